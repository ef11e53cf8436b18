//! The paper's finite Fourier series (18), with the second derivative's misprint mended.

/// One axis of (18): `q = sum a/(w l) sin(w l t) - b/(w l) cos(w l t) + c`.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierAxis {
    /// `a_l`, l = 1..N, in the axis' unit per second
    pub a: Vec<f64>,
    /// `b_l`, l = 1..N, in the axis' unit per second
    pub b: Vec<f64>,
    /// offset, in the axis' unit
    pub c: f64,
}

impl FourierAxis {
    /// Value and its first four time derivatives at `t_s` for the fundamental `w_rad_s`.
    #[must_use]
    pub fn derivatives(&self, w_rad_s: f64, t_s: f64) -> [f64; 5] {
        let mut out = [self.c, 0.0, 0.0, 0.0, 0.0];
        let mut harmonic = 0.0;
        for (&a, &b) in self.a.iter().zip(&self.b) {
            harmonic += 1.0;
            let w = w_rad_s * harmonic;
            let (s, c) = (w * t_s).sin_cos();
            let (along, across) = (a * c + b * s, b * c - a * s);
            out[0] -= across / w;
            out[1] += along;
            out[2] += w * across;
            out[3] -= w * w * along;
            out[4] -= w * w * w * across;
        }
        out
    }
}

/// `q_d = [x y z psi]` (19), world NWU, metres and radians.
#[derive(Debug, Clone, PartialEq)]
pub struct FourierTrajectory {
    /// T of the paper, s
    pub period_s: f64,
    /// x, y, z, psi
    pub axes: [FourierAxis; 4],
}

impl FourierTrajectory {
    /// Fundamental frequency `w_f = 2 pi / T`, rad/s.
    #[must_use]
    pub fn fundamental_rad_s(&self) -> f64 {
        std::f64::consts::TAU / self.period_s
    }

    /// For x, y, z, psi: value and first four derivatives.
    #[must_use]
    pub fn derivatives(&self, t_s: f64) -> [[f64; 5]; 4] {
        let w = self.fundamental_rad_s();
        std::array::from_fn(|axis| self.axes[axis].derivatives(w, t_s))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_agree_with_differences() {
        let axis = FourierAxis { a: vec![0.3, -0.1, 0.2], b: vec![0.1, 0.4, -0.2], c: 0.7 };
        let (w, t, h) = (0.6, 1.3, 1e-4);
        let (before, now, after) =
            (axis.derivatives(w, t - h), axis.derivatives(w, t), axis.derivatives(w, t + h));
        for order in 0..4 {
            let numeric = (after[order] - before[order]) / (2.0 * h);
            assert!((numeric - now[order + 1]).abs() < 1e-6, "order {order}");
        }
    }
}
