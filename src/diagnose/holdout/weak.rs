//! The weak form's residual of the frozen models.

use super::bootstrap::{Blocks, Compared, Squares};
use super::ready::Ready;
use super::settings::HoldoutSettings;
use crate::diagnose::base::Base;
use crate::diagnose::channels::{CHANNELS, Channels, Nuisance, SECOND};
use crate::diagnose::empirical::Empirical;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::fit::{Fitted, evaluate};
use crate::diagnose::trace::Trace;
use crate::physics::PhysicsError;
use rayon::prelude::*;

/// Of one held-out flight.
struct Part {
    /// residual of the rigid body alone, by the models for predictions
    before: Channels,
    /// of the model with effects
    after: Channels,
    /// the flight's own fit about that
    own: Fitted,
    /// the same about the model without what is the flight's own
    of_vehicle: Fitted,
    /// vehicle clock, s, from which on the flight is predicted
    from_s: f64,
}

/// Residuals, and the held-out flights' own linear fits about the carried model.
pub(super) struct Weak {
    pub(super) compared: Vec<Option<Compared>>,
    pub(super) own: Vec<Fitted>,
    /// residual if everything is fitted to the held-out flights themselves
    pub(super) own_rms: [f64; CHANNELS],
}

/// Root mean square of each channel (N, N m). The identified values of nuisances that belong to the vehicle (tilt of
/// the frame, timing of the accelerometer, jitter) are kept like all other parameters. The floor is the residual if
/// everything is fitted to the held-out flight itself.
pub(super) fn residuals(
    ready: &[Ready],
    explanation: &Explanation,
    empirical: Option<&Empirical>,
    settings: &HoldoutSettings,
) -> Result<Weak, PhysicsError> {
    let parts: Vec<Part> = ready
        .par_iter()
        .map(|ready| {
            let (trace, search) = (ready.predicted(), &explanation.search);
            let frozen = |base: &Base, from: &Fitted| -> Result<(Channels, Fitted), PhysicsError> {
                let own = own_fit(&trace, base)?;
                Ok((without_known_nuisances(&own, from), own))
            };
            let (base_before, base_after) = ready.pair.predicting();
            let (mut before, _) = frozen(base_before, &search.before)?;
            let scale = base_after.scale_over(base_before);
            before.iter_mut().flatten().for_each(|left| *left *= scale);
            let (mut after, own) = frozen(base_after, &search.after)?;
            if let Some(empirical) = empirical {
                subtract(&mut after, empirical, &trace);
            }
            let of_vehicle = match ready.pair.loaded {
                Some(_) => own_fit(&ready.trace, &ready.pair.after)?,
                None => own.clone(),
            };
            Ok(Part { before, after, own, of_vehicle, from_s: ready.pair.predicted_from_s() })
        })
        .collect::<Result<_, PhysicsError>>()?;
    let mut blocks = Blocks::new(CHANNELS, settings.block_s);
    let (mut floor, mut rows) = ([0.0; CHANNELS], [0; CHANNELS]);
    for (flight, Part { before, after, own, from_s, .. }) in parts.iter().enumerate() {
        let counts: [usize; CHANNELS] = std::array::from_fn(|channel| own.rows.count_of(channel));
        let measured = counts.map(|count| if count > 0 { 1.0 } else { 0.0 });
        // what a flight has its own was taken from its beginning
        for (row, time_s) in own.rows.time_s.iter().enumerate().filter(|(_, time_s)| *time_s >= from_s) {
            let squares = |channels: &Channels| -> [f64; CHANNELS] {
                std::array::from_fn(|channel| channels[channel][row].powi(2))
            };
            let (before, after) = (&squares(before), &squares(after));
            blocks.add((flight, *time_s), Squares { unchanged: None, before, after, count: &measured });
        }
        for (channel, count) in counts.into_iter().enumerate() {
            rows[channel] += count;
            floor[channel] += count as f64 * own.weighted.sigma[channel].powi(2);
        }
    }
    let (mut compared, _) = blocks.compared(settings.draws, settings.seed);
    let own_rms: [f64; CHANNELS] =
        std::array::from_fn(|channel| (floor[channel] / rows[channel].max(1) as f64).sqrt());
    for (entry, own_rms) in compared.iter_mut().zip(own_rms) {
        // force that is read once only has no second reading
        *entry = entry
            .filter(|compared| compared.before.value > 0.0 && own_rms > 0.0)
            // a flight's own fit has no empirical term
            .map(|compared| Compared { floor: empirical.is_none().then_some(own_rms), ..compared });
    }
    Ok(Weak { own_rms, compared, own: parts.into_iter().map(|part| part.of_vehicle).collect() })
}

/// A flight's own linear fit about a model. The size of a change that was before the flight's rows keeps its value: there
/// it cannot be distinguished from the mass.
fn own_fit(trace: &Trace, base: &Base) -> Result<Fitted, PhysicsError> {
    let first_s = trace.centers.first().map(|&center| trace.grid.time_s(center));
    let mut base = base.clone();
    for term in base.effects.iter_mut().filter(|term| term.is_before(first_s)) {
        term.free.clear();
    }
    evaluate(std::slice::from_ref(trace), base)
}

/// The residual without the part of each nuisance: nuisances of the sensors (bias, level of the attitude) as the flight
/// itself determines them, those of the vehicle as they were identified.
fn without_known_nuisances(own: &Fitted, identified: &Fitted) -> Channels {
    let mut residual = own.rows.residual.clone();
    for (index, column) in own.rows.nuisances.iter().enumerate() {
        let share = match column.nuisance {
            // a model without drag has no column for the velocity's error: neither model is given one
            Nuisance::Mass
            | Nuisance::Inertia(_)
            | Nuisance::Gyroscopic
            | Nuisance::Latency
            | Nuisance::VelocityError => continue,
            Nuisance::AccelerometerBias(_)
            | Nuisance::AirMoment(_)
            | Nuisance::Balance(_)
            | Nuisance::Level(_)
            | Nuisance::KinematicLatency
            | Nuisance::LateralLatency => own.coefficients[index],
            Nuisance::GuessedMomentAboutZ
            | Nuisance::ForceLatency
            | Nuisance::TurnedAccelerometer
            | Nuisance::Tilt(_)
            | Nuisance::Jitter => {
                let columns = &identified.rows.nuisances;
                let place = columns.iter().position(|known| known.nuisance == column.nuisance);
                place.map_or(0.0, |index| identified.coefficients[index])
            }
        };
        for (residual, values) in residual.iter_mut().zip(&column.values) {
            residual.iter_mut().zip(values).for_each(|(r, v)| *r -= share * v);
        }
    }
    residual
}

fn subtract(residual: &mut Channels, empirical: &Empirical, trace: &Trace) {
    let force = empirical.weak_force(trace);
    let readings: &[usize] = if trace.reads_force_twice() { &[0, SECOND] } else { &[0] };
    for first in readings {
        for (axis, force) in force.iter().enumerate() {
            residual[first + axis].iter_mut().zip(force).for_each(|(r, f)| *r -= f);
        }
    }
}
