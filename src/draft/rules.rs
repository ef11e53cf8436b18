//! Rules of thumb: what is usual for a multirotor of a mass and a size, by those that others measured and published.

/// A multirotor whose values are published.
struct Published {
    mass_kg: f64,
    /// distance of the rotors from the centre, m
    arm_m: f64,
    /// mean of the moments about the horizontal axes, kg m^2
    horizontal_kg_m2: f64,
    /// about the vertical axis, kg m^2
    vertical_kg_m2: f64,
    /// m
    rotor_radius_m: f64,
    /// torque for each thrust, m, where it was measured
    torque_per_thrust_m: Option<f64>,
}

/// Sources, in turn: Crazyflie 2.0 (Förster 2015, ETH Zürich); AscTec Hummingbird and Pelican (RotorS, Furrer et al. 2016);
/// 3DR Iris (PX4 `sitl_gazebo`); Holybro X500 (PX4-gazebo-models); Quanser `QBall` 2 (the maker); Kingfisher (Foehn et al.
/// 2022, Agilicious).
const PUBLISHED: [Published; 7] = [
    published([0.028, 0.046, 1.66e-5, 2.93e-5, 0.0231], Some(0.005_96)),
    published([0.716, 0.17, 0.007, 0.012, 0.1], Some(0.016)),
    published([1.0, 0.21, 0.01, 0.02, 0.1], Some(0.016)),
    published([1.545, 0.2435, 0.0297, 0.0565, 0.128], None),
    published([2.0643, 0.2461, 0.0238, 0.0439, 0.1397], Some(0.016)),
    published([1.79, 0.2, 0.03, 0.04, 0.127], None),
    published([0.752, 0.125, 0.0023, 0.0043, 0.0635], Some(0.022)),
];

const fn published(
    [mass_kg, arm_m, horizontal_kg_m2, vertical_kg_m2, rotor_radius_m]: [f64; 5],
    torque_per_thrust_m: Option<f64>,
) -> Published {
    Published { mass_kg, arm_m, horizontal_kg_m2, vertical_kg_m2, rotor_radius_m, torque_per_thrust_m }
}

/// A usual value and how far vehicles stand from it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// geometric mean over the published vehicles, in the unit of the rule
    pub usual: f64,
    /// standard deviation of the logarithm: the relative error of one vehicle
    pub relative: f64,
}

impl Rule {
    fn over(values: impl Iterator<Item = f64>) -> Self {
        let logarithms: Vec<f64> = values.map(f64::ln).collect();
        let count = logarithms.len() as f64;
        let mean = logarithms.iter().sum::<f64>() / count;
        let squares: f64 = logarithms.iter().map(|value| (value - mean).powi(2)).sum();
        Self { usual: mean.exp(), relative: (squares / (count - 1.0)).sqrt() }
    }
}

/// Moment about a horizontal axis over `m l^2`, where l is the distance of the rotors from the centre.
#[must_use]
pub fn horizontal_inertia() -> Rule {
    Rule::over(PUBLISHED.iter().map(|one| one.horizontal_kg_m2 / (one.mass_kg * one.arm_m.powi(2))))
}

/// Moment about the vertical axis over `m l^2`.
#[must_use]
pub fn vertical_inertia() -> Rule {
    Rule::over(PUBLISHED.iter().map(|one| one.vertical_kg_m2 / (one.mass_kg * one.arm_m.powi(2))))
}

/// Radius of a rotor over the distance of the rotors from the centre, of quadrotors.
#[must_use]
pub fn rotor_radius() -> Rule {
    Rule::over(PUBLISHED.iter().map(|one| one.rotor_radius_m / one.arm_m))
}

/// Torque for each thrust over the radius of the rotor: `C_Q / C_T` by that radius.
#[must_use]
pub fn torque_per_thrust() -> Rule {
    let ratio = |one: &Published| Some(one.torque_per_thrust_m? / one.rotor_radius_m);
    Rule::over(PUBLISHED.iter().filter_map(ratio))
}

/// Distance of the rotors from the centre over the cube root of the mass, m/kg^(1/3). Its error is chosen: research vehicles
/// are much alike, and frames between a racer and a cargo carrier of one mass are not.
#[must_use]
pub fn arm() -> Rule {
    Rule { relative: 0.4, ..Rule::over(PUBLISHED.iter().map(|one| one.arm_m / one.mass_kg.cbrt())) }
}

/// Mass over the square of the distance of the rotors from the centre, kg/m^2: of the published vehicles the least and the most, which are
/// 13 and 48. It goes with the load of the rotors' discs, which differs less between small and large vehicles than mass over the cube
/// does: a whoop of 65 mm has 26, a racer of 5 inches 60, a carrier of 100 kg with arms of 1.1 m 85.
#[must_use]
pub fn mass_over_arm_squared() -> (f64, f64) {
    let all = PUBLISHED.iter().map(|one| one.mass_kg / one.arm_m.powi(2));
    all.fold((f64::INFINITY, 0.0), |(least, most), one| (least.min(one), most.max(one)))
}

/// A mass that is so many times beyond [`mass_over_arm_squared`] does not go with the arms. Set by judgement: vehicles that fly are within
/// a factor of two, and grams for kilograms, or the mass of another vehicle, are beyond three.
pub const BEYOND_PUBLISHED: f64 = 3.0;

/// Thrust of all rotors over weight. Set by judgement: a multirotor flies with 1.3 to 4 times its weight, and racing
/// machines with 10.
pub const THRUST_TO_WEIGHT: Rule = Rule { usual: 2.2, relative: 0.5 };

/// Exponent of the thrust curve where nothing states it, 0 linear and 1 quadratic, and its standard error. A propeller's
/// thrust goes with the square of its speed, and its speed with less than the command.
pub const THRUST_EXPO: Rule = Rule { usual: 0.6, relative: 0.3 };

/// Standard error of the balance of a vehicle, mean arms across the rotors' axes: where its centre of mass is, and how much its rotors differ.
/// Of one real quadrotor with the same propellers a rotor's share of the thrust differs between flights by 0.05 rms, which is as
/// much.
pub const BALANCE: f64 = 0.018;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_vehicles_are_alike_enough_for_a_rule() {
        let rules = [horizontal_inertia(), vertical_inertia(), rotor_radius(), torque_per_thrust(), arm()];
        for rule in rules {
            assert!(rule.usual > 0.0 && (0.02..0.6).contains(&rule.relative), "{rule:?}");
        }
        // a body is no flatter than a plate: Izz <= Ixx + Iyy
        assert!(vertical_inertia().usual < 2.0 * horizontal_inertia().usual);
    }

    #[test]
    fn mass_goes_with_the_square_of_the_arms() {
        let (least, most) = mass_over_arm_squared();
        assert!((least - 0.028 / 0.046_f64.powi(2)).abs() < 1e-9, "{least}");
        assert!((most - 0.752 / 0.125_f64.powi(2)).abs() < 1e-9, "{most}");
        // vehicles that fly and are not among the published ones: mass and size from motor to motor
        for (mass_kg, size_m) in
            [(0.028, 0.065), (0.7, 0.22), (3.5, 0.43), (15.5, 1.13), (101.0, 2.18), (1.5, 0.9)]
        {
            let of = mass_kg / (0.5 * size_m * 0.5 * size_m);
            assert!((least / BEYOND_PUBLISHED..most * BEYOND_PUBLISHED).contains(&of), "{mass_kg} kg: {of}");
        }
    }

    #[test]
    fn the_rule_is_a_geometric_mean() {
        let rule = Rule::over([1.0, 4.0].into_iter());
        assert!((rule.usual - 2.0).abs() < 1e-12);
        // logarithms 0 and ln 4: their deviation is ln 4 / sqrt 2
        assert!((rule.relative - 4.0_f64.ln() / 2.0_f64.sqrt()).abs() < 1e-12);
    }
}
