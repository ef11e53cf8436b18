//! What became of the frames of a recording.

/// What became of the frames.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct RecorderStatus {
    /// frames in the file: the system took all their bytes
    pub frames: u64,
    /// their bytes, stamps included
    pub bytes: u64,
    /// frames lost: the disk failed, or was slow for too long
    pub dropped: u64,
    /// frames in the file of which the system could not say that they are on the disk: what a power loss takes, and
    /// on some file systems a full disk
    pub doubtful: u64,
    /// SETUP_SIGNING frames left out, since they carry the signing key
    pub redacted: u64,
    /// what the system last said when writing failed; `None` while it works
    pub failure: Option<String>,
}

impl RecorderStatus {
    /// Every frame is in the file, and it is on the disk.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.dropped == 0 && self.doubtful == 0 && self.failure.is_none()
    }
}
