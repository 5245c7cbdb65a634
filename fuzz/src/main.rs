//! One program for all fuzz targets: libFuzzer in front of the function that `TRIK_FUZZ_TARGET` names.
//!
//! Owns the list of targets. What they do is said beside them, mostly in the `fuzz` module of their crate; `run.sh` builds and starts this.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;

type Target = fn(&[u8]);

const TARGETS: [(&str, Target); 27] = [
    ("reader", lang_diagram::fuzz::reader),
    ("expression", lang_expr::fuzz::expression),
    ("lowering", lang_diagram::fuzz::lowering),
    ("debugging", lang_diagram::fuzz::debugging),
    ("edits", lang_diagram::fuzz::edits),
    ("dataflow", flow),
    ("flow", lang_dataflow::fuzz::source),
    ("flowsave", lang_dataflow::fuzz::reader),
    ("flowdebug", lang_dataflow::fuzz::debugging),
    ("flowedits", lang_dataflow::fuzz::edits),
    ("constraints", lang_constraint::fuzz::constraints),
    ("dcml", lang_dcml::fuzz::dcml),
    ("recording", journal::fuzz::recording),
    ("message", journal::fuzz::message),
    ("lsp", trik::fuzz::lsp),
    ("field", sim::fuzz::field),
    ("frames", trikd::fuzz::fuzz_frames),
    ("messages", trikd::fuzz::fuzz_messages),
    ("lines", trikd::fuzz::fuzz_lines),
    ("channel", trikd::fuzz::fuzz_channel),
    ("strangers", trikd::fuzz::fuzz_strangers),
    ("decode", trikfs::transport::native::fuzz_decode),
    ("library", converter::abi::fuzz_library),
    ("load", config::fuzz::fuzz_load),
    ("format", config::fuzz::fuzz_format),
    ("pattern", config::fuzz::fuzz_pattern),
    ("picture", sim::arena::floor::fuzz::picture),
];

/// Whether a program of these bytes may run is nothing to libFuzzer.
fn flow(bytes: &[u8]) {
    lang_dataflow::fuzz::program(bytes);
}

static TARGET: LazyLock<Target> = LazyLock::new(|| {
    let wanted = std::env::var("TRIK_FUZZ_TARGET").unwrap_or_default();
    if wanted == "picture" {
        // The library for SVG panics at some pictures, which is caught and told; what is not caught still ends the program.
        std::panic::set_hook(Box::new(|_| ()));
    }
    let found = TARGETS.iter().find(|(name, _)| *name == wanted);
    found.map(|(_, target)| *target).unwrap_or_else(|| {
        let names: Vec<_> = TARGETS.iter().map(|(name, _)| *name).collect();
        eprintln!(
            "TRIK_FUZZ_TARGET is '{wanted}', not one of {}",
            names.join(" ")
        );
        std::process::exit(2)
    })
});

fuzz_target!(|bytes: &[u8]| TARGET(bytes));
