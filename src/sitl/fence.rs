//! The fence that the vehicle keeps by itself: borders about home by parameters, and the areas that are stored.

use nalgebra::Vector3;

use super::Settings;
use super::action::Action;
use crate::fence::{Areas, Zone};

/// The areas of the stored fence, in the local frame.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Fence {
    zones: Vec<Zone>,
}

/// What the parameters say of the fence.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct FenceRules {
    /// about home, m
    pub(super) radius_m: Option<f64>,
    /// above home, m
    pub(super) height_max_m: Option<f64>,
    /// the stored areas count
    pub(super) areas: bool,
    /// what a breach makes the vehicle do
    pub(super) action: Action,
}

/// Borders beyond which a place lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Breach {
    pub(super) height: bool,
    pub(super) radius: bool,
    pub(super) areas: bool,
}

impl Fence {
    pub(super) fn of(settings: &Settings) -> Self {
        Self { zones: Areas::of(&settings.fence, &settings.origin.place()).zones }
    }

    /// Whether a place is beyond the borders that are in force; local frame, m.
    pub(super) fn breach(&self, rules: &FenceRules, place_m: &Vector3<f64>, home_m: &Vector3<f64>) -> Breach {
        let from_home = place_m - home_m;
        let beyond = |limit_m: Option<f64>, value_m: f64| limit_m.is_some_and(|limit_m| value_m >= limit_m);
        Breach {
            height: beyond(rules.height_max_m, from_home.z),
            radius: beyond(rules.radius_m, from_home.xy().norm()),
            areas: rules.areas && self.zones.iter().any(|zone| zone.spare_m([place_m.x, place_m.y]) < 0.0),
        }
    }
}

impl Breach {
    pub(super) fn is_any(self) -> bool {
        self.height || self.radius || self.areas
    }

    /// What was not crossed before.
    pub(super) fn since(self, before: Self) -> Self {
        Self {
            height: self.height && !before.height,
            radius: self.radius && !before.radius,
            areas: self.areas && !before.areas,
        }
    }

    /// As ArduPilot names it.
    pub(super) fn ardupilot_name(self) -> String {
        let names = [(self.height, "Max Alt"), (self.radius, "Circle"), (self.areas, "Polygon")];
        let names: Vec<&str> = names.into_iter().filter(|(is, _)| *is).map(|(_, name)| name).collect();
        match names.as_slice() {
            [] => String::new(),
            [one] => format!("{one} fence"),
            [rest @ .., last] => format!("{} and {last} fences", rest.join(", ")),
        }
    }

    /// As PX4 names each.
    pub(super) fn px4_names(self) -> impl Iterator<Item = &'static str> {
        [
            (self.radius, "Geofence violation: exceeding maximum distance to Home"),
            (self.height, "Geofence violation: exceeding maximum altitude above Home"),
            (self.areas, "Geofence violation: approaching or outside geofence"),
        ]
        .into_iter()
        .filter(|(is, _)| *is)
        .map(|(_, name)| name)
    }
}
