//! The sections of the report that hold pictures: what shows the name, and where the models miss.

use super::figures;
use crate::diagnose::Verdict;
use crate::diagnose::locate::{Followed, Portrait};
use crate::report::chart::inline;
use crate::report::html::{figure, note, section};
use crate::report::number::significant;
use crate::report::vehicle_drawing::{MEANT, Mark, vehicle_drawing};
use crate::study::{ExplainStudy, Figures, RecordedAndSimulated};
use maud::{Markup, html};

/// Number of flights whose recorded and simulated motion is drawn.
const DRAWN: usize = 3;
const RECORDED: &str = "Weighted with the weak form's kernel of 0.4 s.";
const SHADED: &str = "Shaded: the error of the rigid body alone is larger than noise.";
const PORTRAIT: &str = "Dots: recorded, less everything else of the model, mean in bins with 95 % bands of a bootstrap over the \
                        flight's periods. Line: what this effect does in the model found.";
/// What a picture of a state would show of a vehicle without what it shows.
const SCATTERED: &str = "the dots would scatter about zero from one side of the picture to the other, and nearly all of \
                         their bands would contain zero.";

/// The picture that shows the answer, with the vehicle beside it.
pub(super) fn proof(study: &ExplainStudy, numbers: &Figures) -> Markup {
    let picture = if let Some(of) = &numbers.portrait {
        figure(&inline(&figures::portrait(of, study.vehicle())), &portrait_caption(study, of))
    } else if let Some(of) = numbers.followed.as_ref().filter(|_| study.effects.is_empty()) {
        figure(
            &inline(&figures::followed(of)),
            "Mean residual in bins of the state, with 95 % bands of a bootstrap over the flight's periods.",
        )
    } else if let Some(of) = numbers.recorded.first() {
        recorded(study, of)
    } else {
        Markup::default()
    };
    let content = html! {
        div.sides { div.more { (picture) } @if let Some(drawn) = vehicle(study) { div.less { (drawn) } } }
        p.note.live-only { "Drag over a plot to zoom in, double-click to see all. The cursor shows the values." }
    };
    let shows_nothing = study.effects.is_empty() && study.verdict() == Verdict::NothingMissing;
    section(if shows_nothing { "What is left" } else { "What shows it" }, &content)
}

/// Recorded and simulated motion.
fn recorded(study: &ExplainStudy, of: &RecordedAndSimulated) -> Markup {
    let after = figures::model_after_along(study, of.axis);
    figure(&inline(&figures::recorded_and_simulated(of, after)), &recorded_caption(&of.spans_s))
}

/// What is shaded is said where something is: `spans_s` are the times of it, s.
fn recorded_caption(spans_s: &[[f64; 2]]) -> String {
    if spans_s.is_empty() { RECORDED.to_owned() } else { format!("{RECORDED} {SHADED}") }
}

/// That the dots are flatter than the line, as a sentence behind a space; empty where they are not, or where the size is from the same data.
fn flatter(study: &ExplainStudy, of: &Portrait) -> String {
    study.flatter(of).map_or_else(String::new, |slope| {
        format!(
            " The dots have {} of the line's slope: they are drawn over the autopilot's own velocity, whose errors flatten them. The size is \
             from the flight path as it was reconstructed.",
            significant(slope, 2)
        )
    })
}

fn portrait_caption(study: &ExplainStudy, of: &Portrait) -> String {
    let Followed::TorqueRate(_) = of.state else {
        return format!(
            "{PORTRAIT}{} If the vehicle did not have this effect, {SCATTERED}",
            flatter(study, of)
        );
    };
    let parts = study.latency().parts;
    let ms = |time_s: f64| significant(1e3 * time_s, 3);
    format!(
        "Rotors that follow late give the torque that was commanded before. So what the commands give is beyond what the motion needs by the latency times the rate of change of the torque: the slope of the line, {} ms (delay {} ms, lag {} ms). Dots: recorded, less everything else of the model, mean in bins with 95 % bands of a bootstrap over the flight's periods. If each rotor followed its command at once, {SCATTERED}",
        ms(parts.total_s()),
        ms(parts.delay_s),
        ms(parts.lag_s)
    )
}

/// The vehicle with the motor that a name is about; `None` where there is no such name.
fn vehicle(study: &ExplainStudy) -> Option<Markup> {
    let rotors = &study.vehicle().rotors;
    let meant: Vec<usize> = study.effects.iter().filter_map(|named| study.motor_of(named)).collect();
    let words: Vec<String> = meant.iter().map(|&place| study.vehicle().motor_words(place)).collect();
    let label = format!("the vehicle from above: {} is meant", words.join("; "));
    let mark = |place: usize| {
        meant.contains(&place).then(|| Mark {
            colour: MEANT,
            is_filled: true,
            words: vec!["this one".to_owned()],
        })
    };
    let caption = format!("From above, forward upwards. Filled: {}.", words.join("; "));
    (!meant.is_empty()).then(|| figure(&vehicle_drawing(rotors, &label, mark, false), &caption))
}

/// Where and when the models miss.
pub(super) fn places(study: &ExplainStudy, numbers: &Figures) -> Markup {
    let after = figures::model_after(study);
    let shown_above = numbers.portrait.is_none() && (numbers.followed.is_none() || !study.effects.is_empty());
    let content = html! {
        @for of in numbers.recorded.iter().take(DRAWN).skip(usize::from(shown_above)) {
            (recorded(study, of))
        }
        @if let Some(of) = &study.path() {
            (figure(&figures::path(of, after).inline(), ""))
        }
        @if let Some(of) = &numbers.heat {
            (figure(&figures::heat(of).inline(), "Full colour: at least five times the residual after."))
        }
    };
    section("Where", &content)
}

/// The pictures of the method.
pub(super) fn details(study: &ExplainStudy, numbers: &Figures) -> Markup {
    let after = figures::model_after(study);
    let content = html! {
        @if let Some(of) = &numbers.left {
            @let after = figures::model_after_along(study, of.axis);
            (figure(&inline(&figures::left_along_time(of, after)), "Recorded less simulated."))
        }
        @if let Some(of) = numbers.followed.as_ref().filter(|_| !study.effects.is_empty()) {
            (figure(
                &inline(&figures::followed(of)),
                "Mean residual in bins of the state, with 95 % bands of a bootstrap over the flight's periods.",
            ))
        }
        (figure(&figures::axes(&numbers.axes, after).inline(), "Root mean square of each axis."))
        @if let Some(of) = &numbers.harmonics {
            (figure(
                &inline(&figures::harmonics(of)),
                "With a periodic trajectory, everything that the model lacks is at the harmonics; noise is also \
                 between them. A ratio of about 1 is noise.",
            ))
        }
        (note("The kernel of the weak form averages over 0.4 s: each point holds a fifth of a second before and after it."))
    };
    section("More pictures", &content)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shade_is_explained_where_there_is_one() {
        assert_eq!(recorded_caption(&[]), RECORDED);
        assert!(recorded_caption(&[[1.0, 2.5]]).ends_with(SHADED));
    }
}
