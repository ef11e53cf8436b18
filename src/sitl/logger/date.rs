//! Dates, as files are named by them.

/// Seconds of a day.
const DAY_S: u64 = 86_400;

/// Year, month, day, hour, minute and second of a time since 1970, UTC.
pub(super) fn date(unix_s: u64) -> [u64; 6] {
    let (mut days, rest) = (unix_s / DAY_S, unix_s % DAY_S);
    let is_leap =
        |year: u64| year.is_multiple_of(4) && (!year.is_multiple_of(100) || year.is_multiple_of(400));
    let mut year = 1970;
    while days >= 365 + u64::from(is_leap(year)) {
        days -= 365 + u64::from(is_leap(year));
        year += 1;
    }
    let lengths = [31, 28 + u64::from(is_leap(year)), 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
    let mut month = 1;
    for length in lengths {
        if days < length {
            break;
        }
        days -= length;
        month += 1;
    }
    [year, month, days + 1, rest / 3600, rest / 60 % 60, rest % 60]
}

#[cfg(test)]
mod tests {
    use super::date;

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(date(0), [1970, 1, 1, 0, 0, 0]);
        assert_eq!(date(951_782_400), [2000, 2, 29, 0, 0, 0]);
        assert_eq!(date(1_700_000_000), [2023, 11, 14, 22, 13, 20]);
        assert_eq!(date(4_107_542_399), [2100, 2, 28, 23, 59, 59]);
    }
}
