//! The secret.

use std::fmt;
use std::path::Path;

use sha2::{Digest, Sha256};

use super::error::SigningError;
use super::owner;

const KEY_BYTES: usize = 32;

/// The secret that signs. It is never shown.
#[derive(Clone, PartialEq, Eq)]
pub struct SigningKey([u8; KEY_BYTES]);

impl fmt::Debug for SigningKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("SigningKey(..)")
    }
}

impl SigningKey {
    /// The key of these bytes.
    #[must_use]
    pub fn from_bytes(bytes: [u8; KEY_BYTES]) -> Self {
        Self(bytes)
    }

    /// The key of a passphrase: its SHA-256, as Mission Planner, QGroundControl and MAVProxy do.
    #[must_use]
    pub fn from_passphrase(passphrase: &str) -> Self {
        Self(Sha256::digest(passphrase.as_bytes()).into())
    }

    /// The key in a file, which holds one of
    /// - 64 hexadecimal digits, white space around them does not count;
    /// - 32 bytes, not all of them printable ASCII;
    /// - any other UTF-8 text: a passphrase, without the line's end. 32 or more hexadecimal digits are a key that was cut,
    ///   and 62 to 66 characters of which most are such digits one that was mistyped, not a passphrase.
    ///
    /// # Errors
    /// The file cannot be read, holds none of these, or a key of zeros.
    pub fn read(path: &Path) -> Result<Self, SigningError> {
        let bytes = std::fs::read(path).map_err(|source| SigningError::File {
            what: "read",
            path: path.into(),
            source,
        })?;
        let error = |got| SigningError::Key { path: path.into(), got };
        let key = Self::parse(&bytes).map_err(error)?;
        // by a key of zeros SETUP_SIGNING switches signing off: a vehicle with it believes everybody
        if key.0 == [0; KEY_BYTES] {
            Err(error("zeros, which autopilots treat as no key".to_owned()))
        } else {
            Ok(key)
        }
    }

    /// A warning where others than its owner may read or write a key's file.
    #[must_use]
    pub fn exposure(path: &Path) -> Option<String> {
        owner::exposure(path)
    }

    fn parse(bytes: &[u8]) -> Result<Self, String> {
        let printable = bytes.iter().all(|byte| matches!(byte, b' '..=b'~' | b'\r' | b'\n' | b'\t'));
        if !printable && let Ok(raw) = <[u8; KEY_BYTES]>::try_from(bytes) {
            return Ok(Self(raw));
        }
        let text = std::str::from_utf8(bytes).map_err(|_| "not 32 bytes, and not a text".to_owned())?;
        if let Some(key) = from_hex(text.trim()) {
            return Ok(Self(key));
        }
        if let Some(mistyped) = mistyped(text.trim()) {
            return Err(mistyped);
        }
        match text.trim_end_matches(['\r', '\n']) {
            "" => Err("nothing".to_owned()),
            cut if cut.len() >= KEY_BYTES && cut.bytes().all(|byte| byte.is_ascii_hexdigit()) => {
                Err("hexadecimal digits, but not 64 of them".to_owned())
            }
            passphrase if passphrase.contains(['\r', '\n']) => Err("several lines".to_owned()),
            passphrase => Ok(Self::from_passphrase(passphrase)),
        }
    }

    pub(super) fn bytes(&self) -> &[u8; KEY_BYTES] {
        &self.0
    }
}

fn from_hex(text: &str) -> Option<[u8; KEY_BYTES]> {
    let digits = text.as_bytes();
    if digits.len() != 2 * KEY_BYTES {
        return None;
    }
    let mut key = [0; KEY_BYTES];
    for (byte, pair) in key.iter_mut().zip(digits.chunks_exact(2)) {
        let digit = |at: usize| char::from(pair[at]).to_digit(16).and_then(|digit| u8::try_from(digit).ok());
        *byte = digit(0)? << 4 | digit(1)?;
    }
    Some(key)
}

/// Characters by which a typed key may be too long or too short.
const SLIPS: usize = 2;
/// Of so many characters of a mistyped key one at most is no hexadecimal digit.
const DIGITS_A_SLIP: usize = 8;

/// What is wrong with a text that was hardly meant for anything but 64 hexadecimal digits.
fn mistyped(text: &str) -> Option<String> {
    let count = text.chars().count();
    let wrong = || text.chars().enumerate().filter(|(_, letter)| !letter.is_ascii_hexdigit());
    let (first, letter) = wrong().next()?;
    let wrong = wrong().count();
    let is_key = count.abs_diff(2 * KEY_BYTES) <= SLIPS && wrong * DIGITS_A_SLIP <= count;
    is_key.then(|| {
        let others = if wrong > 1 { format!(" (and {} more)", wrong - 1) } else { String::new() };
        let letter = letter.escape_debug();
        format!(
            "{count} characters, of which number {} is `{letter}`, no hexadecimal digit{others}",
            first + 1
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_of_digits_that_was_mistyped_is_no_passphrase() {
        let hex = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
        for (typed, said) in [
            (
                hex.replacen("ea41", "eg41", 1),
                "64 characters, of which number 16 is `g`, no hexadecimal digit",
            ),
            (format!(" {}\n", hex.replace('0', "O")), "number 11 is `O`, no hexadecimal digit (and 6 more)"),
            (format!("0x{hex}"), "66 characters, of which number 2 is `x`"),
            (hex.replacen("bf8f", "b\u{1b}f8f", 1), "number 8 is `\\u{1b}`"),
            (hex[1..].to_owned(), "hexadecimal digits, but not 64 of them"),
        ] {
            let refused = SigningKey::parse(typed.as_bytes()).unwrap_err();
            assert!(refused.contains(said), "{typed}: {refused}");
        }
        // words, and what is made of digits for another purpose
        for passphrase in [
            "the quick brown fox jumps over the lazy dog and then is off home",
            "550e8400-e29b-41d4-a716-446655440000",
        ] {
            assert_eq!(SigningKey::parse(passphrase.as_bytes()), Ok(SigningKey::from_passphrase(passphrase)));
        }
    }

    #[test]
    fn a_key_file_is_raw_hexadecimal_or_a_passphrase() {
        let raw: [u8; 32] = std::array::from_fn(|index| u8::try_from(7 * index).unwrap());
        assert_eq!(SigningKey::parse(&raw).unwrap(), SigningKey(raw));
        let hex: String = raw.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(
            SigningKey::parse(format!("  {}\n", hex.to_uppercase()).as_bytes()).unwrap(),
            SigningKey(raw)
        );
        // SHA-256 of "abc", FIPS 180-2
        let abc = from_hex("ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad").unwrap();
        assert_eq!(SigningKey::parse(b"abc\r\n").unwrap(), SigningKey(abc));
        let words = b"a passphrase of 32 characters ..";
        assert_eq!((words.len(), SigningKey::parse(words).unwrap().0 == *words), (32, false));
        for wrong in [&b""[..], b"\n", b"two\nlines\n", &[0xFF; 31], &[b'a'; 62]] {
            assert!(SigningKey::parse(wrong).is_err(), "{wrong:?}");
        }
        assert_eq!(format!("{:?}", SigningKey(abc)), "SigningKey(..)");
    }

    #[test]
    fn a_key_of_zeros_is_none() {
        let path = std::env::temp_dir().join(format!("mavid-zeros-{}", std::process::id()));
        for zeros in [vec![0; 32], vec![b'0'; 64]] {
            std::fs::write(&path, zeros).unwrap();
            let refused = SigningKey::read(&path).unwrap_err().to_string();
            assert!(refused.contains("got zeros, which autopilots treat as no key"), "{refused}");
        }
        std::fs::remove_file(path).unwrap();
    }
}
