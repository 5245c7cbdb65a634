//! The mailbox of a judged program.
//!
//! Owns what it answers where there are no other robots. Its words are those of the programs of a robot.

use lang_diagram::brick::Command;
use lang_diagram::mailbox::Question;

/// What the mailbox answers to the words of a program, and what the robot is told.
pub fn answer(words: &str, hull: &mut i32, mut tell: impl FnMut(Command<'_>)) -> String {
    let Some(question) = Question::parse(words) else {
        return String::new();
    };
    match question {
        Question::Send { hull, text } => tell(Command::Send {
            message: text,
            hull: hull.filter(|hull| *hull >= 0),
        }),
        Question::Join {
            address,
            port,
            hull: own,
        } => {
            *hull = own.max(0);
            tell(Command::Join {
                address,
                port,
                hull: own,
            });
        }
        Question::SetHull(number) => {
            *hull = number;
            return hull.to_string();
        }
        Question::Hull => return hull.to_string(),
        Question::Ip => return "127.0.0.1".to_owned(),
        Question::Connected | Question::Enabled => return "1".to_owned(),
        // The judge knows no other addresses.
        Question::Connect { .. } | Question::Server | Question::Renew => {}
    }
    String::new()
}
