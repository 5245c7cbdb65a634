//! Tests of models that a configuration names: from their text to a node that moves, and every way to be refused.

use crate::load::Loader;
use crate::program::{StageId, Vm};
use converter::{Conversion, Direction};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Two wheels, 0.1 m of way for each radian, 0.2 m apart.
const WHEELS: &str =
    "params = { L = 0.2, r = 0.1 }, actions = { u_l = 'd(left)', u_r = 'd(right)' }";
const NODES: &str =
    "trikfs = { left = { src = '/dev/zero', format = 'i32 position', poll_ms = 20 },
right = { src = '/dev/zero', format = 'i32 position', poll_ms = 20 } }\n";

/// A configuration with a node `pose` of these options.
fn config(options: &str) -> String {
    format!("{NODES}trikfs.pose = dcml {{ {options} }}")
}

/// A folder of this test, removed with the value.
struct Folder(TempDir);

impl Folder {
    fn new(files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (file, text) in files {
            fs::write(folder.path().join(file), text).unwrap();
        }
        Self(folder)
    }
}

fn refused_in(base: Option<&Path>, options: &str) -> String {
    let loader = Loader::default();
    let loaded = loader.load("robot.lua", base, config(options).as_bytes());
    loaded
        .err()
        .unwrap_or_else(|| panic!("{options}"))
        .to_string()
}

fn refused(options: &str) -> String {
    refused_in(None, options)
}

/// A converter, and how many bytes it gives.
struct Follower(Vm, StageId, usize);

impl Follower {
    fn of(base: Option<&Path>, options: &str, inputs: usize) -> Self {
        let loaded = Loader::default().load("robot.lua", base, config(options).as_bytes());
        let loaded = loaded.unwrap_or_else(|problem| panic!("{problem}"));
        let node = loaded
            .config
            .nodes
            .iter()
            .find(|node| node.path == "pose")
            .unwrap();
        let size = 4 * inputs + 4;
        assert_eq!(node.input_tuple_size, size);
        let shown = node.output_tuple_size;
        let mut vm = loaded.program.open("pose").unwrap();
        vm.set_params("pose", &node.params).unwrap();
        let stage = vm.bind("pose", Direction::Read, 0, size, shown).unwrap();
        Self(vm, stage, shown)
    }

    fn feed(&mut self, values: &[i32], us: u32) -> Result<[f32; 3], String> {
        let all = self.all(values, us)?;
        Ok([all[0], all[1], all[2]])
    }

    /// All numbers of the node.
    fn all(&mut self, values: &[i32], us: u32) -> Result<Vec<f32>, String> {
        let mut input: Vec<u8> = values.iter().flat_map(|one| one.to_le_bytes()).collect();
        input.extend(us.to_le_bytes());
        let mut output = vec![0; self.2];
        let done = self.0.convert(self.1, &input, &mut output);
        let done = done.map_err(|fault| fault.to_string())?;
        assert_eq!(done, Conversion::Produced);
        let numbers = output.chunks_exact(4);
        Ok(numbers
            .map(|one| f32::from_le_bytes(one.try_into().unwrap()))
            .collect())
    }
}

fn near(found: [f32; 3], expected: [f64; 3]) {
    let close = found
        .iter()
        .zip(expected)
        .all(|(a, b)| (f64::from(*a) - b).abs() < 1e-5);
    assert!(close, "{found:?} instead of {expected:?}");
}

/// By hand: 1.2 rad of the left wheel and 1.8 of the right one are 0.12 and 0.18 m of way, so a turn by 0.3 rad on a circle
/// of 0.5 m; however late the samples come.
#[test]
fn an_arc_has_its_end_whatever_the_rhythm_of_its_samples() {
    for parts in [1, 3, 60] {
        let mut follower =
            Follower::of(None, &format!("model = 'differential-drive', {WHEELS}"), 2);
        // Counters that pass their end.
        let begin = [i32::MAX - 20, i32::MIN + 5];
        near(follower.feed(&begin, 0).unwrap(), [0.0; 3]);
        let mut pose = [0.0; 3];
        for n in 1..=parts {
            let degrees = |whole: i32| whole * n / parts;
            let now = [
                begin[0].wrapping_add(degrees(1200)),
                begin[1].wrapping_add(degrees(1800)),
            ];
            pose = follower
                .feed(&now, 7000 + 20_000 * (60 / parts.cast_unsigned()))
                .unwrap();
        }
        let (left, right) = (1200.0_f64.to_radians() * 0.1, 1800.0_f64.to_radians() * 0.1);
        let (turn, way) = ((right - left) / 0.2, (right + left) / 2.0);
        let radius = way / turn;
        let heading = turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round();
        near(
            pose,
            [radius * turn.sin(), radius * (1.0 - turn.cos()), heading],
        );
    }
}

#[test]
fn a_value_is_an_action_too_and_other_models_have_their_place_in_outputs() {
    let text = "[[BEGIN Car ACTION: v, s in -0.5 .. 0.5; PARAM: L; CONFIG: x, y, theta, ax, ay;
d(ax) = v * cos(theta); d(ay) = v * sin(theta); d(theta) = v / L * tan(s); x = ax + L * cos(theta); y = ay + L * sin(theta); END;]]";
    let options = format!(
        "model = {text}, params = {{ L = {{ 0.5, min = 0.1, max = 1 }} }}, start = {{ ax = 1 }},
actions = {{ v = {{ 'd(left)', scale = 0.001 }}, s = {{ 'right', scale = 0.01 }} }}"
    );
    let mut follower = Follower::of(None, &options, 2);
    // Sources stand in the order of their names: s, then v.
    near(follower.feed(&[20, 5000], 0).unwrap(), [1.5, 0.0, 0.0]);
    let turn = |way: f64, angle: f64| way / 0.5 * angle.tan();
    near(follower.feed(&[20, 5100], 20_000).unwrap(), {
        let turned = turn(0.1, 0.2);
        let radius = 0.5 / 0.2_f64.tan();
        [
            1.0 + radius * turned.sin() + 0.5 * turned.cos(),
            radius * (1.0 - turned.cos()) + 0.5 * turned.sin(),
            turned,
        ]
    });
    // The range of the action holds; a greater angle than that is not believed.
    let before = turn(0.1, 0.2);
    let [_, _, theta] = follower.feed(&[200, 5100], 20_000).unwrap();
    assert!((f64::from(theta) - before).abs() < 1e-6);
    let [_, _, theta] = follower.feed(&[200, 5200], 20_000).unwrap();
    assert!((f64::from(theta) - before - turn(0.1, 0.5)).abs() < 1e-5);
}

#[test]
fn every_state_and_output_of_a_model_is_shown_after_the_place() {
    let format_of = |options: &str| {
        let loaded = Loader::default().load("robot.lua", None, config(options).as_bytes());
        let loaded = loaded.unwrap_or_else(|problem| panic!("{problem}"));
        let node = loaded
            .config
            .nodes
            .iter()
            .find(|node| node.path == "pose")
            .unwrap();
        let fields = node.format.iter().flat_map(|format| format.fields());
        fields
            .map(|field| field.name.clone())
            .collect::<Vec<String>>()
    };
    let trailer =
        "model = 'trailer', params = { L = 0.5, hitch = 0.5 }, start = { theta_trailer = 4 },
        actions = { speed = { 'd(left)', scale = 0.001 }, steer = { 'right', scale = 0.01 } }";
    assert_eq!(
        format_of(trailer),
        ["x", "y", "theta", "theta_trailer", "bend"]
    );
    let mut follower = Follower::of(None, trailer, 2);
    // An angle of a circle is shown from -pi to pi.
    let angle = follower.all(&[0, 0], 0).unwrap()[3];
    assert!(
        (f64::from(angle) - 4.0 + std::f64::consts::TAU).abs() < 1e-6,
        "{angle}"
    );
    // Straight ahead it comes behind the car: tan(a / 2) shrinks by e^(-way / hitch).
    let mut angle = 0.0;
    for step in 1..=100 {
        angle = f64::from(follower.all(&[10 * step, 0], 20_000).unwrap()[3]);
    }
    let begun = (4.0 - std::f64::consts::TAU) / 2.0;
    let wanted = 2.0 * (begun.tan() * (-1.0_f64 / 0.5).exp()).atan();
    assert!((angle - wanted).abs() < 1e-4, "{angle} {wanted}");
    let bart = "model = 'bart', params = { tt_wheel_half_axis = 1, tt_wheel_radius = 1, tt_steer_offset = 1 },
        actions = { left_f_s = 'left', right_f_s = 'left', left_r_s = 'left', right_r_s = 'left' }";
    assert_eq!(
        format_of(bart),
        [
            "x",
            "y",
            "theta",
            "x_front",
            "y_front",
            "phi_front",
            "x_rear",
            "y_rear",
            "phi_rear"
        ]
    );
}

#[test]
fn the_heading_may_come_from_a_node_of_its_own() {
    let options =
        format!("model = 'differential-drive', heading = {{ 'gyro', scale = 0.001 }}, {WHEELS}");
    let nodes = "trikfs.gyro = { src = '/dev/zero', format = 'i32 angle', poll_ms = 20 }\n";
    let source = format!("{NODES}{nodes}trikfs.pose = dcml {{ {options} }}");
    let loaded = Loader::default()
        .load("robot.lua", None, source.as_bytes())
        .unwrap();
    let mut vm = loaded.program.open("pose").unwrap();
    vm.set_params(
        "pose",
        &[("L".to_owned(), 0.2), ("r".to_owned(), 0.1)].into(),
    )
    .unwrap();
    let stage = vm.bind("pose", Direction::Read, 0, 16, 12).unwrap();
    let mut follower = Follower(vm, stage, 12);
    follower.feed(&[5000, 0, 0], 0).unwrap();
    // Both wheels say straight ahead, a radian each; the gyroscope says half a radian to the left: an arc of 0.1 m.
    let way = (180.0 / std::f64::consts::PI) as i32;
    let metres = f64::from(way).to_radians() * 0.1;
    let pose = follower.feed(&[5500, way, way], 20_000).unwrap();
    let radius = metres / 0.5;
    near(
        pose,
        [radius * 0.5_f64.sin(), radius * (1.0 - 0.5_f64.cos()), 0.5],
    );
}

#[test]
fn counters_that_jump_lose_the_place_and_those_that_are_set_to_0_do_not() {
    let mut follower = Follower::of(None, &format!("model = 'differential-drive', {WHEELS}"), 2);
    follower.feed(&[4000, 4000], 0).unwrap();
    let ahead = f64::from(90_i32).to_radians() * 0.1;
    near(
        follower.feed(&[4090, 4090], 20_000).unwrap(),
        [ahead, 0.0, 0.0],
    );
    // Both were set to 0 and turned by 90 degrees since.
    near(
        follower.feed(&[90, 90], 20_000).unwrap(),
        [2.0 * ahead, 0.0, 0.0],
    );
    let lost = follower.feed(&[90, 9000], 20_000).unwrap_err();
    assert!(lost.starts_with("ENODEV: 'right' jumped by "), "{lost}");
    near(follower.feed(&[91, 9001], 20_000).unwrap(), [0.0; 3]);
    // A tuple that took no time is looked at with the next one.
    near(follower.feed(&[181, 9091], 0).unwrap(), [0.0; 3]);
    near(
        follower.feed(&[181, 9091], 20_000).unwrap(),
        [ahead, 0.0, 0.0],
    );
}

#[test]
fn a_model_without_a_finite_number_is_a_fault_and_begins_anew() {
    let model = "[[BEGIN P ACTION: u; CONFIG: x, y, theta; d(x) = u; d(y) = 0 * u; d(theta) = 1 / (0.5 - x) * 0 * u; END;]]";
    let options = format!("model = {model}, actions = {{ u = {{ 'd(left)', scale = 1 }} }}");
    let mut follower = Follower::of(None, &options, 1);
    follower.feed(&[0], 0).unwrap();
    let fault = follower.feed(&[1], 20_000).unwrap_err();
    assert_eq!(
        fault,
        "ENODEV: the model's theta is no finite number: the place is lost and begins anew"
    );
    near(follower.feed(&[1], 20_000).unwrap(), [0.0; 3]);
}

#[test]
fn a_file_is_found_beside_the_configuration_and_one_of_its_models_by_name() {
    let two =
        "BEGIN A ACTION: u; CONFIG: x, y, theta; d(x) = u; d(y) = 0 * u; d(theta) = 0 * u; END;
BEGIN B ACTION: u; CONFIG: x, y, theta; d(x) = 2 * u; d(y) = 0 * u; d(theta) = 0 * u; END;
BEGIN C ACTION: u; CONFIG: x; d(x) = w; END;";
    let folder = Folder::new(&[("two.dcml", two), ("latin.dcml", "BEGIN A;")]);
    fs::write(folder.0.path().join("latin.dcml"), b"/* \xe9 */").unwrap();
    let base = Some(folder.0.path());
    let actions = "actions = { u = { 'd(left)', scale = 0.01 } }";
    for (name, way) in [("two.dcml#A", 0.1), ("two#B", 0.2)] {
        let mut follower = Follower::of(base, &format!("model = '{name}', {actions}"), 1);
        follower.feed(&[0], 0).unwrap();
        near(follower.feed(&[10], 20_000).unwrap(), [way, 0.0, 0.0]);
    }
    let refused = |name: &str| refused_in(base, &format!("model = '{name}', {actions}"));
    assert!(
        refused("two.dcml").starts_with("robot.lua:3: two.dcml:3:38: "),
        "{}",
        refused("two.dcml")
    );
    assert!(
        refused("two.dcml#C").contains("two.dcml:3:38: "),
        "{}",
        refused("two.dcml#C")
    );
    assert!(refused("two.dcml#D").contains("two.dcml:3:38: "));
    assert!(refused("latin.dcml").starts_with("robot.lua:3: latin.dcml:1:4: the byte 0xe9"));
    assert!(refused("../two.dcml").contains("leads outside the search path"));
    let near = refused("diferential");
    assert!(
        near.ends_with("; did you mean the shipped model differential-drive?"),
        "{near}"
    );
    let missing = refused("none.dcml");
    assert!(
        missing.starts_with("robot.lua:3: model 'none.dcml' was not found in "),
        "{missing}"
    );
}

/// Options of a node, and what is said of them.
const WRONG: [(&str, &str); 13] = [
    (
        "start = {}",
        "model must be a file, 'robot.dcml', or a text, not a nil",
    ),
    (
        "DRIVE, wheel = 1",
        "there is no option 'wheel'; there are actions, heading, model, params, poll_ms, start",
    ),
    ("DRIVE, params = 5", "params must be a table, not 5"),
    (
        "DRIVE, params = { L = 1 }",
        "params: the model needs the number 'r'",
    ),
    (
        "DRIVE, params = { L = 1, r = 'x' }",
        "params.r must be a number, not 'x'",
    ),
    (
        "DRIVE, params = { L = 1, r = 0/0 }",
        "params.r must be a number, not nan",
    ),
    (
        "DRIVE, params = { L = 1, r = 1, w = 1 }",
        "params: the model has no parameter 'w'; it has L, r",
    ),
    (
        "DRIVE, NUMBERS, start = { z = 1 }",
        "start: the model has no state 'z'; it has x, y, theta",
    ),
    (
        "DRIVE, NUMBERS",
        "actions: nothing is said of 'u_l': name its node, u_l = 'd(encoders/E3)'",
    ),
    (
        "DRIVE, NUMBERS, actions = { u_l = 1, u_r = 'left' }",
        "actions.u_l must name a node, 'encoders/E3', or say how fast it changes, 'd(encoders/E3)', not 1",
    ),
    (
        "DRIVE, NUMBERS, actions = { u_l = { 'left', typ = 'f32' }, u_r = 'left' }",
        "actions.u_l has an unknown option 'typ'; there are scale, type",
    ),
    (
        "DRIVE, NUMBERS, actions = { u_l = { 'left', type = 'i64' }, u_r = 'left' }",
        "actions.u_l: type must be one of f32, f64, i16, i32, i8, u16, u32, u8, not 'i64'",
    ),
    (
        "DRIVE, NUMBERS, actions = { u_l = 'left', u_r = 'left' }, heading = 'd(left)'",
        "heading: it takes the place of theta, which must be a state, and is an angle",
    ),
];

/// The shipped model with these options.
fn refused_drive(options: &str) -> String {
    let drive = options.replace("DRIVE", "model = 'differential-drive'");
    refused(&drive.replace("NUMBERS", "params = { L = 1, r = 1 }"))
}

#[test]
fn options_that_mean_nothing_are_told_with_what_there_is() {
    for (options, told) in WRONG {
        let said = refused_drive(options);
        assert!(
            said.starts_with("robot.lua:3: ") && said.contains(told),
            "{options}\n{said}"
        );
    }
}

#[test]
fn sources_that_are_not_there_or_circles_or_of_another_type_are_refused() {
    let of = |right: &str| {
        refused_drive(&format!(
            "DRIVE, NUMBERS, actions = {{ u_l = 'left', u_r = {right} }}"
        ))
    };
    assert!(
        of("'none'").contains("pose: there is no node 'none'"),
        "{}",
        of("'none'")
    );
    assert!(of("'pose'").contains("circle"), "{}", of("'pose'"));
    assert_eq!(
        of("{ 'right', type = 'f32' }"),
        "robot.lua:3: pose: the converter takes 'i32 u_l, f32 u_r, u32 interval_us', but the sources give 'i32 u_l, i32 u_r, u32 interval_us'"
    );
}

#[test]
fn a_text_in_the_configuration_has_its_lines() {
    let text = "model = [[\nBEGIN A\nACTION: u;\nCONFIG: x, y, theta;\nd(x) = v; d(y) = w;\nd(theta) = u;\nEND;]]";
    let said = refused(text);
    let lines: Vec<&str> = said.lines().collect();
    assert!(
        lines[0].starts_with("robot.lua:3: robot.lua:7:8: ") && lines[0].contains("`v`"),
        "{said}"
    );
    assert!(
        lines[1].starts_with("robot.lua:7:18: ") && lines[1].contains("`w`"),
        "{said}"
    );
}
