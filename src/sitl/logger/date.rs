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

/// The week, and the milliseconds of it, of a time in microseconds since 1970, as GPS counts: from 1980-01-06 on, without leap
/// seconds. There have been 18 since 2017.
pub(super) fn gps_time(unix_us: u64) -> [f64; 2] {
    const BEGAN_S: u64 = 315_964_800;
    const LEAP_S: u64 = 18;
    const WEEK_MS: u64 = 7 * DAY_S * 1000;
    let since_ms = (unix_us / 1000).saturating_sub(1000 * (BEGAN_S - LEAP_S));
    [(since_ms / WEEK_MS) as f64, (since_ms % WEEK_MS) as f64]
}

#[cfg(test)]
mod tests {
    use super::{date, gps_time};

    #[test]
    fn weeks_are_those_of_gps() {
        // 2023-11-14 22:13:20 UTC is a Tuesday
        let of_week_s = (2 * 24 + 22) * 3600 + 13 * 60 + 20 + 18;
        assert_eq!(gps_time(1_700_000_000_000_000), [2288.0, 1e3 * f64::from(of_week_s)]);
    }

    #[test]
    fn dates_are_those_of_the_calendar() {
        assert_eq!(date(0), [1970, 1, 1, 0, 0, 0]);
        assert_eq!(date(951_782_400), [2000, 2, 29, 0, 0, 0]);
        assert_eq!(date(1_700_000_000), [2023, 11, 14, 22, 13, 20]);
        assert_eq!(date(4_107_542_399), [2100, 2, 28, 23, 59, 59]);
    }
}
