//! Tables of samples.

use mavid::log::csv::{CsvError, CsvMapping, CsvReport, read_table};
use mavid::recording::{Quantity, Recording, RecordingBuilder};

use super::bytes::Bytes;
use super::tlog::is_sound;

/// Headers that the built-in mapping takes; the last byte of the first line is the input's.
const HEADERS: [&str; 4] = [
    "",
    "time_s,rate_x_rad_s,rate_y_rad_s,rate_z_rad_s,motor_1_command,motor_2_command\n",
    "time_s;attitude_w;attitude_x;attitude_y;attitude_z;position_x_m;position_y_m;position_z_m\n",
    "time_s\troll_rad\tyaw_rad\tbattery_v\tarmed\tother\n",
];
/// Any table, its header perhaps given, its times perhaps in another unit.
pub fn run(data: &[u8], seeded: bool) {
    let mut script = Bytes::new(data);
    let header = script.one_of(&HEADERS);
    let scaled = script.u8();
    let mut mapping = CsvMapping::default();
    if scaled & 1 == 1 {
        mapping.time.scale = 1e-3;
    }
    if scaled & 2 == 2 {
        mapping.delimiter = Some(b';');
    }
    let text = [header.as_bytes(), script.rest()].concat();
    check(&text, &mapping, seeded);
}

/// As a recording.
pub fn read(text: &[u8], mapping: &CsvMapping) -> Result<(Recording, CsvReport), CsvError> {
    let mut builder = RecordingBuilder::new();
    let report = read_table(text, "table", mapping, &mut |_, event| builder.add(event))?;
    Ok((builder.finish().0, report))
}

fn check(text: &[u8], mapping: &CsvMapping, seeded: bool) {
    let (recording, report) = match read(text, mapping) {
        Ok(read) => read,
        Err(error) => {
            assert!(!error.to_string().is_empty());
            return;
        }
    };
    is_sound(&recording);
    assert!(report.rows_rejected < report.rows, "{report:?}");
    assert!(report.rejections.len() <= report.rows_rejected);
    assert!(report.start_time_s.is_finite(), "{report:?}");
    let most = report.rows - report.rows_rejected;
    for (key, stream) in &recording.streams {
        assert!(stream.len() <= most, "{key:?}: {} samples of {most} rows", stream.len());
        let numbers = stream.values.iter().all(|value| !value.is_infinite());
        assert!(numbers, "{key:?}: an infinite number");
        if matches!(key.quantity, Quantity::Attitude | Quantity::AttitudeSetpoint) {
            let unit = |q: &[f64]| (q.iter().map(|value| value * value).sum::<f64>() - 1.0).abs() < 1e-6;
            assert!(stream.values.chunks(4).all(unit), "{key:?}: no rotation");
        }
        let overlooked = key.quantity == Quantity::Attitude && report.clock_resets > 0;
        assert!(!(seeded && overlooked), "the seeded bug: a clock that starts anew in a table of attitudes");
    }
    // what was read once is read the same again
    let again = read(text, mapping).expect("read before");
    assert_eq!(again.1, report);
}
