//! Descending into its own wake a rotor loses thrust.

use crate::physics::equation::documented;
use crate::physics::{Airframe, Bounds, Condition, Effect, Hook, Own, Parameter, Rotors, Wrench};
use crate::units::AIR_DENSITY_KG_M3;

documented! {
    /// `F_i = -loss T_i e(x) e_z` at each hub, where `x = v_z / v_h` is the climb rate over the induced velocity of
    /// hover, `v_h = sqrt(T_i / (2 rho A))`. `e(x)` is the excess of the induced velocity that Leishman measured over
    /// that of momentum theory, `k(x) / k(0) - (sqrt(x^2/4 + 1) - x/2)`, where it is positive (x above -1.45) and where
    /// the ring has formed: it is zero above x = -0.4 and grows smoothly from there to x = -0.6. Its largest value is
    /// 0.09, at x = -1.1. Lateral airspeed carries the ring away and reduces the effect by `1 / (1 + (v_xy / v_h)^2)`.
    /// The fluctuation of the thrust is not modelled.
    ///
    /// Leishman 2006, section 2.13.
    #[derive(Debug, Clone, Copy)]
    pub struct VortexRing;
}

const PARAMETERS: &[Parameter] = &[Parameter { name: "loss", unit: "-", bounds: Bounds::of(0.0, 5.0) }];

/// Induced over hover velocity in descent, by powers of x (Leishman's fit of measurements).
const INDUCED: [f64; 5] = [1.15, -1.125, -1.372, -1.718, -0.655];

/// Climb ratios between which the ring forms.
const FORMING: (f64, f64) = (-0.4, -0.6);

/// Excess of the induced velocity at the climb ratio x.
fn excess(x: f64) -> f64 {
    if !(-2.0..FORMING.0).contains(&x) {
        return 0.0;
    }
    let measured = INDUCED.iter().rev().fold(0.0, |sum, k| sum * x + k) / INDUCED[0];
    let formed = ((x - FORMING.0) / (FORMING.1 - FORMING.0)).min(1.0);
    let formed = formed * formed * (3.0 - 2.0 * formed);
    formed * (measured - ((x * x / 4.0 + 1.0).sqrt() - x / 2.0)).max(0.0)
}

/// Force and torque for a loss of 1.
fn per_loss(at: &Condition, rotors: &Rotors) -> Wrench {
    let radius_m = at.airframe.propulsion.rotor_radius_m.unwrap_or(f64::INFINITY);
    let disc_kg_m = 2.0 * AIR_DENSITY_KG_M3 * std::f64::consts::PI * radius_m * radius_m;
    let mut sum = Wrench::zero();
    for ((arm, air), thrust_n) in at.hubs().zip(&rotors.thrust_n) {
        let hover_m_s = (thrust_n.max(1e-9) / disc_kg_m).sqrt();
        let air = air / hover_m_s;
        let lost_n = thrust_n * excess(air.z) / (1.0 + air.xy().norm_squared());
        sum.lift_at(arm, -lost_n);
    }
    sum
}

impl Effect for VortexRing {
    fn id(&self) -> &'static str {
        "vortex_ring"
    }

    fn sentence(&self) -> &'static str {
        "The vehicle sinks into its own wake: the rotors lose thrust in a steep descent."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Wrench]
    }

    fn missing(&self, airframe: &Airframe) -> Option<&'static str> {
        airframe.propulsion.rotor_radius_m.is_none().then_some("rotor_radius")
    }

    fn wrench(&self, at: &Condition, rotors: &Rotors, own: &mut Own, sum: &mut Wrench) {
        *sum += per_loss(at, rotors) * own.parameters[0];
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn regressor(&self, at: &Condition, rotors: &Rotors, _parameters: &[f64], columns: &mut [Wrench]) {
        if let Some(column) = columns.first_mut() {
            *column = per_loss(at, rotors);
        }
    }
}
