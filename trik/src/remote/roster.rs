//! The robots of a class, as a file names them: a line for each with its name, where it is, and perhaps its group.
//!
//! Owns the form of the file. Where a robot is at the moment is known to `target`, which is asked each time: a virtual robot has
//! another address whenever it starts.

use super::output::harmless;
use super::target::{Target, is_path, target};
use crate::error::Error;
use crate::input;
use crate::input::words::{A_CLASS, no_text, why};
use crate::limits;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Before the port of the page of a robot.
const PAGE: &str = "page=";
/// What a line has.
const FORM: &str = "a line is NAME ADDRESS [GROUP] [page=PORT]";

/// A robot of a class.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Robot {
    /// What people call it.
    pub name: String,
    /// Its address, or the path where the tree of a virtual one is mounted.
    pub at: String,
    /// Those that are together have the same; empty: it is in none.
    pub group: String,
    /// Where browsers find its page, at its address.
    pub page: Option<u16>,
}

impl Robot {
    /// Where it takes programs now.
    ///
    /// # Errors
    /// No virtual robot that takes programs is mounted at its path.
    pub(crate) fn target(&self) -> Result<Target, Error> {
        target(&self.at)
    }
}

/// Robots that belong together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Class {
    /// The name of the file, without its ending, and the group.
    pub name: String,
    /// In the order of the file.
    pub robots: Vec<Robot>,
}

/// `FILE`, or `FILE:GROUP` for a part of it.
///
/// # Errors
/// The file cannot be read, a line of it is wrong, or nobody is in that group.
pub(crate) fn class(text: &str) -> Result<Class, Error> {
    let whole = Path::new(text);
    match text.rsplit_once(':') {
        Some((file, group)) if !whole.exists() => {
            let mut class = read(Path::new(file))?;
            let groups: BTreeSet<String> =
                class.robots.iter().map(|one| one.group.clone()).collect();
            class.robots.retain(|robot| robot.group == group);
            if group.is_empty() || class.robots.is_empty() {
                let known: Vec<_> = groups.into_iter().filter(|name| !name.is_empty()).collect();
                let known = match &known[..] {
                    [] => "it has no groups".to_owned(),
                    names => format!("it has {}", names.join(", ")),
                };
                let why = format!("no robot is in the group '{group}': {known}");
                return Err(Error::file(Path::new(file), why));
            }
            class.name = format!("{}: {group}", class.name);
            Ok(class)
        }
        _ => read(whole),
    }
}

fn read(path: &Path) -> Result<Class, Error> {
    let most = limits::CLASS_BYTES_MAX;
    let bytes = input::read(path, most)
        .map_err(|unread| Error::file(path, why(&unread, most, A_CLASS).english))?;
    let text = String::from_utf8(bytes).map_err(|_| Error::file(path, no_text().english))?;
    // A path keeps its slash, by which it is known as one.
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let robots = parse(&text, folder).map_err(|(line, why)| {
        let place = PathBuf::from(format!("{}:{line}", path.display()));
        Error::file(&place, why)
    })?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    Ok(Class {
        name: harmless(&name),
        robots,
    })
}

/// The robots of a text; or the number of a line, and what is wrong with it. Paths are those seen from the folder.
fn parse(text: &str, folder: &Path) -> Result<Vec<Robot>, (usize, String)> {
    let mut robots: Vec<Robot> = Vec::new();
    let mut lines: Vec<usize> = Vec::new();
    let mut last = 0;
    for (number, line) in (1..).zip(text.lines()) {
        last = number;
        let Some(robot) = robot(line, folder).map_err(|why| (number, why.to_string()))? else {
            continue;
        };
        let same = |other: &Robot| other.name == robot.name || other.at == robot.at;
        if let Some(index) = robots.iter().position(same) {
            let what = match robots[index].name == robot.name {
                true => format!("'{}'", robot.name),
                false => robot.at,
            };
            return Err((
                number,
                format!("{what} is already in line {}", lines[index]),
            ));
        }
        if robots.len() == limits::FLEET_MAX {
            return Err((number, format!("more than {} robots", limits::FLEET_MAX)));
        }
        robots.push(robot);
        lines.push(number);
    }
    match robots.is_empty() {
        true => Err((last.max(1), format!("the file names no robot: {FORM}"))),
        false => Ok(robots),
    }
}

/// The robot of a line; None: the line names none.
fn robot(line: &str, folder: &Path) -> Result<Option<Robot>, Error> {
    let mut words = line
        .split_whitespace()
        .take_while(|word| !word.starts_with('#'));
    let Some(name) = words.next() else {
        return Ok(None);
    };
    let most = limits::CLASS_NAME_BYTES_MAX;
    check(name, most)?;
    let at = words
        .next()
        .ok_or_else(|| wrong(format!("'{name}' has no address: {FORM}")))?;
    if at.chars().any(char::is_control) {
        return Err(wrong(format!(
            "the address of '{name}' has control characters"
        )));
    }
    let at = match is_path(at) {
        // Whether a robot is there is seen when somebody wants something of it.
        true => folder
            .join(at.trim_start_matches("./"))
            .to_string_lossy()
            .into_owned(),
        false => {
            target(at).map_err(|why| wrong(format!("'{at}': {why}")))?;
            at.to_owned()
        }
    };
    let mut robot = Robot {
        name: name.to_owned(),
        at,
        group: String::new(),
        page: None,
    };
    for word in words {
        if let Some(port) = word.strip_prefix(PAGE) {
            let port = port.parse().ok().filter(|port| *port > 0);
            let port: u16 =
                port.ok_or_else(|| wrong(format!("'{word}': a port is a number from 1 to 65535")))?;
            robot.page = Some(port);
        } else if robot.group.is_empty() {
            check(word, most)?;
            word.clone_into(&mut robot.group);
        } else {
            return Err(wrong(format!("'{word}' is too much: {FORM}")));
        }
    }
    Ok(Some(robot))
}

/// A line that says what nobody understands.
fn wrong(why: impl Into<String>) -> Error {
    Error::Refused(why.into())
}

/// Whether a word can be the name of a robot or of a group.
fn check(word: &str, most: usize) -> Result<(), Error> {
    if word.len() > most {
        return Err(wrong(format!("a name is longer than {most} bytes")));
    }
    let fits = |c: char| !c.is_control() && !",:/=".contains(c);
    match word.chars().all(fits) {
        true => Ok(()),
        false => Err(wrong(
            "a name has none of , : / = and no control characters",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(text: &str) -> String {
        let (line, why) = parse(text, Path::new("/class")).expect_err(text);
        format!("{line}: {why}")
    }

    #[test]
    fn a_line_names_a_robot_and_comments_name_none() {
        let text = "# Room 12\n\nanna 192.168.77.11 red # by the window\n\
                    boris\t192.168.77.12:9  blue page=8000\nsim ./robot\nfar /tmp/robot page=1\n";
        let robots = parse(text, Path::new("/class")).expect("robots");
        let shown: Vec<_> = robots
            .iter()
            .map(|one| {
                (
                    one.name.as_str(),
                    one.at.as_str(),
                    one.group.as_str(),
                    one.page,
                )
            })
            .collect();
        assert_eq!(
            shown,
            [
                ("anna", "192.168.77.11", "red", None),
                ("boris", "192.168.77.12:9", "blue", Some(8000)),
                ("sim", "/class/robot", "", None),
                ("far", "/tmp/robot", "", Some(1)),
            ]
        );
    }

    #[test]
    fn a_mistake_is_told_with_its_line() {
        for (text, why) in [
            ("", "1: the file names no robot: a line is NAME ADDRESS"),
            ("# none\n", "1: the file names no robot"),
            ("\nanna\n", "2: 'anna' has no address: a line is NAME"),
            ("anna 1.2.3.4:x", "1: '1.2.3.4:x': 'x' is no port"),
            ("anna a_b!", "1: 'a_b!': no address"),
            ("anna a\nanna b", "2: 'anna' is already in line 1"),
            ("anna a\n\nboris a", "3: a is already in line 1"),
            ("anna a red blue", "1: 'blue' is too much: a line is"),
            ("anna a page=0", "1: 'page=0': a port is"),
            ("anna a page=x", "1: 'page=x': a port is"),
            ("a,b a", "1: a name has none of"),
            ("a\u{1b} a", "1: a name has none of"),
            ("a /tmp/\u{1b}]0;x", "1: the address of 'a' has control"),
            ("a b r:d", "1: a name has none of"),
        ] {
            let told = told(text);
            assert!(told.starts_with(why), "{text}: {told}");
        }
        let long = format!("{} a", "x".repeat(limits::CLASS_NAME_BYTES_MAX + 1));
        assert!(told(&long).contains("longer than"), "{}", told(&long));
        let many: Vec<_> = (0..=limits::FLEET_MAX)
            .map(|one| format!("r{one} h{one}\n"))
            .collect();
        assert_eq!(told(&many.concat()), "65: more than 64 robots");
    }

    #[test]
    fn a_group_is_a_part_of_a_class() {
        let home = tempfile::tempdir().expect("a directory");
        let file = home.path().join("class.txt");
        std::fs::write(&file, "anna a red\nboris b blue\nclara c red\n").expect("a file");
        let names = |text: &str| -> Result<Vec<String>, String> {
            let class = class(text).map_err(|why| why.to_string())?;
            Ok(class.robots.into_iter().map(|one| one.name).collect())
        };
        let path = file.display().to_string();
        assert_eq!(
            names(&path),
            Ok(["anna", "boris", "clara"].map(str::to_owned).to_vec())
        );
        let red = names(&format!("{path}:red"));
        assert_eq!(red, Ok(["anna", "clara"].map(str::to_owned).to_vec()));
        for group in ["green", ""] {
            let why = names(&format!("{path}:{group}")).expect_err("no such group");
            assert!(why.ends_with("it has blue, red"), "{why}");
        }
        assert!(names("/none/class.txt").is_err());
        // What gives nothing is not waited for.
        let pipe = home.path().join("pipe");
        nix::unistd::mkfifo(&pipe, nix::sys::stat::Mode::S_IRWXU).expect("a FIFO");
        std::fs::write(&file, [0xff, 0xfe]).expect("a file");
        for (path, why) in [
            (pipe.display().to_string(), "nothing comes out of this FIFO"),
            (path.clone(), "this is no text in UTF-8"),
            (home.path().display().to_string(), "this is a directory"),
        ] {
            let told = names(&path).expect_err(why);
            assert!(told.contains(why), "{told}");
        }
        std::fs::write(&file, "anna\n").expect("a file");
        let why = names(&path).expect_err("no address");
        assert!(
            why.starts_with(&format!("{path}:1: 'anna' has no address")),
            "{why}"
        );
        let large = std::fs::File::create(&file).expect("a file");
        large.set_len(limits::CLASS_BYTES_MAX + 1).expect("a hole");
        assert!(
            names(&path)
                .expect_err("too long")
                .contains("longer than 64 KiB")
        );
    }
}
