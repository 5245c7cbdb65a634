//! `trik break`, `trik step`, `trik continue`: one order to the debugger of the diagram that runs on a robot.
//!
//! Owns how a program is left between two commands: stopped, with its motors at rest, under nobody's control, so that the
//! next command gets it. What an order does is known in `lang_diagram::debug`.

use super::debugged::{Debugged, Runs};
use super::output::say;
use super::target::{Target, target, the_one};
use super::watch::patience;
use crate::debug::listing::{Listing, Meant, listing_of};
use crate::debug::report::{Report, State};
use crate::debug::stops;
use crate::debug::target::words;
use crate::debug::target::{Channel, Event, Target as _, log_lines, why_not};
use crate::error::Error;
use crate::language;
use crate::output::standard;
use crate::refusal::{Refusal, UNREADABLE};
use crate::terminal::harmless;
use clap::{Args, ValueEnum};
use lang_diagram::debug::order::Order;
use lang_diagram::debug::{Back, Breakpoint, Step};
use lang_text::problem::{Locale, Words};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How long one look at the robot takes.
const TURN: Duration = Duration::from_millis(50);

/// Which program is meant, and how long it is waited for.
#[derive(Args, Clone, Debug)]
pub(crate) struct WhereArgs {
    /// The diagram that runs, a file NAME.qrs or NAME.flow: with it lines are those of `trik show`, and blocks of a
    /// data-flow program can be named by their captions.
    #[arg(long, value_name = "FILE")]
    pub file: Option<PathBuf>,
    /// The main diagram of FILE that runs, if it is not the first one.
    #[arg(long, value_name = "NAME", requires = "file")]
    pub diagram: Option<String>,
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
    /// Give up after this many seconds; the program goes on then [default: wait].
    #[arg(long, value_name = "SECONDS", value_parser = patience)]
    pub seconds: Option<Duration>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// What `trik break` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct BreakArgs {
    /// A line of the text of --file; a block by its id, and with --file by its caption, its label in a data-flow program or
    /// the subprogram that begins with it; or the name of a variable that is to change (with --change).
    pub place: String,
    /// Stop only if this expression is true.
    #[arg(long = "if", value_name = "EXPRESSION")]
    pub condition: Option<String>,
    /// Stop when this variable has changed, and not at a block.
    #[arg(long)]
    pub change: bool,
    #[command(flatten)]
    pub at: WhereArgs,
}

/// A way of `trik step`.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq, ValueEnum)]
pub(crate) enum StepKind {
    /// To the next block of this diagram
    #[default]
    Over,
    /// To the next block, into subprograms too
    Into,
    /// To the block after the call of this subprogram
    Out,
    /// To the block before
    Back,
}

/// What `trik step` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct StepArgs {
    /// How far.
    #[arg(value_enum, default_value_t, value_name = "STEP")]
    pub step: StepKind,
    #[command(flatten)]
    pub at: WhereArgs,
}

/// What `trik continue` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ContinueArgs {
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// Lets the program run until it comes to a place. The exit code: 0 it is stopped there, 1 it has ended before, or the order
/// is refused, 2 the robot could not be reached.
///
/// # Errors
/// The file cannot be read, the place is none, or the robot is gone.
pub(crate) fn stop_at(args: &BreakArgs) -> Result<u8, Refusal> {
    let listing = listing(&args.at)?;
    if let Some(condition) = &args.condition
        && condition.trim().is_empty()
    {
        let why = words::empty_condition();
        return Err(Refusal {
            code: UNREADABLE,
            ..Refusal::new(why.in_locale(args.at.language).to_owned())
        });
    }
    let point = match args.change {
        true => Breakpoint::of_changes(args.place.trim()),
        false => {
            let block = block(&args.place, listing.as_ref(), args.at.language);
            Breakpoint::before(block.map_err(|why| with_variable(why, args))?)
        }
    };
    let point = Breakpoint {
        is_once: true,
        condition: args.condition.as_deref().unwrap_or_default().trim().into(),
        ..point
    };
    let mut robot = attached(args.at.robot.as_ref(), args.at.language)?;
    let talked = (|| {
        // It may come there before it can be looked at again.
        let before = ordered(&mut robot, &Order::Look)?;
        let added = ordered(&mut robot, &Order::Break(point))?;
        match (added, before) {
            (refused @ Reply::Refused(_), _) => Ok(refused),
            (_, Reply::State(told)) if told.state != State::Running => {
                // Somebody may have looked at the past, where it would go on no further than to the present.
                ordered(&mut robot, &Order::Present)?;
                ordered(&mut robot, &Order::Continue)
            }
            (Reply::Done | Reply::State(_), _) => ordered(&mut robot, &Order::Look),
        }
    })();
    finish(&mut robot, talked, (&args.at, listing.as_ref()))
}

/// Goes on by a step. Exit codes as those of [`stop_at`].
///
/// # Errors
/// The file cannot be read, or the robot is gone.
pub(crate) fn step(args: &StepArgs) -> Result<u8, Refusal> {
    let listing = listing(&args.at)?;
    let order = match args.step {
        StepKind::Over => Order::Step(Step::Over, None),
        StepKind::Into => Order::Step(Step::Into, None),
        StepKind::Out => Order::Step(Step::Out, None),
        StepKind::Back => Order::Back(Back::Step(Step::Over)),
    };
    let mut robot = attached(args.at.robot.as_ref(), args.at.language)?;
    let talked = (|| {
        if let Reply::State(told) = ordered(&mut robot, &Order::Look)?
            && told.state == State::Running
        {
            // It is stopped where it is; the next step goes on from there.
            return ordered(&mut robot, &Order::Pause);
        }
        ordered(&mut robot, &order)
    })();
    finish(&mut robot, talked, (&args.at, listing.as_ref()))
}

/// Lets the program go on, without a debugger. Exit codes as those of [`stop_at`].
///
/// # Errors
/// The robot is gone.
pub(crate) fn go_on(args: &ContinueArgs) -> Result<u8, Refusal> {
    let mut robot = attached(args.robot.as_ref(), args.language)?;
    robot.close();
    Ok(0)
}

/// What a robot says to an order.
enum Reply {
    /// It is done, and nothing is said of the program.
    Done,
    /// Where the program is.
    State(Box<Report>),
    /// Why not.
    Refused(String),
}

fn ordered(robot: &mut Debugged, order: &Order) -> Result<Reply, Error> {
    let answer = robot.order(order)?;
    robot.forget_states();
    if let Some(why) = why_not(&answer) {
        return Ok(Reply::Refused(why));
    }
    let told = answer.get("program").and_then(Report::read);
    Ok(told.map_or(Reply::Done, |told| Reply::State(Box::new(told))))
}

fn attached(robot: Option<&Target>, locale: Locale) -> Result<Debugged, Refusal> {
    let begun = match robot {
        Some(robot) => Debugged::attach(robot, Runs::Any, locale),
        None => the_one().and_then(|robot| Debugged::attach(&robot, Runs::Any, locale)),
    };
    begun.map_err(|error| unreachable(error, locale))
}

fn unreachable(error: Error, locale: Locale) -> Refusal {
    Refusal {
        code: UNREADABLE,
        ..Refusal::new(words::told(&error.to_string(), locale))
    }
}

fn listing(at: &WhereArgs) -> Result<Option<Listing>, Refusal> {
    let file = at.file.as_ref();
    let listing = file.map(|file| listing_of(file, at.diagram.as_deref(), at.language));
    listing.transpose()
}

/// The block of a line or a name.
fn block(place: &str, listing: Option<&Listing>, locale: Locale) -> Result<Box<str>, Refusal> {
    let place = place.trim();
    let none = |why: Words| Refusal {
        code: UNREADABLE,
        ..Refusal::new(format!("'{}': {}", harmless(place), why.in_locale(locale)))
    };
    match (place.parse::<usize>(), listing) {
        (Ok(line), Some(listing)) => {
            let line = listing.line_with_block(line);
            let block = line.and_then(|line| listing.blocks(line).first().cloned());
            block.ok_or_else(|| none(words::no_such_line()))
        }
        (Ok(_), None) => Err(none(words::lines_need_file())),
        (Err(_), Some(listing)) => match listing.meant(place) {
            Meant::Block(block) => Ok(block),
            Meant::Nothing => Err(none(words::no_such_block(&listing.near(place)))),
            Meant::Several(blocks) => {
                let why = words::ambiguous(&harmless(place), &listing.choices(&blocks));
                Err(Refusal {
                    code: UNREADABLE,
                    ..Refusal::new(why.in_locale(locale).to_owned())
                })
            }
        },
        // An id has a slash or a brace; the robot knows no others.
        (Err(_), None) if !place.contains(['/', '{']) => Err(none(words::lines_need_file())),
        (Err(_), None) => Ok(place.into()),
    }
}

/// A refusal of a place, with what the person may have meant if the program has a variable of that name.
fn with_variable(mut why: Refusal, args: &BreakArgs) -> Refusal {
    let (name, locale) = (args.place.trim(), args.at.language);
    let variables = match &args.at.robot {
        Some(robot) => Debugged::variables(robot, locale),
        None => the_one().and_then(|robot| Debugged::variables(&robot, locale)),
    };
    // A robot that does not answer has nothing to add.
    let is_one = variables.is_ok_and(|names| names.iter().any(|one| one == name));
    if let (true, Some(last)) = (is_one, why.lines.last_mut()) {
        last.push_str(words::is_variable(&harmless(name)).in_locale(locale));
    }
    why
}

/// Waits until the program is stopped, says where, and leaves it so.
fn finish(
    robot: &mut Debugged,
    talked: Result<Reply, Error>,
    (at, listing): (&WhereArgs, Option<&Listing>),
) -> Result<u8, Refusal> {
    let until = at.seconds.map(|seconds| Instant::now() + seconds);
    let mut told = match talked.map_err(|error| unreachable(error, at.language))? {
        Reply::State(told) => *told,
        Reply::Done => Report::default(),
        Reply::Refused(why) => {
            say(&harmless(&why));
            robot.leave();
            return Ok(1);
        }
    };
    while told.state.is_under_way() {
        if until.is_some_and(|until| Instant::now() >= until) {
            say(words::not_come().in_locale(at.language));
            robot.close();
            return Ok(1);
        }
        let events = robot.turn(TURN);
        for event in events.map_err(|error| unreachable(error, at.language))? {
            match event {
                Event::Report(value) => {
                    for line in log_lines(&value) {
                        say(&harmless(line));
                    }
                    if let Some(state) = Report::read(&value) {
                        told = state;
                    }
                }
                Event::Said(Channel::Output, text) => {
                    let text = text.trim_end_matches('\n');
                    standard(format!("{}\n", harmless(text)).as_bytes())?;
                }
                Event::Said(Channel::Message, text) => say(&harmless(&text)),
                // The person who has started it is asked.
                Event::Asked(_) => {}
                Event::Over(why) => {
                    say(&harmless(&words::told(&why, at.language)));
                    return Ok(1);
                }
            }
        }
    }
    for line in stops::lines(&told, listing, at.language) {
        standard(format!("{line}\n").as_bytes())?;
    }
    robot.leave();
    Ok(u8::from(told.state == State::Ended))
}
