//! Words for what flights do not determine of the inertia.

use crate::diagnose::MOMENT_STD;
use crate::estimate::NAMES;
use crate::text::significant;
use crate::vehicle::Vehicle;

/// Why moments of inertia are not determined where the excitation is too small.
pub(in crate::study) const BY_CONTROL: &str = "almost all rotation was the controller's answer to the noise of the \
                                               gyroscopes; fly an identification trajectory, which excites the \
                                               rotation";

/// Why an entry of the inertia is not determined that the model has from the vehicle file.
pub(in crate::study) const KEPT: &str =
    "the flight alone tells too little of it, so the model has about what the vehicle file states";

/// Which of izz and the torque per thrust a model keeps where the flights tell only their ratio: two clauses on the model and the vehicle
/// file.
pub(in crate::study) fn kept_about_z(model: &Vehicle, stated: &Vehicle) -> String {
    let [izz, stated_izz] = [model, stated].map(|of| of.body.inertia_kg_m2[(2, 2)]);
    let [torque, stated_torque] = [model, stated].map(|of| of.propulsion.torque_per_thrust_m);
    let [izz_words, stated_words] = [izz, stated_izz].map(|izz| significant(izz, 3));
    let percent = 100.0 * MOMENT_STD;
    let kept = if (izz / stated_izz - 1.0).abs() < SAME {
        format!("izz is {izz_words} kg m^2 as the vehicle file states it, uncertain by {percent:.0} %")
    } else {
        format!(
            "izz is {izz_words} kg m^2, uncertain by {percent:.0} %: the nearest to the {stated_words} of the vehicle file that a body with \
             this ixx and iyy can have"
        )
    };
    format!(
        "in the model {kept}; its torque per thrust follows from the ratio, {} N m per N in place of {}",
        significant(torque, 3),
        significant(stated_torque, 3)
    )
}

/// Why no entry of the inertia is determined where no body has what the flight shows: the place of the largest moment, and its ratio to the sum
/// of the other two.
pub(in crate::study) fn no_body((place, ratio): (usize, f64)) -> String {
    format!(
        "no body has the inertia that the flight shows with this vehicle file: its {} is {ratio:.2} times the sum of the other two moments; is \
         torque_ratio wrong in the vehicle file, or are the rotors' places?",
        NAMES[place]
    )
}

/// Relative difference (-) of two values that are one.
const SAME: f64 = 1e-9;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inertia_that_no_body_has_asks_for_the_torque_ratio() {
        let said = no_body((6, 1.017));
        assert!(said.contains("its izz is 1.02 times the sum of the other two moments"), "{said}");
        assert!(said.contains("is torque_ratio wrong"), "{said}");
    }
}
