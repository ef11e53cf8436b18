//! Whether the balance of a vehicle moved between two groups of flights, and what accounts for it.

use super::explanation::{
    Account, Explanation, What, along, explanations, factor, lean, other_rotor_and_load,
};
use super::groups::{Groups, Moved};
use crate::trim::{AXES, Balance};
use crate::vehicle::Vehicle;
use nalgebra::{DVector, Vector3};

/// Sum of squares that an explanation must account for, in standard deviations: 4.5 of them. One of 147 000 comparisons of one
/// component exceeds it by chance where the errors are right: errors that are too small, and heavier tails, are allowed for.
pub const NAMED: f64 = NAMED_SIGMAS * NAMED_SIGMAS;
/// Its root: standard deviations that a change needs.
pub const NAMED_SIGMAS: f64 = 4.5;
/// Sum of squares that the best explanation may leave. Set by judgement: two components exceed it in one of 500.
const FITS: f64 = 12.0;
/// Cost of each amount of an explanation, sum of squares. A smaller one would name a centre of mass, which has two
/// amounts, where a rotor accounts as well; false names are measured by `cargo bench --bench blind -- --vehicles
/// --compared 40 --seed 9101`.
const PRICE: f64 = 5.0;
/// Amounts of a rotor and a load that sits elsewhere together.
const OF_BOTH: f64 = 3.0;
/// An explanation that costs so much more than the best is told apart: one of twenty odds, twice the logarithm.
const APART: f64 = 6.0;
/// Standard deviation of the centre of mass from flight to flight by where battery and load sit, arms, a direction:
/// the flight's own. With less a battery that was put back elsewhere would be a change; `cargo bench --bench blind --
/// --vehicles --compared 40 --seed 9101` measures false ones.
pub const LOADED: f64 = 0.01;
/// Flights that the stated scatter counts as. With fewer one odd flight decides the scatter, with more the flights
/// cannot contradict it.
const PRIOR: f64 = 6.0;
/// Standard errors from which on a flight shows a change alone. Only the list of flights depends on it.
const SHOWN_ALONE: f64 = 2.0;

/// What the balance says of a change.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceChange {
    /// the balance, shares: see [`crate::trim::Leg::lean`]
    pub moved: [Moved; AXES],
    /// sum of squares of the move in standard deviations
    pub strength: f64,
    /// the same where a load or a battery may sit elsewhere
    pub beyond_load: f64,
    /// standard deviations of the groups' scatter over the one that is expected beforehand
    pub scatter: f64,
    /// what accounts for it; `None`: nothing that these flights could show
    pub found: Option<BalanceFound>,
    /// it moved for certain, and by no more than a load or a battery that sits elsewhere moves it
    pub by_a_load: bool,
    /// what would have been shown
    pub least: Least,
}

/// A change of the balance and its cause.
#[derive(Debug, Clone, PartialEq)]
pub struct BalanceFound {
    /// the most likely; `None`: nothing known accounts for it alone, or another rotor and a load together do nearly as well
    pub what: Option<What>,
    /// of a rotor: thrust for the same command over that before, which is 1 without an error
    pub factor: Option<Moved>,
    /// of the centre of mass: how far it moved along body x and y, arms, with standard errors
    pub offset: Option<[(f64, f64); 2]>,
    /// what accounts for it nearly as well; where [`Self::what`] is `None`, what accounts for it alone
    pub rivals: Vec<What>,
    /// sum of squares that it accounts for, in standard deviations: of a rotor the square of its change in standard errors, which are
    /// larger by the spread of its torque
    pub strength: f64,
    /// later flights that each show it alone
    pub carried_by: Vec<usize>,
}

/// The smallest changes that would have been named.
#[derive(Debug, Clone, PartialEq)]
pub struct Least {
    /// of each rotor, share of its thrust
    pub rotors: Vec<f64>,
    /// of the centre of mass, arms
    pub centre: f64,
}

impl BalanceChange {
    /// It moved for certain, and nothing has a name: a load or a battery may do the same, or nothing known alone.
    #[must_use]
    pub fn moved_without_name(&self) -> bool {
        self.strength >= NAMED && self.found.as_ref().is_none_or(|found| found.what.is_none())
    }

    /// A component of [`Self::moved`], along x and y with the error that a load or a battery which sits elsewhere adds.
    #[must_use]
    pub fn beside_a_load(&self, axis: usize) -> Moved {
        beside_a_load(axis, &self.moved[axis])
    }

    /// What is left of this move in a later one, as a share of it, with its standard error: that of the later one where a load or a battery
    /// may sit elsewhere on each side, as it may where a move is judged.
    #[must_use]
    pub fn left_in(&self, later: &Self) -> (f64, f64) {
        let loaded: [Moved; AXES] = std::array::from_fn(|axis| later.beside_a_load(axis));
        along(&difference(&self.moved), &difference(&loaded), &variances_of(&loaded))
    }
}

/// Share of a move that the flights next to it show at least, unless their errors allow all of it. Set by judgement.
const HALF: f64 = 0.5;
/// Standard errors by which a flight lacks a move. The usual three.
const CERTAIN: f64 = 3.0;

/// The comparison of two groups.
struct Pair<'a> {
    balance: &'a Balance,
    groups: &'a Groups,
    scale: f64,
}

/// Judges whether the balance moved between two groups of flights. Neither group is empty.
#[must_use]
pub fn judge_balance(balance: &Balance, groups: &Groups, vehicle: &Vehicle) -> BalanceChange {
    let scale = scatter(balance, groups);
    let pair = Pair { balance, groups, scale };
    let moved: [Moved; AXES] = std::array::from_fn(|axis| pair.moved(axis));
    let (by, variances) = (difference(&moved), variances_of(&moved));
    let known = explanations(vehicle, &middle(&moved));
    let strength = by.component_mul(&by).component_div(&variances).sum();
    let loaded: [Moved; AXES] = std::array::from_fn(|axis| beside_a_load(axis, &moved[axis]));
    let beyond_load = by.component_mul(&by).component_div(&variances_of(&loaded)).sum();
    let shares: Vec<f64> = (0..vehicle.rotors.len()).map(|rotor| pair.share(rotor)).collect();
    let mut found = found(&known, &moved, &shares, (strength, beyond_load));
    // a move that happened elsewhere has no name here
    found.take_if(|_| pair.is_elsewhere(&by));
    if let Some(found) = &mut found {
        found.carried_by = carriers(&pair, found, &known);
    }
    let least = |explanation: &Explanation| match explanation.what {
        What::Rotor(rotor) => {
            Some(1.0 - factor((explanation.least(&variances, NAMED), 0.0), shares[rotor]).0)
        }
        _ => None,
    };
    let worst = variances.x.max(variances.y) + 2.0 * LOADED * LOADED;
    let least = Least { rotors: known.iter().filter_map(least).collect(), centre: (NAMED * worst).sqrt() };
    let by_a_load =
        found.is_none() && strength >= NAMED && beyond_load - turned_by_a_load(&by, &variances) < NAMED;
    BalanceChange { moved, strength, beyond_load, scatter: scale, found, by_a_load, least }
}

/// Sum of squares about the vertical that counts as a load's: it does not turn the vehicle, and what certainly turns is no load alone.
fn turned_by_a_load(by: &Vector3<f64>, variances: &Vector3<f64>) -> f64 {
    let turned = by.z.powi(2) / variances.z;
    if turned < NAMED { turned } else { 0.0 }
}

/// A component of a move where a battery or a load may sit elsewhere on each side: it does not turn the vehicle about the vertical.
fn beside_a_load(axis: usize, moved: &Moved) -> Moved {
    let load = if axis < 2 { LOADED } else { 0.0 };
    let with = |(value, std): (f64, f64), sides: f64| (value, std.hypot(sides.sqrt() * load));
    Moved { before: with(moved.before, 1.0), after: with(moved.after, 1.0), by: with(moved.by, 2.0) }
}

/// The balance in the middle between before and after: the same whichever of the two groups is the earlier one.
pub(super) fn middle(moved: &[Moved; AXES]) -> Vector3<f64> {
    Vector3::from(moved.map(|moved| f64::midpoint(moved.before.0, moved.after.0)))
}

fn difference(moved: &[Moved; AXES]) -> Vector3<f64> {
    Vector3::from(moved.map(|moved| moved.by.0))
}

fn variances_of(moved: &[Moved; AXES]) -> Vector3<f64> {
    Vector3::from(moved.map(|moved| moved.by.1.powi(2)))
}

/// What accounts for a move, if anything has to.
fn found(
    known: &[Explanation],
    moved: &[Moved; AXES],
    shares: &[f64],
    (strength, beyond_load): (f64, f64),
) -> Option<BalanceFound> {
    let (by, variances) = (&difference(moved), &variances_of(moved));
    let mut accounts: Vec<(Account, f64)> = known
        .iter()
        .map(|explanation| {
            let account = explanation.accounts(by, variances);
            let cost = account.cost + PRICE * account.amounts.len() as f64;
            (account, cost)
        })
        .collect();
    accounts.sort_by(|a, b| a.1.total_cmp(&b.1));
    let (best, cost) = accounts.first()?;
    if strength - best.left < NAMED {
        return None;
    }
    let is_near = |(account, other): &&(Account, f64)| *other < cost + APART && account.left <= FITS;
    let mut near: Vec<What> = accounts.iter().filter(is_near).map(|(account, _)| account.what).collect();
    // a rotor and a load have two amounts more than a rotor
    let load = 2.0 * LOADED * LOADED * NAMED;
    let of_both = other_rotor_and_load(known, best.what, (by, variances), load);
    let is_either = matches!(best.what, What::Rotor(_))
        && of_both.is_some_and(|other| other + OF_BOTH * PRICE < cost + APART);
    let fits = best.left <= FITS && !is_either;
    // the size of a rotor's change has to be as certain as that there is one: its torque may fall by more or less than its thrust
    let of_name = if matches!(best.what, What::Rotor(_)) { best.certainty() } else { f64::INFINITY };
    let of_name = of_name.min(strength - best.left);
    if fits && of_name < NAMED {
        return None;
    }
    // where a battery or a load sits is the flight's own
    let about_z = if best.what == What::CentreOfMass { turned_by_a_load(by, variances) } else { 0.0 };
    if (best.what == What::CentreOfMass || !fits) && beyond_load - about_z < NAMED {
        return None;
    }
    if fits {
        near.remove(0);
    }
    let amounts = &best.amounts;
    Some(BalanceFound {
        what: fits.then_some(best.what),
        factor: match best.what {
            What::Rotor(rotor) if fits => {
                let (after, std) = factor(amounts[0], shares[rotor]);
                Some(Moved { before: (1.0, 0.0), after: (after, std), by: (after - 1.0, std) })
            }
            _ => None,
        },
        // the thrust has to act where the centre of mass went
        offset: (fits && best.what == What::CentreOfMass).then(|| [amounts[0], amounts[1]]),
        rivals: near,
        // of what has no name a load may make a part
        strength: if fits { of_name } else { (strength - best.left).min(beyond_load) },
        carried_by: Vec::new(),
    })
}

/// Later flights that each show what was found.
fn carriers(pair: &Pair, found: &BalanceFound, known: &[Explanation]) -> Vec<usize> {
    let alone = |flight: &&usize| {
        let groups = Groups { before: pair.groups.before.clone(), after: vec![**flight] };
        let one = Pair { groups: &groups, ..*pair };
        let moved: [Moved; AXES] = std::array::from_fn(|axis| one.moved(axis));
        let (by, variances) = (difference(&moved), variances_of(&moved));
        let Some(explanation) = known.iter().find(|known| Some(known.what) == found.what) else {
            return by.component_mul(&by).component_div(&variances).sum() >= NAMED;
        };
        let account = explanation.accounts(&by, &variances);
        let is_same_way = match found.factor {
            Some(factor) => (factor.by.0 < 0.0) == (account.amounts[0].0 > 0.0),
            None => true,
        };
        is_same_way && account.amounts.iter().any(|(amount, std)| amount.abs() > SHOWN_ALONE * std)
    };
    pair.groups.after.iter().filter(alone).copied().collect()
}

impl Pair<'_> {
    /// A component in both groups.
    fn moved(&self, axis: usize) -> Moved {
        let covariance = self.balance.covariance_of(axis, self.scale);
        let count = covariance.nrows();
        let weights = |group: &[usize]| {
            let mut weights = DVector::<f64>::zeros(count);
            for &flight in group {
                weights[flight] = covariance[(flight, flight)].recip();
            }
            let sum = weights.sum();
            weights / sum
        };
        let [before, after] = self.groups.both().map(weights);
        let value = |weights: &DVector<f64>| -> f64 {
            self.balance.flights.iter().zip(weights.iter()).map(|(of, weight)| weight * of.lean[axis]).sum()
        };
        let std =
            |weights: &DVector<f64>| (weights.transpose() * &covariance * weights)[(0, 0)].max(0.0).sqrt();
        Moved {
            before: (value(&before), std(&before)),
            after: (value(&after), std(&after)),
            by: (value(&after) - value(&before), std(&(after - before))),
        }
    }

    /// Whether the last flight before a move or the first one after it certainly shows less than half of it: then it happened between other
    /// flights. The error of this flight contains a battery that sits elsewhere.
    fn is_elsewhere(&self, by: &Vector3<f64>) -> bool {
        let lacks_it = |groups: &Groups| {
            let one = Pair { groups, scale: 1.0, ..*self };
            let moved: [Moved; AXES] = std::array::from_fn(|axis| beside_a_load(axis, &one.moved(axis)));
            let (share, std) = along(by, &difference(&moved), &variances_of(&moved));
            share < HALF && 1.0 - share > CERTAIN * std
        };
        let Groups { before, after } = self.groups;
        // later flights may have lost it again
        let of_before = before.last().map(|&last| Groups { before: vec![last], after: after.clone() });
        let of_after = after.first().map(|&first| Groups { before: before.clone(), after: vec![first] });
        of_before.iter().chain(&of_after).any(lacks_it)
    }

    fn share(&self, rotor: usize) -> f64 {
        mean_share(self.balance, self.groups, rotor)
    }
}

/// Share of a rotor in the commanded thrust, mean of the earlier flights' and the later flights' means.
pub(super) fn mean_share(balance: &Balance, groups: &Groups, rotor: usize) -> f64 {
    let mean = |group: &[usize]| {
        let each = group.iter().map(|&flight| balance.flights[flight].shares[rotor]);
        each.sum::<f64>() / group.len() as f64
    };
    let [before, after] = groups.both().map(mean);
    f64::midpoint(before, after)
}

/// Scatter of the flights of each group over what is expected beforehand, learned as far as there are flights to learn it from.
fn scatter(balance: &Balance, groups: &Groups) -> f64 {
    let mut squares = 0.0;
    for axis in 0..AXES {
        let covariance = balance.covariance_of(axis, 1.0);
        for group in groups.both() {
            let weight = |flight: usize| covariance[(flight, flight)].recip();
            let sum: f64 = group.iter().map(|&flight| weight(flight)).sum();
            let mean = group
                .iter()
                .map(|&flight| weight(flight) * lean(&balance.flights[flight])[axis])
                .sum::<f64>()
                / sum;
            for &flight in group {
                squares += weight(flight) * (lean(&balance.flights[flight])[axis] - mean).powi(2);
            }
        }
    }
    let free = (AXES * groups.beside_one()) as f64;
    ((PRIOR + squares) / (PRIOR + free)).sqrt().max(0.8)
}
