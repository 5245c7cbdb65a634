//! Sensors that deliver by themselves: events, IIO samples, lines of text, packets of the lidar.

use super::run::{Robot, robot};

fn numbers(values: &[i32]) -> Vec<u8> {
    values
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

#[test]
fn an_ultrasonic_sensor_without_an_echo_gives_no_number() {
    let mut robot = robot("{ port = 'D2', median3 = false }");
    let none = "ETIMEDOUT: no echo: nothing in reach";
    let or = "nothing is plugged into D1";
    assert_eq!(
        robot.read("sensors/D1", &numbers(&[25, 1455])),
        Ok("25".into())
    );
    assert_eq!(
        robot.read("sensors/D2", &numbers(&[-1, 0])),
        Err(none.to_owned()),
        "named in the robot file"
    );
    assert_eq!(
        robot.read("sensors/D1", &numbers(&[-1, 0])),
        Err(format!("{none}, or {or}"))
    );
    assert_eq!(
        robot.read("sensors/D1", &numbers(&[300, 17000])),
        Ok("25".into()),
        "median"
    );
    assert_eq!(
        robot.read("sensors/D1", &numbers(&[26, 1500])),
        Ok("26".into())
    );
    assert_eq!(
        robot.read("sensors/D2", &numbers(&[25, 1455])),
        Ok("25".into())
    );
    assert_eq!(
        robot.read("sensors/D2", &numbers(&[300, 17000])),
        Ok("300".into()),
        "no median"
    );
}

#[test]
fn keys_are_one_while_they_are_pressed() {
    let mut robot = robot("");
    let value = robot.read("keys", &numbers(&[0, 1, 0, 2, 0, 0, 1]));
    assert_eq!(value, Ok("0 1 0 1 0 0 1".into()));
    let format = format!("{:?}", robot.node("keys").format);
    let order = ["power", "up", "esc", "left", "right", "down", "enter"];
    let places: Vec<_> = order
        .iter()
        .map(|key| format.find(&format!("\"{key}\"")))
        .collect();
    assert!(
        places.iter().all(Option::is_some) && places.is_sorted(),
        "{format}"
    );
}

/// 10 ms from sample to sample; a time in ns that needs all 64 bits, across a carry of the lower half.
fn gyro(chip: i32, axes: [i32; 3], step: u64) -> Vec<u8> {
    let time = (405u64 << 32) - 50_000_000 + step * 10_000_000;
    let mut bytes = numbers(&[chip, axes[0], axes[1], axes[2]]);
    bytes.extend(time.to_le_bytes());
    bytes
}

fn accelerometer(axes: [i32; 3]) -> Vec<u8> {
    let mut bytes = numbers(&axes);
    bytes.extend(0u64.to_le_bytes());
    bytes
}

#[test]
fn the_gyroscope_gives_rates_without_the_bias_it_had_at_rest() {
    let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
    let rest = [11, -22, 33];
    for step in 0..10 {
        let value = robot.read("gyroscope", &gyro(1, rest, step));
        assert_eq!(value, Ok("nothing".into()), "{step}");
    }
    assert_eq!(
        robot.read("gyroscope", &gyro(1, rest, 10)),
        Ok("0 0 0".into())
    );
    // L3GD20: X' = -y, Y' = -x, Z' = z. 100 counts are 875 mdeg/s.
    assert_eq!(
        robot.read("gyroscope", &gyro(1, [111, -22, 33], 11)),
        Ok("0 -875 0".into())
    );
    assert_eq!(
        robot.read("gyroscope", &gyro(1, [11, 78, 33], 12)),
        Ok("-875 0 0".into())
    );
    assert_eq!(
        robot.read("gyroscope", &gyro(1, [11, -22, 34], 13)),
        Ok("0 0 9".into())
    );
    assert_eq!(
        robot.read("gyroscope", &gyro(1, rest, 13)),
        Ok("nothing".into()),
        "the same sample"
    );
}

#[test]
fn the_other_chip_has_other_axes_and_a_known_bias_needs_no_rest() {
    let mut robot = robot("{ port = 'gyroscope', bias = { 10, 20, 30 } }");
    assert_eq!(
        robot.read("gyroscope", &gyro(2, [0; 3], 0)),
        Ok("nothing".into())
    );
    // L3GD20H: X' = x, Y' = -y, Z' = z; the bias is that of the turned axes.
    let value = robot.read("gyroscope", &gyro(2, [10, -20, 130], 1));
    assert_eq!(value, Ok("0 0 875".into()));
    let value = robot.read("gyroscope", &gyro(2, [14, -24, 30], 2));
    assert_eq!(value, Ok("35 35 0".into()));
}

#[test]
fn a_gyroscope_that_is_moved_from_the_start_is_not_calibrated() {
    // Shaken, and in a steady turn: 1144 counts are faster than any chip shows at rest.
    for rates in [[5000, -5000], [1144, 1144], [-1144, -1144]] {
        let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
        let mut faults = 0;
        for (step, rate) in (0..40).zip(rates.into_iter().cycle()) {
            match robot.read("gyroscope", &gyro(1, [0, 0, rate], step)) {
                Ok(value) => assert_eq!(value, "nothing"),
                Err(fault) => {
                    assert_eq!(
                        fault,
                        "EIO: not calibrated yet: let the robot stand still for 100 ms"
                    );
                    faults += 1;
                }
            }
        }
        assert_eq!(faults, 3, "{rates:?}");
    }
}

/// 40 counts are 350 mdeg/s. The bias follows by 1 count in a second: 0.1 after each window of 100 ms.
#[test]
fn a_bias_that_drifts_is_followed_slowly_and_a_turn_is_none() {
    let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
    let mut read = |z, steps: std::ops::Range<u64>| {
        let mut last = String::new();
        for step in steps {
            last = robot.read("gyroscope", &gyro(1, [0, 0, z], step)).unwrap();
        }
        last
    };
    assert_eq!(read(0, 0..12), "0 0 0");
    assert_eq!(read(40, 12..15), "0 0 350");
    // Ten windows are 1 of the 40 counts.
    assert_eq!(read(40, 15..112), "0 0 341", "a creep for a second");
    assert_eq!(read(0, 112..113), "0 0 -9");
    assert_eq!(read(0, 113..300), "0 0 0", "it has come back");
    assert_eq!(read(-40, 300..4400), "0 0 0", "40 seconds of drift");
    assert_eq!(
        read(2000, 4400..4540),
        "0 0 17850",
        "a steady turn stays one"
    );
}

/// Calibrates at rest, then turns for a second around one axis of the runtime's. Gives the last value.
fn turned(robot: &mut Robot, path: &str, gravity: [i32; 3], raw: [i32; 3]) -> String {
    let mut last = String::new();
    for step in 0..=110 {
        let axes = if step > 10 { raw } else { [0; 3] };
        let mut bytes = gyro(1, axes, step);
        bytes.extend(accelerometer(gravity));
        last = robot.read(path, &bytes).unwrap();
        // The accelerometer delivers as well; that is no new sample of the gyroscope.
        assert_eq!(robot.read(path, &bytes), Ok("nothing".into()));
    }
    last
}

#[test]
fn heading_and_tilt_are_the_turns_since_the_calibration() {
    // 10286 counts are 90.0025 degrees in a second.
    let flat = [0, 0, 4096];
    let cases = [
        ("gyroscope/heading", [0, 0, 10286], "-90003"),
        ("gyroscope/heading", [0, 0, -10286], "90003"),
        ("gyroscope/heading", [0, -5143, 0], "0"),
        ("gyroscope/tilt", [0, -5143, 0], "45001 0"),
        ("gyroscope/tilt", [-5143, 0, 0], "0 45001"),
        ("gyroscope/tilt", [0, 0, 10286], "0 0"),
    ];
    for (path, raw, expected) in cases {
        let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
        let last = turned(&mut robot, path, flat, raw);
        let near =
            |a: &str, b: &str| (a.parse::<i32>().unwrap() - b.parse::<i32>().unwrap()).abs() <= 2;
        let all = last
            .split(' ')
            .zip(expected.split(' '))
            .all(|(a, b)| near(a, b));
        assert!(
            all && last.split(' ').count() == expected.split(' ').count(),
            "{path} {raw:?}: {last}"
        );
    }
}

#[test]
fn a_tilt_at_the_start_is_seen_by_the_accelerometer() {
    let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
    // Gravity along y and z alike: 45 degrees around x.
    let last = turned(&mut robot, "gyroscope/tilt", [0, 2896, 2896], [0; 3]);
    assert_eq!(last, "45000 0");
}

#[test]
fn lost_samples_begin_the_angles_anew() {
    let mut robot = robot("{ port = 'gyroscope', calibration_ms = 100 }");
    turned(&mut robot, "gyroscope/heading", [0, 0, 4096], [0, 0, 1000]);
    let mut bytes = gyro(1, [0; 3], 200);
    bytes.extend(accelerometer([0, 0, 4096]));
    let lost = robot.read("gyroscope/heading", &bytes);
    assert_eq!(
        lost,
        Err("EIO: no samples for 900 ms: the angles begin anew".into())
    );
    // The bias is that of before: a steady turn is a turn at once, here of 875 mdeg to the left in each 10 ms.
    for step in 0..3i32 {
        let mut bytes = gyro(1, [0, 0, 10_000], 201 + step as u64);
        bytes.extend(accelerometer([0, 0, 4096]));
        let heading = robot.read("gyroscope/heading", &bytes);
        assert_eq!(heading, Ok((-875 * (step + 1)).to_string()), "{step}");
    }
}

#[test]
fn the_accelerometer_is_in_thousandths_of_g() {
    let mut robot = robot("");
    let value = robot.read("accelerometer", &accelerometer([4096, -2048, 1]));
    assert_eq!(value, Ok("1000 -500 0".into()));
}

fn line(text: &str) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(128, 0);
    bytes
}

#[test]
fn lines_of_the_camera_become_numbers() {
    let mut robot = robot("{ port = 'camera', rows = 1, columns = 2 }");
    assert_eq!(
        robot.read("camera/line", &line("loc: -12 0 35")),
        Ok("-12 0 35".into())
    );
    assert_eq!(
        robot.read("camera/object", &line("loc: 100 -100 4")),
        Ok("100 -100 4".into())
    );
    assert_eq!(
        robot.read("camera/color", &line("color: 16711680 255")),
        Ok("16711680 255".into())
    );
    assert_eq!(
        robot.read("camera/line", &line("hsv: 1 2 3 4 5 6")),
        Ok("nothing".into())
    );
    assert_eq!(
        robot.read("camera/line/hsv", &line("hsv: 1 2 3 4 5 6")),
        Ok("1 2 3 4 5 6".into())
    );
    assert_eq!(
        robot.read("camera/line/hsv", &line("loc: 1 2 3")),
        Ok("nothing".into())
    );
    for wrong in [
        "loc: 1 2",
        "loc: 1 2 3 4",
        "loc: 101 0 0",
        "loc: 0 -101 0",
        "loc:",
    ] {
        assert!(robot.read("camera/line", &line(wrong)).is_err(), "{wrong}");
    }
    for other in ["", "loc: 1 2 x", "loc: 1 2 99999999999999", "log: 1 2 3"] {
        assert_eq!(
            robot.read("camera/line", &line(other)),
            Ok("nothing".into()),
            "{other}"
        );
    }
    for wrong in [
        "color: 1",
        "color: 1 2 3",
        "color: -1 0",
        "color: 16777216 0",
    ] {
        assert!(robot.read("camera/color", &line(wrong)).is_err(), "{wrong}");
    }
}

#[test]
fn commands_to_the_camera_are_lines() {
    let mut robot = robot("");
    assert_eq!(
        robot.write("camera/line/detect", &[1.0]),
        Ok(line("detect"))
    );
    assert_eq!(
        robot.write("camera/line/video_out", &[0.0]),
        Ok(line("video_out 0"))
    );
    let hsv = [20.0, 5.0, 90.0, 10.0, 80.0, 20.0];
    assert_eq!(
        robot.write("camera/object/hsv", &hsv),
        Ok(line("hsv 20 5 90 10 80 20"))
    );
    assert_eq!(
        robot.write("camera/color/mxn", &[3.0, 2.0]),
        Ok(line("mxn 3 2"))
    );
    assert_eq!(
        robot.write("camera/color/mxn", &[4.0, 2.0]),
        Err("ERANGE: rows is 1 to 3, not 4".into())
    );
    assert_eq!(
        robot.write("camera/line/detect", &[0.0]),
        Err("ERANGE: detect is 1 to 1, not 0".into())
    );
}

/// Converters of several nodes are bound in one state, some of them after it was compiled and made smaller: LuaJIT's
/// tables for foreign types had been freed by then, and the process died.
#[test]
fn lines_of_the_gamepad_become_its_state() {
    let mut robot = robot("");
    let mut state = |path: &str, text: &str| robot.read(path, &line(text)).unwrap();
    assert_eq!(state("gamepad/pad1", "keepalive 5000"), "0 0 0");
    assert_eq!(state("gamepad/pad1", "pad 1 -50 100"), "-50 100 1");
    assert_eq!(state("gamepad/pad1", "pad 2 1 1"), "-50 100 1");
    assert_eq!(
        state("gamepad/pad1", "pad 1 500 0"),
        "-50 100 1",
        "out of range"
    );
    assert_eq!(state("gamepad/pad1", "pad 1 x"), "-50 100 1", "half a line");
    assert_eq!(state("gamepad/pad1", "pad 1 up"), "0 0 0");
    assert_eq!(state("gamepad/pad2", "pad 2 7 8"), "7 8 1");
    assert_eq!(state("gamepad/wheel", "wheel -100"), "-100");
    assert_eq!(state("gamepad/wheel", "wheel 101"), "-100");
    assert_eq!(state("gamepad/buttons", "btn 2 down"), "0 1 0 0 0");
    assert_eq!(state("gamepad/buttons", "btn 5"), "0 1 0 0 1");
    assert_eq!(state("gamepad/buttons", "btn 2 up"), "0 0 0 0 1");
    assert_eq!(state("gamepad/buttons", "btn 6"), "0 0 0 0 1");
    assert_eq!(state("gamepad/buttons/presses", "btn 1"), "1 0 0 0 0");
    assert_eq!(state("gamepad/buttons/presses", "btn 1 up"), "1 0 0 0 0");
    assert_eq!(state("gamepad/buttons/presses", "btn 1 down"), "2 0 0 0 0");
}

/// A packet of the lidar that begins at an angle in hundredths of a degree; distances in quarters of mm.
fn packet(start: u16, quarters: &[u16]) -> Vec<u8> {
    let data = 5 + 3 * quarters.len() as u16;
    let mut bytes = vec![0xaa];
    bytes.extend((data + 8).to_be_bytes());
    bytes.extend([0x01, 0x61, 0xad]);
    bytes.extend(data.to_be_bytes());
    bytes.extend([0x7b, 0, 0]);
    bytes.extend(start.to_be_bytes());
    for distance in quarters {
        bytes.push(20);
        bytes.extend(distance.to_be_bytes());
    }
    let sum = bytes
        .iter()
        .fold(0u16, |sum, byte| sum.wrapping_add(u16::from(*byte)));
    bytes.extend(sum.to_be_bytes());
    bytes.resize(1024, 0);
    bytes
}

#[test]
fn sixteen_packets_of_the_lidar_are_360_distances() {
    let mut robot = robot("{ port = 'lidar' }");
    // 90 probes for 22.5 degrees: four in each degree. The first revolution may have begun in the middle.
    let probes: Vec<u16> = [1000, 4000, 2000, 40000].repeat(23)[..90].to_vec();
    for turn in 0..2 {
        for part in 0..16u16 {
            let value = robot.read("lidar", &packet(part * 2250, &probes)).unwrap();
            assert_eq!(value, "nothing", "{turn} {part}");
        }
    }
    let value = robot.read("lidar", &packet(0, &probes)).unwrap();
    let distances: Vec<u32> = value.split(' ').map(|mm| mm.parse().unwrap()).collect();
    assert_eq!(distances.len(), 360);
    // Of 250, 1000, 500 and 10000 mm the least and the greatest go: (1000 + 500) / 2.
    assert_eq!(distances[0], 750);
    assert_eq!(distances[21], 750);
    // 22.5 degrees is the border: two probes of this packet and two of the next in one degree.
    assert_eq!(distances[22], 625);
    assert!(
        distances.iter().all(|mm| [750, 625].contains(mm)),
        "{distances:?}"
    );
}

#[test]
fn what_the_lidar_did_not_see_is_zero_and_wrong_packets_do_no_harm() {
    let mut robot = robot("{ port = 'lidar' }");
    for start in [0, 2250, 0] {
        assert_eq!(
            robot.read("lidar", &packet(start, &[400; 90])),
            Ok("nothing".into())
        );
    }
    let value = robot.read("lidar", &packet(0, &[0; 90]));
    assert_eq!(value, Ok("nothing".into()), "the same place is no new turn");
    robot.read("lidar", &packet(35_900, &[800, 800])).unwrap();
    let value = robot.read("lidar", &packet(10, &[])).unwrap();
    let distances: Vec<&str> = value.split(' ').collect();
    assert_eq!(
        (distances[0], distances[22], distances[23], distances[359]),
        ("100", "100", "0", "200")
    );
    // The second probe of that packet lies beyond the circle.
    assert_eq!(distances[10], "100");
    let mut other = packet(0, &[]);
    other[5] = 0xae;
    assert_eq!(robot.read("lidar", &other), Ok("nothing".into()));
    let mut long = packet(0, &[1; 3]);
    long[7] = 200;
    assert_eq!(
        robot.read("lidar", &long),
        Err("EIO: the packet contradicts itself".into())
    );
    let beyond = robot.read("lidar", &packet(36_000, &[1]));
    assert_eq!(beyond, Err("EIO: the packet begins at 360 degrees".into()));
}
