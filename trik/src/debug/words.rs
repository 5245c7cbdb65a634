//! What a person types at `trik debug`: the words that people know from gdb, and what is meant by them.
//!
//! Owns the words, their short forms and their help. What an order does is known in `lang_diagram::debug`.

use super::listing::{Listing, Meant};
use super::stops::words::typed;
use super::target::words::ambiguous;
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Back, Breakpoint, Step};
use lang_text::problem::{Locale, Words};

/// Something that is typed.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Typed {
    /// An order for the debugger.
    Order(Order),
    /// Lines of the diagram around this one; none: around where it is stopped.
    List(Option<usize>),
    /// Where each thread is, and what calls it is in.
    Threads,
    /// The calls of the thread at which it is stopped.
    Calls,
    /// All variables.
    Variables,
    /// Where the robot is.
    Scene,
    /// The file again, for the program that runs.
    Reload,
    /// What can be typed.
    Help,
    /// The end.
    Quit,
}

/// Why something typed is not understood.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(super) enum NotUnderstood {
    /// There is no such command.
    Unknown(String),
    /// The command lacks something.
    Lacks(Lacking),
    /// Nothing can follow this command.
    Strange(String),
    /// The program has no such line with a block at or after it, and no block that is meant so; the name that may be meant, as
    /// a sentence to append.
    NoBlock {
        text: String,
        is_flow: bool,
        near: Words,
    },
    /// Several blocks are meant so; how each is said.
    Ambiguous(String, String),
}

impl NotUnderstood {
    /// For a person.
    pub(super) fn in_locale(&self, locale: Locale) -> String {
        let words = match self {
            Self::Unknown(word) => Words::new(
                format!("there is no command '{word}'; try help"),
                format!("команды '{word}' нет; попробуйте help"),
            ),
            Self::Lacks(what) => Words::new(
                format!("{} is needed", what.english()),
                format!("нужно: {}", what.russian()),
            ),
            Self::Strange(text) => Words::new(
                format!("nothing can follow this command, and here is '{text}'"),
                format!("после этой команды ничего не пишут, а здесь '{text}'"),
            ),
            Self::NoBlock {
                text,
                is_flow: false,
                near,
            } => Words::new(
                format!(
                    "'{text}' is neither a line that has a block, nor the caption or the id of a block, nor a subprogram; list shows the lines{}",
                    near.english
                ),
                format!(
                    "'{text}' - не строка с блоком, не надпись и не id блока, не подпрограмма; строки показывает list{}",
                    near.russian
                ),
            ),
            Self::NoBlock {
                text,
                is_flow: true,
                near,
            } => Words::new(
                format!(
                    "'{text}' is neither a line that has a block, nor the label of a block, its SUBPROGRAM/LABEL or its id, nor a subprogram; list shows lines and labels{}",
                    near.english
                ),
                format!(
                    "'{text}' - не строка с блоком, не метка блока, не ПОДПРОГРАММА/МЕТКА, не id блока и не подпрограмма; строки и метки показывает list{}",
                    near.russian
                ),
            ),
            Self::Ambiguous(text, choices) => ambiguous(text, choices),
        };
        words.in_locale(locale).to_owned()
    }
}

/// What a command lacks.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Lacking {
    Kinds,
    Time,
    Thread,
    Line,
    LineText,
    Variable,
    Assignment,
    Expression,
    Number,
    StopOrGo,
    RestOrKeep,
    If,
    Condition,
}

impl Lacking {
    fn english(self) -> &'static str {
        match self {
            Self::Kinds => "threads, variables or breakpoints",
            Self::Time => "a time in milliseconds",
            Self::Thread => "the name of a thread",
            Self::Line => "a line",
            Self::LineText => "a text after the line",
            Self::Variable => "the name of a variable",
            Self::Assignment => "NAME=EXPRESSION",
            Self::Expression => "an expression",
            Self::Number => "the number of a breakpoint",
            Self::StopOrGo => "stop or go",
            Self::RestOrKeep => "rest or keep",
            Self::If => "`if` before the condition",
            Self::Condition => "a condition after `if`",
        }
    }

    fn russian(self) -> &'static str {
        match self {
            Self::Kinds => "threads, variables или breakpoints",
            Self::Time => "время в миллисекундах",
            Self::Thread => "имя потока",
            Self::Line => "строка",
            Self::LineText => "текст после номера строки",
            Self::Variable => "имя переменной",
            Self::Assignment => "ИМЯ=ВЫРАЖЕНИЕ",
            Self::Expression => "выражение",
            Self::Number => "номер точки останова",
            Self::StopOrGo => "stop или go",
            Self::RestOrKeep => "rest или keep",
            Self::If => "`if` перед условием",
            Self::Condition => "условие после `if`",
        }
    }
}

/// A command: its words, what follows them, and what it does in English and Russian.
pub(super) struct Row {
    /// The first one is the long one.
    words: &'static str,
    more: &'static str,
    english: &'static str,
    russian: &'static str,
}

impl Row {
    /// Its words, and what follows them.
    pub(super) fn form(&self, locale: Locale) -> String {
        let words = self.words.replace(' ', ", ");
        format!("{words} {}", typed(self.more, locale))
    }

    /// What it does.
    pub(super) fn what(&self, locale: Locale) -> &'static str {
        match locale {
            Locale::English => self.english,
            Locale::Russian => self.russian,
        }
    }
}

const fn row(
    words: &'static str,
    more: &'static str,
    english: &'static str,
    russian: &'static str,
) -> Row {
    Row {
        words,
        more,
        english,
        russian,
    }
}

/// All commands, for help.
pub(super) const ROWS: [Row; 28] = [
    row(
        "continue c",
        "",
        "go on to the next breakpoint; in the past to the next one there, or to the present",
        "дальше до следующей точки останова; в прошлом - до следующей там или до настоящего",
    ),
    row(
        "next n",
        "[THREAD]",
        "go on to the next block of this diagram",
        "к следующему блоку этой диаграммы",
    ),
    row(
        "step s",
        "[THREAD]",
        "go on to the next block, into subprograms too",
        "к следующему блоку, в том числе в подпрограмме",
    ),
    row(
        "finish fin",
        "[THREAD]",
        "go on to the block after the call of this subprogram; a data-flow program: to the first reaction of a later instant",
        "к блоку после вызова этой подпрограммы; в потоковой программе - к первой реакции более позднего момента",
    ),
    row("until u", "LINE", "go on to a line", "до строки"),
    row(
        "reverse-next rn",
        "",
        "back to the block before, in this diagram",
        "назад к предыдущему блоку этой диаграммы",
    ),
    row(
        "reverse-step rs",
        "",
        "back to the block before, into subprograms too",
        "назад к предыдущему блоку, в том числе в подпрограмме",
    ),
    row(
        "reverse-finish rf",
        "",
        "back to where this subprogram was called; a data-flow program: to the last reaction of an earlier instant",
        "назад к вызову этой подпрограммы; в потоковой программе - к последней реакции более раннего момента",
    ),
    row(
        "reverse-continue rc",
        "",
        "back to the last breakpoint",
        "назад к последней точке останова",
    ),
    row(
        "back",
        "MS",
        "back to a time of the program, in milliseconds",
        "назад к моменту программы, в миллисекундах",
    ),
    row(
        "start",
        "",
        "back to the first moment that is kept",
        "назад к самому раннему из сохранённых моментов",
    ),
    row("present", "", "leave the past", "вернуться в настоящее"),
    row(
        "break b",
        "LINE [if EXPRESSION]",
        "stop before a line; LINE may be a block by its id, its caption (in a data-flow program its label), or a subprogram",
        "остановка перед строкой; вместо строки можно написать id блока, его надпись (в потоковой программе метку) или подпрограмму",
    ),
    row(
        "tbreak tb",
        "LINE [if EXPRESSION]",
        "the same, once",
        "то же, один раз",
    ),
    row(
        "watch",
        "NAME [if EXPRESSION]",
        "stop after a variable changes, or a sensor that a diagram reads",
        "остановка после изменения переменной или датчика, который читает диаграмма",
    ),
    row(
        "dprintf",
        "LINE TEXT",
        "write a line there; {EXPRESSION} in it is a value",
        "писать там строку; {ВЫРАЖЕНИЕ} в ней - значение",
    ),
    row(
        "delete d",
        "[NUMBER]",
        "take a breakpoint away, or all",
        "убрать точку останова или все",
    ),
    row(
        "disable",
        "NUMBER",
        "let a breakpoint do nothing; enable NUMBER undoes it",
        "выключить точку останова; enable НОМЕР включает",
    ),
    row(
        "errors",
        "stop|go",
        "whether an error in a block stops the program",
        "останавливает ли программу ошибка в блоке",
    ),
    row(
        "print p",
        "EXPRESSION",
        "compute an expression, which changes nothing",
        "вычислить выражение, ничего не меняя",
    ),
    row(
        "set",
        "NAME=EXPRESSION",
        "assign a variable",
        "присвоить переменной",
    ),
    row(
        "list l",
        "[LINE]",
        "show the diagram as text, around a line or block",
        "показать диаграмму как текст, у строки или блока",
    ),
    row(
        "info i",
        "threads|variables|breakpoints",
        "show all of them; backtrace (bt): the calls of this thread",
        "показать все потоки, переменные, точки останова; backtrace (bt) - вызовы этого потока",
    ),
    row(
        "hold",
        "THREAD",
        "hold a thread at its next block and let the others go on; release THREAD undoes it",
        "задержать поток у следующего блока, остальные идут дальше; release ПОТОК отпускает",
    ),
    row(
        "reload",
        "",
        "take the file as it is now; the program goes on where it is, with what its variables hold",
        "взять файл, какой он сейчас; программа продолжает с того же места и с теми же переменными",
    ),
    row(
        "where w",
        "",
        "in a simulated world: where the robot is at this moment",
        "в моделируемом мире: где робот в этот момент",
    ),
    row(
        "motors",
        "rest|keep",
        "on a robot: whether motors rest while the program is stopped",
        "на роботе: стоят ли моторы, пока программа остановлена",
    ),
    row(
        "quit q",
        "",
        "end; the program is ended too, but for one that was joined with --attach, which goes on",
        "закончить; программа заканчивается тоже, а та, к которой подключились с --attach, идёт дальше",
    ),
];

/// Commands that are in the help of another one.
const BESIDE: [(&str, &str); 4] = [
    ("backtrace", ""),
    ("enable", "NUMBER"),
    ("help", ""),
    ("release", "THREAD"),
];

/// All commands by their long words.
pub(super) fn commands() -> impl Iterator<Item = &'static str> {
    let rows = ROWS
        .iter()
        .map(|row| row.words.split(' ').next().unwrap_or_default());
    rows.chain(BESIDE.map(|(word, _)| word))
}

/// What is typed after a command, as help shows it; empty: nothing, or there is no such command.
pub(super) fn follows(command: &str) -> &'static str {
    let rows = ROWS.iter().map(|row| (row.words, row.more));
    let found = rows.chain(BESIDE).find(|(words, _)| {
        let mut words = words.split(' ');
        words.any(|word| word == command)
    });
    found.map_or("", |(_, more)| more)
}

/// Commands after which nothing comes.
const ALONE: &str = "continue c run r pause reverse-next rn reverse-step rs reverse-finish rf reverse-continue rc start \
    present breakpoints threads variables backtrace bt reload where w help h ? quit q exit";

/// What a line means, which is not empty.
pub(super) fn understand(line: &str, listing: &Listing) -> Result<Typed, NotUnderstood> {
    let line = line.trim();
    let (word, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
    let rest = rest.trim();
    if !rest.is_empty() && ALONE.split(' ').any(|alone| alone == word) {
        let rest = rest.chars().take(40).collect();
        return Err(NotUnderstood::Strange(rest));
    }
    if let Some(order) = moving(word, rest, listing)? {
        return Ok(Typed::Order(order));
    }
    if let Some(order) = order(word, rest, listing)? {
        return Ok(Typed::Order(order));
    }
    Ok(match word {
        "list" | "l" if rest.is_empty() => Typed::List(None),
        "list" | "l" => Typed::List(Some(line_of(rest, listing)?)),
        "info" | "i" => match rest {
            "threads" | "t" => Typed::Threads,
            "variables" | "locals" | "v" => Typed::Variables,
            "breakpoints" | "break" | "b" | "watchpoints" => Typed::Order(Order::Breakpoints(0)),
            _ => return Err(NotUnderstood::Lacks(Lacking::Kinds)),
        },
        "threads" => Typed::Threads,
        "variables" => Typed::Variables,
        "backtrace" | "bt" => Typed::Calls,
        "reload" => Typed::Reload,
        "where" | "w" => Typed::Scene,
        "help" | "h" | "?" => Typed::Help,
        "quit" | "q" | "exit" => Typed::Quit,
        word => return Err(NotUnderstood::Unknown(word.chars().take(40).collect())),
    })
}

/// An order that moves the program, or through its past.
fn moving(word: &str, rest: &str, listing: &Listing) -> Result<Option<Order>, NotUnderstood> {
    let thread = || (!rest.is_empty()).then(|| rest.into());
    Ok(Some(match word {
        "continue" | "c" | "run" | "r" => Order::Continue,
        "pause" => Order::Pause,
        "next" | "n" => Order::Step(Step::Over, thread()),
        "step" | "s" => Order::Step(Step::Into, thread()),
        "finish" | "fin" => Order::Step(Step::Out, thread()),
        "until" | "u" | "advance" => Order::Until(block(rest, listing)?),
        "reverse-next" | "rn" => Order::Back(Back::Step(Step::Over)),
        "reverse-step" | "rs" => Order::Back(Back::Step(Step::Into)),
        "reverse-finish" | "rf" => Order::Back(Back::Step(Step::Out)),
        "reverse-continue" | "rc" => Order::Back(Back::Continue),
        "back" => {
            let lacks = NotUnderstood::Lacks(Lacking::Time);
            Order::Back(Back::To(rest.parse().map_err(|_| lacks)?))
        }
        "start" => Order::Back(Back::Oldest),
        "present" => Order::Present,
        "hold" => Order::Hold(some(rest, Lacking::Thread)?),
        "release" => Order::Release(some(rest, Lacking::Thread)?),
        _ => return Ok(None),
    }))
}

/// An order about breakpoints and values.
fn order(word: &str, rest: &str, listing: &Listing) -> Result<Option<Order>, NotUnderstood> {
    Ok(Some(match word {
        "break" | "b" => Order::Break(breakpoint(rest, listing)?),
        "tbreak" | "tb" => Order::Break(Breakpoint {
            is_once: true,
            ..breakpoint(rest, listing)?
        }),
        "watch" => Order::Break(watch(rest)?),
        "dprintf" => {
            let (line, text) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
            let text = text.trim().trim_matches('"');
            Order::Break(Breakpoint {
                log: some(text, Lacking::LineText)?,
                ..breakpoint(line, listing)?
            })
        }
        "delete" | "d" | "clear" if rest.is_empty() => Order::Clear(None),
        "delete" | "d" | "clear" => Order::Clear(Some(number(rest)?)),
        "disable" => Order::Enable(number(rest)?, false),
        "enable" => Order::Enable(number(rest)?, true),
        "breakpoints" => Order::Breakpoints(0),
        "errors" => Order::Errors(either(rest, ["stop", "go"], Lacking::StopOrGo)?),
        "motors" => Order::Motors(either(rest, ["rest", "keep"], Lacking::RestOrKeep)?),
        "print" | "p" | "inspect" => Order::Evaluate(some(rest, Lacking::Expression)?),
        "set" => {
            let rest = rest.strip_prefix("var ").unwrap_or(rest);
            let lacks = NotUnderstood::Lacks(Lacking::Assignment);
            let (name, text) = rest.split_once('=').ok_or(lacks)?;
            Order::Set(name.trim().into(), text.trim().into())
        }
        _ => return Ok(None),
    }))
}

fn either(text: &str, words: [&str; 2], what: Lacking) -> Result<bool, NotUnderstood> {
    let found = words.iter().position(|word| *word == text);
    found
        .map(|index| index == 0)
        .ok_or(NotUnderstood::Lacks(what))
}

fn some(text: &str, what: Lacking) -> Result<Box<str>, NotUnderstood> {
    match text {
        "" => Err(NotUnderstood::Lacks(what)),
        text => Ok(text.into()),
    }
}

fn number(text: &str) -> Result<u32, NotUnderstood> {
    let lacks = NotUnderstood::Lacks(Lacking::Number);
    text.parse().map_err(|_| lacks)
}

/// The block that is meant by its name.
fn block_named(text: &str, listing: &Listing) -> Result<Box<str>, NotUnderstood> {
    match listing.meant(text) {
        Meant::Block(block) => Ok(block),
        Meant::Nothing => Err(no_block(text, listing)),
        Meant::Several(blocks) => {
            let choices = listing.choices(&blocks);
            Err(NotUnderstood::Ambiguous(shortened(text), choices))
        }
    }
}

fn shortened(text: &str) -> String {
    text.chars().take(80).collect()
}

/// Why nothing is meant by a text that should mean a block.
fn no_block(text: &str, listing: &Listing) -> NotUnderstood {
    let text = shortened(text);
    NotUnderstood::NoBlock {
        is_flow: listing.is_flow(),
        near: listing.near(&text),
        text,
    }
}

/// The line that is meant by its number, or by a block.
fn line_of(text: &str, listing: &Listing) -> Result<usize, NotUnderstood> {
    match text.parse() {
        Ok(line) => Ok(line),
        Err(_) => Ok(listing.line_of(&block_named(text, listing)?)),
    }
}

/// The block that a line or a name means. A line without a block means the next one that has one.
fn block(text: &str, listing: &Listing) -> Result<Box<str>, NotUnderstood> {
    if text.is_empty() {
        return Err(NotUnderstood::Lacks(Lacking::Line));
    }
    match text.parse::<usize>() {
        Ok(line) => {
            let none = || no_block(text, listing);
            let line = listing.line_with_block(line).ok_or_else(none)?;
            listing.blocks(line).first().cloned().ok_or_else(none)
        }
        Err(_) => block_named(text, listing),
    }
}

fn breakpoint(text: &str, listing: &Listing) -> Result<Breakpoint, NotUnderstood> {
    // A label may have spaces.
    let (place, rest) = match text.find(" if ") {
        Some(at) => text.split_at(at),
        None => match text.split_once(char::is_whitespace) {
            // The first word of a longer name may be a name too.
            Some((place, rest))
                if listing.meant(text) == Meant::Nothing && block(place, listing).is_ok() =>
            {
                (place, rest)
            }
            Some(_) | None => (text, ""),
        },
    };
    let condition = condition(rest)?;
    Ok(Breakpoint {
        condition,
        ..Breakpoint::before(block(place.trim(), listing)?)
    })
}

fn watch(text: &str) -> Result<Breakpoint, NotUnderstood> {
    let (name, rest) = text.split_once(char::is_whitespace).unwrap_or((text, ""));
    let name = some(name, Lacking::Variable)?;
    let condition = condition(rest)?;
    Ok(Breakpoint {
        condition,
        ..Breakpoint::of_changes(name)
    })
}

/// What follows a place: nothing, or `if` and a condition.
fn condition(rest: &str) -> Result<Box<str>, NotUnderstood> {
    let condition = match rest.trim() {
        "" => "",
        rest => rest
            .strip_prefix("if")
            .filter(|rest| rest.is_empty() || rest.starts_with(char::is_whitespace))
            .ok_or(NotUnderstood::Lacks(Lacking::If))?,
    };
    if condition.trim().is_empty() && !rest.trim().is_empty() {
        return Err(NotUnderstood::Lacks(Lacking::Condition));
    }
    Ok(condition.trim().into())
}
