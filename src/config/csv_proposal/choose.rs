//! Unit, scale and axes of a group of columns: by its names, and where they do not say it by its numbers.

use crate::log::csv::TableHead;

use super::group::Group;
use super::numbers::Numbers;
use super::words::{Kind, Part};

/// What is proposed for a group, and what is not sure about it.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Chosen {
    pub unit: Option<&'static str>,
    pub scale: Option<f64>,
    pub frame: Option<&'static str>,
    pub unsure: Vec<String>,
}

impl Chosen {
    fn unit(unit: &'static str) -> Self {
        Self { unit: Some(unit), ..Self::default() }
    }

    fn guessed(unit: &'static str, why: &str) -> Self {
        Self { unsure: vec![format!("the unit {unit}: {why}")], ..Self::unit(unit) }
    }
}

/// Standard gravity and how far a mean over a flight may be from it, in the unit.
const GRAVITIES: [(f64, f64, &str); 3] = [(9.81, 3.0, "m/s^2"), (1.0, 0.3, "g"), (1000.0, 300.0, "mg")];
/// Greatest body rate of a flight that is flown in rad/s and not in degrees, rad/s.
const FASTEST_RAD_S: f64 = 15.0;
/// Greatest angle in rad.
const TURN_RAD: f64 = 6.4;

/// Unit and scale of a group.
pub(super) fn unit(head: &TableHead, group: &Group) -> Chosen {
    let numbers = Numbers::of(head, group);
    if matches!(group.kind, Kind::Command | Kind::Demand) {
        return command(group, &numbers);
    }
    if let Some(unit) = group.unit {
        return Chosen::unit(unit);
    }
    match group.kind {
        Kind::Time => time(&numbers),
        Kind::Rate => rate(&numbers),
        Kind::Acceleration if group.is_setpoint => Chosen::unit("m/s^2"),
        Kind::WorldAcceleration => Chosen::guessed("m/s^2", "the name says none"),
        Kind::Acceleration => {
            let norm = numbers.median_norm().unwrap_or(f64::NAN);
            let fits = GRAVITIES.iter().find(|(gravity, margin, _)| (norm - gravity).abs() < *margin);
            match fits {
                Some((_, _, unit)) => Chosen::unit(unit),
                None => Chosen::guessed(
                    "m/s^2",
                    &format!("the median norm is {norm:.2}, which is gravity in no unit"),
                ),
            }
        }
        Kind::Euler => match numbers.greatest() {
            Some(most) if most > TURN_RAD => Chosen::unit("deg"),
            _ => Chosen::guessed("rad", "the name says none, and no angle is greater than a turn in rad"),
        },
        Kind::RotorSpeed => Chosen::guessed("rad/s", "the name says none"),
        Kind::Voltage => match numbers.mean(0) {
            Some(mean) if mean > 2000.0 => Chosen::unit("mV"),
            Some(mean) if mean > 100.0 => Chosen::guessed("cV", &format!("the mean is {mean:.0}")),
            _ => Chosen::unit("V"),
        },
        Kind::Current => match numbers.mean(0) {
            Some(mean) if mean > 200.0 => Chosen::guessed("cA", &format!("the mean is {mean:.0}")),
            _ => Chosen::unit("A"),
        },
        _ => Chosen::default(),
    }
}

/// Body rates whose names say no unit: by their size, and to be confirmed.
fn rate(numbers: &Numbers<'_>) -> Chosen {
    match numbers.greatest() {
        Some(most) if most > FASTEST_RAD_S => {
            let why = format!(
                "the names say none, and the greatest rate is {most:.0}, which is too fast in rad/s. Confirm it, or write rad/s"
            );
            Chosen::guessed("deg/s", &why)
        }
        Some(most) => {
            let why = format!(
                "the names say none, and the greatest rate is {most:.2}: in deg/s the vehicle would hardly turn. Confirm it, or write \
                 deg/s"
            );
            Chosen::guessed("rad/s", &why)
        }
        None => {
            Chosen::guessed("rad/s", "the names say none, and there is no number. Confirm it, or write deg/s")
        }
    }
}

fn time(numbers: &Numbers<'_>) -> Chosen {
    let Some(step) = numbers.median_step() else {
        return Chosen::guessed("s", "no two rows with rising times");
    };
    let found = format!("rows are {step} apart");
    match step {
        step if step < 0.5 => Chosen::unit("s"),
        step if step < 100.0 => Chosen::guessed("ms", &found),
        step if step < 1e6 => Chosen::guessed("us", &found),
        _ => Chosen { scale: Some(1e-3), ..Chosen::guessed("us", &format!("{found}, as nanoseconds are")) },
    }
}

fn command(group: &Group, numbers: &Numbers<'_>) -> Chosen {
    let Some(most) = numbers.greatest() else { return Chosen::default() };
    let scaled = |full: f64| Chosen {
        scale: Some(1.0 / full),
        unsure: vec![format!("full scale is {full}: the greatest command is {most}")],
        ..Chosen::default()
    };
    match most {
        most if most <= 1.05 => Chosen::unit("1"),
        most if most <= 101.0 => scaled(100.0),
        most if most <= 256.0 => scaled(255.0),
        most if most <= 1000.0 => scaled(1000.0),
        most if most <= 2200.0 => match group.unit {
            Some(unit) => Chosen::unit(unit),
            None => Chosen::guessed("us", &format!("the greatest command is {most}")),
        },
        most if most <= 65_535.0 => scaled(65_535.0),
        _ => {
            Chosen { unsure: vec![format!("the scale: the greatest command is {most}")], ..Chosen::default() }
        }
    }
}

/// Axes of the body and of the world, as the table shows them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Axes {
    /// z is down
    pub body_down: Option<bool>,
    /// z is down
    pub world_down: Option<bool>,
    /// columns are named north, east, down, and none east, north, up
    pub is_ned: bool,
    /// the other way round
    pub is_enu: bool,
}

impl Axes {
    /// By gravity in the accelerometer, and by the heights and names of positions.
    pub fn of(head: &TableHead, groups: &[Group]) -> Self {
        let measured = |kind: Kind| groups.iter().find(move |group| group.kind == kind && !group.is_setpoint);
        let sign = |kind: Kind, least: f64| {
            let numbers = Numbers::of(head, measured(kind)?);
            let (mean, norm) = (numbers.mean(2)?, numbers.median_norm()?);
            (mean.abs() > least * norm).then_some(mean < 0.0)
        };
        let places = || groups.iter().filter(|group| matches!(group.kind, Kind::Position | Kind::Velocity));
        let begins = |part: Part| places().any(|group| group.parts.first() == Some(&part));
        let (north, east) = (begins(Part::North), begins(Part::East));
        // a table in both says nothing of its other columns
        let (is_ned, is_enu) = (north && !east, east && !north);
        Self {
            body_down: sign(Kind::Acceleration, 0.6),
            world_down: if is_ned {
                Some(true)
            } else if is_enu {
                Some(false)
            } else {
                sign(Kind::Position, 0.05)
            },
            is_ned,
            is_enu,
        }
    }

    /// The frame of a group as a mapping names it, and what is not sure about it.
    pub fn frame(&self, group: &Group) -> (Option<&'static str>, Option<String>) {
        let (body, world) = (self.body_down, self.world_down);
        let assumed = |what: &str| Some(format!("the axes: {what}"));
        match group.kind {
            Kind::Acceleration if !group.is_setpoint => match body {
                Some(down) => (Some(if down { "frd" } else { "flu" }), None),
                None => (Some("flu"), assumed("gravity is along no z axis of the accelerometer")),
            },
            Kind::Rate => match body {
                Some(down) => (
                    Some(if down { "frd" } else { "flu" }),
                    assumed("taken to be those of the accelerometer"),
                ),
                None => (Some("flu"), assumed("nothing shows whether z is up or down")),
            },
            Kind::Position | Kind::Velocity | Kind::Acceleration | Kind::WorldAcceleration => {
                match group.parts.first() {
                    Some(Part::North) => return (Some("ned"), None),
                    Some(Part::East) => return (Some("enu"), None),
                    _ => {}
                }
                match (self.is_enu, self.is_ned, world) {
                    (true, ..) => (Some("enu"), assumed("taken to be those of the other columns")),
                    (_, true, _) => (Some("ned"), assumed("taken to be those of the other columns")),
                    (.., Some(true)) => (Some("ned"), assumed("z is down by the sign of the heights")),
                    (.., Some(false)) => {
                        (Some("nwu"), assumed("z is up; x may be north, east, or an axis of the laboratory"))
                    }
                    (.., None) => (Some("nwu"), assumed("nothing shows whether z is up or down")),
                }
            }
            Kind::Euler if group.parts.len() == 1 => match (self.is_enu, self.is_ned, world) {
                (true, ..) => (Some("enu"), None),
                (_, true, _) => (Some("ned"), None),
                (.., Some(true)) => (Some("ned"), assumed("yaw is taken to grow to the right, as z is down")),
                _ => (Some("nwu"), assumed("yaw is taken to grow to the left")),
            },
            Kind::Attitude | Kind::Euler => {
                let frame = match (self.is_enu, body.or(world)) {
                    (true, _) => "flu-enu",
                    (_, Some(true)) => "frd-ned",
                    _ => "flu-nwu",
                };
                (Some(frame), assumed("taken to be those of the other columns"))
            }
            _ => (None, None),
        }
    }
}

/// Whether the four numbers of a quaternion begin with w: in flight w and z are large, x and y small. `None` where it cannot be
/// told.
pub(super) fn begins_with_w(head: &TableHead, group: &Group) -> Option<bool> {
    let numbers = Numbers::of(head, group);
    let (first, third) = (numbers.mean_size(0)?, numbers.mean_size(2)?);
    let (least, most) = (first.min(third), first.max(third));
    (most > 3.0 * least).then_some(first > third)
}
