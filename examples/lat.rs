use mavid::diagnose::*;
use mavid::signals::*;
use nalgebra::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let v = mavid::config::read_vehicle(std::path::Path::new(&a[1])).unwrap().vehicle;
    let rec = mavid::log::load(std::path::Path::new(&a[2]), &Default::default()).unwrap().recording;
    let s = condition(
        &rec,
        &v,
        &ConditionSettings {
            transient_s: Some(1.0),
            thrust: ThrustPreference::Commands,
            ..Default::default()
        },
    )
    .unwrap();
    println!("{:?}\n{:?} step {}", s.quality.offsets, s.quality.sources, s.grid.step_s);
    let t = Trace::new(&s, &v, 0.2).unwrap();
    println!("bias {:?}", t.accelerometer_bias_m_s2);
    let kin = t.weak_kinematic().unwrap();
    let imu = t.weak_vector(0, s.specific_force.as_ref().unwrap());
    let vb: Vec<Vector3<f64>> = t.states.iter().map(|x| x.body_velocity_m_s()).collect();
    let vb = t.weak_vector(0, &vb);
    let t0: f64 = std::env::var("T0").map(|x| x.parse().unwrap()).unwrap_or(0.);
    let t1: f64 = std::env::var("T1").map(|x| x.parse().unwrap()).unwrap_or(1e9);
    for (n, y) in [("imu", &imu), ("kin", &kin)] {
        for ax in 0..2 {
            let idx: Vec<usize> = (0..t.rows())
                .filter(|&i| {
                    let x = t.grid.time_s(t.centers[i]);
                    x > t0 && x < t1
                })
                .collect();
            let x = DMatrix::from_fn(idx.len(), 3, |i, j| match j {
                0 => vb[ax][idx[i]],
                1 => vb[ax][idx[i]] * vb[ax][idx[i]].abs(),
                _ => 1.,
            });
            let yy = DVector::from_fn(idx.len(), |i, _| y[ax][idx[i]]);
            let th = (x.transpose() * &x).try_inverse().unwrap() * x.transpose() * &yy;
            let r = &yy - &x * &th;
            let x1 = x.columns(0, 1).into_owned();
            let lin = (x1.transpose() * &yy)[0] / (x1.norm_squared());
            println!(
                "{n} axis {ax} lin+quad+const {:?} rms {:.3} y rms {:.3}; lin only {:.3} vrms {:.3}",
                th.as_slice(),
                r.norm() / (idx.len() as f64).sqrt(),
                yy.norm() / (idx.len() as f64).sqrt(),
                lin,
                x1.norm() / (idx.len() as f64).sqrt()
            );
        }
    }
    if let Ok(f) = std::env::var("DUMP") {
        use std::io::Write;
        let mut o = std::fs::File::create(f).unwrap();
        for i in 0..t.grid.count {
            let q = &t.states[i];
            let vb = q.body_velocity_m_s();
            let sf = s.specific_force.as_ref().unwrap()[i];
            writeln!(
                o,
                "{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}",
                t.grid.time_s(i),
                s.usable[i] as u8,
                vb.x,
                vb.y,
                vb.z,
                sf.x,
                sf.y,
                sf.z,
                q.rates_rad_s.x,
                q.rates_rad_s.y,
                q.rates_rad_s.z,
                s.wrench[i][0],
                s.wrench[i][1],
                s.wrench[i][2],
                s.wrench[i][3]
            )
            .unwrap();
        }
    }
}
