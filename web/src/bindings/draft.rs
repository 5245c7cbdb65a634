//! A drawing as JavaScript has it.
//!
//! Owns names and types of its methods; see `draft` for what they do.

use super::{Project, answer, asked, bad, good, options, parsed, text};
use crate::draft;
use crate::failure::Failure;
use crate::limits;
use crate::project::Answer;
use crate::words;
use js_sys::{Array, JsString, Math, Uint8Array};
use lang_text::problem::Locale;
use serde_json::Value;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

/// Random bits, so that what is new in two projects has other ids.
fn seed() -> u128 {
    let part = || u128::from((Math::random() * 4_294_967_296.0) as u32);
    part() << 96 | part() << 64 | part() << 32
}

fn begun((draft, locale): Answer<draft::Draft>, name: &str) -> JsValue {
    match draft {
        Ok(draft) => good(&Draft(draft).into()),
        Err(why) => bad(&why, name, None, locale),
    }
}

/// The language of messages: an option of every method that says something.
fn locale_of(locale: &JsValue) -> Locale {
    let name = locale.dyn_ref::<JsString>().map(String::from);
    name.and_then(|name| Locale::named(&name))
        .unwrap_or_default()
}

/// Texts of a list.
fn texts(list: &JsValue, what: &str) -> Result<Vec<String>, Failure> {
    let wrong = || Failure::Request(words::wrong_kind(what, "list of strings"));
    let list = list.dyn_ref::<Array>().ok_or_else(wrong)?;
    if list.length() as usize > limits::CHANGED_MAX {
        return Err(wrong());
    }
    let one = |value: JsValue| text(&value, what, limits::NAME_BYTES_MAX);
    list.iter().map(one).collect()
}

/// Opens a save (`.qrs`) or a data-flow program in its textual form (`.flow`) to be changed. The draft has to be freed.
#[wasm_bindgen(js_name = edit, unchecked_return_type = "Answer<Draft>")]
pub fn edit(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "Uint8Array")] bytes: &JsValue,
    #[wasm_bindgen(unchecked_optional_param_type = "LintOptions")] wanted: &JsValue,
) -> JsValue {
    match asked(name, bytes, wanted) {
        Ok((name, bytes, options)) => {
            begun(draft::Draft::open(&name, bytes, &options, seed()), &name)
        }
        Err(why) => bad(&why, "", None, Locale::default()),
    }
}

/// A new project: a main diagram, of control flow with a beginning and an end. The draft has to be freed.
#[wasm_bindgen(unchecked_return_type = "Answer<Draft>")]
pub fn blank(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_optional_param_type = "BlankOptions")] wanted: &JsValue,
) -> JsValue {
    let asked = text(name, "the name", limits::NAME_BYTES_MAX)
        .and_then(|name| Ok((name, options(wanted)?)));
    match asked {
        Ok((name, options)) => begun(draft::Draft::blank(&name, &options, seed()), &name),
        Err(why) => bad(&why, "", None, Locale::default()),
    }
}

/// A project while a person draws it.
#[wasm_bindgen]
pub struct Draft(draft::Draft);

#[wasm_bindgen]
impl Draft {
    /// What it is, and what can be taken back.
    #[wasm_bindgen(unchecked_return_type = "DraftState")]
    pub fn about(&self) -> JsValue {
        parsed(&self.0.about().to_string())
    }

    /// A diagram by its id, with its blocks and links.
    #[wasm_bindgen(unchecked_return_type = "DrawnSheet | null")]
    pub fn sheet(
        &self,
        #[wasm_bindgen(unchecked_param_type = "string")] diagram: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "Locale")] locale: &JsValue,
    ) -> JsValue {
        match text(diagram, "the diagram", limits::NAME_BYTES_MAX) {
            Ok(id) => parsed(&self.0.sheet(&id, locale_of(locale)).to_string()),
            Err(_) => JsValue::NULL,
        }
    }

    /// Makes a change, whole or not at all: the ids of what is new, blocks first.
    #[wasm_bindgen(unchecked_return_type = "Answer<string[]>")]
    pub fn apply(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Change")] change: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "Locale")] locale: &JsValue,
    ) -> JsValue {
        let made = options(change).and_then(|change| self.0.apply(&change));
        answer(&self.0.name, None, (made, locale_of(locale)))
    }

    /// Takes the last change back. Whether there was one.
    pub fn undo(&mut self) -> bool {
        self.0.turn_back(false)
    }

    /// Makes the change again that was taken back last. Whether there was one.
    pub fn redo(&mut self) -> bool {
        self.0.turn_back(true)
    }

    /// Everything that is wrong with it, the worst first.
    #[wasm_bindgen(unchecked_return_type = "Finding[]")]
    pub fn lint(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "Locale")] locale: &JsValue,
    ) -> JsValue {
        parsed(&self.0.lint(locale_of(locale)).to_string())
    }

    /// Names that can stand in its expressions.
    #[wasm_bindgen(unchecked_return_type = "NameFacts[]")]
    pub fn names(&self) -> JsValue {
        parsed(&self.0.names().to_string())
    }

    /// Blocks with these ids, and the links between them: what the change `add` takes.
    #[wasm_bindgen(unchecked_return_type = "Answer<Piece>")]
    pub fn copy(
        &self,
        #[wasm_bindgen(unchecked_param_type = "string[]")] ids: &JsValue,
    ) -> JsValue {
        let copied: Result<Value, Failure> = texts(ids, "ids").map(|ids| self.0.copy(&ids));
        answer(&self.0.name, None, (copied, Locale::default()))
    }

    /// The text of its world in XML.
    pub fn world(&self) -> Option<String> {
        self.0.world().map(str::to_owned)
    }

    /// The text of the images that its world names in XML, each one with its id, as Base64 or SVG.
    pub fn images(&self) -> Option<String> {
        self.0.images().map(str::to_owned)
    }

    /// It as a file that TRIK Studio opens.
    #[wasm_bindgen(unchecked_return_type = "Answer<Uint8Array>")]
    pub fn save(&self) -> JsValue {
        match self.0.save() {
            Ok(bytes) => good(&Uint8Array::from(&bytes[..]).into()),
            Err(why) => bad(&why, &self.0.name, None, Locale::default()),
        }
    }

    /// The same file with nothing compressed, to be compressed as a whole: it takes little room then.
    #[wasm_bindgen(unchecked_return_type = "Answer<Uint8Array>")]
    pub fn stored(&self) -> JsValue {
        match self.0.stored() {
            Ok(bytes) => good(&Uint8Array::from(&bytes[..]).into()),
            Err(why) => bad(&why, &self.0.name, None, Locale::default()),
        }
    }

    /// It as it is now, to be shown, written as text, judged and run. The project has to be freed.
    #[wasm_bindgen(unchecked_return_type = "Answer<Project>")]
    pub fn project(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "OpenOptions")] wanted: &JsValue,
    ) -> JsValue {
        let opened = match options(wanted) {
            Ok(options) => self.0.project(&options),
            Err(why) => (Err(why), Locale::default()),
        };
        match opened {
            (Ok(project), _) => good(&Project(project).into()),
            (Err(why), locale) => bad(&why, &self.0.name, None, locale),
        }
    }
}
