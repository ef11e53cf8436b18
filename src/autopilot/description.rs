//! Which parameters describe a vehicle.

use super::geometry::Geometry;
use super::outputs::{Numbered, PulseRange};
use super::stack::Stack;

/// Rotors and outputs for which names are given.
const ROTORS: usize = 12;
const OUTPUTS: usize = 16;

impl Stack {
    /// Names of the parameters that say where the rotors are and what a command means. No vehicle has all of them.
    #[must_use]
    pub fn describing_parameters(&self) -> Vec<String> {
        let mut names: Vec<String> = match &self.geometry {
            Geometry::Rotors { count, place, turning, airframe, .. } => {
                let of = |entry: &Numbered| (0..ROTORS).map(|rotor| entry.name(rotor)).collect::<Vec<_>>();
                let rotors = place.iter().chain([turning]).flat_map(of);
                [*count, *airframe].map(str::to_owned).into_iter().chain(rotors).collect()
            }
            Geometry::Class { class, kind, former } => [*class, *kind, *former].map(str::to_owned).into(),
        };
        let outputs = &self.outputs;
        names.extend((1..=OUTPUTS).map(|output| outputs.function.name(output)));
        match &outputs.pulses {
            PulseRange::OfOutputs(banks) => {
                names.extend(banks.iter().flat_map(|(low, high)| [low.name(1), high.name(1)]));
            }
            PulseRange::Shares { ends, shares } => {
                names.extend([ends.0, ends.1, shares.0, shares.1].map(str::to_owned));
            }
        }
        names.extend([outputs.expo, outputs.hover].map(str::to_owned));
        names
    }
}

#[cfg(test)]
mod tests {
    use crate::autopilot::STACKS;

    #[test]
    fn names_fit_a_parameter_and_come_once() {
        for stack in STACKS {
            let mut names = stack.describing_parameters();
            assert!(names.len() > 20 && names.iter().all(|name| name.len() <= 16), "{names:?}");
            let count = names.len();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count);
        }
    }
}
