//! What a ground station stores on the vehicle by the mission protocol: a fence. Missions and rally points are
//! refused.

use std::time::Duration;

use mavlink::dialects::ardupilotmega::{
    MISSION_ACK_DATA, MISSION_COUNT_DATA, MISSION_ITEM_INT_DATA, MISSION_REQUEST_INT_DATA, MavFrame,
    MavMissionResult, MavMissionType, MavSeverity,
};

use super::Vehicle;
use super::fence::Fence;
use super::message::Message;
use super::upload::Upload;
use crate::fence::{CIRCLE_INSIDE, CIRCLE_OUTSIDE, FenceItem, POLYGON_INSIDE, POLYGON_OUTSIDE};
use crate::frames::Geodetic;
use crate::units::{narrow, whole};
use crate::wire::Payload;
use crate::wire::message_id as id;

/// MAV_MISSION_TYPE_FENCE
const FENCE: u8 = 1;
/// MAV_MISSION_TYPE_ALL
const ALL: u8 = 255;
/// MAV_FRAME of items whose places are on Earth: above sea, above home, and the same in integers.
const ON_EARTH: [u8; 4] = [0, 3, 5, 6];
/// Items of a polygon, and those that are a figure on their own.
const CORNERS: [u16; 2] = [POLYGON_INSIDE, POLYGON_OUTSIDE];
const CIRCLES: [u16; 2] = [CIRCLE_INSIDE, CIRCLE_OUTSIDE];
/// Most items of a fence.
const CAPACITY: u16 = 64;
/// An item that does not come is asked for again, and an upload without news is given up.
const ASK_AGAIN: Duration = Duration::from_millis(250);
const GIVE_UP: Duration = Duration::from_secs(5);

fn count(items: usize, (target_system, target_component): (u8, u8), mission_type: u8) -> Message {
    let count = u16::try_from(items).unwrap_or(u16::MAX);
    let message =
        MISSION_COUNT_DATA { count, target_system, target_component, ..MISSION_COUNT_DATA::DEFAULT };
    // of any type, also of one that the dialect does not know
    Message::from(message).with_bytes(4, [mission_type])
}

fn request(sequence: usize, (target_system, target_component): (u8, u8)) -> Message {
    Message::from(MISSION_REQUEST_INT_DATA {
        seq: u16::try_from(sequence).unwrap_or(u16::MAX),
        target_system,
        target_component,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
    })
}

fn item(item: &FenceItem, seq: u16, (target_system, target_component): (u8, u8)) -> Message {
    let message = MISSION_ITEM_INT_DATA {
        param1: narrow(item.parameter),
        x: whole(item.place.latitude_deg * 1e7),
        y: whole(item.place.longitude_deg * 1e7),
        seq,
        target_system,
        target_component,
        frame: MavFrame::MAV_FRAME_GLOBAL,
        autocontinue: 1,
        mission_type: MavMissionType::MAV_MISSION_TYPE_FENCE,
        ..MISSION_ITEM_INT_DATA::DEFAULT
    };
    Message::from(message).with_bytes(30, item.command.to_le_bytes())
}

fn acknowledged(
    result: MavMissionResult,
    (target_system, target_component): (u8, u8),
    mission_type: u8,
) -> Message {
    let message =
        MISSION_ACK_DATA { target_system, target_component, mavtype: result, ..MISSION_ACK_DATA::DEFAULT };
    Message::from(message).with_bytes(3, [mission_type])
}

/// An item of a fence from MISSION_ITEM_INT.
fn read(payload: Payload) -> Result<FenceItem, MavMissionResult> {
    let item = FenceItem {
        command: payload.u16(30),
        parameter: payload.f32(0),
        place: Geodetic {
            latitude_deg: f64::from(payload.i32(16)) * 1e-7,
            longitude_deg: f64::from(payload.i32(20)) * 1e-7,
        },
    };
    if !ON_EARTH.contains(&payload.u8(34)) {
        return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED_FRAME);
    }
    if !CORNERS.contains(&item.command) && !CIRCLES.contains(&item.command) {
        return Err(MavMissionResult::MAV_MISSION_UNSUPPORTED);
    }
    let on_earth = item.place.latitude_deg.abs() <= 90.0 && item.place.longitude_deg.abs() <= 180.0;
    if !(on_earth && item.parameter.is_finite() && item.parameter > 0.0) {
        return Err(MavMissionResult::MAV_MISSION_INVALID);
    }
    Ok(item)
}

/// Each polygon has three corners or more, all of them, one behind the other.
fn is_whole(items: &[FenceItem]) -> bool {
    let mut rest = items;
    while let Some(first) = rest.first() {
        let size = if CORNERS.contains(&first.command) { whole(first.parameter) } else { 1 };
        let Some((figure, others)) = usize::try_from(size).ok().and_then(|size| rest.split_at_checked(size))
        else {
            return false;
        };
        let alike = figure
            .iter()
            .all(|corner| (corner.command, corner.parameter) == (first.command, first.parameter));
        let enough = CIRCLES.contains(&first.command) || figure.len() >= 3;
        if !(alike && enough) {
            return false;
        }
        rest = others;
    }
    true
}

impl Vehicle {
    /// A message of the mission protocol.
    pub(super) fn mission(
        &mut self,
        link: usize,
        message_id: u32,
        payload: Payload,
        from: ((u8, u8), Duration),
    ) {
        let (sender, _) = from;
        let (at, kind_at) = match message_id {
            id::MISSION_REQUEST_LIST | id::MISSION_CLEAR_ALL => (0, 2),
            id::MISSION_ACK => (0, 3),
            id::MISSION_ITEM_INT => (32, 37),
            _ => (2, 4),
        };
        if !self.is_for_us((payload.u8(at), payload.u8(at + 1))) {
            return;
        }
        let kind = payload.u8(kind_at);
        let fence = if kind == FENCE { &self.settings.fence[..] } else { &[] };
        let answer = match message_id {
            id::MISSION_REQUEST_LIST => count(fence.len(), sender, kind),
            id::MISSION_REQUEST_INT => match fence.get(usize::from(payload.u16(0))) {
                Some(stored) => item(stored, payload.u16(0), sender),
                None => acknowledged(MavMissionResult::MAV_MISSION_INVALID_SEQUENCE, sender, kind),
            },
            id::MISSION_CLEAR_ALL => {
                if matches!(kind, FENCE | ALL) {
                    self.store_fence(Vec::new());
                }
                // there is never a mission nor a rally point
                acknowledged(MavMissionResult::MAV_MISSION_ACCEPTED, sender, kind)
            }
            id::MISSION_COUNT if kind == FENCE => {
                return self.begin_upload(link, usize::from(payload.u16(0)), from);
            }
            id::MISSION_ITEM_INT if kind == FENCE => return self.take_item(link, payload, from),
            // the ground station has all that it asked for, or gives its upload up
            id::MISSION_ACK => {
                let given_up = u32::from(payload.u8(2)) != MavMissionResult::MAV_MISSION_ACCEPTED as u32;
                if given_up && self.upload.as_ref().is_some_and(|upload| upload.sender == sender) {
                    self.upload = None;
                }
                return;
            }
            _ => acknowledged(MavMissionResult::MAV_MISSION_UNSUPPORTED, sender, kind),
        };
        self.send(link, &answer);
    }

    fn begin_upload(&mut self, link: usize, count: usize, (sender, now): ((u8, u8), Duration)) {
        let busy = self.upload.as_ref().is_some_and(|upload| upload.sender != sender);
        let answer = match count {
            _ if busy => acknowledged(MavMissionResult::MAV_MISSION_DENIED, sender, FENCE),
            _ if count > usize::from(CAPACITY) => {
                acknowledged(MavMissionResult::MAV_MISSION_NO_SPACE, sender, FENCE)
            }
            0 => {
                self.store_fence(Vec::new());
                acknowledged(MavMissionResult::MAV_MISSION_ACCEPTED, sender, FENCE)
            }
            _ => {
                let items = Vec::with_capacity(count);
                self.upload = Some(Upload { link, sender, items, count, asked: now, heard: now });
                request(0, sender)
            }
        };
        self.send(link, &answer);
    }

    fn take_item(&mut self, link: usize, payload: Payload, (sender, now): ((u8, u8), Duration)) {
        let Some(upload) = self.upload.as_mut().filter(|upload| upload.sender == sender) else {
            self.send(link, &acknowledged(MavMissionResult::MAV_MISSION_ERROR, sender, FENCE));
            return;
        };
        upload.heard = now;
        // one that came twice is passed over
        if usize::from(payload.u16(28)) != upload.items.len() {
            return;
        }
        let result = match read(payload) {
            Err(result) => result,
            Ok(item) => {
                upload.items.push(item);
                if upload.items.len() < upload.count {
                    upload.asked = now;
                    let next = request(upload.items.len(), sender);
                    self.send(link, &next);
                    return;
                }
                if is_whole(&upload.items) {
                    let items = std::mem::take(&mut upload.items);
                    self.store_fence(items);
                    MavMissionResult::MAV_MISSION_ACCEPTED
                } else {
                    MavMissionResult::MAV_MISSION_INVALID
                }
            }
        };
        self.upload = None;
        self.send(link, &acknowledged(result, sender, FENCE));
    }

    /// Keeps a fence from now on.
    fn store_fence(&mut self, items: Vec<FenceItem>) {
        self.settings.fence = items;
        self.autopilot.fence = Fence::of(&self.settings);
    }

    /// Asks again for what did not come.
    pub(super) fn pursue_upload(&mut self, now: Duration) {
        let Some(upload) = &mut self.upload else { return };
        let (link, sender) = (upload.link, upload.sender);
        if now.saturating_sub(upload.heard) >= GIVE_UP {
            self.upload = None;
            self.autopilot.say(MavSeverity::MAV_SEVERITY_WARNING, "Fence upload timed out");
            self.send(link, &acknowledged(MavMissionResult::MAV_MISSION_OPERATION_CANCELLED, sender, FENCE));
        } else if now.saturating_sub(upload.asked) >= ASK_AGAIN {
            upload.asked = now;
            let again = request(upload.items.len(), sender);
            self.send(link, &again);
        }
    }
}
