//! What could have been left out: each effect at the values where it does nothing.

use super::base::Present;
use super::trace::Trace;
use crate::physics::Airframe;
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

/// What the air takes of a load's swing before more is known, 1/s.
const SWING_DAMPING_1_S: f64 = 0.2;

/// Decays per rotor radius of the ground's exponential form that are tried.
const GROUND_DECAYS: [f64; 5] = [0.4, 0.7, 1.2, 2.0, 3.5];

/// Distances of a ceiling over the highest rotor that are tried, rotor radii.
const CEILINGS_RADII: [f64; 7] = [0.5, 1.0, 1.5, 2.0, 3.0, 5.0, 8.0];
/// A ceiling's a1 that is as good as none: the thrust grows with its inverse.
const NO_CEILING: f64 = 50.0;

/// An effect by its identifier; `None` where there is no such effect.
pub(super) fn present(id: &str, values: &[f64], free: &[usize]) -> Option<Present> {
    let effect = by_id(id)?;
    Some(Present { effect, values: values.to_vec(), free: free.to_vec() })
}

/// All candidates that the vehicle's description and the recordings allow.
#[must_use]
pub fn candidates(vehicle: &Vehicle, flights: &[Trace]) -> Vec<Candidate> {
    let known = |what: fn(&Trace) -> bool| flights.iter().all(what);
    let velocity = known(|trace| trace.known.velocity && trace.known.attitude);
    let mut tried: Vec<Option<Present>> = vec![
        present("thrust_curve", &[0.0, 0.0], &[0]),
        present("com_offset", &[0.0; 3], &[0, 1]),
        present("rotor_inertia", &[0.0], &[0]),
        present("angular_damping", &[0.0; 3], &[0, 1, 2]),
        present("angular_damping", &[0.0; 3], &[0, 1]),
    ];
    if velocity {
        tried.extend(of_air());
    }
    if known(|trace| trace.known.position && trace.known.attitude) {
        tried.extend(of_place(vehicle, flights));
    }
    let mut number = 0.0;
    for _ in &vehicle.rotors {
        tried.push(present("weak_rotor", &[number, 1.0], &[1]));
        number += 1.0;
    }
    let by_commands = known(|trace| !trace.measured_speeds);
    if let Some(full_v) = full_voltage(flights).filter(|_| by_commands) {
        tried.push(present("battery_sag", &[0.0, full_v], &[0]));
    }
    if velocity {
        // a load that lies on the ground does not swing
        let height_m = highest_m(flights);
        let cords = CORD_LENGTHS_M.into_iter().filter(|length_m| *length_m < height_m);
        tried.extend(cords.map(|length_m| present("slung_load", &[0.0, length_m, SWING_DAMPING_1_S], &[0])));
    }
    if let [flight] = flights {
        let times = change_times(flight).into_iter();
        tried.extend(times.map(|time_s| present("mass_change", &[time_s, 0.0], &[1])));
    }
    let alone = |part: Present| Candidate { id: part.effect.id(), parts: vec![part], through: None };
    tried.into_iter().flatten().map(alone).collect()
}

/// Forces of the air on a vehicle that moves through it.
fn of_air() -> Vec<Option<Present>> {
    let mut tried = Vec::new();
    // of the rotors, at their hubs, or of the body, at its centre
    for at_hubs in [1.0, 0.0] {
        tried.push(present("linear_drag", &[0.0, 0.0, 0.0, at_hubs], &[0, 1]));
        tried.push(present("linear_drag", &[0.0, 0.0, 0.0, at_hubs], &[0, 1, 2]));
        tried.push(present("inflow", &[0.0, at_hubs], &[0]));
    }
    // of a round body, or of flat faces
    for by_face in [0.0, 1.0] {
        tried.push(present("quadratic_drag", &[0.0, 0.0, 0.0, by_face], &[0, 1]));
        tried.push(present("quadratic_drag", &[0.0, 0.0, 0.0, by_face], &[0, 1, 2]));
    }
    tried.extend(["blade_flapping", "translational_lift", "vortex_ring"].map(|id| present(id, &[0.0], &[0])));
    tried
}

/// What depends on where the vehicle is.
fn of_place(vehicle: &Vehicle, flights: &[Trace]) -> Vec<Option<Present>> {
    let mut tried = vec![
        // all rotors lifted alike, or each by its own height
        present("ground_effect", &[0.0, 0.0, 1.0, 0.0], &[0]),
        present("ground_effect", &[0.0, 0.0, 1.0, 1.0], &[0]),
        present("tether", &[0.0, 0.0, 500.0, 0.0], &[0]),
    ];
    // the exponential form, for each height over which it dies down
    for decay in GROUND_DECAYS {
        tried.push(present("ground_effect", &[0.0, 0.0, decay, 1.0], &[1]));
    }
    let ceilings_m = Airframe::new(vehicle).map(|airframe| ceilings_m(flights, &airframe));
    tried.extend(
        ceilings_m
            .unwrap_or_default()
            .into_iter()
            .map(|height_m| present("ceiling_effect", &[NO_CEILING, 0.0, height_m], &[0])),
    );
    tried
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

/// Above the ground where position is known and the ground is zero, else boundless, m.
fn highest_m(flights: &[Trace]) -> f64 {
    if !flights.iter().all(|trace| trace.known.position) {
        return f64::INFINITY;
    }
    let flown =
        flights.iter().flat_map(|trace| trace.centers.iter().map(|&row| trace.states[row].position_m.z));
    let highest_m = flown.fold(f64::MIN, f64::max);
    if highest_m > 0.0 { highest_m } else { f64::INFINITY }
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

/// Heights that a ceiling may have over the flown ones, m.
pub(super) fn ceilings_m(flights: &[Trace], airframe: &Airframe) -> Vec<f64> {
    let radius_m = airframe.propulsion.rotor_radius_m.unwrap_or(0.0);
    let hub_m = |trace: &Trace, row: usize| {
        let state = &trace.states[row];
        let over = airframe.arms_m().iter().map(|arm| (state.attitude * arm).z).fold(f64::MIN, f64::max);
        state.position_m.z + over
    };
    let flown = flights.iter().flat_map(|trace| trace.centers.iter().map(move |&row| hub_m(trace, row)));
    let top_m = flown.fold(f64::MIN, f64::max);
    CEILINGS_RADII.iter().map(|radii| top_m + radii * radius_m).filter(|height_m| *height_m >= 0.5).collect()
}
