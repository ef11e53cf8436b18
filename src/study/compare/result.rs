//! The result of comparing: every flight, what changed, and what could not have been seen.

use super::by_motion::WeakAlone;
use super::scale::ScaleMoved;
use crate::change::{BalanceChange, Groups, Moved, NAMED, Step, Undecided, What};
use crate::note::{About, Note};
use crate::study::{InputFile, StudyError, Track, lost};
use crate::trim::{Balance, RotorTrack, mean_arm_m};
use crate::vehicle::Vehicle;

/// The whole answer.
#[derive(Debug)]
pub struct CompareStudy {
    /// as given or drafted
    pub vehicle: Vehicle,
    /// the file that it was read from; `None`: it was drafted
    pub vehicle_file: Option<InputFile>,
    /// lengths and mass of it are known; otherwise results are shares
    pub is_known: bool,
    /// in the order in which they were given
    pub flights: Vec<ComparedFlight>,
    /// their balance
    pub balance: Balance,
    /// thrust for a command of each rotor along the flights, by that balance
    pub rotors: Vec<RotorTrack>,
    /// each parameter along the flights
    pub tracks: Vec<Track>,
    /// what each flight names alone of its rotors; empty where the motion is not compared
    pub alone: Vec<Option<WeakAlone>>,
    /// flights before and after, where two groups were given
    pub groups: Option<Groups>,
    /// what changed between these groups
    pub compared: Option<Compared>,
    /// where along all flights something changed
    pub history: Vec<Step<Compared>>,
    /// the smallest changes that a border in the middle of all flights would have shown, where there are no groups and nothing changed
    pub least_in_the_middle: Option<Vec<LeastChange>>,
    /// what moved along all flights by more than chance and less than is certain, where there are no groups and nothing changed
    pub undecided_along: Option<UndecidedAlong>,
    /// full thrust over weight that says that this may be two vehicles, where no parameter is compared
    pub lifts_apart: Option<LiftsApart>,
    /// serial numbers of different sensors that say the same
    pub serials_apart: Option<Note>,
    /// full thrust over weight that moved, where parameters that go with it are compared; each flight's own, and no change
    pub scale: Option<ScaleMoved>,
    /// the balance moved without a name: a rotor that lost as much as the smallest change would be seen, and not named
    pub balance_unnamed: bool,
    /// flights that were given and are not compared
    pub left_out: Vec<LeftOut>,
    /// what the user should know
    pub notes: Vec<Note>,
}

/// What moved at a place of a row of flights by more than chance and less than is certain.
#[derive(Debug, Clone, PartialEq)]
pub struct UndecidedAlong {
    /// the first flight of the later ones
    pub from: usize,
    /// the strongest first
    pub moved: Vec<Change>,
    /// standard deviations that make a change at a place of so many flights
    pub least_sigmas: f64,
}

/// Full thrust over weight that differs by more than that of one vehicle does.
#[derive(Debug, Clone, PartialEq)]
pub struct LiftsApart {
    /// of the flights before, mean, `-`
    pub before: f64,
    /// of those after, mean, `-`
    pub after: f64,
    /// which flights these are
    pub of: LiftsOf,
    /// a parameter moved by more than chance as well
    pub moved: bool,
}

/// The flights on both sides of a full thrust over weight that differs.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LiftsOf {
    /// those before and those after, as they were given
    Groups,
    /// those of a row before this place, and those from it on
    From(usize),
    /// those of a row at these places, which are after, and all others, which are before: each of these differs from most others
    Odd(Vec<usize>),
}

impl LiftsApart {
    /// The larger one over the other.
    pub(super) fn ratio(&self) -> f64 {
        self.before.max(self.after) / self.before.min(self.after)
    }
}

/// A flight that cannot be used, where enough others remain.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LeftOut {
    /// its log
    pub path: String,
    /// what was expected and what came
    pub why: String,
}

impl LeftOut {
    pub(super) fn of(error: &StudyError) -> Self {
        let (path, why) = error.of_log();
        Self { path, why }
    }

    pub(super) fn note(&self) -> Note {
        Note::warning(About::File(self.path.clone()), format!("left out: {}", self.why))
    }
}

/// One flight.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparedFlight {
    /// its file
    pub input: InputFile,
    /// electrical power in flight, W, mean; the flight's own
    pub power_w: Option<f64>,
    /// why its motion was not compared; `None`: it was
    pub balance_only: Option<String>,
}

/// What was compared between two groups, and what came out.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// the balance
    pub balance: BalanceChange,
    /// the strongest first; empty: nothing that these flights could show
    pub changes: Vec<Change>,
    /// parameters that moved by more than chance and less than is certain: no changes
    pub undecided: Vec<(Change, Undecided)>,
    /// the smallest changes that would have been named
    pub least: Vec<LeastChange>,
    /// full thrust over weight before and after, where it and several parameters say that this is hardly one vehicle
    pub other_vehicle: Option<(f64, f64)>,
}

/// One change.
#[derive(Debug, Clone, PartialEq)]
pub struct Change {
    /// of what
    pub what: Changed,
    /// before and after, in its unit; `None` where nothing known accounts for it
    pub moved: Option<Moved>,
    /// of [`Self::moved`]
    pub unit: &'static str,
    /// size of the difference in its standard errors; of the whole balance standard deviations of what unchanged flights would show
    pub sigmas: f64,
    /// later flights that each show it alone
    pub carried_by: Vec<usize>,
    /// what else it may be
    pub rivals: Vec<What>,
}

/// What changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Changed {
    /// a rotor's thrust for a command over that before, by its place in the vehicle's file
    Rotor(usize),
    /// the centre of mass along body x (0) or y (1), m, or arms where lengths are not known
    CentreOfMass(usize),
    /// torque about the vertical, over that of all rotors turning one way
    YawTorque,
    /// the balance, by nothing known alone
    Balance,
    /// a parameter of [`CompareStudy::tracks`]
    Parameter(usize),
}

/// The smallest change that would have been named.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeastChange {
    /// of what
    pub what: Changed,
    /// in `unit`
    pub size: f64,
    /// SI
    pub unit: &'static str,
}

impl Changed {
    /// Whether a flight says anything of it: a parameter is not determined by every flight.
    pub(super) fn is_told_by(self, tracks: &[Track], flight: usize) -> bool {
        let Self::Parameter(place) = self else { return true };
        let value = tracks.get(place).and_then(|track| track.values.get(flight).copied().flatten());
        value.is_some()
    }

    /// The last of a row of flights before `from` that says something of it, and the first of those from there on; without one `None`, and
    /// `from` itself.
    fn dated(self, tracks: &[Track], from: usize, flights: usize) -> (Option<usize>, usize) {
        let tells = |flight: &usize| self.is_told_by(tracks, *flight);
        ((0..from).rev().find(tells), (from..flights).find(tells).unwrap_or(from))
    }
}

impl Compared {
    /// Whether what changed has a name.
    pub(super) fn has_name(&self) -> bool {
        !self.changes.iter().any(|change| change.what == Changed::Balance)
    }

    /// Standard deviations of the strongest change; 0: none.
    #[must_use]
    pub fn strongest(&self) -> f64 {
        self.changes.iter().map(|change| self.strength(change)).fold(0.0, f64::max)
    }

    /// Parameters of the motion that moved by so many standard deviations, with a name or not decided. Those that moved by less than
    /// [`UNDECIDED`](crate::change::UNDECIDED) are not known here.
    pub(super) fn moved_by_motion(&self, least_sigmas: f64) -> usize {
        let of_motion = |change: &&Change| matches!(change.what, Changed::Parameter(_));
        let moved = self.changes.iter().filter(of_motion).chain(self.undecided.iter().map(|(of, _)| of));
        moved.filter(|change| change.sigmas >= least_sigmas).count()
    }

    /// Standard deviations of a change from what unchanged flights show. Those that are told of a centre of mass allow for a load, by which it
    /// was judged along both axes together.
    fn strength(&self, change: &Change) -> f64 {
        match change.what {
            Changed::CentreOfMass(axis) => self.balance.moved[axis].sigmas().abs(),
            _ => change.sigmas,
        }
    }

    /// The same where a load or a battery that sits elsewhere is allowed for in what it may be.
    pub(super) fn beside_a_load(&self) -> f64 {
        let loaded = self.balance.beyond_load.sqrt();
        let of = |change: &Change| match change.what {
            Changed::Parameter(_) => change.sigmas,
            Changed::Rotor(_) if !change.rivals.contains(&What::CentreOfMass) => change.sigmas,
            _ => self.strength(change).min(loaded),
        };
        self.changes.iter().map(of).fold(0.0, f64::max)
    }

    /// The changes that are certain by themselves: a centre of mass moves along two axes, and may have moved along one only.
    pub(super) fn certain(&self) -> impl Iterator<Item = &Change> {
        let alone = move |change: &&Change| self.strength(change).powi(2) >= NAMED;
        let none = !self.changes.iter().any(|change| alone(&change));
        self.changes.iter().filter(move |change| none || alone(change))
    }
}

impl CompareStudy {
    /// Something changed: between the groups, or along the flights where there are none.
    #[must_use]
    pub fn has_changed(&self) -> bool {
        match &self.compared {
            Some(compared) => !compared.changes.is_empty() || compared.other_vehicle.is_some(),
            None => !self.history.is_empty(),
        }
    }

    /// The smallest changes that would have been named: between the groups, or in the middle of a history in which nothing changed.
    #[must_use]
    pub fn least(&self) -> Option<&[LeastChange]> {
        let between = self.compared.as_ref().map(|compared| compared.least.as_slice());
        between.or(self.least_in_the_middle.as_deref())
    }

    /// The same without what would be seen and not named.
    #[must_use]
    pub fn least_named(&self) -> Option<Vec<LeastChange>> {
        let is_named =
            |least: &&LeastChange| !(self.balance_unnamed && matches!(least.what, Changed::Rotor(_)));
        self.least().map(|all| all.iter().filter(is_named).copied().collect())
    }

    /// All flights that were given are compared, and nothing of their logs was lost.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.left_out.is_empty() && lost(self.flights.iter().map(|flight| &flight.input)).is_empty()
    }

    /// Nothing says that the flights are those of two vehicles, of which "nothing changed" would say nothing.
    #[must_use]
    pub fn is_of_one_vehicle(&self) -> bool {
        let other = self.compared.as_ref().is_some_and(|compared| compared.other_vehicle.is_some());
        self.lifts_apart.is_none() && self.serials_apart.is_none() && !other
    }

    /// Between which flights a change of a step lies: the last that shows what was before, and the first that shows what is since. Flights
    /// between these do not determine it. `None`: no flight before the step does.
    #[must_use]
    pub fn dated(&self, step: &Step<Compared>, what: Changed) -> (Option<usize>, usize) {
        what.dated(&self.tracks, step.from, self.flights.len())
    }

    /// The same wherever along the flights it changed.
    pub fn changed(&self, what: Changed) -> impl Iterator<Item = (Option<usize>, usize)> {
        let is_of =
            move |step: &&Step<Compared>| step.change.changes.iter().any(|change| change.what == what);
        self.history.iter().filter(is_of).map(move |step| self.dated(step, what))
    }

    /// Places of the flights that are the first to show something otherwise than before.
    pub fn changed_from(&self, what: Changed) -> impl Iterator<Item = usize> {
        self.changed(what).map(|(_, first)| first)
    }

    /// m of an arm; `None` where lengths are not known.
    #[must_use]
    pub fn arm_m(&self) -> Option<f64> {
        self.is_known.then(|| mean_arm_m(&self.vehicle))
    }

    /// Name of a rotor in the vehicle's file.
    #[must_use]
    pub fn rotor(&self, place: usize) -> &str {
        self.vehicle.rotors.get(place).map_or("?", |rotor| rotor.name.as_str())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::Owner;

    #[test]
    fn a_change_is_dated_by_flights_that_determine_it() {
        let value = Some((0.1, 0.01));
        let values = vec![value, value, None, value, None, value];
        let drag = ("quadratic_drag.cx", "N/(m/s)^2");
        let of = (Owner::Vehicle, Some("quadratic_drag"));
        let tracks = [Track::stored(drag, of, values, vec![0.0; 6]).unwrap()];
        let drag = Changed::Parameter(0);
        assert_eq!(drag.dated(&tracks, 2, 6), (Some(1), 3));
        assert_eq!(drag.dated(&tracks, 3, 6), (Some(1), 3));
        assert_eq!(drag.dated(&tracks, 1, 6), (Some(0), 1));
        // every flight has a balance
        assert_eq!(Changed::Rotor(0).dated(&tracks, 2, 6), (Some(1), 2));
        // no flight on a side
        assert_eq!((drag.dated(&tracks, 0, 6).0, drag.dated(&tracks, 6, 6).1), (None, 6));
    }
}
