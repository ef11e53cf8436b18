//! Addresses of files in stores.

use super::error::StoreError;
use crate::text;

/// Schemes of addresses that are no paths of this computer.
const SCHEMES: [&str; 8] = ["s3", "s3a", "gs", "az", "abfs", "abfss", "http", "https"];
/// Letters that make a pattern of a name.
const PATTERN: [char; 3] = ['*', '?', '['];

/// Whether it is the address of something in a store, and no path.
#[must_use]
pub fn is_remote(given: &str) -> bool {
    given.split_once("://").is_some_and(|(scheme, _)| SCHEMES.contains(&scheme))
}

/// An address in its parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Address {
    /// scheme and host, bucket or container: `s3://flights`
    pub root: String,
    /// what follows, without the slash between; empty: all of it
    pub name: String,
    /// it ends with a slash: a folder, whatever is there
    pub is_folder: bool,
}

impl Address {
    /// The parts of an address.
    ///
    /// # Errors
    /// [`StoreError::Address`] where it names no bucket, container or host, or holds a query.
    pub fn of(given: &str) -> Result<Self, StoreError> {
        let refused = |came: &str| StoreError::Address { address: text::clean(given), came: came.to_owned() };
        let (scheme, rest) = given.split_once("://").ok_or_else(|| refused("none"))?;
        let (host, name) = rest.split_once('/').unwrap_or((rest, ""));
        if !is_remote(given) {
            return Err(refused(&format!("an address of `{}`", text::clean(scheme))));
        }
        if host.is_empty() {
            return Err(refused("an address without a bucket, container or host"));
        }
        if scheme.starts_with("http") && name.contains(['?', '#']) {
            return Err(refused("an address with a query, which is not sent"));
        }
        // what is asked for stands in the tables
        if scheme.starts_with("http") && host.contains('@') {
            let address = format!("{scheme}://...@{}", host.rsplit('@').next().unwrap_or_default());
            return Err(StoreError::Address { address, came: "one with a user or a password".to_owned() });
        }
        let is_folder = name.is_empty() || name.ends_with('/');
        let name = name.trim_matches('/').to_owned();
        Ok(Self { root: format!("{scheme}://{host}"), name, is_folder })
    }

    /// A web server has it.
    #[must_use]
    pub fn is_of_web(&self) -> bool {
        self.root.starts_with("http")
    }

    /// Of a pattern the folder below which all that fits it lies, and the pattern; `None`: it is no pattern.
    #[must_use]
    pub fn pattern(&self) -> Option<(Self, String)> {
        let at = self.name.find(PATTERN)?;
        let folder = self.name[..at].rsplit_once('/').map_or("", |(folder, _)| folder);
        let below = Self { name: folder.to_owned(), is_folder: true, ..self.clone() };
        Some((below, self.name.clone()))
    }

    /// The address of a file by its name below the root.
    #[must_use]
    pub fn uri_of(&self, name: &str) -> String {
        format!("{}/{name}", self.root)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_fall_into_their_parts() {
        let of = |given: &str| Address::of(given).unwrap();
        let logs = of("s3://flights/2026/logs/");
        assert_eq!(
            (logs.root.as_str(), logs.name.as_str(), logs.is_folder),
            ("s3://flights", "2026/logs", true)
        );
        assert_eq!(logs.uri_of("2026/logs/a.ulg"), "s3://flights/2026/logs/a.ulg");
        assert!(of("gs://flights").is_folder && !of("https://host:8080/a.ulg").is_folder);
        let (below, pattern) = of("az://logs/2026/*/a?.ulg").pattern().unwrap();
        assert_eq!((below.name.as_str(), pattern.as_str()), ("2026", "2026/*/a?.ulg"));
        assert_eq!(of("s3://flights/a.ulg").pattern(), None);
    }

    #[test]
    fn what_is_no_address_is_told() {
        for (given, came) in [
            ("ftp://host/a", "an address of `ftp`"),
            ("s3:///a", "without a bucket"),
            ("https://host/a.ulg?signature=x", "with a query"),
            ("logs/a.ulg", "got none"),
            ("https://me:secret@host/a.ulg", "https://...@host: "),
        ] {
            let error = Address::of(given).unwrap_err().to_string();
            assert!(error.contains(came) && !error.contains("secret"), "{error}");
        }
        assert!(
            is_remote("s3://x/y") && !is_remote("file:///x") && !is_remote("C://x") && !is_remote("logs/*")
        );
    }
}
