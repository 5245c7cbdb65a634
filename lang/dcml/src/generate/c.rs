//! C99 that C++ takes too: one header of `static inline` functions over arrays of the caller.
//!
//! Owns how C writes it. Allocates nothing and knows no library but math.h.

use super::about;
use super::graph::Scene;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::syntax::{Comparison, Domain};
use crate::tape::{Input, ValueId};

pub(super) const ROW: Row = Row {
    name: "c",
    ending: "h",
    values_max: usize::MAX,
    print,
};

/// Words of C and C++, macros of common headers, and what is called here.
const TAKEN: &str = "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char8_t char16_t \
    char32_t class compl concept const consteval constexpr constinit const_cast continue co_await co_return co_yield \
    decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto if \
    inline int long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public \
    register reinterpret_cast requires restrict return short signed sizeof static static_assert static_cast struct \
    switch template this thread_local throw true try typedef typeid typename typeof typeof_unqual union unsigned using \
    virtual void volatile wchar_t while xor xor_eq final override import module \
    sin cos tan asin acos atan atan2 sqrt exp log fabs pow fmin fmax floor ceil \
    M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2 HUGE_VAL HUGE_VALF \
    HUGE_VALL INFINITY NAN FP_NAN FP_INFINITE FP_ZERO FP_SUBNORMAL FP_NORMAL FP_FAST_FMA FP_FAST_FMAF FP_FAST_FMAL \
    FP_ILOGB0 FP_ILOGBNAN MATH_ERRNO MATH_ERREXCEPT math_errhandling DOMAIN SING OVERFLOW UNDERFLOW PLOSS TLOSS X_TLOSS \
    HUGE MAXFLOAT EDOM ERANGE linux unix i386 NULL EOF BUFSIZ RAND_MAX errno stdin stdout stderr I complex imaginary \
    near far small interface min max abs DBL_MAX DBL_MIN DBL_EPSILON FLT_MAX FLT_MIN INT_MAX INT_MIN environ signgam \
    state action p derivative outputs jacobian dt k1 k2 k3 k4 at i";

struct C {
    model: String,
}

impl Dialect for C {
    fn number(&self, number: f64) -> Text {
        Text::number(digits(number))
    }

    fn input(&self, input: Input, name: &str) -> String {
        match input {
            Input::Param(_) => format!("p->{name}"),
            Input::State(_) | Input::Action(_) => name.to_owned(),
        }
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let name = match function {
            Function::Abs => "fabs",
            Function::Min => "fmin",
            Function::Max => "fmax",
            Function::Sign => return Text::whole(format!("{}_sign({})", self.model, x.text)),
            Function::Sin
            | Function::Cos
            | Function::Tan
            | Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Atan2
            | Function::Sqrt
            | Function::Exp
            | Function::Log
            | Function::Pow
            | Function::Floor => function.name(),
        };
        Text::whole(match function.arguments() {
            1 => format!("{name}({})", x.text),
            _ => format!("{name}({}, {})", x.text, y.text),
        })
    }

    fn select(&self, comparison: Comparison, [left, right, yes, no]: [Text; 4]) -> Text {
        let (left, right) = (left.at_least(Level::Sum), right.at_least(Level::Sum));
        let (yes, no) = (yes.at_least(Level::Sum), no.at_least(Level::Sum));
        let text = format!("{left} {} {right} ? {yes} : {no}", sign(comparison));
        Text::new(text, Level::Choice)
    }
}

/// An argument that is an array; ISO C has none of length 0.
fn array(name: &str, length: usize) -> String {
    match length {
        0 => format!("double *{name}"),
        _ => format!("double {name}[{length}]"),
    }
}

struct Printer<'p, 's, 'm> {
    planner: &'p mut Planner<'s, 'm>,
    dialect: C,
    out: String,
}

/// The whole header.
fn print(scene: &Scene<'_>) -> String {
    let mut planner = Planner::new(scene, &[TAKEN]);
    let model = planner.take(&scene.model.name);
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|_, name| format!("p->{name}"));
    let mut printer = Printer {
        planner: &mut planner,
        dialect: C {
            model: model.clone(),
        },
        out: String::new(),
    };
    printer.functions(scene);
    let functions = std::mem::take(&mut printer.out);
    let mut out = about::block("/*", &header, "");
    out.push_str(&format!(
        "#ifndef {model}_H\n#define {model}_H\n\n#include <math.h>\n\n"
    ));
    out.push_str("/* How many numbers there are of each kind. */\nenum {\n");
    for (name, count) in counts(scene) {
        out.push_str(&format!("    {model}_{name} = {count},\n"));
    }
    // A comma before the brace is an extension in C++98 and no more.
    out.truncate(out.len() - 2);
    out.push_str("\n};\n\n");
    out.push_str(&params(&planner, &model));
    if planner.functions.contains(&Function::Sign) {
        out.push_str(&format!(
            "/* -1, 0 or 1. */\nstatic inline double {model}_sign(double x)\n{{\n    \
             return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : x + 0.0);\n}}\n\n"
        ));
    }
    if functions.contains(&format!("{model}_READ_AGAIN(")) {
        out.push_str(&format!(
            "/* gcc for x86 makes one call of a sine and a cosine of one value, and then waits for both in memory. */\n\
             #if defined(__GNUC__) && !defined(__clang__) && defined(__SSE2__)\n\
             #define {model}_READ_AGAIN(x) (*(const volatile double *)&(x))\n#else\n\
             #define {model}_READ_AGAIN(x) (x)\n#endif\n\n"
        ));
    }
    out.push_str(&functions);
    out.push_str(&format!("#endif /* {model}_H */\n"));
    out
}

fn counts(scene: &Scene<'_>) -> [(&'static str, usize); 4] {
    [
        ("STATES", scene.states.len()),
        ("ACTIONS", scene.actions.len()),
        ("PARAMS", scene.params.len()),
        ("OUTPUTS", scene.outputs.len()),
    ]
}

fn params(planner: &Planner<'_, '_>, model: &str) -> String {
    let mut out = format!("/* What is fixed for one robot. */\ntypedef struct {model}_params {{\n");
    for symbol in &planner.scene.params {
        let name = planner.symbol(symbol);
        let about = about::symbol(symbol);
        out.push_str(&match about.is_empty() {
            true => format!("    double {name};\n"),
            false => format!("    double {name}; /* {about} */\n"),
        });
    }
    if planner.scene.params.is_empty() {
        out.push_str("    double none; /* A structure of C has a member. */\n");
    }
    out.push_str(&format!("}} {model}_params;\n\n"));
    out
}

impl Printer<'_, '_, '_> {
    fn functions(&mut self, scene: &Scene<'_>) {
        let (states, actions) = (scene.states.len(), scene.actions.len());
        self.function(
            "derivative",
            "The derivative of the state.",
            &scene.derivative,
            ("derivative", states),
        );
        if !scene.outputs.is_empty() {
            let outputs = ("outputs", scene.outputs.len());
            let about = "What is computed from the state and the action.";
            self.function("outputs", about, &scene.output_values, outputs);
        }
        if scene.jacobian {
            let about = format!(
                "The derivatives by the state, row after row: jacobian[{states} * i + j] is that of derivative i by state j."
            );
            let results = ("jacobian", states * states);
            self.function("state_jacobian", &about, &scene.state_jacobian, results);
            let about = format!(
                "The derivatives by the action, row after row: jacobian[{actions} * i + j] is that of derivative i by \
                 action j."
            );
            let results = ("jacobian", states * actions);
            self.function("action_jacobian", &about, &scene.action_jacobian, results);
        }
        if states > 0 {
            self.step(scene);
        }
    }

    fn function(&mut self, name: &str, about: &str, roots: &[ValueId], result: (&str, usize)) {
        let scene = self.planner.scene;
        let mut body = self.planner.body(roots, &self.dialect);
        let again = self.read_again(&mut body);
        let model = &self.dialect.model;
        let state = array("state", scene.states.len());
        let action = array("action", scene.actions.len());
        let results = array(result.0, result.1);
        self.out.push_str(&format!(
            "/* {about} */\nstatic inline void {model}_{name}(const {state}, const {action},\n    \
             const {model}_params *p, {results})\n{{\n"
        ));
        let inner = lines(&body, &again, result.0);
        self.out.push_str(&inner);
        self.out.push_str("}\n\n");
    }

    /// Reads each state a second time whose sine and cosine are parts of one result each: gives the lines.
    ///
    /// gcc makes one call of both, keeps its two numbers in memory, and loads them as one vector before they are there.
    fn read_again(&mut self, body: &mut Body) -> Vec<String> {
        let mut read = Vec::new();
        for (input, name) in &body.inputs {
            let Input::State(at) = input else { continue };
            let is_in_lines = ["sin", "cos"].iter().any(|function| {
                let has = |(_, text): &(String, String)| !call_of(text, function, name).is_empty();
                body.lines.iter().any(has)
            });
            let places = |function: &str| -> Vec<(usize, usize)> {
                let all = body.results.iter().enumerate();
                all.flat_map(|(result, text)| {
                    let calls = call_of(text, function, name).into_iter();
                    calls.map(move |place| (result, place))
                })
                .collect()
            };
            if is_in_lines || places("cos").len() != 1 {
                continue;
            }
            if let [(result, place)] = places("sin")[..] {
                let other = self.planner.take(&format!("{name}_again"));
                let model = &self.dialect.model;
                read.push(format!(
                    "    const double {other} = {model}_READ_AGAIN(state[{at}]);\n"
                ));
                let place = place + "sin(".len();
                body.results[result].replace_range(place..place + name.len(), &other);
            }
        }
        read
    }

    /// One step of the classical method of Runge and Kutta.
    fn step(&mut self, scene: &Scene<'_>) {
        let model = &self.dialect.model;
        let count = scene.states.len();
        let state = array("state", count);
        let action = array("action", scene.actions.len());
        self.out.push_str(&format!(
            "/* One step of dt seconds by the classical method of Runge and Kutta, with the action held. */\n\
             static inline void {model}_step({state}, const {action},\n    const {model}_params *p, double dt)\n{{\n    \
             double k1[{count}], k2[{count}], k3[{count}], k4[{count}], at[{count}];\n    int i;\n\n    \
             {model}_derivative(state, action, p, k1);\n"
        ));
        for (before, now, part) in [
            ("k1", "k2", "dt / 2.0"),
            ("k2", "k3", "dt / 2.0"),
            ("k3", "k4", "dt"),
        ] {
            self.out.push_str(&format!(
                "    for (i = 0; i < {count}; i++) {{\n        at[i] = state[i] + {part} * {before}[i];\n    }}\n    \
                 {model}_derivative(at, action, p, {now});\n"
            ));
        }
        self.out.push_str(&format!(
            "    for (i = 0; i < {count}; i++) {{\n        \
             state[i] += dt / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);\n    }}\n"
        ));
        for (at, symbol) in scene.states.iter().enumerate() {
            if symbol.domain == Some(Domain::Circle) {
                self.out.push_str(&format!(
                    "    state[{at}] -= 6.283185307179586 * ceil((state[{at}] - 3.141592653589793) / 6.283185307179586);\n"
                ));
            }
        }
        self.out.push_str("}\n\n");
    }
}

/// Where a function of a name stands: `cos(theta)`, but not the end of `acos(theta)`.
fn call_of(text: &str, function: &str, name: &str) -> Vec<usize> {
    let call = format!("{function}({name})");
    text.match_indices(&call)
        .map(|(at, _)| at)
        .filter(|at| !text[..*at].ends_with(|it: char| it.is_ascii_alphanumeric() || it == '_'))
        .collect()
}

fn lines(body: &Body, again: &[String], result: &str) -> String {
    let mut out = String::new();
    for (input, name) in &body.inputs {
        match input {
            Input::State(at) => out.push_str(&format!("    const double {name} = state[{at}];\n")),
            Input::Action(at) => {
                out.push_str(&format!("    const double {name} = action[{at}];\n"))
            }
            Input::Param(_) => {}
        }
    }
    out.extend(again.iter().map(String::as_str));
    for (name, text) in &body.lines {
        out.push_str(&format!("    const double {name} = {text};\n"));
    }
    if !out.is_empty() {
        out.push('\n');
    }
    let unused = [
        (body.uses_state(), "state"),
        (body.uses_action(), "action"),
        (body.uses_params(), "p"),
        (!body.results.is_empty(), result),
    ];
    for (is_used, name) in unused {
        if !is_used {
            out.push_str(&format!("    (void){name};\n"));
        }
    }
    for (at, text) in body.results.iter().enumerate() {
        out.push_str(&format!("    {result}[{at}] = {text};\n"));
    }
    out
}
