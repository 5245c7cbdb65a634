//! What the graders of other platforms want to be told of a run.
//!
//! Owns the forms: a platform is a row of [`Platform`] with its exit codes and its lines. What came of the runs is given.

use super::row::Row;
use super::words;
use crate::terminal::harmless;
use clap::ValueEnum;
use lang_text::problem::Locale;
use serde_json::json;
use std::ffi::OsString;
use studio::verdict::Verdict;

/// A platform.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Platform {
    /// A checker with exit codes of testlib: 0 right, 1 wrong, 2 not of the right form, 3 the checker has failed; the reason
    /// goes to standard error.
    YandexContest,
    /// A line of JSON with the score from 0 to 1 and a text, for the function check of a code challenge.
    Stepik,
}

/// The exit code of a command line that is not understood. A checker with codes of testlib has failed then: the 2 that
/// other commands give would blame the pupil.
pub(crate) fn of_misuse(code: u8, mut words: impl Iterator<Item = OsString>) -> u8 {
    if code == 0 {
        return 0;
    }
    let of_word = |word: OsString| {
        let word = word.to_str()?;
        let name = word.strip_prefix("--for=").unwrap_or(word);
        Platform::from_str(name, false).ok()?.misuse()
    };
    words.find_map(of_word).unwrap_or(code)
}

/// What a platform is told.
#[derive(Debug, PartialEq)]
pub(super) struct Answer {
    /// For standard output; empty for nothing.
    pub output: String,
    /// For standard error.
    pub error: Vec<String>,
    /// The exit code.
    pub code: u8,
}

/// Exit codes of testlib, and the words with which its messages begin.
fn testlib(verdict: Verdict) -> (u8, &'static str) {
    match verdict {
        Verdict::Accomplished | Verdict::Ended => (0, "ok"),
        Verdict::Wrong | Verdict::ModelTime | Verdict::Program => (1, "wrong answer"),
        Verdict::Structure => (2, "wrong output format"),
        Verdict::NotRun => (3, "FAIL"),
    }
}

impl Platform {
    /// The exit code of a command line that is not understood; None for that of other commands.
    fn misuse(self) -> Option<u8> {
        match self {
            Self::YandexContest => Some(testlib(Verdict::NotRun).0),
            Self::Stepik => None,
        }
    }

    /// The exit code if nothing could be judged.
    pub fn failed(self) -> u8 {
        match self {
            Self::YandexContest => testlib(Verdict::NotRun).0,
            Self::Stepik => Verdict::NotRun.code(),
        }
    }

    /// What it is told of these runs; `full` are the points of a run that has all, if its rules count any.
    pub(super) fn answer(self, rows: &[Row], full: Option<f64>, locale: Locale) -> Answer {
        let worst = rows.iter().map(|row| row.verdict).max();
        let worst = worst.unwrap_or(Verdict::NotRun);
        let texts = rows.iter().map(|row| text(row, rows.len() > 1, locale));
        match self {
            Self::YandexContest => {
                let (code, word) = testlib(worst);
                // The reason of the worst run stands first: tables show one line.
                let mut ranked: Vec<_> = rows.iter().map(|row| row.verdict).zip(texts).collect();
                ranked.sort_by_key(|(verdict, _)| std::cmp::Reverse(*verdict));
                let lines = ranked.into_iter().map(|(_, text)| text);
                let said = lines.collect::<Vec<_>>().join("; ");
                Answer {
                    output: String::new(),
                    error: vec![format!("{word} {said}")],
                    code,
                }
            }
            Self::Stepik => {
                let said = texts.collect::<Vec<_>>().join("\n");
                if worst == Verdict::NotRun {
                    return Answer {
                        output: String::new(),
                        error: vec![said],
                        code: worst.code(),
                    };
                }
                let scores = rows.iter().map(|row| score(row, full));
                let score = scores.sum::<f64>() / rows.len().max(1) as f64;
                let answer = json!({"score": score, "feedback": said});
                Answer {
                    output: format!("{answer}\n"),
                    error: Vec::new(),
                    code: 0,
                }
            }
        }
    }
}

/// What part of the full points a run has.
fn score(row: &Row, full: Option<f64>) -> f64 {
    match full {
        Some(full) => (row.points().unwrap_or(0.0) / full).clamp(0.0, 1.0),
        None => f64::from(u8::from(row.verdict.is_good())),
    }
}

/// How a run ended, and why.
fn text(row: &Row, are_many: bool, locale: Locale) -> String {
    let mut text = String::new();
    if let (true, Some(field)) = (are_many, &row.field) {
        let name = field.rsplit('/').next().unwrap_or(field);
        text.push_str(&format!("{}: ", harmless(name)));
    }
    text.push_str(words::verdict(row.verdict, locale));
    if let Some(points) = row.points() {
        let title = words::table(locale).points;
        text.push_str(&format!(", {title}: {points}"));
    }
    if !row.why().is_empty() {
        text.push_str(&format!(": {}", harmless(row.why())));
    }
    let explained: Vec<String> = row.explanation().collect();
    if !explained.is_empty() {
        text.push_str(&format!("\n{}", explained.join("\n")));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(verdict: Verdict, score: f64, why: &str) -> Row {
        Row {
            verdict,
            total_score: Some(score),
            ..Row::broken("x.qrs".into(), Some("a/far.xml".into()), why.into())
        }
    }

    #[test]
    fn each_kind_of_failure_has_the_code_of_the_platform() {
        let codes = Verdict::ALL.map(|verdict| {
            let rows = [row(verdict, 0.0, "why")];
            let answer = |platform: Platform| platform.answer(&rows, None, Locale::English);
            let yandex = answer(Platform::YandexContest);
            assert!(yandex.error[0].ends_with("why") && yandex.output.is_empty());
            (yandex.code, answer(Platform::Stepik).code)
        });
        let expected = [(0, 0), (0, 0), (1, 0), (1, 0), (1, 0), (2, 0), (3, 2)];
        assert_eq!(codes, expected);
        assert_eq!(Platform::YandexContest.failed(), 3);
    }

    #[test]
    fn a_command_line_that_is_not_understood_is_told_to_the_platform_that_it_names() {
        let code = |code, line: &[&str]| of_misuse(code, line.iter().map(OsString::from));
        assert_eq!(code(2, &["check", "--for", "yandex-contest"]), 3);
        assert_eq!(code(2, &["check", "--for=yandex-contest", "-x"]), 3);
        assert_eq!(code(2, &["check", "--for=stepik"]), 2);
        assert_eq!(code(2, &["check", "a.qrs"]), 2);
        assert_eq!(code(0, &["check", "--for=yandex-contest", "--help"]), 0);
    }

    #[test]
    fn scores_are_parts_of_the_full_points() {
        let rows = [
            row(Verdict::Accomplished, 40.0, ""),
            row(Verdict::ModelTime, 10.0, "too \"long\""),
        ];
        let answer = |full| Platform::Stepik.answer(&rows, full, Locale::English);
        assert_eq!(
            answer(Some(50.0)).output,
            "{\"feedback\":\"far.xml: accomplished, points: 40\\nfar.xml: out of time, points: 10: too \\\"long\\\"\",\"score\":0.5}\n"
        );
        assert!(answer(None).output.contains("\"score\":0.5"));
        let answer = Platform::YandexContest.answer(&rows, None, Locale::English);
        assert!(answer.error[0].starts_with("wrong answer far.xml: out of time, points: 10: too"));
    }
}
