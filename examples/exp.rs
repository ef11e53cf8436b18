#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use mavid::estimate::*;
use mavid::signals::*;
use mavid::simulate::*;
use rayon::prelude::*;
fn env(n: &str, d: f64) -> f64 {
    std::env::var(n).map(|v| v.parse().unwrap()).unwrap_or(d)
}
fn main() {
    let n = env("N", 200.0) as u64;
    let rows: Vec<[[f64; 2]; 7]> = (0..n)
        .into_par_iter()
        .filter_map(|k| {
            let seed = 9000 + k;
            let mut pair = random_vehicle(seed * 7919 + 13);
            if env("SWAP", 0.) > 0. {
                for v in [&mut pair.truth, &mut pair.nominal] {
                    let j = v.body.inertia_kg_m2;
                    let mut m = j;
                    m[(0, 0)] = j[(1, 1)];
                    m[(1, 1)] = j[(0, 0)];
                    v.body.inertia_kg_m2 = m;
                }
            }
            if env("EXACT", 0.) > 0. {
                pair.nominal = pair.truth.clone();
            }
            if env("DIAG", 0.) > 0. {
                for v in [&mut pair.truth] {
                    let j = v.body.inertia_kg_m2;
                    v.body.inertia_kg_m2 = nalgebra::Matrix3::from_diagonal(&j.diagonal());
                }
            }
            let mut rt = RandomTrajectory::default();
            rt.yaw_max_rad = env("YAW", rt.yaw_max_rad);
            let trajectory = rt.draw(seed * 31 + 7).ok()?;
            let reference = mavid::simulate::Reference { trajectory, hover_s: 4.0, ramp_s: 2.0 };
            let mut s = FlightSettings { seed: seed * 17 + 3, ..Default::default() };
            s.control_noise_scale = env("CN", 1.0);
            s.telemetry.noise_scale = env("LN", 1.0);
            s.motor_time_constant_s = env("MT", 0.004);
            s.telemetry.rates.rotor_speed_hz = None;
            if env("R", 0.) > 0. {
                s.telemetry.rates.actuator_hz = env("R", 125.);
                s.telemetry.rates.imu_hz = env("R", 125.);
                s.telemetry.rates.attitude_hz = env("R", 125.);
            }
            let f = simulate_flight(Truth::clean(pair.truth.clone()), &pair.nominal, &reference, &s).ok()?;
            let sig = condition(&f.recording, &pair.nominal, &ConditionSettings::default()).ok()?;
            let is = IdentifySettings { weak_half_width_s: env("H", 0.2), ..Default::default() };
            let id = identify(&[sig], &pair.nominal, &is).ok()?;
            let t = theta_of(&f.truth.vehicle.body);
            let m = std::env::var("M").unwrap_or("WEAK".into());
            let r = id.methods.iter().find(|r| r.method.name() == m)?;
            Some(std::array::from_fn(|i| {
                let e = r.estimated.theta[i] - t[i];
                [100. * e / scale_of(&t, i), e / r.estimated.covariance[(i, i)].sqrt()]
            }))
        })
        .collect();
    let c = rows.len() as f64;
    for i in 0..7 {
        let m = rows.iter().map(|r| r[i][0]).sum::<f64>() / c;
        let sd = (rows.iter().map(|r| (r[i][0] - m).powi(2)).sum::<f64>() / c).sqrt();
        let zs = (rows.iter().map(|r| r[i][1].powi(2)).sum::<f64>() / c).sqrt();
        let cov = rows.iter().filter(|r| r[i][1].abs() < 1.96).count() as f64 / c;
        print!("{}: {:.3}±{:.3} z{:.2} c{:.3} | ", NAMES[i], m, sd / c.sqrt(), zs, cov);
    }
    println!();
}
