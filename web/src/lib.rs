//! Projects of TRIK Studio in a browser: drawn, opened, looked through, shown, written as text, judged, run tick by tick and debugged.
//!
//! Owns the options of each request and the JSON that answers have. Values in, values out: no files, network, threads or
//! clock; `bindings`, which exists in a browser alone, carries them to JavaScript and brings the clock. What is done is known
//! in `studio`, `lang` and `sim`.

#[cfg(target_family = "wasm")]
mod bindings;
pub mod change;
pub mod course;
pub mod draft;
pub mod failure;
mod flow;
pub mod judged;
pub mod limits;
pub mod options;
pub mod palette;
pub mod project;
pub mod run;
pub mod script;
pub mod words;
