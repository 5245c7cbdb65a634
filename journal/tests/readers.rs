//! Recordings in the hands of other people's readers: they find every message, decode it, and make the same bytes of it.
//!
//! Owns the recording that they read. TRIK_MCAP_PYTHON names an interpreter with mcap, mcap-ros2-support and rosbags,
//! TRIK_MCAP_NODE a folder `node_modules` with @mcap/core, @mcap/support, @foxglove/rosmsg and
//! @foxglove/rosmsg2-serialization; what is not named is skipped.

use journal::node::Node;
use journal::standard::robot::{
    BatteryState, CompressedImage, Imu, JointState, Joy, LaserScan, Odometry, Radiation, Range,
    Transform, Transforms,
};
use journal::standard::{Level, Log};
use journal::write::{ABOUT, Writer};
use needs::Need;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::process::Command;

const ZERO: u64 = 1_700_000_000_250_000_000;
const MESSAGES: usize = 100;

/// Nodes of every kind, a failure, a line of the log, and one message of each standard type.
fn record(path: &Path) {
    let file = BufWriter::new(File::create_new(path).unwrap());
    let mut out = Writer::new(file, "readers 1").unwrap();
    let facts = BTreeMap::from([("robot".to_owned(), "two-wheels".to_owned())]);
    out.facts(ABOUT, facts).unwrap();
    out.attach(ZERO, "config.lua", "text/x-lua", b"trikfs = {}")
        .unwrap();
    let numbers = Node::sensor("sensors/A1", "i32 X, >i16 x, f64 _y_, u8 class");
    let numbers = out.add(&numbers).unwrap();
    let bytes = out.add(&Node::sensor("raw", "u8 x 4")).unwrap();
    let text = out.add(&Node::sensor("code", "text 8")).unwrap();
    for at in 0..MESSAGES {
        let time = ZERO + at as u64 * 1_000_000;
        let small = i16::try_from(at).unwrap();
        let mut tuple = (-i32::from(small)).to_le_bytes().to_vec();
        tuple.extend_from_slice(&small.to_be_bytes());
        tuple.extend_from_slice(&(f64::from(small) / 4.0).to_le_bytes());
        tuple.push(7);
        out.sample(numbers, time, &tuple).unwrap();
    }
    out.sample(bytes, ZERO, &[1, 2, 3, 255]).unwrap();
    out.sample(text, ZERO, b"green\0\0\0").unwrap();
    out.fault(numbers, ZERO + 1, 5, "device: gone").unwrap();
    let line = Log {
        level: Level::Info,
        name: "trikfs".to_owned(),
        text: "ready".to_owned(),
        errno: 0,
    };
    out.log(ZERO, &line).unwrap();
    publish_sensors(&mut out);
    publish_robot(&mut out);
    out.finish().unwrap();
}

macro_rules! publish {
    ($out:expr, $name:literal, $message:expr) => {
        let mut topic = $out.topic($name).unwrap();
        $out.publish(&mut topic, ZERO, &$message).unwrap();
    };
}

fn publish_sensors(out: &mut Writer<BufWriter<File>>) {
    let frame = || "front".to_owned();
    let range = Range {
        frame: frame(),
        radiation: Radiation::Ultrasound,
        field_of_view: 0.5,
        min_range: 0.03,
        max_range: 4.0,
        range: f32::INFINITY,
        variance: 0.0,
    };
    publish!(out, "/ros/range", range);
    let imu = Imu {
        frame: frame(),
        orientation: Some([0.0, 0.0, 0.6, 0.8]),
        angular_velocity: [0.1, 0.2, 0.3],
        linear_acceleration: [1.0, 2.0, 9.81],
    };
    publish!(out, "/ros/imu", imu);
    let joy = Joy {
        frame: String::new(),
        axes: vec![0.5],
        buttons: vec![1, 0],
    };
    publish!(out, "/ros/joy", joy);
    let scan = LaserScan {
        ranges: vec![1.0; 360],
        intensities: vec![2.0],
        ..LaserScan::default()
    };
    publish!(out, "/ros/scan", scan);
    let picture = CompressedImage {
        frame: frame(),
        format: "jpeg".to_owned(),
        data: vec![255, 216, 255],
    };
    publish!(out, "/ros/picture", picture);
}

fn publish_robot(out: &mut Writer<BufWriter<File>>) {
    let joints = JointState {
        name: vec!["M3".to_owned(), "M4".to_owned()],
        position: vec![1.0, 2.0],
        ..JointState::default()
    };
    publish!(out, "/ros/joints", joints);
    let battery = BatteryState {
        frame: String::new(),
        voltage: 12.5,
        current: Some(-0.25),
        percentage: None,
    };
    publish!(out, "/ros/battery", battery);
    let place = Odometry {
        frame: "world".to_owned(),
        child_frame: "base".to_owned(),
        position: [1.0, 2.0, 3.0],
        orientation: [0.0, 0.0, 0.6, 0.8],
        linear: [4.0, 5.0, 6.0],
        angular: [7.0, 8.0, 9.0],
    };
    publish!(out, "/ros/odometry", place);
    let transform = Transform {
        frame: "world".to_owned(),
        child_frame: "base".to_owned(),
        translation: [1.0, 2.0, 3.0],
        rotation: [0.0, 0.0, 0.6, 0.8],
    };
    publish!(out, "/ros/tf", Transforms(vec![transform]));
}

/// What every reader has to say of the recording.
const TOLD: &str = "\
/code 1 data=green
/faults 1 name=sensors/A1 msg=device: gone level=40 line=5
/log 1 name=trikfs msg=ready level=20 line=0
/node/raw 1 data=1,2,3,255
/ros/battery 1
/ros/imu 1
/ros/joints 1
/ros/joy 1
/ros/odometry 1
/ros/picture 1
/ros/range 1
/ros/scan 1
/ros/tf 1
/sensors/A1 100 x=-99 x2=99 y=24.75 class=7
";

fn told(command: &mut Command) -> String {
    let output = command.output().expect("the reader starts");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {errors}");
    String::from_utf8(output.stdout).expect("UTF-8")
}

#[test]
fn readers_in_python_decode_every_message_and_make_the_same_bytes_of_it() {
    let Some(python) = std::env::var_os("TRIK_MCAP_PYTHON") else {
        Need::Extra.missing("TRIK_MCAP_PYTHON is not set");
        return;
    };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("all.mcap");
    record(&file);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/readers.py");
    for reader in ["mcap", "rosbags"] {
        let text = told(Command::new(&python).arg(script).arg(reader).arg(&file));
        assert_eq!(text, TOLD, "{reader}");
    }
}

#[test]
fn a_reader_in_javascript_decodes_every_message() {
    let Some(modules) = std::env::var_os("TRIK_MCAP_NODE") else {
        Need::Extra.missing("TRIK_MCAP_NODE is not set");
        return;
    };
    let dir = tempfile::tempdir().unwrap();
    let file = dir.path().join("all.mcap");
    record(&file);
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/readers.js");
    let mut node = Command::new("node");
    node.env("NODE_PATH", modules).arg(script).arg(&file);
    assert_eq!(told(&mut node), TOLD);
}
