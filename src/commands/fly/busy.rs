//! Whether a flight ended because this computer had no time for it, by what was measured.

use std::time::Duration;

use mavid::fly::{Cause, FlightStatistics, Outcome, StreamFigures};

/// A simulated vehicle that stood still for longer was kept waiting by the computer. Set by judgement: PX4 leaves OFFBOARD after 0.5 to 1 s
/// without setpoints.
const STOOD: Duration = Duration::from_millis(500);
/// Share of late setpoints of a computer without time for them. It is below 1 % on one that has time.
const LATE_SHARE: f64 = 0.2;
/// What helps.
const REMEDY: &str = "close what else runs on it, or wait until that is done, and fly again";

/// What was measured of this computer, in words, where a flight ended early by what a busy computer causes; otherwise `None`. `vehicle`
/// is the longest time for which the simulated vehicle on the same computer stood still.
pub fn busy(outcome: &Outcome, stream: &StreamFigures, vehicle: Option<Duration>) -> Option<String> {
    if !outcome.cause.as_ref().is_some_and(may_come_of_it) {
        return None;
    }
    let mut measured: Vec<String> =
        outcome.flown.stalled_before_end_s.iter().map(|s| stalled(*s, &outcome.flown)).collect();
    let stood = vehicle.filter(|stood| *stood > STOOD);
    measured
        .extend(stood.map(|stood| {
            format!("the simulated vehicle on it stood still for {:.1} s", stood.as_secs_f64())
        }));
    if stream.late as f64 > LATE_SHARE * stream.sent as f64 || !measured.is_empty() && stream.late > 0 {
        measured.push(format!("{} of {} setpoints were more than 3 ms late", stream.late, stream.sent));
    }
    let measured = measured.join(", ");
    match (measured.is_empty(), vehicle) {
        (true, _) => None,
        (_, Some(_)) => Some(format!("this computer was too busy for the flight: {measured}; {REMEDY}")),
        // of a vehicle elsewhere, something else may have ended the flight
        (_, None) => Some(format!(
            "this computer was busy: {measured}. Whether the flight ended by that is not known; look for another cause first"
        )),
    }
}

fn stalled(before_end_s: f64, flown: &FlightStatistics) -> String {
    let also = match flown.stalls {
        0 | 1 => String::new(),
        stalls => format!(" ({stalls} times in the flight, {:.1} s at most)", flown.stalled_max_s),
    };
    format!("this program stood still for {before_end_s:.1} s just before that{also}")
}

/// Whether an autopilot without setpoints, or a program that hears late, may bring it about.
fn may_come_of_it(cause: &Cause) -> bool {
    match cause {
        Cause::Operator | Cause::Killed | Cause::Signal(_) | Cause::Battery(_) | Cause::SecondMaster(_) => {
            false
        }
        Cause::Reboot | Cause::Unfit(_) => false,
        Cause::Refused(_)
        | Cause::NotReached(_)
        | Cause::Override(_)
        | Cause::Failsafe(_)
        | Cause::Tracking(_)
        | Cause::Tilt(_)
        | Cause::Room(_)
        | Cause::LinkLost(_)
        | Cause::Estimator(_)
        | Cause::EstimatorReset(_)
        | Cause::Stalled(_)
        | Cause::Unresponsive(_) => true,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mavid::fly::Ending;

    const IN_TIME: StreamFigures = StreamFigures { sent: 1000, late: 0, overtaken: 0, refused: 0 };

    fn ended(cause: Option<Cause>, flown: FlightStatistics) -> Outcome {
        Outcome { cause, ending: Ending::Landed, flown, losses: Vec::new() }
    }

    fn lost() -> Option<Cause> {
        Some(Cause::Override("offboard lost".to_owned()))
    }

    #[test]
    fn a_busy_computer_is_named_with_what_was_measured() {
        let flown = FlightStatistics {
            stalls: 3,
            stalled_max_s: 0.9,
            stalled_before_end_s: Some(0.6),
            ..FlightStatistics::default()
        };
        let stream = StreamFigures { late: 120, ..IN_TIME };
        let said = busy(&ended(lost(), flown), &stream, Some(Duration::from_millis(1240))).unwrap();
        assert_eq!(
            said,
            "this computer was too busy for the flight: this program stood still for 0.6 s just before that (3 times in the flight, \
             0.9 s at most), the simulated vehicle on it stood still for 1.2 s, 120 of 1000 setpoints were more than 3 ms late; \
             close what else runs on it, or wait until that is done, and fly again"
        );
        // the vehicle alone, or the setpoints alone
        let calm = || ended(lost(), FlightStatistics::default());
        let vehicle = busy(&calm(), &IN_TIME, Some(Duration::from_millis(700))).unwrap();
        assert!(
            vehicle.contains("flight: the simulated vehicle on it stood still for 0.7 s; close"),
            "{vehicle}"
        );
        let short = Some(Duration::from_millis(40));
        let late = busy(&calm(), &StreamFigures { late: 300, ..IN_TIME }, short).unwrap();
        assert!(late.contains("flight: 300 of 1000 setpoints"), "{late}");
        // of a vehicle elsewhere no cause is named, and nobody is sent to fly again
        let real = busy(&calm(), &StreamFigures { late: 300, ..IN_TIME }, None).unwrap();
        assert!(real.contains("busy: 300 of 1000") && real.contains("is not known"), "{real}");
        assert!(!real.contains("fly again"), "{real}");
    }

    #[test]
    fn a_computer_that_had_time_is_not_blamed() {
        let short = Some(Duration::from_millis(40));
        assert_eq!(busy(&ended(lost(), FlightStatistics::default()), &IN_TIME, short), None);
        let few = StreamFigures { late: 9, ..IN_TIME };
        assert_eq!(busy(&ended(lost(), FlightStatistics::default()), &few, None), None);
        // nor for what a person decides, nor where nothing ended early
        let stalled = FlightStatistics {
            stalls: 1,
            stalled_max_s: 0.4,
            stalled_before_end_s: Some(0.4),
            ..FlightStatistics::default()
        };
        for cause in [None, Some(Cause::Operator), Some(Cause::Signal("Ctrl-C".to_owned()))] {
            assert_eq!(busy(&ended(cause, stalled.clone()), &IN_TIME, Some(Duration::from_secs(2))), None);
        }
    }
}
