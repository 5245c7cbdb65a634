//! Programs with text as solutions: the verdicts of the diagrams that they were written from, the same each time.

use crate::rig::TRIK;
use harness::{Board, Output, tools};
use std::path::Path;
use std::process::Command;

/// Solutions of the course and where they are tried.
const COURSE: [(&str, &[&str]); 9] = [
    (
        "along-the-box--e52f9a1d",
        &["along-the-box-1", "along-the-box-2", "along-the-box-3"],
    ),
    ("circle--2b37410e", &[]),
    ("example17-at-start", &[]),
    ("hello-world--44746332", &["hello-world"]),
    ("monster--79c0f8ff", &["monster1", "monster2"]),
    ("move-forward--e873613c", &["move-forward"]),
    ("randomizer-solution", &["ts-finish1-test", "ts-randomizer"]),
    ("smile--54cf23d6", &["smile"]),
    ("image-control--f9f07153", &[]),
];
/// Seconds by which a program may end at another moment than its diagram: it has no turns within a tick.
const NEAR_S: f64 = 1.0;

fn trik(board: &Board, words: &[&str]) -> Output {
    tools::run(Command::new(TRIK).args(words).current_dir(board.dir()), b"")
}

/// The verdict in the last line of a run, and its seconds.
fn verdict(output: &Output) -> (String, f64) {
    let line = output.stdout.lines().last().unwrap_or_default();
    let (_, told) = line.rsplit_once(": ").unwrap_or_default();
    let (verdict, rest) = told.split_once(", ").unwrap_or((told, ""));
    let seconds = rest.split(' ').next().and_then(|text| text.parse().ok());
    (verdict.to_owned(), seconds.unwrap_or(f64::NAN))
}

/// Judges all solutions of the course as diagrams and as programs.
fn compare(data: &Path, language: &str, ending: &str) {
    let board = Board::new();
    let mut complaints = Vec::new();
    for (name, fields) in COURSE {
        let save = data.join(format!("course/{name}.qrs"));
        let save = save.to_str().expect("a plain path");
        let program = format!("{name}.{ending}");
        let written = trik(&board, &["gen", save, "--lang", language, "-o", &program]);
        assert_eq!(written.code(), 0, "{name}: {}", written.stderr);
        let fields = fields
            .iter()
            .map(|field| Some(format!("fields/{field}.xml")));
        for field in fields.chain([None]) {
            let place = field.as_deref().map(|field| data.join(field));
            let mut words = vec!["check", save, "--time-limit", "100"];
            if let Some(place) = &place {
                words.extend(["--field", place.to_str().expect("a plain path")]);
            }
            let diagram = trik(&board, &words);
            words.extend(["--script", &program]);
            let text = trik(&board, &words);
            let (wanted, told) = (verdict(&diagram), verdict(&text));
            let is_near = (wanted.1 - told.1).abs() <= NEAR_S;
            if wanted.0 != told.0 || diagram.code() != text.code() || !is_near {
                complaints.push(format!("{name} {field:?}: {told:?}, not {wanted:?}"));
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn javascript_has_the_verdicts_of_its_diagrams() {
    if let Some(data) = needs::data() {
        compare(&data, "javascript", "js");
    }
}

#[test]
fn python_has_the_verdicts_of_its_diagrams() {
    if let Some(data) = needs::data()
        && needs::tool("python3")
    {
        compare(&data, "python", "py");
    }
}

const WORLD: &str = r##"<root version="20251219">
<world><walls><wall id="w" begin="200:-100" end="200:200" stroke-width="10"/></walls>
<regions><region id="finish" type="rectangle" x="60" y="-20" width="120" height="120"/></regions>
<robot position="0:0" direction="0"/></world>
<robots><robot id="trikKitRobot">
<sensors><sensor port="A1###input###sensorA1###" type="trik::robotModel::parts::TrikInfraredSensor" position="62:25" direction="0"/></sensors>
<wheels left="M3###output######M3" right="M4###output######M4"/></robot></robots>
<settings realisticPhysics="false" realisticSensors="false" realisticMotors="false"/>
<constraints><timelimit value="10000"/>
<event id="there" settedUpInitially="true"><condition><inside objectId="robot1" regionId="finish"/></condition>
<trigger><success deferred="true"/></trigger></event></constraints>
</root>
"##;

/// The same in both languages: to the wall, with a thread that counts and chance.
const JAVASCRIPT: &str = "
function count() { for (var i = 0; i < 20; i++) { print('count', i, ' ', script.random(1, 100)); script.wait(17); } }
var main = function () {
    Threading.startThread('count', count);
    brick.motor(M3).setPower(80); brick.motor(M4).setPower(80);
    while (brick.sensor(A1).read() > 20) {}
    brick.motor(M3).powerOff(); brick.motor(M4).powerOff();
    Threading.joinThread('count');
};";
const PYTHON: &str = "
def count():
    for i in range(20):
        print('count', i, script.random(1, 100))
        script.wait(17)
Threading.startThread('count', count)
brick.motor(M3).setPower(80); brick.motor(M4).setPower(80)
while brick.sensor(A1).read() > 20: pass
brick.motor(M3).powerOff(); brick.motor(M4).powerOff()
Threading.joinThread('count')
";

#[test]
fn programs_do_the_same_each_time_also_on_a_busy_computer() {
    let board = Board::new();
    board.file("world.xml", WORLD);
    board.file("p.js", JAVASCRIPT);
    board.file("p.py", PYTHON);
    let mut programs = vec!["p.js"];
    if needs::tool("python3") {
        programs.push("p.py");
    }
    for program in programs {
        let mut seen: Option<(String, Vec<u8>, Vec<u8>)> = None;
        for run in 0..4 {
            let mut busy = Vec::new();
            for _ in 0..2 * run {
                busy.push(
                    tools::shell("while :; do :; done")
                        .spawn()
                        .expect("a shell"),
                );
            }
            let words = ["check", program, "--field", "world.xml", "--force"];
            let files = ["--trajectory", "t.json", "--report", "r.json"];
            let output = trik(&board, &[&words[..], &files].concat());
            for mut child in busy {
                child.kill().expect("it runs");
                child.wait().expect("it ends");
            }
            assert_eq!(output.code(), 0, "{program}: {}", output.stdout);
            let read = |name: &str| std::fs::read(board.path(name)).expect(name);
            let now = (output.stdout, read("t.json"), read("r.json"));
            assert!(now.1.len() > 1000, "{program}");
            match &seen {
                None => seen = Some(now),
                Some(first) => assert!(*first == now, "{program} differs in run {run}"),
            }
        }
    }
}
