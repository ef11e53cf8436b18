//! Thrust curve, thrust coefficient and torque per thrust of one rotor, from what a stand measured.

use super::StandError;
use super::fit::{Fit, Measured};
use super::steps::{Steps, median};
use super::table::StandTable;
use crate::units::rad_s_from_rpm;
use crate::vehicle::{Actuator, Guessed, Propulsion, PwmRange, ThrustLaw};

/// States of the rotor that a fit needs. The law has two parameters and its misfit needs three more.
const LEAST_STEPS: usize = 5;
/// Share of the squares that a law must explain: a rotor's does 0.99 and more. Less is a table of something else.
const LEAST_EXPLAINED: f64 = 0.95;
/// Thrust below this share of the largest is not used: speeds are read badly there, and the scales' offset matters.
/// The rest of the range tells the law.
const LEAST_SHARE: f64 = 0.03;
/// Largest thrusts of one rotor, N; largest speed, rad/s; torque per thrust, m. Beyond stands a wrong unit.
const THRUSTS_N: (f64, f64) = (0.005, 5000.0);
/// See [`THRUSTS_N`].
const SPEED_MOST_RPM: f64 = 150_000.0;
/// See [`THRUSTS_N`].
const RATIOS_M: (f64, f64) = (2e-4, 0.3);
/// Rising and falling thrust that differ by more are told. Only a note depends on it.
const HYSTERESIS: f64 = 0.03;
/// Standard error of the exponent of the voltage with which it is known. A larger one says nothing: exponents lie
/// between 1 and 2.
const VOLTAGE_STD: f64 = 0.5;
/// Pulses of none and of full throttle, where commands are pulses and shares are stated, or the reverse.
const PULSES: PwmRange = PwmRange { min_us: 1000.0, max_us: 2000.0 };

/// What a stand says of a rotor.
#[derive(Debug, Clone, PartialEq)]
pub struct StandResult {
    /// with what was measured in place of what was stated
    pub propulsion: Propulsion,
    /// what is no guess any more
    pub measured: Vec<Guessed>,
    /// what was measured and how well, what lacks, what is odd: sentence by sentence
    pub sentences: Vec<String>,
}

/// What a stand measured, in place of what is stated of the rotors.
///
/// # Errors
/// [`StandError::Rows`] where the rows are too few, or say what no rotor does.
pub fn measured_propulsion(table: &StandTable, stated: &Propulsion) -> Result<StandResult, StandError> {
    let most_n = table.thrust_n.iter().copied().filter(|thrust| thrust.is_finite()).fold(0.0, f64::max);
    if !(THRUSTS_N.0..=THRUSTS_N.1).contains(&most_n) {
        let (least, most) = THRUSTS_N;
        return Err(rows(format!("a largest thrust of {least} to {most} N"), format!("{most_n:.4} N")));
    }
    let mut result = StandResult { propulsion: *stated, measured: Vec::new(), sentences: Vec::new() };
    let used = Used { table, least_n: LEAST_SHARE * most_n };
    result.curve(&used)?;
    result.coefficient(&used)?;
    result.torque(&used)?;
    result.sentences.extend(table.missing.iter().map(|lacks| (*lacks).to_owned()));
    if table.rows_left_out > 0 {
        result.sentences.push(format!("{} rows without a number left out", table.rows_left_out));
    }
    Ok(result)
}

fn rows(expected: String, came: String) -> StandError {
    StandError::Rows { expected, came }
}

/// What a law over too few states expects.
fn too_few(what: &str) -> String {
    format!("rows of at least {LEAST_STEPS} states of the rotor for {what}")
}

/// The name of the law in sentences.
const CURVE: &str = "the thrust curve";

/// A table's commands as shares of the vehicle's range. The law is of commands in 0..1: what a stand measures outside of them
/// would bend it, and is no number here.
fn commands(table: &StandTable, range: PwmRange) -> Result<Vec<f64>, StandError> {
    let pulse_us = |command: &f64| {
        if table.is_pulse { *command } else { PULSES.min_us + command * (PULSES.max_us - PULSES.min_us) }
    };
    let pulses: Vec<f64> = table.command.iter().map(pulse_us).collect();
    let shares: Vec<f64> =
        pulses.iter().map(|pulse| (pulse - range.min_us) / (range.max_us - range.min_us)).collect();
    let inside = shares.iter().filter(|u| (-0.3..=1.3).contains(*u)).count();
    if 2 * inside < shares.iter().filter(|u| u.is_finite()).count() {
        let expected = format!("commands from {:.0} to {:.0} us", range.min_us, range.max_us);
        return Err(rows(expected, format!("{:.4} in the middle", median(finite(&pulses)))));
    }
    let within = |u: f64| if (0.0..=1.0).contains(&u) { u } else { f64::NAN };
    Ok(shares.into_iter().map(within).collect())
}

/// Pulses of none and of full command.
fn range_of(actuator: Actuator) -> PwmRange {
    match actuator {
        Actuator::Pwm(Some(range)) => range,
        _ => PULSES,
    }
}

/// Rows whose command is a number outside of the vehicle's range, in words; `None` without any.
fn outside(table: &StandTable, within: &[f64], range: PwmRange) -> Option<String> {
    let rows = table.command.iter().zip(within).filter(|(command, u)| command.is_finite() && u.is_nan());
    let count = rows.count();
    (count > 0).then(|| {
        format!(
            "{count} of {} rows have commands outside of the vehicle's, {:.0} to {:.0} us, and are left out",
            table.command.len(),
            range.min_us,
            range.max_us
        )
    })
}

/// Thrust at full command, N, and the exponent of the curve, from the law's linear and quadratic parts.
fn full_and_exponent(fit: &Fit) -> (Measured, Measured) {
    let [linear, quadratic] = [fit.values[0], fit.values[1]];
    let full = linear + quadratic;
    let c = &fit.covariance;
    let full_std = (c[(0, 0)] + c[(1, 1)] + 2.0 * c[(0, 1)]).max(0.0).sqrt();
    // d expo / d linear, d expo / d quadratic
    let (by_linear, by_quadratic) = (-quadratic / (full * full), linear / (full * full));
    let variance = by_linear * by_linear * c[(0, 0)]
        + by_quadratic * by_quadratic * c[(1, 1)]
        + 2.0 * by_linear * by_quadratic * c[(0, 1)];
    let expo = Measured { value: quadratic / full, std: variance.max(0.0).sqrt() };
    (Measured { value: full, std: full_std }, expo)
}

/// The rows with enough thrust.
struct Used<'a> {
    table: &'a StandTable,
    least_n: f64,
}

impl Used<'_> {
    /// A column, without the rows of little thrust.
    fn of(&self, column: &[f64]) -> Vec<f64> {
        let kept = |(value, thrust): (&f64, &f64)| if *thrust >= self.least_n { *value } else { f64::NAN };
        column.iter().zip(&self.table.thrust_n).map(kept).collect()
    }

    fn any(&self, column: &[f64]) -> bool {
        self.of(column).iter().any(|value| value.is_finite())
    }

    /// Means of states by the first column, with the thrust as the last.
    fn steps(&self, columns: &[&[f64]]) -> Steps {
        let columns: Vec<Vec<f64>> = columns.iter().map(|column| self.of(column)).collect();
        let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
        Steps::of(&columns)
    }
}

impl StandResult {
    /// A law over states: refused where they are too few, or it does not explain them.
    fn law(
        &mut self,
        what: &str,
        steps: &Steps,
        columns: &[Vec<f64>],
        wanted: &[f64],
    ) -> Result<Fit, StandError> {
        if steps.len() < LEAST_STEPS {
            return Err(rows(too_few(what), steps.len().to_string()));
        }
        let fit = Fit::of(columns, wanted).filter(|fit| fit.explained >= LEAST_EXPLAINED);
        let Some(fit) = fit else {
            let came = "rows that it does not explain: is a unit or a column wrong?".to_owned();
            return Err(rows(
                format!("{what} that explains {:.0} % of the rows", 100.0 * LEAST_EXPLAINED),
                came,
            ));
        };
        if steps.outliers > 0 {
            let of = steps.outliers + steps.rows;
            self.sentences.push(format!("{what}: {} of {of} rows left out as outliers", steps.outliers));
        }
        Ok(fit)
    }

    /// `T = thrust_max ((1 - expo) u + expo u^2)`.
    fn curve(&mut self, used: &Used<'_>) -> Result<(), StandError> {
        let table = used.table;
        if !used.any(&table.command) {
            return Ok(());
        }
        let range = range_of(self.propulsion.actuator);
        let commands = commands(table, range)?;
        let outside = outside(table, &commands, range);
        let steps = used.steps(&[&commands, &table.thrust_n]);
        if let Some(outside) = outside.as_ref().filter(|_| steps.len() < LEAST_STEPS) {
            return Err(rows(too_few(CURVE), format!("{}: {outside}", steps.len())));
        }
        self.sentences.extend(outside);
        let (u, thrust) = (&steps.means[0], &steps.means[1]);
        let square: Vec<f64> = u.iter().map(|u| u * u).collect();
        let fit = self.law(CURVE, &steps, &[u.clone(), square.clone()], thrust)?;
        let [linear, quadratic] = [fit.values[0], fit.values[1]];
        let bent = quadratic / (linear + quadratic);
        let (full, expo) = if (0.0..=1.0).contains(&bent) {
            full_and_exponent(&fit)
        } else {
            let (nearest, column) = if bent < 0.0 { (0.0, u.clone()) } else { (1.0, square) };
            let bound = self.law(CURVE, &steps, &[column], thrust)?;
            self.sentences.push(format!(
                "the thrust bends more than a vehicle file can state (exponent {bent:.2}): {nearest} is taken; are the \
                 commands of the stand in the vehicle's range of pulses?"
            ));
            (bound.measured(0), Measured { value: nearest, std: 0.0 })
        };
        if full.value <= 0.0 {
            return Err(rows(
                "thrust that grows with the command".to_owned(),
                "thrust that falls".to_owned(),
            ));
        }
        self.propulsion.law =
            ThrustLaw::Curve { thrust_max_n: rounded(full.value), expo: rounded(expo.value) };
        self.measured.extend([Guessed::ThrustMax, Guessed::Expo]);
        self.sentences.push(format!(
            "thrust at full command {:.3} +- {:.3} N, exponent of its curve {:.3} +- {:.3}, over commands of {:.0} to {:.0} %",
            full.value,
            full.std,
            expo.value,
            expo.std,
            100.0 * u.iter().copied().fold(f64::INFINITY, f64::min),
            100.0 * u.iter().copied().fold(f64::NEG_INFINITY, f64::max)
        ));
        self.sentences.extend(hysteresis(&commands, &table.thrust_n, |u| linear * u + quadratic * u * u));
        self.sentences.extend(voltage(used, &commands));
        Ok(())
    }

    /// `T = k Omega^2`.
    fn coefficient(&mut self, used: &Used<'_>) -> Result<(), StandError> {
        let table = used.table;
        if !used.any(&table.speed_rad_s) {
            return Ok(());
        }
        let most =
            used.of(&table.speed_rad_s).into_iter().filter(|speed| speed.is_finite()).fold(0.0, f64::max);
        if most > rad_s_from_rpm(SPEED_MOST_RPM) {
            let came = format!("{:.0} rpm", most / rad_s_from_rpm(1.0));
            return Err(rows(format!("rotor speeds up to {SPEED_MOST_RPM} rpm"), came));
        }
        let steps = used.steps(&[&table.speed_rad_s, &table.thrust_n]);
        let square: Vec<f64> = steps.means[0].iter().map(|speed| speed * speed).collect();
        let fit = self.law("the thrust coefficient", &steps, &[square], &steps.means[1])?;
        let Measured { value, std } = fit.measured(0);
        self.propulsion.thrust_coefficient = Some(rounded(value));
        self.sentences.push(format!("thrust coefficient {value:.4e} +- {std:.1e} N/(rad/s)^2"));
        Ok(())
    }

    /// `Q = c T`.
    fn torque(&mut self, used: &Used<'_>) -> Result<(), StandError> {
        let table = used.table;
        if !used.any(&table.torque_nm) {
            return Ok(());
        }
        let steps = used.steps(&[&table.thrust_n, &table.torque_nm]);
        let fit = self.law("the torque per thrust", &steps, &[steps.means[0].clone()], &steps.means[1])?;
        let Measured { value, std } = fit.measured(0);
        let (least, most) = RATIOS_M;
        if !(least..=most).contains(&value) {
            return Err(rows(
                format!("a torque per thrust of {least} to {most} N m per N"),
                format!("{value:.3e}"),
            ));
        }
        self.propulsion.torque_per_thrust_m = rounded(value);
        self.measured.push(Guessed::TorqueRatio);
        self.sentences.push(format!("torque per thrust {value:.5} +- {std:.5} m"));
        Ok(())
    }
}

fn finite(values: &[f64]) -> Vec<f64> {
    values.iter().copied().filter(|value| value.is_finite()).collect()
}

/// To five significant digits: none of it is known better, and files are read by people.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse::<f64>().unwrap_or(value)
}

/// Whether the thrust is another while the command rises than while it falls.
fn hysteresis(commands: &[f64], thrust_n: &[f64], law: impl Fn(f64) -> f64) -> Option<String> {
    let (mut last, mut rises) = (f64::NAN, None);
    let (mut up, mut down) = (Vec::new(), Vec::new());
    for (u, thrust) in commands.iter().zip(thrust_n).filter(|(u, thrust)| u.is_finite() && thrust.is_finite())
    {
        if last.is_finite() && (u - last).abs() > 1e-4 {
            rises = Some(*u > last);
        }
        last = *u;
        let share = thrust / law(*u);
        if *u > 0.2 && share.is_finite() {
            match rises {
                Some(true) => up.push(share),
                Some(false) => down.push(share),
                None => {}
            }
        }
    }
    if up.len() < LEAST_STEPS || down.len() < LEAST_STEPS {
        return None;
    }
    let less = median(up) / median(down) - 1.0;
    (less.abs() > HYSTERESIS).then(|| {
        format!(
            "thrust is {:.1} % {} while the command rises than while it falls: a battery that sags, or a motor that warms; \
             the mean is taken",
            100.0 * less.abs(),
            if less > 0.0 { "larger" } else { "smaller" }
        )
    })
}

/// How thrust goes with the voltage, where that moved by itself.
fn voltage(used: &Used<'_>, commands: &[f64]) -> Option<String> {
    let table = used.table;
    if !used.any(&table.voltage_v) {
        return None;
    }
    let rows: Vec<[f64; 3]> = commands
        .iter()
        .zip(used.of(&table.voltage_v))
        .zip(used.of(&table.thrust_n))
        .map(|((u, volts), thrust)| [*u, volts, thrust])
        .filter(|row| row.iter().all(|value| value.is_finite() && *value > 0.0))
        .collect();
    let column = |of: fn(&[f64; 3]) -> f64| rows.iter().map(of).collect::<Vec<f64>>();
    let columns = [
        column(|_| 1.0),
        column(|row| row[0].ln()),
        column(|row| row[0].ln().powi(2)),
        column(|row| row[1].ln()),
    ];
    let known = Fit::of(&columns, &column(|row| row[2].ln())).map(|fit| fit.measured(3));
    match known.filter(|known| known.std < VOLTAGE_STD) {
        Some(Measured { value, std }) => {
            let volts = median(rows.iter().map(|row| row[1]).collect());
            Some(format!(
                "thrust goes with the voltage to the power of {value:.2} +- {std:.2}, about {volts:.2} V; the file states that of \
                 the test"
            ))
        }
        None => {
            Some("the voltage went with the command: its own effect on thrust is not determined".to_owned())
        }
    }
}

#[cfg(test)]
#[path = "propulsion_tests.rs"]
mod tests;
