//! Puts every sample on the vehicle's own clock.
//!
//! Messages stamp in three ways: time since boot (milliseconds or microseconds, 32 bits of it or 64), Unix
//! time, or not at all. The first that is seen makes the recording's clock and its first stamp is zero; the
//! others are tied to it once. Messages without a stamp are placed by the host's stamp: with the difference
//! between host and vehicle of the frame just before where both arrived in one burst, for these were sent
//! together and share their latency, else with the median of the last differences. Both follow a vehicle
//! whose clock runs slow or fast against the host's, and a host whose clock is set while the vehicle's continues.

/// Differences that the median is taken over; odd.
const WINDOW: usize = 31;
/// Frames that arrive this close together were sent together.
const BURST_US: u64 = 2000;
/// A difference this far from the median is of a message that was old when it was sent.
const OLD_US: u64 = 50_000;
/// A difference that changes by more than this from one stamped message to the next, us: the host's clock was set. No link
/// holds a message back for so long.
pub const HOST_STEP_US: u64 = 10_000_000;
/// Host's stamps further apart than this, us, either way, say nothing of the time that passed until the vehicle's do.
pub const HOST_LEAP_US: u64 = 3_600_000_000;
/// Stamps of different messages may run back against each other by this much.
pub const BACKWARD_US: i64 = 2_000_000;
/// A leap forward beyond this must be matched by the host's clock.
const FORWARD_US: i64 = 5_000_000;
/// So many stamps in a row that agree with each other but not with the clock: the clock has restarted.
pub const WITNESSES: u8 = 3;
/// A vehicle that starts anew may have run this much longer than it was silent: links buffer.
const BOOT_US: i64 = 10_000_000;
/// Microseconds larger than this are Unix time (2001), not time since boot (31 years).
const UNIX_FROM_US: u64 = 1_000_000_000_000_000;
const WRAP_MS_US: i64 = (1 << 32) * 1000;
const WRAP_US: i64 = 1 << 32;

/// A message's own time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stamp {
    /// none
    Absent,
    /// milliseconds since boot, 32 bits (wraps after 49.7 days)
    BootMs(u32),
    /// microseconds since boot, 32 bits (wraps after 71.6 minutes)
    BootUs32(u32),
    /// microseconds since boot or since 1970 UTC
    Us(u64),
}

impl Stamp {
    /// As it stands, s; zero where there is none.
    #[must_use]
    pub fn seconds(self) -> f64 {
        match self {
            Self::Absent => 0.0,
            Self::BootMs(ms) => f64::from(ms) * 1e-3,
            Self::BootUs32(us) => f64::from(us) * 1e-6,
            Self::Us(us) => us as f64 * 1e-6,
        }
    }
}

/// Which clock a stamp is of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Base {
    Boot,
    Unix,
}

/// First stamp of the vehicle and the host's stamp beside it: where the recording's clock is zero.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Anchor {
    stamp: Stamp,
    host_us: i64,
}

impl Anchor {
    /// An anchor for a stamp; `None` for one that cannot anchor: none at all, or one that may have
    /// wrapped unseen.
    #[must_use]
    pub fn new(stamp: Stamp, host_us: i64) -> Option<Self> {
        match stamp {
            Stamp::Absent | Stamp::BootUs32(_) | Stamp::Us(0) => None,
            Stamp::BootMs(_) | Stamp::Us(_) => Some(Self { stamp, host_us }),
        }
    }
}

/// Where a message falls on the recording's clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Placed {
    /// microseconds since the recording's start
    At(i64),
    /// the same, and the vehicle's clock restarted here
    Restarted(i64),
    /// the stamp fits neither the clock nor a new one (so far): drop the message
    Stale,
}

/// One of the vehicle's clocks tied to the recording's.
#[derive(Debug, Clone, Copy)]
struct Tied {
    /// add to the raw stamp to get recording time
    offset_us: i64,
    last_raw_us: i64,
    last_host_us: i64,
    suspect_raw_us: i64,
    suspects: u8,
}

/// The recording's clock.
#[derive(Debug, Clone)]
pub struct VehicleClock {
    boot: Option<Tied>,
    unix: Option<Tied>,
    unix_minus_boot_us: Option<i64>,
    host_minus_time_us: [i64; WINDOW],
    differences: usize,
    start_host_us: i64,
    last_host_us: i64,
    last_time_us: i64,
    /// host's stamp of the last message of any kind
    heard_host_us: Option<i64>,
    /// host's stamp of the first message after a leap that no stamped message has explained yet
    adrift_host_us: Option<i64>,
    host_steps: u64,
    /// restarts to a time since boot that has not passed since the message before
    ran_back: u64,
    ran_back_most_us: u64,
}

impl VehicleClock {
    /// A clock that is zero at the anchor. Without an anchor it is zero at `start_host_us` of the host.
    #[must_use]
    pub fn new(anchor: Option<Anchor>, start_host_us: i64) -> Self {
        let mut clock = Self {
            boot: None,
            unix: None,
            unix_minus_boot_us: None,
            host_minus_time_us: [0; WINDOW],
            differences: 0,
            start_host_us: anchor.map_or(start_host_us, |anchor| anchor.host_us),
            last_host_us: i64::MIN,
            last_time_us: 0,
            heard_host_us: None,
            adrift_host_us: None,
            host_steps: 0,
            ran_back: 0,
            ran_back_most_us: 0,
        };
        match anchor {
            Some(Anchor { stamp: Stamp::BootMs(ms), host_us }) => {
                clock.boot = Some(Tied::new(i64::from(ms) * 1000, 0, host_us));
            }
            Some(Anchor { stamp: Stamp::Us(us), host_us }) => {
                let raw_us = i64::try_from(us).unwrap_or(0);
                *clock.tied(base_of(us)) = Some(Tied::new(raw_us, 0, host_us));
            }
            _ => {}
        }
        clock
    }

    /// A pair of Unix time and time since boot that the vehicle sent itself (SYSTEM_TIME).
    pub fn note_pair(&mut self, unix_us: u64, boot_ms: u32) {
        if unix_us > UNIX_FROM_US && self.unix_minus_boot_us.is_none() {
            self.unix_minus_boot_us =
                i64::try_from(unix_us).ok().map(|unix| unix - i64::from(boot_ms) * 1000);
        }
    }

    /// Places a message by its own stamp, or by the host's where it has none.
    pub fn place(&mut self, stamp: Stamp, host_us: i64) -> Placed {
        let heard_us = self.heard_host_us.replace(host_us);
        if self.differences > 0 && heard_us.is_some_and(|heard| heard.abs_diff(host_us) > HOST_LEAP_US) {
            self.adrift_host_us = Some(host_us);
        }
        match stamp {
            Stamp::Absent | Stamp::Us(0) => Placed::At(self.at_host(host_us)),
            Stamp::BootMs(ms) => {
                let raw_us = self.unwrapped(i64::from(ms) * 1000, WRAP_MS_US);
                self.advance(Base::Boot, raw_us, host_us)
            }
            Stamp::BootUs32(us) => {
                let raw_us = self.unwrapped(i64::from(us), WRAP_US);
                self.advance(Base::Boot, raw_us, host_us)
            }
            Stamp::Us(us) => match i64::try_from(us) {
                Ok(raw_us) => self.advance(base_of(us), raw_us, host_us),
                Err(_) => Placed::Stale,
            },
        }
    }

    /// How often the host's clock was set while the vehicle's continued.
    #[must_use]
    pub fn host_steps(&self) -> u64 {
        self.host_steps
    }

    /// How often the time since boot ran back to one that had not passed since the message before, and by how much at most,
    /// microseconds: that is no restart, but messages in another order.
    #[must_use]
    pub fn ran_back(&self) -> (u64, u64) {
        (self.ran_back, self.ran_back_most_us)
    }

    /// Recording time of a host stamp, microseconds.
    #[must_use]
    pub fn at_host(&self, host_us: i64) -> i64 {
        if let Some(leapt_us) = self.adrift_host_us {
            // hours may have passed, or the clock was set: time continues from where it was until a stamp tells
            return self.last_time_us.saturating_add(host_us.saturating_sub(leapt_us).max(0));
        }
        let known = self.differences.min(WINDOW);
        if known == 0 {
            return host_us.saturating_sub(self.start_host_us);
        }
        let mut differences = self.host_minus_time_us;
        let differences = &mut differences[..known];
        let (_, median, _) = differences.select_nth_unstable(known / 2);
        let newest = self.host_minus_time_us[(self.differences - 1) % WINDOW];
        let in_burst = host_us.abs_diff(self.last_host_us) < BURST_US && newest.abs_diff(*median) < OLD_US;
        host_us.saturating_sub(if in_burst { newest } else { *median })
    }

    fn tied(&mut self, base: Base) -> &mut Option<Tied> {
        match base {
            Base::Boot => &mut self.boot,
            Base::Unix => &mut self.unix,
        }
    }

    /// The whole time since boot of a stamp that keeps only what is left after `modulus_us`: the one
    /// nearest to the last stamp.
    fn unwrapped(&self, raw_us: i64, modulus_us: i64) -> i64 {
        let Some(boot) = self.boot else { return raw_us };
        let behind_us = boot.last_raw_us.saturating_sub(raw_us).saturating_add(modulus_us / 2);
        raw_us.saturating_add(behind_us.div_euclid(modulus_us).max(0).saturating_mul(modulus_us))
    }

    fn advance(&mut self, base: Base, raw_us: i64, host_us: i64) -> Placed {
        let Some(tied) = *self.tied(base) else { return self.tie(base, raw_us, host_us) };
        if tied.continues_with(raw_us, host_us) {
            let time_us = raw_us.saturating_add(tied.offset_us);
            *self.tied(base) = Some(Tied {
                last_raw_us: raw_us.max(tied.last_raw_us),
                last_host_us: host_us,
                suspects: 0,
                ..tied
            });
            self.note(time_us, host_us);
            return Placed::At(time_us);
        }
        let suspects =
            if tied.suspects > 0 && raw_us.abs_diff(tied.suspect_raw_us) < BACKWARD_US.unsigned_abs() {
                tied.suspects + 1
            } else {
                1
            };
        if suspects < WITNESSES {
            *self.tied(base) = Some(Tied { suspects, suspect_raw_us: raw_us, ..tied });
            return Placed::Stale;
        }
        self.restart(base, raw_us, host_us)
    }

    /// First stamp of a clock: tied by what the vehicle said, else by the host's stamps.
    fn tie(&mut self, base: Base, raw_us: i64, host_us: i64) -> Placed {
        let said = self.unix_minus_boot_us.and_then(|difference| match base {
            Base::Unix => Some(self.boot?.offset_us.saturating_sub(difference)),
            Base::Boot => Some(self.unix?.offset_us.saturating_add(difference)),
        });
        let time_us =
            said.map_or_else(|| self.at_host(host_us), |offset_us| raw_us.saturating_add(offset_us));
        *self.tied(base) = Some(Tied::new(raw_us, time_us, host_us));
        self.note(time_us, host_us);
        Placed::At(time_us)
    }

    /// The vehicle's clock restarted: time advances by what passed on the host's clock.
    fn restart(&mut self, base: Base, raw_us: i64, host_us: i64) -> Placed {
        let last_host_us = self.tied(base).map_or(host_us, |tied| tied.last_host_us);
        let passed_us = host_us.saturating_sub(last_host_us).max(1000);
        let back_us = self.tied(base).map_or(0, |tied| tied.last_raw_us.saturating_sub(raw_us));
        if base == Base::Boot && back_us > 0 && raw_us > passed_us.saturating_add(BOOT_US) {
            self.ran_back += 1;
            self.ran_back_most_us = self.ran_back_most_us.max(back_us.unsigned_abs());
        }
        let time_us = self.last_time_us.saturating_add(passed_us);
        if base == Base::Boot {
            self.unix = None;
            self.unix_minus_boot_us = None;
        }
        *self.tied(base) = Some(Tied::new(raw_us, time_us, host_us));
        self.differences = 0;
        self.note(time_us, host_us);
        Placed::Restarted(time_us)
    }

    fn note(&mut self, time_us: i64, host_us: i64) {
        let difference_us = host_us.saturating_sub(time_us);
        if self.differences > 0 {
            let newest = self.host_minus_time_us[(self.differences - 1) % WINDOW];
            if newest.abs_diff(difference_us) > HOST_STEP_US {
                self.host_steps += 1;
                self.differences = 0;
            }
        }
        self.adrift_host_us = None;
        self.last_time_us = self.last_time_us.max(time_us);
        self.last_host_us = host_us;
        self.host_minus_time_us[self.differences % WINDOW] = difference_us;
        self.differences += 1;
    }
}

impl Tied {
    fn new(raw_us: i64, time_us: i64, host_us: i64) -> Self {
        Self {
            offset_us: time_us.saturating_sub(raw_us),
            last_raw_us: raw_us,
            last_host_us: host_us,
            suspect_raw_us: 0,
            suspects: 0,
        }
    }

    /// Whether a stamp continues where the last one was: not far back, and not far ahead of what passed on
    /// the host's clock.
    fn continues_with(&self, raw_us: i64, host_us: i64) -> bool {
        let passed_us = raw_us.saturating_sub(self.last_raw_us);
        let host_passed_us = host_us.saturating_sub(self.last_host_us).max(0);
        passed_us > -BACKWARD_US && passed_us < host_passed_us.saturating_mul(2).saturating_add(FORWARD_US)
    }
}

fn base_of(us: u64) -> Base {
    if us > UNIX_FROM_US { Base::Unix } else { Base::Boot }
}
