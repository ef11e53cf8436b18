//! Files that are whole at every moment.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Writes a file: beside its place, and into it by a new name once all of it is written. Where that fails, what
/// was there before is as it was, and nothing half-written stays.
///
/// A symbolic link continues leading to the file, and a file's permissions stay. Where the place is a device, a pipe, or in
/// a folder that takes no further file, it is written to itself.
///
/// # Errors
/// What the system says.
pub fn write_whole(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let found = fs::metadata(&path).ok();
    if found.as_ref().is_some_and(|found| !found.is_file()) {
        return fs::write(&path, bytes);
    }
    let Some(beside) = beside(&path) else { return fs::write(&path, bytes) };
    let file = match OpenOptions::new().write(true).create(true).truncate(true).open(&beside) {
        Err(error) if found.is_some() && error.kind() == io::ErrorKind::PermissionDenied => {
            return fs::write(&path, bytes);
        }
        opened => opened?,
    };
    let written = fill(file, bytes, found).and_then(|()| fs::rename(&beside, &path));
    if written.is_err() {
        // there is nothing more to be done about one that cannot be removed
        let _ = fs::remove_file(&beside);
    }
    written
}

fn fill(mut file: File, bytes: &[u8], place: Option<fs::Metadata>) -> io::Result<()> {
    if let Some(place) = place {
        file.set_permissions(place.permissions())?;
    }
    file.write_all(bytes)
}

/// The name while it is written; `None` of a path that names no file.
fn beside(path: &Path) -> Option<PathBuf> {
    let mut name = path.file_name()?.to_owned();
    name.push(".part");
    Some(path.with_file_name(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("mavid-files-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).unwrap();
        path
    }

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = entries.map(|name| name.into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn a_file_is_replaced_whole() {
        let folder = folder("replaced");
        let path = folder.join("model.toml");
        for text in ["first", "second, and longer", ""] {
            write_whole(&path, text.as_bytes()).unwrap();
            assert_eq!(fs::read_to_string(&path).unwrap(), text);
        }
        assert_eq!(names(&folder), ["model.toml"]);
        assert!(write_whole(&folder, b"a folder is no file").is_err());
        assert!(write_whole(&folder.join("missing/model.toml"), b"").is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn what_was_there_stays_where_the_new_file_cannot_be_written() {
        let folder = folder("kept");
        let path = folder.join("model.toml");
        fs::write(&path, "before").unwrap();
        // nothing can be written beside it
        fs::create_dir(folder.join("model.toml.part")).unwrap();
        assert!(write_whole(&path, b"after").is_err());
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn links_modes_and_devices_stay_what_they_are() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = folder("kinds");
        let (path, link) = (folder.join("model.toml"), folder.join("link.toml"));
        fs::write(&path, "before").unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("model.toml", &link).unwrap();
        write_whole(&link, b"after").unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "after");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        write_whole(Path::new("/dev/null"), b"gone").unwrap();
        fs::remove_dir_all(folder).unwrap();
    }

    /// The disk of the folder's own kind: a device that is always full takes no byte.
    #[cfg(target_os = "linux")]
    #[test]
    fn a_full_device_is_told() {
        let error = write_whole(Path::new("/dev/full"), b"no room").unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::StorageFull);
    }
}
