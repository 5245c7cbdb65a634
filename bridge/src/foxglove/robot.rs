//! What clients may read and change of a robot: parameters and services.
//!
//! Owns their names, and how a file of a tree is one. Parameters are `NODE/poll_ms`, `NODE/polarity`, `NODE/params/NAME`, and
//! `diagram/NAME` for variables of the diagram that runs. Programs are the business of code that implements [`Programs`].

use crate::limits::{PARAMETER_BYTES_MAX, PARAMETERS_MAX, SNAPSHOT_TIME};
use recorder::nodes;
use serde_json::Value;
use std::collections::HashSet;
use std::fmt;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// A service: its name, and those of the texts that it takes. Its number is its place, from 1.
pub type Service = (&'static str, &'static [&'static str]);
/// All of them.
pub const SERVICES: [Service; 2] = [("/stop", &[]), ("/run", &["file"])];
/// The first ones are for everybody: anyone who sees danger may stop the robot, as by its trikd.
const FOR_ALL: usize = 1;
/// Files of a node that are parameters.
const FILES: [&str; 2] = ["poll_ms", "polarity"];
/// What names of variables begin with.
const DIAGRAM: &str = "diagram/";

/// The services for a client that may act, or only looks.
pub fn services(may_act: bool) -> &'static [Service] {
    match may_act {
        true => &SERVICES,
        false => &SERVICES[..FOR_ALL],
    }
}

/// Whether the service with this number is for everybody.
pub fn is_for_all(service: u32) -> bool {
    usize::try_from(service).is_ok_and(|id| (1..=FOR_ALL).contains(&id))
}

/// Values of parameters by their names; one that cannot be read has none.
pub type Parameters = Vec<(String, Option<Value>)>;

/// Why something is not done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Refused {
    /// There is no parameter with this name.
    Absent(String),
    /// It is no number, text or truth.
    Value(String),
    /// The tree does not take it: why.
    Tree(String, String),
    /// No program is known that does it, or it does not: why.
    Program(String),
    /// There is no service with this number.
    Service(u32),
    /// The service needs this text.
    Argument(&'static str),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent(name) => write!(f, "{name}: there is no such parameter"),
            Self::Value(name) => {
                write!(
                    f,
                    "{name}: the value must be a number, a text, true or false"
                )
            }
            Self::Tree(name, why) => write!(f, "{name}: {why}"),
            Self::Program(why) => f.write_str(why),
            Self::Service(id) => write!(f, "there is no service {id}"),
            Self::Argument(name) => write!(f, "the service needs '{name}', a text"),
        }
    }
}

impl std::error::Error for Refused {}

/// The programs of a robot, where somebody takes them.
pub trait Programs: Send + Sync {
    /// The variables of the diagram that runs; none if none does.
    fn variables(&self) -> Vec<(String, Value)>;

    /// Nobody wants to hear of variables for now: what is kept to read them may go.
    fn rest(&self);

    /// Assigns one of them.
    ///
    /// # Errors
    /// Nobody takes it.
    fn assign(&self, name: &str, value: &Value) -> Result<(), Refused>;

    /// Runs a program that the robot has.
    ///
    /// # Errors
    /// It has none of this name, or nobody runs programs.
    fn run(&self, file: &str) -> Result<(), Refused>;

    /// Ends the program that runs.
    ///
    /// # Errors
    /// It goes on.
    fn stop(&self) -> Result<(), Refused>;
}

/// A robot with its tree.
pub struct Robot {
    root: PathBuf,
    programs: Option<Box<dyn Programs>>,
    /// What was read last, and when.
    snapshot: Mutex<Option<(Instant, Arc<Parameters>)>>,
}

impl Robot {
    /// The one whose tree is there; without programs, if nobody takes any.
    pub fn new(root: &Path, programs: Option<Box<dyn Programs>>) -> Self {
        Self {
            root: root.to_owned(),
            programs,
            snapshot: Mutex::new(None),
        }
    }

    fn snapshot(&self) -> MutexGuard<'_, Option<(Instant, Arc<Parameters>)>> {
        self.snapshot.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Paths of the files that are parameters.
    fn files(&self) -> Vec<String> {
        let mut all = Vec::new();
        for node in nodes::find(&self.root) {
            let directory = self.root.join(&node.path);
            let files = FILES.iter().map(|file| (*file).to_owned());
            let params = directory.join("params").read_dir().into_iter().flatten();
            let params = params
                .flatten()
                .filter_map(|one| one.file_name().into_string().ok());
            let mut params: Vec<String> = params.map(|name| format!("params/{name}")).collect();
            params.sort();
            let files = files.filter(|file| is_writable(&directory.join(file)));
            all.extend(
                files
                    .chain(params)
                    .map(|file| format!("{}/{file}", node.path)),
            );
            if all.len() >= PARAMETERS_MAX {
                all.truncate(PARAMETERS_MAX);
                break;
            }
        }
        all
    }

    /// All parameters with their values, as they were a short time ago at most: those who ask together share one look.
    pub fn parameters(&self) -> Arc<Parameters> {
        let mut snapshot = self.snapshot();
        match &*snapshot {
            Some((at, all)) if at.elapsed() < SNAPSHOT_TIME => all.clone(),
            Some(_) | None => {
                let all = Arc::new(self.read());
                // Those who waited for a slow robot share what it has said.
                *snapshot = Some((Instant::now(), all.clone()));
                all
            }
        }
    }

    fn read(&self) -> Parameters {
        let files = self.files().into_iter();
        let mut all: Vec<_> = files
            .map(|name| {
                let value = read(&self.root.join(&name), name.contains("/params/"));
                (name, value.ok())
            })
            .collect();
        let variables = self
            .programs
            .iter()
            .flat_map(|programs| programs.variables());
        let variables = variables.map(|(name, value)| (format!("{DIAGRAM}{name}"), Some(value)));
        all.extend(variables.take(PARAMETERS_MAX));
        all
    }

    /// Nobody wants to hear of parameters for now.
    pub fn rest(&self) {
        if let Some(programs) = &self.programs {
            programs.rest();
        }
    }

    /// Gives parameters values; those that are not taken, and why.
    pub fn set(&self, values: &[(String, Value)]) -> Vec<Refused> {
        // Only what is in the list: a name of a stranger is no path.
        let known: HashSet<String> = match values.iter().all(|(name, _)| name.starts_with(DIAGRAM))
        {
            true => HashSet::new(),
            false => self.files().into_iter().collect(),
        };
        let one = |(name, value): &(String, Value)| match name.strip_prefix(DIAGRAM) {
            Some(variable) => self.programs()?.assign(variable, value),
            None if known.contains(name) => self.write(name, value),
            None => Err(Refused::Absent(name.clone())),
        };
        let refused = values.iter().filter_map(|pair| one(pair).err()).collect();
        // The next look sees what was taken.
        *self.snapshot() = None;
        refused
    }

    fn write(&self, name: &str, value: &Value) -> Result<(), Refused> {
        let text = match value {
            Value::Bool(truth) => u8::from(*truth).to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) => text.clone(),
            Value::Null | Value::Array(_) | Value::Object(_) => {
                return Err(Refused::Value(name.to_owned()));
            }
        };
        let file = OpenOptions::new()
            .write(true)
            .truncate(true)
            .open(self.root.join(name));
        let written = file.and_then(|mut file| file.write_all(format!("{text}\n").as_bytes()));
        written.map_err(|why| Refused::Tree(name.to_owned(), why.to_string()))
    }

    /// Does what a service is for.
    ///
    /// # Errors
    /// It cannot be done.
    pub fn call(&self, service: u32, arguments: &Value) -> Result<(), Refused> {
        let index = usize::try_from(service)
            .ok()
            .and_then(|id| id.checked_sub(1));
        let (name, _) = index
            .and_then(|index| SERVICES.get(index))
            .ok_or(Refused::Service(service))?;
        if *name == "/stop" {
            return self.stop();
        }
        let file = arguments.get("file").and_then(Value::as_str);
        self.run(file.ok_or(Refused::Argument("file"))?)
    }

    /// Brings everything to rest and ends the program.
    ///
    /// # Errors
    /// The tree does not take it, or the program goes on.
    pub fn stop(&self) -> Result<(), Refused> {
        // The motors first: a program may take its time.
        let rest = std::fs::write(self.root.join("stop"), "1\n");
        let ended = self
            .programs
            .as_ref()
            .map_or(Ok(()), |programs| programs.stop());
        rest.map_err(|why| Refused::Tree("stop".to_owned(), why.to_string()))?;
        ended
    }

    /// Runs a program that the robot has.
    ///
    /// # Errors
    /// It has none of this name, or nobody runs programs.
    pub fn run(&self, file: &str) -> Result<(), Refused> {
        self.programs()?.run(file)
    }

    fn programs(&self) -> Result<&dyn Programs, Refused> {
        let none = "nobody takes programs for this robot: no trikd of it is known";
        self.programs
            .as_deref()
            .ok_or_else(|| Refused::Program(none.to_owned()))
    }
}

fn is_writable(path: &Path) -> bool {
    path.metadata()
        .is_ok_and(|about| about.is_file() && about.permissions().mode() & 0o222 != 0)
}

/// The value in a file: a number, or a text.
fn read(path: &Path, is_float: bool) -> io::Result<Value> {
    let mut text = String::new();
    File::open(path)?
        .take(PARAMETER_BYTES_MAX)
        .read_to_string(&mut text)?;
    let text = text.trim();
    let whole = text.parse::<i64>().ok().filter(|_| !is_float);
    let number = || text.parse::<f64>().ok().filter(|number| number.is_finite());
    Ok(match (whole, number()) {
        (Some(whole), _) => Value::from(whole),
        (None, Some(number)) => Value::from(number),
        (None, None) => Value::from(text),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::sync::atomic::{AtomicUsize, Ordering};

    #[test]
    fn a_value_is_a_number_or_a_text() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("x");
        for (text, is_float, value) in [
            ("20\n", false, Value::from(20)),
            ("20\n", true, Value::from(20.0)),
            ("0.5", false, Value::from(0.5)),
            ("nan", true, Value::from("nan")),
            ("normal\n", false, Value::from("normal")),
        ] {
            fs::write(&path, text).unwrap();
            assert_eq!(read(&path, is_float).unwrap(), value);
        }
    }

    #[test]
    fn only_parameters_are_written_and_only_services_called() {
        let directory = tempfile::tempdir().unwrap();
        let root = directory.path();
        fs::create_dir_all(root.join("a/params")).unwrap();
        for (name, text) in [
            ("bin_data", "\0\0\0\0"),
            ("format", "i32 x\n"),
            ("poll_ms", "20\n"),
            ("params/gain", "1.5\n"),
        ] {
            fs::write(root.join("a").join(name), text).unwrap();
        }
        fs::write(root.join("secret"), "x").unwrap();
        let robot = Robot::new(root, None);
        let set = |name: &str, value: Value| robot.set(&[(name.to_owned(), value)]);
        let are = |gain: f64| {
            vec![
                ("a/poll_ms".to_owned(), Some(Value::from(20))),
                ("a/params/gain".to_owned(), Some(Value::from(gain))),
            ]
        };
        let first = robot.parameters();
        assert_eq!(*first, are(1.5));
        // What is set by a client is there at once.
        let both = ["a/params/gain", "b"].map(|name| (name.to_owned(), Value::from(2)));
        assert_eq!(robot.set(&both), [Refused::Absent("b".to_owned())]);
        assert_eq!(*robot.parameters(), are(2.0));
        assert_eq!(
            fs::read_to_string(root.join("a/params/gain")).unwrap(),
            "2\n"
        );
        for name in [
            "secret",
            "../secret",
            "a/../secret",
            "a/format",
            "/etc/passwd",
            "",
        ] {
            let refused = set(name, Value::from(1));
            assert_eq!(refused, [Refused::Absent(name.to_owned())]);
        }
        let none = set("a/poll_ms", Value::Null);
        assert_eq!(none, [Refused::Value("a/poll_ms".to_owned())]);
        assert!(matches!(
            set("diagram/x", Value::from(1))[..],
            [Refused::Program(_)]
        ));
        robot.call(1, &Value::Null).unwrap();
        assert_eq!(fs::read_to_string(root.join("stop")).unwrap(), "1\n");
        assert!(matches!(
            robot.call(2, &Value::Null),
            Err(Refused::Program(_) | Refused::Argument(_))
        ));
        for id in [0, 3, u32::MAX] {
            assert_eq!(robot.call(id, &Value::Null), Err(Refused::Service(id)));
        }
    }

    /// Programs that count how often they are asked.
    #[derive(Default)]
    struct Counted(AtomicUsize);

    impl Programs for Arc<Counted> {
        fn variables(&self) -> Vec<(String, Value)> {
            let count = self.0.fetch_add(1, Ordering::AcqRel);
            vec![("n".to_owned(), Value::from(count))]
        }

        fn rest(&self) {}

        fn assign(&self, _: &str, _: &Value) -> Result<(), Refused> {
            Ok(())
        }

        fn run(&self, _: &str) -> Result<(), Refused> {
            Ok(())
        }

        fn stop(&self) -> Result<(), Refused> {
            Ok(())
        }
    }

    #[test]
    fn those_who_ask_together_share_one_look_and_a_change_makes_another() {
        let directory = tempfile::tempdir().unwrap();
        let counted = Arc::new(Counted::default());
        let robot = Robot::new(directory.path(), Some(Box::new(counted.clone())));
        let begin = Instant::now();
        let all: Vec<_> = (0..100).map(|_| robot.parameters()).collect();
        let looks = counted.0.load(Ordering::Acquire) as u128;
        let most = begin.elapsed().as_millis() / SNAPSHOT_TIME.as_millis() + 1;
        assert!((1..=most).contains(&looks), "{looks} looks of {most}");
        assert!(Arc::ptr_eq(&all[0], &all[1]) || looks > 1);
        assert!(
            robot
                .set(&[("diagram/n".to_owned(), Value::from(1))])
                .is_empty()
        );
        assert_ne!(robot.parameters(), all[99]);
    }

    #[test]
    fn only_a_stop_is_for_everybody() {
        assert_eq!(services(false), [("/stop", &[] as &[&str])]);
        assert_eq!(services(true), SERVICES);
        let free: Vec<u32> = (0..5).filter(|id| is_for_all(*id)).collect();
        assert_eq!(free, [1]);
        assert!(!is_for_all(u32::MAX));
    }
}
