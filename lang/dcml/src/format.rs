//! The same document in one layout: comments and order are the author's, spaces and line ends are not.
//!
//! Owns the layout. A text that cannot be read is not touched; what is wrong with its meaning is no hindrance. Formatting
//! what is formatted changes nothing, because the layout follows from the tokens, blank lines, and whether a comment
//! stands after something or alone, all of which it keeps.

mod equation;

use super::diagnostic::{Diagnostic, Findings};
use super::lexer::{self, Keyword, Token, TokenKind, slice};
use super::lines::Lines;
use super::parser;

/// Where lines are broken.
pub const WIDTH: usize = 100;
/// Spaces before what is in a model.
const INSIDE: usize = 2;
/// Spaces before what goes on from another line.
const FURTHER: usize = 4;

/// The text in its layout; else why it cannot be read.
pub fn format(text: &str) -> Result<String, Vec<Diagnostic>> {
    if text.len() > crate::limits::DCML_TEXT_MAX {
        return Err(super::understand(text).diagnostics);
    }
    let mut findings = Findings::default();
    parser::parse(text, false, &mut findings);
    if findings.errors() > 0 {
        return Err(findings.finish());
    }
    let mut writer = Writer {
        text,
        lines: Lines::of(text),
        tokens: lexer::tokens(text).collect(),
        at: 0,
        out: String::with_capacity(text.len() + text.len() / 4),
        end: 0,
    };
    writer.document();
    Ok(writer.out)
}

/// A statement or a declaration: its own tokens, and comments before, in and after it.
#[derive(Default)]
struct Item {
    before: Vec<Token>,
    body: Vec<Token>,
    behind: Vec<Token>,
}

struct Writer<'a> {
    text: &'a str,
    lines: Lines<'a>,
    tokens: Vec<Token>,
    at: usize,
    out: String,
    /// Where in the text that ends what is written last.
    end: u32,
}

impl<'a> Writer<'a> {
    fn document(&mut self) {
        loop {
            let before = self.comments();
            let Some(token) = self.tokens.get(self.at).copied() else {
                self.alone(&before, 0);
                return;
            };
            match token.kind {
                TokenKind::Keyword(Keyword::Begin) => {
                    if !self.out.is_empty() {
                        self.blank();
                    }
                    let item = self.item(before, |token, count| {
                        token.kind == TokenKind::Word && count > 1
                    });
                    self.simple(item, 0);
                }
                TokenKind::Keyword(Keyword::End) => {
                    let mut item = self.item(Vec::new(), ends_statement);
                    let inside = std::mem::take(&mut item.before);
                    self.alone(&before, INSIDE);
                    self.alone(&inside, INSIDE);
                    self.simple(item, 0);
                }
                TokenKind::Keyword(Keyword::Package) => {
                    let item = self.item(before, ends_statement);
                    self.simple(item, INSIDE);
                }
                TokenKind::Keyword(Keyword::Section(_)) => self.section(before),
                _ => self.equation(before),
            }
        }
    }

    /// Comments before the next token.
    fn comments(&mut self) -> Vec<Token> {
        let rest = self.tokens[self.at..].iter();
        let found: Vec<Token> = rest
            .take_while(|one| one.kind.is_comment())
            .copied()
            .collect();
        self.at += found.len();
        found
    }

    fn has_break(&self, start: u32, end: u32) -> bool {
        self.lines.line(start) != self.lines.line(end)
    }

    /// Comments on the line of what ended here; the next token is on another one. The parser sees documentation so too.
    fn comments_behind(&mut self) -> Vec<Token> {
        let Some(last) = self.at.checked_sub(1).map(|at| self.tokens[at]) else {
            return Vec::new();
        };
        let rest = &self.tokens[self.at..];
        let next = rest
            .iter()
            .find(|one| !one.kind.is_comment())
            .map(|one| one.span.start);
        let is_behind = |one: &&Token| {
            one.kind.is_comment()
                && !self.has_break(last.span.end, one.span.start)
                && next.is_none_or(|next| self.has_break(one.span.end, next))
        };
        let found: Vec<Token> = rest.iter().take_while(is_behind).copied().collect();
        self.at += found.len();
        found
    }

    /// Tokens up to the one that ends the item, which is told how many there are. Comments among them go before or after:
    /// those that need the rest of a line, or several lines, before.
    fn item(&mut self, before: Vec<Token>, is_last: impl Fn(&Token, usize) -> bool) -> Item {
        let mut item = Item::default();
        let mut inside = Vec::new();
        while let Some(&token) = self.tokens.get(self.at) {
            self.at += 1;
            if token.kind.is_comment() {
                inside.push(token);
                continue;
            }
            item.body.push(token);
            if is_last(&token, item.body.len()) {
                break;
            }
        }
        for one in inside {
            if one.kind == TokenKind::LineComment || self.has_break(one.span.start, one.span.end) {
                item.before.push(one);
            } else {
                item.behind.push(one);
            }
        }
        item.before.extend(before);
        let behind = self.comments_behind();
        item.behind.extend(behind);
        item
    }

    /// `BEGIN Name`, `PACKAGE: a.b;`, `END;`.
    fn simple(&mut self, item: Item, indent: usize) {
        self.alone(&item.before, indent);
        self.begin_line(indent, item.body.first());
        for (at, token) in item.body.iter().enumerate() {
            let before = at.checked_sub(1).map(|before| item.body[before].kind);
            let is_spaced = matches!(
                before,
                Some(TokenKind::Colon | TokenKind::Keyword(Keyword::Begin))
            );
            if is_spaced {
                self.out.push(' ');
            }
            self.out.push_str(slice(self.text, token.span));
        }
        self.end_line(&item, indent);
    }

    fn section(&mut self, before: Vec<Token>) {
        let mut header = self.item(before, |token, _| token.kind == TokenKind::Colon);
        // What stands before the colon is said of the whole section.
        let colon = header.body.last().map_or(0, |one| one.span.start);
        let early = header
            .behind
            .iter()
            .take_while(|one| one.span.start < colon);
        let early = early.count();
        header.before.splice(0..0, header.behind.drain(..early));
        let mut names: Vec<(Item, String)> = Vec::new();
        loop {
            let before = self.comments();
            let item = self.item(before, ends_declaration);
            let is_last = item
                .body
                .last()
                .is_none_or(|one| one.kind != TokenKind::Comma);
            let text = self.declaration(&item.body);
            names.push((item, text));
            if is_last {
                break;
            }
        }
        self.alone(&header.before, INSIDE);
        self.begin_line(INSIDE, header.body.first());
        for token in &header.body {
            self.out.push_str(slice(self.text, token.span));
        }
        let count = names.len();
        let is_plain = header.behind.is_empty()
            && names.iter().enumerate().all(|(at, (item, _))| {
                item.before.is_empty() && (item.behind.is_empty() || at + 1 == count)
            });
        if is_plain {
            self.filled(&names);
            if let Some((last, _)) = names.last() {
                self.end_line(last, INSIDE);
            }
            return;
        }
        self.end_line(&header, INSIDE);
        for (item, text) in &names {
            self.alone(&item.before, FURTHER);
            self.begin_line(FURTHER, item.body.first());
            self.out.push_str(text);
            self.end_line(item, FURTHER);
        }
    }

    /// Names in a row, as many in each line as it has place for.
    fn filled(&mut self, names: &[(Item, String)]) {
        let mut column = self.out.len() - self.out.rfind('\n').map_or(0, |at| at + 1);
        for (_, text) in names {
            if column + 1 + text.len() > WIDTH && column > FURTHER {
                self.out.push('\n');
                self.spaces(FURTHER);
                column = FURTHER;
            } else {
                self.out.push(' ');
                column += 1;
            }
            self.out.push_str(text);
            column += text.len();
        }
    }

    /// `name [unit] in -2 .. 2 = 3,`
    fn declaration(&self, body: &[Token]) -> String {
        let mut text = String::new();
        let mut before = None;
        let mut tokens = body.iter();
        while let Some(token) = tokens.next() {
            let is_tight = match token.kind {
                TokenKind::Comma | TokenKind::Semicolon => true,
                // A sign belongs to its number.
                TokenKind::Number | TokenKind::Open | TokenKind::Close => !matches!(
                    before,
                    Some(TokenKind::Equals | TokenKind::DotDot | TokenKind::Word)
                ),
                _ => false,
            };
            if !is_tight && before.is_some_and(|one| one != TokenKind::Open) {
                text.push(' ');
            }
            text.push_str(slice(self.text, token.span));
            before = Some(token.kind);
            if token.kind == TokenKind::OpenBracket {
                let mut inside = token.span;
                inside.start = inside.end;
                for one in tokens.by_ref() {
                    inside.end = one.span.start;
                    if one.kind == TokenKind::CloseBracket {
                        break;
                    }
                }
                text.push_str(slice(self.text, inside).trim());
                text.push(']');
                before = Some(TokenKind::CloseBracket);
            }
        }
        text
    }

    /// Comments on lines of their own.
    fn alone(&mut self, comments: &[Token], indent: usize) {
        for one in comments {
            self.begin_line(indent, Some(one));
            let text = self.comment(*one, indent);
            self.out.push_str(&text);
            self.out.push('\n');
            self.end = one.span.end;
        }
    }

    /// A comment whose further lines stand under its first one if they begin with stars.
    fn comment(&self, one: Token, indent: usize) -> String {
        let text = slice(self.text, one.span);
        let mut further = text.lines().skip(1).map(str::trim_start).peekable();
        let is_starred = further.peek().is_some() && further.all(|line| line.starts_with('*'));
        let mut out = String::with_capacity(text.len());
        for (at, line) in text.lines().enumerate() {
            let line = line.trim_end();
            if at > 0 {
                out.push('\n');
                if is_starred {
                    out.extend(std::iter::repeat_n(' ', indent + 1));
                    out.push_str(line.trim_start());
                    continue;
                }
            }
            out.push_str(line);
        }
        out
    }

    /// The spaces before the first token of a line, and a blank line before that if the author has one.
    fn begin_line(&mut self, indent: usize, first: Option<&Token>) {
        if let Some(first) = first
            && !self.out.is_empty()
            && self.lines.line(first.span.start) > self.lines.line(self.end) + 1
        {
            self.blank();
        }
        self.spaces(indent);
    }

    fn blank(&mut self) {
        if !self.out.ends_with("\n\n") {
            self.out.push('\n');
        }
    }

    fn spaces(&mut self, count: usize) {
        self.out.extend(std::iter::repeat_n(' ', count));
    }

    fn end_line(&mut self, item: &Item, indent: usize) {
        if let Some(last) = item.body.last() {
            self.end = last.span.end;
        }
        for one in &item.behind {
            self.out.push(' ');
            let text = self.comment(*one, indent);
            self.out.push_str(&text);
            self.end = self.end.max(one.span.end);
        }
        self.out.push('\n');
    }
}

fn ends_statement(token: &Token, _: usize) -> bool {
    token.kind == TokenKind::Semicolon
}

fn ends_declaration(token: &Token, _: usize) -> bool {
    matches!(token.kind, TokenKind::Comma | TokenKind::Semicolon)
}

#[cfg(test)]
mod tests;
