//! The recommended estimate of a flight, with the reason.

use super::method::Method;
use super::nominal::Nominal;
use super::physical::{is_physical, nearest_physical};
use super::result::{Estimated, Finding, MethodResult, size_of};
use super::theta::THETA;

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

/// Why the weak form is the best of the methods for a rigid body alone.
const WHY_WEAK: &str = "the weak form needs no differentiation and keeps the noisy command on the left; its standard errors \
                        allow for coloured residuals";

/// Relative standard errors of mass and inertia where no effects could be searched: of 29 flights with an estimator in the loop, half of them
/// with an effect, the rigid body alone has the mass within 2 % in most and moments within 10 %, and far outside in some.
const UNSEARCHED_MASS: f64 = 0.015;
const UNSEARCHED_INERTIA: f64 = 0.1;

impl Recommendation {
    /// The weak form of the rigid body alone, its inertia made physical.
    #[must_use]
    pub fn weak(mut estimated: Estimated, nominal: &Nominal) -> Self {
        let method = Method::Weak;
        // an inertia that is not determined needs no repair
        let as_estimated = MethodResult::new(method, &estimated, nominal);
        let determined = |i: usize| matches!(as_estimated.parameters[i].finding, Finding::Determined { .. });
        let needed = [1, 4, 6].into_iter().all(determined) && !is_physical(&estimated.theta);
        let nearest =
            needed.then(|| nearest_physical(&estimated.theta, &estimated.covariance, &nominal.theta));
        let mended = nearest.flatten();
        let made_physical = mended.is_some();
        if let Some(theta) = mended {
            estimated.theta = theta;
        }
        let result = MethodResult::new(method, &estimated, nominal);
        Self { method, why: WHY_WEAK.to_owned(), result, made_physical }
    }

    /// Adds to the errors what a search for effects would have told: without one, what else acts is part of mass and inertia.
    pub fn widen(&mut self, nominal: &Nominal) {
        let mut estimated = self.result.estimated.clone();
        for index in 0..THETA {
            let share = if index == 0 { UNSEARCHED_MASS } else { UNSEARCHED_INERTIA };
            let size = size_of(&estimated.theta, nominal, index);
            estimated.covariance[(index, index)] += (share * size).powi(2);
        }
        self.result = MethodResult::new(self.method, &estimated, nominal);
    }

    /// The rigid body together with effects, with the reason for the user. Its inertia is physical.
    #[must_use]
    pub fn joint(estimated: &Estimated, nominal: &Nominal, why: String) -> Self {
        let result = MethodResult::new(Method::Joint, estimated, nominal);
        Self { method: Method::Joint, why, result, made_physical: false }
    }
}
