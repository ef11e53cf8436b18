//! Tests of weighted least squares.

use super::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// y = 2 x0 - x1 + coloured noise; x smooth. The intervals must cover although neighbours repeat.
#[test]
fn intervals_hold_under_coloured_noise() {
    let mut generator = rand_pcg::Pcg64::seed_from_u64(3);
    let mut covered = 0;
    let mut naive = 0;
    let trials = 200;
    for _ in 0..trials {
        let n = 1000;
        let (mut noise, mut slow) = (0.0, [0.0, 0.0]);
        let mut channel = Channel { y: DVector::zeros(n), x: DMatrix::zeros(n, 2) };
        for t in 0..n {
            let mut draw = || -> f64 { StandardNormal.sample(&mut generator) };
            noise = 0.7 * noise + draw();
            for (j, slow) in slow.iter_mut().enumerate() {
                *slow = 0.95 * *slow + draw();
                channel.x[(t, j)] = *slow;
            }
            channel.y[t] = 2.0 * slow[0] - slow[1] + noise;
        }
        let problem = Problem {
            channels: vec![channel],
            runs: std::iter::once(0..n).collect(),
            priors: vec![],
            overlap: 1,
        };
        let solution = problem.solve();
        let error = (solution.theta[0] - 2.0).abs();
        covered += i32::from(error < 1.96 * solution.covariance[(0, 0)].sqrt());
        let inverse = (problem.channels[0].x.transpose() * &problem.channels[0].x).try_inverse().unwrap();
        naive += i32::from(error < 1.96 * solution.sigma[0] * inverse[(0, 0)].sqrt());
    }
    assert!((180..=198).contains(&covered), "covered {covered} of {trials}");
    assert!(naive < covered - 15, "white intervals would have covered {naive}");
}

#[test]
fn an_empty_column_is_not_a_number() {
    let x = DMatrix::from_fn(50, 2, |t, j| if j == 0 { (t as f64).sin() } else { 0.0 });
    let y = x.column(0) * 3.0;
    let problem = Problem {
        channels: vec![Channel { y, x }],
        runs: std::iter::once(0..50).collect(),
        priors: vec![],
        overlap: 1,
    };
    let solution = problem.solve();
    assert!((solution.theta[0] - 3.0).abs() < 1e-9);
    assert!(solution.theta[1].is_nan());
}
