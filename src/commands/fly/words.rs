//! What is said of a flight that is over.

use super::busy::busy;
use crate::commands::words::Word;
use mavid::fly::{self, Ending, Outcome as FlightOutcome, Record};

/// The same as text alone.
pub fn lines(record: &Record) -> Vec<String> {
    let text = |word: Word| match word {
        Word::Message(text) | Word::Warning(text) | Word::Error(text) => text,
    };
    words(record).into_iter().map(text).collect()
}

/// How it went, line by line.
pub fn words(record: &Record) -> Vec<Word> {
    let FlightOutcome { cause, ending, flown, losses } = &record.outcome;
    let how = match ending {
        Ending::NotFlown => "not flown".to_owned(),
        Ending::Landed => "landed".to_owned(),
        Ending::Fell => "fallen".to_owned(),
        Ending::InTheAir(mode) => format!("left in the air, mode {mode}"),
    };
    let why = cause.as_ref().map_or_else(String::new, |cause| format!(": {cause}"));
    let stream = &record.stream;
    let said = format!("{how}{why}");
    let mut lines = vec![if record.outcome.is_whole() { Word::Message(said) } else { Word::Error(said) }];
    let frames = format!("{} frames recorded, {} lost", record.recorder.frames, record.recorder.dropped);
    if *ending == Ending::NotFlown {
        lines.push(Word::Message(frames));
    } else {
        lines.push(Word::Message(format!(
            "{} periods, {:.3} m rms off the reference, {:.3} m at most; tilt {:.1} degrees, planned {:.1}",
            flown.periods,
            flown.tracking_rms_m,
            flown.tracking_max_m,
            flown.tilt_max_deg,
            flown.tilt_planned_deg
        )));
        lines.push(Word::Message(format!(
            "{} setpoints, {} of them more than 3 ms late, {} overtaken by the next, {} refused by the link; {frames}",
            stream.sent, stream.late, stream.overtaken, stream.refused
        )));
    }
    let mut warnings: Vec<String> = busy(&record.outcome, stream, None).into_iter().collect();
    warnings.extend(losses.iter().map(ToString::to_string));
    warnings.extend(record.events_failure.iter().map(|failure| format!("{}: {failure}", fly::EVENTS)));
    let recording = record.recorder.failure.iter();
    warnings.extend(recording.map(|failure| format!("{}: cannot write: {failure}", fly::TLOG)));
    if record.recorder.doubtful > 0 {
        let count = record.recorder.doubtful;
        warnings.push(format!("the system could not confirm that {count} frames are on the disk"));
    }
    lines.extend(warnings.into_iter().map(Word::Warning));
    lines
}
