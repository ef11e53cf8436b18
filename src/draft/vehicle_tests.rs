use super::*;
use crate::autopilot::Autopilot;
use crate::recording::{Quantity, Stream, StreamKey};

fn given(size_m: Option<f64>) -> Given {
    Given { mass_kg: 1.5, size_m, frame: None }
}

fn copter() -> Recording {
    let stated = [
        ("FRAME_CLASS", 1.0),
        ("FRAME_TYPE", 1.0),
        ("MOT_THST_EXPO", 0.6),
        ("MOT_THST_HOVER", 0.4),
        ("MOT_PWM_MIN", 1000.0),
        ("MOT_PWM_MAX", 2000.0),
        ("MOT_SPIN_MIN", 0.15),
        ("MOT_SPIN_MAX", 0.95),
    ];
    let parameters = stated.map(|(name, value)| (name.to_owned(), value)).into();
    Recording { parameters, autopilot: Autopilot::ArduPilot, ..Recording::default() }
}

fn relative(draft: &Draft, of: Guessed) -> Option<f64> {
    draft.vehicle.guesses.iter().find(|guess| guess.of == of).map(|guess| guess.relative)
}

#[test]
fn parameters_mass_and_size_make_a_vehicle() {
    let draft = draft(&copter(), &given(Some(0.5)), "drafted").unwrap();
    let vehicle = &draft.vehicle;
    // 0.25 m from the centre, at 45 degrees, front right
    let side_m = 0.25 / 2.0_f64.sqrt();
    assert!((vehicle.rotors[0].position_m - Vector3::new(side_m, -side_m, 0.0)).norm() < 1e-5);
    assert_eq!(vehicle.propulsion.actuator, Actuator::Pwm(Some(PwmRange { min_us: 1150.0, max_us: 1950.0 })));
    // hovers at 0.4 of the thrust of four rotors
    let ThrustLaw::Curve { thrust_max_n, expo } = vehicle.propulsion.law else { panic!("a curve") };
    assert!((thrust_max_n * 4.0 * 0.4 - 1.5 * 9.81).abs() < 1e-3 && expo == 0.6);
    assert_eq!(relative(&draft, Guessed::ThrustMax), Some(BY_HOVER_SHARE));
    assert_eq!(relative(&draft, Guessed::Arms), None);
    assert!(relative(&draft, Guessed::TorqueRatio).is_some_and(|relative| relative > 0.1));
}

#[test]
fn arms_that_nobody_states_are_a_guess() {
    let draft = draft(&copter(), &given(None), "drafted").unwrap();
    assert!(relative(&draft, Guessed::Arms).is_some());
}

#[test]
fn a_mass_that_does_not_go_with_the_size_is_doubted() {
    let doubts =
        |mass_kg, size_m| draft(&copter(), &Given { mass_kg, ..given(size_m) }, "drafted").unwrap().doubts;
    for (mass_kg, size_m) in [(20.0, 0.5), (200.0, 0.492), (0.15, 0.5)] {
        let said = doubts(mass_kg, Some(size_m)).join("; ");
        assert!(said.contains("does not go with --size"), "{mass_kg} kg, {size_m} m: {said}");
    }
    for (mass_kg, size_m) in [(1.5, 0.5), (0.03, 0.065), (0.8, 0.2), (60.0, 2.2), (2.5, 1.0)] {
        assert_eq!(doubts(mass_kg, Some(size_m)), Vec::<String>::new());
    }
    // arms by the rule of thumb contradict no mass
    assert_eq!(doubts(200.0, None), Vec::<String>::new());
}

#[test]
fn the_flight_says_the_thrust() {
    let key = |quantity, source| StreamKey { quantity, source, instance: 0 };
    let time_s: Vec<f64> = (0..400).map(|index| 0.01 * f64::from(index)).collect();
    // u = 0.5 and a little more in turn, on the ground before
    let pulse = |index: usize| if index < 100 { 1000.0 } else { 1550.0 + 2.0 * (index % 2) as f64 };
    let commands = (0..400).flat_map(|index| [pulse(index); 4]).collect();
    let felt = (0..400).flat_map(|index| [0.0, 0.0, 9.6 + 0.01 * f64::from(index % 2)]).collect();
    let mut recording = copter();
    recording.streams = [
        (
            key(Quantity::ActuatorCommand, "RCOU"),
            Stream { time_s: time_s.clone(), width: 4, values: commands },
        ),
        (key(Quantity::SpecificForce, "IMU"), Stream { time_s, width: 3, values: felt }),
    ]
    .into();
    let draft = draft(&recording, &given(Some(0.5)), "drafted").unwrap();
    let each_n = draft.vehicle.propulsion.thrust_from_command_n(0.501_25);
    assert!((4.0 * each_n / 1.5 - 9.6).abs() < 0.1, "{each_n}");
    assert!(relative(&draft, Guessed::ThrustMax).is_some_and(|relative| relative < 0.05));
}

#[test]
fn what_no_vehicle_is_is_refused() {
    assert!(draft(&copter(), &Given { mass_kg: 0.0, ..given(None) }, "drafted").is_err());
    assert!(draft(&copter(), &given(Some(f64::NAN)), "drafted").is_err());
    assert_eq!(draft(&Recording::default(), &given(None), "drafted"), Err(DraftError::Autopilot));
    let frame = Frame::of_id("quadrotor-x");
    let bare = draft(&Recording::default(), &Given { frame, ..given(Some(0.4)) }, "drafted").unwrap();
    assert_eq!((bare.vehicle.rotors.len(), relative(&bare, Guessed::Arms)), (4, None));
    assert!(relative(&bare, Guessed::ThrustMax).is_some_and(|relative| relative > 0.3));
    let mut heli = copter();
    heli.parameters.insert("FRAME_CLASS".to_owned(), 6.0);
    let frame = Frame::of_id("quadrotor-plus");
    assert!(draft(&heli, &Given { frame, ..given(None) }, "drafted").is_ok());
    assert!(matches!(draft(&heli, &given(None), "drafted"), Err(DraftError::Layout(_))));
}
