//! What all languages say, in English and Russian.

use crate::problem::{Severity, Words};

/// How bad a problem is.
pub(crate) fn severity(severity: Severity) -> Words {
    match severity {
        Severity::Error => Words::new("error", "ошибка"),
        Severity::Warning => Words::new("warning", "предупреждение"),
        Severity::Note => Words::new("note", "замечание"),
    }
}
