//! Detection limits.

use super::flights::{Conditions, fly};
use super::measured::Limit;
use super::support::digits::short;
use mavid::diagnose::Explanation;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// What a study in another language reached at 125 Hz and noise of 1, at z = 4 (drag N/(m/s), quadratic N/(m/s)^2, tilt
/// rad, inflow N/(m/s), factor, m, N m s, N m/(m/s), kg m^2).
const MARKS: [(&str, &str, f64); 13] = [
    ("linear_drag", "dx", 0.0056),
    ("linear_drag", "dy", 0.0056),
    ("quadratic_drag", "cx", 0.0028),
    ("quadratic_drag", "cy", 0.0028),
    ("thrust_tilt", "x", 0.0005),
    ("thrust_curve", "curvature", 0.035),
    ("inflow", "kz", 0.025),
    ("weak_rotor", "factor", 0.0012),
    ("com_offset", "x", 0.000_09),
    ("com_offset", "y", 0.000_09),
    ("angular_damping", "bx", 0.0033),
    ("blade_flapping", "k", 0.0009),
    ("rotor_inertia", "jr", 1.7e-6),
];

/// The smallest sizes that would have been named, on clean flights at 125 Hz and noise of 1.
pub fn run(first: u64, count: u64) -> Vec<Limit> {
    let with = Conditions { usual: true, marks: true, ..Conditions::default() };
    let found: Vec<Explanation> =
        (first..first + count).into_par_iter().filter_map(|seed| fly(seed, &[], with)).collect();
    let mut limits: BTreeMap<(&str, &str, &str), Vec<f64>> = BTreeMap::new();
    for limit in found.iter().flat_map(|explanation| &explanation.limits) {
        limits.entry((limit.id, limit.parameter, limit.unit)).or_default().push(limit.limit);
    }
    println!(
        "\nsmallest size that is named (z = 4), median and 90th percentile of {} flights, over the mark:",
        found.len()
    );
    let mut out = Vec::new();
    for ((id, parameter, unit), mut sizes) in limits {
        sizes.sort_by(f64::total_cmp);
        let (median, most) = (sizes[sizes.len() / 2], sizes[sizes.len() * 9 / 10]);
        let mark = MARKS.iter().find(|(mark, of, _)| (*mark, *of) == (id, parameter));
        let over = mark.map_or_else(String::new, |(.., mark)| format!("{:.2} of {mark:.2e}", median / mark));
        println!("  {id:20} {parameter:14} {median:10.3e} {most:10.3e} {unit:12} {over}");
        out.push(Limit {
            id: id.to_owned(),
            parameter: parameter.to_owned(),
            unit: unit.to_owned(),
            median: short(median),
            most: short(most),
        });
    }
    out
}
