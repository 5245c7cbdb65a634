//! A recording of a robot as a run that the rules of a task judge.
//!
//! Owns which node of a tree says what rules ask, which part of a recording is the run, and the way from its events to what
//! the judge sees, event by event: of a long file no more than a chunk is in memory. What rules ask for is known in `sim`,
//! and what is in a file in `journal`.

mod words;

use super::args::CheckArgs;
use super::recorded_args::{Origin, RecordedArgs};
use crate::limits;
use crate::recording::shared::{Opened, Progress, has_ending, open};
use crate::terminal::harmless;
use journal::layout::Layout;
use journal::read::{Event, EventKind};
use journal::standard::Level;
use journal::write::Story;
use lang_diagram::ports::{Device, GamepadPart, Port};
use lang_text::problem::Words;
use recorder::place_units;
use sim::geometry::Pose;
use sim::judge::Task;
use sim::judge::witness::{Fact, Going, Need, Needs, Seen, Witness, needs};
use std::collections::BTreeSet;
use std::path::Path;
use trikd::protocol::news;

const MS: u64 = 1_000_000;
/// Why a sample says nothing.
const NO_NUMBER: &str = "no number";
/// Both lights together.
const ORANGE: &str = "orange";

/// Whether a record is a recording of a robot.
pub(super) fn is_recording(path: &Path) -> bool {
    has_ending(path, "mcap")
}

/// A recording from the beginning of its run, ready to be told.
pub(super) struct Tape {
    reader: Opened,
    piece: Piece,
    feeds: Vec<(usize, Feed)>,
    /// An event whose time has not come.
    next: Option<Event>,
    /// What nodes had before the run.
    before: Vec<Event>,
    origin: Origin,
    /// The place that counts as where the world has the robot begin.
    zero: Option<Pose>,
    lights: [bool; 2],
    /// Nodes of which a failure was told.
    failed: BTreeSet<usize>,
    progress: Progress,
}

/// What a node says of the robot.
#[derive(Clone, Debug, PartialEq)]
enum Feed {
    /// Its place, in units that are so many m and rad.
    Place(f64, f64),
    /// A device: the number with this name, or the first one.
    Port(Port, Option<String>),
    /// The green or the red light.
    Light(usize),
    Phrase,
}

/// The part of a recording that is the run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Piece {
    begin_ns: u64,
    end_ns: u64,
    with_errors: bool,
}

/// Opens a recording for the rules of a task; also what is strange.
///
/// # Errors
/// It is none, or it does not say what the rules ask.
pub(super) fn tape(
    path: &Path,
    task: &Task,
    args: &CheckArgs,
) -> Result<(Tape, Vec<String>), Vec<String>> {
    let told = |words: &Words| {
        let text = words.in_locale(args.language);
        format!("{}: {text}", path.display())
    };
    let reader = open(path).map_err(|why| vec![why.to_string()])?;
    let needs = needs(task);
    let mut tape = Tape {
        reader,
        piece: Piece {
            begin_ns: 0,
            end_ns: 0,
            with_errors: false,
        },
        feeds: Vec::new(),
        next: None,
        before: Vec::new(),
        origin: args.recorded.pose_from,
        zero: None,
        lights: [false; 2],
        failed: BTreeSet::new(),
        progress: Progress::new(),
    };
    let all = |all: Vec<Words>| all.iter().map(told).collect::<Vec<_>>();
    tape.find_nodes(&needs, &args.recorded.pose).map_err(all)?;
    let mut strange = needs.changes;
    let piece = tape.find_piece(&args.recorded, &mut strange);
    tape.piece = piece.map_err(|why| vec![told(&why)])?;
    tape.rewind(&needs.all).map_err(all)?;
    Ok((tape, all(strange)))
}

/// The nodes that say a fact, as a tree of this project has them, and what each one says; none if no node says it.
fn nodes_of(fact: Fact) -> Vec<(String, Feed)> {
    let of = |folder: &str, port: Port| {
        let node = format!("{folder}/{}", port.name());
        vec![(node, Feed::Port(port, None))]
    };
    match fact {
        Fact::Port(port) => match port.device() {
            Device::Motor => of("motors", port),
            Device::Servo => of("servos", port),
            Device::Encoder => of("encoders", port),
            Device::Plugged => of("sensors", port),
            Device::Button(_) => {
                let name = port.name().to_ascii_lowercase();
                vec![("keys".to_owned(), Feed::Port(port, Some(name)))]
            }
            Device::Gamepad(GamepadPart::Wheel) => {
                vec![("gamepad/wheel".to_owned(), Feed::Port(port, None))]
            }
            Device::Gamepad(
                GamepadPart::Place(_)
                | GamepadPart::Pressed(_)
                | GamepadPart::Button(_)
                | GamepadPart::Connected,
            )
            | Device::Gyroscope
            | Device::Accelerometer
            | Device::LineSensor
            | Device::ColorSensor
            | Device::ObjectSensor(_)
            | Device::Lidar => Vec::new(),
        },
        Fact::Light => vec![
            ("led/green".to_owned(), Feed::Light(0)),
            ("led/red".to_owned(), Feed::Light(1)),
        ],
        Fact::Phrase => vec![("sound/say".to_owned(), Feed::Phrase)],
        // The place is that of a node that a person can choose.
        Fact::Place | Fact::Simulated => Vec::new(),
    }
}

impl Tape {
    fn node(&self, path: &str) -> Option<usize> {
        self.reader
            .nodes()
            .iter()
            .position(|node| node.path == path || node.aliases.iter().any(|alias| alias == path))
    }

    /// Finds the node of each fact; what there is none for is told.
    fn find_nodes(&mut self, needs: &Needs, pose: &str) -> Result<(), Vec<Words>> {
        let mut wrong = Vec::new();
        for need in &needs.all {
            let wanted = nodes_of(need.fact);
            match need.fact {
                Fact::Place => match self.place(pose) {
                    Ok(feed) => self.feed(feed),
                    Err(why) => wrong.push(words::unplaced(need, &why)),
                },
                Fact::Port(_) | Fact::Light | Fact::Phrase | Fact::Simulated
                    if wanted.is_empty() =>
                {
                    wrong.push(words::simulated(need));
                }
                Fact::Port(_) | Fact::Light | Fact::Phrase | Fact::Simulated => {
                    for (path, feed) in wanted {
                        match self.node(&path) {
                            Some(node) => self.feed((node, feed)),
                            None => wrong.push(words::no_node(need, &path)),
                        }
                    }
                }
            }
        }
        match wrong.is_empty() {
            true => Ok(()),
            false => Err(wrong),
        }
    }

    fn feed(&mut self, feed: (usize, Feed)) {
        if !self.feeds.contains(&feed) {
            self.feeds.push(feed);
        }
    }

    /// The node that says where the robot is.
    fn place(&self, path: &str) -> Result<(usize, Feed), Words> {
        let path = path.trim_start_matches('/');
        let node = self.node(path).ok_or_else(|| words::no_place(path))?;
        let about = &self.reader.nodes()[node];
        let layout = self.reader.layout(node);
        let units = layout.and_then(|layout| place_units(about, layout));
        match units {
            Some((length, angle)) => Ok((node, Feed::Place(length, angle))),
            None => Err(words::no_place_in(path, &harmless(&about.units))),
        }
    }

    /// Which part is the run: what a person says, or from the start of its first program to its end, or all of it.
    fn find_piece(
        &mut self,
        args: &RecordedArgs,
        strange: &mut Vec<Words>,
    ) -> Result<Piece, Words> {
        let (first, last) = (self.reader.begin_ns(), self.reader.end_ns());
        let whole = Piece {
            begin_ns: first.saturating_add(args.from.unwrap_or(0)),
            end_ns: args
                .to
                .map_or(last, |to| first.saturating_add(to).min(last)),
            with_errors: false,
        };
        let is_said = args.from.is_some() || args.to.is_some();
        let piece = match is_said {
            true => whole,
            false => {
                let (runs, is_open) = self.runs().map_err(|why| words::unreadable(&why))?;
                if is_open && runs.len() == 1 {
                    strange.push(words::unended());
                }
                if runs.len() > 1 {
                    let begins = runs.iter().map(|(name, piece)| {
                        let after = piece.begin_ns.saturating_sub(first);
                        (name.clone(), after as f64 / 1e9)
                    });
                    strange.push(words::several(&begins.collect::<Vec<_>>()));
                }
                runs.first().map_or(whole, |(_, piece)| *piece)
            }
        };
        if piece.begin_ns >= piece.end_ns {
            return Err(words::nothing(last.saturating_sub(first) as f64 / 1e9));
        }
        let counts = self.reader.facts("counts");
        let counts = counts.map_err(|why| words::unreadable(&why))?;
        let lost = ["missed", "dropped"].map(|key| {
            let count = counts.get(key).and_then(|count| count.parse::<u64>().ok());
            count.unwrap_or(0)
        });
        let lost = lost[0].saturating_add(lost[1]);
        if lost > 0 {
            strange.push(words::lost(lost));
        }
        Ok(piece)
    }

    /// The programs that ran, as far as they were recorded: name and time; and whether the last one was not seen to end.
    /// Only the first ones are looked for. One without an end has not ended well.
    fn runs(&mut self) -> Result<(Vec<(String, Piece)>, bool), journal::error::Error> {
        let end_ns = self.reader.end_ns();
        let mut runs: Vec<(String, Piece)> = Vec::new();
        let mut is_open = false;
        self.reader
            .seek_lines(self.reader.begin_ns(), Story::Programs);
        while let Some(event) = self.reader.next()? {
            let EventKind::Line(Story::Programs, line) = event.what else {
                continue;
            };
            if news::is_started(&line.text, &line.name) {
                if is_open && let Some((_, run)) = runs.last_mut() {
                    run.end_ns = event.unix_ns;
                    is_open = false;
                }
                if runs.len() == limits::RUNS_TOLD {
                    break;
                }
                let piece = Piece {
                    begin_ns: event.unix_ns,
                    end_ns,
                    with_errors: true,
                };
                runs.push((harmless(&line.name), piece));
                is_open = true;
            } else if let Some((_, run)) = runs.last_mut()
                && is_open
                && news::is_end(&line.text, &line.name)
            {
                run.end_ns = event.unix_ns;
                run.with_errors = line.level == Level::Error;
                is_open = false;
            }
        }
        Ok((runs, is_open))
    }

    /// Goes to the beginning of the run. A sensor that is asked and says nothing there cannot be judged by.
    fn rewind(&mut self, needs: &[Need]) -> Result<(), Vec<Words>> {
        let Piece {
            begin_ns, end_ns, ..
        } = self.piece;
        let soon_ns = begin_ns.saturating_add(limits::FIRST_SAMPLE_MS * MS);
        let unreadable = |why: journal::error::Error| vec![words::unreadable(&why)];
        let newest = self.reader.newest(begin_ns).map_err(unreadable)?;
        let of_run = self.feeds.iter().map(|(node, _)| *node);
        let mut nodes: Vec<usize> = of_run.collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut silent = Vec::new();
        for &node in &nodes {
            // What was said before the run is not said in it.
            if self.says(node, Fact::Phrase) {
                continue;
            }
            let about = &self.reader.nodes()[node];
            let had = newest[node].clone();
            let had = had.filter(|had| matches!(had.what, EventKind::Sample { .. }));
            // What was never told anything is at rest.
            if had.is_some() || about.is_written {
                self.before.extend(had);
                continue;
            }
            let path = about.path.clone();
            self.reader.seek_among(begin_ns, &[node]);
            let first = self.reader.next().map_err(unreadable)?;
            // What it said first counts from the beginning, if that was soon.
            match first.filter(|first| first.unix_ns <= end_ns.min(soon_ns)) {
                Some(first) => self.before.push(first),
                None => {
                    let need = needs.iter().find(|need| self.says(node, need.fact));
                    silent.extend(need.map(|need| words::silent(need, &path)));
                }
            }
        }
        if !silent.is_empty() {
            return Err(silent);
        }
        self.reader.seek_with_failures(begin_ns, &nodes);
        Ok(())
    }

    /// Whether a node says this fact.
    fn says(&self, node: usize, fact: Fact) -> bool {
        self.feeds.iter().any(|(of, feed)| {
            let is_meant = match fact {
                Fact::Place => matches!(feed, Feed::Place(..)),
                Fact::Light => matches!(feed, Feed::Light(_)),
                Fact::Phrase => matches!(feed, Feed::Phrase),
                Fact::Port(asked) => matches!(feed, Feed::Port(port, _) if *port == asked),
                Fact::Simulated => false,
            };
            *of == node && is_meant
        })
    }

    /// Tells what an event says.
    fn take(&mut self, event: &Event, to: &mut Seen<'_>) -> Result<(), Words> {
        let after = event.unix_ns.saturating_sub(self.piece.begin_ns) as f64 / 1e9;
        match &event.what {
            EventKind::Sample {
                node,
                layout,
                tuple,
                ..
            } => {
                let layout = &self.reader.layouts()[*layout];
                let feeds = self.feeds.iter().filter(|(of, _)| of == node);
                for (_, feed) in feeds {
                    let place = (self.origin, &mut self.zero);
                    let said = sample(feed, (layout, tuple), place, &mut self.lights, to);
                    let Err(NoNumber) = said else {
                        continue;
                    };
                    let path = &self.reader.nodes()[*node].path;
                    if matches!(feed, Feed::Place(..)) {
                        return Err(words::place_lost(path, after, NO_NUMBER));
                    }
                    if self.failed.insert(*node) {
                        to.warn(words::failed(path, after, NO_NUMBER));
                    }
                }
            }
            EventKind::Fault { node, reason, .. } => {
                let mut of_node = self.feeds.iter().filter(|(of, _)| of == node).peekable();
                if of_node.peek().is_none() {
                    return Ok(());
                }
                let path = &self.reader.nodes()[*node].path;
                let reason = harmless(reason);
                // A place that is unknown for a moment may be another one after it.
                if of_node.any(|(_, feed)| matches!(feed, Feed::Place(..))) {
                    return Err(words::place_lost(path, after, &reason));
                }
                if self.failed.insert(*node) {
                    to.warn(words::failed(path, after, &reason));
                }
            }
            EventKind::Line(..) => {}
        }
        Ok(())
    }
}

/// A sample whose value is NaN or infinite.
#[derive(Debug)]
struct NoNumber;

/// Tells what a sample of a node says.
fn sample(
    feed: &Feed,
    (layout, tuple): (&Layout, &[u8]),
    (origin, zero): (Origin, &mut Option<Pose>),
    lights: &mut [bool; 2],
    to: &mut Seen<'_>,
) -> Result<(), NoNumber> {
    let numbers = layout.numbers(tuple);
    let number = |at: usize| numbers.get(at).map(|number| number.to_f64());
    match feed {
        Feed::Place(length, angle) => {
            let (Some(x), Some(y), Some(heading)) = (number(0), number(1), number(2)) else {
                return Err(NoNumber);
            };
            if ![x, y, heading].into_iter().all(f64::is_finite) {
                return Err(NoNumber);
            }
            let place = Pose::new(x * length, y * length, heading * angle);
            let zero = *zero.get_or_insert(match origin {
                Origin::Start => place,
                Origin::Zero => Pose::default(),
            });
            to.place(seen_from(zero, place));
        }
        Feed::Port(port, name) => {
            let names = name.as_ref().map(|_| layout.names()).unwrap_or_default();
            let at = match name {
                Some(name) => names.iter().position(|own| own == name),
                None => Some(0),
            };
            match at.and_then(number) {
                Some(number) if number.is_finite() => to.port(*port, number.round() as i32),
                Some(_) => return Err(NoNumber),
                None => {}
            }
        }
        Feed::Light(which) => {
            lights[*which] = number(0).is_some_and(|number| number != 0.0);
            to.light(match lights {
                [true, true] => ORANGE,
                [true, false] => "green",
                [false, true] => "red",
                [false, false] => "off",
            });
        }
        Feed::Phrase => to.phrase(&layout.show(tuple)),
    }
    Ok(())
}

/// A place as one sees it from another one.
fn seen_from(zero: Pose, place: Pose) -> Pose {
    let (dx, dy) = (place.at.x - zero.at.x, place.at.y - zero.at.y);
    let (sin, cos) = zero.heading_rad.sin_cos();
    Pose::new(
        dx * cos + dy * sin,
        dy * cos - dx * sin,
        place.heading_rad - zero.heading_rad,
    )
}

impl Witness for Tape {
    fn tell(&mut self, now: u32, to: &mut Seen<'_>) -> Result<Going, Words> {
        for event in std::mem::take(&mut self.before) {
            self.take(&event, to)?;
        }
        let now_ns = self.piece.begin_ns.saturating_add(u64::from(now) * MS);
        let until = now_ns.min(self.piece.end_ns);
        loop {
            let event = match self.next.take() {
                Some(event) => Some(event),
                None => self.reader.next().map_err(|why| words::unreadable(&why))?,
            };
            match event {
                Some(event) if event.unix_ns <= until => self.take(&event, to)?,
                later => {
                    self.next = later;
                    break;
                }
            }
        }
        let Piece {
            begin_ns, end_ns, ..
        } = self.piece;
        self.progress.at(now_ns - begin_ns, end_ns - begin_ns);
        Ok(match now_ns >= end_ns {
            true => Going::Ended {
                with_errors: self.piece.with_errors,
            },
            false => Going::On,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::FRAC_PI_2;

    #[test]
    fn a_place_is_seen_from_where_the_run_began() {
        let zero = Pose::new(1.0, 2.0, FRAC_PI_2);
        let seen = seen_from(zero, Pose::new(1.0, 5.0, FRAC_PI_2));
        assert!((seen.at.x - 3.0).abs() < 1e-9 && seen.at.y.abs() < 1e-9);
        let seen = seen_from(zero, Pose::new(0.0, 2.0, 0.0));
        assert!(seen.at.x.abs() < 1e-9 && (seen.at.y - 1.0).abs() < 1e-9);
        assert!((seen.heading_rad + FRAC_PI_2).abs() < 1e-9);
    }

    #[test]
    fn every_fact_of_a_device_has_its_node_or_is_refused() {
        let node = |name: &str| {
            let found = nodes_of(Fact::Port(Port::named(name).unwrap()));
            found.first().map(|(node, _)| node.clone())
        };
        assert_eq!(node("M3").as_deref(), Some("motors/M3"));
        assert_eq!(node("E1").as_deref(), Some("encoders/E1"));
        assert_eq!(node("A1").as_deref(), Some("sensors/A1"));
        assert_eq!(node("S2").as_deref(), Some("servos/S2"));
        assert_eq!(node("Enter").as_deref(), Some("keys"));
        assert_eq!(node("ObjectSensorXPort"), None);
        assert_eq!(nodes_of(Fact::Light).len(), 2);
    }
}
