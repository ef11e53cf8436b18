//! What a log is good for, in words, and what to do next.

use super::evidence::Evidence;
use super::inspection::{Outlook, Unflown, VehicleSummary};
use super::missing_streams::{Need, SOUND_COPY, WANTED_HZ, lack};
use super::outlook::{AXIS_NAMES, LEAST_ANGULAR_ACCELERATION};
use crate::diagnose::LEAST_FLIGHT_S;
use crate::estimate::{POOR, RIGID_BODY_ALONE, contradicts_file, rescaled, rests_on_guessed_curve};
use crate::note::About;
use crate::recording::Quantity;
use crate::signals::{LEAST_ACTUATOR_HZ, LEAST_BODY_RATE_HZ, SignalsError};
use crate::vehicle::Anchor;

/// Time of flight that a good identification needs, s. Only advice depends on it.
const AMPLE_S: f64 = 20.0;
/// Lost share of the flight from which it is mentioned. Only a remark depends on it.
const NOTABLE_SHARE: f64 = 0.05;

/// What Izz needs beside the data of a log.
const YAW_NEEDS: &str =
    " Izz also needs the rotors' torque per thrust: from a vehicle file or a thrust stand.";

/// The verdict and the advice.
pub(super) fn verdict(
    evidence: &Evidence<'_>,
    outlook: &[Outlook],
    vehicle: &VehicleSummary,
) -> (String, Vec<String>) {
    let mut advice = several_vehicles(vehicle);
    if !evidence.is_of_other_kind() {
        let known = evidence.holds_streams();
        advice.splice(0..0, flying(evidence));
        advice.splice(0..0, if known { missing(evidence) } else { Vec::new() });
        advice.extend(remarks(evidence, vehicle));
    }
    (sentence(evidence, outlook), advice)
}

/// Why nothing can be identified whatever the vehicle is.
pub(super) fn unflown(evidence: &Evidence<'_>) -> Option<Unflown> {
    let nothing = evidence.nothing().filter(|_| evidence.is_unflown())?;
    // a list is for `inspect` alone
    let next = if evidence.streams.is_empty() {
        "`mavid inspect` lists what it holds.".to_owned()
    } else {
        instead_of_nothing(evidence)
    };
    // outputs that carry no time are there: that says more than what a file expects
    let lacks_actuators = evidence.holds_streams()
        && evidence.grounded().is_none()
        && evidence.actuator_hz().is_none()
        && !evidence.untimed_outputs;
    Some(Unflown { why: format!("{nothing}. {next}"), lacks_actuators })
}

fn sentence(evidence: &Evidence<'_>, outlook: &[Outlook]) -> String {
    if evidence.has_other_actuators() {
        return "Nothing can be identified with this vehicle: its actuators are not those of the log. See the advice.".into();
    }
    if evidence.is_contradicted() {
        return "Nothing can be identified with this vehicle: its thrust contradicts the log. See the advice.".into();
    }
    if let Some(nothing) = evidence.nothing() {
        let next = if evidence.is_of_other_kind() {
            String::new()
        } else {
            format!(" {}", instead_of_nothing(evidence))
        };
        return format!("Nothing can be identified from this log: {nothing}.{next}");
    }
    let flight = &evidence.assessment.flight;
    let time = format!("{:.0} s of {:.0} s in the air can be used", flight.usable_s, flight.airborne_s);
    if outlook.iter().all(|outlook| outlook.status == "not_determined") {
        return no_parameter(evidence, &time);
    }
    let (bad, good): (Vec<&Outlook>, Vec<&Outlook>) =
        principal(outlook).partition(|outlook| outlook.status == "not_determined");
    let bad: Vec<&str> = bad.into_iter().map(|outlook| label(outlook.name)).collect();
    match evidence.vehicle {
        None => without_vehicle(&good, &bad, &time),
        Some(_) => with_vehicle(evidence, &good, &bad, &time),
    }
}

/// What to do where nothing at all can be identified.
fn instead_of_nothing(evidence: &Evidence<'_>) -> String {
    let flown = evidence.armed.is_none() || evidence.assessment.flight.airborne_s > 0.0;
    match evidence.actuator_hz() {
        _ if evidence.steps_back.is_some() => "It is damaged: give a sound copy.".to_owned(),
        _ if evidence.undefined => "Give the whole log.".to_owned(),
        _ if evidence.damage.is_some() => damaged(evidence),
        _ if !evidence.timed => "ArduPilot writes them since 2014.".to_owned(),
        _ if evidence.ends_early => "It was cut off: give the whole log.".to_owned(),
        _ if evidence.streams.is_empty() => "What it holds is listed below.".to_owned(),
        _ if !flown => "Fly a trajectory of `mavid plan` with it recording.".to_owned(),
        None => {
            let how = how(evidence, "request SERVO_OUTPUT_RAW or ACTUATOR_OUTPUT_STATUS");
            format!("Next time {how}.")
        }
        Some(_) if matches!(evidence.assessment.refusal, Some(SignalsError::TooSlow { .. })) => {
            "See the advice.".to_owned()
        }
        Some(_) => "Fly a trajectory of `mavid plan` with it recording.".to_owned(),
    }
}

/// What to do with a damaged log.
fn damaged(evidence: &Evidence<'_>) -> String {
    format!("It is damaged, {}: {SOUND_COPY}.", evidence.damage.unwrap_or_default())
}

/// There is a flight, and no parameter can be told from it.
fn no_parameter(evidence: &Evidence<'_>, time: &str) -> String {
    match lack(evidence, Need::of_body(0)).filter(|_| evidence.vehicle.is_none()) {
        Some(lack) if evidence.damage.is_some() => {
            format!("Nothing can be identified from this log: {}. {}", lack.reason, damaged(evidence))
        }
        Some(lack) => {
            format!("Nothing can be identified from this log: {}. Next time {}.", lack.reason, lack.set)
        }
        None => format!(
            "No parameter of the rigid body can be identified from this log, although {time}. Fly a trajectory of `mavid \
             plan`."
        ),
    }
}

fn without_vehicle(good: &[&Outlook], bad: &[&str], time: &str) -> String {
    let names: Vec<&str> = good.iter().map(|outlook| label(outlook.name)).collect();
    let but = if bad.is_empty() { String::new() } else { format!(", but not for {}", bad.join(", ")) };
    // mass and size, which alone are asked for, do not tell it
    let yaw = if names.contains(&"Izz") { YAW_NEEDS } else { "" };
    format!(
        "The log contains the data for identifying {}{but}: {time}. With --vehicle this says how well it will do.{yaw}",
        names.join(", ")
    )
}

fn with_vehicle(evidence: &Evidence<'_>, good: &[&Outlook], bad: &[&str], time: &str) -> String {
    let doubts = doubts(evidence);
    let to = |poor: bool| -> Vec<String> {
        let wanted = |outlook: &&&Outlook| outlook.std_relative.is_some_and(|std| (std > POOR) == poor);
        let told = |outlook: &&Outlook| {
            let name = label(outlook.name);
            // shares of what a wrong file states mean nothing
            match outlook.std_relative.filter(|_| doubts.is_empty() && evidence.assessment.apart.is_empty()) {
                Some(std) => format!("{name} to {}", percent(std)),
                None => name.to_owned(),
            }
        };
        good.iter().filter(wanted).map(told).collect()
    };
    let parts: Vec<String> = [("good for", to(false)), ("poor for", to(true))]
        .into_iter()
        .filter(|(_, names)| !names.is_empty())
        .map(|(word, names)| format!("{word} {}", names.join(", ")))
        .collect();
    let not = if bad.is_empty() { String::new() } else { format!("; not for {}", bad.join(", ")) };
    let parts = parts.join("; ");
    if let Some(apart) = evidence.assessment.apart.first().filter(|_| doubts.is_empty()) {
        return format!("Doubtful: {apart}. One by one its flights may be {parts}{not}: {time}.");
    }
    if !doubts.is_empty() {
        return format!(
            "Doubtful with this vehicle: {}. With the right one this log may be {parts}{not}: {time}.",
            doubts.join("; ")
        );
    }
    let alone = evidence.assessment.flight.usable_s < LEAST_FLIGHT_S;
    if alone {
        return format!("This log is {RIGID_BODY_ALONE}it is {parts}{not}: {time}. Next: `mavid identify`.");
    }
    format!("This log is {parts}{not}: {time}. Next: `mavid identify`.")
}

/// What speaks against the vehicle file, clause by clause.
fn doubts(evidence: &Evidence<'_>) -> Vec<String> {
    let mut doubts = Vec::new();
    if let Some(vehicle) = evidence.vehicle {
        doubts.extend(contradicts_file(evidence.contradictions));
        let odd = vehicle.implausible();
        doubts.extend(odd.iter().map(|odd| odd.trim_end_matches('?').to_owned()));
    }
    if evidence.assessment.notes.iter().any(|note| note.is_warning() && note.about == About::Vehicle) {
        doubts.push("its rotors contradict the autopilot's parameters, see the advice".to_owned());
    }
    if evidence.assessment.notes.iter().any(|note| note.about == About::Contradiction) {
        doubts.push("the recorded streams contradict each other or its rotors, see the advice".to_owned());
    }
    doubts
}

/// Mass and moments: the products follow them.
fn principal(outlook: &[Outlook]) -> impl Iterator<Item = &Outlook> {
    outlook.iter().filter(|outlook| !matches!(outlook.name, "ixy" | "ixz" | "iyz"))
}

/// A parameter as it is spoken of.
fn label(name: &'static str) -> &'static str {
    match name {
        "ixx" => "Ixx",
        "iyy" => "Iyy",
        "izz" => "Izz",
        "thrust_scale" => "thrust",
        other => other,
    }
}

/// Two digits.
fn percent(share: f64) -> String {
    let percent = 100.0 * share;
    match percent {
        p if p < 0.01 => "less than 0.01 %".to_owned(),
        p if p < 0.1 => format!("{p:.2} %"),
        p if p < 10.0 => format!("{p:.1} %"),
        p => format!("{p:.0} %"),
    }
}

/// What to do to have more: another setting of the vehicle's own log, or a message over the link.
fn how(evidence: &Evidence<'_>, request: &str) -> String {
    if evidence.damage.is_some() {
        return SOUND_COPY.to_owned();
    }
    evidence.logging.map_or_else(|| format!("{request} at {WANTED_HZ} Hz"), str::to_owned)
}

/// Streams that are not there, or too slow.
fn missing(evidence: &Evidence<'_>) -> Vec<String> {
    // what stands on the ground does not move, and its streams are not to be recorded better
    let stands = evidence.grounded().is_some();
    let mut advice: Vec<String> = evidence
        .damage
        .map(|damage| format!("Damaged: {damage}; what is missing of the flight may be gone with it."))
        .into_iter()
        .collect();
    if let Some(refusal) = &evidence.assessment.refusal {
        advice.push(refusal.to_string());
    }
    match evidence.actuator_hz() {
        None if stands && evidence.still(Quantity::ActuatorCommand).is_some() => {}
        None => advice.push(match evidence.still(Quantity::ActuatorCommand) {
            Some(hold) => format!("The actuator outputs of this log {hold}: the motors did not run, and nothing can be identified."),
            None => format!(
                "{}: nothing can be identified. To have them, {}.",
                if evidence.untimed_outputs { "Motor outputs without times" } else { "No actuator outputs" },
                how(evidence, "request SERVO_OUTPUT_RAW or ACTUATOR_OUTPUT_STATUS")
            ),
        }),
        Some(hz) if hz < LEAST_ACTUATOR_HZ => {
            advice.push(format!(
                "Actuators at {hz:.0} Hz: too slow. For more, {}.",
                how(evidence, "request them")
            ));
        }
        Some(_) => {}
    }
    match evidence.rate_hz(Quantity::AngularRate) {
        None if stands && evidence.still(Quantity::AngularRate).is_some() => {}
        None => advice.push(format!(
            "{}: inertia cannot be identified. To have them, {}.",
            evidence
                .still(Quantity::AngularRate)
                .map_or("No body rates".to_owned(), |hold| format!("The body rates of this log {hold}")),
            how(
                evidence,
                "request ATTITUDE_QUATERNION or HIGHRES_IMU (PX4), ATTITUDE or RAW_IMU (ArduPilot)"
            )
        )),
        Some(hz) if hz < LEAST_BODY_RATE_HZ => {
            advice.push(format!(
                "Body rates at {hz:.0} Hz: too slow. For more, {}.",
                how(evidence, "request them")
            ));
        }
        Some(_) => {}
    }
    if !(evidence.has_vertical_motion() || stands && evidence.still(Quantity::SpecificForce).is_some()) {
        advice.push(format!(
            "No vertical motion: mass cannot be identified. To have it, {}.",
            how(evidence, "request an IMU message, or attitude, rates and LOCAL_POSITION_NED")
        ));
    }
    if evidence.rate_hz(Quantity::Attitude).is_none() {
        advice.push("No attitude: streams cannot be aligned, and neither drag nor wind can be told.".into());
    }
    if evidence.rate_hz(Quantity::Velocity).is_none() {
        let how = match (evidence.damage, evidence.logging) {
            (Some(_), _) => "",
            (None, Some(set)) => {
                &format!(" The vehicle had no estimate of it, or did not log it: to have it, {set}.")
            }
            (None, None) => " To have it, request LOCAL_POSITION_NED.",
        };
        advice.push(format!("No velocity: drag cannot be told.{how}"));
    }
    advice
}

/// What to fly better.
fn flying(evidence: &Evidence<'_>) -> Vec<String> {
    let mut advice = Vec::new();
    let flight = &evidence.assessment.flight;
    if flight.airborne_s > 0.0 && flight.usable_s < AMPLE_S {
        advice.push(format!(
            "Only {:.0} s can be used: fly {AMPLE_S:.0} s and more of a lively trajectory, clear of take-off and landing.",
            flight.usable_s
        ));
    }
    let dull: Vec<&str> = (0..3)
        .filter(|axis| {
            evidence.angular_acceleration(*axis).is_some_and(|rms| rms < LEAST_ANGULAR_ACCELERATION)
        })
        .map(|axis| AXIS_NAMES[axis])
        .collect();
    if !dull.is_empty() {
        advice.push(format!("Hardly any motion in {}: fly a trajectory of `mavid plan`.", dull.join(", ")));
    }
    let shares = [
        (flight.saturated_s, "with an actuator at its end stop: fly more gently"),
        (flight.gap_s, "inside gaps of a stream: use a better link or fewer messages"),
    ];
    for (seconds, what) in shares {
        if seconds > NOTABLE_SHARE * flight.airborne_s && seconds > 1.0 {
            advice.push(format!("{seconds:.0} s {what}."));
        }
    }
    advice
}

/// Which of several vehicles it is.
fn several_vehicles(vehicle: &VehicleSummary) -> Vec<String> {
    if vehicle.others.is_empty() {
        return Vec::new();
    }
    let others: Vec<String> = vehicle.others.iter().map(ToString::to_string).collect();
    vec![format!(
        "Several vehicles: this is system {}; --system-id chooses another (also there: {}).",
        vehicle.system.unwrap_or(0),
        others.join(", ")
    )]
}

/// What limits the result beside that.
fn remarks(evidence: &Evidence<'_>, vehicle: &VehicleSummary) -> Vec<String> {
    let mut advice = Vec::new();
    if vehicle.without_heartbeat && vehicle.system.is_some() {
        advice.push("No HEARTBEAT: which autopilot flew, and when it was armed, is not known.".into());
    }
    for (key, _, stats) in evidence.streams {
        if stats.all_zero && matches!(key.quantity, Quantity::RotorSpeed | Quantity::ActuatorCommand) {
            advice.push(format!("{} holds nothing but zeros: it is not used.", key.source));
        }
    }
    let speeds = evidence.rate_hz(Quantity::RotorSpeed).is_some();
    if !speeds && evidence.rate_hz(Quantity::ActuatorCommand).is_some() {
        advice.push(
            "No rotor speeds: thrust rests on commands, so the motors' lag and the battery's sag are part of what is \
             identified."
                .into(),
        );
        if let Some(names) = evidence.missing_curve {
            advice.push(format!(
                "The autopilot's thrust curve is not in the log: record its parameters ({names}). The curve in the \
                 vehicle file is used until then."
            ));
        }
    }
    if let (Some(vehicle), Some(expected)) = (evidence.vehicle, &evidence.assessment.expected) {
        let on_scale = match vehicle.anchor {
            Anchor::Mass => rescaled(expected, vehicle.body.mass_kg),
            Anchor::Thrust => expected.clone(),
        };
        advice.extend(
            rests_on_guessed_curve(&on_scale).map(|note| format!("A guess bears on inertia: {}.", note.text)),
        );
    }
    advice.extend(evidence.assessment.notes.iter().map(ToString::to_string));
    advice
}
