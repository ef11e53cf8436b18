//! What a ground station asks of the vehicle's files, and what it is sent of them.

use mavlink::dialects::ardupilotmega::FILE_TRANSFER_PROTOCOL_DATA;

use super::Vehicle;
use super::files::{Answer, Sent};
use super::message::Message;
use crate::wire::Payload;
use crate::wire::file_transfer::Transfer;
use crate::wire::message_id as id;

impl Vehicle {
    /// A message of the file transfer or of the log messages.
    pub(super) fn ask_files(&mut self, link: usize, message_id: u32, payload: Payload, sender: (u8, u8)) {
        let target = match message_id {
            id::FILE_TRANSFER_PROTOCOL => (payload.u8(1), payload.u8(2)),
            id::LOG_REQUEST_LIST => (payload.u8(4), payload.u8(5)),
            id::LOG_REQUEST_DATA => (payload.u8(10), payload.u8(11)),
            _ => (payload.u8(0), payload.u8(1)),
        };
        if !self.is_for_us(target) {
            return;
        }
        match message_id {
            id::FILE_TRANSFER_PROTOCOL => {
                let request = Transfer::read(payload);
                if let Some(answer) = self.file_server.take(&request, (link, sender), self.keeper.store()) {
                    self.answer(answer);
                }
            }
            id::LOG_REQUEST_LIST => self.log_sender.list(link, (payload.u16(0), payload.u16(2))),
            id::LOG_REQUEST_DATA => {
                self.log_sender.data(link, payload.u16(8), payload.u32(0), payload.u32(4));
            }
            _ => self.log_sender.end(),
        }
    }

    fn answer(&mut self, (link, (target_system, target_component), payload): Answer) {
        let message =
            FILE_TRANSFER_PROTOCOL_DATA { target_network: 0, target_system, target_component, payload };
        self.send(link, &Message::from(message));
    }

    /// What is under way of files, one period of the main loop.
    pub(super) fn send_files(&mut self) {
        for answer in self.file_server.pursue(self.keeper.store()) {
            self.answer(answer);
        }
        for sent in self.log_sender.pursue(self.keeper.store()) {
            match sent {
                Sent::Entry(link, entry) => self.send(link, &Message::from(entry)),
                Sent::Data(link, data) => self.send(link, &Message::from(data)),
            }
        }
    }
}
