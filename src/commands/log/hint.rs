//! Commands that the user may give next, as they are typed into a shell.

use std::path::Path;

use mavid::text::{path, shell_word};

use crate::cli::VehicleLinkArgs;

/// The options by which a command speaks to the same vehicle.
pub fn link_options(link: &VehicleLinkArgs) -> String {
    let mut options = format!("--connect {}", shell_word(&link.connect));
    if let Some(system) = link.system_id {
        options.push_str(&format!(" --system-id {system}"));
    }
    if let Some(key) = &link.signing_key_file {
        options.push_str(&format!(" --signing-key-file {}", shell_word(&path(key))));
    }
    options
}

/// Puts the logging of this vehicle back.
pub fn restore(link: &VehicleLinkArgs) -> String {
    format!("mavid log prepare {} --restore", link_options(link))
}

/// Fetches the last log of this vehicle into a folder.
pub fn fetch_last(link: &VehicleLinkArgs, folder: &Path) -> String {
    format!("mavid log fetch {} --last --out {}", link_options(link), shell_word(&path(folder)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hint_names_the_vehicle_that_was_spoken_to() {
        let link = |connect: &str, system_id, key: Option<&str>| VehicleLinkArgs {
            connect: connect.to_owned(),
            system_id,
            signing_key_file: key.map(Into::into),
        };
        let plain = link("tcpout:127.0.0.1:5760", None, None);
        assert_eq!(restore(&plain), "mavid log prepare --connect tcpout:127.0.0.1:5760 --restore");
        let odd = link("serial:/dev/my port:57600", Some(3), Some("the key"));
        assert_eq!(
            fetch_last(&odd, Path::new("a flight")),
            "mavid log fetch --connect 'serial:/dev/my port:57600' --system-id 3 --signing-key-file 'the key' --last \
             --out 'a flight'"
        );
    }
}
