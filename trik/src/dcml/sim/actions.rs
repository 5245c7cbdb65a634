//! Where the actions of a simulation come from: formulas of time, or a table.
//!
//! Owns which action holds at a time, and ranges. The form of the table is known to `rows`.

use super::super::report;
use super::super::rows::{read, table_of};
use super::super::source::Source;
use crate::refusal::{REFUSED, Refusal};
use lang_dcml::formulas::{Formulas, Wrong};
use lang_dcml::robot::Robot;
use lang_dcml::syntax::Domain;

/// Actions at any time.
#[derive(Clone)]
pub(super) struct Actions {
    from: From,
    names: Vec<String>,
    ranges: Vec<Option<(f64, f64)>>,
    /// Which actions were held at an end of their range.
    is_held: Vec<bool>,
}

#[derive(Clone)]
enum From {
    Formulas(Box<Formulas>),
    /// Times, and a line of actions for each.
    Table(Vec<f64>, Vec<Vec<f64>>),
}

impl Actions {
    /// From what the option says: formulas have an equals sign, names of files have none.
    pub fn new(text: &str, robot: &Robot) -> Result<Self, Refusal> {
        let parts = robot.action_parts();
        let names: Vec<&str> = parts.iter().map(|one| one.name.as_str()).collect();
        if text.trim().is_empty() {
            let why = "--actions: give NAME = FORMULA for each action, or a file with a table";
            return Err(Refusal::new(why));
        }
        let from = if text.contains('=') {
            From::Formulas(Box::new(formulas(text, &names)?))
        } else {
            let table = read(text)?;
            let others = robot.state_parts().iter().chain(robot.output_parts());
            let others: Vec<&str> = others.map(|one| one.name.as_str()).collect();
            let (times, rows) = table_of(&table, &names, &others)
                .map_err(|(place, why)| Refusal::new(format!("{text}:{place}: {why}")))?;
            From::Table(times, rows)
        };
        let range = |domain: Option<Domain>| match domain {
            Some(Domain::Range(from, to)) => Some((from, to)),
            _ => None,
        };
        Ok(Self {
            from,
            names: names.into_iter().map(str::to_owned).collect(),
            ranges: parts.iter().map(|one| range(one.domain)).collect(),
            is_held: vec![false; parts.len()],
        })
    }

    /// Times at which they jump.
    pub fn jumps(&self) -> &[f64] {
        match &self.from {
            From::Formulas(_) => &[],
            From::Table(times, _) => times,
        }
    }

    /// The actions at a time in s, within their ranges.
    pub fn at(&mut self, time: f64, to: &mut [f64]) {
        match &mut self.from {
            From::Formulas(formulas) => formulas.at(time, to),
            From::Table(times, rows) => {
                let after = times.partition_point(|one| *one <= time);
                if let Some(row) = rows.get(after.saturating_sub(1)) {
                    to.copy_from_slice(row);
                }
            }
        }
        for ((one, range), is_held) in to.iter_mut().zip(&self.ranges).zip(&mut self.is_held) {
            if let Some((least, most)) = *range
                && (*one < least || *one > most)
            {
                *one = if *one < least { least } else { most };
                *is_held = true;
            }
        }
    }

    /// A line for each action that was held at an end of its range.
    pub fn held(&self) -> Vec<String> {
        let all = self.names.iter().zip(&self.ranges).zip(&self.is_held);
        all.filter_map(|((name, range), is_held)| {
            let (least, most) = range.filter(|_| *is_held)?;
            Some(format!(
                "trik: {name} would leave its range {least} .. {most}, and was held at its end"
            ))
        })
        .collect()
    }
}

fn formulas(text: &str, names: &[&str]) -> Result<Formulas, Refusal> {
    Formulas::new(text, names).map_err(|wrong| match wrong {
        Wrong::Text(found) => {
            let source = Source {
                name: "--actions".into(),
                text: text.to_owned(),
            };
            report::show(&source, &found);
            Refusal {
                lines: Vec::new(),
                code: REFUSED,
            }
        }
        Wrong::Missing(name) => Refusal::new(format!(
            "--actions: there is no formula for {name}: add `; {name} = FORMULA`"
        )),
        Wrong::Other(why) => Refusal::new(format!("--actions: {why}")),
    })
}
