//! What was asked for: names, what they need of the recording, and the forms in which each is tried.

use super::error::TogetherError;
use crate::diagnose::base::Present;
use crate::diagnose::candidates::{ceilings_m, change_times, full_voltage, present};
use crate::diagnose::trace::Trace;
use crate::physics::effects::{ALL, by_id};
use crate::physics::{ActiveEffect, Airframe, Effect};

/// Between command and rotor: these act through the latency, not through columns of their own.
const LATENCIES: [&str; 2] = ["motor_lag", "transport_delay"];
/// Forces of the air: wind shows through these alone.
const OF_AIR: [&str; 6] =
    ["linear_drag", "quadratic_drag", "blade_flapping", "translational_lift", "inflow", "vortex_ring"];
/// Names of what is identified in any case.
const ALWAYS: [&str; 3] = ["thrust_scale", "torque_scale", "inertia_products"];

/// Decays of the exponential ground effect that are tried.
const DECAYS: [f64; 3] = [0.4, 0.8, 1.6];
/// Shortest and longest cord of a load that is tried, m.
const CORDS_M: (f64, f64) = (0.2, 4.0);
/// What the air takes of its swing, 1/s, with the ratio of the cords that are tried: neighbours stay in step while the
/// swing lasts, or are a tenth of a period apart after a minute.
const SWINGS: [(f64, f64); 3] = [(0.0, 1.015), (0.1, 1.03), (0.5, 1.1)];
/// A line that is carried shows only once it weighs something, kg/m.
const LINE_KG_M: f64 = 0.01;
/// Lengths of a tether that are tried, of the farthest distance flown.
const TAUT_AT: [f64; 6] = [0.4, 0.55, 0.7, 0.8, 0.9, 0.96];

/// The effects that are to be identified, each of them once.
#[derive(Debug, Clone)]
pub struct Wanted {
    effects: Vec<&'static dyn Effect>,
}

impl Wanted {
    /// From names as the user gives them.
    ///
    /// # Errors
    /// [`TogetherError`] for a name that is none, is there twice, or cannot be identified as parameters.
    pub fn of(names: &[String]) -> Result<Self, TogetherError> {
        let mut effects: Vec<&'static dyn Effect> = Vec::with_capacity(names.len());
        for name in names {
            let name = name.trim();
            if ALWAYS.contains(&name) {
                return Err(TogetherError::Always { id: name.to_owned() });
            }
            let effect = by_id(name).ok_or_else(|| TogetherError::Unknown { id: name.to_owned() })?;
            if effects.iter().any(|known| known.id() == effect.id()) {
                return Err(TogetherError::Twice { id: effect.id() });
            }
            if effect.id() == "gust" {
                return Err(TogetherError::Gust);
            }
            effects.push(effect);
        }
        if effects.is_empty() {
            return Err(TogetherError::Unknown { id: String::new() });
        }
        Ok(Self { effects })
    }

    /// In the order in which they were asked for.
    #[must_use]
    pub fn effects(&self) -> &[&'static dyn Effect] {
        &self.effects
    }

    /// Some of them act between the command and the rotor's speed: commands must be used, not measured speeds.
    #[must_use]
    pub fn need_commands(&self) -> bool {
        self.effects.iter().any(|effect| effect.is_before_speed())
    }

    /// Asked for.
    #[must_use]
    pub fn has(&self, id: &str) -> bool {
        self.effects.iter().any(|effect| effect.id() == id)
    }

    /// Effects with columns of their own.
    pub(super) fn with_columns(&self) -> impl Iterator<Item = &'static dyn Effect> + '_ {
        self.effects.iter().copied().filter(|effect| !is_latency(effect.id()))
    }

    /// Wind without anything through which it acts; `known` is what the vehicle's file has.
    ///
    /// # Errors
    /// [`TogetherError::WindAlone`].
    pub fn check_wind(&self, known: &[ActiveEffect]) -> Result<(), TogetherError> {
        let of_air = OF_AIR.iter().any(|id| self.has(id) || known.iter().any(|of| of.effect().id() == *id));
        if self.has("steady_wind") && !of_air { Err(TogetherError::WindAlone) } else { Ok(()) }
    }

    /// What the flights must hold and the vehicle's description must state for each of them.
    pub(super) fn check_flights(&self, flights: &[Trace], airframe: &Airframe) -> Result<(), TogetherError> {
        let all = |what: fn(&Trace) -> bool| flights.iter().all(what);
        let moving = all(|trace| trace.known.velocity && trace.known.attitude);
        let placed = all(|trace| trace.known.position && trace.known.attitude);
        for effect in &self.effects {
            let id = effect.id();
            let lacks = |what: &'static str, why: &'static str| TogetherError::Stream { id, what, why };
            if let Some(what) = effect.missing(airframe) {
                return Err(crate::physics::PhysicsError::Missing { id, what }.into());
            }
            if effect.is_before_speed() && flights.iter().any(|trace| trace.measured_speeds) {
                return Err(lacks(
                    "actuator commands",
                    "it acts between the command and the rotor's speed, and only measured speeds are recorded",
                ));
            }
            match id {
                "battery_sag" if full_voltage(flights).is_none() => {
                    return Err(lacks(
                        "battery voltage",
                        "thrust falls with it; record BATTERY_STATUS or SYS_STATUS",
                    ));
                }
                "ground_effect" | "ceiling_effect" | "tether" if !placed => {
                    return Err(lacks("position and attitude", "it acts by where the vehicle is"));
                }
                _ if (OF_AIR.contains(&id) || matches!(id, "steady_wind" | "slung_load")) && !moving => {
                    return Err(lacks("velocity and attitude", "it acts by how the vehicle moves"));
                }
                "imu_offset" | "imu_misalignment" if !all(Trace::has_accelerometer) => {
                    return Err(lacks("accelerometer", "only the inertial unit sees it"));
                }
                "imu_misalignment" | "frame_misalignment" if !all(Trace::reads_force_twice) => {
                    return Err(lacks(
                        "accelerometer, velocity and attitude",
                        "it shows in the difference between the inertial unit and the position reference",
                    ));
                }
                "mass_change" if flights.len() > 1 => {
                    return Err(TogetherError::SeveralFlights { id, flights: flights.len() });
                }
                _ => {}
            }
        }
        Ok(())
    }

    /// The forms in which an effect is tried: start values, and what of them is estimated.
    pub(super) fn forms(&self, id: &str, flights: &[Trace], airframe: &Airframe) -> Vec<Present> {
        let one = |values: &[f64], free: &[usize]| present(id, values, free);
        let hubs = [1.0, 0.0];
        let forms: Vec<Option<Present>> = match id {
            // inflow is the same term as the drag's z
            "linear_drag" if self.has("inflow") => {
                hubs.map(|at_hubs| one(&[0.0, 0.0, 0.0, at_hubs], &[0, 1, 3])).to_vec()
            }
            "linear_drag" => hubs.map(|at_hubs| one(&[0.0, 0.0, 0.0, at_hubs], &[0, 1, 2, 3])).to_vec(),
            "inflow" => hubs.map(|at_hubs| one(&[0.0, at_hubs], &[0, 1])).to_vec(),
            "quadratic_drag" => hubs.map(|by_face| one(&[0.0, 0.0, 0.0, by_face], &[0, 1, 2, 3])).to_vec(),
            "ground_effect" => {
                let inverse = hubs.map(|levelling| one(&[0.0, 0.0, 1.0, levelling], &[0, 3]));
                let exponential = DECAYS.map(|decay| one(&[0.0, 0.1, decay, 1.0], &[1, 2, 3]));
                inverse.into_iter().chain(exponential).collect()
            }
            "ceiling_effect" => ceilings_m(flights, airframe)
                .into_iter()
                .map(|height_m| one(&[3.0, 0.0, height_m], &[0, 2]))
                .collect(),
            "weak_rotor" => {
                (0..airframe.rotor_count()).map(|rotor| one(&[rotor as f64, 1.0], &[1])).collect()
            }
            "battery_sag" => {
                full_voltage(flights).into_iter().map(|full_v| one(&[0.0, full_v], &[0])).collect()
            }
            "slung_load" => {
                let of = |(damping_1_s, ratio): (f64, f64)| {
                    cords_m(ratio).into_iter().map(move |length_m| one(&[0.0, length_m, damping_1_s], &[0]))
                };
                SWINGS.into_iter().flat_map(of).collect()
            }
            "mass_change" => {
                let times = flights.first().map(change_times).unwrap_or_default();
                times.into_iter().map(|time_s| one(&[time_s, 0.0], &[1])).collect()
            }
            "tether" => {
                let far_m = farthest_m(flights);
                let slack = [one(&[0.0, 0.0, 500.0], &[0]), one(&[LINE_KG_M, 0.0, 500.0, 0.5], &[0, 3])];
                let taut = TAUT_AT.iter().map(|share| share * far_m).filter(|length_m| *length_m > 0.5);
                slack.into_iter().chain(taut.map(|length_m| one(&[0.0, 0.0, length_m], &[0, 1, 2]))).collect()
            }
            "thrust_curve" => vec![one(&[0.0], &[0]), one(&[0.0; 2], &[0, 1])],
            // turned with the attitude, its heading is for no equation of the vehicle's own motion to see; or only
            // the position is askew
            "frame_misalignment" => vec![one(&[0.0; 3], &[0, 1]), one(&[0.0; 4], &[0, 1, 2])],
            // up comes when the rest is known
            "steady_wind" => vec![one(&[0.0; 3], &[0, 1])],
            _ => {
                let count = by_id(id).map_or(0, |effect| effect.parameters().len());
                vec![one(&vec![0.0; count], &(0..count).collect::<Vec<_>>())]
            }
        };
        forms.into_iter().flatten().collect()
    }
}

/// Acts through the latency.
pub(super) fn is_latency(id: &str) -> bool {
    LATENCIES.contains(&id)
}

/// All names, for messages.
pub(super) fn names() -> String {
    ALL.iter().map(|effect| effect.id()).collect::<Vec<_>>().join(", ")
}

/// Lengths of a cord that are tried, m, each so many times the one before.
fn cords_m(ratio: f64) -> Vec<f64> {
    let mut out = vec![CORDS_M.0];
    while let Some(last_m) = out.last().map(|length_m| length_m * ratio).filter(|m| *m <= CORDS_M.1) {
        out.push(last_m);
    }
    out
}

/// From the world's origin, m.
fn farthest_m(flights: &[Trace]) -> f64 {
    let flown = flights
        .iter()
        .flat_map(|trace| trace.centers.iter().map(move |&row| trace.states[row].position_m.norm()));
    flown.fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_effect_is_taken_or_refused_with_a_reason() {
        for effect in ALL {
            match Wanted::of(&[format!(" {} ", effect.id())]) {
                Ok(wanted) => assert!(wanted.has(effect.id()) && wanted.effects().len() == 1),
                Err(error) => assert_eq!((error, effect.id()), (TogetherError::Gust, "gust")),
            }
        }
        assert!(Wanted::of(&["motor_lag".to_owned()]).is_ok_and(|wanted| wanted.need_commands()));
        assert!(Wanted::of(&["com_offset".to_owned()]).is_ok_and(|wanted| !wanted.need_commands()));
    }

    #[test]
    fn wind_that_the_files_drag_carries_is_not_alone() {
        let wind = Wanted::of(&["steady_wind".to_owned()]);
        let drag = ActiveEffect::named("linear_drag", &[("dx", 0.1), ("dy", 0.1), ("dz", 0.0)]);
        let (wind, drag) = (wind.unwrap(), drag.unwrap());
        assert_eq!(wind.check_wind(&[]), Err(TogetherError::WindAlone));
        assert_eq!(wind.check_wind(&[drag]), Ok(()));
    }

    #[test]
    fn cords_reach_from_the_shortest_to_the_longest() {
        for (_, ratio) in SWINGS {
            let cords = cords_m(ratio);
            assert!(cords.windows(2).all(|pair| pair[1] > pair[0]) && cords[0] == CORDS_M.0);
            assert!(cords.last().is_some_and(|last| *last <= CORDS_M.1 && *last * ratio > CORDS_M.1));
        }
    }
}
