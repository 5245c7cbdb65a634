//! Rounds, percentiles and ratios.
//!
//! In each round every variant is measured once, one after the other; a ratio is taken inside its round against that
//! round's reference, and the table shows the median over the rounds. So the machine's drift cancels out.

use std::time::Instant;

/// How much is measured.
pub struct Plan {
    pub rounds: usize,
    pub samples: usize,
}

impl Plan {
    pub fn new(quick: bool) -> Self {
        if quick {
            Self {
                rounds: 3,
                samples: 1000,
            }
        } else {
            Self {
                rounds: 11,
                samples: 4000,
            }
        }
    }
}

/// Median and 99th percentile in nanoseconds.
#[derive(Clone, Copy)]
pub struct Spread {
    pub p50: f64,
    pub p99: f64,
}

pub fn spread(mut samples: Vec<u64>) -> Spread {
    samples.sort_unstable();
    let at = |share: f64| samples[((samples.len() - 1) as f64 * share) as usize] as f64;
    Spread {
        p50: at(0.5),
        p99: at(0.99),
    }
}

/// Times `count` calls after a warm-up.
pub fn time(count: usize, mut call: impl FnMut()) -> Spread {
    for _ in 0..count / 10 + 50 {
        call();
    }
    let samples = (0..count).map(|_| {
        let start = Instant::now();
        call();
        u64::try_from(start.elapsed().as_nanos()).unwrap_or(u64::MAX)
    });
    spread(samples.collect())
}

/// One row of a table: a name, how to measure it, and the goal for its ratio to the reference row.
pub struct Row<'a> {
    pub name: &'static str,
    pub measure: Box<dyn FnMut() -> Spread + 'a>,
    pub reference: usize,
    pub goal: Option<f64>,
}

pub fn row<'a>(
    name: &'static str,
    reference: usize,
    goal: Option<f64>,
    measure: impl FnMut() -> Spread + 'a,
) -> Row<'a> {
    Row {
        name,
        measure: Box::new(measure),
        reference,
        goal,
    }
}

/// How a goal went.
pub fn verdict(met: bool) -> &'static str {
    if met { "met" } else { "NOT MET" }
}

pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Measures all rows in all rounds and prints them.
pub fn table(title: &str, rounds: usize, mut rows: Vec<Row<'_>>) {
    let mut seen: Vec<Vec<Spread>> = vec![Vec::new(); rows.len()];
    for _ in 0..rounds {
        for (row, seen) in rows.iter_mut().zip(&mut seen) {
            seen.push((row.measure)());
        }
    }
    println!("\n{title}");
    println!(
        "{:<44} {:>9} {:>9} {:>7}  goal",
        "", "p50 us", "p99 us", "ratio"
    );
    for (index, row) in rows.iter().enumerate() {
        let p50 = median(seen[index].iter().map(|one| one.p50).collect());
        let p99 = median(seen[index].iter().map(|one| one.p99).collect());
        let reference = &seen[row.reference];
        let ratio = median(
            seen[index]
                .iter()
                .zip(reference)
                .map(|(one, reference)| one.p50 / reference.p50)
                .collect(),
        );
        let goal = row.goal.map_or(String::new(), |goal| {
            format!("<= {goal:.2} {}", verdict(ratio <= goal))
        });
        println!(
            "{:<44} {:>9.2} {:>9.2} {:>6.2}x  {goal}",
            row.name,
            p50 / 1000.0,
            p99 / 1000.0,
            ratio
        );
    }
}
