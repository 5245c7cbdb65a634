//! Random rules on random worlds, against an evaluator that does literally what docs/teacher/rules.md and the facts of
//! the original say: no paths resolved in advance, no slots, no order kept beside the ids.
//!
//! Owns the evaluator; `thrown` has the rules. What is critical is counted at its place, its words are tried elsewhere.

mod thrown;

use super::{Checker, Entry, Level, Stage, Verdict, read};
use crate::Value;
use lang_text::problem::Locale;
use lang_text::xml;
use proptest::prelude::*;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use thrown::{
    Change, Cond, Happening, IDS, PROPERTIES, Plain, Trig, Val, happening, one_of, plain, rules_of,
    trig,
};

/// The region where the robot may be, from left to right; its top and bottom are far away.
const ZONE: (i32, i32) = (100, 200);
const ROBOT: i32 = 50;
const TICK_MS: u64 = 10;

/// What is said: the level, the moment, and the words but for what is critical.
type Report = (Level, u64, String);

/// The evaluator.
struct Naive<'a> {
    events: BTreeMap<&'static str, &'a Happening>,
    init: &'a [Trig],
    now: u64,
    alive: BTreeSet<&'static str>,
    /// When events were set up last; what is dropped keeps it.
    since: BTreeMap<&'static str, u64>,
    is_begun: bool,
    variables: BTreeMap<&'static str, Plain>,
    state: BTreeMap<&'static str, Plain>,
    robot_x: i32,
    said: Vec<Report>,
    success: bool,
    deferred: bool,
    failed: bool,
    is_succeeding: bool,
}

fn number(plain: &Plain) -> Option<f64> {
    match plain {
        Plain::Null => None,
        Plain::Bool(one) => Some(f64::from(u8::from(*one))),
        Plain::Int(one) => Some(f64::from(*one)),
        Plain::Double(one) => Some(*one),
        Plain::Text(one) => one.trim().parse().ok(),
    }
}

fn text(plain: &Plain) -> String {
    match plain {
        Plain::Null => String::new(),
        Plain::Bool(one) => one.to_string(),
        Plain::Int(one) => one.to_string(),
        Plain::Double(one) => one.to_string(),
        Plain::Text(one) => (*one).to_owned(),
    }
}

fn truth(plain: &Plain) -> bool {
    match plain {
        Plain::Null => false,
        Plain::Bool(one) => *one,
        Plain::Int(one) => *one != 0,
        Plain::Double(one) => *one != 0.0,
        Plain::Text(one) => !["", "0", "false"].contains(one),
    }
}

fn whole(plain: &Plain) -> i32 {
    match plain {
        Plain::Null => 0,
        Plain::Bool(one) => i32::from(*one),
        Plain::Int(one) => *one,
        // Halves go up, also below zero: the recorded run a_arith decides it.
        Plain::Double(one) => (one + 0.5).floor() as i32,
        Plain::Text(one) => one.trim().parse().unwrap_or(0),
    }
}

fn by_code(left: &str, right: &str) -> Ordering {
    left.encode_utf16().cmp(right.encode_utf16())
}

/// Facts of the original, (h) 5.
fn order(left: &Plain, right: &Plain) -> Ordering {
    use Plain::{Bool, Double, Int, Null, Text};
    match (left, right) {
        (Null, Null) => Ordering::Equal,
        (Null, _) => Ordering::Less,
        (_, Null) => Ordering::Greater,
        (Text(left), Text(right)) => by_code(left, right),
        (Bool(left), Bool(right)) => left.cmp(right),
        (Bool(left), Int(_) | Text(_)) => left.cmp(&truth(right)),
        (Int(_) | Text(_), Bool(right)) => truth(left).cmp(right),
        (Int(_) | Double(_), Text(_)) | (Text(_), Int(_) | Double(_)) => {
            match (number(left), number(right)) {
                (Some(left), Some(right)) => left.total_cmp(&right),
                (None, _) | (_, None) => by_code(&text(left), &text(right)),
            }
        }
        (Int(_) | Double(_) | Bool(_), Int(_) | Double(_) | Bool(_)) => {
            number(left).partial_cmp(&number(right)).expect("numbers")
        }
    }
}

impl Naive<'_> {
    fn complain(&mut self) -> Plain {
        self.said.push((Level::Critical, self.now, String::new()));
        Plain::Null
    }

    fn read_state(&mut self, object: &str, property: &str) -> Plain {
        match self.state.get(property) {
            Some(value) if object == "o" => value.clone(),
            _ => self.complain(),
        }
    }

    /// `${}` of nothing is an error each time, whether the path leads nowhere or to nothing.
    fn either(&mut self, path: &str) -> Plain {
        let found = match (self.variables.get(path), path.split_once('.')) {
            (Some(value), _) => value.clone(),
            (None, Some(("o", property))) => {
                self.state.get(property).cloned().unwrap_or(Plain::Null)
            }
            (None, Some(_) | None) => Plain::Null,
        };
        if found == Plain::Null {
            return self.complain();
        }
        found
    }

    fn value(&mut self, val: &Val) -> Plain {
        match val {
            Val::Plain(plain) => plain.clone(),
            Val::Variable(name) => self.variables.get(name).cloned().unwrap_or(Plain::Null),
            Val::State(object, property) => self.read_state(object, property),
            Val::Either(path) => {
                let (left, right) = (self.either(path), self.either(path));
                Plain::Int(whole(&left).min(whole(&right)))
            }
            Val::One(name, one) => {
                let one = whole(&self.value(one));
                Plain::Int(match *name {
                    "minus" => one.wrapping_neg(),
                    "abs" => one.wrapping_abs(),
                    other => panic!("{other}"),
                })
            }
            Val::Two(name, two) => {
                let left = whole(&self.value(&two[0]));
                let right = whole(&self.value(&two[1]));
                Plain::Int(match *name {
                    "sum" => left.wrapping_add(right),
                    "difference" => left.wrapping_sub(right),
                    "mul" => left.wrapping_mul(right),
                    "min" => left.min(right),
                    "max" => left.max(right),
                    other => panic!("{other}"),
                })
            }
        }
    }

    fn holds(&mut self, cond: &Cond, me: &'static str) -> bool {
        match cond {
            Cond::True => true,
            Cond::Glue(true, all) => all.iter().all(|one| self.holds(one, me)),
            Cond::Glue(false, all) => all.iter().any(|one| self.holds(one, me)),
            Cond::Not(one) => !self.holds(one, me),
            Cond::Compare(name, two) => {
                let left = self.value(&two[0]);
                let right = self.value(&two[1]);
                let order = order(&left, &right);
                match *name {
                    "equals" => order.is_eq(),
                    "notEqual" => order.is_ne(),
                    "greater" => order.is_gt(),
                    "less" => order.is_lt(),
                    "notGreater" => order.is_le(),
                    "notLess" => order.is_ge(),
                    other => panic!("{other}"),
                }
            }
            Cond::Inside(point) => {
                let (left, right) = (self.robot_x, self.robot_x + ROBOT);
                let middle = self.robot_x + ROBOT / 2;
                match *point {
                    "center" => (ZONE.0..=ZONE.1).contains(&middle),
                    "any" => left <= ZONE.1 && right >= ZONE.0,
                    "all" => left >= ZONE.0 && right <= ZONE.1,
                    other => panic!("{other}"),
                }
            }
            Cond::SettedUp(id) => match self.events.contains_key(id) {
                true => self.alive.contains(id),
                false => {
                    self.complain();
                    false
                }
            },
            Cond::Dropped(id) => match self.events.contains_key(id) {
                true => !self.alive.contains(id),
                false => {
                    self.complain();
                    true
                }
            },
            Cond::Timer(ms, drops) => {
                let since = self.since.get(me).copied().unwrap_or(0);
                let over = (self.now - since) as i64 >= i64::from(*ms);
                if over && *drops {
                    self.forget(me);
                }
                over
            }
            Cond::Using(triggers, one) => {
                self.fire(triggers);
                self.holds(one, me)
            }
        }
    }

    fn set_up(&mut self, id: &'static str) {
        self.alive.insert(id);
        self.since.insert(id, self.now);
    }

    fn forget(&mut self, id: &'static str) {
        self.alive.remove(id);
    }

    fn fire(&mut self, triggers: &[Trig]) {
        for trigger in triggers {
            match trigger {
                Trig::Fail => self.fail("no"),
                Trig::Success(true) => self.deferred = true,
                Trig::Success(false) => self.accomplish(),
                Trig::Say(tag, paths) => {
                    // In the order of the letters of what is written, each once.
                    let mut values = BTreeMap::new();
                    for path in paths.iter().collect::<BTreeSet<_>>() {
                        values.insert(path.clone(), text(&self.either(path)));
                    }
                    let words = paths.iter().map(|path| format!(" {}", values[path]));
                    let words = format!("said{}", words.collect::<String>());
                    let level = match *tag {
                        "message" => Level::Info,
                        "log" => Level::Log,
                        other => panic!("{other}"),
                    };
                    self.said.push((level, self.now, words));
                }
                Trig::Set(name, value) => {
                    let value = self.value(value);
                    self.variables.insert(name, value);
                }
                Trig::SetUp(id) if self.events.contains_key(id) => {
                    self.set_up(id);
                }
                Trig::Drop(id) if self.events.contains_key(id) => self.forget(id),
                Trig::SetUp(_) | Trig::Drop(_) => {
                    self.complain();
                }
                Trig::SetState(_, property, value) => {
                    let value = self.value(value);
                    match self.state.get_mut(property) {
                        Some(old) => *old = value,
                        None => {
                            self.complain();
                        }
                    }
                }
            }
        }
    }

    fn dump(&mut self) {
        let value = match &self.variables["total_score"] {
            Plain::Null => "null".to_owned(),
            Plain::Text(text) => format!("\"{text}\""),
            other @ (Plain::Bool(_) | Plain::Int(_) | Plain::Double(_)) => text(other),
        };
        let words = format!(r#"{{"variables":[{{"name":"total_score","value":{value}}}]}}"#);
        self.said.push((Level::Variables, self.now, words));
    }

    fn fail(&mut self, words: &str) {
        self.failed = true;
        self.said.push((Level::Error, self.now, words.to_owned()));
        self.dump();
    }

    fn accomplish(&mut self) {
        if self.is_succeeding {
            return;
        }
        self.is_succeeding = true;
        for id in ["on_success", "on_success2"] {
            if self.events.contains_key(id) {
                self.set_up(id);
                self.check(id);
            }
        }
        self.is_succeeding = false;
        self.success = true;
        let seconds = self.now as f64 / 1000.0;
        let words = format!("The task was accomplished in {seconds} sec!");
        self.said.push((Level::Info, self.now, words));
        self.dump();
    }

    fn check(&mut self, id: &'static str) {
        let event = self.events[id];
        if self.alive.contains(id) && self.holds(&event.condition, id) {
            self.fire(&event.triggers);
            if event.drops {
                self.forget(id);
            }
        }
    }

    fn pass(&mut self) {
        let mut ids: Vec<&'static str> = self.alive.iter().copied().collect();
        ids.sort_by(|left, right| by_code(right, left));
        for id in ids {
            self.check(id);
        }
        // `init` has the empty id: it is the last one.
        if !std::mem::replace(&mut self.is_begun, true) {
            self.fire(self.init);
        }
    }

    /// True: the run is over.
    fn tick(&mut self) -> bool {
        self.pass();
        if self.success || self.failed {
            self.pass();
            return true;
        }
        false
    }

    fn end(&mut self, with_errors: bool) {
        self.pass();
        if self.success || self.failed {
        } else if self.deferred && !with_errors {
            self.accomplish();
        } else {
            self.fail("Program has finished, but the task is not accomplished.");
        }
    }
}

fn value_of(plain: &Plain) -> Value {
    match plain {
        Plain::Null => Value::Null,
        Plain::Bool(one) => Value::Bool(*one),
        Plain::Int(one) => Value::Int(*one),
        Plain::Double(one) => Value::Double(*one),
        Plain::Text(one) => Value::text(one),
    }
}

fn said_by(entries: Vec<Entry>) -> Vec<Report> {
    let said = entries.into_iter().map(|entry| {
        let words = if entry.level == Level::Critical {
            String::new()
        } else {
            entry.text
        };
        (entry.level, entry.at_ms, words)
    });
    said.collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_rules_say_on_random_worlds_what_a_naive_evaluator_says(
        events in prop::collection::vec(happening(), 1..8),
        init in prop::collection::vec(trig(), 0..3),
        world in prop::collection::vec((0..300_i32, one_of(&PROPERTIES[..4]), plain()), 1..12),
        with_errors in any::<bool>(),
    ) {
        let world: Vec<Change> = world;
        let written = rules_of(&events, &init);
        let element = xml::parse(&written).expect("XML");
        let rules = read(&element);
        let rules = Rc::new(rules.unwrap_or_else(|problems| panic!("{written}: {problems:?}")));
        let mut checker = Checker::new(rules, Locale::English);
        let mut stage = Stage::new();
        stage.region("zone", ZONE.0, 0, ZONE.1 - ZONE.0, 1000);
        stage.add("o", "Thing");
        let first = [("n", Plain::Int(3)), ("d", Plain::Double(2.5)), ("t", Plain::Text("3")), ("b", Plain::Bool(true))];
        for (property, value) in &first {
            stage.set("o", property, value_of(value));
        }
        let mut naive = Naive {
            events: IDS.into_iter().zip(&events).collect(),
            init: &init,
            now: 0,
            alive: IDS.into_iter().zip(&events).filter(|(_, event)| event.initially).map(|(id, _)| id).collect(),
            since: BTreeMap::new(),
            is_begun: false,
            variables: BTreeMap::from([("total_score", Plain::Int(0))]),
            state: first.into_iter().collect(),
            robot_x: 0,
            said: Vec::new(),
            success: false,
            deferred: false,
            failed: false,
            is_succeeding: false,
        };
        let mut entries = Vec::new();
        let mut is_over = false;
        for (x, property, value) in &world {
            naive.now += TICK_MS;
            stage.place("robot1", *x, 100, ROBOT, ROBOT);
            stage.set("o", property, value_of(value));
            naive.robot_x = *x;
            naive.state.insert(property, value.clone());
            checker.check(naive.now, &mut stage, &mut entries);
            is_over = naive.tick();
            if is_over {
                break;
            }
        }
        if !is_over {
            naive.now += TICK_MS;
            checker.program_ended(naive.now, with_errors, &mut stage, &mut entries);
            naive.end(with_errors);
        }
        let verdict = if naive.failed {
            Verdict::Failed { after_ms: naive.now }
        } else {
            Verdict::Accomplished { after_ms: naive.now }
        };
        prop_assert_eq!(said_by(entries), naive.said, "{}", written);
        prop_assert_eq!(checker.verdict(), verdict, "{}", written);
    }
}
