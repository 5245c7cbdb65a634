//! Changes of a diagram that runs on a robot: its file, watched for saves, and `trik set`.
//!
//! Owns when a file counts as changed, and the answer to one assignment. What a robot makes of it is its own matter.

use super::link::{Message, ms};
use super::output::{harmless, say};
use super::target::{Target, target, the_one};
use super::upload::Upload;
use crate::debug::target::Written;
use crate::debug::target::words::told;
use crate::diagrams::flow;
use crate::diagrams::save::must;
use crate::error::Error;
use crate::language;
use crate::limits;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lang_text::problem::Locale;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};
use trikd::protocol::news;
use trikd::protocol::program::WhenGone;

/// The words of `--gone`.
pub(super) fn gone() -> impl TypedValueParser<Value = WhenGone> {
    let words = WhenGone::ALL.map(|one| {
        PossibleValue::new(one.word()).help(match one {
            WhenGone::End => "They end with an error that names the block",
            WhenGone::Refuse => "The save is refused, and what runs goes on",
        })
    });
    // Only those words come here.
    PossibleValuesParser::new(words).map(|word| WhenGone::of(&word).unwrap_or_default())
}

/// What `trik set` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct SetArgs {
    /// A variable and its new value, an expression as in a block: n=5, "speed=n * 2".
    #[arg(value_name = "NAME=EXPRESSION", value_parser = assignment)]
    pub assignment: String,
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

fn assignment(text: &str) -> Result<String, String> {
    match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() && !value.trim().is_empty() => {
            Ok(text.to_owned())
        }
        Some(_) | None => Err("NAME=EXPRESSION is wanted, for example n=5".to_owned()),
    }
}

/// Assigns a variable of the diagram that runs on a robot. The exit code: 0 it is assigned, 1 it is refused, 2 the robot
/// could not be reached or did not answer.
pub(crate) fn set(args: &SetArgs) -> u8 {
    match ask(args) {
        Ok(code) => code,
        Err(error) => {
            say(&told(&error.to_string(), args.language));
            2
        }
    }
}

fn ask(args: &SetArgs) -> Result<u8, Error> {
    let target = match &args.robot {
        Some(target) => target.clone(),
        None => the_one()?,
    };
    let (is_changed, text) = assign(&target, &args.assignment, args.language)?;
    say(&harmless(&told(&text, args.language)));
    Ok(u8::from(!is_changed))
}

/// Assigns a variable; whether it is assigned, and what the robot says of it, in this language as far as it knows that.
pub(super) fn assign(
    target: &Target,
    assignment: &str,
    locale: Locale,
) -> Result<(bool, String), Error> {
    let name = assignment.split('=').next().unwrap_or_default().trim();
    let mut link = target.connect()?;
    link.speak(locale);
    link.ask(&[b"set:", assignment.as_bytes()]);
    let deadline = Instant::now() + ms(limits::ANSWER_MS);
    while Instant::now() < deadline {
        match link.next() {
            Some(Message::Info(text) | Message::Error(text)) => {
                if let Some(is_changed) = news::is_changed(&text, name) {
                    return Ok((is_changed, text));
                }
                if text == news::NOT_PAIRED {
                    return Err(Error::Robot(text));
                }
            }
            Some(
                Message::Print(_)
                | Message::Version
                | Message::Status(_)
                | Message::Debug(_)
                | Message::Question(_)
                | Message::Stream(_),
            ) => {}
            None => link.turn(ms(limits::TURN_MS), None, true)?,
        }
    }
    Err(Error::Robot(format!(
        "{} has not answered for {} s: perhaps its trikd is older than this program",
        link.name(),
        limits::ANSWER_MS / 1000
    )))
}

/// What a file looked like: when it was written, and how long it was.
type FileVersion = Option<(SystemTime, u64)>;

/// A diagram that is sent again at each save.
#[derive(Debug)]
pub(super) struct Watched {
    path: PathBuf,
    /// The main diagram that is run, if it is not the first one.
    diagram: Option<String>,
    gone: WhenGone,
    /// What is sent.
    seen: FileVersion,
    /// What it was at the last look.
    last: FileVersion,
    at: Instant,
    locale: Locale,
}

impl Watched {
    /// Watches a file from now on.
    ///
    /// # Errors
    /// It is no diagram: other programs cannot be changed while they run.
    pub(super) fn new(
        path: &Path,
        diagram: Option<&str>,
        gone: WhenGone,
        locale: Locale,
    ) -> Result<Self, Error> {
        if !flow::is_of_blocks(path) {
            let why = "--watch is for diagrams (NAME.qrs, NAME.flow): other programs cannot be changed while they run";
            return Err(Error::file(path, why.to_owned()));
        }
        Ok(Self {
            path: path.to_owned(),
            diagram: diagram.map(str::to_owned),
            gone,
            seen: look(path),
            last: look(path),
            at: Instant::now(),
            locale,
        })
    }

    /// The requests that bring a new version to the robot, if the file was saved since the last time.
    pub(super) fn save(&mut self) -> Option<[Vec<u8>; 2]> {
        if self.at.elapsed() < ms(limits::SAVE_LOOK_MS) {
            return None;
        }
        self.at = Instant::now();
        let now = look(&self.path);
        // An editor may be writing it: half of a program can be one, too.
        let is_written = std::mem::replace(&mut self.last, now) == now;
        // Editors may write a new file and then give it the name: in between there is none.
        if now.is_none() || now == self.seen || !is_written {
            return None;
        }
        self.seen = now;
        match Upload::read(&self.path, self.diagram.as_deref(), self.locale) {
            Ok(upload) => {
                let patch = format!("patch:{}:{}", self.gone.word(), upload.name);
                Some([upload.request(), patch.into_bytes()])
            }
            Err(error) => {
                let why = format!("{error}; what runs goes on as it is");
                say(&told(&why, self.locale));
                None
            }
        }
    }
}

impl Watched {
    /// What a robot says of a new version, for the person: its mistakes are told in the language of the robot, so they are
    /// looked for here again.
    pub(super) fn told(&self, text: &str) -> String {
        let refusal = news::unchanged(&self.name(), "");
        let own = match (self.locale, text.strip_prefix(&refusal)) {
            (Locale::Russian, Some(_)) => self.mistakes(),
            (Locale::English, _) | (Locale::Russian, None) => None,
        };
        match own {
            Some(mistakes) => told(&refusal, self.locale) + &mistakes,
            None => told(text, self.locale),
        }
    }

    fn name(&self) -> String {
        let name = self.path.file_name().unwrap_or_default();
        name.to_string_lossy().into_owned()
    }

    fn mistakes(&self) -> Option<String> {
        let opened = flow::open(&self.path, self.diagram.as_deref());
        match must(opened, &self.path, self.locale) {
            Ok(opened) => Written::of(&opened).mistakes(&self.path, self.locale),
            Err(refusal) => Some(refusal.lines.join("\n")),
        }
    }
}

fn look(path: &Path) -> FileVersion {
    let data = std::fs::metadata(path).ok()?;
    Some((data.modified().ok()?, data.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_assignment_has_a_name_and_a_value() {
        assert!(assignment("n=5").is_ok());
        for wrong in ["n", "=5", "n=", " = "] {
            let why = assignment(wrong).unwrap_err();
            assert!(why.contains("for example n=5"), "{wrong}");
        }
    }

    #[test]
    fn a_save_is_sent_once_when_it_is_written_and_only_diagrams_are_watched() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.qrs");
        std::fs::write(&path, "one").unwrap();
        let mut watched = Watched::new(&path, None, WhenGone::Refuse, Locale::English).unwrap();
        let long_ago = Instant::now().checked_sub(ms(60_000)).unwrap();
        watched.at = long_ago;
        assert_eq!(watched.save(), None);
        for text in ["an", "another"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(watched.save(), None, "it has just looked");
            watched.at = long_ago;
            assert_eq!(watched.save(), None, "it may be written still");
        }
        watched.at = long_ago;
        let [file, patch] = watched.save().unwrap();
        assert_eq!(file, b"file:a.qrs:another");
        assert_eq!(patch, b"patch:refuse:a.qrs");
        watched.at = long_ago;
        assert_eq!(watched.save(), None);
        std::fs::remove_file(&path).unwrap();
        watched.at = long_ago;
        assert_eq!(watched.save(), None);
        assert!(Watched::new(Path::new("A.FLOW"), None, WhenGone::End, Locale::English).is_ok());
        let other =
            Watched::new(Path::new("a.py"), None, WhenGone::End, Locale::English).unwrap_err();
        assert!(
            other.to_string().contains("--watch is for diagrams"),
            "{other}"
        );
    }
}
