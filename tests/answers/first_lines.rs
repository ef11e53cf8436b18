//! What the first lines say of flights that tell little, of models that predict worse than they should, and of what is not determined.

use crate::support;

use mavid::diagnose::{ExplainSettings, explain};
use mavid::report::{
    ExplanationDocument, explained_model, explanation_answer_line, explanation_html, explanation_markdown,
    explanation_text, identification_text, identified_model,
};
use mavid::signals::{ConditionSettings, condition};
use mavid::study::{
    ExplainRequest, ExplainStudy, FlightLimit, IdentifyRequest, Silent, VehicleGiven,
    explain as explained_study, identify,
};
use std::path::{Path, PathBuf};

fn sitl(name: &str) -> Option<PathBuf> {
    Some(support::shared()?.join("onboard/sitl").join(name))
}

fn request(logs: &[PathBuf], vehicle: &Path) -> ExplainRequest {
    ExplainRequest {
        logs: logs.to_vec(),
        vehicle: VehicleGiven::File(vehicle.to_path_buf()),
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    }
}

fn study(logs: &[PathBuf], vehicle: &Path) -> ExplainStudy {
    explained_study(&request(logs, vehicle), &Silent).unwrap()
}

/// Every view begins with the limit, in this order: the text, Markdown, HTML, the last line, and the document's answer.
fn begins_with(study: &ExplainStudy, words: &str) {
    let document = serde_json::to_value(ExplanationDocument::new(study)).unwrap();
    let markdown = explanation_markdown(study);
    let html = explanation_html(study);
    for view in [explanation_text(study), document["answer"].as_str().unwrap().to_owned()] {
        assert!(view.starts_with(&format!("Limited: {words}")), "{}", &view[..300.min(view.len())]);
    }
    assert!(markdown.starts_with("**Limited: "), "{markdown}");
    assert!(
        html.contains("Limited: the vehicle") && html.contains("limited flight"),
        "no limit in the report"
    );
    assert!(explanation_answer_line(study, 500).starts_with("answer: limited flight: "));
    assert!(document["limited"][0].as_str().unwrap().starts_with(words), "{}", document["limited"]);
    assert!(!study.is_certain());
}

#[test]
fn a_hover_says_first_that_it_is_one() {
    let (Some(log), Some(vehicle)) = (sitl("ap08.bin"), sitl("ardupilot-quad-c.toml")) else { return };
    let study = study(&[log], &vehicle);
    assert_eq!(study.limited(), [FlightLimit::Hover]);
    begins_with(&study, "the vehicle only hovers");
    let said = explanation_text(&study);
    assert!(study.effects.is_empty() || said.contains("; no name is certain. "), "{}", &said[..300]);
}

/// It moves for two periods only, and a force that follows the climb predicts another flight worse.
#[test]
fn a_harmful_force_is_left_out_of_a_short_flight() {
    let Some(folder) = support::shared().map(|shared| shared.join("noisy/n12")) else { return };
    let request = ExplainRequest {
        holdout: vec![folder.join("holdout.tlog")],
        ..request(&[folder.join("identify.tlog")], &folder.join("vehicle.toml"))
    };
    let study = explained_study(&request, &Silent).unwrap();
    begins_with(&study, "the vehicle moves for 1");
    // with an empirical force the hold-out is predicted worse
    let force = study.left_out_force.unwrap();
    assert!(force.worse_percent > 1.0 && study.empirical.is_none());
    let said = explanation_text(&study);
    assert!(said.contains(" larger in the mean, so no model has it."), "{}", &said[..1200]);
    let document = serde_json::to_value(ExplanationDocument::new(&study)).unwrap();
    assert!(document["empirical"].is_null());
    assert_eq!(document["empirical_left_out"]["worse_percent"], force.worse_percent);
    assert!(document["answer"].as_str().unwrap().contains("so no model has it"));
}

/// The trajectory ended after twelve seconds, before its first period was over.
#[test]
fn an_aborted_flight_says_first_that_it_has_too_few_periods() {
    let (Some(log), Some(vehicle)) = (sitl("px11.ulg"), sitl("px4-v2.toml")) else { return };
    let study = study(&[log], &vehicle);
    assert!(
        matches!(study.limited()[..], [FlightLimit::FewPeriods { period_s: None, moving_s }] if moving_s < 16.0)
    );
    begins_with(&study, "the vehicle moves for 1");
    let said = explanation_text(&study);
    let document = serde_json::to_value(ExplanationDocument::new(&study)).unwrap();
    // and at which horizons a state that does not change is better
    let all = study.holdout.as_ref().unwrap().no_model_of();
    let (name, windows_s) = &all[0];
    assert!(said.contains(&format!("no model for prediction of {name} (over {}", windows_s[0])), "{said}");
    assert!(explanation_markdown(&study).contains("No model for prediction of"));
    assert!(explanation_html(&study).contains("No model for prediction of"));
    let windows = document["fit"]["holdout"]["open_loop"].as_array().unwrap();
    let told = windows.iter().filter(|of| !of["worse_than_unchanged"].as_array().unwrap().is_empty());
    assert!(told.count() > 0);
}

#[test]
fn a_flight_along_a_trajectory_is_not_limited() {
    let (Some(log), Some(vehicle)) = (sitl("ap07.bin"), sitl("ardupilot-quad-c.toml")) else { return };
    assert_eq!(study(&[log], &vehicle).limited(), []);
}

/// The battery's sag is in the model of `explain`: without it the mass is a tenth more.
#[test]
fn identify_keeps_the_effects_that_explain_finds_in_the_part_that_shows_them() {
    let (Some(log), Some(vehicle)) = (sitl("px08.ulg"), sitl("px4-v1.toml")) else { return };
    let explained = study(std::slice::from_ref(&log), &vehicle);
    let request = IdentifyRequest {
        logs: vec![log],
        vehicle: VehicleGiven::File(vehicle.clone()),
        ..IdentifyRequest::default()
    };
    let identified = identify(&request, &Silent).unwrap();
    let names: Vec<&str> = explained.effects.iter().map(|effect| effect.id).collect();
    assert!(names.contains(&"battery_sag") && identified.beside.contains(&"battery_sag"), "{names:?}");
    let mass = explained.body()[0].after;
    let own = identified.body().estimated.theta[0];
    assert!((own - mass.value).abs() < mass.std, "{own} and {mass:?}");
    let said = identification_text(&identified);
    assert!(said.contains("those that `mavid explain` does not hold back"), "{said}");
    assert!(said.contains("The mass rests on the stated thrust at 16.3 V"), "{said}");
}

/// Torques that go with a power of the thrust tell no izz: it stays as stated, or as near to it as a body can have it.
#[test]
fn izz_that_is_not_determined_stays_near_the_stated_one_and_the_torque_follows() {
    let Some(shared) = support::shared() else { return };
    let folder = shared.join("recordings/autopilots");
    let (log, vehicle) = (folder.join("ap_baseline.tlog"), folder.join("ardupilot-quad.toml"));
    let request = IdentifyRequest {
        logs: vec![log.clone()],
        vehicle: VehicleGiven::File(vehicle.clone()),
        ..IdentifyRequest::default()
    };
    let identified = identify(&request, &Silent).unwrap();
    assert!(identified.torque_law.is_some());
    let stated = mavid::config::load_vehicle(&vehicle).unwrap();
    for text in [identified_model(&identified).unwrap(), explained_model(&study(&[log], &vehicle)).unwrap()] {
        let model = mavid::config::parse_vehicle(&text, "model").unwrap().vehicle;
        let moments = [0, 1, 2].map(|axis| model.body.inertia_kg_m2[(axis, axis)]);
        // as stated it would be 0.06, which is more than ixx and iyy together
        assert!(
            moments[2] > moments[0].max(moments[1]) && moments[2] < moments[0] + moments[1],
            "{moments:?}"
        );
        let ratio = |izz: f64, torque_per_thrust_m: f64| izz / torque_per_thrust_m;
        let told = ratio(moments[2], model.propulsion.torque_per_thrust_m);
        // by the stated torque per thrust the flight gives 0.0177 to 0.0179
        let by_stated = told * stated.propulsion.torque_per_thrust_m;
        assert!((0.0172..0.0184).contains(&by_stated), "{by_stated}");
        assert!(
            text.contains("the motion about z tells only the ratio of izz")
                && text.contains("uncertain by 30 %")
        );
    }
    let said = identification_text(&identified);
    assert!(said.contains("its torque per thrust follows from the ratio"), "{said}");
}

/// The same in a simulated flight: the ratio stays, and what goes with it follows.
#[test]
fn a_model_that_keeps_izz_has_the_ratio_that_the_flight_tells() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("fixtures");
    let vehicle = mavid::config::load_vehicle(&fixtures.join("p01_vehicle.toml")).unwrap();
    let log =
        mavid::log::open(&fixtures.join("p01_identify_0_25s.tlog"), &mavid::log::OpenOptions::default())
            .unwrap();
    let signals = condition(&log.recording, &vehicle, &ConditionSettings::default()).unwrap();
    let explanation = explain(&[signals], &vehicle, &ExplainSettings::default()).unwrap();
    // a torque in proportion to the thrust tells izz: nothing moves
    assert!(explanation.torque_law.is_none());
    let before = explanation.search.after.base.vehicle.clone();
    let kept = explanation.keeping_about_z(&vehicle);
    assert_eq!(kept.search.after.base.vehicle.body, before.body);
    assert_eq!(kept.search.after.base.vehicle.propulsion, before.propulsion);
}

#[test]
fn a_value_that_is_not_determined_has_no_number_beside_it() {
    let (Some(log), Some(vehicle)) = (sitl("ap08.bin"), sitl("ardupilot-quad-c.toml")) else { return };
    let study = study(&[log], &vehicle);
    let said = explanation_text(&study);
    let row = said.lines().find(|line| line.trim_start().starts_with("ixx ")).unwrap();
    assert_eq!(row.matches("not determined").count(), 2, "{row}");
    let mass = said.lines().find(|line| line.trim_start().starts_with("mass ")).unwrap();
    assert_eq!(mass.matches("+-").count(), 2, "{mass}");
    let document = serde_json::to_value(ExplanationDocument::new(&study)).unwrap();
    assert!(document["rigid_body"]["ixx"]["before"].is_null());
    assert!(document["rigid_body"]["mass"]["before_std"].as_f64().unwrap() > 0.0);
}
