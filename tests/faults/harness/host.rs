//! The program: the parts of `mavid fly`, each of which can stand still, on a simulated clock.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use mavid::fly::requests::LinkKind;
use mavid::fly::{Action, Due, Event, Flight, Guide, Key, Outcome, Sortie, Streamer, Supervisor, send_due};
use mavid::link::{Carrier, HostClock, Link, LinkOptions, LinkReader, LinkWriter, Received, Recorder, Store};
use mavid::vehicle::Vehicle;
use mavid::wire::{Check, CrcSeeds, Frame, Record};
use rand::RngExt;
use rand_pcg::Pcg64;
use tokio::runtime::Runtime;

use super::network::Packet;
use super::trace::{Observation, Part, Report, Trace};

/// Between two ticks of the flight.
const TICK: Duration = Duration::from_millis(10);
/// Datagrams that the kernel keeps for a program that does not read.
const SOCKET: usize = 4000;
/// Bytes that may wait for the recording's disk.
const WAITING_BYTES: usize = 64 << 20;

/// A recording in memory.
#[derive(Debug, Clone, Default)]
pub struct Memory(pub Arc<Mutex<Vec<u8>>>);

impl std::io::Write for Memory {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().extend(bytes);
        Ok(bytes.len())
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

impl Store for Memory {
    fn sync(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// What an operator or a system wants of the program.
#[derive(Debug, Clone, PartialEq)]
pub enum Wish {
    Key(Key),
    Stop,
}

/// What has its turn.
#[derive(Debug, Clone, Copy)]
enum Turn {
    Read,
    Write,
    Supervise,
    Stream,
}

impl Turn {
    fn part(self) -> Part {
        match self {
            Self::Read | Self::Write => Part::Link,
            Self::Supervise => Part::Supervisor,
            Self::Stream => Part::Setpoints,
        }
    }
}

/// The program.
pub struct Host {
    supervisor: Supervisor,
    guide: Guide,
    streamer: Streamer,
    carrier: Carrier,
    reader: LinkReader,
    writer: LinkWriter,
    recorder: Recorder,
    pub memory: Memory,
    clock: HostClock,
    /// when the link's task last ran
    ran: Duration,
    datagrams: bool,
    seeds: CrcSeeds,
    /// at the socket, with when it came
    socket: VecDeque<(Duration, Packet)>,
    /// of frames that the reader has not given yet: when each came, and who said it when
    behind: VecDeque<(Duration, Option<Duration>)>,
    stalls: VecDeque<Duration>,
    wishes: VecDeque<Wish>,
    tick_due: Duration,
    parked: [Duration; 4],
    /// sound frames of the vehicle that were read
    pub read: Vec<Vec<u8>>,
    pub outcome: Option<Outcome>,
    random: Pcg64,
}

impl Host {
    pub fn new(sortie: Sortie, vehicle: Vehicle, datagrams: bool, random: Pcg64) -> Self {
        let memory = Memory::default();
        let recorder = Recorder::to_store(memory.clone(), WAITING_BYTES).unwrap();
        let options = LinkOptions { recorder: Some(recorder.clone()), ..LinkOptions::default() };
        let clock = options.clock;
        let (carrier, (reader, writer)) = Link::carried(&options, datagrams);
        Self {
            streamer: Streamer::new(sortie.settings.setpoint_period),
            supervisor: Supervisor::new(Flight::new(sortie), vehicle, LinkKind::Wide),
            guide: Guide::silent(Duration::ZERO),
            carrier,
            reader,
            writer,
            recorder,
            memory,
            clock,
            ran: Duration::ZERO,
            datagrams,
            seeds: CrcSeeds::new(),
            socket: VecDeque::new(),
            behind: VecDeque::new(),
            stalls: VecDeque::new(),
            wishes: VecDeque::new(),
            tick_due: Duration::ZERO,
            parked: [Duration::ZERO; 4],
            read: Vec::new(),
            outcome: None,
            random,
        }
    }

    pub fn flight(&self) -> &Flight {
        self.supervisor.flight()
    }

    /// Lets a part stand still until then.
    pub fn park(&mut self, part: Part, until: Duration) {
        let parked = &mut self.parked[part as usize];
        *parked = until.max(*parked);
    }

    pub fn is_parked(&self, part: Part, now: Duration) -> bool {
        now < self.parked[part as usize]
    }

    /// A datagram, or a piece of a stream, comes to the socket.
    pub fn arrive(&mut self, now: Duration, packet: Packet, trace: &mut Trace) {
        if self.socket.len() >= SOCKET {
            return;
        }
        if Frame::at_start(&packet.bytes)
            .is_some_and(|frame| frame.check(&self.seeds) == Check::Right && frame.header().system.0 == 1)
        {
            trace.add(now, Observation::Came);
        }
        if let Some(report) = Report::of(&self.seeds, &packet.bytes, packet.said) {
            trace.add(now, Observation::Reached(report));
        }
        self.socket.push_back((now, packet));
    }

    pub fn wish(&mut self, wish: Wish) {
        self.wishes.push_back(wish);
    }

    /// The connection is cut, or there again.
    pub fn connect(&mut self, up: bool) {
        if up {
            self.carrier.restored();
        } else {
            self.carrier.lost("cut");
            self.socket.clear();
        }
    }

    /// Each part that does not stand still has its turn, in any order; what left the program.
    pub fn turn(&mut self, now: Duration, trace: &mut Trace) -> Vec<Vec<u8>> {
        let mut left = Vec::new();
        let mut turns = [Turn::Read, Turn::Write, Turn::Supervise, Turn::Stream];
        for at in (1..turns.len()).rev() {
            turns.swap(at, self.random.random_range(0..=at));
        }
        for turn in turns {
            let part = turn.part();
            if self.outcome.is_some() || self.is_parked(part, now) {
                continue;
            }
            match turn {
                Turn::Read => self.take(now),
                Turn::Write => {
                    while let Some(frame) = self.carrier.next(self.clock.now()) {
                        left.push(frame.into());
                    }
                }
                Turn::Supervise => self.supervise(now, trace),
                Turn::Stream => self.stream(now),
            }
            while let Some(frame) = self.carrier.went_past() {
                left.push(frame.into());
            }
        }
        if self.outcome.is_some() && !self.is_parked(Part::Link, now) {
            // what was given is still sent
            while let Some(frame) = self.carrier.next(self.clock.now()) {
                left.push(frame.into());
            }
        }
        left
    }

    /// The link reads what lies at its socket.
    fn take(&mut self, now: Duration) {
        let stamp = self.clock.now();
        self.ran = now;
        while let Some((came, packet)) = self.socket.pop_front() {
            let before = self.carrier.waiting();
            if self.datagrams {
                self.carrier.datagram(&packet.bytes, stamp);
            } else {
                self.carrier.bytes(&packet.bytes, stamp);
            }
            for _ in before..self.carrier.waiting() {
                self.behind.push_back((came, packet.said));
            }
            if packet.said.is_some() {
                self.read.push(packet.bytes);
            }
        }
    }

    /// As `conduct` in the program's runner: whatever is ready, in any order.
    fn supervise(&mut self, now: Duration, trace: &mut Trace) {
        let mut frames = !self.is_parked(Part::Telemetry, now);
        while self.outcome.is_none() {
            let mut ready = Vec::new();
            ready.extend(frames.then_some(0));
            ready.extend((now >= self.tick_due).then_some(1));
            ready.extend((!self.wishes.is_empty()).then_some(2));
            ready.extend((!self.stalls.is_empty()).then_some(3));
            if ready.is_empty() {
                return;
            }
            match ready[self.random.random_range(0..ready.len())] {
                0 => frames = self.hear(now, trace),
                1 => {
                    while self.tick_due <= now {
                        self.tick_due += TICK;
                    }
                    self.supervisor.tick(now, self.reader.waiting());
                }
                2 => match self.wishes.pop_front() {
                    Some(Wish::Key(key)) => self.supervisor.handle(now, Event::Key(key)),
                    _ => self.supervisor.handle(now, Event::Stop("SIGTERM".to_owned())),
                },
                _ => {
                    if let Some(gap) = self.stalls.pop_front() {
                        self.supervisor.handle(now, Event::Stalled(gap));
                    }
                }
            }
            self.act(now, trace);
        }
    }

    /// One thing that the link has for the flight; whether there was one.
    fn hear(&mut self, now: Duration, trace: &mut Trace) -> bool {
        match self.reader.try_receive() {
            Ok(Some(Received::Frame(received))) => {
                let (came, said) = self.behind.pop_front().unwrap_or((now, None));
                if let Some(report) = Report::of(&self.seeds, received.bytes(), said) {
                    trace.add(now, Observation::Heard(report, came));
                }
                if let Some(frame) = Frame::at_start(received.bytes()) {
                    let stamp_us = received.stamp.utc_us;
                    self.supervisor.frame(now, &Record { stamp_us, offset: 0, known: false, frame });
                }
                true
            }
            Ok(Some(Received::Event(event))) => {
                self.supervisor.link_event(now, &event);
                true
            }
            Ok(None) | Err(_) => false,
        }
    }

    fn act(&mut self, now: Duration, trace: &mut Trace) {
        self.guide = self.supervisor.flight().guide().clone();
        while let Some(action) = self.supervisor.next_action() {
            match action {
                Action::Send(message) => {
                    // a link that takes nothing is told by its own events
                    let _ = self.writer.send_message(&message);
                }
                Action::Note(note) => trace.add(now, Observation::Note(note)),
                Action::Finished(outcome) => {
                    trace.add(now, Observation::Over(outcome.clone()));
                    self.outcome = Some(outcome);
                }
            }
        }
    }

    /// As the program's thread of setpoints.
    fn stream(&mut self, now: Duration) {
        let times = (now, self.ran);
        if let Due::Stalled(gap) = send_due(&mut self.streamer, times, self.guide.clone(), &self.writer) {
            self.stalls.push_back(gap);
        }
    }

    /// The recording, ended.
    pub fn recorded(&mut self, runtime: &Runtime) -> Vec<u8> {
        self.carrier.end(self.clock.now());
        // its thread writes in real time
        runtime.block_on(async {
            tokio::time::resume();
            self.recorder.end().await.unwrap();
        });
        self.memory.0.lock().unwrap().clone()
    }
}
