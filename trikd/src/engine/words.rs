//! Why a program did not end well, in Russian.
//!
//! Owns the texts. The English ones stand with the errors; what a program says itself is its own.

use super::{Failure, NoDiagram, NoThread};
use crate::js::files::Unread;
use crate::limits;

/// The sentence.
pub(super) fn russian(failure: &Failure) -> String {
    match failure {
        Failure::Program(text) => text.clone(),
        Failure::Told => String::new(),
        Failure::NoFile => "диаграмма - это файл".to_owned(),
        Failure::Diagram(name, why) => format!("{name}: {}", no_diagram(why)),
        Failure::Unread(why) => unread(why),
        Failure::Nowhere(path, os) => format!("{}: где это? {}", path.display(), os.russian()),
        Failure::Thread(why) => no_thread(why),
        Failure::Start(os) => format!("программа не запускается: {}", os.russian()),
        Failure::Engine(why) => format!("JavaScript не запускается: {why}"),
        Failure::Broken => "в trikd ошибка: его JavaScript оборвался".to_owned(),
        Failure::NoWay(os) => format!("к демону нет пути: {}", os.russian()),
        Failure::NoStart(os) => format!("демон не говорит, что выполнять: {}", os.russian()),
        Failure::Deaf(os) => format!("демона не слышно: {}", os.russian()),
        Failure::Stop(tree, os) => format!(
            "{}/stop: моторы, возможно, ещё вращаются: {}",
            tree.display(),
            os.russian()
        ),
    }
}

pub(super) fn no_diagram(why: &NoDiagram) -> String {
    match why {
        NoDiagram::Unread(os) => format!("не читается: {}", os.russian()),
        NoDiagram::TooLong(limit) => format!("длиннее {} МиБ", limit >> 20),
        NoDiagram::Problems(lines) => lines.join("\n"),
    }
}

fn no_thread(why: &NoThread) -> String {
    match why {
        NoThread::Occupied(name) => format!("поток с именем {name} уже есть"),
        NoThread::TooMany => format!(
            "в программе одновременно не больше {} потоков: дождитесь конца некоторых через Threading.joinThread",
            limits::JS_THREADS
        ),
        NoThread::System(os) => format!("поток не создаётся: {}", os.russian()),
    }
}

fn unread(why: &Unread) -> String {
    match why {
        Unread::Unopened(path, os) => {
            format!("{}: не открывается: {}", path.display(), os.russian())
        }
        Unread::Broken(path, os) => format!("{}: не читается: {}", path.display(), os.russian()),
        Unread::TooLong(path) => format!(
            "{}: длиннее {} МиБ",
            path.display(),
            limits::JS_FILE_BYTES >> 20
        ),
        Unread::Outside(file) => {
            format!("{file}: программа под проверкой читает только файлы своей папки")
        }
    }
}
