//! `trik dcml check`: what is wrong with models.
//!
//! Owns the verdict and its exit code.

use super::{CheckArgs, read, report, understood};
use crate::diagrams::output::standard;
use crate::diagrams::{REFUSED, Refusal, UNREADABLE, say};
use lang_dcml::diagnostic::Severity;

/// Checks all files; the worst of them is the exit code.
pub(super) fn check(args: &CheckArgs) -> Result<u8, Refusal> {
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
