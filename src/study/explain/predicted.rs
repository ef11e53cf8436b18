//! The errors of open-loop prediction.

use crate::compare::improvement_percent;
use crate::diagnose::holdout::{Compared, HALF_S, HoldoutFit, Interval, OpenLoop};

/// Open-loop errors on one set of flights.
#[derive(Debug, Clone, Default)]
pub struct Predicted {
    /// one a length of window
    pub open_loop: Vec<OpenLoop>,
    /// mean over the quantities at 0.5 s
    pub improvement_percent: Option<Interval>,
}

/// An error that falls by less does not fall, percent: rounded to whole percents it reads as nothing.
const FALLS_PERCENT: f64 = 0.5;
/// An error that rises by more is told beside the one that falls, percent. Only words depend on it: with a larger share a reader
/// would not hear of the loss, with a smaller one of chance.
const RISES_PERCENT: f64 = 2.0;

impl Predicted {
    /// The errors over windows of 0.5 s, of which the answer speaks.
    #[must_use]
    pub fn at_half_second(&self) -> Option<&OpenLoop> {
        OpenLoop::half_second(&self.open_loop)
    }

    /// The same by quantity.
    #[must_use]
    pub fn half_second(&self) -> [Option<Compared>; 4] {
        self.at_half_second().map_or([None; 4], OpenLoop::quantities)
    }

    /// The quantity whose error falls most, and by how much, percent; `None` where none falls.
    #[must_use]
    pub fn falls(&self) -> Option<(&'static str, f64)> {
        self.most().filter(|(_, percent)| *percent >= FALLS_PERCENT)
    }

    /// The quantity whose error rises most with the effects, and by how much, percent; `None` where none rises.
    #[must_use]
    pub fn rises(&self) -> Option<(&'static str, f64)> {
        let (name, percent) = self.least()?;
        (percent < -RISES_PERCENT).then_some((name, -percent))
    }

    /// The errors of a quantity with its unit; `None` where it is not predicted.
    #[must_use]
    pub fn errors_of(&self, quantity: &str) -> Option<(Compared, &'static str)> {
        let mut each = self.half_second().into_iter().zip(QUANTITIES);
        let (found, (_, unit)) = each.find(|(_, (name, _))| *name == quantity)?;
        Some((found?, unit))
    }

    /// The quantity whose error falls most, and by how much, percent.
    #[must_use]
    pub fn most(&self) -> Option<(&'static str, f64)> {
        self.half_second()
            .into_iter()
            .zip(QUANTITIES)
            .filter_map(|(compared, (name, _))| Some((name, compared?.improvement_percent.value)))
            // a model that left the flight has no error to speak of
            .filter(|(_, percent)| percent.is_finite())
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The quantity whose error the effects lower least, or raise, and by how much of the rigid body's, percent. That a state which does
    /// not change predicts better is no work of theirs.
    fn least(&self) -> Option<(&'static str, f64)> {
        self.half_second()
            .into_iter()
            .zip(QUANTITIES)
            .filter_map(|(compared, (name, _))| {
                let Compared { before, after, .. } = compared?;
                Some((name, improvement_percent(before.value, after.value)))
            })
            .filter(|(_, percent)| percent.is_finite())
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// What a state that does not change predicts better over 0.5 s: for that the model is none.
    #[must_use]
    pub fn worse_than_unchanged(&self) -> Vec<&'static str> {
        let worse = self.at_half_second().map_or([false; 4], OpenLoop::worse_than_unchanged);
        QUANTITIES.into_iter().zip(worse).filter(|(_, worse)| *worse).map(|((name, _), _)| name).collect()
    }

    /// The same over each window, or at its end, by quantity: the lengths of the windows (s), if there are any.
    #[must_use]
    pub fn no_model_of(&self) -> Vec<(&'static str, Vec<f64>)> {
        let each = QUANTITIES.into_iter().enumerate().map(|(place, (name, _))| {
            let worse = self.open_loop.iter().filter(|of| no_model_in(of)[place]);
            (name, worse.map(|of| of.window_s).collect::<Vec<_>>())
        });
        each.filter(|(_, windows_s)| !windows_s.is_empty()).collect()
    }

    /// Whether the answer has to tell it: it holds over 0.5 s, or over several windows.
    #[must_use]
    pub fn is_no_model(&self) -> bool {
        let worse = self.open_loop.iter().filter(|of| no_model_in(of).contains(&true));
        let windows_s: Vec<f64> = worse.map(|of| of.window_s).collect();
        windows_s.len() > 1 || windows_s.iter().any(|window_s| (window_s - HALF_S).abs() < 1e-9)
    }

    /// Mean over the quantities of what the effects lower the rigid body's errors by, percent. That a state which does not change
    /// predicts better does not count.
    #[must_use]
    pub fn work_of_effects(&self) -> Option<f64> {
        Self::work_on(&self.half_second())
    }

    /// The same of how the vehicle moves (position, velocity) and of how it turns (attitude, rates): the better one.
    #[must_use]
    pub fn better_work_of_effects(&self) -> Option<f64> {
        let all = self.half_second();
        let (moves, turns) = all.split_at(all.len() / 2);
        [moves, turns].into_iter().filter_map(Self::work_on).reduce(f64::max)
    }

    fn work_on(quantities: &[Option<Compared>]) -> Option<f64> {
        let each: Vec<f64> = quantities
            .iter()
            .flatten()
            .map(|Compared { before, after, .. }| improvement_percent(before.value, after.value))
            .filter(|percent| percent.is_finite())
            .collect();
        (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64)
    }

    /// Mean improvement over the quantities, percent.
    #[must_use]
    pub fn improvement(&self) -> Option<f64> {
        Self::mean_improvement(&self.half_second())
    }

    /// The same of how the vehicle moves: position and velocity.
    pub(super) fn improvement_in_motion(&self) -> Option<f64> {
        let all = self.half_second();
        Self::mean_improvement(&all[..all.len() / 2])
    }

    fn mean_improvement(quantities: &[Option<Compared>]) -> Option<f64> {
        let each: Vec<f64> = quantities.iter().flatten().map(|of| of.improvement_percent.value).collect();
        (!each.is_empty()).then(|| each.iter().sum::<f64>() / each.len() as f64)
    }
}

/// Whether a state that does not change predicts each quantity better over a window, or at its end.
#[must_use]
pub fn no_model_in(of: &OpenLoop) -> [bool; 4] {
    let is_worse = |of: Compared| of.is_worse_than_unchanged() || of.ends_worse_than_unchanged();
    of.quantities().map(|compared| compared.is_some_and(is_worse))
}

impl From<&HoldoutFit> for Predicted {
    fn from(shown: &HoldoutFit) -> Self {
        Self { open_loop: shown.open_loop.clone(), improvement_percent: shown.improvement_percent }
    }
}

/// Names of the quantities of [`OpenLoop::quantities`] in their order.
pub const QUANTITIES: [(&str, &str); 4] =
    [("position", "m"), ("velocity", "m/s"), ("attitude", "rad"), ("body rate", "rad/s")];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::holdout::AtEnd;

    /// Errors of a state that does not change, of the rigid body alone and of the better model.
    fn compared(unchanged: f64, before: f64, after: f64) -> Option<Compared> {
        let interval = |value| Interval { value, range: None };
        Some(Compared {
            before: interval(before),
            after: interval(after),
            unchanged: Some(interval(unchanged)),
            floor: None,
            improvement_percent: interval(-900.0),
            at_end: None,
        })
    }

    fn window(window_s: f64, position_m: Option<Compared>, attitude_rad: Option<Compared>) -> OpenLoop {
        OpenLoop { window_s, windows: 10, position_m, velocity_m_s: None, attitude_rad, rates_rad_s: None }
    }

    #[test]
    fn the_work_of_effects_is_against_the_rigid_body_whatever_no_change_would_predict() {
        let of = |before, after| compared(0.1, before, after);
        let predicted = |position_m, velocity_m_s| Predicted {
            open_loop: vec![OpenLoop { velocity_m_s, ..window(0.5, position_m, None) }],
            improvement_percent: None,
        };
        // 50 % less and 25 % more
        let found = predicted(of(2.0, 1.0), of(4.0, 5.0)).work_of_effects().unwrap();
        assert!((found - 12.5).abs() < 1e-12, "{found}");
        assert_eq!(predicted(None, None).work_of_effects(), None);
        // how it moves is half as wrong, how it turns is three times as wrong
        let turned =
            Predicted { open_loop: vec![window(0.5, of(2.0, 1.0), of(1.0, 3.0))], improvement_percent: None };
        assert_eq!(turned.work_of_effects(), Some(-75.0));
        assert_eq!(turned.better_work_of_effects(), Some(50.0));
    }

    #[test]
    fn a_model_is_none_over_each_window_in_which_no_change_is_better() {
        let of = |unchanged, after| compared(unchanged, after, after);
        let open_loop = vec![
            window(0.1, of(1.0, 2.0), None),
            window(0.5, of(2.0, 1.0), of(2.0, 1.0)),
            window(1.0, of(2.0, 1.0), of(1.0, 2.0)),
        ];
        let predicted = Predicted { open_loop, improvement_percent: None };
        assert_eq!(predicted.no_model_of(), [("position", vec![0.1]), ("attitude", vec![1.0])]);
        // over two windows: the answer tells it
        assert!(predicted.worse_than_unchanged().is_empty() && predicted.is_no_model());
        let alone = |window_s| Predicted {
            open_loop: vec![window(window_s, of(1.0, 2.0), None)],
            improvement_percent: None,
        };
        assert!(alone(0.5).is_no_model() && !alone(0.1).is_no_model() && !alone(1.0).is_no_model());
    }

    #[test]
    fn a_model_whose_errors_end_larger_than_those_of_no_change_is_none() {
        let ends = |unchanged, after| {
            let at_end = Some(AtEnd { unchanged, before: after, after });
            compared(2.0, 1.0, 1.0).map(|of| Compared { at_end, ..of })
        };
        let open_loop = vec![window(0.5, ends(2.0, 1.9), None), window(1.0, None, ends(0.4, 0.9))];
        let predicted = Predicted { open_loop, improvement_percent: None };
        assert_eq!(predicted.no_model_of(), [("attitude", vec![1.0])]);
    }
}
