//! The pages of `effects` for the terminal.

use std::fmt::Write;

use crate::physics::WHICH_ROTOR;
use crate::study::{KnownConfusable, KnownEffect, KnownParameter, ParameterKind};
use crate::text::{compact, significant, wrapped};

/// Columns of a sentence.
const COLUMNS: usize = 100;

/// Below this distance, in standard deviations, two effects are one to a flight.
const NOT_APART: f64 = 0.1;

/// What the number of a rotor is, where it stands for itself.
const COUNTED: &str = "; in files, counted from 0 in the vehicle file's order: motor 1 is 0";

/// One line an effect.
#[must_use]
pub fn effects_text(effects: &[KnownEffect]) -> String {
    let mut page = String::from("effects that the program knows; `mavid effects ID` tells one:\n");
    for effect in effects {
        // writing to a String cannot fail
        let _ = writeln!(page, "  {:<20}{}", effect.id, effect.noun);
    }
    page.trim_end().to_owned()
}

/// The page of one effect.
#[must_use]
pub fn effect_text(effect: &KnownEffect) -> String {
    let mut parts = vec![
        format!("{}: {}", effect.id, effect.sentence),
        format!("equation\n{}", indented(&equation(effect.equation))),
        format!("parameters, with bounds for {}\n{}", effect.table_of, parameters(effect)),
        format!("usual size, by class of vehicle\n{}", usual(effect)),
        format!("confused with\n{}", indented(&confusable(effect))),
        format!("for --effects, of usual size on {}\n{}", effect.table_of, indented(effect.table.trim_end())),
    ];
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n")
}

/// The paragraphs as lines of a terminal.
fn equation(markdown: &str) -> String {
    let lines: Vec<&str> = markdown.lines().map(str::trim).collect();
    let paragraphs = lines.split(|line| line.is_empty()).filter(|lines| !lines.is_empty());
    let wrapped = |lines: &[&str]| wrapped(&lines.join(" ").replace('`', ""), COLUMNS).join("\n");
    paragraphs.map(wrapped).collect::<Vec<_>>().join("\n")
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

fn parameters(effect: &KnownEffect) -> String {
    let line = |parameter: &KnownParameter| {
        let KnownParameter { name, unit, kind, least, greatest, .. } = parameter;
        let kind = match kind {
            ParameterKind::Size => "size",
            ParameterKind::Shape => "shape",
            ParameterKind::FinerForm => "finer form, may be left out",
        };
        let scales = match (parameter.mass_power, parameter.arm_power) {
            (0, 0) => String::new(),
            (mass, arm) => format!("; bounds scale with {}", scaling(mass, arm)),
        };
        let bounds = format!("{} to {}", compact(*least), compact(*greatest));
        let counted = if *name == WHICH_ROTOR { COUNTED } else { "" };
        format!("  {name:<20}{unit:<14}{bounds:<22}{kind}{scales}{counted}")
    };
    effect.parameters.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// `mass arm^2`
fn scaling(mass: i32, arm: i32) -> String {
    let power = |name: &str, power: i32| match power {
        0 => None,
        1 => Some(name.to_owned()),
        power => Some(format!("{name}^{power}")),
    };
    [power("mass", mass), power("arm", arm)].into_iter().flatten().collect::<Vec<_>>().join(" ")
}

/// A row a parameter, a column a class.
fn usual(effect: &KnownEffect) -> String {
    if effect.usual.is_empty() {
        return "  not stated".to_owned();
    }
    if effect.usual.iter().all(|class| class.values.is_empty()) {
        return concealed(effect).join("\n");
    }
    let mut lines = vec![format!("  {:<20}{:<14}", "", "")];
    for class in &effect.usual {
        let _ = write!(lines[0], "{:>12}", class.class);
    }
    lines.push(format!("  {:<20}{:<14}", "(mass)", "kg"));
    for class in &effect.usual {
        let _ = write!(lines[1], "{:>12}", compact(class.mass_kg));
    }
    for KnownParameter { name, unit, .. } in &effect.parameters {
        let values: Vec<f64> =
            effect.usual.iter().filter_map(|class| class.values.get(name).copied()).collect();
        if values.len() == effect.usual.len() {
            let cells: String =
                values.iter().map(|value| format!("{:>12}", significant(*value, 2))).collect();
            lines.push(format!("  {name:<20}{unit:<14}{cells}"));
        }
    }
    lines.extend(concealed(effect));
    lines.join("\n")
}

/// A row a parameter for which no size by class is known.
fn concealed(effect: &KnownEffect) -> Vec<String> {
    let row = |parameter: &KnownParameter| {
        let KnownParameter { name, unit, .. } = parameter;
        let value = significant(*effect.concealed.get(name)?, 3);
        Some(format!("  {name:<20}{unit:<14}{value:>12}  size concealed in the tests; not known by class"))
    };
    effect.parameters.iter().filter_map(row).collect()
}

fn confusable(effect: &KnownEffect) -> String {
    let Some((named, flights)) = effect.named else { return "not measured".to_owned() };
    if effect.confusable.is_empty() {
        return format!("nothing: named in {named} of {flights} simulated flights that conceal it");
    }
    let line = |other: &KnownConfusable| {
        let distance = match other.least_distance {
            Some(distance) if distance < NOT_APART => ", where nothing tells them apart".to_owned(),
            Some(distance) => format!(", at least {} standard deviations apart", significant(distance, 2)),
            None => String::new(),
        };
        format!("{}: both in {} of {} flights{distance}", other.id, other.flights, other.of)
    };
    effect.confusable.iter().map(line).collect::<Vec<_>>().join("\n")
}
