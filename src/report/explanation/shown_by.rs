//! By which test a name was given, in words.

use crate::diagnose::Named;
use crate::diagnose::signatures::{is_irregular, latency_kind};
use crate::report::number::significant;

/// The share of the residual energy that an effect explains, or the test of its own by which it has its name.
pub(super) fn shown_by(effect: &Named) -> String {
    let gain = effect.strength.gain;
    if gain > 0.0 {
        return format!("{} % of the residual energy", significant(100.0 * gain, 2));
    }
    let test = if latency_kind(effect.id).is_some() {
        "its own test of the latency"
    } else if is_irregular(effect.id) {
        "its own test of the remaining residual"
    } else {
        "the test of its size together with the other effects"
    };
    format!("by {test}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Strength;

    #[test]
    fn what_has_a_test_of_its_own_has_no_share_of_the_energy() {
        let said = |id, gain| {
            let strength = Strength { z: 8.2, gain, energy: 67.0, count: 1 };
            let parameters = Vec::new();
            shown_by(&Named { id, sentence: "", parameters, strength, confusable_with: Vec::new() })
        };
        assert_eq!(said("linear_drag", 0.021), "2.1 % of the residual energy");
        assert_eq!(said("motor_lag", 0.0), "by its own test of the latency");
        assert_eq!(said("transport_delay", 0.0), "by its own test of the latency");
        assert_eq!(said("gust", 0.0), "by its own test of the remaining residual");
        assert_eq!(said("linear_drag", 0.0), "by the test of its size together with the other effects");
    }
}
