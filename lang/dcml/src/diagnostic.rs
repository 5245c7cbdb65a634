//! What is wrong with a document: where, what, and what to do.
//!
//! Owns the shape of a finding and how many are kept. Which findings there are is known to [`Code`], how they look to a person who
//! shows them.

pub use super::code::Code;
use super::syntax::Span;
use crate::limits::DCML_DIAGNOSTICS;

/// How bad it is.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash, Ord, PartialOrd)]
pub enum Severity {
    /// The model cannot be used.
    Error,
    /// The model means something, perhaps not what its author wants.
    Warning,
}

/// One finding.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Diagnostic {
    /// Which.
    pub code: Code,
    /// How bad.
    pub severity: Severity,
    /// Where.
    pub span: Span,
    /// What is wrong, one sentence without a full stop.
    pub message: String,
    /// What to write at the place itself, a few words.
    pub label: String,
    /// What to do.
    pub hint: Option<String>,
    /// Other places that have to do with it.
    pub notes: Vec<(Span, String)>,
}

impl Diagnostic {
    /// A finding, as bad as its code says.
    pub fn new(
        code: Code,
        span: Span,
        message: impl Into<String>,
        label: impl Into<String>,
    ) -> Self {
        Self {
            code,
            severity: code.severity(),
            span,
            message: message.into(),
            label: label.into(),
            hint: None,
            notes: Vec::new(),
        }
    }

    /// With what to do.
    #[must_use]
    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// With another place.
    #[must_use]
    pub fn note(mut self, span: Span, text: impl Into<String>) -> Self {
        self.notes.push((span, text.into()));
        self
    }
}

/// Findings of one document: the first of each severity, and how many there are.
#[derive(Debug, Default)]
pub(super) struct Findings {
    kept: Vec<Diagnostic>,
    errors: usize,
    warnings: usize,
}

impl Findings {
    /// Takes one; gives its place if it is kept.
    pub(super) fn add(&mut self, one: Diagnostic) -> Option<usize> {
        let count = match one.severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        *count += 1;
        (*count <= DCML_DIAGNOSTICS).then(|| {
            self.kept.push(one);
            self.kept.len() - 1
        })
    }

    /// Whether one would be kept; else it is counted, and need not be made.
    pub(super) fn wants(&mut self, severity: Severity) -> bool {
        let count = match severity {
            Severity::Error => &mut self.errors,
            Severity::Warning => &mut self.warnings,
        };
        let has_place = *count < DCML_DIAGNOSTICS;
        *count += usize::from(!has_place);
        has_place
    }

    /// Adds a place to one that is kept, as long as there are few.
    pub(super) fn also(&mut self, at: Option<usize>, span: Span, text: &str) {
        if let Some(one) = at.and_then(|at| self.kept.get_mut(at))
            && one.notes.len() < 3
        {
            one.notes.push((span, text.to_owned()));
        }
    }

    /// How many errors there are until now.
    pub(super) fn errors(&self) -> usize {
        self.errors
    }

    /// Whether another error would be counted only.
    pub(super) fn is_full(&self) -> bool {
        self.errors >= DCML_DIAGNOSTICS
    }

    /// In the order of the text; what was not kept is told at last.
    pub(super) fn finish(mut self) -> Vec<Diagnostic> {
        self.kept.sort_by_key(|one| (one.span.start, one.severity));
        let more = (self.errors + self.warnings).saturating_sub(self.kept.len());
        if more > 0 {
            let span = self.kept.last().map(|one| one.span).unwrap_or_default();
            let errors = self.errors.saturating_sub(DCML_DIAGNOSTICS);
            let message = format!(
                "there is more: {errors} errors and {} warnings are not shown",
                more - errors
            );
            let mut last = Diagnostic::new(Code::More, span, message, "and on");
            if errors == 0 {
                last.severity = Severity::Warning;
            }
            self.kept.push(last);
        }
        self.kept
    }
}
