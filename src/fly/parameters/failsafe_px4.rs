//! PX4's failsafes.

use super::Parameters;
use super::bitmask::has_bit;
use super::sentence::{Sentence, Topic};
use crate::fly::finding::Level::{Ok, Warning};

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
        ),
        link.choose(
            &format!("If no ground station is heard for {}", link.number("COM_DL_LOSS_T", "s")),
            "NAV_DLL_ACT",
        ),
        transmitter(&topic("transmitter lost")),
        sticks(&topic("pilot's sticks")),
        topic("battery low").choose("If the battery runs low", "COM_LOW_BAT_ACT"),
        fence.choose(&leaves_fence(&fence), "GF_ACTION"),
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
        Some(_) => topic.choose(what, "NAV_RCL_ACT"),
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
