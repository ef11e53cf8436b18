//! The vehicle from above, forward upwards, with marks on its motors.

use crate::vehicle::{Rotor, Spin};
use maud::{Markup, html};

/// Side of the drawing, and half the span of the rotors in it, units of its box.
const SIDE: f64 = 320.0;
const SPAN: f64 = 100.0;
/// Radius of a rotor, of its box.
const ROTOR: f64 = 34.0;
/// From one line of words to the next, of its box.
const LINE: f64 = 14.0;
/// Colours that hold in light and dark: of what is meant, and of what it may be instead.
pub(super) const MEANT: &str = "#d55e00";
pub(super) const RIVAL: &str = "#e69f00";

/// A mark on a motor.
pub(super) struct Mark {
    /// of its ring
    pub(super) colour: &'static str,
    /// whether its area has the colour, too
    pub(super) is_filled: bool,
    /// lines of words below it
    pub(super) words: Vec<String>,
}

/// The drawing; `label` says in words what it shows.
pub(super) fn vehicle_drawing(
    rotors: &[Rotor],
    label: &str,
    mark: impl Fn(usize) -> Option<Mark>,
    centre_is_meant: bool,
) -> Markup {
    let reach = rotors.iter().map(|rotor| rotor.position_m.xy().norm()).fold(f64::MIN_POSITIVE, f64::max);
    let middle = SIDE / 2.0;
    let at = |x: f64, y: f64| (middle - SPAN * y / reach, middle - SPAN * x / reach);
    html! {
        svg.vehicle viewBox=(format!("0 0 {SIDE} {SIDE}")) role="img" aria-label=(label) fill="currentColor" {
            @for (place, rotor) in rotors.iter().enumerate() {
                @let (x, y) = at(rotor.position_m.x, rotor.position_m.y);
                @let mark = mark(place);
                @let colour = mark.as_ref().map_or("currentColor", |mark| mark.colour);
                @let is_filled = mark.as_ref().is_some_and(|mark| mark.is_filled);
                @let (hub_x, hub_y) = edge((middle, middle), (x, y));
                line x1=(middle) y1=(middle) x2=(round(hub_x)) y2=(round(hub_y)) stroke="currentColor" stroke-width="5" stroke-opacity="0.35" {}
                circle cx=(round(x)) cy=(round(y)) r=(ROTOR) fill=(if is_filled { colour } else { "none" })
                    fill-opacity="0.35" stroke=(colour) stroke-width=(if mark.is_some() { "4" } else { "2" }) {}
                text x=(round(x)) y=(round(y - 2.0)) text-anchor="middle" font-weight="bold" { (place + 1) " " (sense(rotor.spin)) }
                text x=(round(x)) y=(round(y + 12.0)) text-anchor="middle" { (rotor.place_words()) }
                @for (line, words) in mark.map_or_else(Vec::new, |mark| mark.words).iter().enumerate() {
                    text x=(round(x)) y=(round(y + ROTOR + LINE * (line + 1) as f64)) text-anchor="middle" font-weight="bold" { (words) }
                }
            }
            circle cx=(middle) cy=(middle) r="6" fill=(if centre_is_meant { MEANT } else { "currentColor" }) {}
            path d=(format!("M{middle} {} l-7 14 h14 z", middle - 62.0)) fill="currentColor" fill-opacity="0.6" {}
            text x=(middle) y=(middle - 68.0) text-anchor="middle" { "forward" }
        }
    }
}

/// Where an arm meets the circle of its rotor: it does not run through the words in it.
fn edge((from_x, from_y): (f64, f64), (x, y): (f64, f64)) -> (f64, f64) {
    let (along_x, along_y) = (x - from_x, y - from_y);
    let share = (1.0 - ROTOR / along_x.hypot(along_y).max(ROTOR)).max(0.0);
    (from_x + share * along_x, from_y + share * along_y)
}

fn sense(spin: Spin) -> &'static str {
    if spin == Spin::Cw { "cw" } else { "ccw" }
}

/// A coordinate without digits that nobody sees.
fn round(value: f64) -> f64 {
    (10.0 * value).round() / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Vector3;

    #[test]
    fn motors_are_numbered_as_the_autopilot_does_and_arms_end_at_them() {
        let rotor = |name: &str| Rotor { name: name.to_owned(), position_m: Vector3::x(), spin: Spin::Cw };
        assert_eq!(edge((160.0, 160.0), (260.0, 160.0)), (226.0, 160.0));
        assert_eq!(edge((160.0, 160.0), (170.0, 160.0)), (160.0, 160.0));
        let mark = |place| {
            (place == 0).then_some(Mark {
                colour: MEANT,
                is_filled: true,
                words: vec!["80 %".into(), "70 %".into()],
            })
        };
        let drawn = vehicle_drawing(&[rotor("a"), rotor("b")], "all", mark, false).into_string();
        assert!(
            drawn.contains("80 %")
                && drawn.contains("70 %")
                && drawn.contains("1 cw")
                && drawn.contains("2 cw")
                && !drawn.contains("0 cw")
        );
    }
}
