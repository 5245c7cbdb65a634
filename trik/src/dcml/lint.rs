//! `trik dcml lint`: what is wrong with models.
//!
//! Owns the verdict and its exit code.

use super::report;
use super::source::{read, understood};
use crate::output::standard;
use crate::refusal::{REFUSED, Refusal, UNREADABLE, say};
use clap::Args;
use lang_dcml::diagnostic::Severity;
use std::path::PathBuf;

/// What `trik dcml lint` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct LintArgs {
    /// Files with models; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Refuse everything that the grammar of the paper (Listing 2) does not have: units, ranges, piecewise and comparisons,
    /// signs before values, comments and documentation but the one before BEGIN, sections twice or in another order.
    #[arg(long)]
    pub paper: bool,
    /// Write a line of JSON for each error and warning to standard output instead, for programs.
    #[arg(long)]
    pub json: bool,
}

/// Looks at all files; the worst of them is the exit code.
pub(super) fn run(args: &LintArgs) -> Result<u8, Refusal> {
    let mut code = 0;
    for path in &args.files {
        let source = match read(path) {
            Ok(source) => source,
            Err(refusal) => {
                say(&refusal.lines);
                code = code.max(UNREADABLE);
                continue;
            }
        };
        let understood = understood(&source, args.paper);
        if args.json {
            standard(&report::json(&source, &understood.diagnostics))?;
        } else {
            report::show(&source, &understood.diagnostics);
        }
        let is_wrong = |severity| {
            understood
                .diagnostics
                .iter()
                .any(|one| one.severity == severity)
        };
        if is_wrong(Severity::Error) {
            code = code.max(REFUSED);
        }
    }
    Ok(code)
}
