//! Requirements of a signature on the flights and on the vehicle file.

use super::trace::Trace;
use crate::physics::Airframe;
use crate::vehicle::Vehicle;

/// A requirement on a flight.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Need {
    /// velocity and attitude
    Velocity,
    /// position and attitude
    Position,
    /// specific force
    Accelerometer,
    /// accelerometer, velocity and attitude: the force is measured twice
    ForceTwice,
    /// accelerometer, velocity and attitude, and a position that is not by satellites
    Frame,
    /// position and attitude, not by satellites: a flight under a ceiling
    UnderRoof,
    /// battery voltage
    Voltage,
    /// commands and body rates fast enough to compare torques row by row, in one of the flights
    Torques,
    /// the effect has a time in one flight
    OneFlight,
}

impl Need {
    /// The needed quantity, and the reason, as text.
    #[must_use]
    pub fn words(self) -> (&'static str, &'static str) {
        match self {
            Self::Velocity => ("velocity and attitude", "it acts by how the vehicle moves"),
            Self::Position => ("position and attitude", "it acts by where the vehicle is"),
            Self::Accelerometer => ("accelerometer", "only the inertial unit sees it"),
            Self::ForceTwice => (
                "accelerometer, velocity and attitude",
                "it shows in the difference between the inertial unit and the position reference",
            ),
            Self::Frame => (
                "accelerometer, velocity, attitude and a position reference with axes of its own",
                "a satellite receiver has none that could be askew",
            ),
            Self::UnderRoof => (
                "position and attitude, the position not by satellites",
                "where satellites are received there is no ceiling",
            ),
            Self::Voltage => ("battery voltage", "thrust falls with it; record BATTERY_STATUS or SYS_STATUS"),
            Self::Torques => (
                "fast actuator commands and body rates",
                "only torques distinguish it from similar effects; record both at 20 Hz at least",
            ),
            Self::OneFlight => ("one flight", "its moment belongs to one"),
        }
    }
}

/// The flights of a vehicle, as a signature sees them.
#[derive(Debug)]
pub struct Recorded<'a> {
    /// by its vehicle file
    pub vehicle: &'a Vehicle,
    /// geometry of the rotors; `None` if the vehicle file is not physical
    pub airframe: Option<Airframe>,
    /// one or more
    pub flights: &'a [Trace],
}

impl<'a> Recorded<'a> {
    /// The flights of a vehicle.
    #[must_use]
    pub fn new(vehicle: &'a Vehicle, flights: &'a [Trace]) -> Self {
        Self { vehicle, airframe: Airframe::new(vehicle).ok(), flights }
    }

    /// Whether a condition holds in every flight.
    #[must_use]
    pub fn all(&self, what: fn(&Trace) -> bool) -> bool {
        self.flights.iter().all(what)
    }

    /// Whether torques are compared in one of the flights.
    #[must_use]
    pub fn compares_torques(&self) -> bool {
        self.flights.iter().any(|trace| trace.torques)
    }

    /// Shares of a force that may act at the rotors' hubs, the rest at the centre of mass. The lever shows only in torques:
    /// where none are compared, there is one form.
    #[must_use]
    pub fn shares_at_hubs(&self) -> &'static [f64] {
        if self.compares_torques() { &[1.0, 0.0] } else { &[1.0] }
    }

    /// The first requirement of an effect that the flights do not satisfy, with its words.
    #[must_use]
    pub fn lacks(&self, needs: &[Need]) -> Option<(Need, &'static str, &'static str)> {
        let unmet = needs.iter().copied().find(|need| !self.has(*need))?;
        let (what, why) = unmet.words();
        Some((unmet, what, why))
    }

    fn has(&self, need: Need) -> bool {
        match need {
            Need::Velocity => self.all(|trace| trace.known.velocity && trace.known.attitude),
            Need::Position => self.all(|trace| trace.known.position && trace.known.attitude),
            Need::Accelerometer => self.all(Trace::has_accelerometer),
            Need::ForceTwice => self.all(Trace::reads_force_twice),
            Need::Frame => self.all(|trace| trace.reads_force_twice() && !trace.position_by_receiver),
            Need::UnderRoof => self.has(Need::Position) && self.all(|trace| !trace.position_by_receiver),
            Need::Voltage => self.full_voltage().is_some(),
            Need::Torques => self.compares_torques(),
            Need::OneFlight => self.flights.len() == 1,
        }
    }

    /// Highest voltage that is held for a while, V.
    #[must_use]
    pub fn full_voltage(&self) -> Option<f64> {
        let mut full: Option<f64> = None;
        for trace in self.flights {
            let voltage = trace.voltage_v.as_ref()?;
            let used = trace.centers.iter().map(|&center| voltage[center]).filter(|v| *v > 0.0);
            let most = used.fold(0.0, f64::max);
            full = Some(full.map_or(most, |full| full.max(most)));
        }
        full.filter(|full_v| (2.5..60.0).contains(full_v))
    }
}

/// Difference between the greatest and the least height of a flight, m: the greatest of them.
pub(super) fn heights_flown_m(flights: &[Trace]) -> f64 {
    let span = |trace: &Trace| {
        let heights = trace.centers.iter().map(|&row| trace.states[row].position_m.z);
        let (least, most) =
            heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), z| (least.min(z), most.max(z)));
        (most - least).max(0.0)
    };
    flights.iter().map(span).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::ExplainSettings;
    use crate::diagnose::made_flights::flown;
    use crate::simulate::RandomTrajectory;

    #[test]
    fn no_ceiling_is_over_a_vehicle_that_receives_satellites() {
        let (mut signals, vehicle) = flown(29, &RandomTrajectory::default(), |_, _| ());
        let mut lacks = |by_receiver| {
            signals.quality.position_by_receiver = by_receiver;
            let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
            Recorded::new(&vehicle, &flights).lacks(&[Need::UnderRoof]).map(|(need, ..)| need)
        };
        assert_eq!(lacks(false), None);
        assert_eq!(lacks(true), Some(Need::UnderRoof));
        signals.position = None;
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        assert!(Recorded::new(&vehicle, &flights).lacks(&[Need::UnderRoof]).is_some());
    }
}
