//! The trajectory against the vehicle's own fence.

use super::stopping::place_and_velocity;
use super::{Situation, Stopping};
use crate::fly::finding::Finding;
use crate::plan::path_samples;
use nalgebra::Vector3;

pub(super) fn findings(situation: &Situation<'_>, stopping: &Stopping) -> Vec<Finding> {
    let fence = situation.fence;
    let unknown = fence.unknown.iter().map(|why| {
        let remedy = "read the fence again, or look at it in another ground station";
        Finding::warning("fence", "the vehicle's whole fence", why.clone(), remedy)
    });
    let mut findings: Vec<Finding> = unknown.collect();
    if fence.is_empty() {
        if findings.is_empty() {
            findings.push(Finding::warning(
                "fence",
                "a fence round the place of the flight",
                "none in force",
                "set one: it is the last thing that stops a vehicle that flies away",
            ));
        }
        return findings;
    }
    let Some(home) = situation.home_m else {
        findings.push(Finding::refusal(
            "fence",
            "home, from which the fence is measured",
            "not known",
            "wait for a position estimate, or set home",
        ));
        return findings;
    };
    let (flown, stopped) = nearest(situation, stopping, &home);
    findings.extend(flown.map(|nearest| judge_path(&nearest, fence.margin_m)));
    findings.extend(stopped.and_then(|nearest| judge_stop(&nearest, stopping)));
    findings
}

/// The nearest approach to any border.
struct Nearest {
    spare_m: f64,
    border: &'static str,
    time_s: f64,
}

fn nearest(
    situation: &Situation<'_>,
    stopping: &Stopping,
    home: &Vector3<f64>,
) -> (Option<Nearest>, Option<Nearest>) {
    let (mut flown, mut stopped): (Option<Nearest>, Option<Nearest>) = (None, None);
    for (time_s, entry) in path_samples(situation.path) {
        let (place, velocity) = place_and_velocity(&entry);
        let rest = stopping.rest(&place, &velocity);
        for (slot, place) in [(&mut flown, place), (&mut stopped, rest)] {
            for (spare_m, border) in situation.fence.spares_m(&(place + situation.origin_m), home) {
                if slot.as_ref().is_none_or(|least| spare_m < least.spare_m) {
                    *slot = Some(Nearest { spare_m, border, time_s });
                }
            }
        }
    }
    (flown, stopped)
}

fn judge_path(nearest: &Nearest, margin_m: f64) -> Finding {
    let Nearest { spare_m, border, time_s } = nearest;
    let expected = format!("at least {margin_m:.1} m from {border}");
    if *spare_m < margin_m || spare_m.is_nan() {
        let came = if *spare_m < 0.0 {
            format!("{:.2} m beyond it at {time_s:.1} s", -spare_m)
        } else {
            format!("{spare_m:.2} m at {time_s:.1} s")
        };
        let remedy = "move the start, plan a smaller trajectory, or correct the fence";
        return Finding::refusal("fence", expected, came, remedy);
    }
    Finding::ok("fence", expected, format!("{spare_m:.2} m at the nearest, at {time_s:.1} s"))
}

fn judge_stop(nearest: &Nearest, stopping: &Stopping) -> Option<Finding> {
    (nearest.spare_m < 0.0).then(|| {
        Finding::warning(
            "fence",
            format!("rest inside it from every point, {}", stopping.basis),
            format!(
                "{:.2} m beyond {} if stopped at {:.1} s",
                -nearest.spare_m, nearest.border, nearest.time_s
            ),
            "move the start away from that border",
        )
    })
}
