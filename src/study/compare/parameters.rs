//! What the parameters of the motion did between two groups of flights.

use super::judge::{Judge, is_of_vehicle};
use super::result::{Change, Changed, LeastChange};
use super::scale::ScaleMoved;
use crate::change::{Groups, ParameterChange, Together, Undecided, judge_together};
use crate::diagnose::signatures::signature_of;
use crate::study::Track;

/// What the parameters did.
#[derive(Debug, Default)]
pub(super) struct OfParameters {
    /// those that changed
    pub(super) changes: Vec<Change>,
    /// those that moved by more than chance and less than is certain
    pub(super) undecided: Vec<(Change, Undecided)>,
    /// the smallest changes that would have been named
    pub(super) least: Vec<LeastChange>,
}

impl Judge<'_> {
    /// What each parameter of the vehicle did between two groups of flights, by itself or together with those along the other axes.
    pub(super) fn of_parameters(&self, groups: &Groups) -> OfParameters {
        let scale = ScaleMoved::between(self.balance, groups);
        let of_vehicle = self.tracks.iter().enumerate().filter(|(_, track)| is_of_vehicle(track));
        let judged =
            of_vehicle.filter_map(|(place, track)| Some((place, self.judged(track, groups, scale)?)));
        let judged: Vec<(usize, ParameterChange)> = judged.collect();
        let mut all = OfParameters::default();
        for (place, own) in &judged {
            let (what, unit) = (Changed::Parameter(*place), self.tracks[*place].unit);
            all.least.push(LeastChange { what, size: own.least, unit });
            let (together, axes) = self.together(*place, &judged);
            let change = Change {
                what,
                moved: Some(own.moved),
                unit,
                sigmas: together.map_or(own.moved.sigmas().abs(), |together| together.sigmas),
                axes,
                carried_by: own.carried_by.clone(),
                rivals: Vec::new(),
            };
            match together.map_or(own.undecided, |together| together.undecided) {
                Some(why) => all.undecided.push((change, why)),
                None if own.changed || together.is_some() => all.changes.push(change),
                None => {}
            }
        }
        all
    }

    /// What the parameters of a drag along all axes of the body, of which this is one, did together, and how many they are; 1: nothing.
    fn together(&self, place: usize, judged: &[(usize, ParameterChange)]) -> (Option<Together>, usize) {
        let own = &self.tracks[place];
        let is_of_air = own.effect.and_then(signature_of).is_some_and(|signature| signature.role.of_air);
        if !is_of_air {
            return (None, 1);
        }
        let is_beside = |track: &Track| track.effect == own.effect && track.unit == own.unit;
        let axes = judged.iter().filter(|(place, _)| is_beside(&self.tracks[*place])).map(|(_, axis)| axis);
        let axes: Vec<&ParameterChange> = axes.collect();
        // what one of them says for certain needs no others
        if axes.iter().any(|axis| axis.changed) {
            return (None, 1);
        }
        judge_together(&axes).map_or((None, 1), |together| (Some(together), axes.len()))
    }
}
