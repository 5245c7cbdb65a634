//! Arbitrary bytes as diagrams: nothing but time and memory within limits may go.
//!
//! Run by tests with mutated saves, and by any fuzzer.

mod choices;
mod debugging;
mod edits;
pub(crate) mod lowering;
mod saves;

pub use choices::Choices;
pub use debugging::debugging;
pub use edits::{edits, edits_of};
pub use lowering::{lowering, project};
pub use saves::reader;
