//! What this language has and the published one does not: the grammar is Listing 2 of the paper.
//!
//! Owns the list, and where documentation and the parts of a model may stand in the published language. All of it is told
//! only if the published language is asked for.

use super::super::diagnostic::{Code, Diagnostic};
use super::super::lexer::{Keyword, TokenKind};
use super::super::syntax::{Kind, Span};
use super::Parser;

/// A construct that Listing 2 does not have.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Beyond {
    Comment,
    Documentation,
    Units,
    Domain,
    Comparison,
    Piecewise,
    SecondSection,
    Order,
    Sign,
    Parentheses,
}

impl Beyond {
    /// What it is called, and what the published language has in its place.
    const fn texts(self) -> (&'static str, &'static str) {
        match self {
            Self::Comment => (
                "a comment that is no `/** documentation */`",
                "remove it, or move its text into the documentation before `BEGIN`",
            ),
            Self::Documentation => (
                "documentation here",
                "it has one `/** documentation */`, directly before `BEGIN`",
            ),
            Self::Units => ("units", "remove it; the documentation can say the unit"),
            Self::Domain => (
                "ranges and angles that wrap",
                "remove it; the documentation can say where the value may be",
            ),
            Self::Comparison => ("comparisons", "its operators are `+`, `-`, `*` and `/`"),
            Self::Piecewise => (
                "`piecewise`",
                "use `min`, `max`, `abs` or `sign`, if they can express it",
            ),
            Self::SecondSection => (
                "two sections of one kind",
                "put the names into one section, with commas between them",
            ),
            Self::Order => (
                "parts of a model in this order",
                "the order is PACKAGE, ACTION, PARAM, CONST, CONFIG, VAR, and then all equations",
            ),
            Self::Sign => ("a sign before a value", "write `0 - x` for `-x`"),
            Self::Parentheses => (
                "a number in parentheses as a constant",
                "write the number, with its sign",
            ),
        }
    }
}

/// The parts of a model in the order of Listing 2.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub(super) enum Part {
    Package,
    Action,
    Param,
    Const,
    Config,
    Var,
    Equation,
}

impl Part {
    pub(super) const fn of(kind: Kind) -> Self {
        match kind {
            Kind::Action => Self::Action,
            Kind::Param => Self::Param,
            Kind::Const => Self::Const,
            Kind::Config => Self::Config,
            Kind::Var => Self::Var,
        }
    }
}

impl Parser<'_, '_> {
    /// Refuses what the published language does not have, if that is the one to be read.
    pub(super) fn extension(&mut self, span: Span, what: Beyond) {
        if !self.paper {
            return;
        }
        let (what, hint) = what.texts();
        let message = format!("the published language does not have {what}");
        let found = Diagnostic::new(Code::Extension, span, message, "an extension");
        self.findings.add(found.hint(hint));
        self.damage.any = true;
    }

    /// Refuses documentation that is not the one directly before `BEGIN`. All tokens are read.
    pub(super) fn paper_documentation(&mut self) {
        if !self.paper {
            return;
        }
        let is_begin = |at: usize| {
            let token = self.tokens.get(at);
            token.is_some_and(|one| one.kind == TokenKind::Keyword(Keyword::Begin))
        };
        let mut wrong = Vec::new();
        for (at, (before, span)) in self.docs.iter().enumerate() {
            let next = self.docs.get(at + 1).map(|(before, _)| *before);
            if !is_begin(*before) || next == Some(*before) {
                wrong.push(*span);
            }
        }
        for span in wrong {
            self.bad.push(span.start);
            self.extension(span, Beyond::Documentation);
        }
        self.bad.sort_unstable();
    }

    /// Refuses a part of the model that stands after one that it should stand before.
    pub(super) fn paper_order(&mut self, part: Part) {
        if self.furthest > Some(part) {
            let span = self.token().span;
            self.extension(span, Beyond::Order);
        } else {
            self.furthest = Some(part);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::diagnostic::{Code, Diagnostic};
    use crate::{understand, understand_paper};

    const PLAIN: &str = "BEGIN M ACTION: u; PARAM: k; CONFIG: x; d(x) = k * u; END;";

    fn with(from: &str, to: &str) -> String {
        assert!(PLAIN.contains(from), "{from}");
        PLAIN.replacen(from, to, 1)
    }

    /// Documents with their parts in another order, the words that are refused, and why.
    fn orders() -> Vec<(String, &'static str, &'static str)> {
        let order = "parts of a model in this order";
        let constant = with("CONFIG: x;", "CONFIG: x; CONST: c = 1;");
        vec![
            (
                with("ACTION: u; PARAM: k;", "PARAM: k; ACTION: u;"),
                "ACTION",
                order,
            ),
            (
                with("PARAM: k; CONFIG: x;", "CONFIG: x; PARAM: k;"),
                "PARAM",
                order,
            ),
            (constant.replace("u; END", "c * u; END"), "CONST", order),
            (
                with("CONFIG: x; d(x) = k * u;", "d(x) = k * u; CONFIG: x;"),
                "CONFIG",
                order,
            ),
            (
                with("CONFIG: x; ", "CONFIG: x; PACKAGE: a.b; "),
                "PACKAGE",
                order,
            ),
        ]
    }

    /// Each construct: the document, the words that are refused, and why.
    fn cases() -> Vec<(String, &'static str, &'static str)> {
        let order = "parts of a model in this order";
        let inner = "documentation here";
        let sign = "a sign before a value";
        let comment = "a comment that is no `/** documentation */`";
        let domain = "ranges and angles that wrap";
        let number = "a number in parentheses as a constant";
        let constant = |text: &str| {
            let to = format!("k; CONST: c = {text};");
            with("k;", &to).replace("k * u", "k * u * c")
        };
        vec![
            (with("u;", "u; // why\n"), "// why", comment),
            (with("u;", "u; /* why */"), "/* why */", comment),
            (with("u;", "/** why */ u;"), "/** why */", inner),
            (with("ACTION", "/** why */ ACTION"), "/** why */", inner),
            (with("u;", "u; /** why */\n"), "/** why */", inner),
            (with(" d(x)", " /** why */ d(x)"), "/** why */", inner),
            (with("M ", "M /** why */ "), "/** why */", inner),
            (with("END;", "END; /** why */"), "/** why */", inner),
            (format!("/** a */ /** b */ {PLAIN}"), "/** a */", inner),
            (with("u;", "u [m];"), "[", "units"),
            (with("x;", "x in S1;"), "in", domain),
            (with("u;", "u in -1 .. 1;"), "in", domain),
            (
                with("k;", "k; ACTION: v;").replace("* u", "* u * v"),
                "ACTION",
                "two sections of one kind",
            ),
            (
                with("CONFIG", "VAR: a; CONFIG")
                    .replace("END", "a = k; END")
                    .replace("k * u", "a * u"),
                "CONFIG",
                order,
            ),
            (with("k * u", "-k * u"), "-", sign),
            (with("k * u", "k * -u"), "-", sign),
            (with("k * u", "k * (+u)"), "+", sign),
            (with("k * u", "k * sin(-u)"), "-", sign),
            (constant("(2)"), "(2)", number),
            (constant("(-2)"), "(-2)", number),
            (with("k * u", "min(k, u < 1)"), "<", "comparisons"),
            (
                with("k * u", "piecewise(u, k, 1)"),
                "piecewise",
                "`piecewise`",
            ),
        ]
    }

    #[test]
    fn the_published_language_has_nothing_that_its_grammar_does_not_have() {
        for (text, words, what) in cases().into_iter().chain(orders()) {
            let all = understand_paper(&text);
            let refused = |one: &&Diagnostic| one.code == Code::Extension;
            let first = all.diagnostics.iter().find(refused);
            let first = first.unwrap_or_else(|| panic!("{text}: {:?}", all.diagnostics));
            let message = format!("the published language does not have {what}");
            assert_eq!(first.message, message, "{text}");
            let span = first.span.start as usize..first.span.end as usize;
            assert_eq!(&text[span], words, "{text}");
            assert!(first.hint.is_some(), "{text}");
            let is_inside = first.span.start < all.document.models[0].span.end
                && first.span.start >= all.document.models[0].span.start;
            assert_eq!(all.models.is_empty(), is_inside, "{text}");
        }
        // All that the grammar has, in one document.
        let all = "/** Two\n * lines. */ BEGIN M PACKAGE: a.b.c; ACTION : u, v; PARAM: k; CONST: c = -2.5, g = +1, h = 3;
        CONFIG: x, y; VAR: a; a = k * (c + g) / h - d(x); d(x) = sin(u) + atan2(u, v) * pi; y = a; END;
        BEGIN N ACTION: u; CONFIG: x; d(x) = u; END;";
        let found = understand_paper(all);
        assert_eq!((found.models.len(), found.diagnostics), (2, vec![]));
        assert_eq!(found.models, understand(all).models);
    }
}
