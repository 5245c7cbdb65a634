//! Names and texts that hurt: of variables, threads, subprograms, parameters and diagrams. What is generated is taken by
//! the languages' own tools.

use std::process::Command;

use lang_diagram::generate::{Language, Options, generate};
use lang_diagram::project::Project;
use lang_diagram::sketch::Sketch;

/// Words that mean something to some language or to what is generated, and that an expression can have as a name.
const WORDS: &str = "self this class def lambda None True False global import pass del async await yield var let const \
    new typeof delete void with script brick Threading arguments eval undefined NaN Infinity Object Number String Math \
    main program Program wait tree turn started threads current label light button sleep fail file Text Table Whole int \
    char double float long struct union static extern register volatile inline restrict _Bool signed unsigned sizeof \
    typedef enum errno stdin stdout stderr NULL EOF INFINITY M_PI RAND_MAX BUFSIZ O_RDONLY linux unix asm auto switch \
    case default continue exit abort malloc free printf puts write read open close y0 y1 j0 gamma signgam index clock \
    select pow round remainder div rand srand strlen memcpy environ pause alarm kill link pipe stat timezone ffi io os \
    table string coroutine require arg assert pairs ipairs tostring type math next error pcall _G _ENV keys readFile \
    opened order find step poll Result begin procedure unit uses object array of record property set downto xor shl mod \
    fun mutable module namespace open match member abstract base val process sys str len range list dict tuple id input \
    bytes super exec __init__ __name__ execMain TASK_t __proto__ constructor toString prototype valueOf globalThis \
    exports console turns again item put copy same divide toText toWhole x_2 _ __ _1 a1b";
/// Texts that hurt wherever a program writes them down.
const TEXTS: [&str; 30] = [
    "*/ int evil; /*",
    "*/*/",
    "-- ]] evil",
    "\"; evil();//",
    "\\",
    "\\\\\"",
    "a\nevil()",
    "a\r\nevil()",
    "a\u{2028}evil()",
    "// x \\",
    "??/",
    "{ } (* *) *)",
    "\"\"\"",
    "'''",
    "%s%n",
    "${x}`x`",
    "\u{1}\u{7f}",
    "\u{feff}",
    "\u{202e}\u{2066}",
    "</script>",
    "#include <x>",
    "#{x}",
    "   ",
    "0day",
    "a-b a.b",
    "\\u0041\\x41",
    "$1 $2 {0} @x ~",
    "\u{1f642}",
    "\u{416}\u{451} class",
    "\u{4e2d}\u{6587} \u{e9}",
];

/// A project in which everything that has a name has this one, and all words are variables.
fn project(name: &str, words: &[String]) -> Project {
    let mut sketch = Sketch::new();
    sketch.diagram_property("name", name);
    let start = sketch.block("InitialNode", &[]);
    let values: Vec<String> = words.iter().map(|word| format!("{word} = 1")).collect();
    let body = format!("{}\nprint({})", values.join("\n"), words.join(" + "));
    let set = sketch.block("Function", &[("Body", &body)]);
    let say = sketch.block("TrikSay", &[("Text", name)]);
    let print = sketch.block("TrikPrintText", &[("PrintText", name)]);
    let fork = sketch.block("Fork", &[]);
    let inner = sketch.subprogram(words.first().map_or("s", |word| word), &[("p", "int", "1")]);
    let begin = sketch.block("InitialNode", &[]);
    let body = sketch.block("Function", &[("Body", "print(p)")]);
    let done = sketch.block("FinalNode", &[]);
    sketch.chain(&[begin, body, done]);
    sketch.draw_on(sketch.main());
    let call = sketch.call(inner, &["5"]);
    let end = sketch.block("FinalNode", &[]);
    let timer = sketch.block("Timer", &[("Delay", "10")]);
    let last = sketch.block("FinalNode", &[]);
    sketch.chain(&[start, set, say, print, call, fork]);
    sketch.guarded(fork, end, "main");
    sketch.guarded(fork, timer, name);
    sketch.link(timer, last);
    sketch.project()
}

/// Projects whose names and texts hurt.
pub fn projects() -> Vec<(String, Project)> {
    let words: Vec<String> = WORDS.split_whitespace().map(str::to_owned).collect();
    let by_words = words.chunks(40).map(|part| {
        let name = format!("t {}", part[0]);
        (part.join(" "), project(&name, part))
    });
    let plain = ["v".to_owned()];
    let long = ["x".repeat(400)];
    let by_texts = TEXTS.iter().map(|text| {
        let words = if text.starts_with('\u{416}') {
            &long
        } else {
            &plain
        };
        ((*text).to_owned(), project(text, words))
    });
    by_words.chain(by_texts).collect()
}

fn check(test: &str, language: Language, tool: &[&str], last: &[&str]) {
    if !needs::tool(tool[0]) {
        return;
    }
    let folder = crate::scratch(test);
    let path = folder.join(format!("program.{}", language.ending()));
    let mut complaints = Vec::new();
    for (name, project) in projects() {
        let text = match generate(&project, language, Options::default()) {
            Ok(generated) => generated.text,
            Err(problems) => {
                complaints.push(format!("{name:?}: refused: {}", problems[0]));
                continue;
            }
        };
        std::fs::write(&path, &text).unwrap();
        let output = Command::new(tool[0])
            .args(&tool[1..])
            .arg(&path)
            .args(last)
            .current_dir(&folder)
            .output()
            .unwrap();
        if !output.status.success() || !output.stderr.is_empty() {
            let told = String::from_utf8_lossy(&output.stderr);
            complaints.push(format!("{name:?}: {told}"));
        }
        assert!(!text.contains("\u{202e}"), "{name:?}");
    }
    let _ = std::fs::remove_dir_all(&folder);
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn names_that_hurt_are_taken_by_node() {
    let tool = ["node", "--check"];
    check("names-javascript", Language::JavaScript, &tool, &[]);
}

#[test]
fn names_that_hurt_are_taken_by_python() {
    let tool = ["python3", "-m", "py_compile"];
    check("names-python", Language::Python, &tool, &[]);
}

#[test]
fn names_that_hurt_are_taken_by_lua() {
    let tool = ["luajit", "-b", "-t", "raw"];
    check("names-lua", Language::Lua, &tool, &["/dev/null"]);
}

#[test]
fn names_that_hurt_are_taken_by_c() {
    let tool = ["cc", "-Wall", "-Werror", "-pthread", "-fsyntax-only"];
    check("names-c", Language::C, &tool, &[]);
}
