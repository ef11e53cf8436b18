//! Reads the log once and asks each question of its flights.

use super::balance::off_balance;
use super::effects::effects;
use super::finding::{Amount, Finding, Gravity, Screening, Where};
use super::settings::{Bounds, ScreenSettings};
use crate::autopilot::VehicleKind;
use crate::draft::{Given, draft};
use crate::log::{
    Hold, Input, LogError, LogFlight, Loss, OpenOptions, OpenedFlights, ReadReport, open_flights,
};
use crate::recording::{Quantity, Recording};
use crate::signals::{
    ConditionSettings, OffMixer, ReportedState, Signals, ThrustPreference, adopt_in_flight_parameters,
    condition, outputs_off_mixer,
};
use crate::vehicle::Vehicle;
use rayon::ThreadPoolBuilder;

/// Most time of a log that is held, s: the bound on numbers is met before, but for logs that are almost empty.
const MOST_S: f64 = 3600.0;
/// A vehicle of which nothing is known: the balance is in shares and arms, in which its mass does not show.
const UNKNOWN: Given = Given { mass_kg: 1.0, size_m: None, frame: None };

/// What is notable in a log of any known format, by its bytes.
///
/// Outputs that no longer follow the controllers, data that was lost, and a balance that is off need nothing but the log. Effects are
/// searched where [`ScreenSettings::vehicle`] says what the vehicle weighs, in as much flight as [`Bounds`] allow. A log of 4 MB takes less
/// than a tenth of a second of one core without that search, and up to two seconds with it.
///
/// The work stays on the calling thread. For that, the search of effects makes the thread the only one of a `rayon` pool, once: what
/// the thread itself later gives to `rayon` stays on it as well. A thread that is of a pool already uses that pool.
///
/// ```
/// use mavid::screen::{ScreenSettings, screen};
///
/// let log = std::fs::read(concat!(env!("CARGO_MANIFEST_DIR"), "/fixtures/px4_flight.ulg"))?;
/// let screening = screen(&log, &ScreenSettings::default())?;
/// assert!(screening.airborne_s > 8.0 && screening.findings.is_empty());
/// // the mass was not given
/// assert!(screening.not_done.iter().any(|why| why.contains("mass")));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`LogError`] where the bytes are no log, or are of no known format.
pub fn screen(log: &[u8], settings: &ScreenSettings) -> Result<Screening, LogError> {
    on_this_thread(|| screened(log, settings))
}

/// Keeps what the work divides among threads on the calling one.
fn on_this_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    if rayon::current_thread_index().is_none() {
        let pool = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
        // without memory for a pool the work is done all the same
        if let Ok(pool) = pool {
            return pool.install(work);
        }
    }
    work()
}

fn screened(log: &[u8], settings: &ScreenSettings) -> Result<Screening, LogError> {
    let Bounds { bytes, numbers, .. } = settings.bounds;
    let used = log.get(..bytes).unwrap_or(log);
    let hold = Hold { seconds: MOST_S, numbers, short_s: 0.0 };
    let input = Input::Bytes { name: "the log", bytes: used };
    let OpenedFlights { flights, report } = open_flights(input, &OpenOptions::default(), &hold)?;
    let mut screening = Screening { format: report.format, ..Screening::default() };
    if used.len() < log.len() {
        screening.not_done.push(format!(
            "the log has {} bytes, expected at most {bytes}: the bytes behind are not looked at",
            log.len()
        ));
    }
    let opened = OpenedFlights { flights, report };
    let cut = (used.len() < log.len()).then_some(used);
    screening.findings.extend(lost(&opened.report, cut));
    screening.not_done.extend(not_held(&opened.report));
    match refused(&opened) {
        Some(why) => screening.not_done.push(why),
        None => {
            let mut mass = Some("effects are not searched: the mass of the vehicle was not given".to_owned());
            let is_one = opened.flights.flights.len() == 1;
            for flight in opened.flights.flights {
                let before = screening.not_done.len();
                let part_s = flight.part_s.filter(|_| !is_one);
                look_at(flight, settings, &mut screening);
                if let Some((from_s, to_s)) = part_s {
                    let of_flight =
                        |why: &mut String| *why = format!("flight from {from_s:.0} to {to_s:.0} s: {why}");
                    screening.not_done[before..].iter_mut().for_each(of_flight);
                }
                screening.not_done.extend(mass.take().filter(|_| settings.vehicle.is_none()));
            }
        }
    }
    screening.findings.sort_by_key(|finding| std::cmp::Reverse(finding.gravity));
    Ok(screening)
}

/// What of the log was lost. Of a log that was cut here, `cut` is what is left: its end is no damage.
fn lost(report: &ReadReport, cut: Option<&[u8]>) -> Vec<Finding> {
    let finding = |loss: &Loss| Finding {
        id: "data_lost",
        gravity: if loss.is_damage() { Gravity::Warning } else { Gravity::Info },
        sentence: loss.to_string(),
        span_s: None,
        at: None,
        amounts: Vec::new(),
        may_be: Vec::new(),
    };
    let is_of_the_log = |loss: &&Loss| {
        !matches!(loss, Loss::NotHeld { .. }) && !cut.is_some_and(|cut| is_of_the_cut(loss, cut))
    };
    report.losses.iter().filter(is_of_the_log).map(finding).collect()
}

/// The loss is the record or the row at the end of what was looked at.
fn is_of_the_cut(loss: &Loss, cut: &[u8]) -> bool {
    let is_last = |line: u64| line == 1 + cut.iter().map(|byte| u64::from(*byte == b'\n')).sum::<u64>();
    match loss {
        Loss::CutOff { .. } => true,
        Loss::EndlessRow { line } => is_last(*line),
        Loss::RowsRejected { count: 1, first: Some(row), .. } => is_last(row.line),
        _ => false,
    }
}

/// Flight that is more than the bounds allow.
fn not_held(report: &ReadReport) -> Option<String> {
    report.losses.iter().find_map(|loss| match loss {
        Loss::NotHeld { seconds } => {
            Some(format!("{seconds:.0} s of flight at the end are not looked at: the bounds allow no more"))
        }
        _ => None,
    })
}

/// Why the flights of a log are not looked at.
fn refused(opened: &OpenedFlights) -> Option<String> {
    let OpenedFlights { flights, report } = opened;
    let parameter =
        |name: &str| flights.flights.iter().find_map(|flight| flight.recording.parameters.get(name).copied());
    let kind = report.kind().map(|kind| kind.by_parameters(parameter));
    if let Some(kind) = kind.filter(|kind| *kind != VehicleKind::Multirotor) {
        return Some(format!("expected the log of a multirotor, got that of a {}", kind.name()));
    }
    if report.out_of_order().is_some() {
        return Some(
            "the stamps of the log run back: it is damaged, or its pieces were put together wrongly".into(),
        );
    }
    if !report.is_timed() {
        return Some("the messages of the log have no times".into());
    }
    let on_ground = |recording: &Recording| ReportedState::of(recording).never_armed();
    if flights.flights.iter().all(|flight| on_ground(&flight.recording)) {
        return Some("nothing flew: the vehicle was never armed".into());
    }
    None
}

/// One flight: what its outputs show, and then what its motion shows until the first output left the mixer.
fn look_at(flight: LogFlight, settings: &ScreenSettings, screening: &mut Screening) {
    let LogFlight { mut recording, part_s } = flight;
    // a part of a log has a clock of its own
    let begins_s = part_s.map_or(0.0, |(from_s, _)| from_s);
    let off_mixer = outputs_off_mixer(&recording);
    let end_s = begins_s + last_s(&recording);
    let told = off_mixer.iter().map(|off| off_mixer_finding(&off.later(begins_s), end_s));
    screening.findings.extend(told);
    if let Some(first) = off_mixer.first() {
        recording.end_at(first.left_s);
    }
    let before = screening.findings.len();
    motion(&mut recording, !off_mixer.is_empty(), (settings, screening));
    for finding in &mut screening.findings[before..] {
        finding.span_s = finding.span_s.map(|(from_s, to_s)| (from_s + begins_s, to_s + begins_s));
    }
}

/// What the motion of a flight shows, on the recording's clock.
fn motion(
    recording: &mut Recording,
    is_off_mixer: bool,
    (settings, screening): (&ScreenSettings, &mut Screening),
) {
    adopt_in_flight_parameters(recording);
    let given = settings.vehicle.unwrap_or(UNKNOWN);
    let conditioned = conditioned(recording, &given);
    let (signals, vehicle) = match conditioned {
        Ok(conditioned) => conditioned,
        Err(why) => return screening.not_done.push(format!("balance and effects are not looked at: {why}")),
    };
    screening.airborne_s += signals.quality.airborne_s.iter().map(|(from, to)| to - from).sum::<f64>();
    match off_balance(&signals, &vehicle) {
        Ok(found) => screening.findings.extend(found),
        Err(why) => screening.not_done.push(format!("the balance is not looked at: {why}")),
    }
    if settings.vehicle.is_some() && !is_off_mixer {
        effects(&signals, &vehicle, (settings.bounds.searched, screening));
    } else if settings.vehicle.is_some() {
        screening
            .not_done
            .push("effects are not searched: an output left the mixer, which is the cause".into());
    }
}

fn conditioned(recording: &Recording, given: &Given) -> Result<(Signals, Vehicle), String> {
    let vehicle = draft(recording, given, "vehicle").map_err(|why| why.to_string())?.vehicle;
    let settings = ConditionSettings {
        transient_s: Some(0.0),
        thrust: ThrustPreference::Commands,
        ..ConditionSettings::default()
    };
    let signals = condition(recording, &vehicle, &settings).map_err(|why| why.to_string())?;
    Ok((signals, vehicle))
}

/// s of the last sample of all streams.
fn last_s(recording: &Recording) -> f64 {
    recording.streams.values().filter_map(|stream| stream.time_s.last()).copied().fold(0.0, f64::max)
}

fn off_mixer_finding(off: &OffMixer, end_s: f64) -> Finding {
    let amounts = [("output", Some(off.output as f64), "1"), ("stopped_at", off.stopped_s, "s")];
    let amount = |(name, value, unit): (&str, Option<f64>, &'static str)| {
        Some(Amount { name: name.to_owned(), value: value?, std: None, unit })
    };
    Finding {
        id: "output_off_mixer",
        gravity: Gravity::Critical,
        sentence: format!("{off}."),
        span_s: Some((off.left_s, end_s)),
        at: Some(Where { quantity: Quantity::ActuatorCommand.name(), channel: off.output - 1 }),
        amounts: amounts.into_iter().filter_map(amount).collect(),
        may_be: Vec::new(),
    }
}
