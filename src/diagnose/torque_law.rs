//! The law of the rotors' torque about their axes. A vehicle file states one ratio of torque and thrust; where the torque does not go
//! with the thrust, another thrust has another ratio.
//!
//! `tau = kappa T (T / T_hover)^e`: the rotors together turn the vehicle about z by more where they lift more, and by the product of
//! their differences in roll and pitch. The mean thrust tells the exponent; the product, which a load beside the centre alters, is estimated
//! beside it and must not contradict it.

use super::channels::{Channels, append, channels, nothing};
use super::fit::Fitted;
use super::gates::{Gates, NAME_Z};
use super::rotors::{RotorMotion, Thrusts};
use super::trace::Trace;
use crate::estimate::Estimated;
use crate::note::{About, Note};
use crate::physics::Airframe;
use nalgebra::Vector3;

/// The rotors' torque goes with this power of their thrust, where it is certain that it does not go with the thrust itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TorqueLaw {
    /// 1 of a torque that is in proportion to the thrust
    pub exponent: f64,
    /// its standard error
    pub std: f64,
}

impl TorqueLaw {
    /// What is to be said of it.
    #[must_use]
    pub fn note(&self) -> Note {
        let Self { exponent, std } = self;
        let text = format!(
            "the yaw torque of the rotors does not go with their thrust, as the vehicle file states it: it goes with the power \
             {exponent:.2} +- {std:.2} of the thrust. No torque per thrust (torque_ratio) holds at every thrust, so izz is not known"
        );
        Note::warning(About::Vehicle, text)
    }

    /// The same estimate with the error that this law brings into the moment about z: the change of the torque with the thrust is not its
    /// stated ratio.
    #[must_use]
    pub fn in_errors_of(&self, mut estimated: Estimated) -> Estimated {
        let (entry, izz) = (ABOUT_Z, estimated.theta[ABOUT_Z]);
        if estimated.covariance[(entry, entry)] > 0.0 {
            estimated.covariance[(entry, entry)] += ((self.exponent - 1.0) * izz).powi(2);
        }
        Estimated { torque_exponent: Some(self.exponent), ..estimated }
    }
}

/// Izz in `Theta`.
pub(super) const ABOUT_Z: usize = 6;
/// An exponent nearer to one than this is ordinary: the ratio of torque and thrust changes by a tenth with Reynolds number over the range of
/// a rotor.
const ORDINARY: f64 = 0.2;
/// Added to the least number of standard errors of a name: no name is expected of it, and it must not be said of a vehicle without
/// reason.
const EXTRA_Z: f64 = 1.0;
/// Standard errors by which the product of the differences in roll and pitch may show the contrary. The usual three.
const OPPOSITE: f64 = 3.0;
/// Standard deviation by which the exponents of flights of one vehicle differ beside their errors. On ten flights of ArduCopter's simulator,
/// whose torque goes with the power 1.7 to 1.8, they are 1.31 to 1.77.
const OF_FLIGHTS: f64 = 0.2;
/// Least share of the yaw torque that the rigid body explains.
const EXPLAINED: f64 = 0.5;
/// Least thrust of a rotor over that of hover whose power is taken: below, a rotor hardly turns.
const LEAST_THRUST: f64 = 0.02;

/// The torque law, where the flights tell that it is another than stated.
pub(super) fn torque_law(flights: &[Trace], fitted: &Fitted) -> Option<TorqueLaw> {
    let told = fitted.rows.compares_torques
        && fitted.base.effects.iter().all(|term| term.signature.role.bends_thrust.is_none());
    if !told || fitted.rigid_body().explained.is_none_or(|explained| explained[2] < EXPLAINED) {
        return None;
    }
    let airframe = Airframe::new(&fitted.base.vehicle).ok()?;
    let mut all: [Channels; 3] = Default::default();
    for (index, trace) in flights.iter().enumerate() {
        let (commanded, motion) = (fitted.rows.commanded(index)?, fitted.rows.moved(index)?);
        for (all, part) in all.iter_mut().zip(columns(trace, &airframe, commanded, motion)) {
            append(all, &part);
        }
    }
    let [thrust, level, across] = all;
    let alone = fitted.weighted.test(std::slice::from_ref(&level))?;
    let beside = fitted.weighted.test(&[thrust, across, level])?;
    let (of_thrust, by_across, by) = (beside.theta[0], beside.theta[1], beside.theta[2]);
    let (across_std, own_std) = (beside.std(1), beside.std(2));
    let p = alone.p_cluster;
    tracing::debug!(by, own_std, of_thrust, by_across, across_std, p, "law of the rotors' torque tested");
    let certain = by.abs() > (NAME_Z + EXTRA_Z) * own_std && p < Gates::default().p_cluster;
    let large = by.abs() > ORDINARY + 2.0 * own_std && of_thrust.abs() < 0.5 * by.abs();
    let contradicted = by_across * by.signum() < -OPPOSITE * across_std || alone.theta[0] * by < 0.0;
    if !(certain && large && own_std > 0.0) || contradicted {
        return None;
    }
    Some(TorqueLaw { exponent: 1.0 + by, std: own_std.hypot(OF_FLIGHTS) })
}

/// Force and torque per unit of the exponent: of the thrust itself, of the torque by the mean thrust, and of the rest of the torque.
fn columns(
    trace: &Trace,
    airframe: &Airframe,
    commanded: &RotorMotion,
    motion: &RotorMotion,
) -> [Channels; 3] {
    let count = airframe.rotor_count();
    let hover_n = airframe.hover_thrust_n;
    let relative = |thrust_n: f64| (thrust_n / hover_n).max(LEAST_THRUST);
    let powered = |thrusts: &Thrusts| {
        let mut out = *thrusts;
        out[..count].iter_mut().for_each(|thrust| *thrust *= relative(*thrust).ln());
        airframe.thrust_wrench(&out)
    };
    let instants = 0..trace.grid.count;
    let used = |index: usize| if trace.usable[index] { 1.0 } else { 0.0 };
    let force = |index: usize| powered(&commanded.thrust_n.at(index)).force_n * used(index);
    let torque = |index: usize| powered(&motion.thrust_n.at(index)).torque_nm * used(index);
    let by_level = |index: usize| {
        let thrusts = motion.thrust_n.at(index);
        let level = relative(thrusts[..count].iter().sum::<f64>() / count as f64).ln();
        Vector3::z() * (airframe.thrust_wrench(&thrusts).torque_nm.z * level * used(index))
    };
    let torques: Vec<Vector3<f64>> = instants.clone().map(torque).collect();
    let level: Vec<Vector3<f64>> = instants.clone().map(by_level).collect();
    let across: Vec<Vector3<f64>> =
        torques.iter().zip(&level).map(|(all, level)| Vector3::z() * (all.z - level.z)).collect();
    let forces: Vec<Vector3<f64>> = instants.map(force).collect();
    [
        channels(trace, trace.weak_vector(0, &forces), trace.weak_vector(0, &torques)),
        channels(trace, nothing(trace), trace.weak_vector(0, &level)),
        channels(trace, nothing(trace), trace.weak_vector(0, &across)),
    ]
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::{ExplainSettings, Explanation, explain};
    use crate::physics::{ActiveEffect, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};
    use crate::simulate::RandomTrajectory;
    use crate::vehicle::Vehicle;

    /// Torques that go with a power of the thrust.
    #[derive(Debug)]
    struct Powered;

    const EXPONENT: &[Parameter] = &[Parameter { name: "e", unit: "-", bounds: Bounds::of(-1.0, 2.0) }];

    impl Effect for Powered {
        fn id(&self) -> &'static str {
            "powered"
        }

        fn sentence(&self) -> &'static str {
            "The rotors' torque goes with a power of their thrust."
        }

        fn equation(&self) -> &'static str {
            "`tau = kappa T (T / T_hover)^e`"
        }

        fn parameters(&self) -> &'static [Parameter] {
            EXPONENT
        }

        fn hooks(&self) -> &'static [Hook] {
            &[Hook::Wrench]
        }

        fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
            let airframe = at.airframe;
            for (sign, thrust_n) in airframe.yaw_signs().iter().zip(&rotors.thrust_n) {
                let more = (thrust_n / airframe.hover_thrust_n).max(0.0).powf(own.parameters[0]) - 1.0;
                sum.torque_nm.z += sign * airframe.propulsion.torque_per_thrust_m * thrust_n * more;
            }
        }
    }

    fn explained(seed: u64, exponent: f64) -> (Explanation, Vehicle) {
        let (signals, vehicle) = flown(seed, &RandomTrajectory::default(), |truth, _| {
            if exponent != 1.0 {
                truth.effects.push(ActiveEffect::new(&Powered, &[exponent - 1.0]).unwrap());
            }
        });
        (explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap(), vehicle)
    }

    fn told(seed: u64, exponent: f64) -> Option<TorqueLaw> {
        explained(seed, exponent).0.torque_law
    }

    #[test]
    fn izz_stays_as_stated_where_only_its_ratio_to_the_torque_is_told() {
        let (found, stated) = explained(6101, 1.6);
        let of = |found: &Explanation| {
            let vehicle = &found.search.after.base.vehicle;
            (vehicle.body.inertia_kg_m2[(2, 2)], vehicle.propulsion.torque_per_thrust_m)
        };
        let (izz, torque_m) = of(&found);
        assert!((torque_m / stated.propulsion.torque_per_thrust_m - 1.0).abs() < 1e-12);
        let kept = found.keeping_about_z(&stated);
        let (kept_izz, kept_torque_m) = of(&kept);
        let moments = [0, 1].map(|axis| kept.search.after.base.vehicle.body.inertia_kg_m2[(axis, axis)]);
        let nearest = stated.body.inertia_kg_m2[(2, 2)].min((moments[0] + moments[1]) / 1.01);
        assert!((kept_izz / nearest - 1.0).abs() < 0.01, "{kept_izz} and {nearest}");
        assert!((kept_izz / kept_torque_m / (izz / torque_m) - 1.0).abs() < 1e-12);
        // the model of the rigid body alone has an izz that a body can have as well
        let alone = &kept.search.before.base.vehicle.body.inertia_kg_m2;
        assert!(alone[(2, 2)] < alone[(0, 0)] + alone[(1, 1)], "{alone}");
    }

    #[test]
    fn a_torque_that_does_not_go_with_the_thrust_is_told_with_its_power() {
        let law = told(6101, 1.6).unwrap();
        assert!((law.exponent - 1.6).abs() < 2.0 * law.std && law.std < 0.3, "{law:?}");
        let said = law.note().sentence();
        assert!(said.contains("does not go with their thrust"), "{said}");
    }

    #[test]
    fn a_torque_in_proportion_to_the_thrust_is_not_told() {
        for seed in [6101, 6102] {
            assert_eq!(told(seed, 1.0), None, "seed {seed}");
        }
    }
}
