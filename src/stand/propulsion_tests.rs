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
        "Time (s),ESC signal (\u{b5}s),Thrust (N),Torque (N\u{b7}m),Motor Optical Speed (RPM)\n".to_owned();
    for row in 0..400_u32 {
        let step = f64::from(if row < 200 { row / 10 } else { (399 - row) / 10 });
        let u = 0.05 + 0.05 * step;
        let thrust = 12.0 * (0.3 * u + 0.7 * u * u) * if row < 200 { 1.0 } else { down };
        let scatter = 0.05 * (f64::from(row) * 1.7).sin();
        let rpm = (thrust / 1.1e-5).sqrt() / rad_s_from_rpm(1.0);
        text += &format!("{},{},{},{},{rpm}\n", row, 1000.0 + 1000.0 * u, thrust + scatter, -0.016 * thrust);
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
    assert_eq!(result.measured, [Guessed::ThrustMax, Guessed::Expo, Guessed::TorqueRatio]);
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
    assert!(said(&format!("ESC signal (us),Thrust (N)\n{pulses}")).contains("commands from 1000 to 2000 us"));
    let fast = rows(|n| format!("{},{}\n", 1e6 * n, n));
    assert!(said(&format!("RPM,Thrust (N)\n{fast}")).contains("rotor speeds up to"));
}

#[test]
fn rows_outside_of_the_vehicles_commands_are_told() {
    let range = PwmRange { min_us: 1150.0, max_us: 1950.0 };
    let stated = Propulsion { actuator: Actuator::Pwm(Some(range)), ..STATED };
    let text = "Throttle (%),Thrust (N)\n10,0.4\n20,1.0\n40,3.1\n60,6.2\n80,10.1\n100,15.0\n";
    let why = measured_propulsion(&parse_table(text).unwrap(), &stated).unwrap_err().to_string();
    let told = "2 of 6 rows have commands outside of the vehicle's, 1150 to 1950 us, and are left out";
    assert!(why.contains(&format!("got 4: {told}")), "{why}");
    let more = text.replace("60,6.2", "50,4.5\n60,6.2");
    let sentences = measured_propulsion(&parse_table(&more).unwrap(), &stated).unwrap().sentences;
    assert!(
        sentences.iter().any(|said| said.starts_with("2 of 7 rows have commands outside")),
        "{sentences:?}"
    );
}
