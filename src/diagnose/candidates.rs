//! What could have been left out: each effect at the values where it does nothing.

use super::base::Present;
use super::trace::Trace;
use crate::physics::effects::by_id;
use crate::vehicle::Vehicle;

/// One or more effects that are tried together.
#[derive(Debug, Clone)]
pub struct Candidate {
    /// identifier of the effect that the evidence is about
    pub id: &'static str,
    /// with the values at which they do nothing
    pub parts: Vec<Present>,
    /// columns come through another effect at this value: wind acts through drag
    pub through: Option<Present>,
}

/// Times of a mass change that are tried, s apart.
const MASS_CHANGE_EVERY_S: f64 = 4.0;
/// Lengths of a load's cord that are tried, m: their periods lie 20 % apart.
const CORD_LENGTHS_M: [f64; 7] = [0.25, 0.4, 0.6, 0.9, 1.3, 2.0, 3.0];

/// An effect by its identifier; `None` where there is no such effect.
pub(super) fn present(id: &str, values: &[f64], free: &[usize]) -> Option<Present> {
    let effect = by_id(id)?;
    Some(Present { effect, values: values.to_vec(), free: free.to_vec() })
}

/// All candidates that the vehicle's description and the recordings allow.
#[must_use]
pub fn candidates(vehicle: &Vehicle, flights: &[Trace]) -> Vec<Candidate> {
    let mut out: Vec<Candidate> = Vec::new();
    let mut add = |parts: &[Option<Present>]| {
        let parts: Option<Vec<Present>> = parts.iter().cloned().collect();
        if let Some(parts) = parts.filter(|parts| !parts.is_empty()) {
            out.push(Candidate { id: parts[0].effect.id(), parts, through: None });
        }
    };
    let known = |what: fn(&Trace) -> bool| flights.iter().all(what);
    let velocity = known(|trace| trace.known.velocity && trace.known.attitude);
    if velocity {
        // of the rotors, at their hubs, or of the body, at its centre
        for at_hubs in [1.0, 0.0] {
            add(&[present("linear_drag", &[0.0, 0.0, 0.0, at_hubs], &[0, 1])]);
            add(&[present("linear_drag", &[0.0, 0.0, 0.0, at_hubs], &[0, 1, 2])]);
            add(&[present("inflow", &[0.0, at_hubs], &[0])]);
        }
        add(&[present("quadratic_drag", &[0.0; 3], &[0, 1])]);
        add(&[present("quadratic_drag", &[0.0; 3], &[0, 1, 2])]);
        add(&[present("blade_flapping", &[0.0], &[0])]);
        add(&[present("translational_lift", &[0.0], &[0])]);
        add(&[present("vortex_ring", &[0.0], &[0])]);
    }
    if known(|trace| trace.known.position && trace.known.attitude) {
        // all rotors lifted alike, or each by its own height
        add(&[present("ground_effect", &[0.0, 0.0, 1.0, 0.0], &[0])]);
        add(&[present("ground_effect", &[0.0, 0.0, 1.0, 1.0], &[0])]);
        add(&[present("tether", &[0.0, 0.0, 500.0], &[0])]);
    }
    add(&[present("thrust_curve", &[0.0], &[0])]);
    add(&[present("com_offset", &[0.0; 3], &[0, 1])]);
    add(&[present("thrust_tilt", &[0.0; 2], &[0, 1])]);
    add(&[present("rotor_inertia", &[0.0], &[0])]);
    add(&[present("angular_damping", &[0.0; 3], &[0, 1, 2])]);
    add(&[present("angular_damping", &[0.0; 3], &[0, 1])]);
    let mut number = 0.0;
    for _ in &vehicle.rotors {
        add(&[present("weak_rotor", &[number, 1.0], &[1])]);
        number += 1.0;
    }
    let by_commands = known(|trace| !trace.measured_speeds);
    if let Some(full_v) = full_voltage(flights).filter(|_| by_commands) {
        add(&[present("battery_sag", &[0.0, full_v], &[0])]);
    }
    if velocity {
        for length_m in CORD_LENGTHS_M {
            add(&[present("slung_load", &[0.0, length_m], &[0])]);
        }
    }
    if let [flight] = flights {
        for time_s in change_times(flight) {
            add(&[present("mass_change", &[time_s, 0.0], &[1])]);
        }
    }
    out
}

/// Wind, tried together with drag at the hubs or at the centre: its columns are those that it has through a
/// drag of one unit.
#[must_use]
pub fn drag_and_wind(at_hubs: f64) -> Option<(Present, Present, Present)> {
    let drag = present("linear_drag", &[0.0, 0.0, 0.0, at_hubs], &[0, 1])?;
    let unit = present("linear_drag", &[1.0, 1.0, 0.0, at_hubs], &[])?;
    let wind = present("steady_wind", &[0.0; 3], &[0, 1])?;
    Some((drag, wind, unit))
}

/// Highest voltage that is held for a while, V.
pub(super) fn full_voltage(flights: &[Trace]) -> Option<f64> {
    let mut full: Option<f64> = None;
    for trace in flights {
        let voltage = trace.voltage_v.as_ref()?;
        let used = trace.centers.iter().map(|&center| voltage[center]).filter(|v| *v > 0.0);
        let most = used.fold(0.0, f64::max);
        full = Some(full.map_or(most, |full| full.max(most)));
    }
    full.filter(|full_v| (2.5..60.0).contains(full_v))
}

pub(super) fn change_times(trace: &Trace) -> Vec<f64> {
    let (Some(first), Some(last)) = (trace.centers.first(), trace.centers.last()) else { return Vec::new() };
    let (first_s, last_s) = (trace.grid.time_s(*first), trace.grid.time_s(*last));
    let mut out = Vec::new();
    let mut time_s = first_s + MASS_CHANGE_EVERY_S;
    while time_s < last_s - 0.5 * MASS_CHANGE_EVERY_S {
        out.push(time_s);
        time_s += MASS_CHANGE_EVERY_S;
    }
    out
}
