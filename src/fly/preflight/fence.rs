//! The vehicle's own fence, in its local frame.

use crate::autopilot::Autopilot;
use crate::fence::{Areas, FenceItem, Zone};
use crate::fly::parameters::{FenceSwitch, Parameters, has_bit};
use crate::frames::Geodetic;
use nalgebra::Vector3;

/// Bits of FENCE_TYPE.
const HEIGHT_MAX: u32 = 0;

const RADIUS: u32 = 1;

const AREAS: u32 = 2;

const HEIGHT_MIN: u32 = 3;

/// A vehicle's fence in its local frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Fence {
    /// areas, m north and west of the local frame's origin
    pub zones: Vec<Zone>,
    /// m from home
    pub radius_m: Option<f64>,
    /// m above home
    pub height_max_m: Option<f64>,
    /// m above home
    pub height_min_m: Option<f64>,
    /// distance that the autopilot itself keeps from all of these, m
    pub margin_m: f64,
    /// reasons why the fence could not be read completely
    pub unknown: Vec<String>,
}

impl Fence {
    /// The active fence, from parameters and the items of the fence mission (in its order); `origin` is that of the
    /// local frame, without which items have no place.
    #[must_use]
    pub fn new(parameters: &Parameters, items: &[FenceItem], origin: Option<&Geodetic>) -> Self {
        let mut fence = Self::default();
        let areas = match parameters.autopilot {
            Autopilot::ArduPilot => fence.ardupilot(parameters),
            Autopilot::Px4 => fence.px4(parameters),
            Autopilot::Other | Autopilot::Unknown => true,
        };
        match (areas && !items.is_empty(), origin) {
            (true, Some(origin)) => fence.place(items, origin),
            (true, None) => {
                fence
                    .unknown
                    .push("the local frame's origin is not known, so its areas have no place".into());
            }
            (false, _) => {}
        }
        fence
    }

    /// Whether areas are in force.
    fn ardupilot(&mut self, parameters: &Parameters) -> bool {
        match FenceSwitch::of(parameters) {
            FenceSwitch::On | FenceSwitch::OnInFlight => {}
            FenceSwitch::Off => return false,
            FenceSwitch::Unknown(name) => {
                self.unknown.push(format!("{name} did not answer"));
                // that it is enabled in flight is the exception, and older releases do not know it
                return name == "FENCE_ENABLE";
            }
        }
        let Some(kinds) = parameters.get("FENCE_TYPE") else {
            self.unknown.push("FENCE_TYPE did not answer".into());
            return true;
        };
        let mut read = |bit: u32, name: &str| {
            let in_force = has_bit(kinds, bit);
            let value = parameters.get(name).filter(|_| in_force);
            if in_force && value.is_none() {
                self.unknown.push(format!("{name} did not answer"));
            }
            value
        };
        let (radius_m, max_m, min_m) = (
            read(RADIUS, "FENCE_RADIUS"),
            read(HEIGHT_MAX, "FENCE_ALT_MAX"),
            read(HEIGHT_MIN, "FENCE_ALT_MIN"),
        );
        self.radius_m = radius_m;
        self.height_max_m = max_m;
        self.height_min_m = min_m;
        self.margin_m = parameters.get("FENCE_MARGIN").unwrap_or(0.0);
        has_bit(kinds, AREAS)
    }

    fn px4(&mut self, parameters: &Parameters) -> bool {
        for name in ["GF_ACTION", "GF_MAX_HOR_DIST", "GF_MAX_VER_DIST"] {
            if parameters.get(name).is_none() {
                self.unknown.push(format!("{name} did not answer"));
            }
        }
        // zero means none
        let positive = |name: &str| parameters.get(name).filter(|value| *value > 0.0);
        self.radius_m = positive("GF_MAX_HOR_DIST");
        self.height_max_m = positive("GF_MAX_VER_DIST");
        true
    }

    fn place(&mut self, items: &[FenceItem], origin: &Geodetic) {
        let Areas { zones, broken } = Areas::of(items, origin);
        self.zones = zones;
        let incomplete = |(came, of)| format!("a polygon has {came} of {of} corners");
        self.unknown.extend(broken.into_iter().map(incomplete));
    }

    /// No border at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.zones.is_empty()
            && [self.radius_m, self.height_max_m, self.height_min_m].iter().all(Option::is_none)
    }

    /// Distance to each border, m, positive where the vehicle may be; places in the local frame.
    pub(super) fn spares_m(
        &self,
        place: &Vector3<f64>,
        home: &Vector3<f64>,
    ) -> impl Iterator<Item = (f64, &'static str)> {
        let place = *place;
        let from_home = place - home;
        let bounds = [
            (self.radius_m.map(|radius| radius - from_home.xy().norm()), "the fence's radius about home"),
            (self.height_max_m.map(|max| max - from_home.z), "the fence's greatest height"),
            (self.height_min_m.map(|min| from_home.z - min), "the fence's least height"),
        ];
        let bounds = bounds.into_iter().filter_map(|(spare, name)| spare.map(|spare| (spare, name)));
        let zones = self.zones.iter().map(move |zone| (zone.spare_m([place.x, place.y]), zone.name()));
        bounds.chain(zones)
    }
}
