//! How fast expressions run: nodes per second on one core, and how that compares to a plain walk of the same tree.
//!
//! The yardstick is what one writes in an hour: boxed nodes, variables by name in a map. `cargo bench -p lang-expr --bench
//! expressions`; the least of several runs counts.

use lang_expr::reserved::SensorIndex;
use lang_expr::tree::{Binary, Id, Node, Tree};
use lang_expr::{Compat, Kit, Names, Outside, Source, Store, Value, Wanted, analyse, evaluate};
use std::collections::HashMap;
use std::hint::black_box;
use std::time::Instant;

/// Texts as pupils write them.
const TEXTS: [(&str, &str); 5] = [
    ("regulator", "u = kp * (dist - s) + kd * (errOld - err)"),
    ("condition", "s < 40 and err > -5 or x == 3"),
    ("arithmetic", "(x + 1) * 2 - 7 / (x + 3) + x * x * 0.5"),
    ("whole", "(x * 3 + 1) // 2 % 7 << 2"),
    ("element", "a[x] + a[x + 1]"),
];
const SETUP: &str = "kp=2.5 kd=-3 dist=40 errOld=1 err=2 x=3 s=17 a={1,2,3,4,5,6}";
const ROUNDS: u32 = 400_000;
const RUNS: u32 = 5;

struct Nobody;

impl Outside for Nobody {
    fn sensor(&mut self, _: SensorIndex) -> Value {
        Value::Int(42)
    }
    fn time(&mut self) -> i32 {
        0
    }
    fn print(&mut self, _: &str) {}
    fn random(&mut self, _: i32) -> i32 {
        0
    }
}

/// The yardstick.
enum Boxed {
    Number(f64),
    Name(String),
    Minus(Box<Boxed>),
    Binary(Binary, Box<Boxed>, Box<Boxed>),
    Element(String, Box<Boxed>),
    Assign(String, Box<Boxed>),
}

fn boxed(tree: &Tree, id: Id) -> Boxed {
    match tree.node(id) {
        Node::Int(text) | Node::Float(text) => Boxed::Number(text.parse().unwrap_or(0.0)),
        Node::Name(name) => Boxed::Name(name.to_string()),
        Node::Unary(_, operand) => Boxed::Minus(Box::new(boxed(tree, *operand))),
        Node::Binary(operator, left, right) => Boxed::Binary(
            *operator,
            Box::new(boxed(tree, *left)),
            Box::new(boxed(tree, *right)),
        ),
        Node::Index { table, index } => match tree.node(*table) {
            Node::Name(name) => Boxed::Element(name.to_string(), Box::new(boxed(tree, *index))),
            _ => Boxed::Number(0.0),
        },
        Node::Assign { target, value } => match tree.node(*target) {
            Node::Name(name) => Boxed::Assign(name.to_string(), Box::new(boxed(tree, *value))),
            _ => Boxed::Number(0.0),
        },
        _ => Boxed::Number(0.0),
    }
}

#[derive(Default)]
struct Walker {
    values: HashMap<String, f64>,
    lists: HashMap<String, Vec<f64>>,
}

impl Walker {
    fn walk(&mut self, node: &Boxed) -> f64 {
        match node {
            Boxed::Number(number) => *number,
            Boxed::Name(name) => self.values.get(name).copied().unwrap_or(0.0),
            Boxed::Minus(operand) => -self.walk(operand),
            Boxed::Element(name, index) => {
                let index = self.walk(index) as usize;
                let list = self.lists.get(name);
                list.and_then(|list| list.get(index).copied())
                    .unwrap_or(0.0)
            }
            Boxed::Assign(name, value) => {
                let value = self.walk(value);
                self.values.insert(name.clone(), value);
                value
            }
            Boxed::Binary(operator, left, right) => {
                let (left, right) = (self.walk(left), self.walk(right));
                match operator {
                    Binary::Add => left + right,
                    Binary::Subtract => left - right,
                    Binary::Multiply => left * right,
                    Binary::Divide => left / right,
                    Binary::DivideWhole => (left / right).trunc(),
                    Binary::Modulo => left % right,
                    Binary::ShiftLeft => f64::from((left as i32) << (right as i32 & 31)),
                    Binary::Less => f64::from(u8::from(left < right)),
                    Binary::Greater => f64::from(u8::from(left > right)),
                    Binary::Equal => f64::from(u8::from(left == right)),
                    Binary::And => f64::from(u8::from(left != 0.0 && right != 0.0)),
                    Binary::Or => f64::from(u8::from(left != 0.0 || right != 0.0)),
                    _ => 0.0,
                }
            }
        }
    }
}

/// Seconds of the fastest of several runs.
fn fastest(mut round: impl FnMut()) -> f64 {
    let mut best = f64::INFINITY;
    for _ in 0..RUNS {
        let began = Instant::now();
        for _ in 0..ROUNDS {
            round();
        }
        best = best.min(began.elapsed().as_secs_f64());
    }
    best
}

fn main() {
    let mut names = Names::new(Kit::V62, Compat::Studio);
    let mut store = Store::default();
    let mut setup = Source::new(SETUP, Wanted::Statements);
    analyse(&mut setup, &mut names).expect("the setup is right");
    evaluate(&setup, &names, &mut store, &mut Nobody).expect("the setup runs");
    let mut walker = Walker::default();
    for (name, number) in [
        ("kp", 2.5),
        ("kd", -3.0),
        ("dist", 40.0),
        ("errOld", 1.0),
        ("err", 2.0),
    ] {
        walker.values.insert(name.into(), number);
    }
    walker.values.insert("x".into(), 3.0);
    walker.values.insert("s".into(), 17.0);
    walker
        .lists
        .insert("a".into(), vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);

    println!(
        "{:<12} {:>6} {:>16} {:>16} {:>7}",
        "text", "nodes", "nodes/s", "plain walk", "ratio"
    );
    let (mut nodes, mut seconds, mut plain_seconds) = (0.0, 0.0, 0.0);
    for (label, text) in TEXTS {
        let mut source = Source::new(text, Wanted::Any);
        analyse(&mut source, &mut names).unwrap_or_else(|problems| panic!("{text}: {problems:?}"));
        let count = source.tree().nodes.len() as f64;
        let ours = fastest(|| {
            // As the machine does it: the types are looked at each time.
            analyse(&mut source, &mut names).expect("still right");
            black_box(evaluate(&source, &names, &mut store, &mut Nobody).expect("runs"));
        });
        let plain = source
            .tree()
            .root
            .map(|root| boxed(source.tree(), root))
            .expect("a root");
        let theirs = fastest(|| {
            black_box(walker.walk(black_box(&plain)));
        });
        let rounds = f64::from(ROUNDS);
        println!(
            "{label:<12} {count:>6} {:>16.0} {:>16.0} {:>7.2}",
            count * rounds / ours,
            count * rounds / theirs,
            theirs / ours
        );
        nodes += count * rounds;
        seconds += ours;
        plain_seconds += theirs;
    }
    println!(
        "{:<12} {:>6} {:>16.0} {:>16.0} {:>7.2}",
        "all",
        "",
        nodes / seconds,
        nodes / plain_seconds,
        plain_seconds / seconds
    );
}
