//! Tests: docs/user/expressions.md says what really happens.

use super::{Bench, shown_as};
use crate::Compat;
use crate::reserved::{BUTTONS, FUNCTIONS, SENSORS, Shape};
use crate::tree::Binary;

fn page() -> String {
    let path = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../docs/user/expressions.md"
    );
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The text from a title to the next one.
fn section(page: &str, title: &str) -> String {
    let from = page
        .split_once(&format!("\n## {title}\n"))
        .unwrap_or_else(|| panic!("no section {title}"))
        .1;
    from.split("\n## ").next().unwrap_or_default().to_owned()
}

/// Cells of the rows of a section's first table, without its head.
fn rows(section: &str) -> Vec<Vec<String>> {
    let lines = section
        .lines()
        .skip_while(|line| !line.starts_with('|'))
        .take_while(|line| line.starts_with('|'))
        .skip(2);
    lines
        .map(|line| {
            let line = line.replace("\\|", "\u{1}");
            let cells = line.trim_matches('|').split('|');
            cells
                .map(|cell| cell.trim().replace('\u{1}', "|"))
                .collect()
        })
        .collect()
}

/// Whether a text shows what the page says; of a message only the beginning.
fn is_as_said(found: &str, said: &str) -> bool {
    let message = |text: &str| {
        text.split_once(' ')
            .filter(|(place, _)| place.contains(':'))
            .map(|(_, words)| words.to_owned())
    };
    found == said
        || found.starts_with(said) && !said.is_empty() && message(found).is_some()
        || message(found).is_some_and(|words| !said.is_empty() && words.starts_with(said))
}

#[test]
fn examples_show_what_the_page_says() {
    let mut bench: Option<Bench> = None;
    let mut checked = 0;
    for (index, line) in page().lines().enumerate() {
        match line {
            "```expression" => bench = Some(Bench::new(Compat::Studio)),
            "```" => bench = None,
            _ => {}
        }
        let Some(bench) = bench.as_mut().filter(|_| !line.starts_with("```")) else {
            continue;
        };
        let (text, said) = line
            .split_once("-- ")
            .or(line.split_once("--"))
            .unwrap_or_else(|| panic!("line {}: no result", index + 1));
        let found = bench.shown(text);
        assert!(
            is_as_said(&found, said.trim()),
            "line {}: {text}: {found:?}",
            index + 1
        );
        checked += 1;
    }
    assert!(checked > 35, "only {checked} examples");
}

#[test]
fn oddities_are_as_the_table_says() {
    let rows = rows(&section(&page(), "Oddities"));
    assert!(rows.len() > 12, "{}", rows.len());
    for row in rows {
        let text = row[0].trim_matches('`');
        for (compat, said) in [(Compat::Studio, &row[1]), (Compat::Fixed, &row[2])] {
            let found = shown_as(compat, &[text]);
            assert!(is_as_said(&found, said), "{text}, {compat:?}: {found:?}");
        }
        assert_ne!(row[1], row[2], "{text}: nothing odd");
    }
}

#[test]
fn all_operators_stand_in_the_order_of_their_strength() {
    let mut last = 0;
    let mut seen = 0;
    for row in rows(&section(&page(), "Operators")) {
        if row[0].contains("in front") {
            continue;
        }
        for sign in row[0]
            .split(['`', ' ', ','])
            .filter(|sign| !sign.is_empty())
        {
            let operator = Binary::of(sign).unwrap_or_else(|| panic!("no operator {sign}"));
            assert!(operator.precedence() >= last, "{sign}");
            last = operator.precedence();
            seen += 1;
        }
    }
    assert_eq!(seen, 24);
}

#[test]
fn all_functions_and_variables_of_the_robot_are_on_the_page() {
    let page = page();
    let functions = section(&page, "Functions");
    for (row, (name, _, arguments, result)) in rows(&functions).iter().zip(&FUNCTIONS) {
        assert!(row[0].starts_with(&format!("`{name}(")), "{name}: {row:?}");
        let wants = match arguments.chars().next() {
            Some('f') => "`float`",
            Some('i') => "`integer`",
            Some('s') => "`string`",
            Some(_) => "anything",
            None => "",
        };
        assert_eq!(row[1], wants, "{name}");
        let gives = match result {
            'f' => "`float`",
            'i' => "`integer`",
            _ => "writes",
        };
        assert!(row[2].starts_with(gives), "{name}");
    }
    assert_eq!(rows(&functions).len(), FUNCTIONS.len());
    let robot = section(&page, "The robot");
    for sensor in SENSORS {
        let (start, number) = sensor.name.split_at(sensor.name.len() - 1);
        let in_a_range =
            number.parse::<u32>().is_ok() && robot.contains(&format!("`{start}1` to "));
        assert!(
            robot.contains(&format!("`{}`", sensor.name)) || in_a_range,
            "{}",
            sensor.name
        );
        if let Shape::Numbers(count) = sensor.shape {
            assert!(
                robot.contains(&format!("{count} elements")),
                "{}",
                sensor.name
            );
        }
    }
    for (name, code) in BUTTONS {
        assert!(robot.contains(&format!("`{name}`")), "{name}");
        assert!(robot.contains(&code.to_string()), "{name}");
    }
}

#[test]
fn limits_are_as_the_page_says() {
    use crate::limits;
    let numbers: Vec<String> = rows(&section(&page(), "Limits"))
        .iter()
        .map(|row| row[1].split(' ').next().unwrap_or_default().to_owned())
        .collect();
    let expected = [
        limits::EXPRESSION_TEXT_MAX,
        limits::EXPRESSION_DEPTH_MAX.into(),
        limits::NAMES_MAX,
        limits::LIST_MAX,
        limits::LIST_DEPTH_MAX.into(),
        limits::TEXT_MAX,
        limits::STORE_CELLS_MAX as usize,
    ];
    assert_eq!(numbers, expected.map(|number| number.to_string()));
}
