//! Tokens of a program as text, one after another, and the values that they are.
//!
//! Owns looking ahead. What a line is made of is known to [`super`].

use super::super::error_at;
use super::super::lexer::{Lexed, Sign, Token};
use super::super::words::{self, Wanted};
use super::Parser;
use lang_text::problem::Problem;

impl<'a> Parser<'a> {
    pub(super) fn peek(&mut self, count: usize) -> &Lexed<'a> {
        while self.ahead.len() <= count {
            let next = self.lexer.next();
            self.ahead.push_back(next);
        }
        &self.ahead[count]
    }

    pub(super) fn take(&mut self) -> Lexed<'a> {
        match self.ahead.pop_front() {
            Some(lexed) => lexed,
            None => self.lexer.next(),
        }
    }

    pub(super) fn offset(&mut self) -> usize {
        self.peek(0).at
    }

    pub(super) fn sign_at(&mut self, count: usize, sign: Sign) -> bool {
        self.peek(count).token == Token::Sign(sign)
    }

    /// The next token if it is a word, which stays.
    pub(super) fn word(&mut self) -> Option<&'a str> {
        match self.peek(0).token {
            Token::Word(word) => Some(word),
            Token::Number(_)
            | Token::Text(_)
            | Token::Sign(_)
            | Token::Line
            | Token::End
            | Token::Wrong(_) => None,
        }
    }

    pub(super) fn expected(&mut self, wanted: Wanted) -> Problem {
        self.refused(|token| words::expected(wanted, token))
    }

    pub(super) fn sign(&mut self, sign: Sign) -> Result<(), Problem> {
        if !self.sign_at(0, sign) {
            return Err(self.expected(Wanted::Sign(sign.text())));
        }
        self.take();
        Ok(())
    }

    pub(super) fn skip_lines(&mut self) {
        while self.next_is(|token| *token == Token::Line) {
            self.take();
        }
    }

    /// A word or a text.
    pub(super) fn text(&mut self, wanted: Wanted) -> Result<String, Problem> {
        match &mut self.peek_mut().token {
            Token::Word(word) => {
                let word = (*word).to_owned();
                self.take();
                Ok(word)
            }
            Token::Text(text) => {
                let text = std::mem::take(text);
                self.take();
                Ok(text)
            }
            Token::Number(_) | Token::Sign(_) | Token::Line | Token::End | Token::Wrong(_) => {
                Err(self.expected(wanted))
            }
        }
    }

    pub(super) fn peek_mut(&mut self) -> &mut Lexed<'a> {
        self.peek(0);
        &mut self.ahead[0]
    }

    /// A word, a number or a text.
    pub(super) fn value(&mut self) -> Result<String, Problem> {
        match self.number() {
            Some(text) => Ok(text.to_owned()),
            None => self.text(Wanted::Value),
        }
    }

    /// The next token if it is a number, which is taken.
    pub(super) fn number(&mut self) -> Option<&'a str> {
        let text = match self.peek(0).token {
            Token::Number(text) => text,
            Token::Word(_)
            | Token::Text(_)
            | Token::Sign(_)
            | Token::Line
            | Token::End
            | Token::Wrong(_) => return None,
        };
        self.take();
        Some(text)
    }

    pub(super) fn whole<T: std::str::FromStr>(&mut self, wanted: Wanted) -> Result<T, Problem> {
        let at = self.offset();
        let Some(text) = self.number() else {
            return Err(self.expected(wanted));
        };
        let number = text.parse().ok();
        number.ok_or_else(|| error_at(at, words::bad_number(text)))
    }

    pub(super) fn coordinate(&mut self) -> Result<f64, Problem> {
        let at = self.offset();
        // What places may be besides, since no project may be lost.
        if let Some(word) = self.word().filter(|word| ["inf", "NaN"].contains(word)) {
            self.take();
            return Ok(if word == "inf" {
                f64::INFINITY
            } else {
                f64::NAN
            });
        }
        let Some(text) = self.number() else {
            return Err(self.expected(Wanted::Coordinate));
        };
        let number = text.parse().unwrap_or(f64::NAN);
        match number.is_finite() || text == "-inf" {
            true => Ok(number),
            false => Err(error_at(at, words::far_number(text))),
        }
    }

    pub(super) fn point(&mut self) -> Result<(f64, f64), Problem> {
        let x = self.coordinate()?;
        self.sign(Sign::Comma)?;
        Ok((x, self.coordinate()?))
    }
}
