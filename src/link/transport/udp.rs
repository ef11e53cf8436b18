//! Links over UDP.

use std::collections::BTreeSet;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::sync::Arc;
use std::time::Duration;

use socket2::{Domain, Protocol, Socket, Type};
use tokio::net::UdpSocket;
use tokio::time::{Instant, sleep_until};

use super::super::clock::HostStamp;
use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;
use super::backoff::Backoff;
use super::resolver::resolve;

/// Larger than any datagram.
const BUFFER: usize = 1 << 16;
/// Asked of the system for bursts; it gives what its own limit allows.
const RECEIVE_BUFFER: usize = 4 << 20;
/// So many failures in a row are no passing trouble.
const FAILURES: u32 = 8;
/// Strangers that are told; further ones are only counted.
const STRANGERS: usize = 16;

/// Waits for datagrams and answers the first peer that sends a heartbeat.
#[derive(Debug)]
pub(in crate::link) struct UdpIn {
    local: SocketAddr,
    first: Option<Arc<UdpSocket>>,
    peer_timeout: Duration,
    strangers: BTreeSet<SocketAddr>,
}

/// Whom a waiting link answers, and since when that peer is silent.
struct Peer {
    address: SocketAddr,
    heard: Instant,
}

impl UdpIn {
    pub async fn open(host: &str, port: u16, peer_timeout: Duration) -> io::Result<Self> {
        let asked = resolve(host, port).await?[0];
        let socket = bind(asked)?;
        // port 0 becomes the one that the system chose, also for later
        let local = socket.local_addr()?;
        Ok(Self { local, first: Some(socket), peer_timeout, strangers: BTreeSet::new() })
    }

    pub fn local(&self) -> SocketAddr {
        self.local
    }

    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        let mut backoff = Backoff::new();
        loop {
            let socket = self.first.take().map_or_else(|| bind(self.local), Ok);
            if let Ok(socket) = socket {
                let why = self.session(&socket, incoming, outgoing).await;
                incoming.lost(why);
                outgoing.discard();
            }
            backoff.wait().await;
        }
    }

    /// Until the socket itself fails.
    async fn session(
        &mut self,
        socket: &Arc<UdpSocket>,
        incoming: &mut Incoming,
        outgoing: &mut Outgoing,
    ) -> String {
        let mut buffer = vec![0; BUFFER];
        let mut peer: Option<Peer> = None;
        let mut failures = Failures::default();
        loop {
            let silent_at = peer.as_ref().map_or_else(Instant::now, |peer| peer.heard + self.peer_timeout);
            let failure = tokio::select! {
                received = socket.recv_from(&mut buffer) => match received {
                    Ok((bytes, from)) => {
                        failures.reset();
                        if self.received(&buffer[..bytes], from, &mut peer, incoming, outgoing) {
                            outgoing.open_direct(socket, Some(from));
                        }
                        None
                    }
                    Err(error) => Some(error),
                },
                frame = outgoing.next(), if peer.is_some() => {
                    let to = peer.as_ref().map_or(self.local, |peer| peer.address);
                    let stamp = outgoing.now();
                    sent(socket.send_to(&frame, to).await, &frame, stamp, outgoing)
                }
                () = sleep_until(silent_at), if peer.is_some() => {
                    peer = None;
                    incoming.lost(format!("silent for {} s", self.peer_timeout.as_secs_f64()));
                    outgoing.discard();
                    None
                }
            };
            if let Some(error) = failure
                && let Some(why) = failures.add(&error).await
            {
                return why;
            }
        }
    }

    /// Takes a datagram; whether its sender has just become the peer.
    fn received(
        &mut self,
        bytes: &[u8],
        from: SocketAddr,
        peer: &mut Option<Peer>,
        incoming: &mut Incoming,
        outgoing: &mut Outgoing,
    ) -> bool {
        let stamp = incoming.now();
        match peer {
            Some(peer) if peer.address == from => {
                incoming.datagram(bytes, stamp);
                peer.heard = stamp.at;
            }
            Some(_) => {
                incoming.count_stranger();
                if self.strangers.len() < STRANGERS && self.strangers.insert(from) {
                    incoming.stranger(from.to_string());
                }
            }
            None => {
                if incoming.datagram(bytes, stamp) {
                    outgoing.connected();
                    incoming.connected(from.to_string());
                    *peer = Some(Peer { address: from, heard: stamp.at });
                    return true;
                }
            }
        }
        false
    }
}

/// Sends datagrams to one peer and hears only that one.
#[derive(Debug)]
pub(in crate::link) struct UdpOut {
    remote: SocketAddr,
    first: Option<Arc<UdpSocket>>,
}

impl UdpOut {
    pub async fn open(host: &str, port: u16) -> io::Result<Self> {
        let remote = resolve(host, port).await?[0];
        Ok(Self { remote, first: Some(connect(remote).await?) })
    }

    /// A peer that refuses (nothing listens on its port) is told once and tried on, since it is we who speak
    /// first; its next datagram restores it.
    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        let mut backoff = Backoff::new();
        incoming.connected(self.remote.to_string());
        let mut lost = false;
        loop {
            let socket = match self.first.take() {
                Some(first) => Ok(first),
                None => connect(self.remote).await,
            };
            if let Ok(socket) = socket {
                outgoing.connected();
                outgoing.open_direct(&socket, None);
                incoming.open(true);
                let why = self.session(&socket, &mut lost, incoming, outgoing).await;
                if !lost {
                    lost = true;
                    incoming.lost(why);
                }
                incoming.open(false);
                outgoing.discard();
            }
            backoff.wait().await;
        }
    }

    /// Until the socket itself fails.
    async fn session(
        &mut self,
        socket: &Arc<UdpSocket>,
        lost: &mut bool,
        incoming: &mut Incoming,
        outgoing: &mut Outgoing,
    ) -> String {
        let mut buffer = vec![0; BUFFER];
        let mut failures = Failures::default();
        loop {
            let failure = tokio::select! {
                received = socket.recv(&mut buffer) => match received {
                    Ok(bytes) => {
                        let stamp = incoming.now();
                        failures.reset();
                        if std::mem::take(lost) {
                            incoming.connected(self.remote.to_string());
                        }
                        incoming.datagram(&buffer[..bytes], stamp);
                        None
                    }
                    Err(error) => Some(error),
                },
                frame = outgoing.next() => {
                    let stamp = outgoing.now();
                    let mut result = socket.send(&frame).await;
                    if is_refusal(&result) {
                        // the answer to an earlier datagram; this one was not sent yet
                        self.refused(lost, incoming);
                        result = socket.send(&frame).await;
                    }
                    sent(result, &frame, stamp, outgoing)
                }
            };
            match failure {
                None => {}
                Some(error) if error.kind() == io::ErrorKind::ConnectionRefused => {
                    self.refused(lost, incoming);
                }
                Some(error) => {
                    if let Some(why) = failures.add(&error).await {
                        return why;
                    }
                }
            }
        }
    }
}

impl UdpOut {
    fn refused(&self, lost: &mut bool, incoming: &mut Incoming) {
        if !std::mem::replace(lost, true) {
            incoming.lost(format!("nothing listens on {}", self.remote));
            incoming.open(true);
        }
    }
}

fn is_refusal(result: &io::Result<usize>) -> bool {
    result.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::ConnectionRefused)
}

fn sent(
    result: io::Result<usize>,
    frame: &[u8],
    stamp: HostStamp,
    outgoing: &mut Outgoing,
) -> Option<io::Error> {
    match result {
        Ok(_) => {
            outgoing.sent(frame, stamp);
            None
        }
        Err(error) => {
            outgoing.failed();
            Some(error)
        }
    }
}

/// Failures in a row: each is followed by a pause, and too many end the session.
#[derive(Debug, Default)]
struct Failures {
    count: u32,
}

impl Failures {
    fn reset(&mut self) {
        self.count = 0;
    }

    /// Pauses; `Some` where it is no passing trouble.
    async fn add(&mut self, error: &io::Error) -> Option<String> {
        self.count += 1;
        if self.count >= FAILURES {
            return Some(format!("the socket failed {FAILURES} times in a row: {error}"));
        }
        tokio::time::sleep(Duration::from_millis(1 << self.count)).await;
        None
    }
}

fn bind(local: SocketAddr) -> io::Result<Arc<UdpSocket>> {
    let socket = Socket::new(Domain::for_address(local), Type::DGRAM, Some(Protocol::UDP))?;
    if local.is_ipv6() && local.ip().is_unspecified() {
        // `[::]` means everybody
        socket.set_only_v6(false)?;
    }
    // a smaller buffer is no reason to fail
    let _ = socket.set_recv_buffer_size(RECEIVE_BUFFER);
    socket.set_nonblocking(true)?;
    socket.bind(&local.into())?;
    UdpSocket::from_std(socket.into()).map(Arc::new)
}

async fn connect(remote: SocketAddr) -> io::Result<Arc<UdpSocket>> {
    let any: IpAddr =
        if remote.is_ipv6() { Ipv6Addr::UNSPECIFIED.into() } else { Ipv4Addr::UNSPECIFIED.into() };
    let socket = bind((any, 0).into())?;
    socket.connect(remote).await?;
    Ok(socket)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(start_paused = true)]
    async fn a_socket_that_goes_on_failing_ends_the_session_after_pauses() {
        let (mut failures, start) = (Failures::default(), Instant::now());
        let error = io::Error::other("no such network");
        for _ in 1..FAILURES {
            assert_eq!(failures.add(&error).await, None);
        }
        let paused = start.elapsed();
        assert!(paused >= Duration::from_millis(200), "{paused:?}");
        let why = failures.add(&error).await.unwrap();
        assert!(why.contains("no such network"), "{why}");
        failures.reset();
        assert_eq!(failures.add(&error).await, None);
    }

    #[tokio::test]
    async fn the_receive_buffer_is_larger_than_the_systems_default() {
        let local = SocketAddr::from(([127, 0, 0, 1], 0));
        let plain = UdpSocket::bind(local).await.unwrap();
        let ours = bind(local).unwrap();
        let size = |socket: &UdpSocket| socket2::SockRef::from(socket).recv_buffer_size().unwrap();
        assert!(size(&ours) > size(&plain), "{} {}", size(&ours), size(&plain));
    }
}
