//! The border to JavaScript: arguments without trust, answers as objects.
//!
//! Owns names and types of the module. An argument of another kind than it should be is an error in an answer, as is all else that
//! can be wrong; its length is looked at before memory is spent on it.

use crate::course::solve;
use crate::failure::Failure;
use crate::limits;
use crate::text::{self, Text};
use js_sys::{JSON, JsString, Object, Reflect};
use lang_dcml::limits::DCML_TEXT_MAX;
use serde_json::Value;
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::*;

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

/// A text that is no longer than it may be.
fn string(value: &JsValue, what: &str, most: usize) -> Result<String, Failure> {
    let Some(text) = value.dyn_ref::<JsString>() else {
        return Err(Failure::Request(format!("{what}: a string is wanted")));
    };
    if text.length() as usize > most {
        return Err(Failure::Request(format!("{what}: longer than {most}")));
    }
    Ok(String::from(text))
}

/// A text that may be missing.
fn perhaps(value: &JsValue, what: &str) -> Result<Option<String>, Failure> {
    match value.is_undefined() || value.is_null() {
        true => Ok(None),
        false => string(value, what, limits::OPTIONS_BYTES_MAX).map(Some),
    }
}

/// JSON that we have written.
fn parsed(value: &Value) -> JsValue {
    JSON::parse(&value.to_string()).unwrap_or(JsValue::NULL)
}

fn answer(told: Result<JsValue, Failure>) -> JsValue {
    let object = Object::new();
    // A new object takes every property.
    let put = |name: &str, value: &JsValue| Reflect::set(&object, &name.into(), value).map(drop);
    let _ = put("ok", &told.is_ok().into());
    let _ = match &told {
        Ok(value) => put("value", value),
        Err(why) => put("error", &parsed(&why.json())),
    };
    object.into()
}

/// A place in a text: anything that is none is its beginning.
fn place(value: f64) -> u32 {
    value as u32
}

/// The models that come with this project.
#[wasm_bindgen(unchecked_return_type = "Shipped[]")]
pub fn shipped() -> JsValue {
    parsed(&text::shipped())
}

/// Reads a text with models; what is wrong with it is asked of it then.
#[wasm_bindgen(unchecked_return_type = "Answer<Models>")]
pub fn read(#[wasm_bindgen(unchecked_param_type = "string")] text: &JsValue) -> JsValue {
    let read = string(text, "text", DCML_TEXT_MAX).and_then(Text::read);
    answer(read.map(|text| Models(text).into()))
}

/// A text with models. Places are those of JavaScript's strings.
#[wasm_bindgen]
pub struct Models(Text);

#[wasm_bindgen]
impl Models {
    /// What is wrong; with `paper` also what the published language does not have.
    #[wasm_bindgen(unchecked_return_type = "Diagnostic[]")]
    pub fn lint(
        &self,
        #[wasm_bindgen(unchecked_optional_param_type = "boolean")] paper: Option<bool>,
    ) -> JsValue {
        parsed(&self.0.diagnostics(paper.unwrap_or(false)))
    }

    /// The models without mistakes.
    #[wasm_bindgen(unchecked_return_type = "ModelFacts[]")]
    pub fn models(&self) -> JsValue {
        parsed(&self.0.models())
    }

    /// A model in another language; with `jacobian` its derivatives too.
    #[wasm_bindgen(unchecked_return_type = "Answer<string>")]
    pub fn generate(
        &self,
        #[wasm_bindgen(unchecked_param_type = "Language")] language: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "string")] model: &JsValue,
        #[wasm_bindgen(unchecked_optional_param_type = "boolean")] jacobian: Option<bool>,
    ) -> JsValue {
        let told = string(language, "language", limits::OPTIONS_BYTES_MAX).and_then(|language| {
            let model = perhaps(model, "model")?;
            let jacobian = jacobian.unwrap_or(false);
            self.0.generate(&language, model.as_deref(), jacobian)
        });
        answer(told.map(|text| text.into()))
    }

    /// A model under actions for some time.
    #[wasm_bindgen(unchecked_return_type = "Answer<Solution>")]
    pub fn solve(
        &self,
        #[wasm_bindgen(unchecked_param_type = "SolveOptions")] options: &JsValue,
    ) -> JsValue {
        let written = JSON::stringify(options)
            .ok()
            .filter(|text| !text.is_undefined());
        let written =
            written.ok_or_else(|| Failure::Request("options: an object is wanted".to_owned()));
        let told = written.and_then(|text| string(&text, "options", limits::OPTIONS_BYTES_MAX));
        answer(
            told.and_then(|text| solve(&self.0, &text))
                .map(|value| parsed(&value)),
        )
    }

    /// The edit that makes the text as the formatter wants it; null: it is so already.
    #[wasm_bindgen(unchecked_return_type = "Answer<Edit | null>")]
    pub fn format(&self) -> JsValue {
        answer(self.0.format().map(|value| parsed(&value)))
    }

    /// What the word at a place is.
    #[wasm_bindgen(unchecked_return_type = "Hover | null")]
    pub fn hover(&self, at: f64) -> JsValue {
        parsed(&self.0.hover(place(at)))
    }

    /// What may stand at a place.
    #[wasm_bindgen(unchecked_return_type = "Offers")]
    pub fn complete(&self, at: f64) -> JsValue {
        parsed(&self.0.complete(place(at)))
    }

    /// Where the name at a place is declared.
    #[wasm_bindgen(unchecked_return_type = "Range | null")]
    pub fn definition(&self, at: f64) -> JsValue {
        parsed(&self.0.definition(place(at)))
    }

    /// All places of the name at a place.
    #[wasm_bindgen(unchecked_return_type = "Reference[]")]
    pub fn references(&self, at: f64) -> JsValue {
        parsed(&self.0.references(place(at)))
    }

    /// The edits that give the name at a place another one.
    #[wasm_bindgen(unchecked_return_type = "Answer<Edit[]>")]
    pub fn rename(
        &self,
        at: f64,
        #[wasm_bindgen(unchecked_param_type = "string")] name: &JsValue,
    ) -> JsValue {
        let name = string(name, "name", limits::OPTIONS_BYTES_MAX);
        answer(
            name.and_then(|name| self.0.rename(place(at), &name))
                .map(|value| parsed(&value)),
        )
    }

    /// The function in whose parentheses a place is.
    #[wasm_bindgen(unchecked_return_type = "Signature | null")]
    pub fn signature(&self, at: f64) -> JsValue {
        parsed(&self.0.signature(place(at)))
    }

    /// The outline.
    #[wasm_bindgen(unchecked_return_type = "Outlined[]")]
    pub fn symbols(&self) -> JsValue {
        parsed(&self.0.symbols())
    }

    /// What can be done about what is wrong between two places.
    #[wasm_bindgen(unchecked_return_type = "Fix[]")]
    pub fn fixes(&self, from: f64, to: f64) -> JsValue {
        parsed(&self.0.fixes(place(from), place(to)))
    }

    /// The words between two places with what they are.
    #[wasm_bindgen(unchecked_return_type = "Word[]")]
    pub fn words(&self, from: f64, to: f64) -> JsValue {
        parsed(&self.0.colours(place(from), place(to)))
    }
}
