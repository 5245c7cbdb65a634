//! The past of programs: every moment that is computed again is the one that was.

use super::*;
use crate::machine::stops::Stop;

/// What a program looked like before a token.
#[derive(Clone, Debug, Eq, PartialEq)]
struct Seen {
    ms: u32,
    next: Option<(Target, String)>,
    values: Vec<(String, String)>,
    waiting: usize,
}

fn seen((machine, stop): (&Machine, &Stop)) -> Seen {
    let nodes = (0..).zip(&machine.program().nodes);
    let ports = nodes.flat_map(|(node, block)| {
        let ports = u8::try_from(block.row.ports.len()).expect("few");
        (0..ports).map(move |port| Target { node, port })
    });
    Seen {
        ms: machine.now(),
        next: stop.next.as_ref().map(|(to, token)| (*to, token.brief())),
        values: machine
            .variables()
            .map(|(name, value)| (name.to_owned(), value.brief()))
            .collect(),
        waiting: ports.map(|at| machine.waiting_at(at)).sum(),
    }
}

/// Where somebody stands who looks.
fn here(desk: &Desk) -> Seen {
    let present = || Some((&desk.machine, desk.machine.stopped()?));
    seen(desk.hindsight.shown().or_else(present).expect("a stop"))
}

/// A robot that answers something else each time it is asked.
#[derive(Default)]
struct Restless {
    asked: i32,
    told: Vec<String>,
}

impl Brick for Restless {
    fn command(&mut self, command: Command<'_>) {
        self.told.push(command.to_string());
    }

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        self.asked += 1;
        Some((self.asked * 37) % 101)
    }

    fn vector(&mut self, _port: Port, _into: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.asked += 1;
        low + (self.asked * 7919).rem_euclid(high - low + 1)
    }

    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        self.asked += 1;
        (self.asked % 5 == 0).then(|| (Some(3), format!("letter {}", self.asked)))
    }

    fn contents(&mut self, _file: &str) -> Option<String> {
        self.asked += 1;
        Some(format!("{} words", self.asked))
    }
}

/// Readings, random numbers, letters, a file, a wait that keeps, and tokens that wait for others.
const ALL: &str = "A Sensor\nR Random generator {fromNumber=1 | toNumber=9 | repeatedly=true | time=50}\nL Message receiver\nF Text programming {IO0=n = n + I0 % 7; n}\nV Variable {variable=n = 0; k = 2}\nW Wait and send {time=70 | keep=true}\nZ Zip flows\nU Unzip flows\nM Motors\nD Read file {fileName=a.txt}\nG Text programming {IO0=k = random(50); t = I0; k}\nA.OUT > F.I0\nF.O0 > Z.DATA1\nR.OUT > Z.DATA2\nZ.OUT > U.DATA\nU.OUT1 > M.M3\nR.OUT > W.DATA\nW.OUT > G.I0\nG.O0 > M.M4\nL.OUT > D.CF_IN";

/// A program that goes by steps, stopped before its first block, and each moment of it.
fn chronicle(text: &str, steps: usize, bytes: usize) -> (Desk, Restless, Vec<Seen>) {
    let checked = check(&of(text));
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    let mut desk = Desk::new(
        Machine::new(Rc::new(checked.program)),
        Locale::English,
        bytes,
    );
    let mut robot = Restless::default();
    desk.stop_first();
    let mut moments = Vec::new();
    let mut now = 0;
    while moments.len() < steps {
        // The caller's clock goes on at each stop, and the program's does not.
        now += 10;
        desk.step(now, &mut robot, &mut Deaf);
        if !desk.is_stopped() {
            continue;
        }
        let stop = desk.machine.stopped().expect("a stop");
        if stop.next.is_some() {
            moments.push(here(&desk));
        }
        if moments.len() < steps {
            assert!(told(&mut desk, "step").contains("\"done\":true"));
        }
    }
    (desk, robot, moments)
}

/// Runs until it is stopped, by a clock that goes on.
fn until_stopped(desk: &mut Desk, robot: &mut Robot, now: &mut u32) {
    loop {
        *now += 10;
        desk.step(*now, robot, &mut Deaf);
        if desk.is_stopped() {
            return;
        }
    }
}

fn done(desk: &mut Desk, order: &str) -> String {
    let answer = told(desk, order);
    assert!(answer.contains("\"done\":true"), "{order}: {answer}");
    while desk.search_on() {}
    told(desk, "look")
}

#[test]
fn every_moment_of_the_past_is_the_one_that_was() {
    let (mut desk, robot, moments) = chronicle(ALL, 400, HISTORY_BYTES);
    let (commands, asked) = (robot.told.len(), robot.asked);
    for wanted in moments.iter().rev().skip(1) {
        let state = done(&mut desk, "back");
        assert!(state.contains("\"state\":\"past\""), "{state}");
        assert_eq!(&here(&desk), wanted);
    }
    assert!(told(&mut desk, "back").contains("the first moment that is kept"));
    for wanted in &moments[1..moments.len() - 1] {
        done(&mut desk, "step");
        assert_eq!(&here(&desk), wanted);
    }
    let state = done(&mut desk, "step");
    assert!(state.contains("\"state\":\"stopped\""), "{state}");
    assert_eq!(Some(&here(&desk)), moments.last());
    // Nobody was asked and told anything meanwhile.
    assert_eq!((robot.told.len(), robot.asked), (commands, asked));
}

#[test]
fn an_instant_back_and_a_time_and_the_first_moment_are_found() {
    let (mut desk, _, moments) = chronicle(ALL, 200, HISTORY_BYTES);
    let last = moments.last().expect("some").ms;
    let before = moments.iter().rfind(|one| one.ms < last).expect("one");
    done(&mut desk, "back out");
    assert_eq!(&here(&desk), before);
    done(&mut desk, "step out");
    assert_eq!(here(&desk).ms, last);
    done(&mut desk, "back to 105");
    let between = here(&desk);
    assert_eq!((between.ms, between.next), (100, None));
    let values = &moments.iter().find(|one| one.ms > 100).expect("one").values;
    assert_eq!(&between.values, values);
    done(&mut desk, "step");
    assert_eq!(Some(&here(&desk)), moments.iter().find(|one| one.ms > 100));
    let state = done(&mut desk, "back start");
    assert!(state.contains("\"reason\":\"oldest\""), "{state}");
    assert_eq!(here(&desk), moments[0]);
    assert!(told(&mut desk, "back to 100000").contains("has not come to that time"));
    assert!(told(&mut desk, "set n=3").contains("looks at the past"));
    // Nor does who assigns without the debugger.
    let assigned = desk.assign("n", "3");
    assert!(matches!(assigned, Err(crate::debug::NotNow::Past)));
    assert!(told(&mut desk, "until qrm:/main/M").contains("looks at the past"));
    assert!(
        told(&mut desk, "evaluate n + 1").contains("\"done\":false"),
        "n has no value there"
    );
    let state = done(&mut desk, "present");
    assert!(state.contains("\"state\":\"stopped\""), "{state}");
    assert_eq!(Some(&here(&desk)), moments.last());
}

#[test]
fn breakpoints_and_changes_are_found_backwards_and_forwards() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M\nif n % 10 == 0 and data > 3");
    told(&mut desk, "break qrm:/main/M\nlog {n}");
    told(&mut desk, "watch k");
    let mut now = 0;
    for _ in 0..4 {
        told(&mut desk, "continue");
        until_stopped(&mut desk, &mut robot, &mut now);
    }
    desk.log();
    let n = |desk: &mut Desk| told(desk, "evaluate n");
    assert!(n(&mut desk).contains("\"value\":\"30\""));
    for (order, number, value) in [
        ("back continue", 1, "20"),
        ("back continue", 1, "10"),
        ("continue", 1, "20"),
        ("back continue", 1, "10"),
        ("back continue", 3, "0"),
    ] {
        let state = done(&mut desk, order);
        assert!(
            state.contains(&format!("\"number\":{number}")),
            "{order}: {state}"
        );
        assert!(
            n(&mut desk).contains(&format!("\"value\":\"{value}\"")),
            "{order}: {state}"
        );
    }
    assert_eq!(desk.log(), None, "nothing is written in the past");
    // On from the past: to the present, and then on from there.
    for _ in 0..2 {
        done(&mut desk, "continue");
    }
    let state = done(&mut desk, "continue");
    assert!(state.contains("\"state\":\"stopped\""), "{state}");
    assert!(n(&mut desk).contains("\"value\":\"30\""));
}

#[test]
fn what_a_person_changes_and_a_new_version_stay_where_they_were() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    let mut now = 0;
    let mut moments = Vec::new();
    for round in 0..6 {
        told(&mut desk, "continue");
        until_stopped(&mut desk, &mut robot, &mut now);
        moments.push(here(&desk));
        match round {
            1 => assert!(told(&mut desk, "set n=100").contains("\"done\":true")),
            3 => {
                let next = SLOW.replace("n = n + 1", "n = n + 50");
                desk.patch(&version(&next), &mut robot).expect("a change");
            }
            _ => {}
        }
    }
    let counts: Vec<&str> = moments.iter().map(|one| one.values[0].1.as_str()).collect();
    assert_eq!(counts, ["1", "2", "101", "102", "152", "202"]);
    for wanted in moments.iter().rev().skip(1) {
        let state = done(&mut desk, "back continue");
        assert!(state.contains("\"reason\":\"breakpoint\""), "{state}");
        assert_eq!(&here(&desk), wanted);
    }
}

#[test]
fn a_program_that_has_ended_can_be_looked_at_also_after_an_error() {
    let text = "L Loop {start_border=1 | end_border=5 | time=10}\nF Text programming {IO0=n = I0; 60 / (5 - I0)}\nM Motors\nL.OUT > F.I0\nF.O0 > M.M3";
    let (mut desk, mut robot) = (desk(text), Robot::default());
    told(&mut desk, "attach");
    runs(&mut desk, &mut robot, 0, 200);
    let state = told(&mut desk, "look");
    assert!(state.contains("\"state\":\"ended\""), "{state}");
    assert!(state.contains("\"kept\":{\"from_ms\":0,"), "{state}");
    done(&mut desk, "back");
    let last = here(&desk);
    assert_eq!(last.next.map(|(_, token)| token).as_deref(), Some("5"));
    assert!(told(&mut desk, "evaluate n").contains("\"value\":\"4\""));
    let state = done(&mut desk, "continue");
    assert!(state.contains("\"state\":\"ended\""), "{state}");
    // Without a debugger nothing is kept.
    told(&mut desk, "detach");
    assert!(told(&mut desk, "back").contains("attach the debugger first"));
}

#[test]
fn the_past_takes_no_more_than_it_may_and_forgets_its_beginning() {
    const BYTES: usize = 60_000;
    let (mut desk, _, moments) = chronicle(ALL, 2000, BYTES);
    let (from_ms, bytes) = desk.hindsight.kept().expect("some of it");
    assert!(
        from_ms > 0 && bytes < 2 * BYTES,
        "{bytes} bytes from {from_ms} ms on"
    );
    done(&mut desk, "back start");
    let first = here(&desk);
    assert!(moments.contains(&first));
    assert!(first.ms >= from_ms);
    assert!(told(&mut desk, "back").contains("the first moment that is kept"));
}

#[test]
fn all_that_a_copy_holds_is_counted() {
    use lang_diagram::debug::again::Again;
    const LONG: usize = 3000;
    let long = "x".repeat(LONG);
    let bytes = |text: &str| {
        let whole =
            format!("A Sensor\nF Text programming {{IO0=n = I0; '{long}'}}\n{text}\nA.OUT > F.I0");
        let (mut desk, mut robot) = (desk(&whole), Robot::default());
        runs(&mut desk, &mut robot, 0, 0);
        let before = desk.machine.bytes();
        runs(&mut desk, &mut robot, 10, 60);
        assert!(desk.machine.errors().is_empty(), "{text}");
        desk.machine.bytes() - before
    };
    // A token at 20, 40 and 60 ms each.
    for (text, count) in [
        ("Y Say\nF.O0 > Y.DATA", 0),
        ("G Text programming {IO0=I0}\nF.O0 > G.I0", 1),
        ("W Wait and send {time=9000 | keep=false}\nF.O0 > W.DATA", 1),
        ("W Wait and send {time=9000 | keep=true}\nF.O0 > W.DATA", 3),
        ("D Write to file\nF.O0 > D.FILE", 1),
        ("D Write to file\nF.O0 > D.FILE\nF.O0 > D.TEXT", 2),
        ("D Text on screen\nF.O0 > D.TEXT", 1),
    ] {
        let grown = bytes(text);
        // A text of a value is counted by its cells, with some room.
        let wanted = count * LONG..2 * count * LONG + LONG / 10;
        assert!(wanted.contains(&grown), "{text}: {grown} bytes");
    }
}

#[test]
fn a_long_way_back_is_given_up_and_one_that_is_not_finds_its_end() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "watch k");
    let mut now = 0;
    until_stopped(&mut desk, &mut robot, &mut now);
    told(&mut desk, "continue");
    told(&mut desk, "break qrm:/main/M\nif n == 3000 or n < 1");
    until_stopped(&mut desk, &mut robot, &mut now);
    let begun = told(&mut desk, "back continue");
    assert!(begun.contains("\"state\":\"searching\""), "{begun}");
    let news = desk.news();
    assert!(news.iter().all(|one| one.contains("searching")), "{news:?}");
    let given_up = told(&mut desk, "pause");
    assert!(given_up.contains("\"state\":\"stopped\""), "{given_up}");
    told(&mut desk, "back continue");
    // The owner of the desk goes on with it between other things.
    while desk.hindsight.is_searching() {
        desk.step(now, &mut robot, &mut Deaf);
    }
    let found = desk.news().pop().expect("its end is told");
    assert!(found.contains("\"state\":\"past\""), "{found}");
    assert!(found.contains("\"variable\":\"k\""), "{found}");
}
