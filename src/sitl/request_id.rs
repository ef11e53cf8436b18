//! Ids of the messages that the vehicle listens to.
#![expect(deprecated, reason = "autopilots and ground stations still speak them")]

use mavlink::MessageData;
use mavlink::dialects::ardupilotmega as dialect;

pub(super) const HEARTBEAT: u32 = dialect::HEARTBEAT_DATA::ID;
pub(super) const PING: u32 = dialect::PING_DATA::ID;
pub(super) const SET_MODE: u32 = dialect::SET_MODE_DATA::ID;
pub(super) const PARAM_REQUEST_READ: u32 = dialect::PARAM_REQUEST_READ_DATA::ID;
pub(super) const PARAM_REQUEST_LIST: u32 = dialect::PARAM_REQUEST_LIST_DATA::ID;
pub(super) const PARAM_SET: u32 = dialect::PARAM_SET_DATA::ID;
pub(super) const MISSION_REQUEST_LIST: u32 = dialect::MISSION_REQUEST_LIST_DATA::ID;
pub(super) const MISSION_COUNT: u32 = dialect::MISSION_COUNT_DATA::ID;
pub(super) const MISSION_CLEAR_ALL: u32 = dialect::MISSION_CLEAR_ALL_DATA::ID;
pub(super) const MISSION_ACK: u32 = dialect::MISSION_ACK_DATA::ID;
pub(super) const MISSION_REQUEST_INT: u32 = dialect::MISSION_REQUEST_INT_DATA::ID;
pub(super) const REQUEST_DATA_STREAM: u32 = dialect::REQUEST_DATA_STREAM_DATA::ID;
pub(super) const MISSION_ITEM_INT: u32 = dialect::MISSION_ITEM_INT_DATA::ID;
pub(super) const COMMAND_INT: u32 = dialect::COMMAND_INT_DATA::ID;
pub(super) const COMMAND_LONG: u32 = dialect::COMMAND_LONG_DATA::ID;
pub(super) const SET_ATTITUDE_TARGET: u32 = dialect::SET_ATTITUDE_TARGET_DATA::ID;
pub(super) const SET_POSITION_TARGET_LOCAL_NED: u32 = dialect::SET_POSITION_TARGET_LOCAL_NED_DATA::ID;
pub(super) const TIMESYNC: u32 = dialect::TIMESYNC_DATA::ID;
pub(super) const SETUP_SIGNING: u32 = dialect::SETUP_SIGNING_DATA::ID;
pub(super) const FILE_TRANSFER_PROTOCOL: u32 = dialect::FILE_TRANSFER_PROTOCOL_DATA::ID;
pub(super) const LOG_REQUEST_LIST: u32 = dialect::LOG_REQUEST_LIST_DATA::ID;
pub(super) const LOG_REQUEST_DATA: u32 = dialect::LOG_REQUEST_DATA_DATA::ID;
pub(super) const LOG_REQUEST_END: u32 = dialect::LOG_REQUEST_END_DATA::ID;
