//! Whether a log can be that of a vehicle with this number of rotors.

use super::SignalsError;
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

/// Refuses commands or speeds of which those of a rotor never move while others do: no autopilot leaves a motor where it is for a
/// whole flight. A row of outputs has more channels than a vehicle has motors. `channels` are those of the rotors, in their order.
pub(super) fn refuse_still_rotors(
    message: &str,
    stream: &Stream,
    channels: &[usize],
) -> Result<(), SignalsError> {
    let still: Vec<usize> = (0..channels.len()).filter(|rotor| !moves(stream, channels[*rotor])).collect();
    if still.is_empty() || still.len() == channels.len() {
        return Ok(());
    }
    let names: Vec<String> = still.iter().map(|rotor| (rotor + 1).to_string()).collect();
    let (those, outputs) = match names.as_slice() {
        [one] => (format!("rotor {one}"), "an output that never moves"),
        [all @ .., last] => (format!("rotors {} and {last}", all.join(", ")), "outputs that never move"),
        [] => return Ok(()),
    };
    Err(SignalsError::OtherRotors {
        rotors: channels.len(),
        came: format!("one in which {message} has {outputs} for {those}"),
    })
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
        assert!(refuse_still_rotors("SERVO_OUTPUT_RAW", &commands, &[1, 0]).is_ok());
        // nothing moves: that is no matter of how many rotors there are
        assert!(refuse_still_rotors("SERVO_OUTPUT_RAW", &commands, &[2, 3]).is_ok());
        let refused = refuse_still_rotors("SERVO_OUTPUT_RAW", &commands, &[0, 1, 2, 3]).unwrap_err();
        let said = refused.to_string();
        assert!(said.contains("4 rotors") && said.contains("for rotors 3 and 4"), "{said}");
    }
}
