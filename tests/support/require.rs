//! What a test does where something that it compares with is missing.
//!
//! Without more said, the test prints `skipped: ...` and passes. The environment variable `MAVID_REQUIRE` names, by commas,
//! what has to be there: a test that lacks one of these fails.

#![allow(dead_code, clippy::panic, clippy::print_stderr)] // no user uses all of it

/// What a test can lack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Needed {
    /// Python with the packages of `tests/peers/setup.sh`
    Peers,
    /// MAVSDK, which is not to be had for every platform
    Mavsdk,
    /// MuJoCo, which is not to be had for every platform
    Mujoco,
    /// DuckDB, Polars, pandas, PyArrow and mcap, which are not to be had for every platform
    Tables,
    /// the folder of shared recordings
    Shared,
    /// a loopback address of IPv6
    Ipv6,
    /// headless Chromium of `tests/browser/setup.sh`
    Browser,
}

impl Needed {
    pub const ALL: [Self; 7] =
        [Self::Peers, Self::Mavsdk, Self::Mujoco, Self::Tables, Self::Shared, Self::Ipv6, Self::Browser];

    /// As `MAVID_REQUIRE` names it.
    pub fn word(self) -> &'static str {
        match self {
            Self::Peers => "peers",
            Self::Mavsdk => "mavsdk",
            Self::Mujoco => "mujoco",
            Self::Tables => "tables",
            Self::Shared => "shared",
            Self::Ipv6 => "ipv6",
            Self::Browser => "browser",
        }
    }
}

/// Says why a test asserts nothing here.
///
/// # Panics
/// Where `MAVID_REQUIRE` asks for what is missing.
pub fn skip(needed: Needed, why: &str) {
    let required = std::env::var("MAVID_REQUIRE").unwrap_or_default();
    match judge(needed, why, &required) {
        // past the capture of the test harness, which would hide it in a test that passes
        Ok(line) => {
            let _ = std::io::Write::write_all(&mut std::io::stderr(), format!("{line}\n").as_bytes());
        }
        Err(failure) => panic!("{failure}"),
    }
}

/// The line to print, or the failure, where `required` is what `MAVID_REQUIRE` holds.
pub fn judge(needed: Needed, why: &str, required: &str) -> Result<String, String> {
    let words = || required.split(',').map(str::trim).filter(|word| !word.is_empty());
    if let Some(unknown) = words().find(|word| Needed::ALL.iter().all(|needed| needed.word() != *word)) {
        let expected = Needed::ALL.map(Needed::word).join(", ");
        return Err(format!("MAVID_REQUIRE: expected words out of {expected}, found `{unknown}`"));
    }
    if words().any(|word| word == needed.word()) {
        return Err(format!("MAVID_REQUIRE asks for `{}`, which is missing: {why}", needed.word()));
    }
    Ok(format!("skipped: {why}"))
}
