//! Links over a network that loses, delays, reorders and doubles.

use crate::lossy;
use crate::support;

use std::sync::atomic::Ordering;
use std::time::Duration;

use lossy::{Faults, LossyProxy};
use mavid::link::{Link, LinkEvent, LinkOptions, LinkReader, Received};
use mavid::wire::{ComponentId, SystemId};
use support::{ground_heartbeat, header, heartbeat, v2};
use tokio::time::timeout;

const LONG: Duration = Duration::from_secs(20);

async fn receive(reader: &mut LinkReader) -> Received {
    timeout(LONG, reader.receive()).await.unwrap().unwrap()
}

/// Both ends of a link through the proxy, connected.
async fn through(faults: Faults) -> (LossyProxy, mavid::link::Ends, mavid::link::Ends) {
    let options = LinkOptions { peer_timeout: Duration::from_millis(500), ..LinkOptions::default() };
    let mut ground = Link::open(&"udpin:127.0.0.1:0".parse().unwrap(), options).await.unwrap();
    let target = ground.0.local_address().unwrap();
    let proxy = LossyProxy::start(0, target, faults).await;
    let vehicle = LinkOptions { system: SystemId(1), component: ComponentId(1), ..LinkOptions::default() };
    let vehicle = Link::open(&format!("udpout:{}", proxy.address).parse().unwrap(), vehicle).await.unwrap();
    loop {
        vehicle.1.send_message(&heartbeat()).unwrap();
        let wait = timeout(Duration::from_millis(50), ground.0.receive()).await;
        if matches!(wait, Ok(Ok(Received::Event(LinkEvent::Connected { .. })))) {
            return (proxy, ground, vehicle);
        }
    }
}

#[tokio::test]
async fn losses_by_the_sequence_are_those_of_the_network() {
    let faults = Faults { seed: 5, loss: 0.2, ..Faults::default() };
    let (proxy, (mut ground, _out), (_in, vehicle)) = through(faults).await;
    for _ in 0..200 {
        vehicle.send_message(&heartbeat()).unwrap();
        vehicle.flush().await.unwrap();
    }
    let lost = || proxy.tally.lost.load(Ordering::SeqCst);
    while ground.stats().received_frames + lost() < vehicle.stats().sent_frames {
        receive(&mut ground).await;
    }
    let (lost, stats) = (lost(), ground.stats());
    assert!((20..70).contains(&lost), "{lost}");
    assert_eq!(stats.received_frames, vehicle.stats().sent_frames - lost);
    assert!(stats.lost() <= lost, "the last frames may be lost unseen");
    assert!(stats.lost() + 8 > lost, "{} {lost}", stats.lost());
}

#[tokio::test]
async fn a_late_frame_is_not_counted_as_lost() {
    let faults = Faults {
        seed: 9,
        duplicate: 0.1,
        reorder: 0.2,
        held: Duration::from_millis(20),
        delay: Duration::from_millis(2),
        ..Faults::default()
    };
    let (proxy, (mut ground, _out), (_in, vehicle)) = through(faults).await;
    for _ in 0..100 {
        vehicle.send_message(&heartbeat()).unwrap();
        tokio::time::sleep(Duration::from_millis(4)).await;
    }
    let tally = &proxy.tally;
    let expected = || vehicle.stats().sent_frames + tally.doubled.load(Ordering::SeqCst);
    while ground.stats().received_frames < expected() {
        receive(&mut ground).await;
    }
    assert!(tally.held.load(Ordering::SeqCst) > 5 && tally.doubled.load(Ordering::SeqCst) > 3);
    assert_eq!(ground.stats().lost(), 0);
}

#[tokio::test]
async fn a_cut_line_is_lost_and_restored() {
    let (proxy, (mut ground, out), (_in, vehicle)) = through(Faults::default()).await;
    out.send_message(&ground_heartbeat()).unwrap();
    proxy.cut(true);
    loop {
        match receive(&mut ground).await {
            Received::Event(LinkEvent::Lost { .. }) => break,
            other => assert!(matches!(other, Received::Frame(_)), "{other:?}"),
        }
    }
    proxy.cut(false);
    vehicle.send(&v2(header(1, 77), &heartbeat())).unwrap();
    loop {
        if let Received::Event(event) = receive(&mut ground).await {
            assert!(matches!(event, LinkEvent::Restored { .. }), "{event:?}");
            break;
        }
    }
}
