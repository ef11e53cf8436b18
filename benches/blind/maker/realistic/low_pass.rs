//! A low-pass of second order, after Butterworth.

use nalgebra::Vector3;

/// Of three axes.
#[derive(Debug, Clone)]
pub struct LowPass {
    /// of the input now, once and twice back; of the output once and twice back
    weights: [f64; 5],
    inputs: [Vector3<f64>; 2],
    outputs: [Vector3<f64>; 2],
}

impl LowPass {
    /// With a cut, Hz, for samples `step` s apart, at rest at `value`.
    pub fn new(cut: f64, step: f64, value: Vector3<f64>) -> Self {
        let warped = (std::f64::consts::PI * cut * step).tan();
        let damped = std::f64::consts::SQRT_2 * warped;
        let whole = 1.0 + damped + warped * warped;
        let ahead = warped * warped / whole;
        let back = [2.0 * (warped * warped - 1.0) / whole, (1.0 - damped + warped * warped) / whole];
        let weights = [ahead, 2.0 * ahead, ahead, -back[0], -back[1]];
        Self { weights, inputs: [value; 2], outputs: [value; 2] }
    }

    /// The next sample.
    pub fn next(&mut self, input: Vector3<f64>) -> Vector3<f64> {
        let [now, once, twice, last, before] = self.weights;
        let output = now * input
            + once * self.inputs[0]
            + twice * self.inputs[1]
            + last * self.outputs[0]
            + before * self.outputs[1];
        self.inputs = [input, self.inputs[0]];
        self.outputs = [output, self.outputs[0]];
        output
    }
}
