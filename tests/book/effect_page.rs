//! The page of one effect.

use super::blocks::{listed, paragraph, table};
use super::measured::{EffectRun, Measured};
use super::ordinary::ordinary;
use super::overview::title;
use super::{MEASURED, WRITE};
use mavid::diagnose::UsualSize;
use mavid::diagnose::signatures::signature_of;
use mavid::export::{Format, places};
use mavid::physics::{Airframe, Effect, Parameter, REFERENCE_SIZE};
use mavid::simulate::random_vehicle;
use mavid::text::{compact, significant, spoken};

/// The whole page.
pub fn page(effect: &dyn Effect, measured: &Measured) -> String {
    let id = effect.id();
    let heading = format!("# {}", title(effect));
    let origin = format!("<!-- Made from the code and {MEASURED} by `{WRITE}`. -->");
    let meaning = paragraph(&format!("`{id}`. {}", effect.sentence()));
    let mut parts = vec![origin, heading, meaning];
    if measured.pictures.iter().any(|picture| picture.id == id) {
        parts.push(format!("![Residual force or torque with {id} concealed]({id}.svg)"));
        parts.push(paragraph(&format!("*{}*", caption(effect))));
    }
    parts.extend(["## Equation".to_owned(), equation(effect)]);
    parts.extend(["## Parameters".to_owned(), parameters(effect), bounds_text(effect)]);
    parts.extend(["## What a flight needs".to_owned(), needs(effect)]);
    parts.extend(["## Usual size and accuracy".to_owned(), accuracy(effect, measured)]);
    parts.extend(["## Confusable effects".to_owned(), confusable(id, measured)]);
    parts.extend(["## Export".to_owned(), simulators(id)]);
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n") + "\n"
}

fn caption(effect: &dyn Effect) -> String {
    format!(
        "Residual of a rigid body, and of the model that `explain` found, in a simulated flight in which {} was concealed.",
        usual(effect)
    )
}

/// `dx` = 0.3 N/(m/s) per kg, ...: the sizes that are concealed.
pub fn usual(effect: &dyn Effect) -> String {
    let Some(signature) = signature_of(effect.id()) else { return String::new() };
    let all = || effect.parameters().iter().chain(effect.finer_parameters());
    let unit =
        |name: &str| all().find(|parameter| parameter.name == name).map_or("-", |parameter| parameter.unit);
    if signature.sizes.is_empty() {
        let names: Vec<_> =
            effect.parameters().iter().map(|parameter| format!("`{}`", parameter.name)).collect();
        return format!("{} of usual size", listed(&names));
    }
    let value = |(name, size): &(&str, UsualSize)| {
        let (number, by) = match size {
            UsualSize::Of(value) => (*value, ""),
            UsualSize::PerMass(per) => (*per, " per kg"),
            UsualSize::PerInertia(per) => (*per, " per kg m^2"),
        };
        let unit = if unit(name) == "-" { String::new() } else { format!(" {}", unit(name)) };
        format!("`{name}` = {}{unit}{by}", compact(number))
    };
    let of_size = signature.sizes.iter().filter(|(_, size)| *size != UsualSize::Of(0.0));
    listed(&of_size.map(value).collect::<Vec<_>>())
}

/// The paragraphs of an equation, broken as the book breaks lines.
fn equation(effect: &dyn Effect) -> String {
    let lines: Vec<&str> = effect.equation().lines().map(str::trim).collect();
    let paragraphs = lines.split(|line| line.is_empty()).filter(|lines| !lines.is_empty());
    paragraphs.map(|lines| paragraph(&lines.join(" "))).collect::<Vec<_>>().join("\n\n")
}

fn parameters(effect: &dyn Effect) -> String {
    let amounts = signature_of(effect.id()).map_or(&[][..], |signature| signature.amounts);
    let (common, finer) = (effect.parameters(), effect.finer_parameters());
    let rows: Vec<Vec<String>> = common
        .iter()
        .chain(finer)
        .enumerate()
        .map(|(slot, parameter)| {
            let kind = match slot {
                slot if slot >= common.len() => "finer form",
                slot if amounts.contains(&slot) => "size",
                _ => "shape",
            };
            let (least, greatest) = parameter.bounds.at(&REFERENCE_SIZE);
            vec![
                format!("`{}`", parameter.name),
                parameter.unit.to_owned(),
                kind.to_owned(),
                format!("{} to {}", compact(least), compact(greatest)),
                scaling(parameter),
            ]
        })
        .collect();
    table(&["parameter", "unit", "kind", "bounds", "bounds scale with"], &rows)
}

/// `m l^2`, or nothing.
fn scaling(parameter: &Parameter) -> String {
    let power = |symbol: &str, power: i32| match power {
        0 => None,
        1 => Some(symbol.to_owned()),
        power => Some(format!("{symbol}^{power}")),
    };
    let (mass, arm) = parameter.bounds.powers();
    let factors: Vec<String> = [power("m", mass), power("l", arm)].into_iter().flatten().collect();
    if factors.is_empty() { "-".to_owned() } else { factors.join(" ") }
}

fn bounds_text(effect: &dyn Effect) -> String {
    let mut all = effect.parameters().iter().chain(effect.finer_parameters());
    if all.all(|parameter| parameter.bounds.powers() == (0, 0)) {
        return String::new();
    }
    paragraph(&format!(
        "Scaled bounds are those of a vehicle with mass m = {} kg and arms of l = {} m.",
        compact(REFERENCE_SIZE.mass_kg),
        compact(REFERENCE_SIZE.arm_m)
    ))
}

fn needs(effect: &dyn Effect) -> String {
    let mut lines = Vec::new();
    for need in signature_of(effect.id()).map_or(&[][..], |signature| signature.needs) {
        let (what, why) = need.words();
        lines.push(format!("- in the log: {what} ({why})"));
    }
    lines.extend(ordinary(effect.id()).map(|entry| format!("- in the flight: {}", entry.shown_by.words())));
    let mut bare = random_vehicle(1).truth;
    (bare.propulsion.rotor_radius_m, bare.propulsion.thrust_coefficient) = (None, None);
    bare.propulsion.law = mavid::vehicle::ThrustLaw::Curve { thrust_max_n: 10.0, expo: 1.0 };
    let missing = Airframe::new(&bare).ok().and_then(|airframe| effect.missing(&airframe));
    lines.extend(missing.map(|what| format!("- in the vehicle file: `{what}`")));
    lines.join("\n")
}

fn run<'a>(id: &str, measured: &'a Measured) -> Option<&'a EffectRun> {
    measured.effects.iter().find(|run| run.id == id)
}

fn accuracy(effect: &dyn Effect, measured: &Measured) -> String {
    let id = effect.id();
    let Some(run) = run(id, measured) else { return "Not measured.".to_owned() };
    let mut text = format!(
        "With {} (kg of mass, kg m^2 of the mean of Ixx and Iyy), the effect was named in {} of {} [simulated \
         flights](../figures-diagnosis.md#right-names)",
        usual(effect),
        run.named,
        run.flights
    );
    if run.in_set > 0 {
        text += &format!(", and was in the confusable set of the named effect in {} more", run.in_set);
    }
    if run.traces > 0 {
        text += &format!(", and was stated as a trace in {}", run.traces);
    }
    text += ".";
    if let Some(error) = run.size_error_percent {
        text += &format!(" The median error of the size was {} %.", significant(error, 2));
    }
    let limits: Vec<String> = measured
        .limits
        .iter()
        .filter(|limit| limit.id == id)
        .map(|limit| {
            format!("`{}` {} {}", limit.parameter, significant(limit.median, 2), spoken(&limit.unit))
        })
        .collect();
    if !limits.is_empty() {
        text += &format!(
            " The [detection limits](../figures-diagnosis.md#detection-limits), as medians over random vehicles, are {}.",
            listed(&limits)
        );
    }
    paragraph(&text.replace(" -.", ".").replace(" -,", ","))
}

fn confusable(id: &str, measured: &Measured) -> String {
    let Some(run) = run(id, measured) else { return "Not measured.".to_owned() };
    if run.confusable.is_empty() {
        return paragraph(&format!("None in the {} flights in which it was named.", run.named));
    }
    let rows: Vec<Vec<String>> = run
        .confusable
        .iter()
        .map(|(other, confused)| {
            let distance =
                confused.least_distance.map_or("-".to_owned(), |distance| significant(distance, 2));
            vec![
                format!("[`{other}`]({other}.md)"),
                format!("{} of {}", confused.flights, run.named),
                distance,
            ]
        })
        .collect();
    let text = "Effects in the confusable set of this name, and the smallest distance between both in standard deviations. \
                Effects less than five apart are not separated by the flight.";
    format!("{}\n\n{}", paragraph(text), table(&["effect", "flights", "smallest distance"], &rows))
}

fn simulators(id: &str) -> String {
    let all = [
        (Format::Px4Sih, "`px4-sih`"),
        (Format::ArdupilotSitl, "`ardupilot-sitl`"),
        (Format::Sdf, "`sdf`"),
        (Format::Mjcf, "`mjcf`"),
        (Format::Rotorpy, "`rotorpy`"),
    ];
    let with_place = places(id);
    let (holds, leaves_out): (Vec<_>, Vec<_>) =
        all.into_iter().partition(|(format, _)| with_place.contains(format));
    let names =
        |of: Vec<(Format, &str)>| listed(&of.iter().map(|(_, name)| (*name).to_owned()).collect::<Vec<_>>());
    if holds.is_empty() {
        return "[`mavid export`](../simulation.md#export-a-model) leaves it out in every format and says so.".to_owned();
    }
    let mut text =
        format!("[`mavid export`](../simulation.md#export-a-model) writes it for {}.", names(holds));
    if !leaves_out.is_empty() {
        text += &format!(" It leaves it out for {} and says so.", names(leaves_out));
    }
    paragraph(&text)
}
