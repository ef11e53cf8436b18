#![allow(clippy::all, clippy::print_stdout, clippy::unwrap_used, missing_docs)]
use mavid::log::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let l = load(std::path::Path::new(&a[1]), &LoadOptions::default()).unwrap();
    for (k, s) in &l.recording.streams {
        println!(
            "{:?} n={} t {:.3}..{:.3} w{} first {:?} last {:?}",
            k,
            s.len(),
            s.time_s.first().unwrap_or(&-1.),
            s.time_s.last().unwrap_or(&-1.),
            s.width,
            &s.values[..s.width.min(4)],
            &s.values[s.values.len() - s.width.min(4)..]
        );
    }
    println!("{:?} {:?} {:?}", l.recording.clock_resets_s, l.recording.parameters, l.recording.texts.len());
}
