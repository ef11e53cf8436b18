//! Whether the held-out flights can be of the vehicle that was identified.

use super::Ready;
use super::weak::Weak;
use crate::diagnose::explanation::Explanation;
use crate::diagnose::rows::{CHANNEL_NAMES, Nuisance};
use crate::diagnose::search::Fitted;
use crate::estimate::{NAMES, UNITS};
use crate::physics::PhysicsError;

/// A parameter's value on the held-out flights against that of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// `mass`, `ixx` ... or `effect.parameter`
    pub name: String,
    /// SI
    pub unit: &'static str,
    /// of the model
    pub identified: f64,
    /// its standard error
    pub identified_std: f64,
    /// of the held-out flights alone
    pub held_out: f64,
    /// its standard error
    pub held_out_std: f64,
}

impl Agreement {
    /// Difference in standard errors of the difference.
    #[must_use]
    pub fn sigmas(&self) -> f64 {
        (self.held_out - self.identified) / self.identified_std.hypot(self.held_out_std)
    }

    fn share(&self) -> f64 {
        (self.held_out - self.identified) / self.identified
    }

    /// Certainly, and by more than a vehicle of one kind differs from flight to flight.
    fn differs(&self) -> bool {
        let share = match self.name.as_str() {
            "mass" => MASS_SHARE,
            "ixx" | "iyy" | "izz" => INERTIA_SHARE,
            _ => return false,
        };
        self.sigmas().abs() > SIGMAS && self.share().abs() > share
    }
}

/// Certain: beyond this many standard errors.
const SIGMAS: f64 = 8.0;
/// And relevant: beyond this share of the mass, of a principal inertia.
const MASS_SHARE: f64 = 0.08;
const INERTIA_SHARE: f64 = 0.35;
/// And it shows: a channel's residual is this much larger than the held-out flight's own fit leaves.
const RESIDUAL_RATIO: f64 = 1.3;

/// One linear step about the carried model gives the held-out flights' own values.
pub(super) fn judged(
    ready: &[Ready],
    explanation: &Explanation,
    weak: &Weak,
) -> Result<(Vec<Agreement>, Option<String>), PhysicsError> {
    let identified = &explanation.search.after;
    let mut all: Vec<Agreement> = Vec::new();
    for (index, own) in weak.own.iter().enumerate() {
        let found = agreements(own, identified);
        if index == 0 {
            all = found;
        } else {
            all.iter_mut().zip(found).for_each(|(all, one)| pool(all, &one));
        }
    }
    let jumps: Vec<(usize, f64)> = weak
        .compared
        .iter()
        .enumerate()
        .filter_map(|(channel, compared)| {
            let compared = compared.as_ref()?;
            let ratio = compared.after.value / weak.own_rms[channel];
            (ratio > RESIDUAL_RATIO).then_some((channel, ratio))
        })
        .collect();
    let different: Vec<&Agreement> = all.iter().filter(|agreement| agreement.differs()).collect();
    let worst = jumps.iter().max_by(|a, b| a.1.total_cmp(&b.1));
    let reason = worst.filter(|_| !different.is_empty()).map(|(channel, ratio)| {
        let parameters: Vec<String> = different.iter().map(|agreement| described(agreement)).collect();
        format!(
            "{} not of the vehicle that was identified: {}; the residual of {} is {ratio:.1} times what its own fit leaves",
            if ready.len() == 1 { "the hold-out is" } else { "the hold-outs are" },
            parameters.join(", "),
            CHANNEL_NAMES[*channel]
        )
    });
    Ok((all, reason))
}

/// The first parameter that differs, mass before inertia.
pub(super) fn first_different(agreement: &[Agreement]) -> Option<&Agreement> {
    agreement.iter().find(|agreement| agreement.differs())
}

fn described(agreement: &Agreement) -> String {
    format!(
        "{} {:.4} +- {:.4} {} there, {:.4} +- {:.4} here ({:+.0} %, {:.0} sigma)",
        agreement.name,
        agreement.held_out,
        agreement.held_out_std,
        agreement.unit,
        agreement.identified,
        agreement.identified_std,
        100.0 * agreement.share(),
        agreement.sigmas().abs()
    )
}

fn agreements(own: &Fitted, identified: &Fitted) -> Vec<Agreement> {
    const PLACES: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    let body = &own.base.vehicle.body;
    let std = |fitted: &Fitted, index: usize| fitted.covariance[(index, index)].max(0.0).sqrt();
    let mut out = Vec::new();
    for (index, column) in own.rows.nuisances.iter().enumerate() {
        let (name, unit, value) = match column.nuisance {
            Nuisance::Mass => (NAMES[0], UNITS[0], body.mass_kg),
            Nuisance::Inertia(entry) => {
                let (row, column) = PLACES[entry];
                (NAMES[1 + entry], UNITS[1 + entry], body.inertia_kg_m2[(row, column)])
            }
            _ => continue,
        };
        out.push(Agreement {
            name: name.to_owned(),
            unit,
            identified: value,
            identified_std: std(identified, index),
            held_out: value + own.coefficients[index],
            held_out_std: std(own, index),
        });
    }
    let mut index = own.rows.nuisances.len();
    for present in &own.base.present {
        for &free in &present.free {
            let Some(parameter) = present.parameter(free) else { continue };
            out.push(Agreement {
                name: format!("{}.{}", present.effect.id(), parameter.name),
                unit: parameter.unit,
                identified: present.values[free],
                identified_std: if index < identified.covariance.nrows() {
                    std(identified, index)
                } else {
                    0.0
                },
                held_out: present.values[free] + own.coefficients[index],
                held_out_std: std(own, index),
            });
            index += 1;
        }
    }
    out
}

/// Two flights' values weighted by their variances.
fn pool(all: &mut Agreement, one: &Agreement) {
    let (a, b) = (all.held_out_std.powi(-2), one.held_out_std.powi(-2));
    if a.is_finite() && b.is_finite() && a + b > 0.0 {
        all.held_out = (all.held_out * a + one.held_out * b) / (a + b);
        all.held_out_std = (a + b).powf(-0.5);
    }
}
