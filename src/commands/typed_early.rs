//! What was typed before a question was asked is no answer to it.

/// Takes from a terminal what was typed and is not read yet, half a line among it. Input that is no terminal, as a file or a pipe,
/// keeps its lines.
pub fn throw_away() {
    #[cfg(unix)]
    throw_away_of(std::io::stdin());
}

#[cfg(unix)]
fn throw_away_of(input: impl std::os::fd::AsFd) {
    use rustix::termios::{QueueSelector, tcflush};
    // what is no terminal has nothing of the kind
    let _ = tcflush(input, QueueSelector::IFlush);
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::fs::{Mode, OFlags};
    use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
    use std::fs::File;
    use std::io::{Read, Write};
    use std::os::fd::AsFd;

    /// A keyboard, and the terminal that it types into.
    fn terminal() -> (File, File) {
        let keyboard = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&keyboard).unwrap();
        unlockpt(&keyboard).unwrap();
        let name = ptsname(&keyboard, Vec::new()).unwrap();
        let terminal = rustix::fs::open(name, OFlags::RDWR | OFlags::NOCTTY, Mode::empty()).unwrap();
        (keyboard.into(), terminal.into())
    }

    /// Whether there is something to read, waited for without end or not at all.
    fn has_input(input: &impl AsFd, waits: bool) -> bool {
        let no_time = Timespec { tv_sec: 0, tv_nsec: 0 };
        let limit = if waits { None } else { Some(&no_time) };
        poll(&mut [PollFd::new(input, PollFlags::IN)], limit).unwrap() > 0
    }

    #[test]
    fn a_terminal_forgets_what_was_typed_and_hears_what_is_typed_then() {
        let (mut keyboard, mut terminal) = terminal();
        keyboard.write_all(b"arm\n").unwrap();
        assert!(has_input(&terminal, true));
        throw_away_of(&terminal);
        assert!(!has_input(&terminal, false));
        keyboard.write_all(b"y\n").unwrap();
        let mut line = [0; 8];
        let count = terminal.read(&mut line).unwrap();
        assert_eq!(&line[..count], b"y\n");
    }

    #[test]
    fn a_pipe_keeps_its_lines() {
        let (mut reader, mut writer) = std::io::pipe().unwrap();
        writer.write_all(b"arm\n").unwrap();
        drop(writer);
        throw_away_of(&reader);
        let mut text = String::new();
        reader.read_to_string(&mut text).unwrap();
        assert_eq!(text, "arm\n");
    }
}
