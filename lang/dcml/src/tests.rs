//! Documents from text to models and messages.

use super::diagnostic::{Code, Severity};
use super::*;
use crate::model::Expr;
use crate::syntax::Kind;

/// The two models of the paper, as they are printed there.
pub(super) const DRIVE: &str = "BEGIN DifferentialDrive
PACKAGE: robotics.models;
ACTION: u_l, u_r;
PARAM: L, r;
CONFIG: x, y, theta;
d(x) = r / 2 * (u_l + u_r) * cos(theta);
d(y) = r / 2 * (u_l + u_r) * sin(theta);
d(theta) = (r / L) * (u_r - u_l);
END;
";
pub(super) const BART: &str = "BEGIN Bart
PACKAGE: robotics.models;
ACTION: left_f_s, right_f_s, left_r_s, right_r_s;
PARAM : tt_wheel_half_axis, tt_wheel_radius, tt_steer_offset;
CONFIG: x, y, theta, x_front, y_front, phi_front, x_rear, y_rear, phi_rear;
VAR: k;
k = tt_steer_offset / tt_wheel_half_axis;
d(x_front) = (tt_wheel_radius/2) * (((cos(phi_front) - k * sin(phi_front)) * right_f_s) + ((cos(phi_front) + k * sin(phi_front)) * left_f_s));
d(y_front) = (tt_wheel_radius/2) * (((sin(phi_front) + k * cos(phi_front)) * right_f_s) + ((sin(phi_front) - k * cos(phi_front)) * left_f_s));
d(phi_front) = (tt_wheel_radius / (2 * tt_wheel_half_axis)) * (right_f_s - left_f_s);
d(x_rear) = (tt_wheel_radius/2) * (((cos(phi_rear) - k * sin(phi_rear)) * right_r_s) + ((cos(phi_rear) + k * sin(phi_rear)) * left_r_s));
d(y_rear) = (tt_wheel_radius/2) * (((sin(phi_rear) + k * cos(phi_rear)) * right_r_s) + ((sin(phi_rear) - k * cos(phi_rear)) * left_r_s));
d(phi_rear) = (tt_wheel_radius / (2 * tt_wheel_half_axis)) * (right_r_s - left_r_s);
x = (x_front + x_rear)/2;
y = (y_front + y_rear)/2;
theta = atan2((y_front-y_rear),(x_front-x_rear)) + (pi / 4);
END;
";

#[test]
fn the_published_models_are_understood() {
    for text in [DRIVE, BART] {
        let paper = understand_paper(text);
        assert_eq!(paper.diagnostics, []);
        assert_eq!(paper.models.len(), 1);
    }
    let drive = &understand(DRIVE).models[0];
    assert_eq!(drive.package.as_deref(), Some("robotics.models"));
    let names = |kind| {
        drive
            .of_kind(kind)
            .map(|one| one.name.as_str())
            .collect::<Vec<_>>()
    };
    assert_eq!(names(Kind::Action), ["u_l", "u_r"]);
    assert_eq!(names(Kind::Param), ["L", "r"]);
    assert_eq!(
        drive
            .states()
            .map(|one| one.name.as_str())
            .collect::<Vec<_>>(),
        ["x", "y", "theta"]
    );
    assert_eq!(drive.equations.len(), 3);
    let bart = &understand(BART).models[0];
    assert_eq!((bart.states().count(), bart.outputs().count()), (6, 3));
    let targets = bart
        .equations
        .iter()
        .map(|one| bart.symbols[one.target].name.as_str());
    let expected = [
        "k",
        "x",
        "y",
        "theta",
        "x_front",
        "y_front",
        "phi_front",
        "x_rear",
        "y_rear",
        "phi_rear",
    ];
    assert_eq!(targets.collect::<Vec<_>>(), expected);
}

#[test]
fn each_finding_has_an_example_that_gives_it_and_no_other_error() {
    for &code in Code::ALL {
        let example = code.example();
        if matches!(
            code,
            Code::UnknownUnit | Code::UnitMismatch | Code::UnitScale
        ) {
            continue;
        }
        if example.is_empty() {
            assert!(
                matches!(code, Code::TooDeep | Code::TooLong | Code::More),
                "{}",
                code.name()
            );
            continue;
        }
        let all = if code == Code::Extension {
            understand_paper(example)
        } else {
            understand(example)
        };
        let errors = all
            .diagnostics
            .iter()
            .filter(|one| one.severity == Severity::Error || one.code == code);
        let names: Vec<_> = errors.map(|one| one.code.name()).collect();
        assert_eq!(names, [code.name()], "{example}\n{:?}", all.diagnostics);
        let is_good = all
            .diagnostics
            .iter()
            .all(|one| one.severity == Severity::Warning);
        if !is_good && code != Code::DuplicateModel && code != Code::OutsideModel {
            assert_eq!(all.models.len(), 0, "{example}");
        }
    }
    let mut names: Vec<_> = Code::ALL.iter().map(|one| one.name()).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), Code::ALL.len());
}

#[test]
fn equations_are_in_an_order_in_which_they_can_be_computed() {
    let text = "BEGIN M ACTION: u; CONFIG: x, y; VAR: a, b, c;
d(x) = y; a = b + c; b = c * u; c = x; y = a; END;";
    let model = &understand(text).models[0];
    let targets: Vec<_> = model
        .equations
        .iter()
        .map(|one| model.symbols[one.target].name.as_str())
        .collect();
    assert_eq!(targets, ["c", "b", "a", "y", "x"]);
    assert!(model.equations[4].is_derivative);
    let Expr::Symbol(id) = model.equations[4].value else {
        panic!("{:?}", model.equations[4])
    };
    assert_eq!(model.symbols[id].name, "y");
}

/// Where the list begins in docs/dcml.md, and where it ends.
const LIST: (&str, &str) = (
    "<!-- errors: written by `TRIK_WRITE_DOCS=1 cargo test -p lang-dcml --lib` -->\n",
    "<!-- end of errors -->",
);

/// The list of all findings, as the documentation has it.
fn list() -> String {
    let mut out = String::new();
    for &code in Code::ALL {
        let severity = match code.severity() {
            Severity::Error => "error",
            Severity::Warning => "warning",
        };
        out.push_str(
            &format!("\n### {}\n\nAn {severity}: ", code.name()).replace("An warning", "A warning"),
        );
        out.push_str(&format!("{}\n", code.explanation()));
        if !code.example().is_empty() {
            // Documents are ASCII.
            let example: String = code
                .example()
                .chars()
                .map(|sign| match sign {
                    sign if sign.is_ascii() => sign.to_string(),
                    sign => sign.escape_unicode().to_string(),
                })
                .collect();
            out.push_str(&format!("\n```dcml\n{example}```\n"));
        }
    }
    out.push('\n');
    out
}

#[test]
fn the_list_of_errors_in_the_document_is_the_whole_one() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/dcml.md");
    let document = std::fs::read_to_string(path).unwrap();
    let (before, rest) = document.split_once(LIST.0).unwrap();
    let (written, after) = rest.split_once(LIST.1).unwrap();
    let made = list();
    if std::env::var_os("TRIK_WRITE_DOCS").is_some() {
        std::fs::write(path, format!("{before}{}{made}{}{after}", LIST.0, LIST.1)).unwrap();
        return;
    }
    assert_eq!(written, made, "write it anew with TRIK_WRITE_DOCS=1");
}

#[test]
fn the_document_has_all_functions_and_units() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/dcml.md");
    let document = std::fs::read_to_string(path).unwrap();
    for function in function::Function::ALL {
        assert!(
            document.contains(&format!("`{}(", function.name())),
            "{}",
            function.name()
        );
    }
    let (_, units) = document.split_once("Units are those of the SI:").unwrap();
    let words: Vec<&str> = units
        .lines()
        .next()
        .unwrap_or_default()
        .split([',', ';', ' ', '`', '.'])
        .collect();
    for unit in unit::Unit::names().filter(|unit| !["kg", "sr"].contains(unit)) {
        assert!(words.contains(&unit), "{unit}");
    }
}

#[test]
fn derivatives_in_expressions_are_computed_before_what_needs_them() {
    let text = "BEGIN M ACTION: u; PARAM: k; CONFIG: x, y, speed, z, d_z; VAR: a;
        d(x) = u + a; d(y) = 2 * d(x) + x; speed = sqrt(pow(d(x), 2) + pow(d(y), 2));
        a = k * d(z); d(z) = x; d(d_z) = d(z); END;";
    for all in [understand(text), understand_paper(text)] {
        assert_eq!(all.diagnostics, []);
        let mut robot = crate::robot::Robot::new(&all.models[0], &[10.0]).unwrap();
        // In the order x, y, z, d_z: z' = x, a = 10 z', x' = u + a, y' = 2 x' + x.
        let (state, action) = ([3.0, 0.0, 0.0, 0.0], [1.0]);
        let mut derivative = [0.0; 4];
        crate::system::System::derivative(&mut robot, &state, &action, &mut derivative);
        assert_eq!(derivative, [31.0, 65.0, 3.0, 3.0]);
        let mut outputs = [0.0];
        robot.output(&state, &action, &mut outputs);
        assert_eq!(outputs, [31f64.hypot(65.0)]);
    }
}

#[test]
fn derivatives_that_are_not_known_are_told() {
    let told = |inside: &str| {
        let text = format!("BEGIN M ACTION: u; CONFIG: x, y; {inside} END;");
        let all = understand(&text).diagnostics;
        let mut mistakes = all.iter().filter(|one| one.severity == Severity::Error);
        let first = mistakes.next().expect("a mistake");
        (first.code, first.message.clone())
    };
    for (inside, code, message) in [
        (
            "d(x) = d(y); d(y) = d(x);",
            Code::AlgebraicLoop,
            "values need each other in a circle: d(x) -> d(y) -> d(x)",
        ),
        (
            "VAR: a; a = d(x); d(x) = a; d(y) = u;",
            Code::AlgebraicLoop,
            "values need each other in a circle: a -> d(x) -> a",
        ),
        (
            "d(x) = d(y); y = x + u;",
            Code::NotDerivable,
            "`y` is computed from other values, and its derivative is not known",
        ),
        (
            "d(x) = d(u); d(y) = u;",
            Code::NotDerivable,
            "`u` is no `CONFIG`, and only those have a derivative",
        ),
        (
            "d(x) = d(x, y) + u; d(y) = u;",
            Code::NotDerivable,
            "only a name of `CONFIG` has a derivative",
        ),
        (
            "d(x) = d(z) + u; d(y) = u;",
            Code::UndeclaredName,
            "`z` is not declared",
        ),
        (
            "d(x) = d(y) + u;",
            Code::MissingEquation,
            "`y` has no equation",
        ),
    ] {
        assert_eq!(told(inside), (code, message.to_owned()), "{inside}");
    }
}

#[test]
fn a_derivative_has_the_unit_of_its_state_by_time() {
    let with = |sum: &str| {
        let text = format!(
            "BEGIN M ACTION: u [m/s]; CONFIG: x [m], y [m]; d(x) = u; d(y) = d(x) + {sum}; END;"
        );
        let codes: Vec<_> = understand(&text)
            .diagnostics
            .iter()
            .map(|one| one.code)
            .collect();
        codes
    };
    assert_eq!(with("u"), []);
    assert_eq!(with("x"), [Code::UnitMismatch]);
}
