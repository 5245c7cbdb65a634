//! What goes on all the time: readers, followers, configurations, clients of trikd.
//!
//! Owns these threads. Each call goes through [`Figures::call`], which says what is right. Knows no fault.

use crate::figures::Figures;
use crate::robot::{APART, KNOWN, Robot, config};
use needs::Random;
use std::fs::File;
use std::io::{self, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::FileExt;
use std::path::Path;
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

/// Readers of known values.
const READERS: u32 = 2;
/// Between two things that one thread does.
const PACE: Duration = Duration::from_millis(2);
/// Between two configurations.
const RELOAD: Duration = Duration::from_millis(400);
/// Between two clients of trikd.
const CLIENT: Duration = Duration::from_millis(20);
/// Connections that one client leaves open.
const OPEN: usize = 40;

/// What a client may send that is nothing, too much, or half of something.
const RUBBISH: [&str; 8] = [
    "99999999:",
    "4:dat",
    "-1:x",
    ":",
    "3:run",
    "11:unknown:word",
    "9:version",
    "GET / HTTP/1.1\r\n\r\n",
];

type Work = fn(&Robot, &Figures, &mut Random);

/// Starts all of it.
pub fn start(robot: &Arc<Robot>, figures: &Arc<Figures>, seed: u32) -> Vec<JoinHandle<()>> {
    let mut works: Vec<(Work, Duration)> = vec![
        (follow, PACE),
        (reload, RELOAD),
        (clients, CLIENT),
        (look_around, 5 * PACE),
        (crash, PACE),
    ];
    works.extend((0..READERS).map(|_| (read as Work, PACE)));
    let numbered = works.into_iter().zip(1..);
    numbered
        .map(|((work, pace), number)| {
            let (robot, figures) = (Arc::clone(robot), Arc::clone(figures));
            std::thread::spawn(move || {
                let mut random = Random::new(seed.wrapping_add(number));
                while !figures.is_over() {
                    work(&robot, &figures, &mut random);
                    figures.pause(pace);
                }
            })
        })
        .collect()
}

/// The first bytes of a file: a stream has no end.
fn first_bytes(path: &Path, count: usize) -> io::Result<Vec<u8>> {
    let mut bytes = vec![0; count];
    let size = File::open(path)?.read(&mut bytes)?;
    bytes.truncate(size);
    Ok(bytes)
}

/// Opens, reads and closes a file whose content is known.
fn read(robot: &Robot, figures: &Figures, random: &mut Random) {
    let (name, known) = KNOWN[random.below(KNOWN.len())];
    let path = robot.mount.path(name);
    figures.call(
        "reads of known values",
        || first_bytes(&path, known.len()),
        |bytes| bytes == known,
    );
}

/// A converter that crashes in its own process: the right value, or the error that says so.
fn crash(robot: &Robot, figures: &Figures, _: &mut Random) {
    let path = robot.mount.path("apart/device");
    figures.call(
        "reads of a converter that crashes",
        || match first_bytes(&path, APART.len()) {
            Err(error) if error.raw_os_error() == Some(libc::EIO) => Ok(true),
            read => read.map(|bytes| bytes == APART),
        },
        |is_right| *is_right,
    );
}

/// Keeps a stream and a newest value open for a while.
fn follow(robot: &Robot, figures: &Figures, random: &mut Random) {
    let stream = robot.mount.path("stream/device");
    figures.call(
        "bytes of a stream",
        || {
            let mut file = File::open(&stream)?;
            let mut bytes = [0; 1];
            for _ in 0..random.below(20) {
                file.read_exact(&mut bytes)?;
                if !b"abcd".contains(&bytes[0]) {
                    return Ok(false);
                }
            }
            Ok(true)
        },
        |is_right| *is_right,
    );
    let paced = robot.mount.path("paced/bin_data");
    figures.call(
        "reads of an open newest value",
        || {
            let file = File::open(&paced)?;
            let mut bytes = [0; 1];
            for _ in 0..50 {
                file.read_exact_at(&mut bytes, 0)?;
            }
            Ok(bytes)
        },
        |bytes| bytes == &[5],
    );
}

/// Another configuration, or one that must be refused.
fn reload(robot: &Robot, figures: &Figures, random: &mut Random) {
    let (text, is_good) = match random.below(4) {
        0 => ("trikfs = { broken".to_owned(), false),
        1 => (config("other"), true),
        _ => (config("extra"), true),
    };
    let text = robot.mount.board().fill_in(&text);
    let path = robot.mount.path("config");
    figures.call(
        "configurations",
        || {
            let mut file = File::options().write(true).truncate(true).open(&path)?;
            file.write_all(text.as_bytes())?;
            match file.sync_all() {
                Err(error) if error.raw_os_error() == Some(libc::EINVAL) => Ok(false),
                done => done.map(|()| true),
            }
        },
        |was_applied| *was_applied == is_good,
    );
}

/// Names, attributes, texts, and writes that make no sense.
fn look_around(robot: &Robot, figures: &Figures, random: &mut Random) {
    let root = robot.mount.root().to_owned();
    match random.below(3) {
        0 => figures.call(
            "listings",
            || {
                let names = std::fs::read_dir(&root)?.collect::<io::Result<Vec<_>>>()?;
                // After a crash what is below the mount point is seen for a moment, then a tree without nodes.
                match names.len() < KNOWN.len() {
                    true => Err(io::ErrorKind::NotConnected.into()),
                    false => Ok(names),
                }
            },
            |names| names.len() > KNOWN.len(),
        ),
        1 => figures.call(
            "reads of status",
            || std::fs::read_to_string(root.join("status")),
            |text| text.starts_with("config ") && !text.contains("panics"),
        ),
        _ => figures.call(
            "writes of rubbish",
            || {
                let mut file = File::options().write(true).open(root.join("motor/value"))?;
                match file.write_all(b"full speed\n") {
                    Err(error) if error.raw_os_error() == Some(libc::EINVAL) => Ok(true),
                    done => done.map(|()| false),
                }
            },
            |was_refused| *was_refused,
        ),
    }
}

/// Clients of trikd: good ones that ask, and others.
fn clients(robot: &Robot, figures: &Figures, random: &mut Random) {
    // Kept until the next round: connections that say nothing or half of something.
    let ports = [robot.control, robot.telemetry];
    let mut open = Vec::new();
    for _ in 0..random.below(OPEN) {
        let Ok(mut stream) = TcpStream::connect(("127.0.0.1", ports[random.below(2)])) else {
            continue;
        };
        let _ = stream.write_all(RUBBISH[random.below(RUBBISH.len())].as_bytes());
        open.push(stream);
    }
    figures.call(
        "questions to trikd",
        || {
            let mut stream = TcpStream::connect(("127.0.0.1", robot.control))?;
            stream.set_read_timeout(Some(Duration::from_secs(10)))?;
            stream.write_all(b"13:configVersion")?;
            let mut answer = [0; 64];
            stream.read(&mut answer)
        },
        |size| *size > 0,
    );
}
