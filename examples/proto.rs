use mavid::plan::{bounds::*, criterion::*, descent::*, information::*, space::*, optimise::*};
use nalgebra::*;
use std::time::Instant;
fn main() {
    let starts: u64 = std::env::args().nth(1).map_or(16, |s| s.parse().unwrap());
    let seeds: u64 = std::env::args().nth(2).map_or(5, |s| s.parse().unwrap());
    let vehicle = mavid::config::read_vehicle(std::path::Path::new("configs/qball2.toml")).unwrap().vehicle;
    let z = std::env::args().nth(3).map_or(AxisStart::Near(1.1), |_| AxisStart::OnBound(0.7));
    let space = SeriesSpace::new(10.0, 5, [AxisStart::At(0.0), AxisStart::At(0.0), z, AxisStart::At(0.0)]);
    let sampler = GramSampler::new(&space, 64, Vector4::repeat(1.0), 9.81);
    let problem = Problem { sampler, criterion: Criterion::Cond, parameter_scale: SVector::repeat(1.0), bounds: bounds_of(&vehicle.limits, &vehicle), dynamics: Dynamics::new(&vehicle), space };
    for seed in 0..seeds {
        let t0 = Instant::now();
        let search = Search::new(seed, starts);
        let best = search.run(&problem, 5000, &|| {}).unwrap();
        println!("{seed} {:.5} viol {:.1e} {:.1?} z0 {:.4}", best.log_value.exp(), best.violation, t0.elapsed(), problem.space.trajectory(&best.unknowns).derivatives(0.0)[2][0]);
    }
}
