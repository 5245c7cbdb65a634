//! The benchmark: every figure as a ratio to a peer or limit measured in the same run.
//!
//! `cargo bench -p trikfs --bench ratios [-- SECTION...]` prints one table per section; `--quick` makes few rounds,
//! `torn` reads values ten million times and is only run when named. Method and last results are in
//! docs/maintainer/performance.md. Owns the measuring; what is measured is the program as it ships.

mod ratios {
    pub mod bulk;
    pub mod bus;
    pub mod bus_peer;
    pub mod events;
    pub mod idle;
    pub mod isolated;
    pub mod measure;
    pub mod newest;
    pub mod open;
    pub mod peers;
    pub mod reads;
    pub mod reload;
    pub mod samples;
    pub mod states;
    pub mod together;
    pub mod torn;
}

use ratios::measure::Plan;
use ratios::{
    bulk, bus, events, idle, isolated, newest, open, peers, reads, reload, samples, states,
    together, torn,
};

/// A section's name and what it runs.
type Section = (&'static str, fn(&Plan) -> Outcome);

/// Benchmarks fail with a sentence.
type Outcome = Result<(), String>;

const SECTIONS: [Section; 12] = [
    ("reads", reads::run),
    ("newest", newest::run),
    ("events", events::run),
    ("open", open::run),
    ("states", states::run),
    ("reload", reload::run),
    ("bulk", bulk::run),
    ("isolated", isolated::run),
    ("together", together::run),
    ("bus", bus::run),
    ("samples", samples::run),
    ("idle", idle::run),
];

fn main() {
    let words: Vec<String> = std::env::args()
        .skip(1)
        .filter(|word| word != "--bench")
        .collect();
    if let Some(role) = words.first().and_then(|word| word.strip_prefix("role=")) {
        return peers::play(role, &words[1..]);
    }
    let plan = Plan::new(words.iter().any(|word| word == "--quick"));
    let named: Vec<&str> = words
        .iter()
        .map(String::as_str)
        .filter(|word| !word.starts_with('-'))
        .collect();
    peers::pin_to_one_core();
    println!(
        "client and daemon on one core; {} rounds of {} samples, all variants in each round",
        plan.rounds, plan.samples
    );
    let mut failed = false;
    let sections = SECTIONS
        .into_iter()
        .chain([("torn", torn::run as fn(&Plan) -> Outcome)]);
    for (name, run) in sections {
        let wanted = if named.is_empty() {
            name != "torn"
        } else {
            named.contains(&name)
        };
        if wanted && let Err(reason) = run(&plan) {
            println!("{name}: not measured: {reason}");
            failed = true;
        }
    }
    if failed {
        std::process::exit(1);
    }
}
