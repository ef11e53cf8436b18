//! Free text of an autopilot: plain words and short numbers stay, everything else is covered.

use std::ops::Range;

/// What covers a letter. It is a letter itself, so that a covered text stays as it is when it is read again.
const COVER: u8 = b'x';
/// Longest plain word of letters, bytes. Set by judgement, as the limits below: words of the autopilots' messages are shorter, keys longer.
const LONGEST_WORD: usize = 18;
/// Most digits of a number that stays: it is a voltage, a count or a version, and no place and no serial number.
const MOST_DIGITS: usize = 4;
/// Most decimals of a number that stays: two decimals of a degree are a kilometre.
const MOST_DECIMALS: usize = 2;
/// Most digits and letters of numbers side by side that stay: `47,39` is a kilometre.
const MOST_IN_GROUPS: usize = 5;
/// Words after which all that follows is covered.
const BEFORE_SECRET: &[&str] = &[
    "PASS",
    "PASSWD",
    "PASSWORD",
    "PASSPHRASE",
    "KEY",
    "SECRET",
    "TOKEN",
    "SSID",
    "PIN",
    "SERIAL",
    "SN",
    "UID",
];
/// Units that may follow a number without a space.
const UNITS: &[&str] = &[
    "s", "ms", "us", "V", "mV", "A", "mA", "mAh", "Hz", "kHz", "m", "cm", "mm", "km", "deg", "g", "G", "kg",
    "W", "Wh", "S",
];

/// A text's place in a longer one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(super) struct Part {
    /// it follows another part, which may have ended with a word before which a secret stands: all of it is covered
    pub(super) is_continued: bool,
    /// its last word may be the start of one
    pub(super) goes_on: bool,
}

/// Covers what may be a serial number, a key, a name or a place, and empties what stands behind the end of the text; whether that changed
/// anything.
pub(super) fn cover(text: &mut [u8], part: Part) -> bool {
    let before = text.to_vec();
    let end = text.iter().position(|byte| *byte == 0).unwrap_or(text.len());
    let (text, behind) = text.split_at_mut(end);
    behind.fill(0);
    let words = words(text);
    let first_secret = first_secret(text, &words, part);
    let is_number = in_long_numbers(text, &words);
    for (place, word) in words.into_iter().enumerate() {
        let is_last = part.goes_on && behind.is_empty() && word.end == text.len();
        let letters = &mut text[word];
        if place >= first_secret || is_last || is_number[place] || !is_plain(letters) {
            letters.iter_mut().filter(|byte| **byte != b'.').for_each(|byte| *byte = COVER);
        }
    }
    *text != before[..end] || before[end..].iter().any(|byte| *byte != 0)
}

/// Where the words of a text stand.
fn words(text: &[u8]) -> Vec<Range<usize>> {
    let is_of_word = |byte: u8| byte.is_ascii_alphanumeric() || byte == b'.' || byte >= 0x80;
    let (mut out, mut at) = (Vec::new(), 0);
    while at < text.len() {
        let length = text[at..].iter().take_while(|byte| is_of_word(**byte)).count();
        if length > 0 {
            out.push(at..at + length);
        }
        at += length.max(1);
    }
    out
}

/// The place of the first word that may be a secret: the one behind a keyword. The number of words where there is no keyword.
fn first_secret(text: &[u8], words: &[Range<usize>], part: Part) -> usize {
    if part.is_continued {
        return 0;
    }
    let announces = |place: usize| {
        let word = &text[words[place].clone()];
        let end = word.iter().rposition(|byte| byte.is_ascii_alphabetic()).map_or(0, |last| last + 1);
        let word = &word[..end];
        // `S/N`
        let is_split = word.eq_ignore_ascii_case(b"N")
            && place > 0
            && text[words[place - 1].start..words[place].start].eq_ignore_ascii_case(b"S/");
        is_split || BEFORE_SECRET.iter().any(|before| before.as_bytes().eq_ignore_ascii_case(word))
    };
    (0..words.len()).find(|place| announces(*place)).map_or(words.len(), |place| place + 1)
}

/// Which words are parts of a long number: groups of digits that stand side by side, as in a place or a serial number.
fn in_long_numbers(text: &[u8], words: &[Range<usize>]) -> Vec<bool> {
    let begins_with_digit = |word: &Range<usize>| text[word.start].is_ascii_digit();
    let mut out = vec![false; words.len()];
    let mut first = 0;
    while first < words.len() {
        let length = words[first..].iter().take_while(|word| begins_with_digit(word)).count();
        let signs = words[first..first + length].iter().flat_map(|word| &text[word.clone()]);
        let is_long =
            length > 1 && signs.filter(|sign| sign.is_ascii_alphanumeric()).count() > MOST_IN_GROUPS;
        out[first..first + length].fill(is_long);
        first += length.max(1);
    }
    out
}

/// A word of letters, a short number with or without a unit, or capitals with a number as the parts of an autopilot have (`EKF3`).
fn is_plain(word: &[u8]) -> bool {
    let Ok(word) = std::str::from_utf8(word) else { return false };
    let word = word.trim_matches('.');
    if !word.is_ascii() {
        return false;
    }
    if word.bytes().all(|letter| letter.is_ascii_alphabetic() || letter == b'.') {
        let is_hexadecimal = word.len() >= 8 && word.bytes().all(|letter| letter.is_ascii_hexdigit());
        return word.len() <= LONGEST_WORD && !is_hexadecimal;
    }
    let is_of_number = |letter: char| letter.is_ascii_digit() || letter == '.';
    let name = word.trim_end_matches(is_of_number);
    let number = &word[name.len()..];
    if name.is_empty() {
        return is_short(number);
    }
    if name.bytes().all(|letter| letter.is_ascii_uppercase()) {
        // `V4.7.0` is a version, `N47` a place; other names carry two digits at most
        let most = match name.len() {
            1 if name == "V" => MOST_DIGITS,
            1 => 1,
            _ => 2,
        };
        return name.len() <= 8 && number.bytes().filter(u8::is_ascii_digit).count() <= most;
    }
    let unit = word.trim_start_matches(is_of_number);
    UNITS.contains(&unit) && is_short(&word[..word.len() - unit.len()])
}

/// A number of few digits: `12.6`, `4.7.0`.
fn is_short(number: &str) -> bool {
    let decimals =
        number.split_once('.').map_or(0, |(_, after)| after.bytes().filter(u8::is_ascii_digit).count());
    let is_version = number.matches('.').count() > 1;
    number.bytes().filter(u8::is_ascii_digit).count() <= MOST_DIGITS
        && (is_version || decimals <= MOST_DECIMALS)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn covered(text: &str, part: Part) -> String {
        let mut bytes = text.as_bytes().to_vec();
        let changed = cover(&mut bytes, part);
        assert_eq!(changed, bytes != text.as_bytes());
        let once = bytes.clone();
        assert!(!cover(&mut bytes, part) && bytes == once, "{text}: covered twice");
        String::from_utf8_lossy(&bytes).into_owned()
    }

    #[test]
    fn what_an_autopilot_says_stays() {
        for said in [
            "EKF3 IMU0 is using GPS",
            "Throttle 0.25 at 12.6 V",
            "PreArm: Battery 1 below minimum arming voltage",
            "Takeoff detected after 10s at 400Hz with 4S",
            "ArduCopter V4.7.0",
            "Mission: 12 WP",
            "RC3_MIN is greater than RC3_TRIM",
        ] {
            assert_eq!(covered(said, Part::default()), said);
        }
    }

    #[test]
    fn serial_numbers_keys_and_places_are_covered() {
        for (said, shared) in [
            ("CubeOrange 00340025 3433510A 30303939", "CubeOrange xxxxxxxx xxxxxxxx xxxxxxxx"),
            ("home at 47.3977 8.5456", "home at xx.xxxx x.xxxx"),
            ("home at 47.397, 8.545", "home at xx.xxx, x.xxx"),
            ("wifi password hunter", "wifi password xxxxxx"),
            ("pass: hunter2 set", "pass: xxxxxxx xxx"),
            ("Serial: ab", "Serial: xx"),
            ("password is hunter", "password xx xxxxxx"),
            ("secret key hunter", "secret xxx xxxxxx"),
            ("key. hunter ... two", "key. xxxxxx ... xxx"),
            ("NET_PASS1=hunter", "NET_PASS1=xxxxxx"),
            ("S/N: ABCD", "S/N: xxxx"),
            ("at 47,3977 8,5456", "at xx,xxxx x,xxxx"),
            ("at 47 23 51.7 N 8 32 44.2 E", "at xx xx xx.x N x xx xx.x E"),
            ("N47 23.86", "xxx 23.86"),
            ("board 1234-5678-9012", "board xxxx-xxxx-xxxx"),
            ("ArduCopter V4.7.0-dev (c6ea8b1a)", "ArduCopter V4.7.0-dev (xxxxxxxx)"),
            ("zażółć", "xxxxxxxxxx"),
            ("abcdefghijklmnopqrstuvwxyz", "xxxxxxxxxxxxxxxxxxxxxxxxxx"),
        ] {
            assert_eq!(covered(said, Part::default()), shared);
        }
    }

    #[test]
    fn a_word_that_is_cut_in_two_is_covered_on_both_sides() {
        let first = Part { is_continued: false, goes_on: true };
        assert_eq!(covered("the key is hun", first), "the key xx xxx");
        let second = Part { is_continued: true, goes_on: false };
        assert_eq!(covered("ter two", second), "xxx xxx");
        // what stands behind the end of a text goes
        assert_eq!(covered("armed\0hunter", Part::default()), "armed\0\0\0\0\0\0\0");
    }
}
