//! Standard messages of made-up nodes, read back from the recording that has them.
//!
//! Owns the expected numbers, worked out by hand.

use crate::entry::{Entry, Known};
use crate::pen::Pen;
use crate::standard::rows::ROWS;
use journal::node::Node;
use journal::write::{Out, Writer};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

const BEGIN: u64 = 1_700_000_000_000_000_000;
const MS: u64 = 1_000_000;

/// A recording with standard messages.
struct Scene {
    pen: Pen<Out>,
    out: Out,
    nodes: Vec<Arc<Known>>,
}

/// Messages by their topics: the moment, and what is after the time in the header.
type Had = BTreeMap<String, Vec<(u64, Vec<u8>)>>;

impl Scene {
    /// Of nodes with these paths, formats and units.
    fn new(nodes: &[(&str, &str, &str)]) -> Self {
        let out = Out::default();
        let file = Writer::live(out.clone(), "test").unwrap();
        let mut scene = Self {
            pen: Pen::new(file).with_standard(true),
            out,
            nodes: Vec::new(),
        };
        for (path, format, units) in nodes {
            let mut node = Node::sensor(path, format);
            node.units = (*units).to_owned();
            scene.add(node);
        }
        scene
    }

    fn add(&mut self, node: Node) {
        let number = u32::try_from(self.nodes.len()).unwrap();
        let known = Arc::new(Known { number, node });
        self.pen.put(&Entry::Node(known.clone())).unwrap();
        self.nodes.push(known);
    }

    /// A sample of i32 at so many ms.
    fn sample(&mut self, node: usize, at_ms: u64, numbers: &[i32]) {
        let tuple: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        self.tuple(node, at_ms, &tuple);
    }

    fn floats(&mut self, node: usize, at_ms: u64, numbers: &[f32]) {
        let tuple: Vec<u8> = numbers.iter().flat_map(|n| n.to_le_bytes()).collect();
        self.tuple(node, at_ms, &tuple);
    }

    fn tuple(&mut self, node: usize, at_ms: u64, tuple: &[u8]) {
        let known = self.nodes[node].clone();
        let entry = Entry::Sample(known, BEGIN + at_ms * MS, tuple.into());
        self.pen.put(&entry).unwrap();
    }

    fn fault(&mut self, node: usize, at_ms: u64) {
        let known = self.nodes[node].clone();
        let entry = Entry::Fault(known, BEGIN + at_ms * MS, 19, "gone".into());
        self.pen.put(&entry).unwrap();
    }

    fn settle(&mut self) {
        self.pen.settle(false).unwrap();
    }

    /// The standard messages that were written.
    fn had(mut self) -> Had {
        self.pen.settle(true).unwrap();
        self.pen.file.finish().unwrap();
        let bytes = self.out.take();
        let mut had = Had::new();
        let options = mcap::read::Options::IgnoreEndMagic;
        for message in mcap::MessageStream::new_with_options(&bytes, options.into()).unwrap() {
            let message = message.unwrap();
            let topic = message.channel.topic.clone();
            if topic.starts_with("/ros/") || topic == "/tf" {
                let at_ms = (message.log_time - BEGIN) / MS;
                had.entry(topic)
                    .or_default()
                    .push((at_ms, message.data.to_vec()));
            }
        }
        had
    }
}

/// The numbers at these places of a message, counted after its head of 4 bytes.
fn f64s<const N: usize>(message: &[u8], at: usize) -> [f64; N] {
    std::array::from_fn(|one| {
        let begin = 4 + at + 8 * one;
        f64::from_le_bytes(message[begin..begin + 8].try_into().unwrap())
    })
}

fn f32s<const N: usize>(message: &[u8], at: usize) -> [f32; N] {
    std::array::from_fn(|one| {
        let begin = 4 + at + 4 * one;
        f32::from_le_bytes(message[begin..begin + 4].try_into().unwrap())
    })
}

fn near(a: &[f64], b: &[f64]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-6)
}

#[test]
fn a_distance_is_a_range_in_metres_and_none_without_an_echo_or_a_unit() {
    let mut scene = Scene::new(&[
        ("sensors/D1", "i32 distance", "cm"),
        ("sensors/D2", "i32 distance", "furlongs"),
        ("sensors/A5", "i32 darkness", "%"),
    ]);
    scene.sample(0, 0, &[25]);
    scene.sample(0, 20, &[0]);
    scene.sample(0, 40, &[-1]);
    scene.sample(1, 40, &[7]);
    scene.sample(2, 40, &[7]);
    let had = scene.had();
    assert_eq!(had.keys().collect::<Vec<_>>(), ["/ros/sensors/D1"]);
    let ranges = &had["/ros/sensors/D1"];
    assert_eq!(ranges.len(), 1);
    // Time, 4 bytes of length, "sensors/D1" with its end; the kind, then floats from a multiple of 4.
    let message = &ranges[0].1;
    assert_eq!(message[4 + 23], 0, "ultrasound");
    let [view, least, most, range] = f32s(message, 24);
    assert_eq!((view, least, most, range), (0.0, 0.0, f32::INFINITY, 0.25));
}

#[test]
fn a_turn_is_an_imu_with_the_last_acceleration_while_that_is_there() {
    let mut scene = Scene::new(&[
        ("accelerometer", "i32 x, i32 y, i32 z", "mg"),
        ("gyroscope", "i32 x, i32 y, i32 z", "mdeg/s"),
    ]);
    scene.sample(1, 0, &[0, 0, 90_000]);
    scene.sample(0, 10, &[0, 0, 1000]);
    scene.sample(1, 20, &[0, 0, 90_000]);
    scene.sample(1, 200, &[0, 0, 90_000]);
    scene.sample(0, 210, &[0, 0, 1000]);
    scene.fault(0, 220);
    scene.sample(1, 230, &[0, 0, 90_000]);
    let had = scene.had();
    let imus = &had["/ros/imu"];
    let times: Vec<u64> = imus.iter().map(|(at, _)| *at).collect();
    assert_eq!(times, [20]);
    // Time, 4 bytes of length, "imu" with its end, then doubles: 4 of the orientation, 9 of its covariance.
    let message = &imus[0].1;
    assert_eq!(f64s::<1>(message, 16 + 32), [-1.0], "no orientation");
    let rates = f64s::<3>(message, 16 + 32 + 72);
    assert!(
        near(&rates, &[0.0, 0.0, std::f64::consts::FRAC_PI_2]),
        "{rates:?}"
    );
    let forces = f64s::<3>(message, 16 + 32 + 72 + 24 + 72);
    assert!(near(&forces, &[0.0, 0.0, 9.806_65]), "{forces:?}");
}

#[test]
fn two_gyroscopes_of_a_group_are_no_imu_and_each_group_has_its_own() {
    let vector = "i32 x, i32 y, i32 z";
    let mut scene = Scene::new(&[
        ("a/accelerometer", vector, "mg"),
        ("a/gyroscope", vector, "mdeg/s"),
        ("a/gyroscope2", vector, "mdeg/s"),
        ("b/accelerometer", vector, "m/s2"),
        ("b/gyroscope", vector, "rad/s"),
    ]);
    for node in [0, 1, 2, 3, 4] {
        scene.sample(node, 10, &[1, 2, 3]);
    }
    assert_eq!(scene.had().keys().collect::<Vec<_>>(), ["/ros/b/imu"]);
}

#[test]
fn joints_of_one_look_are_one_message_and_those_without_a_value_are_left_out() {
    let mut scene = Scene::new(&[
        ("encoders/E3", "i32 position", "deg"),
        ("encoders/E4", "i32 position", "deg"),
        ("motors/M1", "i32 duty_cycle", "%"),
        ("motors/M2", "i32 speed", "deg/s"),
    ]);
    let mut servo = Node::sensor("servos/S1", "i32 position");
    (servo.units, servo.rest) = ("deg".to_owned(), "-2147483648".to_owned());
    scene.add(servo);
    scene.sample(4, 0, &[90]);
    scene.sample(0, 1, &[180]);
    scene.sample(1, 2, &[360]);
    scene.sample(2, 2, &[50]);
    scene.settle();
    // Too early for the next.
    scene.sample(0, 5, &[181]);
    scene.settle();
    // A servo that is off has no angle, and what is not sampled any more has none either.
    scene.sample(4, 1100, &[i32::MIN]);
    scene.sample(1, 1100, &[-360]);
    scene.settle();
    let had = scene.had();
    assert_eq!(had.keys().collect::<Vec<_>>(), ["/ros/joint_states"]);
    let states = &had["/ros/joint_states"];
    let sizes: Vec<(u64, usize)> = (states.iter()).map(|(at, m)| (*at, m.len())).collect();
    assert_eq!(sizes.len(), 2, "{sizes:?}");
    assert_eq!((sizes[0].0, sizes[1].0), (2, 1100));
    let text = String::from_utf8_lossy(&states[0].1);
    for name in ["encoders/E3", "encoders/E4", "servos/S1"] {
        assert!(text.contains(name));
    }
    // Its positions are followed by two empty lists.
    let end = states[0].1.len() - 4 - 8 - 24;
    let positions = f64s::<3>(&states[0].1, end);
    let pi = std::f64::consts::PI;
    assert!(near(&positions, &[pi, 2.0 * pi, pi / 2.0]), "{positions:?}");
    let text = String::from_utf8_lossy(&states[1].1);
    assert!(
        text.contains("E4") && !text.contains("E3") && !text.contains("S1"),
        "{text}"
    );
}

#[test]
fn a_gamepad_is_a_joy_when_all_of_it_has_a_value() {
    let pad = "i32 x, i32 y, i32 touched";
    let mut scene = Scene::new(&[
        ("gamepad/buttons", "i32 b1, i32 b2", ""),
        ("gamepad/pad1", pad, ""),
        ("gamepad/text", "text 64", ""),
    ]);
    scene.sample(0, 0, &[1, 0]);
    scene.settle();
    scene.sample(1, 20, &[-50, 100, 1]);
    scene.settle();
    scene.sample(1, 40, &[-50, 101, 1]);
    scene.settle();
    let had = scene.had();
    let joys = &had["/ros/gamepad"];
    assert_eq!(joys.len(), 1);
    // Time, 4 bytes of length, "gamepad" with its end; a count before each list.
    let message = &joys[0].1;
    assert_eq!(f32s::<2>(message, 20 + 4), [-0.5, 1.0]);
    assert_eq!(
        message[4 + 20 + 12..],
        [3, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0]
    );
}

#[test]
fn distances_clockwise_are_a_scan_counter_clockwise() {
    let format: Vec<String> = (0..8).map(|at| format!("i32 d{at}")).collect();
    let mut scene = Scene::new(&[("lidar", &format.join(", "), "mm")]);
    scene.sample(0, 0, &[1000, 2000, 0, 4000, 5000, 6000, 7000, 8000]);
    let had = scene.had();
    let message = &had["/ros/lidar"][0].1;
    // Time, 4 bytes of length, "lidar" with its end, a filler of 2.
    let [least, most, step] = f32s::<3>(message, 20);
    assert_eq!(least, 0.0);
    assert!((step - std::f32::consts::FRAC_PI_4).abs() < 1e-6 && (most - 7.0 * step).abs() < 1e-5);
    let ranges = f32s::<8>(message, 20 + 28 + 4);
    assert_eq!(ranges[..6], [1.0, 8.0, 7.0, 6.0, 5.0, 4.0]);
    assert!(ranges[6].is_nan());
    assert_eq!(ranges[7], 2.0);
}

#[test]
fn a_place_is_a_transform_and_from_the_second_on_an_odometry_with_its_speed() {
    let format = "f32 x, f32 y, f32 heading";
    let mut scene = Scene::new(&[
        ("odometry", format, ""),
        ("pose", "f32 x, f32 y, f32 theta", "m, rad"),
        ("other", format, ""),
    ]);
    scene.floats(0, 0, &[0.0, 0.0, 90.0]);
    scene.floats(0, 100, &[0.0, 50.0, 90.0]);
    // After a pause nobody knows a speed.
    scene.floats(0, 5000, &[0.0, 60.0, 90.0]);
    scene.floats(1, 5000, &[1.0, 2.0, 0.0]);
    scene.floats(2, 5000, &[1.0, 2.0, 0.0]);
    let had = scene.had();
    assert_eq!(had.keys().collect::<Vec<_>>(), ["/ros/odometry", "/tf"]);
    assert_eq!(had["/tf"].len(), 4);
    let places = &had["/ros/odometry"];
    assert_eq!(places.len(), 1);
    // Time, "odom" and "base_link" with lengths and ends: 8 + 9 filled to 12, 4 + 10; doubles from 40.
    let message = &places[0].1;
    let place = f64s::<7>(message, 40);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    assert!(
        near(&place, &[0.0, 0.05, 0.0, 0.0, 0.0, half, half]),
        "{place:?}"
    );
    let speed = f64s::<6>(message, 40 + 56 + 288);
    assert!(near(&speed, &[0.5, 0.0, 0.0, 0.0, 0.0, 0.0]), "{speed:?}");
}

#[test]
fn a_voltage_is_a_battery_and_a_picture_is_its_file() {
    let mut scene = Scene::new(&[
        ("battery", "f64 voltage", "V"),
        ("camera/picture", "u8 x 12", ""),
    ]);
    scene.tuple(0, 0, &7.5_f64.to_le_bytes());
    scene.tuple(0, 10, &f64::NAN.to_le_bytes());
    scene.tuple(0, 20, &(-1.0_f64).to_le_bytes());
    scene.tuple(1, 0, b"\xff\xd8\xff\x01\x02\xff\xd9\0\0\0\0\0");
    scene.tuple(1, 10, b"\xff\xd8\xff\x01\x02\x03\0\0\0\0\0\0");
    scene.tuple(1, 20, b"hello, world");
    let had = scene.had();
    assert_eq!(had["/ros/battery"].len(), 1);
    assert_eq!(f32s::<1>(&had["/ros/battery"][0].1, 20), [7.5]);
    let pictures = &had["/ros/camera/picture"];
    assert_eq!(pictures.len(), 1);
    assert!(
        pictures[0]
            .1
            .ends_with(b"\x07\0\0\0\xff\xd8\xff\x01\x02\xff\xd9")
    );
}

#[test]
fn a_node_of_another_format_is_what_it_is_now() {
    let mut scene = Scene::new(&[("encoders/E1", "i32 position", "deg")]);
    scene.sample(0, 0, &[1]);
    scene.settle();
    let mut other = Node::sensor("encoders/E1", "i32 distance");
    other.units = "m".to_owned();
    scene.add(other);
    scene.sample(1, 20, &[2]);
    scene.settle();
    let had = scene.had();
    assert_eq!(had["/ros/joint_states"].len(), 1);
    assert_eq!(had["/ros/encoders/E1"].len(), 1);
}

#[test]
fn a_recording_without_them_has_the_messages_of_the_nodes_alone() {
    let mut scene = Scene::new(&[]);
    scene.pen = Pen::new(Writer::live(scene.out.clone(), "test").unwrap());
    scene.out.take();
    let mut node = Node::sensor("sensors/D1", "i32 distance");
    node.units = "cm".to_owned();
    scene.add(node);
    scene.sample(0, 0, &[25]);
    let bytes = scene.out.take();
    let has = |text: &[u8]| bytes.windows(text.len()).any(|part| part == text);
    assert!(has(b"SensorsD1") && !has(b"sensor_msgs"));
}

#[test]
fn the_document_has_every_row_and_no_other() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/user/journal.md");
    let document = std::fs::read_to_string(path).unwrap();
    let told = document.lines().filter_map(|line| {
        let mut cells = line.strip_prefix("| `/")?.split(" | ");
        let topic = cells.next()?.trim_matches('`');
        let kind = cells.next()?.trim_matches('`').rsplit('/').next()?;
        Some((format!("/{topic}"), kind.to_owned()))
    });
    let told: BTreeSet<(String, String)> = told.collect();
    let rows = ROWS.iter().map(|row| (row.topic, row.message));
    let with_transforms = rows.chain([("/tf", "TFMessage")]);
    let known = with_transforms.map(|(topic, kind)| (topic.to_owned(), kind.to_owned()));
    assert_eq!(told, known.collect());
}
