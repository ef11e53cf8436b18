//! Every dependency may be used under a permissive licence or MPL-2.0.

use std::process::Command;

/// Licences under which the program may be built and passed on: the list of deny.toml, which cargo-deny reads too.
fn accepted() -> Vec<String> {
    let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/deny.toml")).unwrap();
    let deny: toml::Table = toml::from_str(&text).unwrap();
    let allowed = deny["licenses"]["allow"].as_array().unwrap().iter();
    allowed.map(|name| name.as_str().unwrap().to_owned()).collect()
}

/// A licence expression (SPDX, or the older form with `/` for OR), read from left to right.
struct Expression<'a> {
    accepted: &'a [String],
    words: Vec<String>,
    at: usize,
}

impl<'a> Expression<'a> {
    fn new(text: &str, accepted: &'a [String]) -> Self {
        let spaced = text.replace('(', " ( ").replace(')', " ) ").replace('/', " OR ");
        Self { accepted, words: spaced.split_whitespace().map(str::to_owned).collect(), at: 0 }
    }

    fn take(&mut self, word: &str) -> bool {
        let found = self.words.get(self.at).is_some_and(|next| next == word);
        self.at += usize::from(found);
        found
    }

    /// `a OR b`, weaker than AND.
    fn any(&mut self) -> Option<bool> {
        let mut satisfied = self.all()?;
        while self.take("OR") {
            satisfied |= self.all()?;
        }
        Some(satisfied)
    }

    /// `a AND b`
    fn all(&mut self) -> Option<bool> {
        let mut satisfied = self.one()?;
        while self.take("AND") {
            satisfied &= self.one()?;
        }
        Some(satisfied)
    }

    /// A name, perhaps WITH an exception (which only adds permissions), or a bracket.
    fn one(&mut self) -> Option<bool> {
        if self.take("(") {
            let satisfied = self.any()?;
            return self.take(")").then_some(satisfied);
        }
        let name = self.words.get(self.at)?.clone();
        self.at += 1;
        if ["OR", "AND", "WITH", ")"].contains(&name.as_str()) {
            return None;
        }
        if self.take("WITH") {
            self.words.get(self.at)?;
            self.at += 1;
        }
        Some(self.accepted.iter().any(|known| known == name.trim_end_matches('+')))
    }
}

/// `None` where the text is no licence expression.
fn is_accepted(text: &str, accepted: &[String]) -> Option<bool> {
    let mut expression = Expression::new(text, accepted);
    let satisfied = expression.any()?;
    (expression.at == expression.words.len()).then_some(satisfied)
}

/// The packages of the lock file, for all platforms, or for this one where only its packages are at hand.
fn metadata() -> serde_json::Value {
    let rustc =
        Command::new(std::env::var_os("RUSTC").unwrap_or("rustc".into())).arg("-vV").output().unwrap();
    let version = String::from_utf8(rustc.stdout).unwrap();
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).unwrap();
    let run = |further: &[&str]| {
        Command::new(std::env::var_os("CARGO").unwrap_or("cargo".into()))
            .args(["metadata", "--format-version", "1", "--offline", "--locked", "--manifest-path"])
            .arg(concat!(env!("CARGO_MANIFEST_DIR"), "/Cargo.toml"))
            .args(further)
            .output()
            .unwrap()
    };
    let mut output = run(&[]);
    if !output.status.success() {
        output = run(&["--filter-platform", host]);
    }
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn every_dependency_is_free_to_use() {
    let metadata = metadata();
    let packages = metadata["packages"].as_array().unwrap();
    assert!(packages.len() > 20, "{}", packages.len());
    let accepted = accepted();
    let mut offenders = Vec::new();
    for package in packages {
        let licence = package["license"].as_str().unwrap_or("no licence stated");
        if is_accepted(licence, &accepted) != Some(true) {
            offenders.push(format!("{} {}: {licence}", package["name"], package["version"]));
        }
    }
    assert!(offenders.is_empty(), "not under an accepted licence:\n{}", offenders.join("\n"));
}

#[test]
fn expressions_are_read_as_they_mean() {
    let list = ["MIT", "Apache-2.0", "Unicode-3.0"].map(str::to_owned);
    for (text, accepted) in [
        ("MIT", Some(true)),
        ("MIT/Apache-2.0", Some(true)),
        ("GPL-3.0-only OR MIT", Some(true)),
        ("GPL-3.0-only AND MIT", Some(false)),
        ("(MIT OR Apache-2.0) AND Unicode-3.0", Some(true)),
        ("GPL-3.0-only OR MIT AND LGPL-2.1", Some(false)),
        ("Apache-2.0 WITH LLVM-exception OR GPL-2.0", Some(true)),
        ("GPL-2.0+", Some(false)),
        ("no licence stated", None),
        ("MIT OR", None),
        ("(MIT", None),
        ("", None),
    ] {
        assert_eq!(is_accepted(text, &list), accepted, "{text}");
    }
}
