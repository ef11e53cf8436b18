//! Forward-mode differentiation: one formula gives values (`f64`) and exact gradients ([`Dual`]).

use std::ops::{Add, Div, Mul, Neg, Sub};

/// What the kinematic formulas need of a number.
pub trait Scalar:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// A number that depends on nothing.
    fn constant(value: f64) -> Self;
    /// Sine and cosine, argument in radians.
    fn sin_cos(self) -> (Self, Self);
    /// Square root.
    fn sqrt(self) -> Self;
    /// Angle of the point (`x`, `self`), radians.
    fn atan2(self, x: Self) -> Self;
}

impl Scalar for f64 {
    fn constant(value: f64) -> Self {
        value
    }

    fn sin_cos(self) -> (Self, Self) {
        self.sin_cos()
    }

    fn sqrt(self) -> Self {
        self.sqrt()
    }

    fn atan2(self, x: Self) -> Self {
        self.atan2(x)
    }
}

/// A value and its gradient with respect to `N` inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dual<const N: usize> {
    /// value
    pub value: f64,
    /// derivative with respect to each input
    pub gradient: [f64; N],
}

impl<const N: usize> Dual<N> {
    /// The input number `index` itself.
    #[must_use]
    pub fn input(value: f64, index: usize) -> Self {
        Self { value, gradient: std::array::from_fn(|k| f64::from(u8::from(k == index))) }
    }

    /// `f(self)` where `f` has this value and slope here.
    fn through(self, value: f64, slope: f64) -> Self {
        Self { value, gradient: self.gradient.map(|g| slope * g) }
    }

    /// `f(self, other)` with this value and these partial slopes.
    fn through_two(self, other: Self, value: f64, slopes: (f64, f64)) -> Self {
        let gradient = std::array::from_fn(|k| slopes.0 * self.gradient[k] + slopes.1 * other.gradient[k]);
        Self { value, gradient }
    }
}

impl<const N: usize> Add for Dual<N> {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        let gradient = std::array::from_fn(|k| self.gradient[k] + other.gradient[k]);
        Self { value: self.value + other.value, gradient }
    }
}

impl<const N: usize> Sub for Dual<N> {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        let gradient = std::array::from_fn(|k| self.gradient[k] - other.gradient[k]);
        Self { value: self.value - other.value, gradient }
    }
}

impl<const N: usize> Mul for Dual<N> {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        self.through_two(other, self.value * other.value, (other.value, self.value))
    }
}

impl<const N: usize> Div for Dual<N> {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let value = self.value / other.value;
        self.through_two(other, value, (1.0 / other.value, -value / other.value))
    }
}

impl<const N: usize> Neg for Dual<N> {
    type Output = Self;
    fn neg(self) -> Self {
        self.through(-self.value, -1.0)
    }
}

impl<const N: usize> Scalar for Dual<N> {
    fn constant(value: f64) -> Self {
        Self { value, gradient: [0.0; N] }
    }

    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value.sin_cos();
        (self.through(sin, cos), self.through(cos, -sin))
    }

    fn sqrt(self) -> Self {
        let root = self.value.sqrt();
        self.through(root, 0.5 / root)
    }

    fn atan2(self, x: Self) -> Self {
        let square = self.value * self.value + x.value * x.value;
        self.through_two(x, self.value.atan2(x.value), (x.value / square, -self.value / square))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn formula<S: Scalar>(x: S, y: S) -> S {
        let (sin, cos) = (x * y).sin_cos();
        (sin / (y + S::constant(2.0))).atan2(cos - x) + (x * x + y * y).sqrt() - (-y)
    }

    #[test]
    fn gradients_agree_with_differences() {
        let (x, y, h) = (0.7, 1.3, 1e-6);
        let dual = formula(Dual::<2>::input(x, 0), Dual::input(y, 1));
        let numeric = [
            (formula(x + h, y) - formula(x - h, y)) / (2.0 * h),
            (formula(x, y + h) - formula(x, y - h)) / (2.0 * h),
        ];
        assert!((dual.value - formula(x, y)).abs() < 1e-15);
        assert!((dual.gradient[0] - numeric[0]).abs() < 1e-8);
        assert!((dual.gradient[1] - numeric[1]).abs() < 1e-8);
    }
}
