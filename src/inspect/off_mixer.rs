//! Outputs that left the mixer, from window to window: what follows in the same flight cannot be used.

use super::airborne::Airborne;
use crate::log::SILENCE_S;
use crate::recording::{Quantity, Recording};
use crate::signals::{OffMixer, best, outputs_off_mixer, until_down, within};

/// What the windows so far have shown of outputs that left the mixer.
#[derive(Debug, Default)]
pub(super) struct OffMixerTally {
    /// each output once
    found: Vec<OffMixer>,
    /// one has left it in this flight
    is_off: bool,
    /// and the vehicle fell to the ground since
    is_down: bool,
    /// last command of the windows so far, s
    commanded_s: Option<f64>,
}

impl OffMixerTally {
    /// Takes a window. From when on nothing of it can be identified, s: an output left the mixer then, or in a window before, where this is
    /// that flight still. As for identification, a silence or a restart of the vehicle's clock ends a flight. `None`: all outputs follow.
    pub(super) fn add(&mut self, recording: &Recording) -> Option<f64> {
        let commands = best(recording, Quantity::ActuatorCommand, |stream| !stream.is_empty());
        let times_s = commands.map(|(_, stream)| stream.time_s.as_slice()).unwrap_or_default();
        let silent_s =
            times_s.first().zip(self.commanded_s).map_or(0.0, |(first_s, last_s)| first_s - last_s);
        if silent_s > SILENCE_S || !recording.clock_resets_s.is_empty() {
            self.is_off = false;
            self.is_down = false;
        }
        self.commanded_s = times_s.last().copied().or(self.commanded_s);
        let outputs = outputs_off_mixer(recording);
        let left_s = outputs.first().map(|first| first.left_s);
        for off in outputs {
            if self.found.iter().all(|known| known.output != off.output) {
                self.found.push(off);
            }
        }
        if self.is_off {
            return Some(f64::NEG_INFINITY);
        }
        self.is_off = left_s.is_some();
        left_s
    }

    /// What of the time in the air of a window is flight, where an output left the mixer at `left_s` (s) as [`Self::add`] gave it: nothing after the
    /// vehicle fell to the ground.
    pub(super) fn flown(&mut self, recording: &Recording, airborne: &mut Airborne, left_s: f64) {
        let end_s = |spans_s: &[(f64, f64)]| spans_s.last().map(|(_, end_s)| *end_s);
        let until_s = end_s(&airborne.flown_s);
        let flown_s = std::mem::take(&mut airborne.flown_s);
        airborne.flown_s = if self.is_down { Vec::new() } else { until_down(recording, flown_s, left_s) };
        airborne.free_s = within(&airborne.free_s, &airborne.flown_s);
        self.is_down |= end_s(&airborne.flown_s) != until_s;
    }

    /// All outputs that left it, in the order in which they did.
    pub(super) fn found(self) -> Vec<OffMixer> {
        self.found
    }
}

#[cfg(test)]
mod tests {
    use super::super::assess::{Assessment, Assessor};
    use super::*;
    use crate::recording::{Stream, StreamKey};

    /// A flight of 30 s from `begins_s` on: four outputs at 10 Hz that move against each other, the third of them only until `left_s`, and
    /// body rates.
    fn flight(begins_s: f64, left_s: f64) -> Recording {
        let (mut outputs, mut rates) =
            (Stream { width: 4, ..Stream::default() }, Stream { width: 3, ..Stream::default() });
        for index in 0..300 {
            let time_s = begins_s + f64::from(index) * 0.1;
            let of = |motor: f64| 1550.0 + 40.0 * (1.7 * time_s + motor).sin();
            outputs.time_s.push(time_s);
            outputs.values.extend([
                of(0.0),
                of(1.0),
                if time_s < left_s { of(2.0) } else { 1540.0 },
                of(3.0),
            ]);
        }
        for index in 0..1500 {
            let time_s = begins_s + f64::from(index) * 0.02;
            rates.time_s.push(time_s);
            rates.values.extend([0.0, 1.0, 2.0].map(|axis| 0.5 * (3.0 * time_s + axis).sin()));
        }
        let key = |quantity, source| StreamKey { quantity, source, instance: 0 };
        let streams =
            [(key(Quantity::ActuatorCommand, "RCOU"), outputs), (key(Quantity::AngularRate, "IMU"), rates)];
        Recording { streams: streams.into(), ..Recording::default() }
    }

    fn assessed(windows: &[Recording]) -> Assessment {
        let mut assessor = Assessor::new(None);
        windows.iter().for_each(|window| assessor.window(window));
        assessor.finish()
    }

    #[test]
    fn time_from_when_on_an_output_stands_still_is_flight_and_cannot_be_used() {
        let [sound, stuck] = [60.0, 18.0].map(|left_s| assessed(&[flight(0.0, left_s)]));
        assert!(sound.off_mixer.is_empty() && sound.flight.off_mixer_s == 0.0, "{:?}", sound.flight);
        assert!(sound.flight.usable_s > 20.0, "{:?}", sound.flight);
        let [OffMixer { output: 3, left_s, .. }] = stuck.off_mixer[..] else { panic!("{stuck:?}") };
        assert!((left_s - 18.0).abs() < 0.11, "{left_s}");
        assert!((stuck.flight.airborne_s - sound.flight.airborne_s).abs() < 1e-9, "{:?}", stuck.flight);
        assert!((stuck.flight.off_mixer_s - 12.0).abs() < 0.3, "{:?}", stuck.flight);
        assert!(stuck.flight.usable_s < 18.0 && stuck.flight.usable_s > 10.0, "{:?}", stuck.flight);
        // the segment says the same, and the forecast sees no more
        assert!((stuck.flight.segments[0].usable_s - stuck.flight.usable_s).abs() < 1e-9);
        let (_, seen) = stuck.liveliest.unwrap();
        assert!(
            seen.streams.values().all(|stream| stream.time_s.last().is_some_and(|last_s| *last_s < left_s))
        );
    }

    #[test]
    fn the_rest_of_that_flight_cannot_be_used_either_and_the_next_flight_can() {
        let usable_s = |windows: &[Recording]| assessed(windows).flight.usable_s;
        let stuck = flight(0.0, 18.0);
        let first_s = usable_s(std::slice::from_ref(&stuck));
        assert!((usable_s(&[stuck.clone(), flight(30.0, 1e9)]) - first_s).abs() < 1e-9);
        // behind a silence, or after a restart of the clock
        assert!(usable_s(&[stuck.clone(), flight(30.0 + 2.0 * SILENCE_S, 1e9)]) > first_s + 20.0);
        let again = Recording { clock_resets_s: vec![30.0], ..flight(30.0, 1e9) };
        assert!(usable_s(&[stuck, again]) > first_s + 20.0);
    }
}
