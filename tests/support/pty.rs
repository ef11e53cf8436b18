//! A program at a pseudo-terminal.

#![allow(dead_code, clippy::unwrap_used)] // no test uses all of it

use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread;

use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};

/// The end of a terminal at which somebody sits.
pub struct Person {
    keyboard: File,
    seen: Arc<Mutex<Vec<u8>>>,
    looks: Arc<AtomicBool>,
}

impl Person {
    /// Starts a program with input, output and errors at a terminal of 40 rows and 120 columns.
    pub fn starts(command: &mut Command) -> (Self, Child) {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        let size = Winsize { ws_row: 40, ws_col: 120, ws_xpixel: 0, ws_ypixel: 0 };
        tcsetwinsize(&master, size).unwrap();
        let name = PathBuf::from(ptsname(&master, Vec::new()).unwrap().into_string().unwrap());
        let flags = OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC;
        let terminal = || File::from(rustix::fs::open(&name, flags, Mode::empty()).unwrap());
        let child = command.stdin(terminal()).stdout(terminal()).stderr(terminal()).spawn().unwrap();
        let keyboard = File::from(master);
        let screen = keyboard.try_clone().unwrap();
        let (seen, looks) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(true)));
        let (to, still) = (seen.clone(), looks.clone());
        thread::spawn(move || look(screen, &to, &still));
        (Self { keyboard, seen, looks }, child)
    }

    /// Types.
    pub fn types(&mut self, text: &str) {
        self.keyboard.write_all(text.as_bytes()).unwrap();
    }

    /// All that was on the screen so far.
    pub fn saw(&self) -> String {
        String::from_utf8_lossy(&self.seen.lock().unwrap()).into_owned()
    }

    /// Takes nothing of the screen any more, and does not hang up.
    pub fn looks_away(&self) {
        self.looks.store(false, Ordering::SeqCst);
    }
}

fn look(mut screen: File, to: &Mutex<Vec<u8>>, still: &AtomicBool) {
    let mut bytes = [0; 4096];
    while still.load(Ordering::SeqCst) {
        match screen.read(&mut bytes) {
            // everybody has left the terminal
            Ok(0) | Err(_) => return,
            Ok(count) => to.lock().unwrap().extend_from_slice(&bytes[..count]),
        }
    }
}
