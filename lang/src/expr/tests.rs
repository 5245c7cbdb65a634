//! The oracle table of the real program, and more of its rules.

use super::reserved::{SENSORS, SensorIndex};
use super::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate};
use crate::problem::Problem;

/// A robot whose sensors show their index, for tests.
#[derive(Default)]
struct Robot {
    printed: Vec<String>,
}

impl Outside for Robot {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        if SENSORS[usize::from(sensor)].name == "gyroscope" {
            return Value::ints(&[0, 1, 2, 3, 4, 5, -160_000]);
        }
        Value::Int(i32::from(sensor))
    }

    fn time(&mut self) -> i32 {
        30
    }

    fn print(&mut self, text: &str) {
        self.printed.push(text.to_owned());
    }

    fn random(&mut self, below: i32) -> i32 {
        below - 1
    }
}

/// A project: texts run one after another on the same variables.
struct Bench {
    names: Names,
    store: Store,
    robot: Robot,
}

impl Bench {
    fn new(compat: Compat) -> Self {
        Self {
            names: Names::new(Kit::V62, compat),
            store: Store::default(),
            robot: Robot::default(),
        }
    }

    fn run(&mut self, text: &str) -> Result<Value, Vec<Problem>> {
        let mut source = Source::new(text, Wanted::Any);
        analyse(&mut source, &mut self.names)?;
        evaluate(&source, &self.names, &mut self.store, &mut self.robot)
    }

    /// What an evaluating Print Text shows, or the messages with their places.
    fn shown(&mut self, text: &str) -> String {
        match self.run(text) {
            Ok(value) => value.printed().to_string(),
            Err(problems) => {
                let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
                lines.join(" | ")
            }
        }
    }
}

/// Texts run in order; what the last one shows.
fn shown(texts: &[&str]) -> String {
    shown_as(Compat::Studio, texts)
}

fn shown_as(compat: Compat, texts: &[&str]) -> String {
    let mut bench = Bench::new(compat);
    texts.iter().map(|text| bench.shown(text)).last().unwrap()
}

/// Texts that run one after another, and what the last one shows or says.
const ORACLE: [(&[&str], &str); 56] = [
    (&["7/2"], "3.5"),
    (&["7//2"], "3"),
    (&["-7//2"], "-3"),
    (&["-7%2"], "-1"),
    (&["7.5//2"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["7.5%2"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["1/0"], "1:1 Division by zero"),
    (&["-16777217"], "-16777216"),
    (&["0-16777217"], "-16777217"),
    (&["2^3^2"], "512"),
    (&["-2^2"], "-4"),
    (&["1000000*1000000"], "1000000000000"),
    (&["1 << 40"], "256"),
    (&["3==3.0"], "true"),
    (&["\"3\"==3"], "true"),
    (&["\"a\"<\"b\""], "false"),
    (&["\"2\"<\"10\""], "true"),
    (&["0.4 and 1"], "false"),
    (&["\"abc\" and true"], "false"),
    (&["not nil"], "true"),
    (&["not 0"], "true"),
    (&["not 1==2"], "false"),
    (&["1 < 2 < 3"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (&["1 .. 2"], "12"),
    (&["1+2 .. 3*4"], "312"),
    (&["1/3"], "0.333333"),
    (&["2^0.5"], "1.414214"),
    (&["0.1+0.2"], "0.3"),
    (&["#\"abc\""], "3"),
    (
        &["a={1,2,3}", "#a"],
        "1:1 Type mismatch. | 1:2 Type mismatch",
    ),
    (&["~5"], "-6"),
    (&["5 ~ 3"], "6"),
    (&["0x1F"], "31"),
    (&["1e3"], "1000"),
    (&["a={1,2,3}", "a[0]"], "1"),
    (&["a={1,2,3}", "a[3]"], ""),
    (&["a[2]=5", "a[0]"], ""),
    (&["a[2]=5", "a[2]"], "5"),
    (&["a={1,2,3} a[1]=2.5", "a[1]"], "2.5"),
    (&["x=1 x=2.5", "x"], "2.5"),
    (
        &["x=1 x=\"s\""],
        "1:5 Left and right operand have mismatched types. | 1:1 Type mismatch | 1:5 Type mismatch",
    ),
    (
        &["y"],
        "1:1 Seems like accessing an uninitialized variable y",
    ),
    (&["sin(1,2)"], "1:1 Too many parameters, 1 expected"),
    (&["foo(1)"], "1:1 Unknown function"),
    (&["sensorA1=3"], "1:1 Variable sensorA1 is read-only"),
    (&["1 +"], "1:3 Unexpected end of input"),
    (&["a,b=1,2", "a+b"], "3"),
    (
        &["a,b=1"],
        "1:1 Number of variables in assignment shall be equal to the number of assigned values",
    ),
    (&["A1"], "A1"),
    (&["LeftButton"], "105"),
    (&["'it''s'"], "s"),
    (&["\"a\"+1"], "1:1 Type mismatch. | 1:1 Type mismatch"),
    (
        &["#f"],
        "1:2 Can not deduce type, expression can be of following types: string, table[any]",
    ),
    (&["x=5 -- c\ny=6", "x+y"], "11"),
    (&["\u{43f}=5", "\u{43f}*2"], "10"),
    (&["a={[2]=5}", "a[2] .. a[1]"], "5"),
];

#[test]
fn the_oracle_table_of_the_real_program_holds() {
    for (texts, wanted) in ORACLE {
        let found = shown(texts);
        // What to do follows the real program's words.
        let is_same = found == wanted
            || found
                .split(" | ")
                .zip(wanted.split(" | "))
                .all(|(found, wanted)| wanted.contains(':') && found.starts_with(wanted))
                && found.split(" | ").count() == wanted.split(" | ").count();
        assert!(is_same, "{texts:?}: {found:?} instead of {wanted:?}");
    }
}
