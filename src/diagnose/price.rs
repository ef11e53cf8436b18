//! The cost of a model: its residual, its number of columns, and the distance of its nuisance parameters from their priors.

use super::fit::Fitted;
use super::priors::Alike;
use super::tested::Tested;

/// Energy that a column must explain to justify a parameter, in squared standard deviations of independent rows. Set
/// by judgement; measured only together with all conditions of a name (see `Gates`).
const COLUMN_PRICE: f64 = 12.0;

/// Scale of what is not a residual, for models of the same rows.
#[derive(Debug, Clone, Copy)]
pub(super) struct Price {
    /// rows that count as one independent row
    alike: Alike,
}

impl Price {
    /// By the correlation of the residual that a model leaves.
    pub(super) fn of(fitted: &Fitted) -> Self {
        Self { alike: fitted.weighted.alike() }
    }

    /// Of these columns, in squared sigmas of the rows.
    pub(super) fn of_columns(self, count: usize) -> f64 {
        COLUMN_PRICE * self.alike.all * count as f64
    }

    /// Energy that a candidate explains, less the price of its columns.
    pub(super) fn worth(self, tested: &Tested) -> f64 {
        tested.evidence.energy - self.of_columns(tested.evidence.theta.len())
    }

    /// Twice the negative log-density of the rows and of the nuisances' priors, and the columns' price, in squared sigmas of the
    /// rows, up to a constant. Rows are too many by the factor by which they are alike, so the priors are multiplied by it.
    pub(super) fn cost(self, fitted: &Fitted) -> f64 {
        2.0 * (fitted.misfit() + fitted.against_priors(self.alike))
            + self.of_columns(fitted.rows.effects.len())
    }
}

#[cfg(test)]
mod tests {
    use super::super::base::Base;
    use super::super::fit::evaluate;
    use super::super::rows::tests::{turning_on_the_spot, vehicle};
    use super::super::trace::Trace;
    use super::*;

    /// A nuisance two of its prior's standard deviations from zero costs four squared sigmas of independent rows.
    #[test]
    fn nuisances_cost_by_their_priors() {
        let vehicle = vehicle();
        let trace = Trace::new(&turning_on_the_spot(), &vehicle, 0.2).unwrap();
        let fitted = evaluate(&[trace], Base::rigid(&vehicle)).unwrap();
        let (index, std) = fitted
            .rows
            .nuisances
            .iter()
            .enumerate()
            .find_map(|(index, column)| Some((index, column.prior_std?)))
            .unwrap();
        let price = Price { alike: Alike { all: 3.0, torques: 3.0 } };
        let at = |coefficient: f64| {
            let mut moved = fitted.clone();
            moved.coefficients[index] = coefficient;
            price.cost(&moved)
        };
        assert!((at(2.0 * std) - at(0.0) - 3.0 * 4.0).abs() < 1e-6 * at(0.0).abs().max(1.0));
        assert!((price.of_columns(2) - 72.0).abs() < 1e-12);
    }
}
