//! Mass and inertia by the estimator of `explain`, together with the effects that the flights show.

use crate::diagnose::{ExplainSettings, Explanation, GyroscopicShare, TorqueLaw, Verdict, brief, explain};
use crate::estimate::{
    Contradiction, Estimated, Finding, MOMENTS, MethodResult, NAMES, Nominal, Recommendation, THETA,
    moved_by_guessed_curve, stated,
};
use crate::note::Note;
use crate::signals::Signals;
use crate::study::doubts::{Moment, of_mass, of_shape};
use crate::study::explain::{
    Asked, BY_CONTROL, FlightLimit, KEPT, explain_prepared, kept_about_z, limits_of_flights, of_voltage,
};
use crate::study::flights::Prepared;
use crate::study::{Progress, StudyError};
use crate::text::list;
use crate::vehicle::{Anchor, Guessed, Vehicle};

/// The recommended estimate, and what was estimated beside mass and inertia.
#[derive(Debug)]
pub(super) struct EstimateWithEffects {
    pub(super) best: Recommendation,
    /// identifiers of effects
    pub(super) effects: Vec<&'static str>,
    /// hardly anything but the controller turned the vehicle
    pub(super) turned_by_control: bool,
    /// where a simulator leaves the gyroscopic torque out
    pub(super) gyroscopic: Option<GyroscopicShare>,
    /// where the rotors' torque certainly does not go with their thrust
    pub(super) torque_law: Option<TorqueLaw>,
    /// places in mass and inertia of what the model has from the vehicle file
    pub(super) undetermined: Vec<usize>,
    /// m, of the model: a guessed one follows izz, and one that no flight can tell follows the stated izz
    pub(super) torque_per_thrust_m: f64,
    /// kg m^2, of the model, where it has izz from the vehicle file because flights tell only its ratio to the torque per thrust
    pub(super) about_z_kg_m2: Option<f64>,
    /// why izz is not determined then
    pub(super) about_z: Option<String>,
    /// what the mass rests on
    pub(super) notes: Vec<Note>,
}

/// Takes the moments of inertia out of a result that rests on the controller's answer to noise.
pub(super) fn without_inertia(result: &mut MethodResult) {
    for index in 1..THETA {
        result.parameters[index].finding = Finding::NotDetermined { reason: BY_CONTROL.to_owned() };
    }
}

/// Takes out of a result what the model has from the vehicle file.
pub(super) fn without_undetermined(result: &mut MethodResult, undetermined: &[usize]) {
    for &index in undetermined {
        let finding = &mut result.parameters[index].finding;
        if matches!(finding, Finding::Determined { .. }) {
            *finding = Finding::NotDetermined { reason: KEPT.to_owned() };
        }
    }
}

/// Says of a result which of izz and the torque per thrust the model keeps.
pub(super) fn with_kept_about_z(result: &mut MethodResult, kept: &str) {
    if let Finding::NotDetermined { reason } = &mut result.parameters[THETA - 1].finding {
        reason.push_str(&format!("; {kept}"));
    }
}

/// Flights as `explain` sees them, and what is found in them.
#[derive(Debug)]
pub(super) struct Found {
    /// their signals
    pub(super) flights: Vec<Signals>,
    /// with the effects that hold on what was held back
    pub(super) explanation: Explanation,
    /// of the part that `explain` does not hold back: the whole flight does not show all that this part shows
    pub(super) of_part: bool,
    /// why the flights tell little, by the way they were flown
    pub(super) limited: Vec<FlightLimit>,
    /// what a flight that is too short for a certain name shows, each in brief with its size
    pub(super) unsure: Vec<String>,
}

impl Found {
    /// In whole flights: nothing is held back, so every name that they give stays.
    pub(super) fn in_whole(flights: &[Signals], vehicle: &Vehicle) -> Result<Self, String> {
        let explanation =
            explain(flights, vehicle, &ExplainSettings::default()).map_err(|why| why.to_string())?;
        let explanation = explanation.keeping_about_z(vehicle);
        let limited = limits_of_flights(flights, vehicle);
        Ok(Self { flights: flights.to_vec(), explanation, of_part: false, limited, unsure: Vec::new() })
    }
}

/// Explains the flights as `mavid explain` does, a part held back. What holds there is then estimated on the whole flight.
///
/// # Errors
/// Where the flights are too short, or lack what a search needs: why.
pub(super) fn found_beside(
    mut flights: Prepared,
    asked: Asked,
    progress: &dyn Progress,
) -> Result<Found, String> {
    let why = |error| match error {
        StudyError::Explain { source, .. } => source.to_string(),
        other => other.to_string(),
    };
    let whole = flights.signals.clone();
    let limited = limits_of_flights(&whole, asked.vehicle);
    let study = explain_prepared(&mut flights, &mut Prepared::default(), asked, progress).map_err(why)?;
    let unsure = study.short.as_ref().map_or_else(Vec::new, |short| short.unsure.clone());
    let usable = |signals: &[Signals]| -> usize {
        signals.iter().flat_map(|one| one.usable.iter()).filter(|usable| **usable).count()
    };
    if usable(&flights.signals) == usable(&whole) {
        let explanation = study.explanation.keeping_about_z(asked.vehicle);
        return Ok(Found { flights: flights.signals, explanation, of_part: false, limited, unsure });
    }
    let of_part = &study.explanation;
    let (unexplained, terms) = (of_part.verdict == Verdict::Unexplained, &of_part.search.after.base.effects);
    let holds = |id: &str| !unexplained && terms.iter().any(|term| term.id() == id);
    let mut settings = ExplainSettings::default();
    settings.refused =
        settings.signatures.iter().map(|signature| signature.id()).filter(|id| !holds(id)).collect();
    let mut explanation = explain(&whole, asked.vehicle, &settings).map_err(|error| error.to_string())?;
    // a latency or a gust is no candidate that could be refused
    explanation.named.retain(|named| of_part.named.iter().any(|known| known.id == named.id));
    if unexplained {
        explanation.verdict = Verdict::Unexplained;
    }
    // without an effect that holds, what it does would be in mass and inertia: the part that shows it tells them
    let stays = |id: &str| {
        let mut named = explanation.named.iter().map(|named| named.id);
        let mut terms = explanation.search.after.base.effects.iter().map(|term| term.id());
        named.any(|named| named == id) || terms.any(|term| term == id)
    };
    if !unexplained && !of_part.named.iter().all(|named| stays(named.id)) {
        let explanation = study.explanation.keeping_about_z(asked.vehicle);
        return Ok(Found { flights: flights.signals, explanation, of_part: true, limited, unsure });
    }
    Ok(Found {
        flights: whole,
        explanation: explanation.keeping_about_z(asked.vehicle),
        of_part: false,
        limited,
        unsure,
    })
}

/// Mass and inertia of the final fit.
pub(super) fn joint_estimate(of: &Found, vehicle: &Vehicle) -> EstimateWithEffects {
    let Found { flights, explanation: found, .. } = of;
    let unexplained = found.verdict == Verdict::Unexplained;
    // what serves as no explanation is not in the model
    let fitted = if unexplained { &found.search.before } else { &found.search.after };
    let mut estimated = fitted.with_stated_thrust(&vehicle.propulsion);
    estimated.by_wider_window = Some(found.search.by_wider_window);
    if !fitted.base.estimates_bend() {
        let moved = moved_by_guessed_curve(flights, vehicle).map(|by| by.on(&estimated.theta));
        estimated = estimated.with_guessed_curve(moved);
    }
    if let Some(law) = found.torque_law {
        estimated = law.in_errors_of(estimated);
    }
    let effects: Vec<&'static str> = found.named.iter().map(|named| named.id).collect();
    let best = Recommendation::joint(&estimated, &Nominal::of(vehicle), why(of, vehicle));
    let (turned_by_control, torque_law) = (found.turned_by_control, found.torque_law);
    EstimateWithEffects {
        best,
        effects,
        turned_by_control,
        gyroscopic: fitted.gyroscopic(),
        torque_law,
        undetermined: fitted.undetermined.clone(),
        torque_per_thrust_m: fitted.base.vehicle.propulsion.torque_per_thrust_m,
        about_z_kg_m2: torque_law.map(|_| fitted.base.vehicle.body.inertia_kg_m2[(2, 2)]),
        about_z: torque_law.map(|_| kept_about_z(&fitted.base.vehicle, vehicle)),
        notes: of
            .limited
            .iter()
            .map(FlightLimit::note)
            .chain(mass_apart(&estimated, vehicle))
            .chain(odd_shape(&estimated, &fitted.base.vehicle).filter(|_| torque_law.is_none()))
            .chain(found.named.iter().filter_map(of_voltage))
            .collect(),
    }
}

/// A note on a mass by the stated thrust that differs from the stated one by more than files do, and by less than contradicts them.
fn mass_apart(estimated: &Estimated, vehicle: &Vehicle) -> Option<Note> {
    let mass = (estimated.theta[0], estimated.covariance[(0, 0)].max(0.0).sqrt());
    let is_told = Contradiction::of(NAMES[0], mass, stated(vehicle, 0)).is_some();
    let is_asked = vehicle.anchor != Anchor::Mass && mass.0.is_finite() && !is_told;
    if is_asked { of_mass(mass, vehicle.body.mass_kg) } else { None }
}

/// A note on moments of inertia that a multirotor does not have. What is not determined is as the model has it, and as uncertain as its
/// guess.
fn odd_shape(estimated: &Estimated, model: &Vehicle) -> Option<Note> {
    let moment = |entry: usize, axis: usize| {
        let (value, std) = (estimated.theta[entry], estimated.covariance[(entry, entry)].max(0.0).sqrt());
        if value.is_finite() && std.is_finite() {
            return Moment { value, std, is_determined: true };
        }
        let kept = model.body.inertia_kg_m2[(axis, axis)];
        Moment { value: kept, std: model.guessed(Guessed::Inertia) * kept, is_determined: false }
    };
    let [about_x, about_y, about_z] = MOMENTS;
    of_shape([moment(about_x, 0), moment(about_y, 1)], moment(about_z, 2))
}

/// The reason for the user.
fn why(Found { flights, explanation: found, of_part, unsure, .. }: &Found, vehicle: &Vehicle) -> String {
    let names: Vec<String> = found.named.iter().map(|named| brief(named, vehicle, false)).collect();
    let usable = |one: &Signals| one.usable.iter().filter(|usable| **usable).count() as f64 * one.grid.step_s;
    let seconds: f64 = flights.iter().map(usable).sum();
    let part = if *of_part {
        ", those that `mavid explain` does not hold back: the rest does not show all names"
    } else {
        ""
    };
    let used = format!("from {seconds:.0} s of flight{part}");
    match (found.verdict, names.join(", ")) {
        (Verdict::Unexplained, _) => format!(
            "mass and inertia alone, {used}: something acts in these flights that no known effect explains, and `mavid explain` \
             shows where"
        ),
        (_, names) if names.is_empty() && !unsure.is_empty() => format!(
            "mass and inertia alone, {used}: this flight shows {}, but not surely enough for a name",
            list(unsure)
        ),
        (_, names) if names.is_empty() => {
            format!("these flights show no effect beside mass and inertia ({used})")
        }
        (_, names) => format!(
            "mass and inertia are estimated together with the other effects in these flights: {names} (`mavid explain` gives \
             their sizes; {used})"
        ),
    }
}
