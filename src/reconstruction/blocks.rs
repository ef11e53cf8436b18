//! States along time, and the matrices of their size.

use nalgebra::{Const, Dyn, OMatrix, SMatrix, SVector};

/// Components of one state.
pub const STATE: usize = 9;
/// Components of a residual.
pub const WIDTH: usize = 3;

/// One state.
pub type State = SVector<f64, STATE>;
/// A block of the states' normal matrix, or a covariance.
pub type Block = SMatrix<f64, STATE, STATE>;
/// Derivatives of one residual by both neighbouring states.
pub type Pair = SMatrix<f64, WIDTH, { 2 * STATE }>;
/// States by parameters: one line a component, one column a parameter.
pub type Columns<const LINES: usize> = OMatrix<f64, Const<LINES>, Dyn>;
