//! What it costs to leave an effect out, by the model's own figures: the table `[identified.prediction]` of its file.

use crate::text::significant;
use toml::{Table, Value};

/// Quantities of a prediction: keys of the table, names and units.
const QUANTITIES: [(&str, &str, &str); 4] = [
    ("position_m", "position", "m"),
    ("velocity_m_s", "velocity", "m/s"),
    ("attitude_rad", "attitude", "rad"),
    ("rates_rad_s", "body rate", "rad/s"),
];
/// An error that grows by less at every horizon is told as none that grows, as a factor. Only words depend on it.
const GROWS: f64 = 1.02;

/// Errors of prediction with an effect and without it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Costs<'a>(Option<&'a Table>);

impl<'a> Costs<'a> {
    /// Of the table `[identified]`.
    pub(super) fn of(identified: Option<&'a Table>) -> Self {
        Self(identified.and_then(|table| table.get("prediction")?.as_table()))
    }

    /// How much larger errors are without an effect, at each horizon, as half a sentence.
    pub(super) fn words(&self, id: &str) -> String {
        let Some((horizons_s, each)) = self.errors(id) else {
            return "how much that costs in prediction is not in the model's file: `mavid explain` writes it"
                .to_owned();
        };
        let growth = |(_, _, pairs): &(&str, &str, Vec<(f64, f64)>)| {
            pairs.iter().map(|(with, without)| without / with).fold(0.0, f64::max)
        };
        let worst = each.iter().max_by(|a, b| growth(a).total_cmp(&growth(b)));
        let Some((name, unit, pairs)) = worst.filter(|worst| growth(worst) >= GROWS) else {
            return "without it no error of prediction grows by 2 % or more".to_owned();
        };
        let at = |(horizon_s, (with, without)): (&f64, &(f64, f64))| {
            format!(
                "from {} to {} {unit} over {horizon_s} s",
                significant(*with, 2),
                significant(*without, 2)
            )
        };
        let at: Vec<String> = horizons_s.iter().zip(pairs).map(at).collect();
        format!("without it the prediction error of the {name} grows {}", at.join(", "))
    }

    /// Horizons (s), and of each quantity the errors with the effect and without it.
    #[expect(clippy::type_complexity, reason = "two words, and pairs at each horizon")]
    fn errors(&self, id: &str) -> Option<(Vec<f64>, Vec<(&'static str, &'static str, Vec<(f64, f64)>)>)> {
        let table = self.0?;
        let without = table.get("without")?.as_table()?.get(id)?.as_table()?;
        let horizons_s = numbers(table.get("window_s")?)?;
        let each = QUANTITIES.into_iter().filter_map(|(key, name, unit)| {
            let pairs: Vec<(f64, f64)> =
                numbers(table.get(key)?)?.into_iter().zip(numbers(without.get(key)?)?).collect();
            (pairs.len() == horizons_s.len()).then_some((name, unit, pairs))
        });
        let each: Vec<_> = each.collect();
        (!each.is_empty()).then_some((horizons_s, each))
    }
}

/// Positive, finite numbers of an array.
fn numbers(value: &Value) -> Option<Vec<f64>> {
    let number = |value: &Value| {
        let number = value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
        number.filter(|number| number.is_finite() && *number > 0.0)
    };
    value.as_array()?.iter().map(number).collect()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "a test ends where it fails")]
    use super::*;

    #[test]
    fn the_cost_is_that_of_the_quantity_that_suffers_most_at_every_horizon() {
        let table: Table = toml::from_str(
            "[prediction]\nwindow_s = [0.5, 1.0]\nposition_m = [0.012, 0.03]\nrates_rad_s = [0.038, 0.05]\n\
             [prediction.without.weak_rotor]\nposition_m = [0.05, 0.2]\nrates_rad_s = [1.71, 3.2]\n\
             [prediction.without.inflow]\nposition_m = [0.01201, 0.03]\nrates_rad_s = [0.038, 0.05]\n",
        )
        .unwrap();
        let costs = Costs::of(Some(&table));
        assert_eq!(
            costs.words("weak_rotor"),
            "without it the prediction error of the body rate grows from 0.038 to 1.7 rad/s over 0.5 s, from 0.050 to 3.2 \
             rad/s over 1 s"
        );
        assert_eq!(costs.words("inflow"), "without it no error of prediction grows by 2 % or more");
        let unknown = "is not in the model's file: `mavid explain` writes it";
        assert!(
            costs.words("tether").ends_with(unknown) && Costs::of(None).words("inflow").ends_with(unknown)
        );
    }
}
