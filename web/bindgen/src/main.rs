//! Makes a package for browsers and Node of a compiled module: `bindgen MODULE.wasm OUT NAME`.
//!
//! Owns the form of the package: modules of JavaScript with declarations for TypeScript, for every engine that has
//! `fetch` or is given the bytes.

use anyhow::{Context as _, bail};
use wasm_bindgen_cli_support::Bindgen;

fn main() -> anyhow::Result<()> {
    let mut arguments = std::env::args().skip(1);
    let mut next = || arguments.next();
    let (Some(module), Some(out), Some(name), None) = (next(), next(), next(), next()) else {
        bail!("usage: bindgen MODULE.wasm OUT NAME");
    };
    let mut bindgen = Bindgen::new();
    bindgen
        .input_path(&module)
        .out_name(&name)
        .typescript(true)
        .omit_default_module_path(false);
    bindgen
        .web(true)?
        .remove_name_section(true)
        .remove_producers_section(true);
    bindgen.generate(&out).with_context(|| module)
}
