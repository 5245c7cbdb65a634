//! What a recording has of a program.

use super::*;
use crate::check::check;
use crate::machine::Machine;
use crate::machine::fixtures::{diagram, project};
use crate::project::DiagramKind::{Main, Subprogram};
use lang_diagram::stand_in::StandIn;
use lang_expr::value::List;
use std::rc::Rc;

/// Gives 1 and 2 at 100 and 200 ms, which a subprogram that is called twice doubles.
fn doubled() -> Rc<Program> {
    let main = "L Loop {start_border=1 | end_border=3 | time=100}\nONE User block of twice\nTWO User block of twice\nS Say\nL.OUT > ONE.I0\nONE.O0 > TWO.I0\nTWO.O0 > S.DATA";
    let twice = "I Input port {identifier=I0}\nF Text programming {IO0=I0 * 2}\nO Output port {identifier=O0}\nI.OUT > F.I0\nF.O0 > O.DATA";
    let of = [
        diagram("main", Main, main),
        diagram("twice", Subprogram, twice),
    ];
    program(project(of.into()))
}

fn program(project: crate::project::Project) -> Rc<Program> {
    let checked = check(&project);
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    Rc::new(checked.program)
}

/// The number of the first output of the first block.
fn output(program: &Program) -> u8 {
    program.node(0).row.port("O0").expect("an output")
}

fn told(diary: &mut Diary, program: &Program, now: u32) -> String {
    let told = diary.tell(object(), program, now).done();
    told.replace("qrm:/", "").replace('"', "")
}

#[test]
fn each_block_of_each_call_has_its_reactions_and_the_last_token_of_each_port() {
    let program = doubled();
    let (mut machine, mut robot) = (Machine::new(program.clone()), StandIn::default());
    let mut diary = Diary::new(&program);
    for now in (0..=100).step_by(10) {
        machine.step(now, &mut robot, &mut diary);
    }
    assert!(diary.has_news());
    insta::assert_snapshot!(told(&mut diary, &program, 100).replace("},{id", "},\n{id"));
    assert!(!diary.has_news());
    assert_eq!(told(&mut diary, &program, 110), "{blocks:[]}");
    // Names are known by now.
    for now in (110..=200).step_by(10) {
        machine.step(now, &mut robot, &mut diary);
    }
    let first = told(&mut diary, &program, 200);
    let gave = "{blocks:[{id:main/L,reacted:3,ports:[{port:OUT,type:int,value:2,count:2}";
    assert!(first.starts_with(gave), "{first}");
}

#[test]
fn what_is_too_much_comes_later_and_is_counted() {
    let lines: Vec<String> = (0..100)
        .map(|at| format!("F{at} Text programming {{IO0=1}}"))
        .collect();
    let program = program(project(vec![diagram("main", Main, &lines.join("\n"))]));
    let (mut diary, port) = (Diary::new(&program), output(&program));
    // A million tokens are as many as one.
    for round in 0..10_000 {
        for node in 0..100 {
            diary.fired(0, node);
            diary.sent(0, node, port, &Value::Int(round));
        }
    }
    let first = told(&mut diary, &program, 0);
    assert!(
        first.len() < limits::DIARY_BYTES_MAX + 200,
        "{}",
        first.len()
    );
    let here = first.matches("reacted:10000").count();
    assert!(
        first.ends_with(&format!("blocks_left_out:{}}}", 100 - here)),
        "{first}"
    );
    // At most so much in a time; nothing is told twice, and nobody is passed over.
    diary.fired(50, 0);
    let (mut seen, mut now) = (here, 0);
    while seen < 101 && now < 5000 {
        now += 50;
        let next = told(&mut diary, &program, now);
        assert!(
            next.len() < 50 * limits::DIARY_BYTES_PER_MS + 300,
            "{}",
            next.len()
        );
        seen += next.matches("reacted:").count();
        assert_eq!(next.contains("reacted:10001"), seen == 101, "{next}");
    }
    assert!(!diary.has_news());
    // A reader that has missed some of it is told all of it again, however old it is.
    diary.tell_again();
    diary.is_last();
    let again = told(&mut diary, &program, 6000);
    assert!(
        again.contains("diagram:main") && again.contains("left_out:"),
        "{again}"
    );
}

#[test]
fn long_tokens_are_cut_and_blocks_that_are_too_many_are_counted_together() {
    let text = "F Text programming {IO0=1}\nG Text programming {IO0=1}";
    let program = program(project(vec![diagram("main", Main, text)]));
    let (mut diary, port) = (Diary::new(&program), output(&program));
    let long = Value::text("\u{43f}".repeat(5000));
    diary.sent(0, 0, port, &long);
    let first = told(&mut diary, &program, 0);
    assert!(first.contains(",bytes:10000,count:1}"), "{first}");
    let items = List::new(vec![long; 20]).expect("a list");
    diary.sent(0, 0, port, &Value::List(Rc::new(items)));
    let many = Value::ints(&[7; 1000]);
    diary.sent(0, 1, port, &many);
    let second = told(&mut diary, &program, 50);
    assert!(second.contains("items:20,"), "{second}");
    assert!(second.contains("items:1000,"), "{second}");
    assert!(second.contains("value:[7, 7, 7"), "{second}");
    assert!(second.len() < 1000, "{second}");
    let beyond = limits::DIARY_BLOCKS_MAX as NodeId;
    diary.fired(60, beyond);
    diary.sent(60, beyond, 0, &Value::Nil);
    assert!(diary.has_news());
    let third = told(&mut diary, &program, 100);
    assert_eq!(third, "{blocks:[],others:{reacted:1,tokens:1}}");
    assert!(!diary.has_news());
}

#[test]
fn a_block_that_has_no_room_in_a_line_comes_in_the_next_one() {
    let texts = "{IO0=1 | IO1=1 | IO2=1 | IO3=1 | IO4=1 | IO5=1}";
    let lines: Vec<String> = (0..10)
        .map(|at| format!("F{at} Text programming {texts}"))
        .collect();
    let program = program(project(vec![diagram("main", Main, &lines.join("\n"))]));
    let (mut diary, port) = (Diary::new(&program), output(&program));
    let text = Value::text("\u{43f}".repeat(100));
    for node in 0..10 {
        for output in 0..6 {
            diary.sent(0, node, port + 2 * output, &text);
        }
    }
    let mut seen = 0;
    for turn in 1..=10 {
        diary.is_last();
        let line = told(&mut diary, &program, turn);
        assert!(line.len() < limits::DIARY_BYTES_MAX + 100, "{}", line.len());
        assert!(line.contains("{id:"), "{line}");
        seen += line.matches(",count:1}").count();
        if !diary.has_news() {
            break;
        }
    }
    assert_eq!(seen, 60);
}
