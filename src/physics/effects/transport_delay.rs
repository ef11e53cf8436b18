//! Commands take time to arrive.

use crate::physics::equation::documented;
use crate::physics::{Bounds, Effect, Hook, Parameter};

documented! {
    /// The commands `u(t - delay)` act at time t: an exact shift, no filter.
    #[derive(Debug, Clone, Copy)]
    pub struct TransportDelay;
}

const PARAMETERS: &[Parameter] = &[Parameter { name: "delay", unit: "s", bounds: Bounds::of(0.0, 0.3) }];

impl Effect for TransportDelay {
    fn id(&self) -> &'static str {
        "transport_delay"
    }

    fn sentence(&self) -> &'static str {
        "Commands arrive late, as a pure delay."
    }

    fn equation(&self) -> &'static str {
        Self::EQUATION
    }

    fn parameters(&self) -> &'static [Parameter] {
        PARAMETERS
    }

    fn hooks(&self) -> &'static [Hook] {
        &[Hook::Commands]
    }

    fn command_delay_s(&self, parameters: &[f64]) -> f64 {
        parameters[0].max(0.0)
    }
}
