//! Each effect in the words of a flight-test engineer, with its numbers.

use crate::diagnose::{Named, NamedParameter};
use crate::physics::effects::by_id;
use crate::report::number::{significant, spoken, with_error};
use crate::vehicle::Vehicle;

/// Values of an effect by their names.
struct Values<'a> {
    named: &'a Named,
}

impl Values<'_> {
    fn get(&self, name: &str) -> Option<&NamedParameter> {
        self.named.parameters.iter().find(|parameter| parameter.name == name)
    }

    fn value(&self, name: &str) -> f64 {
        self.get(name).map_or(0.0, |parameter| parameter.value)
    }

    /// `factor` brings it to the unit in which it is said.
    fn said(&self, name: &str, factor: f64) -> String {
        self.get(name).map_or_else(|| "0".to_owned(), |p| with_error(factor * p.value, factor.abs() * p.std))
    }
}

/// Mean of the drag along body x and y, of those that were found.
fn mean_drag(values: &Values<'_>) -> f64 {
    let found: Vec<f64> =
        ["dx", "dy"].iter().map(|name| values.value(name)).filter(|value| *value != 0.0).collect();
    found.iter().sum::<f64>() / found.len().max(1) as f64
}

/// What was left out, as a clause that begins with a capital and ends without a full stop.
#[must_use]
pub fn clause(named: &Named, vehicle: &Vehicle) -> String {
    let values = Values { named };
    let mass_kg = vehicle.body.mass_kg;
    match named.id {
        "linear_drag" => format!(
            "Drag was left out: {} ({} 1/s), throughout the flight, growing with airspeed",
            axes(&values, &["dx", "dy", "dz"], "N per m/s"),
            significant(mean_drag(&values) / mass_kg, 2)
        ),
        "quadratic_drag" => format!(
            "Drag that grows with the square of the airspeed was left out: {}",
            axes(&values, &["cx", "cy", "cz"], "N per (m/s)^2")
        ),
        "angular_damping" => format!(
            "Damping of the rotation was left out: {}",
            axes(&values, &["bx", "by", "bz"], "N m per rad/s")
        ),
        "ground_effect" => ground(&values, vehicle),
        "steady_wind" => wind(&values),
        "mass_change" => mass_change(&values, mass_kg),
        "weak_rotor" => weak_rotor(&values, vehicle),
        "com_offset" => com_offset(&values),
        "thrust_tilt" => format!(
            "The thrust axis leans by {} deg about body x and {} deg about body y: thrust pushes sideways, fixed in the body",
            values.said("x", 1.0_f64.to_degrees()),
            values.said("y", 1.0_f64.to_degrees())
        ),
        "thrust_curve" => format!(
            "The thrust curve is bent: about hover thrust changes with the command {} % {} than the vehicle file says",
            values.said("curvature", 100.0 * values.value("curvature").signum()),
            if values.value("curvature") > 0.0 { "more" } else { "less" }
        ),
        "battery_sag" => format!(
            "Thrust falls with the battery: as its voltage to the power of {}, from {} V on",
            values.said("exponent", 1.0),
            significant(values.value("full_voltage"), 4)
        ),
        "motor_lag" if values.get("time_constant_down").is_some() => format!(
            "The motors' lag was left out: the rotors follow their commands with a time constant of {} ms up and {} ms down",
            values.said("time_constant", 1e3),
            values.said("time_constant_down", 1e3)
        ),
        "slung_load" => format!(
            "A load swings below: {} kg on a cord of {} m",
            values.said("mass", 1.0),
            values.said("length", 1.0)
        ),
        _ => of_one_number(&values).unwrap_or_else(|| in_general(named)),
    }
}

/// Effects that are told by one number: identifier, parameter, factor to the unit that is said, and the words before
/// and after it.
const OF_ONE_NUMBER: [(&str, &str, f64, &str, &str); 8] = [
    (
        "motor_lag",
        "time_constant",
        1e3,
        "The motors' lag was left out: the rotors follow their commands with a time constant of",
        "ms",
    ),
    ("transport_delay", "delay", 1e3, "A delay was left out: commands act", "ms after they were sent"),
    (
        "rotor_inertia",
        "jr",
        1.0,
        "The rotors' own inertia was left out:",
        "kg m^2 each; spinning them up yaws the vehicle, turning it tilts them",
    ),
    (
        "blade_flapping",
        "k",
        1.0,
        "The rotors' hub moment was left out:",
        "N m per m/s of airspeed across the rotor axis",
    ),
    ("inflow", "kz", 1.0, "Thrust falls with climb: by", "N per m/s of airspeed along the rotor axis"),
    (
        "translational_lift",
        "kh",
        1.0,
        "Translational lift was left out:",
        "N per (m/s)^2 of airspeed across the rotor axis",
    ),
    ("tether", "line_mass", 1e3, "A line leads down to the ground:", "g more for each metre of height"),
    (
        "vortex_ring",
        "loss",
        1.0,
        "It sank into its own wake: the loss of thrust is",
        "times that of Leishman's vortex ring",
    ),
];

/// In the words of [`OF_ONE_NUMBER`].
fn of_one_number(values: &Values<'_>) -> Option<String> {
    let (_, parameter, factor, before, after) =
        OF_ONE_NUMBER.iter().find(|(id, ..)| *id == values.named.id)?;
    Some(format!("{before} {} {after}", values.said(parameter, *factor)))
}

/// The effect's own sentence with its values.
fn in_general(named: &Named) -> String {
    let values: Vec<String> = named
        .parameters
        .iter()
        .map(|p| {
            format!("{} {} {}", p.name, with_error(p.value, p.std), spoken(p.unit)).trim_end().to_owned()
        })
        .collect();
    let sentence = by_id(named.id).map_or(named.id, |effect| effect.sentence());
    format!("{} ({})", sentence.trim_end_matches('.'), values.join(", "))
}

/// One number where the axes agree within two standard errors, else one an axis.
fn axes(values: &Values<'_>, names: &[&str], unit: &str) -> String {
    const AXES: [&str; 3] = ["x", "y", "z"];
    let known: Vec<(&str, &NamedParameter)> =
        names.iter().zip(AXES).filter_map(|(name, axis)| Some((axis, values.get(name)?))).collect();
    let weight: f64 = known.iter().map(|(_, p)| p.std.powi(-2)).sum();
    let mean = known.iter().map(|(_, p)| p.value * p.std.powi(-2)).sum::<f64>() / weight;
    let alike = known.iter().all(|(_, p)| (p.value - mean).abs() < 2.0 * p.std);
    let list = |parts: Vec<String>| match parts.as_slice() {
        [most @ .., last] if !most.is_empty() => format!("{} and {last}", most.join(", ")),
        all => all.concat(),
    };
    if alike && weight.is_finite() && known.len() > 1 {
        let along = list(known.iter().map(|(axis, _)| (*axis).to_owned()).collect());
        return format!("{} {unit} along body {along}", with_error(mean, weight.powf(-0.5)));
    }
    let each = known.iter().map(|(axis, p)| format!("{} along {axis}", with_error(p.value, p.std)));
    format!("{} {unit} of the body", list(each.collect()))
}

/// Sides, not signs; what was not estimated is not said.
fn com_offset(values: &Values<'_>) -> String {
    let side = |name: &str, plus: &str, minus: &str| {
        let p = values.get(name).filter(|p| p.std > 0.0)?;
        let side = if p.value < 0.0 { minus } else { plus };
        Some(format!("{} mm {side}", with_error(1e3 * p.value.abs(), 1e3 * p.std)))
    };
    let sides: Vec<String> =
        [side("x", "forward", "aft"), side("y", "to the left", "to the right"), side("z", "above", "below")]
            .into_iter()
            .flatten()
            .collect();
    format!(
        "The centre of mass is {} of where the vehicle file has it: thrust turns the vehicle about it",
        sides.join(" and ")
    )
}

fn ground(values: &Values<'_>, vehicle: &Vehicle) -> String {
    let radius = vehicle.propulsion.rotor_radius_m;
    let (rho, ca, cb) = (values.value("rho"), values.value("ca"), values.value("cb"));
    // two radii up
    let gain_percent = 100.0 * (1.0 / (1.0 - rho / 64.0) - 1.0 + ca * (-2.0 * cb).exp());
    let height = radius.map_or(String::new(), |radius_m| {
        format!("{} % more thrust at {} m", significant(gain_percent, 2), significant(2.0 * radius_m, 2))
    });
    let by = if ca > 0.0 {
        format!("falling by e every {} rotor radii", significant(1.0 / cb, 2))
    } else {
        format!("{} times that of Cheeseman and Bennett, fading with height", values.said("rho", 1.0))
    };
    let parts: Vec<String> = [by, height].into_iter().filter(|part| !part.is_empty()).collect();
    format!("Ground effect was left out: {}", parts.join(", "))
}

/// Compass points, clockwise from north.
const POINTS: [&str; 8] =
    ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/// Degrees from north, clockwise, from where a wind towards north and west (m/s) comes.
fn from_deg(north: f64, west: f64) -> f64 {
    west.atan2(-north).to_degrees().rem_euclid(360.0)
}

/// The point of the compass from where a wind towards north and west (m/s) comes.
pub(super) fn point_of(north: f64, west: f64) -> &'static str {
    let from_deg = from_deg(north, west);
    POINTS
        .iter()
        .cycle()
        .zip([0.0, 45.0, 90.0, 135.0, 180.0, 225.0, 270.0, 315.0, 360.0])
        .min_by(|a, b| (a.1 - from_deg).abs().total_cmp(&(b.1 - from_deg).abs()))
        .map_or("north", |(name, _)| name)
}

fn wind(values: &Values<'_>) -> String {
    let (north, east) = (values.value("north"), -values.value("west"));
    let speed = north.hypot(east);
    let std = |name: &str| values.get(name).map_or(0.0, |p| p.std);
    let speed_std = if speed > 0.0 {
        (north * std("north")).hypot(east * std("west")) / speed
    } else {
        std("north").max(std("west"))
    };
    let from_deg = from_deg(north, -east);
    let point = point_of(north, -east);
    format!(
        "A steady wind was left out: {} m/s from {point} ({from_deg:.0} deg), {} m/s towards north and {} m/s towards west",
        with_error(speed, speed_std),
        values.said("north", 1.0),
        values.said("west", 1.0)
    )
}

fn mass_change(values: &Values<'_>, mass_kg: f64) -> String {
    let delta = values.value("delta");
    format!(
        "The mass changed in flight: {} kg ({} %) from {} s on",
        values.said("delta", 1.0),
        significant(100.0 * delta / mass_kg, 2),
        values.said("time", 1.0)
    )
}

/// `rotor front_left`, by its number.
pub(super) fn rotor_name(vehicle: &Vehicle, number: f64) -> String {
    let mut rotors = vehicle.rotors.iter().enumerate();
    rotors
        .find(|(index, _)| (*index as f64 - number).abs() < 0.5)
        .map_or_else(|| format!("rotor {number:.0}"), |(_, rotor)| format!("rotor {}", rotor.name))
}

fn weak_rotor(values: &Values<'_>, vehicle: &Vehicle) -> String {
    let name = rotor_name(vehicle, values.value("rotor"));
    let factor = values.value("factor");
    let std = values.get("factor").map_or(0.0, |p| p.std);
    let (what, change) = if factor < 1.0 { ("weak", 1.0 - factor) } else { ("strong", factor - 1.0) };
    format!(
        "{name} is {what}: its thrust and torque are {} % {} than the others'",
        with_error(100.0 * change, 100.0 * std),
        if factor < 1.0 { "less" } else { "more" }
    )
    .replacen("rotor", "Rotor", 1)
}

/// How an effect is called in a list.
#[must_use]
pub fn called(id: &str) -> &'static str {
    match id {
        "linear_drag" => "drag",
        "quadratic_drag" => "drag with the square of the airspeed",
        "ground_effect" => "ground effect",
        "ceiling_effect" => "ceiling effect",
        "motor_lag" => "motor lag",
        "transport_delay" => "a delay of the commands",
        "thrust_curve" => "a bent thrust curve",
        "battery_sag" => "battery sag",
        "weak_rotor" => "a weak rotor",
        "com_offset" => "a centre of mass that is off",
        "thrust_tilt" => "a leaning thrust axis",
        "rotor_inertia" => "the rotors' inertia",
        "angular_damping" => "damping of the rotation",
        "blade_flapping" => "the rotors' hub moment",
        "inflow" => "thrust that falls with climb",
        "translational_lift" => "translational lift",
        "steady_wind" => "a steady wind",
        "gust" => "gusts",
        "slung_load" => "a slung load",
        "mass_change" => "a change of mass",
        "imu_misalignment" => "an inertial unit that sits askew",
        "imu_offset" => "an accelerometer away from the centre of mass",
        "frame_misalignment" => "a position reference that is askew",
        "tether" => "a tether",
        "vortex_ring" => "the vortex ring state",
        _ => "an effect without a name",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Strength;
    use crate::physics::effects::ALL;

    fn vehicle() -> Vehicle {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
        crate::config::load_vehicle(&path).unwrap()
    }

    fn named(id: &str, values: &[(&str, f64, f64)]) -> Named {
        let effect = by_id(id).unwrap();
        let parameters = effect
            .parameters()
            .iter()
            .filter_map(|p| {
                let (_, value, std) = values.iter().find(|(name, ..)| *name == p.name)?;
                Some(NamedParameter { name: p.name, value: *value, std: *std, unit: p.unit })
            })
            .collect();
        Named {
            id: effect.id(),
            sentence: effect.sentence(),
            parameters,
            strength: Strength::default(),
            confusable_with: Vec::new(),
        }
    }

    #[test]
    fn drag_is_one_number_where_the_axes_agree() {
        let vehicle = vehicle();
        let text = clause(&named("linear_drag", &[("dx", 0.41, 0.02), ("dy", 0.42, 0.02)]), &vehicle);
        assert!(
            text.starts_with("Drag was left out: 0.415 +- 0.014 N per m/s along body x and y (0.2"),
            "{text}"
        );
        let text = clause(&named("linear_drag", &[("dx", 0.41, 0.01), ("dy", 0.61, 0.02)]), &vehicle);
        assert!(text.contains("0.410 +- 0.010 along x and 0.61 +- 0.02 along y N per m/s"), "{text}");
    }

    #[test]
    fn wind_comes_from_where_it_blows() {
        // towards north and west: from the south-east
        let text = clause(&named("steady_wind", &[("north", 2.5, 0.1), ("west", 1.5, 0.1)]), &vehicle());
        assert!(text.contains("2.92 +- 0.10 m/s from south-east (149 deg)"), "{text}");
    }

    #[test]
    fn every_effect_has_a_clause_of_its_own_or_its_sentence() {
        let vehicle = vehicle();
        for effect in ALL {
            let values: Vec<(&str, f64, f64)> = effect
                .parameters()
                .iter()
                .map(|p| (p.name, (p.min + 0.1 * (p.max.min(10.0) - p.min)).max(0.01), 0.01))
                .collect();
            let text = clause(&named(effect.id(), &values), &vehicle);
            let begins = text.chars().next().is_some_and(char::is_uppercase);
            assert!(begins && !text.ends_with('.') && !text.contains("NaN"), "{}: {text}", effect.id());
            assert_ne!(called(effect.id()), "an effect without a name");
        }
        let rotor = clause(&named("weak_rotor", &[("rotor", 1.0, 0.0), ("factor", 0.97, 0.001)]), &vehicle);
        assert!(rotor.starts_with("Rotor ") && rotor.contains("3.00 +- 0.10 % less"), "{rotor}");
    }
}
