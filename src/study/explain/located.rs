//! Where simulation and recording differ, in the words of JSON and of people.

use crate::diagnose::locate::{Follow, Localisation};
use crate::diagnose::{AXES, CHANNEL_NAMES, Explanation, SECOND, Verdict};
use crate::vehicle::AXIS_NAMES;
use schemars::JsonSchema;
use serde::Serialize;

/// An axis' share of the misfit.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct AxisShare {
    /// as in [`CHANNEL_NAMES`]
    pub axis: &'static str,
    /// percent
    pub share_percent: f64,
}

/// What a variable of the state explains of the misfit of one axis.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct StateShare {
    /// name
    pub variable: String,
    /// axis whose residual follows it
    pub axis: &'static str,
    /// percent
    pub share_percent: f64,
    /// value of the variable at which the misfit is largest, SI
    pub peak_at: f64,
}

/// A force that belongs to the room.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Field {
    /// world axis of the force
    pub force_along: &'static str,
    /// N, at its largest
    pub force_n: f64,
    /// world axis along which it changes
    pub changes_along: &'static str,
    /// m, where along it
    pub at_m: f64,
    /// m, how wide
    pub extent_m: f64,
}

/// The misfit by axis, time, state and frequency.
#[derive(Debug, Clone, PartialEq, Default, Serialize, JsonSchema)]
pub struct Located {
    /// largest share first; none where nothing is missing
    pub axes: Vec<AxisShare>,
    /// s, spans in which it is above noise
    pub time_s: Vec<[f64; 2]>,
    /// what it follows most first
    pub state: Vec<StateShare>,
    /// Hz, from and to, of the axis with the largest share
    pub band_hz: Option<[f64; 2]>,
    /// a force of the room, where one is certain
    pub field: Option<Field>,
}

/// Axes and states below this share are not listed, percent. Only the length of a table depends on it.
const LEAST_SHARE_PERCENT: f64 = 1.0;
/// A state that explains less of the misfit leads nowhere, percent: nine tenths of it would be elsewhere. The tables list it all the
/// same.
const LEADING_PERCENT: f64 = 10.0;

impl Located {
    /// The rigid body's misfit; nothing where nothing is missing.
    #[must_use]
    pub fn of(explanation: &Explanation) -> Self {
        match (explanation.verdict, &explanation.located_before) {
            (Verdict::NothingMissing, _) | (_, None) => Self::default(),
            (_, Some(found)) => Self { field: field(explanation), ..Self::new(found, explanation) },
        }
    }

    /// What the found effects leave.
    #[must_use]
    pub fn left(explanation: &Explanation) -> Self {
        let found = explanation.located_after.as_ref();
        found.map_or_else(Self::default, |found| Self {
            field: field(explanation),
            ..Self::new(found, explanation)
        })
    }

    fn new(found: &Localisation, explanation: &Explanation) -> Self {
        // torques whose commands are too far apart tell averages alone
        let compares =
            |axis: &str| explanation.search.after.rows.compares_torques || !axis.starts_with("torque");
        let axes = axis_shares(found, compares);
        let worst = axes.first().and_then(|first| channel_of(first.axis));
        let mut time_s: Vec<[f64; 2]> = found
            .spans
            .iter()
            .filter(|span| Some(span.channel) == worst)
            .map(|span| [span.from_s, span.to_s])
            .collect();
        time_s.sort_by(|a, b| a[0].total_cmp(&b[0]));
        Self {
            band_hz: worst.and_then(|worst| found.bands[worst]).map(|band| [band.low_hz, band.high_hz]),
            axes,
            time_s,
            state: found
                .follows
                .iter()
                .filter(|follow| follow.entered.is_some() && compares(CHANNEL_NAMES[follow.channel]))
                .map(state)
                .collect(),
            field: None,
        }
    }

    /// The state that the misfit follows most, if it leads anywhere.
    #[must_use]
    pub fn leading_state(&self) -> Option<&StateShare> {
        self.state.first().filter(|state| state.share_percent > LEADING_PERCENT)
    }

    /// The channel of the axis with the largest share.
    #[must_use]
    pub fn worst_axis(&self) -> Option<usize> {
        self.axes.first().and_then(|first| channel_of(first.axis))
    }
}

fn channel_of(axis: &str) -> Option<usize> {
    CHANNEL_NAMES.iter().position(|name| *name == axis)
}

/// Shares of the misfit of the axes that are compared. Both readings of a force are one axis.
fn axis_shares(found: &Localisation, compares: impl Fn(&str) -> bool) -> Vec<AxisShare> {
    let share = |axis: usize| {
        let second = found.axes.get(SECOND + axis).map_or(0.0, |second| second.share);
        found.axes[axis].share + second
    };
    let compared = || (0..AXES).filter(|axis| compares(CHANNEL_NAMES[*axis]));
    let all = compared().map(share).sum::<f64>().max(f64::MIN_POSITIVE);
    let mut axes: Vec<AxisShare> = compared()
        .map(|axis| AxisShare { axis: CHANNEL_NAMES[axis], share_percent: 100.0 * share(axis) / all })
        .filter(|axis| axis.share_percent > LEAST_SHARE_PERCENT)
        .collect();
    axes.sort_by(|a, b| b.share_percent.total_cmp(&a.share_percent));
    axes
}

fn state(follow: &Follow) -> StateShare {
    StateShare {
        variable: follow.state.name(),
        axis: CHANNEL_NAMES[follow.channel],
        share_percent: 100.0 * follow.share,
        peak_at: follow.peak_at,
    }
}

fn field(explanation: &Explanation) -> Option<Field> {
    let found = explanation.field.as_ref().filter(|field| field.certain)?;
    Some(Field {
        force_along: AXIS_NAMES[found.component.min(2)],
        force_n: found.force_n,
        changes_along: AXIS_NAMES[found.along.min(2)],
        at_m: found.where_m,
        extent_m: found.extent_m,
    })
}
