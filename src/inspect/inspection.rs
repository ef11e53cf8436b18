//! What is in a log, as values; their field names are the keys of the JSON document.

use std::collections::BTreeMap;

use serde::Serialize;

use super::flown::FlightSummary;
use super::onboard::OnboardReading;
use super::quantity::QuantitySummary;
use crate::signals::OffMixer;

/// What is in a log, and what it is good for.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Inspection {
    /// one or two sentences: what the log is good for and what to do next
    pub verdict: String,
    /// nothing can be identified whatever the vehicle is: nothing was flown, or no stream shows it
    #[serde(skip)]
    pub unflown: Option<Unflown>,
    /// why the log is not one of the given vehicle: what was expected and what came
    #[serde(skip)]
    pub other_rotors: Option<String>,
    /// what to change about the next recording, the most important first
    pub advice: Vec<String>,
    /// whose log it is
    pub vehicle: VehicleSummary,
    /// the vehicle's clock
    pub clock: ClockSummary,
    /// the file and its damage
    pub reading: Reading,
    /// what was lost; empty: nothing, and exit status 0
    pub losses: Vec<String>,
    /// one a stream
    pub streams: Vec<StreamSummary>,
    /// armed, in the air, modes
    pub timeline: Timeline,
    /// flight segments
    pub flight: FlightSummary,
    /// outputs that left the mixer in the air
    pub outputs_off_mixer: Vec<OffMixer>,
    /// how the vehicle was moved; none where nothing flew or nothing measured motion
    pub excitation: Option<Excitation>,
    /// offsets between streams, from kinematics; only with a vehicle
    pub stream_offsets: Vec<OffsetSummary>,
    /// what one may want to know, and how well the log will tell it
    pub quantities: Vec<QuantitySummary>,
    /// mass and size are assumed: errors of quantities are relative
    pub quantities_relative: bool,
    /// what each parameter can be identified to
    pub identifiability: Vec<Outlook>,
    /// the vehicle's parameters
    pub parameters: ParameterSummary,
    /// warnings and worse
    pub texts: TextSummary,
    /// most numbers held at once for flight segments: bounds the memory
    pub numbers_held_max: usize,
}

/// Whose log it is.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Default)]
pub struct VehicleSummary {
    /// MAVLink system id; none for a table
    pub system: Option<u32>,
    /// MAVLink component id
    pub component: Option<u8>,
    /// `px4`, `ardupilot`, `other` or `unknown`
    pub autopilot: &'static str,
    /// other vehicles in the log, by system id
    pub others: Vec<u32>,
    /// no HEARTBEAT of a vehicle is in the log
    pub without_heartbeat: bool,
    /// what kind of vehicle it is, where the log says so
    #[serde(skip_serializing_if = "Option::is_none")]
    pub kind: Option<&'static str>,
    /// the autopilot's software in its own words, where a log that it wrote itself says so
    #[serde(skip_serializing_if = "Option::is_none")]
    pub firmware: Option<String>,
}

/// The vehicle's clock against the host's.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct ClockSummary {
    /// first and last sample, s of the vehicle's clock since the recording's start
    pub span_s: (f64, f64),
    /// at the recording's start, microseconds since 1970 UTC: by the host's clock, or in the vehicle's own log by a satellite receiver
    pub start_utc_us: Option<u64>,
    /// host's clock less the vehicle's, s: how much it grew in a million
    pub drift_ppm: Option<f64>,
    /// standard error of that
    pub drift_std_ppm: Option<f64>,
    /// rms of the frames' arrival about the second's mean, s
    pub arrival_jitter_s: Option<f64>,
    /// latest arrival behind the second's earliest, s
    pub arrival_latest_s: Option<f64>,
    /// restarts of the vehicle's clock, s
    pub resets_s: Vec<f64>,
    /// jumps of the position estimate, s
    pub estimator_resets_s: Vec<f64>,
}

/// The file and its damage.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "format", rename_all = "snake_case")]
pub enum Reading {
    /// telemetry log
    Tlog(Box<TlogReading>),
    /// table
    Csv(CsvReading),
    /// log that the vehicle wrote itself
    Onboard(Box<OnboardReading>),
    /// a format that has nothing to add to what all have
    Other {
        /// which one
        name: &'static str,
    },
}

/// What was met in a telemetry log.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct TlogReading {
    /// bytes read
    pub bytes: u64,
    /// frames, unknown ones included
    pub frames: u64,
    /// of these MAVLink 1
    pub frames_v1: u64,
    /// of these MAVLink 2
    pub frames_v2: u64,
    /// of these signed
    pub signed: u64,
    /// frames of messages that the dialect does not have, by id
    pub unknown_ids: BTreeMap<u32, u64>,
    /// frames behind another's stamp
    pub shared_stamps: u64,
    /// host stamps before their predecessor
    pub backward_stamps: u64,
    /// the furthest that one lies before its predecessor, s
    pub backward_most_s: f64,
    /// host stamps equal to their predecessor, of records with a stamp of their own
    pub doubled_stamps: u64,
    /// host stamps more than an hour after their predecessor
    pub leaping_stamps: u64,
    /// host stamps of no wall clock
    pub odd_stamps: u64,
    /// times that the recording computer's clock was set while the vehicle's continued
    pub host_steps: u64,
    /// what is odd about the host's stamps, in words; nothing is lost by it
    pub oddities: Vec<String>,
    /// the stamps' bytes run the wrong way round
    pub little_endian_stamps: bool,
    /// frames dropped for a wrong checksum
    pub bad_crc: u64,
    /// places where bytes were skipped
    pub resync_count: u64,
    /// bytes skipped there
    pub skipped_bytes: u64,
    /// byte offset and length of the first of these places
    pub resyncs: Vec<(u64, u64)>,
    /// bytes of a record that the file's end cut off, or zeros there
    pub truncated_tail_bytes: u64,
    /// frames missing by sequence numbers, all senders
    pub sequence_lost: u64,
    /// frames that came twice, all senders
    pub duplicates: u64,
    /// who sent what
    pub senders: Vec<SenderSummary>,
    /// messages decoded
    pub decoded: u64,
    /// messages whose stamp fits no clock
    pub stale_stamps: u64,
    /// messages and parameters of a simulator's truth: counted, never read
    pub withheld_truth: u64,
    /// messages in a frame or unit that cannot be used, by name
    pub unusable: BTreeMap<&'static str, u64>,
    /// messages without a finite value, by name
    pub empty: BTreeMap<&'static str, u64>,
}

/// One sender of frames.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SenderSummary {
    /// system id
    pub system: u32,
    /// component id
    pub component: u8,
    /// frames
    pub frames: u64,
    /// missing by sequence numbers
    pub lost: u64,
    /// came twice
    pub duplicates: u64,
    /// frames by message id
    pub messages: BTreeMap<u32, u64>,
}

/// What was met in a table.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct CsvReading {
    /// rows after the header
    pub rows: usize,
    /// left out
    pub rows_rejected: usize,
    /// line and reason of the first of them
    pub rejections: Vec<(u64, String)>,
    /// sorted into place
    pub rows_out_of_order: usize,
    /// of the same time as another, left out
    pub rows_repeating_a_time: usize,
    /// attitudes that are no rotations, left out
    pub invalid_attitudes: usize,
    /// columns that the mapping does not use
    pub unused_columns: Vec<String>,
}

/// One stream.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct StreamSummary {
    /// what it holds
    pub quantity: &'static str,
    /// message or file
    pub source: &'static str,
    /// port, index or sensor number
    pub instance: u8,
    /// values a sample, at most
    pub width: usize,
    /// samples
    pub count: u64,
    /// first and last stamp, s
    pub span_s: (f64, f64),
    /// samples a second, gaps left out
    pub rate_hz: f64,
    /// s
    pub median_period_s: f64,
    /// half the width of the middle 68 % of periods, s
    pub jitter_s: f64,
    /// periods longer than three medians
    pub gaps: u64,
    /// s
    pub largest_gap_s: f64,
    /// time that the gaps miss, s
    pub missing_s: f64,
    /// steps back in time
    pub backward: u64,
    /// stamps that came twice in a row
    pub repeated_stamps: u64,
    /// restarts of the clock while it ran
    pub resets: u64,
    /// `live`, `constant` (never changes) or `zero` (nothing but zeros)
    pub state: &'static str,
}

/// Armed, in the air, modes; times in s of the vehicle's clock.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct Timeline {
    /// spans armed
    pub armed_s: Vec<(f64, f64)>,
    /// spans that the autopilot calls in the air (taking off and landing included)
    pub in_air_s: Vec<(f64, f64)>,
    /// each change of mode
    pub modes: Vec<ModeChange>,
    /// entries beyond what is kept
    pub dropped: u64,
}

/// A mode from here on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeChange {
    /// s
    pub time_s: f64,
    /// the autopilot's number
    pub number: f64,
    /// its name where it is known
    pub name: Option<&'static str>,
}

/// How the vehicle was moved in the time that can be used, seen through the identification's kernel.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Excitation {
    /// s that it rests on
    pub seconds: f64,
    /// rms about body x, y, z, rad/s; none without body rates
    pub rate_rms_rad_s: Option<[f64; 3]>,
    /// rms about body x, y, z, rad/s^2
    pub angular_acceleration_rms_rad_s2: Option<[f64; 3]>,
    /// 5 to 95 % of the angular acceleration's power lie between, Hz
    pub angular_acceleration_band_hz: Option<(f64, f64)>,
    /// mean of the specific force along the thrust, m/s^2
    pub thrust_mean_m_s2: Option<f64>,
    /// standard deviation of it, m/s^2
    pub thrust_variation_m_s2: Option<f64>,
    /// m/s
    pub speed_rms_m_s: Option<f64>,
    /// m/s
    pub speed_max_m_s: Option<f64>,
    /// lowest and highest, m
    pub altitude_m: Option<(f64, f64)>,
    /// period of a trajectory that repeats itself, s
    pub period_s: Option<f64>,
}

/// Offset of a stream against the inertial unit.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct OffsetSummary {
    /// which
    pub quantity: &'static str,
    /// s; positive: its stamps are late
    pub late_s: f64,
    /// s, standard error
    pub std_s: f64,
}

/// What a parameter can be identified to.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Outlook {
    /// as in `identify`
    pub name: &'static str,
    /// `determined`: a standard error is known; `possible`: nothing speaks against it, a vehicle file tells;
    /// `not_determined`: see `reason`
    pub status: &'static str,
    /// standard error to expect, in the parameter's unit
    pub std: Option<f64>,
    /// unit of that
    pub unit: &'static str,
    /// standard error by the parameter's nominal size (products of inertia: by the root of the two moments)
    pub std_relative: Option<f64>,
    /// why not
    pub reason: Option<String>,
}

/// The vehicle's parameters.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct ParameterSummary {
    /// all that the log holds
    pub count: usize,
    /// those that identification reads or that tell the vehicle's build
    pub relevant: BTreeMap<String, f64>,
    /// parameters beyond those kept
    pub dropped: u64,
}

/// What the vehicle said.
#[derive(Debug, Clone, PartialEq, Serialize, Default)]
pub struct TextSummary {
    /// all texts
    pub count: u64,
    /// warnings and worse, the first of them
    pub warnings: Vec<Text>,
    /// warnings and worse
    pub warning_count: u64,
}

/// One text.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Text {
    /// s
    pub time_s: f64,
    /// MAV_SEVERITY: 0 emergency, 1 alert, 2 critical, 3 error, 4 warning
    pub severity: u8,
    /// what
    pub text: String,
}

/// Why nothing can be identified whatever the vehicle is.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unflown {
    /// the reason, and what to do
    pub why: String,
    /// the reason is that no actuator outputs are logged: what a vehicle file expects of them says more
    pub lacks_actuators: bool,
}
