//! ArduCopter's failsafes.

use super::Parameters;
use super::bitmask::has_bit;
use super::fence_switch::FenceSwitch;
use super::sentence::{Sentence, Topic, rounded};
use crate::fly::finding::Level::{Ok, Warning};

/// Bit of GUID_OPTIONS by which the yaw stick is ignored.
const IGNORE_YAW: u32 = 2;

pub(super) fn declaration(parameters: &Parameters, own_system: u8) -> Vec<Sentence> {
    let topic = |about| Topic { parameters, about };
    vec![
        setpoints(&topic("setpoints stop")),
        ground_station(&topic("ground station lost"), own_system),
        topic("transmitter lost").choose("If the transmitter is lost", "FS_THR_ENABLE"),
        sticks(&topic("pilot's sticks")),
        topic("estimate bad").choose("If the position estimate turns bad", "FS_EKF_ACTION"),
        topic("battery low").choose("If the battery runs low", "BATT_FS_LOW_ACT"),
        fence(&topic("fence")),
    ]
}

fn setpoints(topic: &Topic<'_>) -> Sentence {
    let what = "If setpoints stop";
    match topic.parameters.get("GUID_TIMEOUT") {
        None => topic.unknown(what, "GUID_TIMEOUT"),
        Some(seconds) => topic.say(
            Ok,
            format!(
                "{what}: it keeps the last velocity for {} s (GUID_TIMEOUT), then holds its position and \
                 stays in GUIDED.",
                rounded(seconds)
            ),
        ),
    }
}

/// Whether heartbeats of ours are those of its ground station: from MAV_GCS_SYSID to MAV_GCS_SYSID_HI where that is the
/// greater, and otherwise of that one system alone.
pub(in crate::fly) fn hears_station(parameters: &Parameters, system: f64, own_system: u8) -> bool {
    let highest = parameters.get("MAV_GCS_SYSID_HI").filter(|highest| *highest > system).unwrap_or(system);
    (system - 0.5..highest + 0.5).contains(&f64::from(own_system))
}

/// Heartbeats count only if they come from the system that the vehicle was told.
fn ground_station(topic: &Topic<'_>, own_system: u8) -> Sentence {
    let what = format!("If this ground station is not heard for {}", topic.number("FS_GCS_TIMEOUT", "s"));
    let sentence = topic.choose(&what, "FS_GCS_ENABLE");
    if topic.parameters.get("FS_GCS_ENABLE").is_none_or(|enable| enable < 0.5) {
        return sentence;
    }
    match topic.parameters.get("SYSID_MYGCS") {
        Some(system) if hears_station(topic.parameters, system, own_system) => sentence,
        Some(system) => topic.say(
            Warning,
            format!(
                "If this ground station (system {own_system}) is lost, the vehicle does not notice: it listens to \
                 system {system} ({}).",
                topic.parameters.name_of("SYSID_MYGCS")
            ),
        ),
        None => topic.unknown("Whether the vehicle notices the loss of this ground station", "SYSID_MYGCS"),
    }
}

fn sticks(topic: &Topic<'_>) -> Sentence {
    let what = "If the pilot moves the sticks in GUIDED";
    match topic.parameters.get("GUID_OPTIONS") {
        None => topic.unknown(what, "GUID_OPTIONS"),
        Some(mask) => {
            let yaw = if has_bit(mask, IGNORE_YAW) { "nothing happens" } else { "only the yaw stick acts" };
            topic.say(
                Warning,
                format!("{what}: {yaw} (GUID_OPTIONS = {mask}); only the mode switch takes over."),
            )
        }
    }
}

fn fence(topic: &Topic<'_>) -> Sentence {
    let leaves = "If it leaves its fence";
    match FenceSwitch::of(topic.parameters) {
        FenceSwitch::Unknown("FENCE_ENABLE") => topic.unknown(leaves, "FENCE_ENABLE"),
        FenceSwitch::Unknown(name) => {
            let what = "No fence is enabled now (FENCE_ENABLE = 0). Whether one is in flight (releases from 4.6 on can)";
            topic.unknown(what, name)
        }
        FenceSwitch::Off => {
            topic.say(Warning, "There is no fence (FENCE_ENABLE = 0): nothing stops it at a border.")
        }
        FenceSwitch::On => topic.choose(leaves, "FENCE_ACTION"),
        FenceSwitch::OnInFlight => {
            let what = format!("{leaves}, enabled at arming or takeoff (FENCE_AUTOENABLE)");
            topic.choose(&what, "FENCE_ACTION")
        }
    }
}
