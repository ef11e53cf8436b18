//! Messages whose meaning is known and that say nothing more of the motion or of what drives it.

/// By what they hold; what is not listed is not known here.
const KNOWN: &[&[&str]] = &[
    // what the controllers asked for, with their own feedback in it, and height and speed that the estimators tell as well
    &["NTUN", "PSC", "PSCZ", "GUID", "GUIA", "PIDR", "PIDP", "PIDY", "PIDA", "PIDN", "PIDE", "ATSK"],
    // a frequency sweep: it runs for the test alone, and rates and attitude of it are logged beside it
    &["SIDD", "SIDS"],
    // by how much the outputs make up for the battery: undone in commands that are rebuilt, it makes results worse
    &["MOTB"],
    // insides of the estimators
    &[
        "NKF2", "NKF3", "NKF5", "NKQ", "XKF2", "XKF3", "XKF5", "XKFS", "XKFM", "XKQ", "XKT", "XKTV", "XKV1",
        "XKV2", "XKY0",
    ],
    &["XKY1", "EKF2", "EKF3", "EKF4", "ORGN"],
    // other sensors, and how good the known ones are
    &[
        "MAG", "MAG2", "MAG3", "VIBE", "GPA", "UBX1", "UBX2", "RFND", "OF", "ARSP", "IMT", "IMT2", "IMT3",
        "TERR", "BCL",
    ],
    // the transmitter, missions, the link
    &["RCIN", "RCI2", "RSSI", "CMD", "RAD", "MAV", "CMDI", "FNCE", "RALY", "MISE"],
    // the computer and the log itself
    &[
        "PM", "PMA", "POWR", "MCU", "HEAT", "FILE", "VER", "FMT", "FMTU", "UNIT", "MULT", "SRTL", "D16",
        "DU16", "D32", "DU32",
    ],
    &["DFLT", "FTN", "FTN1", "FTN2", "EDT2", "STAK", "TSYN"],
];

/// Whether the meaning of messages of this name is known.
pub(super) fn is_known(message: &str) -> bool {
    KNOWN.iter().any(|names| names.contains(&message))
}

#[cfg(test)]
mod tests {
    use super::super::special::SPECIALS;
    use super::super::topics::TOPICS;
    use super::*;

    #[test]
    fn what_is_read_is_not_listed_as_unused() {
        let read = TOPICS.iter().flat_map(|topics| topics.iter()).map(|topic| topic.message);
        let read = read.chain(SPECIALS.iter().map(|special| special.message));
        let both: Vec<&str> = read.filter(|message| is_known(message)).collect();
        assert!(both.is_empty(), "{both:?}");
        assert!(is_known("SIDD") && !is_known("NEWS"));
    }
}
