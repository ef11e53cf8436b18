//! Which of an autopilot's parameters a draft reads.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};

use super::vehicle::{Given, layout};
use crate::autopilot::Stack;

/// Names of the parameters that a draft of a vehicle of `stack` looks for, by what is `known` of them so far: those of a rotor
/// are asked for once the number of rotors is known.
#[must_use]
pub fn parameters_of(stack: &Stack, given: &Given, known: &BTreeMap<String, f64>) -> BTreeSet<String> {
    let names = RefCell::new(BTreeSet::new());
    let parameter = |name: &str| {
        names.borrow_mut().insert(name.to_owned());
        known.get(name).copied()
    };
    // why there is none is for the draft to say
    let _ = layout(stack, given, &parameter);
    let outputs = &stack.outputs;
    let _ = outputs.pulses.ends_us(parameter);
    let mut names = names.into_inner();
    names.extend([outputs.expo.to_owned(), outputs.hover.to_owned()]);
    names
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::autopilot::{ARDUPILOT, PX4};

    #[test]
    fn rotors_are_asked_for_once_their_number_is_known() {
        let given = Given { mass_kg: 1.0, size_m: None, frame: None };
        let first = parameters_of(&PX4, &given, &BTreeMap::new());
        assert!(first.contains("CA_ROTOR_COUNT") && !first.contains("CA_ROTOR0_PX"), "{first:?}");
        let known = BTreeMap::from([("CA_ROTOR_COUNT".to_owned(), 4.0)]);
        assert!(parameters_of(&PX4, &given, &known).contains("CA_ROTOR0_PX"));
        let copter = parameters_of(&ARDUPILOT, &given, &BTreeMap::new());
        assert!(copter.contains("FRAME_CLASS") && copter.contains("MOT_THST_EXPO"), "{copter:?}");
    }
}
