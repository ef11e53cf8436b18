//! What the program knows of an effect: equation, parameters, usual sizes, confusable effects, and a table for `--effects`.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde::{Deserialize, Serialize};

use crate::autopilot::Frame;
use crate::diagnose::called;
use crate::diagnose::signatures::signature_of;
use crate::draft::Given;
use crate::physics::effects::ALL;
use crate::physics::{Effect, Parameter, WHICH_ROTOR};
use crate::text::{compact, significant};
use crate::vehicle::Vehicle;

use super::effect_name::effect_of;
use super::{StudyError, VehicleGiven};

/// What `cargo bench --bench explain` measured.
const MEASURED: &str = include_str!("../../docs/measured.json");

/// Classes of vehicles by what one of them weighs, kg.
const CLASSES: [(&str, f64); 4] = [("palm-sized", 0.03), ("small", 0.25), ("medium", 2.0), ("large", 8.0)];
/// The frame of each.
const CLASS_FRAME: &str = "quadrotor-x";

/// The class whose lengths are those of the signatures: they were chosen for vehicles of 0.4 to 3 kg.
const LENGTHS_OF: &str = "medium";
/// Parameters whose example is a size concealed in the tests, on vehicles of 0.4 to 3 kg, and tells nothing of other vehicles: a
/// pack of four cells, and a moment that does not grow with the inertia of small vehicles.
const OF_TESTS: [(&str, &str); 2] = [("battery_sag", "full_voltage"), ("blade_flapping", "k")];

/// What the program knows of one effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KnownEffect {
    /// identifier, as in files
    pub id: &'static str,
    /// what it is called
    pub noun: &'static str,
    /// what it does
    pub sentence: &'static str,
    /// equation and source, in Markdown
    pub equation: &'static str,
    /// the finer ones last
    pub parameters: Vec<KnownParameter>,
    /// an example of its size, by class of vehicle; without the parameters of [`KnownEffect::concealed`], and without the number of a rotor
    pub usual: Vec<UsualOfClass>,
    /// size concealed in the tests on [`KnownEffect::table_of`], of parameters for which no size by class is known, in the unit of each
    pub concealed: BTreeMap<&'static str, f64>,
    /// effects that were not separated from it
    pub confusable: Vec<KnownConfusable>,
    /// flights in which it was concealed and it was named, of how many; `None` where it was not measured
    pub named: Option<(usize, usize)>,
    /// an `[[effect]]` table for `--effects`, of usual size on [`KnownEffect::table_of`]
    pub table: String,
    /// the vehicle of the table
    pub table_of: String,
}

/// A parameter of an effect.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KnownParameter {
    /// in files
    pub name: &'static str,
    /// SI, `-` if none
    pub unit: &'static str,
    /// what it is
    pub kind: ParameterKind,
    /// least plausible value on the vehicle of the table, in `unit`
    pub least: f64,
    /// greatest plausible value on it, in `unit`
    pub greatest: f64,
    /// power of the vehicle's mass with which the bounds scale
    pub mass_power: i32,
    /// power of its arms
    pub arm_power: i32,
}

/// What a parameter is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum ParameterKind {
    /// how much there is of the effect
    Size,
    /// how it acts
    Shape,
    /// of its finer form, and may be left out
    FinerForm,
}

/// A usual size on a class of vehicles.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct UsualOfClass {
    /// the class
    pub class: &'static str,
    /// kg
    pub mass_kg: f64,
    /// in the unit of each parameter
    pub values: BTreeMap<&'static str, f64>,
}

/// An effect that was not separated from another one.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KnownConfusable {
    /// which
    pub id: String,
    /// flights in which it was in the confusable set
    pub flights: usize,
    /// of how many in which the effect was named
    pub of: usize,
    /// smallest distance of both, standard deviations
    pub least_distance: Option<f64>,
}

#[derive(Deserialize)]
struct Measured {
    effects: Vec<Run>,
}

#[derive(Deserialize)]
struct Run {
    id: String,
    flights: usize,
    named: usize,
    confusable: BTreeMap<String, Confused>,
}

#[derive(Deserialize)]
struct Confused {
    flights: usize,
    least_distance: Option<f64>,
}

/// What is known of the effect that is called `id` (its identifier, or its name), or of all effects without it; tables and bounds are for `vehicle`.
///
/// # Errors
/// [`StudyError::File`] where there is no such effect.
pub fn known_effects(id: Option<&str>, vehicle: &Vehicle) -> Result<Vec<KnownEffect>, StudyError> {
    let chosen: Vec<&'static dyn Effect> = match id {
        Some(name) => {
            let found = effect_of(name);
            vec![found.map_err(|why| StudyError::File { file: "effects".to_owned(), why })?]
        }
        None => ALL.to_vec(),
    };
    let measured: Measured = serde_json::from_str(MEASURED).map_err(|error| StudyError::File {
        file: "docs/measured.json".to_owned(),
        why: error.to_string(),
    })?;
    let classes = classes()?;
    Ok(chosen.into_iter().map(|effect| known(effect, (vehicle, &classes), &measured)).collect())
}

/// One vehicle of each class, drafted by rules of thumb.
fn classes() -> Result<Vec<(&'static str, Vehicle)>, StudyError> {
    let of_class = |(class, mass_kg): (&'static str, f64)| {
        let given = Given { mass_kg, size_m: None, frame: Frame::of_id(CLASS_FRAME) };
        Ok((class, VehicleGiven::Weighed(given).alone()?.0.vehicle))
    };
    CLASSES.into_iter().map(of_class).collect()
}

fn known(
    effect: &'static dyn Effect,
    (of, classes): (&Vehicle, &[(&'static str, Vehicle)]),
    measured: &Measured,
) -> KnownEffect {
    let id = effect.id();
    let reference = classes.iter().find(|(class, _)| *class == LENGTHS_OF).map(|(_, vehicle)| vehicle);
    let usual = |vehicle: &Vehicle| {
        let values = signature_of(id)?.usual_values(vehicle)?.into_iter();
        let scaled =
            |(name, value)| (name, value * times(effect, name, (vehicle, reference.unwrap_or(vehicle))));
        Some(values.map(scaled).collect::<Vec<(&'static str, f64)>>())
    };
    let is_of_tests = |name: &str| OF_TESTS.contains(&(id, name));
    // which rotor it is, is no size
    let has_size = |name: &str| name != WHICH_ROTOR && !is_of_tests(name);
    let of_class = |(class, vehicle): &(&'static str, Vehicle)| {
        let values = usual(vehicle)?.into_iter().filter(|(name, _)| has_size(name)).collect();
        Some(UsualOfClass { class, mass_kg: vehicle.body.mass_kg, values })
    };
    let run = measured.effects.iter().find(|run| run.id == id);
    KnownEffect {
        id,
        noun: called(id),
        sentence: effect.sentence(),
        equation: effect.equation(),
        parameters: parameters(effect, of),
        usual: classes.iter().filter_map(of_class).collect(),
        concealed: usual(of).into_iter().flatten().filter(|(name, _)| is_of_tests(name)).collect(),
        confusable: run.map(|run| confusable(run, measured)).unwrap_or_default(),
        named: run.map(|run| (run.named, run.flights)),
        table: table(effect, of, &usual(of).unwrap_or_default()),
        table_of: of.name.clone(),
    }
}

/// By how much the example of a length is greater on a vehicle than on the reference: as their arms. 1 of what is no length of the
/// vehicle.
fn times(effect: &dyn Effect, name: &str, (vehicle, reference): (&Vehicle, &Vehicle)) -> f64 {
    let powers = effect.parameters().iter().find(|one| one.name == name).map(|one| one.bounds.powers());
    let arms = vehicle.size().arm_m / reference.size().arm_m;
    powers.filter(|(mass, _)| *mass == 0).map_or(1.0, |(_, arm)| arms.powi(arm))
}

/// Bounds on a vehicle, in the parameter's unit: the number of a rotor is that of one of its own.
fn bounds(parameter: &Parameter, of: &Vehicle) -> (f64, f64) {
    let (least, greatest) = parameter.bounds.at(&of.size());
    let last = of.rotors.len().saturating_sub(1) as f64;
    (least, if parameter.is_rotor() { greatest.min(last) } else { greatest })
}

fn parameters(effect: &dyn Effect, of: &Vehicle) -> Vec<KnownParameter> {
    let amounts = signature_of(effect.id()).map_or(&[][..], |signature| signature.amounts);
    let common = effect.parameters();
    let known = |(slot, parameter): (usize, &Parameter)| {
        let (least, greatest) = bounds(parameter, of);
        let (mass_power, arm_power) = parameter.bounds.powers();
        let kind = match slot {
            slot if slot >= common.len() => ParameterKind::FinerForm,
            slot if amounts.contains(&slot) => ParameterKind::Size,
            _ => ParameterKind::Shape,
        };
        let Parameter { name, unit, .. } = *parameter;
        KnownParameter { name, unit, kind, least, greatest, mass_power, arm_power }
    };
    common.iter().chain(effect.finer_parameters()).enumerate().map(known).collect()
}

/// The effects in the confusable sets of its name, and those in whose sets it was.
fn confusable(run: &Run, measured: &Measured) -> Vec<KnownConfusable> {
    let own = run.confusable.iter().map(|(id, confused)| (id.clone(), confused, run.named));
    let other = measured.effects.iter().filter_map(|other| {
        let confused = other.confusable.get(&run.id).filter(|_| !run.confusable.contains_key(&other.id))?;
        Some((other.id.clone(), confused, other.named))
    });
    let known = |(id, confused, of): (String, &Confused, usize)| KnownConfusable {
        id,
        flights: confused.flights,
        of,
        least_distance: confused.least_distance,
    };
    own.chain(other).map(known).collect()
}

/// An `[[effect]]` table of usual size, with unit and bounds of each value.
fn table(effect: &dyn Effect, of: &Vehicle, usual: &[(&str, f64)]) -> String {
    let mut text = format!("[[effect]]\nid = \"{}\"\n", effect.id());
    let all = effect.parameters().iter().chain(effect.finer_parameters());
    for (parameter, value) in
        all.filter_map(|one| Some((one, usual.iter().find(|(name, _)| *name == one.name)?.1)))
    {
        let (least, greatest) = bounds(parameter, of);
        let unit = if parameter.unit == "-" { "" } else { parameter.unit };
        let of_tests = OF_TESTS.contains(&(effect.id(), parameter.name));
        let remark = match parameter.is_rotor() {
            true => {
                "; in files, counted from 0 in the vehicle file's order: motor 1 is 0; its name is taken too"
            }
            false if of_tests => ", the size concealed in the tests",
            false => "",
        };
        let bounds = format!("{unit} ({} to {}){remark}", compact(least), compact(greatest));
        // writing to a String cannot fail
        let _ = writeln!(text, "{} = {:?} # {}", parameter.name, rounded(value), bounds.trim_start());
    }
    text
}

/// Three digits: a usual size is known to no more.
fn rounded(value: f64) -> f64 {
    significant(value, 3).parse().unwrap_or(value)
}
