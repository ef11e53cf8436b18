//! A weak rotor shows about every axis at once: its thrust lacks about body x and y, its torque about z. What turns a vehicle about one axis
//! alone is another cause: a load beside the centre, arms that are not straight, motors that lean.

use super::base::Base;
use super::channels::{AXES, Channels};
use super::confusable::confusable_with;
use super::evidence::Weighted;
use super::fit::Fitted;
use super::named::Confusable;
use super::signature::{EffectTerm, Signature};
use super::signatures::signature_of;
use super::tested::Search;
use super::trace::Trace;
use crate::change::NAMED_SIGMAS;
use crate::estimate::{Finding, Nominal, finding, inertia_by_wider_window};
use crate::signals::Signals;
use crate::vehicle::{Mixer, Vehicle};

/// Share of what the other axes show that each axis has to show.
const SHOWN: f64 = 0.5;
/// Ixx and Iyy in `Theta`.
const ACROSS: [usize; 2] = [1, 4];
/// Ordinary scatter of rotors of one vehicle, standard deviation (-): what the others differ by adds to what each axis shows.
const SCATTER: f64 = 0.02;
/// Standard deviations of that scatter by which an axis shows less. One of three axes shows as little by chance in 5 % of cases (2.1 of
/// one side); more would let pass what shows about one axis alone.
const BEYOND_SCATTER: f64 = 2.1;
/// Standard errors from which on the torques about x and y alone show a rotor. The usual three.
const CERTAIN: f64 = 3.0;

/// Whether the axes exclude that this rotor is weak: one of them shows less than half of what the others do, certainly; or a centre of mass
/// that is off is in the model, and nothing but the torque about z, which has other causes too, tells the rotor beside it. Where the
/// torques answer the motion rather than causing it, they tell the balance alone, and a load beside the centre has the same. Of effects
/// that are no rotor's, nothing is excluded. The effect's first column in the model has the index `first`.
pub(super) fn is_refuted(
    (flights, stated): (&[Signals], &Vehicle),
    fitted: &Fitted,
    term: &EffectTerm,
    first: usize,
) -> bool {
    let amount = term.free.iter().position(|slot| term.is_amount(*slot));
    let Some(place) = amount.filter(|_| term.signature.role.which.is_some()) else { return false };
    let rows = &fitted.rows;
    let Some(column) = rows.effects.get(first + place - rows.nuisances.len()) else { return false };
    let size = term.from_nothing(term.free[place]);
    let number = term.signature.role.which.map(|slot| term.values[slot]);
    let Some(rotor) = number.and_then(|number| fitted.base.vehicle.rotor_of(number)) else { return false };
    let mixer = fitted.base.vehicle.mixer();
    // of each axis about the rotor's size
    let information: [f64; 3] = std::array::from_fn(|axis| {
        let sigma = fitted.weighted.sigma[3 + axis];
        let energy: f64 = column[3 + axis].iter().map(|value| value * value).sum();
        if sigma > 0.0 { energy / sigma.powi(2) } else { 0.0 }
    });
    let shows_less = |axis: usize| {
        let mut alone: Channels = std::array::from_fn(|_| vec![0.0; rows.len()]);
        alone[3 + axis].clone_from(&column[3 + axis]);
        // what this axis shows less what the others show
        let Some(evidence) = fitted.weighted.test(&[alone]) else { return false };
        let (apart, std) = (evidence.theta[0] * size.signum(), evidence.std(0));
        let least = SHOWN * size.abs();
        let by_others = ordinary_apart(&mixer, rotor, axis, &information);
        apart < -least.max(NAMED_SIGMAS * std).max(BEYOND_SCATTER * by_others)
    };
    if rows.compares_torques && (0..3).any(shows_less) {
        return true;
    }
    let causes = || causes_motion(inertia_by_wider_window(flights, stated), stated, fitted);
    let told = || shows_across(fitted, first + place, size) && causes();
    is_loaded_aside(&fitted.base) && rows.compares_torques && !told()
}

/// Least weakness of a rotor (-) that gets a name by averaged torques, or beside a centre of mass that is off: the standard deviation of an
/// ordinary rotor's. 0 elsewhere. Set by judgement: there a rotor and a load beside the centre are told less surely apart.
pub(super) fn least_weakness(traces: &[Trace], base: &Base, signature: &Signature) -> f64 {
    let are_averaged = !traces.iter().any(|trace| trace.torques);
    let is_unsure = are_averaged || is_loaded_aside(base);
    if signature.role.which.is_some() && is_unsure { SCATTER } else { 0.0 }
}

/// Standard deviation (-) of what an axis shows of a rotor less what the others show, by the scatter of the other rotors. `information` is
/// that of each axis about the rotor's size. Infinite where the rotor does not act about an axis that is compared.
fn ordinary_apart(mixer: &Mixer, rotor: usize, axis: usize, information: &[f64; 3]) -> f64 {
    let others: Vec<usize> = (0..3).filter(|other| *other != axis && information[*other] > 0.0).collect();
    let all: f64 = others.iter().map(|other| information[*other]).sum();
    // what a weakness of another rotor looks like about an axis, as one of this rotor
    let looks = |axis: usize, other: usize| {
        let (of_other, own) = (mixer.matrix[(1 + axis, other)], mixer.matrix[(1 + axis, rotor)]);
        of_other / own
    };
    let variance: f64 = (0..mixer.matrix.ncols())
        .filter(|other| *other != rotor)
        .map(|other| {
            let mean: f64 = others.iter().map(|axis| information[*axis] / all * looks(*axis, other)).sum();
            (looks(axis, other) - mean).powi(2)
        })
        .sum();
    let std = SCATTER * variance.sqrt();
    if std.is_nan() { f64::INFINITY } else { std }
}

/// The weak rotor of a model that only the balance shows, where a centre of mass that is off has nearly the same one: the torques about x
/// and y answer the motion rather than causing it, and the flights do not tell both apart. A rotor that is so weak is rarer than a load
/// beside the centre, so that the flights are explained without it.
pub(super) fn by_balance_alone(traces: &[Trace], stated: &Vehicle, found: &Search) -> Option<&'static str> {
    let fitted = &found.after;
    let is_rotor = |term: &EffectTerm| term.signature.role.which.is_some();
    let place = fitted.base.effects.iter().position(is_rotor)?;
    if !fitted.rows.compares_torques
        || is_loaded_aside(&fitted.base)
        || causes_motion(found.by_wider_window, stated, fitted)
    {
        return None;
    }
    let is_load = |of: &Confusable| signature_of(of.id).is_some_and(|of| of.role.of_the_loading);
    let alike = confusable_with(traces, fitted, place, (&found.last, &[]));
    let is_alike = alike.iter().any(|of| is_load(of) && !of.is_told_apart());
    is_alike.then(|| fitted.base.effects[place].id())
}

/// Whether the torque about x or y causes the motion about it: the flights determine the moment of inertia. `by_wider_window` are ratios of
/// Ixx, Iyy, Izz by a window of twice the width.
fn causes_motion(by_wider_window: [f64; 3], stated: &Vehicle, fitted: &Fitted) -> bool {
    let estimated = fitted.rigid_body().with_wider_window(by_wider_window);
    let nominal = Nominal::without_guesses(stated);
    let determined = |index| matches!(finding(&estimated, &nominal, index), Finding::Determined { .. });
    determined(ACROSS[0]) || determined(ACROSS[1])
}

fn is_loaded_aside(base: &Base) -> bool {
    base.estimates(|term| term.signature.role.of_the_loading && !term.is_of_every_vehicle(&base.size))
}

/// Whether all but the torque about z shows a size.
fn shows_across(fitted: &Fitted, index: usize, size: f64) -> bool {
    let across = Weighted::without(&fitted.rows, &fitted.weighted, AXES - 1);
    let (coefficients, covariance) = across.coefficients(&fitted.rows);
    let std = covariance[(index, index)].max(0.0).sqrt();
    let shown = (size + coefficients[index]) * size.signum();
    std > 0.0 && shown > CERTAIN * std && shown > SHOWN * size.abs()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;
    use crate::diagnose::explain::{ExplainSettings, explain};
    use crate::diagnose::made_flights::flown;
    use crate::diagnose::signatures::signature_of;
    use crate::physics::ActiveEffect;
    use crate::physics::effects::by_id;
    use crate::simulate::{RandomTrajectory, random_vehicle};
    use statrs::distribution::{ContinuousCDF, Normal};

    /// What the axes show of the first rotor's weakness, if rotors are weak by these shares.
    fn shown(mixer: &Mixer, weak: &[f64]) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let row = mixer.matrix.row(1 + axis);
            row.iter().zip(weak).map(|(arm, weak)| arm * weak).sum::<f64>() / row[0]
        })
    }

    /// Whether an axis shows less, of axes that tell the same; with the scatter of the other rotors, and without.
    fn shows_less(mixer: &Mixer, shown: [f64; 3]) -> (bool, bool) {
        let size = shown.iter().sum::<f64>() / 3.0;
        let less = |scatter: f64| {
            (0..3).any(|axis| {
                let apart = 1.5 * (shown[axis] - size);
                let by_others = scatter * ordinary_apart(mixer, 0, axis, &[1.0; 3]);
                apart < -(SHOWN * size.abs()).max(by_others)
            })
        };
        (less(BEYOND_SCATTER), less(0.0))
    }

    /// Whether a flight whose torques are averaged has a name for a rotor that is weak by this share, and the least that it would name.
    fn named_by_averages(weak: f64) -> (bool, Option<f64>) {
        let (mut signals, vehicle) = flown(23, &RandomTrajectory::default(), |truth, _| {
            truth.effects.push(ActiveEffect::new(by_id("weak_rotor").unwrap(), &[1.0, 1.0 - weak]).unwrap());
        });
        signals.quality.torques = false;
        let found = explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap();
        let limit = found.limits.iter().find(|limit| limit.id == "weak_rotor").map(|limit| limit.limit);
        (found.named.iter().any(|named| named.id == "weak_rotor"), limit)
    }

    #[test]
    fn averaged_torques_need_a_weaker_rotor() {
        let (is_named, limit) = named_by_averages(0.012);
        assert!(!is_named && limit.is_some_and(|limit| limit >= SCATTER), "{is_named} {limit:?}");
        assert!(named_by_averages(0.1).0);
    }

    #[test]
    fn a_rotor_within_the_scatter_of_rotors_gets_no_name_beside_a_centre_of_mass_that_is_off() {
        let (signals, vehicle) = flown(23, &RandomTrajectory::default(), |_, _| {});
        let flights = [Trace::new(&signals, &vehicle, ExplainSettings::default().half_width_s).unwrap()];
        let [rotor, load] = ["weak_rotor", "com_offset"].map(|id| signature_of(id).unwrap());
        let mut base = Base::anchored(&vehicle);
        let least = |base: &Base| [rotor, load].map(|of| least_weakness(&flights, base, of));
        assert_eq!(least(&base), [0.0; 2]);
        // 0.5 % of the arm is ordinary, 10 % are not
        for (share, expected) in [(0.005, 0.0), (0.1, SCATTER)] {
            let mut term = load.whole();
            term.values[0] = share * base.size.arm_m;
            base.effects = vec![term];
            assert_eq!(least(&base), [expected, 0.0]);
        }
    }

    #[test]
    fn a_weak_rotor_among_rotors_that_scatter_is_kept_and_a_torque_about_one_axis_is_not() {
        const STEPS: u32 = 40;
        let mixer = random_vehicle(3).truth.mixer();
        assert_eq!(mixer.matrix.ncols(), 4);
        let law = Normal::standard();
        let scatter = |step: u32| 0.02 * law.inverse_cdf((f64::from(step) + 0.5) / f64::from(STEPS));
        for weak in [0.05, 0.07, 0.1] {
            let (mut refused, mut by_noise_alone, mut all) = (0, 0, 0);
            for step in 0..STEPS.pow(3) {
                let others = [step % STEPS, step / STEPS % STEPS, step / STEPS.pow(2)].map(scatter);
                let (now, before) =
                    shows_less(&mixer, shown(&mixer, &[weak, others[0], others[1], others[2]]));
                refused += u32::from(now);
                by_noise_alone += u32::from(before);
                all += 1;
            }
            let share = |count: u32| f64::from(count) / f64::from(all);
            assert!(share(refused) < 0.1, "{weak}: {}", share(refused));
            assert!(share(by_noise_alone) > 0.2 || weak > 0.09, "{weak}: {}", share(by_noise_alone));
        }
        // a load beside the centre, and a torque about the vertical
        for axis in 0..3 {
            let mut alone = [0.0; 3];
            alone[axis] = 0.3;
            assert!(shows_less(&mixer, alone).0, "axis {axis}");
        }
    }
}
