//! MAVLink's file transfer: what the payload of FILE_TRANSFER_PROTOCOL holds, and the checksum of files.

use crc::{Algorithm, Crc, Table};

use super::frame::Payload;

/// Bytes of the message's `payload`, and where it begins.
pub const TRANSFER_BYTES: usize = 251;
const PAYLOAD_AT: usize = 3;
/// Bytes before the data.
const HEADER_BYTES: usize = 12;
/// Most bytes of data in one message.
pub const DATA_BYTES: usize = TRANSFER_BYTES - HEADER_BYTES;

/// That of both autopilots: the polynomial of IEEE 802.3, beginning with nought, and not inverted at the end.
const FILE_SUM: Algorithm<u32> = Algorithm {
    width: 32,
    poly: 0x04c1_1db7,
    init: 0,
    refin: true,
    refout: true,
    xorout: 0,
    check: 0x2dfd_2d88,
    residue: 0,
};
static FILE_CRC: Crc<u32, Table<16>> = Crc::<u32, Table<16>>::new(&FILE_SUM);

/// The checksum of a file, as both autopilots calculate it.
#[derive(Clone)]
pub struct FileSum(crc::Digest<'static, u32, Table<16>>);

impl std::fmt::Debug for FileSum {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("FileSum")
    }
}

impl Default for FileSum {
    fn default() -> Self {
        Self(FILE_CRC.digest())
    }
}

impl FileSum {
    /// Goes on with these bytes.
    pub fn update(&mut self, bytes: &[u8]) {
        self.0.update(bytes);
    }

    /// Of all bytes so far.
    #[must_use]
    pub fn value(self) -> u32 {
        self.0.finalize()
    }

    /// Of these bytes.
    #[must_use]
    pub fn of(bytes: &[u8]) -> u32 {
        FILE_CRC.checksum(bytes)
    }
}

/// Operations of the file transfer, as far as logs need them.
pub mod operation {
    /// ends a session
    pub const TERMINATE: u8 = 1;
    /// ends all sessions
    pub const RESET: u8 = 2;
    /// lists a folder from an entry on
    pub const LIST: u8 = 3;
    /// opens a file for reading
    pub const OPEN: u8 = 4;
    /// reads a piece
    pub const READ: u8 = 5;
    /// calculates the checksum of a file
    pub const CRC: u8 = 14;
    /// reads many pieces
    pub const BURST: u8 = 15;
    /// an answer
    pub const ACK: u8 = 128;
    /// a refusal
    pub const NAK: u8 = 129;
}

/// Why a vehicle refuses, as far as it matters here.
pub mod refusal {
    /// for no reason that is told
    pub const FAIL: u8 = 1;
    /// with an error number of the vehicle's system beside it
    pub const FAIL_ERRNO: u8 = 2;
    /// the session is not open
    pub const INVALID_SESSION: u8 = 4;
    /// there are no more sessions
    pub const NO_SESSIONS: u8 = 5;
    /// the file, or the list, ends here
    pub const END: u8 = 6;
    /// this operation is not known
    pub const UNKNOWN: u8 = 7;
    /// there is no such file
    pub const NOT_FOUND: u8 = 10;

    /// In words.
    #[must_use]
    pub fn words(code: u8) -> &'static str {
        match code {
            FAIL => "failed",
            FAIL_ERRNO => "an error of its file system",
            3 => "the size of the data is wrong",
            INVALID_SESSION => "the session is not open",
            NO_SESSIONS => "no session is free",
            END => "the file ends before",
            UNKNOWN => "the operation is not known",
            8 => "the file is there already",
            9 => "the file is protected",
            NOT_FOUND => "there is no such file",
            _ => "no reason that is known here",
        }
    }
}

/// One message of the file transfer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Transfer<'a> {
    /// counts requests; an answer has the next number
    pub sequence: u16,
    /// which file is open
    pub session: u8,
    /// what it is, see [`operation`]
    pub operation: u8,
    /// bytes of data that it has, or that are asked for
    pub size: u8,
    /// of an answer: what it answers
    pub answers: u8,
    /// of a burst: nothing more of it comes
    pub burst_complete: bool,
    /// where in the file, or in the list
    pub offset: u32,
    /// its data; of a message that came, `size` bytes at most
    pub data: &'a [u8],
}

impl<'a> Transfer<'a> {
    /// A request without data.
    #[must_use]
    pub fn request(sequence: u16, operation: u8) -> Self {
        Self {
            sequence,
            session: 0,
            operation,
            size: 0,
            answers: 0,
            burst_complete: false,
            offset: 0,
            data: &[],
        }
    }

    /// Reads the payload of a FILE_TRANSFER_PROTOCOL. Zeros at its end, which MAVLink 2 leaves out, may be missing.
    #[must_use]
    pub fn read(payload: Payload<'a>) -> Self {
        let at = |offset: usize| payload.u8(PAYLOAD_AT + offset);
        let begin = PAYLOAD_AT + HEADER_BYTES;
        let end = payload.0.len().min(PAYLOAD_AT + TRANSFER_BYTES);
        Self {
            sequence: payload.u16(PAYLOAD_AT),
            session: at(2),
            operation: at(3),
            size: at(4),
            answers: at(5),
            burst_complete: at(6) != 0,
            offset: payload.u32(PAYLOAD_AT + 8),
            data: payload.0.get(begin..end).unwrap_or(&[]),
        }
    }

    /// The data that it says it has, with the zeros that were left out; never more than a message holds.
    #[must_use]
    pub fn whole_data(&self) -> Vec<u8> {
        let size = usize::from(self.size).min(DATA_BYTES);
        let mut data = self.data.get(..size.min(self.data.len())).unwrap_or(&[]).to_vec();
        data.resize(size, 0);
        data
    }

    /// As the `payload` of a FILE_TRANSFER_PROTOCOL; data beyond what fits is left out.
    #[must_use]
    pub fn bytes(&self) -> [u8; TRANSFER_BYTES] {
        let mut bytes = [0; TRANSFER_BYTES];
        bytes[..2].copy_from_slice(&self.sequence.to_le_bytes());
        bytes[2..7].copy_from_slice(&[
            self.session,
            self.operation,
            self.size,
            self.answers,
            u8::from(self.burst_complete),
        ]);
        bytes[8..HEADER_BYTES].copy_from_slice(&self.offset.to_le_bytes());
        let fits = self.data.len().min(DATA_BYTES);
        bytes[HEADER_BYTES..HEADER_BYTES + fits].copy_from_slice(&self.data[..fits]);
        bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_also_without_the_zeros_at_its_end() {
        let data = [7, 8, 0, 0];
        let sent = Transfer {
            sequence: 0x1234,
            session: 3,
            size: 4,
            answers: operation::READ,
            burst_complete: true,
            offset: 0x0102_0304,
            data: &data,
            ..Transfer::request(0, operation::ACK)
        };
        let mut payload = vec![0, 1, 2];
        payload.extend(sent.bytes());
        let whole = Transfer::read(Payload(&payload));
        assert_eq!(whole.whole_data(), data);
        let cut = Transfer::read(Payload(&payload[..3 + 12 + 2]));
        assert_eq!(cut, Transfer { data: &data[..2], ..sent });
        assert_eq!(cut.whole_data(), data);
        // it says that it has more than it can have
        let lying = Transfer { size: 255, ..cut };
        assert_eq!(lying.whole_data().len(), DATA_BYTES);
        let empty = Transfer::read(Payload(&[]));
        assert_eq!((empty.sequence, empty.whole_data()), (0, Vec::new()));
    }

    #[test]
    fn the_checksum_is_that_of_both_autopilots() {
        // crc32part of NuttX and crc_crc32 of ArduPilot, beginning with nought
        assert_eq!(FileSum::of(b"123456789"), 0x2dfd_2d88);
        let mut sum = FileSum::default();
        sum.update(b"1234");
        sum.update(b"56789");
        assert_eq!(sum.value(), FileSum::of(b"123456789"));
    }
}
