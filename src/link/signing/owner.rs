//! Files that are for their owner alone.

use std::io;
use std::path::Path;

use tempfile::NamedTempFile;

/// A warning where others than its owner may read or write a key's file; `None` where the system tells no such thing.
pub(super) fn exposure(path: &Path) -> Option<String> {
    let (done, mode) = open_to_others(path)?;
    let name = crate::text::path(path);
    Some(format!(
        "the signing key in {name} can be {done} by others (mode {mode:o}, expected 600): chmod 600 {name}"
    ))
}

/// The same of the times of a key, which are taken from others as they are read.
pub(super) fn times_exposure(path: &Path) -> Option<String> {
    let (done, mode) = open_to_others(path)?;
    Some(format!(
        "the signing times in {} could be {done} by others (mode {mode:o}, expected 600): a change of them would \
         allow old messages to be replayed, or block the vehicle; only this user can read and write them from now on",
        crate::text::path(path)
    ))
}

/// What others than its owner may do to a file, and its mode.
#[cfg(unix)]
fn open_to_others(path: &Path) -> Option<(String, u32)> {
    use std::os::unix::fs::MetadataExt;
    const OTHERS: u32 = 0o077;
    // one that is gone meanwhile was read before
    let mode = std::fs::metadata(path).ok()?.mode() & 0o777;
    let open = [(0o044, "read"), (0o022, "written")];
    let done: Vec<&str> =
        open.into_iter().filter(|(bits, _)| mode & bits != 0).map(|(_, done)| done).collect();
    let done = if done.is_empty() { "run".to_owned() } else { done.join(" and ") };
    (mode & OTHERS != 0).then_some((done, mode))
}

/// The system tells no such thing.
#[cfg(not(unix))]
fn open_to_others(_path: &Path) -> Option<(String, u32)> {
    None
}

/// A new file in this folder, for its owner alone whatever the process's umask. It is removed unless it is given a name.
pub(super) fn temporary(folder: &Path) -> io::Result<NamedTempFile> {
    let file = tempfile::Builder::new().prefix(".mavid-times-").tempfile_in(folder)?;
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        const OWNER: u32 = 0o600;
        // never open to others, not even between two calls; a umask can only take from it, which is given back
        file.as_file().set_permissions(std::fs::Permissions::from_mode(OWNER))?;
    }
    Ok(file)
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Write;
    use std::os::unix::fs::{MetadataExt, PermissionsExt};

    #[test]
    fn what_others_may_read_or_write_is_warned_of() {
        let path = std::env::temp_dir().join(format!("mavid-owner-{}", std::process::id()));
        fs::write(&path, "a key").unwrap();
        for (mode, said) in [
            (0o600, None),
            (0o400, None),
            (0o640, Some("read by others (mode 640")),
            (0o604, Some("read by others")),
            (0o620, Some("written by others (mode 620")),
            (0o602, Some("written by others")),
            (0o666, Some("read and written by others")),
        ] {
            fs::set_permissions(&path, fs::Permissions::from_mode(mode)).unwrap();
            let warning = exposure(&path);
            assert_eq!(warning.is_some(), said.is_some(), "{mode:o}: {warning:?}");
            assert!(warning.unwrap_or_default().contains(said.unwrap_or_default()), "{mode:o}");
        }
        // a file that others could read is replaced by one that they cannot
        fs::set_permissions(&path, fs::Permissions::from_mode(0o666)).unwrap();
        let mut file = temporary(&std::env::temp_dir()).unwrap();
        file.write_all(b"another").unwrap();
        file.persist(&path).unwrap();
        assert_eq!(fs::metadata(&path).unwrap().mode() & 0o777, 0o600);
        assert_eq!(fs::read_to_string(&path).unwrap(), "another");
        fs::remove_file(path).unwrap();
    }
}
