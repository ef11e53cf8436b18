//! What was played, and what was held back.

/// What was played.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ReplayCounts {
    /// frames played
    pub frames: u64,
    /// frames held back
    pub held_back: HeldBack,
    /// frames that had nobody to go to
    pub unsent: u64,
    /// frames that the other end sent; nobody acted on them
    pub discarded: u64,
}

/// Frames of a log that are not played, by the first reason that holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct HeldBack {
    /// no autopilot sent them: ground stations, companions, cameras, radios
    pub not_of_an_autopilot: u64,
    /// nobody here knows what they say
    pub unknown: u64,
    /// known, and not on the list of telemetry: whoever hears them may act upon them
    pub not_telemetry: u64,
}

impl HeldBack {
    /// All of them.
    #[must_use]
    pub fn total(self) -> u64 {
        self.not_of_an_autopilot + self.unknown + self.not_telemetry
    }
}
