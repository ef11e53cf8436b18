//! A force across the airspeed, as a body that sheds vortices on one side has.

use mavid::physics::{Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};
use nalgebra::Vector3;

/// A force across the airspeed.
#[derive(Debug, Clone, Copy)]
pub struct SideForce;

const PARAMETERS: &[Parameter] =
    &[Parameter { name: "k", unit: "N/(m/s)", bounds: Bounds::of(-5.0, 5.0).by_mass() }];

impl Effect for SideForce {
    fn id(&self) -> &'static str {
        "side_force"
    }

    fn sentence(&self) -> &'static str {
        "The air pushes the vehicle sideways: a force across the airspeed, in proportion to it."
    }

    fn equation(&self) -> &'static str {
        "`F = k (e_z x v_air)` at the centre of mass, body."
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn sided(&self) -> &'static [usize] {
        &[0]
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn wrench(&self, at: &Condition, _rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        sum.force_n += Vector3::z().cross(&at.air_velocity_m_s) * own.parameters[0];
    }
}
