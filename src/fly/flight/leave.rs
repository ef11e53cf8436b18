//! Leaving our mode: hold, land, return, by the vehicle's own modes. The planned landing is one of these.

use std::time::Duration;

use super::event::Key;
use super::leaving::Leaving;
use super::phase::Phase;
use super::state::Flight;
use crate::autopilot::Mode;
use crate::fly::commander::Manner;
use crate::fly::outcome::{Cause, Ending, Level};
use crate::fly::safety::Lead;
use crate::fly::setpoint::Place;
use crate::fly::target::Order;

/// If a vehicle does not report within this time after the order that it is armed, it is not armed.
const ARMS_WITHIN: Duration = Duration::from_millis(2500);
/// A mode that is not entered within this time will not be entered.
const HOLD_BY: Duration = Duration::from_secs(3);
const LAND_BY: Duration = Duration::from_secs(5);
/// A mode that was accepted, or not answered, is ordered again after this time.
const ASK_AGAIN: Duration = Duration::from_millis(400);
/// An autopilot that disarms after its landing may change its mode before it is heard to stand on the ground.
const GROUND_IS_HEARD: Duration = Duration::from_millis(1500);
/// The same, until it is heard that it is disarmed.
const DISARM_IS_HEARD: Duration = Duration::from_secs(3);
/// Longest time from the order to land to the ground; a vehicle that returns first flies home.
const GROUND_BY: Duration = Duration::from_secs(180);
/// On the ground, the autopilot disarms by itself; after this time the order is given.
const DISARM_AFTER: Duration = Duration::from_secs(3);
/// The order is repeated after this time if the vehicle accepted it and does not report that it is disarmed.
const DISARM_AGAIN: Duration = Duration::from_secs(4);
/// Longest time for which a program that is to end waits for the vehicle to hold: a silent link may come back.
const STOP_WITHIN: Duration = Duration::from_secs(5);
/// Deceleration that may be expected of a vehicle after the order to hold, m/s^2. PX4's MPC_ACC_HOR is 3 m/s^2 by
/// default, ArduPilot's WPNAV_ACCEL 2.5; a larger value orders the hold later.
const BRAKING_M_S2: f64 = 3.0;

/// Motors off: ten times a second for as long as an ordinary command is repeated.
const KILLING: Manner = Manner { repeat: Manner::URGENT.repeat, ..Manner::PATIENT };

impl Flight {
    /// Orders the vehicle's hold mode.
    pub(super) fn begin_hold(&mut self, now: Duration) {
        self.leave_to(now, Mode::Hold);
    }

    /// Orders the landing.
    pub(super) fn begin_landing(&mut self, now: Duration) {
        self.leave_to(now, Mode::Land);
    }

    fn leave_to(&mut self, now: Duration, wish: Mode) {
        // a mode that is not ours is not left: whoever chose it flies
        let from = self.contact.as_ref().map(|contact| contact.telemetry.stack().number_of(Mode::External));
        // setpoints continue until the mode is seen, but say: stop here; what stands on the ground is not steered
        if self.stand.is_none() {
            self.guide.lead = Lead::Silent;
        }
        if self.guide.lead != Lead::Silent {
            let planned = self.cause.is_none();
            let place = if planned { self.guide.setpoint(now).map(|told| told.place()) } else { None };
            if let Some(place) = place.or_else(|| self.stopping_place()) {
                self.guide.lead = Lead::Hold(place);
            }
        }
        self.enter(now, Phase::Leave(Leaving::to(wish, from, now)));
        // what was ordered for the flight is over
        self.commander.clear();
        self.ask(now, wish);
    }

    /// The place at which the vehicle comes to rest if it brakes now.
    fn stopping_place(&self) -> Option<Place> {
        let (position_m, velocity_m_s) = self.motion_now()?;
        let yaw_rad = self.place_now()?.yaw_rad;
        let ahead_m = velocity_m_s * (velocity_m_s.norm() / (2.0 * BRAKING_M_S2));
        Some(Place { position_m: position_m + ahead_m, yaw_rad })
    }

    fn ask(&mut self, now: Duration, wish: Mode) {
        if let Phase::Leave(leaving) = &mut self.phase {
            leaving.asked = now;
        }
        if let Some((_, stack)) = self.target() {
            self.give(now, Order::set_mode(stack, wish), Manner::URGENT);
        }
    }

    pub(super) fn leave(&mut self, now: Duration) {
        let armed = self.is_armed();
        let Phase::Leave(leaving) = &self.phase else { return };
        let (wish, wished, stop_by) = (leaving.wish, leaving.wished, leaving.stop_by);
        let seen = leaving.is_ordered() && self.is_in(wish);
        let on_ground = self.is_on_ground(now);
        if !armed {
            // the order to arm may still act
            if self.stand.is_some() || !self.arm_ordered || now.saturating_sub(self.entered) > ARMS_WITHIN {
                self.finish(now, if self.stand.is_some() { Ending::Landed } else { Ending::NotFlown });
            }
            return;
        }
        if stop_by.is_some_and(|by| now >= by || seen) {
            let mode = self.mode_name();
            self.finish(now, Ending::InTheAir(mode));
            return;
        }
        let Phase::Leave(leaving) = &mut self.phase else { return };
        match (seen, leaving.reached) {
            (true, None) => {
                leaving.reached = Some(now);
                self.guide.lead = Lead::Silent;
                // what it shows needs no order any more: whoever else chose the same is not to hear one
                if let Some((_, stack)) = self.target() {
                    self.commander.forget(&Order::set_mode(stack, wish));
                }
            }
            (true, Some(_)) if leaving.strayed => {
                self.end(now, Cause::Override(format!("{} was left and entered again", self.phase.name())));
                return;
            }
            (true, Some(_)) => {
                leaving.left.update(now, false);
            }
            // somebody else has chosen another mode after ours; on the ground it may be the autopilot, as it disarms
            (false, Some(_)) => {
                leaving.strayed |= !on_ground;
                let patience = match wish {
                    _ if on_ground => DISARM_IS_HEARD,
                    Mode::Hold => Duration::ZERO,
                    _ => GROUND_IS_HEARD,
                };
                if leaving.left.update(now, true) >= patience {
                    let mode = self.mode_name();
                    self.end(now, Cause::Override(format!("{} left for {mode}", self.phase.name())));
                    return;
                }
            }
            (false, None) => {
                self.insist(now, wish, wished);
                return;
            }
        }
        // a vehicle in another mode in the air is on its way to "hands off"
        if self.known.is_in_doubt() || !seen && !on_ground {
            return;
        }
        self.wait_for_the_ground(now, wish, wished);
    }

    /// Repeats the order of a mode that is not reported yet, then orders the next one.
    fn insist(&mut self, now: Duration, wish: Mode, wished: Duration) {
        if self.left_by_others(now) {
            return;
        }
        if let Phase::Leave(leaving) = &mut self.phase
            && self.known.is_in_doubt()
            && !leaving.is_ordered()
        {
            // what could not be ordered yet was not refused
            leaving.wished = now;
            return;
        }
        let waited = now.saturating_sub(wished);
        let next = match wish {
            Mode::External | Mode::Hold if waited > HOLD_BY => Some(Mode::Land),
            Mode::Land if waited > LAND_BY => Some(Mode::Return),
            Mode::Return if waited > LAND_BY => {
                let mode = self.mode_name();
                self.cause.get_or_insert(Cause::Unresponsive(format!(
                    "no ordered mode is entered; it is in {mode}"
                )));
                self.note(now, Level::Error, "abort", "the vehicle enters no ordered mode: hands off");
                self.hands_off(now);
                return;
            }
            _ => None,
        };
        match next {
            Some(next) => {
                self.note(now, Level::Error, "abort", format!("{} is not entered", self.phase.name()));
                self.wish(now, next);
            }
            None => {
                let due = matches!(&self.phase, Phase::Leave(leaving)
                    if now.saturating_sub(leaving.asked) >= ASK_AGAIN);
                if due {
                    self.ask(now, wish);
                }
            }
        }
    }

    /// Whether the vehicle is in a mode that we did not order, and not in the one that it was to leave: somebody else
    /// decided so.
    fn left_by_others(&mut self, now: Duration) -> bool {
        let Some(shown) = self.custom_mode() else { return false };
        let Phase::Leave(leaving) = &self.phase else { return false };
        if leaving.comes_from(shown) {
            return false;
        }
        let (phase, mode) = (self.phase.name(), self.mode_name());
        self.end(now, Cause::Override(format!("{mode} was entered before {phase}")));
        true
    }

    fn wish(&mut self, now: Duration, wish: Mode) {
        let shown = self.custom_mode();
        let by_us = self.is_to_command();
        let stack = self.target().map(|(_, stack)| stack);
        if let Phase::Leave(leaving) = &mut self.phase {
            // what somebody else chose meanwhile stays his
            leaving.from = match leaving.reached {
                _ if by_us => shown,
                Some(_) => stack.map(|stack| stack.number_of(leaving.wish)),
                None => leaving.from,
            };
            (leaving.wish, leaving.wished, leaving.reached, leaving.ordered) = (wish, now, None, false);
            leaving.strayed &= !by_us;
            let name = leaving.name();
            self.note(now, Level::Information, "phase", name);
            self.commander.clear();
            self.ask(now, wish);
        }
    }

    fn wait_for_the_ground(&mut self, now: Duration, wish: Mode, wished: Duration) {
        let (on_ground, hold_then_land) = (self.is_on_ground(now), self.sortie.settings.hold_then_land);
        let Phase::Leave(leaving) = &mut self.phase else { return };
        let landed_for = leaving.landed.update(now, on_ground);
        let held = !leaving.by_operator && now.saturating_sub(wished) > hold_then_land;
        let disarm = Order::arm(false);
        let asked = leaving.disarmed.is_some_and(|at| now.saturating_sub(at) < DISARM_AGAIN);
        if wish == Mode::Hold {
            if held {
                self.note(now, Level::Warning, "abort", "held long enough: landing");
                self.wish(now, Mode::Land);
            }
        } else if landed_for > DISARM_AFTER && !asked && !self.commander.waits_for(&disarm) {
            leaving.disarmed = Some(now);
            self.give(now, disarm, Manner::PATIENT);
        } else if now.saturating_sub(wished) > GROUND_BY {
            self.cause.get_or_insert(Cause::NotReached("the ground is not reached".to_owned()));
            let mode = self.mode_name();
            self.finish(now, Ending::InTheAir(mode));
        }
    }

    fn is_on_ground(&self, now: Duration) -> bool {
        self.contact.as_ref().is_some_and(|contact| contact.telemetry.ground.is_landed_at(now))
    }

    /// The operator's keys.
    pub(super) fn key(&mut self, now: Duration, key: Key) {
        if matches!(self.phase, Phase::Watch) {
            let text =
                "hands off is final: the pilot has control; use the remote control, or start mavid again";
            self.note(now, Level::Warning, "watch", text);
            return;
        }
        if key == Key::Kill {
            self.note(now, Level::Error, "abort", "motors off by the operator");
            let flying = self.phase.is_airborne() && !self.is_on_ground(now);
            self.cause = Some(if flying { Cause::Killed } else { Cause::Operator });
            self.commander.clear();
            let ours =
                self.is_to_command() || matches!(self.phase, Phase::Lost) && self.is_in(Mode::External);
            self.killed_in = self.custom_mode().filter(|_| ours);
            if self.killed_in.is_some() {
                self.give(now, Order::kill(), KILLING);
            } else {
                let text = "the vehicle is not in our mode: only its pilot may stop the motors";
                self.note(now, Level::Error, "abort", text);
            }
            // a stream that ends makes PX4 choose another mode, in which nothing of ours is obeyed: it ends with the order
            self.guide.lead = match self.stopping_place() {
                Some(place) if self.guide.lead != Lead::Silent => Lead::Hold(place),
                _ => Lead::Silent,
            };
            if self.contact.is_some() {
                self.enter(now, Phase::Watch);
            } else {
                self.finish(now, Ending::NotFlown);
            }
            return;
        }
        let next = match (&self.phase, key) {
            (Phase::Leave(_), Key::To(mode)) => Some(mode),
            (Phase::Leave(leaving), _) => match leaving.wish {
                Mode::External | Mode::Hold => Some(Mode::Land),
                Mode::Land | Mode::Return => Some(Mode::Return),
            },
            _ => None,
        };
        match next {
            Some(next) => {
                self.cause.get_or_insert(Cause::Operator);
                self.wish(now, next);
            }
            None if matches!(self.phase, Phase::Lost) => self.begin_hold(now),
            None => self.end(now, Cause::Operator),
        }
        if let Phase::Leave(leaving) = &mut self.phase {
            leaving.by_operator = true;
            if let Key::To(mode) = key
                && mode != leaving.wish
            {
                self.wish(now, mode);
            }
        }
    }

    /// The program is to end: the vehicle is left in hold, or in what it does already.
    pub(super) fn stop(&mut self, now: Duration, by: &str) {
        if matches!(self.phase, Phase::Watch | Phase::Lost) {
            let mode = self.mode_name();
            self.finish(now, Ending::InTheAir(mode));
            return;
        }
        self.end(now, Cause::Signal(by.to_owned()));
        if let Phase::Leave(leaving) = &mut self.phase {
            self.cause.get_or_insert(Cause::Signal(by.to_owned()));
            leaving.stop_by.get_or_insert(now + STOP_WITHIN);
        }
    }
}
