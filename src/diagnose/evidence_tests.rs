//! Expected numbers are those of NumPy and SciPy: `python3 tests/peers/evidence_numbers.py`, with `0.1` after it where
//! something is known beforehand.

use super::super::channels::{Nuisance, NuisanceColumn};
use super::super::rows::tests::rows_of;
use super::*;

const ROWS: i32 = 240;
const SIGMA: [f64; CHANNELS] = [0.5, 1.0, 1.0, 0.1, 1.0, 1.0, 1.0, 1.0, 1.0];

/// Numbers without order in -0.5..0.5.
fn chance(k: i32, row: i32) -> f64 {
    let j = row + 1;
    f64::from((j * j * (17 * k + 23) + j * (101 * k + 59)) % 1009) / 1009.0 - 0.5
}

fn noise(k: i32, row: i32) -> f64 {
    chance(k, row) + if row > 0 { 0.6 * chance(k, row - 1) } else { 0.0 }
}

/// One of the force on body x and one of the torque about it; nothing in the other channels.
fn column(force: impl Fn(i32) -> f64, torque: impl Fn(i32) -> f64) -> Channels {
    let mut out: Channels = std::array::from_fn(|_| (0..ROWS).map(|_| 0.0).collect());
    out[0] = (0..ROWS).map(force).collect();
    out[3] = (0..ROWS).map(torque).collect();
    out
}

/// Rows with two nuisances, of which a spread of the second may be known, and one effect; and two tested columns.
fn problem(prior_std: Option<f64>) -> (Rows, [Channels; 2]) {
    let a = column(|i| (0.11 * f64::from(i)).sin(), |i| 0.1 * (0.05 * f64::from(i)).cos());
    let b = column(|i| (0.031 * f64::from(i)).cos(), |i| 0.1 * chance(7, i));
    let bias = column(|_| 1.0, |_| 0.0);
    let lean = column(|i| (0.11 * f64::from(i) + 1.0).sin(), |_| 0.02);
    let present = column(|_| 0.0, |i| 0.1 * (0.02 * f64::from(i)).sin());
    let shares = [(&a, 0.3), (&b, -0.4), (&bias, 0.2), (&lean, 0.5), (&present, 0.7)];
    let mut residual = column(|i| 0.4 * noise(1, i), |i| 0.08 * noise(2, i));
    for (of, share) in shares {
        for (to, from) in residual.iter_mut().zip(of) {
            to.iter_mut().zip(from).for_each(|(to, from)| *to += share * from);
        }
    }
    let nuisance = |values, prior_std| NuisanceColumn {
        nuisance: Nuisance::Mass,
        values,
        first_row: 0,
        prior_std,
        prior_mean: 0.0,
        considered: None,
    };
    let nuisances = vec![nuisance(bias, None), nuisance(lean, prior_std)];
    (rows_of(vec![0..150, 150..240], residual, nuisances, vec![present]), [a, b])
}

fn all_near(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-7 * expected.abs(), "{found}, not {expected}");
    }
}

#[test]
fn coefficients_deviate_and_chances_are_those_of_one_least_squares_problem() {
    let (rows, tested) = problem(None);
    let found = Weighted::at(&rows, &SIGMA).test(&tested).unwrap();
    all_near(&found.theta, &[0.341_521_197_258_292_2, -0.393_563_212_976_975_6]);
    let (variances, across) =
        ([2.728_810_634_747_147_5e-4, 2.276_016_559_031_640_5e-4], -5.313_336_503_872_927e-6);
    all_near(found.covariance.as_slice(), &[variances[0], across, across, variances[1]]);
    all_near(&[found.z, found.p_cluster], &[32.833_312_842_234_356, 4.330_111_096_967_485e-13]);
    all_near(&[found.energy, found.gain], &[128.381_582_285_327_26, 0.787_420_808_059_761_6]);
    all_near(&[found.rms[0], found.rms[3]], &[0.340_320_098_773_846_67, 0.026_767_925_023_138_652]);
    assert!((0..CHANNELS).all(|channel| [0, 3].contains(&channel) || found.rms[channel] == 0.0));
}

#[test]
fn nuisances_have_the_coefficients_of_ridge_regression() {
    let known = [
        (
            None,
            163.040_627_033_548_87,
            [0.141_338_590_528_405_58, 0.634_696_038_234_631_4, 0.714_971_685_058_907],
        ),
        (
            Some(0.1),
            196.658_886_284_414_9,
            [0.146_051_443_283_149_87, 0.529_674_950_301_773, 0.722_932_956_455_108_7],
        ),
    ];
    for (prior_std, energy, theta) in known {
        let (rows, _) = problem(prior_std);
        let weighted = Weighted::at(&rows, &SIGMA);
        all_near(weighted.coefficients(&rows).0.as_slice(), &theta);
        all_near(&[weighted.energy], &[energy]);
    }
}

/// What is known of a coefficient stays where it is, wherever the fit has come: a coefficient from elsewhere is the same one.
#[test]
fn a_prior_keeps_its_mean() {
    const KNOWN: f64 = 0.3;
    let (mut from_zero, _) = problem(Some(0.1));
    from_zero.nuisances[1].prior_mean = KNOWN;
    let mut at_mean = from_zero.clone();
    at_mean.nuisances[1].prior_mean = 0.0;
    let column = at_mean.nuisances[1].values.clone();
    for (to, values) in at_mean.residual.iter_mut().zip(&column) {
        to.iter_mut().zip(values).for_each(|(to, value)| *to -= KNOWN * value);
    }
    let (from_zero_fit, at_mean_fit) = (Weighted::at(&from_zero, &SIGMA), Weighted::at(&at_mean, &SIGMA));
    let mut expected = at_mean_fit.coefficients(&at_mean).0;
    expected[1] += KNOWN;
    all_near(from_zero_fit.coefficients(&from_zero).0.as_slice(), expected.as_slice());
    assert!((&from_zero_fit.left - &at_mean_fit.left).norm() < 1e-9);
}

#[test]
fn what_is_known_of_a_nuisance_counts_once() {
    let (rows, tested) = problem(Some(0.1));
    let found = Weighted::at(&rows, &SIGMA).test(&tested).unwrap();
    all_near(&found.theta, &[0.385_276_648_962_127_43, -0.391_595_481_738_795_1]);
    all_near(&[found.energy, found.gain], &[144.469_871_519_824_04, 0.734_621_629_611_421_2]);
}

/// The last 90 of 240 rows are of a flight whose torques are not compared: there the channel is zero and does not count.
#[test]
fn rows_that_do_not_measure_a_channel_do_not_count_in_it() {
    const MEASURED: usize = 150;
    let (mut rows, _) = problem(None);
    let nuisances = rows.nuisances.iter_mut().map(|column| &mut column.values);
    for values in nuisances.chain(&mut rows.effects).chain([&mut rows.residual]) {
        values[3][MEASURED..].fill(0.0);
    }
    let counted_everywhere = Weighted::new(&rows);
    rows.measured[3].truncate(1);
    let weighted = Weighted::new(&rows);
    assert_eq!((weighted.count_of(3), weighted.count_of(0)), (MEASURED, 240));
    let left = weighted.left_of(3);
    let rms = (left.iter().map(|value| value * value).sum::<f64>() / MEASURED as f64).sqrt();
    assert!((weighted.sigma[3] / rms - 1.0).abs() < 0.02, "{}, not {rms}", weighted.sigma[3]);
    assert!((weighted.gammas(&weighted.left)[3][0] - 1.0).abs() < 0.04);
    let ratio = counted_everywhere.sigma[3] / weighted.sigma[3];
    assert!((ratio / (MEASURED as f64 / 240.0).sqrt() - 1.0).abs() < 0.02, "{ratio}");
}
