//! `mavid compare` where the scale of forces moved between flights: a payload beside a mass that is taken as stated.

use crate::compare::{config, folder, simulated};

use mavid::report::comparison_text;
use mavid::study::{CompareRequest, Silent, VehicleGiven, compare};
use std::ops::Range;
use std::path::PathBuf;

#[test]
fn a_payload_that_was_taken_off_is_no_change_where_the_mass_is_taken_as_stated() {
    let folder = folder("payload");
    let vehicle = folder.join("weighed.toml");
    let nominal = std::fs::read_to_string(config("x500.toml")).unwrap();
    std::fs::write(&vehicle, format!("{nominal}\n[identify]\nanchor = \"mass\"\n")).unwrap();
    let flights = |name: &str, mass_kg: f64, seeds: Range<u32>| -> Vec<PathBuf> {
        seeds.map(|seed| PathBuf::from(simulated(&folder, name, (mass_kg, 0.3), seed))).collect()
    };
    let request = CompareRequest {
        before: flights("with", 2.0643, 1..4),
        after: flights("without", 1.6514, 4..7),
        vehicle: Some(VehicleGiven::File(vehicle)),
        transient_s: CompareRequest::TRANSIENT_S,
        ..CompareRequest::default()
    };
    let study = compare(&request, &Silent).unwrap();
    let told = comparison_text(&study);
    // all moments of inertia came out at 1.25 of theirs
    let izz = study.tracks.iter().find(|track| track.name == "izz").unwrap();
    let [before, after] = [[0, 1, 2], [3, 4, 5]].map(|flights| izz.only(&flights).pooled().unwrap().0);
    assert!((after / before - 1.25).abs() < 0.1, "{told}");
    assert!(!study.has_changed() && study.is_of_one_vehicle(), "{told}");
    assert!(told.contains("The thrust for a command over the weight went from 1."), "{told}");
    // a border elsewhere is none either
    assert!(study.history.is_empty(), "{told}");
}
