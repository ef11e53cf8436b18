//! Parameters: names, types, units, defaults, and what was renamed between releases.

use mavlink::dialects::ardupilotmega::MavParamType;

use super::release::Release;

/// MAV_PARAM_TYPE of a parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterType {
    /// signed, 8 bits
    Int8,
    /// signed, 16 bits
    Int16,
    /// signed, 32 bits
    Int32,
    /// single precision
    Real32,
}

impl ParameterType {
    /// In a message.
    #[must_use]
    pub const fn mav(self) -> MavParamType {
        match self {
            Self::Int8 => MavParamType::MAV_PARAM_TYPE_INT8,
            Self::Int16 => MavParamType::MAV_PARAM_TYPE_INT16,
            Self::Int32 => MavParamType::MAV_PARAM_TYPE_INT32,
            Self::Real32 => MavParamType::MAV_PARAM_TYPE_REAL32,
        }
    }
}

/// What a flight needs a parameter for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Purpose {
    /// from an actuator output to a rotor's thrust
    Thrust,
    /// what the vehicle does by itself
    Failsafe,
    /// what the autopilot makes of a setpoint
    Limit,
    /// what the autopilot logs
    Logging,
}

/// Unit of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Unit {
    /// as it is written
    pub symbol: &'static str,
    /// how many of it make one of its base unit: SI, but degrees for angles
    pub per_base: f64,
}

/// Units of parameters.
pub(crate) mod units {
    use super::Unit;

    const fn unit(symbol: &'static str, per_base: f64) -> Unit {
        Unit { symbol, per_base }
    }

    pub(crate) const NONE: Unit = unit("", 1.0);
    pub(crate) const S: Unit = unit("s", 1.0);
    pub(crate) const PER_S: Unit = unit("1/s", 1.0);
    pub(crate) const HZ: Unit = unit("Hz", 1.0);
    pub(crate) const B_S: Unit = unit("B/s", 1.0);
    pub(crate) const V: Unit = unit("V", 1.0);
    pub(crate) const MAH: Unit = unit("mAh", 1.0 / 3.6);
    pub(crate) const US: Unit = unit("us", 1e6);
    pub(crate) const M: Unit = unit("m", 1.0);
    pub(crate) const M_S: Unit = unit("m/s", 1.0);
    pub(crate) const M_S2: Unit = unit("m/s^2", 1.0);
    pub(crate) const M_S3: Unit = unit("m/s^3", 1.0);
    pub(crate) const CM: Unit = unit("cm", 100.0);
    pub(crate) const CM_S: Unit = unit("cm/s", 100.0);
    pub(crate) const CM_S2: Unit = unit("cm/s^2", 100.0);
    pub(crate) const DEG: Unit = unit("deg", 1.0);
    pub(crate) const DEG_S: Unit = unit("deg/s", 1.0);
    pub(crate) const DEG_S2: Unit = unit("deg/s^2", 1.0);
    pub(crate) const CDEG: Unit = unit("cdeg", 100.0);
    pub(crate) const CDEG_S2: Unit = unit("cdeg/s^2", 100.0);
}

/// One parameter, by its name in the oldest release that is known here.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// at most 16 letters
    pub name: &'static str,
    /// of its value on the wire
    pub kind: ParameterType,
    /// of its value
    pub unit: Unit,
    /// what the embedded vehicle begins with, in `unit`: the release's default. `None` where it depends on the vehicle or
    /// the embedded one has none
    pub default: Option<f64>,
    /// gone with this release
    pub until: Option<Release>,
    /// new with this release
    pub since: Option<Release>,
}

impl Parameter {
    /// One that the vehicle decides, or that the embedded one has not.
    pub(crate) const fn of_vehicle(name: &'static str, kind: ParameterType, unit: Unit) -> Self {
        Self { name, kind, unit, default: None, until: None, since: None }
    }

    /// One with a default.
    pub(crate) const fn of_release(
        name: &'static str,
        kind: ParameterType,
        unit: Unit,
        default: f64,
    ) -> Self {
        Self { default: Some(default), ..Self::of_vehicle(name, kind, unit) }
    }

    pub(crate) const fn until(self, release: Release) -> Self {
        Self { until: Some(release), ..self }
    }

    pub(crate) const fn since(self, release: Release) -> Self {
        Self { since: Some(release), ..self }
    }

    /// Whether a release has it.
    fn is_in(&self, release: Release) -> bool {
        self.until.is_none_or(|until| release < until) && self.since.is_none_or(|since| release >= since)
    }
}

/// A parameter that changed its name and perhaps its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Renamed {
    /// before
    pub old: &'static str,
    /// since
    pub new: &'static str,
    /// of its value on the wire since then
    pub kind: ParameterType,
    /// value under the old name = scale times value under the new one
    pub scale: f64,
}

/// All parameters of an autopilot that are known here.
#[derive(Debug)]
pub struct ParameterTable {
    /// [`Purpose::Thrust`], most needed first
    pub thrust: &'static [Parameter],
    /// [`Purpose::Failsafe`]
    pub failsafes: &'static [Parameter],
    /// [`Purpose::Limit`]
    pub limits: &'static [Parameter],
    /// what no flight asks for, and the embedded vehicle has
    pub others: &'static [Parameter],
    /// new names of those above; the name of the current release before those of development versions
    pub renamed: &'static [Renamed],
    /// the release that brought the new names
    pub renamed_since: Release,
}

impl ParameterTable {
    /// What a flight asks for, most needed first.
    pub fn needed(&self) -> impl Iterator<Item = (Purpose, &'static Parameter)> {
        let of = |purpose, list: &'static [Parameter]| list.iter().map(move |entry| (purpose, entry));
        of(Purpose::Thrust, self.thrust)
            .chain(of(Purpose::Failsafe, self.failsafes))
            .chain(of(Purpose::Limit, self.limits))
    }

    fn all(&self) -> impl Iterator<Item = &'static Parameter> {
        self.needed().map(|(_, entry)| entry).chain(self.others)
    }

    /// A parameter by its older name.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&'static Parameter> {
        self.all().find(|entry| entry.name == name)
    }

    /// The newer names of a parameter, with what each changed; `name` is the older one.
    pub fn renames_of(&self, name: &str) -> impl Iterator<Item = &'static Renamed> {
        self.renamed.iter().filter(move |renamed| renamed.old == name)
    }

    /// Name, type and default of every parameter of a release that has a default.
    pub fn defaults(&self, release: Release) -> impl Iterator<Item = (&'static str, ParameterType, f64)> {
        let current = move |entry: &'static Parameter, default: f64| {
            let renamed =
                (release >= self.renamed_since).then(|| self.renames_of(entry.name).next()).flatten();
            match renamed {
                Some(renamed) => (renamed.new, renamed.kind, default / renamed.scale),
                None => (entry.name, entry.kind, default),
            }
        };
        let of_release = self.all().filter(move |entry| entry.is_in(release));
        of_release.filter_map(move |entry| entry.default.map(|default| current(entry, default)))
    }
}
