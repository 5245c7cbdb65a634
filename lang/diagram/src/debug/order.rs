//! What a person asks of a debugger, as a text: for the network, a terminal, an editor.
//!
//! Owns the words of orders in both directions. An order is a line; a breakpoint may have two more lines. Knows no program:
//! whether there is such a block or thread is found out when the order is carried out.

use std::fmt;

use super::{Back, Breakpoint, Spot, Step};
use crate::limits;
use crate::words::shortened;

pub use super::no_order::{NoOrder, WORDS, Wanted};

/// Something that is asked of a debugger.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Order {
    /// Attach the debugger; the past is kept from now on.
    Attach,
    /// Take it away; a program that is stopped goes on.
    Detach,
    /// Say where the program is.
    Look,
    /// Stop the program as soon as it can be.
    Pause,
    /// Go on; in the past to the next breakpoint there, or to the present.
    Continue,
    /// Go on for a step; of the thread with this name, or of the one at which it is stopped.
    Step(Step, Option<Box<str>>),
    /// Go on to this block.
    Until(Box<str>),
    /// Go back.
    Back(Back),
    /// Leave the past.
    Present,
    /// Hold the thread with this name, and let the others go on.
    Hold(Box<str>),
    /// Let it go on.
    Release(Box<str>),
    /// A breakpoint, at a block or at changes of a variable.
    Break(Breakpoint),
    /// A breakpoint away, by its number; none: all.
    Clear(Option<u32>),
    /// Keep a breakpoint, and let it do nothing, or something again.
    Enable(u32, bool),
    /// Say which breakpoints there are with numbers after this one.
    Breakpoints(u32),
    /// Whether errors stop the program.
    Errors(bool),
    /// Whether motors rest while the program is stopped.
    Motors(bool),
    /// Assign a variable the value of an expression.
    Set(Box<str>, Box<str>),
    /// Compute an expression.
    Evaluate(Box<str>),
}

impl Order {
    /// What a text asks for.
    ///
    /// # Errors
    /// [`NoOrder`].
    pub fn parse(text: &str) -> Result<Self, NoOrder> {
        if text.len() > limits::ORDER_BYTES_MAX {
            return Err(NoOrder::TooLong);
        }
        let (line, more) = text.split_once('\n').unwrap_or((text, ""));
        let (word, rest) = line.trim().split_once(' ').unwrap_or((line.trim(), ""));
        let rest = rest.trim();
        if !more.is_empty() && !matches!(word, "break" | "watch") {
            return Err(NoOrder::Strange(more.into()));
        }
        let order = match word {
            "attach" => Self::Attach,
            "detach" => Self::Detach,
            "look" => Self::Look,
            "pause" => Self::Pause,
            "continue" => Self::Continue,
            "present" => Self::Present,
            "breakpoints" if rest.is_empty() => Self::Breakpoints(0),
            "breakpoints" => return breakpoints(rest),
            "step" => return step(rest),
            "until" => return Ok(Self::Until(some(rest, Wanted::Block)?)),
            "back" => return back(rest).map(Self::Back),
            "hold" => return Ok(Self::Hold(some(rest, Wanted::Thread)?)),
            "release" => return Ok(Self::Release(some(rest, Wanted::Thread)?)),
            "break" => {
                return breakpoint((rest, Wanted::Block), more, Spot::Block).map(Self::Break);
            }
            "watch" => {
                return breakpoint((rest, Wanted::Variable), more, Spot::Change).map(Self::Break);
            }
            "clear" if rest == "all" => return Ok(Self::Clear(None)),
            "clear" => return number(rest).map(|number| Self::Clear(Some(number))),
            "enable" => return number(rest).map(|number| Self::Enable(number, true)),
            "disable" => return number(rest).map(|number| Self::Enable(number, false)),
            "errors" => return either(rest, ["stop", "go"]).map(Self::Errors),
            "motors" => return either(rest, ["rest", "keep"]).map(Self::Motors),
            "set" => {
                let lacks = NoOrder::Lacks(Wanted::Assignment);
                let (name, text) = rest.split_once('=').ok_or(lacks)?;
                return Ok(Self::Set(name.trim().into(), text.trim().into()));
            }
            "evaluate" => return Ok(Self::Evaluate(some(rest, Wanted::Expression)?)),
            _ => return Err(NoOrder::Unknown(shortened(word))),
        };
        match rest {
            "" => Ok(order),
            more => Err(NoOrder::Strange(shortened(more))),
        }
    }

    /// Whether it changes what the program does, so that only the client in control may give it.
    pub fn is_for_control(&self) -> bool {
        match self {
            Self::Look | Self::Breakpoints(_) | Self::Evaluate(_) => false,
            Self::Attach
            | Self::Detach
            | Self::Pause
            | Self::Continue
            | Self::Step(..)
            | Self::Until(_)
            | Self::Back(_)
            | Self::Present
            | Self::Hold(_)
            | Self::Release(_)
            | Self::Break(_)
            | Self::Clear(_)
            | Self::Enable(..)
            | Self::Errors(_)
            | Self::Motors(_)
            | Self::Set(..) => true,
        }
    }

    /// Whether it makes sense only while a debugger is attached.
    pub fn is_for_debugger(&self) -> bool {
        match self {
            Self::Attach
            | Self::Look
            | Self::Breakpoints(_)
            | Self::Evaluate(_)
            | Self::Set(..) => false,
            Self::Detach
            | Self::Pause
            | Self::Continue
            | Self::Step(..)
            | Self::Until(_)
            | Self::Back(_)
            | Self::Present
            | Self::Hold(_)
            | Self::Release(_)
            | Self::Break(_)
            | Self::Clear(_)
            | Self::Enable(..)
            | Self::Errors(_)
            | Self::Motors(_) => true,
        }
    }
}

impl fmt::Display for Order {
    /// The text that [`Order::parse`] understands.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Attach => f.write_str("attach"),
            Self::Detach => f.write_str("detach"),
            Self::Look => f.write_str("look"),
            Self::Pause => f.write_str("pause"),
            Self::Continue => f.write_str("continue"),
            Self::Step(step, None) => write!(f, "step {}", step.word()),
            Self::Step(step, Some(thread)) => write!(f, "step {} {thread}", step.word()),
            Self::Until(block) => write!(f, "until {block}"),
            Self::Back(Back::Step(step)) => write!(f, "back {}", step.word()),
            Self::Back(Back::Continue) => f.write_str("back continue"),
            Self::Back(Back::To(ms)) => write!(f, "back to {ms}"),
            Self::Back(Back::Oldest) => f.write_str("back start"),
            Self::Present => f.write_str("present"),
            Self::Hold(thread) => write!(f, "hold {thread}"),
            Self::Release(thread) => write!(f, "release {thread}"),
            Self::Break(point) => {
                match &point.at {
                    Spot::Block(block) => write!(f, "break {block}")?,
                    Spot::Change(variable) => write!(f, "watch {variable}")?,
                }
                if point.from_hit > 0 {
                    write!(f, " from {}", point.from_hit)?;
                }
                if point.is_once {
                    f.write_str(" once")?;
                }
                if point.is_disabled {
                    f.write_str(" disabled")?;
                }
                if !point.condition.is_empty() {
                    write!(f, "\nif {}", point.condition)?;
                }
                if !point.log.is_empty() {
                    write!(f, "\nlog {}", point.log)?;
                }
                Ok(())
            }
            Self::Clear(None) => f.write_str("clear all"),
            Self::Clear(Some(number)) => write!(f, "clear {number}"),
            Self::Enable(number, true) => write!(f, "enable {number}"),
            Self::Enable(number, false) => write!(f, "disable {number}"),
            Self::Breakpoints(0) => f.write_str("breakpoints"),
            Self::Breakpoints(after) => write!(f, "breakpoints after {after}"),
            Self::Errors(stop) => f.write_str(if *stop { "errors stop" } else { "errors go" }),
            Self::Motors(rest) => f.write_str(if *rest { "motors rest" } else { "motors keep" }),
            Self::Set(name, text) => write!(f, "set {name}={text}"),
            Self::Evaluate(text) => write!(f, "evaluate {text}"),
        }
    }
}

impl Step {
    const ALL: [Self; 3] = [Self::Into, Self::Over, Self::Out];

    /// Its word in orders.
    pub fn word(self) -> &'static str {
        match self {
            Self::Into => "into",
            Self::Over => "over",
            Self::Out => "out",
        }
    }

    fn of(word: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|step| step.word() == word)
    }
}

fn some(text: &str, what: Wanted) -> Result<Box<str>, NoOrder> {
    match text {
        "" => Err(NoOrder::Lacks(what)),
        text => Ok(text.into()),
    }
}

fn number(text: &str) -> Result<u32, NoOrder> {
    text.parse().map_err(|_| NoOrder::Lacks(Wanted::Number))
}

fn either(text: &str, words: [&'static str; 2]) -> Result<bool, NoOrder> {
    match words.iter().position(|word| *word == text) {
        Some(index) => Ok(index == 0),
        None => Err(NoOrder::Strange(shortened(text))),
    }
}

fn step(rest: &str) -> Result<Order, NoOrder> {
    let (word, thread) = rest.split_once(' ').unwrap_or((rest, ""));
    let step = match word {
        "" => Step::Over,
        word => Step::of(word).ok_or_else(|| NoOrder::Strange(shortened(word)))?,
    };
    let thread = thread.trim();
    Ok(Order::Step(
        step,
        (!thread.is_empty()).then(|| thread.into()),
    ))
}

fn back(rest: &str) -> Result<Back, NoOrder> {
    if let Some(ms) = rest.strip_prefix("to ") {
        let ms = ms.trim().parse();
        return ms.map(Back::To).map_err(|_| NoOrder::Lacks(Wanted::Time));
    }
    match rest {
        "" => Ok(Back::Step(Step::Over)),
        "continue" => Ok(Back::Continue),
        "start" => Ok(Back::Oldest),
        word => {
            let step = Step::of(word).map(Back::Step);
            step.ok_or_else(|| NoOrder::Strange(shortened(word)))
        }
    }
}

fn breakpoints(rest: &str) -> Result<Order, NoOrder> {
    match rest.strip_prefix("after ") {
        Some(after) => number(after.trim()).map(Order::Breakpoints),
        None => Err(NoOrder::Strange(shortened(rest))),
    }
}

fn breakpoint(
    (rest, what): (&str, Wanted),
    more: &str,
    spot: impl FnOnce(Box<str>) -> Spot,
) -> Result<Breakpoint, NoOrder> {
    let mut words = rest.split_whitespace();
    let mut point = Breakpoint {
        at: spot(some(words.next().unwrap_or_default(), what)?),
        ..Breakpoint::default()
    };
    while let Some(word) = words.next() {
        match word {
            "from" => {
                let hits = words.next().and_then(|word| word.parse().ok());
                let hits = hits.filter(|hits| *hits > 0);
                point.from_hit = hits.ok_or(NoOrder::Lacks(Wanted::Hits))?;
            }
            "once" => point.is_once = true,
            "disabled" => point.is_disabled = true,
            word => return Err(NoOrder::Strange(shortened(word))),
        }
    }
    for line in more.lines() {
        let (word, text) = line.split_once(' ').unwrap_or((line, ""));
        let (part, what) = match word {
            "if" => (&mut point.condition, Wanted::Condition),
            "log" => (&mut point.log, Wanted::Line),
            _ => return Err(NoOrder::Strange(shortened(line))),
        };
        // Of two lines one would be forgotten.
        if !part.is_empty() {
            return Err(NoOrder::Strange(shortened(line)));
        }
        *part = some(text.trim(), what)?;
    }
    Ok(point)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn orders_are_what_they_are_written_as() {
        let point = Breakpoint {
            at: Spot::Block("{b}".into()),
            condition: "n > 3".into(),
            from_hit: 2,
            log: "n is {n}".into(),
            is_once: true,
            is_disabled: true,
        };
        for order in [
            Order::Attach,
            Order::Detach,
            Order::Look,
            Order::Pause,
            Order::Continue,
            Order::Step(Step::Into, None),
            Order::Step(Step::Out, Some("a thread".into())),
            Order::Until("{b}".into()),
            Order::Back(Back::Step(Step::Over)),
            Order::Back(Back::Continue),
            Order::Back(Back::To(1500)),
            Order::Back(Back::Oldest),
            Order::Present,
            Order::Hold("main".into()),
            Order::Release("main".into()),
            Order::Break(Breakpoint {
                at: Spot::Change("n".into()),
                ..point.clone()
            }),
            Order::Break(point),
            Order::Clear(Some(3)),
            Order::Clear(None),
            Order::Enable(3, true),
            Order::Enable(3, false),
            Order::Breakpoints(0),
            Order::Breakpoints(17),
            Order::Errors(true),
            Order::Errors(false),
            Order::Motors(true),
            Order::Motors(false),
            Order::Set("n".into(), "m = 3".into()),
            Order::Evaluate("n + 1".into()),
        ] {
            let text = order.to_string();
            assert_eq!(Order::parse(&text), Ok(order), "{text}");
            let word = text.split_whitespace().next().unwrap();
            assert!(WORDS.split(", ").any(|known| known == word), "{word}");
        }
        assert_eq!(Order::parse("step"), Ok(Order::Step(Step::Over, None)));
        assert_eq!(
            Order::parse("back"),
            Ok(Order::Back(Back::Step(Step::Over)))
        );
    }

    #[test]
    fn what_is_no_order_says_why() {
        for (text, why) in [
            ("", "'' is no order"),
            ("fly away", "'fly' is no order"),
            ("step sideways", "'sideways' cannot be in this order"),
            ("until", "this order needs the id of a block"),
            ("break", "this order needs the id of a block"),
            ("watch", "this order needs the name of a variable"),
            ("breakpoints 5", "'5' cannot be in this order"),
            (
                "breakpoints after all",
                "this order needs the number of a breakpoint",
            ),
            ("break b from x", "this order needs a number of hits"),
            (
                "break b from 0",
                "this order needs a number of hits from 1 on",
            ),
            ("break b from", "this order needs a number of hits"),
            ("break b\nif ", "this order needs a condition after `if`"),
            ("break b\nif", "this order needs a condition after `if`"),
            ("watch n\nlog  ", "this order needs a text after `log`"),
            ("break b\nif 1\nif 2", "'if 2' cannot be in this order"),
            ("break b often", "'often' cannot be in this order"),
            ("break b\nwhile 1", "'while 1' cannot be in this order"),
            ("continue\nif 1", "'if 1' cannot be in this order"),
            ("clear", "this order needs the number of a breakpoint"),
            ("back to noon", "this order needs a time"),
            ("set n", "this order needs NAME=EXPRESSION"),
            ("errors maybe", "'maybe' cannot be in this order"),
            ("look around", "'around' cannot be in this order"),
        ] {
            let refused = Order::parse(text).unwrap_err().to_string();
            assert!(refused.starts_with(why), "{text}: {refused}");
        }
        let long = format!("evaluate {}", "1+".repeat(limits::ORDER_BYTES_MAX));
        assert_eq!(Order::parse(&long), Err(NoOrder::TooLong));
    }

    proptest! {
        #[test]
        fn nothing_that_comes_makes_it_fall(text in "\\PC{0,40}|(break|watch|breakpoints|step|back|set) [a-z{}=0-9\\n ]{0,30}") {
            if let Ok(order) = Order::parse(&text) {
                let again = Order::parse(&order.to_string());
                prop_assert_eq!(again, Ok(order));
            }
        }
    }
}
