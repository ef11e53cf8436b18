//! Links over TCP.

use std::io;
use std::net::SocketAddr;
use std::time::Duration;

use socket2::{SockRef, TcpKeepalive};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::timeout;

use super::super::incoming::Incoming;
use super::super::outgoing::Outgoing;
use super::backoff::Backoff;
use super::resolver::resolve;
use super::stream;

const CONNECT_TIMEOUT: Duration = Duration::from_secs(5);
/// A peer that is gone without a word is found out after this and a few probes.
const KEEPALIVE: Duration = Duration::from_secs(5);
const PROBE: Duration = Duration::from_secs(1);

/// Serves one client at a time.
#[derive(Debug)]
pub(in crate::link) struct TcpIn {
    listener: TcpListener,
}

impl TcpIn {
    pub async fn open(host: &str, port: u16) -> io::Result<Self> {
        Ok(Self { listener: TcpListener::bind(resolve(host, port).await?.as_slice()).await? })
    }

    pub fn local(&self) -> Option<SocketAddr> {
        self.listener.local_addr().ok()
    }

    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        let mut backoff = Backoff::new();
        loop {
            match self.listener.accept().await {
                Ok((client, peer)) => {
                    backoff.reset();
                    prepare(&client);
                    carry(client, peer, incoming, outgoing).await;
                }
                // a client that left before it was served, or no descriptors left
                Err(_) => backoff.wait().await,
            }
        }
    }
}

/// Connects, and connects again.
#[derive(Debug)]
pub(in crate::link) struct TcpOut {
    host: String,
    port: u16,
    first: Option<(TcpStream, SocketAddr)>,
}

impl TcpOut {
    /// A patient one is open as well while the other end refuses or is silent.
    pub async fn open(host: &str, port: u16, patient: bool) -> io::Result<Self> {
        let first = match connect(host, port).await {
            Ok(first) => Some(first),
            Err(error) if patient && is_absence(&error) => None,
            Err(error) => return Err(error),
        };
        Ok(Self { host: host.into(), port, first })
    }

    pub fn is_connected(&self) -> bool {
        self.first.is_some()
    }

    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        let mut backoff = Backoff::new();
        loop {
            let connection = match self.first.take() {
                Some(first) => Ok(first),
                None => connect(&self.host, self.port).await,
            };
            match connection {
                Ok((stream, peer)) => {
                    backoff.reset();
                    carry(stream, peer, incoming, outgoing).await;
                }
                Err(error) => incoming.waiting(error.to_string()),
            }
            backoff.wait().await;
        }
    }
}

/// The other end may come yet.
fn is_absence(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::ConnectionRefused | io::ErrorKind::TimedOut)
}

async fn connect(host: &str, port: u16) -> io::Result<(TcpStream, SocketAddr)> {
    let mut failure = None;
    for address in resolve(host, port).await? {
        match timeout(CONNECT_TIMEOUT, TcpStream::connect(address)).await {
            Ok(Ok(stream)) => {
                prepare(&stream);
                return Ok((stream, address));
            }
            Ok(Err(error)) => failure = Some(error),
            Err(_) => failure = Some(io::ErrorKind::TimedOut.into()),
        }
    }
    Err(failure.unwrap_or_else(|| io::ErrorKind::NotFound.into()))
}

/// No delay for small frames; a dead peer is found out. Where the system refuses, the link still works.
fn prepare(stream: &TcpStream) {
    let _ = stream.set_nodelay(true);
    let keepalive = TcpKeepalive::new().with_time(KEEPALIVE).with_interval(PROBE);
    let _ = SockRef::from(stream).set_tcp_keepalive(&keepalive);
}

async fn carry(stream: TcpStream, peer: SocketAddr, incoming: &mut Incoming, outgoing: &mut Outgoing) {
    outgoing.connected();
    incoming.connected(peer.to_string());
    let why = stream::session(stream, incoming, outgoing).await;
    incoming.lost(why);
    outgoing.discard();
}

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test]
    async fn small_frames_are_not_held_back() {
        let server = TcpIn::open("127.0.0.1", 0).await.unwrap();
        let port = server.listener.local_addr().unwrap().port();
        let (stream, _) = connect("127.0.0.1", port).await.unwrap();
        assert!(stream.nodelay().unwrap());
        assert!(SockRef::from(&stream).keepalive().unwrap());
        let (accepted, _) = server.listener.accept().await.unwrap();
        prepare(&accepted);
        assert!(accepted.nodelay().unwrap());
    }
}
