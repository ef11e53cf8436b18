//! What a vehicle's description may state and is hardly meant.

use super::description::Vehicle;
use super::propulsion::ThrustLaw;
use super::rotor::Rotor;

/// Radii of gyration over the distance of the rotors from the centre. Published multirotors have 0.38 to 0.87.
const GYRATION: (f64, f64) = (0.15, 1.5);
/// Thrust of all rotors over weight: from a vehicle that hardly climbs to a racer.
const THRUST_TO_WEIGHT: (f64, f64) = (1.2, 15.0);
/// Speed of sound, m/s: no propeller's tip reaches it.
const SOUND_M_S: f64 = 340.0;
/// Torque per thrust over the rotor's radius, `C_Q / C_T`. Published propellers have 0.1 to 0.3.
const TORQUE_OVER_RADIUS: (f64, f64) = (0.02, 0.6);
/// Distance of the rotors from the centre over the cube root of the mass, m/kg^(1/3). Published multirotors have 0.14 to 0.21.
const ARM_OVER_MASS: (f64, f64) = (0.04, 1.2);
/// Distance of two hubs over the rotors' radius: discs overlap by little, or are above each other.
const APART_OVER_RADIUS: f64 = 1.5;
/// Hubs that are nearer to each other than this share of the radius are above each other.
const COAXIAL: f64 = 0.2;
/// Height of a hub over its distance from the centre: arms that are tilted by 35 degrees.
const HEIGHT_OVER_ARM: f64 = 0.7;

impl Vehicle {
    /// What is possible but hardly meant, sentence by sentence.
    #[must_use]
    pub fn implausible(&self) -> Vec<String> {
        let all = [
            body(self),
            gyration(self),
            rotors(self),
            thrust(self),
            tips(self),
            propeller(self),
            arms(self),
            reach(self),
            spacing(self),
        ];
        all.into_iter().flatten().collect()
    }
}

fn body(vehicle: &Vehicle) -> Option<String> {
    let moments = vehicle.body.inertia_kg_m2.symmetric_eigenvalues();
    let (largest, others) = (moments.max(), moments.sum() - moments.max());
    (largest > others * (1.0 + 1e-9)).then(|| {
        format!(
            "body.inertia: these moments are physically impossible: the largest principal moment, {largest:.4e} kg m^2, \
             is above the sum of the other two, {others:.4e}"
        )
    })
}

fn gyration(vehicle: &Vehicle) -> Option<String> {
    let arm_m = vehicle.size().arm_m;
    let moments = vehicle.body.inertia_kg_m2.symmetric_eigenvalues();
    let radius = |moment: f64| (moment / vehicle.body.mass_kg).max(0.0).sqrt() / arm_m;
    let (least, most) = GYRATION;
    let is_odd = |share: &f64| !(least..=most).contains(share);
    let share = moments.iter().map(|moment| radius(*moment)).find(is_odd)?;
    Some(format!(
        "body.inertia: a radius of gyration of {share:.2} of the arms' {arm_m:.3} m; expected {least} to {most}: a wrong unit, \
         or another vehicle's arms?"
    ))
}

fn rotors(vehicle: &Vehicle) -> Option<String> {
    (vehicle.mixer().matrix.svd(false, false).rank(1e-9) < 4)
        .then(|| "rotor: the rotors cannot set thrust and all three torques independently".to_owned())
}

fn thrust(vehicle: &Vehicle) -> Option<String> {
    let full_n = vehicle.propulsion.thrust_from_command_n(1.0) * vehicle.rotors.len() as f64;
    let weight_n = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    if full_n <= weight_n {
        return Some(format!(
            "propulsion: full thrust, {full_n:.3} N, does not lift the weight, {weight_n:.3} N"
        ));
    }
    let (ratio, (least, most)) = (full_n / weight_n, THRUST_TO_WEIGHT);
    (!(least..=most).contains(&ratio)).then(|| {
        format!(
            "propulsion: full thrust, {full_n:.3} N, is {ratio:.2} times the weight, {weight_n:.3} N; expected {least} to {most}"
        )
    })
}

/// The speed of the rotors' tips at full thrust, where it is known.
fn tips(vehicle: &Vehicle) -> Option<String> {
    let propulsion = &vehicle.propulsion;
    let radius_m = propulsion.rotor_radius_m?;
    let full_rad_s = match propulsion.law {
        ThrustLaw::Speed { speed_max_rad_s } => speed_max_rad_s,
        ThrustLaw::Curve { thrust_max_n, .. } => (thrust_max_n / propulsion.thrust_coefficient?).sqrt(),
    };
    let tip_m_s = full_rad_s * radius_m;
    (tip_m_s > SOUND_M_S).then(|| {
        format!(
            "propulsion: at full thrust the rotors' tips move at {tip_m_s:.0} m/s, above the speed of sound: rotor speed in \
             rad/s, rotor_radius in m?"
        )
    })
}

fn propeller(vehicle: &Vehicle) -> Option<String> {
    let radius_m = vehicle.propulsion.rotor_radius_m?;
    let (share, (least, most)) = (vehicle.propulsion.torque_per_thrust_m / radius_m, TORQUE_OVER_RADIUS);
    (!(least..=most).contains(&share)).then(|| {
        format!(
            "propulsion: torque per thrust is {share:.3} of the rotors' radius of {radius_m:.3} m; expected {least} to {most}"
        )
    })
}

/// The arms against the mass.
fn reach(vehicle: &Vehicle) -> Option<String> {
    let (arm_m, mass_kg) = (vehicle.size().arm_m, vehicle.body.mass_kg);
    let (least, most) = ARM_OVER_MASS;
    (!(least..=most).contains(&(arm_m / mass_kg.cbrt()))).then(|| {
        format!(
            "rotor: arms of {arm_m:.3} m on a vehicle of {mass_kg:.3} kg; expected {:.2} to {:.1} m: a wrong unit?",
            least * mass_kg.cbrt(),
            most * mass_kg.cbrt()
        )
    })
}

/// The rotors against the space between their hubs.
fn spacing(vehicle: &Vehicle) -> Option<String> {
    let radius_m = vehicle.propulsion.rotor_radius_m?;
    let rotors = &vehicle.rotors;
    let pairs = rotors
        .iter()
        .enumerate()
        .flat_map(|(index, one)| rotors[..index].iter().map(move |other| (other, one)));
    let apart_m = |(one, other): (&Rotor, &Rotor)| (one.position_m - other.position_m).xy().norm();
    let side_by_side = |pair: &(&Rotor, &Rotor)| apart_m(*pair) > COAXIAL * radius_m;
    let (one, other) = pairs.filter(side_by_side).min_by(|a, b| apart_m(*a).total_cmp(&apart_m(*b)))?;
    let apart_m = apart_m((one, other));
    (apart_m < APART_OVER_RADIUS * radius_m).then(|| {
        format!(
            "propulsion.rotor_radius: {radius_m:.3} m, but the hubs of {} and {} are {apart_m:.3} m apart: their discs would \
             overlap",
            one.name, other.name
        )
    })
}

fn arms(vehicle: &Vehicle) -> Option<String> {
    let center_m =
        vehicle.rotors.iter().map(|rotor| rotor.position_m.z).sum::<f64>() / vehicle.rotors.len() as f64;
    let is_tilted = |rotor: &&Rotor| {
        (rotor.position_m.z - center_m).abs() > HEIGHT_OVER_ARM * rotor.position_m.xy().norm()
    };
    let (index, rotor) = vehicle.rotors.iter().enumerate().find(|(_, rotor)| is_tilted(rotor))?;
    Some(format!(
        "{}: {:.3} m above or below the others, and {:.3} m from the axis; position is x forward, y left, z up",
        rotor.motor_words(index),
        (rotor.position_m.z - center_m).abs(),
        rotor.position_m.xy().norm()
    ))
}
