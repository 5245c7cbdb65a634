//! Tests of the standard messages: their bytes are those that another implementation makes.
//!
//! `vectors.txt` was made by rosbags with its types of Jazzy; `journal/tests/readers.rs` asks it again where it is installed.

use super::*;

/// 1700000000.25 s.
const MOMENT: u64 = 1_700_000_000_250_000_000;

fn same<M: Message>(message: &M) {
    let bytes = encode(message, MOMENT);
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    let mut lines = include_str!("vectors.txt").lines();
    let wanted = lines.find_map(|line| line.strip_prefix(M::NAME)?.strip_prefix(' '));
    assert_eq!(Some(hex.as_str()), wanted, "{}", M::NAME);
}

fn front() -> String {
    "front".to_owned()
}

#[test]
fn sensors_are_the_bytes_of_another_implementation() {
    same(&Range {
        frame: front(),
        radiation: Radiation::Infrared,
        field_of_view: 0.5,
        min_range: 0.1,
        max_range: 0.8,
        range: 0.25,
        variance: 0.5,
    });
    same(&Imu {
        frame: front(),
        orientation: None,
        angular_velocity: [0.1, 0.2, 0.3],
        linear_acceleration: [1.0, 2.0, 9.81],
    });
    same(&LaserScan {
        frame: front(),
        angle_min: 0.0,
        angle_max: 1.0,
        angle_increment: 0.5,
        time_increment: 0.001,
        scan_time: 0.1,
        range_min: 0.1,
        range_max: 8.0,
        ranges: vec![1.0, 2.0, 3.0],
        intensities: Vec::new(),
    });
    same(&CompressedImage {
        frame: front(),
        format: "jpeg".to_owned(),
        data: vec![255, 216, 255],
    });
    same(&Joy {
        frame: front(),
        axes: vec![0.5, -1.0],
        buttons: vec![1, 0, 1],
    });
}

#[test]
fn the_robot_is_the_bytes_of_another_implementation() {
    same(&JointState {
        frame: front(),
        name: vec!["M3".to_owned(), "M4".to_owned()],
        position: vec![1.0, 2.0],
        velocity: Vec::new(),
        effort: vec![30.0, -30.0],
    });
    same(&BatteryState {
        frame: front(),
        voltage: 12.5,
        current: None,
        percentage: Some(0.75),
    });
    same(&Odometry {
        frame: front(),
        child_frame: "base".to_owned(),
        position: [1.0, 2.0, 3.0],
        orientation: [0.0, 0.0, 0.6, 0.8],
        linear: [4.0, 5.0, 6.0],
        angular: [7.0, 8.0, 9.0],
    });
    let base = Transform {
        frame: front(),
        child_frame: "base".to_owned(),
        translation: [1.0, 2.0, 3.0],
        rotation: [0.0, 0.0, 0.6, 0.8],
    };
    same(&Transforms(vec![base.clone(), base]));
}
