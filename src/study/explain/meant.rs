//! Which motor a name is about.

use super::result::ExplainStudy;
use crate::diagnose::Named;
use crate::diagnose::signatures::signature_of;

impl ExplainStudy {
    /// The motor that an effect is about, from 0; `None` where it is about none.
    #[must_use]
    pub fn motor_of(&self, named: &Named) -> Option<usize> {
        let signature = signature_of(named.id)?;
        let name = signature.effect.parameters().get(signature.role.which?)?.name;
        self.vehicle().rotor_of(named.get(name)?.value)
    }

    /// The name of the parameter that says which motor an effect is about.
    #[must_use]
    pub fn motor_parameter(&self, named: &Named) -> Option<&'static str> {
        let signature = signature_of(named.id)?;
        Some(signature.effect.parameters().get(signature.role.which?)?.name)
    }
}
