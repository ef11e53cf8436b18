//! Signed links, with each other and with pymavlink.

use crate::python;
use crate::support;

use std::time::{Duration, SystemTime, UNIX_EPOCH};

use mavid::link::{
    Distrust, Ends, Link, LinkError, LinkEvent, LinkOptions, LinkReader, Received, ReceivedFrame, Signing,
    SigningKey,
};
use mavlink::dialects::ardupilotmega::MavMessage;
use serde_json::json;
use support::{Needed, header, heartbeat, unknown, v1, v2};
use tokio::time::timeout;

const KEY: [u8; 32] = [7; 32];

fn options(key: Option<[u8; 32]>) -> LinkOptions {
    let signing = key.map(|key| Signing::with_key(SigningKey::from_bytes(key)));
    LinkOptions { signing, ..LinkOptions::default() }
}

async fn frame(reader: &mut LinkReader) -> ReceivedFrame {
    loop {
        let received = timeout(Duration::from_secs(20), reader.receive()).await.unwrap().unwrap();
        if let Received::Frame(frame) = received {
            return frame;
        }
    }
}

async fn event(reader: &mut LinkReader) -> LinkEvent {
    loop {
        let received = timeout(Duration::from_secs(20), reader.receive()).await.unwrap().unwrap();
        if let Received::Event(event) = received {
            return event;
        }
    }
}

/// A pair that is connected.
async fn pair(first: LinkOptions, second: LinkOptions) -> (Ends, Ends) {
    let (mut one, mut two) = Link::pair(first, second);
    for reader in [&mut one.0, &mut two.0] {
        assert!(matches!(reader.receive().await.unwrap(), Received::Event(_)));
    }
    (one, two)
}

#[tokio::test]
async fn only_what_is_signed_with_the_key_is_delivered() {
    let ((mut reader, _out), (_in, writer)) = pair(options(Some(KEY)), options(Some(KEY))).await;
    let forged = v2(header(1, 0), &heartbeat());
    let radio = v1(header(51, 0), &MavMessage::RADIO_STATUS(Default::default()));
    for bytes in [&forged, &radio, &unknown(5, b"unsigned")] {
        writer.send(bytes).unwrap();
    }
    writer.send_message(&heartbeat()).unwrap();
    assert_eq!(frame(&mut reader).await.bytes(), radio);
    let signed = frame(&mut reader).await;
    assert!(signed.header.is_signed());
    assert_eq!(signed.message().unwrap(), heartbeat());
    // the same again, and changed on the way
    writer.send(signed.bytes()).unwrap();
    let mut changed = signed.bytes().to_vec();
    *changed.last_mut().unwrap() ^= 1;
    writer.send(&changed).unwrap();
    writer.send_message(&heartbeat()).unwrap();
    assert_eq!(frame(&mut reader).await.header.sequence, 1);
    let stats = reader.stats();
    assert_eq!((stats.unsigned, stats.replayed, stats.badly_signed), (2, 1, 1));
    assert_eq!(stats.received_frames, 7);
}

#[tokio::test]
async fn without_a_key_signed_frames_pass_unchecked_which_is_told() {
    let ((mut reader, _out), (_in, writer)) = pair(options(None), options(Some(KEY))).await;
    writer.send_message(&heartbeat()).unwrap();
    assert!(matches!(event(&mut reader).await, LinkEvent::Unchecked { .. }));
    assert!(frame(&mut reader).await.header.is_signed());
}

/// Where the vehicle has no key, or another, nothing is sent to it: not even a heartbeat finds a way before the vehicle has
/// shown that it has the key.
#[tokio::test]
async fn a_waiting_link_speaks_to_nobody_who_has_not_shown_that_he_has_the_key() {
    let address = "udpin:127.0.0.1:0".parse().unwrap();
    let (mut reader, writer) = Link::open(&address, options(Some(KEY))).await.unwrap();
    let port = reader.local_address().unwrap().port();
    let vehicle = std::net::UdpSocket::bind("127.0.0.1:0").unwrap();
    let send = |bytes: &[u8]| vehicle.send_to(bytes, ("127.0.0.1", port)).unwrap();
    send(&v2(header(1, 0), &heartbeat()));
    let LinkEvent::Distrusted { why: Distrust::Unsigned, .. } = event(&mut reader).await else { panic!() };
    send(&v1(header(1, 1), &heartbeat()));
    let LinkEvent::Distrusted { why: Distrust::Downgraded, .. } = event(&mut reader).await else { panic!() };
    send(&signed_with([8; 32]).await);
    let LinkEvent::Distrusted { why: Distrust::Wrong, .. } = event(&mut reader).await else { panic!() };
    assert!(matches!(writer.send_message(&heartbeat()), Err(LinkError::NotConnected { .. })));
    send(&signed_with(KEY).await);
    assert!(matches!(event(&mut reader).await, LinkEvent::Trusted { .. }));
    assert!(matches!(event(&mut reader).await, LinkEvent::Connected { .. }));
    let stats = reader.stats();
    assert_eq!((stats.unsigned, stats.downgraded, stats.badly_signed, stats.sent_frames), (2, 1, 1, 0));
}

/// A HEARTBEAT signed now.
async fn signed_with(key: [u8; 32]) -> Vec<u8> {
    let ((mut raw, _out), (_in, writer)) = pair(options(None), options(Some(key))).await;
    writer.send_message(&heartbeat()).unwrap();
    frame(&mut raw).await.bytes().to_vec()
}

/// The times of a key are nobody else's business, whatever the umask and whatever was there before.
#[cfg(unix)]
#[test]
fn the_times_of_a_key_are_for_their_owner_alone() {
    use std::os::unix::fs::{MetadataExt, PermissionsExt};
    let folder = std::env::temp_dir().join(format!("mavid-times-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (key, times) = (folder.join("key"), folder.join("key.times"));
    std::fs::write(&key, "a passphrase\n").unwrap();
    for mode in [0o600, 0o644] {
        std::fs::set_permissions(&key, std::fs::Permissions::from_mode(mode)).unwrap();
        let signing = Signing::open(&key).unwrap();
        assert_eq!(std::fs::metadata(&times).unwrap().mode() & 0o777, 0o600);
        let warned = signing.warnings().iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
        assert_eq!(warned.contains("read by others (mode 644, expected 600)"), mode == 0o644, "{warned}");
        // of the times that the first of these left open
        assert_eq!(
            warned.contains("could be read and written by others (mode 666"),
            mode == 0o644,
            "{warned}"
        );
        drop(signing);
        assert_eq!(std::fs::metadata(&times).unwrap().mode() & 0o777, 0o600);
        // as an earlier version left it
        std::fs::set_permissions(&times, std::fs::Permissions::from_mode(0o666)).unwrap();
    }
    std::fs::remove_dir_all(&folder).unwrap();
}

/// Whoever gives the key by another name is known by what was heard by the first.
#[cfg(unix)]
#[test]
fn a_key_behind_a_symbolic_link_has_the_times_of_the_key() {
    let folder = std::env::temp_dir().join(format!("mavid-key-link-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let (key, link) = (folder.join("key"), folder.join("link"));
    std::fs::write(&key, "a passphrase\n").unwrap();
    std::os::unix::fs::symlink("key", &link).unwrap();
    drop(Signing::open(&link).unwrap());
    assert!(folder.join("key.times").is_file() && !folder.join("link.times").exists());
    std::fs::remove_dir_all(&folder).unwrap();
}

#[tokio::test]
async fn pymavlink_takes_our_signatures_and_we_take_its() {
    let ((mut raw, _out), (_in, writer)) = pair(options(None), options(Some(KEY))).await;
    let mut frames = Vec::new();
    for _ in 0..3 {
        writer.send_message(&heartbeat()).unwrap();
        frames.push(frame(&mut raw).await.bytes().to_vec());
    }
    // once more the same, and one with a changed signature
    frames.push(frames[2].clone());
    writer.send_message(&heartbeat()).unwrap();
    frames.push(frame(&mut raw).await.bytes().to_vec());
    *frames[4].last_mut().unwrap() ^= 1;
    let since_2015 =
        SystemTime::now().duration_since(UNIX_EPOCH).unwrap().as_micros() - 1_420_070_400_000_000;
    let hex = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let given = json!({
        "key": hex(&KEY),
        "time": u64::try_from(since_2015 / 10).unwrap(),
        "frames": frames.iter().map(|frame| hex(frame)).collect::<Vec<_>>(),
    });
    let answer = match python::ask("signing_with_pymavlink.py", &[], &given) {
        Ok(answer) => answer,
        Err(missing) => return support::skip(Needed::Peers, &missing),
    };
    assert_eq!(answer["accepted"], json!([true, true, true, false, false]));
    let ((mut reader, _out), (_in, bare)) = pair(options(Some(KEY)), options(None)).await;
    for (sequence, signed) in (0_u8..).zip(answer["frames"].as_array().unwrap()) {
        let text = signed.as_str().unwrap();
        let bytes: Vec<u8> =
            (0..text.len()).step_by(2).map(|at| u8::from_str_radix(&text[at..at + 2], 16).unwrap()).collect();
        bare.send(&bytes).unwrap();
        assert_eq!(frame(&mut reader).await.header.sequence, sequence);
    }
    assert_eq!(reader.stats().badly_signed + reader.stats().replayed, 0);
}
