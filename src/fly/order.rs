//! The order in which a vehicle's frames were sent, by their sequence numbers.

use std::time::Duration;

/// After a silence of this length (half a turn of the sequence numbers at a high rate), frames that arrive are not
/// older than earlier ones.
const SILENCE: Duration = Duration::from_millis(150);
/// Sequence numbers of one turn.
const TURN: i64 = 256;

/// Counts a sender's frames on from their sequence numbers, which turn over every 256 frames.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct SendingOrder {
    newest: Option<(u8, i64)>,
}

impl SendingOrder {
    /// The place of a frame among all that were sent, `silence` after the frame before it: greater means sent
    /// later. Right where the network holds frames back by less than half a turn.
    pub(super) fn place(&mut self, sequence: u8, silence: Duration) -> i64 {
        let place = match self.newest {
            None => 0,
            Some((_, newest)) if silence > SILENCE => newest + TURN,
            Some((number, newest)) => newest + i64::from(i8::from_ne_bytes([sequence.wrapping_sub(number)])),
        };
        if self.newest.is_none_or(|(_, newest)| place > newest) {
            self.newest = Some((sequence, place));
        }
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const CLOSE: Duration = Duration::from_millis(2);

    #[test]
    fn a_turn_and_a_silence_go_on() {
        let mut order = SendingOrder::default();
        let places: Vec<i64> =
            [250, 254, 251, 3, 255, 4].into_iter().map(|sequence| order.place(sequence, CLOSE)).collect();
        assert_eq!(places, [0, 4, 1, 9, 5, 10]);
        // 200 is as well 60 before 4
        assert!(order.place(200, Duration::from_secs(1)) > 10);
        assert_eq!(order.place(201, CLOSE) - order.place(200, CLOSE), 1);
    }

    proptest! {
        /// Frames held back by up to a hundred others are put back into the order of their sending.
        #[test]
        fn what_was_shuffled_is_sorted(held in proptest::collection::vec(0_usize..100, 1..600)) {
            let mut arrivals: Vec<(usize, usize)> = held.iter().enumerate().map(|(sent, held)| (sent + held, sent)).collect();
            arrivals.sort_unstable();
            let mut order = SendingOrder::default();
            let mut placed: Vec<(i64, usize)> = arrivals
                .iter()
                .map(|(_, sent)| (order.place(u8::try_from(sent % 256).unwrap(), CLOSE), *sent))
                .collect();
            placed.sort_unstable();
            prop_assert!(placed.windows(2).all(|pair| pair[0].1 < pair[1].1 && pair[0].0 < pair[1].0));
        }
    }
}
