//! The vehicle of a run: where it is, and which it is.

use super::context::Context;
use super::embedded::Embedded;
use super::step::Step;
use crate::cli::VehicleLinkArgs;
use crate::commands::CommandError;

/// From boot until the position estimate of an embedded vehicle is good, s.
pub const WARM_UP_S: &str = "2";

/// ArduPilot's GUIDED makes a lively trajectory calm unless it is allowed more than its defaults.
const LIVELY: [&str; 6] =
    ["WP_ACC=10", "WP_ACC_Z=6", "WP_SPD_UP=4", "WP_SPD_DN=4", "PSC_NE_JERK=40", "PSC_D_JERK=40"];

/// The vehicle.
#[derive(Debug)]
pub struct Target {
    /// its address
    pub connect: String,
    /// its MAVLink system id, once it is known
    pub system: Option<u32>,
    /// the one that this program started
    pub embedded: Option<Embedded>,
    /// it is that one, in place of the vehicle of the run
    pub is_twin: bool,
}

impl Target {
    /// At the address of the arguments, or the embedded one, which is started.
    pub fn of(context: &Context<'_>) -> Result<Self, CommandError> {
        let system = context.args.system_id;
        if let Some(connect) = &context.args.connect {
            crate::commands::network::address("--connect", connect)?;
            return Ok(Self { connect: connect.clone(), system, embedded: None, is_twin: false });
        }
        let args = context.args;
        let autopilot = args.autopilot.and_then(mavid::autopilot::Autopilot::stack);
        let mut step = Step::of(&["sitl"]).maybe("--vehicle", args.vehicle.as_ref());
        if let Some(stack) = autopilot {
            step = step.option("--autopilot", stack.id);
        }
        step = step.option("--warm-up", WARM_UP_S).word("--esc-telemetry");
        if autopilot.is_some_and(|stack| stack.autopilot == mavid::autopilot::Autopilot::ArduPilot) {
            step = LIVELY.iter().fold(step, |step, parameter| step.option("--param", parameter));
        }
        let step = step.maybe("--effects", args.effects.as_ref());
        let (embedded, step) = Embedded::start(&step)?;
        context.tell(&step);
        Ok(Self { connect: embedded.address(), system, embedded: Some(embedded), is_twin: false })
    }

    /// As the arguments of a conversation.
    pub fn link(&self) -> VehicleLinkArgs {
        VehicleLinkArgs { connect: self.connect.clone(), system_id: self.system, signing_key_file: None }
    }
}
