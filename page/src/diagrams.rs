//! Diagrams of the robot: their pictures, what stands in their blocks, and a diagram with another value in one of them.
//!
//! Owns what of a block is told to a browser. Changes no file: what is changed goes to the robot over its control port, as every
//! other program does.

use crate::error::Error;
use crate::{flows, limits, store};
use lang_dataflow::read::{Language, language};
use lang_diagram::blocks::{Content, Property, find};
use lang_diagram::check::check;
use lang_diagram::lower::World;
use lang_diagram::project::{Block, Diagram, Project};
use lang_diagram::read::{Opened, read};
use lang_diagram::show::picture::picture;
use lang_text::problem::{Locale, Problem, Severity};
use serde_json::{Map, Value, json};
use std::path::Path;

/// A value for a property of a block.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// The id of the block.
    pub block: String,
    /// The name of the property in the save.
    pub property: String,
    /// What stands there from now on.
    pub value: String,
}

/// A diagram as JSON: for each sheet its `name`, whether it is the `main` one, whether it is of data `flow`, its `picture` in SVG, in
/// which every block is a group with its `data-id`, and its `blocks` by those ids, each with its properties.
///
/// # Errors
/// There is no such program, or it is no diagram that can be read.
pub fn sheets(folder: &Path, name: &str, locale: Locale) -> Result<Value, Error> {
    if flows::is_text(name) {
        return flows::of_text(&store::read(folder, name)?, name, locale);
    }
    let opened = open(folder, name, locale)?;
    if language(&opened.save) == Language::Dataflow {
        return flows::of_save(&opened.save, name, locale);
    }
    let sheet = |(at, diagram): (usize, &Diagram)| {
        let is_main = opened.project.main == Some(at);
        let blocks = diagram.blocks.iter();
        let blocks = blocks.filter_map(|block| Some((block.id.clone(), told(block, locale)?)));
        json!({
            "name": diagram.name,
            "main": is_main,
            "flow": false,
            "picture": picture(diagram, locale),
            "blocks": blocks.collect::<Map<_, _>>(),
        })
    };
    Ok(opened
        .project
        .diagrams
        .iter()
        .enumerate()
        .map(sheet)
        .collect())
}

/// The save of a diagram with another value in one of its blocks.
///
/// # Errors
/// There is no such diagram, block or property, the value is too long or none of those that can stand there, or the diagram has
/// mistakes by it that it had not before.
pub fn changed(
    folder: &Path,
    name: &str,
    change: &Change,
    locale: Locale,
) -> Result<Vec<u8>, Error> {
    let Opened {
        project, mut save, ..
    } = open(folder, name, locale)?;
    let wrong = |why: String| Error::Change(why);
    let mut blocks = project.diagrams.iter().flat_map(|diagram| &diagram.blocks);
    let block = blocks.find(|block| block.id == change.block);
    let property = block.and_then(|block| find(&block.kind)?.property(&change.property));
    let Some(property) = property else {
        let why = format!(
            "{name} has no block {} with {}",
            change.block, change.property
        );
        return Err(wrong(why.chars().take(limits::CELL_LETTERS).collect()));
    };
    if change.value.len() > limits::PROPERTY_BYTES_MAX {
        let most = limits::PROPERTY_BYTES_MAX;
        return Err(wrong(format!(
            "{}: at most {most} bytes",
            property.shown_in(locale)
        )));
    }
    if let Some(words) = choices(property.content)
        && !words.contains(&change.value.as_str())
    {
        let words = words.join(", ");
        return Err(wrong(format!(
            "{}: one of {words}",
            property.shown_in(locale)
        )));
    }
    let said = |problem: Problem| wrong(problem.in_locale(locale));
    save.set_property(&change.block, &change.property, &change.value)
        .map_err(said)?;
    let before = mistakes(&project, locale);
    let mut new = mistakes(&save.project().0, locale);
    new.retain(|mistake| !before.contains(mistake));
    if !new.is_empty() {
        new.truncate(limits::MISTAKES_MAX);
        return Err(wrong(new.join("; ")));
    }
    save.write().map_err(said)
}

fn open(folder: &Path, name: &str, locale: Locale) -> Result<Opened, Error> {
    let bytes = store::read(folder, name)?;
    read(&bytes).map_err(|problems| Error::undrawn(name, &problems, locale))
}

fn mistakes(project: &Project, locale: Locale) -> Vec<String> {
    let problems = check(project, World::Robot).into_iter();
    let errors = problems.filter(|problem| problem.severity == Severity::Error);
    errors.map(|problem| problem.in_locale(locale)).collect()
}

/// What stands in a block; None if it is of another kit.
fn told(block: &Block, locale: Locale) -> Option<Value> {
    let row = find(&block.kind)?;
    let property = |property: &Property| {
        let value = block
            .properties
            .get(property.name)
            .map_or(property.default, String::as_str);
        json!({
            "name": property.name,
            "title": property.shown_in(locale),
            "value": value,
            "choices": choices(property.content),
        })
    };
    let properties: Vec<_> = row.properties.iter().map(property).collect();
    Some(json!({"title": row.shown_in(locale), "properties": properties}))
}

/// The words that can stand there; None if it is any text.
fn choices(content: Content) -> Option<&'static [&'static str]> {
    match content {
        Content::Flag => Some(&["true", "false"]),
        Content::Choice(words) | Content::Port(words) => Some(words),
        Content::Expression(_)
        | Content::Evaluated
        | Content::Raw
        | Content::Variable
        | Content::Ports
        | Content::Number => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const COUNT: &[u8] = include_bytes!("../../editors/vscode/test/texts/count.qrs");

    fn programs() -> tempfile::TempDir {
        let home = tempfile::tempdir().unwrap();
        fs::write(home.path().join("count.qrs"), COUNT).unwrap();
        fs::write(home.path().join("b.js"), "print(1)").unwrap();
        home
    }

    /// The block of a kind, as a browser knows it.
    fn block(sheets: &Value, title: &str) -> (String, Value) {
        let all = sheets.as_array().unwrap().iter();
        let mut blocks = all.flat_map(|sheet| sheet["blocks"].as_object().unwrap());
        let found = blocks.find(|(_, block)| block["title"] == title);
        let (id, block) = found.unwrap();
        (id.clone(), block.clone())
    }

    fn change(block: &str, property: &str, value: &str) -> Change {
        let (block, property, value) = (block.to_owned(), property.to_owned(), value.to_owned());
        Change {
            block,
            property,
            value,
        }
    }

    #[test]
    fn each_block_has_its_properties_and_its_group_in_the_picture() {
        let home = programs();
        let told = sheets(home.path(), "count.qrs", Locale::English).unwrap();
        let (id, timer) = block(&told, "Timer");
        assert_eq!(timer["properties"][0]["name"], "Delay");
        assert_eq!(timer["properties"][0]["value"], "100");
        let picture = told[0]["picture"].as_str().unwrap();
        assert!(picture.contains(&format!("data-id=\"{id}\"")), "{picture}");
        let russian = sheets(home.path(), "count.qrs", Locale::Russian).unwrap();
        assert_ne!(
            russian[0]["blocks"][&block(&told, "Timer").0]["properties"][0]["title"],
            timer["properties"][0]["title"]
        );
        assert!(matches!(
            sheets(home.path(), "b.js", Locale::English),
            Err(Error::Diagram(_))
        ));
    }

    #[test]
    fn a_changed_diagram_is_the_same_but_for_one_value() {
        let home = programs();
        let told = sheets(home.path(), "count.qrs", Locale::English).unwrap();
        let (timer, _) = block(&told, "Timer");
        let bytes = changed(
            home.path(),
            "count.qrs",
            &change(&timer, "Delay", "250"),
            Locale::English,
        )
        .unwrap();
        fs::write(home.path().join("other.qrs"), bytes).unwrap();
        let other = sheets(home.path(), "other.qrs", Locale::English).unwrap();
        assert_eq!(block(&other, "Timer").1["properties"][0]["value"], "250");
        let text = |sheets: &Value| sheets.to_string();
        assert_eq!(text(&other).replace("250", "100"), text(&told));
    }

    #[test]
    fn a_value_that_means_nothing_is_refused_with_its_place() {
        let home = programs();
        let told = sheets(home.path(), "count.qrs", Locale::English).unwrap();
        let (timer, _) = block(&told, "Timer");
        let long = "1+".repeat(limits::PROPERTY_BYTES_MAX);
        for (block, property, value, why) in [
            (timer.as_str(), "Delay", "1 +", "Delay"),
            (&timer, "Delay", "1\u{0}", "control"),
            (&timer, "Delay", &long, "at most"),
            (&timer, "None", "1", "no block"),
            ("none", "Delay", "1", "no block"),
        ] {
            let told = changed(
                home.path(),
                "count.qrs",
                &change(block, property, value),
                Locale::English,
            );
            let told = told.unwrap_err().to_string();
            assert!(told.contains(why), "{property} {:.20}: {told}", value);
        }
    }
}
