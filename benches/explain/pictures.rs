//! The residual of one flight with an effect, before it was found and after.

use super::flights::{Conditions, fly};
use super::measured::{Chart, Picture};
use super::ordinary::Ordinary;
use super::support::digits::to_digits;
use mavid::diagnose::locate::Follow;
use mavid::diagnose::{AXES, CHANNEL_NAMES, Explanation};

/// Points of a line along time.
const POINTS: usize = 120;

/// The flight of a seed at usual rates and noise.
pub fn picture(entry: &'static Ordinary, seed: u64) -> Option<Picture> {
    let with = Conditions { usual: true, ..Conditions::default() };
    let explanation = fly(seed, &[entry], with)?;
    let panels = [Some(along_time(&explanation)), followed(&explanation)];
    Some(Picture { id: entry.id.to_owned(), panels: panels.into_iter().flatten().collect() })
}

/// A number as finely as a picture shows it.
fn drawn(value: f64) -> f64 {
    to_digits(value, 3)
}

/// The channel with the largest share of the misfit.
fn worst(explanation: &Explanation) -> usize {
    let Some(located) = &explanation.located_before else { return 0 };
    let most = located.axes.iter().enumerate().max_by(|a, b| a.1.share.total_cmp(&b.1.share));
    most.map_or(0, |(axis, _)| axis)
}

fn name(channel: usize) -> String {
    CHANNEL_NAMES[channel].replace('_', " ")
}

fn unit(channel: usize) -> String {
    if channel < AXES / 2 { "N" } else { "N m" }.to_owned()
}

fn along_time(explanation: &Explanation) -> Chart {
    let axis = worst(explanation);
    let (before, after) = (&explanation.search.before.rows, &explanation.search.after.rows);
    let every = before.time_s.len().div_ceil(POINTS).max(1);
    let thin = |values: &[f64]| values.iter().step_by(every).copied().map(drawn).collect();
    Chart {
        title: format!("residual of the {}", name(axis)),
        x_label: "time (s)".to_owned(),
        y_label: unit(axis),
        x: thin(&before.time_s),
        before: thin(&before.residual[axis]),
        after: thin(&after.residual[axis]),
        low: Vec::new(),
        high: Vec::new(),
    }
}

/// The residual against the state that it follows most.
fn followed(explanation: &Explanation) -> Option<Chart> {
    let most = explanation.located_before.as_ref()?.lives_on()?;
    let same = |follow: &&Follow| follow.channel == most.channel && follow.state == most.state;
    let after = explanation.located_after.as_ref()?.follows.iter().find(same);
    let of = |follow: &Follow, what: fn(&mavid::diagnose::locate::Bin) -> f64| -> Vec<f64> {
        follow.bins.iter().map(|bin| drawn(what(bin))).collect()
    };
    let state = most.state.name().replace('_', " ");
    Some(Chart {
        title: format!("residual of the {} against {state}", name(most.channel)),
        x_label: format!("{state} ({})", most.state.unit()),
        y_label: unit(most.channel),
        x: of(most, |bin| bin.center),
        before: of(most, |bin| bin.mean),
        after: after.map_or_else(Vec::new, |after| of(after, |bin| bin.mean)),
        low: of(most, |bin| bin.low),
        high: of(most, |bin| bin.high),
    })
}
