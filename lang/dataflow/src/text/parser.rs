//! Lines of a program as text to a draft.
//!
//! Owns the grammar, and where reading goes on after an error. Labels, ports and names of diagrams are looked up later, in
//! [`super::resolve`]. Nothing nests, so nothing here calls itself.

mod tokens;

use super::draft::{
    BlockDraft, Called, DiagramDraft, EdgeDraft, EndDraft, IdsDraft, Placed, PortDraft,
    ProjectDraft,
};
use super::lexer::{Lexed, Lexer, Sign, Token, Wrong};
use super::words::{self, Wanted};
use super::{error_at, ids, tell};
use crate::blocks::{self, Row};
use crate::limits;
use crate::project::{DiagramKind, Policy};
use lang_text::problem::{Problem, Words};
use std::collections::VecDeque;

/// The key that `kit` stands for.
pub(super) const KIT: &str = "lastKitId";
/// The end of an edge that is at no block.
pub(super) const NOWHERE: &str = "nowhere";

/// How far a colon is looked for after a word that begins no line.
const LONG_LABEL_TOKENS: usize = 8;
/// Words that begin a line.
const STARTS: [&str; 6] = ["kit", "meta", "run", "diagram", "subprogram", NOWHERE];
const DIAGRAM_CLAUSES: [&str; 3] = ["run", "id", "logical"];
const BLOCK_CLAUSES: [&str; 6] = ["of", "named", "at", "element", "id", "logical"];
const EDGE_CLAUSES: [&str; 6] = ["fifo", "latest", "error", "capacity", "via", "id"];

/// What a text says; what is wrong with it is added to the problems.
pub(super) fn parse<'a>(text: &'a str, problems: &mut Vec<Problem>) -> ProjectDraft<'a> {
    if text.len() > limits::SOURCE_BYTES_MAX {
        tell(
            problems,
            error_at(0, words::too_long(limits::SOURCE_BYTES_MAX)),
        );
        return ProjectDraft::default();
    }
    let mut parser = Parser {
        lexer: Lexer::new(text),
        ahead: VecDeque::new(),
        draft: ProjectDraft::default(),
        blocks: 0,
        edges: 0,
        properties: 0,
        is_list: false,
        is_over: false,
        homeless: None,
    };
    while !parser.is_over && problems.len() < lang_text::limits::PROBLEMS {
        if parser.next_is(|token| *token == Token::Line) {
            parser.take();
        } else if parser.next_is(|token| *token == Token::End) {
            break;
        } else if let Err(problem) = parser.line() {
            tell(problems, problem);
            parser.recover();
        }
    }
    if let Some(at) = parser.homeless {
        tell(problems, error_at(at, words::no_diagram()));
    }
    // Of what is too much, nothing is looked up.
    match parser.is_over {
        true => ProjectDraft::default(),
        false => parser.draft,
    }
}

struct Parser<'a> {
    lexer: Lexer<'a>,
    /// Tokens that were looked at and not taken.
    ahead: VecDeque<Lexed<'a>>,
    draft: ProjectDraft<'a>,
    blocks: usize,
    edges: usize,
    /// With keys of the project.
    properties: usize,
    /// Whether it is in a list of properties, in which lines end nothing.
    is_list: bool,
    /// Whether there is so much that the rest is not read.
    is_over: bool,
    /// Where the first block or edge stands that is below no diagram.
    homeless: Option<usize>,
}

impl<'a> Parser<'a> {
    fn next_is(&mut self, is: impl Fn(&Token<'a>) -> bool) -> bool {
        is(&self.peek(0).token)
    }

    /// A problem with the next token: that it is none, or else what is said of it.
    fn refused(&mut self, say: impl FnOnce(&Token<'a>) -> Words) -> Problem {
        let Lexed { at, token } = self.peek(0);
        match token {
            Token::Wrong(wrong) => error_at(*at, words::wrong(*wrong)),
            Token::Word(_)
            | Token::Number(_)
            | Token::Text(_)
            | Token::Sign(_)
            | Token::Line
            | Token::End => error_at(*at, say(token)),
        }
    }

    /// Goes on with the next line after an error; with one that looks like a line if a list may have no end.
    fn recover(&mut self) {
        let is_there = self.is_list && self.begins();
        while !is_there && !self.next_is(|token| *token == Token::End) {
            let is_line = self.take().token == Token::Line;
            if is_line && (!self.is_list || self.begins()) {
                break;
            }
        }
        self.is_list = false;
    }

    fn begins(&mut self) -> bool {
        let Some(word) = self.word() else {
            return false;
        };
        let is_start = STARTS.contains(&word) && !self.sign_at(1, Sign::Equals);
        is_start || self.sign_at(1, Sign::Colon) || self.sign_at(1, Sign::Dot)
    }

    fn line(&mut self) -> Result<(), Problem> {
        let Some(word) = self.word() else {
            return Err(self.refused(|token| words::no_line(token, STARTS)));
        };
        if self.sign_at(1, Sign::Colon) {
            return self.block(word);
        }
        if self.sign_at(1, Sign::Dot) {
            return self.edge();
        }
        match word {
            NOWHERE if self.sign_at(1, Sign::Arrow) => self.edge(),
            "diagram" => self.diagram(DiagramKind::Main),
            "subprogram" => self.diagram(DiagramKind::Subprogram),
            "kit" => {
                let at = self.take().at;
                let value = self.value()?;
                self.key(at, KIT.to_owned(), value)
            }
            "meta" => {
                let at = self.take().at;
                let key = self.text(Wanted::Name)?;
                self.sign(Sign::Equals)?;
                let value = self.value()?;
                self.key(at, key, value)
            }
            "run" => self.run_nothing(),
            label if self.sign_at(1, Sign::Arrow) => {
                self.take();
                Err(self.refused(|_| words::no_port(label)))
            }
            _ if self.is_long_label() => Err(self.refused(|_| words::long_label())),
            _ => Err(self.refused(|token| words::no_line(token, STARTS))),
        }
    }

    /// Whether words, numbers or stray signs stand before a colon: a label of several.
    fn is_long_label(&mut self) -> bool {
        let mut count = 1;
        while count < LONG_LABEL_TOKENS {
            match self.peek(count).token {
                Token::Sign(Sign::Colon) => return count > 1,
                Token::Word(_) | Token::Number(_) | Token::Wrong(Wrong::Stray(_)) => count += 1,
                Token::Text(_)
                | Token::Sign(
                    Sign::Comma
                    | Sign::Semicolon
                    | Sign::Equals
                    | Sign::Dot
                    | Sign::Arrow
                    | Sign::Open
                    | Sign::Close,
                )
                | Token::Line
                | Token::End
                | Token::Wrong(Wrong::Quotes | Wrong::Backticks | Wrong::Escape) => return false,
            }
        }
        false
    }

    /// The end of a line that may have these words.
    fn line_end(&mut self, clauses: &[&'static str]) -> Result<(), Problem> {
        if self.next_is(|token| matches!(token, Token::Line | Token::End)) {
            return Ok(());
        }
        Err(self.refused(|token| match clauses.is_empty() {
            true => words::nothing_more(token),
            false => words::surplus(token, clauses),
        }))
    }

    fn key(&mut self, at: usize, key: String, value: String) -> Result<(), Problem> {
        if self.draft.meta.contains_key(&key) {
            return Err(error_at(at, words::key_twice(&key)));
        }
        self.count_property(at)?;
        self.draft.meta.insert(key, value);
        self.line_end(&[])
    }

    fn count_property(&mut self, at: usize) -> Result<(), Problem> {
        self.properties += 1;
        if self.properties <= limits::SOURCE_PROPERTIES_MAX {
            return Ok(());
        }
        self.is_over = true;
        let words = words::too_many_properties(limits::SOURCE_PROPERTIES_MAX);
        Err(error_at(at, words))
    }

    fn run_nothing(&mut self) -> Result<(), Problem> {
        let at = self.take().at;
        if self.word() != Some("nothing") {
            return Err(self.expected(Wanted::Nothing));
        }
        self.take();
        self.chosen(at)?;
        self.draft.is_idle = true;
        self.line_end(&[])
    }

    /// Refuses a second choice of what is run.
    fn chosen(&self, at: usize) -> Result<(), Problem> {
        let is_chosen = self.draft.is_idle || self.draft.diagrams.iter().any(|one| one.is_run);
        match is_chosen {
            true => Err(error_at(at, words::run_twice())),
            false => Ok(()),
        }
    }

    /// A text that is put into a place that must be empty.
    fn once<T>(at: usize, word: &str, place: &mut Option<T>, value: T) -> Result<(), Problem> {
        match place {
            Some(_) => Err(error_at(at, words::twice(word))),
            None => {
                *place = Some(value);
                Ok(())
            }
        }
    }

    /// An id that can be one.
    fn id(&mut self) -> Result<Placed<String>, Problem> {
        let at = self.offset();
        let value = self.text(Wanted::Text)?;
        match ids::can_be(&value) {
            true => Ok(Placed { at, value }),
            false => Err(error_at(at, words::bad_id(&value))),
        }
    }

    /// The id after the word `logical`; an object may have none.
    fn logical(&mut self) -> Result<String, Problem> {
        let at = self.offset();
        let value = self.text(Wanted::Text)?;
        match value.is_empty() || ids::can_be(&value) {
            true => Ok(value),
            false => Err(error_at(at, words::bad_id(&value))),
        }
    }

    fn diagram(&mut self, kind: DiagramKind) -> Result<(), Problem> {
        let at = self.take().at;
        if self.draft.diagrams.len() >= limits::SOURCE_DIAGRAMS_MAX {
            self.is_over = true;
            let words = words::too_many_diagrams(limits::SOURCE_DIAGRAMS_MAX);
            return Err(error_at(at, words));
        }
        // What follows belongs to it, whatever is wrong with its line.
        self.draft.diagrams.push(DiagramDraft::new(at, kind));
        let name = self.text(Wanted::Name)?;
        let mut ids = IdsDraft::default();
        let mut is_run = false;
        while let Some(word) = self.word().filter(|word| DIAGRAM_CLAUSES.contains(word)) {
            let at = self.take().at;
            match word {
                "id" => Self::once(at, word, &mut ids.graphical, self.id()?)?,
                "logical" => Self::once(at, word, &mut ids.logical, self.logical()?)?,
                _ if is_run => return Err(error_at(at, words::twice(word))),
                _ => {
                    self.chosen(at)?;
                    is_run = true;
                }
            }
        }
        if let Some(diagram) = self.draft.diagrams.last_mut() {
            (diagram.name, diagram.ids, diagram.is_run) = (name, ids, is_run);
        }
        self.line_end(&DIAGRAM_CLAUSES)
    }

    /// One mistake where the line of a diagram is forgotten, and not one for each line below it.
    fn need_diagram(&mut self, at: usize) {
        if self.draft.diagrams.is_empty() {
            self.homeless = Some(at);
            let diagram = DiagramDraft::new(at, DiagramKind::Main);
            self.draft.diagrams.push(diagram);
        }
    }

    fn block(&mut self, label: &'a str) -> Result<(), Problem> {
        let at = self.take().at;
        self.take();
        self.need_diagram(at);
        if self.blocks >= limits::SOURCE_BLOCKS_MAX {
            self.is_over = true;
            let words = words::too_many_blocks(limits::SOURCE_BLOCKS_MAX);
            return Err(error_at(at, words));
        }
        self.blocks += 1;
        let block = self.block_body(at, label);
        if let Some(diagram) = self.draft.diagrams.last_mut() {
            match block {
                Ok(block) => diagram.blocks.push(block),
                Err(problem) => {
                    diagram.broken.push(label);
                    return Err(problem);
                }
            }
        }
        Ok(())
    }

    fn block_body(&mut self, at: usize, label: &'a str) -> Result<BlockDraft<'a>, Problem> {
        let (row, element) = self.kind()?;
        let mut block = BlockDraft {
            at,
            label,
            row,
            element,
            properties: Default::default(),
            values: Vec::new(),
            caption: None,
            position: None,
            called: None,
            ids: IdsDraft::default(),
        };
        if self.sign_at(0, Sign::Open) {
            self.properties(&mut block)?;
        }
        let mut element = None;
        while let Some(word) = self.word().filter(|word| BLOCK_CLAUSES.contains(word)) {
            let at = self.take().at;
            match word {
                "of" => Self::once(at, word, &mut block.called, self.called()?)?,
                "named" => Self::once(at, word, &mut block.caption, self.text(Wanted::Name)?)?,
                "at" => Self::once(at, word, &mut block.position, self.point()?)?,
                "element" => Self::once(at, word, &mut element, self.text(Wanted::Name)?)?,
                "id" => Self::once(at, word, &mut block.ids.graphical, self.id()?)?,
                _ => Self::once(at, word, &mut block.ids.logical, self.logical()?)?,
            }
        }
        if let Some(element) = element {
            block.element = element;
        }
        self.line_end(&BLOCK_CLAUSES)?;
        Ok(block)
    }

    /// The name of a block: its row and its element.
    fn kind(&mut self) -> Result<(Option<&'static Row>, String), Problem> {
        let at = self.offset();
        let is_word = self.word().is_some();
        let mut name = self.text(Wanted::Block)?;
        if is_word && name == "unknown" && self.next_is(|token| matches!(token, Token::Text(_))) {
            return Ok((None, self.text(Wanted::Text)?));
        }
        if let Some(row) = named(&name) {
            return Ok((Some(row), row.element.to_owned()));
        }
        // The first word of several, perhaps.
        let names = |row: &'static Row| [row.shown, row.russian, row.element];
        let unknown = words::unknown_block(&name, blocks::table().flat_map(names));
        while let Some(word) = self.word().filter(|_| is_word && name.len() < 100) {
            self.take();
            name = format!("{name} {word}");
            if named(&name).is_some() {
                return Err(error_at(at, words::needs_quotes(&name)));
            }
        }
        Err(error_at(at, unknown))
    }

    fn properties(&mut self, block: &mut BlockDraft<'a>) -> Result<(), Problem> {
        self.take();
        self.is_list = true;
        loop {
            self.skip_lines();
            if self.sign_at(0, Sign::Close) {
                self.take();
                self.is_list = false;
                return Ok(());
            }
            let at = self.offset();
            let is_word = self.word().is_some();
            let name = self.text(Wanted::Name)?;
            if let Some(row) = block
                .row
                .filter(|row| is_word && row.property(&name).is_none())
            {
                return Err(error_at(at, no_property(row, &name)));
            }
            self.skip_lines();
            self.sign(Sign::Equals)?;
            self.skip_lines();
            let value_at = self.offset();
            let value = self.value()?;
            if block.properties.contains_key(&name) {
                return Err(error_at(at, words::property_twice(&name)));
            }
            self.count_property(at)?;
            block.values.push((name.clone(), value_at));
            block.properties.insert(name, value);
            self.skip_lines();
            if self.sign_at(0, Sign::Comma) {
                self.take();
            } else if !self.sign_at(0, Sign::Close) {
                return Err(self.expected(Wanted::Comma));
            }
        }
    }

    fn called(&mut self) -> Result<Called, Problem> {
        let is_id = self.word() == Some("id");
        if is_id && matches!(self.peek(1).token, Token::Text(_)) {
            self.take();
            return Ok(Called::Logical(self.text(Wanted::Text)?));
        }
        let at = self.offset();
        let value = self.text(Wanted::Name)?;
        Ok(Called::Name(Placed { at, value }))
    }

    fn end(&mut self) -> Result<Option<EndDraft<'a>>, Problem> {
        let Some(label) = self.word() else {
            return Err(self.expected(Wanted::End));
        };
        let at = self.take().at;
        if !self.sign_at(0, Sign::Dot) {
            if label == NOWHERE {
                return Ok(None);
            }
            return Err(self.refused(|_| words::no_port(label)));
        }
        self.take();
        let port_at = self.offset();
        let port = match self.word() {
            Some(word) => {
                self.take();
                PortDraft::Name(word)
            }
            None => PortDraft::Number(self.whole(Wanted::Port)?),
        };
        Ok(Some(EndDraft {
            at,
            label,
            port_at,
            port,
        }))
    }

    fn edge(&mut self) -> Result<(), Problem> {
        let at = self.offset();
        if self.edges >= limits::SOURCE_EDGES_MAX {
            self.is_over = true;
            return Err(error_at(
                at,
                words::too_many_edges(limits::SOURCE_EDGES_MAX),
            ));
        }
        self.need_diagram(at);
        self.edges += 1;
        let from = self.end()?;
        self.sign(Sign::Arrow)?;
        let to = self.end()?;
        let mut edge = EdgeDraft {
            from,
            to,
            policy: None,
            capacity: None,
            path: Vec::new(),
            id: None,
        };
        while let Some(word) = self.word().filter(|word| EDGE_CLAUSES.contains(word)) {
            let at = self.take().at;
            match (word, Policy::of(word)) {
                (_, Some(policy)) => {
                    Self::once(at, word, &mut edge.policy, policy)?;
                    if self.next_is(|token| matches!(token, Token::Number(_))) {
                        let capacity = self.whole(Wanted::Whole)?;
                        Self::once(at, "capacity", &mut edge.capacity, capacity)?;
                    }
                }
                ("capacity", None) => {
                    let capacity = self.whole(Wanted::Whole)?;
                    Self::once(at, word, &mut edge.capacity, capacity)?;
                }
                ("via", None) => self.path(at, &mut edge.path)?,
                (_, None) => Self::once(at, word, &mut edge.id, self.id()?)?,
            }
        }
        self.line_end(&EDGE_CLAUSES)?;
        if let Some(diagram) = self.draft.diagrams.last_mut() {
            diagram.edges.push(edge);
        }
        Ok(())
    }

    fn path(&mut self, at: usize, path: &mut Vec<(f64, f64)>) -> Result<(), Problem> {
        if !path.is_empty() {
            return Err(error_at(at, words::twice("via")));
        }
        path.push(self.point()?);
        while self.sign_at(0, Sign::Semicolon) {
            self.take();
            path.push(self.point()?);
        }
        Ok(())
    }
}

/// What is said of a property that a block does not have: the editor shows some by another name.
fn no_property(row: &Row, name: &str) -> Words {
    // Units and colons stand behind some names.
    let plain = |shown: &str| {
        let end = shown.find([':', '=', '(']).unwrap_or(shown.len());
        shown[..end].trim().to_lowercase()
    };
    let meant = plain(name);
    let shown = row.properties.iter().find(|one| plain(one.shown) == meant);
    match shown {
        Some(one) if one.name != name => words::shown_property(one.shown, one.name),
        Some(_) | None => {
            let known: Vec<_> = row.properties.iter().map(|one| one.name).collect();
            words::unknown_property(row.shown, name, &known)
        }
    }
}

/// The row of a name that a person knows.
fn named(name: &str) -> Option<&'static Row> {
    blocks::table().find(|row| [row.shown, row.russian, row.element].contains(&name))
}
