//! Requested parameters, and the names by which a vehicle may answer.

use crate::autopilot::{Autopilot, KillSwitch, Purpose, Stack};

/// A parameter to request.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RequestedParameter {
    /// names by which it may answer, older first
    pub names: Vec<String>,
    /// what for
    pub purpose: Purpose,
}

/// Parameters to request from a vehicle with this number of rotors, most important first; none for other autopilots.
#[must_use]
pub fn requested_parameters(autopilot: Autopilot, rotors: usize) -> Vec<RequestedParameter> {
    let Some(stack) = autopilot.stack() else { return Vec::new() };
    let named = stack
        .parameters
        .needed()
        .map(|(purpose, entry)| RequestedParameter { names: all_names(stack, entry.name), purpose });
    let outputs = stack.outputs.groups.iter().flat_map(|group| group.names(rotors));
    let one = |purpose| move |name| RequestedParameter { names: vec![name], purpose };
    let outputs = outputs.map(one(Purpose::Thrust));
    let switches = switches(stack).into_iter().map(one(Purpose::Failsafe));
    let logging = stack.log_parameters().into_iter().map(str::to_owned);
    named.chain(outputs).chain(switches).chain(logging.map(one(Purpose::Logging))).collect()
}

fn all_names(stack: &Stack, name: &str) -> Vec<String> {
    let new = stack.parameters.renames_of(name).map(|renamed| renamed.new.to_owned());
    std::iter::once(name.to_owned()).chain(new).collect()
}

/// Options of the channels that may stop the motors.
fn switches(stack: &Stack) -> Vec<String> {
    match &stack.pilot.kill {
        KillSwitch::Channel(_) => Vec::new(),
        KillSwitch::Option { option, channels, .. } => {
            channels.clone().map(|channel| option.name(channel.into())).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_fit_a_parameter_and_come_once() {
        for autopilot in [Autopilot::Px4, Autopilot::ArduPilot] {
            let mut names: Vec<String> =
                requested_parameters(autopilot, 8).into_iter().flat_map(|wanted| wanted.names).collect();
            assert!(names.iter().all(|name| name.len() <= 16), "{names:?}");
            let count = names.len();
            names.sort();
            names.dedup();
            assert_eq!(names.len(), count);
        }
        assert!(requested_parameters(Autopilot::Other, 4).is_empty());
    }
}
