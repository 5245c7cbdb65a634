//! Standard messages of numbers in SI.
//!
//! Owns which numbers cannot be: they give no message. What nobody measures is what the type says for unknown.

use super::gather::Gathered;
use journal::standard::robot::{
    BatteryState, CompressedImage, JointState, Joy, LaserScan, Radiation, Range,
};
use std::f64::consts::TAU;

/// What a gamepad gives at the end of an axis.
const AXIS_END: f64 = 100.0;
/// How files of pictures begin and end.
const PICTURES: [(&str, &[u8], &[u8]); 2] = [
    ("jpeg", b"\xff\xd8\xff", b"\xff\xd9"),
    ("png", b"\x89PNG\r\n\x1a\n", b"IEND\xae\x42\x60\x82"),
];

/// The messages have 32 bits.
#[allow(
    clippy::cast_possible_truncation,
    reason = "digits are lost, and no more"
)]
fn short(number: f64) -> f32 {
    number as f32
}

/// Without anything in front of it a sensor gives 0, or less, which is no distance.
pub(super) fn range(path: &str, range_m: f64, radiation: Radiation) -> Option<Range> {
    (range_m > 0.0).then(|| Range {
        frame: path.to_owned(),
        radiation,
        field_of_view: 0.0,
        min_range: 0.0,
        max_range: f32::INFINITY,
        range: short(range_m),
        variance: 0.0,
    })
}

pub(super) fn battery(path: &str, voltage_v: f64) -> Option<BatteryState> {
    (voltage_v >= 0.0).then(|| BatteryState {
        frame: path.to_owned(),
        voltage: short(voltage_v),
        current: None,
        percentage: None,
    })
}

/// Of distances clockwise, the first ahead; those of the message are counter-clockwise.
pub(super) fn scan(path: &str, distances_m: &[f64]) -> LaserScan {
    let one = |distance: &f64| match *distance > 0.0 {
        true => short(*distance),
        // Nothing came back.
        false => f32::NAN,
    };
    let (first, others) = distances_m.split_at(distances_m.len().min(1));
    let ranges = first.iter().chain(others.iter().rev()).map(one).collect();
    #[allow(
        clippy::cast_precision_loss,
        reason = "a tuple has at most 1024 numbers"
    )]
    let (count, last) = (distances_m.len() as f64, others.len() as f64);
    LaserScan {
        frame: path.to_owned(),
        angle_min: 0.0,
        angle_max: short(last * TAU / count),
        angle_increment: short(TAU / count),
        time_increment: 0.0,
        scan_time: 0.0,
        range_min: 0.0,
        range_max: f32::INFINITY,
        ranges,
        intensities: Vec::new(),
    }
}

/// A file that is filled up with zero bytes; None if it is no whole picture.
pub(super) fn picture(path: &str, tuple: &[u8]) -> Option<CompressedImage> {
    let mut pictures = PICTURES.iter();
    let (format, _, end) = pictures.find(|(_, begin, _)| tuple.starts_with(begin))?;
    let size = tuple.iter().rposition(|&byte| byte != 0)? + 1;
    let data = &tuple[..size];
    data.ends_with(end).then(|| CompressedImage {
        frame: path.to_owned(),
        format: (*format).to_owned(),
        data: data.to_vec(),
    })
}

/// All joints that have a value; None if none has.
pub(super) fn joints<'a>(
    values: impl Iterator<Item = (&'a str, &'a [f64])>,
    are_speeds: bool,
) -> Option<JointState> {
    let (name, numbers): (Vec<String>, Vec<f64>) = values
        .filter_map(|(path, numbers)| Some((path.to_owned(), *numbers.first()?)))
        .unzip();
    let (position, velocity) = match are_speeds {
        false => (numbers, Vec::new()),
        true => (Vec::new(), numbers),
    };
    (!name.is_empty()).then(|| JointState {
        frame: String::new(),
        name,
        position,
        velocity,
        effort: Vec::new(),
    })
}

/// Whether a gamepad gives these.
pub(super) fn are_of_a_gamepad(buttons: &[bool], numbers: &[f64]) -> bool {
    let are_fine = buttons
        .iter()
        .zip(numbers)
        .all(|(is_button, number)| match is_button {
            true => *number == 0.0 || *number == 1.0,
            false => number.abs() <= AXIS_END,
        });
    are_fine && buttons.len() == numbers.len()
}

/// Axes and buttons in the order of their nodes, so that each keeps its place; None while one of them has no value.
pub(super) fn gamepad<'a>(
    group: &str,
    gathered: &Gathered,
    unix_ns: u64,
    buttons: impl Fn(&str) -> Option<&'a [bool]>,
) -> Option<Joy> {
    let mut joy = Joy {
        frame: group.to_owned(),
        ..Joy::default()
    };
    let mut nodes = 0;
    for (path, numbers) in gathered.values(unix_ns) {
        nodes += 1;
        for (is_button, number) in buttons(path)?.iter().zip(numbers) {
            match is_button {
                true => joy.buttons.push(i32::from(*number != 0.0)),
                false => joy.axes.push(short(number / AXIS_END)),
            }
        }
    }
    (nodes == gathered.len() && nodes > 0).then_some(joy)
}
