//! A number with its error and its unit, which stand on one line.

/// Between parts of one quantity where a line must not end.
const NO_BREAK: char = '\u{a0}';

/// What stands between a value and its error.
const ERROR: [&str; 2] = ["+-", "±"];

/// What may stand behind the last word of a quantity.
const ENDS: [char; 5] = ['.', ',', ';', ':', ')'];

/// Units, of which the number before them does not stand on another line.
const UNITS: [&str; 27] = [
    "%",
    "N",
    "m",
    "mm",
    "cm",
    "m/s",
    "m/s^2",
    "s",
    "ms",
    "1/s",
    "Hz",
    "kg",
    "g",
    "kg/m",
    "rad",
    "rad/s",
    "rad/s^2",
    "deg",
    "V",
    "A",
    "W",
    "sigma",
    "N/m",
    "(m/s)^2",
    "N/(m/s)",
    "N/(m/s)^2",
    "m/(m/s)",
];

/// Words in which the parts of one quantity stand on one line.
#[must_use]
pub fn unbroken(words: &str) -> String {
    let mut out = String::with_capacity(words.len() + 16);
    let mut before = None;
    for word in words.split(' ') {
        if let Some(before) = before {
            out.push(if is_one(before, word) { NO_BREAK } else { ' ' });
        }
        out.push_str(word);
        before = Some(word);
    }
    out
}

/// Whether two neighbours are parts of one quantity.
pub(super) fn is_one(before: &str, word: &str) -> bool {
    let ended = word.trim_end_matches(ENDS);
    match (before, ended) {
        (sign, error) if ERROR.contains(&sign) => is_number(error),
        (value, sign) if ERROR.contains(&sign) => is_number(value),
        ("N", "m" | "per") | ("m", "per") | ("kg", "m^2") => true,
        ("per", _) => is_unit(word),
        (value, _) => is_number(value) && is_unit(word),
    }
}

/// Whether a word is a unit, which may end in a bracket of its own.
fn is_unit(word: &str) -> bool {
    UNITS.contains(&word) || word.strip_suffix(ENDS).is_some_and(is_unit)
}

fn is_number(word: &str) -> bool {
    let digits = word.trim_start_matches(['(', '-', '+']);
    let is_digit = |letter: char| letter.is_ascii_digit();
    digits.starts_with(is_digit) && digits.ends_with(is_digit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_stands_beside_its_error_and_its_unit() {
        let shown = |words: &str| unbroken(words).replace(NO_BREAK, "~");
        assert_eq!(shown("drag (1.17 +- 0.02 across), by 97 %."), "drag (1.17~+-~0.02 across), by 97~%.");
        assert_eq!(shown("0.040 +- 0.003 N m per rad/s"), "0.040~+-~0.003~N~m~per~rad/s");
        assert_eq!(shown("drag (0.41 ± 0.02 N per m/s)"), "drag (0.41~±~0.02~N~per~m/s)");
        assert_eq!(shown("0.08 N per (m/s)^2, (2.0 +- 0.1)e-5 kg"), "0.08~N~per~(m/s)^2, (2.0~+-~0.1)e-5~kg");
        assert_eq!(shown("from 0.30 to 0.41 +- 0.02 N/(m/s)."), "from 0.30 to 0.41~+-~0.02~N/(m/s).");
        assert_eq!(
            shown("izz -0.0003 +- 0.0004 kg m^2; 14 % (51 to 56 %)"),
            "izz -0.0003~+-~0.0004~kg~m^2; 14~% (51 to 56~%)"
        );
        // other words are broken as before
        assert_eq!(
            shown("motor 2 (rear left), 2 flights +- few  a, as per part"),
            "motor 2 (rear left), 2 flights +- few  a, as per part"
        );
    }
}
