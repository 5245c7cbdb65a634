//! All targets that compute give what the reference gives.

use crate::models;
use crate::outcome::{Case, DT, cases, expected};
use crate::tools::{has_file, python, run, scratch};
use lang_dcml::generate::{JAVA_INTERFACE, Options, Target, generate};
use lang_dcml::model::Model;
use lang_dcml::syntax::Kind;
use std::path::Path;

pub const COMMONS_MATH: &str = "/usr/share/java/commons-math3.jar";
const RANDOM: usize = 40;
const CASES: usize = 12;

/// What is compared.
pub fn all() -> Vec<Model> {
    let mut models = models::shipped();
    models.push(models::everything());
    models.extend(crate::hostile::models());
    models.extend(models::random(RANDOM));
    models
}

/// How large the parts of a model are: states, actions, parameters, outputs.
pub fn sizes(model: &Model) -> [usize; 4] {
    [
        model.states().count(),
        model.of_kind(Kind::Action).count(),
        model.of_kind(Kind::Param).count(),
        model.outputs().count(),
    ]
}

/// What stands between two texts in another one.
fn between<'t>(text: &'t str, start: &str, end: &str) -> &'t str {
    let rest = text
        .split_once(start)
        .unwrap_or_else(|| panic!("no {start}"))
        .1;
    rest.split_once(end).unwrap_or_else(|| panic!("no {end}")).0
}

pub fn text(model: &Model, target: Target) -> String {
    generate(model, target, &Options { jacobian: true })
        .unwrap_or_else(|why| panic!("{}: {why}", model.name))
}

/// Writes all cases of all models, one number in a line.
fn write_cases(folder: &Path, models: &[Model]) -> Vec<Vec<Case>> {
    let mut lines = String::new();
    let mut all = Vec::new();
    for model in models {
        let cases = cases(model, CASES);
        for case in &cases {
            for number in case.state.iter().chain(&case.action).chain(&case.params) {
                lines.push_str(&format!("{number:?}\n"));
            }
        }
        all.push(cases);
    }
    std::fs::write(folder.join("cases.txt"), lines).unwrap();
    all
}

/// Compares what a program printed, one number in a line.
fn compare(test: &str, models: &[Model], cases: &[Vec<Case>], printed: &str, has_step: bool) {
    let mut lines = printed.lines();
    let (mut compared, mut vague) = (0, 0);
    let mut complaints = Vec::new();
    for (model, cases) in models.iter().zip(cases) {
        for case in cases {
            let mut expected = expected(model, case);
            if !has_step {
                expected.truncate(expected.len() - case.state.len());
            }
            for (at, one) in expected.iter().enumerate() {
                let line = lines
                    .next()
                    .unwrap_or_else(|| panic!("{test}: output ends early"));
                let word = line.trim().to_lowercase();
                let got = match word.as_str() {
                    "nan" | "-nan" => f64::NAN,
                    word => word.parse().unwrap_or_else(|_| panic!("{test}: {word}")),
                };
                compared += 1;
                vague += usize::from(one.tolerance.is_none());
                if !one.is(got) {
                    let value = one.value;
                    complaints.push(format!(
                        "{}: {at}: {got:?} and not {value:?} for {case:?}",
                        model.name
                    ));
                }
            }
        }
    }
    assert_eq!(lines.next(), None, "{test}: more output");
    let count = complaints.len();
    complaints.truncate(10);
    assert!(
        complaints.is_empty(),
        "{test}: {count} of {compared}\n{}",
        complaints.join("\n")
    );
    assert!(
        vague * 4 < compared,
        "{test}: {vague} of {compared} are vague"
    );
}

const C_MAIN: &str = "static double number(FILE *in) { char word[64]; if (fscanf(in, \"%63s\", word) != 1) abort(); return strtod(word, 0); }\n\
         static void read(FILE *in, double *to, int n) { int i; for (i = 0; i < n; i++) to[i] = number(in); }\n\
         static void show(const double *from, int n) { int i; for (i = 0; i < n; i++) printf(\"%.17g\\n\", from[i]); }\n\
         int main(void) { FILE *in = fopen(\"cases.txt\", \"r\"); int c; if (!in) return 1;\n";

#[test]
fn c_agrees_as_c_and_as_cpp() {
    let test = "dcml-c";
    if !needs::tool("gcc") || !needs::tool("g++") {
        return;
    }
    let (folder, models) = (scratch(test), all());
    let cases = write_cases(&folder, &models);
    let mut program = "#include <stdio.h>\n#include <stdlib.h>\n".to_owned();
    let mut main = String::new();
    for (at, model) in models.iter().enumerate() {
        let header = text(model, Target::C);
        let name = between(&header, "#ifndef ", "_H\n");
        std::fs::write(folder.join(format!("m{at}.h")), &header).unwrap();
        program.push_str(&format!("#include \"m{at}.h\"\n"));
        let [states, actions, params, outputs] = sizes(model);
        let size = |count: usize| count.max(1);
        let fields = format!("read(in, (double *)&p, {params});");
        main.push_str(&format!(
            "for (c = 0; c < {CASES}; c++) {{ double x[{}], u[{}], out[{}]; {name}_params p;\n\
             read(in, x, {states}); read(in, u, {actions}); {fields}\n\
             {name}_derivative(x, u, &p, out); show(out, {states});\n",
            size(states),
            size(actions),
            size(states * states.max(actions).max(outputs)),
        ));
        if outputs > 0 {
            main.push_str(&format!(
                "{name}_outputs(x, u, &p, out); show(out, {outputs});\n"
            ));
        }
        main.push_str(&format!(
            "{name}_state_jacobian(x, u, &p, out); show(out, {});\n\
             {name}_action_jacobian(x, u, &p, out); show(out, {});\n\
             {name}_step(x, u, &p, {DT}); show(x, {states}); }}\n",
            states * states,
            states * actions
        ));
    }
    program.push_str(C_MAIN);
    program.push_str(&main);
    program.push_str("return 0; }\n");
    std::fs::write(folder.join("main.c"), &program).unwrap();
    std::fs::write(folder.join("main.cpp"), &program).unwrap();
    for (compiler, standard, source) in [
        ("gcc", "-std=c99", "main.c"),
        ("g++", "-std=c++98", "main.cpp"),
    ] {
        let strict = [
            "-Wall",
            "-Wextra",
            "-Werror",
            "-pedantic",
            "-O1",
            "-o",
            "program",
            source,
            "-lm",
        ];
        let mut words = vec![compiler, standard];
        words.extend(strict);
        run(&folder, &words);
        compare(test, &models, &cases, &run(&folder, &["./program"]), true);
    }
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn rust_agrees() {
    let test = "dcml-rust";
    if !needs::tool("rustc") {
        return;
    }
    let (folder, models) = (scratch(test), all());
    let cases = write_cases(&folder, &models);
    let mut program = "#![deny(warnings)]\n".to_owned();
    let mut main = String::new();
    for (at, model) in models.iter().enumerate() {
        let name = format!("m{at}");
        let module = text(model, Target::Rust);
        std::fs::write(folder.join(format!("{name}.rs")), &module).unwrap();
        program.push_str(&format!("mod {name};\n"));
        let outputs = match model.outputs().count() {
            0 => String::new(),
            _ => format!("show(&{name}::outputs(&x, &u, &p));"),
        };
        let fields: String = between(
            &module,
            "pub struct Params {",
            "
}",
        )
        .lines()
        .filter_map(|line| line.strip_prefix("    pub ")?.strip_suffix(": f64,"))
        .map(|field| format!("{field}: number(),"))
        .collect();
        main.push_str(&format!(
            "for _ in 0..{CASES} {{ let mut x = [(); {name}::STATES].map(|()| number());\n\
             let u = [(); {name}::ACTIONS].map(|()| number()); let p = {name}::Params {{ {fields} }};\n\
             show(&{name}::derivative(&x, &u, &p)); {outputs}\n\
             show({name}::state_jacobian(&x, &u, &p).as_flattened());\n\
             show({name}::action_jacobian(&x, &u, &p).as_flattened());\n\
             {name}::step(&mut x, &u, &p, {DT}); show(&x); }}\n"
        ));
    }
    program.push_str(
        "fn show(all: &[f64]) { for one in all { println!(\"{one:?}\"); } }\n\
         fn main() { let text = std::fs::read_to_string(\"cases.txt\").unwrap();\n\
         let mut lines = text.lines(); let mut number = || lines.next().unwrap().parse::<f64>().unwrap();\n",
    );
    program.push_str(&main);
    program.push_str("}\n");
    std::fs::write(folder.join("main.rs"), &program).unwrap();
    run(
        &folder,
        &["rustc", "--edition", "2021", "-C", "opt-level=1", "main.rs"],
    );
    compare(test, &models, &cases, &run(&folder, &["./main"]), true);
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn python_agrees_on_single_states_and_on_many_at_once() {
    let test = "dcml-python";
    let Some(python) = python() else {
        return;
    };
    let (folder, models) = (scratch(test), all());
    let cases = write_cases(&folder, &models);
    let mut program = "import numpy as np\nwith open('cases.txt') as f: numbers = iter(f.read().split())\n\
        def read(n): return [float(next(numbers)) for _ in range(n)]\n\
        def show(a):\n for v in np.asarray(a).ravel(): print(repr(float(v)))\n\
        def check(m, has_outputs):\n s = [(read(len(m.STATES)), read(len(m.ACTIONS)), read(len(m.PARAMS))) for _ in range(CASES)]\n \
        many = [np.array(a).T for a in zip(*s)]\n batch = m.derivative(0, *many)\n \
        for i, (x, u, p) in enumerate(s):\n  d = m.derivative(0, x, u, dict(zip(m.PARAMS, p)))\n  \
        assert d.shape == (len(m.STATES),)\n  np.testing.assert_allclose(batch[:, i], d, rtol=1e-9)\n  show(d)\n  \
        if has_outputs: show(m.outputs(x, u, p))\n  show(m.state_jacobian(x, u, p))\n  show(m.action_jacobian(x, u, p))\n  \
        show(m.step(x, u, p, DT))\n"
        .replace("CASES", &CASES.to_string())
        .replace("m.CASES", "m")
        .replace("DT", &DT.to_string());
    for (at, model) in models.iter().enumerate() {
        let name = format!("m{at}");
        let path = folder.join(format!("{name}.py"));
        std::fs::write(path, text(model, Target::Python)).unwrap();
        let has_outputs = if model.outputs().count() > 0 {
            "True"
        } else {
            "False"
        };
        program.push_str(&format!("import {name}\ncheck({name}, {has_outputs})\n"));
    }
    std::fs::write(folder.join("main.py"), &program).unwrap();
    let printed = run(&folder, &[&python, "-W", "error", "main.py"]);
    compare(test, &models, &cases, &printed, true);
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn lua_agrees() {
    let test = "dcml-lua";
    if !needs::tool("luajit") {
        return;
    }
    let (folder, models) = (scratch(test), all());
    let cases = write_cases(&folder, &models);
    let mut program = "local lines = io.lines('cases.txt')\nlocal function number() return tonumber(lines()) end\n\
        local function read(n) local a = {} for i = 1, n do a[i] = number() end return a end\n\
        local function show(a) for _, v in ipairs(a) do if type(v) == 'table' then show_row(v) else print(string.format('%.17g', v)) end end end\n\
        show_row = show\n\
        local function check(m) for _ = 1, CASES do local x, u, p = read(#m.STATES), read(#m.ACTIONS), {}\n\
        for _, name in ipairs(m.PARAMS) do p[name] = number() end\n\
        show(m.derivative(x, u, p)) show(m.outputs(x, u, p, {})) show(m.state_jacobian(x, u, p)) show(m.action_jacobian(x, u, p))\n\
        m.step(x, u, p, DT) show(x) end end\n"
        .replace("CASES", &CASES.to_string())
        .replace("DT", &DT.to_string());
    for (at, model) in models.iter().enumerate() {
        let name = format!("m{at}");
        let path = folder.join(format!("{name}.lua"));
        std::fs::write(path, text(model, Target::Lua)).unwrap();
        program.push_str(&format!("check(require '{name}')\n"));
    }
    std::fs::write(folder.join("main.lua"), &program).unwrap();
    compare(
        test,
        &models,
        &cases,
        &run(&folder, &["luajit", "main.lua"]),
        true,
    );
    let _ = std::fs::remove_dir_all(&folder);
}

#[test]
fn javascript_agrees() {
    let test = "dcml-javascript";
    if !needs::tool("node") {
        return;
    }
    let (folder, models) = (scratch(test), all());
    let cases = write_cases(&folder, &models);
    let mut program = "var lines = require('fs').readFileSync('cases.txt', 'utf8').split('\\n'), at = 0, out = [];\n\
        function number() { return parseFloat(lines[at++]); }\n\
        function read(n) { var a = []; for (var i = 0; i < n; i++) a.push(number()); return a; }\n\
        function show(a) { a.forEach(function (v) { if (Array.isArray(v)) show(v); else out.push(String(v)); }); }\n\
        function check(m) { for (var c = 0; c < CASES; c++) { var x = read(m.STATES.length), u = read(m.ACTIONS.length), p = {};\n\
        m.PARAMS.forEach(function (name) { p[name] = number(); });\n\
        show(m.derivative(x, u, p)); show(m.outputs(x, u, p, [])); show(m.stateJacobian(x, u, p)); show(m.actionJacobian(x, u, p));\n\
        m.step(x, u, p, DT); show(x); } }\n"
        .replace("CASES", &CASES.to_string())
        .replace("DT", &DT.to_string());
    for (at, model) in models.iter().enumerate() {
        let name = format!("m{at}");
        let path = folder.join(format!("{name}.js"));
        std::fs::write(path, text(model, Target::JavaScript)).unwrap();
        program.push_str(&format!("check(require('./{name}.js'));\n"));
    }
    program.push_str("require('fs').writeSync(1, out.join('\\n') + '\\n');\n");
    std::fs::write(folder.join("main.js"), &program).unwrap();
    compare(
        test,
        &models,
        &cases,
        &run(&folder, &["node", "main.js"]),
        true,
    );
    let _ = std::fs::remove_dir_all(&folder);
}

/// Stand-in for the interface of Hipparchus, with its signatures: the library is on Maven Central only.
const HIPPARCHUS: &str = "package org.hipparchus.ode;\npublic interface OrdinaryDifferentialEquation {\n\
    int getDimension();\ndefault void init(double t0, double[] y0, double finalTime) { }\n\
    double[] computeDerivatives(double t, double[] y);\n}\n";

#[test]
fn java_agrees_for_both_libraries() {
    let test = "dcml-java";
    if !needs::tool("javac") || !has_file(COMMONS_MATH) {
        return;
    }
    let models = all();
    for target in [Target::Java, Target::JavaHipparchus] {
        let folder = scratch(&format!("{test}-{}", target.name()));
        let cases = write_cases(&folder, &models);
        std::fs::create_dir(folder.join("src")).unwrap();
        let mut main = String::new();
        for (at, model) in models.iter().enumerate() {
            let source = text(model, target);
            let simple = between(&source, "public class ", " implements");
            let name = match source.starts_with("package ") {
                true => format!("{}.{simple}", between(&source, "package ", ";")),
                false => simple.to_owned(),
            };
            // The compiler wants the name of the class; several packages may have it.
            std::fs::create_dir(folder.join(format!("src/{at}"))).unwrap();
            std::fs::write(folder.join(format!("src/{at}/{simple}.java")), &source).unwrap();
            let [states, actions, params, outputs] = sizes(model);
            let outputs = match outputs {
                0 => String::new(),
                _ => format!(
                    "double[] o = new double[{name}.OUTPUTS]; m.computeOutputs(x, o); show(o);"
                ),
            };
            let derivative = match target {
                Target::Java => "m.computeDerivatives(0.0, x, d);",
                _ => "d = m.computeDerivatives(0.0, x);",
            };
            main.push_str(&format!(
                "static void check{at}() throws Exception {{ {name} m = new {name}();\n\
                 for (int c = 0; c < {CASES}; c++) {{ double[] x = read({states}); m.setAction(read({actions}));\n\
                 m.setParameters(read({params})); double[] d = new double[m.getDimension()]; {derivative} show(d); {outputs}\n\
                 double[][] j = new double[{states}][{states}]; m.computeStateJacobian(x, j); for (double[] row : j) show(row);\n\
                 j = new double[{states}][{actions}]; m.computeActionJacobian(x, j); for (double[] row : j) show(row); }}\n\
                 refuses(() -> m.setAction(new double[{actions} + 1])); refuses(() -> m.setParameters(new double[{params} + 1]));\n\
                 }}\n"
            ));
        }
        let calls: String = (0..models.len())
            .map(|at| format!("check{at}();"))
            .collect();
        let program = format!(
            "import java.io.*;\npublic class Main {{\nstatic BufferedReader in; static StringBuilder out = new StringBuilder();\n\
             static double[] read(int n) throws Exception {{ double[] a = new double[n];\n\
             for (int i = 0; i < n; i++) a[i] = Double.parseDouble(in.readLine()); return a; }}\n\
             static void show(double[] a) {{ for (double v : a) out.append(v).append('\\n'); }}\n\
             static void refuses(Runnable what) {{ try {{ what.run(); }} catch (IllegalArgumentException e) {{ return; }}\n\
             throw new IllegalStateException(\"a wrong size was taken\"); }}\n{main}\n\
             public static void main(String[] a) throws Exception {{ in = new BufferedReader(new FileReader(\"cases.txt\"));\n\
             {calls} System.out.print(out); }} }}\n"
        );
        std::fs::write(folder.join("src/Main.java"), &program).unwrap();
        if target == Target::JavaHipparchus {
            let path = folder.join("src/OrdinaryDifferentialEquation.java");
            std::fs::write(path, HIPPARCHUS).unwrap();
        }
        write_interface(&folder);
        compile_java(&folder);
        let path = format!("{COMMONS_MATH}:out");
        let printed = run(&folder, &["java", "-cp", &path, "Main"]);
        compare(test, &models, &cases, &printed, false);
        let _ = std::fs::remove_dir_all(&folder);
    }
}

/// The interface of all classes, in `src`.
pub fn write_interface(folder: &Path) {
    let (path, text) = JAVA_INTERFACE;
    let path = folder.join("src").join(path);
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

/// Compiles all files in `src`.
pub fn compile_java(folder: &Path) {
    let mut files = Vec::new();
    let mut folders = vec![folder.join("src")];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            match path.is_dir() {
                true => folders.push(path),
                false => files.push(path.display().to_string()),
            }
        }
    }
    let lints = [
        "-Xlint:all,-path",
        "-Xdoclint:syntax,html",
        "-Werror",
        "-encoding",
        "US-ASCII",
    ];
    let places = ["-sourcepath", "none", "-d", "out", "-cp", COMMONS_MATH];
    let mut words = vec!["javac"];
    words.extend(lints.iter().chain(&places));
    words.extend(files.iter().map(String::as_str));
    run(folder, &words);
}

#[test]
fn latex_compiles() {
    let test = "dcml-latex";
    if !needs::tool("pdflatex") {
        return;
    }
    let folder = scratch(test);
    let mut document =
        "\\documentclass{article}\n\\usepackage{amsmath}\n\\begin{document}\n".to_owned();
    for model in all() {
        document.push_str(&text(&model, Target::Latex));
    }
    document.push_str("\\end{document}\n");
    std::fs::write(folder.join("main.tex"), document).unwrap();
    let words = [
        "pdflatex",
        "-interaction=nonstopmode",
        "-halt-on-error",
        "main.tex",
    ];
    let log = run(&folder, &words);
    assert!(log.contains("Output written on main.pdf"), "{log}");
    assert!(!log.contains("LaTeX Warning: Command"), "{log}");
    let _ = std::fs::remove_dir_all(&folder);
}
