//! Columns that together are one quantity.

use std::collections::BTreeMap;

use super::words::{Kind, Part, Said, said};

/// Columns of one quantity, in the order of its values.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Group {
    pub kind: Kind,
    pub is_setpoint: bool,
    /// in the header, from 0
    pub columns: Vec<usize>,
    pub parts: Vec<Part>,
    /// as the names say it
    pub unit: Option<&'static str>,
}

/// The orders in which the parts of a vector may be named.
const VECTORS: &[[Part; 3]] = &[
    [Part::X, Part::Y, Part::Z],
    [Part::North, Part::East, Part::Down],
    [Part::East, Part::North, Part::Up],
    [Part::Roll, Part::Pitch, Part::Yaw],
    [Part::Number(0), Part::Number(1), Part::Number(2)],
    [Part::Number(1), Part::Number(2), Part::Number(3)],
];

/// The same of a quaternion, w first.
const QUATERNIONS: &[[Part; 4]] = &[
    [Part::W, Part::X, Part::Y, Part::Z],
    [Part::Number(0), Part::Number(1), Part::Number(2), Part::Number(3)],
    [Part::Number(1), Part::Number(2), Part::Number(3), Part::Number(4)],
];

/// What columns of one quantity have in common: kind, whether it is a setpoint, words.
type Key = (Kind, bool, String);
/// Columns of one quantity by their parts, with their places in the header.
type Family = BTreeMap<Part, (usize, Said)>;

/// All whole groups of a header in the order of their first columns, and the columns that are in none.
pub(super) fn groups(header: &[String]) -> (Vec<Group>, Vec<usize>) {
    let mut families: BTreeMap<Key, Family> = BTreeMap::new();
    for (index, name) in header.iter().enumerate() {
        if let Some(said) = said(name) {
            let family = families.entry((said.kind, said.is_setpoint, said.group.clone())).or_default();
            family.entry(said.part).or_insert((index, said));
        }
    }
    let mut groups: Vec<Group> =
        families.into_iter().filter_map(|(key, family)| group(key, &family)).collect();
    groups.sort_by_key(|group| group.columns.iter().min().copied());
    let is_used = |index: &usize| groups.iter().any(|group| group.columns.contains(index));
    let unused = (0..header.len()).filter(|index| !is_used(index)).collect();
    (groups, unused)
}

fn group((kind, is_setpoint, _): Key, family: &Family) -> Option<Group> {
    let has = |parts: &[Part]| parts.iter().all(|part| family.contains_key(part));
    let first_of = |orders: &[&[Part]]| orders.iter().find(|parts| has(parts)).map(|parts| parts.to_vec());
    let parts = match kind {
        Kind::Position | Kind::Velocity | Kind::Rate | Kind::Acceleration | Kind::WorldAcceleration => {
            first_of(&VECTORS.iter().map(<[Part; 3]>::as_slice).collect::<Vec<_>>())?
        }
        Kind::Attitude => first_of(&QUATERNIONS.iter().map(<[Part; 4]>::as_slice).collect::<Vec<_>>())?,
        Kind::Euler if is_setpoint => first_of(&[&[Part::Roll, Part::Pitch, Part::Yaw], &[Part::Yaw]])?,
        Kind::Euler => first_of(&[&[Part::Roll, Part::Pitch, Part::Yaw], &[Part::Roll, Part::Yaw]])?,
        Kind::Command | Kind::Demand | Kind::RotorSpeed => {
            let numbers: Vec<Part> =
                family.keys().copied().filter(|part| matches!(part, Part::Number(_))).collect();
            // one motor is no multirotor
            (numbers.len() >= 3).then_some(numbers)?
        }
        _ => vec![*family.keys().next()?],
    };
    let columns = parts.iter().filter_map(|part| Some(family.get(part)?.0)).collect();
    let unit = parts.iter().find_map(|part| family.get(part)?.1.unit);
    Some(Group { kind, is_setpoint, columns, parts, unit })
}
