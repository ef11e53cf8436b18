//! The output prediction error (43).

use super::SampledModel;
use nalgebra::{SVector, Vector4};

/// RMS of each component of `e_y = Gamma Theta - Upsilon` (43) over the samples from `from_s` to `to_s`
/// (s, vehicle clock): N, N m, N m, N m. `None` where there are none.
#[must_use]
pub fn output_prediction_rms(
    model: &SampledModel,
    theta: &SVector<f64, 7>,
    (from_s, to_s): (f64, f64),
) -> Option<[f64; 4]> {
    let (mut sum, mut count) = (Vector4::zeros(), 0_usize);
    for ((time_s, gamma), upsilon) in model.time_s.iter().zip(&model.gamma).zip(&model.upsilon) {
        if (from_s..=to_s).contains(time_s) {
            let error = gamma.matrix() * theta - upsilon;
            sum += error.component_mul(&error);
            count += 1;
        }
    }
    (count > 0).then(|| sum.map(|square| (square / count as f64).sqrt()).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::regression::Phi;
    use nalgebra::Vector3;

    #[test]
    fn each_component_has_its_own_error() {
        let gamma = Phi::of(10.0, &Vector3::zeros(), &Vector3::new(2.0, 0.0, 0.0));
        let model = SampledModel {
            step_s: 1.0,
            time_s: vec![0.0, 1.0, 2.0],
            gamma: vec![gamma; 3],
            upsilon: vec![
                Vector4::new(19.0, 0.0, 0.0, 3.0),
                Vector4::new(21.0, 0.0, 0.0, 3.0),
                Vector4::zeros(),
            ],
            runs: vec![],
        };
        let theta = SVector::from([2.0, 0.25, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(output_prediction_rms(&model, &theta, (0.0, 1.5)), Some([1.0, 0.5, 0.0, 3.0]));
        assert_eq!(output_prediction_rms(&model, &theta, (5.0, 6.0)), None);
    }
}
