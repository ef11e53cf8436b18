//! Where a link goes: `udpin:HOST:PORT` and its like.

use crate::text;
use std::fmt;
use std::path::PathBuf;
use std::str::FromStr;

const FORMS: &str = "udpin:HOST:PORT, udpout:HOST:PORT, tcpin:HOST:PORT, tcpout:HOST:PORT, \
                     serial:PATH:BAUD[:rtscts] or pty:PATH (udp: is udpin:, and tcp: is tcpout:)";

/// Where a link goes.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Address {
    /// waits for datagrams and answers the first peer that sends a heartbeat
    UdpIn {
        /// local name or IP address to listen on
        host: String,
        /// UDP port
        port: u16,
    },
    /// sends datagrams to one peer and hears only that one
    UdpOut {
        /// the peer's name or IP address
        host: String,
        /// UDP port
        port: u16,
    },
    /// waits for connections and serves one at a time
    TcpIn {
        /// local name or IP address to listen on
        host: String,
        /// TCP port
        port: u16,
    },
    /// connects to a peer
    TcpOut {
        /// the peer's name or IP address
        host: String,
        /// TCP port
        port: u16,
    },
    /// opens a serial port, 8 data bits, no parity, 1 stop bit
    Serial {
        /// device, like `/dev/ttyACM0` or `COM3`
        path: PathBuf,
        /// bits a second
        baud: u32,
        /// hardware flow control (RTS/CTS)
        flow_control: bool,
    },
    /// makes a pseudo-terminal that another program opens as its serial port
    Pty {
        /// symbolic link to make to it
        path: PathBuf,
    },
}

/// Why a text is no address.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum AddressError {
    /// its first word is no kind of link
    #[error("expected {FORMS}, got `{got}`")]
    Form {
        /// the text
        got: String,
    },
    /// it is the bare path of a device
    #[error(
        "expected a serial port with its rate in bits a second, like `serial:{path}:{baud}`, got `{got}`"
    )]
    Device {
        /// the text
        got: String,
        /// the device
        path: String,
        /// the rate that was given, or a usual one
        baud: u32,
    },
    /// a host is missing
    #[error("expected a host name or IP address (IPv6 in brackets) in `{got}`, got `{host}`")]
    Host {
        /// the text
        got: String,
        /// its part for the host
        host: String,
    },
    /// the port is no port
    #[error("expected a port of 0 to 65535 in `{got}`, got `{port}`")]
    Port {
        /// the text
        got: String,
        /// its part for the port
        port: String,
    },
    /// the baud rate is no rate
    #[error("expected a baud rate above 0 like 57600 in `{got}`, got `{baud}`")]
    Baud {
        /// the text
        got: String,
        /// its part for the rate
        baud: String,
    },
}

impl FromStr for Address {
    type Err = AddressError;

    fn from_str(text: &str) -> Result<Self, AddressError> {
        let form = || {
            let (path, rest) = text.split_once(':').unwrap_or((text, ""));
            if !is_device(path) {
                return AddressError::Form { got: text.into() };
            }
            let baud = rest.parse().ok().filter(|baud| *baud > 0).unwrap_or(USUAL_BAUD);
            AddressError::Device { got: text.into(), path: path.into(), baud }
        };
        let (kind, rest) = text.split_once(':').ok_or_else(form)?;
        // as other programs write it: `udp://:14540` waits on all interfaces
        let (rest, anywhere) = rest.strip_prefix("//").map_or((rest, false), |rest| (rest, true));
        match kind {
            "udp" | "udpin" if anywhere && rest.starts_with(':') => {
                endpoint(text, &format!("0.0.0.0{rest}")).map(|(host, port)| Self::UdpIn { host, port })
            }
            // what `udp:` and `tcp:` mean to pymavlink and MAVProxy
            "udp" => endpoint(text, rest).map(|(host, port)| Self::UdpIn { host, port }),
            "tcp" => endpoint(text, rest).map(|(host, port)| Self::TcpOut { host, port }),
            "udpin" => endpoint(text, rest).map(|(host, port)| Self::UdpIn { host, port }),
            "udpout" => endpoint(text, rest).map(|(host, port)| Self::UdpOut { host, port }),
            "tcpin" => endpoint(text, rest).map(|(host, port)| Self::TcpIn { host, port }),
            "tcpout" => endpoint(text, rest).map(|(host, port)| Self::TcpOut { host, port }),
            "serial" => serial(text, rest),
            "pty" if !rest.is_empty() => Ok(Self::Pty { path: rest.into() }),
            _ => Err(form()),
        }
    }
}

/// Rate of a usual telemetry radio, bits a second.
const USUAL_BAUD: u32 = 57_600;

/// Whether a text is the name of a serial port on Linux, macOS or Windows.
fn is_device(text: &str) -> bool {
    let com = text.get(..3).is_some_and(|start| start.eq_ignore_ascii_case("com"));
    text.starts_with("/dev/") || com && text[3..].parse::<u8>().is_ok()
}

fn endpoint(text: &str, rest: &str) -> Result<(String, u16), AddressError> {
    let (host, port) = rest.rsplit_once(':').ok_or_else(|| AddressError::Form { got: text.into() })?;
    let inner = host.strip_prefix('[').and_then(|host| host.strip_suffix(']'));
    // an IPv6 address without brackets cannot be told from its port
    if inner.unwrap_or(host).is_empty() || inner.is_none() && host.contains([':', '[', ']']) {
        return Err(AddressError::Host { got: text.into(), host: host.into() });
    }
    let number = port.parse().map_err(|_| AddressError::Port { got: text.into(), port: port.into() })?;
    Ok((inner.unwrap_or(host).into(), number))
}

fn serial(text: &str, rest: &str) -> Result<Address, AddressError> {
    let bare = rest.strip_suffix(":rtscts");
    let flow_control = bare.is_some();
    let (path, baud) = bare.unwrap_or(rest).rsplit_once(':').unwrap_or((rest, ""));
    if path.is_empty() {
        return Err(AddressError::Form { got: text.into() });
    }
    match baud.parse() {
        Ok(number) if number > 0 => Ok(Address::Serial { path: path.into(), baud: number, flow_control }),
        _ => Err(AddressError::Baud { got: text.into(), baud: baud.into() }),
    }
}

impl fmt::Display for Address {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (kind, host, port) = match self {
            Self::UdpIn { host, port } => ("udpin", host, port),
            Self::UdpOut { host, port } => ("udpout", host, port),
            Self::TcpIn { host, port } => ("tcpin", host, port),
            Self::TcpOut { host, port } => ("tcpout", host, port),
            Self::Serial { path, baud, flow_control } => {
                let flow = if *flow_control { ":rtscts" } else { "" };
                return write!(f, "serial:{}:{baud}{flow}", text::path(&path));
            }
            Self::Pty { path } => return write!(f, "pty:{}", text::path(&path)),
        };
        if host.contains(':') {
            write!(f, "{kind}:[{host}]:{port}")
        } else {
            write!(f, "{kind}:{host}:{port}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_of_other_programs_are_read() {
        for (text, same) in [
            ("udp:127.0.0.1:14550", "udpin:127.0.0.1:14550"),
            ("tcp:127.0.0.1:5760", "tcpout:127.0.0.1:5760"),
            ("udp://:14540", "udpin:0.0.0.0:14540"),
            ("udpin://0.0.0.0:14540", "udpin:0.0.0.0:14540"),
            ("udpout://192.168.1.2:14550", "udpout:192.168.1.2:14550"),
            ("tcp://vehicle.local:5760", "tcpout:vehicle.local:5760"),
            ("serial:///dev/ttyACM0:57600", "serial:/dev/ttyACM0:57600"),
        ] {
            assert_eq!(
                text.parse::<Address>().map(|address| address.to_string()),
                Ok(same.to_owned()),
                "{text}"
            );
        }
        assert!("udp::14550".parse::<Address>().is_err());
        assert!("tcp://:5760".parse::<Address>().is_err());
    }

    #[test]
    fn addresses_are_written_as_they_are_read() {
        for text in [
            "udpin:0.0.0.0:14550",
            "udpin:[::]:14550",
            "udpout:localhost:14540",
            "udpout:[fe80::1%eth0]:14540",
            "tcpin:127.0.0.1:5760",
            "tcpout:vehicle.local:5760",
            "serial:/dev/ttyACM0:57600",
            "serial:/dev/serial/by-path/pci-0:1.2:921600:rtscts",
            "serial:COM3:115200",
            "pty:/tmp/vehicle",
        ] {
            let address: Address = text.parse().unwrap();
            assert_eq!(address.to_string(), text);
        }
        let Address::Serial { path, baud, flow_control } = "serial:/a:b:57600:rtscts".parse().unwrap() else {
            panic!("no serial port");
        };
        assert_eq!((path, baud, flow_control), (PathBuf::from("/a:b"), 57600, true));
    }

    #[test]
    fn a_wrong_address_is_told_with_what_was_expected() {
        for (text, expected) in [
            ("", "udpin:HOST:PORT"),
            ("127.0.0.1:14550", "udpin:HOST:PORT"),
            ("udq:127.0.0.1:14550", "udpin:HOST:PORT"),
            ("udpin:14550", "udpin:HOST:PORT"),
            ("upd:127.0.0.1:14550", "(udp: is udpin:, and tcp: is tcpout:), got"),
            ("udpin::14550", "host name"),
            ("udpin:[]:14550", "host name"),
            ("udpout:::1:14550", "in brackets"),
            ("tcpout:a:65536", "got `65536`"),
            ("tcpout:a:", "port of 0 to 65535"),
            ("serial:/dev/ttyACM0", "baud"),
            ("serial:/dev/ttyACM0:0", "got `0`"),
            ("serial::57600", "serial:PATH:BAUD"),
            ("pty:", "pty:PATH"),
            ("/dev/ttyUSB0", "`serial:/dev/ttyUSB0:57600`, got"),
            ("/dev/ttyUSB0:115200", "`serial:/dev/ttyUSB0:115200`, got `/dev/ttyUSB0:115200`"),
            ("COM3", "`serial:COM3:57600`"),
            ("computer:14550", "udpin:HOST:PORT"),
        ] {
            let error = text.parse::<Address>().unwrap_err().to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
