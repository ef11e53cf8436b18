//! Which method to believe for this flight, and why.

use super::method::Method;
use super::nominal::Nominal;
use super::physical::{is_physical, nearest_physical};
use super::result::{Estimated, Finding, MethodResult};
use super::theta::{NAMES, scale_of};
use super::weak::WeakEstimate;

/// More rows than this held back by the robust weights: outliers, not noise.
const OUTLIER_SHARE: f64 = 0.02;
/// Two estimates differ where they are further apart than this many standard errors of their difference.
const HAUSMAN_SIGMA: f64 = 5.0;
/// Instruments whose standard error is more than this many times the plain one's are too weak.
const WEAKEST_INSTRUMENT: f64 = 4.0;

/// The recommended method's result.
#[derive(Debug, Clone, PartialEq)]
pub struct Recommendation {
    /// which method
    pub method: Method,
    /// for the user
    pub why: String,
    /// its parameters, inertia physical
    pub result: MethodResult,
    /// the unconstrained inertia was not physical and was moved to the nearest that is
    pub made_physical: bool,
}

/// Chooses between the weak form's variants.
#[must_use]
pub fn recommend(
    plain: &WeakEstimate,
    robust: Option<&WeakEstimate>,
    instruments: Option<&WeakEstimate>,
    nominal: &Nominal,
) -> Recommendation {
    let (method, chosen, why) = choose(plain, robust, instruments);
    let mut estimated = Estimated::of(chosen);
    // an inertia that is not determined needs no repair
    let as_estimated = MethodResult::new(method, &estimated, nominal);
    let determined = |i: usize| matches!(as_estimated.parameters[i].finding, Finding::Determined { .. });
    let needed = [1, 4, 6].into_iter().all(determined) && !is_physical(&estimated.theta);
    let mended =
        needed.then(|| nearest_physical(&estimated.theta, &estimated.covariance, &nominal.theta)).flatten();
    let made_physical = mended.is_some();
    if let Some(theta) = mended {
        estimated.theta = theta;
    }
    Recommendation { method, why, result: MethodResult::new(method, &estimated, nominal), made_physical }
}

fn choose<'a>(
    plain: &'a WeakEstimate,
    robust: Option<&'a WeakEstimate>,
    instruments: Option<&'a WeakEstimate>,
) -> (Method, &'a WeakEstimate, String) {
    if let Some(iv) = instruments
        && let Some((index, sigma)) = hausman(plain, iv)
    {
        let why = format!(
            "the commanded trajectory as instrument moves {} by {sigma:.1} standard errors: noise in the \
                 regressors biases the other methods",
            NAMES[index]
        );
        return (Method::WeakIv, iv, why);
    }
    if let Some(robust) = robust.filter(|robust| robust.held_back > OUTLIER_SHARE) {
        let why = format!(
            "{:.1} % of the rows are outliers that ordinary least squares would follow",
            100.0 * robust.held_back
        );
        return (Method::WeakRobust, robust, why);
    }
    let why = "the weak form needs no differentiation and keeps the noisy command on the left; its standard errors \
               allow for coloured residuals"
        .into();
    (Method::Weak, plain, why)
}

/// The moment of inertia in which instruments contradict least squares most, if any does, and the
/// instruments are strong enough to say so.
fn hausman(plain: &WeakEstimate, iv: &WeakEstimate) -> Option<(usize, f64)> {
    [1, 4, 6]
        .into_iter()
        .filter_map(|index| {
            let (v_plain, v_iv) = (plain.covariance[(index, index)], iv.covariance[(index, index)]);
            let strong = v_iv.sqrt() < WEAKEST_INSTRUMENT * v_plain.sqrt()
                && v_iv.sqrt() < 0.1 * scale_of(&plain.theta, index);
            let difference = iv.theta[index] - plain.theta[index];
            // under the null the efficient estimate is the plain one: var(difference) = V_iv - V_plain
            let variance = (v_iv - v_plain).max(0.25 * v_iv);
            let sigma = difference.abs() / variance.sqrt();
            (strong && sigma > HAUSMAN_SIGMA).then_some((index, sigma))
        })
        .max_by(|a, b| a.1.total_cmp(&b.1))
}
