//! Flight modes: their numbers on the wire, their names, and who flies.

/// What a flight asks a vehicle to be in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mode {
    /// flies our setpoints: PX4 OFFBOARD, ArduCopter GUIDED
    External,
    /// stops where it is: PX4 AUTO.LOITER ("Hold"), ArduCopter BRAKE
    Hold,
    /// lands where it is
    Land,
    /// flies home and lands
    Return,
}

/// Whose wishes a mode follows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FlownBy {
    /// the sticks of a transmitter
    Pilot,
    /// the autopilot itself
    Autopilot,
    /// setpoints of a program: a companion computer or a ground station
    Companion,
}

/// How `custom_mode` comes from the parameters of `MAV_CMD_DO_SET_MODE`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Numbering {
    /// main mode in bits 16 to 23 and sub mode in bits 24 to 31: the second and the third parameter
    MainAndSub,
    /// the number itself: the second parameter
    Whole,
}

impl Numbering {
    /// `custom_mode` of a main and a sub mode.
    #[must_use]
    pub const fn number(self, main: u8, sub: u8) -> u32 {
        match self {
            Self::MainAndSub => (main as u32) << 16 | (sub as u32) << 24,
            Self::Whole => main as u32,
        }
    }

    /// Main and sub mode of a `custom_mode`: [`Self::number`] of both is the number again.
    #[must_use]
    pub const fn parts(self, number: u32) -> (u8, u8) {
        let [low, _, main, sub] = number.to_le_bytes();
        match self {
            Self::MainAndSub => (main, sub),
            Self::Whole => (low, 0),
        }
    }
}

/// One mode of a multirotor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FlightMode {
    /// `custom_mode` of HEARTBEAT and CURRENT_MODE
    pub number: u32,
    /// in the autopilot's sources
    pub name: &'static str,
    /// what the autopilot and ground stations show
    pub title: &'static str,
    /// who flies
    pub flown_by: FlownBy,
    /// value of the parameters of a mode switch (COM_FLTMODE1, FLTMODE1 and on); `None` where no switch leads to it
    pub switch: Option<i32>,
}

/// The modes that a flight asks for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Wishes {
    /// [`Mode::External`]
    pub external: FlightMode,
    /// [`Mode::Hold`]
    pub hold: FlightMode,
    /// [`Mode::Land`]
    pub land: FlightMode,
    /// [`Mode::Return`]
    pub home: FlightMode,
}

impl Wishes {
    /// The mode of a wish.
    #[must_use]
    pub const fn of(&self, wish: Mode) -> &FlightMode {
        match wish {
            Mode::External => &self.external,
            Mode::Hold => &self.hold,
            Mode::Land => &self.land,
            Mode::Return => &self.home,
        }
    }
}
