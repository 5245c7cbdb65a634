//! `trik replay --diff`: where a recording and what another configuration makes of it differ.
//!
//! Owns what belongs together, and what a difference is. What was recorded after a device gave something, and before it gave
//! the next, was made of that.

use super::picture;
use super::{Anew, Had, Of, Run, Step};
use crate::chart::short;
use crate::error::Error;
use crate::limits;
use crate::recording::shared::{Opened, seconds};
use crate::terminal::harmless;
use journal::layout::{Layout, Number};
use journal::read::{Event, EventKind};
use recorder::errno::LEFT;
use std::collections::VecDeque;
use std::fmt::Write;

/// What is wished of a comparison.
pub(crate) struct Wishes<'a> {
    /// Of what.
    pub(crate) of: Of<'a>,
    /// Differences count from this moment on, in ns from the beginning.
    pub(crate) from: u64,
    /// Both are drawn.
    pub(crate) is_drawn: bool,
}

/// What there is to say.
pub(crate) struct Report {
    pub(crate) text: String,
    /// The picture as SVG.
    pub(crate) picture: Option<String>,
    /// Nothing differs.
    pub(crate) is_same: bool,
}

/// One node in both.
#[derive(Default)]
pub(super) struct Tally {
    recorded: u64,
    anew: u64,
    /// Of those that count, how many belong together and are the same, and how many are not.
    others: u64,
    /// When the first difference was, in ns from the beginning, and what it was.
    first: Option<(u64, String)>,
    /// The largest distance of two numbers, when that was, and what it was.
    largest: Option<(f64, u64, String)>,
    /// What has come of the last bytes and was not recorded yet; None before the first bytes.
    waiting: Option<VecDeque<Had>>,
    /// When those were given.
    given: u64,
    /// What the first bytes gave has been met, and no others have come yet.
    is_first_met: bool,
    /// Something has been met.
    has_met: bool,
    /// The number of the failure that stands in what has come.
    standing: Option<i32>,
}

/// Compares them.
///
/// # Errors
/// What the run says.
pub(crate) fn compare(wishes: &Wishes<'_>) -> Result<Report, Error> {
    let mut run = Run::open(&wishes.of)?;
    let begin = run.begin_ns();
    let mut tallies: Vec<Tally> = run.nodes.iter().map(|_| Tally::default()).collect();
    run.walk(|plain, nodes, step| {
        match step {
            Step::Given(node, at, had) => {
                tallies[node].give(at.saturating_sub(begin), had, wishes.from);
            }
            Step::Recorded(event) => {
                let at = event.unix_ns.saturating_sub(begin);
                for (anew, tally) in nodes.iter().zip(&mut tallies) {
                    if event.node().is_some() && anew.recorded == event.node() {
                        let (layout, had) = had_of(plain, event);
                        let pair = (layout.unwrap_or(&anew.layout), &anew.layout);
                        tally.meet(at, &had, pair, wishes.from);
                    }
                }
            }
        }
        Ok(())
    })?;
    let mut text = String::new();
    for (anew, tally) in run.nodes.iter().zip(&tallies) {
        let _ = writeln!(text, "{}", words(anew, tally));
    }
    if has_lost(&mut run.plain) {
        text.push_str(
            "the recorder has lost events, so not each difference is one of the configuration\n",
        );
    }
    let others = |tally: &Tally| tally.others > 0;
    let is_same = !tallies.iter().any(others);
    let drawn = tallies.iter().map(|tally| is_same || others(tally));
    let drawn: Vec<bool> = drawn.collect();
    let picture = match wishes.is_drawn {
        true => Some(picture::draw(wishes, &drawn)?),
        false => None,
    };
    Ok(Report {
        text,
        picture,
        is_same,
    })
}

/// Whether the recorder has lost anything.
fn has_lost(plain: &mut Opened) -> bool {
    let counts = plain.facts("counts").unwrap_or_default();
    let lost = ["missed", "dropped"].into_iter();
    lost.filter_map(|key| counts.get(key))
        .any(|count| count != "0")
}

/// What a node had by an event, and the layout of it.
pub(super) fn had_of<'a>(plain: &'a Opened, event: &Event) -> (Option<&'a Layout>, Had) {
    match &event.what {
        EventKind::Sample { layout, tuple, .. } => {
            (plain.layouts().get(*layout), Ok(tuple.clone()))
        }
        EventKind::Fault { errno, reason, .. } => (None, Err((*errno, reason.clone()))),
        EventKind::Line(_, line) => (None, Err((0, line.text.clone()))),
    }
}

impl Tally {
    /// The device gave something: what came of the bytes before and was not recorded is too much.
    fn give(&mut self, at: u64, had: Option<Had>, from: u64) {
        let waiting = self.waiting.get_or_insert_default();
        if let Some(had) = waiting.pop_front().filter(|_| self.recorded > 0) {
            let what = format!("nothing was recorded, now it is {}", shown_shortly(&had));
            let given = self.given;
            self.differ(given, from, what);
        }
        self.given = at;
        self.is_first_met = false;
        let waiting = self.waiting.get_or_insert_default();
        waiting.clear();
        self.anew += u64::from(matches!(had, Some(Ok(_))));
        if let Some(had) = &had {
            self.standing = had.as_ref().err().map(|(errno, _)| *errno);
        }
        waiting.extend(had);
    }

    /// It was recorded that the node had this.
    fn meet(&mut self, at: u64, had: &Had, layouts: (&Layout, &Layout), from: u64) {
        self.recorded += u64::from(had.is_ok());
        // Of what came before, the bytes are not known.
        let Some(waiting) = &mut self.waiting else {
            return;
        };
        let Some(now) = waiting.pop_front() else {
            // It goes on to fail, or a reload has taken the node away, of which no device knows.
            let errno = had.as_ref().err().map(|(errno, _)| *errno);
            if errno.is_some() && (errno == self.standing || errno == Some(LEFT)) {
                return;
            }
            // The recorder begins to look at a device and at what is made of it one after the other: of one sample more the bytes
            // are not known.
            if self.is_first_met && had.is_ok() {
                self.is_first_met = false;
                return;
            }
            let what = match had {
                Ok(tuple) => format!("recorded is {}, now it is nothing", shown(layouts.0, tuple)),
                Err((_, why)) => {
                    format!("recorded is a failure ({}), now it is none", harmless(why))
                }
            };
            return self.differ(at, from, what);
        };
        self.is_first_met = !std::mem::replace(&mut self.has_met, true);
        match (had, &now) {
            (Ok(before), Ok(now)) => self.measure(at, from, (before, now), layouts),
            (Err((before, _)), Err((now, _))) if before == now => {}
            (Err((_, before)), Err((_, now))) => {
                let (before, now) = (harmless(before), harmless(now));
                self.differ(
                    at,
                    from,
                    format!("recorded is a failure ({before}), now it is another ({now})"),
                );
            }
            (Ok(tuple), Err((_, why))) => {
                let what = format!(
                    "recorded is {}, now it fails: {}",
                    shown(layouts.0, tuple),
                    harmless(why)
                );
                self.differ(at, from, what);
            }
            (Err((_, why)), Ok(tuple)) => {
                let now = shown(layouts.1, tuple);
                self.differ(
                    at,
                    from,
                    format!("recorded is a failure ({}), now it is {now}", harmless(why)),
                );
            }
        }
    }

    fn measure(
        &mut self,
        at: u64,
        from: u64,
        (before, now): (&[u8], &[u8]),
        (was, is): (&Layout, &Layout),
    ) {
        if was == is && before == now {
            return;
        }
        let (names, numbers) = (is.names(), is.numbers(now));
        let mut met = 0;
        let mut first = None;
        for (name, number) in was.names().iter().zip(was.numbers(before)) {
            let Some(at_now) = names.iter().position(|other| other == name) else {
                continue;
            };
            let Some(other) = numbers.get(at_now) else {
                continue;
            };
            met += 1;
            if is_same(number, *other) {
                continue;
            }
            let what = format!("{} was {number}, is {other}", harmless(name));
            let far = (other.to_f64() - number.to_f64()).abs();
            if at >= from
                && !far.is_nan()
                && self.largest.as_ref().is_none_or(|largest| far > largest.0)
            {
                self.largest = Some((far, at, what.clone()));
            }
            first.get_or_insert(what);
        }
        let is_other = || format!("it was {}, is {}", shown(was, before), shown(is, now));
        match first {
            Some(what) => self.differ(at, from, what),
            // Numbers in another form are the same numbers.
            None if met > 0 && names.len() == met && was.names().len() == met => {}
            None => self.differ(at, from, is_other()),
        }
    }

    fn differ(&mut self, at: u64, from: u64, what: String) {
        if at >= from {
            self.others += 1;
            self.first.get_or_insert((at, what));
        }
    }
}

/// Whether both are the same number, in whatever type; what is no number is the same as what is none either.
fn is_same(one: Number, other: Number) -> bool {
    match (whole(one), whole(other)) {
        (Some(one), Some(other)) => one == other,
        (Some(_) | None, Some(_) | None) => {
            let (one, other) = (one.to_f64(), other.to_f64());
            one == other || (one.is_nan() && other.is_nan())
        }
    }
}

fn whole(number: Number) -> Option<i128> {
    match number {
        Number::Signed(number) => Some(number.into()),
        Number::Unsigned(number) => Some(number.into()),
        Number::Single(_) | Number::Double(_) => None,
    }
}

/// A tuple for a line.
fn shown(layout: &Layout, tuple: &[u8]) -> String {
    let text = layout.show(tuple);
    match text.chars().count() > limits::DIFF_SHOWN_CHARS {
        true => text
            .chars()
            .take(limits::DIFF_SHOWN_CHARS)
            .chain("...".chars())
            .collect(),
        false => harmless(&text),
    }
}

fn shown_shortly(had: &Had) -> String {
    match had {
        Ok(_) => "a sample".to_owned(),
        Err((_, why)) => format!("a failure ({})", harmless(why)),
    }
}

/// What there is to say of a node.
fn words(anew: &Anew, tally: &Tally) -> String {
    let path = harmless(&anew.path);
    let of = match anew.of == anew.path {
        true => String::new(),
        false => format!(", of what {} gave", harmless(&anew.of)),
    };
    if anew.recorded.is_none() {
        return format!("{path}: {} samples{of}; it was not recorded", tally.anew);
    }
    let counts = match tally.recorded == tally.anew {
        true => format!("{} samples", tally.anew),
        false => format!("{} samples, recorded are {}", tally.anew, tally.recorded),
    };
    let Some((at, what)) = &tally.first else {
        return format!("{path}: {counts}{of}, as recorded");
    };
    let mut line = format!(
        "{path}: {counts}{of}, {} differ; first at {} s: {what}",
        tally.others,
        seconds(*at)
    );
    if let Some((far, at, what)) = &tally.largest {
        let far = short(*far);
        let _ = write!(line, "; most at {} s, by {far}: {what}", seconds(*at));
    }
    line
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layout(text: &str) -> Layout {
        Layout::parse(text).unwrap()
    }

    fn meet(tally: &mut Tally, at: u64, before: &[u8], now: &[u8], layouts: (&Layout, &Layout)) {
        tally.give(at, Some(Ok(now.to_vec())), 0);
        tally.meet(at, &Ok(before.to_vec()), layouts, 0);
    }

    #[test]
    fn the_first_and_the_largest_difference_are_kept() {
        let form = layout("i8 x, i8 y");
        let mut tally = Tally::default();
        for (at, before, now) in [
            (1, [1, 1], [1, 1]),
            (2, [1, 5], [1, 4]),
            (3, [0, 0], [9, 1]),
            (4, [3, 3], [3, 4]),
        ] {
            meet(&mut tally, at, &before, &now, (&form, &form));
        }
        assert_eq!((tally.recorded, tally.anew, tally.others), (4, 4, 3));
        assert_eq!(tally.first, Some((2, "y was 5, is 4".to_owned())));
        assert_eq!(tally.largest, Some((9.0, 3, "x was 0, is 9".to_owned())));
    }

    #[test]
    fn whole_numbers_are_compared_to_their_last_digit_and_a_number_that_is_gone_is_a_difference() {
        let (pair, one) = (layout("u64 t, i8 y"), layout("u64 t"));
        let long = 1_700_000_000_000_000_000_u64;
        let tuple = |t: u64| [&t.to_le_bytes()[..], &[1]].concat();
        for (now, form, others) in [
            (tuple(long), &pair, 0),
            (tuple(long + 1), &pair, 1),
            (long.to_le_bytes().to_vec(), &one, 1),
        ] {
            let mut tally = Tally::default();
            meet(&mut tally, 1, &tuple(long), &now, (&pair, form));
            assert_eq!(tally.others, others, "{now:?}");
        }
        let float = layout("f64 x");
        for (before, now, others) in [
            (f64::NAN, f64::NAN, 0),
            (f64::NAN, 1.0, 1),
            (1.0, f64::NAN, 1),
        ] {
            let mut tally = Tally::default();
            let (before, now) = (before.to_le_bytes(), now.to_le_bytes());
            meet(&mut tally, 1, &before, &now, (&float, &float));
            // The same bytes are the same.
            assert_eq!(tally.others, others);
        }
    }

    #[test]
    fn a_failure_that_stands_and_a_node_that_was_taken_away_are_no_difference() {
        let form = layout("i8 x");
        let mut tally = Tally::default();
        let fail = |errno: i32, why: &str| Err((errno, why.into()));
        tally.give(1, Some(fail(5, "a")), 0);
        for (errno, why) in [(5, "a"), (5, "b"), (LEFT, "the node has left the tree")] {
            tally.meet(2, &fail(errno, why), (&form, &form), 0);
        }
        assert_eq!(tally.others, 0);
        tally.meet(3, &fail(6, "c"), (&form, &form), 0);
        assert_eq!(tally.others, 1);
    }

    #[test]
    fn numbers_of_another_type_are_the_same_numbers() {
        let (small, large) = (layout("i8 x"), layout("f64 x"));
        let mut tally = Tally::default();
        meet(
            &mut tally,
            1,
            &[2],
            &2.0_f64.to_le_bytes(),
            (&small, &large),
        );
        assert_eq!(tally.others, 0);
        meet(
            &mut tally,
            2,
            &[2],
            &2.5_f64.to_le_bytes(),
            (&small, &large),
        );
        assert_eq!(tally.first, Some((2, "x was 2, is 2.5".to_owned())));
        // Other names are other numbers.
        let other = layout("i8 z");
        let mut tally = Tally::default();
        meet(&mut tally, 1, &[2], &[2], (&small, &other));
        assert_eq!(tally.others, 1);
    }

    #[test]
    fn what_is_only_in_one_of_them_differs() {
        let form = layout("i8 x");
        let mut tally = Tally::default();
        // Of what device this was made is not known.
        tally.meet(0, &Ok(vec![9]), (&form, &form), 0);
        tally.give(1, None, 0);
        tally.meet(2, &Ok(vec![7]), (&form, &form), 0);
        assert_eq!(tally.others, 1);
        tally.give(3, Some(Ok(vec![1])), 0);
        tally.give(4, Some(Err((5, "EIO".to_owned()))), 0);
        assert_eq!(tally.others, 2);
        tally.meet(5, &Err((5, "other words".to_owned())), (&form, &form), 0);
        assert_eq!(tally.others, 2, "the errno is the same");
        // One sample more at the beginning is of bytes that came before, and no second one.
        let mut begun = Tally::default();
        begun.give(1, Some(Ok(vec![7])), 0);
        for (at, others) in [(2, 0), (3, 0), (4, 1)] {
            begun.meet(at, &Ok(vec![7]), (&form, &form), 0);
            assert_eq!(begun.others, others);
        }
        // What counts from later on does not count before.
        tally.give(6, None, 100);
        tally.meet(7, &Ok(vec![7]), (&form, &form), 100);
        assert_eq!(tally.others, 2);
        // The last bytes may be recorded and their sample not.
        tally.give(8, Some(Ok(vec![1])), 0);
        assert_eq!(tally.others, 2);
    }
}
