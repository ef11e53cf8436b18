//! Ctrl-C during the download after a flight: the download ends, and the flight is analysed.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::process::{Command, Stdio};
use std::thread;

use mavid::wire::Splitter;
use mavid::wire::file_transfer::{Transfer, operation};
use serde_json::Value;

use crate::loopback::is_identified;
use crate::processes::{config, folder, planned, vehicle};

/// FILE_TRANSFER_PROTOCOL and LOG_DATA.
const FILE_TRANSFER: u32 = 110;
const LOG_DATA: u32 = 120;
/// Pieces of a log that pass, of the download: the rest never comes.
const PIECES: usize = 40;

/// Passes on between stations, one after the other, and a vehicle, whose logs come to a standstill.
fn stalled(vehicle: &str) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    let address = listener.local_addr().unwrap();
    let vehicle = vehicle.trim_start_matches("tcpin:").to_owned();
    thread::spawn(move || {
        for station in listener.incoming() {
            let station = station.unwrap();
            let down = TcpStream::connect(&vehicle).unwrap();
            let (mut from, mut to) = (station.try_clone().unwrap(), down.try_clone().unwrap());
            thread::spawn(move || std::io::copy(&mut from, &mut to));
            pass_down(down, station);
        }
    });
    format!("tcpout:{address}")
}

fn pass_down(mut vehicle: TcpStream, mut station: TcpStream) {
    let (mut splitter, mut bytes, mut pieces) = (Splitter::new(), [0; 4096], 0);
    while let Ok(read @ 1..) = vehicle.read(&mut bytes) {
        splitter.feed(&bytes[..read]);
        while let Some(frame) = splitter.next_frame() {
            let is_piece = match frame.header().message_id {
                FILE_TRANSFER => {
                    matches!(Transfer::read(frame.payload()).answers, operation::BURST | operation::READ)
                }
                LOG_DATA => true,
                _ => false,
            };
            pieces += usize::from(is_piece);
            // the station has ended
            if !(is_piece && pieces > PIECES) && station.write_all(frame.bytes()).is_err() {
                return;
            }
        }
    }
}

pub fn the_first_interrupt_ends_the_download_and_the_flight_is_analysed() {
    let trajectory = planned("interrupted_plan", 4);
    let out = folder("interrupted").join("flight");
    let (_vehicle, listens) = vehicle("px4", "tcpin:127.0.0.1:0");
    let mut flight = Command::new(env!("CARGO_BIN_EXE_mavid"))
        .args(["--json", "fly", "--plain", "--arm", "--fetch-log", "--vehicle", &config("x500.toml")])
        .args(["--connect", &stalled(&listens), "--out", out.to_str().unwrap()])
        .args(["--trajectory", trajectory.to_str().unwrap()])
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut stdout = flight.stdout.take().unwrap();
    let document = thread::spawn(move || {
        let mut document = Vec::new();
        stdout.read_to_end(&mut document).map(|_| document)
    });
    let mut said = String::new();
    let lines = BufReader::new(flight.stderr.take().unwrap()).lines();
    for line in lines.map_while(Result::ok) {
        // both ways were measured by then
        if line.contains("going on by file transfer") {
            let id = flight.id().to_string();
            assert!(Command::new("kill").args(["-INT", &id]).status().unwrap().success());
        }
        said.push_str(&line);
        said.push('\n');
    }
    let status = flight.wait().unwrap();
    assert!(said.contains("the vehicle's own log is not fetched: ended by Ctrl-C; "), "{said}");
    assert!(
        said.contains("are kept, and the next download into the same folder goes on with them"),
        "{said}"
    );
    assert!(said.contains("the flight is analysed without it; Ctrl-C once more ends the program"), "{said}");
    assert_eq!(status.code(), Some(0), "{said}");
    let document: Value = serde_json::from_slice(&document.join().unwrap().unwrap()).unwrap();
    is_identified(&document, "interrupted");
    let part = std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path());
    let part = part.into_iter().find(|path| path.extension().is_some_and(|end| end == "part")).unwrap();
    assert!(std::fs::metadata(part).unwrap().len() > 5000);
}
