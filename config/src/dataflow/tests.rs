//! Tests of programs of data flow that a configuration names: from their text to a node that computes, and every way to be
//! refused.

use crate::load::{Loaded, Loader};
use crate::program::{StageId, Vm};
use converter::{Conversion, Direction};
use std::fs;
use std::path::Path;

const NODES: &str = "trikfs = { near = { src = '/dev/zero', format = 'i32 value', poll_ms = 20 },
turn = { src = '/dev/zero', format = 'f32 x, f32 y, f32 z', poll_ms = 20 } }\n";

/// A complementary filter: of what is between two sensors, a part from each.
const FILTER: &str = "diagram \"Fused\"
  memory: Variable(variable = \"angle = 0.0\")
  near: Sensor(VarName = sensorA1)
  turn: Sensor(VarName = accelerometer)
  fuse: \"Text programming\"(IO0 = `angle = 0.75*angle + 0.25*(I0 + I1[2])`)
  near.OUT -> fuse.I0
  turn.OUT -> fuse.I1
";
const INPUTS: &str =
    "inputs = { sensorA1 = 'near', accelerometer = { 'turn', type = 'f32' } }, shows = { 'angle' }";

fn text(program: &str, options: &str) -> String {
    format!("{NODES}trikfs.made = dataflow {{ program = {program}, {options} }}")
}

fn loaded(base: Option<&Path>, program: &str, options: &str) -> Result<Loaded, String> {
    let loaded = Loader::default().load("robot.lua", base, text(program, options).as_bytes());
    loaded.map_err(|error| error.to_string())
}

fn refused_in(base: Option<&Path>, program: &str, options: &str) -> String {
    loaded(base, program, options).expect_err(options)
}

fn refused(program: &str, options: &str) -> String {
    refused_in(None, program, options)
}

fn inline(program: &str) -> String {
    format!("[=[\n{program}]=]")
}

/// A converter of these many bytes.
struct Node(Vm, StageId, usize);

impl Node {
    fn of(base: Option<&Path>, program: &str, options: &str) -> Self {
        let loaded = loaded(base, program, options).unwrap_or_else(|reason| panic!("{reason}"));
        let mut nodes = loaded.config.nodes.iter();
        let node = nodes.find(|node| node.path == "made").expect("the node");
        let mut vm = loaded.program.open("made").expect("a state");
        vm.set_params("made", &node.params).expect("parameters");
        let (input, output) = (node.input_tuple_size, node.output_tuple_size);
        let stage = vm.bind("made", Direction::Read, 0, input, output);
        Self(vm, stage.expect("a converter"), output)
    }

    fn feed(&mut self, near: i32, turn: [f32; 3], us: u32) -> Result<Vec<f64>, String> {
        // Sources stand in the order of their names.
        let mut input: Vec<u8> = turn.iter().flat_map(|one| one.to_le_bytes()).collect();
        input.extend(near.to_le_bytes());
        input.extend(us.to_le_bytes());
        let mut output = vec![0; self.2];
        let done = self.0.convert(self.1, &input, &mut output);
        match done.map_err(|fault| fault.to_string())? {
            Conversion::Produced => {}
            Conversion::Consumed => return Ok(Vec::new()),
        }
        let numbers = output.chunks_exact(8);
        Ok(numbers
            .map(|one| f64::from_le_bytes(one.try_into().expect("eight bytes")))
            .collect())
    }
}

#[test]
fn a_program_computes_from_newest_values_and_remembers() {
    let mut node = Node::of(None, &inline(FILTER), INPUTS);
    assert_eq!(node.feed(4, [9.0, 9.0, 4.0], 0), Ok(vec![2.0]));
    assert_eq!(node.feed(4, [9.0, 9.0, 4.0], 20_000), Ok(vec![3.5]));
    assert_eq!(node.feed(0, [9.0, 9.0, 0.5], 20_000), Ok(vec![2.75]));
    // Another file begins anew.
    let mut other = Node::of(None, &inline(FILTER), INPUTS);
    assert_eq!(other.feed(4, [9.0, 9.0, 4.0], 0), Ok(vec![2.0]));
}

/// Sources stand in the order of their names, wherever a program reads them.
#[test]
fn a_sensor_that_only_a_text_reads_has_its_own_reading() {
    let program = "diagram \"Sum\"
  near: Sensor(VarName = sensorA1)
  add: \"Text programming\"(IO0 = `angle = I0 + 100*accelerometer[1]`)
  near.OUT -> add.I0
";
    let mut node = Node::of(None, &inline(program), INPUTS);
    assert_eq!(node.feed(4, [7.0, 2.0, 9.0], 0), Ok(vec![204.0]));
    assert_eq!(node.feed(5, [7.0, 3.0, 9.0], 20_000), Ok(vec![305.0]));
    let alone = "diagram \"Alone\"
  every: Loop(end_border = 1000, time = 10)
  add: \"Text programming\"(IO0 = `angle = sensorA1 + 100*accelerometer[1] + 0*I0`)
  every.OUT -> add.I0
";
    let mut node = Node::of(None, &inline(alone), INPUTS);
    assert_eq!(node.feed(4, [7.0, 2.0, 9.0], 0), Ok(vec![204.0]));
}

#[test]
fn what_goes_wrong_names_its_block_and_the_program_begins_anew() {
    let divides = FILTER.replace("0.25*(I0 + I1[2])", "4 / I0");
    let mut node = Node::of(None, &inline(&divides), INPUTS);
    assert_eq!(node.feed(4, [0.0; 3], 0), Ok(vec![1.0]));
    assert_eq!(node.feed(4, [0.0; 3], 20_000), Ok(vec![1.75]));
    let fault = node.feed(0, [0.0; 3], 20_000).expect_err("a fault");
    assert!(fault.contains("fuse.I1: division by 0"), "{fault}");
    assert_eq!(node.feed(4, [0.0; 3], 20_000), Ok(vec![1.0]));
    let ends = FILTER.to_owned() + "  stop: Stop\n  fuse.CF_OUT -> stop.IN0\n";
    let mut node = Node::of(None, &inline(&ends), INPUTS);
    let fault = node.feed(4, [0.0; 3], 0).expect_err("a fault");
    assert!(fault.contains("the program has ended"), "{fault}");
}

#[test]
fn motors_are_outputs_and_what_has_no_value_yet_gives_nothing() {
    let drives = "diagram \"Drive\"
  near: Sensor(VarName = sensorA1)
  turn: Sensor(VarName = accelerometer)
  far: If(condition = `data > 5`)
  fuse: \"Text programming\"(IO0 = `speed = I0; I0 * 10`)
  wheels: Motors
  near.OUT -> far.DATA
  far.TRUE -> fuse.I0
  fuse.O0 -> wheels.M4
";
    let options = INPUTS.replace(", shows = { 'angle' }", "");
    let mut node = Node::of(None, &inline(drives), &options);
    assert_eq!(node.feed(4, [0.0; 3], 0), Ok(vec![0.0]));
    assert_eq!(node.feed(7, [0.0; 3], 20_000), Ok(vec![70.0]));
    assert_eq!(node.feed(700, [0.0; 3], 20_000), Ok(vec![100.0]));
    let mut node = Node::of(
        None,
        &inline(drives),
        &format!("{options}, shows = {{ 'speed', 'M4' }}"),
    );
    assert_eq!(node.feed(4, [0.0; 3], 0), Ok(vec![]));
    assert_eq!(node.feed(7, [0.0; 3], 20_000), Ok(vec![7.0, 70.0]));
}

#[test]
fn a_long_pause_costs_no_more_than_a_hundred_instants() {
    let counts = FILTER.to_owned()
        + "  count: Loop(end_border = 1000000, time = 10)\n  keep: \"Text programming\"(IO0 = `angle = I0`)\n  count.OUT -> keep.I0\n";
    let counts = counts.replace(
        "angle = 0.75*angle + 0.25*(I0 + I1[2])",
        "other = I0 + I1[2]",
    );
    let mut node = Node::of(None, &inline(&counts), INPUTS);
    assert_eq!(node.feed(0, [0.0; 3], 0), Ok(vec![1.0]));
    assert_eq!(node.feed(0, [0.0; 3], 20_000), Ok(vec![3.0]));
    let after = node.feed(0, [0.0; 3], u32::MAX).expect("numbers")[0];
    assert!((100.0..=110.0).contains(&after), "{after}");
}

#[test]
fn programs_are_found_beside_the_configuration_as_text_and_as_lua() {
    let folder = tempfile::tempdir().expect("a folder");
    let written = crate::dataflow::chunk(
        FILTER.as_bytes().to_vec(),
        b"fused.flow",
        "fused.flow",
        super::Language::Lua,
    );
    fs::write(folder.path().join("fused.flow"), FILTER).expect("a program");
    fs::write(folder.path().join("fused.lua"), written.expect("a module")).expect("a module");
    for name in ["'fused.flow'", "'fused.lua'"] {
        let mut node = Node::of(Some(folder.path()), name, INPUTS);
        assert_eq!(node.feed(4, [9.0, 9.0, 4.0], 0), Ok(vec![2.0]), "{name}");
    }
    let refused = |program| refused_in(Some(folder.path()), program, INPUTS);
    let as_c = format!("{INPUTS}, language = 'c'");
    let wrong = refused_in(Some(folder.path()), "'fused.lua'", &as_c);
    assert!(wrong.contains("is Lua already"), "{wrong}");
    fs::write(folder.path().join("other.lua"), "return 3").expect("another file");
    let wrong = refused("'other.lua'");
    assert!(wrong.contains("is no program that"), "{wrong}");
    fs::write(folder.path().join("no.qrs"), b"PK").expect("a torn save");
    let wrong = refused("'no.qrs'");
    assert!(wrong.contains("robot.lua:3: no.qrs: "), "{wrong}");
}

fn told(options: &str, expected: &str) {
    let reason = refused(&inline(FILTER), options);
    assert!(reason.starts_with("robot.lua:"), "{reason}");
    assert!(reason.contains(expected), "{reason}");
}

#[test]
fn mistakes_of_a_node_are_told_with_their_place() {
    told(
        "shows = { 'angle' }",
        "inputs: nothing is said of 'accelerometer'",
    );
    told("inputs = 3", "inputs must be a table, not 3");
    told(
        "inputs = { sensorA2 = 'near' }",
        "inputs: the program reads no 'sensorA2'; it reads accelerometer, sensorA1",
    );
    told(
        "inputs = { accelerometer = { 'turn', type = 'x' } }",
        "type must be one of f32, f64, i16",
    );
    told(
        "inputs = { accelerometer = { 'turn', count = 0 } }",
        "count must be a whole number of 1 to 400",
    );
    told(
        "inputs = { accelerometer = { 'turn', kind = 'x' } }",
        "there are count, type",
    );
    told(
        "inputs = { accelerometer = 'turn', sensorA1 = { 'near', count = 2 } }",
        "sensorA1 has no count",
    );
    told(
        "inputs = { accelerometer = 'turn', sensorA1 = 5 }",
        "must name a node",
    );
    let inputs = INPUTS.replace(", shows = { 'angle' }", "");
    told(
        &inputs,
        "shows: the program tells no motor anything: name variables that the node shows, shows = { 'heading' }; it has angle",
    );
    told(
        &format!("{inputs}, shows = {{ 'M1' }}"),
        "shows: the program has no 'M1'; there are none and the variables angle",
    );
    told(
        &format!("{inputs}, shows = 3"),
        "shows must be a list of names, not 3",
    );
    told(
        &format!("{INPUTS}, language = 'd'"),
        "language must be 'lua' or 'c', not 'd'",
    );
    told(
        &format!("{INPUTS}, models = 1"),
        "there is no option 'models'; there are inputs, language, poll_ms, program, shows",
    );
}

#[test]
fn mistakes_of_a_program_are_told_with_their_place() {
    let said = refused(
        &inline(&FILTER.replace("near.OUT -> fuse.I0", "near.OUT -> fuse.I9")),
        INPUTS,
    );
    assert!(said.contains("the text of the program: "), "{said}");
    let said = refused(
        &inline(&(FILTER.to_owned() + "  say: Say\n  near.OUT -> say.DATA\n")),
        INPUTS,
    );
    assert!(
        said.contains("'Say' does something beside computing"),
        "{said}"
    );
    assert!(refused("'none.flow'", INPUTS).contains("none.flow"));
    assert!(refused("'../out.flow'", INPUTS).contains("leads outside"));
    assert!(refused("7", INPUTS).contains("program must be a file"));
}
