//! Java: a class for the solvers of Commons Math 3 or of Hipparchus, with the checks of sizes that the language's authors
//! gave theirs.
//!
//! Owns how Java writes it, the two libraries' interfaces, and letters: a file of Java is ASCII here.

use super::about;
use super::graph::Scene;
use super::names::letters;
use super::plan::{Body, Dialect, Level, Planner, Text, digits, sign};
use super::row::Row;
use crate::function::Function;
use crate::model::Symbol;
use crate::syntax::{Comparison, Domain};
use crate::tape::{Input, ValueId};

/// For Commons Math 3.
pub(super) const ROW: Row = Row {
    name: "java",
    ending: "java",
    values_max: crate::limits::DCML_JAVA_VALUES,
    print: |scene| print(scene, Library::CommonsMath),
};
/// For Hipparchus.
pub(super) const ROW_HIPPARCHUS: Row = Row {
    name: "java-hipparchus",
    print: |scene| print(scene, Library::Hipparchus),
    ..ROW
};

/// Whose interface the class implements.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Library {
    CommonsMath,
    Hipparchus,
}

/// Words of Java, classes that are named, and what is called here.
const TAKEN: &str = "abstract assert boolean break byte case catch char class const continue default do double else enum \
    exports extends final finally float for goto if implements import instanceof int interface long module native new \
    non open opens package permits private protected provides public record requires return sealed short static strictfp \
    super switch synchronized this throw throws to transient transitive try uses var void volatile when while with yield \
    true false null Math String Object Double System Override IllegalArgumentException FirstOrderDifferentialEquations \
    OrdinaryDifferentialEquation org java javax t state derivative jacobian outputs parameters action values names expected what \
    pow min max checkSize setParameters setAction getDimension computeDerivatives computeOutputs computeStateJacobian \
    computeActionJacobian STATES ACTIONS PARAMETERS OUTPUTS getClass hashCode equals clone toString notify notifyAll \
    wait finalize init current names List trik RobotModel getModelName getParameterNames getActionNames getStateNames \
    getOutputNames isAngle getParameters getAction getState setState computeDerivative getParameter setParameter getOutputs \
    getOutput step place";

/// The interface that all classes implement, a file `trik/dcml/RobotModel.java` of its own.
pub(super) const INTERFACE: &str = include_str!("RobotModel.java");

const KEYWORDS: &str = "abstract assert boolean break byte case catch char class const continue default do double else \
    enum extends final finally float for goto if implements import instanceof int interface long native new package \
    private protected public return short static strictfp super switch synchronized this throw throws transient try \
    void volatile while true false null _ java javax org";

struct Java;

impl Dialect for Java {
    fn number(&self, number: f64) -> Text {
        Text::of_pi(number, "Math.PI").unwrap_or_else(|| Text::number(digits(number)))
    }

    fn input(&self, _: Input, name: &str) -> String {
        name.to_owned()
    }

    fn call(&self, function: Function, x: Text, y: Text) -> Text {
        let name = match function {
            Function::Sign => "Math.signum",
            // Java's own differ where an argument is not a number, and at 1 to the power of infinity.
            Function::Pow => "pow",
            Function::Min => "min",
            Function::Max => "max",
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
            | Function::Abs
            | Function::Floor => &format!("Math.{}", function.name()),
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

/// What other letters stand as in a file of ASCII.
fn ascii(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_ascii() {
            out.push(letter);
        } else {
            let mut units = [0; 2];
            for unit in letter.encode_utf16(&mut units) {
                out.push_str(&format!("\\u{unit:04x}"));
            }
        }
    }
    out
}

fn package(name: &str) -> String {
    let part = |part: &str| {
        let mut part = letters(part, 60);
        if part.is_empty() || part.starts_with(|first: char| first.is_ascii_digit()) {
            part.insert(0, '_');
        }
        if KEYWORDS.split_whitespace().any(|word| word == part) {
            part.push('_');
        }
        part
    };
    let parts: Vec<String> = name.split('.').map(part).collect();
    parts.join(".")
}

/// Letters of a name in the lists of names; the names of fields are as long.
const NAME_LETTERS: usize = 60;

/// The whole class.
fn print(scene: &Scene<'_>, library: Library) -> String {
    let mut planner = Planner::new(scene, &[TAKEN]);
    let class = planner.take(&scene.model.name);
    let element = |array: &str, at: usize| format!("{array}[{at}]");
    let header = about::header(&planner, element, &|at, _| format!("parameters[{at}]"));
    let methods = methods(&mut planner, scene, library);
    let mut out = String::new();
    if let Some(name) = &scene.model.package {
        out.push_str(&format!("package {};\n\n", package(name)));
    }
    let (of, interface) = match library {
        Library::CommonsMath => (
            "org.apache.commons.math3.ode",
            "FirstOrderDifferentialEquations",
        ),
        Library::Hipparchus => ("org.hipparchus.ode", "OrdinaryDifferentialEquation"),
    };
    out.push_str(&format!(
        "import {of}.{interface};\nimport trik.dcml.RobotModel;\n\n"
    ));
    let mut lines = vec!["<pre>".to_owned()];
    lines.extend(header.iter().map(|line| html(line)));
    lines.push("</pre>".to_owned());
    out.push_str(&about::block("/**", &lines, ""));
    out.push_str(&format!(
        "public class {class} implements {interface}, RobotModel {{\n"
    ));
    out.push_str(&fields(&planner));
    out.push_str(&setter(
        &planner,
        "setParameters",
        "parameters",
        &scene.params,
    ));
    out.push_str(&setter(&planner, "setAction", "action", &scene.actions));
    out.push_str(&getter(&planner, "getParameters", &scene.params));
    out.push_str(&getter(&planner, "getAction", &scene.actions));
    out.push_str(&of_robot(&planner));
    out.push_str(
        "    /** How many numbers a state has. */\n    @Override\n    public int getDimension() {\n        return STATES;\n    }\n\n",
    );
    out.push_str(&methods);
    out.push_str(HELPER);
    for function in &planner.functions {
        out.push_str(helper(*function));
    }
    out.truncate(out.len() - 1);
    out.push_str("}\n");
    ascii(&out)
}

/// What the class knows: sizes, parameters, the action that is held.
fn fields(planner: &Planner<'_, '_>) -> String {
    let scene = planner.scene;
    let mut out = String::new();
    for (name, what, count) in [
        (
            "STATES",
            "How many numbers a state has.",
            scene.states.len(),
        ),
        (
            "ACTIONS",
            "How many numbers an action has.",
            scene.actions.len(),
        ),
        (
            "PARAMETERS",
            "How many parameters there are.",
            scene.params.len(),
        ),
        (
            "OUTPUTS",
            "How many outputs there are.",
            scene.outputs.len(),
        ),
    ] {
        out.push_str(&format!(
            "    /** {what} */\n    public static final int {name} = {count};\n"
        ));
    }
    out.push('\n');
    for symbol in scene.params.iter().chain(&scene.actions) {
        let about = html(&about::symbol(symbol));
        if !about.is_empty() {
            out.push_str(&format!("    /** {about} */\n"));
        }
        out.push_str(&format!("    private double {};\n", planner.symbol(symbol)));
    }
    out.push_str("    private double[] current = new double[STATES];\n\n");
    out
}

/// A line of documentation: markup and tags are no such thing in an author's text.
fn html(line: &str) -> String {
    line.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('@', "&#64;")
}

const HELPER: &str = "    private static void checkSize(String what, double[] values, int expected) {\n        \
    if (values.length != expected) {\n            \
    throw new IllegalArgumentException(what + \" has \" + values.length + \" numbers, not \" + expected);\n        \
    }\n    }\n\n";

/// Functions that Java has in another form.
fn helper(function: Function) -> &'static str {
    match function {
        Function::Pow => {
            "    /** As in C: 1 to any power is 1, and -1 to an infinite one too. */\n    \
             private static double pow(double x, double y) {\n        \
             return x == 1.0 || (x == -1.0 && Double.isInfinite(y)) ? 1.0 : Math.pow(x, y);\n    }\n\n"
        }
        Function::Min => {
            "    /** The other one where one is not a number. */\n    private static double min(double x, double y) {\n        \
             return Double.isNaN(x) ? y : Double.isNaN(y) ? x : Math.min(x, y);\n    }\n\n"
        }
        Function::Max => {
            "    /** The other one where one is not a number. */\n    private static double max(double x, double y) {\n        \
             return Double.isNaN(x) ? y : Double.isNaN(y) ? x : Math.max(x, y);\n    }\n\n"
        }
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
        | Function::Abs
        | Function::Sign
        | Function::Floor => "",
    }
}

/// A copy of numbers that the class has as fields.
fn getter(planner: &Planner<'_, '_>, name: &str, symbols: &[&Symbol]) -> String {
    let all: Vec<_> = symbols.iter().map(|one| planner.symbol(one)).collect();
    format!(
        "    @Override\n    public double[] {name}() {{\n        return new double[] {{{}}};\n    }}\n\n",
        all.join(", ")
    )
}

/// Names, the state, and which of its numbers are angles.
fn of_robot(planner: &Planner<'_, '_>) -> String {
    let scene = planner.scene;
    let mut out = format!(
        "    @Override\n    public String getModelName() {{\n        return \"{}\";\n    }}\n\n",
        letters(&scene.model.name, NAME_LETTERS)
    );
    for (method, symbols) in [
        ("getParameterNames", &scene.params),
        ("getActionNames", &scene.actions),
        ("getStateNames", &scene.states),
        ("getOutputNames", &scene.outputs),
    ] {
        let quoted: Vec<String> = symbols
            .iter()
            .map(|one| format!("\"{}\"", letters(&one.name, NAME_LETTERS)))
            .collect();
        out.push_str(&format!(
            "    @Override\n    public String[] {method}() {{\n        return new String[] {{{}}};\n    }}\n\n",
            quoted.join(", ")
        ));
    }
    let angles: Vec<String> = scene
        .states
        .iter()
        .enumerate()
        .filter(|(_, one)| one.domain == Some(Domain::Circle))
        .map(|(at, _)| format!("state == {at}"))
        .collect();
    let angles = match angles.as_slice() {
        [] => "false".to_owned(),
        all => all.join(" || "),
    };
    out.push_str(&format!(
        "    @Override\n    public boolean isAngle(int state) {{\n        return {angles};\n    }}\n\n    \
         @Override\n    public double[] getState() {{\n        return current.clone();\n    }}\n\n    \
         @Override\n    public void setState(double[] state) {{\n        checkSize(\"state\", state, STATES);\n        \
         current = state.clone();\n    }}\n\n"
    ));
    out
}

fn setter(planner: &Planner<'_, '_>, name: &str, array: &str, symbols: &[&Symbol]) -> String {
    let (count, what) = match array {
        "action" => ("ACTIONS", "the action that is held from now on"),
        _ => ("PARAMETERS", "what is fixed for one robot"),
    };
    let mut out = format!(
        "    /**\n     * Sets {what}.\n     *\n     * @param {array} as many numbers as {count} says\n     \
         * @throws IllegalArgumentException if there are more or fewer\n     */\n    \
         @Override\n    public void {name}(double[] {array}) {{\n        checkSize(\"{array}\", {array}, {count});\n"
    );
    for (at, symbol) in symbols.iter().enumerate() {
        out.push_str(&format!(
            "        {} = {array}[{at}];\n",
            planner.symbol(symbol)
        ));
    }
    out.push_str("    }\n\n");
    out
}

fn methods(planner: &mut Planner<'_, '_>, scene: &Scene<'_>, library: Library) -> String {
    let (states, actions) = (scene.states.len(), scene.actions.len());
    let mut out = String::new();
    let body = planner.body(&scene.derivative, &Java);
    out.push_str(
        "    @Override\n    public void computeDerivative(double[] state, double[] derivative) {\n        \
         checkSize(\"state\", state, STATES);\n        checkSize(\"derivative\", derivative, STATES);\n",
    );
    out.push_str(&lines(&body, "derivative", 0));
    out.push_str("    }\n\n    /** The derivative of the state, for solvers. */\n    @Override\n");
    out.push_str(match library {
        Library::CommonsMath => {
            "    public void computeDerivatives(double t, double[] state, double[] derivative) {\n        \
             computeDerivative(state, derivative);\n    }\n\n"
        }
        Library::Hipparchus => {
            "    public double[] computeDerivatives(double t, double[] state) {\n        \
             double[] derivative = new double[STATES];\n        computeDerivative(state, derivative);\n        \
             return derivative;\n    }\n\n"
        }
    });
    let body = planner.body(&scene.output_values, &Java);
    out.push_str(
        "    /** What is computed from the state and the action. */\n    \
         @Override\n    public void computeOutputs(double[] state, double[] outputs) {\n        \
         checkSize(\"state\", state, STATES);\n        checkSize(\"outputs\", outputs, OUTPUTS);\n",
    );
    out.push_str(&lines(&body, "outputs", 0));
    out.push_str("    }\n\n");
    let mut jacobian = |name: &str, by: &str, columns: usize, roots: &[ValueId]| {
        let body = planner.body(roots, &Java);
        out.push_str(&format!(
            "    /** The derivatives by the {by}: a row for each derivative, a column for each {by}. */\n    \
             public void {name}(double[] state, double[][] jacobian) {{\n        checkSize(\"state\", state, STATES);\n"
        ));
        out.push_str(&lines(&body, "jacobian", columns.max(1)));
        out.push_str("    }\n\n");
    };
    if scene.jacobian {
        jacobian(
            "computeStateJacobian",
            "state",
            states,
            &scene.state_jacobian,
        );
        jacobian(
            "computeActionJacobian",
            "action",
            actions,
            &scene.action_jacobian,
        );
    }
    out
}

fn lines(body: &Body, result: &str, columns: usize) -> String {
    let mut out = String::new();
    for (input, name) in &body.inputs {
        if let Input::State(at) = input {
            out.push_str(&format!("        final double {name} = state[{at}];\n"));
        }
    }
    for (name, text) in &body.lines {
        out.push_str(&format!("        final double {name} = {text};\n"));
    }
    for (at, text) in body.results.iter().enumerate() {
        let place = match columns {
            0 => format!("[{at}]"),
            columns => format!("[{}][{}]", at / columns, at % columns),
        };
        out.push_str(&format!("        {result}{place} = {text};\n"));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packages_have_no_words_of_the_language() {
        let name = "robotics.class.2d.java.int_";
        assert_eq!(package(name), "robotics.class_._2d.java_.int_");
        assert_eq!(ascii("\u{e9}\u{1f642}"), "\\u00e9\\ud83d\\ude42");
    }
}
