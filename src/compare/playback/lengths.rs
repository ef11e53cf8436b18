//! Playback over windows of several lengths: the longest one begins as the others do, and is simulated once.

use super::floor::{Floor, FloorNoise};
use super::settings::PlaybackSettings;
use super::windows::{Played, WindowErrors, Windows, played};
use crate::compare::CompareError;
use crate::physics::Model;
use crate::signals::Signals;
use crate::simulate::Push;
use crate::vehicle::Vehicle;

/// Errors over windows of one length.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct LengthErrors {
    /// of the model
    pub windows: Vec<WindowErrors>,
    /// what a model that is right would leave, where it was asked for
    pub floor: Vec<WindowErrors>,
}

/// [`playback`](super::playback) window by window, for whoever needs to know how the error is spread. `push` acts beside
/// the model.
///
/// # Errors
/// As [`playback`](super::playback).
pub fn playback_windows(
    (model, vehicle): (&Model, &Vehicle),
    push: Option<Push>,
    signals: &Signals,
    settings: &PlaybackSettings,
) -> Result<Vec<WindowErrors>, CompareError> {
    let each = playback_lengths((model, vehicle), push, signals, (settings, &[settings.window_s]), None)?;
    Ok(each.into_iter().flat_map(|length| length.windows).collect())
}

/// [`playback_windows`](super::playback_windows) over windows of each of these lengths (s), in place of that of the settings;
/// with the floor that noise makes, of the model without `push`.
///
/// # Errors
/// As [`playback`](super::playback).
pub fn playback_lengths(
    (model, vehicle): (&Model, &Vehicle),
    push: Option<Push>,
    signals: &Signals,
    (settings, windows_s): (&PlaybackSettings, &[f64]),
    floor: Option<FloorNoise>,
) -> Result<Vec<LengthErrors>, CompareError> {
    let of_length = |&window_s: &f64| Windows::of(signals, &PlaybackSettings { window_s, ..*settings });
    let lengths: Vec<Windows> = windows_s.iter().map(of_length).collect::<Result<_, _>>()?;
    let model = played(model, signals);
    let of = |push| Played::of((&model, vehicle), push, signals, settings);
    let (pushed, exact) = (of(push)?, of(None)?);
    let mut floor = match floor {
        Some(noise) => Some(Floor::of(of(None)?, noise)),
        None => None,
    };
    let mut out = vec![LengthErrors::default(); lengths.len()];
    for start in starts(&lengths) {
        let has = |of: &&Windows| of.starts.binary_search(&start).is_ok();
        let longest = lengths.iter().filter(has).map(|of| of.window).max().unwrap_or_default();
        let simulated = pushed.window(pushed.warm(start)?, (start, longest));
        for (of, out) in lengths.iter().zip(&mut out).filter(|(of, _)| has(of)) {
            out.windows.push(of.errors(start, &simulated[..of.window]));
        }
        let Some(floor) = &mut floor else { continue };
        let truth = match push {
            Some(_) => exact.window(exact.warm(start)?, (start, longest)),
            None => simulated,
        };
        let noisy = floor.predicted(start, &truth)?;
        for (of, out) in lengths.iter().zip(&mut out).filter(|(of, _)| has(of)) {
            out.floor.push(of.errors_against(start, noisy[..of.window].iter().copied()));
        }
    }
    Ok(out)
}

/// Where any of the windows begins.
fn starts(lengths: &[Windows]) -> Vec<usize> {
    let mut all: Vec<usize> = lengths.iter().flat_map(|of| of.starts.iter().copied()).collect();
    all.sort_unstable();
    all.dedup();
    all
}
