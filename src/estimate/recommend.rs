//! The recommended method for a flight, with the reason.

use super::method::Method;
use super::nominal::Nominal;
use super::physical::{is_physical, nearest_physical};
use super::result::{Estimated, Finding, MethodResult};
use super::theta::{NAMES, scale_of};
use super::weak::WeakEstimate;

/// Share of the rows with reduced robust weights above which they are outliers and not noise. Chosen; not measured.
const OUTLIER_SHARE: f64 = 0.02;
/// Standard errors of the difference beyond which two estimates differ (Hausman test). Chosen; not measured.
const HAUSMAN_SIGMA: f64 = 5.0;
/// Largest ratio of the standard errors with and without instruments. Beyond it the instruments are too weak. Chosen;
/// not measured.
const WEAKEST_INSTRUMENT: f64 = 4.0;

/// The recommended method's result.
#[derive(Debug, Clone, PartialEq)]
pub struct Recommendation {
    /// the method
    pub method: Method,
    /// the reason for the user
    pub why: String,
    /// its parameters, inertia physical
    pub result: MethodResult,
    /// whether the unconstrained inertia was physically impossible and was replaced by the nearest possible one
    pub made_physical: bool,
}

/// Chooses between the weak form's variants. `whole` adds to an estimate what all of them have in common: what a wider window
/// and a guessed thrust curve say of it.
#[must_use]
pub fn recommend(
    (plain, whole): (&WeakEstimate, &dyn Fn(&WeakEstimate) -> Estimated),
    robust: Option<&WeakEstimate>,
    instruments: Option<&WeakEstimate>,
    nominal: &Nominal,
) -> Recommendation {
    let (method, chosen, why) = choose(plain, robust, instruments);
    let mut estimated = whole(chosen);
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

/// The moment of inertia for which the instrumental variables contradict least squares most, if the difference is
/// significant and the instruments are strong enough.
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
