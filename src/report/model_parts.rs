//! What the model files of several commands have in common.

use crate::diagnose::{Fitted, Nuisance};
use crate::estimate::NAMES;
use crate::physics::ActiveEffect;
use std::fmt::Write;

/// The effects as `[[effect]]` tables.
pub(super) fn effect_tables(effects: &[ActiveEffect]) -> String {
    let mut text = String::new();
    for effect in effects {
        let _ = writeln!(text, "\n[[effect]]\nid = \"{}\"", effect.effect().id());
        let (common, finer) = (effect.effect().parameters(), effect.effect().finer_parameters());
        for (parameter, value) in common.iter().chain(finer).zip(effect.parameters()) {
            let _ = writeln!(text, "{} = {value:?} # {}", parameter.name, parameter.unit);
        }
    }
    text
}

/// Names and values of the correlation of everything that was estimated together; `None` where there is none.
pub(super) fn correlation(fitted: &Fitted) -> (Vec<String>, Vec<Vec<Option<f64>>>) {
    let mut kept: Vec<(usize, String)> = Vec::new();
    for (index, column) in fitted.rows.nuisances.iter().enumerate() {
        let name = match column.nuisance {
            Nuisance::Mass => NAMES[0].to_owned(),
            Nuisance::Inertia(entry) => NAMES[1 + entry].to_owned(),
            Nuisance::Latency => "latency".to_owned(),
            _ => continue,
        };
        kept.push((index, name));
    }
    let mut index = fitted.rows.nuisances.len();
    for present in &fitted.base.present {
        for &free in &present.free {
            let parameter = present.parameter(free).map_or("", |parameter| parameter.name);
            kept.push((index, format!("{}.{parameter}", present.id())));
            index += 1;
        }
    }
    let covariance = &fitted.covariance;
    let of = |i: usize, j: usize| {
        let r = covariance[(i, j)] / (covariance[(i, i)] * covariance[(j, j)]).sqrt();
        r.is_finite().then_some(r)
    };
    let rows = kept.iter().map(|(i, _)| kept.iter().map(|(j, _)| of(*i, *j)).collect()).collect();
    (kept.into_iter().map(|(_, name)| name).collect(), rows)
}

/// The same as rows of a TOML array.
pub(super) fn correlations(fitted: &Fitted) -> (Vec<String>, Vec<String>) {
    let (names, rows) = correlation(fitted);
    let row = |row: &Vec<Option<f64>>| {
        let cells: Vec<String> =
            row.iter().map(|r| r.map_or_else(|| "nan".to_owned(), |r| format!("{r:.4}"))).collect();
        format!("  [{}]", cells.join(", "))
    };
    (names, rows.iter().map(row).collect())
}
