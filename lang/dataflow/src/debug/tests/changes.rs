//! Programs that change while they run.

use super::*;

#[test]
fn a_new_version_goes_on_where_the_old_one_was() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 40);
    let faster = SLOW
        .replace("I0 * k", "I0 * k + 1")
        .replace("k = 2", "k = 7");
    let patched = desk.patch(&version(&faster), &mut robot).expect("a change");
    assert_eq!(patched.to_string(), "4 blocks kept, 0 new, 0 gone");
    runs(&mut desk, &mut robot, 50, 60);
    // The formula is new, and the block that assigns k does not start again.
    assert_eq!(last(&robot), "power M3 11");
    let n = desk.machine().variables().find(|(name, _)| *name == "n");
    assert_eq!(n.map(|(_, value)| value.brief()).as_deref(), Some("3"));
    // A block that is new starts; one that is gone speaks no more.
    let other = "B Loop {time=10}\nM Motors\nB.OUT > M.M4";
    let patched = desk.patch(&version(other), &mut robot).expect("a change");
    assert_eq!(patched.to_string(), "1 blocks kept, 1 new, 3 gone");
    robot.told.clear();
    runs(&mut desk, &mut robot, 70, 100);
    assert!(
        robot.told.iter().all(|told| told.starts_with("power M4")),
        "{:?}",
        robot.told
    );
    assert!(robot.told.len() > 1);
}

#[test]
fn windows_counts_and_timers_outlive_a_change() {
    let wait = "G Motors {M3Power=50}\nW Wait and send {time=100}\nN Motors {M3Power=0}\nG.CF_OUT > W.CF_IN\nW.CF_OUT > N.CF_IN";
    let (mut desk, mut robot) = (desk(wait), Robot::default());
    runs(&mut desk, &mut robot, 0, 50);
    let longer = wait
        .replace("time=100", "time=500")
        .replace("M3Power=0", "M3Power=-20");
    desk.patch(&version(&longer), &mut robot).expect("a change");
    robot.told.clear();
    runs(&mut desk, &mut robot, 60, 110);
    // The wait that had begun ends when it would have, and the first block is not started again.
    assert!(
        robot.told.iter().any(|told| told == "power M3 -20"),
        "{:?}",
        robot.told
    );
    assert!(
        !robot.told.iter().any(|told| told == "power M3 50"),
        "{:?}",
        robot.told
    );
}

#[test]
fn tokens_that_a_wait_keeps_outlive_a_change_and_are_counted() {
    let keeps = "L Loop {start_border=1 | end_border=4 | time=10}\nW Wait and send {time=100 | keep=true}\nM Motors\nL.OUT > W.DATA\nW.OUT > M.M3";
    let (mut desk, mut robot) = (desk(keeps), Robot::default());
    runs(&mut desk, &mut robot, 0, 50);
    let waiting = |desk: &mut Desk| {
        let state = told(desk, "look");
        let (_, list) = state.split_once("\"waiting\":").expect("a list");
        list.to_owned()
    };
    let three = "\"caption\":\"W\",\"port\":\"DATA\",\"count\":3,\"lost\":0";
    let before = waiting(&mut desk);
    assert!(before.contains(three), "{before}");
    let other = keeps.replace("time=100", "time=20");
    let patched = desk.patch(&version(&other), &mut robot).expect("a change");
    assert_eq!(patched.to_string(), "3 blocks kept, 0 new, 0 gone");
    assert_eq!(waiting(&mut desk), before);
    runs(&mut desk, &mut robot, 60, 130);
    // The one that was held ends when it would have, and the next ones after the new time.
    assert_eq!(last(&robot), "power M3 2");
    let gone = "L Loop {start_border=1 | end_border=4 | time=10}\nM Motors\nL.OUT > M.M4";
    let patched = desk.patch(&version(gone), &mut robot).expect("a change");
    assert_eq!(
        patched.to_string(),
        "2 blocks kept, 0 new, 1 gone, 1 token lost"
    );
}

#[test]
fn a_version_that_is_wrong_changes_nothing() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 40);
    let wrong = Version::of(&of("A Sensor\nM Motors\nF Zip flows\nF.OUT > M.M3"));
    assert!(matches!(wrong, Err(NoVersion::Mistakes(_))));
    let absent = SLOW.replace("A Sensor", "A Sensor {VarName=sensorA2}");
    let refused = desk.patch(&version(&absent), &mut robot);
    let Err(NoVersion::Mistakes(problems)) = refused else {
        panic!("{refused:?}");
    };
    assert!(
        problems[0]
            .in_locale(Locale::English)
            .contains("no such device")
    );
    runs(&mut desk, &mut robot, 50, 60);
    assert_eq!(last(&robot), "power M3 10");
    desk.stop(&mut robot, &mut Deaf);
    assert_eq!(
        desk.patch(&version(SLOW), &mut robot),
        Err(NoVersion::Ended)
    );
}

#[test]
fn a_program_that_is_stopped_is_changed_where_it_stands() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/M");
    runs(&mut desk, &mut robot, 0, 20);
    assert!(desk.is_stopped());
    let same = SLOW.replace("n + 1", "n + 10");
    desk.patch(&version(&same), &mut robot).expect("a change");
    assert!(desk.is_stopped());
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 30, 30);
    assert_eq!(last(&robot), "power M3 10");
    // The place where it stands may go.
    runs(&mut desk, &mut robot, 40, 60);
    assert!(desk.is_stopped());
    desk.patch(&version("A Sensor\nN Motors\nA.OUT > N.M4"), &mut robot)
        .expect("a change");
    assert!(desk.is_stopped());
    assert!(told(&mut desk, "continue").contains("\"done\":true"));
    runs(&mut desk, &mut robot, 70, 200);
    assert!(
        robot.told.iter().any(|told| told == "power M4 5"),
        "{:?}",
        robot.told
    );
}

#[test]
fn a_block_that_changed_a_variable_may_go_while_it_is_stopped_for_that() {
    let (mut desk, mut robot) = slow();
    told(&mut desk, "attach");
    told(&mut desk, "watch n");
    runs(&mut desk, &mut robot, 0, 40);
    assert!(told(&mut desk, "look").contains("\"by\":"));
    desk.patch(&version("A Sensor"), &mut robot)
        .expect("a change");
    let seen = told(&mut desk, "look");
    assert!(seen.contains("\"variable\":\"n\""), "{seen}");
    assert!(!seen.contains("\"by\":"), "{seen}");
}

#[test]
fn a_type_that_only_the_running_program_has_is_told() {
    let halves = "B Variable {variable=q = 2.5}\nA Sensor\nF Text programming {IO0=q * 2 + 0 * I0}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    let (mut desk, mut robot) = (desk(halves), Robot::default());
    runs(&mut desk, &mut robot, 0, 40);
    let wholes = halves.replace("q = 2.5", "q = 2").replace("q * 2", "q % 7");
    let refused = desk.patch(&version(&wholes), &mut robot);
    let Err(NoVersion::Mistakes(problems)) = refused else {
        panic!("{refused:?}");
    };
    let why = problems[0].in_locale(Locale::English).to_string();
    assert!(
        why.contains("Type mismatch; variables keep the types that they have in the running program, where q is of type float: start the program anew"),
        "{why}"
    );
}

#[test]
fn a_version_that_gives_a_variable_another_type_is_refused() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 40);
    let other = SLOW
        .replace("n = 0; k = 2", "n = 0; k = 'two'")
        .replace("I0 * k", "I0");
    let refused = desk.patch(&version(&other), &mut robot);
    let Err(NoVersion::Mistakes(problems)) = refused else {
        panic!("{refused:?}");
    };
    let why = problems[0].in_locale(Locale::English).to_string();
    assert!(
        why.contains("'k' is of the type 'integer', and this gives it 'string': a variable keeps its type until the program starts anew. Give it 'integer', or take another name."),
        "{why}"
    );
    // A list keeps its type, whatever its first item is.
    let list =
        "A Sensor\nF Text programming {IO0=h[1] = I0; h[1]}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    let (mut desk, mut robot) = (
        super::desk(list),
        Robot {
            a1: 5,
            ..Robot::default()
        },
    );
    runs(&mut desk, &mut robot, 0, 40);
    desk.patch(&version(list), &mut robot)
        .expect("the same again");
    runs(&mut desk, &mut robot, 50, 100);
    assert_eq!(
        desk.machine().errors().len(),
        0,
        "{:?}",
        desk.machine().errors()
    );
}

#[test]
fn a_version_whose_variables_get_their_values_later_is_taken() {
    let (mut desk, mut robot) = slow();
    runs(&mut desk, &mut robot, 0, 40);
    let other = "A Sensor\nP Text programming {IO0=kp = 0.5; e = I0 | IO1=kp*e + 20}\nM Motors\nA.OUT > P.I0\nP.O1 > M.M3";
    desk.patch(&version(other), &mut robot).expect("a change");
    runs(&mut desk, &mut robot, 50, 100);
    assert_eq!(last(&robot), "power M3 23");
}

#[test]
fn a_token_for_a_port_that_nothing_leads_to_any_more_is_lost() {
    let two = "A Sensor\nF Text programming {IO0=I0 | IO1=I1 + 1}\nM Motors\nA.OUT > F.I0\nA.OUT > F.I1\nF.O0 > M.M3\nF.O1 > M.M4";
    let (mut desk, mut robot) = (
        desk(two),
        Robot {
            a1: 5,
            ..Robot::default()
        },
    );
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/F");
    runs(&mut desk, &mut robot, 0, 20);
    let state = told(&mut desk, "look");
    assert!(state.contains("\"port\":\"I1\""), "{state}");
    assert!(state.contains("\"waiting\":[{"), "{state}");
    let one = "A Sensor\nF Text programming {IO0=I0}\nM Motors\nA.OUT > F.I0\nF.O0 > M.M3";
    let patched = desk.patch(&version(one), &mut robot).expect("a change");
    assert_eq!(patched.lost, 1);
    assert!(desk.is_stopped());
    told(&mut desk, "clear all");
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 30, 60);
    assert!(
        robot.told.iter().all(|told| told == "power M3 5"),
        "{:?}",
        robot.told
    );
    assert!(!robot.told.is_empty());
}

#[test]
fn each_call_of_a_subprogram_keeps_its_own_and_a_random_that_repeats_no_more_ends() {
    let inner =
        "I Input port\nS Flow replacer {time=60}\nO Output port\nI.OUT > S.DATA\nS.OUT > O.DATA";
    let outer = "R Random generator {fromNumber=3 | toNumber=3 | repeatedly=true | time=20}\nC User block of inner\nD User block of inner\nM Motors\nR.OUT > C.I0\nR.OUT > D.I0\nC.O0 > M.M3\nD.O0 > M.M4";
    let whole = |outer: &str| {
        project(vec![
            diagram("main", DiagramKind::Main, outer),
            diagram("inner", DiagramKind::Subprogram, inner),
        ])
    };
    let checked = check(&whole(outer));
    assert!(!checked.has_errors(), "{:?}", checked.problems);
    let mut desk = Desk::new(
        Machine::new(Rc::new(checked.program)),
        Locale::English,
        HISTORY_BYTES,
    );
    let mut robot = Robot::default();
    told(&mut desk, "attach");
    // One id, a block in each call: it stops in both.
    told(&mut desk, "break qrm:/inner/S");
    runs(&mut desk, &mut robot, 0, 20);
    assert!(desk.is_stopped());
    let call = |name| format!("\"caption\":\"S\",\"call\":\"{name}\"");
    assert!(told(&mut desk, "look").contains(&call("C")));
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 30, 30);
    assert!(desk.is_stopped(), "in the other call");
    assert!(told(&mut desk, "look").contains(&call("D")));
    told(&mut desk, "clear all");
    told(&mut desk, "continue");
    let once = outer.replace("repeatedly=true", "repeatedly=false");
    let once = Version::of(&whole(&once)).expect("a good program");
    let patched = desk.patch(&once, &mut robot).expect("a change");
    assert_eq!(patched.to_string(), "10 blocks kept, 0 new, 0 gone");
    runs(&mut desk, &mut robot, 40, 200);
    assert_eq!(
        robot
            .told
            .iter()
            .filter(|told| *told == "power M4 3")
            .count(),
        1
    );
    assert!(matches!(desk.machine().status(), Status::Ended { .. }));
    assert!(told(&mut desk, "continue").contains("has ended"));
    assert!(told(&mut desk, "until qrm:/main/M").contains("has ended"));
}

#[test]
fn a_program_that_has_ended_takes_no_values_and_stops_in_its_past() {
    let text = "V Variable {variable=n = 3}\nM Motors {M3Power=50}\nV.CF_OUT > M.CF_IN";
    let (mut desk, mut robot) = (desk(text), Robot::default());
    told(&mut desk, "attach");
    runs(&mut desk, &mut robot, 0, 20);
    assert!(matches!(desk.machine().status(), Status::Ended { .. }));
    for order in ["set n=4", "until qrm:/main/M", "step", "continue", "pause"] {
        let answer = told(&mut desk, order);
        assert!(answer.contains("\"done\":false"), "{order}: {answer}");
        assert!(answer.contains("has ended"), "{order}: {answer}");
        assert!(answer.contains("begin anew"), "{order}: {answer}");
    }
    assert_eq!(desk.assign("n", "4"), Err(NotNow::Ended));
    let n = told(&mut desk, "evaluate n");
    assert!(n.contains("\"value\":\"3\""), "{n}");
    let points = told(&mut desk, "breakpoints");
    assert!(points.contains("\"breakpoints\":[]"), "{points}");
    assert!(told(&mut desk, "break qrm:/main/M").contains("\"number\":1"));
    let back = told(&mut desk, "back continue");
    assert!(back.contains("\"state\":\"past\""), "{back}");
    assert!(
        back.contains("\"reason\":\"breakpoint\",\"number\":1"),
        "{back}"
    );
    assert!(told(&mut desk, "set n=4").contains("looks at the past"));
}

#[test]
fn the_token_after_one_that_is_gone_is_looked_at_like_any_other() {
    let next = |desk: &Desk| {
        let (machine, stop) = match desk.hindsight.shown() {
            Some(past) => past,
            None => (&desk.machine, desk.machine.stopped().expect("a stop")),
        };
        let to = stop.next.as_ref().map(|(to, _)| to.node);
        let node = to.map(|node| machine.program().node(node));
        (machine.now(), node.map(|node| node.id.to_string()))
    };
    let at = |now: u32, id: &str| (now, Some(format!("qrm:/main/{id}")));
    let all = "S Sensor\nC Motors\nD Motors\nE Motors\nS.OUT > C.M3\nS.OUT > D.M4\nS.OUT > E.M3";
    let (mut desk, mut robot) = (desk(all), Robot::default());
    told(&mut desk, "attach");
    told(&mut desk, "break qrm:/main/C");
    told(&mut desk, "break qrm:/main/D");
    runs(&mut desk, &mut robot, 0, 20);
    assert_eq!(next(&desk), at(20, "C"));
    let without = all.replace("C Motors\n", "").replace("S.OUT > C.M3\n", "");
    let patched = desk.patch(&version(&without), &mut robot);
    assert_eq!(patched.expect("a change").lost, 1);
    let reached = desk.machine.reached();
    assert_eq!(desk.machine.moment(), reached, "it was not counted");
    told(&mut desk, "continue");
    runs(&mut desk, &mut robot, 30, 30);
    assert_eq!(next(&desk), at(20, "D"));
    assert_eq!(desk.machine.moment(), reached);
    let points = told(&mut desk, "breakpoints");
    assert_eq!(points.matches("\"hits\":1").count(), 2, "{points}");
    told(&mut desk, "step");
    runs(&mut desk, &mut robot, 40, 40);
    assert_eq!(next(&desk), at(20, "E"));
    // The past has all three: the last one of them is of the old version.
    for id in ["D", "C"] {
        told(&mut desk, "back");
        assert_eq!(next(&desk), at(20, id));
    }
    for id in ["D", "E"] {
        told(&mut desk, "step");
        assert_eq!(next(&desk), at(20, id));
    }
}
