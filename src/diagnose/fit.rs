//! Rigid body, latency and effects fitted to the flights: Gauss-Newton on the weak-form rows.

use super::base::{Base, follows_force};
use super::channels::{AXES, CHANNELS, Channels, Nuisance, NuisanceColumn};
use super::evidence::Weighted;
use super::priors::Alike;
use super::rows::Rows;
use super::scale_error::{beyond_stated_mass, of_scale};
use super::signature::EffectTerm;
use super::trace::Trace;
use crate::estimate::{Estimated, INERTIA_ENTRIES, THETA, ThetaCovariance, theta_of};
use crate::physics::PhysicsError;
use crate::vehicle::Propulsion;
use nalgebra::{DMatrix, DVector};

/// A base fitted to the flights.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// the model
    pub base: Base,
    /// linearised about it
    pub rows: Rows,
    /// weighted, partialled
    pub weighted: Weighted,
    /// remaining coefficients (about zero after convergence), nuisances first
    pub coefficients: DVector<f64>,
    /// their covariance
    pub covariance: DMatrix<f64>,
    /// places in mass and inertia of what the flights do not determine: the model has what the vehicle file states there, as far as they
    /// tell nothing else
    pub undetermined: Vec<usize>,
    /// where the flights show an inertia that no body has, by more than their errors: the place in mass and inertia of the largest moment,
    /// and its ratio to the sum of the other two. The model then has what the vehicle file states
    pub beyond_bodies: Option<(usize, f64)>,
}

impl Fitted {
    /// Each effect with the column of its first free value.
    pub(super) fn with_first_columns(&self) -> impl Iterator<Item = (&EffectTerm, usize)> {
        self.base.effects.iter().scan(self.rows.nuisances.len(), |next, present| {
            let first = *next;
            *next += present.free.len();
            Some((present, first))
        })
    }

    /// Mass and inertia with their covariance; NaN where no row bears on a parameter.
    #[must_use]
    pub fn rigid_body(&self) -> Estimated {
        self.rigid_body_by_rows().with_torque_error(self.rows.torque_error)
    }

    /// The same without what all torques have in common as an error.
    pub(super) fn rigid_body_by_rows(&self) -> Estimated {
        let place = |index: usize| {
            let wanted = if index == 0 { Nuisance::Mass } else { Nuisance::Inertia(index - 1) };
            self.rows.nuisances.iter().position(|column| column.nuisance == wanted)
        };
        let places: [Option<usize>; THETA] = std::array::from_fn(place);
        let covariance = ThetaCovariance::from_fn(|i, j| match (places[i], places[j]) {
            (Some(i), Some(j)) => self.covariance[(i, j)],
            _ => 0.0,
        });
        let mut theta = theta_of(&self.base.vehicle.body);
        for (index, value) in theta.iter_mut().enumerate() {
            if covariance[(index, index)] <= 0.0 {
                *value = f64::NAN;
            }
        }
        Estimated {
            theta,
            covariance,
            explained: Some(self.explained_torques()),
            by_wider_window: None,
            by_guessed_curve: None,
            torque_exponent: None,
        }
    }

    /// The same on the scale of the stated thrust, also of a vehicle that was weighed.
    #[must_use]
    pub fn with_stated_thrust(&self, stated: &Propulsion) -> Estimated {
        let of_stated = stated.full_thrust_n() / self.base.vehicle.propulsion.full_thrust_n();
        let estimated = self.rigid_body();
        let theta = estimated.theta * of_stated;
        let mut covariance = estimated.covariance * of_stated.powi(2);
        // without the stated mass the scale is as unsure as the curve leaves it
        let more = beyond_stated_mass(&self.base);
        for index in (0..theta.len()).filter(|_| more > 0.0) {
            covariance[(index, index)] += (more * theta[index]).powi(2);
        }
        Estimated { theta, covariance, ..estimated }
    }

    /// Share of the variance of the torques about body x, y, z that the inertia explains, without the part of nuisances and
    /// effects.
    fn explained_torques(&self) -> [f64; 3] {
        let theta = theta_of(&self.base.vehicle.body);
        std::array::from_fn(|axis| {
            let channel = 3 + axis;
            let left = DVector::from_vec(self.weighted.left_of(channel));
            let mut with_body = left.clone();
            for (column, moved) in self.rows.nuisances.iter().zip(self.coefficients.iter()) {
                let Nuisance::Inertia(index) = column.nuisance else { continue };
                // what is left is left by the inertia that the rows tell, a step from the base's
                let along = column.values[channel].iter().map(|value| value * (theta[1 + index] + moved));
                with_body += DVector::from_iterator(left.len(), along);
            }
            1.0 - left.variance() / with_body.variance().max(f64::MIN_POSITIVE)
        })
    }

    /// Relative standard error of the scale of forces by a bent thrust curve (-); 0 without one.
    #[must_use]
    pub fn std_of_scale(&self) -> f64 {
        of_scale(&self.base)
    }

    /// The model's weight, N.
    #[must_use]
    pub fn weight_n(&self) -> f64 {
        self.base.vehicle.body.mass_kg * self.base.vehicle.gravity_m_s2
    }

    /// Standard error of `value m_w / m` at a mass m that is the weighed one m_w, by the chain rule: `value` is that of a
    /// column that follows the scale of force, and the mass is the first column.
    #[must_use]
    pub fn std_by_mass(&self, column: usize, value: f64) -> f64 {
        let share = value / self.base.vehicle.body.mass_kg;
        let variance = self.covariance[(column, column)] - 2.0 * share * self.covariance[(column, 0)]
            + share * share * self.covariance[(0, 0)];
        variance.max(0.0).sqrt()
    }

    /// Standard error of a free value of an effect, in the place of `column`.
    pub(super) fn std_of(&self, column: usize, (value, unit): (f64, &str)) -> f64 {
        if self.base.weighed_kg.is_some() && follows_force(unit) {
            return self.std_by_mass(column, value);
        }
        self.covariance[(column, column)].max(0.0).sqrt()
    }

    /// Another model of the same flights, with the covariance as it is known.
    ///
    /// # Errors
    /// [`PhysicsError`] where the base is not physical.
    pub(super) fn moved_to(&self, flights: &[Trace], base: Base) -> Result<Self, PhysicsError> {
        Ok(Self { covariance: self.covariance.clone(), ..evaluate(flights, base)? })
    }

    /// Negative log-likelihood up to a constant: the sum over the rows at which a channel is measured of the logarithm of its
    /// standard deviation, with forces as measured accelerations.
    #[must_use]
    pub fn misfit(&self) -> f64 {
        let mass_kg = self.base.vehicle.body.mass_kg;
        let measured = |channel: usize| {
            let of_torque = (3..AXES).contains(&channel);
            self.weighted.sigma[channel] / if of_torque { 1.0 } else { mass_kg }
        };
        let of = |channel: usize| (self.rows.count_of(channel) as f64, measured(channel));
        let used: Vec<(f64, f64)> = (0..CHANNELS).map(of).filter(|(_, sigma)| *sigma != 0.0).collect();
        // a form that cannot be carried along the flight is no candidate
        if used.iter().all(|(_, sigma)| *sigma > 0.0) {
            used.iter().map(|(rows, sigma)| rows * sigma.ln()).sum()
        } else {
            f64::INFINITY
        }
    }

    /// Negative log-density of the priors at the nuisances' coefficients, up to a constant, times the rows that are `alike`.
    #[must_use]
    pub(super) fn against_priors(&self, alike: Alike) -> f64 {
        let of = |(column, value): (&NuisanceColumn, &f64)| {
            let against = column.prior_std.map(|std| 0.5 * ((value - column.prior_mean) / std).powi(2));
            alike.of(column.nuisance) * against.unwrap_or_default()
        };
        self.rows.nuisances.iter().zip(self.coefficients.iter()).map(of).sum()
    }
}

/// How the latency is treated in a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Newton {
    /// estimated
    Free,
    /// its delay is estimated, its lag is kept
    Delay,
    /// it is kept, but its column is in the regression
    Held,
}

/// Fits rigid body, latency and the base's effects.
///
/// # Errors
/// [`PhysicsError`] where the estimate leaves what is physical.
pub fn fit(flights: &[Trace], base: Base, newton: Newton) -> Result<Fitted, PhysicsError> {
    let begun = base.clone();
    let fitted = converged(flights, base, newton)?;
    if fitted.base.is_unbiased || !is_no_bias(&fitted) {
        return Ok(fitted);
    }
    converged(flights, Base { is_unbiased: true, ..begun }, newton)
}

/// Standard deviations of its prior from which on the bias that fits best is no accelerometer's. What is wrong with the thrust along z is
/// then taken for a bias, and the mass, which its mean tells, comes out wrong. On the one such flight that was seen it was 15. Set by judgement.
const NO_BIAS: f64 = 5.0;

/// Whether a bias with a prior is far from it.
fn is_no_bias(fitted: &Fitted) -> bool {
    let of = |(column, value): (&NuisanceColumn, &f64)| {
        let is_bias = matches!(column.nuisance, Nuisance::AccelerometerBias(_));
        is_bias && column.prior_std.is_some_and(|std| value.abs() > NO_BIAS * std)
    };
    fitted.rows.nuisances.iter().zip(fitted.coefficients.iter()).any(of)
}

/// Gauss-Newton until the steps are small against their errors.
///
/// On the way the effects' columns stay as they were made as long as no value moves far, and the errors are those of the start: they change
/// little, and cost more than the step. The last step is by columns and errors of its own base.
fn converged(flights: &[Trace], mut base: Base, newton: Newton) -> Result<Fitted, PhysicsError> {
    let mut made_at = base.clone();
    let mut fitted = evaluate(flights, base.clone())?;
    for pass in 1..=PASSES {
        let moves = step(&mut base, &fitted.rows, &fitted.coefficients, newton);
        let Fitted { covariance, mut rows, weighted, .. } = fitted;
        let is_on_the_way = pass < PASSES && moves.largest(&covariance) >= CONVERGED;
        let near = (is_on_the_way && is_near(&base, &made_at)).then(|| std::mem::take(&mut rows.effects));
        if near.is_none() {
            made_at.clone_from(&base);
        }
        // two of a long flight at a time take much memory
        drop((rows, weighted));
        fitted = linearised(flights, base.clone(), near)?;
        if is_on_the_way {
            fitted.coefficients = fitted.weighted.values(&fitted.rows);
            fitted.covariance = covariance;
            continue;
        }
        (fitted.coefficients, fitted.covariance) = fitted.weighted.coefficients(&fitted.rows);
        let left = step(&mut base.clone(), &fitted.rows, &fitted.coefficients, newton);
        if left.largest(&fitted.covariance) < CONVERGED {
            break;
        }
    }
    Ok(fitted)
}

/// Share of its distance from nothing by which a value may move while its column stays. The slopes of effects that are not linear change by
/// as much, and the way is then a fifth of what it was with each pass, or less. Set by judgement.
const NEAR: f64 = 0.2;

/// Whether every estimated value of the effects is near that of a base with the same effects.
fn is_near(base: &Base, other: &Base) -> bool {
    let near = |(term, other): (&EffectTerm, &EffectTerm)| {
        term.free.iter().all(|&slot| {
            let from = other.values[slot];
            (term.values[slot] - from).abs() <= NEAR * (from - term.nothing_at(slot)).abs()
        })
    };
    base.effects.iter().zip(&other.effects).all(near)
}

/// Rows, weights and coefficients at a base, without a Gauss-Newton step.
pub(super) fn evaluate(flights: &[Trace], base: Base) -> Result<Fitted, PhysicsError> {
    let fitted = linearised(flights, base, None)?;
    let (coefficients, covariance) = fitted.weighted.coefficients(&fitted.rows);
    Ok(Fitted { coefficients, covariance, ..fitted })
}

/// The same for who finds the coefficients otherwise: they and their covariance are zero. Columns of the effects as in
/// [`Rows::with_columns`].
pub(super) fn linearised(
    flights: &[Trace],
    base: Base,
    near: Option<Vec<Channels>>,
) -> Result<Fitted, PhysicsError> {
    let rows = Rows::with_columns(flights, &base, near)?;
    let weighted = Weighted::new(&rows);
    let count = rows.nuisances.len() + rows.effects.len();
    let (coefficients, covariance) = (DVector::zeros(count), DMatrix::zeros(count, count));
    Ok(Fitted {
        base,
        rows,
        weighted,
        coefficients,
        covariance,
        undetermined: Vec::new(),
        beyond_bodies: None,
    })
}

/// Coefficients of the rows' columns, and their covariance.
pub(super) type Coefficients = (DVector<f64>, DMatrix<f64>);

/// What a step moved: coefficients by their places, and by how much.
pub(super) struct Moves(Vec<(usize, f64)>);

impl Moves {
    /// The largest of them in standard errors.
    pub(super) fn largest(&self, covariance: &DMatrix<f64>) -> f64 {
        let of = |&(index, by): &(usize, f64)| {
            by.abs() / covariance[(index, index)].max(0.0).sqrt().max(f64::MIN_POSITIVE)
        };
        self.0.iter().map(of).fold(0.0, f64::max)
    }
}

/// Moves the base by the coefficients.
pub(super) fn step(base: &mut Base, rows: &Rows, coefficients: &DVector<f64>, newton: Newton) -> Moves {
    let mut moves = Vec::new();
    let body = &mut base.vehicle.body;
    for (index, column) in rows.nuisances.iter().enumerate() {
        let by = coefficients[index];
        match column.nuisance {
            Nuisance::Mass => {
                body.mass_kg = (body.mass_kg + by).clamp(0.3 * body.mass_kg, 3.0 * body.mass_kg)
            }
            Nuisance::Inertia(entry) => {
                let (row, column) = INERTIA_ENTRIES[entry];
                let scale = (body.inertia_kg_m2[(row, row)] * body.inertia_kg_m2[(column, column)]).sqrt();
                // a diagonal entry neither vanishes nor triples in one pass
                let by = if row == column {
                    by.clamp(-0.7 * scale, 2.0 * scale)
                } else {
                    by.clamp(-0.5 * scale, 0.5 * scale)
                };
                body.inertia_kg_m2[(row, column)] += by;
                if row != column {
                    body.inertia_kg_m2[(column, row)] += by;
                }
            }
            Nuisance::Gyroscopic => {
                let before = body.gyroscopic;
                body.gyroscopic = (before + by).clamp(0.0, 1.0);
                moves.push((index, body.gyroscopic - before));
                continue;
            }
            Nuisance::Latency if newton != Newton::Held => {
                let by = by.clamp(-0.05, 0.05);
                if base.latency.lag_s > 0.0 && newton == Newton::Free {
                    base.latency.lag_s = (base.latency.lag_s + by).max(1e-4);
                } else {
                    base.latency.delay_s = (base.latency.delay_s + by).clamp(-0.03, 0.3);
                }
            }
            _ => continue,
        }
        moves.push((index, by));
    }
    let mut index = rows.nuisances.len();
    for present in &mut base.effects {
        for &free in &present.free {
            let by = coefficients[index];
            let before = present.values[free];
            present.values[free] = present.possible(free, before + by, &base.size);
            moves.push((index, present.values[free] - before));
            index += 1;
        }
    }
    base.bring_to_scale(rows.compares_torques);
    Moves(moves)
}

/// Largest number of Gauss-Newton passes. A number of steps: only the time of a search and its last digits depend on
/// it.
pub(super) const PASSES: usize = 8;

/// A coefficient that moves by less than this many standard errors has converged. A twentieth of the error changes
/// nothing that is told.
pub(super) const CONVERGED: f64 = 0.05;
