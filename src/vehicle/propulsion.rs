//! From an actuator value to one rotor's thrust.

/// The unit in which the autopilot's actuator values come, and what they mean.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Actuator {
    /// u in 0..1 commands the rotor speed `u * speed_max`
    Speed,
    /// u in 0..1 goes through the thrust law
    Thrust,
    /// pulse width in microseconds, mapped to u in 0..1, then through the law.
    /// `None`: the recorded values are already fractions of full scale
    Pwm(Option<PwmRange>),
}

/// Pulse widths that mean u = 0 and u = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PwmRange {
    /// microseconds at u = 0
    pub min_us: f64,
    /// microseconds at u = 1
    pub max_us: f64,
}

/// One rotor's thrust from its normalised command u in 0..1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ThrustLaw {
    /// `k (u * speed_max)^2`
    Speed {
        /// rotor speed at u = 1, rad/s
        speed_max_rad_s: f64,
    },
    /// `thrust_max ((1 - expo) u + expo u^2)`: PX4's THR_MDL_FAC, ArduPilot's MOT_THST_EXPO
    Curve {
        /// N, one rotor at u = 1
        thrust_max_n: f64,
        /// 0 linear, 1 quadratic
        expo: f64,
    },
}

/// Thrust and torque of one rotor (all rotors are alike).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Propulsion {
    /// what the recorded actuator values mean
    pub actuator: Actuator,
    /// thrust from the normalised command
    pub law: ThrustLaw,
    /// k in `T = k Omega^2`, N/(rad/s)^2; `None` where only a curve in u is known
    pub thrust_coefficient: Option<f64>,
    /// drag torque per thrust, N m per N
    pub torque_per_thrust_m: f64,
    /// m
    pub rotor_radius_m: Option<f64>,
    /// s, first-order response of the rotor's speed to the command, where known beforehand
    pub time_constant_s: Option<f64>,
    /// s, the same of a rotor that slows down, where it differs
    pub time_constant_down_s: Option<f64>,
}

impl Propulsion {
    /// Mean of the stated time constants of rising and falling speed, s; `None` where none is stated.
    #[must_use]
    pub fn mean_time_constant_s(&self) -> Option<f64> {
        let rising_s = self.time_constant_s?;
        Some(f64::midpoint(rising_s, self.time_constant_down_s.unwrap_or(rising_s)))
    }

    /// How many times as long slowing down takes as speeding up; 1 where nothing else is stated.
    #[must_use]
    pub fn falling_over_rising(&self) -> f64 {
        match (self.time_constant_s, self.time_constant_down_s) {
            (Some(up_s), Some(down_s)) if up_s > 0.0 && down_s > 0.0 => down_s / up_s,
            _ => 1.0,
        }
    }

    /// Recorded actuator value to the normalised command u.
    #[must_use]
    pub fn normalized(&self, value: f64) -> f64 {
        match self.actuator {
            Actuator::Pwm(Some(range)) => (value - range.min_us) / (range.max_us - range.min_us),
            Actuator::Speed | Actuator::Thrust | Actuator::Pwm(None) => value,
        }
    }

    /// Thrust of one rotor, N, from the normalised command; below u = 0 there is none.
    #[must_use]
    pub fn thrust_from_command_n(&self, u: f64) -> f64 {
        let u = u.max(0.0);
        match self.law {
            ThrustLaw::Speed { speed_max_rad_s } => {
                self.thrust_coefficient.unwrap_or(f64::NAN) * (u * speed_max_rad_s).powi(2)
            }
            ThrustLaw::Curve { thrust_max_n, expo } => thrust_max_n * ((1.0 - expo) * u + expo * u * u),
        }
    }

    /// Thrust of one rotor at u = 1, N: what sets the scale of all thrusts.
    #[must_use]
    pub fn full_thrust_n(&self) -> f64 {
        self.thrust_from_command_n(1.0)
    }

    /// The same propulsion with `factor` times the thrust at every command and speed.
    #[must_use]
    pub fn scaled(mut self, factor: f64) -> Self {
        self.thrust_coefficient = self.thrust_coefficient.map(|coefficient| coefficient * factor);
        if let ThrustLaw::Curve { thrust_max_n, .. } = &mut self.law {
            *thrust_max_n *= factor;
        }
        self
    }

    /// Second derivative of thrust by command, N: how much thrust the jitter of a command makes.
    #[must_use]
    pub fn thrust_curvature_n(&self) -> f64 {
        match self.law {
            ThrustLaw::Speed { speed_max_rad_s } => {
                2.0 * self.thrust_coefficient.unwrap_or(f64::NAN) * speed_max_rad_s * speed_max_rad_s
            }
            ThrustLaw::Curve { thrust_max_n, expo } => 2.0 * thrust_max_n * expo,
        }
    }

    /// Thrust of one rotor, N, from its measured speed; `None` where no coefficient is known.
    #[must_use]
    pub fn thrust_from_speed_n(&self, speed_rad_s: f64) -> Option<f64> {
        self.thrust_coefficient.map(|k| k * speed_rad_s * speed_rad_s)
    }

    /// The normalised command that gives this thrust (N); inverse of [`Self::thrust_from_command_n`].
    #[must_use]
    pub fn command_from_thrust(&self, thrust_n: f64) -> f64 {
        let thrust_n = thrust_n.max(0.0);
        match self.law {
            ThrustLaw::Speed { speed_max_rad_s } => {
                (thrust_n / self.thrust_coefficient.unwrap_or(f64::NAN)).sqrt() / speed_max_rad_s
            }
            ThrustLaw::Curve { thrust_max_n, expo } => {
                let share = thrust_n / thrust_max_n;
                if expo.abs() < 1e-9 {
                    share
                } else {
                    let b = 1.0 - expo;
                    ((b * b + 4.0 * expo * share).sqrt() - b) / (2.0 * expo)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_and_thrust_invert_each_other() {
        for law in [
            ThrustLaw::Curve { thrust_max_n: 18.86, expo: 0.65 },
            ThrustLaw::Curve { thrust_max_n: 5.0, expo: 0.0 },
            ThrustLaw::Speed { speed_max_rad_s: 1100.0 },
        ] {
            let propulsion = Propulsion {
                actuator: Actuator::Thrust,
                law,
                thrust_coefficient: Some(8.55e-6),
                torque_per_thrust_m: 0.016,
                rotor_radius_m: None,
                time_constant_s: None,
                time_constant_down_s: None,
            };
            for u in [0.0, 0.2, 0.7, 1.0] {
                let thrust = propulsion.thrust_from_command_n(u);
                assert!((propulsion.command_from_thrust(thrust) - u).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn pwm_maps_its_range() {
        let propulsion = Propulsion {
            actuator: Actuator::Pwm(Some(PwmRange { min_us: 1150.0, max_us: 1950.0 })),
            law: ThrustLaw::Curve { thrust_max_n: 18.86, expo: 0.65 },
            thrust_coefficient: None,
            torque_per_thrust_m: 0.007,
            rotor_radius_m: None,
            time_constant_s: None,
            time_constant_down_s: None,
        };
        assert!((propulsion.normalized(1550.0) - 0.5).abs() < 1e-12);
        // 18.86 (0.35 * 0.5 + 0.65 * 0.25) = 6.36525 N
        assert!((propulsion.thrust_from_command_n(0.5) - 6.36525).abs() < 1e-9);
    }
}
