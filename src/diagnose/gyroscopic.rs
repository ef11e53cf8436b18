//! Simulators that turn the vehicle without the gyroscopic torque `w x J w` that acts on every body.

use super::base::Base;
use super::channels::{AXES, Channels, Nuisance, NuisanceColumn, append};
use super::fit::Fitted;
use super::nuisances::gyroscopic_column;
use super::trace::Trace;
use crate::note::{About, Note};
use crate::vehicle::Guessed;

/// Share of the gyroscopic torque that acts on the vehicle of a simulator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GyroscopicShare {
    /// 1 of a body, about 0 where it is left out
    pub value: f64,
    /// standard error
    pub std: f64,
}

impl GyroscopicShare {
    /// What is to be said of it.
    #[must_use]
    pub fn note(&self) -> Note {
        let Self { value, std } = self;
        let text = format!(
            "this simulator turns the vehicle without its gyroscopic torque: {value:.2} +- {std:.2} of w x J w acts, 1 on every real \
             vehicle. It is estimated together with the inertia, and the model has it (body.gyroscopic)"
        );
        Note::remark(About::Estimate, text)
    }
}

/// Standard errors by which the share must be below the whole: as for a name.
const CERTAIN: f64 = 4.0;

/// Standard errors by which the share may be below none. The usual two.
const POSSIBLE: f64 = 2.0;

/// Error of the share beside that of noise: the moments it rests on are known to a few percent, and so is their difference, which is
/// about a third of them. Simulators leave out all of it, so a share in between is an error of the model.
const MODEL_STD: f64 = 0.2;

/// The start of a fit that estimates the share, where a simulator flew and the flights tell that it leaves the torque out. A real
/// vehicle always has it.
pub(super) fn left_out(flights: &[Trace], fitted: &Fitted, start: &Base) -> Option<Base> {
    let simulated = flights.iter().all(|trace| trace.simulated) && fitted.rows.compares_torques;
    // with a guessed torque about z, izz is one, and so is what the others turn it by
    let guessed = [Guessed::TorqueRatio, Guessed::Arms];
    let simulated = simulated && start.vehicle.guesses.iter().all(|guess| !guessed.contains(&guess.of));
    if !simulated || start.estimates_gyroscopic {
        return None;
    }
    let mut column = Channels::default();
    for trace in flights {
        append(&mut column, &gyroscopic_column(trace, &fitted.base.vehicle.body));
    }
    // where hardly anything turns about two axes at once, nothing is told
    if column[3..AXES].iter().flatten().all(|value| *value == 0.0) {
        return None;
    }
    let evidence = fitted.weighted.test(&[column])?;
    let (more, std) = (*evidence.theta.first()?, evidence.std(0));
    let now = fitted.base.vehicle.body.gyroscopic;
    let share = now + more;
    tracing::debug!(share, std, "gyroscopic torque of a simulator tested");
    let error = std.hypot(MODEL_STD);
    if !(now - share > CERTAIN * error && std > 0.0) {
        return None;
    }
    // no body has less than none of it: something else turns the vehicle, and this is no measure of it
    if share < -POSSIBLE * error {
        tracing::info!(share, std, "gyroscopic torque is not estimated: its share is none that a body has");
        return None;
    }
    let mut base = start.clone();
    base.vehicle.body.gyroscopic = share.clamp(0.0, 1.0);
    base.estimates_gyroscopic = true;
    Some(base)
}

impl Fitted {
    /// The share of the gyroscopic torque, where it was estimated.
    #[must_use]
    pub fn gyroscopic(&self) -> Option<GyroscopicShare> {
        let of = |column: &NuisanceColumn| column.nuisance == Nuisance::Gyroscopic;
        let place = self.rows.nuisances.iter().position(of)?;
        let std = self.covariance[(place, place)].max(0.0).sqrt();
        Some(GyroscopicShare { value: self.base.vehicle.body.gyroscopic, std })
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use crate::diagnose::{ExplainSettings, Explanation, explain};
    use crate::signals::{ConditionSettings, condition};
    use crate::simulate::{
        FlightSettings, RandomTrajectory, Reference, Truth, random_vehicle, simulate_flight,
    };
    use crate::vehicle::Vehicle;

    /// A flight of a vehicle on which this share of the gyroscopic torque acts, of a simulator or not.
    fn explained(share: f64, simulated: bool) -> (Explanation, Vehicle) {
        let pair = random_vehicle(48);
        let trajectory = RandomTrajectory::default().draw(4801).unwrap();
        let reference = Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
        let mut truth = Truth::clean(pair.truth.clone());
        truth.vehicle.body.gyroscopic = share;
        let settings = FlightSettings { seed: 48, ..FlightSettings::default() };
        let flight = simulate_flight(truth, &pair.nominal, &reference, &settings).unwrap();
        let mut recording = flight.recording;
        let id = if simulated { 2_753_028.0 } else { 1_442_082.0 };
        recording.parameters.insert("INS_ACC_ID".to_owned(), id);
        let conditioning = ConditionSettings { transient_s: Some(1.0), ..ConditionSettings::default() };
        let signals = condition(&recording, &pair.nominal, &conditioning).unwrap();
        (explain(&[signals], &pair.nominal, &ExplainSettings::default()).unwrap(), pair.truth)
    }

    #[test]
    fn a_simulator_without_the_torque_is_told_and_its_inertia_is_right() {
        let (found, truth) = explained(0.0, true);
        let share = found.search.after.gyroscopic().unwrap();
        assert!(share.value.abs() < 4.0 * share.std + 0.02 && share.std < 0.2, "{share:?}");
        assert_eq!(found.search.after.base.vehicle.body.gyroscopic, share.value);
        let (body, true_body) = (&found.search.after.base.vehicle.body, &truth.body);
        for axis in 0..3 {
            let (moment, of) = (body.inertia_kg_m2[(axis, axis)], true_body.inertia_kg_m2[(axis, axis)]);
            assert!((moment / of - 1.0).abs() < 0.05, "axis {axis}: {moment}, not {of}");
        }
        assert!(share.note().sentence().contains("without its gyroscopic torque"));
    }

    #[test]
    fn a_rigid_body_keeps_it_whoever_flew_it() {
        for simulated in [true, false] {
            let (found, _) = explained(1.0, simulated);
            assert_eq!(found.search.after.gyroscopic(), None);
            assert_eq!(found.search.after.base.vehicle.body.gyroscopic, 1.0);
        }
        // and a real vehicle always has it
        assert_eq!(explained(0.0, false).0.search.after.gyroscopic(), None);
    }
}
