//! Data-flow programs of the robot: their pictures, and what stands in their blocks.
//!
//! Owns what of a block and its ports is told to a browser. Changes no file.

use crate::error::Error;
use crate::limits::{FLOW_BLOCKS_MAX, FLOW_EDGES_MAX};
use lang_dataflow::blocks::{Content, Direction, Port, Property, Row};
use lang_dataflow::project::{Block, Diagram, Project};
use lang_dataflow::show::{Looks, callings, picture, too_many, too_many_edges};
use lang_diagram::read::Save;
use lang_text::problem::Locale;
use serde_json::{Map, Value, json};
use std::path::Path;

/// The ending of a program in its textual form.
const ENDING: &str = "flow";

/// Whether a program of this name is a text.
pub(crate) fn is_text(name: &str) -> bool {
    let ending = Path::new(name).extension();
    ending.is_some_and(|ending| ending.eq_ignore_ascii_case(ENDING))
}

/// The sheets of a text; as those of a diagram, but `flow` is true, and each block has a `name`, which no other one of its sheet
/// has, and its `ports`.
///
/// # Errors
/// The text is none, it has mistakes, or it is too large.
pub(crate) fn of_text(bytes: &[u8], name: &str, locale: Locale) -> Result<Value, Error> {
    let text = std::str::from_utf8(bytes).map_err(|_| Error::Text(name.to_owned()))?;
    let read = lang_dataflow::text::read(text);
    let project = read.map_err(|problems| Error::undrawn(name, &problems, locale))?;
    sheets(&project, name, locale, &mut Looks::default())
}

/// The same of a save. What is strange about it is told when it runs.
///
/// # Errors
/// It is too large.
pub(crate) fn of_save(save: &Save, name: &str, locale: Locale) -> Result<Value, Error> {
    let project = lang_dataflow::read::project(save).0;
    sheets(&project, name, locale, &mut Looks::default())
}

/// All its sheets; what one picture has looked at for its ways is not left for the next one.
fn sheets(
    project: &Project,
    name: &str,
    locale: Locale,
    looks: &mut Looks,
) -> Result<Value, Error> {
    let diagrams = &project.diagrams;
    // One more for each diagram, which has a picture too.
    let count: usize = diagrams.iter().map(|one| 1 + one.blocks.len()).sum();
    let edges: usize = diagrams.iter().map(|one| one.edges.len()).sum();
    let refused = match (count > FLOW_BLOCKS_MAX, edges > FLOW_EDGES_MAX) {
        (true, _) => Some(too_many(name, count, FLOW_BLOCKS_MAX)),
        (false, true) => Some(too_many_edges(name, edges, FLOW_EDGES_MAX)),
        (false, false) => None,
    };
    if let Some(words) = refused {
        return Err(Error::Diagram(words.in_locale(locale).to_owned()));
    }
    let sheet = |(at, diagram): (usize, &Diagram)| {
        let names = callings(diagram, locale);
        let blocks = diagram.blocks.iter().zip(names);
        let blocks = blocks.map(|(block, name)| (block.id.clone(), told(block, &name, locale)));
        json!({
            "name": diagram.name,
            "main": project.main == Some(at),
            "flow": true,
            "picture": picture(project, at, locale, looks),
            "blocks": blocks.collect::<Map<_, _>>(),
        })
    };
    Ok(diagrams.iter().enumerate().map(sheet).collect())
}

/// What stands in a block, and where its ports are in its picture.
fn told(block: &Block, name: &str, locale: Locale) -> Value {
    let (rows, ports) = block
        .row
        .map_or((&[][..], &[][..]), |row| (row.properties, row.ports));
    let property = |property: &Property| {
        let shown = property.shown.trim_end_matches(['=', ':']);
        let choices = match property.content {
            Content::Flag => Some(&["true", "false"][..]),
            Content::Choice(words) => Some(words),
            Content::Expression
            | Content::Truth
            | Content::Whole
            | Content::Variables
            | Content::Evaluated
            | Content::Raw
            | Content::Constant
            | Content::Number
            | Content::Sensor
            | Content::Port => None,
        };
        json!({
            "name": property.name,
            "title": shown,
            "value": block.text(property.name),
            "choices": choices,
        })
    };
    let port = |port: &Port| {
        let gives = port.way == Direction::Out;
        json!({"name": port.name, "gives": gives, "x": port.at.0, "y": port.at.1})
    };
    json!({
        "title": block.row.map_or(block.element.as_str(), |row: &Row| row.shown_in(locale)),
        "name": name,
        "properties": rows.iter().map(property).collect::<Vec<_>>(),
        "ports": ports.iter().map(port).collect::<Vec<_>>(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const WALLS: &[u8] = include_bytes!("../../examples/dataflow/walls.flow");

    #[test]
    fn each_block_has_its_ports_and_its_group_in_the_picture() {
        let told = of_text(WALLS, "walls.flow", Locale::English).unwrap();
        let sheets = told.as_array().unwrap();
        let main = sheets.iter().find(|sheet| sheet["main"] == true).unwrap();
        assert_eq!(
            (&main["name"], &main["flow"]),
            (&json!("Walls"), &json!(true))
        );
        let blocks = main["blocks"].as_object().unwrap();
        let (id, front) = blocks
            .iter()
            .find(|(_, one)| one["name"] == "front")
            .unwrap();
        let group = format!("data-id=\"{id}\"");
        assert!(main["picture"].as_str().unwrap().contains(&group));
        assert_eq!(front["title"], "Sensor");
        assert_eq!(front["properties"][0]["value"], "sensorD1");
        let ports = front["ports"].as_array().unwrap();
        let out = ports.iter().find(|port| port["name"] == "OUT").unwrap();
        assert_eq!(out["gives"], true);
        assert!(out["x"].as_i64().unwrap() > 0);
        let russian = of_text(WALLS, "walls.flow", Locale::Russian).unwrap();
        assert_ne!(russian, told);
    }

    #[test]
    fn all_pictures_of_a_project_share_what_may_be_looked_at_for_ways() {
        let row =
            "  A: Say at 0, 0\n  B: Say at 200, 0\n  C: Say at 400, 0\n  A.CF_OUT -> C.CF_IN\n";
        let text = format!("diagram \"a\"\n{row}\ndiagram \"a\"\n{row}");
        let project = lang_dataflow::text::read(&text).unwrap();
        // How many corners the edge of each picture has.
        let corners = |looks: &mut Looks| {
            let told = sheets(&project, "a.flow", Locale::English, looks).unwrap();
            [0, 1].map(|at| {
                let picture = told[at]["picture"].as_str().unwrap();
                let (_, way) = picture.split_once("points=\"").unwrap();
                way.split('"').next().unwrap().split(' ').count()
            })
        };
        let mut looks = Looks::default();
        let before = looks.left();
        assert_eq!(corners(&mut looks), [6, 6]);
        let one = (before - looks.left()) / 2;
        assert_eq!(corners(&mut Looks::at_most(one + 1)), [6, 2]);
        assert_eq!(corners(&mut Looks::at_most(0)), [2, 2]);
    }

    #[test]
    fn what_is_no_program_or_too_large_is_refused_in_words() {
        let cases: [(&[u8], &str); 2] = [
            (b"diagram \"a\"\n  b: None", "there is no block 'None'"),
            (b"\xff", "UTF-8"),
        ];
        for (bytes, why) in cases {
            let told = of_text(bytes, "a.flow", Locale::English).unwrap_err();
            assert!(told.to_string().contains(why), "{told}");
        }
        let mut text = "diagram \"a\"\n".to_owned();
        for at in 0..FLOW_BLOCKS_MAX {
            text += &format!("  b{at}: Say\n");
        }
        let told = of_text(text.as_bytes(), "a.flow", Locale::English).unwrap_err();
        assert!(told.to_string().contains("at most 5000"), "{told}");
        let edge = "  a.CF_OUT -> b.CF_IN\n";
        for (count, is_drawn) in [(FLOW_EDGES_MAX, true), (FLOW_EDGES_MAX + 1, false)] {
            let text = "diagram \"a\"\n  a: Say\n  b: Say\n".to_owned() + &edge.repeat(count);
            let told = of_text(text.as_bytes(), "a.flow", Locale::English);
            assert_eq!(told.is_ok(), is_drawn);
            let why = "a.flow has 10001 edges: at most 10000 are drawn";
            assert!(told.err().is_none_or(|told| told.to_string() == why));
        }
        assert!(is_text("a/b.FLOW") && !is_text("flow") && !is_text("a.flow.qrs"));
    }
}
