//! Why a robot of a class is not there or has not done something, in two languages.
//!
//! Owns the texts. What a robot says itself stays as it is: the page knows its sentences.

use crate::limits;
use lang_text::problem::Words;
use std::io;
use std::net::SocketAddr;

/// Why something is not so.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Why {
    /// It is not known where it is.
    Nowhere(Words),
    /// Nothing takes programs there.
    Refused(SocketAddr),
    /// Nothing answers there.
    NoAnswer(SocketAddr),
    /// The network has no way to it.
    NoWay(SocketAddr),
    /// It was there and says nothing.
    Silent,
    /// The file takes too long.
    Slow,
    /// It has closed the connection.
    Closed,
    /// It does not speak as robots do.
    NoRobot(String),
    /// What the system says.
    System(String),
    /// What the robot says.
    Said(String),
    /// The robot is not reached.
    Away,
    /// Everything was stopped before.
    Stopped,
    /// A mistake of this program.
    Failed,
}

impl Why {
    /// Why there is no connection to an address.
    // Kinds of errors of the system are not ours to list.
    #[allow(clippy::wildcard_enum_match_arm)]
    pub fn of(at: SocketAddr, error: &io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::ConnectionRefused => Self::Refused(at),
            io::ErrorKind::TimedOut => Self::NoAnswer(at),
            io::ErrorKind::HostUnreachable | io::ErrorKind::NetworkUnreachable => Self::NoWay(at),
            _ => Self::System(crate::error::plain(error)),
        }
    }

    /// The sentence in each language.
    pub fn words(&self) -> Words {
        let seconds = limits::CLASS_SILENCE_TIME.as_secs();
        match self {
            Self::Nowhere(words) => words.clone(),
            Self::Refused(at) => {
                let hint = match at.ip().is_loopback() {
                    true => (
                        "start a virtual robot with trik up",
                        "запустите виртуального робота: trik up",
                    ),
                    false => ("start trikd on the robot", "запустите trikd на роботе"),
                };
                Words::new(
                    format!("nothing takes programs at {at}: {}", hint.0),
                    format!("по адресу {at} никто не принимает программы: {}", hint.1),
                )
            }
            Self::NoAnswer(at) => Words::new(
                format!("{at} does not answer: is it switched on, and in the same network?"),
                format!("{at} не отвечает: робот включён и находится в той же сети?"),
            ),
            Self::NoWay(at) => Words::new(
                format!("there is no way to {at}: is this computer in the network of the robot?"),
                format!("к адресу {at} нет пути: этот компьютер в сети робота?"),
            ),
            Self::Silent => Words::new(
                format!("it has said nothing for {seconds} s"),
                format!("робот молчит уже {seconds} с"),
            ),
            Self::Slow => {
                let seconds = limits::CLASS_UPLOAD_TIME.as_secs();
                Words::new(
                    format!("the file was not there after {seconds} s"),
                    format!("файл не дошёл за {seconds} с"),
                )
            }
            Self::Closed => Words::new(
                "the robot has closed the connection",
                "робот закрыл соединение",
            ),
            Self::NoRobot(why) => Words::new(
                format!("it does not speak as robots do: {why}"),
                format!("ответ не похож на ответ робота: {why}"),
            ),
            Self::System(why) | Self::Said(why) => Words::new(why, why),
            Self::Away => Words::new("the robot is not reached", "с роботом нет связи"),
            Self::Stopped => Words::new(
                "everything was stopped before it began",
                "всё было остановлено раньше, чем программа началась",
            ),
            Self::Failed => Words::new(
                "this program has failed; its terminal says why",
                "ошибка в самой программе; подробности в её терминале",
            ),
        }
    }
}

/// Why an order of a viewer is not carried out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refused {
    /// This computer may only look.
    Looks,
    /// The words are no order.
    Words,
    /// No program can have this name.
    Name,
    /// The file is empty.
    Empty,
    /// Files are on their way.
    Busy,
    /// No robot is chosen.
    Nobody,
}

impl Refused {
    /// The sentence in each language.
    pub fn words(self) -> Words {
        match self {
            Self::Looks => Words::new(
                "this computer may only look: robots are commanded on the computer that serves the page",
                "с этого компьютера можно только смотреть: роботами управляют с компьютера, на котором работает страница",
            ),
            Self::Words => Words::new("this is no order", "это не распоряжение"),
            Self::Name => Words::new(
                "a file of this name cannot be a program: it has a colon, a slash, a backslash or control characters, begins with a dot, or is too long",
                "файл с таким именем не может быть программой: в имени двоеточие, косая черта или управляющие символы, оно начинается с точки или слишком длинное",
            ),
            Self::Empty => Words::new("the file is empty", "файл пуст"),
            Self::Busy => Words::new(
                "files are on their way: wait until they have arrived",
                "файлы ещё отправляются: подождите, пока они дойдут",
            ),
            Self::Nobody => Words::new("no robot is chosen", "не выбран ни один робот"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_reason_is_said_in_both_languages() {
        let at: SocketAddr = "127.0.0.1:8888".parse().unwrap();
        let far: SocketAddr = "192.168.77.1:8888".parse().unwrap();
        let reasons = [
            Why::Refused(at),
            Why::Refused(far),
            Why::NoAnswer(at),
            Why::NoWay(at),
            Why::Silent,
            Why::Slow,
            Why::Closed,
            Why::NoRobot("x".to_owned()),
            Why::Away,
            Why::Stopped,
            Why::Failed,
        ];
        let refusals = [
            Refused::Looks,
            Refused::Words,
            Refused::Name,
            Refused::Empty,
            Refused::Busy,
            Refused::Nobody,
        ];
        let all = reasons.iter().map(Why::words);
        for words in all.chain(refusals.map(Refused::words)) {
            assert!(words.english.is_ascii(), "{}", words.english);
            let letters = words.russian.chars().filter(|c| ('а'..='я').contains(c));
            assert!(letters.count() >= 8, "{}", words.russian);
        }
        assert_ne!(Why::Refused(at).words(), Why::Refused(far).words());
    }

    #[test]
    fn what_the_system_says_of_a_connection_is_told_apart() {
        let at: SocketAddr = "127.0.0.1:1".parse().unwrap();
        let of = |number| Why::of(at, &io::Error::from_raw_os_error(number));
        assert_eq!(of(111), Why::Refused(at));
        assert_eq!(of(110), Why::NoAnswer(at));
        assert_eq!(of(113), Why::NoWay(at));
        assert_eq!(of(13), Why::System("Permission denied".to_owned()));
    }
}
