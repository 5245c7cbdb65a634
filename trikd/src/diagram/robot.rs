//! The tree as a running diagram sees it: commands of blocks to files.
//!
//! Owns which file a command goes to, and what a robot without that file means: the block does nothing, as on the
//! original robots, and the first failure of a device is told. Knows no blocks and no time.

use super::asking::Asking;
use super::parts::Parts;
use super::readings::Readings;
use super::words::trouble;
use crate::brick::Brick;
use crate::brick::actuators::Motor;
use crate::display::{Display, Unshown};
use crate::host::Host;
use crate::limits;
use crate::program::child;
use crate::protocol::program::mailbox::Question;
use lang_diagram::brick::{self, Answer, Command, Figure};
use lang_diagram::ports::Port;
use lang_text::problem::{Locale, Problem};
use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoroshiro64Star;
use std::collections::{HashSet, VecDeque};
use std::fs::OpenOptions;
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};

/// What keeps a device from doing what a block tells it.
#[derive(Debug)]
pub enum Trouble {
    /// There is no motor at this port.
    NoMotor,
    /// There is no such camera.
    NoCamera,
    /// There is no encoder at this port.
    NoEncoder,
    /// The sensor that was to look does not hear.
    NoDetector,
    /// [`limits::DIAGRAM_COMMANDS`] run.
    ManyCommands,
    /// What is to be read is no file.
    NoFile,
    /// It is longer than [`limits::DIAGRAM_FILE_BYTES`].
    LongFile,
    /// What the system says.
    System(io::Error),
    /// The display.
    Display(Unshown),
}

impl From<io::Error> for Trouble {
    fn from(error: io::Error) -> Self {
        Self::System(error)
    }
}

impl From<Unshown> for Trouble {
    fn from(why: Unshown) -> Self {
        Self::Display(why)
    }
}

/// The robot of one diagram.
pub struct Robot<'a> {
    brick: &'a Brick,
    host: &'a Host,
    motors: Parts<Motor>,
    readings: Readings<'a>,
    display: Display,
    /// Messages with the hull numbers of who sent them.
    mail: VecDeque<(i32, String)>,
    /// Commands of the system that have not ended.
    commands: Vec<Child>,
    /// What has failed once.
    told: HashSet<String>,
    random: Random,
    asking: Asking,
    /// The language of what a person is told.
    locale: Locale,
}

/// Random numbers; the generator is one for processors of 32 bits.
struct Random(Xoroshiro64Star);

impl Random {
    /// Seeded by what the standard library seeds its tables with, which differs from run to run.
    fn new() -> Self {
        use std::hash::{BuildHasher, Hasher};
        let seed = std::hash::RandomState::new().build_hasher().finish();
        Self(Xoroshiro64Star::seed_from_u64(seed))
    }

    /// Both bounds included.
    fn between(&mut self, low: i32, high: i32) -> i32 {
        let span = u64::from(high.abs_diff(low)) + 1;
        let offset = (u64::from(self.0.next_u32()) * span) >> 32;
        let drawn = i64::from(low) + i64::try_from(offset).unwrap_or(0);
        i32::try_from(drawn).unwrap_or(high)
    }
}

impl<'a> Robot<'a> {
    /// The robot over a tree, on which a question waits for so long and is asked in this language. Opens nothing yet.
    pub fn new(brick: &'a Brick, host: &'a Host, patience: Duration, locale: Locale) -> Self {
        Self {
            brick,
            host,
            motors: Parts::new(),
            readings: Readings::new(brick),
            display: Display::new(brick.tree().root()),
            mail: VecDeque::new(),
            commands: Vec::new(),
            told: HashSet::new(),
            random: Random::new(),
            asking: Asking::new(patience),
            locale,
        }
    }

    /// Keeps a message of another robot; the oldest go when nobody takes them.
    pub fn post(&mut self, sender: i32, text: String) {
        if self.mail.len() >= limits::DIAGRAM_MAIL {
            self.mail.pop_front();
        }
        self.mail.push_back((sender, text));
    }

    /// What a person says to a question.
    pub fn answer(&mut self, number: u32, text: Option<String>) {
        self.asking.hear(number, text);
    }

    /// Between two steps: tells a camera again what it could not hear yet, and forgets commands of the system that have
    /// ended.
    pub fn go_on(&mut self) {
        let result = self.readings.detect_again();
        self.note("camera", result);
        self.commands
            .retain_mut(|child| matches!(child.try_wait(), Ok(None)));
    }

    /// Tells a failure, each once.
    fn note(&mut self, what: &str, result: Result<(), impl Into<Trouble>>) {
        if let Err(why) = result
            && self.told.len() < limits::DIAGRAM_WARNINGS
            && self.told.insert(what.to_owned())
        {
            // The daemon may be gone; then this process ends soon.
            let words = trouble(&why.into());
            let why = words.in_locale(self.locale);
            let _ = self.host.info(&format!("{what}: {why}"));
        }
    }

    fn motor(&mut self, port: Port) -> Option<&Motor> {
        let brick = self.brick;
        self.motors.get(port, || brick.motor(port.name()))
    }

    fn set_power(&mut self, port: Port, power: i32) {
        let result = match self.motor(port) {
            None => return self.note(port.name(), Err(Trouble::NoMotor)),
            Some(motor) => motor.set_power(power.into()),
        };
        self.note(port.name(), result);
    }

    /// What changes the display.
    fn show(&mut self, order: &str) {
        let result = self.display.order(order);
        self.note("display", result);
    }

    /// Starts a command of the system, or a line of JavaScript, beside the program; it ends with the program.
    fn start(&mut self, command: &str, is_code: bool) {
        if self.commands.len() >= limits::DIAGRAM_COMMANDS {
            return self.note("system", Err(Trouble::ManyCommands));
        }
        let mut process = if is_code {
            let mut process = child::this_program();
            process
                .arg("js")
                .arg("--tree")
                .arg(self.brick.tree().root());
            process.args(["--line", command]);
            process
        } else {
            let mut process = std::process::Command::new("sh");
            process.args(["-c", command]);
            // What helpers say is not what the program says.
            process.stdout(Stdio::null()).stderr(Stdio::null());
            process
        };
        match process.stdin(Stdio::null()).spawn() {
            Ok(child) => self.commands.push(child),
            Err(error) => self.note("system", Err(error)),
        }
    }

    fn light(&mut self, color: &str) {
        let green = matches!(color, "green" | "orange");
        let red = matches!(color, "red" | "orange");
        let result = self.brick.led().set(green, red);
        self.note("led", result);
    }

    fn append(&mut self, file: &str, text: &str) {
        let opened = OpenOptions::new().append(true).create(true).open(file);
        let result = opened.and_then(|mut file| file.write_all(text.as_bytes()));
        self.note(file, result);
    }

    fn mailbox(&mut self, question: Question<'_>) {
        let result = self.host.post(question);
        self.note("mailbox", result);
    }
}

/// The text of a file, unless it is too long or no file at all: a FIFO would keep the program waiting.
fn read_text(file: &str) -> Result<String, Trouble> {
    let opened = OpenOptions::new()
        .read(true)
        .custom_flags(nix::libc::O_NONBLOCK)
        .open(file)?;
    if !opened.metadata()?.is_file() {
        return Err(Trouble::NoFile);
    }
    let mut text = String::new();
    let limit = limits::DIAGRAM_FILE_BYTES;
    opened.take(limit + 1).read_to_string(&mut text)?;
    if text.len() as u64 > limit {
        return Err(Trouble::LongFile);
    }
    Ok(text)
}

/// A figure as an order for the display.
fn order(figure: Figure) -> String {
    let words = |verb: &str, numbers: &[i32]| {
        numbers
            .iter()
            .fold(verb.to_owned(), |words, number| format!("{words} {number}"))
    };
    match figure {
        Figure::Pixel(at) => words("point", &at),
        Figure::Line(ends) => words("line", &ends),
        Figure::Rectangle(sides, filled) => {
            format!("{} {}", words("rect", &sides), u8::from(filled))
        }
        Figure::Ellipse(sides, filled) => {
            format!("{} {}", words("ellipse", &sides), u8::from(filled))
        }
        Figure::Arc(numbers) => words("arc", &numbers),
    }
}

impl brick::Brick for Robot<'_> {
    fn command(&mut self, command: Command<'_>) {
        match command {
            Command::Power { port, percent } => self.set_power(port, percent),
            Command::Servo { port, degrees } => self.set_power(port, degrees),
            Command::Off { port, .. } => {
                let result = self.motor(port).map_or(Ok(()), Motor::power_off);
                self.note(port.name(), result);
            }
            Command::ResetEncoder { port } => {
                let result = self.readings.reset(port);
                self.note(port.name(), result);
            }
            Command::Sound { file } => self.note("sound", self.brick.sound().play(file)),
            Command::Tone { hertz, ms } => self.note("sound", self.brick.sound().tone(hertz, ms)),
            Command::Say { text } => {
                self.note("sound", self.brick.sound().say(text.unwrap_or_default()))
            }
            Command::Led { color } => self.light(color),
            Command::System { command, code } => self.start(command, code),
            Command::Append { file, text } => self.append(file, text),
            Command::Remove { file } => {
                // It may never have been there.
                let _ = std::fs::remove_file(file);
            }
            Command::StartCamera { mode, show } => {
                let result = self.readings.start_camera(mode, show);
                self.note("camera", result);
            }
            Command::StopCamera { mode } => self.readings.stop_camera(mode),
            Command::Detect { mode } => {
                let result = self.readings.detect(mode);
                self.note("camera", result);
            }
            Command::Send { message, hull } => self.mailbox(Question::Send {
                hull: hull.or(Some(-1)),
                text: message,
            }),
            Command::Join {
                address,
                port,
                hull,
            } => self.mailbox(Question::Join {
                address,
                port,
                hull,
            }),
            Command::CalibrateGyroscope => self.readings.calibrate(),
            Command::Console { text } => {
                // As above.
                let _ = self.host.print(&format!("{text}\n"));
            }
            Command::Draw(figure) => self.show(&order(figure)),
            Command::Label { x, y, size, text } => {
                let text = text.replace('\n', "\\n");
                self.show(&format!("label {x} {y} {size} {text}"));
            }
            Command::PenColor { color } => self.show(&format!("color {color}")),
            Command::PenWidth { width } => self.show(&format!("width {width}")),
            Command::Background { color } => self.show(&format!("background {color}")),
            Command::Smile { sad } => self.show(if sad { "sadsmile" } else { "smile" }),
            Command::ClearScreen => self.show("clear"),
            Command::Redraw => self.show("redraw"),
            // Pictures are made when somebody looks; a real robot has no marker; the daemon brings all to rest.
            Command::StartVideo { .. }
            | Command::StopVideo
            | Command::MarkerDown { .. }
            | Command::MarkerUp
            | Command::Rest => {}
        }
    }

    fn ask(&mut self, question: brick::Question<'_>) -> Answer {
        let host = self.host;
        self.asking
            .ask(question, Instant::now(), &mut |number, json| {
                // The daemon may be gone; then this process ends soon.
                let _ = host.question(number, json);
            })
    }

    fn may_ask_again(&mut self, question: brick::Question<'_>) -> bool {
        self.asking.may_again(question, Instant::now())
    }

    fn ask_again(&mut self, question: brick::Question<'_>, why: &[Problem]) {
        let said: Vec<String> = why.iter().map(|one| one.said(self.locale)).collect();
        let host = self.host;
        self.asking.again(
            question,
            &said.join("\n"),
            Instant::now(),
            &mut |number, json| {
                // As of the question itself.
                let _ = host.question(number, json);
            },
        );
    }

    fn scalar(&mut self, port: Port) -> Option<i32> {
        self.readings.scalar(port)
    }

    fn vector(&mut self, port: Port, into: &mut Vec<i32>) -> bool {
        self.readings.vector(port, into)
    }

    fn random(&mut self, low: i32, high: i32) -> i32 {
        self.random.between(low, high)
    }

    fn mail(&mut self) -> Option<String> {
        self.mail.pop_front().map(|(_, text)| text)
    }

    fn letter(&mut self) -> Option<(Option<i32>, String)> {
        let (sender, text) = self.mail.pop_front()?;
        Some((Some(sender), text))
    }

    fn contents(&mut self, file: &str) -> Option<String> {
        let read = read_text(file);
        match read {
            Ok(text) => Some(text),
            Err(error) => {
                self.note(file, Err::<(), _>(error));
                None
            }
        }
    }
}
