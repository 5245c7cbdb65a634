//! Texts and their layout.

use super::super::syntax::{Document, EquationText, ExprText, Node, Span};
use super::super::tests::{BART, DRIVE};
use super::super::understand;
use super::*;

fn formatted(text: &str) -> String {
    let once = format(text).unwrap_or_else(|why| panic!("{text}\n{why:?}"));
    assert_eq!(
        format(&once).as_deref(),
        Ok(once.as_str()),
        "not the second time:\n{text}"
    );
    assert_eq!(without_places(text), without_places(&once), "{once}");
    assert_eq!(comments(text), comments(&once));
    once
}

/// All comments, without white space and in any order.
fn comments(text: &str) -> Vec<String> {
    let all = lexer::tokens(text).filter(|one| one.kind.is_comment());
    let plain = |one: Token| slice(text, one.span).split_whitespace().collect::<String>();
    let mut found: Vec<String> = all.map(plain).collect();
    found.sort();
    found
}

fn expression(one: &mut ExprText) {
    one.span = Span::default();
    match &mut one.node {
        Node::Sign(_, inside) => expression(inside),
        Node::Binary(_, left, right) | Node::Compare(_, left, right) => {
            expression(left);
            expression(right);
        }
        Node::Call(name, arguments) => {
            name.span = Span::default();
            arguments.iter_mut().for_each(expression);
        }
        _ => {}
    }
}

/// The tree, with documentation, but nothing of its layout.
pub(crate) fn without_places(text: &str) -> Document {
    let mut document = understand(text).document;
    let none = Span::default();
    for model in &mut document.models {
        model.span = none;
        model.name.span = none;
        if let Some(doc) = &mut model.doc {
            doc.span = none;
        }
        if let Some(name) = &mut model.package {
            name.span = none;
        }
        for section in &mut model.sections {
            section.span = none;
            for one in &mut section.names {
                one.name.span = none;
                if let Some(doc) = &mut one.doc {
                    doc.span = none;
                }
                if let Some(unit) = &mut one.unit {
                    unit.span = none;
                }
                if let Some((_, span)) = &mut one.domain {
                    *span = none;
                }
                if let Some((_, span)) = &mut one.value {
                    *span = none;
                }
            }
        }
        for EquationText {
            span,
            target,
            value,
            ..
        } in &mut model.equations
        {
            *span = none;
            target.span = none;
            expression(value);
        }
    }
    document
}

#[test]
fn published_models_get_an_indentation_and_lines_that_fit() {
    let expected = "BEGIN DifferentialDrive
  PACKAGE: robotics.models;
  ACTION: u_l, u_r;
  PARAM: L, r;
  CONFIG: x, y, theta;
  d(x) = r / 2 * (u_l + u_r) * cos(theta);
  d(y) = r / 2 * (u_l + u_r) * sin(theta);
  d(theta) = (r / L) * (u_r - u_l);
END;
";
    assert_eq!(formatted(DRIVE), expected);
    let bart = formatted(BART);
    assert!(bart.lines().all(|line| line.len() <= WIDTH), "{bart}");
    let broken = "  d(x_front) = (tt_wheel_radius / 2)
    * (((cos(phi_front) - k * sin(phi_front)) * right_f_s)
    + ((cos(phi_front) + k * sin(phi_front)) * left_f_s));
";
    assert!(bart.contains(broken), "{bart}");
}

#[test]
fn comments_stay_where_they_are_and_blank_lines_too() {
    let text = "\u{feff}// a model
/** Doc.
      * more
   */ BEGIN M // begins\r
ACTION:u,/** the other */\tv ;// inputs


PARAM : /* first */ k[ m/s ]  in -1..2 , // of k
  l /** of l */ , m;
CONST:a=-1,b = +2.5;
CONFIG: x in S1;
d ( x )=u // left
*v+ /* between */ (k--l)*m*a*b;  /* behind */ /* twice */
// last
END ; // after
";
    let expected = "// a model
/** Doc.
 * more
 */
BEGIN M // begins
  ACTION:
    u,
    /** the other */
    v; // inputs

  PARAM:
    /* first */
    k [m/s] in -1 .. 2, // of k
    l, /** of l */
    m;
  CONST: a = -1, b = +2.5;
  CONFIG: x in S1;
  d(x) = u // left
    * v + /* between */ (k - -l) * m * a * b; /* behind */ /* twice */
  // last
END; // after
";
    assert_eq!(formatted(text), expected);
}

#[test]
fn what_cannot_be_read_is_not_touched() {
    assert!(format("BEGIN M ACTION: u; CONFIG: x; d(x) = (u; END;").is_err());
    // A mistake of meaning is no hindrance.
    let text = "BEGIN M\n  ACTION: u;\n  CONFIG: x;\n  d(x) = w;\nEND;\n";
    assert_eq!(formatted(text), text);
}

#[test]
fn long_sections_and_comments_in_odd_places_survive() {
    let names = (0..60)
        .map(|at| format!("name_{at}"))
        .collect::<Vec<_>>()
        .join(",");
    let text = std::format!(
        "BEGIN /* a */ M /** doc */ ACTION /** in */ : u; // x\n PACKAGE // p\n : a /* q */ . b // r\n ;\
         CONFIG:{names}; d(name_0) = u /* one\n two */ + // three\n pow /* four */ (u, /* five */ 2); END // six\n; /* seven */"
    );
    let out = formatted(&text);
    assert!(out.contains("\n    name_"), "{out}");
    for word in ["one", "three", "four", "five", "six", "seven"] {
        assert!(out.contains(word));
    }
}
