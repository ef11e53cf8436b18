//! What flights would have shown, in words.

use crate::diagnose::signatures::{ALL, signature_of};
use crate::diagnose::wording::Words;
use crate::diagnose::{DetectionLimit, called, limit};
use crate::report::number::{significant, spoken};
use crate::text::list;
use crate::vehicle::AXIS_NAMES;

/// Largest number of effects that the answer lists as visible.
const TOLD: usize = 3;

/// The effects that are told first if nothing is missing, each with the smallest size that would have been named. Where some of an
/// effect's axes would not have shown its usual size, those are told that would.
pub(super) fn would_show(limits: &[DetectionLimit]) -> Vec<String> {
    ranked(|words| words.told_if_absent).iter().filter_map(|id| shown(limits, id)).take(TOLD).collect()
}

fn shown(limits: &[DetectionLimit], id: &str) -> Option<String> {
    let all: Vec<&DetectionLimit> = limits.iter().filter(|limit| limit.id == id).collect();
    let is_shown = |of: &&DetectionLimit| of.is_possible() && of.usual.is_none_or(|usual| of.limit < usual);
    let shown: Vec<&DetectionLimit> = all.iter().copied().filter(is_shown).collect();
    let words = limit(largest(&shown)?);
    let axes: Vec<String> = shown.iter().filter_map(|of| axis(of.parameter)).map(str::to_owned).collect();
    let is_whole = shown.len() == all.len() || axes.is_empty();
    Some(if is_whole { words } else { format!("{words} along body {}", list(&axes)) })
}

/// The effects that are expected of every vehicle in motion, and of which no parameter would have been seen at its usual size.
pub(super) fn unseen_of_usual_size(limits: &[DetectionLimit]) -> Vec<String> {
    let is_unseen = |id: &&str| {
        let of = limits.iter().filter(|limit| limit.id == *id);
        let mut sized = of.filter_map(|limit| Some((limit.limit, limit.usual?))).peekable();
        sized.peek().is_some() && sized.all(|(limit, usual)| limit > usual)
    };
    let expected = ranked(|words| words.expected_in_motion);
    expected.into_iter().filter(is_unseen).map(|id| called(id).to_owned()).collect()
}

/// Identifier of each effect that would have been named, and its smallest size in words.
pub(super) fn named_from(limits: &[DetectionLimit]) -> Vec<(&'static str, String)> {
    let possible: Vec<&DetectionLimit> = limits.iter().filter(|limit| limit.is_possible()).collect();
    possible
        .chunk_by(|one, next| one.id == next.id && one.unit == next.unit)
        .filter_map(|of| Some((of.first()?.id, from(of)?)))
        .collect()
}

/// The smallest size, of one unit: in the words of the effect if it has such, otherwise along each axis.
fn from(of: &[&DetectionLimit]) -> Option<String> {
    let first = of.first()?;
    if signature_of(first.id).is_some_and(|signature| signature.words.limit.is_some()) {
        return Some(limit(largest(of)?));
    }
    let size = |limit: &&DetectionLimit| significant(limit.limit, 2);
    let each: Vec<String> = match of {
        [one] => vec![size(one)],
        all => all
            .iter()
            .map(|one| format!("{} {}", axis(one.parameter).unwrap_or(one.parameter), size(one)))
            .collect(),
    };
    Some(format!("{} {}", each.join(", "), spoken(first.unit)).trim_end().to_owned())
}

/// What would not have been shown even at the greatest size that is searched; `None` where there is no such effect.
pub(super) fn not_possible(limits: &[DetectionLimit]) -> Option<String> {
    let unseen: Vec<&DetectionLimit> = limits.iter().filter(|limit| !limit.is_possible()).collect();
    let one = |of: &[&DetectionLimit]| {
        let id = of.first()?.id;
        let axes: Vec<String> = of.iter().filter_map(|of| axis(of.parameter)).map(str::to_owned).collect();
        let is_whole = limits.iter().filter(|limit| limit.id == id).count() == of.len() || axes.is_empty();
        let along = if is_whole { String::new() } else { format!(" along body {}", list(&axes)) };
        Some(format!("{}{along}", called(id)))
    };
    let each: Vec<String> = unseen.chunk_by(|one, next| one.id == next.id).filter_map(one).collect();
    (!each.is_empty()).then(|| format!("of no possible size: {}", each.join(", ")))
}

fn largest<'a>(of: &[&'a DetectionLimit]) -> Option<&'a DetectionLimit> {
    of.iter().copied().max_by(|a, b| a.limit.total_cmp(&b.limit))
}

/// The body axis of a parameter: x of `dx`.
fn axis(parameter: &'static str) -> Option<&'static str> {
    let letter = parameter.get(parameter.len().checked_sub(1)?..)?;
    (parameter.len() <= 2 && AXIS_NAMES.contains(&letter)).then_some(letter)
}

/// Identifiers of the effects that have such a rank, in its order.
fn ranked(rank: fn(&Words) -> Option<usize>) -> Vec<&'static str> {
    let mut all: Vec<(usize, &str)> =
        ALL.iter().filter_map(|signature| Some((rank(&signature.words)?, signature.id()))).collect();
    all.sort_unstable();
    all.into_iter().map(|(_, id)| id).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(
        (id, parameter): (&'static str, &'static str),
        size: f64,
        usual: Option<f64>,
        unit: &'static str,
    ) -> DetectionLimit {
        DetectionLimit { id, parameter, limit: size, certain: size, usual, most: 8.0, unit }
    }

    fn drag(x: f64, y: f64, z: f64) -> Vec<DetectionLimit> {
        let one = |parameter, size| of(("linear_drag", parameter), size, Some(0.3), "N/(m/s)");
        vec![one("dx", x), one("dy", y), one("dz", z)]
    }

    #[test]
    fn an_effect_is_unseen_where_no_axis_would_have_shown_its_usual_size() {
        let along_two = drag(0.054, 0.06, 0.4);
        assert!(unseen_of_usual_size(&along_two).is_empty());
        assert_eq!(would_show(&along_two), ["drag of 0.060 N per m/s along body x and y"]);
        let along_none = drag(0.31, 0.35, 0.4);
        assert_eq!(unseen_of_usual_size(&along_none), ["drag"]);
        assert!(would_show(&along_none).is_empty());
        assert_eq!(would_show(&drag(0.1, 0.1, 0.2)), ["drag of 0.20 N per m/s"]);
        assert!(unseen_of_usual_size(&[]).is_empty());
    }

    #[test]
    fn the_smallest_sizes_are_said_as_in_the_sentence() {
        let rotor = of(("weak_rotor", "factor"), 0.0028, None, "-");
        let load = of(("slung_load", "mass"), 0.04, None, "kg");
        let ground = of(("ground_effect", "rho"), 3.0, Some(4.0), "-");
        let limits = [drag(0.054, 0.06, 0.4), vec![rotor, load, ground]].concat();
        let expected = [
            ("linear_drag", "x 0.054, y 0.060, z 0.40 N per m/s"),
            ("weak_rotor", "a rotor 0.28 % weak"),
            ("slung_load", "0.040 kg"),
            ("ground_effect", "ground effect 3.0 times that of Cheeseman and Bennett"),
        ];
        assert_eq!(named_from(&limits), expected.map(|(id, words)| (id, words.to_owned())));
        assert_eq!(not_possible(&limits), None);
    }

    #[test]
    fn what_no_size_would_have_shown_is_called_by_its_name() {
        let sag = of(("battery_sag", "exponent"), 9.0, None, "-");
        let limits = [drag(0.1, 0.1, 9.0), vec![sag]].concat();
        assert_eq!(
            not_possible(&limits).as_deref(),
            Some("of no possible size: drag along body z, battery sag")
        );
    }
}
