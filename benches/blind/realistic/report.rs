//! Figures of many flights.

use std::collections::BTreeMap;

use super::judge::{Judged, Moved, Stated};
use super::stored::{Bias, CleanFlights, EffectFlights, Intervals, Localised, Realistic, SeveralFlights};
use crate::maker::realistic::case::EFFECTS;
use crate::score::upper;

/// Everything that is stored.
pub fn figures((command, seed): (String, u64), judged: &[Judged]) -> Realistic {
    let of =
        |entries: usize| judged.iter().filter(|flight| flight.entries.len() == entries).collect::<Vec<_>>();
    let single = of(1);
    let effects = EFFECTS
        .iter()
        .map(|id| single.iter().filter(|flight| flight.entries[0] == *id).copied().collect::<Vec<_>>())
        .filter(|flights| !flights.is_empty())
        .map(|flights| effect(&flights))
        .collect();
    let several: Vec<&Judged> = judged.iter().filter(|flight| flight.entries.len() > 1).collect();
    Realistic {
        command,
        seed,
        clean: clean(&of(0)),
        effects,
        several: together(&several),
        sizes: intervals(judged.iter().flat_map(|flight| &flight.sizes)),
        bodies: intervals(judged.iter().flat_map(|flight| &flight.bodies)),
        localisation: localised(judged),
    }
}

fn counted<'a>(names: impl Iterator<Item = &'a String>) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    names.for_each(|name| *counts.entry(name.clone()).or_default() += 1);
    counts
}

fn clean(flights: &[&Judged]) -> CleanFlights {
    let named = flights.iter().filter(|flight| !flight.others.is_empty()).count();
    let unexplained = flights.iter().filter(|flight| flight.names.is_empty() && !flight.right).count();
    CleanFlights {
        flights: flights.len(),
        named,
        unexplained,
        bound_percent: rounded(100.0 * upper(named, flights.len())),
        names: counted(flights.iter().flat_map(|flight| &flight.others)),
    }
}

fn effect(flights: &[&Judged]) -> EffectFlights {
    let sum = |count: &dyn Fn(&Judged) -> usize| flights.iter().map(|flight| count(flight)).sum();
    let id = flights.first().map_or_else(String::new, |flight| flight.entries[0].to_owned());
    let own = |names: &[String]| usize::from(names.contains(&id));
    let found: Vec<&Moved> =
        flights.iter().filter(|flight| own(&flight.named) > 0).flat_map(|flight| &flight.moved).collect();
    let alone: Vec<&Moved> = flights.iter().flat_map(|flight| &flight.moved).collect();
    EffectFlights {
        flights: flights.len(),
        right: sum(&|flight| usize::from(flight.right)),
        named: sum(&|flight| own(&flight.named)),
        in_set: sum(&|flight| own(&flight.in_set)),
        others: counted(flights.iter().flat_map(|flight| &flight.others)),
        without: bias(&alone, |moved| Some(moved.before)),
        with: bias(&found, |moved| moved.after),
        id,
    }
}

fn bias(moved: &[&Moved], off: impl Fn(&Moved) -> Option<f64>) -> Bias {
    let of = |mass: bool| {
        let kept = moved.iter().filter(move |moved| (moved.name == "mass") == mass);
        kept.filter_map(|moved| off(moved)).map(|off| 100.0 * off).collect::<Vec<_>>()
    };
    let (mass, mut inertia) = (of(true), of(false));
    inertia.iter_mut().for_each(|off| *off = off.abs());
    inertia.sort_by(f64::total_cmp);
    let mean = mass.iter().sum::<f64>() / mass.len() as f64;
    Bias {
        mass: (!mass.is_empty()).then(|| rounded(mean)),
        inertia: inertia.get(inertia.len() / 2).map(|off| rounded(*off)),
    }
}

fn together(flights: &[&Judged]) -> SeveralFlights {
    let sum = |count: &dyn Fn(&Judged) -> usize| flights.iter().map(|flight| count(flight)).sum();
    SeveralFlights {
        flights: flights.len(),
        right: sum(&|flight| usize::from(flight.right)),
        concealed: sum(&|flight| flight.named.len() + flight.in_set.len() + flight.missed.len()),
        found: sum(&|flight| flight.named.len() + flight.in_set.len()),
        others: counted(flights.iter().flat_map(|flight| &flight.others)),
    }
}

fn intervals<'a>(stated: impl Iterator<Item = &'a Stated>) -> Intervals {
    let mut counts = Intervals::default();
    for one in stated {
        let (share, errors) = one.off();
        let near = share <= if one.name == "mass" { 0.02 } else { 0.1 };
        counts.stated += 1;
        counts.near += usize::from(near);
        counts.inside += usize::from(errors <= 1.96);
        counts.two += usize::from(errors <= 2.0);
        counts.right += usize::from(near && errors <= 3.0);
    }
    counts
}

fn localised(flights: &[Judged]) -> Localised {
    let mut counts = Localised::default();
    for (said, is) in flights.iter().flat_map(|flight| flight.axes.0.into_iter().zip(flight.axes.1)) {
        counts.hits += usize::from(said && is);
        counts.wrong += usize::from(said && !is);
        counts.missed += usize::from(is && !said);
    }
    let all = (2 * counts.hits + counts.wrong + counts.missed) as f64;
    counts.f1 = rounded(2.0 * counts.hits as f64 / all.max(1.0));
    counts
}

fn rounded(value: f64) -> f64 {
    (1000.0 * value).round() / 1000.0
}

/// Tells the figures.
pub fn tell(figures: &Realistic) {
    let clean = &figures.clean;
    println!(
        "nothing concealed: {} flights, {} named {:?}, {} unexplained: at most {:.1} % named (95 %, Clopper-Pearson)",
        clean.flights, clean.named, clean.names, clean.unexplained, clean.bound_percent
    );
    println!("{:20} flights right named in set  others; bias without and with: mass, inertia", "effect");
    let told = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.1}"));
    for run in &figures.effects {
        let Bias { mass, inertia } = run.without;
        println!(
            "{:20} {:7} {:5} {:5} {:6}  {:?}; {} {} {} {}",
            run.id,
            run.flights,
            run.right,
            run.named,
            run.in_set,
            run.others,
            told(mass),
            told(inertia),
            told(run.with.mass),
            told(run.with.inertia)
        );
    }
    let total = |count: &dyn Fn(&EffectFlights) -> usize| figures.effects.iter().map(count).sum::<usize>();
    println!(
        "one effect: {} of {} right, {} false names",
        total(&|run| run.right),
        total(&|run| run.flights),
        total(&|run| run.others.values().sum())
    );
    let several = &figures.several;
    println!(
        "several: {} of {} right, {} of {} effects found, false {:?}",
        several.right, several.flights, several.found, several.concealed, several.others
    );
    for (name, of) in [("sizes", figures.sizes), ("masses and inertias", figures.bodies)] {
        println!(
            "{name}: {} stated, {} near, {} inside 95 %, {} within two standard errors, {} right",
            of.stated, of.near, of.inside, of.two, of.right
        );
    }
    println!("localisation: {:?}", figures.localisation);
}
