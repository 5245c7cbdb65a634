//! Breakpoints as a client sets them: by lines, by names of subprograms and blocks, by ids, by variables.
//!
//! Owns which of them are set. A client always says all of one kind; what it does not say any more is taken away.

use crate::debug::listing::Listing;
use crate::debug::target::words::ambiguous;
use crate::debug::target::{Target, why_not};
use crate::error::Error;
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Breakpoint, Spot};
use serde_json::{Value, json};
use std::fmt;

/// How a client says where a breakpoint is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Kind {
    /// A line of the text.
    Line,
    /// A subprogram, all blocks of a type, or one block as a person sees it.
    Name,
    /// The id of a block.
    Id,
    /// A variable that changes.
    Variable,
}

/// A breakpoint that is set.
#[derive(Clone, Debug)]
struct Set {
    kind: Kind,
    /// What the client calls it, as long as it wants it; several blocks of one name are one for it.
    id: u64,
    /// What the program that runs calls it.
    number: u64,
    point: Breakpoint,
    /// Why the program that runs does not have it.
    refused: Option<String>,
}

/// All that are set.
#[derive(Debug, Default)]
pub(super) struct Points {
    set: Vec<Set>,
    /// How many a client has been told of.
    ids: u64,
    /// Whether errors in blocks stop the program.
    pub stops_at_errors: bool,
}

fn text(value: &Value, name: &str) -> Box<str> {
    let text = value.get(name).and_then(Value::as_str);
    // A breakpoint is an order of lines.
    text.unwrap_or_default()
        .replace(['\n', '\r'], " ")
        .trim()
        .into()
}

/// What is said of a name that means nothing.
const NO_NAME: &str = "there is no subprogram and no block of this name";

/// Why a breakpoint of a client is not set. Each is for the client's person to mend, or for the robot, which says why.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Unset {
    /// What is said of hits is no number of them.
    Hits,
    /// What is said of one of these is blank.
    Blank(&'static str),
    /// There is no block where it should be.
    Nowhere(Kind),
    /// There is none of this name; the one that may be meant, as a sentence to append.
    NotNamed(String),
    /// A name means several blocks, and how each of them is said.
    Ambiguous(String, String),
    /// The debugger refuses it.
    Refused(String),
}

impl fmt::Display for Unset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Hits => "a number of hits from 1 on is wanted, such as 5, >= 5 or > 5",
            Self::Blank(what) => {
                return write!(f, "the {what} is blank: write one, or leave it out");
            }
            Self::Nowhere(Kind::Line) => "this line has no block",
            Self::Nowhere(Kind::Name) => NO_NAME,
            Self::NotNamed(near) => return write!(f, "{NO_NAME}{near}"),
            Self::Ambiguous(name, choices) => {
                return f.write_str(&ambiguous(name, choices).english);
            }
            Self::Nowhere(Kind::Id) => "there is no block with this id",
            Self::Nowhere(Kind::Variable) => "a name of a variable is wanted",
            Self::Refused(why) => why,
        })
    }
}

/// From which hit on a breakpoint stops: `5`, `>= 5`, `> 5`.
///
/// # Errors
/// It is something else.
fn hits(text: &str) -> Result<u32, Unset> {
    let (digits, more) = match text.trim().strip_prefix(">=") {
        Some(rest) => (rest, 0),
        None => match text.trim().strip_prefix('>') {
            Some(rest) => (rest, 1),
            None => (text, 0),
        },
    };
    match digits.trim() {
        "" => Ok(0),
        digits => {
            let hits: Result<u32, _> = digits.parse();
            let hits = hits.map(|hits| hits.saturating_add(more));
            // Such a count would stop as if none had been said.
            let hits = hits.ok().filter(|hits| *hits > 0);
            hits.ok_or(Unset::Hits)
        }
    }
}

/// What of a breakpoint is written and has nothing in it; clients leave out what they do not mean, or send no letter.
fn blank(one: &Value) -> Option<&'static str> {
    let parts = [
        ("condition", "condition"),
        ("hitCondition", "count of hits"),
        ("logMessage", "log message"),
    ];
    let is_blank = |name: &str| {
        let text = one.get(name).and_then(Value::as_str);
        text.is_some_and(|text| !text.is_empty() && text.trim().is_empty())
    };
    let found = parts.into_iter().find(|(name, _)| is_blank(name));
    found.map(|(_, what)| what)
}

/// The blocks of a name.
fn named(name: &str, listing: &Listing) -> Result<Vec<Box<str>>, Unset> {
    match listing.named(name) {
        Ok(blocks) if blocks.is_empty() => Err(Unset::NotNamed(listing.near(name).english)),
        Ok(blocks) => Ok(blocks),
        Err(blocks) => {
            let choices = listing.choices(&blocks);
            Err(Unset::Ambiguous(name.to_owned(), choices))
        }
    }
}

impl Points {
    /// Sets all of a kind as a client says; for each what has become of it.
    pub fn set(
        &mut self,
        kind: Kind,
        wanted: &[Value],
        listing: &Listing,
        target: &mut dyn Target,
    ) -> Result<Value, Error> {
        let (gone, kept) = std::mem::take(&mut self.set)
            .into_iter()
            .partition(|set| set.kind == kind);
        self.set = kept;
        let gone: Vec<Set> = gone;
        for set in gone {
            if let Ok(number) = u32::try_from(set.number) {
                target.order(&Order::Clear(Some(number)))?;
            }
        }
        let mut told = Vec::new();
        for one in wanted {
            told.push(self.add(kind, one, listing, target)?);
        }
        Ok(json!({ "breakpoints": told }))
    }

    fn add(
        &mut self,
        kind: Kind,
        one: &Value,
        listing: &Listing,
        target: &mut dyn Target,
    ) -> Result<Value, Error> {
        let line = one.get("line").and_then(Value::as_u64);
        let line = line
            .and_then(|line| usize::try_from(line).ok())
            .unwrap_or(0);
        let refused = |why: &Unset| {
            let why = why.to_string();
            json!({"verified": false, "message": why, "line": line.max(1)})
        };
        if let Some(what) = blank(one) {
            return Ok(refused(&Unset::Blank(what)));
        }
        let from_hit = match hits(&text(one, "hitCondition")) {
            Ok(hits) => hits,
            Err(why) => return Ok(refused(&why)),
        };
        let before = |blocks: Vec<Box<str>>| blocks.into_iter().map(Spot::Block).collect();
        let spots: Vec<Spot> = match kind {
            Kind::Line => before(listing.blocks(line).first().cloned().into_iter().collect()),
            Kind::Name => match named(&text(one, "name"), listing) {
                Ok(blocks) => before(blocks),
                Err(why) => return Ok(refused(&why)),
            },
            Kind::Id => {
                let id = text(one, "instructionReference");
                before(listing.has(&id).then_some(id).into_iter().collect())
            }
            Kind::Variable => {
                let name = text(one, "dataId");
                let name = (!name.is_empty()).then_some(name);
                name.map(Spot::Change).into_iter().collect()
            }
        };
        let mut first = None;
        self.ids += 1;
        let id = self.ids;
        for spot in spots {
            let point = Breakpoint {
                at: spot.clone(),
                condition: text(one, "condition"),
                from_hit,
                log: text(one, "logMessage"),
                ..Breakpoint::default()
            };
            let answer = target.order(&Order::Break(point.clone()))?;
            if let Some(why) = why_not(&answer) {
                return Ok(refused(&Unset::Refused(why)));
            }
            let number = answer.get("number").and_then(Value::as_u64).unwrap_or(0);
            let set = Set {
                kind,
                id,
                number,
                point,
                refused: None,
            };
            first.get_or_insert_with(|| set.told(listing));
            self.set.push(set);
        }
        Ok(first.unwrap_or_else(|| refused(&Unset::Nowhere(kind))))
    }

    /// Sets all again, for a program that has begun anew.
    pub fn set_again(&mut self, target: &mut dyn Target) -> Result<(), Error> {
        for set in &mut self.set {
            set.put(target)?;
        }
        Ok(())
    }

    /// Sets those again that an earlier version could not have.
    pub fn set_missing(&mut self, target: &mut dyn Target) -> Result<(), Error> {
        for set in self.set.iter_mut().filter(|set| set.refused.is_some()) {
            set.put(target)?;
        }
        Ok(())
    }

    /// What a client is to know of each in another text, by the ids that it has.
    pub fn places(&self, listing: &Listing) -> Vec<Value> {
        let mut told: Vec<(u64, Value)> = Vec::new();
        for set in &self.set {
            let now = set.told(listing);
            match told.last_mut() {
                // Of several blocks the first that is there counts.
                Some((id, before)) if *id == set.id => {
                    if before["verified"] == false {
                        *before = now;
                    }
                }
                Some(_) | None => told.push((set.id, now)),
            }
        }
        told.into_iter().map(|(_, told)| told).collect()
    }

    /// What the client calls a breakpoint of the program.
    pub fn id_of(&self, number: u64) -> Option<u64> {
        let mut all = self.set.iter().filter(|set| set.refused.is_none());
        all.find(|set| set.number == number).map(|set| set.id)
    }
}

impl Set {
    /// Sets it in the program that runs.
    fn put(&mut self, target: &mut dyn Target) -> Result<(), Error> {
        let answer = target.order(&Order::Break(self.point.clone()))?;
        self.refused = why_not(&answer);
        self.number = answer.get("number").and_then(Value::as_u64).unwrap_or(0);
        Ok(())
    }

    /// What a client is to know of it.
    fn told(&self, listing: &Listing) -> Value {
        let id = self.id;
        if let Some(why) = &self.refused {
            return json!({"id": id, "verified": false, "message": why});
        }
        match &self.point.at {
            Spot::Block(block) if listing.has(block) => {
                json!({"id": id, "verified": true, "line": listing.line_of(block)})
            }
            Spot::Block(_) => {
                let why = "the new version has no such block";
                json!({"id": id, "verified": false, "message": why})
            }
            Spot::Change(_) => json!({"id": id, "verified": true}),
        }
    }
}
