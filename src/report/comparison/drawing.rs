//! The vehicle from above, with what changed of it.

use crate::change::What;
use crate::study::{Changed, CompareStudy};
use crate::vehicle::Spin;
use maud::{Markup, html};

/// Side of the drawing, and half the span of the rotors in it, units of its box.
const SIDE: f64 = 320.0;
const SPAN: f64 = 100.0;
/// Radius of a rotor, of its box.
const ROTOR: f64 = 34.0;
/// Colours that hold in light and dark: of what changed, and of what it may be instead.
const CHANGED: &str = "#d55e00";
const RIVAL: &str = "#e69f00";

/// The vehicle from above, forward upwards: the rotor that changed is filled, what it may be instead is ringed.
pub(super) fn drawing(study: &CompareStudy) -> Markup {
    let rotors = &study.vehicle.rotors;
    let reach = rotors.iter().map(|rotor| rotor.position_m.xy().norm()).fold(f64::MIN_POSITIVE, f64::max);
    let middle = SIDE / 2.0;
    let at = |x: f64, y: f64| (middle - SPAN * y / reach, middle - SPAN * x / reach);
    let is_square = format!("0 0 {SIDE} {SIDE}");
    html! {
        svg viewBox=(is_square) role="img" aria-label="the vehicle from above" style="max-width:22rem" {
            @for (place, rotor) in rotors.iter().enumerate() {
                @let (x, y) = at(rotor.position_m.x, rotor.position_m.y);
                @let (colour, is_filled) = colour(study, place);
                line x1=(middle) y1=(middle) x2=(round(x)) y2=(round(y)) stroke="currentColor" stroke-width="5" stroke-opacity="0.35" {}
                circle cx=(round(x)) cy=(round(y)) r=(ROTOR) fill=(if is_filled { colour } else { "none" })
                    fill-opacity="0.35" stroke=(colour) stroke-width="2.5" {}
                text x=(round(x)) y=(round(y - 2.0)) text-anchor="middle" fill="currentColor" { (place + 1) " " (sense(rotor.spin)) }
                text x=(round(x)) y=(round(y + 12.0)) text-anchor="middle" fill="currentColor" { (rotor.name) }
                @if let Some(words) = factor(study, place) {
                    text x=(round(x)) y=(round(y + ROTOR + 14.0)) text-anchor="middle" font-weight="bold" fill=(CHANGED) { (words) }
                }
            }
            circle cx=(middle) cy=(middle) r="6" fill=(if of_centre(study) { CHANGED } else { "currentColor" }) {}
            path d=(format!("M{middle} {} l-7 14 h14 z", middle - 62.0)) fill="currentColor" fill-opacity="0.6" {}
            text x=(middle) y=(middle - 68.0) text-anchor="middle" fill="currentColor" { "forward" }
        }
    }
}

fn sense(spin: Spin) -> &'static str {
    if spin == Spin::Cw { "cw" } else { "ccw" }
}

/// A coordinate without digits that nobody sees.
fn round(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

/// All that changed: between the groups, or along the flights.
fn changes(study: &CompareStudy) -> impl Iterator<Item = &crate::study::Change> {
    let along = study.history.iter().filter(|_| study.compared.is_none()).map(|step| &step.change);
    study.compared.iter().chain(along).flat_map(|compared| &compared.changes)
}

fn colour(study: &CompareStudy, place: usize) -> (&'static str, bool) {
    if changes(study).any(|change| change.what == Changed::Rotor(place)) {
        (CHANGED, true)
    } else if changes(study).any(|change| change.rivals.contains(&What::Rotor(place))) {
        (RIVAL, false)
    } else {
        ("currentColor", false)
    }
}

fn of_centre(study: &CompareStudy) -> bool {
    changes(study).any(|change| matches!(change.what, Changed::CentreOfMass(_)))
}

/// What is left of a rotor's thrust, percent.
fn factor(study: &CompareStudy, place: usize) -> Option<String> {
    let change = changes(study).find(|change| change.what == Changed::Rotor(place))?;
    let (after, std) = (change.moved?.after.0, change.moved?.by.1);
    Some(format!("{:.0} +- {:.0} %", 100.0 * after, (100.0 * std).max(1.0)))
}
