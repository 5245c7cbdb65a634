//! One program for each block, and for what blocks alone do not show: whatever a program calls is defined in it, or is
//! what the language and the robot have.

use std::collections::BTreeSet;
use std::io::Write;
use std::process::{Command, Stdio};

use lang_diagram::blocks::{Does, table};
use lang_diagram::generate::{Language, Options, generate};
use lang_diagram::lower::World;
use lang_diagram::project::Project;
use lang_diagram::sketch::Sketch;

/// What F# programs call without defining it: words of the language and its library.
const FSHARP: &str = "Console DivideByZeroException Double Environment IO Math ResizeArray Process Random Thread \
    ThreadStart abs acos and asin atan atan2 ceil cos divide elif enum exp float float32 floor for fun if in int let log \
    match max min model new not or raise rec sign sin sqrt string then when while with";
/// And Pascal programs.
const PASCAL: &str = "Abs Abort Arr ArcCos ArcSin ArcTan ButtonEventCode Ceil Console Cos Exp Floor Ln Main_ Max Min Ord Power \
    Random Round Sign Sin Sqrt Thread Writeln action and array begin do else for foreach function if integer mod \
    new not or params procedure repeat single then until var while char real";
/// What Lua and LuaJIT have.
const LUA: &str = "arg assert bit coroutine error io ipairs math os pairs pcall print require select setmetatable string \
    table tonumber tostring type";

/// Blocks one after the other.
fn chain(blocks: &[(&str, &[(&str, &str)])]) -> Project {
    let mut sketch = Sketch::new();
    let mut spots = vec![sketch.block("InitialNode", &[])];
    for (kind, properties) in blocks {
        spots.push(sketch.block(kind, properties));
    }
    spots.push(sketch.block("FinalNode", &[]));
    sketch.chain(&spots);
    sketch.project()
}

/// All threads can do, in one program.
fn threads() -> Project {
    let mut sketch = Sketch::new();
    let start = sketch.block("InitialNode", &[]);
    let fork = sketch.block("Fork", &[]);
    let timer = sketch.block("Timer", &[("Delay", "10")]);
    let button = sketch.block("GetButtonCode", &[("Wait", "false")]);
    let join = sketch.block("Join", &[]);
    let kill = sketch.block("KillThread", &[("Thread", "other")]);
    let end = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, fork]);
    sketch.guarded(fork, timer, "main");
    sketch.guarded(fork, button, "other");
    sketch.link(timer, join);
    sketch.link(button, join);
    sketch.guarded(join, kill, "main");
    sketch.link(kill, end);
    sketch.project()
}

/// Functions and operators of expressions.
const EXPRESSIONS: &str = "a = random(5); b = a + 1; c = a // b; d = a % b; e = a / b; f = a ^ b; g = -e; h = a & b | 3 ~ 1; \
    i = ~a; j = a << 2; k = b >> 1; l = sin(e) + cos(e) + ln(f) + exp(e) + asin(e) + acos(e) + atan(e) + sqrt(f) + abs(g); \
    m = sgn(g) + ceil(e) + floor(e); n = min(a, e) + max(a, e) + atan2(e, f); o = pi; p = time(); t = 'x' .. a .. e; \
    u = #t; v = t == 'y' or not (a < b) and e >= 0.5; w = {1, 2, 3}; x = w[a] + w[0]; w[1] = 5; print(t .. v); y = t + 1";

/// A project for each block, with its defaults and as its examples have it, for each reading, and for what else counts.
pub fn projects() -> Vec<(String, Project)> {
    let mut all = Vec::new();
    for row in table() {
        all.push((row.kind.to_owned(), chain(&[(row.kind, &[])])));
        if let Does::Act(_) = row.does {
            for (at, example) in row.examples.iter().enumerate() {
                let name = format!("{} {at}", row.kind);
                all.push((name, chain(&[(row.kind, example.properties)])));
            }
        }
    }
    let unbounded = [("LowerBound", ""), ("UpperBound", "")];
    let alone: [(&str, &[_]); 5] = [
        ("Randomizer", &unbounded),
        ("KillThread", &[("Thread", "main")]),
        ("Function", &[("Body", EXPRESSIONS)]),
        (
            "SendMessageThreads",
            &[("Thread", "main"), ("Message", "1")],
        ),
        ("ReceiveMessageThreads", &[("Synchronized", "false")]),
    ];
    for block in alone {
        all.push((format!("alone {}", block.0), chain(&[block])));
    }
    for port in lang_diagram::ports::Port::all() {
        if let Some(variable) = port.variable() {
            let body = format!("x = {variable}");
            let is_table = port.sort() == lang_diagram::ports::Sort::Vector;
            let body = if is_table { body + "[0]" } else { body };
            let name = format!("reading {variable}");
            all.push((name, chain(&[("Function", &[("Body", &body)])])));
        }
    }
    all.push(("threads".to_owned(), threads()));
    all
}

/// The programs that a language has for them.
fn programs(language: Language) -> Vec<(String, String)> {
    let mut all = Vec::new();
    for (name, project) in projects() {
        let options = Options {
            world: World::Robot,
            ..Options::default()
        };
        if let Ok(generated) = generate(&project, language, options) {
            all.push((name, generated.text));
        }
    }
    assert!(all.len() > 60, "{language:?}: {}", all.len());
    all
}

/// What comes out of a tool that is given a text.
fn piped(tool: &[&str], text: &str) -> (bool, String) {
    let mut child = Command::new(tool[0])
        .args(&tool[1..])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child
        .stdin
        .take()
        .unwrap()
        .write_all(text.as_bytes())
        .unwrap();
    let output = child.wait_with_output().unwrap();
    let told = [output.stdout, output.stderr].concat();
    (
        output.status.success(),
        String::from_utf8_lossy(&told).into_owned(),
    )
}

#[test]
fn c_of_each_block_compiles_and_links() {
    if !needs::tool("cc") {
        return;
    }
    let folder = crate::scratch("each-c");
    let out = folder.join("program");
    let out = out.to_str().unwrap();
    let mut complaints = Vec::new();
    for (name, text) in programs(Language::C) {
        // A name without a declaration is an error already; what is special is linked, too.
        let is_linked = name.starts_with("alone") || name == "threads";
        let mut tool = vec!["cc", "-Wall", "-Werror", "-pthread", "-x", "c", "-"];
        if is_linked {
            tool.extend(["-o", out, "-lm"]);
        } else {
            tool.push("-fsyntax-only");
        }
        let (good, told) = piped(&tool, &text);
        if !good || !told.is_empty() {
            complaints.push(format!("{name}: {told}"));
        }
    }
    let _ = std::fs::remove_dir_all(&folder);
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn lua_of_each_block_uses_no_global_that_nobody_sets() {
    if !needs::tool("luajit") {
        return;
    }
    let mut complaints = Vec::new();
    for (name, text) in programs(Language::Lua) {
        let (good, listing) = piped(&["luajit", "-bl", "-"], &text);
        assert!(good, "{name}: {listing}");
        let named = |operation: &str| -> BTreeSet<String> {
            let lines = listing.lines().filter(|line| line.contains(operation));
            let quoted = lines.filter_map(|line| line.split('"').nth(1));
            quoted.map(str::to_owned).collect()
        };
        let known: BTreeSet<String> = LUA.split_whitespace().map(str::to_owned).collect();
        let set = named(" GSET ");
        let unknown = named(" GGET ");
        let unknown = unknown
            .iter()
            .filter(|name| !set.contains(*name) && !known.contains(*name));
        // Where nothing has to wait for others, `wait` asks whether there are any; a thread's own state is set late.
        let unknown: Vec<_> = unknown
            .filter(|name| !["runThreads", "current"].contains(&name.as_str()))
            .collect();
        if !unknown.is_empty() {
            complaints.push(format!("{name}: {unknown:?}"));
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn python_of_each_block_has_only_what_the_official_runtime_has() {
    if !needs::tool("python3") {
        return;
    }
    let script = crate::root().join("lang/diagram/tests/generate/official.py");
    // All at once, because each start takes time.
    let programs = programs(Language::Python);
    let texts: Vec<String> = programs
        .into_iter()
        .map(|(name, text)| format!("# {name}\n{text}"))
        .collect();
    let tool = ["python3", script.to_str().unwrap()];
    let (good, told) = piped(&tool, &texts.join("\0"));
    assert!(good && told.is_empty(), "{told}");
}

/// Names before brackets that no line begins to define, outside of texts and comments.
fn undefined(text: &str, before: &[&str], known: &str, spaced: bool) -> BTreeSet<String> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
    let mut called = BTreeSet::new();
    let mut defined: BTreeSet<String> = known.split_whitespace().map(str::to_lowercase).collect();
    for line in text.lines() {
        let line = line.split("//").next().unwrap_or_default();
        // Every second part stands in quotes.
        let quote = if spaced { '"' } else { '\'' };
        let code: String = line.split(quote).step_by(2).collect::<Vec<_>>().join("0");
        let mut words = code
            .split(|letter| !is_part(letter))
            .filter(|word| !word.is_empty())
            .peekable();
        while let Some(word) = words.next() {
            if before.contains(&word)
                && let Some(name) = words.peek()
            {
                defined.insert(name.to_lowercase());
            }
        }
        for (at, _) in code.match_indices('(') {
            let head = if spaced {
                code[..at].trim_end()
            } else {
                &code[..at]
            };
            let start = head.rfind(|letter| !is_part(letter)).map_or(0, |at| at + 1);
            let word = &head[start..];
            let is_member = head[..start].ends_with(['.', ':']);
            if !word.is_empty()
                && !is_member
                && !word.starts_with(|letter: char| letter.is_ascii_digit())
            {
                called.insert(word.to_lowercase());
            }
        }
    }
    called.difference(&defined).cloned().collect()
}

#[test]
fn fsharp_and_pascal_of_each_block_define_what_they_call() {
    let mut complaints = Vec::new();
    for (language, before, known, spaced) in [
        (
            Language::FSharp,
            &["let", "rec", "and", "mutable"][..],
            FSHARP,
            true,
        ),
        (
            Language::Pascal,
            &["function", "procedure"][..],
            PASCAL,
            false,
        ),
    ] {
        for (name, text) in programs(language) {
            let undefined = undefined(&text, before, known, spaced);
            if !undefined.is_empty() {
                complaints.push(format!("{language:?} {name}: {undefined:?}"));
            }
        }
    }
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}
