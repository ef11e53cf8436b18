//! Links over a pseudo-terminal: the end that another program does not open as its serial port.

use crate::text;
use std::fs::{self, File};
use std::io::{self, ErrorKind, Read, Write};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::time::Duration;

use rustix::event::{PollFd, PollFlags, Timespec, poll};
use rustix::fs::{Mode, OFlags};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{OptionalActions, tcgetattr, tcsetattr};

use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;
use super::threads::{self, Port};

/// How often it is looked whether the terminal was opened.
const LOOK: Duration = Duration::from_millis(20);
/// A call that waits longer returns.
const CALL: Timespec = Timespec { tv_sec: 0, tv_nsec: 50_000_000 };
const NO_WAIT: Timespec = Timespec { tv_sec: 0, tv_nsec: 0 };

/// A pseudo-terminal behind a symbolic link, which goes when this does.
#[derive(Debug)]
pub(in crate::link) struct Pty {
    master: File,
    terminal: PathBuf,
    link: PathBuf,
}

impl Pty {
    pub fn open(link: &Path) -> io::Result<Self> {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY | OpenptFlags::CLOEXEC)?;
        grantpt(&master)?;
        unlockpt(&master)?;
        rustix::io::ioctl_fionbio(&master, true)?;
        let name = ptsname(&master, Vec::new())?;
        let terminal = PathBuf::from(name.to_string_lossy().into_owned());
        make_raw(&terminal)?;
        // a link that an earlier run left behind is replaced, anything else is not ours
        match fs::symlink_metadata(link) {
            Ok(found) if found.is_symlink() => fs::remove_file(link)?,
            Ok(_) => return Err(io::Error::new(ErrorKind::AlreadyExists, "something else has that name")),
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(error),
        }
        std::os::unix::fs::symlink(&terminal, link)?;
        Ok(Self { master: master.into(), terminal, link: link.into() })
    }

    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        loop {
            if let (true, Ok(port)) = (is_opened(&self.master), self.port()) {
                outgoing.connected();
                incoming.connected(text::path(&self.terminal));
                let why = threads::session(port, incoming, outgoing).await;
                incoming.lost(why);
                outgoing.discard();
            }
            tokio::time::sleep(LOOK).await;
        }
    }

    fn port(&self) -> io::Result<Port> {
        let end = || self.master.try_clone().map(End);
        Ok(Port { reader: Box::new(end()?), writer: Box::new(end()?) })
    }
}

impl Drop for Pty {
    fn drop(&mut self) {
        if fs::read_link(&self.link).is_ok_and(|to| to == self.terminal) {
            // a link that cannot be removed leads nowhere and is replaced by the next run
            let _ = fs::remove_file(&self.link);
        }
    }
}

/// Bytes pass as they are. Opening and closing it once also makes the system tell whether it is open.
fn make_raw(terminal: &Path) -> io::Result<()> {
    let opened = rustix::fs::open(terminal, OFlags::RDWR | OFlags::NOCTTY | OFlags::CLOEXEC, Mode::empty())?;
    let mut modes = tcgetattr(&opened)?;
    modes.make_raw();
    Ok(tcsetattr(&opened, OptionalActions::Now, &modes)?)
}

/// Whether some program has the terminal open.
fn is_opened(master: &File) -> bool {
    ready(master, PollFlags::IN, &NO_WAIT).is_ok_and(|found| !found.contains(PollFlags::HUP))
}

fn ready(file: &File, wanted: PollFlags, wait: &Timespec) -> io::Result<PollFlags> {
    let mut one = [PollFd::from_borrowed_fd(file.as_fd(), wanted)];
    poll(&mut one, Some(wait))?;
    Ok(one[0].revents())
}

/// One direction of the pseudo-terminal.
struct End(File);

impl End {
    fn wait(&self, wanted: PollFlags) -> io::Result<()> {
        let found = ready(&self.0, wanted, &CALL)?;
        if found.intersects(wanted) {
            return Ok(());
        }
        Err(if found.is_empty() {
            ErrorKind::TimedOut.into()
        } else {
            io::Error::new(ErrorKind::UnexpectedEof, "the terminal was closed")
        })
    }
}

/// Another thread was faster.
fn as_timeout(error: io::Error) -> io::Error {
    if error.kind() == ErrorKind::WouldBlock { ErrorKind::TimedOut.into() } else { error }
}

impl Read for End {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        self.wait(PollFlags::IN)?;
        self.0.read(buffer).map_err(as_timeout)
    }
}

impl Write for End {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.wait(PollFlags::OUT)?;
        self.0.write(bytes).map_err(as_timeout)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
