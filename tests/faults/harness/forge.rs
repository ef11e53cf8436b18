//! Frames that somebody else makes.

use mavid::wire::{CrcSeeds, MARKER_V1, MARKER_V2, checksum};
use rand::RngExt;
use rand_pcg::Pcg64;

/// Payload of a message in the order of the wire, little-endian.
#[derive(Debug, Default)]
struct Body(Vec<u8>);

impl Body {
    fn u8s(mut self, values: &[u8]) -> Self {
        self.0.extend(values);
        self
    }

    fn u16(mut self, value: u16) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn u32(mut self, value: u32) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn u64(mut self, value: u64) -> Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn f32s(mut self, values: &[f32]) -> Self {
        self.0.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self
    }
}

/// A MAVLink 2 frame.
pub fn frame(seeds: &CrcSeeds, id: u32, payload: &[u8], sender: (u8, u8), sequence: u8) -> Vec<u8> {
    let [i0, i1, i2, _] = id.to_le_bytes();
    let length = payload.len() as u8;
    let mut bytes = vec![MARKER_V2, length, 0, 0, sequence, sender.0, sender.1, i0, i1, i2];
    bytes.extend(payload);
    let sum = checksum(&bytes[1..], seeds.get(id).unwrap_or(0));
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// A MAVLink 1 frame.
fn old_frame(seeds: &CrcSeeds, id: u8, payload: &[u8], sequence: u8) -> Vec<u8> {
    let mut bytes = vec![MARKER_V1, payload.len() as u8, sequence, 1, 1, id];
    bytes.extend(payload);
    let sum = checksum(&bytes[1..], seeds.get(id.into()).unwrap_or(0));
    bytes.extend(sum.to_le_bytes());
    bytes
}

/// HEARTBEAT of a quadrotor: its mode, and whether it is armed.
fn heartbeat(px4: bool, mode: u32, armed: bool, status: u8) -> Body {
    let autopilot = if px4 { 12 } else { 3 };
    Body::default().u32(mode).u8s(&[2, autopilot, if armed { 129 } else { 1 }, status, 3])
}

/// Modes of a pilot, of failsafes, and ours.
pub fn modes(px4: bool) -> &'static [u32] {
    if px4 {
        &[
            3 << 16,
            2 << 16,
            7 << 16,
            4 << 16 | 3 << 24,
            4 << 16 | 5 << 24,
            4 << 16 | 6 << 24,
            6 << 16,
            10 << 16,
        ]
    } else {
        &[2, 16, 0, 5, 6, 9, 17, 4, 20]
    }
}

fn one<T: Copy>(random: &mut Pcg64, of: &[T]) -> T {
    of[random.random_range(0..of.len())]
}

/// What is known to whoever forges.
#[derive(Debug)]
pub struct Forger {
    pub px4: bool,
    pub seeds: CrcSeeds,
    /// of the vehicle's last frame
    pub sequence: u8,
    known: Vec<u32>,
}

impl Forger {
    pub fn new(px4: bool) -> Self {
        let seeds = CrcSeeds::new();
        let known = (0..20_000).filter(|id| seeds.get(*id).is_some()).collect();
        Self { px4, seeds, sequence: 0, known }
    }

    fn ours(&self) -> u32 {
        if self.px4 { 6 << 16 } else { 4 }
    }

    fn of_vehicle(&self, random: &mut Pcg64, id: u32, body: Body) -> Vec<u8> {
        let sequence = match random.random_range(0..3) {
            0 => self.sequence.wrapping_add(1),
            1 => self.sequence.wrapping_sub(random.random_range(0..40)),
            _ => random.random(),
        };
        frame(&self.seeds, id, &body.0, (1, 1), sequence)
    }

    /// A frame, and what it is.
    pub fn make(&self, random: &mut Pcg64) -> (&'static str, Vec<u8>) {
        let (seeds, px4) = (&self.seeds, self.px4);
        match random.random_range(0..19) {
            0 | 1 => ("disarmed", self.of_vehicle(random, 0, heartbeat(px4, self.ours(), false, 4))),
            2 => {
                let mode = one(random, modes(px4));
                ("mode by HEARTBEAT", self.of_vehicle(random, 0, heartbeat(px4, mode, true, 4)))
            }
            3 => {
                let mode = one(random, modes(px4));
                let body = Body::default().u32(mode).u32(mode).u8s(&[0]);
                ("mode by CURRENT_MODE", self.of_vehicle(random, 436, body))
            }
            4 => {
                let status = random.random_range(0..10);
                ("system status", self.of_vehicle(random, 0, heartbeat(px4, self.ours(), true, status)))
            }
            5 | 6 => {
                let command = one(random, &[176, 400, 22, 511, 512]);
                let result = random.random_range(0..11);
                let body = Body::default().u16(command).u8s(&[result, 0]).u32(0).u8s(&[255, 190]);
                ("COMMAND_ACK", self.of_vehicle(random, 77, body))
            }
            7 => {
                let landed = random.random_range(0..5);
                ("landed state", self.of_vehicle(random, 245, Body::default().u8s(&[0, landed])))
            }
            8 => {
                let far = one(random, &[0.3_f32, 5.0, 1e3, 1e9, f32::NAN, f32::INFINITY]);
                let values: Vec<f32> = (0..6).map(|_| far * (2.0 * random.random::<f32>() - 1.0)).collect();
                let body = Body::default().u32(random.random_range(0..200_000)).f32s(&values);
                ("position", self.of_vehicle(random, 32, body))
            }
            9 => {
                let text = b"Failsafe activated\x1b[2J";
                let mut body = Body::default().u8s(&[random.random_range(0..8)]).u8s(text);
                body.0.resize(54, 0);
                ("text", self.of_vehicle(random, 253, body))
            }
            10 => ("station with our ids", frame(seeds, 0, &[0, 0, 0, 0, 6, 8, 0, 4, 3], (255, 190), 1)),
            11 => {
                let values = [0.5_f32, 0.5, -2.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
                let body = Body::default().u32(1).f32s(&values).u16(0xdf8).u8s(&[1, 1, 1]);
                ("setpoint of another", frame(seeds, 84, &body.0, (254, 190), 1))
            }
            12 => ("another vehicle", frame(seeds, 0, &heartbeat(px4, 0, true, 4).0, (2, 1), 1)),
            13 => ("MAVLink 1", old_frame(seeds, 0, &heartbeat(px4, self.ours(), false, 4).0, 9)),
            14 => {
                let mut noise = vec![MARKER_V2];
                noise.extend((0..200).map(|_| random.random::<u8>()));
                ("noise", noise)
            }
            15 => {
                // to a question of somebody else: by the time of day, since its own start, or by any number
                let since_start_ns = random.random_range(0..200_000_000_000_u64);
                let asked =
                    one(random, &[1_760_000_000_000_000_000 + since_start_ns, since_start_ns, u64::MAX / 2]);
                let body = Body::default().u64(since_start_ns).u64(asked);
                ("answer to another's TIMESYNC", self.of_vehicle(random, 111, body))
            }
            // any id of the dialect, any content
            _ => {
                let id = one(random, &self.known);
                let length = random.random_range(1..255);
                let payload: Vec<u8> = (0..length).map(|_| random.random()).collect();
                ("any id", self.of_vehicle(random, id, Body(payload)))
            }
        }
    }
}
