//! `trik dcml doc`: what models say of themselves.
//!
//! Owns nothing but the way to the page, which crate `lang` makes.

use super::{DocArgs, read, report};
use crate::diagrams::Refusal;
use crate::diagrams::output::standard;
use lang_dcml::manual;

/// Writes the page of a file.
pub(super) fn doc(args: &DocArgs) -> Result<u8, Refusal> {
    let source = read(&args.file)?;
    let page = manual::markdown(&source.text).map_err(|why| {
        report::show(&source, &why);
        Refusal::new(format!("{}: cannot be understood", source.name))
    })?;
    standard(page.as_bytes())?;
    Ok(0)
}
