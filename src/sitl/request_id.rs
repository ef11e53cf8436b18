//! Ids of the messages that the vehicle listens to.

pub(super) const HEARTBEAT: u32 = 0;
pub(super) const PING: u32 = 4;
pub(super) const SET_MODE: u32 = 11;
pub(super) const PARAM_REQUEST_READ: u32 = 20;
pub(super) const PARAM_REQUEST_LIST: u32 = 21;
pub(super) const PARAM_SET: u32 = 23;
pub(super) const MISSION_REQUEST_LIST: u32 = 43;
pub(super) const MISSION_COUNT: u32 = 44;
pub(super) const MISSION_CLEAR_ALL: u32 = 45;
pub(super) const MISSION_ACK: u32 = 47;
pub(super) const MISSION_REQUEST_INT: u32 = 51;
pub(super) const REQUEST_DATA_STREAM: u32 = 66;
pub(super) const MISSION_ITEM_INT: u32 = 73;
pub(super) const COMMAND_INT: u32 = 75;
pub(super) const COMMAND_LONG: u32 = 76;
pub(super) const SET_ATTITUDE_TARGET: u32 = 82;
pub(super) const SET_POSITION_TARGET_LOCAL_NED: u32 = 84;
pub(super) const TIMESYNC: u32 = 111;
pub(super) const SETUP_SIGNING: u32 = 256;
