//! The border to JavaScript: arguments without trust, answers as objects, the clock of the page.
//!
//! Owns names and types of the package. An argument of another kind than it should be is an error in an answer, as is all
//! else that can be wrong; its length is looked at before memory is spent on it.

use crate::failure::Failure;
use crate::judged;
use crate::limits;
use crate::palette;
use crate::project::{self, Answer};
use crate::run;
use crate::words;
use js_sys::{Date, Float64Array, JSON, JsString, Object, Reflect, Uint8Array};
use lang_diagram::limits::SAVE_BYTES;
use lang_text::problem::Locale;
use serde_json::Value;
use sim::judge::Clock;
use std::time::Duration;
use studio::findings::Findings;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

mod draft;
mod script;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = include_str!("types.d.ts");

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = console, js_name = error)]
    fn complain(text: &str);
}

/// A mistake of this package ends the module, and this tells where it was.
#[wasm_bindgen(start, private)]
fn start() {
    std::panic::set_hook(Box::new(|panic| complain(&panic.to_string())));
}

fn clock() -> Clock {
    Clock::new(|| {
        let ms = Date::now();
        Duration::from_secs_f64(if ms > 0.0 { ms / 1000.0 } else { 0.0 })
    })
}

/// A text that is no longer than it may be.
fn text(value: &JsValue, what: &str, most: usize) -> Result<String, Failure> {
    let Some(text) = value.dyn_ref::<JsString>() else {
        return Err(Failure::Request(words::wrong_kind(what, "string")));
    };
    let length = text.length() as usize;
    if length > most {
        return Err(Failure::Request(words::too_long(what, length, most)));
    }
    Ok(String::from(text))
}

/// Options as JSON: empty without any.
fn options(value: &JsValue) -> Result<String, Failure> {
    if value.is_undefined() || value.is_null() {
        return Ok(String::new());
    }
    let written = JSON::stringify(value).ok();
    let written = written.filter(|written| !written.is_undefined());
    let written = written.ok_or_else(|| Failure::Request(words::no_options()))?;
    text(&written, "options", limits::OPTIONS_BYTES_MAX)
}

/// The bytes of a file.
fn bytes(value: &JsValue) -> Result<Vec<u8>, Failure> {
    let Some(bytes) = value.dyn_ref::<Uint8Array>() else {
        return Err(Failure::Request(words::wrong_kind("bytes", "Uint8Array")));
    };
    let length = bytes.length() as usize;
    if length > SAVE_BYTES {
        return Err(Failure::Request(words::too_long(
            "the file", length, SAVE_BYTES,
        )));
    }
    Ok(bytes.to_vec())
}

fn put(object: &Object, name: &str, value: &JsValue) {
    // A new object takes every property.
    let _ = Reflect::set(object, &name.into(), value);
}

/// JSON that we have written.
fn parsed(text: &str) -> JsValue {
    JSON::parse(text).unwrap_or(JsValue::NULL)
}

fn good(value: &JsValue) -> JsValue {
    let object = Object::new();
    put(&object, "ok", &JsValue::TRUE);
    put(&object, "value", value);
    object.into()
}

fn bad(why: &Failure, file: &str, findings: Option<Findings<'_>>, locale: Locale) -> JsValue {
    let object = Object::new();
    put(&object, "ok", &JsValue::FALSE);
    let why = why.json(file, findings, locale);
    put(&object, "error", &parsed(&why.to_string()));
    object.into()
}

/// An answer with a value.
fn answer(file: &str, findings: Option<Findings<'_>>, (told, locale): Answer<Value>) -> JsValue {
    match told {
        Ok(value) => good(&parsed(&value.to_string())),
        Err(why) => bad(&why, file, findings, locale),
    }
}

/// What a request needs before it can be answered.
type Asked = (String, Vec<u8>, String);

fn asked(name: &JsValue, content: &JsValue, wanted: &JsValue) -> Result<Asked, Failure> {
    let name = text(name, "the name", limits::NAME_BYTES_MAX)?;
    Ok((name, bytes(content)?, options(wanted)?))
}

/// Everything that is wrong with a file, as `trik lint --json` finds it: a save (`.qrs`), a data-flow program as text
/// (`.flow`), a world (`.xml`). The worst first.
#[wasm_bindgen(unchecked_return_type = "Answer<Finding[]>")]
pub fn lint(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "Uint8Array")] bytes: &JsValue,
    #[wasm_bindgen(unchecked_optional_param_type = "LintOptions")] options: &JsValue,
) -> JsValue {
    match asked(name, bytes, options) {
        Ok((name, bytes, options)) => answer(&name, None, project::lint(&name, bytes, &options)),
        Err(why) => bad(&why, "", None, Locale::default()),
    }
}

/// Opens a save (`.qrs`) or a data-flow program as text (`.flow`). The project has to be freed.
#[wasm_bindgen(unchecked_return_type = "Answer<Project>")]
pub fn open(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "Uint8Array")] bytes: &JsValue,
    #[wasm_bindgen(unchecked_optional_param_type = "OpenOptions")] options: &JsValue,
) -> JsValue {
    let (name, bytes, options) = match asked(name, bytes, options) {
        Ok(asked) => asked,
        Err(why) => return bad(&why, "", None, Locale::default()),
    };
    match project::Project::open(&name, bytes, &options) {
        (Ok(project), _) => good(&Project(project).into()),
        (Err(why), locale) => bad(&why, &name, None, locale),
    }
}

/// The blocks that a person can draw with, in the order of the palette.
#[wasm_bindgen(unchecked_return_type = "Answer<PaletteBlock[]>")]
pub fn palette(
    #[wasm_bindgen(unchecked_optional_param_type = "PaletteOptions")] wanted: &JsValue,
) -> JsValue {
    let told = match options(wanted) {
        Ok(options) => palette::palette(&options),
        Err(why) => (Err(why), Locale::default()),
    };
    answer("", None, told)
}

/// A project that was opened. Nothing of it changes.
#[wasm_bindgen]
pub struct Project(project::Project);

#[wasm_bindgen]
impl Project {
    fn answer(&self, wanted: &JsValue, ask: impl FnOnce(&str) -> Answer<Value>) -> JsValue {
        let told = match options(wanted) {
            Ok(options) => ask(&options),
            Err(why) => (Err(why), Locale::default()),
        };
        answer(&self.0.name, Some(self.0.findings()), told)
    }

    /// What it is.
    #[wasm_bindgen(unchecked_return_type = "About")]
    pub fn about(&self) -> JsValue {
        parsed(&self.0.about().to_string())
    }

    /// The program as sentences, as `trik show` prints it, or a picture of a diagram as SVG.
    #[wasm_bindgen(unchecked_return_type = "Answer<string>")]
    pub fn show(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "ShowOptions")] options: &JsValue,
    ) -> JsValue {
        self.answer(options, |options| self.0.show(options))
    }

    /// The sentences of `show` line by line, with the blocks that each tells of.
    #[wasm_bindgen(unchecked_return_type = "Answer<OutlineLine[]>")]
    pub fn outline(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "OutlineOptions")] options: &JsValue,
    ) -> JsValue {
        self.answer(options, |options| self.0.outline(options))
    }

    /// The program in a language with text, as `trik gen` writes it.
    #[wasm_bindgen(unchecked_return_type = "Answer<Generated>")]
    pub fn generate(
        &self,
        #[wasm_bindgen(unchecked_param_type = "Language")] language: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "GenerateOptions")] options: &JsValue,
    ) -> JsValue {
        self.answer(options, |options| {
            match text(language, "the language", limits::NAME_BYTES_MAX) {
                Ok(language) => self.0.generate(&language, options),
                Err(why) => (Err(why), Locale::default()),
            }
        })
    }

    /// Runs it to its verdict, as `trik check` does, in this one call.
    #[wasm_bindgen(unchecked_return_type = "Answer<Judged>")]
    pub fn judge(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "RunOptions")] options: &JsValue,
    ) -> JsValue {
        self.answer(options, |options| judged::judge(&self.0, options, clock()))
    }

    /// Begins a run that is drawn while it goes. The run has to be freed.
    #[wasm_bindgen(unchecked_return_type = "Answer<Run>")]
    pub fn run(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "RunOptions")] wanted: &JsValue,
    ) -> JsValue {
        let begun = match options(wanted) {
            Ok(options) => run::Run::begin(&self.0, &options),
            Err(why) => (Err(why), Locale::default()),
        };
        match begun {
            (Ok(run), _) => good(&Run(run).into()),
            (Err(why), locale) => bad(&why, &self.0.name, Some(self.0.findings()), locale),
        }
    }
}

/// A run between its beginning and its verdict, and after it.
#[wasm_bindgen]
pub struct Run(run::Run);

#[wasm_bindgen]
impl Run {
    /// Makes so many ticks of 10 ms, at most 6000 in one call and fewer if it ends or a debugger holds it. What it is doing
    /// then.
    #[wasm_bindgen(unchecked_return_type = "Progress")]
    pub fn tick(&mut self, count: u32) -> JsValue {
        self.0.tick(count).into()
    }

    /// What it is doing.
    #[wasm_bindgen(unchecked_return_type = "Progress")]
    pub fn progress(&self) -> JsValue {
        self.0.progress().into()
    }

    /// What stands still in the world. It changes with what markers draw and rules move.
    #[wasm_bindgen(unchecked_return_type = "Scene")]
    pub fn scene(&self) -> JsValue {
        parsed(&self.0.course().scene())
    }

    /// What moves in the world, and what the program does.
    #[wasm_bindgen(unchecked_return_type = "State")]
    pub fn state(&self) -> JsValue {
        parsed(&self.0.state())
    }

    /// Where the robot was after each tick from this one on, four numbers for each: milliseconds of model time, pixels to the
    /// right and down, degrees clockwise. At most 100000 ticks in one call.
    pub fn trail(&self, from: u32) -> Float64Array {
        Float64Array::from(self.0.course().trail(from as usize))
    }

    /// Where the middle of the robot was after each tick from this one on, two numbers for each: metres as those of `state`. At
    /// most 200000 ticks in one call.
    pub fn way(&self, from: u32) -> Float64Array {
        Float64Array::from(self.0.course().way(from as usize))
    }

    /// What rules and program have said since the last call.
    #[wasm_bindgen(unchecked_return_type = "News")]
    pub fn news(&mut self) -> JsValue {
        parsed(&self.0.news().to_string())
    }

    /// The display of the robot, as a PNG file.
    pub fn display(&self) -> Uint8Array {
        Uint8Array::from(&self.0.course().display()[..])
    }

    /// Gives the debugger an order, as `trik debug` sends it; the answer is what it tells.
    #[wasm_bindgen(unchecked_return_type = "Answer<DebugAnswer>")]
    pub fn order(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "string")] order: &JsValue,
    ) -> JsValue {
        let order = text(order, "an order", limits::ORDER_BYTES_MAX);
        match order.and_then(|order| self.0.order(&order)) {
            Ok(told) => good(&parsed(&told)),
            Err(why) => bad(&why, &self.0.project().name, None, self.0.course().locale()),
        }
    }

    /// Puts a new version of its program into a run with a debugger: what stays keeps its state, and no motor moves by it. What
    /// has changed, in words.
    #[wasm_bindgen(unchecked_return_type = "Answer<string>")]
    pub fn patch(&mut self, project: &Project) -> JsValue {
        match self.0.patch(&project.0) {
            Ok(told) => good(&told.into()),
            Err(why) => {
                let findings = Some(project.0.findings());
                bad(&why, &project.0.name, findings, self.0.course().locale())
            }
        }
    }

    /// What the debugger tells by itself since the last call.
    #[wasm_bindgen(unchecked_return_type = "DebugReport[]")]
    pub fn reports(&mut self) -> JsValue {
        parsed(&self.0.reports())
    }

    /// Ends it as it is.
    pub fn end(&mut self) {
        self.0.end();
    }

    /// What came out; nothing before the end.
    #[wasm_bindgen(unchecked_return_type = "Judged | undefined")]
    pub fn outcome(&self) -> JsValue {
        match self.0.outcome() {
            Some(told) => parsed(&told.to_string()),
            None => JsValue::UNDEFINED,
        }
    }
}
