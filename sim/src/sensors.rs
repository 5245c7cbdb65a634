//! Camera sensors: programs of the controller that are started by a script and speak through two FIFOs.
//!
//! Owns the scripts, the FIFOs, which sensor runs (one at a time, as on the one signal processor) and the lines:
//! out `loc: X C M`, `loc: X Y S`, `color: C...`, `hsv: A B C D E F`; in `detect`, `hsv A B C D E F`, `mxn M N`,
//! `video_out 0|1`. The encoder of pictures is one of them; its lines are JPEG files.

use crate::attributes::Attributes;
use crate::camera::{HEIGHT, Hsv, Picture, WIDTH};
use crate::faults;
use crate::fifo::{In, Out, Reader};
use crate::files::{Part, script};
use crate::photo;
use crate::shared::Shared;
use crate::world::colour;
use std::io;
use std::os::fd::BorrowedFd;
use std::path::PathBuf;

const PERIOD_S: f64 = 0.04;
/// Pictures cost more than lines.
const PICTURE_PERIOD_S: f64 = 0.1;
/// Pictures themselves, from the encoder.
const PICTURES: &str = "mjpg";
const NAMES: [&str; 4] = ["line", "object", "mxn", PICTURES];
const BLACK: Hsv = [0, 359, 0, 100, 0, 20];
const RED: Hsv = [340, 20, 50, 100, 20, 100];
/// Objects that are smaller are not told.
const SMALLEST: i32 = 4;
/// Cells of the colour sensor in each direction.
const MAX_GRID: i32 = 3;

/// The camera and whatever looks through it.
pub struct Camera {
    root: PathBuf,
    control: In,
    running: Option<Running>,
}

/// One sensor at work.
struct Running {
    name: &'static str,
    out: Out,
    input: In,
    /// For the colour in the middle; the answer was not told yet.
    is_asked: bool,
    due_s: f64,
    ranges: Hsv,
    grid: [i32; 2],
    last: Vec<u8>,
}

impl Camera {
    /// The scripts and what they speak to.
    pub fn make(attributes: &Attributes) -> io::Result<Self> {
        let root = attributes.root();
        for name in NAMES {
            script(
                root,
                &format!("etc/init.d/{}-ov7670", full(name)),
                &start_script(name),
            )?;
        }
        std::fs::create_dir_all(root.join("run"))?;
        Ok(Self {
            root: root.to_owned(),
            control: In::make(root.join("control/camera"))?,
            running: None,
        })
    }

    fn start(&mut self, name: &'static str) {
        if self
            .running
            .as_ref()
            .is_some_and(|running| running.name == name)
        {
            return;
        }
        self.stop();
        let fifo = |way: &str| self.root.join(format!("run/{}.{way}.fifo", full(name)));
        // Without FIFOs there is no sensor; the script that waits for them says so.
        let Ok(input) = In::make(fifo("in")) else {
            return;
        };
        let made = if name == PICTURES {
            Out::make_large(fifo("out"))
        } else {
            Out::make(fifo("out"))
        };
        let Ok(out) = made else {
            return;
        };
        self.running = Some(Running {
            name,
            out,
            input,
            is_asked: false,
            due_s: 0.0,
            ranges: if name == "object" { RED } else { BLACK },
            grid: [MAX_GRID; 2],
            last: Vec::new(),
        });
    }

    fn stop(&mut self) {
        if let Some(mut running) = self.running.take() {
            running.out.set_there(false);
        }
    }
}

impl Part for Camera {
    fn run(&mut self, shared: &Shared) -> f64 {
        let (now_s, fault, has_camera) = {
            let machine = shared.machine();
            let has_camera = machine.body().pixel(0.0, 0.0).is_some();
            (machine.time_s(), machine.faults[faults::CAMERA], has_camera)
        };
        let can_run = has_camera && !fault.unplug;
        for line in self.control.lines() {
            let (name, order) = line.split_once(' ').unwrap_or_default();
            let known = NAMES.into_iter().find(|other| *other == name);
            let is_running = self
                .running
                .as_ref()
                .is_some_and(|running| running.name == name);
            match (known, order) {
                (Some(name), "start") if can_run => self.start(name),
                (Some(_), "stop") if is_running => self.stop(),
                _ => {}
            }
        }
        if !can_run {
            self.stop();
        }
        match &mut self.running {
            Some(running) => running.run(shared, now_s),
            None => f64::INFINITY,
        }
    }

    fn inputs(&self) -> Vec<BorrowedFd<'_>> {
        let mut inputs = vec![self.control.fd()];
        inputs.extend(self.running.iter().map(|running| running.input.fd()));
        inputs
    }
}

impl Running {
    fn run(&mut self, shared: &Shared, now_s: f64) -> f64 {
        let is_read = self.out.reader() != Reader::None;
        for line in self.input.lines() {
            self.is_asked |= self.order(&line) && self.name != PICTURES;
        }
        // A program waits with its answer for who opens the pipe.
        if !is_read {
            return f64::INFINITY;
        }
        if std::mem::take(&mut self.is_asked) {
            let ranges = picture(shared).detect().map(|part| part.to_string());
            self.out
                .send(format!("hsv: {}\n", ranges.join(" ")).as_bytes());
        }
        if self.due_s <= now_s {
            let slower_s = self.frame(shared);
            let period_s = if self.name == PICTURES {
                PICTURE_PERIOD_S
            } else {
                PERIOD_S
            };
            self.due_s = (self.due_s + period_s).max(now_s) + slower_s;
        }
        self.due_s
    }

    /// One line of a program; true if it asks for the colours in the middle.
    fn order(&mut self, line: &str) -> bool {
        let mut words = line.split_whitespace();
        let verb = words.next().unwrap_or_default();
        let numbers: Option<Vec<i32>> = words.map(|word| word.parse().ok()).collect();
        match (verb, numbers.as_deref()) {
            ("detect", Some([])) => return true,
            ("hsv", Some(&[a, b, c, d, e, f])) => self.ranges = [a, b, c, d, e, f],
            ("mxn", Some(&[m, n]))
                if (1..=MAX_GRID).contains(&m) && (1..=MAX_GRID).contains(&n) =>
            {
                self.grid = [m, n];
            }
            // There is no display; what a sensor does not understand it leaves out.
            _ => {}
        }
        false
    }

    /// Looks and tells what is there.
    fn frame(&mut self, shared: &Shared) -> f64 {
        let is_encoder = self.name == PICTURES;
        // A picture for people is larger, and made by itself.
        let picture = if is_encoder {
            Picture(Vec::new())
        } else {
            picture(shared)
        };
        let mut machine = shared.machine();
        let fault = machine.faults[faults::CAMERA];
        let noise = machine.random.within(fault.noise).round() as i32;
        let is_lost = machine.random.chance(fault.drop);
        let mut garbage = [0; 16];
        if fault.garbage {
            machine.random.fill(&mut garbage);
        }
        drop(machine);
        if fault.stuck && !self.last.is_empty() {
            // Nothing changes any more.
        } else if is_encoder {
            self.last = photo::jpeg(shared, fault.noise);
        } else {
            self.last = self.line(&picture, noise).into_bytes();
        }
        if fault.garbage {
            let mut bytes = garbage.to_vec();
            bytes.push(b'\n');
            self.out.send(&bytes);
        } else if !is_lost {
            self.out.send(&self.last);
        }
        f64::from(fault.slow_ms) / 1000.0
    }

    /// What a sensor tells of what it sees.
    fn line(&self, picture: &Picture, noise: i32) -> String {
        match self.name {
            "line" => {
                let line = picture.line(&self.ranges);
                let x = (line.x + noise).clamp(-100, 100);
                format!("loc: {x} {} {}\n", line.crossing, line.mass)
            }
            "object" => {
                let (x, y, size) = picture.object(&self.ranges);
                let x = (x + noise).clamp(-100, 100);
                let size = if size < SMALLEST { 0 } else { size };
                format!("loc: {x} {y} {size}\n")
            }
            _ => {
                let [rows, columns] = self.grid.map(|size| size as usize);
                let colours = picture.colours(rows, columns);
                let words: Vec<String> = colours.iter().map(u32::to_string).collect();
                format!("color: {}\n", words.join(" "))
            }
        }
    }
}

/// What the camera sees; the machine is free between the rows.
fn picture(shared: &Shared) -> Picture {
    let across = |place: usize, size: usize| (2 * place + 1) as f64 / size as f64 - 1.0;
    let row = |row: usize| {
        let machine = shared.machine();
        std::array::from_fn(|column| {
            let seen = machine
                .body()
                .pixel(across(column, WIDTH), across(row, HEIGHT));
            seen.unwrap_or(colour(0, 0, 0))
        })
    };
    Picture((0..HEIGHT).map(row).collect())
}

/// How scripts and FIFOs of a sensor are called.
fn full(name: &str) -> String {
    if name == PICTURES {
        "mjpg-encoder".to_owned()
    } else {
        format!("{name}-sensor")
    }
}

/// What stands for the controller's own script: it tells the board and waits for the FIFO.
fn start_script(name: &str) -> String {
    let full = full(name);
    format!(
        r#"
control=$root/control/camera
out=$root/run/{full}.out.fifo
[ -p "$control" ] || {{ echo "the virtual board is not running" >&2; exit 1; }}
case ${{1:-}} in
start)
    echo "{name} start" 1<>"$control"
    tries=0
    while [ ! -p "$out" ]; do
        tries=$((tries + 1))
        [ "$tries" -le 200 ] || {{ echo "$out does not appear: there is no camera" >&2; exit 1; }}
        sleep 0.1
    done
    ;;
stop)
    echo "{name} stop" 1<>"$control"
    ;;
*)
    echo "usage: $0 start|stop" >&2
    exit 2
    ;;
esac
"#
    )
}
