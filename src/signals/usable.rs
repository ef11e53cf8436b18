//! The instants of a flight that identification may use.

use super::actuation::Actuation;
use super::off_ground::{SHORTEST_FLIGHT_S, off_ground, within};
use super::reported_state::{LEAST_FREE_S, ReportedState};
use super::select::median_period_s;
use super::{Grid, SignalsError, hold_onto};
use crate::recording::{Recording, Stream};
use crate::vehicle::Vehicle;
use nalgebra::Vector3;

/// Thrust below which a vehicle does not fly, as a share of the nominal weight. Between idling and a fast descent; a
/// smaller one takes motors that spin up for flight.
pub const FLYING_SHARE: f64 = 0.4;
/// Time left out at both ends of an airborne span for lift-off and touch-down, s. With less the jerk of lift-off
/// would be a force; with more short hops are lost.
const GROUND_MARGIN_S: f64 = 0.5;
/// A pause is a gap if it is longer than this many periods and than [`LEAST_GAP_S`]. A few lost frames can be
/// interpolated; longer ones hold motion that nobody saw.
const GAP_PERIODS: f64 = 5.0;
/// Shortest gap, s. Three samples at 50 Hz: a shorter pause is interpolated well within the kernel of 0.4 s.
const LEAST_GAP_S: f64 = 0.06;
/// An actuator that is longer at its bound is saturated; a shorter contact is a known command, s. A rotor follows a
/// short command; only one that stays at a bound hides what the controller wanted.
const SATURATION_S: f64 = 0.1;
/// Saturated stretches are kept if less than this time would be left without them, s. With less there is no
/// identification at all.
const LEAST_UNSATURATED_S: f64 = 8.0;
/// Windows over which excitation is assessed, s, relative to the livelier half of the flight, so that a bump at
/// landing has no influence. Shorter windows leave holes in slow trajectories, longer ones keep hovers.
const EXCITATION_WINDOW_S: f64 = 4.0;
/// Least excitation of a window relative to that half. With more calm parts of a trajectory would be lost, with less
/// a hover before it would dilute the flight.
const EXCITATION_SHARE: f64 = 0.3;

/// Seconds of flight that each rule left out (an instant may fall under several).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Usable {
    /// s on the common grid
    pub total_s: f64,
    /// s not airborne
    pub grounded_s: f64,
    /// s of the transient at the beginning
    pub transient_s: f64,
    /// s before the first and after the last excitation
    pub idle_s: f64,
    /// s with an actuator at its end stop
    pub saturated_s: f64,
    /// s inside gaps of a stream
    pub gap_s: f64,
    /// s left
    pub usable_s: f64,
    /// whether saturated stretches were kept because little else was left
    pub saturation_kept: bool,
}

impl Usable {
    /// One line with the time that each rule left out.
    #[must_use]
    pub fn summary(&self) -> String {
        format!(
            "of {:.1} s: {:.1} s not airborne, {:.1} s transient, {:.1} s without excitation, {:.1} s saturated{}, {:.1} s in gaps",
            self.total_s,
            self.grounded_s,
            self.transient_s,
            self.idle_s,
            self.saturated_s,
            if self.saturation_kept { " (kept: little else is left)" } else { "" },
            self.gap_s
        )
    }

    /// Why too little is left: less than `needed_s`, with `transient_s` to be left out at the beginning, both s.
    pub(super) fn refusal(&self, needed_s: f64, transient_s: Option<f64>) -> SignalsError {
        let (flown_s, reason) = (self.total_s - self.grounded_s, self.summary());
        let most_s = flown_s - needed_s;
        match transient_s {
            Some(asked_s) if asked_s > most_s && most_s > 0.0 && 2.0 * self.transient_s > flown_s => {
                SignalsError::LeftOutTooLong { most_s, asked_s, reason }
            }
            _ => SignalsError::NothingUsable { usable_s: self.usable_s, needed_s, reason },
        }
    }
}

/// The data from which the mask is computed.
#[derive(Debug, Clone, Copy)]
pub struct Evidence<'a> {
    /// streams whose gaps count
    pub streams: &'a [&'a Stream],
    /// spans in the air, s
    pub airborne_s: &'a [(f64, f64)],
    /// restarts of the vehicle's clock, s
    pub resets_s: &'a [f64],
    /// normalised commands, where they are the source of thrust
    pub command: Option<&'a Stream>,
    /// rad/s, body, on the grid
    pub rate: Option<&'a [Vector3<f64>]>,
    /// the log is damaged: rates that are wrong excite nothing
    pub is_damaged: bool,
}

/// Spans in the air, s: the rotors carry the vehicle, and the autopilot says neither that it is disarmed nor that it has landed.
/// Where little is left without taking off and landing, these count too.
pub(super) fn airborne_spans(
    recording: &Recording,
    actuation: &Actuation,
    vehicle: &Vehicle,
) -> Vec<(f64, f64)> {
    let needed = FLYING_SHARE * vehicle.body.mass_kg * vehicle.gravity_m_s2;
    let words = ReportedState::of(recording);
    let told = carried_spans(actuation, needed, |t_s| words.may_be_off_ground(t_s));
    // a height off the ground is clear of it: the margin at both ends is for words
    let clear = off_ground(recording, told.clone()).into_iter();
    let clear: Vec<(f64, f64)> =
        clear.map(|(from_s, to_s)| (from_s - GROUND_MARGIN_S, to_s + GROUND_MARGIN_S)).collect();
    let flown = within(&told, &clear);
    let mut free = within(&carried_spans(actuation, needed, |t_s| words.may_fly(t_s)), &clear);
    free.retain(|(start, end)| end - start > SHORTEST_FLIGHT_S);
    let seconds = |spans: &[(f64, f64)]| spans.iter().map(|(start, end)| end - start).sum::<f64>();
    if seconds(&free) >= LEAST_FREE_S {
        return free;
    }
    flown
}

/// Spans in which the rotors give more than `needed` (N) and the autopilot's words allow flight, s.
fn carried_spans(actuation: &Actuation, needed: f64, may_fly: impl Fn(f64) -> bool) -> Vec<(f64, f64)> {
    let stream = actuation.stream();
    // thrust smoothed over half a second: a single sample at the end stop is not a landing
    let mut smooth = 0.0;
    let mut spans: Vec<(f64, f64)> = Vec::new();
    let mut open: Option<f64> = None;
    for index in 0..stream.len() {
        let t = stream.time_s[index];
        let step = if index > 0 { t - stream.time_s[index - 1] } else { 0.0 };
        let collective = actuation.collective_n(index);
        let share = (step / 0.3).clamp(0.0, 1.0);
        smooth = if index == 0 { collective } else { smooth + share * (collective - smooth) };
        match (may_fly(t) && smooth > needed, open) {
            (true, None) => open = Some(t),
            (false, Some(start)) => {
                spans.push((start, t));
                open = None;
            }
            _ => {}
        }
    }
    if let (Some(start), Some(&end)) = (open, stream.time_s.last()) {
        spans.push((start, end));
    }
    spans.retain(|(start, end)| end - start > SHORTEST_FLIGHT_S);
    spans
}

/// The mask, and the time that each rule left out; `transient_s` is left out at the beginning of the first airborne
/// span.
#[must_use]
pub fn usable(grid: &Grid, evidence: &Evidence<'_>, transient_s: Option<f64>) -> (Vec<bool>, Usable) {
    let grounded = grounded(grid, evidence);
    let transient = transient(grid, evidence, transient_s);
    let saturated = evidence.command.map_or_else(|| vec![false; grid.count], |c| saturated(grid, c));
    let gap = gaps(grid, evidence);
    let masked = |heed_saturation: bool| {
        let candidates: Vec<bool> = (0..grid.count)
            .map(|i| !(grounded[i] || transient[i] || gap[i] || heed_saturation && saturated[i]))
            .collect();
        let idle = evidence.rate.map_or_else(
            || vec![false; grid.count],
            |rate| idle(grid, (rate, evidence.is_damaged), &candidates),
        );
        let mask: Vec<bool> = candidates.iter().zip(&idle).map(|(c, idle)| *c && !idle).collect();
        (candidates, idle, mask)
    };
    let seconds = |mask: &[bool]| mask.iter().filter(|m| **m).count() as f64 * grid.step_s;
    let (mut candidates, mut idle, mut mask) = masked(true);
    let mut saturation_kept = false;
    if seconds(&mask) < LEAST_UNSATURATED_S {
        // a command at its end stop is still a known command: better than no flight at all
        let kept = masked(false);
        saturation_kept = seconds(&kept.2) > seconds(&mask);
        if saturation_kept {
            (candidates, idle, mask) = kept;
        }
    }
    let flown =
        |rule: &[bool]| seconds(&rule.iter().zip(&grounded).map(|(r, g)| *r && !*g).collect::<Vec<_>>());
    let report = Usable {
        total_s: grid.count as f64 * grid.step_s,
        grounded_s: seconds(&grounded),
        transient_s: flown(&transient),
        idle_s: seconds(&idle.iter().zip(&candidates).map(|(idle, c)| *idle && *c).collect::<Vec<bool>>()),
        saturated_s: flown(&saturated),
        gap_s: flown(&gap),
        usable_s: seconds(&mask),
        saturation_kept,
    };
    (mask, report)
}

fn grounded(grid: &Grid, evidence: &Evidence<'_>) -> Vec<bool> {
    let recording_start = grid.start_s;
    let recording_end = grid.time_s(grid.count.saturating_sub(1));
    (0..grid.count)
        .map(|i| {
            let t = grid.time_s(i);
            !evidence.airborne_s.iter().any(|&(start, end)| {
                // a log that begins or ends in the air has no ground there to keep away from
                let start = if start <= recording_start + 0.1 { start } else { start + GROUND_MARGIN_S };
                let end = if end >= recording_end - 0.1 { end } else { end - GROUND_MARGIN_S };
                (start..=end).contains(&t)
            })
        })
        .collect()
}

/// The paper's transient, s.
const TRANSIENT_S: f64 = 10.0;

/// The beginning of the first airborne span.
fn transient(grid: &Grid, evidence: &Evidence<'_>, transient_s: Option<f64>) -> Vec<bool> {
    let flown: f64 = evidence.airborne_s.iter().map(|(start, end)| end - start).sum();
    let until = evidence.airborne_s.first().map_or(f64::NEG_INFINITY, |(start, _)| {
        start.max(grid.start_s) + transient_s.unwrap_or_else(|| TRANSIENT_S.min(0.2 * flown))
    });
    (0..grid.count).map(|i| grid.time_s(i) < until).collect()
}

/// Instants with a command at or beyond its range, or at its largest or smallest recorded value for long.
fn saturated(grid: &Grid, command: &Stream) -> Vec<bool> {
    let (low, high) = end_stops(command);
    let stuck: Vec<f64> = (0..command.len())
        .map(|i| f64::from(u8::from(command.sample(i).iter().any(|&u| u <= low || u >= high))))
        .collect();
    let flags = Stream { time_s: command.time_s.clone(), width: 1, values: stuck };
    let touching: Vec<bool> = hold_onto(&flags, grid).unwrap_or_default().iter().map(|f| *f > 0.5).collect();
    let mut mask = vec![false; grid.count];
    for run in Grid::runs(&touching, 1) {
        if run.len() as f64 * grid.step_s > SATURATION_S {
            mask[run].fill(true);
        }
    }
    mask
}

/// The range of u, narrowed if many samples have exactly the same extreme value (a flat top).
fn end_stops(command: &Stream) -> (f64, f64) {
    let finite = || command.values.iter().copied().filter(|v| v.is_finite());
    let (smallest, largest) = (finite().fold(1.0, f64::min), finite().fold(0.0, f64::max));
    let repeated = |extreme: f64| finite().filter(|v| v.to_bits() == extreme.to_bits()).count() >= 5;
    let low = if repeated(smallest) { smallest } else { 0.0 };
    let high = if repeated(largest) { largest } else { 1.0 };
    (low.max(0.0), high.min(1.0))
}

/// Instants inside a gap of any stream, or at a restart of the vehicle's clock.
fn gaps(grid: &Grid, evidence: &Evidence<'_>) -> Vec<bool> {
    let mut mask = vec![false; grid.count];
    let mut mark = |from: f64, to: f64| {
        let first = ((from - grid.start_s) / grid.step_s).floor().max(0.0);
        let mut index = 0;
        // first is a small non-negative whole number; found by bisection to stay clear of casts
        let mut high = grid.count;
        while index < high {
            let middle = usize::midpoint(index, high);
            if (middle as f64) < first { index = middle + 1 } else { high = middle }
        }
        while index < grid.count && grid.time_s(index) <= to {
            mask[index] = true;
            index += 1;
        }
    };
    for stream in evidence.streams {
        let period = median_period_s(stream);
        for pair in stream.time_s.windows(2) {
            if pair[1] - pair[0] > (GAP_PERIODS * period).max(LEAST_GAP_S) {
                mark(pair[0], pair[1]);
            }
        }
    }
    for &reset in evidence.resets_s {
        mark(reset - 0.5, reset + 0.5);
    }
    mask
}

/// Instants before the first and after the last excited window: hover gives no information about inertia.
/// Of a damaged log, the outermost windows count as idle too: what is left of the damage may have made them lively.
fn idle(grid: &Grid, (rate, is_damaged): (&[Vector3<f64>], bool), candidates: &[bool]) -> Vec<bool> {
    let mut window = 1;
    while (window as f64) * grid.step_s < EXCITATION_WINDOW_S {
        window += 1;
    }
    let power: Vec<(usize, f64)> = (0..grid.count)
        .step_by(window)
        .filter_map(|start| {
            let inside: Vec<usize> =
                (start..(start + window).min(grid.count)).filter(|&i| candidates[i]).collect();
            let sum: f64 = inside.iter().map(|&i| rate[i].norm_squared()).sum();
            (!inside.is_empty()).then(|| (start, (sum / inside.len() as f64).sqrt()))
        })
        .collect();
    let mut ordered: Vec<f64> = power.iter().map(|(_, p)| *p).collect();
    ordered.sort_by(f64::total_cmp);
    let lively = ordered.get(ordered.len() * 6 / 10).copied().unwrap_or(0.0);
    let exciting = |&&(_, p): &&(usize, f64)| p >= EXCITATION_SHARE * lively;
    let first = power.iter().find(exciting).map_or(0, |(start, _)| *start);
    let last = power.iter().rev().find(exciting).map_or(grid.count, |(start, _)| start + window);
    let (first, last) =
        if is_damaged { (first + window, last.saturating_sub(window)) } else { (first, last) };
    (0..grid.count).map(|i| i < first || i >= last).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flight_of_which_the_beginning_takes_most_says_how_much_may_be_left_out() {
        let of = |transient_s: f64| Usable {
            total_s: 48.0,
            grounded_s: 8.0,
            transient_s,
            usable_s: 40.0 - transient_s,
            ..Usable::default()
        };
        let said = |used: Usable, asked_s| used.refusal(2.4, asked_s).to_string();
        let told = said(of(40.0), Some(1e9));
        assert!(
            told.contains("(--transient)") && told.contains("expected at most 37.6 s, got 1000000000 s"),
            "{told}"
        );
        // not asked for, or not what leaves too little
        assert!(said(of(40.0), None).starts_with("nothing to identify from: 0.0 s usable"));
        assert!(said(Usable { usable_s: 0.0, ..of(1.0) }, Some(1.0)).starts_with("nothing to identify from"));
    }
}
