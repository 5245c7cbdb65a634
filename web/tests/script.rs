//! Programs with text whose questions come from outside, asked by this test instead of an engine.

use serde_json::Value;
use web::failure::Failure;
use web::script::Script;

/// The robot has to be 100 pixels ahead within two seconds.
const WORLD: &str = r#"<root version="20251219"><world><regions>
<region id="there" type="rectangle" x="100" y="-200" width="5000" height="500"/></regions>
<robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot"/></robots><settings/>
<constraints><timelimit value="2000"/>
<event settedUpInitially="true"><condition><inside objectId="robot1" regionId="there"/></condition>
<trigger><success/></trigger></event></constraints></root>"#;
/// More than any answer here needs.
const MANY: u32 = 1000;

fn begun(name: &str, world: &str) -> Script {
    Script::begin(name, world, r#"{"seed": 1}"#).0.unwrap()
}

fn refused(name: &str, world: &str, options: &str) -> Failure {
    match Script::begin(name, world, options).0 {
        Ok(_) => panic!("{name} has begun"),
        Err(why) => why,
    }
}

fn verdict(script: &Script) -> String {
    let outcome: Value = script.outcome().unwrap();
    outcome["verdict"].as_str().unwrap().to_owned()
}

#[test]
fn a_program_drives_the_world_by_its_questions() {
    let mut script = begun("p.py", WORLD);
    for motor in ["M3", "M4"] {
        let told = script.ask("write", &format!("motors/{motor}/value\n100"), MANY);
        assert_eq!(told, "ok:0:");
    }
    assert!(script.outcome().is_none());
    assert_eq!(script.ask("print", "on my way\n", MANY), "ok:0:");
    // Nothing waits for an answer: that is said, and not waited for.
    assert_eq!(script.go_on(MANY), "no:0:5:nothing was asked");
    // The answer comes when the time has: two pictures of 20 ms, and then the rest.
    assert_eq!(script.ask("wait", "35", 2), "later");
    assert_eq!(script.go_on(1), "later");
    assert_eq!(script.go_on(MANY), "ok:40:");
    assert_eq!(script.news()["printed"], serde_json::json!(["on my way"]));
    assert_eq!(script.ask("wait", "1900", MANY), "over");
    assert_eq!(verdict(&script), "accomplished");
    assert_eq!(script.ask("read", "encoders/E3/value", MANY), "over");
}

#[test]
fn what_there_is_not_is_answered_with_a_number_and_a_reason() {
    let mut script = begun("p.js", "");
    assert_eq!(
        script.ask("read", "motors/Q9/value", MANY),
        "no:0:2:the simulated robot has no such file"
    );
    assert!(script.ask("take", "", MANY).starts_with("no:0:11:"));
    assert!(
        script
            .ask("include", "more.js", MANY)
            .starts_with("no:0:2:more.js: ")
    );
    assert!(script.ask("nonsense", "", MANY).starts_with("no:0:5:"));
    let long = "x".repeat(1 << 20);
    assert!(script.ask("print", &long, MANY).starts_with("no:0:5:"));
    assert_eq!(script.ask("listen", "keys/device", MANY), "ok:0:");
    // Nothing comes: the wait ends at its time, and what is no time never comes.
    assert_eq!(script.ask("event", "20", MANY), "ok:20:");
    assert_eq!(script.ask("event", "never", 50), "later");
}

#[test]
fn who_asks_without_waiting_is_charged_time() {
    for name in ["p.py", "p.js"] {
        let mut script = begun(name, "");
        let mut last = String::new();
        for _ in 0..250 {
            last = script.ask("read", "battery/value", MANY);
        }
        assert!(last.starts_with("ok:20:"), "{name}: {last}");
        // One that only computes takes time as well.
        for _ in 0..6 {
            last = script.ask("look", "", MANY);
        }
        assert!(last.starts_with("ok:4"), "{name}: {last}");
    }
}

#[test]
fn a_program_that_has_failed_says_where() {
    let mut script = begun("p.py", WORLD);
    script.ask("error", "Line 3: NameError: x\nf at p.py:3", MANY);
    assert_eq!(script.ask("end", "1", MANY), "over");
    let outcome = script.outcome().unwrap();
    assert_eq!(outcome["verdict"], "failed");
    let told = outcome["messages"].to_string();
    assert!(told.contains("NameError: x"), "{told}");
    assert!(outcome["report"].as_str().unwrap().contains("NameError"));
}

#[test]
fn what_is_no_program_or_world_is_refused() {
    for (name, world, options, kind) in [
        ("p.lua", "", "", "request"),
        ("p", "", "", "request"),
        ("p.py", "<root", "", "world"),
        ("p.py", "", r#"{"field": "<root/>"}"#, "request"),
        ("p.py", "", r#"{"debug": true}"#, "request"),
        ("p.py", "", r#"{"seed": -1}"#, "request"),
    ] {
        assert_eq!(
            refused(name, world, options).kind(),
            kind,
            "{name} {options}"
        );
    }
}

#[test]
fn a_run_that_is_ended_has_an_outcome_and_answers_nothing() {
    let mut script = begun("p.js", "");
    assert_eq!(script.ask("event", "100", 3), "later");
    script.end();
    assert!(script.outcome().is_some());
    assert_eq!(script.go_on(5), "over");
    assert!(!script.state().is_empty() && !script.course().scene().is_empty());
}
