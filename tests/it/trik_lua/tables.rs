//! The tables of docs/user/trik.md are those of the configuration: attribute, access, unit, description.
//!
//! `TRIK_WRITE_DOCS=1 cargo test -p tests --test it trik_lua::tables` writes them anew.

use super::run::robot;
use config::description::NodeDescription;
use std::fmt::Write;
use std::path::Path;

const BEGIN: &str = "<!-- tables: made by a test, do not edit -->\n";
const END: &str = "<!-- end of tables -->\n";

fn row(table: &mut String, name: &str, node: &NodeDescription) {
    let access = match (node.mode & 0o444 != 0, node.mode & 0o222 != 0) {
        (true, true) => "read, write",
        (false, true) => "write",
        _ => "read",
    };
    let names: Vec<String> = node
        .format
        .iter()
        .flat_map(|format| format.fields())
        .map(|field| field.name.clone())
        .collect();
    let is_text = node.format.as_ref().is_some_and(|format| format.is_text());
    let numbers = match names.len() {
        0 if is_text => "one text".to_owned(),
        0 => "-".to_owned(),
        count if count > 9 => format!("{count}: {} to {}", names[0], names[count - 1]),
        _ => names.join(", "),
    };
    let units = if node.units.is_empty() {
        "-"
    } else {
        &node.units
    };
    writeln!(
        table,
        "| `{name}` | {access} | {numbers} | {units} | {} |",
        node.about
    )
    .unwrap();
}

/// One table for each group of the tree; a port stands for its likes, unless its type is another.
fn tables() -> String {
    let robot = robot(
        "{ port = 'lidar' }, { port = 'ir_camera' }, { port = 'M1', encoder = 'E1' },
         { port = 'odometry', left = 'E1', right = 'E2', wheel_diameter_mm = 56, track_mm = 155 }",
    );
    let mut text = String::new();
    let mut group = "";
    for node in &robot.loaded.config.nodes {
        let top = node.path.split('/').next().unwrap_or_default();
        let number = node.path.chars().last().and_then(|c| c.to_digit(10));
        let has_likes = ["motors", "encoders", "servos", "sensors"].contains(&top);
        if has_likes && number.is_some_and(|number| number > 1) {
            continue;
        }
        if group != top {
            group = top;
            write!(
                text,
                "\n### {top}\n\n| file | access | numbers | unit | what |\n"
            )
            .unwrap();
            text.push_str("| --- | --- | --- | --- | --- |\n");
        }
        row(&mut text, &format!("{}/", node.path), node);
        for attribute in &node.attributes {
            row(&mut text, &attribute.path, attribute);
        }
    }
    text.push('\n');
    text
}

/// A device that is absent by default has a row only if the robot of the tables lists it.
#[test]
fn every_port_that_gives_a_node_at_the_top_is_in_the_tables() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../config/lua/trik"));
    let tables = tables();
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let text = std::fs::read_to_string(entry.unwrap().path()).unwrap();
        let Some((_, rest)) = text.split_once("top = true, ports = { ") else {
            continue;
        };
        let (ports, _) = rest.split_once(" } }").unwrap();
        for port in ports.split(", ") {
            let name = port.strip_suffix(" = {}").unwrap_or(port);
            let name = name.strip_suffix(" = {").unwrap_or(name);
            assert!(
                tables.contains(&format!("\n### {name}\n")),
                "{name} has no table: list it in the robot of `tables`"
            );
            count += 1;
        }
    }
    assert!(count >= 14, "only {count} ports at the top");
}

#[test]
fn the_tables_of_the_document_are_those_of_the_configuration() {
    let path = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/user/trik.md"));
    let document = std::fs::read_to_string(path).unwrap();
    let (before, rest) = document.split_once(BEGIN).unwrap();
    let (written, after) = rest.split_once(END).unwrap();
    let made = tables();
    if std::env::var_os("TRIK_WRITE_DOCS").is_some() {
        std::fs::write(path, format!("{before}{BEGIN}{made}{END}{after}")).unwrap();
        return;
    }
    assert!(made.lines().count() > 60, "{made}");
    assert_eq!(written, made, "write it anew with TRIK_WRITE_DOCS=1");
}
