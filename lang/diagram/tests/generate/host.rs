//! The robot's side of a generated program: the stand-in in virtual time, and whose turn it is.
//!
//! Owns the words between the shims (`shim.js`, `shim.py`, `shim.lua`) and the stand-in. One thread of the program runs
//! at a time: one that waits hands over to the one that is due first, and time passes only when all wait.

use std::collections::{BTreeMap, VecDeque};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command as Process, Stdio};

use lang_diagram::brick::{Brick, Command, Figure};
use lang_diagram::machine::STEP_MS;
use lang_diagram::ports::{Direction, Kit, Port, Sort};
use lang_diagram::stand_in::StandIn;

/// Model time after which a program has shown enough.
pub const MODEL_MS: u32 = 60_000;
/// Lines of a program that does nothing but ask.
const LINES_MAX: usize = 400_000;
/// How often a program may look at sensors in one step of the world.
const LINES_IN_A_STEP: u32 = 50;

#[derive(Debug)]
enum Thread {
    /// Somebody else runs first.
    Ready,
    /// Until this time; who came first goes first.
    Waits(u32, u32),
    /// Until this thread has ended.
    Joins(String),
    /// Until a message comes.
    Receives,
}

struct Host<'a> {
    robot: &'a mut StandIn,
    threads: BTreeMap<u32, Thread>,
    names: BTreeMap<String, u32>,
    mail: BTreeMap<u32, VecDeque<String>>,
    /// Who goes on at once, the last one first.
    ready: Vec<u32>,
    began: u32,
    /// Readings as of the last refresh, which is every second step.
    cached: BTreeMap<String, String>,
    /// Lines since somebody waited.
    asked: u32,
    /// Whether the red light is on.
    red: bool,
}

/// Runs a program until it ends or has told enough; tells whether it ended, or its complaint.
pub fn run(
    command: &[&str],
    program: &Path,
    robot: &mut StandIn,
    enough: usize,
) -> Result<bool, String> {
    let mut child = Process::new(command[0])
        .args(&command[1..])
        .arg(program)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| error.to_string())?;
    let mut input = child.stdin.take().unwrap();
    let output = BufReader::new(child.stdout.take().unwrap());
    let mut host = Host {
        robot,
        threads: BTreeMap::from([(0, Thread::Ready)]),
        names: BTreeMap::from([("main".to_owned(), 0)]),
        mail: BTreeMap::new(),
        ready: Vec::new(),
        began: 0,
        cached: BTreeMap::new(),
        asked: 0,
        red: false,
    };
    host.began = host.robot.now();
    let mut ended = false;
    for line in output.lines().take(LINES_MAX) {
        let line = line.map_err(|error| error.to_string())?;
        let words: Vec<String> = line.split('\t').map(unescape).collect();
        let words: Vec<&str> = words.iter().map(String::as_str).collect();
        let answer = host.answer(&words);
        if let Some(answer) = answer {
            ended = answer == "quit";
            // A child that is gone says why on its standard error.
            if writeln!(input, "{answer}")
                .and_then(|()| input.flush())
                .is_err()
            {
                break;
            }
        }
        if ended || host.robot.log.len() >= enough || host.robot.now() - host.began > MODEL_MS {
            break;
        }
    }
    let is_enough =
        ended || host.robot.log.len() >= enough || host.robot.now() - host.began > MODEL_MS;
    if is_enough {
        let _ = child.kill();
        let _ = child.wait();
        return Ok(ended);
    }
    drop(input);
    let output = child
        .wait_with_output()
        .map_err(|error| error.to_string())?;
    Err(format!(
        "it stopped by itself: {}",
        String::from_utf8_lossy(&output.stderr)
    ))
}

fn unescape(text: &str) -> String {
    let mut out = String::new();
    let mut letters = text.chars();
    while let Some(letter) = letters.next() {
        out.push(match (letter, letter == '\\') {
            (_, true) => match letters.next() {
                Some('t') => '\t',
                Some('n') => '\n',
                other => other.unwrap_or('\\'),
            },
            (letter, false) => letter,
        });
    }
    out
}

fn number(text: &str) -> i32 {
    let number: f64 = text
        .parse()
        .unwrap_or_else(|_| panic!("{text:?} is no number"));
    assert_eq!(number, number.trunc(), "{text} is not whole");
    number as i32
}

fn numbers<const N: usize>(words: &[&str]) -> [i32; N] {
    assert!(words.len() >= N, "{words:?}");
    std::array::from_fn(|at| number(words[at]))
}

fn port(name: &str, way: Direction) -> Port {
    Port::find(Kit::V62, name, way).unwrap_or_else(|| panic!("no port {name:?}"))
}

impl Host<'_> {
    fn answer(&mut self, words: &[&str]) -> Option<String> {
        let id = || words[1].parse::<u32>().unwrap();
        match words[0] {
            "scalar" => Some(self.reading(words[1])),
            "vector" => Some(self.reading(words[1])),
            "key" => {
                let code = number(words[1]);
                let is_it = |port: &Port| port.sort() == Sort::Button(code);
                let port = Port::all().find(is_it).unwrap();
                Some(self.reading(port.name()))
            }
            "anykey" => {
                let pressed = Port::all().find_map(|port| match port.sort() {
                    Sort::Button(code) if self.robot.scalar(port) != Some(0) => Some(code),
                    _ => None,
                });
                Some(pressed.unwrap_or(-1).to_string())
            }
            "random" => Some(
                self.robot
                    .random(number(words[1]), number(words[2]))
                    .to_string(),
            ),
            "time" => Some(self.robot.now().to_string()),
            "read" => Some(self.read(words[1])),
            "write" => {
                self.write(words[1], words[2]);
                None
            }
            "message" => {
                let message = self.mail.entry(id()).or_default().pop_front();
                Some(message.unwrap_or_default())
            }
            "wait" | "start" | "join" | "kill" | "send" | "receive" | "end" => {
                Some(self.turn(words))
            }
            _ => {
                self.tell(words);
                None
            }
        }
    }

    /// Who runs after somebody has done something with threads.
    fn turn(&mut self, words: &[&str]) -> String {
        let id = || words[1].parse::<u32>().unwrap();
        match words[0] {
            "wait" => {
                self.asked = 0;
                let wait = u32::try_from(number(words[2]).max(1)).unwrap();
                let until = self.robot.now() + wait.div_ceil(STEP_MS) * STEP_MS;
                let order = self.robot.log.len() as u32;
                self.threads.insert(id(), Thread::Waits(until, order));
                self.next()
            }
            "start" => {
                let new = words[2].parse().unwrap();
                self.threads.insert(id(), Thread::Ready);
                self.ready.push(id());
                self.threads.insert(new, Thread::Ready);
                self.names.insert(words[3].to_owned(), new);
                new.to_string()
            }
            "join" => {
                if self.names.contains_key(words[2]) {
                    self.threads
                        .insert(id(), Thread::Joins(words[2].to_owned()));
                    return self.next();
                }
                words[1].to_owned()
            }
            "kill" => {
                if let Some(killed) = self.names.remove(words[2]) {
                    self.forget(killed);
                    if killed == id() {
                        return self.next();
                    }
                }
                words[1].to_owned()
            }
            "send" => {
                if let Some(&to) = self.names.get(words[2]) {
                    let mail = self.mail.entry(to).or_default();
                    mail.push_back(words[3].to_owned());
                    if matches!(self.threads.get(&to), Some(Thread::Receives)) {
                        // The thread that waited for it goes first.
                        self.threads.insert(to, Thread::Ready);
                        self.threads.insert(id(), Thread::Ready);
                        self.ready.push(id());
                        return to.to_string();
                    }
                }
                words[1].to_owned()
            }
            "receive" => {
                if self.mail.get(&id()).is_some_and(|mail| !mail.is_empty()) {
                    return words[1].to_owned();
                }
                self.threads.insert(id(), Thread::Receives);
                self.next()
            }
            _ => {
                self.forget(id());
                self.next()
            }
        }
    }

    /// What a file of the tree has.
    fn read(&mut self, name: &str) -> String {
        let parts: Vec<&str> = name.split('/').collect();
        match parts[..] {
            ["sensors" | "encoders", port, "value"] => self.reading(port),
            ["keys", "value"] => {
                let keys = ["Power", "Up", "Esc", "Left", "Right", "Down", "Enter"];
                keys.map(|key| self.reading(key)).join(" ")
            }
            ["camera", "line", "value"] => self.reading("LineSensorPort"),
            ["accelerometer", "value"] => self.reading("AccelerometerPort"),
            ["gyroscope", "heading"] => {
                let all = self.reading("GyroscopePort");
                all.split(' ').nth(6).unwrap().to_owned()
            }
            ["gyroscope", _] => "0 0 0".to_owned(),
            _ => panic!("no file {name}"),
        }
    }

    /// What a text means that is written to a file of the tree.
    fn write(&mut self, name: &str, text: &str) {
        let parts: Vec<&str> = name.split('/').collect();
        match parts[..] {
            ["motors", port, "value"] => self.tell(&["power", port, text]),
            ["motors", port, "brake"] => self.tell(&["off", port]),
            ["servos", port, "value"] => self.tell(&["servo", port, text]),
            ["encoders", port, "value"] => self.tell(&["reset", port]),
            ["sound", "play", "value"] => self.tell(&["sound", text]),
            ["sound", "say", "value"] => self.tell(&["say", text]),
            ["sound", "tone", "value"] => {
                let (hertz, ms) = text.split_once(' ').unwrap();
                self.tell(&["tone", hertz, ms]);
            }
            ["camera", mode, "detect"] => self.tell(&["detect", mode]),
            ["led", "red", "value"] => self.red = text == "1",
            ["led", "green", "value"] => {
                let color = match (self.red, text) {
                    (true, "1") => "orange",
                    (true, _) => "red",
                    (false, "1") => "green",
                    (false, _) => "off",
                };
                self.tell(&["led", color]);
            }
            ["stop"] => self.tell(&["rest"]),
            _ => panic!("no file {name}"),
        }
    }

    fn forget(&mut self, thread: u32) {
        self.threads.remove(&thread);
        self.ready.retain(|&other| other != thread);
        self.names.retain(|_, &mut other| other != thread);
    }

    /// Who runs next; time passes if nobody can.
    fn next(&mut self) -> String {
        if let Some(thread) = self.ready.pop() {
            return thread.to_string();
        }
        let names = &self.names;
        let joined = self.threads.iter().find_map(|(&id, thread)| match thread {
            Thread::Joins(name) if !names.contains_key(name) => Some(id),
            _ => None,
        });
        if let Some(joined) = joined {
            return joined.to_string();
        }
        let waiting = self
            .threads
            .iter()
            .filter_map(|(&id, thread)| match thread {
                Thread::Waits(until, order) => Some((*until, *order, id)),
                _ => None,
            });
        let Some((until, _, id)) = waiting.min() else {
            return "quit".to_owned();
        };
        while self.robot.now() < until {
            self.tick();
        }
        id.to_string()
    }

    /// One step of the world. What was read before is refreshed after each second one, when all have run, as the
    /// original refreshes the variables of sensors.
    fn tick(&mut self) {
        if ((self.robot.now() - self.began) / STEP_MS).is_multiple_of(2) {
            let names: Vec<String> = self.cached.keys().cloned().collect();
            for name in names {
                let now = self.measured(&name);
                self.cached.insert(name, now);
            }
        }
        self.robot.tick();
    }

    /// A reading as a variable of the original shows it: the same until the next refresh.
    fn reading(&mut self, name: &str) -> String {
        self.asked += 1;
        if self.asked > LINES_IN_A_STEP {
            // A program that only looks and never waits takes time as well.
            self.asked = 0;
            self.tick();
        }
        if let Some(known) = self.cached.get(name) {
            return known.clone();
        }
        let now = self.measured(name);
        self.cached.insert(name.to_owned(), now.clone());
        now
    }

    fn measured(&mut self, name: &str) -> String {
        let port = port(name, Direction::In);
        if port.sort() != Sort::Vector {
            return self.robot.scalar(port).unwrap_or(0).to_string();
        }
        let mut all = Vec::new();
        self.robot.vector(port, &mut all);
        let all: Vec<String> = all.iter().map(i32::to_string).collect();
        all.join(" ")
    }

    fn tell(&mut self, words: &[&str]) {
        let text = words.get(1).copied().unwrap_or("");
        let second = words.get(2).copied().unwrap_or("");
        let rest = &words[1..];
        let command = match words[0] {
            "power" => Command::Power {
                port: port(text, Direction::Out),
                percent: number(second).clamp(-100, 100),
            },
            "off" => Command::Off {
                port: port(text, Direction::Out),
                brake: false,
            },
            "servo" => Command::Servo {
                port: port(text, Direction::Out),
                degrees: number(second),
            },
            "reset" => Command::ResetEncoder {
                port: port(text, Direction::In),
            },
            "sound" => Command::Sound { file: text },
            "tone" => Command::Tone {
                hertz: number(text),
                ms: number(second),
            },
            "say" => Command::Say { text: Some(text) },
            "led" => Command::Led { color: text },
            "system" => Command::System {
                command: text,
                code: false,
            },
            "append" => Command::Append {
                file: text,
                text: second,
            },
            "remove" => Command::Remove { file: text },
            "camera" => Command::StartCamera {
                mode: text,
                show: second == "1",
            },
            "detect" => Command::Detect { mode: text },
            "calibrate" => Command::CalibrateGyroscope,
            "print" => Command::Console { text },
            "pen" => Command::PenColor { color: text },
            "width" => Command::PenWidth {
                width: number(text),
            },
            "background" => Command::Background { color: text },
            "pixel" => Command::Draw(Figure::Pixel(numbers(rest))),
            "line" => Command::Draw(Figure::Line(numbers(rest))),
            "rectangle" => Command::Draw(Figure::Rectangle(numbers(rest), rest[4] == "1")),
            "ellipse" => Command::Draw(Figure::Ellipse(numbers(rest), rest[4] == "1")),
            "arc" => Command::Draw(Figure::Arc(numbers(rest))),
            "label" => Command::Label {
                x: number(text),
                y: number(second),
                size: number(rest[2]),
                text: rest[3],
            },
            "smile" => Command::Smile { sad: text == "1" },
            "clear" => Command::ClearScreen,
            "redraw" => Command::Redraw,
            "marker" => Command::MarkerDown { color: text },
            "markerup" => Command::MarkerUp,
            "rest" => Command::Rest,
            other => panic!("a word that nobody knows: {other}"),
        };
        self.robot.command(command);
    }
}
