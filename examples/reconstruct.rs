#![allow(warnings, clippy::all)]
use mavid::{config::load_vehicle, log, physics::effects, reconstruction::{fit, force_problem}};
fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let vehicle = load_vehicle(args[0].as_ref()).unwrap();
    for path in &args[1..] {
        let opened = log::open(std::path::Path::new(path), &Default::default()).unwrap();
        let drag = effects::by_id("linear_drag").unwrap();
        let t = std::time::Instant::now();
        let (problem, free) = force_problem(&opened.recording, &vehicle, &[drag]).unwrap();
        let names: Vec<_> = problem.unknowns.iter().map(|u| u.name).collect();
        match fit(problem, &free) {
            Ok(f) => {
                println!("{path}: {:.2} s, cost {:.0}", t.elapsed().as_secs_f64(), f.cost);
                for n in names { let (v, s, r) = f.value(n).unwrap(); println!("   {n:12} {v:9.4} +- {s:.4} (blocks {r:.4})"); }
                for s in &f.sigma { println!("   sigma {:.4} {:.4} {:.4}", s[0], s[1], s[2]); }
            }
            Err(e) => println!("{path}: {e}"),
        }
    }
}
