//! The effects that a model of the vehicle lacks, in as much flight as the bounds allow.

use super::finding::{Amount, Finding, Gravity, Screening};
use crate::diagnose::{ExplainSettings, LEAST_FLIGHT_S, Named, Verdict, clause, explain};
use crate::signals::Signals;
use crate::vehicle::Vehicle;

/// Searches effects in the liveliest part of a flight that has at most `instants` of its grid.
pub(super) fn effects(signals: &Signals, vehicle: &Vehicle, (instants, screening): (usize, &mut Screening)) {
    if !signals.quality.torques {
        let why = "effects are not searched: commands or body rates are logged too seldom to compare torques";
        return screening.not_done.push(why.to_owned());
    }
    let step_s = signals.grid.step_s;
    let (from, to) = liveliest(signals, instants);
    let whole = signals.usable.iter().filter(|usable| **usable).count();
    let kept = signals.usable[from..to].iter().filter(|usable| **usable).count();
    let seconds = kept as f64 * step_s;
    if seconds < LEAST_FLIGHT_S {
        return screening.not_done.push(format!(
            "effects are not searched: {seconds:.1} s of flight can be used within the bounds, expected at least {LEAST_FLIGHT_S:.0} s"
        ));
    }
    if kept < whole {
        screening.not_done.push(format!(
            "effects are searched in the {seconds:.0} s of flight with the most motion, {:.0} s more could be used: the bounds allow no more",
            (whole - kept) as f64 * step_s
        ));
    }
    match explain(&[signals.part(from..to)], vehicle, &ExplainSettings::default()) {
        Ok(found) => {
            let span_s = (signals.grid.time_s(from), signals.grid.time_s(to - 1));
            screening.findings.extend(found.named.iter().map(|named| finding(named, vehicle, span_s)));
            if matches!(found.verdict, Verdict::PartlyExplained | Verdict::Unexplained) {
                screening.findings.push(unexplained(span_s));
            }
        }
        Err(why) => screening.not_done.push(format!("effects are not searched: {why}")),
    }
}

/// From and to, of at most so many instants in a row: those with the most usable motion.
fn liveliest(signals: &Signals, instants: usize) -> (usize, usize) {
    let count = signals.grid.count;
    if count <= instants {
        return (0, count);
    }
    let rate = |index: usize| signals.rate.as_ref().map_or(1.0, |rate| rate[index].norm_squared());
    let worth = |index: usize| if signals.usable[index] { 1e-6 + rate(index) } else { 0.0 };
    let mut now: f64 = (0..instants).map(worth).sum();
    let (mut most, mut from) = (now, 0);
    for next in instants..count {
        now += worth(next) - worth(next - instants);
        if now > most {
            (most, from) = (now, next + 1 - instants);
        }
    }
    (from, from + instants)
}

fn finding(named: &Named, vehicle: &Vehicle, span_s: (f64, f64)) -> Finding {
    let amount = |parameter: &crate::diagnose::NamedParameter| Amount {
        name: parameter.name.to_owned(),
        value: parameter.value,
        std: (parameter.std > 0.0).then_some(parameter.std),
        unit: parameter.unit,
    };
    Finding {
        id: named.id,
        gravity: Gravity::Warning,
        sentence: format!("{}.", clause(named, vehicle)),
        span_s: Some(span_s),
        at: None,
        amounts: named.parameters.iter().map(amount).collect(),
        may_be: named.confusable_with.iter().map(|other| other.id.to_owned()).collect(),
    }
}

fn unexplained(span_s: (f64, f64)) -> Finding {
    Finding {
        id: "unexplained",
        gravity: Gravity::Warning,
        sentence: "The motion deviates from the vehicle's model, and no known effect explains all of it."
            .to_owned(),
        span_s: Some(span_s),
        at: None,
        amounts: Vec::new(),
        may_be: Vec::new(),
    }
}
