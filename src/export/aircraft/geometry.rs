//! Rotors as PX4's control allocation takes them, CA_ROTORn_*.
//!
//! Places are from the centre of mass, forward-right-down; CT is relative, because the allocation divides by the sum.

use super::determined::Determined;
use super::parameter::AircraftParameter;
use super::table::Table;
use crate::export::axes::frd;
use crate::export::source::Source;
use crate::text::{compact, with_error};

/// PX4's default of CA_ROTORn_CT.
const CT: f64 = 6.5;

/// Places from the centre of mass that was found, and what a weak rotor gives.
pub(super) fn geometry(
    source: &mut Source<'_>,
    determined: &Determined<'_>,
    table: &Table,
) -> Vec<AircraftParameter> {
    if !table.is_px4() {
        if source.has("weak_rotor") || source.has("com_offset") {
            source.note(
                "ArduPilot has no parameter for a rotor that gives less, or for a centre of mass beside the rotors' centre: balance the vehicle",
            );
        }
        return Vec::new();
    }
    let mut parameters = places(source, determined);
    parameters.extend(coefficients(source, determined));
    parameters
}

fn places(source: &mut Source<'_>, determined: &Determined<'_>) -> Vec<AircraftParameter> {
    let stds = ["x", "y"].map(|axis| determined.std("com_offset", axis));
    let [Some(std_x), Some(std_y)] = stds else { return Vec::new() };
    let motors: Vec<String> =
        (0..source.vehicle.rotors.len()).map(|index| source.vehicle.motor_words(index)).collect();
    let arms = source.arms_m();
    let place = |(index, (arm, name)): (usize, (&nalgebra::Vector3<f64>, &String))| {
        let [x, y, _] = frd(arm);
        let why = format!("{name}, from the centre of mass that was found");
        [("PX", x, std_x), ("PY", y, std_y)].map(|(end, value, std)| {
            AircraftParameter::number(format!("CA_ROTOR{index}_{end}"), (value, std), "m", why.clone())
        })
    };
    arms.iter().zip(&motors).enumerate().flat_map(place).collect()
}

fn coefficients(source: &mut Source<'_>, determined: &Determined<'_>) -> Vec<AircraftParameter> {
    let Some(std) = determined.std("weak_rotor", "factor") else { return Vec::new() };
    if !source.has("weak_rotor") {
        return Vec::new();
    }
    let rotor = source.take_or("weak_rotor", "rotor", f64::NAN);
    let factor = source.take("weak_rotor", "factor");
    let factors = source.rotor_factors();
    let one = |(index, rotor_file): (usize, &crate::vehicle::Rotor)| {
        let is_weak = (index as f64 - rotor).abs() < 0.5;
        let name = format!("CA_ROTOR{index}_CT");
        let motor = rotor_file.motor_words(index);
        if is_weak {
            let why = format!(
                "{motor}: it gives {} of the others' thrust; repair it rather than fly with this",
                with_error(factor, std)
            );
            AircraftParameter::number(name, (CT * factor, CT * std), "-", why)
        } else {
            let own = factors.get(index).copied().unwrap_or(1.0);
            let why = format!(
                "{motor}: PX4's own {CT}{}, beside which the weak one's stands; PX4 takes their ratios alone, whose error is the weak one's",
                if own < 1.0 { format!(" times {} of the model", compact(own)) } else { String::new() }
            );
            AircraftParameter::switch(name, CT * own, false, why)
        }
    };
    source.vehicle.rotors.iter().enumerate().map(one).collect()
}
