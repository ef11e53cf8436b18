//! What a link records, and what a bad disk does to it.

use crate::support;

use std::io::{self, Write};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::time::Duration;

use mavid::link::{
    Ends, HostClock, Link, LinkEvent, LinkOptions, LinkReader, Received, RecordError, Recorder, Signing,
    SigningKey, Store,
};
use mavlink::dialects::ardupilotmega::MavMessage;
use support::{frames, header, heartbeat, read, unknown, v1, v2};
use tokio::time::timeout;

/// A disk in memory that can be stopped and broken.
struct Disk {
    bytes: Arc<Mutex<Vec<u8>>>,
    /// each write takes one; all are free when the other end is gone
    tickets: mpsc::Receiver<()>,
    full: Arc<AtomicBool>,
}

impl Write for Disk {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let _ = self.tickets.recv();
        if self.full.load(Ordering::SeqCst) {
            return Err(io::Error::new(io::ErrorKind::StorageFull, "the disk is full"));
        }
        self.bytes.lock().unwrap().extend_from_slice(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Store for Disk {
    fn sync(&mut self) -> io::Result<()> {
        Ok(())
    }
}

fn file(what: &str) -> PathBuf {
    std::env::temp_dir().join(format!("mavid-{what}-{}.tlog", std::process::id()))
}

/// A recorded link and a bare one at its other end, connected.
async fn pair(recorder: &Recorder, signing: Option<Signing>) -> (Ends, Ends) {
    let options = LinkOptions { recorder: Some(recorder.clone()), signing, ..LinkOptions::default() };
    let (mut one, mut two) = Link::pair(options, LinkOptions::default());
    for reader in [&mut one.0, &mut two.0] {
        receive(reader).await;
    }
    (one, two)
}

async fn receive(reader: &mut LinkReader) -> Received {
    timeout(Duration::from_secs(20), reader.receive()).await.unwrap().unwrap()
}

/// The next frame; what the link says of itself before it is left out.
async fn frame_of(reader: &mut LinkReader) -> mavid::link::ReceivedFrame {
    loop {
        if let Received::Frame(frame) = receive(reader).await {
            return frame;
        }
    }
}

#[tokio::test]
async fn every_frame_is_recorded_to_the_byte_but_no_key_and_no_noise() {
    let path = file("recorded");
    let recorder = Recorder::create(&path, true).unwrap();
    let signing = Signing::with_key(SigningKey::from_bytes([1; 32]));
    let before_us = HostClock::start().now().utc_us;
    let ((mut reader, writer), (mut other, sender)) = pair(&recorder, Some(signing)).await;
    let mut wrongly_signed = v2(header(1, 1), &heartbeat());
    wrongly_signed[2] = 1;
    let checksum = mavlink::calculate_crc(&wrongly_signed[1..wrongly_signed.len() - 2], 50);
    let end = wrongly_signed.len() - 2;
    wrongly_signed[end..].copy_from_slice(&checksum.to_le_bytes());
    wrongly_signed.extend_from_slice(&[9; 13]);
    let radio = v1(header(51, 0), &MavMessage::RADIO_STATUS(Default::default()));
    let key = MavMessage::SETUP_SIGNING(Default::default());
    let arrived = [
        v2(header(1, 0), &heartbeat()),
        wrongly_signed,
        unknown(2, &[0xFD; 40]),
        v2(header(9, 1), &key),
        radio,
    ];
    for bytes in &arrived {
        sender.send(bytes).unwrap();
    }
    // only the radio's report is believed; who else speaks is told
    let radio = loop {
        if let Received::Frame(radio) = receive(&mut reader).await {
            break radio;
        }
    };
    assert_eq!(radio.bytes(), arrived[4]);
    writer.send_message(&key).unwrap();
    writer.send_message(&heartbeat()).unwrap();
    let (key_sent, beat) = (frame_of(&mut other).await, frame_of(&mut other).await);
    assert_eq!(key_sent.header.message_id, 256);
    writer.flush().await.unwrap();
    let status = recorder.finish().await.unwrap();
    assert_eq!((status.frames, status.redacted, status.dropped, status.failure), (5, 2, 0, None));
    let (records, report) = read(&std::fs::read(&path).unwrap());
    let mut expected = arrived.to_vec();
    expected.remove(3);
    expected.push(beat.bytes().to_vec());
    assert_eq!(frames(&records), expected);
    assert!(report.is_undamaged() || report.lost_frames() > 0);
    assert_eq!(report.bytes, status.bytes);
    for (stamp_us, _) in &records {
        assert_eq!(stamp_us & 3, 0);
        assert!((before_us..before_us + 60_000_000).contains(&(stamp_us + 3)), "{stamp_us}");
    }
    assert_eq!(records[3].0 & !3, radio.stamp.utc_us & !3);
    assert!(matches!(Recorder::create(&path, false), Err(RecordError::Exists { .. })));
    std::fs::remove_file(&path).unwrap();
}

/// What comes after the end is in neither the file nor the figures.
#[tokio::test]
async fn an_ended_recording_holds_what_it_says() {
    let path = file("ended");
    let recorder = Recorder::create(&path, true).unwrap();
    let ((mut reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    for sequence in 0..3 {
        sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
        assert!(matches!(receive(&mut reader).await, Received::Frame(_)));
    }
    let status = recorder.end().await.unwrap();
    for sequence in 3..9 {
        sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
        assert!(matches!(receive(&mut reader).await, Received::Frame(_)), "no word of a failing disk");
    }
    assert_eq!((status.frames, recorder.status().frames, recorder.status().dropped), (3, 3, 0));
    let (records, report) = read(&std::fs::read(&path).unwrap());
    assert_eq!((records.len(), report.bytes), (3, status.bytes));
    assert!(matches!(recorder.end().await, Err(RecordError::Ended)));
    std::fs::remove_file(&path).unwrap();
}

/// Whatever is under way when the link is closed: what it has counted is what the recording has, or has dropped.
#[tokio::test]
async fn a_closed_link_has_counted_what_is_recorded() {
    for is_full in [false, true] {
        let (_, tickets) = mpsc::channel();
        let disk = Disk { bytes: Arc::default(), tickets, full: Arc::new(AtomicBool::new(is_full)) };
        let recorder = Recorder::to_store(disk, 1 << 20).unwrap();
        let ((mut reader, writer), (_other, sender)) = pair(&recorder, None).await;
        for sequence in 0..250 {
            sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
        }
        while !matches!(receive(&mut reader).await, Received::Frame(_)) {}
        drop(reader);
        let stats = writer.close().await;
        let status = recorder.end().await.unwrap();
        assert!(stats.received_frames > 0);
        assert_eq!(status.frames + status.dropped, stats.received_frames);
        assert_eq!((status.frames == 0, status.dropped == 0), (is_full, !is_full));
    }
}

#[tokio::test]
async fn a_slow_disk_costs_frames_but_never_time() {
    let (bytes, (ticket, tickets)) = (Arc::new(Mutex::new(Vec::new())), mpsc::channel());
    let disk = Disk { bytes: bytes.clone(), tickets, full: Arc::default() };
    let recorder = Recorder::to_store(disk, 2000).unwrap();
    let ((mut reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    // the disk stands still from the first heartbeat on
    for sequence in 0..250 {
        sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
    }
    let (mut delivered, mut failed) = (0, 0);
    while delivered < 250 {
        match receive(&mut reader).await {
            Received::Frame(_) => delivered += 1,
            Received::Event(event) => {
                assert_eq!(event, LinkEvent::RecordingFails);
                failed += 1;
            }
        }
    }
    assert_eq!(failed, 1, "told once");
    assert!(recorder.status().dropped > 0);
    drop(ticket);
    let status = recorder.finish().await.unwrap();
    assert_eq!(status.frames + status.dropped, 250);
    sender.send(&v2(header(1, 250), &heartbeat())).unwrap();
    assert_eq!(receive(&mut reader).await, Received::Event(LinkEvent::RecordingGoesOn));
    let status = recorder.finish().await.unwrap();
    let (records, report) = read(&bytes.lock().unwrap());
    assert_eq!(records.len() as u64, status.frames);
    assert_eq!(report.lost_frames(), status.dropped);
}

#[tokio::test]
async fn a_full_disk_is_told_and_tried_again() {
    let (bytes, full) = (Arc::new(Mutex::new(Vec::new())), Arc::new(AtomicBool::new(true)));
    let (_, tickets) = mpsc::channel();
    let disk = Disk { bytes: bytes.clone(), tickets, full: full.clone() };
    let recorder = Recorder::to_store(disk, 1 << 20).unwrap();
    let ((mut reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    // the first frame already may hear of the failure, or only the second
    let mut told = 0;
    for sequence in 0..2 {
        sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
        while let Received::Event(event) = receive(&mut reader).await {
            assert_eq!(event, LinkEvent::RecordingFails);
            told += 1;
        }
        let failure = recorder.finish().await.unwrap().failure.unwrap();
        assert!(failure.contains("full"), "{failure}");
    }
    assert_eq!(told, 1);
    full.store(false, Ordering::SeqCst);
    let status = recorder.finish().await.unwrap();
    // what waited in the buffer is not lost
    assert_eq!((status.frames, status.dropped, status.failure), (2, 0, None));
    assert_eq!(read(&bytes.lock().unwrap()).0.len(), 2);
}

/// Arming and a new mode go to the disk at once; what follows waits for the next second or for a word.
#[tokio::test]
async fn a_mode_change_is_on_the_disk_at_once() {
    let path = file("mode");
    let recorder = Recorder::create(&path, true).unwrap();
    let ((_reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    sender.send(&v2(header(1, 0), &heartbeat())).unwrap();
    let deadline = std::time::Instant::now() + Duration::from_secs(20);
    while std::fs::metadata(&path).unwrap().len() == 0 {
        assert!(std::time::Instant::now() < deadline, "never written");
        tokio::time::sleep(Duration::from_millis(2)).await;
    }
    std::fs::remove_file(&path).unwrap();
}

#[tokio::test(start_paused = true)]
async fn a_disk_that_stands_still_is_given_up_and_what_it_did_not_take_is_lost() {
    let (bytes, (ticket, tickets)) = (Arc::new(Mutex::new(Vec::new())), mpsc::channel());
    let disk = Disk { bytes: bytes.clone(), tickets, full: Arc::default() };
    let recorder = Recorder::to_store(disk, 1 << 20).unwrap();
    let ((mut reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    for sequence in 0..5 {
        sender.send(&v2(header(1, sequence), &heartbeat())).unwrap();
        assert!(matches!(receive(&mut reader).await, Received::Frame(_)));
    }
    let status = recorder.end().await.unwrap();
    assert_eq!((status.frames, status.dropped, status.is_whole()), (0, 5, false));
    assert!(status.failure.unwrap().contains("accepted nothing for 3 s"));
    drop(ticket);
}

/// Takes everything, and cannot say whether it is on the disk.
struct Unsure;

impl Write for Unsure {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Store for Unsure {
    fn sync(&mut self) -> io::Result<()> {
        Err(io::Error::other("no word from the disk"))
    }
}

#[tokio::test]
async fn frames_that_the_system_does_not_confirm_are_told() {
    let recorder = Recorder::to_store(Unsure, 1 << 20).unwrap();
    let ((mut reader, _writer), (_other, sender)) = pair(&recorder, None).await;
    sender.send(&v2(header(1, 0), &heartbeat())).unwrap();
    while !matches!(receive(&mut reader).await, Received::Frame(_)) {}
    let status = recorder.end().await.unwrap();
    assert_eq!((status.frames, status.dropped, status.doubtful), (1, 0, 1));
    assert!(!status.is_whole() && status.failure.unwrap().contains("no word"));
}
