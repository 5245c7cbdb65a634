//! Tests of a sampled sensor with a folder instead of sysfs and a FIFO in that of its node.

use super::*;
use crate::scratch::Scratch;
use nix::sys::stat::Mode;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::sync::Mutex;

struct Board {
    scratch: Scratch,
    log: Arc<Mutex<Vec<String>>>,
}

impl Board {
    /// A gyroscope as device1, beside something else.
    fn new() -> Self {
        let scratch = Scratch::new();
        for (number, name) in [(0, "mma8451"), (1, "l3gd20h")] {
            let folder = scratch.path(&format!("devices/iio:device{number}"));
            fs::create_dir_all(folder.join("buffer")).unwrap();
            fs::create_dir_all(folder.join("scan_elements")).unwrap();
            fs::write(folder.join("name"), format!("{name}\n")).unwrap();
            fs::write(folder.join("sampling_frequency"), "100\n").unwrap();
            fs::write(folder.join("buffer/enable"), "1\n").unwrap();
            fs::write(folder.join("buffer/length"), "2\n").unwrap();
            let types = [
                ("anglvel_x", "le:s16/16>>0"),
                ("anglvel_y", "le:s16/16>>0"),
                ("anglvel_z", "le:s16/16>>0"),
                ("timestamp", "le:s64/64>>0"),
            ];
            for (index, (channel, kind)) in types.iter().enumerate() {
                let file = |what: &str| folder.join(format!("scan_elements/in_{channel}_{what}"));
                fs::write(file("en"), "0\n").unwrap();
                fs::write(file("index"), format!("{index}\n")).unwrap();
                fs::write(file("type"), format!("{kind}\n")).unwrap();
            }
            fs::create_dir_all(scratch.path("dev")).unwrap();
            let node = scratch.path(&format!("dev/iio:device{number}"));
            nix::unistd::mkfifo(&node, Mode::S_IRWXU).unwrap();
        }
        fs::create_dir(scratch.path("devices/trigger0")).unwrap();
        Self {
            scratch,
            log: Arc::default(),
        }
    }

    fn description(&self) -> IioDescription {
        IioDescription {
            devices: self.scratch.path("devices"),
            nodes: self.scratch.path("dev"),
            names: vec!["l3gd20".to_owned(), "l3gd20h".to_owned()],
            gives_position: true,
            channels: vec!["anglvel_z".to_owned(), "anglvel_x".to_owned()],
            sampling_frequency: Some(190.0),
        }
    }

    fn open(&self, description: &IioDescription, damaged: &Arc<Counter>) -> Result<Iio, Error> {
        let log = self.log.clone();
        let log: LogSink = Arc::new(move |line| log.lock().unwrap().push(line.to_owned()));
        Iio::open(description, damaged.clone(), &log)
    }

    fn text(&self, name: &str) -> String {
        let path = self.scratch.path("devices/iio:device1").join(name);
        fs::read_to_string(path).unwrap()
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.scratch.path("devices/iio:device1").join(name), text).unwrap();
    }

    fn writer(&self) -> fs::File {
        let path = self.scratch.path("dev/iio:device1");
        OpenOptions::new().write(true).open(path).unwrap()
    }
}

fn read(iio: &mut Iio) -> Option<Vec<i32>> {
    let mut buf = [0; 12];
    match iio.read(&mut buf).unwrap() {
        Got::Bytes(n) => {
            assert_eq!(n, 12);
            let (numbers, _) = buf.as_chunks();
            Some(
                numbers
                    .iter()
                    .map(|bytes| i32::from_le_bytes(*bytes))
                    .collect(),
            )
        }
        _ => None,
    }
}

/// x, y, z as the gyroscope writes them.
fn sample(x: i16, y: i16, z: i16) -> Vec<u8> {
    [x, y, z]
        .iter()
        .flat_map(|value| value.to_le_bytes())
        .collect()
}

#[test]
fn a_device_is_found_switched_on_read_and_switched_off() {
    let board = Board::new();
    // A boot script has switched y on: it is part of each sample all the same.
    board.put("scan_elements/in_anglvel_y_en", "1\n");
    let damaged = Arc::<Counter>::default();
    let mut iio = board.open(&board.description(), &damaged).unwrap();
    assert_eq!(board.text("buffer/enable"), "1\n");
    assert_eq!(board.text("buffer/length"), "128\n");
    assert_eq!(board.text("scan_elements/in_anglvel_z_en"), "1\n");
    assert_eq!(board.text("scan_elements/in_timestamp_en"), "0\n");
    assert_eq!(board.text("sampling_frequency"), "190\n");
    assert_eq!(read(&mut iio), None);
    let mut writer = board.writer();
    writer.write_all(&sample(-3, 7, 1000)).unwrap();
    writer.write_all(&sample(-4, 7, -32768)).unwrap();
    assert_eq!(read(&mut iio), Some(vec![2, 1000, -3]));
    assert_eq!(read(&mut iio), Some(vec![2, -32768, -4]));
    assert_eq!(read(&mut iio), None);
    drop(writer);
    assert!(matches!(iio.read(&mut [0; 12]), Err(Error::NoDevice(_))));
    drop(iio);
    assert_eq!(board.text("buffer/enable"), "0\n");
    assert_eq!((damaged.get(), board.log.lock().unwrap().len()), (0, 0));
}

#[test]
fn a_timestamp_stands_behind_its_padding() {
    let board = Board::new();
    let mut description = board.description();
    description.gives_position = false;
    description.channels.push("timestamp".to_owned());
    let mut iio = board.open(&description, &Arc::default()).unwrap();
    let mut writer = board.writer();
    let mut bytes = sample(1, 2, 3)[..4].to_vec(); // x and z: y is off
    bytes.extend([0xee; 4]);
    bytes.extend(0x1122_3344_5566_7788i64.to_le_bytes());
    writer.write_all(&bytes).unwrap();
    let mut buf = [0; 16];
    assert_eq!(iio.read(&mut buf), Ok(Got::Bytes(16)));
    assert_eq!(buf[..8], [2, 0, 0, 0, 1, 0, 0, 0]);
    assert_eq!(buf[8..], 0x1122_3344_5566_7788i64.to_le_bytes());
}

#[test]
fn half_a_sample_is_dropped_and_counted_and_the_next_one_is_right() {
    let board = Board::new();
    let mut description = board.description();
    description.channels = vec!["anglvel_x".to_owned(), "anglvel_y".to_owned()];
    let damaged = Arc::<Counter>::default();
    let mut iio = board.open(&description, &damaged).unwrap();
    let mut writer = board.writer();
    writer.write_all(&[1, 2, 3]).unwrap();
    assert_eq!(read(&mut iio), None);
    writer.write_all(&sample(5, 6, 0)[..4]).unwrap();
    assert_eq!(read(&mut iio), Some(vec![2, 5, 6]));
    assert_eq!(damaged.get(), 1);
}

#[test]
fn what_is_missing_is_named() {
    let board = Board::new();
    let damaged = Arc::default();
    let refused = |description: &IioDescription| match board.open(description, &damaged) {
        Err(error) => error.to_string(),
        Ok(_) => panic!("opened"),
    };
    let mut description = board.description();
    description.names = vec!["bmi160".to_owned()];
    let reason = refused(&description);
    assert!(
        reason.ends_with("devices: there is no bmi160; there are: mma8451, l3gd20h"),
        "{reason}"
    );
    description = board.description();
    description.channels.push("temp".to_owned());
    let reason = refused(&description);
    assert!(reason.contains("there is no channel 'temp'"), "{reason}");
    board.put("scan_elements/in_anglvel_x_type", "nonsense");
    let reason = refused(&board.description());
    assert!(
        reason.contains("the type 'nonsense' is not known"),
        "{reason}"
    );
    board.put("scan_elements/in_anglvel_x_index", "first");
    assert!(refused(&board.description()).contains("'first' is no number"));
    fs::remove_file(board.scratch.path("dev/iio:device1")).unwrap();
    assert!(refused(&board.description()).contains("dev/iio:device1: "));
    fs::remove_dir_all(board.scratch.path("devices")).unwrap();
    assert!(refused(&board.description()).contains("devices: "));
}

#[test]
fn a_rate_that_cannot_be_set_is_a_line_of_the_log_and_no_failure() {
    let board = Board::new();
    let path = board.scratch.path("devices/iio:device1/sampling_frequency");
    fs::remove_file(path).unwrap();
    board.open(&board.description(), &Arc::default()).unwrap();
    let log = board.log.lock().unwrap();
    assert_eq!(log.len(), 1);
    assert!(
        log[0].starts_with("a sampling frequency of 190 Hz cannot be set: ")
            && log[0].ends_with("it has no sampling_frequency"),
        "{log:?}"
    );
}
