//! What the name of a column says: what it holds, which part of it, its unit.

/// What a column may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Kind {
    Time,
    Position,
    Velocity,
    Attitude,
    Euler,
    Rate,
    Acceleration,
    WorldAcceleration,
    Command,
    /// before a correction for the battery
    Demand,
    RotorSpeed,
    Voltage,
    Current,
    Armed,
    LandedState,
}

/// Which value of the quantity a column is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    Whole,
    X,
    Y,
    Z,
    W,
    North,
    East,
    Down,
    Up,
    Roll,
    Pitch,
    Yaw,
    Number(u32),
}

/// What a name says.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Said {
    pub kind: Kind,
    /// it is what was ordered, not what was measured
    pub is_setpoint: bool,
    pub part: Part,
    /// as a mapping names it
    pub unit: Option<&'static str>,
    /// the words that columns of one quantity have in common
    pub group: String,
}

/// Words of each kind, the more specific kinds first.
const KINDS: &[(Kind, &[&str])] = &[
    (Kind::Armed, &["armed", "arming"]),
    (Kind::LandedState, &["landed"]),
    (Kind::RotorSpeed, &["rpm", "erpm"]),
    (Kind::Voltage, &["vbat", "volt", "voltage", "vbatt"]),
    (Kind::Current, &["current", "curr", "amps", "ibat"]),
    (
        Kind::Command,
        &["motor", "motors", "mot", "pwm", "rcou", "actuator", "actuators", "servo", "thruster", "esc"],
    ),
    (
        Kind::Rate,
        &[
            "gyro",
            "gyr",
            "gyroscope",
            "rate",
            "rates",
            "omega",
            "angular",
            "rollspeed",
            "pitchspeed",
            "yawspeed",
        ],
    ),
    (Kind::Acceleration, &["acc", "accel", "acceleration", "accelerometer", "specific"]),
    (Kind::Attitude, &["q", "quat", "quaternion"]),
    (Kind::Euler, &["roll", "pitch", "yaw", "heading"]),
    (Kind::Velocity, &["vel", "velocity", "speed"]),
    (Kind::Position, &["pos", "position", "loc", "location"]),
    (Kind::Attitude, &["attitude", "att", "orientation"]),
    (Kind::Time, &["time", "timestamp", "t", "stamp", "clock", "seconds", "micros", "millis"]),
];

/// What was ordered.
const SETPOINT: &[&str] = &[
    "setpoint",
    "sp",
    "des",
    "desired",
    "ref",
    "reference",
    "target",
    "goal",
    "ctrltarget",
    "cmd",
    "commanded",
];

/// Nothing that a mapping has a place for.
const OTHER: &[&str] = &[
    "mag",
    "magnetometer",
    "baro",
    "temp",
    "temperature",
    "pressure",
    "error",
    "err",
    "bias",
    "std",
    "var",
    "cov",
    "variance",
    "covariance",
    "integral",
    "lat",
    "lon",
    "latitude",
    "longitude",
    "gps",
    "rc",
    "torque",
];

/// Units at the end of a name; the longer ones first.
const UNITS: &[(&[&str], &str)] = &[
    (&["m", "s", "2"], "m/s^2"),
    (&["m", "s", "s"], "m/s^2"),
    (&["mss"], "m/s^2"),
    (&["m", "s2"], "m/s^2"),
    (&["mrad", "s"], "mrad/s"),
    (&["rad", "s"], "rad/s"),
    (&["deg", "s"], "deg/s"),
    (&["degs"], "deg/s"),
    (&["dps"], "deg/s"),
    (&["m", "s"], "m/s"),
    (&["mps"], "m/s"),
    (&["rad"], "rad"),
    (&["deg"], "deg"),
    (&["mg"], "mg"),
    (&["g"], "g"),
    (&["rpm"], "rpm"),
    (&["mv"], "mV"),
    (&["cv"], "cV"),
    (&["v"], "V"),
    (&["ca"], "cA"),
    (&["a"], "A"),
    (&["us"], "us"),
    (&["ms"], "ms"),
    (&["sec"], "s"),
    (&["s"], "s"),
    (&["m"], "m"),
];

/// Units that a kind may have: another one at the end of a name is a word of it.
fn may_have(kind: Kind, unit: &str) -> bool {
    let units: &[&str] = match kind {
        Kind::Time => &["s", "ms", "us"],
        Kind::Position => &["m"],
        Kind::Velocity => &["m/s"],
        Kind::Attitude | Kind::Armed | Kind::LandedState => &[],
        Kind::Euler => &["rad", "deg"],
        Kind::Rate => &["rad/s", "deg/s", "mrad/s"],
        Kind::Acceleration | Kind::WorldAcceleration => &["m/s^2", "g", "mg"],
        Kind::Command | Kind::Demand => &["us"],
        Kind::RotorSpeed => &["rpm", "rad/s"],
        Kind::Voltage => &["V", "mV", "cV"],
        Kind::Current => &["A", "cA"],
    };
    units.contains(&unit)
}

/// What a name says; `None` where it says nothing of a flight.
pub(super) fn said(name: &str) -> Option<Said> {
    let (name, index) = without_index(name);
    let words = apart(name);
    if words.iter().any(|word| OTHER.contains(&word.as_str())) {
        return None;
    }
    let (words, unit) = without_unit(&words);
    // `rpm1`: the number stands behind the unit
    let unit = unit.or_else(|| words.iter().any(|word| word == "rpm").then_some("rpm"));
    let is = |all: &[&str]| words.iter().any(|word| all.contains(&word.as_str()));
    let found = KINDS.iter().find(|(_, all)| is(all)).map(|(kind, _)| *kind);
    let kind = match (found, unit) {
        // the letters of the body rates, each a whole name
        (None | Some(Kind::Attitude), _) if index.is_none() && is_body_rate(words) => Kind::Rate,
        // `rotor_1_speed`, `battery_V`, `x`
        (Some(Kind::Velocity), _) if is(&["rotor", "propeller", "prop"]) => Kind::RotorSpeed,
        (None | Some(Kind::Command | Kind::Time), Some("rpm")) => Kind::RotorSpeed,
        (None, Some("V" | "mV" | "cV")) => Kind::Voltage,
        (None, Some("A" | "cA")) => Kind::Current,
        (None, Some("s" | "ms" | "us")) if words.is_empty() => Kind::Time,
        (None, None | Some("m")) if words.len() == 1 && matches!(words[0].as_str(), "x" | "y" | "z") => {
            Kind::Position
        }
        (Some(Kind::Acceleration), _) if is(&["world"]) => Kind::WorldAcceleration,
        (Some(Kind::Command), _) if is(&["demand", "demanded"]) => Kind::Demand,
        (Some(Kind::Rate), _) if is(&["climb", "frame", "sample"]) => return None,
        (Some(kind), _) => kind,
        (None, _) => return None,
    };
    let part = index
        .map(Part::Number)
        .or_else(|| words.iter().rev().find_map(|word| part(kind, word)))
        .unwrap_or(Part::Whole);
    let group =
        words.iter().filter(|word| self::part(kind, word).is_none()).cloned().collect::<Vec<_>>().join(" ");
    let is_setpoint =
        is(SETPOINT) && !matches!(kind, Kind::Command | Kind::Demand | Kind::RotorSpeed | Kind::Time);
    Some(Said { kind, is_setpoint, part, unit: unit.filter(|unit| may_have(kind, unit)), group })
}

/// `p`, `q` or `r`.
fn is_body_rate(words: &[String]) -> bool {
    matches!(words, [word] if ["p", "q", "r"].contains(&word.as_str()))
}

/// A name without the index in brackets at its end, and the index.
fn without_index(name: &str) -> (&str, Option<u32>) {
    let split = || {
        let (front, index) = name.strip_suffix(']')?.rsplit_once('[')?;
        Some((front, Some(index.parse().ok()?)))
    };
    split().unwrap_or((name, None))
}

/// The part that a word stands for.
fn part(kind: Kind, word: &str) -> Option<Part> {
    Some(match word {
        "x" | "forward" => Part::X,
        "y" | "left" => Part::Y,
        "z" => Part::Z,
        "w" => Part::W,
        "n" | "north" => Part::North,
        "e" | "east" => Part::East,
        "d" | "down" => Part::Down,
        "u" | "up" => Part::Up,
        "roll" | "rollspeed" => Part::Roll,
        "pitch" | "pitchspeed" => Part::Pitch,
        "yaw" | "heading" | "yawspeed" => Part::Yaw,
        "p" if kind == Kind::Rate => Part::Roll,
        "q" if kind == Kind::Rate => Part::Pitch,
        "r" if kind == Kind::Rate => Part::Yaw,
        number => Part::Number(number.parse().ok()?),
    })
}

/// The words of a name, in lower case: parted at marks, at digits, and where a capital follows a small letter.
fn apart(name: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before = ' ';
    for letter in name.chars() {
        let goes_on = before.is_alphanumeric()
            && before.is_ascii_digit() == letter.is_ascii_digit()
            && !(before.is_lowercase() && letter.is_uppercase());
        if letter.is_alphanumeric() {
            match words.last_mut().filter(|_| goes_on) {
                Some(word) => word.extend(letter.to_lowercase()),
                None => words.push(letter.to_lowercase().collect()),
            }
        }
        before = letter;
    }
    if let [letter, axis, ..] = words.as_slice()
        && SHORT
            .iter()
            .any(|(short, _, axes)| letter == short && axis.len() == 1 && axes.contains(axis.as_str()))
    {
        // `g_x` is `gx`
        let axis = words.remove(1);
        words[0].push_str(&axis);
    }
    words.into_iter().flat_map(unglued).collect()
}

/// Letters for a quantity, the quantity, and the axes that may follow the letter.
const SHORT: &[(&str, &str, &str)] = &[
    ("v", "vel", "xyzned"),
    ("a", "acc", "xyz"),
    ("g", "gyro", "xyz"),
    ("w", "omega", "xyz"),
    ("p", "pos", "xyzned"),
    ("q", "quat", "wxyz"),
    ("m", "motor", ""),
];

/// `vx` is `vel x`, `xacc` is `acc x`, `gyrox` is `gyro x`.
fn unglued(word: String) -> Vec<String> {
    const LONG: &[&str] = &["gyro", "accel", "acc", "vel", "pos", "quat", "omega", "rate"];
    let axis = |text: &str| ["x", "y", "z", "w", "n", "e", "d"].contains(&text);
    let pair = |kind: &str, axis: &str| vec![kind.to_owned(), axis.to_owned()];
    for (short, whole, axes) in SHORT {
        match word.strip_prefix(short) {
            Some("") if axes.is_empty() => return vec![(*whole).to_owned()],
            Some(rest) if rest.len() == 1 && axes.contains(rest) => return pair(whole, rest),
            _ => {}
        }
    }
    for long in LONG {
        let rest = word.strip_prefix(long).or_else(|| word.strip_suffix(long));
        if let Some(rest) = rest.filter(|rest| axis(rest)) {
            return pair(long, rest);
        }
    }
    vec![word]
}

/// The words before the unit, and the unit.
fn without_unit(words: &[String]) -> (&[String], Option<&'static str>) {
    // a lone `m` was taken for a motor
    let is = |word: &String, unit: &&str| word == unit || *unit == "m" && word == "motor";
    for (end, unit) in UNITS {
        let Some(at) = words.len().checked_sub(end.len()) else { continue };
        if words[at..].iter().zip(end.iter()).all(|(word, unit)| is(word, unit)) && !(at == 0 && *unit == "m")
        {
            // the word of the unit says what it is as well
            return (if *unit == "rpm" { words } else { &words[..at] }, Some(unit));
        }
    }
    (words, None)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &str) -> Option<(Kind, Part, Option<&'static str>, bool)> {
        said(name).map(|said| (said.kind, said.part, said.unit, said.is_setpoint))
    }

    #[test]
    fn names_of_several_loggers_are_understood() {
        for (name, kind, part, unit) in [
            ("timestamp", Kind::Time, Part::Whole, None),
            ("time_s", Kind::Time, Part::Whole, Some("s")),
            ("TimeUS", Kind::Time, Part::Whole, Some("us")),
            ("stateEstimate.qw", Kind::Attitude, Part::W, None),
            ("stateEstimate.vx", Kind::Velocity, Part::X, None),
            ("gyro.x", Kind::Rate, Part::X, None),
            ("gx", Kind::Rate, Part::X, None),
            ("g_y", Kind::Rate, Part::Y, None),
            ("GZ [deg/s]", Kind::Rate, Part::Z, Some("deg/s")),
            ("q", Kind::Rate, Part::Pitch, None),
            ("r_rad_s", Kind::Rate, Part::Yaw, Some("rad/s")),
            ("q[2]", Kind::Attitude, Part::Number(2), None),
            ("a_x", Kind::Acceleration, Part::X, None),
            ("xgyro [mrad/s]", Kind::Rate, Part::X, Some("mrad/s")),
            ("accel_m_s2[2]", Kind::Acceleration, Part::Number(2), Some("m/s^2")),
            ("acc_z_m_s2", Kind::Acceleration, Part::Z, Some("m/s^2")),
            ("motor.m4", Kind::Command, Part::Number(4), None),
            ("rotor_1_speed_rad_s", Kind::RotorSpeed, Part::Number(1), Some("rad/s")),
            ("pm.vbat", Kind::Voltage, Part::Whole, None),
            ("battery_V", Kind::Voltage, Part::Whole, Some("V")),
            ("roll (deg)", Kind::Euler, Part::Roll, Some("deg")),
            ("rollspeed", Kind::Rate, Part::Roll, None),
            ("PN", Kind::Position, Part::North, None),
            ("vel_d", Kind::Velocity, Part::Down, None),
            ("x", Kind::Position, Part::X, None),
            ("acceleration_world_x_m_s2", Kind::WorldAcceleration, Part::X, Some("m/s^2")),
            ("motor_1_demand", Kind::Demand, Part::Number(1), None),
        ] {
            assert_eq!(of(name), Some((kind, part, unit, false)), "{name}");
        }
        assert_eq!(of("pos_sp_x"), Some((Kind::Position, Part::X, None, true)));
        assert_eq!(of("mag.x"), None);
        assert_eq!(of("comment"), None);
    }
}
