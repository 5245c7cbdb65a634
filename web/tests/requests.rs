//! Requests as JavaScript makes them, without JavaScript: what is answered, and what is refused.

use lang_diagram::sketch::Sketch;
use lang_text::problem::Locale;
use serde_json::{Value, json};
use sim::judge::Clock;
use web::draft::Draft;
use web::failure::Failure;
use web::judged::judge;
use web::project::{Project, lint};
use web::run::Run;

/// The robot has to be 100 pixels ahead within two seconds.
const WORLD: &str = r#"<root version="20251219"><world><regions>
<region id="there" type="rectangle" x="100" y="-200" width="5000" height="500"/></regions>
<robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot"/></robots><settings/>
<constraints><timelimit value="2000"/>
<event settedUpInitially="true"><condition><inside objectId="robot1" regionId="there"/></condition>
<trigger><success/></trigger></event></constraints></root>"#;

/// A diagram that drives ahead for a time.
fn save(ms: &str) -> Vec<u8> {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let drive = sketch.block(
        "TrikV6EnginesForward",
        &[("Ports", "M3, M4"), ("Power", "100")],
    );
    let set = sketch.block("Function", &[("Body", "a = 5")]);
    let wait = sketch.block("Timer", &[("Delay", ms)]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, drive, set, wait, end]);
    sketch.world(WORLD);
    sketch.qrs().unwrap()
}

fn opened(bytes: Vec<u8>) -> Project {
    Project::open("task.qrs", bytes, "").0.unwrap()
}

fn judged(project: &Project, options: &str) -> Value {
    judge(project, options, Clock::default()).0.unwrap()
}

#[test]
fn a_project_is_judged_and_says_what_it_is() {
    let project = opened(save("1500"));
    let about = project.about();
    assert_eq!(
        (&about["language"], &about["hasWorld"]),
        (&"diagram".into(), &true.into())
    );
    let outcome = judged(&project, r#"{"trajectory": true}"#);
    assert_eq!(outcome["verdict"], "accomplished", "{outcome}");
    assert!(
        outcome["trajectory"]
            .as_str()
            .unwrap()
            .contains("trikKitRobot")
    );
    // It has not gone far enough then.
    let outcome = judged(&opened(save("10")), "");
    assert_eq!(
        (&outcome["verdict"], &outcome["trajectory"]),
        (&"failed".into(), &Value::Null)
    );
    assert_eq!(outcome["explanation"], Value::Null);
    // Why is told to those who ask, in their language, and after a run that is looked at too.
    let asks = r#"{"explain": true, "locale": "ru"}"#;
    let whole = judged(&opened(save("10")), asks)["explanation"].clone();
    let mut run = Run::begin(&opened(save("10")), asks).0.unwrap();
    while run.tick(1000) == "runs" {}
    let seen = run.outcome().unwrap();
    assert_eq!(seen["explanation"], whole);
    let first = whole["text"][0].as_str().unwrap();
    assert!(
        first.contains("0.04") && !first.starts_with("why") && whole["ms"] == outcome["ms"],
        "{whole}"
    );
    let nearest = &whole["rules"][0]["conditions"][0]["nearest"];
    assert!(nearest["gap"].as_f64().unwrap() > 1.0, "{whole}");
    let text = project.show("").0.unwrap();
    assert!(text.as_str().unwrap().contains("1500"), "{text}");
    let lines = project.outline("").0.unwrap();
    let all: Vec<&str> = (lines.as_array().unwrap().iter())
        .map(|line| line["text"].as_str().unwrap())
        .collect();
    assert_eq!(all.join("\n") + "\n", text.as_str().unwrap());
    let timer = lines.as_array().unwrap().iter();
    let mut timer = timer.filter(|line| line["text"].as_str().unwrap().contains("1500"));
    let block = timer.next().unwrap()["blocks"][0].as_str().unwrap();
    assert!(block.contains("/Timer/"), "{block}");
    let code = project.generate("python", "").0.unwrap();
    assert!(code["text"].as_str().unwrap().contains("setPower(100)"));
}

#[test]
fn what_cannot_be_run_has_a_verdict_and_a_report() {
    let project = opened(save("1500"));
    let outcome = judged(&project, r#"{"field": "<root"}"#);
    assert_eq!(
        (&outcome["verdict"], &outcome["failure"]),
        (&"broken".into(), &"not_run".into())
    );
    assert!(outcome["report"].as_str().unwrap().contains("error"));
    let begun = Run::begin(&project, r#"{"field": "<root"}"#).0;
    assert!(matches!(begun.err(), Some(Failure::World(_))));
}

#[test]
fn a_run_tick_by_tick_comes_to_the_same_end_and_shows_what_happens() {
    let project = opened(save("1500"));
    let whole = judged(&project, r#"{"trajectory": true}"#);
    for options in [
        r#"{"trajectory": true}"#,
        r#"{"trajectory": true, "debug": true}"#,
    ] {
        let mut run = Run::begin(&project, options).0.unwrap();
        assert_eq!(run.tick(20), "runs");
        let state: Value = serde_json::from_str(&run.state()).unwrap();
        assert_eq!(state["motors"], serde_json::json!({"M3": 100, "M4": 100}));
        assert_eq!(state["variables"]["a"], "5");
        assert_eq!(state["threads"][0]["kind"], "Timer", "{state}");
        assert!(state["world"]["robots"][0]["at"][0].as_f64().unwrap() > 0.0);
        let scene: Value = serde_json::from_str(&run.course().scene()).unwrap();
        assert_eq!(scene["robots"].as_array().unwrap().len(), 1);
        assert!(run.outcome().is_none());
        while run.tick(1) == "runs" {}
        assert_eq!(run.outcome().unwrap(), whole, "{options}");
        assert_eq!(run.news()["messages"], whole["messages"]);
        assert_eq!(run.news()["messages"], serde_json::json!([]));
        let ticks = run.course().trail(0).len() / 4;
        assert_eq!(run.course().trail(ticks - 1).len(), 4);
        assert!(run.course().trail(usize::MAX).is_empty());
        assert!(run.course().display().starts_with(b"\x89PNG"));
    }
}

#[test]
fn a_debugger_holds_model_time() {
    let project = opened(save("1500"));
    let mut plain = Run::begin(&project, "").0.unwrap();
    assert!(matches!(plain.order("attach"), Err(Failure::Request(_))));
    let mut run = Run::begin(&project, r#"{"debug": true}"#).0.unwrap();
    let answer = |run: &mut Run, order: &str| {
        let told: Value = serde_json::from_str(&run.order(order).unwrap()).unwrap();
        assert_eq!(told["done"], true, "{order}: {told}");
        told
    };
    answer(&mut run, "attach");
    answer(&mut run, "pause");
    assert_eq!((run.tick(1), run.tick(100)), ("held", "held"));
    let reports: Value = serde_json::from_str(&run.reports()).unwrap();
    assert!(!reports.as_array().unwrap().is_empty());
    let has_a = |run: &Run| {
        let state: Value = serde_json::from_str(&run.state()).unwrap();
        state["variables"]["a"] == "5"
    };
    let mut steps = 0;
    while !has_a(&run) {
        answer(&mut run, "step");
        assert_eq!(run.tick(50), "held", "after {steps} steps");
        steps += 1;
        assert!(steps < 5, "{}", run.state());
    }
    assert_eq!(answer(&mut run, "evaluate a + 1")["value"], "6");
    answer(&mut run, "detach");
    while run.tick(1000) == "runs" {}
    assert_eq!(run.outcome().unwrap()["verdict"], "accomplished");
}

#[test]
fn findings_are_told_and_strangers_are_refused() {
    let found = |name: &str, bytes: &[u8]| lint(name, bytes.to_vec(), "").0.unwrap();
    assert_eq!(found("task.qrs", &save("1500")), serde_json::json!([]));
    assert_eq!(found("task.qrs", b"rubbish")[0]["level"], "error");
    assert_eq!(found("world.xml", b"<root")[0]["file"], "world.xml");
    assert_eq!(found("a.flow", b"nonsense")[0]["fileLine"], 1);
    let why = |bytes: &[u8]| Project::open("a.qrs", bytes.to_vec(), "").0.unwrap_err();
    assert_eq!(why(b"rubbish").kind(), "unreadable");
    assert_eq!(why(WORLD.as_bytes()).kind(), "unreadable");
    let other = Project::open("a.qrs", save("5"), r#"{"diagram": "other"}"#).0;
    assert_eq!(other.unwrap_err().kind(), "diagram");
    let project = opened(save("5"));
    assert_eq!(
        project.generate("basic", "").0.unwrap_err().kind(),
        "request"
    );
    assert_eq!(
        project.show(r#"{"diagram": "x"}"#).0.unwrap_err().kind(),
        "diagram"
    );
    let (told, locale) = project.generate("python", r#"{"goto": true, "locale": "ru"}"#);
    assert_eq!(told.unwrap_err().kind(), "request");
    assert_eq!(locale.name(), "ru");
}

#[test]
fn a_project_is_drawn_looked_through_and_judged() {
    let mut draft = Draft::blank("new.qrs", r#"{"locale": "ru"}"#, 5).0.unwrap();
    let diagram = draft.about()["diagrams"][0]["id"]
        .as_str()
        .unwrap()
        .to_owned();
    let sheet = draft.sheet(&diagram, Locale::English);
    let id = |at: usize| sheet["blocks"][at]["id"].as_str().unwrap().to_owned();
    let mut apply = |change: Value| draft.apply(&change.to_string());
    let block = json!({"kind": "Timer", "at": [200, 200], "properties": {"Delay": "x"}});
    let new = apply(json!({"do": "add", "diagram": diagram, "blocks": [block]})).unwrap();
    let timer = new[0].as_str().unwrap().to_owned();
    for (from, to) in [(id(0), timer.clone()), (timer.clone(), id(1))] {
        apply(json!({"do": "connect", "from": from, "to": to})).unwrap();
    }
    let found = draft.lint(Locale::English);
    assert_eq!(
        (
            &found[0]["level"],
            &found[0]["object"],
            &found[0]["property"]
        ),
        (
            &"error".into(),
            &timer.as_str().into(),
            &"Delay (ms)".into()
        )
    );
    let set = |value: &str| json!({"do": "set", "id": timer, "property": "Delay", "value": value});
    draft.apply(&set("500").to_string()).unwrap();
    assert_eq!(draft.lint(Locale::English), json!([]));
    assert!(
        draft
            .names()
            .as_array()
            .unwrap()
            .contains(&json!({"name": "sensorA1", "is": "sensor"}))
    );
    let judged = judged(&draft.project("").0.unwrap(), "");
    assert_eq!(
        (&judged["verdict"], &judged["ms"]),
        (&"ended".into(), &530.into())
    );
    // What is taken back is not there, and what was saved before is.
    let saved = draft.save().unwrap();
    assert!(draft.turn_back(false) && draft.turn_back(true) && !draft.turn_back(true));
    assert_eq!(draft.save().unwrap(), saved);
    let again = Draft::open("new.qrs", saved, "", 6).0.unwrap();
    assert_eq!(
        again.sheet(&diagram, Locale::English),
        draft.sheet(&diagram, Locale::English)
    );
    let piece = again.copy(&[timer.clone(), id(1)]);
    assert_eq!(
        (
            piece["blocks"].as_array().unwrap().len(),
            &piece["links"][0]["to"]
        ),
        (2, &1.into())
    );
}

#[test]
fn a_change_that_is_none_is_refused_by_its_field_and_nothing_changes() {
    let mut draft = Draft::blank("new.qrs", "", 5).0.unwrap();
    let before = draft.about();
    let refused = |draft: &mut Draft, change: &str| match draft.apply(change).unwrap_err() {
        Failure::Request(words) => words.english.to_string(),
        Failure::Program(problems) => format!("program: {}", problems[0].words.english),
        other => panic!("{other:?}"),
    };
    for (change, field) in [
        ("[]", "'do'"),
        ("{", "'do'"),
        (r#"{"do": "fly"}"#, "'do'"),
        (r#"{"do": "remove", "ids": "a"}"#, "'ids'"),
        (r#"{"do": "remove", "ids": [], "more": 1}"#, "'more'"),
        (
            r#"{"do": "move", "places": [{"id": "a", "at": [1]}]}"#,
            "'at'",
        ),
        (r#"{"do": "kit", "kit": "ev3"}"#, "'kit'"),
        (
            r#"{"do": "remove", "ids": ["a"]}"#,
            "program: there is no such block",
        ),
        (r#"{"do": "world", "text": "<root"}"#, "program: "),
    ] {
        let why = refused(&mut draft, change);
        assert!(why.contains(field), "{change}: {why}");
    }
    assert_eq!(draft.about(), before);
}

#[test]
fn a_run_takes_a_new_version_of_its_program_and_refuses_a_broken_one() {
    let project = opened(save("60000"));
    let mut run = Run::begin(&project, r#"{"debug": true}"#).0.unwrap();
    run.tick(10);
    let mut draft = Draft::open("task.qrs", save("60000"), "", 3).0.unwrap();
    let diagram = draft.about()["diagrams"][0]["id"]
        .as_str()
        .unwrap()
        .to_owned();
    let sheet = draft.sheet(&diagram, Locale::English);
    let motors = sheet["blocks"][1]["id"].as_str().unwrap().to_owned();
    let mut version = |power: &str| {
        let set = json!({"do": "set", "id": motors, "property": "Power", "value": power});
        draft.apply(&set.to_string()).unwrap();
        draft.project("").0.unwrap()
    };
    match run.patch(&version("100 +")) {
        Err(Failure::Program(problems)) => assert!(!problems.is_empty()),
        other => panic!("{other:?}"),
    }
    assert_eq!(run.tick(1), "runs");
    let told = run.patch(&version("0 - 100")).unwrap();
    assert_eq!(told, "5 blocks kept, 0 new, 0 gone");
    let plain = Run::begin(&project, "").0.unwrap().patch(&project);
    assert!(matches!(plain, Err(Failure::Request(_))), "no debugger");
    run.end();
    assert!(
        matches!(run.patch(&project), Err(Failure::Request(_))),
        "over"
    );
}
