//! Where a misfit is, in words.

use crate::report::number::significant;
use crate::study::Located;
use std::fmt::Write;

/// Share of a misfit from which on it is mainly along one axis: a third.
const MAINLY_PERCENT: f64 = 100.0 / 3.0;

/// Location of a misfit: axis, place or state, band.
pub(super) fn whereabouts(located: &Located) -> String {
    let mut parts = Vec::new();
    if let Some(field) = &located.field {
        parts.push(format!(
            "a force of {} N along world {} near the local position {} = {:.1} m, {} m wide",
            significant(field.force_n, 2),
            field.force_along,
            field.changes_along,
            field.at_m,
            significant(field.extent_m, 1)
        ));
    } else if let Some(axis) = located.axes.first() {
        let what = format!("a {}", channel_in_words(axis.axis));
        let most =
            if axis.share_percent >= MAINLY_PERCENT { "mainly" } else { "spread over several axes, at most" };
        let mut words = format!("{most} {what} ({:.0} %)", axis.share_percent);
        if let Some(state) = located.leading_state() {
            let _ = write!(words, " that follows {}", spoken_state(&state.variable));
        }
        parts.push(words);
    }
    if let Some([low, high]) = located.band_hz {
        parts.push(format!("between {} and {} Hz", significant(low, 2), significant(high, 2)));
    }
    if parts.is_empty() { "spread over all axes, times and states".to_owned() } else { parts.join(", ") }
}

/// `force_x` as `force along body x`.
pub(super) fn channel_in_words(channel: &str) -> String {
    channel.replace("force_", "force along body ").replace("torque_", "torque about body ")
}

/// The displayed name of a state.
pub(super) fn spoken_state(variable: &str) -> String {
    match variable {
        "rate_x" => "the roll rate".to_owned(),
        "rate_y" => "the pitch rate".to_owned(),
        "rate_z" => "the yaw rate".to_owned(),
        "airspeed_x" | "airspeed_y" | "airspeed_z" => {
            format!("the airspeed along body {}", variable.trim_start_matches("airspeed_"))
        }
        rotor if rotor.starts_with("rotor_") => {
            format!("the thrust of motor {}", rotor.trim_start_matches("rotor_"))
        }
        other => format!("the {}", other.replace('_', " ")),
    }
}
