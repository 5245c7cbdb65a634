//! Loads libraries that are compiled here; without a C compiler the tests that need one say so and pass.

use super::*;
use crate::convert::inline_c::Compiler;
use crate::errno::Error;
use crate::failure::Blame;
use crate::scratch::Scratch;
use config::description::Place;
use std::fs;

const PLAIN: &str = "int converter(int in_s, char *in, int out_s, char *out) {\n\
    for (int i = 0; i < out_s; i++) out[i] = in[i] + ADD;\n\
    in[0] = 0;\n\
    return in_s > 2 && in[1] == 99 ? 7 : 0;\n\
}\n";

const VERSIONED: &str = r#"
#include "trikfs_converter.h"
#include <stdlib.h>
#include <string.h>
struct half { int have; uint8_t first; double gain; };
static int open_half(const trikfs_open_info *info, void **state) {
  struct half *half = calloc(1, sizeof *half);
  *state = half;
  half->gain = 1;
  for (uint32_t i = 0; i < info->param_count; i++)
    if (!strcmp(info->params[i].name, "gain")) half->gain = info->params[i].value;
  info->log(info->host, info->node);
  return half->gain > 0 ? TRIKFS_OK : 5;
}
static int half(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size) {
  struct half *half = state;
  if (in[0] == 255) return 6;
  if (in[0] == 254) return 8;
  half->have = !half->have;
  if (half->have) { half->first = in[0]; return TRIKFS_CONSUMED; }
  out[0] = (uint8_t)((half->first + in[0]) * half->gain);
  return TRIKFS_OK;
}
static const char *explain(void *state, int code) { return code == 5 ? "gain must be above 0" : code == 8 ? "ENODEV: no sensor on the cable" : "255 means no echo"; }
static int same(void *state, const uint8_t *in, uint32_t in_size, uint8_t *out, uint32_t out_size) {
  memcpy(out, in, out_size < in_size ? out_size : in_size);
  return TRIKFS_OK;
}
static const trikfs_converter half_converter = { TRIKFS_ABI_VERSION, sizeof half_converter, "half", "every second", 1, 1, open_half, half, free, explain };
static const trikfs_converter same_converter = { TRIKFS_ABI_VERSION, sizeof same_converter, "same", NULL, 0, 0, NULL, same, NULL, NULL };
static const trikfs_converter *const all[] = { &half_converter, &same_converter };
static const trikfs_library library = { TRIKFS_ABI_VERSION, sizeof library, 2, all };
const trikfs_library *trikfs_library_entry(void) { return &library; }
"#;

/// Compiles C and puts the library where a user would have it.
fn library(scratch: &Scratch, name: &str, code: &str) -> Option<PathBuf> {
    if Compiler::find().is_none() {
        needs::Need::Tools.missing("no C compiler");
        return None;
    }
    let compiled = Compiler::compile_with_any(code, &Place::default(), &scratch.cache(), &|_| {})
        .expect("compiles");
    let path = scratch.path(name);
    fs::copy(compiled, &path).expect("copied");
    Some(path)
}

fn plain(scratch: &Scratch, name: &str, add: u8) -> Option<PathBuf> {
    library(scratch, name, &PLAIN.replace("ADD", &add.to_string()))
}

fn open(library: &Library, size: usize, params: &[(&str, f64)]) -> Result<NativeStage, Fault> {
    open_logging(library, size, params, Arc::new(|_| {}))
}

fn open_logging(
    library: &Library,
    size: usize,
    params: &[(&str, f64)],
    log: Arc<dyn Fn(&str) + Send + Sync>,
) -> Result<NativeStage, Fault> {
    let params: BTreeMap<String, f64> = params
        .iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .collect();
    library.open(&OpenInfo {
        direction: Direction::Read,
        input_size: size,
        output_size: size,
        node: "front/eye",
        params: &params,
        log,
    })
}

fn refusal(result: Result<Library, LibraryError>, scratch: &Scratch) -> String {
    result
        .expect_err("refused")
        .to_string()
        .replace(&scratch.dir().display().to_string(), "DIR")
}

#[test]
fn a_plain_library_converts_and_may_scribble_over_its_input() {
    let scratch = Scratch::new();
    let Some(path) = plain(&scratch, "libadd.so", 1) else {
        return;
    };
    let library = Library::load(&path, None, &scratch.cache()).expect("loads");
    let mut stage = open(&library, 3, &[]).expect("opens");
    let mut output = [9; 3];
    assert_eq!(
        stage.convert(&[1, 2, 255], &mut output),
        Ok(Conversion::Produced)
    );
    assert_eq!(output, [2, 3, 0]);
    assert_eq!(
        stage.convert(&[1, 99, 3], &mut output),
        Err("libadd.so: converter returned 7".into())
    );
    assert_eq!(
        stage.convert(&[5, 6, 7], &mut output),
        Ok(Conversion::Produced)
    );
}

#[test]
fn a_new_library_under_the_same_name_is_the_new_code_and_the_old_one_stays() {
    let scratch = Scratch::new();
    let Some(path) = plain(&scratch, "libadd.so", 1) else {
        return;
    };
    let old = Library::load(&path, None, &scratch.cache()).expect("loads");
    let mut old = open(&old, 1, &[]).expect("opens");
    plain(&scratch, "libadd.so", 50);
    let new = Library::load(&path, None, &scratch.cache()).expect("loads");
    let mut new = open(&new, 1, &[]).expect("opens");
    let mut output = [0];
    new.convert(&[1], &mut output).expect("converts");
    assert_eq!(output, [51]);
    old.convert(&[1], &mut output).expect("converts");
    assert_eq!(output, [2]);
    fs::remove_file(&path).expect("removed");
    old.convert(&[2], &mut output)
        .expect("converts without its file");
    assert_eq!(output, [3]);
}

#[test]
fn each_opening_of_a_versioned_converter_has_a_state_of_its_own() {
    let scratch = Scratch::new();
    let Some(path) = library(&scratch, "libhalf.so", VERSIONED) else {
        return;
    };
    let library = Library::load(&path, Some("half"), &scratch.cache()).expect("loads");
    let (sender, logged) = std::sync::mpsc::channel();
    let log = Arc::new(move |text: &str| sender.send(text.to_owned()).expect("a listener"));
    let mut first = open_logging(&library, 1, &[("gain", 2.0)], log).expect("opens");
    let mut second = open(&library, 1, &[]).expect("opens");
    let mut output = [9];
    assert_eq!(first.convert(&[3], &mut output), Ok(Conversion::Consumed));
    assert_eq!(second.convert(&[1], &mut output), Ok(Conversion::Consumed));
    assert_eq!(first.convert(&[4], &mut output), Ok(Conversion::Produced));
    assert_eq!(output, [14]);
    assert_eq!(
        first.convert(&[255], &mut output),
        Err("libhalf.so#half: 255 means no echo".into())
    );
    // The word that blames the device stays the first, where it is looked for.
    let lost = first.convert(&[254], &mut output).expect_err("no sensor");
    assert_eq!(
        Error::of_converter(&lost),
        Error::NoDevice("libhalf.so#half: no sensor on the cable".to_owned())
    );
    assert_eq!(logged.try_iter().collect::<Vec<_>>(), ["front/eye"]);
    let refused = open(&library, 1, &[("gain", -1.0)]).expect_err("refused");
    assert_eq!(refused.text(), "libhalf.so#half: gain must be above 0");
    let refused = open(&library, 2, &[]).expect_err("refused");
    assert_eq!(
        refused.text(),
        "libhalf.so#half: converter 'half': input tuples must have 1 bytes, not 2"
    );
    assert_eq!(library.check_sizes(2, 1).expect_err("refused"), refused);
    library.check_sizes(1, 1).expect("fits");
}

#[test]
fn many_tuples_stop_at_the_end_of_either_side_and_at_a_fault() {
    let scratch = Scratch::new();
    let Some(path) = library(&scratch, "libhalf.so", VERSIONED) else {
        return;
    };
    let cache = scratch.cache();
    let half = Library::load(&path, Some("half"), &cache).expect("loads");
    let mut stage = open(&half, 1, &[]).expect("opens");
    let mut output = [0; 2];
    assert_eq!(stage.convert_many(&[1, 2, 3], &mut output), (3, 1, None));
    assert_eq!(stage.convert_many(&[4, 5, 6, 7], &mut output), (3, 2, None));
    assert_eq!(output, [7, 11]);
    let fault = Some("libhalf.so#half: 255 means no echo".into());
    assert_eq!(
        stage.convert_many(&[7, 8, 255, 9], &mut output),
        (3, 1, fault)
    );
    let same = Library::load(&path, Some("same"), &cache).expect("loads");
    let mut stage = open(&same, 3, &[]).expect("opens");
    assert_eq!(
        stage.convert_many(&[1, 2, 3, 4, 5], &mut [0; 9]),
        (1, 1, None)
    );
    assert_eq!(stage.convert_many(&[1, 2, 3], &mut [0; 2]), (0, 0, None));
    assert_eq!(stage.convert_many(&[], &mut []), (0, 0, None));
}

#[test]
fn a_library_of_several_needs_a_name_that_it_has() {
    let scratch = Scratch::new();
    let Some(path) = library(&scratch, "libhalf.so", VERSIONED) else {
        return;
    };
    let cache = scratch.cache();
    assert_eq!(
        refusal(Library::load(&path, None, &cache), &scratch),
        "DIR/libhalf.so: holds several converters, add #NAME: half, same"
    );
    assert_eq!(
        refusal(Library::load(&path, Some("sam"), &cache), &scratch),
        "DIR/libhalf.so: has no converter 'sam', did you mean 'same'; it holds: half, same"
    );
    let Some(plain) = plain(&scratch, "libadd.so", 3) else {
        return;
    };
    Library::load(&plain, Some("converter"), &cache)
        .expect("the plain function's own name is allowed");
}

#[test]
fn what_is_no_library_is_refused_with_what_was_looked_for() {
    let scratch = Scratch::new();
    let cache = scratch.cache();
    let load = |name: &str| refusal(Library::load(&scratch.path(name), None, &cache), &scratch);
    assert_eq!(load("absent.so"), "DIR/absent.so: no such library");
    fs::write(scratch.path("text.so"), "hello").expect("written");
    assert_eq!(load("text.so"), "DIR/text.so: not a shared library");
    fs::create_dir(scratch.path("dir.so")).expect("created");
    assert_eq!(load("dir.so"), "DIR/dir.so: not a regular file");
    nix::unistd::mkfifo(&scratch.path("fifo.so"), nix::sys::stat::Mode::S_IRWXU).expect("fifo");
    assert_eq!(load("fifo.so"), "DIR/fifo.so: not a regular file");
    let Some(path) = library(&scratch, "empty.so", "int other(void) { return 0; }") else {
        return;
    };
    assert_eq!(
        load("empty.so"),
        "DIR/empty.so: exports neither trikfs_library_entry nor converter"
    );
    let mut bytes = fs::read(&path).expect("read");
    bytes.truncate(bytes.len() / 4);
    fs::write(scratch.path("cut.so"), bytes).expect("written");
    assert_eq!(
        load("cut.so"),
        "DIR/cut.so: not a whole shared library: it was cut short"
    );
}

#[test]
fn the_dynamic_linkers_own_refusal_names_the_file_of_the_user() {
    let scratch = Scratch::new();
    let code = "int elsewhere(void);\nint converter(int a, char *b, int c, char *d) { return elsewhere(); }";
    let Some(path) = library(&scratch, "libneeds.so", code) else {
        return;
    };
    let said = refusal(Library::load(&path, None, &scratch.cache()), &scratch);
    assert_eq!(said, "DIR/libneeds.so: undefined symbol: elsewhere");
}

#[test]
fn a_library_that_returns_nonsense_is_refused() {
    let scratch = Scratch::new();
    let code = "#include \"trikfs_converter.h\"\nconst trikfs_library *trikfs_library_entry(void) { return 0; }";
    let Some(path) = library(&scratch, "libnull.so", code) else {
        return;
    };
    let said = refusal(Library::load(&path, None, &scratch.cache()), &scratch);
    assert_eq!(
        said,
        "DIR/libnull.so: the entry of the library returned no library"
    );
}

#[test]
fn compiled_inline_code_is_loaded_from_the_cache_itself() {
    let scratch = Scratch::new();
    if plain(&scratch, "unused.so", 9).is_none() {
        return;
    }
    let cache = scratch.cache();
    let code = PLAIN.replace("ADD", "9");
    let compiled =
        Compiler::compile_with_any(&code, &Place::default(), &cache, &|_| {}).expect("compiles");
    let library = Library::load(&compiled, None, &cache).expect("loads");
    assert_eq!(library.label(), "inline C");
    assert!(
        !fs::read_dir(cache.dir())
            .expect("read")
            .flatten()
            .any(|entry| { entry.file_name().to_string_lossy().starts_with("lib-") })
    );
}

#[test]
fn who_can_mend_a_library_that_is_not_loaded_is_known() {
    let scratch = Scratch::new();
    let cache = scratch.cache();
    let blame = |path: &Path| {
        let refused = Library::load(path, None, &cache).expect_err("refused");
        refused.blame()
    };
    assert_eq!(
        blame(&scratch.path("missing.so")),
        Blame::Configuration,
        "its name is wrong"
    );
    let script = scratch.path("script.so");
    fs::write(&script, "#!/bin/sh\n").expect("written");
    assert_eq!(blame(&script), Blame::Converter, "its build is wrong");
    let said = |words: &str| {
        let wrong = explain(
            &format!("/cache/lib-1.so: {words}"),
            Path::new("/cache/lib-1.so"),
            "mine.so",
        );
        LibraryError::Library {
            shown: "mine.so".to_owned(),
            why: wrong,
        }
    };
    let symbol = said("undefined symbol: x");
    assert_eq!(symbol.blame(), Blame::Converter);
    assert_eq!(symbol.to_string(), "mine.so: undefined symbol: x");
    let mapped = said("failed to map segment from shared object");
    assert_eq!(mapped.blame(), Blame::Machine, "the cache cannot hold code");
    assert!(
        mapped
            .to_string()
            .ends_with("choose another place with --cache")
    );
}
