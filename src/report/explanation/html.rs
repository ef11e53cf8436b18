//! `report.html` of `explain`: each section is one function, and one call in [`explanation_html`].

use super::along::along_section;
use super::answer::answer;
use super::hold_out::{hold_out, hold_out_details};
use super::limits::{named_from, not_possible};
use super::motor::{motor, sizes};
use super::pictures;
use super::rivals::rival;
use super::shown_by::shown_by;
use super::text::{ERRORS, after, before, scale, verdict};
use crate::diagnose::holdout::RateLaw;
use crate::diagnose::{Empirical, NO_LATENCY, Named, Slight, Verdict, called, clause};
use crate::report::html::{
    self, Cell, folded, folded_numbers, name, note, number, paragraph, section, table, text, warning,
};
use crate::report::number::{chance, significant, spoken, with_error};
use crate::report::page::page;
use crate::report::quality::data_quality;
use crate::study::{ExplainStudy, TriedAs};
use crate::text::capital;
use crate::vehicle::AXIS_NAMES;
use maud::{Markup, html};

/// The report: one file, nothing loaded from anywhere. The answer, what shows it, where, how much, how much better, what else
/// would have been seen; the method is folded.
#[must_use]
pub fn explanation_html(study: &ExplainStudy) -> String {
    let _stage = tracing::info_span!("report").entered();
    let numbers = study.figures();
    let method = html! {
        (pictures::details(study, &numbers))
        (hold_out_details(study))
        (evidence(study))
        (data_quality(study.given.inputs.iter().map(|input| input.path.as_str()).zip(&study.given.quality)))
        (provenance(study))
    };
    let sections = html! {
        @for said in &study.notes { (warning(&said.sentence())) }
        (pictures::proof(study, &numbers))
        (pictures::places(study, &numbers))
        (found(study))
        (rigid_body(study))
        (along_section(study))
        (hold_out(study))
        (limits(study))
        (next_flight(study))
        (folded("Method and data", &method))
    };
    page(&format!("mavid explain: {}", study.given.vehicle.name), &answer(study), &tags(study), &sections)
}

fn tags(study: &ExplainStudy) -> Vec<String> {
    let flights = study.given.inputs.len();
    let mut tags = vec![
        verdict(study),
        format!("{flights} flight{} explained", if flights == 1 { "" } else { "s" }),
        study.shown_on.heading(),
    ];
    if study.explanation.too_little_excitation {
        tags.push("too little excitation".to_owned());
    }
    if !study.limited().is_empty() {
        tags.push("limited flight".to_owned());
    }
    tags.extend(study.other_vehicle().map(|_| "hold-out of another vehicle".to_owned()));
    tags
}

fn found(study: &ExplainStudy) -> Markup {
    let heading = match study.verdict() {
        Verdict::Unexplained => "What comes closest but does not explain it".to_owned(),
        Verdict::NothingMissing => {
            format!("What was left out: nothing that {} could show", study.these_flights())
        }
        Verdict::Explained | Verdict::PartlyExplained => "How much: what was left out".to_owned(),
    };
    let content = html! {
        @for named in study.effects.iter().chain(&study.closest) { (effect(study, named)) }
        @if !study.explanation.slight.is_empty() { (traces(study)) }
        @if let Some(term) = &study.empirical { (empirical(term)) }
        @if let Some(law) = &study.rate_law { (rate_law(law)) }
    };
    section(&heading, &content)
}

fn effect(study: &ExplainStudy, effect: &Named) -> Markup {
    let rows: Vec<Vec<Cell>> = effect
        .parameters
        .iter()
        .map(|p| match motor(study, effect, p.name) {
            Some(motor) => vec![name(p.name), number(motor), text("")],
            None => vec![name(p.name), number(with_error(p.value, p.std)), text(spoken(p.unit))],
        })
        .collect();
    let caption = format!(
        "{}: z {:.1}, chance {}, {}, change of BIC {}",
        called(effect.id),
        effect.strength.z,
        chance(study.p_value(effect)),
        shown_by(effect),
        significant(study.delta_bic(effect), 3)
    );
    html! {
        (paragraph(&format!("{}.", clause(effect, study.vehicle()))))
        (table(&caption, &["parameter", "value|", "unit"], &rows))
        @for other in &effect.confusable_with {
            (note(&format!("{}.", capital(&rival(study, other)))))
        }
    }
}

fn traces(study: &ExplainStudy) -> Markup {
    let percent =
        |of: Option<f64>| number(of.map_or_else(|| "-".to_owned(), |of| significant(100.0 * of, 2)));
    let row = |of: &Slight| {
        let materiality = of.materiality.as_ref();
        vec![
            text(called(of.effect.id)),
            text(sizes(study, &of.effect)),
            number(format!("{:.1}", of.effect.strength.z)),
            percent(materiality.map(|of| of.force)),
            percent(materiality.map(|of| of.torque)),
            percent(materiality.map(|of| of.misfit)),
        ]
    };
    let rows: Vec<Vec<Cell>> = study.explanation.slight.iter().map(row).collect();
    let head = ["effect", "size", "z|", "% of the weight|", "% of the torque|", "% of the misfit|"];
    table("Traces: significant, but too small to get a name. Another cause is possible", &head, &rows)
}

fn empirical(term: &Empirical) -> Markup {
    let what = format!(
        "An empirical term, not a mechanism: a force along {}, linear between the knots and zero outside of the flown \
         range. It predicts {} % of the force residual in parts of the flight to which it was not fitted.",
        term.along.name(),
        significant(100.0 * term.gain, 2)
    );
    let row = |(at, force): (&f64, &nalgebra::Vector3<f64>)| {
        [*at, force.x, force.y, force.z].map(|value| number(significant(value, 3))).to_vec()
    };
    let rows: Vec<Vec<Cell>> = term.knots.iter().zip(&term.force_n).map(row).collect();
    let at = format!("{} ({})|", term.along.name(), term.along.unit());
    let knots = table("Empirical force", &[&at, "x (N)|", "y (N)|", "z (N)|"], &rows);
    html! { (paragraph(&what)) (folded_numbers(&format!("Its {} knots", rows.len()), &knots)) }
}

fn rate_law(law: &RateLaw) -> Markup {
    let what = "An empirical law, not a mechanism, for open-loop predictions: over 0.5 s the torques of the model predict these \
                rates or attitudes worse than no change at all. A share of them acts, and the rates decay as the controller \
                lets them: it holds for this vehicle under this controller.";
    let row = |axis: usize| {
        let values = [law.share[axis], law.decay_1_s[axis], law.offset_rad_s2[axis]];
        let values = values.map(|value| number(significant(value, 3)));
        std::iter::once(text(AXIS_NAMES[axis])).chain(values).collect()
    };
    let rows: Vec<Vec<Cell>> = (0..3).map(row).collect();
    let head = ["about body", "share of the torque|", "decay (1/s)|", "constant (rad/s^2)|"];
    html! { (paragraph(what)) (table("Empirical law of the rates", &head, &rows)) }
}

fn rigid_body(study: &ExplainStudy) -> Markup {
    let rows: Vec<Vec<Cell>> = study
        .body()
        .into_iter()
        .map(|of| {
            // both are of the same flights and err alike: their difference errs by no more than this
            let std = of.before.own_std().hypot(of.after.own_std());
            let known = of.not_determined.is_none() && of.before_not_determined.is_none();
            let moved = (of.after.value - of.before.value) / std.max(f64::MIN_POSITIVE);
            vec![
                text(of.name),
                number(significant(of.nominal, 4)),
                number(before(&of)),
                number(after(&of)),
                number(if known && !of.weighed { format!("{moved:+.1}") } else { "-".into() }),
                text(of.unit),
            ]
        })
        .collect();
    let latency = study.latency();
    let content = html! {
        (table(
            "Before: without the effects. After: estimated together with the effects. Moved: change in standard \
             errors of both together.",
            &["parameter", "nominal|", "before|", "after|", "moved|", "unit"],
            &rows,
        ))
        (note(&format!("+-: {ERRORS}.")))
        @if let Some(sentence) = scale(study) { (note(&format!("{sentence}."))) }
        @for (reason, names) in study.body_not_determined() {
            (note(&format!("{}: not determined: {reason}.", names.join(", "))))
        }
        @if latency.is_determined() {
            (note(&format!(
                "From command to rotor {} ms.",
                with_error(1e3 * latency.total_s, 1e3 * latency.std_s)
            )))
        } @else {
            (note(&format!("From command to rotor: not determined: {NO_LATENCY}.")))
        }
    };
    section("Rigid body", &content)
}

fn evidence(study: &ExplainStudy) -> Markup {
    let rows: Vec<Vec<Cell>> = study
        .tried()
        .into_iter()
        .map(|tried| {
            vec![
                text(match tried.tried_as {
                    TriedAs::Taken(step) => format!("step {step}: taken"),
                    TriedAs::Rival => "rival".to_owned(),
                    TriedAs::Left => "in the end: not named".to_owned(),
                }),
                text(match tried.form.as_str() {
                    "" => called(tried.id).to_owned(),
                    form => format!("{} ({form})", called(tried.id)),
                }),
                number(format!("{:.1}", tried.z)),
                number(significant(100.0 * tried.gain, 2)),
                number(chance(tried.p_cluster)),
                text(tried.refused.unwrap_or("")),
            ]
        })
        .collect();
    let gates = &study.given.settings.gates;
    let caption = format!(
        "A name needs z above {}, distributed over the flight, {} % of the residual energy, and a physically possible \
         size. A lag, a delay and gusts have tests of their own",
        gates.z,
        100.0 * gates.gain
    );
    let content = html! {
        (table(&caption, &["", "effect", "z|", "gain %|", "chance over blocks|", "refused by"], &rows))
        @if let Some(lack) = &study.explanation.lack_of_fit {
            (note(&format!(
                "Lack of fit at the harmonics after all names: chance {} over {} periods of {:.1} s.",
                chance(lack.p_least()),
                lack.periods,
                lack.period_s
            )))
        }
    };
    section("Evidence", &content)
}

fn next_flight(study: &ExplainStudy) -> Markup {
    let Some(next) = &study.next_flight else { return Markup::default() };
    let content = match next {
        Ok(next) => paragraph(&format!("{}.", capital(&next.sentence()))),
        Err(why) => note(&format!("None was designed: {why}.")),
    };
    section("The next flight", &content)
}

fn limits(study: &ExplainStudy) -> Markup {
    let limits = &study.explanation.limits;
    let row = |(id, from): (&'static str, String)| vec![text(called(id)), name(id), text(from)];
    let rows: Vec<Vec<Cell>> = named_from(limits).into_iter().map(row).collect();
    let content = table(
        &format!("The smallest size of each effect that {} would have shown", study.these_flights()),
        &["effect", "identifier", "from"],
        &rows,
    );
    let content = html! {
        (content)
        @if let Some(unseen) = not_possible(limits) { (note(&unseen)) }
    };
    section("What else would have been seen", &content)
}

fn provenance(study: &ExplainStudy) -> Markup {
    let mut files: Vec<_> = study.given.inputs.iter().map(|input| ("explained", input)).collect();
    files.extend(study.held_out_inputs().iter().map(|input| ("hold-out", input)));
    let settings = &study.given.settings;
    html::provenance(
        &files,
        &[
            ("left out at the beginning, s", significant(study.given.transient_s, 3)),
            ("half width of the kernel, s", significant(settings.half_width_s, 3)),
            ("least z", significant(settings.gates.z, 3)),
            ("least share of the residual energy", significant(settings.gates.gain, 2)),
            ("chance of the cluster test", significant(settings.gates.p_cluster, 2)),
        ],
    )
}
