//! Help on the addresses of links.

/// The forms of an address.
macro_rules! address_forms {
    () => {
        "udpin:HOST:PORT (waits for the other end), udpout:HOST:PORT, tcpin:HOST:PORT (waits), tcpout:HOST:PORT, \
         serial:PATH:BAUD (8 data bits, no parity), serial:PATH:BAUD:rtscts (with hardware flow control), or pty:PATH (makes \
         a pseudo-terminal that the other end opens as its serial port PATH). udp: is udpin:, and tcp: is tcpout:"
    };
}

/// Help of an address.
pub(super) const ADDRESS: &str = address_forms!();
/// Help of several.
pub(super) const LISTEN: &str = concat!(
    "a link: ",
    address_forms!(),
    "; may be given several times [default: those of the autopilot's own simulator]"
);
