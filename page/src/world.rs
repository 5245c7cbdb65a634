//! The world around a virtual robot, as the page shows it.
//!
//! Owns the border. What is in the texts is known to the simulator that makes them and to `page/app/src/world`, which draws them.

use lang_text::problem::Words;

/// A world that can be looked at and takes orders. Its methods are called from the thread of the server and must not wait.
pub trait World: Send + Sync {
    /// What stands still, as JSON, with a number that changes whenever it does.
    fn scene(&self) -> (u64, String);

    /// The number alone: it is asked for at every picture.
    fn version(&self) -> u64;

    /// What moves, as JSON, at this moment.
    fn state(&self) -> String;

    /// It does what people order. One that was recorded does not.
    fn takes_orders(&self) -> bool {
        true
    }

    /// Does what a person orders, in words. Words that are long may take time.
    ///
    /// # Errors
    /// What is wrong with the words, for this person.
    fn order(&self, words: &str) -> Result<(), Refused>;
}

/// Why a world does not do what it is told: a sentence for the person, in both languages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Refused(pub Words);

impl std::fmt::Display for Refused {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0.english)
    }
}

impl std::error::Error for Refused {}
