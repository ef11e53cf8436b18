//! How the estimators err, to be held against what is known of real ones.

use rayon::prelude::*;

use crate::maker::realistic::case::{EFFECTS, RealCase};
use crate::maker::realistic::flight::Errors;

/// Tells the errors of this many flights from a seed on.
pub fn tell(seed: u64, count: u64) {
    let all: Vec<_> = (seed..seed + count)
        .into_par_iter()
        .map(|seed| {
            let effect = EFFECTS[usize::try_from(seed).unwrap_or(0) % EFFECTS.len()];
            (seed, effect, RealCase::flown(seed, &[effect]))
        })
        .collect();
    for capture in [false, true] {
        let mut errors: Vec<Errors> = Vec::new();
        for (seed, effect, made) in &all {
            match made {
                Err(why) if !capture => println!("  seed {seed} {effect}: {why}"),
                Ok((case, [first, _])) if case.senses.source.motion_capture == capture => {
                    let axes = first.visibility.axes.map(|axis| format!("{axis:.0}")).join(" ");
                    println!("  seed {seed} draw {} {effect}: seen {axes}", case.draw);
                    errors.push(first.errors);
                }
                _ => {}
            }
        }
        if errors.is_empty() {
            continue;
        }
        let of = |name: &str, get: &dyn Fn(&Errors) -> f64| {
            let mut values: Vec<f64> = errors.iter().map(get).collect();
            values.sort_by(f64::total_cmp);
            let at = |share: usize| values[(values.len() - 1) * share / 4];
            println!("  {name:10} {:.4} {:.4} {:.4} {:.4} {:.4}", at(0), at(1), at(2), at(3), at(4));
        };
        println!("motion capture {capture}: {} flights; least, quartiles and most", errors.len());
        of("velocity", &|e| (e.velocity.norm_squared() / 3.0).sqrt());
        of("v x", &|e| e.velocity.x);
        of("v z", &|e| e.velocity.z);
        of("attitude", &|e| e.attitude);
        of("tilt", &|e| e.tilt);
        of("position", &|e| e.position);
        of("rates", &|e| e.rates);
        for (place, name) in ["nis p", "nis v", "nis baro", "nis yaw"].into_iter().enumerate() {
            of(name, &|e| e.innovations[place]);
        }
    }
}
