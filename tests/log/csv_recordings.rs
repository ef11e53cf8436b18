//! CSV flights: tables with every kind of fault, and the real recordings beside the repository.

use crate::support;

use mavid::config::{load_csv_mapping, parse_csv_mapping};
use mavid::log::csv::{CsvError, CsvMapping, CsvReport, read_table};
use mavid::log::{self, OpenOptions};
use mavid::recording::{Quantity, Recording, RecordingBuilder, Stream};
use std::io::{BufRead, Read};
use std::path::Path;

fn read_from(
    from: impl BufRead,
    name: &str,
    mapping: &CsvMapping,
) -> Result<(Recording, CsvReport), CsvError> {
    let mut builder = RecordingBuilder::new();
    let report = read_table(from, name, mapping, &mut |_, event| builder.add(event))?;
    Ok((builder.finish().0, report))
}

fn read(text: &str) -> Result<(Recording, CsvReport), CsvError> {
    read_from(text.as_bytes(), "flight.csv", &CsvMapping::default())
}

fn read_as(mapping: &str, text: &str) -> (Recording, CsvReport) {
    let mapping = parse_csv_mapping(mapping, "mapping.toml").unwrap();
    read_from(text.as_bytes(), "flight.csv", &mapping).unwrap()
}

fn stream(recording: &Recording, quantity: Quantity) -> &Stream {
    let mut found = recording.streams.iter().filter(|(key, _)| key.quantity == quantity);
    let (_, stream) = found.next().unwrap();
    assert!(found.next().is_none());
    stream
}

#[test]
fn default_columns_with_gaps() {
    let (recording, report) = read(
        "time_s,position_x_m,position_y_m,position_z_m,motor_1_command,motor_2_command,battery_V,note\n\
         10.0,1,2,3,0.5,0.6,11.1,a\n\
         10.1,,,,0.5,,11.1,b\n\
         10.2,1,2,nan,0.5,0.6,,c\n",
    )
    .unwrap();
    let position = stream(&recording, Quantity::Position);
    assert_eq!((position.len(), position.width), (2, 3));
    assert!((position.time_s[1] - 0.2).abs() < 1e-12);
    assert!(position.sample(1)[2].is_nan());
    let command = stream(&recording, Quantity::ActuatorCommand);
    assert_eq!((command.len(), command.width), (3, 2));
    assert!(command.sample(1)[1].is_nan());
    assert_eq!(stream(&recording, Quantity::BatteryVoltage).len(), 2);
    assert_eq!(report.unused_columns, ["note"]);
    assert_eq!((report.rows, report.rows_rejected, report.start_time_s), (3, 0, 10.0));
    assert!(!report.has_loss());
}

#[test]
fn bom_crlf_quotes_and_other_delimiters_do_not_matter() {
    let plain = read("time_s,battery_V\n0,12\n1,11\n").unwrap();
    for text in [
        "\u{feff}time_s,battery_V\r\n0,12\r\n1,11\r\n",
        "time_s;battery_V\n0;12\n1;11\n",
        "time_s\tbattery_V\n0\t12\n1\t11",
        "\"time_s\", \"battery_V\"\n 0 , 12\n1,11\n\n".replace(" \"", "\"").as_str(),
    ] {
        assert_eq!(read(text).unwrap(), plain, "{text:?}");
    }
}

#[test]
fn bad_rows_are_left_out_with_line_and_reason() {
    let (recording, report) = read("time_s,battery_V\n0,12\n1\n2,11,10\n3,full\n,9\n4,inf\n5,10\n").unwrap();
    assert_eq!(stream(&recording, Quantity::BatteryVoltage).values, [12.0, 10.0]);
    assert_eq!((report.rows, report.rows_rejected), (7, 5));
    let told: Vec<String> =
        report.rejections.iter().map(|row| format!("{}: {}", row.line, row.reason)).collect();
    assert_eq!(
        told,
        [
            "3: expected 2 cells as in the header, came 1",
            "4: expected 2 cells as in the header, came 3",
            "5: column \"battery_V\": expected a number, came \"full\"",
            "6: column \"time_s\": expected a time, came nothing",
            "7: column \"battery_V\": expected a number, came \"inf\"",
        ]
    );
    assert!(report.has_loss());
}

#[test]
fn time_is_sorted_and_repeats_are_counted() {
    let (recording, report) = read("time_s,battery_V\n0,1\n0.2,3\n0.1,2\n0.2,4\n0.3,5\n").unwrap();
    let voltage = stream(&recording, Quantity::BatteryVoltage);
    assert_eq!(voltage.time_s, [0.0, 0.1, 0.2, 0.3]);
    assert_eq!(voltage.values, [1.0, 2.0, 3.0, 5.0]);
    assert_eq!((report.rows_out_of_order, report.rows_repeating_a_time), (1, 1));
}

#[test]
fn a_clock_that_starts_anew_is_a_reset_not_disorder() {
    let (recording, report) = read("time_s,battery_V\n5,1\n6,2\n0,3\n1,4\n").unwrap();
    assert_eq!(stream(&recording, Quantity::BatteryVoltage).time_s, [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(recording.clock_resets_s, [2.0]);
    assert_eq!((report.clock_resets, report.rows_out_of_order), (1, 0));
    // a damaged time far ahead splits the flight and does not drag the rest along
    let (recording, report) = read("time_s,battery_V\n0,1\n1,2\n9e15,3\n2,4\n").unwrap();
    assert_eq!(stream(&recording, Quantity::BatteryVoltage).time_s, [0.0, 1.0, 2.0, 3.0]);
    assert_eq!(report.clock_resets, 2);
}

#[test]
fn what_cannot_be_read_is_refused_with_the_columns() {
    let missing = read("seconds,battery_V\n0,12\n").unwrap_err().to_string();
    assert!(missing.contains("flight.csv: expected column(s) time_s, but the header has seconds, battery_V"));
    let half = read("time_s,position_x_m,position_z_m\n0,1,2\n").unwrap_err().to_string();
    assert!(half.contains("expected column(s) position_y_m,"), "{half}");
    assert!(matches!(read("time_s,battery_V,battery_V\n").unwrap_err(), CsvError::RepeatedColumn { .. }));
    assert!(matches!(read("time_s,speed\n0,1\n").unwrap_err(), CsvError::NothingMapped { .. }));
    assert!(matches!(read("time_s,battery_V\n").unwrap_err(), CsvError::NoRows { rows: 0, .. }));
    let none = read("time_s,battery_V\na,b\n").unwrap_err().to_string();
    assert!(none.contains("of 1 row(s) none was usable (line 2: column \"time_s\""), "{none}");
    assert!(read("").is_err());
}

#[test]
fn units_frames_and_sentinels_become_si_flu_nwu() {
    let (recording, report) = read_as(
        r#"
        [time]
        column = "t"
        unit = "us"
        [[quantity]]
        name = "specific_force"
        columns = ["ax", "ay", "az"]
        frame = "frd"
        unit = "mg"
        [[quantity]]
        name = "velocity"
        columns = ["ve", "vn", "vu"]
        frame = "enu"
        [[quantity]]
        name = "attitude"
        columns = ["roll", "pitch", "yaw"]
        form = "euler"
        unit = "deg"
        frame = "frd-ned"
        [[quantity]]
        name = "rotor_speed"
        columns = ["rpm{n}"]
        unit = "rpm"
        missing = [65535]
        "#,
        "t,ax,ay,az,ve,vn,vu,roll,pitch,yaw,rpm1,rpm2\n\
         1700000000000000,0,0,-1000,1,2,3,0,0,90,60,65535\n\
         1700000000500000,0,0,-1000,1,2,3,0,10,0,60,120\n",
    );
    assert!((report.start_time_s - 1.7e9).abs() < 1e-6);
    let force = stream(&recording, Quantity::SpecificForce);
    assert_eq!(force.time_s, [0.0, 0.5]);
    assert!((force.sample(0)[2] - 9.806_65).abs() < 1e-12);
    assert_eq!(stream(&recording, Quantity::Velocity).sample(0), [2.0, -1.0, 3.0]);
    // facing east is a quarter turn clockwise, -90 degrees about up
    let half = std::f64::consts::FRAC_1_SQRT_2;
    for (got, wanted) in stream(&recording, Quantity::Attitude).sample(0).iter().zip([half, 0.0, 0.0, -half])
    {
        assert!((got - wanted).abs() < 1e-12);
    }
    // ten degrees nose up is a negative turn about left
    assert!((stream(&recording, Quantity::Attitude).sample(1)[2] + 5_f64.to_radians().sin()).abs() < 1e-12);
    let speed = stream(&recording, Quantity::RotorSpeed);
    assert!((speed.sample(0)[0] - std::f64::consts::TAU).abs() < 1e-12);
    assert!(speed.sample(0)[1].is_nan());
}

#[test]
fn quaternions_far_from_unit_are_left_out() {
    let (recording, report) = read(
        "time_s,attitude_w,attitude_x,attitude_y,attitude_z\n0,1,0,0,0\n1,0,0,0,0\n2,1,0,,0\n3,0.99,0,0,0\n",
    )
    .unwrap();
    let attitude = stream(&recording, Quantity::Attitude);
    assert_eq!(attitude.time_s, [0.0, 3.0]);
    assert_eq!(attitude.sample(1), [1.0, 0.0, 0.0, 0.0]);
    assert_eq!(report.invalid_attitudes, 2);
}

#[test]
fn bytes_that_are_no_table_are_refused_not_fatal() {
    let mapping = CsvMapping::default();
    let mut state = 1_u32;
    let mut noise: Vec<u8> = Vec::new();
    for _ in 0..20_000 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        noise.push(state.to_be_bytes()[0]);
    }
    assert!(read_from(noise.as_slice(), "noise", &mapping).is_err());
    let mut after_header = b"time_s,battery_V\n0,1\n".to_vec();
    after_header.extend(noise);
    let (recording, report) = read_from(after_header.as_slice(), "noise", &mapping).unwrap();
    assert_eq!(stream(&recording, Quantity::BatteryVoltage).values, [1.0]);
    assert!(report.rows_rejected > 0);
}

#[test]
fn mapping_mistakes_are_told() {
    let table = |lines: &str| format!("[time]\ncolumn = \"t\"\n[[quantity]]\n{lines}\n");
    for (text, needles) in [
        (table("name = \"speed\"\ncolumns = [\"a\"]"), ["`quantity[0].name`", "one of attitude,"]),
        (
            table("name = \"position\"\ncolumns = [\"a\"]"),
            ["`quantity[0].columns`", "3 name(s) for position"],
        ),
        (
            table("name = \"battery_voltage\"\ncolumns = [\"a\"]\nunit = \"m\""),
            ["`quantity[0].unit`", "\"V\", \"mV\", \"cV\""],
        ),
        (
            table("name = \"armed\"\ncolumns = [\"a\"]\nframe = \"ned\""),
            ["`quantity[0].frame`", "no such key"],
        ),
        (table("name = \"armed\"\ncolumns = [\"a\"]\nunits = \"1\""), ["m.toml", "unknown field `units`"]),
        ("[time]\ncolumn = \"t\"\n".to_owned(), ["`quantity`", "at least one"]),
    ] {
        let message = parse_csv_mapping(&text, "m.toml").unwrap_err().to_string();
        for needle in needles {
            assert!(message.contains(needle), "{needle:?} is not in {message:?}");
        }
    }
}

#[test]
fn the_shipped_example_reads_its_logger() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/csv/crazyflie_client.toml");
    let mapping = load_csv_mapping(&path).unwrap();
    let text = "timestamp;stateEstimate.x;stateEstimate.y;stateEstimate.z;stateEstimate.vx;stateEstimate.vy;\
                stateEstimate.vz;stateEstimate.qx;stateEstimate.qy;stateEstimate.qz;stateEstimate.qw;gyro.x;gyro.y;\
                gyro.z;acc.x;acc.y;acc.z;motor.m1;motor.m2;motor.m3;motor.m4\n\
                500;1;2;3;0;0;0;0;0;0;1;180;0;0;0;0;1;65535;0;0;0\n";
    let (recording, _) = read_from(text.as_bytes(), "cf.csv", &mapping).unwrap();
    assert_eq!(stream(&recording, Quantity::Attitude).sample(0)[0], 1.0);
    assert!((stream(&recording, Quantity::AngularRate).sample(0)[0] - std::f64::consts::PI).abs() < 1e-12);
    assert!((stream(&recording, Quantity::ActuatorCommand).sample(0)[0] - 1.0).abs() < 1e-12);
}

/// Median of one value of the samples that `keep` selects by their time.
fn median(stream: &Stream, index: usize, keep: impl Fn(f64) -> bool) -> f64 {
    let mut values: Vec<f64> = (0..stream.len())
        .filter(|sample| keep(stream.time_s[*sample]))
        .map(|sample| stream.sample(sample)[index])
        .collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn shared_recordings_load() {
    let Some(shared) = support::shared() else { return };
    let paths = support::files(&shared.join("recordings"), "csv");
    assert!(paths.len() >= 21, "{}", paths.len());
    for path in paths {
        let opened = log::open(&path, &OpenOptions::default()).unwrap();
        let (recording, report) = (&opened.recording, opened.report.table().unwrap());
        let name = path.display();
        assert!(report.rows > 1500, "{name}: {} rows", report.rows);
        assert_eq!(report.rows_rejected, 0, "{name}: {:?}", report.rejections);
        assert_eq!(report.unused_columns, Vec::<String>::new(), "{name}");
        assert_eq!((report.clock_resets, report.rows_out_of_order), (0, 0), "{name}");
        assert_eq!(report.invalid_attitudes, 0, "{name}");
        assert_eq!(stream(recording, Quantity::ActuatorCommand).width, 4, "{name}");
        let folder = path.parent().unwrap().file_name().unwrap().to_str().unwrap();
        if folder == "nanodrone" || folder == "nanobench" {
            let end_s = *stream(recording, Quantity::Position).time_s.last().unwrap();
            let airborne = |time_s: f64| folder == "nanodrone" || (5.0..end_s - 5.0).contains(&time_s);
            let up = median(stream(recording, Quantity::SpecificForce), 2, airborne);
            assert!((9.7..10.3).contains(&up), "{name}: {up} m/s^2");
        }
    }
}

#[test]
fn a_dropped_rotor_speed_is_missing_not_zero() {
    let Some(shared) = support::shared() else { return };
    let path = shared.join("recordings/nanodrone/random1_run1.csv");
    let recording = log::open(&path, &OpenOptions::default()).unwrap().recording;
    let speed = stream(&recording, Quantity::RotorSpeed);
    assert_eq!(speed.width, 4);
    let known = speed.values.iter().filter(|value| !value.is_nan());
    assert!(known.clone().all(|value| (100.0..2600.0).contains(value)));
    assert!(known.count() > 4 * 5900);
}

/// A flight of two rows before whatever follows.
const TWO_ROWS: &str = "time_s,battery_V\n0,12\n1,12\n";

#[test]
fn a_row_without_an_end_costs_what_follows_and_no_memory() {
    for (begin, byte) in [("", b'1'), ("", b','), ("\"", b'1'), ("\"", b'\n')] {
        // it never ends
        let bytes = TWO_ROWS.as_bytes().chain(begin.as_bytes()).chain(std::io::repeat(byte));
        let reader = std::io::BufReader::new(bytes);
        let (recording, report) = read_from(reader, "long.csv", &CsvMapping::default()).unwrap();
        assert_eq!(stream(&recording, Quantity::BatteryVoltage).len(), 2);
        assert_eq!((report.rows, report.rows_rejected, report.cut_at_line), (3, 1, Some(4)));
        let told: Vec<String> = report.losses().iter().map(ToString::to_string).collect();
        let told = told.join("; ");
        assert!(told.contains("line 4: expected a row of at most 1048576 bytes"), "{told}");
        assert!(told.contains("nothing is read from line 4 on"), "{told}");
    }
}

#[test]
fn a_header_has_a_greatest_size() {
    let long = std::io::BufReader::new(std::io::repeat(b','));
    let error = read_from(long, "long.csv", &CsvMapping::default()).unwrap_err();
    assert!(matches!(error, CsvError::LongHeader { max: 1_048_576, .. }), "{error}");
    let many = read(&format!("time_s{}\n", ",".repeat(5000))).unwrap_err().to_string();
    assert!(many.contains("expected at most 4096 columns, the header has 5001"), "{many}");
    let names: Vec<String> = (0..3000).map(|number| format!("column_{number}")).collect();
    let told = read(&format!("{}\n", names.join(","))).unwrap_err().to_string();
    assert!(told.len() < 1000 && told.contains("and 2980 more"), "{told}");
}

#[test]
fn column_names_and_cells_command_nothing() {
    let evil = "x\u{1b}[31m\u{9b}2J\u{202e}";
    for text in [
        format!("{evil},battery_V\n"),
        format!("time_s,battery_V\n{evil},1\n"),
        format!("time_s,battery_V\n\"0\n{evil}\",1\n"),
        format!("{evil},\u{9b}\n"),
    ] {
        let said = read(&text).unwrap_err().to_string();
        assert!(!said.chars().any(mavid::text::is_command), "{said:?}");
    }
    // ASCII controls in the first line are no text at all; the others are
    let (_, report) = read("time_s,battery_V,x\u{9b}2J\u{202e}\n0,1,2\n").unwrap();
    assert_eq!(report.unused_columns, ["x\\u{9b}2J\\u{202e}"]);
}

#[test]
fn what_is_no_text_is_said_and_not_printed() {
    let mapping = CsvMapping::default();
    for (bytes, words) in [
        (&b""[..], "expected text with a header of column names in its first line, got an empty file"),
        (&b"\n1,2\n"[..], "got an empty line"),
        (&b"\x7fELF\x02\x01\0\0,\x1b[31m\n"[..], "got binary data"),
    ] {
        let error = read_from(bytes, "flight.csv", &mapping).unwrap_err().to_string();
        assert!(error.starts_with("flight.csv: ") && error.contains(words), "{error}");
        assert!(!error.chars().any(char::is_control), "{error:?}");
    }
}

#[test]
fn commas_as_decimal_marks_are_told() {
    let reason = |text: &str| read(text).unwrap_err().to_string();
    let said = reason("time_s,battery_V\n0,1,11,1\n0,2,11,2\n");
    assert!(said.contains("commas both between the cells and decimal marks"), "{said}");
    let said = reason("time_s;battery_V\n0,1;11,1\n0,2;11,2\n");
    assert!(said.contains("came \"0,1\": write it with a decimal point"), "{said}");
}
