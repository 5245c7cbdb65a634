//! Tests of the constructors of ports: what they give, and each refusal with its place and words.

use crate::description::{
    ByteOrder, Checksum, CommandDescription, GpioDescription, GpioDirection, IioDescription,
    LengthField, LinesDescription, NodeDescription, PacketsDescription, PwmDescription,
    SourceDescription,
};
use crate::load::Loader;

fn load(fields: &str) -> Result<NodeDescription, String> {
    let source = format!("trikfs = {{\nx = {{ src = {fields} }} }}");
    let loaded = Loader::default().load("robot.lua", None, source.as_bytes());
    let mut nodes = loaded.map_err(|problem| problem.to_string())?.config.nodes;
    Ok(nodes.remove(0))
}

fn node(fields: &str) -> NodeDescription {
    load(fields).unwrap_or_else(|problem| panic!("{fields}: {problem}"))
}

fn refused(fields: &str) -> String {
    let problem = load(fields).expect_err(fields);
    let reason = problem.strip_prefix("robot.lua:2: x: ");
    reason.unwrap_or_else(|| panic!("{problem}")).to_owned()
}

#[test]
fn iio_knows_the_size_of_its_tuples() {
    let one = node("iio{ name = 'mma8451', channels = { 'accel_x', 'timestamp', 'accel_y' } }");
    assert_eq!((one.input_tuple_size, one.mode), (16, 0o444));
    let SourceDescription::Iio(iio) = one.source else {
        panic!("not iio")
    };
    let expected = IioDescription {
        devices: "/sys/bus/iio/devices".into(),
        nodes: "/dev".into(),
        names: vec!["mma8451".into()],
        gives_position: false,
        channels: vec!["accel_x".into(), "timestamp".into(), "accel_y".into()],
        sampling_frequency: None,
    };
    assert_eq!(iio, expected);
    let listed = node(
        "iio{ name = { 'l3gd20', 'l3gd20h' }, channels = { 'anglvel_z' }, sampling_frequency = 12.5 }",
    );
    assert_eq!(listed.input_tuple_size, 8);
    let SourceDescription::Iio(iio) = listed.source else {
        panic!("not iio")
    };
    assert_eq!(
        (iio.gives_position, iio.sampling_frequency),
        (true, Some(12.5))
    );
}

#[test]
fn mistakes_in_iio_are_refused() {
    for (text, reason) in [
        ("iio{}", "iio: name is missing"),
        (
            "iio{ name = 'a' }",
            "iio: channels is missing, for example channels = { 'accel_x', 'timestamp' }",
        ),
        (
            "iio{ name = 5, channels = { 'x' } }",
            "name must be a list of names, not a number",
        ),
        (
            "iio{ name = '../a', channels = { 'x' } }",
            "iio: name has '../a', but a name has 1 to 64 letters, digits, '_', '-' and '.'",
        ),
        (
            "iio{ name = 'a', channels = {} }",
            "iio: channels must be a list of names",
        ),
        (
            "iio{ name = 'a', channels = { x = 'y' } }",
            "iio: channels must be a list of names",
        ),
        (
            "iio{ name = 'a', channels = { 'x', 'x' } }",
            "iio: channels has 'x' twice",
        ),
        (
            "iio{ name = 'a', channels = { 1 } }",
            "channels must be a name, not a number",
        ),
        (
            "iio{ name = 'a', chanels = { 'x' } }",
            "iio: unknown key 'chanels', did you mean 'channels'",
        ),
        (
            "iio{ name = 'a', channels = { 'x' }, sampling_frequency = 0 }",
            "iio: sampling_frequency must be above 0 and at most 1000000000, not 0",
        ),
        (
            "iio{ name = 'a', channels = { 'x' } }, input_tuple_size = 5",
            "input_tuple_size is 5, but the source gives tuples of 4 bytes",
        ),
        (
            "iio{ name = 'a', channels = { 'x' } }, write_converter = id_create(4)",
            "write_converter makes no sense: the source cannot be written",
        ),
    ] {
        assert_eq!(refused(text), reason, "{text}");
    }
    let many: Vec<_> = (0..65).map(|number| format!("'c{number}'")).collect();
    assert_eq!(
        refused(&format!(
            "iio{{ name = 'a', channels = {{ {} }} }}",
            many.join(",")
        )),
        "iio: channels has more than 64 names"
    );
}

#[test]
fn pwm_and_gpio_are_states_that_can_be_written() {
    let pwm = node("pwm{ chip = '/sys/class/pwm/pwmchip3', channel = 1, period_ns = 20000000 }");
    assert_eq!((pwm.input_tuple_size, pwm.mode), (4, 0o644));
    let expected = PwmDescription {
        chip: "/sys/class/pwm/pwmchip3".into(),
        channel: 1,
        period_ns: 20_000_000,
    };
    assert_eq!(pwm.source, SourceDescription::Pwm(expected));
    for (word, direction, mode) in [
        ("in", GpioDirection::In, 0o444),
        ("out", GpioDirection::Out, 0o644),
        ("high", GpioDirection::High, 0o644),
        ("low", GpioDirection::Low, 0o644),
    ] {
        let gpio = node(&format!("gpio{{ number = 56, direction = '{word}' }}"));
        assert_eq!((gpio.input_tuple_size, gpio.mode), (1, mode));
        let expected = GpioDescription {
            base: "/sys/class/gpio".into(),
            number: 56,
            direction,
            active_low: false,
        };
        assert_eq!(gpio.source, SourceDescription::Gpio(expected));
    }
}

#[test]
fn mistakes_in_pwm_and_gpio_are_refused() {
    for (text, reason) in [
        (
            "pwm{}",
            "pwm: chip is missing, for example chip = '/sys/class/pwm/pwmchip0'",
        ),
        (
            "pwm{ chip = 'pwmchip0', period_ns = 5 }",
            "the path 'pwmchip0' must begin with a slash",
        ),
        ("pwm{ chip = '/c' }", "pwm: period_ns is missing"),
        (
            "pwm{ chip = '/c', period_ns = 0 }",
            "period_ns must be a whole number from 1 to 4294967295, not 0",
        ),
        (
            "pwm{ chip = '/c', period_ns = 1, channel = 256 }",
            "channel must be a whole number from 0 to 255, not 256",
        ),
        (
            "pwm{ chip = '/c', period = 1 }",
            "pwm: unknown key 'period'",
        ),
        ("gpio{ direction = 'in' }", "gpio: number is missing"),
        (
            "gpio{ number = 1 }",
            "gpio: direction is missing: 'in', 'out', 'high' or 'low'",
        ),
        (
            "gpio{ number = 1, direction = 'ou' }",
            "gpio: direction is one of 'in', 'out', 'high', 'low', not 'ou', did you mean 'out'",
        ),
        (
            "gpio{ number = 1.5, direction = 'in' }",
            "number must be a whole number from 0 to 65535, not 1.5",
        ),
        (
            "gpio{ number = 1, direction = 'in', active_low = 1 }",
            "active_low must be true or false, not a number",
        ),
    ] {
        assert_eq!(refused(text), reason, "{text}");
    }
}

#[test]
fn pictures_have_a_pipe_and_perhaps_a_program_and_cannot_be_written() {
    let node = node(
        "pictures{ path = '/run/p.fifo', start = { '/etc/p', 'start' }, stop = { '/etc/p', 'stop' } }, input_tuple_size = 64",
    );
    assert_eq!(node.mode, 0o444);
    let SourceDescription::Lines(lines) = node.source else {
        panic!("{:?}", node.source);
    };
    assert!(lines.are_pictures && lines.input.is_none() && lines.start.is_some());
    let pictures = |fields: &str| refused(&format!("pictures{{ {fields} }}, input_tuple_size = 8"));
    assert!(
        pictures("'/run/p', stop = { '/etc/p' }").contains("stop makes no sense without start")
    );
    assert!(pictures("'/run/p', input = '/run/q'").contains("input"));
    assert!(pictures("").contains("path"));
}

#[test]
fn lines_have_a_pipe_and_perhaps_a_program() {
    let full = node(
        "lines{ path = '/run/s.out.fifo', input = '/run/s.in.fifo', start = { '/etc/s', 'start' }, stop = { '/etc/s', 'stop' } }, input_tuple_size = 64",
    );
    assert_eq!(full.mode, 0o644);
    let command = |word: &str| {
        Some(CommandDescription {
            program: "/etc/s".into(),
            arguments: vec![word.to_owned()],
        })
    };
    let expected = LinesDescription {
        path: "/run/s.out.fifo".into(),
        input: Some("/run/s.in.fifo".into()),
        start: command("start"),
        stop: command("stop"),
        answer: None,
        are_pictures: false,
    };
    assert_eq!(full.source, SourceDescription::Lines(expected));
    let asks = node(
        "lines{ '/run/out', input = '/run/in', question = 'detect', answer = 'hsv:' }, input_tuple_size = 8",
    );
    let SourceDescription::Lines(lines) = asks.source else {
        panic!("{:?}", asks.source);
    };
    let answer = lines.answer.unwrap();
    assert_eq!((&*answer.question, &*answer.answer), ("detect", "hsv:"));
    let plain = node("lines{ '/run/pad.fifo' }, input_tuple_size = 32");
    assert_eq!(plain.mode, 0o444);
}

#[test]
fn mistakes_in_lines_are_refused() {
    for (text, reason) in [
        ("lines{}, input_tuple_size = 4", "lines: path is missing"),
        ("lines{ path = '/x' }", "input_tuple_size is missing"),
        (
            "lines{ path = '/x', start = '/etc/s start' }, input_tuple_size = 4",
            "start must be a list of a program and its arguments, not a string",
        ),
        (
            "lines{ path = '/x', start = {} }, input_tuple_size = 4",
            "lines: start must be a list of a program and its arguments",
        ),
        (
            "lines{ path = '/x', start = { 's' } }, input_tuple_size = 4",
            "the path 's' must begin with a slash",
        ),
        (
            "lines{ path = '/x', start = { '/s', 5 } }, input_tuple_size = 4",
            "start must be a list of a program and its arguments, not a number",
        ),
        (
            "lines{ path = '/x', start = { '/s', 'a\\nb' } }, input_tuple_size = 4",
            "lines: an argument of start is not UTF-8 of at most 1024 bytes without control characters",
        ),
        (
            "lines{ path = '/x', input = '/y', question = 'detect' }, input_tuple_size = 4",
            "lines: question and answer belong together, for example question = 'detect', answer = 'hsv:'",
        ),
        (
            "lines{ path = '/x', input = '/y', question = 'detect', answer = '' }, input_tuple_size = 4",
            "lines: question and answer belong together, for example question = 'detect', answer = 'hsv:'",
        ),
        (
            "lines{ path = '/x', question = 'detect', answer = 'hsv:' }, input_tuple_size = 4",
            "lines: question makes no sense without input",
        ),
        (
            "lines{ path = '/x', input = '/y', question = 5, answer = 'hsv:' }, input_tuple_size = 4",
            "question must be a string, not a number",
        ),
        (
            "lines{ path = '/x', stop = { '/s' } }, input_tuple_size = 4",
            "lines: stop makes no sense without start",
        ),
    ] {
        assert_eq!(refused(text), reason, "{text}");
    }
    let words = "'a',".repeat(32);
    assert_eq!(
        refused(&format!(
            "lines{{ path = '/x', start = {{ '/s', {words} }} }}, input_tuple_size = 4"
        )),
        "lines: start has more than 32 words"
    );
}

#[test]
fn packets_are_described_by_their_start_length_and_checksum() {
    let lidar = node(
        "packets{ path = '/dev/ttyS1', baud = 230400, start = '\\xAA', length = { at = 1, bytes = 2, add = 2 }, order = 'big', checksum = 'sum16' }, input_tuple_size = 512",
    );
    let expected = PacketsDescription {
        path: "/dev/ttyS1".into(),
        baud: Some(230_400),
        start: vec![0xaa],
        length: LengthField {
            at: 1,
            bytes: 2,
            add: 2,
        },
        order: ByteOrder::Big,
        checksum: Checksum::Sum16,
    };
    assert_eq!((lidar.mode, expected.size_min()), (0o444, 5));
    assert_eq!(lidar.source, SourceDescription::Packets(expected));
}

#[test]
fn mistakes_in_packets_are_refused() {
    let packets = |fields: &str| refused(&format!("packets{{ {fields} }}, input_tuple_size = 8"));
    let good = "path = '/t', start = 'S', length = { at = 1 }";
    for (text, reason) in [
        ("start = 'S'", "packets: path is missing"),
        ("path = '/t'", "packets: start is missing"),
        (
            "path = '/t', start = ''",
            "packets: start has 1 to 16 bytes, not 0",
        ),
        (
            "path = '/t', start = 5",
            "start must be a string of bytes, not a number",
        ),
        (
            "path = '/t', start = 'S'",
            "packets: length is missing, for example length = { at = 1, bytes = 2 }",
        ),
        (
            "path = '/t', start = 'S', length = 5",
            "length must be a table, not a number",
        ),
        (
            "path = '/t', start = 'S', length = {}",
            "packets: length: at is missing",
        ),
        (
            "path = '/t', start = 'S', length = { at = 1, bytes = 3 }",
            "bytes must be a whole number from 1 to 2, not 3",
        ),
        (
            "path = '/t', start = 'S', length = { at = 1, add = 0.5 }",
            "packets: length: add must be a whole number from -4194304 to 4194304, not 0.5",
        ),
        (
            "path = '/t', start = 'S', length = { at = 1, byte = 1 }",
            "packets: length: unknown key 'byte', did you mean 'bytes'",
        ),
        (
            good,
            "packets: checksum is missing: 'sum16', 'sum8', 'xor8', or 'none' if there is none",
        ),
    ] {
        assert_eq!(packets(text), reason, "{text}");
    }
    assert_eq!(
        packets(&format!("{good}, checksum = 'crc16'")),
        "packets: checksum is one of 'none', 'sum8', 'sum16', 'xor8', not 'crc16'"
    );
    assert!(
        packets(&format!("{good}, checksum = 'none', baud = 9601")).ends_with("3000000, not 9601")
    );
    assert_eq!(
        packets("path = '/t', start = 'S', length = { at = 6, bytes = 2 }, checksum = 'sum8'"),
        "packets: start, length and checksum take 9 bytes, more than a tuple of 8"
    );
}
