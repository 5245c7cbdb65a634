//! Formal parameters of a subprogram and actual arguments of a call: XML inside of a property.

use crate::project::{Argument, Parameter};
use lang_text::problem::Problem;
use lang_text::xml;

/// Parameters from the text of `labels`, in its order.
///
/// # Errors
/// Text that is no XML.
pub(crate) fn formal(labels: &str) -> Result<Vec<Parameter>, Problem> {
    if labels.trim().is_empty() {
        return Ok(Vec::new());
    }
    let document = xml::parse(labels)?;
    let parameter = |label: &xml::Element<'_>| {
        let text = |name| label.attribute(name).unwrap_or_default().to_owned();
        Parameter {
            name: text("text"),
            kind: text("type"),
            default: text("value"),
        }
    };
    let labels = document.elements().filter(|one| one.name == "label");
    Ok(labels.map(parameter).collect())
}

/// Arguments from the text of `dynamicProperties`, in its order.
///
/// # Errors
/// Text that is no XML.
pub(crate) fn actual(properties: &str) -> Result<Vec<Argument>, Problem> {
    if properties.trim().is_empty() {
        return Ok(Vec::new());
    }
    let document = xml::parse(properties)?;
    let argument = |property: &xml::Element<'_>| {
        let text = |name| property.attribute(name).unwrap_or_default().to_owned();
        Argument {
            name: text("displayedName"),
            kind: text("type"),
            value: text("dynamicPropertyValue"),
        }
    };
    let properties = document.elements().filter(|one| one.name == "property");
    Ok(properties.map(argument).collect())
}
