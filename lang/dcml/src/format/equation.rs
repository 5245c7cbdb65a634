//! The layout of equations: spaces around operators, and where a long one is broken.
//!
//! Owns the choice of breaks: before the operator that binds least and stands in the fewest parentheses, as late on the
//! line as it can be.

use super::super::lexer::{Token, TokenKind, slice};
use super::{FURTHER, INSIDE, WIDTH, Writer};

/// A token or comment as it is printed.
struct Piece {
    text: String,
    /// Whether a space stands before it.
    is_spaced: bool,
    /// How bad it is to break the line before it; nothing if it cannot be.
    cost: Option<u32>,
    /// Whether the line ends after it.
    ends_line: bool,
}

impl Writer<'_> {
    pub(super) fn equation(&mut self, before: Vec<Token>) {
        self.alone(&before, INSIDE);
        let first = self.tokens[self.at];
        let from = self.at;
        let rest = self.tokens[from..].iter();
        let end = rest
            .take_while(|one| one.kind != TokenKind::Semicolon)
            .count();
        self.at = (from + end + 1).min(self.tokens.len());
        let last = self.tokens[self.at - 1];
        let pieces = self.pieces(from..self.at);
        self.begin_line(INSIDE, Some(&first));
        self.broken(&pieces);
        self.end = last.span.end;
        for one in self.comments_behind() {
            self.out.push(' ');
            let text = self.comment(one, INSIDE);
            self.out.push_str(&text);
            self.end = one.span.end;
        }
        self.out.push('\n');
    }

    fn pieces(&self, range: std::ops::Range<usize>) -> Vec<Piece> {
        let mut pieces: Vec<Piece> = Vec::with_capacity(range.len());
        let mut depth = 0u32;
        let mut before: Option<TokenKind> = None;
        // Of the last token that was printed, comments too.
        let mut wants_space = false;
        for token in &self.tokens[range] {
            if token.kind.is_comment() {
                pieces.push(Piece {
                    text: self.comment(*token, FURTHER),
                    is_spaced: true,
                    cost: None,
                    ends_line: token.kind == TokenKind::LineComment,
                });
                wants_space = true;
                continue;
            }
            let is_operand_before = matches!(
                before,
                Some(TokenKind::Word | TokenKind::Number | TokenKind::Close)
            );
            let (is_operator, cost) = match token.kind {
                TokenKind::Equals => (true, None),
                TokenKind::Less
                | TokenKind::LessOrEqual
                | TokenKind::Greater
                | TokenKind::GreaterOrEqual => (true, Some(depth * 4 + 1)),
                TokenKind::Plus | TokenKind::Minus if is_operand_before => {
                    (true, Some(depth * 4 + 2))
                }
                TokenKind::Star | TokenKind::Slash => (true, Some(depth * 4 + 3)),
                _ => (false, None),
            };
            // Behind a comma it is as good as at the commas themselves.
            let cost = if before == Some(TokenKind::Comma) {
                Some(depth * 4)
            } else {
                cost
            };
            pieces.push(Piece {
                text: slice(self.text, token.span).to_owned(),
                is_spaced: is_operator || (wants_space && !pieces.is_empty()),
                cost,
                ends_line: false,
            });
            match token.kind {
                TokenKind::Open => depth += 1,
                TokenKind::Close => depth = depth.saturating_sub(1),
                _ => {}
            }
            wants_space = is_operator || token.kind == TokenKind::Comma;
            before = Some(token.kind);
        }
        pieces
    }

    /// Prints pieces in lines that are not too long, where that can be.
    fn broken(&mut self, pieces: &[Piece]) {
        let mut start = 0;
        let mut indent = INSIDE;
        while start < pieces.len() {
            let end = line_end(&pieces[start..], WIDTH - indent) + start;
            if start > 0 {
                self.out.push('\n');
                self.spaces(FURTHER);
            }
            indent = FURTHER;
            for (at, piece) in pieces[start..end].iter().enumerate() {
                if at > 0 && piece.is_spaced {
                    self.out.push(' ');
                }
                self.out.push_str(&piece.text);
            }
            start = end;
        }
    }
}

/// How many pieces make one line of this width, at least one.
fn line_end(pieces: &[Piece], width: usize) -> usize {
    let mut column = 0;
    let mut best: Option<(u32, usize)> = None;
    for (at, piece) in pieces.iter().enumerate() {
        if at > 0 && piece.is_spaced {
            column += 1;
        }
        let last = piece.text.rsplit('\n').next().unwrap_or_default();
        if last.len() < piece.text.len() {
            column = 0;
        }
        column += last.chars().count();
        // A break directly after the first piece gains nothing.
        if let Some(cost) = piece.cost
            && at > 1
            && (column <= width || best.is_none())
            && best.is_none_or(|(least, _)| cost <= least)
        {
            best = Some((cost, at));
        }
        if column > width
            && let Some((_, at)) = best
        {
            return at;
        }
        if piece.ends_line {
            return at + 1;
        }
    }
    pieces.len()
}
