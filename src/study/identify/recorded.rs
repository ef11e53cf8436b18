//! Force and torque that the rotors gave, and what models make of the recorded motion.

use super::result::IdentifyStudy;
use crate::estimate::{Finding, Theta, theta_of};
use crate::regression::{ZeroPhase, paper_models};
use crate::signals::Butterworth;

/// Names and units of the components of the regression models' output (43).
pub const COMPONENTS: [(&str, &str); 4] =
    [("1: F_z", "N"), ("2: tau_phi", "N m"), ("3: tau_theta", "N m"), ("4: tau_psi", "N m")];

/// One component along the first flight behind the zero-phase low-pass.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorsAndMotion {
    /// in the order of [`COMPONENTS`]
    pub component: usize,
    /// s
    pub time_s: Vec<f64>,
    /// what the motion takes with mass and inertia of the vehicle file
    pub nominal: Vec<f64>,
    /// what it takes with those of the rigid body identified alone
    pub identified: Vec<f64>,
    /// what the rotors gave, on the scale of the weighed mass where there is one
    pub rotors: Vec<f64>,
}

impl IdentifyStudy {
    /// Each component of the first flight; none where body rates or vertical motion are not recorded.
    #[must_use]
    pub fn rotors_and_motion(&self) -> Vec<RotorsAndMotion> {
        let nominal = theta_of(&self.vehicle.body);
        let best = &self.identification.best.result.parameters;
        let identified = Theta::from_fn(|index, _| match best[index].finding {
            Finding::Determined { value, .. } | Finding::Given { value } => value,
            Finding::NotDetermined { .. } => nominal[index],
        });
        let factor = match self.scale.as_ref().map(|scale| &scale.factor) {
            Some(Finding::Determined { value, .. }) => *value,
            _ => 1.0,
        };
        let Some(signals) = self.flights.first() else { return Vec::new() };
        let filter = Butterworth::new(self.identification.cutoff_hz, 1.0 / signals.grid.step_s);
        let models = filter.and_then(|filter| {
            paper_models(signals, self.vehicle.gravity_m_s2, &ZeroPhase::Butterworth(filter))
        });
        let Some((standard, _)) = models else { return Vec::new() };
        let by = |component: usize, theta: &Theta| -> Vec<f64> {
            standard.gamma.iter().map(|gamma| (gamma.matrix() * theta)[component]).collect()
        };
        (0..COMPONENTS.len())
            .map(|component| RotorsAndMotion {
                component,
                time_s: standard.time_s.clone(),
                nominal: by(component, &nominal),
                identified: by(component, &identified),
                rotors: standard.upsilon.iter().map(|given| factor * given[component]).collect(),
            })
            .collect()
    }
}
