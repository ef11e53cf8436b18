//! Thrust curve, thrust coefficient and torque per thrust of one rotor, from what a stand measured.

use super::StandError;
use super::fit::{Fit, Measured};
use super::steps::{Steps, median};
use super::table::StandTable;
use crate::units::rad_s_from_rpm;
use crate::vehicle::{Actuator, Guessed, Propulsion, PwmRange, ThrustLaw};

/// States of the rotor that a fit needs. Chosen.
const LEAST_STEPS: usize = 5;
/// Share of the squares that a law must explain: a rotor's does 0.99 and more. Chosen.
const LEAST_EXPLAINED: f64 = 0.95;
/// Thrust below this share of the largest is not used: speeds are read badly there, and the scales' offset matters.
const LEAST_SHARE: f64 = 0.03;
/// Largest thrusts of one rotor, N; largest speed, rad/s; torque per thrust, m. Beyond stands a wrong unit.
const THRUSTS_N: (f64, f64) = (0.005, 5000.0);
/// See [`THRUSTS_N`].
const SPEED_MOST_RPM: f64 = 150_000.0;
/// See [`THRUSTS_N`].
const RATIOS_M: (f64, f64) = (2e-4, 0.3);
/// Rising and falling thrust that differ by more are told. Chosen.
const HYSTERESIS: f64 = 0.03;
/// Standard error of the exponent of the voltage with which it is known. Chosen.
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
            let expected = format!("rows of at least {LEAST_STEPS} states of the rotor for {what}");
            return Err(rows(expected, steps.len().to_string()));
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
        let range = match self.propulsion.actuator {
            Actuator::Pwm(Some(range)) => range,
            _ => PULSES,
        };
        let pulses: Vec<f64> = if table.is_pulse {
            table.command.clone()
        } else {
            table
                .command
                .iter()
                .map(|share| PULSES.min_us + share * (PULSES.max_us - PULSES.min_us))
                .collect()
        };
        let commands: Vec<f64> =
            pulses.iter().map(|pulse| (pulse - range.min_us) / (range.max_us - range.min_us)).collect();
        let inside = commands.iter().filter(|u| (-0.3..=1.3).contains(*u)).count();
        if 2 * inside < commands.iter().filter(|u| u.is_finite()).count() {
            let expected = format!("commands from {:.0} to {:.0} us", range.min_us, range.max_us);
            return Err(rows(expected, format!("{:.4} in the middle", median(finite(&pulses)))));
        }
        // the law is of commands in 0..1: what a stand measures outside of the vehicle's range bends it
        let within = |u: &f64| if (0.0..=1.0).contains(u) { *u } else { f64::NAN };
        let commands: Vec<f64> = commands.iter().map(within).collect();
        let steps = used.steps(&[&commands, &table.thrust_n]);
        let (u, thrust) = (&steps.means[0], &steps.means[1]);
        let square: Vec<f64> = u.iter().map(|u| u * u).collect();
        let what = "the thrust curve";
        let fit = self.law(what, &steps, &[u.clone(), square.clone()], thrust)?;
        let [linear, quadratic] = [fit.values[0], fit.values[1]];
        let full = linear + quadratic;
        let expo = quadratic / full;
        let (full, expo) = if (0.0..=1.0).contains(&expo) {
            let c = &fit.covariance;
            let full_std = (c[(0, 0)] + c[(1, 1)] + 2.0 * c[(0, 1)]).max(0.0).sqrt();
            // d expo / d linear, d expo / d quadratic
            let (by_linear, by_quadratic) = (-quadratic / (full * full), linear / (full * full));
            let variance = by_linear * by_linear * c[(0, 0)]
                + by_quadratic * by_quadratic * c[(1, 1)]
                + 2.0 * by_linear * by_quadratic * c[(0, 1)];
            (Measured { value: full, std: full_std }, Measured { value: expo, std: variance.max(0.0).sqrt() })
        } else {
            let nearest = if expo < 0.0 { 0.0 } else { 1.0 };
            let column = if expo < 0.0 { u.clone() } else { square };
            let bound = self.law(what, &steps, &[column], thrust)?;
            self.sentences.push(format!(
                "the thrust bends more than a vehicle file can state (exponent {expo:.2}): {nearest} is taken; are the \
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
        self.measured.extend([Guessed::ThrustMax, Guessed::ThrustCurve]);
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
mod tests {
    use super::*;
    use crate::stand::parse_table;

    const STATED: Propulsion = Propulsion {
        actuator: Actuator::Pwm(Some(PwmRange { min_us: 1000.0, max_us: 2000.0 })),
        law: ThrustLaw::Curve { thrust_max_n: 1.0, expo: 0.0 },
        thrust_coefficient: None,
        torque_per_thrust_m: 0.02,
        rotor_radius_m: None,
        time_constant_s: None,
        time_constant_down_s: None,
    };

    /// A rotor of 12 N at full command, exponent 0.7, 1.1e-5 N/(rad/s)^2 and 0.016 m, with scales that scatter by 0.05 N, up
    /// and down again; `down` multiplies the thrust on the way down.
    fn table(down: f64) -> String {
        let mut text =
            "Time (s),ESC signal (\u{b5}s),Thrust (N),Torque (N\u{b7}m),Motor Optical Speed (RPM)\n"
                .to_owned();
        for row in 0..400_u32 {
            let step = f64::from(if row < 200 { row / 10 } else { (399 - row) / 10 });
            let u = 0.05 + 0.05 * step;
            let thrust = 12.0 * (0.3 * u + 0.7 * u * u) * if row < 200 { 1.0 } else { down };
            let scatter = 0.05 * (f64::from(row) * 1.7).sin();
            let rpm = (thrust / 1.1e-5).sqrt() / rad_s_from_rpm(1.0);
            text +=
                &format!("{},{},{},{},{rpm}\n", row, 1000.0 + 1000.0 * u, thrust + scatter, -0.016 * thrust);
        }
        text
    }

    #[test]
    fn curve_coefficient_and_torque_come_out_with_their_errors() {
        let result = measured_propulsion(&parse_table(&table(1.0)).unwrap(), &STATED).unwrap();
        let ThrustLaw::Curve { thrust_max_n, expo } = result.propulsion.law else { panic!("a curve") };
        assert!((thrust_max_n - 12.0).abs() < 0.1 && (expo - 0.7).abs() < 0.03, "{result:?}");
        let coefficient = result.propulsion.thrust_coefficient.unwrap();
        assert!((coefficient / 1.1e-5 - 1.0).abs() < 0.01, "{coefficient}");
        assert!((result.propulsion.torque_per_thrust_m - 0.016).abs() < 2e-4);
        assert_eq!(result.measured, [Guessed::ThrustMax, Guessed::ThrustCurve, Guessed::TorqueRatio]);
        assert!(result.sentences.iter().any(|said| said.starts_with("no voltage")), "{:?}", result.sentences);
        assert!(!result.sentences.iter().any(|said| said.contains("falls")), "{:?}", result.sentences);
    }

    #[test]
    fn commands_outside_of_the_vehicles_range_do_not_bend_the_curve() {
        // the vehicle's commands begin where the stand's rotor turns already
        let range = PwmRange { min_us: 1150.0, max_us: 1950.0 };
        let stated = Propulsion { actuator: Actuator::Pwm(Some(range)), ..STATED };
        let curve = |u: f64| 10.0 * (0.4 * u + 0.6 * u * u);
        let row = |pulse: f64| {
            let u = (pulse - 1150.0) / 800.0;
            format!("{pulse},{}\n", if u > 0.0 { curve(u) } else { 0.4 })
        };
        let rows: String = (0..100).map(|row| 1000.0 + 10.0 * f64::from(row)).map(row).collect();
        let table = parse_table(&format!("ESC (us),Thrust (N)\n{rows}")).unwrap();
        let result = measured_propulsion(&table, &stated).unwrap();
        let ThrustLaw::Curve { thrust_max_n, expo } = result.propulsion.law else { panic!("a curve") };
        assert!((thrust_max_n - 10.0).abs() < 0.02 && (expo - 0.6).abs() < 0.01, "{result:?}");
    }

    #[test]
    fn what_is_odd_is_told() {
        let result = measured_propulsion(&parse_table(&table(0.9)).unwrap(), &STATED).unwrap();
        assert!(
            result.sentences.iter().any(|said| said.contains("larger while the command rises")),
            "{result:?}"
        );
    }

    #[test]
    fn what_no_rotor_does_is_refused() {
        let said = |text: &str| {
            let table = parse_table(text).unwrap();
            measured_propulsion(&table, &STATED).unwrap_err().to_string()
        };
        assert!(said("Throttle (%),Thrust (N)\n10,1\n20,2\n").contains("at least 5 states"));
        assert!(said("Throttle (%),Thrust (N)\n10,0\n").contains("a largest thrust of"));
        let rows = |row: fn(f64) -> String| (1..=20).map(|n| row(f64::from(n))).collect::<String>();
        let alike = rows(|n| format!("{},{}\n", 5.0 * n, if n % 2.0 == 0.0 { 9.0 } else { 1.0 }));
        assert!(said(&format!("Throttle (%),Thrust (N)\n{alike}")).contains("does not explain"));
        let ratio = rows(|n| format!("{},{},{}\n", 5.0 * n, n, n));
        assert!(
            said(&format!("Throttle (%),Thrust (N),Torque (Nm)\n{ratio}")).contains("a torque per thrust of")
        );
        let pulses = rows(|n| format!("{},{}\n", 5000.0 + n, n));
        assert!(
            said(&format!("ESC signal (us),Thrust (N)\n{pulses}")).contains("commands from 1000 to 2000 us")
        );
        let fast = rows(|n| format!("{},{}\n", 1e6 * n, n));
        assert!(said(&format!("RPM,Thrust (N)\n{fast}")).contains("rotor speeds up to"));
    }
}
