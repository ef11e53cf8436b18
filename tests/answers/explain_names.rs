//! Names that simulated flights must be given, and those that they must not.

use crate::concealed;

use concealed::{Sizes, explained};
use mavid::diagnose::{Explanation, Named, Verdict};
use mavid::simulate::RandomTrajectory;

fn ids(explanation: &Explanation) -> Vec<&'static str> {
    explanation.named.iter().map(|named| named.id).collect()
}

fn value(named: &Named, parameter: &str) -> f64 {
    named.parameters.iter().find(|known| known.name == parameter).unwrap().value
}

fn is_near(found: f64, truth: f64, share: f64) -> bool {
    (found - truth).abs() < share * truth.abs()
}

/// Within a share of the truth, or three standard errors.
fn holds(named: &Named, parameter: &str, truth: f64, share: f64) -> bool {
    let found = named.parameters.iter().find(|known| known.name == parameter).unwrap();
    (found.value - truth).abs() < (share * truth.abs()).max(3.0 * found.std)
}

#[test]
fn a_lean_of_the_thrust_is_named_when_it_is_more_than_any_mounting() {
    let small =
        explained(3, &[("thrust_tilt", &[("x", 0.0025), ("y", -0.0025)])], RandomTrajectory::default());
    assert_eq!((small.verdict, ids(&small)), (Verdict::NothingMissing, vec![]));
    let large = explained(3, &[("thrust_tilt", &[("x", 0.03), ("y", -0.02)])], RandomTrajectory::default());
    assert_eq!((large.verdict, ids(&large)), (Verdict::Explained, vec!["thrust_tilt"]));
    assert!(
        is_near(value(&large.named[0], "x"), 0.03, 0.1) && is_near(value(&large.named[0], "y"), -0.02, 0.1)
    );
}

#[test]
fn what_only_sensors_see_is_named_as_theirs() {
    let cases: [(&str, Sizes); 3] = [
        ("imu_offset", &[("x", 0.05), ("y", -0.03), ("z", 0.04)]),
        ("imu_misalignment", &[("x", 0.035), ("y", -0.026), ("z", 0.03)]),
        ("frame_misalignment", &[("x", 0.035), ("y", -0.026), ("z", 0.0)]),
    ];
    for (id, sizes) in cases {
        let found = explained(5, &[(id, sizes)], RandomTrajectory::default());
        assert_eq!((found.verdict, ids(&found)), (Verdict::Explained, vec![id]));
        let named = &found.named[0];
        for (name, truth) in sizes.iter().filter(|(_, truth)| *truth != 0.0) {
            assert!(holds(named, name, *truth, 0.15), "{id} {name}: {named:?}");
        }
    }
}

#[test]
fn a_body_that_drags_at_its_centre_and_is_damped_does_not_drag_at_half_of_its_hubs() {
    let found = explained(
        4,
        &[
            ("linear_drag", &[("dx", 0.6), ("dy", 0.6), ("dz", 0.6), ("at_hubs", 0.0)]),
            ("angular_damping", &[("bx", 0.02), ("by", 0.02), ("bz", 0.02)]),
        ],
        RandomTrajectory::default(),
    );
    assert_eq!(found.verdict, Verdict::Explained, "{:?}", ids(&found));
    let mut names = ids(&found);
    names.sort_unstable();
    assert_eq!(names, ["angular_damping", "linear_drag"]);
    for named in &found.named {
        let (truth, parameters) = match named.id {
            "linear_drag" => (0.6, ["dx", "dy", "dz"]),
            _ => (0.02, ["bx", "by", "bz"]),
        };
        for parameter in parameters {
            assert!(holds(named, parameter, truth, 0.15), "{named:?}");
            let named = &named.strength;
            assert!(named.z > 4.0, "{named:?}");
        }
    }
}

#[test]
fn flat_faces_and_round_bodies_are_told_apart() {
    for by_face in [0.0, 1.0] {
        let sizes = [("cx", 0.2), ("cy", 0.2), ("cz", 0.2), ("by_face", by_face)];
        let found = explained(2, &[("quadratic_drag", &sizes)], RandomTrajectory::default());
        assert_eq!((found.verdict, ids(&found)), (Verdict::Explained, vec!["quadratic_drag"]));
        let named = &found.named[0];
        assert!(is_near(value(named, "cx"), 0.2, 0.15), "{named:?}");
        assert!((value(named, "by_face") - by_face).abs() < 0.25, "{named:?}");
    }
}

#[test]
fn a_load_on_a_cord_is_found_with_its_weight_and_length() {
    let gently =
        RandomTrajectory { speed_max_m_s: 1.0, acceleration_max_m_s2: 0.8, ..RandomTrajectory::default() };
    let load = [("mass", 0.1), ("length", 0.8), ("damping", 0.3)];
    let found = explained(7, &[("slung_load", &load)], gently);
    assert!(ids(&found).contains(&"slung_load"), "{:?} {:?}", found.verdict, ids(&found));
    let named = found.named.iter().find(|named| named.id == "slung_load").unwrap();
    assert!(
        is_near(value(named, "mass"), 0.1, 0.25) && is_near(value(named, "length"), 0.8, 0.15),
        "{named:?}"
    );
}

#[test]
fn a_payload_is_dropped_when_it_was() {
    let found =
        explained(6, &[("mass_change", &[("time", 26.3), ("delta", -0.1)])], RandomTrajectory::default());
    assert_eq!((found.verdict, ids(&found)), (Verdict::Explained, vec!["mass_change"]));
    let named = &found.named[0];
    assert!(is_near(value(named, "delta"), -0.1, 0.05), "{named:?}");
    assert!((value(named, "time") - 26.3).abs() < 0.3, "{named:?}");
}

#[test]
fn a_low_ceiling_is_named() {
    let ceiling = [("a1", 3.5), ("a2", 0.03), ("height", 2.35)];
    let found = explained(1, &[("ceiling_effect", &ceiling)], RandomTrajectory::default());
    // where height and thrust go together a bent thrust curve may be named beside it
    assert!(ids(&found).contains(&"ceiling_effect"), "{:?} {:?}", found.verdict, ids(&found));
    let named = found.named.iter().find(|named| named.id == "ceiling_effect").unwrap();
    assert!((value(named, "height") - 2.35).abs() < 0.15, "{named:?}");
}

#[test]
fn the_first_rotor_keeps_its_number() {
    let found =
        explained(6, &[("weak_rotor", &[("rotor", 0.0), ("factor", 0.93)])], RandomTrajectory::default());
    assert_eq!((found.verdict, ids(&found)), (Verdict::Explained, vec!["weak_rotor"]));
    assert_eq!(value(&found.named[0], "rotor"), 0.0);
    assert!(is_near(value(&found.named[0], "factor"), 0.93, 0.01));
}

#[test]
fn what_the_form_of_two_laws_of_the_drag_may_be_wrong_by_is_in_each_of_them() {
    let drag: Sizes = &[("dx", 0.8), ("dy", 0.8), ("dz", 0.8)];
    let square: Sizes = &[("cx", 0.3), ("cy", 0.3), ("cz", 0.3)];
    let found =
        explained(4, &[("linear_drag", drag), ("quadratic_drag", square)], RandomTrajectory::default());
    let named = |id: &str| {
        found.named.iter().find(|named| named.id == id).unwrap_or_else(|| panic!("{:?}", ids(&found)))
    };
    for (id, parameter) in [("linear_drag", "dx"), ("quadratic_drag", "cx")] {
        let named = named(id);
        let found = named.parameters.iter().find(|known| known.name == parameter).unwrap();
        // alone each has 2 % of itself at the least
        assert!(found.std > 0.025 * found.value, "{id}: {found:?}");
        assert!(holds(named, parameter, if id == "linear_drag" { 0.8 } else { 0.3 }, 0.0), "{id}: {found:?}");
    }
}
