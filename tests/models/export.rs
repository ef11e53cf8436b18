//! A model for other simulators: values by hand, and every file read back.

use mavid::autopilot::Autopilot;
use mavid::diagnose::called;
use mavid::export::{Exported, Format, PLACES, aircraft_parameters, export, places};
use mavid::physics::ActiveEffect;
use mavid::physics::effects::{ALL, by_id};
use mavid::vehicle::{ThrustLaw, Vehicle};

fn vehicle() -> Vehicle {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml");
    let mut vehicle = mavid::config::load_vehicle(&path).unwrap();
    vehicle.body.inertia_kg_m2[(0, 1)] = 0.001;
    vehicle.body.inertia_kg_m2[(1, 0)] = 0.001;
    vehicle.body.inertia_kg_m2[(1, 2)] = 0.002;
    vehicle.body.inertia_kg_m2[(2, 1)] = 0.002;
    vehicle
}

fn effect(id: &str, values: &[f64]) -> ActiveEffect {
    ActiveEffect::new(by_id(id).unwrap(), values).unwrap()
}

fn parameter(text: &str, name: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with(&format!("param set {name} "))).unwrap();
    line.rsplit(' ').next().unwrap().parse().unwrap()
}

#[test]
fn px4_has_its_frame_and_the_thrust_of_full_command() {
    let vehicle = vehicle();
    let effects = [effect("linear_drag", &[0.3, 0.3, 0.3]), effect("thrust_tilt", &[0.02, 0.0])];
    let exported = export(&vehicle, &effects, None, Format::Px4Sih).unwrap();
    let value = |name| parameter(&exported.text, name);
    assert!((value("SIH_MASS") - vehicle.body.mass_kg).abs() < 1e-6);
    // y and z turn about: xy changes sign, yz does not
    assert!((value("SIH_IXY") + 0.001).abs() < 1e-9 && (value("SIH_IYZ") - 0.002).abs() < 1e-9);
    assert!((value("SIH_KDV") - 0.3).abs() < 1e-9);
    // the hubs move as the vehicle turns: 0.3 N/(m/s) at 0.174 m in x and y and 0.0581 m in z
    let (across, up): (f64, f64) = (0.174, 0.06 - 0.0019);
    let damping = 0.3 * (2.0 * (across * across + up * up) + 2.0 * across * across) / 3.0;
    assert!((value("SIH_KDW") - damping).abs() < 1e-7);
    let full = vehicle.propulsion.full_thrust_n();
    assert!((value("SIH_T_MAX") / full - 1.0).abs() < 1e-6 && value("THR_MDL_FAC") == 0.0);
    let hover = vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0;
    assert!((value("MPC_THR_HOVER") * full / hover - 1.0).abs() < 1e-6);
    // 12.5 ms up, 25 ms down
    assert!((value("SIH_T_TAU") - 0.01875).abs() < 1e-9);
    assert!(value("IMU_GYRO_RATEMAX") == 1000.0 && value("IMU_INTEG_RATE") == 1000.0);
    for told in ["thrust_max", "12.5", "centre of mass"].map(|part| part.replace("12.5", "0.0125")) {
        assert!(exported.left_out.iter().any(|note| note.contains(&told)), "{told}: {:?}", exported.left_out);
    }
    assert!(
        exported.left_out.iter().any(|note| note.contains("a tilted thrust axis")),
        "{:?}",
        exported.left_out
    );
    assert!(exported.text.contains("# a tilted thrust axis"));
}

/// The frame file without its comments.
fn frame(text: &str) -> serde_json::Value {
    let clean: String = text.lines().filter(|line| !line.starts_with('#')).collect();
    serde_json::from_str(&clean).unwrap()
}

#[test]
fn ardupilots_frame_has_the_models_forces_by_its_own_laws() {
    let mut vehicle = vehicle();
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 11.0, expo: 0.5 };
    let effects = [
        effect("linear_drag", &[0.3, 0.3, 0.3]),
        effect("quadratic_drag", &[0.02, 0.02, 0.02, 1.0]),
        effect("angular_damping", &[0.01, 0.01, 0.01]),
    ];
    let exported = export(&vehicle, &effects, None, Format::ArdupilotSitl).unwrap();
    let file = frame(&exported.text);
    let number = |key: &str| file[key].as_f64().unwrap();
    let weight = vehicle.body.mass_kg * vehicle.gravity_m_s2;
    // full thrust is the weight over hoverThrOut
    assert!((weight / number("hoverThrOut") / 4.0 - 11.0).abs() < 1e-9);
    // at home: the standard atmosphere at 584 m
    let density = 1.225 * (1.0 - 2.255_77e-5 * number("refAlt")).powf(4.255_88);
    let momentum = number("mdrag_coef") * (density * number("disc_area") * weight).sqrt();
    assert!((momentum / 0.3 - 1.0).abs() < 1e-4, "{momentum}");
    // what the reference flight leaves for the body, beside the momentum drag of its own thrust
    let (tilt, speed) = (number("refAngle").to_radians(), number("refSpd"));
    let thrust = weight / tilt.cos();
    let of_rotors = tilt.cos()
        * number("mdrag_coef")
        * (speed * tilt.cos())
        * (thrust * density * number("disc_area")).sqrt();
    let body = (weight * tilt.tan() - of_rotors) / (speed * speed);
    assert!((body / 0.02 - 1.0).abs() < 1e-3, "{body}");
    // at hover a little more thrust turns as much as in the model
    let law = |u: f64| 11.0 * (0.5 * u + 0.5 * u * u);
    let hover = vehicle.propulsion.command_from_thrust(weight / 4.0);
    for (index, rotor) in vehicle.rotors.iter().enumerate() {
        let position = &file[format!("motor{}_position", index + 1)];
        assert_eq!(position[0].as_f64().unwrap(), rotor.position_m.x);
        // to the right, not to the left
        assert_eq!(position[1].as_f64().unwrap(), -rotor.position_m.y);
        let yaw = file[format!("motor{}_yaw", index + 1)].as_f64().unwrap();
        let torque = |u: f64| yaw * 0.05 * number("diagonal_size") * u * law(u);
        let slope = (torque(hover + 1e-6) - torque(hover - 1e-6)) / (law(hover + 1e-6) - law(hover - 1e-6));
        let expected = -rotor.spin.yaw_sign() * vehicle.propulsion.torque_per_thrust_m;
        assert!((slope / expected - 1.0).abs() < 1e-6, "{slope} {expected}");
    }
    // 0.01 N m/(rad/s) over the moments of inertia; the drag at the hubs is the same in both
    let rates = vehicle.body.inertia_kg_m2.diagonal().map(|moment| 0.01 / moment);
    assert!((400.0_f64.to_radians() / number("refRotRate") / rates.mean() - 1.0).abs() < 1e-9);
    assert!(exported.left_out.iter().any(|note| note.contains("products of inertia")));
    assert!(exported.left_out.iter().any(|note| note.contains("1150 us")), "{:?}", exported.left_out);
    let plain = export(&vehicle, &[], None, Format::ArdupilotSitl).unwrap();
    let plain = frame(&plain.text);
    for key in ["refRotRate", "mdrag_coef", "refAngle"] {
        assert!(plain[key].as_f64().unwrap().abs() < 1e-9, "{key}: {}", plain[key]);
    }
}

/// Tags of a text in order, each checked to be closed.
fn well_formed(text: &str) {
    let mut open: Vec<String> = Vec::new();
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        let end = if rest[start..].starts_with("<!--") {
            start + rest[start..].find("-->").unwrap() + 2
        } else {
            start + rest[start..].find('>').unwrap()
        };
        let tag = &rest[start + 1..end];
        rest = &rest[end + 1..];
        if tag.starts_with(['?', '!']) || tag.ends_with('/') {
            continue;
        }
        match tag.strip_prefix('/') {
            Some(name) => assert_eq!(open.pop().as_deref(), Some(name)),
            None => open.push(tag.split(' ').next().unwrap().to_owned()),
        }
    }
    assert!(open.is_empty(), "{open:?}");
}

fn between<'a>(text: &'a str, open: &str, close: &str) -> &'a str {
    let start = text.find(open).unwrap() + open.len();
    &text[start..start + text[start..].find(close).unwrap()]
}

#[test]
fn gazebo_and_mujoco_are_well_formed_and_hold_the_values() {
    let mut vehicle = vehicle();
    vehicle.name = "a<b & c -- d".into();
    let effects = [
        effect("linear_drag", &[0.3, 0.3, 0.0]),
        effect("motor_lag", &[0.03]),
        effect("com_offset", &[0.01, -0.02, 0.0]),
        effect("angular_damping", &[0.01, 0.01, 0.01]),
    ];
    let sdf = export(&vehicle, &effects, None, Format::Sdf).unwrap();
    well_formed(&sdf.text);
    let coefficient = vehicle.propulsion.thrust_coefficient.unwrap();
    let hover = (vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0 / coefficient).sqrt();
    let drag: f64 = between(&sdf.text, "<rotorDragCoefficient>", "<").parse().unwrap();
    assert!((drag * 4.0 * hover - 0.3).abs() < 1e-9);
    assert_eq!(between(&sdf.text, "<timeConstantUp>", "<"), "0.03");
    assert!(sdf.left_out.iter().any(|note| note.starts_with(called("angular_damping"))));
    // with the rotors' own mass, as points, the base is the whole vehicle again
    let base: f64 = between(&sdf.text, "<mass>", "<").parse().unwrap();
    assert!((base + 4e-3 - vehicle.body.mass_kg).abs() < 1e-12);
    let moment: f64 = between(&sdf.text, "<ixx>", "<").parse().unwrap();
    let hubs = 4.0 * 1e-3 * (0.174_f64.powi(2) + 0.06_f64.powi(2));
    assert!((moment + hubs - vehicle.body.inertia_kg_m2[(0, 0)]).abs() < 1e-5, "{moment}");
    let mjcf = export(&vehicle, &effects, None, Format::Mjcf).unwrap();
    well_formed(&mjcf.text);
    assert!(mjcf.text.contains("dyntype=\"filterexact\" dynprm=\"0.03\""));
    let inertia: Vec<f64> =
        between(&mjcf.text, "fullinertia=\"", "\"").split(' ').map(|v| v.parse().unwrap()).collect();
    assert_eq!(inertia[3], 0.001);
    assert_eq!(inertia[5], 0.002);
    // a drag across the rotor axis at the middle of the hubs, and what the hubs' own motion damps beside the effect
    assert_eq!(between(&mjcf.text, "name=\"drag_x\"", "/>").rsplit_once(' ').unwrap().1, "-0.3\"");
    assert!(!mjcf.text.contains("drag_z"));
    let damping = between(&mjcf.text, "name=\"damping_z\"", "/>").rsplit_once('-').unwrap().1;
    let damping: f64 = damping.trim_end_matches('"').parse().unwrap();
    assert!((damping - 0.01 - 0.3 * 2.0 * 0.174 * 0.174).abs() < 1e-12, "{damping}");
}

#[test]
fn a_weak_rotor_is_weak_in_gazebo_and_mujoco_and_left_out_elsewhere() {
    let vehicle = vehicle();
    let effects = [effect("weak_rotor", &[2.0, 0.9])];
    let coefficient = vehicle.propulsion.thrust_coefficient.unwrap();
    let sdf = export(&vehicle, &effects, None, Format::Sdf).unwrap();
    let constants: Vec<f64> = sdf
        .text
        .split("<motorConstant>")
        .skip(1)
        .map(|rest| rest.split('<').next().unwrap().parse::<f64>().unwrap() / coefficient)
        .collect();
    let mjcf = export(&vehicle, &effects, None, Format::Mjcf).unwrap();
    assert!(mjcf.text.contains("is its control times the force of its gear"), "{}", mjcf.text);
    assert!(!export(&vehicle, &[], None, Format::Mjcf).unwrap().text.contains("weak rotor"));
    let gears: Vec<f64> = mjcf
        .text
        .split("gear=\"0 0 ")
        .skip(1)
        .map(|rest| rest.split(' ').next().unwrap().parse().unwrap())
        .collect();
    for factors in [constants, gears] {
        assert_eq!(factors.len(), 4);
        for (factor, wanted) in factors.iter().zip([1.0, 1.0, 0.9, 1.0]) {
            assert!((factor - wanted).abs() < 1e-9, "{factors:?}");
        }
    }
    let identified = toml::from_str(
        "[prediction]\nwindow_s = [0.1, 0.5]\nattitude_rad = [0.001, 0.008]\n\
         [prediction.without.weak_rotor]\nattitude_rad = [0.014, 0.33]\n",
    )
    .unwrap();
    for format in [Format::Px4Sih, Format::ArdupilotSitl, Format::Rotorpy] {
        let left_out = export(&vehicle, &effects, Some(&identified), format).unwrap().left_out;
        // the motor by the autopilot's number, and what it costs by the model's own figures
        let expected = "a weak rotor cannot be represented here: motor 3 (front left), factor = 0.9; without it the \
                        prediction error of the attitude grows from 0.0010 to 0.014 rad over 0.1 s, from 0.0080 to 0.33 rad \
                        over 0.5 s";
        assert!(left_out.iter().any(|note| note == expected), "{format:?}: {left_out:?}");
    }
}

#[test]
fn rotorpy_gets_back_what_it_is_made_of() {
    let mut vehicle = vehicle();
    vehicle.propulsion.time_constant_down_s = None;
    let effects = [effect("linear_drag", &[0.3, 0.3, 0.2]), effect("inflow", &[0.1])];
    let exported = export(&vehicle, &effects, None, Format::Rotorpy).unwrap();
    let value = |key: &str| -> f64 { between(&exported.text, &format!("'{key}': "), ",").parse().unwrap() };
    let hover = (vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0 / value("k_eta")).sqrt();
    assert!((value("k_d") * 4.0 * hover - 0.3).abs() < 1e-9);
    assert!((value("k_z") * 4.0 * hover - 0.3).abs() < 1e-9);
    assert!((value("k_m") / value("k_eta") - vehicle.propulsion.torque_per_thrust_m).abs() < 1e-12);
    assert!(exported.left_out.is_empty(), "{:?}", exported.left_out);
}

#[test]
fn what_a_simulator_cannot_be_is_said() {
    let mut vehicle = vehicle();
    vehicle.rotors.pop();
    let error = export(&vehicle, &[], None, Format::Px4Sih).unwrap_err();
    assert!(error.to_string().contains("3 rotors"), "{error}");
    // a plus, whose rotors PX4's simulator would put in an X at half their arms
    let mut plus = self::vehicle();
    for (rotor, [x, y]) in plus.rotors.iter_mut().zip([[0.2, 0.0], [-0.2, 0.0], [0.0, 0.2], [0.0, -0.2]]) {
        (rotor.position_m.x, rotor.position_m.y) = (x, y);
    }
    let error = export(&plus, &[], None, Format::Px4Sih).unwrap_err();
    assert!(error.to_string().contains("four rotors in an X"), "{error}");
    let mut mirrored = self::vehicle();
    for rotor in &mut mirrored.rotors {
        rotor.position_m.y = -rotor.position_m.y;
    }
    let turn = |vehicle| {
        let notes = export(vehicle, &[], None, Format::Px4Sih).unwrap().left_out;
        notes.iter().any(|note| note.contains("turn counter-clockwise"))
    };
    assert_ne!(turn(&self::vehicle()), turn(&mirrored));
    vehicle.propulsion.thrust_coefficient = None;
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 10.0, expo: 0.5 };
    vehicle.propulsion.rotor_radius_m = None;
    let error = export(&vehicle, &[], None, Format::Rotorpy).unwrap_err();
    assert!(error.to_string().contains("thrust_coefficient"), "{error}");
}

#[test]
fn without_a_measured_speed_rotors_turn_as_usual_propellers_and_lift_as_the_model_says() {
    let mut vehicle = vehicle();
    vehicle.propulsion.thrust_coefficient = None;
    vehicle.propulsion.rotor_radius_m = Some(0.127);
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 10.0, expo: 0.5 };
    for format in [Format::Rotorpy, Format::Sdf] {
        let exported = export(&vehicle, &[], None, format).unwrap();
        let told = exported.left_out.iter().any(|note| note.contains("no rotor's speed is known"));
        assert!(told, "{:?}", exported.left_out);
    }
    let text = export(&vehicle, &[], None, Format::Rotorpy).unwrap().text;
    let number = |key: &str| -> f64 {
        let (_, rest) = text.split_once(&format!("'{key}': ")).unwrap();
        rest.split(',').next().unwrap().parse().unwrap()
    };
    // 0.1 rho D^4 / (2 pi)^2
    assert!((number("k_eta") / 1.29155e-5 - 1.0).abs() < 1e-3, "{}", number("k_eta"));
    let full_n = number("k_eta") * number("rotor_speed_max").powi(2);
    assert!((full_n / 10.0 - 1.0).abs() < 1e-9, "{full_n}");
}

#[test]
fn ardupilots_notes_tell_the_current_of_its_battery_and_what_the_yaw_factor_holds() {
    let mut vehicle = vehicle();
    for (expo, share) in [(0.0, "0.50"), (1.0, "0.67")] {
        vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 11.0, expo };
        let exported = export(&vehicle, &[], None, Format::ArdupilotSitl).unwrap();
        let frame = frame(&exported.text);
        let number = |key: &str| frame[key].as_f64().unwrap();
        // no voltage of the battery changes the thrust
        assert_eq!((number("battCapacityAh"), number("refBatRes")), (0.0, 0.0));
        let (current, hour) =
            (format!("{:.0} A at hover", number("refCurrent")), 1000.0 * number("refCurrent"));
        let told = |words: &str| exported.left_out.iter().any(|note| note.contains(words));
        assert!(
            told(&current) && told(&format!("set BATT_CAPACITY to {hour:.0} mAh")),
            "{:?}",
            exported.left_out
        );
        assert!(
            told(&format!("the torque itself is {share} of the model's there")),
            "{:?}",
            exported.left_out
        );
        // about hover the torque changes with the thrust as in the model: by hand, with the command of a thrust
        let torque = |thrust_n: f64| {
            let yaw = number("motor1_yaw").abs() * 0.05 * number("diagonal_size");
            yaw * vehicle.propulsion.command_from_thrust(thrust_n) * thrust_n
        };
        let hover_n = vehicle.body.mass_kg * vehicle.gravity_m_s2 / 4.0;
        let slope = (torque(hover_n + 1e-4) - torque(hover_n - 1e-4)) / 2e-4;
        assert!((slope / vehicle.propulsion.torque_per_thrust_m - 1.0).abs() < 1e-6, "{slope}");
    }
}

#[test]
fn ardupilots_note_says_that_its_hubs_damp_more_than_the_model() {
    let mut vehicle = vehicle();
    vehicle.propulsion.law = ThrustLaw::Curve { thrust_max_n: 11.0, expo: 0.5 };
    let drag = |at_hubs: f64| {
        let effects = [effect("linear_drag", &[2.0, 2.0, 2.0, at_hubs])];
        export(&vehicle, &effects, None, Format::ArdupilotSitl).unwrap()
    };
    let told = |exported: &Exported, words: &str| exported.left_out.iter().any(|note| note.contains(words));
    let at_center = drag(0.0);
    assert_eq!(frame(&at_center.text)["refRotRate"].as_f64().unwrap(), 0.0);
    assert!(told(&at_center, "damps the rotation more than in the model"), "{:?}", at_center.left_out);
    assert!(!told(&at_center, "refRotRate is from the mean"), "{:?}", at_center.left_out);
    assert!(!told(&drag(1.0), "damps the rotation more"), "{:?}", drag(1.0).left_out);
}

#[test]
fn what_mujocos_file_cannot_hold_is_in_its_callback_where_that_can_make_it() {
    let vehicle = vehicle();
    let effects = [effect("quadratic_drag", &[0.05, 0.06, 0.07]), effect("slung_load", &[0.2, 1.0])];
    let exported = export(&vehicle, &effects, None, Format::Mjcf).unwrap();
    let callback = exported.callback.unwrap().text(std::path::Path::new("model.xml"));
    for wanted in ["QUADRATIC = np.array([0.05, 0.06, 0.07])", "mujoco.set_mjcb_passive(passive)"] {
        assert!(callback.contains(wanted), "{callback}");
    }
    let told = |id: &str, words: &str| {
        exported
            .left_out
            .iter()
            .any(|note| note.starts_with(&format!("{} cannot", called(id))) && note.contains(words))
    };
    assert!(told("quadratic_drag", "the callback in Python"), "{:?}", exported.left_out);
    assert!(told("slung_load", "mavid explain` writes it"), "{:?}", exported.left_out);
    assert_eq!(export(&vehicle, &effects[1..], None, Format::Mjcf).unwrap().callback, None);
    assert_eq!(export(&vehicle, &effects, None, Format::Sdf).unwrap().callback, None);
}

/// What the table says of each effect and simulator is what the exporters do.
#[test]
fn the_table_says_of_every_effect_which_simulators_can_hold_it() {
    let mut wrong = Vec::new();
    for effect in ALL {
        let id = effect.id();
        let places = places(id);
        let near = |bounds: (f64, f64)| 0.01_f64.clamp(bounds.0, bounds.1);
        let size = vehicle().size();
        let values: Vec<f64> = effect.parameters().iter().map(|p| near(p.bounds.at(&size))).collect();
        let active = [ActiveEffect::new(*effect, &values).unwrap()];
        for format in [Format::Px4Sih, Format::ArdupilotSitl, Format::Sdf, Format::Mjcf, Format::Rotorpy] {
            let exported = export(&vehicle(), &active, None, format).unwrap();
            let has_place = !exported
                .left_out
                .iter()
                .any(|note| note.starts_with(&format!("{} cannot be represented", called(id))));
            if has_place != places.contains(&format) {
                wrong.push(format!("{id} in {format:?}: has a place: {has_place}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for (place, (id, formats)) in PLACES.iter().enumerate() {
        assert!(by_id(id).is_some() && !formats.is_empty(), "{id}: no effect, or no simulator");
        assert!(PLACES[..place].iter().all(|(other, _)| other != id), "{id}: twice");
    }
}

#[test]
fn each_rotor_beside_a_weak_one_says_what_its_coefficient_rests_on() {
    let effects = [effect("weak_rotor", &[2.0, 0.9])];
    let identified =
        "[effects.weak_rotor]\nrotor = { value = 2.0, std = 0.0 }\nfactor = { value = 0.9, std = 0.01 }\n";
    let identified = toml::from_str(identified).unwrap();
    let written =
        aircraft_parameters(&vehicle(), &effects, Some(&identified), (Autopilot::Px4, None)).unwrap();
    let of = |name: &str| written.parameters.iter().find(|parameter| parameter.name == name).unwrap();
    let (weak, sound) = (of("CA_ROTOR2_CT"), of("CA_ROTOR0_CT"));
    assert!((weak.value - 0.9 * 6.5).abs() < 1e-9 && (weak.std.unwrap() - 0.065).abs() < 1e-9);
    assert!(weak.why.contains("0.900 +- 0.010 of the others' thrust"), "{}", weak.why);
    assert!(sound.value == 6.5 && sound.why.contains("whose error is the weak one's"), "{}", sound.why);
}

#[test]
fn an_aircraft_gets_what_was_identified_and_nothing_else() {
    let vehicle = vehicle();
    let effects = [
        effect("linear_drag", &[0.3, 0.3, 0.2]),
        effect("quadratic_drag", &[0.03, 0.001, 0.0]),
        effect("thrust_curve", &[-0.2]),
    ];
    let identified = toml::from_str(
        "mass = { value = 2.06, std = 0.0206 }\n[effects.linear_drag]\ndx = { value = 0.3, std = 0.01 }\n\
         dy = { value = 0.3, std = 0.01 }\n[effects.quadratic_drag]\ncx = { value = 0.03, std = 0.001 }\n\
         cy = { value = 0.001, std = 0.001 }\n[effects.thrust_curve]\ncurvature = { value = -0.2, std = 0.02 }\n",
    )
    .unwrap();
    let written = aircraft_parameters(&vehicle, &effects, Some(&identified), (Autopilot::Px4, None)).unwrap();
    let of = |name: &str| written.parameters.iter().find(|parameter| parameter.name == name).unwrap();
    let mass = vehicle.body.mass_kg;
    // d / m, and its error: that of the drag without the scale of the thrust, which a bent curve moves in drag and mass alike
    let momentum = of("EKF2_MCOEF");
    assert!((momentum.value - 0.3 / mass).abs() < 1e-12);
    let scale = 0.0206 / 2.06 * 0.3;
    assert!((momentum.std.unwrap() - (0.01_f64.powi(2) - scale * scale).sqrt() / mass).abs() < 1e-9);
    assert!(momentum.why.contains("along x and 0.300 +- 0.010 along y"), "{}", momentum.why);
    // an axis that is known worse says less, and errors do not shrink by it
    let uneven: toml::Table = toml::from_str(
        "[effects.linear_drag]\ndx = { value = 0.30, std = 0.01 }\ndy = { value = 0.25, std = 0.03 }\n\
         dz = { value = 0.2, std = 0.01 }\n",
    )
    .unwrap();
    let drag = [effect("linear_drag", &[0.30, 0.25, 0.2])];
    let uneven = aircraft_parameters(&vehicle, &drag, Some(&uneven), (Autopilot::Px4, None)).unwrap();
    let momentum = uneven.parameters.iter().find(|parameter| parameter.name == "EKF2_MCOEF").unwrap();
    assert!((momentum.value - (0.9 * 0.30 + 0.1 * 0.25) / mass).abs() < 1e-12);
    assert!((momentum.std.unwrap() - (0.9 * 0.01 + 0.1 * 0.03) / mass).abs() < 1e-12);
    assert!(momentum.why.contains("without the report's z"), "{}", momentum.why);
    // rho m / (2 c) where the drag is told from none, and off where it is not
    assert!((of("EKF2_BCOEF_X").value - 0.5 * 1.225 * mass / 0.03).abs() < 1e-9);
    assert_eq!((of("EKF2_BCOEF_Y").value, of("EKF2_DRAG_CTRL").value), (0.0, 1.0));
    // the curve has the slope at hover that was found: by a finite difference of the model's own thrust
    let hover_n = mass * vehicle.gravity_m_s2 / 4.0;
    let command = vehicle.propulsion.command_from_thrust(hover_n);
    let bent = |u: f64| {
        let thrust_n = vehicle.propulsion.thrust_from_command_n(u);
        let speed = (thrust_n / hover_n).sqrt();
        thrust_n + -0.2 * 2.0 * hover_n * speed * (speed - 1.0)
    };
    let factor = of("THR_MDL_FAC").value;
    let curve = |u: f64| (1.0 - factor) * u + factor * u * u;
    let elasticity = |law: &dyn Fn(f64) -> f64| {
        command * (law(command + 1e-6) - law(command - 1e-6)) / (2e-6 * law(command))
    };
    assert!((elasticity(&bent) - elasticity(&curve)).abs() < 1e-6, "{factor}");
    let hover = of("MPC_THR_HOVER");
    assert!((hover.value - curve(command)).abs() < 1e-9 && hover.std.unwrap() > 0.01 * hover.value);
    assert!(hover.why.contains("the model file does not hold the voltage"), "{}", hover.why);
    // thinner air: the same drag at sea level is more, and ArduPilot scales the throttle by the density itself
    let of_ardupilot = |altitude_m| {
        let autopilot = (Autopilot::ArduPilot, altitude_m);
        aircraft_parameters(&vehicle, &effects, Some(&identified), autopilot).unwrap().parameters
    };
    let (low, high) = (of_ardupilot(None), of_ardupilot(Some(584.0)));
    let ratios: Vec<f64> = low.iter().zip(&high).map(|(low, high)| high.value / low.value).collect();
    for (name, ratio) in [("MOT_THST_HOVER", 0.945), ("EK3_DRAG_MCOEF", 1.0287), ("EK3_DRAG_BCOEF_X", 0.945)]
    {
        let at = low.iter().position(|parameter| parameter.name == name).unwrap();
        assert!((ratios[at] - ratio).abs() < 5e-4, "{name}: {}", ratios[at]);
        assert!(high[at].why.contains("1.158 kg/m^3"), "{}", high[at].why);
    }
    // what cannot be held is named with all that goes with it
    let strong = [effect("linear_drag", &[9.0, 9.0, 0.2]), effects[1].clone()];
    let strong = aircraft_parameters(&vehicle, &strong, Some(&identified), (Autopilot::Px4, None)).unwrap();
    assert!(!strong.parameters.iter().any(|parameter| parameter.name.starts_with("EKF2")));
    for id in ["linear_drag", "quadratic_drag"] {
        let named = format!("{} cannot be represented here: ", called(id));
        assert!(strong.left_out.iter().any(|note| note.starts_with(&named)), "{id}: {:?}", strong.left_out);
        assert!(
            !written.left_out.iter().any(|note| note.starts_with(&named)),
            "{id}: {:?}",
            written.left_out
        );
    }
    // without standard errors nothing follows
    let none = aircraft_parameters(&vehicle, &effects, None, (Autopilot::ArduPilot, None));
    assert!(none.unwrap_err().to_string().contains("standard errors"));
}

/// A program of another model is never written over, and one that nothing needs any more does not stay.
#[test]
fn the_program_of_a_models_effects_belongs_to_the_file_of_the_model() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("export-programs");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let place = |name: &str| folder.join(name).display().to_string();
    let vehicle =
        std::fs::read_to_string(std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("configs/x500.toml"))
            .unwrap();
    let drag =
        |c: f64| format!("{vehicle}\n[[effect]]\nid = \"quadratic_drag\"\ncx = {c}\ncy = {c}\ncz = {c}\n");
    std::fs::write(place("one.toml"), drag(0.05)).unwrap();
    std::fs::write(place("two.toml"), drag(0.07)).unwrap();
    std::fs::write(place("plain.toml"), &vehicle).unwrap();
    let to = |model: &str, out: &str| {
        let arguments = ["export", &place(model), "--to", "mjcf", "--out", &place(out)];
        std::process::Command::new(env!("CARGO_BIN_EXE_mavid")).args(arguments).output().unwrap()
    };
    let read = |name: &str| std::fs::read_to_string(folder.join(name)).unwrap();
    assert!(to("one.toml", "x500-a.xml").status.success());
    assert!(to("two.toml", "x500-b.xml").status.success());
    let (a, b) = (read("x500_a_effects.py"), read("x500_b_effects.py"));
    assert!(a.contains("import x500_a_effects\n") && a.contains("from_xml_path(\"x500-a.xml\")"), "{a}");
    assert!(a.contains("[0.05, 0.05, 0.05]") && b.contains("[0.07, 0.07, 0.07]"));
    // the same name for the program of another model
    for out in ["x500-a.mjcf", "x500_a.xml"] {
        let refused = to("two.toml", out);
        let said = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{said}");
        assert!(said.contains("x500_a_effects.py; expected that this file is not there"), "{said}");
        assert!(!folder.join(out).exists());
    }
    assert_eq!(read("x500_a_effects.py"), a);
    // an export to the same file replaces both, and takes away what is not needed any more
    assert!(to("two.toml", "x500-a.xml").status.success());
    assert!(read("x500_a_effects.py").contains("[0.07, 0.07, 0.07]"));
    let plain = to("plain.toml", "x500-a.xml");
    assert!(plain.status.success() && !folder.join("x500_a_effects.py").exists());
    assert!(String::from_utf8_lossy(&plain.stderr).contains("x500_a_effects.py, of an earlier run"));
}
