//! Which fields and parameters tell where a flight was, of which hardware, or a key.

/// A coordinate on the Earth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coordinate {
    Latitude,
    Longitude,
}

/// Words of a name, in capitals, without digits at their ends: `SIH_LOC_LAT0` as `SIH`, `LOC`, `LAT`.
fn words(name: &str) -> Vec<String> {
    let parts = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|part| !part.is_empty());
    parts
        .map(|part| part.trim_end_matches(|letter: char| letter.is_ascii_digit()).to_ascii_uppercase())
        .collect()
}

/// The coordinate that a field or parameter of this name holds.
pub(super) fn coordinate(name: &str) -> Option<Coordinate> {
    for word in words(name) {
        match word.as_str() {
            "LAT" | "LATITUDE" | "TLAT" | "OLAT" => return Some(Coordinate::Latitude),
            "LON" | "LNG" | "LONGITUDE" | "TLNG" | "OLNG" => return Some(Coordinate::Longitude),
            _ => {}
        }
    }
    None
}

/// Whether a field of this name tells one piece of hardware from others of its kind, or one place from others: what the autopilot's table of
/// the magnetic field has for the place tells it to some metres.
pub(super) fn is_identity(name: &str) -> bool {
    let words = words(name);
    let has = |wanted: &str| words.iter().any(|word| word == wanted);
    let of_field = || has("DECLINATION") || has("DECL") || has("INCLINATION") || has("STRENGTH");
    has("MAG") && of_field()
        || has("UID")
        || has("UUID")
        // not the parameters of ArduPilot's guided mode, GUID_TIMEOUT and others
        || words.last().is_some_and(|word| word == "GUID")
        || has("ICAO")
        || has("DEVID")
        || has("SERIALNO")
        || (has("DEVICE") && (has("ID") || has("IDS")))
        || (has("SERIAL") && (has("NUMBER") || has("NUM") || has("NO")))
}

/// Whether a parameter of this name tells one piece of hardware from others, where it is, or holds a key.
pub(super) fn is_secret_parameter(name: &str) -> bool {
    let words = words(name);
    let last = words.last().map(String::as_str);
    // a pass-through of a serial port is none
    let is_port = words.first().is_some_and(|word| word == "SERIAL");
    let key = ["PASS", "PASSWD", "PASSWORD", "PASSPHRASE", "KEY", "SECRET", "TOKEN"];
    is_identity(name)
        || is_place(name, &words)
        || !is_port && words.iter().any(|word| key.contains(&word.as_str()))
        // CAL_ACC0_ID, COMPASS_PRIO1_ID, INS_ACC_ID; not MAV_SYS_ID and MAV_COMP_ID
        || (last == Some("ID") && words.len() > 2 && words[0] != "MAV")
}

/// Whether a parameter of this name and these words holds a place, or what is peculiar to one: the declination of the magnetic field,
/// and all of a simulation's start.
fn is_place(name: &str, words: &[String]) -> bool {
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    coordinate(name).is_some()
        || matches!(words[..], [.., "DECL" | "DECLINATION"] | ["COMPASS", "DEC"])
        || matches!(words[..], ["SIM", "OPOS", ..] | ["SIH", "LOC", ..] | ["AHRS", "ORIG" | "ORIGIN", ..])
}

/// Whether a text holds what may be a serial number, a key or a position: eight hexadecimal digits in a row, or a number with
/// four decimals.
pub(super) fn is_suspicious(text: &str) -> bool {
    let is_long = |word: &str| {
        let digits = word.chars().filter(|letter| letter.is_ascii_hexdigit()).count();
        digits >= 8 && digits == word.len() && word.chars().any(|letter| letter.is_ascii_digit())
    };
    let has_decimals = |word: &str| {
        let decimals =
            word.split_once('.').map(|(_, after)| after.chars().take_while(char::is_ascii_digit).count());
        decimals.is_some_and(|count| count >= 4)
    };
    text.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '.')
        .any(|word| is_long(word.trim_matches('.')) || has_decimals(word))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_what_they_hold() {
        for name in ["lat", "ref_lat", "latitude_deg", "SIH_LOC_LAT0", "Lat", "TLat"] {
            assert_eq!(coordinate(name), Some(Coordinate::Latitude), "{name}");
        }
        for name in ["lon", "Lng", "longitude", "SIM_OPOS_LNG"] {
            assert_eq!(coordinate(name), Some(Coordinate::Longitude), "{name}");
        }
        for name in ["lateral_acceleration", "alt", "LONGSHOT", "x"] {
            assert_eq!(coordinate(name), None, "{name}");
        }
        for name in [
            "device_id",
            "accel_device_ids",
            "sys_guid",
            "serial_number",
            "uid",
            "UID1",
            "mag_inclination_ref_deg",
            "mag_strength_ref_gs",
        ] {
            assert!(is_identity(name), "{name}");
        }
        for name in
            ["CAL_ACC0_ID", "COMPASS_DEV_ID2", "BRD_SERIAL_NUM", "NET_PASS", "SIM_OPOS_LAT", "INS_ACC_ID"]
        {
            assert!(is_secret_parameter(name), "{name}");
        }
        for name in [
            "EKF2_MAG_DECL",
            "ATT_MAG_DECL",
            "COMPASS_DEC",
            "SIM_OPOS_ALT",
            "SIM_OPOS_HDG",
            "SIH_LOC_MU_X",
            "AHRS_ORIG_LAT",
            "BCN_LONGITUDE",
            "LPE_LAT",
        ] {
            assert!(is_secret_parameter(name), "{name}");
        }
        for name in ["EKF2_DECL_TYPE", "EKF2_MAG_TYPE", "COMPASS_AUTODEC", "MPC_DEC_HOR_SLOW", "FENCE_RADIUS"]
        {
            assert!(!is_secret_parameter(name), "{name}");
        }
        for name in [
            "SERIAL0_BAUD",
            "SERIAL_PASS2",
            "MAV_SYS_ID",
            "MAV_COMP_ID",
            "MPC_THR_HOVER",
            "CA_ROTOR0_PX",
            "SYSID_THISMAV",
            "MAV_TYPE",
            "MOT_PWM_MAX",
        ] {
            assert!(!is_secret_parameter(name), "{name}");
        }
        assert!(
            is_suspicious("CubeOrange 00340025 3433510A 30303939") && is_suspicious("home at 47.3977 8.5456")
        );
        assert!(!is_suspicious("EKF3 IMU0 is using GPS") && !is_suspicious("Throttle 0.25 at 12.6 V"));
    }
}
