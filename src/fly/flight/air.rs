//! In the air: up, to the start, along the trajectory.

use std::sync::Arc;
use std::time::Duration;

use nalgebra::Vector3;

use super::gate::Gate;
use super::phase::Phase;
use super::state::Flight;
use crate::autopilot::{Mode, Takeoff};
use crate::fly::commander::Manner;
use crate::fly::course::{CLIMB_M_S, PathClock, TRANSFER_M_S, TURN_RAD_S, Track, transfer};
use crate::fly::health::BatteryLevel;
use crate::fly::lift::Weighed;
use crate::fly::outcome::{Cause, Level};
use crate::fly::preflight::HOVER;
use crate::fly::safety::{Lead, SetpointBounds};
use crate::fly::setpoint::Place;
use crate::fly::sortie::Origin;
use crate::fly::target::Order;

/// Largest lead of the setpoint over a vehicle whose rotors spin up, m. A larger lead makes the vehicle jump once its
/// rotors carry.
const LEAD_MAX_M: f64 = 0.6;
/// Distance to its height at which a climb is complete, m. Less may never be reached in wind; more begins the
/// transfer too low.
const CLIMBED_M: f64 = 0.3;
/// Largest speed of a complete climb, m/s. As slow as a hover in wind.
const CLIMBED_M_S: f64 = 0.3;

impl Flight {
    /// The plan's zero in the vehicle's local frame.
    pub(in crate::fly) fn offset_m(&self, stand_m: &Vector3<f64>) -> Vector3<f64> {
        let [x, y, ..] = self.sortie.course.takeoff();
        match self.sortie.settings.origin {
            Origin::Local => Vector3::new(0.0, 0.0, stand_m.z),
            Origin::Here => Vector3::new(stand_m.x - x, stand_m.y - y, stand_m.z),
        }
    }

    /// Where the course begins, for a vehicle that stands at `stand_m`; local frame.
    pub(super) fn start_from(&self, stand_m: &Vector3<f64>) -> Place {
        let [x, y, z, yaw_rad] = self.sortie.course.takeoff();
        Place { position_m: Vector3::new(x, y, z) + self.offset_m(stand_m), yaw_rad }
    }

    pub(super) fn start(&self) -> Option<Place> {
        self.stand.map(|stand| self.start_from(&stand.position_m))
    }

    /// The place above the point of takeoff, at the height of the start.
    fn top(&self) -> Option<Place> {
        let (stand, start) = (self.stand?, self.start()?);
        let position_m = Vector3::new(stand.position_m.x, stand.position_m.y, start.position_m.z);
        Some(Place { position_m, ..stand })
    }

    pub(super) fn begin_climb(&mut self, now: Duration) {
        let (Some(stand), Some(top), Some((_, stack))) = (self.stand, self.top(), self.target()) else {
            return;
        };
        if let Some(contact) = &mut self.contact {
            contact.telemetry.ground.expect_takeoff();
        }
        match stack.setpoints.takeoff {
            Takeoff::BySetpoints => {
                let path = Arc::new(transfer(&stand, &top, CLIMB_M_S, TURN_RAD_S));
                self.lead_along(Track { path, offset_m: Vector3::zeros(), clock: PathClock::start(now) });
            }
            Takeoff::ByCommand => {
                let height_m = top.position_m.z - stand.position_m.z;
                match Order::takeoff(height_m) {
                    Ok(takeoff) => self.give(now, takeoff, Manner::PATIENT),
                    Err(why) => return self.end(now, Cause::Refused(why.to_string())),
                }
            }
        }
        self.enter(now, Phase::Climb);
    }

    fn lead_along(&mut self, track: Track) {
        self.watch.tracking.restart();
        self.guide.lead = Lead::Along(track);
    }

    pub(super) fn climb(&mut self, now: Duration) {
        let Some(top) = self.top() else { return };
        let Some((position_m, velocity_m_s)) = self.motion_now() else { return };
        let told = self.guide.setpoint(now).map(|setpoint| setpoint.position_m.z);
        let mut led_to_the_top = true;
        if let Lead::Along(track) = &mut self.guide.lead {
            let ahead = told.is_some_and(|told| told - position_m.z > LEAD_MAX_M);
            track.clock.set_running(!ahead, now);
            led_to_the_top = track.is_over(now);
        }
        let below_m = top.position_m.z - position_m.z;
        if led_to_the_top && below_m < CLIMBED_M && velocity_m_s.z.abs() < CLIMBED_M_S {
            self.begin_transfer(now);
        } else if now.saturating_sub(self.entered) > self.sortie.settings.reach_timeout {
            self.end(now, Cause::NotReached(format!("no takeoff: still {below_m:.2} m below its height")));
        }
    }

    fn begin_transfer(&mut self, now: Duration) {
        let (Some(here), Some(start)) = (self.place_now(), self.start()) else { return };
        // from where it was led to, or from where it is after a takeoff by command
        let from = self.guide.setpoint(now).map_or(here, |setpoint| setpoint.place());
        let path = Arc::new(transfer(&from, &start, TRANSFER_M_S, TURN_RAD_S));
        self.lead_along(Track { path, offset_m: Vector3::zeros(), clock: PathClock::start(now) });
        self.enter(now, Phase::Transfer);
    }

    pub(super) fn transfer(&mut self, now: Duration) {
        let Some(start) = self.start() else { return };
        if matches!(&self.guide.lead, Lead::Along(track) if track.is_over(now)) {
            self.guide.lead = Lead::Hold(start);
            self.gate = Gate::default();
            self.enter(now, Phase::Gate);
        }
    }

    /// In hover: reports whether the thrust by the vehicle file is the weight.
    pub(super) fn weigh(&mut self, now: Duration) {
        let (level, text) = match self.lift.as_ref().map(|lift| lift.weighed()) {
            Some(Weighed::Notable(text)) => (Level::Warning, text),
            Some(Weighed::Alike(text)) => (Level::Information, text),
            None => return,
        };
        self.note(now, level, HOVER, text);
    }

    pub(super) fn begin_course(&mut self, now: Duration) {
        let Some(stand) = self.stand else { return };
        let path = self.sortie.course.path().clone();
        let offset_m = self.offset_m(&stand.position_m);
        self.lead_along(Track { path, offset_m, clock: PathClock::start(now) });
        self.enter(now, Phase::Course);
    }

    pub(super) fn fly_course(&mut self, now: Duration) {
        let Lead::Along(track) = &self.guide.lead else { return };
        let along_s = track.clock.at(now).along_s;
        let period = self.sortie.course.period_at(along_s);
        if period > self.flown.periods + 1 {
            self.flown.periods = period - 1;
            let text = format!("period {} of {}", self.flown.periods, self.sortie.course.repeats());
            self.note(now, Level::Information, "period", format!("{text} flown"));
        }
        if self.battery_level() == BatteryLevel::Low
            && let Some(course) = self.sortie.course.ending_soon(along_s)
        {
            let loss =
                format!("battery low: {} of {} periods", course.repeats(), self.sortie.course.repeats());
            self.note(now, Level::Warning, "battery", loss.clone());
            self.losses.push(loss);
            if let Lead::Along(track) = &mut self.guide.lead {
                track.path = course.path().clone();
            }
            self.sortie.course = course;
        }
        if matches!(&self.guide.lead, Lead::Along(track) if track.is_over(now)) {
            self.begin_landing(now);
        }
    }

    /// Passes the setpoint to the safety rules, and pauses the path while nothing is received.
    pub(super) fn follow(&mut self, now: Duration) {
        let paused = self.watch.is_paused();
        if let (Phase::Transfer | Phase::Course, Lead::Along(track)) = (&self.phase, &mut self.guide.lead) {
            track.clock.set_running(!paused && !self.known.is_in_doubt(), now);
        }
        self.guide.bounds = self.bounds();
        if let Some(reference) = self.guide.setpoint(now) {
            self.watch.tracking.record_reference(now, reference.position_m);
        }
        if let Some(sent) = self.guide.sent(now) {
            self.climbed |= self.stand.is_some_and(|stand| self.room(&stand).contains(&sent.position_m));
            self.watch.masters.record_setpoint(now, sent);
        }
    }

    /// The permitted region of setpoints: the room, and the way up from the ground.
    fn bounds(&self) -> Option<SetpointBounds> {
        let stand = self.stand.or_else(|| self.place_now())?;
        let room = self.room(&stand);
        Some(if self.climbed { room } else { room.with(&stand.position_m) })
    }

    /// The room around a vehicle that stood there; local frame.
    fn room(&self, stand: &Place) -> SetpointBounds {
        SetpointBounds::room(&self.sortie.limits, &self.offset_m(&stand.position_m))
    }

    /// Position and smoothed velocity, m and m/s, world, local.
    pub(super) fn motion_now(&self) -> Option<(Vector3<f64>, Vector3<f64>)> {
        let telemetry = &self.contact.as_ref()?.telemetry;
        Some((telemetry.motion?.value.position_m, telemetry.smooth_velocity_m_s()?))
    }

    /// The reason if the vehicle left our mode: somebody else decided so.
    pub(super) fn left_our_mode(&self) -> Option<String> {
        let telemetry = &self.contact.as_ref()?.telemetry;
        let state = telemetry.state?.value;
        let stack = telemetry.stack();
        (!stack.is_in(Mode::External, state.custom_mode)).then(|| {
            format!("{} left for {}", stack.name_of(Mode::External), stack.mode_name(state.custom_mode))
        })
    }
}
