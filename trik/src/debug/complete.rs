//! What the key Tab offers at `trik debug`: commands, and what a command is about.
//!
//! Owns which names fit where. Pure: knows no terminal and no program.

use super::listing::Listing;
use super::report::Report;
use super::words;

/// What follows a command.
enum About {
    Nothing,
    Place,
    Thread,
    /// An expression, or a variable.
    Variables,
    /// One of these words, with a stroke between two.
    Words(&'static str),
}

/// What its help says that follows it.
fn about(command: &str) -> About {
    let more = words::follows(command);
    let first = more.trim_start_matches('[');
    let first = first.split([' ', ']', '=']).next().unwrap_or_default();
    match first {
        "LINE" => About::Place,
        "THREAD" => About::Thread,
        "NAME" | "EXPRESSION" => About::Variables,
        words if words.contains('|') => About::Words(words),
        // A number, a time, or nothing.
        _ => About::Nothing,
    }
}

/// Names that a program has now.
#[derive(Clone, Debug, Default)]
pub(super) struct Known {
    /// Blocks and subprograms as people name them.
    pub places: Vec<String>,
    pub variables: Vec<String>,
    pub threads: Vec<String>,
}

impl Known {
    /// Those of a program that tells this of itself, by its text.
    pub(super) fn of(told: &Report, listing: &Listing) -> Self {
        let (variables, threads) = (told.variables.iter(), told.threads.iter());
        Self {
            places: listing.names(),
            variables: variables.map(|one| one.name.clone()).collect(),
            threads: threads.map(|one| one.name.clone()).collect(),
        }
    }
}

/// Where the word begins that is being typed at the end of a line, in bytes, and what it may become, in order.
pub(super) fn candidates(line: &str, known: &Known) -> (usize, Vec<String>) {
    let start = line.len() - line.trim_start().len();
    let Some(end) = line[start..].find(char::is_whitespace) else {
        let commands = fitting(&line[start..], words::commands());
        // What follows is typed at once.
        let open = |word: String| match words::follows(&word) {
            "" => word,
            _ => word + " ",
        };
        return (start, commands.into_iter().map(open).collect());
    };
    let command = &line[start..start + end];
    let rest = line[start + end..].trim_start();
    let from = line.len() - rest.len();
    match about(command) {
        About::Nothing => (line.len(), Vec::new()),
        // A place may have blanks, and what follows `if` is an expression.
        About::Place if rest.contains(" if ") => of_variables(line, known),
        About::Place => (from, fitting(rest, names(&known.places))),
        About::Thread => (from, fitting(rest, names(&known.threads))),
        About::Variables => of_variables(line, known),
        About::Words(all) => (from, fitting(rest, all.split('|'))),
    }
}

fn names(all: &[String]) -> impl Iterator<Item = &str> {
    all.iter().map(String::as_str)
}

/// The variable whose name is being typed.
fn of_variables(line: &str, known: &Known) -> (usize, Vec<String>) {
    let is_of_name = |c: char| c.is_alphanumeric() || c == '_';
    let from = line.trim_end_matches(is_of_name).len();
    (from, fitting(&line[from..], names(&known.variables)))
}

fn fitting<'a>(begun: &str, all: impl IntoIterator<Item = &'a str>) -> Vec<String> {
    let fitting = all.into_iter().filter(|name| name.starts_with(begun));
    let mut fitting: Vec<String> = fitting.map(str::to_owned).collect();
    fitting.sort_unstable();
    fitting.dedup();
    fitting
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_command_is_completed_by_what_it_is_about() {
        let own = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect();
        let known = Known {
            places: own(&["wheels", "Keep to the wall/turn", "walls"]),
            variables: own(&["gain", "sum", "gate"]),
            threads: own(&["main", "other"]),
        };
        for (line, from, wanted) in [
            (
                "rev",
                0,
                &[
                    "reverse-continue",
                    "reverse-finish",
                    "reverse-next",
                    "reverse-step",
                ][..],
            ),
            ("  br", 2, &["break "]),
            ("sta", 0, &["start"]),
            ("b w", 2, &["walls", "wheels"]),
            ("tbreak Keep to t", 7, &["Keep to the wall/turn"]),
            ("b wheels if ga", 12, &["gain", "gate"]),
            ("p 2 * su", 6, &["sum"]),
            ("set ga", 4, &["gain", "gate"]),
            ("watch ", 6, &["gain", "gate", "sum"]),
            ("hold o", 5, &["other"]),
            ("info v", 5, &["variables"]),
            ("motors ", 7, &["keep", "rest"]),
            ("info ", 5, &["breakpoints", "threads", "variables"]),
            ("release m", 8, &["main"]),
            ("d ", 2, &[]),
            ("continue w", 10, &[]),
            ("", 0, &[]),
        ] {
            let (at, found) = candidates(line, &known);
            assert_eq!(at, from, "{line}");
            match line {
                "" => assert!(found.len() > 25, "{found:?}"),
                _ => assert_eq!(found, wanted, "{line}"),
            }
        }
    }
}
