//! Requests as JavaScript makes them, without JavaScript: what is answered, and what is refused.

use lang_diagram::sketch::Sketch;
use serde_json::Value;
use sim::judge::Clock;
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
    let text = project.show("").0.unwrap();
    assert!(text.as_str().unwrap().contains("1500"), "{text}");
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
        let scene: Value = serde_json::from_str(&run.scene()).unwrap();
        assert_eq!(scene["robots"].as_array().unwrap().len(), 1);
        assert!(run.outcome().is_none());
        while run.tick(1) == "runs" {}
        assert_eq!(run.outcome().unwrap(), whole, "{options}");
        assert_eq!(run.news()["messages"], whole["messages"]);
        assert_eq!(run.news()["messages"], serde_json::json!([]));
        let ticks = run.trail(0).len() / 4;
        assert_eq!(run.trail(ticks - 1).len(), 4);
        assert!(run.trail(usize::MAX).is_empty());
        assert!(run.display().starts_with(b"\x89PNG"));
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
