//! The ground under the vehicle's feet.

use nalgebra::Vector3;

use crate::physics::{Airframe, MAX_ROTORS, State, Wrench};

/// How the ground and the feet are.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundSettings {
    /// world z of the ground, m
    pub height_m: f64,
    /// feet below the centre of mass, m; one foot under each hub
    pub leg_m: f64,
    /// how deep the feet give way under the vehicle's own weight, m
    pub sink_m: f64,
    /// of the bounce, -
    pub damping_ratio: f64,
    /// Coulomb's, -
    pub friction: f64,
}

impl Default for GroundSettings {
    fn default() -> Self {
        Self { height_m: 0.0, leg_m: 0.1, sink_m: 0.004, damping_ratio: 0.6, friction: 0.6 }
    }
}

/// Below this speed a foot creeps instead of slipping, m/s: it smooths Coulomb's law.
const CREEP_M_S: f64 = 0.05;

/// Springs, dampers and friction under each foot.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundContact {
    settings: GroundSettings,
    feet_m: [Vector3<f64>; MAX_ROTORS],
    foot_count: usize,
    stiffness_n_m: f64,
    damping_n_s_m: f64,
}

impl GroundContact {
    /// The ground for a vehicle of this airframe.
    #[must_use]
    pub fn new(airframe: &Airframe, settings: GroundSettings) -> Self {
        let mut feet_m = [Vector3::zeros(); MAX_ROTORS];
        for (foot, arm) in feet_m.iter_mut().zip(airframe.arms_m()) {
            *foot = Vector3::new(arm.x, arm.y, -settings.leg_m);
        }
        let share_kg = airframe.mass_kg / airframe.rotor_count() as f64;
        let stiffness_n_m = share_kg * airframe.gravity_m_s2 / settings.sink_m;
        Self {
            settings,
            feet_m,
            foot_count: airframe.rotor_count(),
            stiffness_n_m,
            damping_n_s_m: 2.0 * settings.damping_ratio * (stiffness_n_m * share_kg).sqrt(),
        }
    }

    /// Height of the centre of mass of a vehicle that stands still, m.
    #[must_use]
    pub fn standing_height_m(&self) -> f64 {
        self.settings.height_m + self.settings.leg_m - self.settings.sink_m
    }

    /// Force and torque of the ground on the body.
    #[must_use]
    pub fn wrench(&self, state: &State) -> Wrench {
        let mut sum = Wrench::zero();
        for foot in &self.feet_m[..self.foot_count] {
            let depth_m = self.settings.height_m - state.position_m.z - (state.attitude * foot).z;
            if depth_m <= 0.0 {
                continue;
            }
            let velocity = state.velocity_m_s + state.attitude * state.rates_rad_s.cross(foot);
            // a foot is pushed, never held
            let normal_n = (self.stiffness_n_m * depth_m - self.damping_n_s_m * velocity.z).max(0.0);
            let slip = velocity.xy();
            let grip = -self.settings.friction * normal_n / slip.norm().hypot(CREEP_M_S);
            let force = Vector3::new(slip.x * grip, slip.y * grip, normal_n);
            sum += Wrench::at(foot, state.attitude.inverse_transform_vector(&force));
        }
        sum
    }
}
