use mavid::diagnose::*;
use mavid::signals::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let vehicle = mavid::config::read_vehicle(std::path::Path::new(&a[1])).unwrap().vehicle;
    let mut traces = vec![];
    let t0 = std::time::Instant::now();
    for f in &a[2..] {
        let rec = if f.ends_with("csv") {
            mavid::log::csv::read_csv(std::path::Path::new(f), &mavid::config::default_csv_mapping().unwrap())
                .unwrap()
                .0
        } else {
            mavid::log::load(std::path::Path::new(f), &Default::default()).unwrap().recording
        };
        let set = ConditionSettings {
            transient_s: Some(std::env::var("TR").map(|x| x.parse().unwrap()).unwrap_or(1.0)),
            thrust: if std::env::var("MEAS").is_ok() {
                ThrustPreference::Measured
            } else {
                ThrustPreference::Commands
            },
            ..Default::default()
        };
        let s = condition(&rec, &vehicle, &set).unwrap();
        if std::env::var("Q").is_ok() {
            println!("{:?}", s.quality.offsets);
        }
        traces.push(s);
    }
    let t1 = t0.elapsed();
    let ex = explain(&traces, &vehicle, &ExplainSettings::default()).unwrap();
    let out = &ex.search;
    let show = |f: &Fitted| {
        let b = &f.base;
        print!(
            "  m {:.4} J {:.3e} {:.3e} {:.3e} lat {:.4}/{:.4} sig {} ",
            b.vehicle.body.mass_kg,
            b.vehicle.body.inertia_kg_m2[(0, 0)],
            b.vehicle.body.inertia_kg_m2[(1, 1)],
            b.vehicle.body.inertia_kg_m2[(2, 2)],
            b.latency.delay_s,
            b.latency.lag_s,
            f.weighted.sigma.map(|s| format!("{s:.1e}")).join(" ")
        );
        let mut i = f.rows.nuisances.len();
        for p in &b.present {
            print!("| {} {:?}", p.effect.id(), p.values);
            for _ in &p.free {
                print!(" +-{:.2e}", f.covariance[(i, i)].sqrt());
                i += 1;
            }
        }
        println!();
    };
    println!(
        "{} {:?} closest {:?}  prep {:?} explain {:?} rows {}",
        ex.verdict.name(),
        ex.named
            .iter()
            .map(|n| format!(
                "{} {} conf {:?}",
                n.id,
                n.parameters
                    .iter()
                    .map(|p| format!("{} {:.4}+-{:.4}", p.name, p.value, p.std))
                    .collect::<Vec<_>>()
                    .join(" "),
                n.confusable_with.iter().map(|c| (c.id, c.distinguishability)).collect::<Vec<_>>()
            ))
            .collect::<Vec<_>>(),
        ex.closest.iter().map(|n| n.id).collect::<Vec<_>>(),
        t1,
        t0.elapsed() - t1,
        out.after.rows.len()
    );
    if std::env::var("V").is_ok() {
        show(&out.before);
    }
    for s in &out.steps {
        println!(
            "  took {} at {:?} theta {:.4?} z {:.1} gain {:.3} pcl {:.1e}; rivals {:?}",
            s.taken.candidate.id,
            s.taken.candidate.parts[0].values,
            s.taken.evidence.theta,
            s.taken.evidence.z,
            s.taken.evidence.gain,
            s.taken.evidence.p_cluster,
            s.rivals
                .iter()
                .map(|r| format!("{} {:.3} z{:.0}", r.candidate.id, r.evidence.gain, r.evidence.z))
                .collect::<Vec<_>>()
        );
    }
    show(&out.after);
    if std::env::var("V").is_ok() {
        println!("   latency {:?}", out.latency);
    }
    if let Some(f) = &ex.lack_of_fit {
        println!(
            "   LOF period {:.3} x{} p {} rms {:.3?} excess {:.1} of {:.1}",
            f.period_s,
            f.periods,
            f.p_value.map(|p| format!("{p:.0e}")).join(" "),
            f.excess_rms,
            f.excess_energy,
            out.after.weighted.energy
        );
    } else {
        println!("   not periodic");
    }
    for (when, located) in [("before", &ex.located_before), ("after", &ex.located_after)] {
        let Some(located) = located else { continue };
        println!(
            "   {when} shares {} changes {:?}",
            located.axes.map(|a| format!("{:.2}({:.1e}/{:.1e})", a.share, a.rms, a.noise)).join(" "),
            located
                .changes
                .iter()
                .take(3)
                .map(|c| format!("{} {:.1}s {:?} {:.3}", c.channel, c.time_s, c.kind, c.size))
                .collect::<Vec<_>>()
        );
        for f in located.follows.iter().take(4) {
            println!(
                "      {} {} F {:.0} share {:.2} partial {:.0} {:.2} entered {:?} peak {:.2}",
                f.channel,
                f.state.name(),
                f.f,
                f.share,
                f.partial_f,
                f.partial_share,
                f.entered,
                f.peak_at
            );
        }
        println!(
            "      bands {:?}",
            located.bands.map(|b| b.map(|b| format!("{:.2}-{:.2} h {:?}", b.low_hz, b.high_hz, b.harmonic)))
        );
        println!(
            "      coherent {:?}",
            located
                .coherences
                .iter()
                .take(3)
                .map(|c| format!(
                    "{} {} {:.2}>{:.2} at {:.2}",
                    c.channel,
                    c.with.name(),
                    c.mean,
                    c.noise,
                    c.frequency_hz
                ))
                .collect::<Vec<_>>()
        );
    }
    println!("   field {:?}", ex.field);
    println!("   aperiodic {:?}", ex.aperiodic);
    let mut l = out.last.clone();
    l.sort_by(|a, b| b.evidence.z.total_cmp(&a.evidence.z));
    println!(
        "    left {}",
        l.iter()
            .take(4)
            .map(|t| format!(
                "{} z {:.1} gain {:.4} pcl {:.0e} {:.4?};",
                t.candidate.id, t.evidence.z, t.evidence.gain, t.evidence.p_cluster, t.evidence.theta
            ))
            .collect::<String>()
    );
}
