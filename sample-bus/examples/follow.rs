//! Prints every event of a node, with a note where some were missed: follow MOUNTPOINT NODE [COUNT].
//!
//! Needs the crate `sample-bus` and nothing else of trikfs.

use sample_bus::{Reader, Step};
use std::path::Path;
use std::process::ExitCode;
use std::time::Duration;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [mountpoint, node, count @ ..] = words.as_slice() else {
        eprintln!("usage: follow MOUNTPOINT NODE [COUNT]");
        return ExitCode::from(2);
    };
    let mut left = count.first().map_or(Ok(u64::MAX), |text| text.parse());
    let mut reader = match Reader::open(Path::new(mountpoint), node) {
        Ok(reader) => reader,
        Err(error) => {
            eprintln!("{node}: {error}");
            return ExitCode::FAILURE;
        }
    };
    let mut tuple = Vec::new();
    let mut idle_ms = 0;
    while let Ok(events @ 1..) = left {
        match reader.next_event(&mut tuple) {
            Step::Missed(events) => println!("missed {events}"),
            Step::Nothing => {
                idle_ms += 1;
                // Once in a while, look whether the node is still there.
                if idle_ms % 100 == 0 && !reader.is_current() {
                    eprintln!("{node}: gone");
                    return ExitCode::from(3);
                }
                std::thread::sleep(Duration::from_millis(1));
            }
            Step::Event(event) => {
                (idle_ms, left) = (0, Ok(events - 1));
                let what = match event.errno {
                    0 => tuple
                        .iter()
                        .take(16)
                        .map(|byte| format!("{byte:02x}"))
                        .collect(),
                    errno => format!("error {}", std::io::Error::from_raw_os_error(errno)),
                };
                println!("{} {} {what}", event.sequence, event.time_ns);
            }
        }
    }
    ExitCode::SUCCESS
}
