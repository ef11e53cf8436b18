//! A strictly convex quadratic programme by the dual active-set method of Goldfarb and Idnani (1983).
//!
//! The planner's subproblems have some 35 unknowns, many dense rows and few active ones. The dual
//! method starts at the unconstrained minimum and pays for active rows only, returns exact vertices,
//! and needs no scaling or tolerance to be chosen; an interior-point solver would factor all rows at
//! every step.

use nalgebra::{DMatrix, DVector};

/// `minimise 1/2 z' H z + c' z` subject to `rows z <= limits`.
#[derive(Debug, Clone)]
pub struct QuadraticProgram {
    /// `H`, positive definite
    pub curvature: DMatrix<f64>,
    /// `c`
    pub slope: Vec<f64>,
    /// row-major, as wide as `slope`
    pub rows: Vec<f64>,
    /// one for each row
    pub limits: Vec<f64>,
}

/// Result of the programme.
#[derive(Debug, Clone, PartialEq)]
pub enum QuadraticOutcome {
    /// The minimum.
    Solved(DVector<f64>),
    /// No point keeps all rows.
    Infeasible,
    /// `H` is not positive definite, or rounding kept the method from ending.
    Stalled,
}

/// Active set with `J = L^-T Q` and the triangular factor `R` of Goldfarb and Idnani.
struct ActiveSet {
    inverse: DMatrix<f64>,
    factor: DMatrix<f64>,
    rows: Vec<usize>,
    multipliers: Vec<f64>,
}

impl QuadraticProgram {
    /// A programme without rows.
    #[must_use]
    pub fn new(curvature: DMatrix<f64>, slope: Vec<f64>) -> Self {
        Self { curvature, slope, rows: Vec::new(), limits: Vec::new() }
    }

    /// Adds `row z <= limit`.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>, limit: f64) {
        self.rows.extend(row);
        self.limits.push(limit);
    }

    fn row(&self, index: usize) -> &[f64] {
        let width = self.slope.len();
        &self.rows[index * width..(index + 1) * width]
    }

    /// Violation of row `index` at `z`.
    fn excess(&self, index: usize, z: &DVector<f64>) -> f64 {
        dot(self.row(index), z.as_slice()) - self.limits[index]
    }

    fn worst_row(&self, z: &DVector<f64>, tolerance: f64) -> Option<(usize, f64)> {
        let mut worst = None;
        let mut largest = tolerance;
        for index in 0..self.limits.len() {
            let excess = self.excess(index, z);
            if excess > largest {
                largest = excess;
                worst = Some((index, excess));
            }
        }
        worst
    }

    /// Solves the programme; rows are kept to `tolerance` (in the units of their limits). Wherever all
    /// rows hold, `add_rows` may push more and return true: the method then continues from there.
    #[must_use]
    pub fn solve(
        &mut self,
        tolerance: f64,
        mut add_rows: impl FnMut(&mut Self, &DVector<f64>) -> bool,
    ) -> QuadraticOutcome {
        let Some(cholesky) = self.curvature.clone().cholesky() else {
            return QuadraticOutcome::Stalled;
        };
        let Some(inverse) = cholesky.l().try_inverse() else {
            return QuadraticOutcome::Stalled;
        };
        let mut z = -cholesky.solve(&DVector::from_column_slice(&self.slope));
        let mut active = ActiveSet::new(inverse.transpose());
        for _ in 0..40 * self.slope.len() {
            let Some((index, _)) = self.worst_row(&z, tolerance) else {
                if !add_rows(self, &z) {
                    return QuadraticOutcome::Solved(z);
                }
                continue;
            };
            if active.rows.contains(&index) {
                return QuadraticOutcome::Stalled;
            }
            if !self.enforce(index, &mut z, &mut active) {
                return QuadraticOutcome::Infeasible;
            }
        }
        QuadraticOutcome::Stalled
    }

    /// Moves to a point at which row `index` holds with equality, and drops active rows that prevent it. False if the
    /// row contradicts those that stay.
    fn enforce(&self, index: usize, z: &mut DVector<f64>, active: &mut ActiveSet) -> bool {
        // the method's constraints read n' z >= b
        let normal: Vec<f64> = self.row(index).iter().map(|value| -value).collect();
        let mut multiplier = 0.0;
        for _ in 0..=2 * self.slope.len() {
            let projected = active.project(&normal);
            let (direction, dual) = (active.primal_step(&projected), active.dual_step(&projected));
            let along = dot(&normal, direction.as_slice());
            let blocking = active.blocking(&dual);
            let to_drop = blocking.map_or(f64::INFINITY, |(_, step)| step);
            let scale = dot(&normal, &normal);
            let to_row = if along > 1e-13 * scale { self.excess(index, z) / along } else { f64::INFINITY };
            let step = to_drop.min(to_row);
            if !step.is_finite() {
                return false;
            }
            if to_row.is_finite() {
                z.axpy(step, &direction, 1.0);
            }
            for (value, change) in active.multipliers.iter_mut().zip(&dual) {
                *value -= step * change;
            }
            multiplier += step;
            if to_row <= to_drop {
                active.add(index, multiplier, projected);
                return true;
            }
            if let Some((position, _)) = blocking {
                active.remove(position);
            }
        }
        false
    }
}

impl ActiveSet {
    fn new(inverse: DMatrix<f64>) -> Self {
        let factor = DMatrix::zeros(inverse.ncols(), inverse.ncols());
        Self { inverse, factor, rows: Vec::new(), multipliers: Vec::new() }
    }

    /// `J' n`
    fn project(&self, normal: &[f64]) -> Vec<f64> {
        self.inverse.column_iter().map(|column| dot(column.as_slice(), normal)).collect()
    }

    /// The part of the step that leaves the active rows as they are.
    fn primal_step(&self, projected: &[f64]) -> DVector<f64> {
        let mut step = DVector::zeros(projected.len());
        for (column, share) in projected.iter().enumerate().skip(self.rows.len()) {
            step.axpy(*share, &self.inverse.column(column), 1.0);
        }
        step
    }

    /// `R^-1 d`: how the multipliers of the active rows fall per unit of the new one.
    fn dual_step(&self, projected: &[f64]) -> Vec<f64> {
        let count = self.rows.len();
        let mut step = projected[..count].to_vec();
        for row in (0..count).rev() {
            for column in row + 1..count {
                step[row] -= self.factor[(row, column)] * step[column];
            }
            step[row] /= self.factor[(row, row)];
        }
        step
    }

    /// The active row whose multiplier first falls to zero, and the step at which it does.
    fn blocking(&self, dual: &[f64]) -> Option<(usize, f64)> {
        let falling = dual.iter().enumerate().filter(|(_, change)| **change > 1e-14);
        falling
            .map(|(position, change)| (position, self.multipliers[position] / change))
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    fn add(&mut self, index: usize, multiplier: f64, mut projected: Vec<f64>) {
        let count = self.rows.len();
        for column in (count + 1..projected.len()).rev() {
            let rotation = Rotation::new(projected[column - 1], projected[column]);
            (projected[column - 1], projected[column]) = (rotation.length, 0.0);
            rotation.turn_columns(&mut self.inverse, column - 1);
        }
        for (row, value) in projected.iter().enumerate().take(count + 1) {
            self.factor[(row, count)] = *value;
        }
        self.rows.push(index);
        self.multipliers.push(multiplier);
    }

    fn remove(&mut self, position: usize) {
        let count = self.rows.len();
        self.rows.remove(position);
        self.multipliers.remove(position);
        for column in position..count - 1 {
            for row in 0..=column + 1 {
                self.factor[(row, column)] = self.factor[(row, column + 1)];
            }
            let rotation = Rotation::new(self.factor[(column, column)], self.factor[(column + 1, column)]);
            (self.factor[(column, column)], self.factor[(column + 1, column)]) = (rotation.length, 0.0);
            for next in column + 1..count - 1 {
                let pair = (self.factor[(column, next + 1)], self.factor[(column + 1, next + 1)]);
                let (upper, lower) = rotation.turn(pair);
                self.factor[(column, next + 1)] = upper;
                self.factor[(column + 1, next + 1)] = lower;
            }
            rotation.turn_columns(&mut self.inverse, column);
        }
    }
}

/// A plane rotation that brings (`first`, `second`) to (`length`, 0).
struct Rotation {
    cos: f64,
    sin: f64,
    length: f64,
}

impl Rotation {
    fn new(first: f64, second: f64) -> Self {
        let length = (first * first + second * second).sqrt();
        if length == 0.0 {
            return Self { cos: 1.0, sin: 0.0, length };
        }
        Self { cos: first / length, sin: second / length, length }
    }

    fn turn(&self, (first, second): (f64, f64)) -> (f64, f64) {
        (self.cos * first + self.sin * second, self.cos * second - self.sin * first)
    }

    /// Turns columns `left` and `left + 1`.
    fn turn_columns(&self, matrix: &mut DMatrix<f64>, left: usize) {
        let height = matrix.nrows();
        let (head, tail) = matrix.as_mut_slice().split_at_mut((left + 1) * height);
        for (first, second) in head[left * height..].iter_mut().zip(tail) {
            (*first, *second) = self.turn((*first, *second));
        }
    }
}

/// Inner product with eight running sums, so that additions are independent.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a_chunks, b_chunks) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a_chunks.remainder().iter().zip(b_chunks.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a_chunks.zip(b_chunks) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    rest + sums.iter().sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    fn solved(program: &mut QuadraticProgram) -> DVector<f64> {
        match program.solve(1e-10, |_, _| false) {
            QuadraticOutcome::Solved(point) => point,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn a_corner_is_found() {
        // the point of x + y <= 1, x <= 0.2 nearest to (1, 1)
        let mut program = QuadraticProgram::new(DMatrix::identity(2, 2), vec![-1.0, -1.0]);
        program.push([1.0, 1.0], 1.0);
        program.push([1.0, 0.0], 0.2);
        assert!((solved(&mut program) - DVector::from_vec(vec![0.2, 0.8])).norm() < 1e-12);
    }

    #[test]
    fn contradiction_is_infeasible() {
        let mut program = QuadraticProgram::new(DMatrix::identity(2, 2), vec![0.0, 0.0]);
        program.push([1.0, 0.0], -1.0);
        program.push([-1.0, 0.0], -1.0);
        assert_eq!(program.solve(1e-10, |_, _| false), QuadraticOutcome::Infeasible);
    }

    /// The minimum of a convex programme: feasible, and no feasible point lies downhill. Checked by
    /// projecting the gradient on random feasible directions.
    #[test]
    fn random_programmes_end_at_their_minimum() {
        let mut random = Pcg64Mcg::seed_from_u64(7);
        for _ in 0..30 {
            let (width, count) = (8, 60);
            let root = DMatrix::from_fn(width, width, |_, _| random.random_range(-1.0..1.0));
            let curvature = &root * root.transpose() + DMatrix::identity(width, width) * 0.01;
            let slope = (0..width).map(|_| random.random_range(-1.0..1.0)).collect();
            let mut program = QuadraticProgram::new(curvature, slope);
            for _ in 0..count {
                let row: Vec<f64> = (0..width).map(|_| random.random_range(-1.0..1.0)).collect();
                program.push(row, random.random_range(0.05..0.5));
            }
            let z = solved(&mut program);
            assert!(program.worst_row(&z, 1e-9).is_none());
            let value = |z: &DVector<f64>| -> f64 {
                0.5 * z.dot(&(&program.curvature * z)) + dot(&program.slope, z.as_slice())
            };
            for _ in 0..200 {
                let step = DVector::from_fn(width, |_, _| random.random_range(-0.01..0.01));
                let other = &z + step;
                if program.worst_row(&other, 0.0).is_none() {
                    assert!(value(&other) >= value(&z) - 1e-12);
                }
            }
        }
    }
}
