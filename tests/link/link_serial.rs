//! Links over serial ports, against pseudo-terminals.

use crate::support;

use std::path::PathBuf;
use std::time::Duration;

use mavid::link::{Address, Link, LinkError, LinkEvent, LinkOptions, LinkReader, Received, ReceivedFrame};
use mavid::wire::{ComponentId, SystemId};
use support::{ground_heartbeat, heartbeat, unknown};
use tokio::time::timeout;

const LONG: Duration = Duration::from_secs(20);

fn vehicle() -> LinkOptions {
    LinkOptions { system: SystemId(1), component: ComponentId(1), ..LinkOptions::default() }
}

async fn frame(reader: &mut LinkReader) -> ReceivedFrame {
    loop {
        if let Received::Frame(frame) = timeout(LONG, reader.receive()).await.unwrap().unwrap() {
            return frame;
        }
    }
}

async fn event(reader: &mut LinkReader) -> LinkEvent {
    loop {
        if let Received::Event(event) = timeout(LONG, reader.receive()).await.unwrap().unwrap() {
            return event;
        }
    }
}

fn name(what: &str) -> PathBuf {
    std::env::temp_dir().join(format!("mavid-{what}-{}", std::process::id()))
}

#[tokio::test]
async fn a_serial_port_carries_frames_and_comes_back_after_a_hang_up() {
    let path = name("pty");
    let pty: Address = format!("pty:{}", path.display()).parse().unwrap();
    let port: Address = format!("serial:{}:57600", path.display()).parse().unwrap();
    let missing = Link::open(&port, LinkOptions::default()).await.unwrap_err();
    assert!(missing.to_string().contains(&port.to_string()), "{missing}");
    let (mut sitl, sitl_out) = Link::open(&pty, vehicle()).await.unwrap();
    assert!(matches!(sitl_out.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
    let (mut ground, ground_out) = Link::open(&port, LinkOptions::default()).await.unwrap();
    assert!(matches!(event(&mut sitl).await, LinkEvent::Connected { .. }));
    // every byte value passes: the terminal changes none
    let all: Vec<u8> = (0..=254).collect();
    let strange = unknown(3, &all);
    sitl_out.send(&strange).unwrap();
    sitl_out.send_message(&heartbeat()).unwrap();
    assert_eq!(frame(&mut ground).await.bytes(), strange);
    assert_eq!(frame(&mut ground).await.message().unwrap(), heartbeat());
    ground_out.send_latest(&ground_heartbeat()).unwrap();
    assert_eq!(frame(&mut sitl).await.message().unwrap(), ground_heartbeat());
    // the ground station leaves and comes back
    drop((ground, ground_out));
    assert!(matches!(event(&mut sitl).await, LinkEvent::Lost { .. }));
    let (mut ground, ground_out) = Link::open(&port, LinkOptions::default()).await.unwrap();
    assert!(matches!(event(&mut sitl).await, LinkEvent::Restored { .. }));
    // the vehicle leaves and comes back
    drop((sitl, sitl_out));
    assert!(matches!(event(&mut ground).await, LinkEvent::Connected { .. }));
    assert!(matches!(event(&mut ground).await, LinkEvent::Lost { .. }));
    assert!(matches!(ground_out.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
    let (mut sitl, _sitl_out) = Link::open(&pty, vehicle()).await.unwrap();
    assert!(matches!(event(&mut ground).await, LinkEvent::Restored { .. }));
    ground_out.send_message(&ground_heartbeat()).unwrap();
    assert_eq!(frame(&mut sitl).await.message().unwrap(), ground_heartbeat());
}

#[tokio::test]
async fn a_pseudo_terminal_replaces_no_file() {
    let path = name("file");
    std::fs::write(&path, "precious").unwrap();
    let address: Address = format!("pty:{}", path.display()).parse().unwrap();
    assert!(matches!(Link::open(&address, vehicle()).await, Err(LinkError::Open { .. })));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "precious");
    std::fs::remove_file(&path).unwrap();
}
