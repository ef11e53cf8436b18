//! A ground station without I/O at the other end of an embedded vehicle's link.

#![allow(dead_code, reason = "each test binary uses a part")]
#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use std::path::Path;
use std::time::Duration;

use mavid::config::read_vehicle;
use mavid::sitl::{Fault, Firmware, LinkId, LinkRole, Mode, Outgoing, Settings, Vehicle};
use mavid::units::narrow;
use mavid::wire::{ComponentId, Frame, SystemId};
use mavlink::dialects::ardupilotmega::{self as dialect, MavMessage};
use mavlink::{MAVLinkV2MessageRaw, MavHeader, MavlinkVersion, Message};

/// A ground station and the vehicle that it talks to.
pub struct Ground {
    pub vehicle: Vehicle,
    pub link: LinkId,
    pub kind: Firmware,
    pub now: Duration,
    /// everything that came, with its time
    pub received: Vec<(Duration, u32, Vec<u8>)>,
    pub system: u8,
    sequence: u8,
    /// a heartbeat every second
    pub beats: bool,
    next_beat: Duration,
}

/// The settings of a vehicle file of the project, its position good after two seconds.
pub fn settings(kind: Firmware) -> Settings {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let vehicle = read_vehicle(&file).unwrap().vehicle;
    Settings { warm_up: Some(Duration::from_secs(2)), ..Settings::new(vehicle, kind) }
}

impl Ground {
    pub fn new(settings: Settings) -> Self {
        let kind = settings.autopilot;
        let mut vehicle = Vehicle::new(settings).unwrap();
        let link = vehicle.open_link(LinkRole::GroundStation);
        Self {
            vehicle,
            link,
            kind,
            now: Duration::ZERO,
            received: Vec::new(),
            system: 255,
            sequence: 0,
            beats: true,
            next_beat: Duration::ZERO,
        }
    }

    pub fn of(kind: Firmware) -> Self {
        Self::new(settings(kind))
    }

    pub fn frame(&mut self, message: &MavMessage) -> Vec<u8> {
        let mut raw = MAVLinkV2MessageRaw::new();
        let header = MavHeader { system_id: self.system.into(), component_id: 190, sequence: self.sequence };
        raw.serialize_message(header, message);
        self.sequence = self.sequence.wrapping_add(1);
        raw.raw_bytes().to_vec()
    }

    pub fn send(&mut self, message: &MavMessage) {
        let bytes = self.frame(message);
        self.vehicle.receive(self.link, &bytes, self.now);
    }

    pub fn take(&mut self, out: Vec<Outgoing>) {
        for outgoing in out.into_iter().filter(|outgoing| outgoing.link == self.link) {
            let id = Frame::at_start(&outgoing.bytes).unwrap().header().message_id;
            self.received.push((outgoing.time, id, outgoing.bytes));
        }
    }

    /// Time goes on by so many seconds, with a heartbeat each.
    pub fn wait(&mut self, seconds: f64) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            if self.beats && self.now >= self.next_beat {
                self.next_beat = self.now + Duration::from_secs(1);
                self.send(&heartbeat());
            }
            self.now = (self.now + Duration::from_millis(20)).min(end);
            let out = self.vehicle.advance(self.now);
            self.take(out);
        }
    }

    /// The same with a setpoint every 20 ms.
    pub fn stream(&mut self, seconds: f64, setpoint: &MavMessage) {
        let end = self.now + Duration::from_secs_f64(seconds);
        while self.now < end {
            self.send(setpoint);
            self.wait(0.02);
        }
    }

    /// Sends a command and gives the result of its acknowledgement.
    pub fn command(&mut self, number: u16, params: [f32; 7]) -> u8 {
        let before = self.received.len();
        let bytes = self.command_frame(number, params);
        self.vehicle.receive(self.link, &bytes, self.now);
        let out = self.vehicle.advance(self.now);
        self.take(out);
        self.received[before..]
            .iter()
            .filter(|(_, id, _)| *id == 77)
            .map(|(_, _, bytes)| Frame::at_start(bytes).unwrap().payload())
            .find(|payload| payload.u16(0) == number)
            .map_or(u8::MAX, |payload| payload.u8(2))
    }

    /// By its bytes: numbers that the dialect does not know are among them.
    fn command_frame(&mut self, number: u16, params: [f32; 7]) -> Vec<u8> {
        let mut payload: Vec<u8> = params.iter().flat_map(|param| param.to_le_bytes()).collect();
        payload.extend(number.to_le_bytes());
        payload.extend([1, 1, 0]);
        self.raw(76, 152, &payload)
    }

    /// A frame of any message, by its payload and seed.
    pub fn raw(&mut self, id: u8, seed: u8, payload: &[u8]) -> Vec<u8> {
        let length = u8::try_from(payload.len()).unwrap();
        let mut frame = vec![0xFD, length, 0, 0, self.sequence, self.system, 190, id, 0, 0];
        frame.extend(payload);
        let sum = mavid::wire::checksum(&frame[1..], seed);
        frame.extend(sum.to_le_bytes());
        self.sequence = self.sequence.wrapping_add(1);
        frame
    }

    /// Sends such a frame and takes what comes at once.
    pub fn send_raw(&mut self, id: u8, seed: u8, payload: &[u8]) {
        let bytes = self.raw(id, seed, payload);
        self.vehicle.receive(self.link, &bytes, self.now);
        let out = self.vehicle.advance(self.now);
        self.take(out);
    }

    /// PARAM_REQUEST_READ by name.
    pub fn request_parameter(&mut self, name: &str) {
        let mut payload = (-1_i16).to_le_bytes().to_vec();
        payload.extend([1, 1]);
        payload.extend(padded(name));
        self.send_raw(20, 214, &payload);
    }

    /// PARAM_SET with a type and the four bytes of its value.
    pub fn set_parameter(&mut self, name: &str, kind: u8, value: [u8; 4]) {
        let mut payload = value.to_vec();
        payload.extend([1, 1]);
        payload.extend(padded(name));
        payload.push(kind);
        self.send_raw(23, 168, &payload);
    }

    /// The last PARAM_VALUE of this name.
    pub fn parameter(&self, name: &str) -> Option<mavid::wire::Payload<'_>> {
        let all = self.received.iter().rev().filter(|(_, id, _)| *id == 22);
        all.map(|(_, _, bytes)| Frame::at_start(bytes).unwrap().payload())
            .find(|payload| payload.text(8, 16) == name)
    }

    pub fn set_mode(&mut self, mode: Mode) -> u8 {
        let number = mode.custom_mode(self.kind).unwrap();
        let params = match self.kind {
            Firmware::PX4 => [(number >> 16 & 0xFF) as f32, (number >> 24) as f32],
            _ => [number as f32, 0.0],
        };
        self.command(176, [1.0, params[0], params[1], 0.0, 0.0, 0.0, 0.0])
    }

    pub fn arm(&mut self) -> u8 {
        self.command(400, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    pub fn disarm(&mut self) -> u8 {
        self.command(400, [0.0; 7])
    }

    pub fn set_interval(&mut self, id: u32, rate_hz: f64) -> u8 {
        self.command(511, [id as f32, narrow(1e6 / rate_hz), 0.0, 0.0, 0.0, 0.0, 0.0])
    }

    pub fn fault(&mut self, fault: Fault) {
        self.vehicle.fault(fault);
    }

    /// Forgets what came so far.
    pub fn forget(&mut self) {
        self.received.clear();
    }

    pub fn count(&self, id: u32) -> usize {
        self.received.iter().filter(|(_, got, _)| *got == id).count()
    }

    /// Payload of the last message of an id.
    pub fn last(&self, id: u32) -> Option<mavid::wire::Payload<'_>> {
        let (_, _, bytes) = self.received.iter().rev().find(|(_, got, _)| *got == id)?;
        Frame::at_start(bytes).map(|frame| frame.payload())
    }

    /// Custom mode, base mode, system status of the last heartbeat of the vehicle.
    pub fn heartbeat(&self) -> (u32, u8, u8) {
        let own = self.received.iter().rev().filter(|(_, id, _)| *id == 0).find_map(|(_, _, bytes)| {
            let frame = Frame::at_start(bytes).unwrap();
            let from_vehicle =
                frame.header().system == SystemId(1) && frame.header().component == ComponentId(1);
            from_vehicle.then(|| frame.payload())
        });
        let payload = own.unwrap();
        (payload.u32(0), payload.u8(6), payload.u8(7))
    }

    pub fn is_armed(&self) -> bool {
        self.heartbeat().1 & 128 != 0
    }

    pub fn mode(&self) -> Option<Mode> {
        Mode::from_custom_mode(self.kind, self.heartbeat().0)
    }

    /// North, east, down, m, of the last LOCAL_POSITION_NED.
    pub fn position(&self) -> [f64; 3] {
        self.last(32).unwrap().f32s(4)
    }

    /// All texts, chunks put together.
    pub fn texts(&self) -> Vec<String> {
        let mut texts: Vec<String> = Vec::new();
        for (_, _, bytes) in self.received.iter().filter(|(_, id, _)| *id == 253) {
            let payload = Frame::at_start(bytes).unwrap().payload();
            let text = payload.text(1, 50);
            match texts.last_mut() {
                Some(last) if payload.u8(53) > 0 => last.push_str(&text),
                _ => texts.push(text),
            }
        }
        texts
    }

    pub fn has_text(&self, part: &str) -> bool {
        self.texts().iter().any(|text| text.contains(part))
    }

    /// Every frame as the dialect reads it; unknown ids are left out.
    pub fn typed(&self) -> Vec<MavMessage> {
        let parse = |(_, id, bytes): &(Duration, u32, Vec<u8>)| {
            MavMessage::parse(MavlinkVersion::V2, *id, Frame::at_start(bytes)?.payload().0).ok()
        };
        self.received.iter().filter_map(parse).collect()
    }

    /// Takes off to this height and waits until it hovers there.
    pub fn take_off(&mut self, height_m: f64) {
        self.wait(3.0);
        if self.kind == Firmware::PX4 {
            let above_sea = 488.0 + narrow(height_m);
            assert_eq!(self.command(22, [0.0, 0.0, 0.0, f32::NAN, f32::NAN, f32::NAN, above_sea]), 0);
            assert_eq!(self.arm(), 0, "{:?}", self.texts());
        } else {
            self.set_interval(32, 20.0);
            self.set_interval(245, 5.0);
            assert_eq!(self.set_mode(Mode::Guided), 0);
            assert_eq!(self.arm(), 0, "{:?}", self.texts());
            assert_eq!(self.command(22, [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, narrow(height_m)]), 0);
        }
        self.wait(4.0 + 2.0 * height_m);
        let [_, _, down] = self.position();
        assert!((down + height_m).abs() < 0.4, "{down}");
    }
}

pub fn heartbeat() -> MavMessage {
    MavMessage::HEARTBEAT(dialect::HEARTBEAT_DATA {
        mavtype: dialect::MavType::MAV_TYPE_GCS,
        autopilot: dialect::MavAutopilot::MAV_AUTOPILOT_INVALID,
        base_mode: dialect::MavModeFlag::empty(),
        system_status: dialect::MavState::MAV_STATE_ACTIVE,
        mavlink_version: 3,
        custom_mode: 0,
    })
}

/// SET_ATTITUDE_TARGET: a pitch (nose up), body rates forward-right-down, a thrust.
pub fn attitude_target(type_mask: u8, pitch_rad: f32, rates: [f32; 3], thrust: f32) -> MavMessage {
    let (sin, cos) = (0.5 * pitch_rad).sin_cos();
    MavMessage::SET_ATTITUDE_TARGET(dialect::SET_ATTITUDE_TARGET_DATA {
        target_system: 1,
        target_component: 1,
        type_mask: dialect::AttitudeTargetTypemask::from_bits_truncate(type_mask),
        q: [cos, 0.0, sin, 0.0],
        body_roll_rate: rates[0],
        body_pitch_rate: rates[1],
        body_yaw_rate: rates[2],
        thrust,
        ..dialect::SET_ATTITUDE_TARGET_DATA::default()
    })
}

/// What a setpoint says, NED; `mask` ignores by its bits.
#[derive(Clone, Copy)]
pub struct Target {
    pub mask: u16,
    pub frame: dialect::MavFrame,
    pub position: [f32; 3],
    pub velocity: [f32; 3],
    pub acceleration: [f32; 3],
    pub yaw: f32,
    pub yaw_rate: f32,
}

impl Target {
    /// Position, velocity and acceleration together, heading north.
    pub fn at(position: [f32; 3]) -> Self {
        Self {
            mask: 0,
            frame: dialect::MavFrame::MAV_FRAME_LOCAL_NED,
            position,
            velocity: [0.0; 3],
            acceleration: [0.0; 3],
            yaw: 0.0,
            yaw_rate: 0.0,
        }
    }

    /// A velocity alone.
    pub fn moving(velocity: [f32; 3]) -> Self {
        Self { mask: 0b111 | 0b111 << 6 | 1 << 11, velocity, ..Self::at([0.0; 3]) }
    }

    pub fn message(&self) -> MavMessage {
        let ([x, y, z], [vx, vy, vz], [afx, afy, afz]) = (self.position, self.velocity, self.acceleration);
        MavMessage::SET_POSITION_TARGET_LOCAL_NED(dialect::SET_POSITION_TARGET_LOCAL_NED_DATA {
            time_boot_ms: 0,
            x,
            y,
            z,
            vx,
            vy,
            vz,
            afx,
            afy,
            afz,
            yaw: self.yaw,
            yaw_rate: self.yaw_rate,
            type_mask: dialect::PositionTargetTypemask::from_bits_retain(self.mask),
            target_system: 1,
            target_component: 1,
            coordinate_frame: self.frame,
        })
    }
}

/// A parameter's name in its field.
fn padded(name: &str) -> [u8; 16] {
    let mut field = [0; 16];
    field[..name.len()].copy_from_slice(name.as_bytes());
    field
}
