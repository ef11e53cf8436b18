//! Names of files from a vehicle, made harmless.

/// Letters of a name, at most.
const LETTERS: usize = 80;
/// Names that mean devices on Windows, whatever follows a dot.
const DEVICES: [&str; 6] = ["con", "prn", "aux", "nul", "com", "lpt"];
/// Where nothing of a name is left.
const NAMELESS: &str = "log";

/// The name under which a log is kept here: its last part, with its folder before it where that is a day (PX4). Letters,
/// digits, `.`, `-` and `_` stay; it does not begin with a dot, is not long, and is no device's.
#[must_use]
pub fn local_name(path: &str) -> String {
    let mut parts = path.rsplit(['/', '\\']).filter(|part| !part.is_empty());
    let base = harmless(parts.next().unwrap_or(NAMELESS));
    match parts.next().filter(|folder| is_day(folder)) {
        Some(day) => format!("{day}_{base}"),
        None => base,
    }
}

/// `2026-11-23`
fn is_day(folder: &str) -> bool {
    let digits = |at: usize| matches!(at, 4 | 7);
    folder.len() == 10
        && folder
            .bytes()
            .enumerate()
            .all(|(at, byte)| if digits(at) { byte == b'-' } else { byte.is_ascii_digit() })
}

fn harmless(name: &str) -> String {
    let keep = |letter: char| {
        let stays = letter.is_ascii_alphanumeric() || matches!(letter, '.' | '-' | '_');
        if stays { letter } else { '_' }
    };
    let letters: Vec<char> = name.chars().map(keep).collect();
    // its end tells what it is
    let from = letters.len().saturating_sub(LETTERS);
    let kept: String = letters[from..].iter().collect();
    let kept = kept.trim_start_matches(['.', '-']).trim_end_matches('.');
    if kept.is_empty() {
        return NAMELESS.to_owned();
    }
    let stem = kept.split('.').next().unwrap_or_default().to_ascii_lowercase();
    let numbered = stem.strip_suffix(|letter: char| letter.is_ascii_digit()).unwrap_or(&stem);
    if DEVICES.contains(&stem.as_str()) || DEVICES[4..].contains(&numbered) {
        return format!("{NAMELESS}_{kept}");
    }
    kept.to_owned()
}

#[cfg(test)]
mod tests {
    use super::local_name;

    #[test]
    fn names_stay_what_they_are_and_hostile_ones_become_harmless() {
        for (path, name) in [
            ("/APM/LOGS/00000012.BIN", "00000012.BIN"),
            ("/fs/microsd/log/2026-11-23/06_34_39.ulg", "2026-11-23_06_34_39.ulg"),
            ("/fs/microsd/log/sess012/log001.ulg", "log001.ulg"),
            ("/APM/LOGS/../../../etc/passwd", "passwd"),
            ("..", "log"),
            ("", "log"),
            ("/", "log"),
            ("a/\u{0}\u{1b}[2Jx.bin", "___2Jx.bin"),
            ("..\\..\\boot.ini", "boot.ini"),
            ("/logs/.bashrc", "bashrc"),
            ("/logs/-rf.bin", "rf.bin"),
            ("/logs/NUL.bin", "log_NUL.bin"),
            ("/logs/com1", "log_com1"),
            ("/logs/computer.bin", "computer.bin"),
            ("/logs/x.bin...", "x.bin"),
            ("2026-11-2\u{202e}/x.ulg", "x.ulg"),
        ] {
            assert_eq!(local_name(path), name, "{path:?}");
        }
        let long = local_name(&format!("/logs/{}.bin", "x".repeat(500)));
        assert!(long.len() == 80 && long.ends_with(".bin"), "{long}");
    }
}
