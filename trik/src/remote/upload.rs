//! A program on its way to a robot, and its start there.
//!
//! Owns which files are sent, and what a robot answers to them. `link` is the connection.

mod words;

use super::link::{Link, Message, ms};
use super::output::harmless;
use crate::diagrams::flow::{is_of_blocks, unread, with_main};
use crate::diagrams::save::Unreadable;
use crate::error::Error;
use crate::limits;
use lang_text::problem::{Locale, Words};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::os::fd::BorrowedFd;
use std::path::Path;
use std::time::Instant;
use trikd::protocol::news;

/// A program on its way to robots.
#[derive(Debug)]
pub(super) struct Upload {
    /// Its name on the robot.
    pub(super) name: String,
    content: Vec<u8>,
}

impl Upload {
    /// Reads a file. `diagram` is the main diagram of it that is run, if it is not the first; what is wrong is told in this
    /// language.
    ///
    /// # Errors
    /// It cannot be read, is too long, its name is none for a robot, or it has no such diagram.
    pub(super) fn read(path: &Path, diagram: Option<&str>, locale: Locale) -> Result<Self, Error> {
        let bad = |why: Words| Error::file(path, why.in_locale(locale));
        let name = path.file_name().and_then(|name| name.to_str());
        let name = name.ok_or_else(|| bad(words::no_name()))?;
        // The same rule as on the robot, and a colon would end the name on the way.
        trikd::scripts::locate(Path::new("/"), name.as_bytes())
            .map_err(|why| Error::Refused(why.words().in_locale(locale).to_owned()))?;
        if name.contains(':') {
            return Err(bad(words::colon()));
        }
        let data = std::fs::metadata(path).map_err(|error| bad(words::unread(&error)))?;
        if !data.is_file() {
            return Err(bad(words::no_file()));
        }
        let most = match is_of_blocks(path) {
            true => limits::BLOCKS_UPLOAD_BYTES_MAX,
            false => limits::UPLOAD_BYTES_MAX,
        };
        if data.len() > most {
            return Err(bad(words::too_long(data.len(), most)));
        }
        let mut content = Vec::new();
        let file = std::fs::File::open(path).map_err(|error| bad(words::unread(&error)))?;
        // It may have grown meanwhile.
        std::io::Read::read_to_end(&mut std::io::Read::take(file, most), &mut content)
            .map_err(|error| bad(words::unread(&error)))?;
        if let Some(diagram) = diagram {
            if !is_of_blocks(path) {
                return Err(bad(words::no_diagram()));
            }
            content =
                with_main(path, content, diagram).map_err(|why| unreadable(path, why, locale))?;
            // Written anew, it may be longer than it was.
            let length = content.len() as u64;
            if length > most {
                return Err(bad(words::too_long(length, most)));
            }
        }
        let name = name.to_owned();
        Ok(Self { name, content })
    }

    /// The request that has it kept.
    pub(super) fn request(&self) -> Vec<u8> {
        let mut request = format!("file:{}:", self.name).into_bytes();
        request.extend_from_slice(&self.content);
        request
    }

    /// Sends it and waits until the robot has kept it. `report` hears how many bytes of how many are on their way.
    ///
    /// # Errors
    /// A sentence: the connection is lost, or the robot refuses.
    pub(super) fn send(
        &self,
        link: &mut Link,
        mut report: impl FnMut(usize, usize),
    ) -> Result<(), Error> {
        link.ask(&[&self.request()]);
        // Answered in order, so after the answer the file is kept or refused.
        link.ask(&[b"version"]);
        let all = link.unsent();
        let mut moved = (all, Instant::now());
        loop {
            report(all - link.unsent().min(all), all);
            while let Some(message) = link.next() {
                match message {
                    Message::Version => return Ok(()),
                    Message::Error(text) if self.is_refused(&text) => {
                        let robot = link.name();
                        let why = format!("{robot} refuses {}: {text}", self.name);
                        return Err(Error::Robot(why));
                    }
                    Message::Error(text) => link.remember(&text),
                    Message::Print(_)
                    | Message::Info(_)
                    | Message::Status(_)
                    | Message::Debug(_)
                    | Message::Question(_)
                    | Message::Stream(_) => {}
                }
            }
            if moved.0 != link.unsent() {
                moved = (link.unsent(), Instant::now());
            } else if moved.1.elapsed() >= ms(limits::ANSWER_MS) {
                return Err(Error::Robot(format!(
                    "{} has not answered for {} s: is it a robot?",
                    link.name(),
                    limits::ANSWER_MS / 1000
                )));
            }
            link.turn(ms(limits::TURN_MS), None, true)?;
        }
    }

    /// Other errors are those of a program that still runs.
    fn is_refused(&self, text: &str) -> bool {
        text == news::NOT_PAIRED
            || text.starts_with(news::UPLOAD_FAILED)
            || text.starts_with(&format!("'{}'", self.name))
    }
}

/// Why the diagram that was asked for is not sent.
fn unreadable(path: &Path, why: Unreadable, locale: Locale) -> Error {
    match why {
        Unreadable::File(why) | Unreadable::Diagram(why) => {
            Error::file(path, harmless(why.in_locale(locale)))
        }
        Unreadable::Save(problems) => Error::Refused(unread(path, &problems, locale).join("\n")),
    }
}

/// Runs a program that is on the robot, and waits until it has started, or `also` can be read.
///
/// # Errors
/// A sentence: the connection is lost, or the robot refuses.
pub(super) fn start(
    link: &mut Link,
    name: &str,
    also: Option<BorrowedFd<'_>>,
) -> Result<(), Error> {
    link.ask(&[b"run:", name.as_bytes()]);
    link.ask(&[b"status"]);
    let deadline = Instant::now() + ms(limits::ANSWER_MS);
    let mut errors: Vec<String> = Vec::new();
    loop {
        while let Some(message) = link.next() {
            match message {
                Message::Info(text) if text == news::started(name) => return Ok(()),
                Message::Error(text) => errors.push(text),
                Message::Status(text) => {
                    // A robot that had too much to say may have left the news of the start out.
                    if news::status(&text).is_of(name) {
                        return Ok(());
                    }
                    let why = errors
                        .pop()
                        .unwrap_or_else(|| "it does not say why".to_owned());
                    let why = format!("{} does not run {name}: {why}", link.name());
                    return Err(Error::Robot(why));
                }
                Message::Print(_)
                | Message::Info(_)
                | Message::Version
                | Message::Debug(_)
                | Message::Question(_)
                | Message::Stream(_) => {}
            }
            errors.drain(..errors.len().saturating_sub(1));
        }
        if Instant::now() >= deadline {
            return Err(Error::Robot(format!(
                "{} does not say that {name} has started: if its software is older than trikd, the program may run, and trik stop ends it",
                link.name()
            )));
        }
        link.turn(ms(limits::TURN_MS), also, true)?;
        let mut there = also.map(|fd| PollFd::new(fd, PollFlags::POLLIN));
        if poll(there.as_mut_slice(), PollTimeout::ZERO).is_ok_and(|count| count > 0) {
            return Ok(());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(path: &Path) -> Result<Upload, Error> {
        Upload::read(path, None, Locale::English)
    }

    #[test]
    fn a_file_that_no_robot_takes_is_refused_here() {
        let folder = tempfile::tempdir().expect("a directory");
        // The name of the temporary one begins with a dot.
        let dir = folder.path().join("programs");
        std::fs::create_dir(&dir).expect("a directory");
        for (name, why) in [
            ("a:b.js", "':'"),
            (".hidden.js", "begins with a dot"),
            ("none.js", "there is no such file"),
        ] {
            if name != "none.js" {
                std::fs::write(dir.join(name), "x").expect(name);
            }
            let refusal = read(&dir.join(name)).unwrap_err().to_string();
            assert!(refusal.contains(why), "{name}: {refusal}");
        }
        assert!(read(&dir).unwrap_err().to_string().contains("not a file"));
        assert!(read(Path::new("/")).is_err());
        let large = std::fs::File::create(dir.join("large")).expect("a file");
        large.set_len(limits::UPLOAD_BYTES_MAX + 1).expect("a hole");
        assert!(
            read(&dir.join("large")).unwrap_err().to_string().contains(
                "268435457 bytes long, and a robot takes at most 268435456 in one message"
            )
        );
        let blocks = std::fs::File::create(dir.join("large.qrs")).expect("a file");
        blocks.set_len(17 << 20).expect("a hole");
        let refusal = read(&dir.join("large.qrs")).unwrap_err();
        let why =
            "17825792 bytes long, and a robot takes at most 16776192 in one message (about 16 MiB)";
        assert!(refusal.to_string().contains(why), "{refusal}");
    }
}
