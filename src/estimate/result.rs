//! Results of estimates: a value with its standard error, or the reason why there is none.

use super::method::Method;
use super::nominal::Nominal;
use super::theta::{MOMENTS, NAMES, THETA, Theta, ThetaCovariance, UNITS, scale_of};
use super::weak::WeakEstimate;
use crate::signals::TorqueError;

/// Largest standard error of a moment of inertia that counts as determined, as a share of its nominal size. A user
/// can state as much without a flight.
pub const LARGEST_RELATIVE_STD: f64 = 0.3;

/// One parameter.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// as in files
    pub name: &'static str,
    /// as in files
    pub unit: &'static str,
    /// the result
    pub finding: Finding,
}

/// A number or the reason why there is none.
#[derive(Debug, Clone, PartialEq)]
pub enum Finding {
    /// determined by the flight
    Determined {
        /// in the parameter's unit
        value: f64,
        /// standard error, same unit
        std: f64,
    },
    /// known in advance (a weighed mass)
    Given {
        /// in the parameter's unit
        value: f64,
    },
    /// not determined by the flight
    NotDetermined {
        /// for the user
        reason: String,
    },
}

/// In a reason.
pub(super) const CURVE_IS_A_GUESS: &str = "the shape of the thrust curve is a guess";

/// Share of a parameter's size from which on what moves it is among the reasons. Only a word of the report depends on it.
const TELLING: f64 = 0.01;

/// Before what a flight is good for, where it is too short for a search: what else acts is then part of mass and inertia.
pub const RIGID_BODY_ALONE: &str = "too short to search for effects; for a rigid body alone ";

/// Standard error, as a share of the parameter's size, from which it is poor. Only a word of the report depends on
/// it.
pub const POOR: f64 = 0.1;

/// Least share of a torque's variance that the rigid body must explain for its inertia to be reported. With less,
/// what else turned the vehicle would decide the inertia.
pub const LEAST_EXPLAINED: f64 = 0.3;

/// Largest factor, or its inverse, by which an inertia may change if the window is twice as wide. Of 100 simulated flights
/// with a trajectory and torques of the air none of the determined inertias changed by more than 1.23; of hovers in strong
/// turbulence, where control causes the torque, those by far from the truth changed by 3 and more. Cases, `noisy` flights and
/// flights of both autopilots' simulators: at most 1.22, but one of 1.32 that is 12 % off.
const LARGEST_WINDOW_FACTOR: f64 = 1.25;

/// Places in `Theta` of what torques about x and y tell.
const ABOUT_X_AND_Y: std::ops::RangeInclusive<usize> = 1..=5;

/// `Theta` with its covariance.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// NaN where there is no column
    pub theta: Theta,
    /// same order
    pub covariance: ThetaCovariance,
    /// share of the variance of the torques about x, y, z that the rigid body explains; `None` if it was not assessed
    pub explained: Option<[f64; 3]>,
    /// Ixx, Iyy, Izz by a window of twice the width, as shares of this estimate's; NaN where it is not determined, `None` if
    /// it was not assessed
    pub by_wider_window: Option<[f64; 3]>,
    /// how far `theta` moves with one standard error of a guessed thrust curve; `None` where no guess bears on it
    pub by_guessed_curve: Option<Theta>,
    /// the power of the thrust with which the rotors' torque about their axes goes, where it is certain that the vehicle file has it
    /// wrong
    pub torque_exponent: Option<f64>,
}

impl Estimated {
    /// The rigid-body part of a weak-form estimate.
    #[must_use]
    pub fn of(weak: &WeakEstimate) -> Self {
        let share = |name: &str| {
            let index = weak.channels.iter().position(|channel| *channel == name)?;
            weak.explained.get(index).copied()
        };
        let explained =
            ["torque_x", "torque_y", "torque_z"].map(|name| share(name).unwrap_or(f64::NEG_INFINITY));
        Self {
            theta: weak.theta,
            covariance: weak.covariance,
            explained: Some(explained),
            by_wider_window: None,
            by_guessed_curve: None,
            torque_exponent: None,
        }
    }

    /// The same with what a wider window gives.
    #[must_use]
    pub fn with_wider_window(self, ratios: [f64; 3]) -> Self {
        Self { by_wider_window: Some(ratios), ..self }
    }

    /// The same where all torques about an axis have a relative standard error in common: the moments and products of inertia that they
    /// tell have it too.
    #[must_use]
    pub fn with_torque_error(mut self, error: TorqueError) -> Self {
        for (index, relative) in [MOMENTS[0], MOMENTS[1]].into_iter().zip(error.of_moments()) {
            if self.covariance[(index, index)] > 0.0 {
                self.covariance[(index, index)] += (relative * self.theta[index]).powi(2);
            }
        }
        let relative = error.rebuilt;
        for row in ABOUT_X_AND_Y {
            for column in ABOUT_X_AND_Y {
                let both = self.covariance[(row, row)] > 0.0 && self.covariance[(column, column)] > 0.0;
                if both && relative > 0.0 {
                    self.covariance[(row, column)] +=
                        relative * relative * self.theta[row] * self.theta[column];
                }
            }
        }
        self
    }

    /// The same with how far a guessed thrust curve moves it.
    #[must_use]
    pub fn with_guessed_curve(self, moved: Option<Theta>) -> Self {
        Self { by_guessed_curve: moved, ..self }
    }

    /// Whether the rigid body explains the torques that tell a parameter (place in `Theta`), as far as that was assessed.
    #[must_use]
    pub fn explains(&self, index: usize) -> bool {
        unexplained(self, index).is_none()
    }

    /// Whether an inertia (place in `Theta`) is the same by a wider window, as far as that was assessed. Where feedback control
    /// causes the torque, it is not.
    #[must_use]
    pub fn is_of_all_bands(&self, index: usize) -> bool {
        of_feedback(self, index).is_none()
    }

    /// How far a guessed thrust curve moves a parameter, in its unit.
    #[must_use]
    pub fn moved_by_curve(&self, index: usize) -> f64 {
        self.by_guessed_curve.map_or(0.0, |moved| moved[index].abs())
    }
}

/// Result of one method.
#[derive(Debug, Clone, PartialEq)]
pub struct MethodResult {
    /// which
    pub method: Method,
    /// in `Theta`'s order
    pub parameters: [Parameter; THETA],
    /// the raw numbers
    pub estimated: Estimated,
}

impl MethodResult {
    /// Assesses each parameter with the nominal sizes.
    #[must_use]
    pub fn new(method: Method, estimated: &Estimated, nominal: &Nominal) -> Self {
        let parameters = std::array::from_fn(|index| Parameter {
            name: NAMES[index],
            unit: UNITS[index],
            finding: by_method(method, finding(estimated, nominal, index)),
        });
        Self { method, parameters, estimated: estimated.clone() }
    }
}

impl MethodResult {
    /// Emits each parameter as a tracing event.
    pub fn emit(&self) {
        let method = self.method.name();
        for Parameter { name, unit, finding } in &self.parameters {
            match finding {
                Finding::Determined { value, std } => {
                    tracing::info!(method, name, value, std, unit, "parameter determined");
                }
                Finding::Given { value } => tracing::info!(method, name, value, unit, "parameter given"),
                Finding::NotDetermined { reason } => {
                    tracing::info!(method, name, reason, "parameter not determined");
                }
            }
        }
    }
}

/// Replaces the reason for gradient descent: with a fixed gain it follows the noise, whatever the flight is.
fn by_method(method: Method, finding: Finding) -> Finding {
    match (method, finding) {
        (Method::Gd | Method::Fmgd, Finding::NotDetermined { .. }) => Finding::NotDetermined {
            reason: "gradient descent with this gain follows the noise; a smaller --sigma averages longer"
                .into(),
        },
        (_, finding) => finding,
    }
}

/// The axes whose torques determine a moment or product of inertia.
fn axes_of(index: usize) -> &'static [usize] {
    match index {
        1 => &[0],
        2 => &[0, 1],
        3 => &[0, 2],
        4 => &[1],
        5 => &[1, 2],
        6 => &[2],
        _ => &[],
    }
}

/// A share in words: how much more than all of it says nothing.
pub(super) fn percent(share: f64) -> String {
    if share > 1.0 { "more than 100 %".to_owned() } else { format!("{:.0} %", 100.0 * share) }
}

/// The reason if the rigid body does not explain the torque of one of the parameter's axes.
fn unexplained(estimated: &Estimated, index: usize) -> Option<String> {
    let shares = estimated.explained?;
    axes_of(index).iter().find(|axis| shares[**axis] < LEAST_EXPLAINED).map(|axis| {
        format!(
            "the rigid body explains only {:.0} % of the torque about {}: the rest is noise, or physics that it lacks",
            100.0 * shares[*axis].max(0.0),
            ["x", "y", "z"][*axis]
        )
    })
}

/// Whether a moment of inertia depends on the band of frequencies, by its ratio (-) from a window of twice the width: the torque then answers
/// the motion (feedback control). NaN says nothing.
#[must_use]
pub fn depends_on_band(ratio: f64) -> bool {
    ratio.is_finite() && !(1.0 / LARGEST_WINDOW_FACTOR..=LARGEST_WINDOW_FACTOR).contains(&ratio)
}

/// The reason if the inertia about one of the parameter's axes depends on the window.
fn of_feedback(estimated: &Estimated, index: usize) -> Option<String> {
    let ratios = estimated.by_wider_window?;
    axes_of(index).iter().find(|axis| depends_on_band(ratios[**axis])).map(|axis| {
        let name = ["x", "y", "z"][*axis];
        format!(
            "a window of twice the width gives {:.2} times the inertia about {name}: it depends on the band of frequencies, so \
             the torque about {name} answers the motion (feedback control) rather than causing it; fly an identification \
             trajectory, which excites the rotation",
            ratios[*axis]
        )
    })
}

/// The reason if a product of inertia couples an axis whose moment is not determined: it says nothing beside that.
fn of_open_moment(estimated: &Estimated, nominal: &Nominal, index: usize) -> Option<String> {
    let axes = axes_of(index);
    let moments = axes.iter().map(|axis| [1, 4, 6][*axis]).filter(|_| axes.len() > 1);
    let relative = |moment: usize| {
        let std = estimated.covariance[(moment, moment)].max(0.0).sqrt();
        std / size_of(&estimated.theta, nominal, moment)
    };
    let is_open = |moment: &usize| relative(*moment).is_nan() || relative(*moment) > LARGEST_RELATIVE_STD;
    let mut open = moments.filter(is_open);
    open.next().map(|moment| {
        format!(
            "it couples an axis whose moment, {}, has a standard error of {} of its size",
            NAMES[moment],
            percent(relative(moment))
        )
    })
}

/// Size of a parameter by which its errors are judged: the larger of the nominal and of the estimate.
#[must_use]
pub fn size_of(theta: &Theta, nominal: &Nominal, index: usize) -> f64 {
    scale_of(&nominal.theta, index).max(scale_of(&theta.map(f64::abs), index))
}

/// Place of Izz.
const ABOUT_Z: usize = 6;

/// Assesses one parameter.
#[must_use]
pub fn finding(estimated: &Estimated, nominal: &Nominal, index: usize) -> Finding {
    let (value, variance) = (estimated.theta[index], estimated.covariance[(index, index)]);
    if !value.is_finite() || !variance.is_finite() {
        let reason = if index == 0 {
            "the recording holds no vertical motion"
        } else {
            "no torque can be compared: body rates or commands are not recorded, or at too low a rate"
        };
        return Finding::NotDetermined { reason: reason.to_owned() };
    }
    if let Some(exponent) = estimated.torque_exponent.filter(|_| index == ABOUT_Z) {
        return Finding::NotDetermined {
            reason: format!(
                "the rotors' torque goes with the power {exponent:.2} of their thrust, so the motion about z tells only the ratio of \
                 izz and the change of the torque with the thrust"
            ),
        };
    }
    let std = variance.max(0.0).sqrt();
    let size = size_of(&estimated.theta, nominal, index);
    let relative = std / size;
    if relative > LARGEST_RELATIVE_STD {
        let axes = axes_of(index).iter().map(|axis| ["x", "y", "z"][*axis]).collect::<Vec<_>>();
        let fly = if index == 0 {
            "weigh the vehicle, or fly climbs and descents".to_owned()
        } else {
            format!("fly more angular acceleration about {}", axes.join(" and "))
        };
        return Finding::NotDetermined {
            reason: format!("standard error {} of its size; {fly}", percent(relative)),
        };
    }
    if let Some(reason) = unexplained(estimated, index) {
        return Finding::NotDetermined { reason };
    }
    if let Some(reason) = of_feedback(estimated, index) {
        return Finding::NotDetermined { reason };
    }
    if let Some(reason) = of_open_moment(estimated, nominal, index) {
        return Finding::NotDetermined { reason };
    }
    let moment = matches!(index, 0 | 1 | 4 | 6);
    if moment && value <= 2.0 * std {
        return Finding::NotDetermined {
            reason: format!("estimate {value:.3e} +- {std:.1e} is not distinguishable from zero"),
        };
    }
    let (guessed, by_curve) = (nominal.guessed(index), estimated.moved_by_curve(index));
    if guessed.hypot(by_curve / size) > LARGEST_RELATIVE_STD {
        let of_curve = (by_curve >= TELLING * size).then(|| {
            format!("{CURVE_IS_A_GUESS}, one standard error of it moves this by {}", percent(by_curve / size))
        });
        let why: Vec<String> = nominal.guesses(index).into_iter().chain(of_curve).collect();
        return Finding::NotDetermined { reason: why.join(" and ") };
    }
    Finding::Determined { value, std: std.hypot(guessed * value).hypot(by_curve) }
}
