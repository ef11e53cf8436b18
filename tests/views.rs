//! The views of each study, as they are written down in `tests/snapshots`: text, JSON, and the outline of a page.
//!
//! Numbers of JSON are rounded, and charts and long lists stand for themselves, so that another processor finds the same.
//! `INSTA_UPDATE=always cargo test --release --test views` writes them anew.

#![allow(clippy::unwrap_used, reason = "a test ends where it fails")]

use std::path::PathBuf;

use mavid::config::read_vehicle;
use mavid::diagnose::locate::Bin;
use mavid::inspect::inspect;
use mavid::log::OpenOptions;
use mavid::report::{
    ExplanationDocument, IdentificationDocument, InspectionDocument, ValidationDocument, explained_model,
    explanation_html, explanation_text, identification_text, identified_model, inspection_text,
    validation_text,
};
use mavid::study::{
    ExplainRequest, IdentifyRequest, ReadSettings, Silent, ValidateRequest, explain, identify, validate,
};
use serde::Serialize;
use serde_json::Value;

/// More numbers than this in a row are told by their count.
const LISTED: usize = 4;
/// Digits of a number that are told.
const DIGITS: i32 = 3;

/// From the package's folder, in which tests run.
fn fixture(name: &str) -> PathBuf {
    PathBuf::from("fixtures").join(name)
}

fn outlined(document: &impl Serialize) -> String {
    let value = serde_json::to_value(document).unwrap();
    serde_json::to_string_pretty(&shortened(value)).unwrap()
}

fn shortened(value: Value) -> Value {
    match value {
        Value::Number(number) => {
            let value = number.as_f64().unwrap();
            let rounded: f64 = mavid::report::significant(value, DIGITS).parse().unwrap();
            if value.fract() == 0.0 { Value::Number(number) } else { rounded.into() }
        }
        Value::Array(items) if items.len() > LISTED && items.iter().all(Value::is_number) => {
            format!("{} numbers", items.len()).into()
        }
        Value::Array(items) if items.len() > LISTED && items.iter().all(Value::is_array) => {
            format!("{} lists", items.len()).into()
        }
        Value::Array(items) => items.into_iter().map(shortened).collect(),
        Value::Object(fields) => fields.into_iter().map(|(name, value)| (name, shortened(value))).collect(),
        other => other,
    }
}

/// A page with the title of each chart in its place, without its style and script and the program's version.
fn outline(page: &str) -> String {
    let mut out = String::new();
    let mut rest = page;
    while let Some((at, kind)) = ["svg", "style", "script"]
        .into_iter()
        .filter_map(|kind| Some((rest.find(&format!("<{kind}"))?, kind)))
        .min()
    {
        let end = &format!("</{kind}>");
        let (element, after) = rest[at..].split_at(rest[at..].find(end).unwrap() + end.len());
        let title = element
            .split_once("<title>")
            .filter(|_| kind == "svg")
            .and_then(|(_, rest)| rest.split_once("</title>"));
        out.push_str(&rest[..at]);
        out.push_str(&title.map_or_else(|| format!("[{kind}]"), |(title, _)| format!("[chart: {title}]")));
        rest = after;
    }
    (out + rest).replace(concat!("mavid ", env!("CARGO_PKG_VERSION")), "mavid [version]")
}

#[test]
fn an_explanation() {
    let request = ExplainRequest {
        logs: vec![fixture("p01_identify_0_25s.tlog")],
        vehicle: fixture("p01_vehicle.toml").into(),
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    let study = explain(&request, &Silent).unwrap();
    insta::assert_snapshot!("explanation_text", explanation_text(&study));
    insta::assert_snapshot!("explanation_json", outlined(&ExplanationDocument::new(&study)));
    insta::assert_snapshot!("explanation_html", outline(&explanation_html(&study)));
    assert!(explained_model(&study).unwrap().contains("verdict = "));
}

#[test]
fn an_identification() {
    let request = IdentifyRequest {
        logs: vec![fixture("p04_identify_10_22s.tlog")],
        vehicle: fixture("p04_vehicle.toml").into(),
        ..IdentifyRequest::default()
    };
    let study = identify(&request, &Silent).unwrap();
    insta::assert_snapshot!("identification_text", identification_text(&study));
    insta::assert_snapshot!("identification_json", outlined(&IdentificationDocument::new(&study)));
    assert!(identified_model(&study).unwrap().contains("[identified]"));
}

#[test]
fn a_validation() {
    let request = ValidateRequest {
        logs: vec![fixture("p04_identify_10_22s.tlog")],
        models: vec![fixture("p04_vehicle.toml"), fixture("p01_vehicle.toml")],
        drafted: None,
        transient_s: 2.0,
        read: ReadSettings::default(),
    };
    let study = validate(&request, &Silent).unwrap();
    insta::assert_snapshot!("validation_text", validation_text(&study));
    insta::assert_snapshot!("validation_json", outlined(&ValidationDocument::new(&study)));
}

#[test]
fn an_inspection() {
    let (log, vehicle) = (fixture("px4_baseline_40_46s.tlog"), fixture("px4-sih.toml"));
    let vehicle = read_vehicle(&vehicle).unwrap().vehicle;
    let inspection = inspect(&log, &OpenOptions::default(), Some(&vehicle), &mut |_| {}).unwrap();
    let name = log.to_str().unwrap();
    insta::assert_snapshot!("inspection_text", inspection_text(name, &inspection));
    insta::assert_snapshot!("inspection_json", outlined(&InspectionDocument::new(name, &inspection)));
}

/// The picture that leads the report of a lag: not the noise along time, but a line whose slope is the latency.
#[test]
fn a_lag_is_the_slope_of_what_is_commanded_over_the_rate_of_change_of_the_torque() {
    let request = ExplainRequest {
        logs: vec![fixture("p04_identify_10_22s.tlog")],
        vehicle: fixture("p04_vehicle.toml").into(),
        transient_s: ExplainRequest::TRANSIENT_S,
        ..ExplainRequest::default()
    };
    let study = explain(&request, &Silent).unwrap();
    assert_eq!(study.effects.iter().map(|effect| effect.id).collect::<Vec<_>>(), ["motor_lag"]);
    let picture = study.figures().portrait.unwrap();
    assert!(picture.id == "motor_lag" && (3..6).contains(&picture.channel), "{picture:?}");
    let slope = |bins: &[Bin]| {
        let (first, last) = (bins.first().unwrap(), bins.last().unwrap());
        (last.mean - first.mean) / (last.center - first.center)
    };
    let latency_s = study.latency().parts.total_s();
    assert!((0.05..0.09).contains(&latency_s), "{latency_s}");
    assert!((slope(&picture.model) / latency_s - 1.0).abs() < 1e-6, "{}", slope(&picture.model));
    assert!((slope(&picture.recorded) / latency_s - 1.0).abs() < 0.15, "{picture:?}");
    // most of what was recorded is away from nothing by more than its band
    let is_away = |bin: &&Bin| bin.high < 0.0 || bin.low > 0.0;
    assert!(picture.recorded.iter().filter(is_away).count() >= 7, "{picture:?}");
    let page = explanation_html(&study);
    assert!(page.contains("beyond the needed") && page.contains("the slope of the line"), "no such picture");
}
