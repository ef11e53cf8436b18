//! Links over serial ports.

use crate::text;
use std::io;
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

use serialport::{DataBits, FlowControl, Parity, StopBits};

use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;
use super::backoff::Backoff;
use super::threads::{self, Port};

/// A call that waits longer returns, so that its thread can see whether it is still wanted.
const CALL: Duration = Duration::from_millis(50);
/// How long a port that exists and cannot be opened is tried again.
const LET_GO: Duration = Duration::from_millis(500);

/// Opens a serial port, and opens it again.
pub(in crate::link) struct Serial {
    path: PathBuf,
    baud: u32,
    flow_control: bool,
    first: Option<Port>,
}

impl std::fmt::Debug for Serial {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Serial").field("path", &self.path).field("baud", &self.baud).finish_non_exhaustive()
    }
}

impl Serial {
    pub fn open(path: &Path, baud: u32, flow_control: bool) -> io::Result<Self> {
        let mut serial = Self { path: path.into(), baud, flow_control, first: None };
        let port = serial.port_once_let_go();
        serial.first = Some(port.map_err(|error| io::Error::new(error.kind(), with_ports(&error, path)))?);
        Ok(serial)
    }

    /// The port, waited for while a link that has just ended still holds it: its threads notice after a [`CALL`].
    fn port_once_let_go(&self) -> io::Result<Port> {
        let asked = Instant::now();
        loop {
            match self.port() {
                Err(_) if self.path.exists() && asked.elapsed() < LET_GO => thread::sleep(CALL),
                port => return port,
            }
        }
    }

    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        let mut backoff = Backoff::new();
        loop {
            let port = self.first.take().map_or_else(|| self.port(), Ok);
            if let Ok(port) = port {
                backoff.reset();
                outgoing.connected();
                incoming.connected(text::path(&self.path));
                let why = threads::session(port, incoming, outgoing).await;
                incoming.lost(why);
                outgoing.discard();
            }
            backoff.wait().await;
        }
    }

    fn port(&self) -> io::Result<Port> {
        let flow = if self.flow_control { FlowControl::Hardware } else { FlowControl::None };
        let reader = serialport::new(self.path.to_string_lossy(), self.baud)
            .data_bits(DataBits::Eight)
            .parity(Parity::None)
            .stop_bits(StopBits::One)
            .flow_control(flow)
            .timeout(CALL)
            .open()?;
        let writer = reader.try_clone()?;
        Ok(Port { reader: Box::new(reader), writer: Box::new(writer) })
    }
}

/// Ports that an error names at most.
const NAMED: usize = 8;

/// Why a port was not opened, with the ports that there are.
fn with_ports(error: &io::Error, path: &Path) -> String {
    let ports = serialport::available_ports().unwrap_or_default();
    let mut names: Vec<String> = ports.into_iter().map(|port| text::clean(&port.port_name)).collect();
    // radios and flight controllers are on USB
    names.sort_by_key(|name| (!name.contains("USB") && !name.contains("ACM"), name.clone()));
    let there = match names.len() {
        0 => "this computer has no serial ports".to_owned(),
        count if count > NAMED => {
            format!("serial ports here: {}, and {} more", names[..NAMED].join(", "), count - NAMED)
        }
        _ => format!("serial ports here: {}", names.join(", ")),
    };
    let may_not = error.kind() == io::ErrorKind::PermissionDenied && path.exists();
    let group = if may_not { "; may this user open it (on Debian: group dialout)?" } else { "" };
    format!("{error}{group}; {there}")
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use crate::link::transport::pty::Pty;

    #[test]
    fn a_port_is_opened_once_the_link_before_has_let_go_of_it() {
        let folder = std::env::temp_dir().join(format!("mavid_serial_{}", std::process::id()));
        std::fs::create_dir_all(&folder).unwrap();
        let path = folder.join("tty");
        let _other_end = Pty::open(&path).unwrap();
        let before = Serial::open(&path, 57_600, false).unwrap();
        let ends = thread::spawn(move || {
            thread::sleep(CALL);
            drop(before);
        });
        assert!(Serial::open(&path, 57_600, false).is_ok());
        ends.join().unwrap();
        let error = Serial::open(&folder.join("none"), 57_600, false).unwrap_err().to_string();
        assert!(error.contains("serial ports"), "{error}");
    }
}
