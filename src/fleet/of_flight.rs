//! One flight of a log as rows.

use super::rows::{EffectRow, FlightRow, LegRow, ParameterRow, ResidualRow};
use crate::diagnose::{CHANNEL_NAMES, Explanation, Owner, clause};
use crate::study::AloneFlight;
use crate::vehicle::Vehicle;

/// What the rows of one flight have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct FlightOf<'a> {
    pub(super) log: &'a str,
    pub(super) place: i64,
    pub(super) vehicle: &'a str,
    pub(super) vehicle_type: &'a str,
    pub(super) start_utc_us: Option<i64>,
    pub(super) nominal: Option<&'a Vehicle>,
    pub(super) is_known: bool,
}

pub(super) fn flight_rows(of: &FlightOf<'_>, flight: &AloneFlight) -> FlightRow {
    let explained = flight.explained.as_ref();
    FlightRow {
        log: of.log.to_owned(),
        flight: of.place,
        vehicle: of.vehicle.to_owned(),
        vehicle_type: of.vehicle_type.to_owned(),
        start_utc_us: of.start_utc_us,
        from_s: flight.airborne_s.first().map_or(0.0, |span| span.0),
        airborne_s: flight.airborne_s.iter().map(|(from, to)| to - from).sum(),
        vehicle_is_known: of.is_known,
        balance_error: flight.legs.as_ref().err().cloned(),
        motion_error: explained.err().cloned(),
        verdict: explained.ok().map(|explained| explained.explanation.verdict.name().to_owned()),
    }
}

pub(super) fn leg_rows(of: &FlightOf<'_>, flight: &AloneFlight) -> Vec<LegRow> {
    let legs = flight.legs.as_ref().map_or(&[][..], Vec::as_slice);
    let row = |leg: &crate::trim::Leg| LegRow {
        log: of.log.to_owned(),
        flight: of.place,
        vehicle: of.vehicle.to_owned(),
        time_s: leg.time_s,
        lean: leg.lean.to_vec(),
        felt: leg.felt.to_vec(),
        turning: leg.turning.to_vec(),
        rate: leg.rate.to_vec(),
        shares: leg.shares.clone(),
        lift: leg.lift,
        voltage_v: leg.voltage_v,
    };
    legs.iter().map(row).collect()
}

/// What the motion shows, and what is told of every flight beside it.
pub(super) fn parameter_rows(of: &FlightOf<'_>, flight: &AloneFlight) -> Vec<ParameterRow> {
    let row = |(name, unit): (&str, &str), (value, std): (f64, Option<f64>), owner: Owner| ParameterRow {
        log: of.log.to_owned(),
        flight: of.place,
        vehicle: of.vehicle.to_owned(),
        name: name.to_owned(),
        unit: unit.to_owned(),
        value,
        std,
        common_std: 0.0,
        owner: if owner == Owner::Vehicle { "vehicle" } else { "flight" }.to_owned(),
        effect: None,
    };
    let mut rows = Vec::new();
    if let Ok(explained) = &flight.explained {
        rows.extend(explained.parameters.iter().map(|parameter| ParameterRow {
            common_std: parameter.common_std,
            effect: parameter.effect.map(str::to_owned),
            ..row(
                (&parameter.name, parameter.unit),
                (parameter.estimate.0, Some(parameter.estimate.1)),
                parameter.owner,
            )
        }));
        let latency = &explained.explanation.search.latency;
        if latency.is_determined() {
            rows.push(row(("latency", "s"), (latency.total_s, Some(latency.std_s)), Owner::Vehicle));
        }
    }
    let vibration = flight.vibration_m_s2;
    rows.extend(
        vibration.map(|(level, std)| row(("vibration", "m/s^2"), (level, Some(std)), Owner::Vehicle)),
    );
    rows.extend(flight.power_w.map(|power| row(("power", "W"), (power, None), Owner::Flight)));
    rows.retain(|row| row.value.is_finite());
    rows
}

fn explanation(flight: &AloneFlight) -> Option<&Explanation> {
    flight.explained.as_ref().ok().map(|explained| &explained.explanation)
}

pub(super) fn effect_rows(of: &FlightOf<'_>, flight: &AloneFlight) -> Vec<EffectRow> {
    let named = explanation(flight).map_or(&[][..], |explanation| &explanation.named);
    let row = |named: &crate::diagnose::Named| EffectRow {
        log: of.log.to_owned(),
        flight: of.place,
        vehicle: of.vehicle.to_owned(),
        effect: named.id.to_owned(),
        sentence: of.nominal.map_or_else(String::new, |vehicle| clause(named, vehicle)),
        z: named.strength.z,
        gain: named.strength.gain,
        may_be: named.confusable_with.iter().map(|other| other.id).collect::<Vec<_>>().join(","),
    };
    named.iter().map(row).collect()
}

pub(super) fn residual_rows(of: &FlightOf<'_>, flight: &AloneFlight) -> Vec<ResidualRow> {
    let Some(explanation) = explanation(flight) else { return Vec::new() };
    let (before, after) = (&explanation.search.before, &explanation.search.after);
    let scale = after.base.scale_over(&before.base);
    let channels = CHANNEL_NAMES.into_iter().enumerate().map(|(channel, axis)| ResidualRow {
        log: of.log.to_owned(),
        flight: of.place,
        vehicle: of.vehicle.to_owned(),
        axis: axis.to_owned(),
        unit: if axis.starts_with("torque") { "N m" } else { "N" }.to_owned(),
        before: scale * before.weighted.sigma[channel],
        after: after.weighted.sigma[channel],
    });
    channels.filter(|row| row.after > 0.0 && row.before.is_finite() && row.after.is_finite()).collect()
}
