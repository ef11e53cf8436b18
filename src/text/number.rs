//! Numbers as people read them: rounded to what is known of them.

/// Digits after the point that show a standard error's one digit, or two where the first is a 1.
fn decimals(std: f64) -> i32 {
    let mut power = 0;
    while std * 10.0_f64.powi(power) < 1.95 && power < 12 {
        power += 1;
    }
    while std * 10.0_f64.powi(power) >= 19.5 && power > -9 {
        power -= 1;
    }
    power
}

pub(crate) fn rounded(value: f64, decimals: i32) -> String {
    let Ok(places) = usize::try_from(decimals) else {
        let unit = 10.0_f64.powi(-decimals);
        return format!("{:.0}", (value / unit).round() * unit);
    };
    let text = format!("{value:.places$}");
    // no minus before a zero
    if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
        text.trim_start_matches('-').to_owned()
    } else {
        text
    }
}

/// `0.412 +- 0.014`, both rounded to the standard error; small numbers with their power of ten. A standard
/// error of zero is a value that was set.
#[must_use]
pub fn with_error(value: f64, std: f64) -> String {
    if !(std > 0.0 && std.is_finite()) {
        return significant(value, 3);
    }
    let places = decimals(std);
    let largest = value.abs().max(std);
    if places > 5 && largest < 1e-2 {
        let power = exponent(largest);
        let scale = 10.0_f64.powi(-power);
        let (value, std, places) = (value * scale, std * scale, places + power);
        return format!("({} +- {})e{power}", rounded(value, places), rounded(std, places));
    }
    format!("{} +- {}", rounded(value, places), rounded(std, places))
}

/// `0.78 to 0.84`: the ends of an interval, rounded to the standard error that it is of.
#[must_use]
pub fn interval([low, high]: [f64; 2], std: f64) -> String {
    let places = decimals(std);
    let end = |end: f64| if places > 5 { significant(end, 3) } else { rounded(end, places) };
    format!("{} to {}", end(low), end(high))
}

/// A value with so many digits that it differs from one which is `step` larger.
#[must_use]
pub fn to_step(value: f64, step: f64) -> String {
    rounded(value, decimals(step))
}

/// At most four significant digits, without zeros at the end.
#[must_use]
pub fn compact(value: f64) -> String {
    let short = format!("{value:.3e}").parse::<f64>().unwrap_or(value);
    short.to_string()
}

/// A parameter of an autopilot in the fewest digits that give its value again: its messages hold single precision.
#[must_use]
pub fn parameter_value(value: f64) -> String {
    let exact = value.to_string();
    let single = exact.parse::<f32>().ok().filter(|single| f64::from(*single) == value);
    single.map_or(exact, |single| single.to_string())
}

/// As many significant digits; without power of ten between 1e-4 and 1e6.
#[must_use]
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "-".to_owned();
    }
    let mut power = exponent(value.abs());
    // 0.0999 to two digits is 0.10
    if rounded(value.abs() * 10.0_f64.powi(-power), digits - 1).starts_with("10") {
        power += 1;
    }
    if !(-4..6).contains(&power) {
        let scaled = value * 10.0_f64.powi(-power);
        return format!("{}e{power}", rounded(scaled, digits - 1));
    }
    rounded(value, (digits - 1 - power).max(0))
}

/// Power of ten of a positive number's first digit.
fn exponent(value: f64) -> i32 {
    let mut power = 0;
    while value * 10.0_f64.powi(-power) >= 10.0 && power < 300 {
        power += 1;
    }
    while value * 10.0_f64.powi(-power) < 1.0 && power > -300 {
        power -= 1;
    }
    power
}

/// A chance as people read it: what is beyond the range of floating point is said to be below it.
#[must_use]
pub fn chance(p: f64) -> String {
    if p < 1e-300 { "below 1e-300".to_owned() } else { significant(p, 1) }
}

/// Units as they are said: `N per m/s`.
#[must_use]
pub fn spoken(unit: &str) -> String {
    match unit {
        "-" => String::new(),
        "N/(m/s)" => "N per m/s".to_owned(),
        "N/(m/s)^2" => "N per (m/s)^2".to_owned(),
        "N m/(rad/s)" => "N m per rad/s".to_owned(),
        "N m/(m/s)" => "N m per m/s".to_owned(),
        other => other.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends_of_an_interval_are_rounded_as_their_error_is() {
        assert_eq!(interval([0.77664, 0.83936], 0.016), "0.777 to 0.839");
        assert_eq!(interval([-0.021, 0.0301], 0.03), "-0.02 to 0.03");
        assert_eq!(interval([2.04e-7, 3.96e-7], 5e-8), "2.04e-7 to 3.96e-7");
    }

    #[test]
    fn values_that_a_step_parts_are_told_apart() {
        assert_eq!([30.07, 31.44].map(|value| to_step(value, 1.37)), ["30.1", "31.4"]);
        assert_eq!([0.4, 0.8].map(|value| to_step(value, 0.4)), ["0.4", "0.8"]);
        assert_eq!([100.0, 150.0].map(|value| to_step(value, 50.0)), ["100", "150"]);
    }

    #[test]
    fn values_are_rounded_to_their_standard_error() {
        assert_eq!(with_error(0.4123, 0.0204), "0.41 +- 0.02");
        assert_eq!(with_error(0.4123, 0.0140), "0.412 +- 0.014");
        assert_eq!(with_error(-8.98, 0.043), "-8.98 +- 0.04");
        assert_eq!(with_error(1234.5, 37.0), "1230 +- 40");
        assert_eq!(with_error(2.04e-5, 1.1e-6), "(2.04 +- 0.11)e-5");
        assert_eq!(with_error(-0.001, 0.3), "0.0 +- 0.3");
        assert_eq!(with_error(24.0, 0.0), "24.0");
    }

    #[test]
    fn a_parameter_has_the_digits_that_it_was_set_with() {
        let values = [f64::from(0.15_f32), 100.0, -0.25, 176_126.0, 0.1];
        assert_eq!(values.map(parameter_value), ["0.15", "100", "-0.25", "176126", "0.1"]);
    }

    #[test]
    fn significant_digits() {
        assert_eq!(significant(0.005_64, 2), "0.0056");
        assert_eq!(significant(49.3, 2), "49");
        assert_eq!(significant(1.7e-6, 2), "1.7e-6");
        assert_eq!(significant(0.0, 2), "0");
        assert_eq!(significant(0.099_99, 2), "0.10");
        assert_eq!(significant(9.96, 2), "10");
    }
}
