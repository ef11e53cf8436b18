//! A search in all its steps.

use mavid::diagnose::Explanation;

/// What the search took, and what was left.
pub fn print_steps(explanation: &Explanation) {
    for step in &explanation.search.steps {
        println!(
            "    took {} {:?} e {:.0}",
            step.taken.candidate.id, step.taken.evidence.theta, step.taken.evidence.energy
        );
        for rival in step.rivals.iter().take(5) {
            let e = &rival.evidence;
            let values = &rival.candidate.parts[0].values;
            println!(
                "      before {:18} {values:?} theta {:?} z {:.1} e {:.0}",
                rival.candidate.id, e.theta, e.z, e.energy
            );
        }
    }
    let mut last: Vec<_> = explanation.search.last.iter().collect();
    last.sort_by(|a, b| b.evidence.energy.total_cmp(&a.evidence.energy));
    println!("    {} candidates", last.len());
    for tested in last.iter().take(14) {
        let e = &tested.evidence;
        println!(
            "    {:18} {:?} theta {:?} std {:.3e} z {:.1} pc {:.1e} gain {:.4} e {:.1} rms {:?}",
            tested.candidate.id,
            tested.candidate.parts[0].values,
            e.theta,
            e.std(0),
            e.z,
            e.p_cluster,
            e.gain,
            e.energy,
            e.rms
        );
    }
    println!(
        "    sigma {:?} torque {:?} {:?}",
        explanation.search.after.weighted.sigma,
        explanation.search.after.rows.torque_rms,
        explanation.search.after.base.effects
    );
}
