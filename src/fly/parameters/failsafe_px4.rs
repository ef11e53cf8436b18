//! PX4's failsafes.

use super::Parameters;
use super::bitmask::has_bit;
use super::sentence::{Choice, Sentence, Topic};
use crate::fly::finding::Level::{Ok, Warning};

const OFFBOARD_LOST: &[Choice] = &[
    (0, "changes to Position mode and, without a transmitter, descends", Warning),
    (1, "changes to Altitude mode: it drifts with the wind", Warning),
    (2, "changes to Stabilized mode: without a pilot it falls", Warning),
    (3, "returns to its launch place", Ok),
    (4, "lands where it is", Ok),
    (5, "holds its position", Ok),
    (6, "stops its motors in the air", Warning),
    (7, "disarms in the air", Warning),
];

const LINK_LOST: &[Choice] = &[
    (0, "does nothing, its other failsafes apply", Warning),
    (1, "holds its position", Ok),
    (2, "returns to its launch place", Ok),
    (3, "lands where it is", Ok),
    (5, "stops its motors in the air", Warning),
    (6, "disarms in the air", Warning),
];

const BATTERY_LOW: &[Choice] = &[
    (0, "only warns", Warning),
    (1, "returns to its launch place when critical", Ok),
    (2, "lands when critical", Ok),
    (3, "returns when critical and lands at the emergency level", Ok),
];

const FENCE: &[Choice] = &[
    (0, "does nothing", Warning),
    (1, "only warns", Warning),
    (2, "holds its position", Ok),
    (3, "returns to its launch place", Ok),
    (4, "stops its motors in the air", Warning),
    (5, "lands where it is", Ok),
];

/// Bit of COM_RCL_EXCEPT and of COM_RC_OVERRIDE that means OFFBOARD.
const EXCEPT_OFFBOARD: u32 = 2;
const OVERRIDE_OFFBOARD: u32 = 1;

pub(super) fn declaration(parameters: &Parameters) -> Vec<Sentence> {
    let topic = |about| Topic { parameters, about };
    let stop = topic("setpoints stop");
    let link = topic("ground station lost");
    let fence = topic("fence");
    vec![
        stop.choose(
            &format!(
                "If setpoints stop for {}, PX4 leaves OFFBOARD (and goes back by itself when they resume)",
                stop.number("COM_OF_LOSS_T", "s")
            ),
            "COM_OBL_RC_ACT",
            OFFBOARD_LOST,
        ),
        link.choose(
            &format!("If no ground station is heard for {}", link.number("COM_DL_LOSS_T", "s")),
            "NAV_DLL_ACT",
            LINK_LOST,
        ),
        transmitter(&topic("transmitter lost")),
        sticks(&topic("pilot's sticks")),
        topic("battery low").choose("If the battery runs low", "COM_LOW_BAT_ACT", BATTERY_LOW),
        fence.choose(&leaves_fence(&fence), "GF_ACTION", FENCE),
    ]
}

/// A distance of zero is no border.
fn leaves_fence(topic: &Topic<'_>) -> String {
    let border = |name: &str, of_home: &str| {
        let is_off = topic.parameters.get(name) == Some(0.0);
        (!is_off).then(|| format!("{} {of_home}", topic.number(name, "m")))
    };
    let borders = [border("GF_MAX_HOR_DIST", "from home"), border("GF_MAX_VER_DIST", "above home")];
    let borders: Vec<String> = borders.into_iter().flatten().collect();
    match borders.as_slice() {
        [] => "If it leaves a stored fence (GF_MAX_HOR_DIST and GF_MAX_VER_DIST are 0, no border)".to_owned(),
        borders => format!("If it leaves {}, or a stored fence", borders.join(" or ")),
    }
}

fn transmitter(topic: &Topic<'_>) -> Sentence {
    let what = "If the transmitter is lost";
    match topic.parameters.get("COM_RCL_EXCEPT") {
        None => topic.unknown(what, "COM_RCL_EXCEPT"),
        Some(mask) if has_bit(mask, EXCEPT_OFFBOARD) => {
            topic.say(Ok, format!("{what}: it flies on in OFFBOARD (COM_RCL_EXCEPT = {mask})."))
        }
        Some(_) => topic.choose(what, "NAV_RCL_ACT", LINK_LOST),
    }
}

fn sticks(topic: &Topic<'_>) -> Sentence {
    let what = "If the pilot moves the sticks in OFFBOARD";
    match topic.parameters.get("COM_RC_OVERRIDE") {
        None => topic.unknown(what, "COM_RC_OVERRIDE"),
        Some(mask) if has_bit(mask, OVERRIDE_OFFBOARD) => {
            topic.say(Ok, format!("{what}: the pilot has control (COM_RC_OVERRIDE = {mask})."))
        }
        Some(mask) => topic.say(
            Warning,
            format!("{what}: nothing happens (COM_RC_OVERRIDE = {mask}); only the mode switch takes over."),
        ),
    }
}
