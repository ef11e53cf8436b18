//! The kinds of transport, and how each is opened and served.

use std::net::SocketAddr;
use std::time::Duration;

use tokio::io::DuplexStream;

#[cfg(unix)]
use super::pty;
use super::{serial, stream, tcp, udp};
use crate::link::address::Address;
use crate::link::error::LinkError;
use crate::link::incoming::Incoming;
use crate::link::outgoing::Outgoing;

/// What carries the bytes of a link.
#[derive(Debug)]
pub(in crate::link) enum Transport {
    UdpIn(udp::UdpIn),
    UdpOut(udp::UdpOut),
    TcpIn(tcp::TcpIn),
    TcpOut(tcp::TcpOut),
    Serial(serial::Serial),
    #[cfg(unix)]
    Pty(pty::Pty),
    Memory(Option<DuplexStream>),
}

/// Opens what an address names.
pub(in crate::link) async fn open(
    address: &Address,
    (peer_timeout, patient): (Duration, bool),
) -> Result<Transport, LinkError> {
    let opened = match address {
        Address::UdpIn { host, port } => {
            udp::UdpIn::open(host, *port, peer_timeout).await.map(Transport::UdpIn)
        }
        Address::UdpOut { host, port } => udp::UdpOut::open(host, *port).await.map(Transport::UdpOut),
        Address::TcpIn { host, port } => tcp::TcpIn::open(host, *port).await.map(Transport::TcpIn),
        Address::TcpOut { host, port } => {
            tcp::TcpOut::open(host, *port, patient).await.map(Transport::TcpOut)
        }
        Address::Serial { path, baud, flow_control } => {
            serial::Serial::open(path, *baud, *flow_control).map(Transport::Serial)
        }
        #[cfg(unix)]
        Address::Pty { path } => pty::Pty::open(path).map(Transport::Pty),
        #[cfg(not(unix))]
        Address::Pty { .. } => {
            return Err(LinkError::Unavailable { address: address.to_string(), kind: "pseudo-terminal" });
        }
    };
    opened.map_err(|source| LinkError::Open { address: address.to_string(), source })
}

impl Transport {
    /// The socket's own address, where it has one for good.
    pub fn local(&self) -> Option<SocketAddr> {
        match self {
            Self::UdpIn(udp) => Some(udp.local()),
            Self::TcpIn(tcp) => tcp.local(),
            _ => None,
        }
    }

    /// Whether there is somebody to send to as soon as it is open.
    pub fn is_connected(&self) -> bool {
        match self {
            Self::UdpOut(_) | Self::Serial(_) | Self::Memory(_) => true,
            Self::TcpOut(tcp) => tcp.is_connected(),
            _ => false,
        }
    }

    /// Carries bytes, connecting again as often as needed; ends only where that is impossible.
    pub async fn serve(&mut self, incoming: &mut Incoming, outgoing: &mut Outgoing) {
        match self {
            Self::UdpIn(udp) => udp.serve(incoming, outgoing).await,
            Self::UdpOut(udp) => udp.serve(incoming, outgoing).await,
            Self::TcpIn(tcp) => tcp.serve(incoming, outgoing).await,
            Self::TcpOut(tcp) => tcp.serve(incoming, outgoing).await,
            Self::Serial(serial) => serial.serve(incoming, outgoing).await,
            #[cfg(unix)]
            Self::Pty(pty) => pty.serve(incoming, outgoing).await,
            Self::Memory(stream) => {
                if let Some(stream) = stream.take() {
                    incoming.connected("memory".into());
                    let why = stream::session(stream, incoming, outgoing).await;
                    incoming.lost(why);
                }
            }
        }
    }
}
