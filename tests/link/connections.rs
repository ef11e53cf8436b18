//! Links over loopback: frames, events, peers, losses.

use crate::support;

use std::net::SocketAddr;
use std::time::Duration;

use mavid::link::{Address, Link, LinkError, LinkEvent, LinkOptions, LinkReader, Received, ReceivedFrame};
use mavid::wire::{ComponentId, SystemId};
use mavlink::dialects::ardupilotmega::MavMessage;
use support::{Needed, ground_heartbeat, header, heartbeat, unknown, v1, v2};
use tokio::io::AsyncWriteExt;
use tokio::net::{TcpListener, UdpSocket};
use tokio::time::timeout;

const LONG: Duration = Duration::from_secs(20);

fn vehicle() -> LinkOptions {
    LinkOptions { system: SystemId(1), component: ComponentId(1), ..LinkOptions::default() }
}

async fn receive(reader: &mut LinkReader) -> Received {
    timeout(LONG, reader.receive()).await.unwrap().unwrap()
}

async fn frame(reader: &mut LinkReader) -> ReceivedFrame {
    loop {
        if let Received::Frame(frame) = receive(reader).await {
            return frame;
        }
    }
}

async fn event(reader: &mut LinkReader) -> LinkEvent {
    loop {
        if let Received::Event(event) = receive(reader).await {
            return event;
        }
    }
}

/// A port that nothing uses now.
fn free_port(host: &str) -> u16 {
    std::net::UdpSocket::bind((host, 0)).unwrap().local_addr().unwrap().port()
}

async fn both_ways(host: &str) {
    let bare = host.trim_matches(['[', ']']);
    let port = free_port(bare);
    let address = |kind: &str| format!("{kind}:{host}:{port}").parse::<Address>().unwrap();
    let (mut sitl, sitl_out) = Link::open(&address("udpin"), vehicle()).await.unwrap();
    assert!(matches!(sitl_out.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
    let (mut ground, ground_out) = Link::open(&address("udpout"), LinkOptions::default()).await.unwrap();
    assert!(matches!(event(&mut ground).await, LinkEvent::Connected { .. }));
    for _ in 0..3 {
        ground_out.send_message(&ground_heartbeat()).unwrap();
    }
    let first = frame(&mut sitl).await;
    assert_eq!((first.header.system, first.header.component), (SystemId(255), ComponentId(190)));
    assert_eq!(first.message().unwrap(), ground_heartbeat());
    assert_eq!(frame(&mut sitl).await.header.sequence, 1);
    let strange = unknown(9, b"payload");
    sitl_out.send(&strange).unwrap();
    sitl_out.send_message(&heartbeat()).unwrap();
    assert_eq!(frame(&mut ground).await.bytes(), strange);
    assert_eq!(frame(&mut ground).await.message().unwrap(), heartbeat());
    sitl_out.flush().await.unwrap();
    let stats = sitl_out.stats();
    assert_eq!((stats.sent_frames, stats.received_frames, stats.lost()), (2, 3, 0));
}

#[tokio::test]
async fn udp_carries_frames_both_ways() {
    both_ways("127.0.0.1").await;
}

#[tokio::test]
async fn udp_carries_frames_over_ipv6() {
    if std::net::UdpSocket::bind("[::1]:0").is_err() {
        return support::skip(Needed::Ipv6, "no socket could be bound to [::1]");
    }
    both_ways("[::1]").await;
}

#[tokio::test]
async fn a_waiting_link_answers_only_the_first_that_sent_a_heartbeat() {
    let port = free_port("127.0.0.1");
    let target: SocketAddr = ([127, 0, 0, 1], port).into();
    let address = format!("udpin:127.0.0.1:{port}").parse().unwrap();
    let options = LinkOptions { peer_timeout: Duration::from_millis(300), ..LinkOptions::default() };
    let (mut reader, writer) = Link::open(&address, options).await.unwrap();
    let bind = || UdpSocket::bind("127.0.0.1:0");
    let (mute, peer, stranger) = (bind().await.unwrap(), bind().await.unwrap(), bind().await.unwrap());
    // without a heartbeat nobody is answered
    mute.send_to(&unknown(0, b"x"), target).await.unwrap();
    frame(&mut reader).await;
    assert!(!writer.is_connected());
    peer.send_to(&v2(header(1, 0), &heartbeat()), target).await.unwrap();
    let name = peer.local_addr().unwrap().to_string();
    assert_eq!(event(&mut reader).await, LinkEvent::Connected { peer: name });
    stranger.send_to(&v2(header(1, 1), &heartbeat()), target).await.unwrap();
    let name = stranger.local_addr().unwrap().to_string();
    assert_eq!(event(&mut reader).await, LinkEvent::Stranger { peer: name.clone() });
    writer.send_message(&ground_heartbeat()).unwrap();
    let mut buffer = [0; 300];
    let bytes = timeout(LONG, peer.recv(&mut buffer)).await.unwrap().unwrap();
    assert_eq!(bytes, v2(header(255, 0), &ground_heartbeat()).len());
    assert!(stranger.try_recv(&mut buffer).is_err());
    assert_eq!(reader.stats().stranger_datagrams, 1);
    // silent: the next that sends a heartbeat is the peer
    assert!(matches!(event(&mut reader).await, LinkEvent::Lost { .. }));
    assert!(matches!(writer.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
    stranger.send_to(&v2(header(1, 2), &heartbeat()), target).await.unwrap();
    assert_eq!(event(&mut reader).await, LinkEvent::Restored { peer: name });
}

/// A flight streams setpoints for 5 s into a silence: the downlink alone may be lost.
#[tokio::test]
async fn a_silent_peer_is_still_sent_to_for_more_than_five_seconds() {
    let port = free_port("127.0.0.1");
    let address = format!("udpin:127.0.0.1:{port}").parse().unwrap();
    let (mut reader, writer) = Link::open(&address, LinkOptions::default()).await.unwrap();
    let peer = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    peer.set_read_timeout(Some(LONG)).unwrap();
    peer.send_to(&v2(header(1, 0), &heartbeat()), ("127.0.0.1", port)).unwrap();
    assert!(matches!(event(&mut reader).await, LinkEvent::Connected { .. }));
    tokio::time::pause();
    let mut buffer = [0; 300];
    for step in 0..60 {
        // the queue and the slot, a setpoint's way
        writer.send_message(&ground_heartbeat()).unwrap_or_else(|error| panic!("{step}: {error}"));
        writer.flush().await.unwrap();
        writer.send_latest(&ground_heartbeat()).unwrap();
        writer.flush().await.unwrap();
        for _ in 0..2 {
            peer.recv(&mut buffer).unwrap();
        }
        tokio::time::sleep(Duration::from_millis(100)).await;
    }
    assert_eq!(reader.stats().losses, 0);
    assert!(matches!(event(&mut reader).await, LinkEvent::Lost { .. }));
    assert!(matches!(writer.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
}

#[tokio::test]
async fn a_refusing_udp_peer_is_told_once_and_restored_by_its_answer() {
    let port = free_port("127.0.0.1");
    let address = format!("udpout:127.0.0.1:{port}").parse().unwrap();
    let (mut reader, writer) = Link::open(&address, LinkOptions::default()).await.unwrap();
    assert!(matches!(event(&mut reader).await, LinkEvent::Connected { .. }));
    writer.send_message(&heartbeat()).unwrap();
    let LinkEvent::Lost { why } = event(&mut reader).await else { panic!("no loss") };
    assert!(why.contains("nothing listens"), "{why}");
    for _ in 0..20 {
        writer.send_message(&heartbeat()).unwrap();
        writer.flush().await.unwrap();
    }
    let peer = UdpSocket::bind(("127.0.0.1", port)).await.unwrap();
    writer.send_message(&heartbeat()).unwrap();
    let mut buffer = [0; 300];
    let (_, from) = timeout(LONG, peer.recv_from(&mut buffer)).await.unwrap().unwrap();
    peer.send_to(&v2(header(1, 0), &heartbeat()), from).await.unwrap();
    assert!(matches!(event(&mut reader).await, LinkEvent::Restored { .. }));
    assert_eq!(reader.stats().losses, 1);
}

#[tokio::test]
async fn tcp_connects_again_and_a_server_takes_the_next_client() {
    let port = TcpListener::bind("127.0.0.1:0").await.unwrap().local_addr().unwrap().port();
    let address = |kind: &str| format!("{kind}:127.0.0.1:{port}").parse::<Address>().unwrap();
    let missing = Link::open(&address("tcpout"), LinkOptions::default()).await.unwrap_err().to_string();
    assert!(missing.contains(&format!("tcpout:127.0.0.1:{port}")), "{missing}");
    let (mut server, server_out) = Link::open(&address("tcpin"), vehicle()).await.unwrap();
    for turn in 0..2_u8 {
        let (mut client, client_out) = Link::open(&address("tcpout"), LinkOptions::default()).await.unwrap();
        let connected = event(&mut server).await;
        assert_eq!(matches!(connected, LinkEvent::Connected { .. }), turn == 0, "{connected:?}");
        client_out.send_message(&ground_heartbeat()).unwrap();
        assert_eq!(frame(&mut server).await.message().unwrap(), ground_heartbeat());
        server_out.send_message(&heartbeat()).unwrap();
        assert_eq!(frame(&mut client).await.header.sequence, turn);
        drop((client, client_out));
        assert!(matches!(event(&mut server).await, LinkEvent::Lost { .. }));
    }
    let (mut client, _client_out) = Link::open(&address("tcpout"), LinkOptions::default()).await.unwrap();
    assert!(matches!(event(&mut client).await, LinkEvent::Connected { .. }));
    assert!(matches!(event(&mut server).await, LinkEvent::Restored { .. }));
    drop((server, server_out));
    assert!(matches!(event(&mut client).await, LinkEvent::Lost { .. }));
    let (_server, _server_out) = Link::open(&address("tcpin"), vehicle()).await.unwrap();
    assert!(matches!(event(&mut client).await, LinkEvent::Restored { .. }));
}

#[tokio::test]
async fn a_patient_client_waits_for_its_server() {
    let port = TcpListener::bind("127.0.0.1:0").await.unwrap().local_addr().unwrap().port();
    let address = |kind: &str| format!("{kind}:127.0.0.1:{port}").parse::<Address>().unwrap();
    let patient = LinkOptions { patient: true, ..LinkOptions::default() };
    let (mut client, _client_out) = Link::open(&address("tcpout"), patient.clone()).await.unwrap();
    assert!(!client.is_connected());
    let (mut server, _server_out) = Link::open(&address("tcpin"), vehicle()).await.unwrap();
    assert!(matches!(event(&mut client).await, LinkEvent::Connected { .. }));
    assert!(matches!(event(&mut server).await, LinkEvent::Connected { .. }));
    let unknown = "tcpout:no host:5760".parse::<Address>().unwrap();
    assert!(Link::open(&unknown, patient).await.is_err());
}

#[tokio::test(start_paused = true)]
async fn of_setpoints_only_the_latest_waits() {
    let ((mut first, first_out), (second, second_out)) = Link::pair(vehicle(), LinkOptions::default());
    drop((second, second_out));
    assert!(matches!(event(&mut first).await, LinkEvent::Connected { .. }));
    assert!(matches!(event(&mut first).await, LinkEvent::Lost { .. }));
    assert!(matches!(first.receive().await, Err(LinkError::Closed)));
    assert!(matches!(first_out.send_latest(&heartbeat()), Err(LinkError::Closed)));
    assert!(matches!(first_out.send(&[1, 2, 3]), Err(LinkError::NotAFrame { bytes: 3 })));

    let ((mut first, first_out), (mut second, second_out)) = Link::pair(vehicle(), LinkOptions::default());
    assert!(matches!(event(&mut second).await, LinkEvent::Connected { .. }));
    for _ in 0..5 {
        second_out.send_latest(&ground_heartbeat()).unwrap();
    }
    second_out.send_latest(&heartbeat()).unwrap();
    second_out.flush().await.unwrap();
    // no sequence number is spent on what was replaced
    let only = frame(&mut first).await;
    assert_eq!((only.message().unwrap(), only.header.sequence), (heartbeat(), 0));
    assert_eq!((second_out.stats().replaced, second_out.stats().sent_frames), (5, 1));
    drop(first_out);
}

/// What is sent past the queue keeps its place among what goes through it.
#[tokio::test(flavor = "multi_thread", worker_threads = 2)]
async fn over_udp_the_latest_is_sent_at_once_and_in_order() {
    let port = free_port("127.0.0.1");
    let address = |kind: &str| format!("{kind}:127.0.0.1:{port}").parse::<Address>().unwrap();
    let (mut sitl, sitl_out) = Link::open(&address("udpin"), vehicle()).await.unwrap();
    let (mut ground, ground_out) = Link::open(&address("udpout"), LinkOptions::default()).await.unwrap();
    // both know each other
    ground_out.send_message(&ground_heartbeat()).unwrap();
    frame(&mut sitl).await;
    // the frame is given out first, then the writer is open
    while !sitl_out.is_connected() {
        tokio::task::yield_now().await;
    }
    sitl_out.send_message(&heartbeat()).unwrap();
    frame(&mut ground).await;
    for (out, reader) in [(&ground_out, &mut sitl), (&sitl_out, &mut ground)] {
        for turn in 0..50 {
            out.send_latest(&heartbeat()).unwrap();
            if turn % 3 == 0 {
                out.send_message(&ground_heartbeat()).unwrap();
            }
        }
        out.flush().await.unwrap();
        let sent = out.stats().sent_frames;
        assert_eq!(sent + out.stats().replaced, 1 + 50 + 17);
        for sequence in 1..sent {
            let frame = frame(reader).await;
            assert_eq!(u64::from(frame.header.sequence), sequence);
        }
        assert_eq!(reader.stats().lost(), 0);
    }
}

/// Frames of MAVLink 1 and of unknown messages come through, a frame inside a payload does not.
#[tokio::test]
async fn every_whole_frame_comes_through_and_none_from_within_a_payload() {
    let port = free_port("127.0.0.1");
    let address = format!("udpin:127.0.0.1:{port}").parse().unwrap();
    let (mut reader, _writer) = Link::open(&address, LinkOptions::default()).await.unwrap();
    let peer = UdpSocket::bind("127.0.0.1:0").await.unwrap();
    let radio = MavMessage::RADIO_STATUS(Default::default());
    let frames = [
        v2(header(1, 0), &heartbeat()),
        v1(header(51, 0), &radio),
        unknown(1, &v2(header(1, 77), &ground_heartbeat())),
        v2(header(1, 2), &heartbeat()),
    ];
    // one datagram each, then all in one
    for datagram in frames.iter().cloned().chain([frames.concat()]) {
        peer.send_to(&datagram, ("127.0.0.1", port)).await.unwrap();
    }
    for expected in frames.iter().chain(&frames) {
        assert_eq!(frame(&mut reader).await.bytes(), expected);
    }
    let stats = reader.stats();
    assert_eq!((stats.received_frames, stats.unknown, stats.skipped_bytes), (8, 2, 0));
}

#[tokio::test]
async fn losses_and_noise_are_counted() {
    let listener = TcpListener::bind("127.0.0.1:0").await.unwrap();
    let address = format!("tcpout:{}", listener.local_addr().unwrap()).parse().unwrap();
    let (mut reader, _writer) = Link::open(&address, LinkOptions::default()).await.unwrap();
    let (mut line, _) = listener.accept().await.unwrap();
    let good = |sequence| v2(header(9, sequence), &heartbeat());
    let mut broken = good(9);
    broken[12] ^= 1;
    let bytes = [good(0), good(1), good(7), vec![1, 2, 3], good(8), broken, good(10), vec![0; 4], good(11)];
    line.write_all(&bytes.concat()).await.unwrap();
    for sequence in [0, 1, 7, 8, 10, 11] {
        assert_eq!(frame(&mut reader).await.header.sequence, sequence);
    }
    let stats = reader.stats();
    assert_eq!(stats.senders[&(SystemId(9), ComponentId(1))].lost, 6);
    assert_eq!((stats.received_frames, stats.bad_crc, stats.lost()), (6, 1, 6));
    assert_eq!(stats.received_bytes, bytes.concat().len() as u64);
    assert_eq!(stats.skipped_bytes, 3 + 4 + good(9).len() as u64);
    assert_eq!(stats.resyncs, 1, "all of it came in one piece");
}

/// A burst that fits into the system's smallest buffers is not lost, whoever is scheduled first.
#[tokio::test]
async fn a_burst_is_taken_whole() {
    let port = free_port("127.0.0.1");
    let address = format!("udpin:127.0.0.1:{port}").parse().unwrap();
    let (mut reader, _writer) = Link::open(&address, LinkOptions::default()).await.unwrap();
    let peer = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    for sequence in 0..200 {
        peer.send_to(&v2(header(1, sequence), &heartbeat()), ("127.0.0.1", port)).unwrap();
    }
    for sequence in 0..200 {
        assert_eq!(frame(&mut reader).await.header.sequence, sequence);
    }
    assert_eq!(reader.stats().lost(), 0);
}
