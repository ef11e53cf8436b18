//! Batches of raw samples of an inertial sensor (ISBH, ISBD), for spectra.

use super::message::Message;
use crate::frames::body_from_frd;
use crate::recording::Quantity;

/// A batch's samples, in body FLU.
type Samples = [[f64; 3]; 32];

/// What the head of a batch says.
#[derive(Debug, Clone, Copy)]
struct Head {
    number: f64,
    quantity: Quantity,
    instance: u8,
    divisor: f64,
    start_s: f64,
    rate_hz: f64,
}

/// The batch that is being read.
#[derive(Debug, Default)]
pub(super) struct Batches {
    head: Option<Head>,
}

/// 32 samples in a row.
#[derive(Debug)]
pub(super) struct Piece {
    pub quantity: Quantity,
    pub instance: u8,
    /// stamp of the first, s
    pub start_s: f64,
    /// s between two
    pub step_s: f64,
    pub samples: Samples,
}

impl Batches {
    /// Takes a head.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a byte, or it saturates")]
    pub(super) fn head(&mut self, message: &Message<'_>, fields: &[usize]) {
        let value = |index: usize| fields.get(index).map_or(f64::NAN, |field| message.number(*field));
        let quantity = if value(1) == 0.0 { Quantity::SpecificForce } else { Quantity::AngularRate };
        let head = Head {
            number: value(0),
            quantity,
            instance: value(2) as u8,
            divisor: value(3),
            start_s: value(4) * 1e-6,
            rate_hz: value(5),
        };
        let is_whole = head.divisor > 0.0 && head.rate_hz > 0.0 && head.start_s.is_finite();
        self.head = is_whole.then_some(head);
    }

    /// The samples of a piece; `None` where its head was lost.
    pub(super) fn piece(&self, message: &Message<'_>, fields: &[usize]) -> Option<Piece> {
        let [number, place, x, y, z] = *fields else { return None };
        let head = self.head.filter(|head| head.number == message.number(number))?;
        let [x, y, z] = [message.array(x)?, message.array(y)?, message.array(z)?];
        let sample = |index: usize| {
            let frd = [x[index], y[index], z[index]].map(|raw| f64::from(raw) / head.divisor);
            body_from_frd(frd).0.into()
        };
        let step_s = 1.0 / head.rate_hz;
        Some(Piece {
            quantity: head.quantity,
            instance: head.instance,
            start_s: head.start_s + message.number(place) * x.len() as f64 * step_s,
            step_s,
            samples: std::array::from_fn(sample),
        })
    }
}
