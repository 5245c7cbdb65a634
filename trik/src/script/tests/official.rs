//! The table of what the controller's own runtime has, called on the simulated robot.

use super::{Port, Status, python, robot, run};
use std::fmt::Write;

/// A row: the call, what the document says of it in JavaScript and in Python, whether it works under a judge.
fn rows() -> Vec<[&'static str; 4]> {
    let text = include_str!("../../../../docs/user/official.md");
    let rows = text.lines().filter(|line| line.starts_with("| `"));
    let rows = rows.map(|line| {
        let mut cells = line.trim_matches('|').split('|').map(str::trim);
        let mut cell = || cells.next().unwrap().trim_matches('`');
        [cell(), cell(), cell(), cell()]
    });
    rows.collect()
}

/// What is wrong with the rows of one language.
fn complaints(name: &str, rows: &[[&'static str; 4]], language: usize, text: &str) -> Vec<String> {
    let mut robot = robot();
    for (port, numbers) in [
        ("LidarPort", vec![7; 360]),
        ("AccelerometerPort", vec![0, 0, 1000]),
    ] {
        robot.vectors.insert(Port::named(port).unwrap(), numbers);
    }
    let (status, error) = match name {
        "JavaScript" => run(text, 60_000, &mut robot),
        _ => python(text, 60_000, &mut robot),
    };
    assert!(matches!(status, Status::Ended { .. }), "{name}: {status:?}");
    assert_eq!(error, "", "{name}");
    let mut found = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let start = format!("print \"ROW {index} ");
        let told = robot.log.iter().find(|(_, line)| line.starts_with(&start));
        let told = told.map_or("nothing", |(_, line)| line.as_str());
        let is_there = !row[language].starts_with("absent: ") && row[3] == "yes";
        // Of a name alone only that it is there can be seen.
        let says_nothing = !row[0].ends_with(')') && row[3] == "no";
        if told.contains(" works") != is_there && !says_nothing {
            found.push(format!("{name}: {}: '{}' but {told}", row[0], row[3]));
        }
    }
    found
}

#[test]
fn the_table_says_what_works_under_a_judge() {
    let rows = rows();
    assert!(rows.len() > 200, "{}", rows.len());
    let mut javascript = String::from(
        "function row(n, text, f) { var t; try { var v = f(); t = v === undefined && !/[)]$/.test(text) ? 'is undefined' : 'works'; } \
         catch (e) { t = 'fails ' + e; } print('ROW ' + n + ' ' + t); }\n",
    );
    let mut python = String::from(
        "true, false = True, False\n\
         def row(n, f):\n\
         \x20   try:\n        f()\n        told = 'works'\n\
         \x20   except Exception as error:\n        told = 'fails %s %s' % (type(error).__name__, error)\n\
         \x20   print('ROW', n, told)\n",
    );
    for (index, [call, ..]) in rows.iter().enumerate() {
        let _ = writeln!(
            javascript,
            "row({index}, {call:?}, function() {{ {} return {call}; }});",
            must_be_there(call)
        );
        let _ = writeln!(python, "row({index}, lambda: {})", python_of(call));
    }
    javascript.push_str("script.quit();\n");
    let mut found = complaints("JavaScript", &rows, 1, &javascript);
    if needs::tool("python3") {
        found.extend(complaints("Python", &rows, 2, &python));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// A part of the robot that is null is not there.
fn must_be_there(call: &str) -> String {
    match call.strip_suffix(')') {
        Some(_) if is_part(call) => format!("if ({call} === null) throw 'null';"),
        Some(_) | None => String::new(),
    }
}

fn python_of(call: &str) -> String {
    if is_part(call) {
        format!("({call}).__class__.__name__ != 'NoneType' or 1 / 0")
    } else {
        call.to_owned()
    }
}

/// Whether a call gives a part of the robot: `brick.NAME(...)` of a port or bus.
fn is_part(call: &str) -> bool {
    let parts = [
        "motor",
        "sensor",
        "encoder",
        "lineSensor",
        "colorSensor",
        "objectSensor",
        "soundSensor",
        "lidar",
        "irCamera",
        "pwmCapture",
        "fifo",
        "eventDevice",
        "i2c",
        "smBusI2c",
        "marker",
        "accelerometer",
        "gyroscope",
    ];
    let name = call
        .strip_prefix("brick.")
        .and_then(|rest| rest.split_once('('));
    name.is_some_and(|(name, rest)| parts.contains(&name) && rest.matches(')').count() == 1)
}
