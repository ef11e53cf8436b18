//! What benchmarks share: their arguments, and the figures that they store.
#![allow(dead_code, reason = "each benchmark uses a part")]
#![allow(clippy::print_stdout, reason = "a benchmark prints")]

pub mod comparison;
pub mod digits;
pub mod fleet;
pub mod identification;
pub mod recorded;
pub mod sections;

use std::str::FromStr;

/// The words after `cargo bench --bench NAME --`.
pub struct Arguments(Vec<String>);

impl Arguments {
    /// Of this process, without the `--bench` that cargo adds.
    pub fn of_process() -> Self {
        Self(std::env::args().skip(1).filter(|word| word != "--bench").collect())
    }

    /// The word after `name`; ends the process where there is none.
    pub fn text(&self, name: &str) -> Option<String> {
        let place = self.0.iter().position(|word| word == name)?;
        Some(self.0.get(place + 1).cloned().unwrap_or_else(|| refuse(name, "a value after it", "nothing")))
    }

    /// The number after `name`, or what is taken without it; ends the process where it is none.
    pub fn number<T: FromStr>(&self, name: &str, otherwise: T) -> T {
        self.text(name).map_or(otherwise, |text| {
            text.parse().unwrap_or_else(|_| {
                refuse(name, &format!("a number ({})", std::any::type_name::<T>()), &text)
            })
        })
    }

    /// All words, as they were written.
    pub fn line(&self) -> String {
        self.0.join(" ")
    }

    /// The whole command line of this benchmark.
    pub fn command(&self, benchmark: &str) -> String {
        format!("cargo bench --bench {benchmark} -- {}", self.line())
    }

    /// Whether the word is there.
    pub fn has(&self, word: &str) -> bool {
        self.0.iter().any(|other| other == word)
    }
}

fn refuse<T>(name: &str, expected: &str, came: &str) -> T {
    end(&format!("{name}: expected {expected}, got {came}"))
}

/// Ends the process and says why.
pub fn end(why: &str) -> ! {
    println!("{why}");
    std::process::exit(2);
}
