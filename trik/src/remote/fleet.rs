//! One thing done with several robots at once: `trik send`, `stop` and `status`.
//!
//! Owns a thread for each robot, the lines about their progress and the table at the end.

mod words;

use super::link::{Link, Message, ms};
use super::output::{harmless, say};
use super::roster::{Class, class};
use super::run::percent;
use super::target::{Target, target, the_one};
use super::upload::{Upload, start};
use super::watch::look;
use crate::debug::report::Report;
use crate::debug::stops::{self, words as stop_words};
use crate::debug::target::words::told;
use crate::error::Error;
use crate::language;
use crate::limits;
use crate::refusal::Refusal;
use clap::Args;
use lang_text::problem::Locale;
use std::fmt::{self, Write as _};
use std::io::{self, Write as _};
use std::path::PathBuf;
use std::time::{Duration, Instant};
use trikd::program::rest::is_explained;
use trikd::protocol::news;

/// What `trik stop` and `trik status` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FleetArgs {
    /// The robots: names or addresses, with ports that are not 8888, or where the trees of virtual ones are mounted, paths
    /// with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target, value_delimiter = ',')]
    pub robot: Vec<Target>,
    /// The robots that a file names, a line for each: NAME ADDRESS [GROUP] [page=PORT]; with :GROUP those of that group.
    #[arg(long, value_name = "FILE[:GROUP]", value_parser = class)]
    pub class: Option<Class>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// What `trik send` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct SendArgs {
    /// Programs, and files that they need.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// The robots: names or addresses, with ports that are not 8888, or where the trees of virtual ones are mounted, paths
    /// with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target, value_delimiter = ',')]
    pub robot: Vec<Target>,
    /// The robots that a file names, a line for each: NAME ADDRESS [GROUP] [page=PORT]; with :GROUP those of that group.
    #[arg(long, value_name = "FILE[:GROUP]", value_parser = class)]
    pub class: Option<Class>,
    /// Run this program when all files are there.
    #[arg(long, value_name = "NAME")]
    pub run: Option<String>,
    /// Language of sentences: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// A robot that something is done with.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Member {
    /// Its name in the class; None: it was named by where it is.
    name: Option<String>,
    /// Where it is: a virtual one of a class may not run.
    at: Result<Target, Error>,
}

impl fmt::Display for Member {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.name, &self.at) {
            (Some(name), _) => out.write_str(name),
            (None, Ok(target)) => write!(out, "{target}"),
            (None, Err(_)) => Ok(()),
        }
    }
}

impl Member {
    /// What went wrong with it. A name of a class stands in no other sentence.
    fn complaint(&self, why: &Error, locale: Locale) -> String {
        let why = told(&why.to_string(), locale);
        match &self.name {
            Some(name) => format!("{name}: {why}"),
            None => why,
        }
    }
}

/// Those that were named, each once; else the one that is meant without a name.
fn fleet(named: &[Target], class: Option<&Class>) -> Result<Vec<Member>, Error> {
    let by_address = |target: &Target| Member {
        name: None,
        at: Ok(target.clone()),
    };
    if named.is_empty() && class.is_none() {
        return Ok(vec![by_address(&the_one()?)]);
    }
    let robots = class.map_or(&[][..], |class| &class.robots);
    let of_class = robots.iter().map(|robot| Member {
        name: Some(robot.name.clone()),
        at: robot.target(),
    });
    let mut all: Vec<Member> = Vec::new();
    for member in of_class.chain(named.iter().map(by_address)) {
        let is_same = |other: &Member| member.at.is_ok() && other.at == member.at;
        if !all.iter().any(is_same) {
            all.push(member);
        }
    }
    let most = limits::FLEET_MAX;
    match all.len() {
        count if count > most => Err(Error::Refused(format!(
            "{count} robots: at most {most} at once"
        ))),
        _ => Ok(all),
    }
}

/// Does it with all at once; the results are in their order.
fn each<T: Send>(all: &[Member], work: impl Fn(&Member) -> T + Sync) -> Vec<T> {
    let work = &work;
    std::thread::scope(|scope| {
        let threads: Vec<_> = all
            .iter()
            .map(|member| scope.spawn(move || work(member)))
            .collect();
        threads
            .into_iter()
            .map(|thread| {
                thread
                    .join()
                    .unwrap_or_else(|panic| std::panic::resume_unwind(panic))
            })
            .collect()
    })
}

/// What a robot answered to a request and a `status` after it.
pub(super) struct Answer {
    infos: Vec<String>,
    errors: Vec<String>,
    /// None: it does not know the question.
    status: Option<String>,
}

impl Answer {
    /// What became of `stop`: a sentence, and true if everything rests. What a program says of itself is no failure of it.
    pub(super) fn of_stop(&self) -> (bool, &str) {
        let failure = self.errors.iter().find(|text| is_explained(text));
        let mut ended = self.infos.iter().rev();
        let ended = ended.find(|text| text.contains(" was stopped by "));
        match (failure, ended, &self.status) {
            (Some(text), _, _) => (false, text),
            (None, Some(text), _) => (true, text),
            (None, None, Some(_)) => (true, "no program was running; everything rests"),
            (None, None, None) => (false, "was told to stop, and does not say whether it has"),
        }
    }
}

/// Asks, and waits for the answer for this long at most.
pub(super) fn ask(
    target: &Target,
    request: Option<&[u8]>,
    patience: Duration,
) -> Result<Answer, Error> {
    over(&mut target.connect()?, request, patience)
}

fn over(link: &mut Link, request: Option<&[u8]>, patience: Duration) -> Result<Answer, Error> {
    if let Some(request) = request {
        link.ask(&[request]);
    }
    link.ask(&[b"status"]);
    let deadline = Instant::now() + patience;
    let mut answer = Answer {
        infos: Vec::new(),
        errors: Vec::new(),
        status: None,
    };
    while answer.status.is_none() && Instant::now() < deadline {
        match link.next() {
            Some(Message::Info(text)) => answer.infos.push(text),
            Some(Message::Error(text)) => answer.errors.push(text),
            Some(Message::Status(text)) => answer.status = Some(text),
            Some(_) => {}
            None => link.turn(ms(limits::TURN_MS), None, true)?,
        }
        // A program that runs may have much to say.
        for texts in [&mut answer.infos, &mut answer.errors] {
            texts.drain(..texts.len().saturating_sub(8));
        }
    }
    Ok(answer)
}

/// Ends the programs of robots and brings all that moves to rest. The exit code: 0 all rest, 1 one does not say so,
/// 2 one could not be told.
pub(crate) fn stop(args: &FleetArgs) -> u8 {
    ask_all(args, |member| {
        let answer = ask(&member.at.clone()?, Some(b"stop"), ms(limits::ANSWER_MS))?;
        let (rests, text) = answer.of_stop();
        let text = told(text, args.language);
        let code = u8::from(!rests);
        Ok((code, format!("{member}: {text}\n")))
    })
}

/// Shows what runs on robots. The exit code: 0 all have told, 2 one could not be asked.
pub(crate) fn status(args: &FleetArgs) -> u8 {
    ask_all(args, |member| {
        let mut link = member.at.clone()?.connect()?;
        match over(&mut link, None, ms(limits::ANSWER_MS))?.status {
            Some(text) => {
                let line = |line| words::status(line, args.language);
                let mut lines: Vec<_> = text.lines().map(line).collect();
                if news::status(&text).runs.is_some() {
                    link.speak(args.language);
                    let told = debugger(&mut link, &text, args.language);
                    lines.extend(told);
                }
                let lines = lines.iter().map(|line| format!("{member}: {line}\n"));
                Ok((0, lines.collect()))
            }
            None => Err(Error::Robot(format!(
                "{member} does not know the question: its software is older than trikd"
            ))),
        }
    })
}

/// Where a program is stopped by a debugger, which threads are held, and who is in control of that, if its status has not told
/// that. A robot that does not answer has none.
fn debugger(link: &mut Link, status: &str, locale: Locale) -> Vec<String> {
    let mut control = None;
    let Ok(answer) = look(link, 1, &mut control) else {
        return Vec::new();
    };
    let told = answer.get("program").and_then(Report::read);
    let stopped = told
        .as_ref()
        .and_then(|told| stops::in_one_line(told, locale));
    let held = told.map(|told| told.held.join(", "));
    let held = held.filter(|names| !names.is_empty());
    let mut lines: Vec<_> = stopped.into_iter().collect();
    lines.extend(held.map(|names| stop_words::held(&names).in_locale(locale).to_owned()));
    let control = control.filter(|holder| !status.contains(&news::debugs(holder)));
    lines.extend(control.map(|holder| words::debugger(&holder, locale)));
    lines
}

/// Prints what each says, and gives the greatest of the codes.
fn ask_all(args: &FleetArgs, work: impl Fn(&Member) -> Result<(u8, String), Error> + Sync) -> u8 {
    let all = match fleet(&args.robot, args.class.as_ref()) {
        Ok(all) => all,
        Err(error) => {
            say(&told(&error.to_string(), args.language));
            return 2;
        }
    };
    let mut worst = 0;
    for (member, done) in all.iter().zip(each(&all, work)) {
        let code = match done {
            Ok((code, text)) => {
                // A reader that has stopped reading knows enough.
                let _ = io::stdout().write_all(harmless(&text).as_bytes());
                code
            }
            Err(error) => {
                say(&member.complaint(&error, args.language));
                2
            }
        };
        worst = worst.max(code);
    }
    worst
}

/// How it went with one robot.
struct Sent {
    count: usize,
    result: Result<String, Error>,
}

/// Sends files to robots and perhaps runs one of them.
///
/// # Errors
/// A file cannot be sent, or a robot has not got everything.
pub(crate) fn send(args: &SendArgs) -> Result<u8, Refusal> {
    let locale = args.language;
    let refused = |error: Error| Refusal::new(told(&error.to_string(), locale));
    let files = read(args).map_err(refused)?;
    let all = fleet(&args.robot, args.class.as_ref()).map_err(refused)?;
    let results = each(&all, |member| send_to(member, &files, args));
    let table = table(&all, &results, (files.len(), locale));
    let _ = io::stdout().write_all(table.as_bytes());
    let failed = results.iter().filter(|sent| sent.result.is_err()).count();
    match failed {
        0 => Ok(0),
        _ => Err(Refusal::new(
            words::not_all(failed, all.len()).in_locale(locale),
        )),
    }
}

fn read(args: &SendArgs) -> Result<Vec<Upload>, Error> {
    let files: Vec<_> = args
        .files
        .iter()
        .map(|path| Upload::read(path, None, args.language))
        .collect::<Result<_, _>>()?;
    for (index, file) in files.iter().enumerate() {
        if files[..index].iter().any(|other| other.name == file.name) {
            let words = words::twice(&file.name);
            return Err(Error::Refused(words.in_locale(args.language).to_owned()));
        }
    }
    Ok(files)
}

fn send_to(target: &Member, files: &[Upload], args: &SendArgs) -> Sent {
    let locale = args.language;
    let mut count = 0;
    let mut work = || {
        let mut link = target.at.clone()?.connect()?;
        for file in files {
            let mut shown = 0;
            file.send(&mut link, |done, all| {
                let part = percent(done, all) / 25 * 25;
                if all >= limits::PROGRESS_BYTES && part > shown && part < 100 {
                    shown = part;
                    let _ = writeln!(io::stderr(), "{target}: {} {part} %", file.name);
                }
            })?;
            count += 1;
            let name = &file.name;
            let words = words::is_sent(name, count, files.len());
            let _ = writeln!(io::stderr(), "{target}: {}", words.in_locale(locale));
        }
        let words = match &args.run {
            Some(name) => {
                link.speak(locale);
                start(&mut link, name, None)?;
                words::runs(name)
            }
            None => words::sent(),
        };
        Ok(words.in_locale(locale).to_owned())
    };
    let result = work();
    Sent { count, result }
}

/// A line for each robot, in columns.
fn table(all: &[Member], results: &[Sent], (files, locale): (usize, Locale)) -> String {
    let names: Vec<_> = all.iter().map(Member::to_string).collect();
    let letters = |name: &String| name.chars().count();
    let [robot, sent, result] = words::columns(locale);
    let least = robot.chars().count();
    let width = names.iter().map(letters).max().unwrap_or(0).max(least);
    let mut text = format!("{robot:<width$}  {sent:<8}  {result}\n");
    for (name, sent) in names.iter().zip(results) {
        let files = words::of(sent.count, files).in_locale(locale).to_owned();
        let result = match &sent.result {
            Ok(done) => harmless(done),
            Err(why) => harmless(&words::failed(&why.to_string(), locale)).replace('\n', " "),
        };
        // Writing to a text cannot fail.
        let _ = writeln!(text, "{name:<width$}  {files:<8}  {result}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::roster::Robot;
    use super::*;

    #[test]
    fn a_robot_that_is_named_twice_is_one() {
        let named: Vec<_> = ["a", "b", "a:8888", "a:1"]
            .iter()
            .flat_map(|name| target(name))
            .collect();
        let shown: Vec<_> = fleet(&named, None)
            .expect("robots")
            .iter()
            .map(Member::to_string)
            .collect();
        assert_eq!(shown, ["a", "b", "a:1"]);
        let many: Vec<_> = (1..=65)
            .flat_map(|number| target(&format!("r{number}")))
            .collect();
        assert_eq!(
            fleet(&many, None),
            Err(Error::Refused("65 robots: at most 64 at once".to_owned()))
        );
    }

    #[test]
    fn robots_of_a_class_have_their_names_and_one_that_does_not_run_keeps_nobody_from_anything() {
        let robot = |name: &str, at: &str| Robot {
            name: name.to_owned(),
            at: at.to_owned(),
            group: String::new(),
            page: None,
        };
        let class = Class {
            name: "class".to_owned(),
            robots: vec![robot("anna", "a"), robot("sim", "/none/robot")],
        };
        let named: Vec<_> = ["a", "b"].iter().flat_map(|name| target(name)).collect();
        let all = fleet(&named, Some(&class)).expect("robots");
        let shown: Vec<_> = all.iter().map(Member::to_string).collect();
        assert_eq!(shown, ["anna", "sim", "b"]);
        let why = all[1].at.clone().expect_err("it does not run");
        assert!(
            all[1]
                .complaint(&why, Locale::English)
                .starts_with("sim: /none/robot: no virtual robot"),
            "{why}"
        );
    }

    #[test]
    fn a_stop_is_done_if_the_robot_says_so_whatever_its_program_says() {
        let lines = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect();
        let stopped = "x.js was stopped by a client after 0.1 s";
        for (infos, errors, status, rests) in [
            (&[stopped][..], &[][..], true, true),
            (&[stopped], &["TypeError: x is not defined"], true, true),
            (&[], &["TypeError: x is not defined"], true, true),
            (&[], &[], true, true),
            (&[stopped], &["not everything is at rest: M1"], true, false),
            (&[], &[], false, false),
            (&[], &["TypeError: x is not defined"], false, false),
        ] {
            let answer = Answer {
                infos: lines(infos),
                errors: lines(errors),
                status: status.then(String::new),
            };
            let (told, why) = answer.of_stop();
            assert_eq!(told, rests, "{infos:?} {errors:?} {status}: {why}");
        }
    }

    #[test]
    fn the_table_has_a_line_for_each_robot() {
        let all = ["a", "192.168.77.10"].map(|name| Member {
            name: None,
            at: target(name),
        });
        let results = [
            Sent {
                count: 2,
                result: Ok("x.js runs".to_owned()),
            },
            Sent {
                count: 0,
                result: Err(Error::Robot("it\nburns".to_owned())),
            },
        ];
        assert_eq!(
            table(&all, &results, (2, Locale::English)),
            "ROBOT          FILES     RESULT\na              2 of 2    x.js runs\n192.168.77.10  0 of 2    FAILED: it burns\n"
        );
    }
}
