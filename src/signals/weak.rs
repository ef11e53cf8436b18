//! The weak (integral) form: derivatives move from the data to a smooth test function.
//!
//! With `phi(s) = (1 - (s/H)^2)^4` on `[-H, H]`, normalised to `integral phi = 1`,
//! `integral phi f^(d) dt = (-1)^d integral phi^(d) f dt`. Each order is one FIR filter, applied at
//! chosen centres only; all orders have the same support, so nothing is delayed against anything.

use super::Grid;
use nalgebra::Vector3;

/// Highest derivative that the kernel offers; `phi'''` still vanishes at the ends.
pub const MAX_ORDER: usize = 3;

/// FIR taps of the test function and its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct WeakKernel {
    /// samples on each side of the centre
    pub half_count: usize,
    taps: [Vec<f64>; MAX_ORDER + 1],
}

impl WeakKernel {
    /// Kernel of half width `half_width_s` for data spaced `step_s`, at least four samples a side.
    ///
    /// The taps of order d are scaled so that they give exactly the derivative of `t^d`.
    #[must_use]
    pub fn new(half_width_s: f64, step_s: f64) -> Self {
        let mut half_count = 4;
        while (half_count as f64 + 0.5) * step_s < half_width_s {
            half_count += 1;
        }
        // the support ends where the next sample would lie
        let h = (half_count as f64 + 1.0) * step_s;
        let offset = |i: usize| (i as f64 - half_count as f64) * step_s;
        let mut taps: [Vec<f64>; MAX_ORDER + 1] = Default::default();
        let mut factorial = 1.0;
        for (order, taps) in taps.iter_mut().enumerate() {
            if order > 0 {
                factorial *= order as f64;
            }
            let sign = if order % 2 == 0 { 1.0 } else { -1.0 };
            *taps = (0..=2 * half_count).map(|i| sign * bump_derivative(offset(i) / h, order)).collect();
            // a sampled phi'' still answers a constant, a sampled phi''' a slope: taken out
            if order >= 2 {
                let power = i32::from(order == 3);
                let s = |i: usize| offset(i) / h;
                let shape = |i: usize| s(i).powi(power) * bump_derivative(s(i), 0);
                let answer: f64 = taps.iter().enumerate().map(|(i, tap)| tap * s(i).powi(power)).sum();
                let scale: f64 = (0..=2 * half_count).map(|i| shape(i) * s(i).powi(power)).sum();
                taps.iter_mut().enumerate().for_each(|(i, tap)| *tap -= answer / scale * shape(i));
            }
            let power = i32::try_from(order).unwrap_or(0);
            let moment: f64 =
                taps.iter().enumerate().map(|(i, tap)| tap * offset(i).powi(power) / factorial).sum();
            taps.iter_mut().for_each(|tap| *tap /= moment);
        }
        Self { half_count, taps }
    }

    /// `integral phi f^(order) dt` at one centre; `column` is spaced as the kernel was made for.
    #[must_use]
    pub fn at(&self, order: usize, column: &[f64], center: usize) -> f64 {
        let window = &column[center - self.half_count..=center + self.half_count];
        self.taps[order].iter().zip(window).map(|(tap, value)| tap * value).sum()
    }

    /// The same at all centres.
    #[must_use]
    pub fn apply(&self, order: usize, column: &[f64], centers: &[usize]) -> Vec<f64> {
        let window = |center: usize| &column[center - self.half_count..=center + self.half_count];
        let mut out = Vec::with_capacity(centers.len());
        // each sum in its own order, four side by side: one alone waits for every addition
        let mut fours = centers.chunks_exact(4);
        for four in &mut fours {
            let [a, b, c, d] = [four[0], four[1], four[2], four[3]].map(window);
            let mut sums = [-0.0; 4];
            for ((((tap, a), b), c), d) in self.taps[order].iter().zip(a).zip(b).zip(c).zip(d) {
                sums = [sums[0] + tap * a, sums[1] + tap * b, sums[2] + tap * c, sums[3] + tap * d];
            }
            out.extend(sums);
        }
        out.extend(fours.remainder().iter().map(|&center| self.at(order, column, center)));
        out
    }

    /// The same of each component of a vector series.
    #[must_use]
    pub fn apply_vector(&self, order: usize, series: &[Vector3<f64>], centers: &[usize]) -> [Vec<f64>; 3] {
        let mut out: [Vec<f64>; 3] = std::array::from_fn(|_| Vec::with_capacity(centers.len()));
        let window = |center: usize| &series[center - self.half_count..=center + self.half_count];
        let taps = &self.taps[order];
        let mut put = |sums: &Vector3<f64>| out.iter_mut().zip(sums).for_each(|(out, sum)| out.push(*sum));
        // as of one component
        let mut fours = centers.chunks_exact(4);
        for four in &mut fours {
            let [a, b, c, d] = [four[0], four[1], four[2], four[3]].map(window);
            let mut sums = [Vector3::repeat(-0.0); 4];
            for ((((tap, a), b), c), d) in taps.iter().zip(a).zip(b).zip(c).zip(d) {
                sums.iter_mut().zip([a, b, c, d]).for_each(|(sum, value)| *sum += value * *tap);
            }
            sums.iter().for_each(&mut put);
        }
        for &center in fours.remainder() {
            let mut sums = Vector3::repeat(-0.0);
            taps.iter().zip(window(center)).for_each(|(tap, value)| sums += value * *tap);
            put(&sums);
        }
        out
    }

    /// Covariance of two outputs whose centres lie `lag` samples apart, per variance of white input noise.
    #[must_use]
    pub fn noise_covariance(&self, order: usize, lag: usize) -> f64 {
        let taps = &self.taps[order];
        taps.iter().zip(taps.iter().skip(lag)).map(|(tap, other)| tap * other).sum()
    }

    /// Centres every `stride` samples whose whole support lies in a run of true entries of `mask`.
    #[must_use]
    pub fn centers(&self, mask: &[bool], stride: usize) -> Vec<usize> {
        Grid::runs(mask, 2 * self.half_count + 1)
            .into_iter()
            .flat_map(|run| (run.start + self.half_count..run.end - self.half_count).step_by(stride.max(1)))
            .collect()
    }
}

/// d-th derivative in s of `(1 - s^2)^4`.
fn bump_derivative(s: f64, order: usize) -> f64 {
    let u = 1.0 - s * s;
    match order {
        0 => u.powi(4),
        1 => -8.0 * s * u.powi(3),
        2 => -8.0 * u.powi(3) + 48.0 * s * s * u * u,
        _ => 144.0 * s * u * u - 192.0 * s.powi(3) * u,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn derivatives_of_a_sine() {
        let (step, w) = (0.008, 4.0);
        let kernel = WeakKernel::new(0.2, step);
        let column: Vec<f64> = (0..400).map(|i| (w * step * f64::from(i)).sin()).collect();
        // the kernel is even: every order sees the same attenuation
        let t = 200.0 * step;
        let gain = kernel.at(0, &column, 200) / (w * t).sin();
        assert!(gain > 0.9 && gain < 1.0);
        let expected = [(w * t).sin(), w * (w * t).cos(), -w * w * (w * t).sin(), -w * w * w * (w * t).cos()];
        for (order, value) in expected.iter().enumerate() {
            let got = kernel.at(order, &column, 200);
            assert!((got / (value * gain) - 1.0).abs() < 2e-3, "order {order}: {got} {value}");
        }
    }

    /// Of `phi` with `H` as half its width the second moment is `H^2 / 11`, the fourth `3 H^4 / 143` (beta functions, by
    /// hand); a cosine is lowered by `gamma(5.5) (2 / x)^4.5 J_4.5(x)`, x = w H, in every order.
    /// SciPy: `gamma(5.5) * (2 / x) ** 4.5 * jv(4.5, x)` at x = 4 H and 10 H. Samples in place of the integral leave more
    /// where the derivative of `phi` bends more at the ends.
    #[test]
    fn integrals_with_the_test_function_are_known() {
        let step = 0.008;
        let kernel = WeakKernel::new(0.2, step);
        let h = 26.0 * step;
        let t = |i: i32| step * f64::from(i - 200);
        let column = |of: &dyn Fn(f64) -> f64| -> Vec<f64> { (0..=400).map(|i| of(t(i))).collect() };
        let near = |order: usize, of: &dyn Fn(f64) -> f64, expected: f64| {
            let found = kernel.at(order, &column(of), 200);
            let sampled = [2e-7, 1e-5, 5e-5, 1e-3][order];
            assert!((found / expected - 1.0).abs() < sampled, "order {order}: {found}, not {expected}");
        };
        near(0, &|t| t * t, h * h / 11.0);
        near(0, &|t| t.powi(4), 3.0 * h.powi(4) / 143.0);
        // 3 t^2 and 12 t^2
        near(1, &|t| t.powi(3), 3.0 * h * h / 11.0);
        near(2, &|t| t.powi(4), 12.0 * h * h / 11.0);
        for (w, lowered) in [(4.0, 0.968_950_925_916_139_2), (10.0, 0.818_945_050_243_385)] {
            near(0, &|t| (w * t).cos(), lowered);
            near(1, &|t| (w * t).sin(), w * lowered);
            near(2, &|t| (w * t).cos(), -w * w * lowered);
            near(3, &|t| (w * t).sin(), -w * w * w * lowered);
        }
    }

    /// White noise of unit variance becomes `step / H` times `beta(1/2, 9) / beta(1/2, 5)^2`, its derivative `step / H^3`
    /// times `64 beta(3/2, 7) / beta(1/2, 5)^2`.
    /// SciPy: `beta(.5, 9) / beta(.5, 5) ** 2` and `64 * beta(1.5, 7) / beta(.5, 5) ** 2`
    #[test]
    fn noise_that_passes_is_known() {
        let step = 0.008;
        let (kernel, h) = (WeakKernel::new(0.2, step), 26.0 * step);
        let known = [0.907_034_142_328_260_2 * step / h, 4.405_594_405_594_406 * step / h.powi(3)];
        for (order, expected) in known.into_iter().enumerate() {
            let found = kernel.noise_covariance(order, 0);
            assert!((found / expected - 1.0).abs() < 1e-5, "order {order}: {found}, not {expected}");
        }
    }

    #[test]
    fn all_centres_at_once_give_what_each_gives() {
        let kernel = WeakKernel::new(0.05, 0.01);
        let series: Vec<Vector3<f64>> = (0..60)
            .map(f64::from)
            .map(|t| Vector3::new((0.37 * t).sin(), t.cos() - 0.1 * t, 1.0 / (1.0 + t)))
            .collect();
        let centers: Vec<usize> = (8..50).step_by(3).collect();
        assert_ne!(centers.len() % 4, 0);
        for order in 0..=MAX_ORDER {
            let by_vector = kernel.apply_vector(order, &series, &centers);
            for (axis, by_vector) in by_vector.iter().enumerate() {
                let column: Vec<f64> = series.iter().map(|v| v[axis]).collect();
                let each: Vec<f64> =
                    centers.iter().map(|&center| kernel.at(order, &column, center)).collect();
                assert_eq!(kernel.apply(order, &column, &centers), each);
                assert_eq!(by_vector, &each);
            }
        }
    }

    #[test]
    fn constants_have_no_derivative() {
        let kernel = WeakKernel::new(0.2, 0.01);
        let column = vec![3.0; 101];
        assert!((kernel.at(0, &column, 50) - 3.0).abs() < 1e-12);
        for order in 1..=MAX_ORDER {
            assert!(kernel.at(order, &column, 50).abs() < 1e-8);
        }
    }

    #[test]
    fn centres_keep_their_support_inside_runs() {
        let kernel = WeakKernel::new(0.05, 0.01);
        let mut mask = vec![true; 100];
        mask[40] = false;
        for center in kernel.centers(&mask, 3) {
            assert!(mask[center - kernel.half_count..=center + kernel.half_count].iter().all(|g| *g));
        }
    }
}
