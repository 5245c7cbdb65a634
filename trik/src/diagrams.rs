//! Diagrams on this computer, without a robot: `trik gen`, `trik show` and `trik lint`, a file for each.
//!
//! Owns nothing else. What a diagram means is known in `lang-diagram` alone; `save` is the way of a save from its file to
//! there, `report` puts its problems into lines, `words` has what is said here.

pub(crate) mod flow;
pub(crate) mod generate;
pub(crate) mod lint;
mod report;
pub(crate) mod save;
pub(crate) mod show;
mod words;
