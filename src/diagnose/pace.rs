//! How far a search is, for whoever waits. How many rounds it takes is not known beforehand: the flights decide it.

/// Parts of a search by the time that they usually take, in rounds of testing all candidates: a reconstruction of the flights ...
const RECONSTRUCTION: u64 = 3;
/// ... and the localisation and the verdict.
const VERDICT: u64 = 1;
/// A search without a finding tests this often, at least one more is to come while it finds something.
const LEAST_ROUNDS: u64 = 3;

/// Is told rounds that are done, and how many there may be.
pub struct Pace<'a> {
    tell: &'a dyn Fn(u64, u64),
    done: u64,
    may_be: u64,
}

impl<'a> Pace<'a> {
    /// At the begin of a search.
    pub fn new(tell: &'a dyn Fn(u64, u64)) -> Self {
        let mut pace = Self { tell, done: 0, may_be: LEAST_ROUNDS + RECONSTRUCTION + VERDICT };
        pace.tells(0, 0);
        pace
    }

    fn tells(&mut self, done: u64, ahead: u64) {
        self.done += done;
        self.may_be = self.may_be.max(self.done + ahead);
        (self.tell)(self.done, self.may_be);
    }

    /// All candidates were tested, and will be once more.
    pub(super) fn tested(&mut self) {
        self.tells(1, 1 + RECONSTRUCTION + VERDICT);
    }

    /// The flights were reconstructed.
    pub(super) fn reconstructed(&mut self) {
        self.tells(RECONSTRUCTION, VERDICT);
    }

    /// Something left the model: they are reconstructed again.
    pub(super) fn again(&mut self) {
        self.tells(0, RECONSTRUCTION + VERDICT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::cell::RefCell;

    #[test]
    fn a_longer_search_moves_its_end_and_never_passes_it() {
        let told = RefCell::new(Vec::new());
        let tell = |done, may_be| told.borrow_mut().push((done, may_be));
        let mut pace = Pace::new(&tell);
        (0..4).for_each(|_| pace.tested());
        pace.reconstructed();
        pace.again();
        pace.reconstructed();
        let told = told.into_inner();
        assert_eq!(told, [(0, 7), (1, 7), (2, 7), (3, 8), (4, 9), (7, 9), (7, 11), (10, 11)]);
    }
}
