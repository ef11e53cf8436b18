use mavid::plan::{bounds::*, criterion::*, descent::*, information::*, space::*};
use mavid::vehicle::*;
use nalgebra::*;
use rand::{RngExt, SeedableRng};
use std::time::Instant;
fn main() {
    let grid_n: u32 = std::env::args().nth(1).map_or(80, |s| s.parse().unwrap());
    let starts: u32 = std::env::args().nth(2).map_or(20, |s| s.parse().unwrap());
    let deg = std::f64::consts::PI / 180.0;
    let limits = Limits {
        roll_max_rad: Some(5.73 * deg),
        pitch_max_rad: Some(5.73 * deg),
        yaw_max_rad: Some(180.0 * deg),
        yaw_rate_max_rad_s: Some(28.65 * deg),
        x_max_m: Some(1.0),
        y_max_m: Some(1.0),
        z_min_m: Some(0.7),
        z_max_m: Some(1.5),
        speed_max_m_s: Some(0.5),
        ..Limits::default()
    };
    let rotors = [(0.2, 0.0, Spin::Cw), (-0.2, 0.0, Spin::Cw), (0.0, 0.2, Spin::Ccw), (0.0, -0.2, Spin::Ccw)]
        .map(|(x, y, spin)| Rotor { name: "r".into(), position_m: Vector3::new(x, y, 0.0), spin });
    let vehicle = Vehicle {
        name: "qball".into(),
        body: RigidBody {
            mass_kg: 1.79,
            inertia_kg_m2: Matrix3::from_diagonal(&Vector3::new(0.03, 0.03, 0.04)),
            center_of_mass_m: Vector3::zeros(),
        },
        propulsion: Propulsion {
            actuator: Actuator::Thrust,
            law: ThrustLaw::Curve { thrust_max_n: f64::NAN, expo: 0.0 },
            thrust_coefficient: None,
            torque_per_thrust_m: 0.02,
            rotor_radius_m: None,
            time_constant_s: None,
        },
        rotors: rotors.to_vec(),
        limits,
        anchor: Anchor::Thrust,
        gravity_m_s2: 9.81,
    };
    let space = SeriesSpace::new(10.0, 5, [0.0, 0.0, std::env::var("Z0").map_or(0.7, |v| v.parse().unwrap()), 0.0], [false, false, std::env::var("JERK").is_err(), false]);
    let sampler = GramSampler::new(&space, 64, Vector4::repeat(1.0), 9.81);
    let problem = Problem {
        sampler,
        criterion: Criterion::Cond,
        parameter_scale: SVector::repeat(1.0),
        bounds: bounds_of(&limits, &vehicle),
        dynamics: Dynamics::new(&vehicle),
        space,
    };
    let grid = BoundGrid::new(&problem.space, grid_n, 0.0);
    let mut results = vec![]; let mut best = vec![];
    let t0 = Instant::now();
    for seed in 0..starts {
        let mut random = rand_pcg::Pcg64Mcg::seed_from_u64(u64::from(seed) + std::env::var("S0").map_or(0, |v| v.parse::<u64>().unwrap()));
        let x = DVector::from_fn(problem.space.dimension(), |_, _| random.random_range(-0.3..0.3));
        let mut it = problem.iterate(x, &grid);
        let t = Instant::now();
        let mut log = vec![];
        let mut n = 0;
        while !it.settled && n < 150 {
            problem.descend(&mut it, &grid, 1, 1e-7);
            n += 1;
            if n % 5 == 0 {
                log.push(format!("{:.3}", it.log_value.exp()));
            }
        }
        let _ = &log;
        if seed < 8 {
            println!(
                "{seed} {n} {:.4} viol {:.1e} prox {:.1e} {:.1?} {}",
                it.log_value.exp(),
                it.violation,
                it.proximal,
                t.elapsed(),
                log.join(" ")
            );
        }
        results.push(it.log_value.exp()); best.push((it.log_value.exp(), problem.space.trajectory(&it.unknowns)));
    }
    best.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (v, t) in best.iter().take(8) { println!("{v:.4}"); for ax in &t.axes { for l in 0..5 { print!("{:6.3}@{:4.0} ", ax.a[l].hypot(ax.b[l]), ax.b[l].atan2(ax.a[l]).to_degrees()); } println!("c {:.3}", ax.c); } }
    for (v, t) in best.iter().take(60) {
        let tt = Instant::now();
        let mut x = problem.space.unknowns(t);
        print!("{v:.4}");
        for n in [400,1000] {
        let g = BoundGrid::new(&problem.space, n, 0.0);
        let mut it = problem.iterate(x, &g);
        for k in 0..500 { problem.descend(&mut it, &g, 1, 1e-10); if it.settled { print!(" s{k} {:.0e}", it.proximal); break; } }
        print!(" -> {n} {:.5} viol {:.1e} {:.1?}", it.log_value.exp(), it.violation, tt.elapsed());
        x = it.unknowns;
        }
        println!();
    }
    results.sort_by(f64::total_cmp);
    println!("{:.1?} best {:.4?}", t0.elapsed(), &results[..10.min(results.len())]);
    println!("median {:.3} ", results[results.len() / 2]);
}
