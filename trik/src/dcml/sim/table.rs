//! What is shown of a solution: a line of numbers for each time.
//!
//! Owns its form as text. Knows no solver.

use lang_dcml::robot::Part;
use lang_dcml::syntax::Domain;
use std::fmt::Write as _;

/// What is shown of a solution: a line for each time.
pub(super) struct Table {
    /// Time, states, outputs, actions.
    pub columns: Vec<Column>,
    /// How many of the columns after the time are states and outputs.
    pub configs: usize,
    /// As many numbers as there are columns.
    pub rows: Vec<Vec<f64>>,
}

/// A column of a table.
pub(super) struct Column {
    /// The name in the model.
    pub name: String,
    /// Its unit, if it is known.
    pub unit: Option<String>,
    /// Whether it is an angle that wraps.
    pub is_circle: bool,
}

impl Column {
    /// Of a part of a robot.
    pub fn of(part: &Part) -> Self {
        Self {
            name: part.name.clone(),
            unit: part.unit.clone(),
            is_circle: part.domain == Some(Domain::Circle),
        }
    }
}

impl Table {
    /// As text: names in the first line.
    pub fn csv(&self) -> String {
        let names: Vec<&str> = self.columns.iter().map(|one| one.name.as_str()).collect();
        let mut text = names.join(",");
        text.push('\n');
        for row in &self.rows {
            for (at, number) in row.iter().enumerate() {
                let comma = if at == 0 { "" } else { "," };
                // Zero has no sign for people.
                let _ = write!(text, "{comma}{}", number + 0.0);
            }
            text.push('\n');
        }
        text
    }
}
