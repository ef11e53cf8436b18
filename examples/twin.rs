#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use mavid::estimate::*;
use mavid::signals::*;
use mavid::simulate::pid::*;
fn main() {
    let vehicle = mavid::config::load_vehicle(std::path::Path::new("configs/qball2.toml")).unwrap();
    let t = nalgebra::SVector::from([1.82245, 0.00749, -0.00051, -0.00003, 0.00976, -0.00098, 0.05130]);
    let (traj) =
        mavid::config::read_trajectory(std::path::Path::new("configs/trajectories/table2.toml")).unwrap();
    let truth = mavid::vehicle::RigidBody {
        mass_kg: t[0],
        inertia_kg_m2: inertia_of(&t),
        center_of_mass_m: nalgebra::Vector3::zeros(),
    };
    let s = PidFlightSettings::default();
    let f = simulate_pid_flight(
        &mavid::physics::RigidBodyModel::new(&truth, 9.81).unwrap(),
        &traj.series,
        &s,
        None,
    )
    .unwrap();
    let sig = condition(&f.recording, &vehicle, &ConditionSettings::default()).unwrap();
    println!("{:?} {}", sig.quality.usable, sig.grid.step_s);
    let id = identify(&[sig], &vehicle, &IdentifySettings::default()).unwrap();
    for m in &id.methods {
        print!("{:12}", m.method.name());
        for i in 0..7 {
            print!(
                " {}={:.5}({:.2}%)±{:.5}",
                NAMES[i],
                m.estimated.theta[i],
                100. * (m.estimated.theta[i] - t[i]) / scale_of(&t, i),
                m.estimated.covariance[(i, i)].sqrt()
            );
        }
        println!();
    }
    println!("{:?} {:?} cut {}", id.latency, id.compensated, id.cutoff_hz);
}
