//! Whether a log can be that of a vehicle with this number of rotors.

use super::SignalsError;
use super::reported_state::ReportedState;
use super::stated_rotors::{Differing, rotor_difference};
use crate::recording::{Recording, Stream};
use crate::vehicle::Vehicle;

/// Refuses a log whose autopilot states another number of rotors than the vehicle has: its outputs would be read as those of motors that
/// they do not drive.
pub(super) fn refuse_stated_count(recording: &Recording, vehicle: &Vehicle) -> Result<(), SignalsError> {
    let difference = rotor_difference(recording.autopilot, &recording.parameters, vehicle);
    match difference.filter(|difference| difference.of == Differing::Count) {
        Some(difference) => Err(SignalsError::OtherRotors {
            rotors: vehicle.rotors.len(),
            came: format!("one whose parameters state {}", difference.stated),
        }),
        None => Ok(()),
    }
}

/// Samples of an output that must move for it to be a motor's, of ten. A servo or an unused output moves less often.
const MOVES_OF_TEN: usize = 3;
/// Fewer channels that move as motors do are no vehicle in the air, and say nothing of how many rotors it has.
const LEAST_MOTORS: usize = 3;

/// Refuses commands or speeds of which those of a rotor never move while others move as motors in the air do: no autopilot leaves a
/// motor where it is for a whole flight. A row of outputs has more channels than a vehicle has motors. `channels` are those of the
/// rotors, in their order.
pub(super) fn refuse_still_rotors(
    recording: &Recording,
    (message, stream): (&str, &Stream),
    channels: &[usize],
) -> Result<(), SignalsError> {
    let still: Vec<usize> = (0..channels.len()).filter(|rotor| !moves(stream, channels[*rotor])).collect();
    if still.is_empty() || motors(stream, &ReportedState::of(recording)).len() < LEAST_MOTORS {
        return Ok(());
    }
    let names: Vec<String> = still.iter().map(|rotor| (rotor + 1).to_string()).collect();
    let (those, outputs) = match names.as_slice() {
        [one] => (format!("motor {one}"), "an output that never moves"),
        [all @ .., last] => (format!("motors {} and {last}", all.join(", ")), "outputs that never move"),
        [] => return Ok(()),
    };
    Err(SignalsError::OtherRotors {
        rotors: channels.len(),
        came: format!("one in which {message} has {outputs} for {those}"),
    })
}

/// Channels that move in the air as motors do.
pub(super) fn motors(stream: &Stream, said: &ReportedState) -> Vec<usize> {
    let in_air: Vec<usize> = (1..stream.len()).filter(|&index| said.may_fly(stream.time_s[index])).collect();
    let moves = |channel: &usize| {
        let moved = |index: &&usize| stream.sample(**index)[*channel] != stream.sample(**index - 1)[*channel];
        let count = in_air.iter().filter(moved).count();
        in_air.len() > 20 && 10 * count >= MOVES_OF_TEN * in_air.len()
    };
    (0..stream.width).filter(moves).collect()
}

/// A channel has two values.
fn moves(stream: &Stream, channel: usize) -> bool {
    let mut values =
        (0..stream.len()).map(|index| stream.sample(index)[channel]).filter(|value| value.is_finite());
    values.next().is_some_and(|first| values.any(|value| value.to_bits() != first.to_bits()))
}

/// Number of channels that move. PX4 reports its whole row of outputs; those without a motor stay at the value of a disarmed one.
pub(super) fn channels_that_move(stream: &Stream) -> usize {
    (0..stream.width).filter(|channel| moves(stream, *channel)).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_output_that_stays_where_it_is_drives_nothing() {
        let rows =
            [[f64::NAN, 1500.0, 900.0, 0.0], [1400.0, 1510.0, 900.0, 0.0], [1420.0, 1490.0, 900.0, 0.0]];
        let commands = Stream { time_s: vec![0.0, 0.1, 0.2], width: 4, values: rows.concat() };
        assert_eq!(channels_that_move(&commands), 2);
        assert_eq!(channels_that_move(&Stream::default()), 0);
    }

    #[test]
    fn a_rotor_whose_output_never_moves_in_a_flight_is_none() {
        let time_s: Vec<f64> = (0..100).map(|index| 0.1 * f64::from(index)).collect();
        let row = |t: &f64| [1500.0 + t, 1500.0 - t, 1400.0 + 2.0 * t, 900.0, 900.0];
        let commands = Stream { width: 5, values: time_s.iter().flat_map(row).collect(), time_s };
        let of = |channels: &[usize]| {
            refuse_still_rotors(&Recording::default(), ("SERVO_OUTPUT_RAW", &commands), channels)
        };
        assert!(of(&[0, 1, 2]).is_ok());
        let said = of(&[0, 1, 2, 3, 4]).unwrap_err().to_string();
        assert!(said.contains("5 rotors") && said.contains("for motors 4 and 5"), "{said}");
        // at rest two outputs that drift are no flight
        let rest = Stream {
            width: 3,
            values: commands.values.chunks(5).flat_map(|row| [row[0], row[1], row[3]]).collect(),
            time_s: commands.time_s.clone(),
        };
        assert!(refuse_still_rotors(&Recording::default(), ("RCOU", &rest), &[0, 1, 2]).is_ok());
    }
}
