//! What the coprocessor measures: analog ports, battery, encoders, and the infrared camera on the other bus.

use super::run::robot;

fn word(raw: u16) -> [u8; 2] {
    raw.to_le_bytes()
}

#[test]
fn the_registers_are_those_of_the_board() {
    let robot = robot("");
    let registers = [
        ("motors/M1", 0x14),
        ("motors/M2", 0x15),
        ("motors/M3", 0x16),
        ("motors/M4", 0x17),
        ("encoders/E1", 0x30),
        ("encoders/E2", 0x31),
        ("encoders/E3", 0x33),
        ("encoders/E4", 0x32),
        ("sensors/A1", 0x25),
        ("sensors/A2", 0x24),
        ("sensors/A3", 0x23),
        ("sensors/A4", 0x22),
        ("sensors/A5", 0x21),
        ("sensors/A6", 0x20),
        ("battery", 0x26),
    ];
    for (path, register) in registers {
        let source = format!("{:?}", robot.node(path).source);
        for part in [
            "/dev/i2c-2",
            "address: 72,",
            &format!("register: {register},"),
        ] {
            assert!(source.contains(part), "{path}: {source}");
        }
    }
}

#[test]
fn an_encoder_turns_ticks_into_degrees_without_overflow() {
    let mut robot = robot("{ port = 'E4', type = 'encoder126' }");
    // 100 degrees are 157 ticks; parts of a degree are cut towards zero; E1 and E3 count backwards.
    let cases = [
        (0, 0),
        (157, 100),
        (-157, -100),
        (1, 0),
        (2, 1),
        (-3, -1),
        (21_474_837, 13_678_240),
        (i32::MAX, 1_367_823_978),
        (i32::MIN, -1_367_823_979),
    ];
    for (ticks, degrees) in cases {
        let bytes = ticks.to_le_bytes();
        assert_eq!(
            robot.read("encoders/E2", &bytes),
            Ok(format!("{degrees}")),
            "{ticks}"
        );
        assert_eq!(
            robot.read("encoders/E1", &bytes),
            Ok(format!("{}", -degrees)),
            "{ticks}"
        );
        assert_eq!(
            robot.read("encoders/E3", &bytes),
            Ok(format!("{}", -degrees)),
            "{ticks}"
        );
        assert_eq!(
            robot.read("encoders/E1/raw", &bytes),
            Ok(format!("{ticks}"))
        );
    }
    assert_eq!(
        robot.read("encoders/E4", &3296i32.to_le_bytes()),
        Ok("1000".into())
    );
    assert_eq!(
        robot.read("encoders/E4", &(-33i32).to_le_bytes()),
        Ok("-10".into())
    );
    // 2147483647 * 1000 / 3296
    assert_eq!(
        robot.read("encoders/E4", &i32::MAX.to_le_bytes()),
        Ok("651542368".into())
    );
}

#[test]
fn an_encoder_can_only_be_set_to_zero() {
    let mut robot = robot("");
    assert_eq!(robot.write("encoders/E1", &[0.0]), Ok(vec![0; 4]));
    for wrong in [1.0, -1.0, 90.0] {
        let reason = format!("EINVAL: an encoder can only be set to 0, not to {wrong}");
        assert_eq!(robot.write("encoders/E1", &[wrong]), Err(reason));
    }
}

#[test]
fn each_analog_type_converts_as_the_runtime_does() {
    let mut robot = robot(
        "{ port = 'A1', type = 'sharpGP2' }, { port = 'A2' }, { port = 'A3', type = 'touchSensor' },
         { port = 'A5', type = 'light' }",
    );
    let cases = [
        // 8697 / raw - 2, cut; no signal is 0.
        ("A1", 511, "15"),
        ("A1", 322, "25"),
        ("A1", 235, "35"),
        ("A1", 1023, "6"),
        ("A1", 0, "0"),
        ("A1", 1, "8695"),
        ("A2", 0, "0"),
        ("A2", 1023, "100"),
        ("A2", 512, "50"),
        ("A2", 1022, "99"),
        ("A2", 10, "0"),
        ("A2", 11, "1"),
        ("A3", 0, "1"),
        ("A3", 100, "1"),
        ("A3", 101, "0"),
        ("A3", 1023, "0"),
        ("A5", 0, "-3"),
        ("A5", 30, "0"),
        ("A5", 1023, "100"),
        ("A5", 526, "49"),
        ("A5", 39, "0"),
        ("A5", 40, "1"),
    ];
    for (port, raw, expected) in cases {
        let value = robot.read(&format!("sensors/{port}"), &word(raw));
        assert_eq!(value, Ok(expected.into()), "{port} at {raw}");
        assert_eq!(
            robot.read(&format!("sensors/{port}/raw"), &word(raw)),
            Ok(raw.to_string())
        );
    }
}

#[test]
fn more_than_ten_bits_are_a_failure_and_no_number() {
    let mut robot = robot("");
    for path in ["sensors/A1", "sensors/A1/raw", "battery", "battery/raw"] {
        let failed = robot.read(path, &word(0xffff));
        assert_eq!(
            failed,
            Err("EIO: the coprocessor gave 65535, more than ten bits".into())
        );
    }
}

#[test]
fn the_points_of_a_sharp_sensor_may_be_measured_anew() {
    let mut robot =
        robot("{ port = 'A1', type = 'sharpGP2', points = { {10, 600}, {20, 300}, {30, 200} } }");
    // On 6000 / raw exactly: offset and shift are 0.
    for (raw, cm) in [(600, "10"), (300, "20"), (200, "30"), (100, "60")] {
        assert_eq!(robot.read("sensors/A1", &word(raw)), Ok(cm.into()));
    }
}

#[test]
fn the_median_of_three_takes_a_single_wrong_reading_out() {
    let mut robot = robot("{ port = 'A1', median3 = true }");
    let values: Vec<_> = [512, 512, 1023, 512, 0, 512]
        .into_iter()
        .map(|raw| robot.read("sensors/A1", &word(raw)).unwrap())
        .collect();
    assert_eq!(values, ["50"; 6]);
}

#[test]
fn the_battery_is_in_volts_and_absent_below_one() {
    let mut robot = robot("");
    // 12.958 mV for one count.
    for (raw, volts) in [
        (1023, "13.256"),
        (857, "11.105"),
        (100, "1.296"),
        (78, "1.011"),
    ] {
        assert_eq!(robot.read("battery", &word(raw)), Ok(volts.into()), "{raw}");
    }
    assert_eq!(
        robot.read("battery", &word(77)),
        Err("ENODEV: no battery: 998 mV".into())
    );
    assert_eq!(
        robot.read("battery", &word(0)),
        Err("ENODEV: no battery: 0 mV".into())
    );
    assert_eq!(robot.read("battery/cells", &[0]), Ok("2".into()));
    assert_eq!(robot.read("battery/cells", &[1]), Ok("3".into()));
}

/// Memory of the infrared camera: every pixel the same, then the words at these places of its second half.
fn picture(pixel: i16, words: &[(usize, u16)]) -> Vec<u8> {
    let mut bytes = vec![0; 2 * 1664];
    for at in 0..768 {
        bytes[2 * at..2 * at + 2].copy_from_slice(&pixel.to_be_bytes());
    }
    for (at, word) in words {
        let at = 1664 + 2 * at;
        bytes[at..at + 2].copy_from_slice(&word.to_be_bytes());
    }
    bytes
}

#[test]
fn the_infrared_camera_has_classes_of_warmth() {
    let classes = [
        (-121, 0),
        (-120, 1),
        (-81, 1),
        (-80, 2),
        (-20, 3),
        (19, 3),
        (20, 4),
        (89, 4),
        (90, 5),
        (199, 5),
        (200, 6),
    ];
    for (pixel, class) in classes {
        let mut robot = robot("{ port = 'ir_camera' }");
        let expected = vec![class.to_string(); 9].join(" ");
        assert_eq!(
            robot.read("ir_camera", &picture(pixel, &[])),
            Ok(expected),
            "{pixel}"
        );
    }
}

#[test]
fn the_offset_of_a_pixel_is_put_together_from_its_row_column_and_rest() {
    // Scales: row 1, column 2, rest 1. Reference -10, row 3 << 1, column -1 << 2, rest 5 << 1: together 2.
    let words = [
        (16, 0x0121),
        (17, 0xfff6),
        (18, 0x0003),
        (24, 0x000f),
        (64, 5 << 10),
    ];
    let first = |pixel| {
        let mut robot = robot("{ port = 'ir_camera', rows = 24, columns = 32 }");
        let classes = robot.read("ir_camera", &picture(pixel, &words)).unwrap();
        assert_eq!(classes.split(' ').count(), 768);
        classes.chars().next()
    };
    assert_eq!(first(21), Some('3'));
    assert_eq!(first(22), Some('4'));
}
