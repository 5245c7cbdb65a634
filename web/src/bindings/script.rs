//! Programs with text for JavaScript: their questions and what there is to see of their runs.

use super::{bad, good, options, parsed, text};
use crate::failure::Failure;
use crate::limits;
use crate::script;
use js_sys::Float64Array;
use lang_diagram::limits::SAVE_BYTES;
use lang_text::problem::Locale;
use studio::limits::SCRIPT_FRAME_BYTES;
use wasm_bindgen::prelude::*;

/// Begins a run of a program in Python (`NAME.py`) or JavaScript (`NAME.js`) in a world; an empty text is an empty floor. Its
/// engine is elsewhere and asks. The run has to be freed.
#[wasm_bindgen(unchecked_return_type = "Answer<Script>")]
pub fn script(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "string")] world: &JsValue,
    #[wasm_bindgen(unchecked_optional_param_type = "RunOptions")] wanted: &JsValue,
) -> JsValue {
    let given = || -> Result<(String, String, String), Failure> {
        let name = text(name, "the name", limits::NAME_BYTES_MAX)?;
        let world = text(world, "the world", SAVE_BYTES)?;
        Ok((name, world, options(wanted)?))
    };
    let (name, world, options) = match given() {
        Ok(given) => given,
        Err(why) => return bad(&why, "", None, Locale::default()),
    };
    match script::Script::begin(&name, &world, &options) {
        (Ok(begun), _) => good(&Script(begun).into()),
        (Err(why), locale) => bad(&why, &name, None, locale),
    }
}

/// The text of a program as its engine runs it, by the name of its file: what makes `var main = function()` has a call of it.
#[wasm_bindgen(unchecked_return_type = "Answer<string>")]
pub fn runnable(
    #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    #[wasm_bindgen(unchecked_param_type = "string")] program: &JsValue,
) -> JsValue {
    let name = text(name, "the name", limits::NAME_BYTES_MAX);
    let program = text(program, "the program", SAVE_BYTES);
    match name.and_then(|name| Ok((name, program?))) {
        Ok((name, program)) => good(&script::runnable(&name, &program).into()),
        Err(why) => bad(&why, "", None, Locale::default()),
    }
}

/// A run of a program with text, between its questions.
#[wasm_bindgen]
pub struct Script(script::Script);

#[wasm_bindgen]
impl Script {
    /// Takes a question, and makes at most so many ticks of 10 ms until it is answered: `ok:NOW:TEXT` or `no:NOW:ERRNO:REASON`,
    /// with milliseconds since the program has begun; `later` if it needs more of them; `over` if the run is.
    pub fn ask(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "string")] word: &JsValue,
        #[wasm_bindgen(unchecked_param_type = "string")] said: &JsValue,
        ticks: u32,
    ) -> String {
        let word = text(word, "the question", limits::NAME_BYTES_MAX);
        let said = text(said, "the question", SCRIPT_FRAME_BYTES);
        match (word, said) {
            (Ok(word), Ok(said)) => self.0.ask(&word, &said, ticks),
            (Err(_), _) | (_, Err(_)) => self.0.refuse(),
        }
    }

    /// Makes more ticks for a question that is to be answered later; answers as `ask` does.
    #[wasm_bindgen(js_name = goOn)]
    pub fn go_on(&mut self, ticks: u32) -> String {
        self.0.go_on(ticks)
    }

    /// What stands still in the world. It changes with what markers draw and rules move.
    #[wasm_bindgen(unchecked_return_type = "Scene")]
    pub fn scene(&self) -> JsValue {
        parsed(&self.0.course().scene())
    }

    /// What moves in the world, and where the program is.
    #[wasm_bindgen(unchecked_return_type = "ScriptState")]
    pub fn state(&self) -> JsValue {
        parsed(&self.0.state())
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

    /// What a person may want to know of the run: what the simulated robot does not have.
    #[wasm_bindgen(unchecked_return_type = "string[]")]
    pub fn remarks(&self) -> JsValue {
        parsed(&self.0.remarks().to_string())
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
