//! What is known of a target language: a row that the file of the language has.
//!
//! Owns the columns. Knows no language.

use super::graph::Scene;

/// One language, as the file of that language says it.
pub(super) struct Row {
    /// On the command line.
    pub(super) name: &'static str,
    /// Of the names of files, without a dot.
    pub(super) ending: &'static str,
    /// Values and results that one function of the language can hold.
    pub(super) values_max: usize,
    /// Writes a model.
    pub(super) print: fn(&Scene) -> String,
}
