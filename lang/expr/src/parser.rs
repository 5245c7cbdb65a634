//! Tokens to a tree: a Pratt parser of the language as TRIK Studio has it.
//!
//! Its messages come in the order in which the real program's combinators give them, and stand where those stand: at
//! the token that does not fit, at the last one when the text ends too early. Depth is limited.

use super::escape;
use super::lexer::{Placed, Token, tokens};
use super::tree::{Binary, Field, Id, Node, Tree, UNARY_PRECEDENCE, Unary};
use super::words::{Fault, Meant, Reason};
use crate::limits;
use lang_text::problem::Position;

/// Something was wrong and has been told.
struct Failed;

type Parsed<T> = Result<T, Failed>;

/// The tree of a text, and what is wrong with it; with faults it has no root.
pub fn parse(text: &str) -> (Tree, Vec<Fault>) {
    let (tokens, faults) = tokens(text);
    let mut parser = Parser {
        text,
        tokens,
        position: 0,
        depth: 0,
        tree: Tree::default(),
        depths: Vec::new(),
        faults,
    };
    let root = parser.block();
    if parser.position < parser.tokens.len() {
        parser.unexpected();
    }
    if parser.faults.is_empty() {
        parser.tree.root = root.ok();
    } else {
        parser.tree = Tree::default();
    }
    (parser.tree, parser.faults)
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Placed>,
    position: usize,
    depth: u16,
    tree: Tree,
    /// How deep the tree below each node is.
    depths: Vec<u16>,
    faults: Vec<Fault>,
}

impl<'a> Parser<'a> {
    fn is_end(&self) -> bool {
        self.position >= self.tokens.len()
    }

    /// The next token; the last one again, at the end.
    fn next(&self) -> Option<&Placed> {
        self.tokens.get(self.position).or(self.tokens.last())
    }

    /// The next token, if there is one.
    fn peek(&self) -> Option<Token> {
        self.tokens.get(self.position).map(|placed| placed.token)
    }

    fn sees(&self, word: &str) -> bool {
        matches!(self.peek(), Some(Token::Word(seen)) if seen == word)
    }

    fn here(&self) -> Position {
        self.next()
            .map_or(Position { line: 1, column: 1 }, |placed| placed.at)
    }

    fn lexeme(&self) -> &'a str {
        self.next()
            .map_or("", |placed| &self.text[placed.bytes.clone()])
    }

    fn fault(&mut self, reason: Reason) -> Failed {
        self.fault_at(reason, self.here())
    }

    fn fault_at(&mut self, reason: Reason, at: Position) -> Failed {
        // What follows from a fault is told as the real program tells it, but nothing of a text that was given up.
        let mut told = self.faults.iter();
        let is_told = told.any(|fault| fault.reason == Reason::TooDeep);
        if !is_told && self.faults.len() < limits::EXPRESSION_PROBLEMS_MAX {
            self.faults.push(Fault::new(reason, at));
        }
        Failed
    }

    /// Tells a token that cannot stand here, with what may be meant.
    fn unexpected(&mut self) -> Failed {
        let before = self.position.checked_sub(1);
        let before = before.and_then(|at| self.tokens.get(at));
        let meant = match (before.map(|placed| placed.token), self.peek()) {
            (Some(Token::Word("=")), Some(Token::Word(">"))) => Meant::Sign(">="),
            (Some(Token::Word("=")), Some(Token::Word("<"))) => Meant::Sign("<="),
            (_, Some(Token::Word("="))) => Meant::Sign("=="),
            (_, Some(Token::Word(word))) if word.starts_with(char::is_alphabetic) => Meant::Block,
            (_, Some(Token::Name | Token::Int | Token::Float | Token::Text | Token::Word(_)))
            | (_, None) => Meant::Unknown,
        };
        self.fault(Reason::UnexpectedToken(self.lexeme().to_owned(), meant))
    }

    /// Tells that another token is wanted here.
    fn wants(&mut self, wanted: &'static str) -> Failed {
        let reason = match self.peek() {
            Some(token) => Reason::Expected(wanted, token.shown()),
            None => Reason::ExpectedAtEnd(wanted),
        };
        self.fault(reason)
    }

    fn expect(&mut self, word: &'static str) -> Parsed<()> {
        if self.sees(word) {
            self.position += 1;
            return Ok(());
        }
        Err(self.wants(word))
    }

    fn add(&mut self, node: Node, at: Position) -> Parsed<Id> {
        let mut below = 0;
        let id = Id::try_from(self.tree.nodes.len()).unwrap_or(Id::MAX);
        self.tree.nodes.push(node);
        self.tree.places.push(at);
        self.tree.children(id, |child| {
            below = below.max(self.depths[child as usize]);
        });
        self.depths.push(below + 1);
        if below + 1 > limits::EXPRESSION_DEPTH_MAX {
            return Err(self.fault_at(Reason::TooDeep, at));
        }
        Ok(id)
    }

    fn at(&self, id: Id) -> Position {
        self.tree.place(id)
    }

    /// Whether an expression can begin here.
    fn begins_expression(&self) -> bool {
        match self.peek() {
            Some(Token::Word(word)) => matches!(
                word,
                "nil" | "false" | "true" | "..." | "(" | "{" | "-" | "not" | "#" | "~"
            ),
            Some(_) => true,
            None => false,
        }
    }

    fn block(&mut self) -> Parsed<Id> {
        let mut statements = Vec::new();
        while self.begins_expression() || self.sees(";") {
            if self.sees(";") {
                self.position += 1;
            } else {
                self.statement(&mut statements)?;
            }
        }
        if let [only] = statements[..] {
            return Ok(only);
        }
        let at = statements
            .first()
            .map_or(Position { line: 1, column: 1 }, |&id| self.at(id));
        self.add(Node::Block(statements), at)
    }

    fn statement(&mut self, into: &mut Vec<Id>) -> Parsed<()> {
        let left = self.expressions();
        if !self.sees("=") {
            let left = left?;
            let statement = match left[..] {
                [only] => only,
                _ => {
                    let fields = left
                        .iter()
                        .map(|&value| Field { key: None, value })
                        .collect();
                    let at = self.at(left[0]);
                    self.add(Node::Table { fields, bare: true }, at)?
                }
            };
            into.push(statement);
            return Ok(());
        }
        self.position += 1;
        let right = self.expressions();
        let (left, right) = (left?, right?);
        let at = self.at(left[0]);
        if left.len() != right.len() {
            return Err(self.fault_at(Reason::CountsDiffer, at));
        }
        for (&target, &value) in left.iter().zip(&right) {
            if matches!(self.tree.node(target), Node::Call { .. }) {
                self.fault_at(Reason::AssignToCall, at);
                continue;
            }
            let place = self.at(target);
            into.push(self.add(Node::Assign { target, value }, place)?);
        }
        Ok(())
    }

    /// One expression or more, with commas between.
    fn expressions(&mut self) -> Parsed<Vec<Id>> {
        let mut found = Vec::new();
        let mut outcome = self.expression().map(|id| found.push(id));
        while self.sees(",") {
            self.position += 1;
            match self.expression() {
                Ok(id) => found.push(id),
                Err(failed) => return Err(failed),
            }
        }
        outcome = outcome.and(Ok(()));
        outcome.map(|()| found)
    }

    fn expression(&mut self) -> Parsed<Id> {
        self.binary(0)
    }

    fn binary(&mut self, least: u8) -> Parsed<Id> {
        if self.depth >= limits::EXPRESSION_DEPTH_MAX {
            // What follows is of no use, and would be told again at each level.
            let failed = self.fault(Reason::TooDeep);
            self.position = self.tokens.len();
            return Err(failed);
        }
        self.depth += 1;
        let found = self.binary_inside(least);
        self.depth -= 1;
        found
    }

    fn binary_inside(&mut self, least: u8) -> Parsed<Id> {
        let mut left = self.primary()?;
        while let Some(Token::Word(word)) = self.peek()
            && let Some(operator) = Binary::of(word)
            && operator.precedence() >= least
        {
            self.position += 1;
            let next = operator.precedence() + u8::from(!operator.is_right());
            let right = self.binary(next)?;
            let at = self.at(left);
            left = self.add(Node::Binary(operator, left, right), at)?;
        }
        Ok(left)
    }

    fn primary(&mut self) -> Parsed<Id> {
        let Some(token) = self.peek() else {
            return Err(self.fault(Reason::UnexpectedEnd));
        };
        let at = self.here();
        let text = self.lexeme();
        let simple = match token {
            Token::Int => Node::Int(text.into()),
            Token::Float => Node::Float(text.into()),
            Token::Text => Node::Text(escape::unquote(text).into()),
            Token::Word("nil") => Node::Nil,
            Token::Word("true") => Node::Bool(true),
            Token::Word("false") => Node::Bool(false),
            Token::Word("...") => {
                let failed = self.fault(Reason::NotSupportedYet);
                self.position += 1;
                return Err(failed);
            }
            Token::Name | Token::Word("(") => return self.prefixed(),
            Token::Word("{") => return self.table(),
            Token::Word("-") => return self.unary(Unary::Minus),
            Token::Word("not") => return self.unary(Unary::Not),
            Token::Word("#") => return self.unary(Unary::Length),
            Token::Word("~") => return self.unary(Unary::BitNot),
            Token::Word(_) => return Err(self.unexpected()),
        };
        self.position += 1;
        self.add(simple, at)
    }

    fn unary(&mut self, operator: Unary) -> Parsed<Id> {
        let at = self.here();
        self.position += 1;
        let operand = self.binary(UNARY_PRECEDENCE)?;
        self.add(Node::Unary(operator, operand), at)
    }

    /// A name or an expression in brackets, with what follows it: indices and calls.
    fn prefixed(&mut self) -> Parsed<Id> {
        let mut found = self.prefix();
        loop {
            let Some(token) = self.peek() else {
                return found;
            };
            match token {
                Token::Word("[" | ".") => {
                    let index = self.index();
                    let (table, index) = (found?, index?);
                    let at = self.at(table);
                    found = self.add(Node::Index { table, index }, at);
                }
                Token::Word(":") => {
                    self.position += 1;
                    let name = self.name();
                    let arguments = self.arguments();
                    let (object, name, arguments) = (found?, name?, arguments?);
                    let at = self.at(object);
                    found = self.add(
                        Node::Method {
                            object,
                            name,
                            arguments,
                        },
                        at,
                    );
                }
                Token::Word("(" | "{") | Token::Text => {
                    let arguments = self.arguments();
                    let (function, arguments) = (found?, arguments?);
                    let at = self.at(function);
                    found = self.add(
                        Node::Call {
                            function,
                            arguments,
                        },
                        at,
                    );
                }
                Token::Name | Token::Int | Token::Float | Token::Word(_) => return found,
            }
        }
    }

    fn prefix(&mut self) -> Parsed<Id> {
        if !self.sees("(") {
            return self.name();
        }
        self.position += 1;
        let inner = self.expression();
        let closed = self.expect(")");
        let inner = inner?;
        closed.map(|()| inner)
    }

    fn name(&mut self) -> Parsed<Id> {
        if self.peek() != Some(Token::Name) {
            return Err(self.wants("identifier"));
        }
        let at = self.here();
        let name = Node::Name(self.lexeme().into());
        self.position += 1;
        self.add(name, at)
    }

    fn index(&mut self) -> Parsed<Id> {
        if self.sees("[") {
            self.position += 1;
            let index = self.expression();
            let closed = self.expect("]");
            let index = index?;
            return closed.map(|()| index);
        }
        self.position += 1;
        let at = self.here();
        if self.peek() != Some(Token::Name) {
            return Err(self.wants("identifier"));
        }
        let name = Node::Text(self.lexeme().into());
        self.position += 1;
        self.add(name, at)
    }

    fn arguments(&mut self) -> Parsed<Vec<Id>> {
        match self.peek() {
            Some(Token::Word("(")) => {
                self.position += 1;
                let inner = if self.begins_expression() {
                    self.expressions()
                } else if self.is_end() {
                    // As the real program has it: what is missing is the expression, then the bracket.
                    Err(self.fault(Reason::UnexpectedEnd))
                } else {
                    Ok(Vec::new())
                };
                let closed = self.expect(")");
                let inner = inner?;
                closed.map(|()| inner)
            }
            Some(Token::Word("{")) => self.table().map(|id| vec![id]),
            Some(Token::Text) => {
                let at = self.here();
                let text = Node::RawText(self.lexeme().into());
                self.position += 1;
                self.add(text, at).map(|id| vec![id])
            }
            Some(_) => Err(self.unexpected()),
            None => Err(self.fault(Reason::UnexpectedEnd)),
        }
    }

    fn table(&mut self) -> Parsed<Id> {
        let mut at = self.here();
        self.position += 1;
        let mut fields = Vec::new();
        while self.begins_expression() || self.sees("[") {
            let field = self.field()?;
            if fields.is_empty() {
                at = self.at(field.key.unwrap_or(field.value));
            }
            fields.push(field);
            if !self.sees(",") && !self.sees(";") {
                break;
            }
            self.position += 1;
        }
        self.expect("}")?;
        self.add(
            Node::Table {
                fields,
                bare: false,
            },
            at,
        )
    }

    fn field(&mut self) -> Parsed<Field> {
        if self.sees("[") {
            self.position += 1;
            let key = self.expression();
            self.expect("]")?;
            self.expect("=")?;
            let value = self.expression()?;
            return Ok(Field {
                key: Some(key?),
                value,
            });
        }
        let first = self.expression()?;
        if !self.sees("=") {
            return Ok(Field {
                key: None,
                value: first,
            });
        }
        self.position += 1;
        let value = self.expression()?;
        Ok(Field {
            key: Some(first),
            value,
        })
    }
}
