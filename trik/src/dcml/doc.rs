//! `trik dcml doc`: what models say of themselves.
//!
//! Owns nothing but the way to the page, which crate `lang` makes.

use super::report;
use super::source::read;
use crate::output::standard;
use crate::refusal::Refusal;
use clap::Args;
use lang_dcml::manual;
use std::path::PathBuf;

/// What `trik dcml doc` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct DocArgs {
    /// A file with models; - is standard input.
    pub file: PathBuf,
}

/// Writes the page of a file.
pub(super) fn run(args: &DocArgs) -> Result<u8, Refusal> {
    let source = read(&args.file)?;
    let page = manual::markdown(&source.text).map_err(|why| {
        report::show(&source, &why);
        Refusal::new(format!("{}: cannot be understood", source.name))
    })?;
    standard(page.as_bytes())?;
    Ok(0)
}
