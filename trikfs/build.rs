//! Builds the shared library of the example configuration hello.lua, so that the example runs without a step by hand.
//!
//! The library stays in the build directory, where a trikfs that runs from there looks for it (see `search`).
//! A C compiler is needed for LuaJIT anyway.

use std::env;
use std::error::Error;
use std::path::PathBuf;

const SOURCE: &str = "../config/lua/hello/hello.c";

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed={SOURCE}");
    let library = PathBuf::from(env::var("OUT_DIR")?).join("libhello.so");
    let mut compiler = cc::Build::new()
        .cargo_metadata(false)
        .get_compiler()
        .to_command();
    compiler
        .args(["-shared", "-fPIC", "-O2", "-std=gnu99", "-o"])
        .arg(&library)
        .arg(SOURCE);
    let status = compiler.status()?;
    if !status.success() {
        return Err(format!("{compiler:?}: {status}").into());
    }
    Ok(())
}
