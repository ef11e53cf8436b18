//! Jumps of the estimator: the offsets by which it jumped last, which it repeats from then on.

/// What one kind of message has said.
#[derive(Debug, Clone, Copy)]
struct Reported {
    message: u8,
    offsets_m: [f64; 2],
    /// other offsets, until the next message repeats them, and when they came: a single message may be damaged
    doubted: Option<([f64; 2], f64)>,
}

/// The jumps so far.
#[derive(Debug, Default)]
pub(super) struct Jumps(Vec<Reported>);

impl Jumps {
    /// The clock began anew.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Takes the offsets that a message says; when the estimator jumped, s, once a second message agrees. The first word is of
    /// before the log began.
    pub(super) fn take(&mut self, message: u8, offsets_m: [f64; 2], time_s: f64) -> Option<f64> {
        let Some(said) = self.0.iter_mut().find(|said| said.message == message) else {
            self.0.push(Reported { message, offsets_m, doubted: None });
            return None;
        };
        if said.offsets_m == offsets_m {
            said.doubted = None;
            return None;
        }
        match said.doubted {
            Some((doubted_m, since_s)) if doubted_m == offsets_m => {
                *said = Reported { offsets_m, doubted: None, ..*said };
                Some(since_s)
            }
            _ => {
                said.doubted = Some((offsets_m, time_s));
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Jumps;

    #[test]
    fn a_jump_is_repeated_and_damage_is_not() {
        let mut jumps = Jumps::default();
        let mut take = |north_m: f64, time_s: f64| jumps.take(7, [north_m, 0.0], time_s);
        assert_eq!([take(1.0, 0.0), take(1.0, 0.1), take(9e9, 0.2), take(1.0, 0.3)], [None; 4]);
        // when it came first, told once
        assert_eq!([take(2.0, 0.4), take(2.0, 0.5), take(2.0, 0.6)], [None, Some(0.4), None]);
        // two in a row that are damaged agree in nothing
        assert_eq!([take(5.0, 0.7), take(6.0, 0.8), take(2.0, 0.9)], [None; 3]);
    }
}
