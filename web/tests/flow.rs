//! Requests about drawings of data flow, as JavaScript makes them.

use lang_text::problem::Locale;
use serde_json::{Value, json};
use std::path::PathBuf;
use web::draft::Draft;
use web::failure::Failure;
use web::palette::palette;
use web::project::Project;
use web::run::Run;

/// A robot that has a sonar ahead and wheels, and nothing else around.
const WORLD: &str = r#"<root version="20251219"><world/>
<robots><robot id="trikKitRobot"><sensors/></robot></robots><settings/></root>"#;

fn blank() -> Draft {
    let options = r#"{"language": "dataflow"}"#;
    Draft::blank("new.qrs", options, 5).0.unwrap()
}

fn diagram(draft: &Draft) -> String {
    let about = draft.about();
    about["diagrams"][0]["id"].as_str().unwrap().to_owned()
}

fn apply(draft: &mut Draft, change: &Value) -> Vec<String> {
    let new = draft.apply(&change.to_string()).unwrap();
    let new = new.as_array().unwrap().iter();
    new.map(|id| id.as_str().unwrap().to_owned()).collect()
}

/// The place of a port in the palette.
fn port(kind: &str, name: &str) -> usize {
    let all = palette(r#"{"language": "dataflow"}"#).0.unwrap();
    let all = all.as_array().unwrap();
    let row = all.iter().find(|row| row["kind"] == kind).unwrap();
    let ports = row["ports"].as_array().unwrap();
    ports.iter().position(|one| one["name"] == name).unwrap()
}

fn drawn() -> (Draft, [String; 3]) {
    let mut draft = blank();
    let block = |kind: &str, x: u32, properties: Value| json!({"kind": kind, "at": [x, 100], "properties": properties});
    let diagram = diagram(&draft);
    let blocks = json!([
        block("DFValueEmitterBlock", 0, json!({})),
        block("DFFunctionBlock", 200, json!({"IO0": "a = I0; 40 + a"})),
        block("DFMotorsBlock", 600, json!({})),
    ]);
    let links = json!([
        {"from": 1, "to": 2, "ports": [port("DFFunctionBlock", "O0"), port("DFMotorsBlock", "M3")]},
        {"from": 1, "to": 2, "ports": [port("DFFunctionBlock", "O0"), port("DFMotorsBlock", "M4")],
         "properties": {"Policy": "latest"}},
    ]);
    let add = json!({"do": "add", "diagram": diagram, "blocks": blocks, "links": links});
    let ids = apply(&mut draft, &add);
    let [value, function, motors, ..] = &ids[..] else {
        panic!("{ids:?}");
    };
    let ids = [value.clone(), function.clone(), motors.clone()];
    (draft, ids)
}

#[test]
fn the_palette_has_all_blocks_with_their_ports_in_both_languages() {
    let all = |locale: &str| {
        let options = format!(r#"{{"language": "dataflow", "locale": "{locale}"}}"#);
        palette(&options).0.unwrap().as_array().unwrap().clone()
    };
    let (english, russian) = (all("en"), all("ru"));
    assert_eq!((english.len(), russian.len()), (47, 47));
    let of = |all: &[Value]| all.iter().find(|one| one["kind"] == "DFIfBlock").cloned();
    let (one, other) = (of(&english).unwrap(), of(&russian).unwrap());
    assert_eq!(
        (&one["title"], &other["title"]),
        (&"If".into(), &"\u{415}\u{441}\u{43b}\u{438}".into())
    );
    assert_eq!(
        one["ports"][1],
        json!({"name": "DATA", "way": "in", "of": "any", "at": [1, 48]})
    );
    assert_eq!(one["properties"][0]["default"], "data>0");
    let wrong = palette(r#"{"language": "blocks"}"#).0.unwrap_err();
    assert_eq!(wrong.kind(), "request");
    let diagrams = palette("").0.unwrap();
    assert!(diagrams[0]["ports"].is_null());
}

#[test]
fn a_program_is_drawn_looked_through_and_run() {
    let (mut draft, [value, function, motors]) = drawn();
    assert_eq!(draft.about()["language"], "dataflow");
    let from = [
        port("DFValueEmitterBlock", "OUT"),
        port("DFFunctionBlock", "I0"),
    ];
    let connect = |to: &str, ports: [usize; 2]| json!({"do": "connect", "from": value, "to": to, "ports": ports});
    let link = apply(&mut draft, &connect(&function, from)).remove(0);
    let sheet = draft.sheet(&diagram(&draft), Locale::English);
    let links = sheet["links"].as_array().unwrap();
    assert_eq!(links.len(), 3);
    let of = links.iter().find(|one| one["id"] == link.as_str()).unwrap();
    assert_eq!((&of["ports"], &of["from"]), (&json!(from), &json!(value)));
    assert!(links.iter().any(|one| one["policy"] == "latest"));
    assert_eq!(sheet["blocks"][1]["details"], "IO0 = a = I0; 40 + a");
    let names = draft.names();
    for wanted in ["a", "sensorA1", "I0", "data"] {
        let names = names.as_array().unwrap();
        assert!(names.iter().any(|one| one["name"] == wanted), "{wanted}");
    }
    let set = |value: &str| json!({"do": "set", "id": function, "property": "IO0", "value": value});
    apply(&mut draft, &set("40 +"));
    let found = draft.lint(Locale::English);
    assert_eq!(
        (&found[0]["level"], &found[0]["object"]),
        (&"error".into(), &json!(function))
    );
    apply(&mut draft, &set("40 + I0"));
    apply(&mut draft, &json!({"do": "world", "text": WORLD}));
    let project = draft.project("").0.unwrap();
    let text = project.show(r#"{"source": true}"#).0.unwrap();
    assert!(text.as_str().unwrap().contains("-> "), "{text}");
    // Nothing comes in from a sensor.
    assert!(project.generate("lua", "").0.is_err());
    // It is over at once: a value is given once.
    let mut run = Run::begin(&project, r#"{"debug": true}"#).0.unwrap();
    run.tick(5);
    let wrong = draft.apply(&connect(&motors, [0, 0]).to_string());
    assert!(matches!(wrong.unwrap_err(), Failure::Program(_)));
    let wrong = draft.apply(&json!({"do": "connect", "from": value, "to": motors}).to_string());
    assert!(matches!(wrong.unwrap_err(), Failure::Program(_)));
}

#[test]
fn a_run_tells_the_last_token_of_each_port_and_takes_a_new_version() {
    let mut draft = blank();
    let here = diagram(&draft);
    let add = json!({"do": "add", "diagram": here, "blocks": [
        {"kind": "DFRandomValueBlock", "at": [0, 0], "properties": {"fromNumber": "50", "toNumber": "50", "repeatedly": "true", "time": "20"}},
        {"kind": "DFMotorsBlock", "at": [300, 0]},
    ], "links": [{"from": 0, "to": 1, "ports": [port("DFRandomValueBlock", "OUT"), port("DFMotorsBlock", "M3")]}]});
    let ids = apply(&mut draft, &add);
    let project = draft.project("").0.unwrap();
    let mut run = Run::begin(&project, r#"{"debug": true}"#).0.unwrap();
    run.order("attach").unwrap();
    run.tick(20);
    let reports = run.reports();
    assert!(reports.contains(r#""port":"OUT""#), "{reports}");
    let state: Value = serde_json::from_str(&run.state()).unwrap();
    assert_eq!(state["motors"]["M3"], 50, "{state}");
    let set = json!({"do": "set", "id": ids[0], "property": "fromNumber", "value": "20"});
    apply(&mut draft, &set);
    let set = json!({"do": "set", "id": ids[0], "property": "toNumber", "value": "20"});
    apply(&mut draft, &set);
    let told = run.patch(&draft.project("").0.unwrap()).unwrap();
    assert!(told.contains("2 blocks kept"), "{told}");
    run.tick(20);
    let state: Value = serde_json::from_str(&run.state()).unwrap();
    assert_eq!(state["motors"]["M3"], 20, "{state}");
}

/// The library of behaviours.
fn library() -> Vec<(String, Vec<u8>)> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../examples/dataflow"));
    let files = std::fs::read_dir(folder)
        .unwrap()
        .map(|one| one.unwrap().path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "flow"));
    let name = |path: &PathBuf| path.file_name().unwrap().to_string_lossy().into_owned();
    files
        .map(|path| (name(&path), std::fs::read(&path).unwrap()))
        .collect()
}

#[test]
fn a_program_in_its_textual_form_becomes_a_drawing_and_is_saved_as_one() {
    let all = library();
    assert!(all.len() >= 5);
    for (name, bytes) in all {
        let draft = Draft::open(&name, bytes.clone(), "", 1).0.unwrap();
        let about = draft.about();
        assert_eq!(about["name"], name.replace(".flow", ".qrs"));
        let saved = draft.save().unwrap();
        let again = Draft::open("a.qrs", saved.clone(), "", 2).0.unwrap();
        assert_eq!(again.save().unwrap(), saved, "{name}");
        let source = |project: &Project| {
            let text = project.show(r#"{"source": true}"#).0.unwrap();
            let text = text.as_str().unwrap().to_owned();
            // A save has the version of the language, and edges in the order of the blocks where they begin.
            let lines = text
                .lines()
                .filter(|line| !line.is_empty() && !line.starts_with("meta"));
            let mut lines: Vec<_> = lines.map(str::to_owned).collect();
            lines.sort();
            lines
        };
        let text = Project::open(&name, bytes, "").0.unwrap();
        assert_eq!(
            source(&again.project("").0.unwrap()),
            source(&text),
            "{name}"
        );
        for one in about["diagrams"].as_array().unwrap() {
            let id = one["id"].as_str().unwrap();
            let sheet = draft.sheet(id, Locale::Russian);
            assert_eq!(sheet, again.sheet(id, Locale::Russian), "{name}");
            let links = sheet["links"].as_array().unwrap();
            assert!(links.iter().all(|link| link["ports"].is_array()), "{sheet}");
        }
        let errors = draft.lint(Locale::English);
        let errors = errors.as_array().unwrap().iter();
        let errors: Vec<_> = errors.filter(|one| one["level"] == "error").collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
    }
    let wrong = Draft::open("a.flow", b"nonsense".to_vec(), "", 1)
        .0
        .unwrap_err();
    assert_eq!(wrong.kind(), "unreadable");
}
