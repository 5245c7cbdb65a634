//! Why something is not shown on the display, in Russian.
//!
//! Owns the texts. The English ones stand with the errors.

use super::Unshown;
use crate::limits;
use crate::pictures::NoPicture;

/// The sentence.
pub(super) fn russian(why: &Unshown) -> String {
    match why {
        Unshown::Fault(why) => why.russian(),
        Unshown::File(path, os) => format!("{}: {}", path.display(), os.russian()),
        Unshown::LongFile(path) => {
            let most = screen::limits::FILE_BYTES >> 20;
            format!("{}: больше {most} МиБ", path.display())
        }
        Unshown::NotPicture(path, why) => format!("{}: {}", path.display(), why.russian()),
        Unshown::NoDisplay(path) => {
            format!(
                "в дереве нет дисплея ({}); ничего не показывается",
                path.display()
            )
        }
        Unshown::Tree(path, os, fault) => {
            let fault = match fault.as_str() {
                "" => String::new(),
                fault => format!(" ({fault})"),
            };
            let path = path.display();
            format!("{path}: {}{fault}; ничего не показывается", os.russian())
        }
        Unshown::Simulated(why) => (*why).to_string(),
        Unshown::NoPhoto(why) => no_picture(why),
        Unshown::NoText => "это распоряжение - не текст в UTF-8".to_owned(),
        Unshown::NotWhole(verb, word) => format!("для {verb} нужны целые числа, а не '{word}'"),
        Unshown::ShowWords => "для show нужны ширина, высота, формат и количество чисел".to_owned(),
        Unshown::PhotoWords => "для photo нужны ширина и высота".to_owned(),
        Unshown::PhotoSide(word) => format!("{word} - не ширина и не высота снимка"),
        Unshown::ManyNumbers => format!("для show чисел не больше {}", limits::SHOWN_NUMBERS),
        Unshown::FewNumbers => "чисел меньше, чем указано".to_owned(),
        Unshown::Numbers(os) => os.russian(),
        Unshown::Orders(os) => format!("распоряжения не читаются: {}", os.russian()),
        Unshown::Answers(os) => format!("ответы не записываются: {}", os.russian()),
        Unshown::Failed(count) => format!("не выполнено распоряжений: {count}"),
    }
}

fn no_picture(why: &NoPicture) -> String {
    match why {
        NoPicture::Tree(path, os, fault) => {
            let fault = match fault.as_str() {
                "" => String::new(),
                fault => format!(" ({fault})"),
            };
            format!("{}: {}{fault}", path.display(), os.russian())
        }
        NoPicture::Strange(path, why) => format!("{}: {}", path.display(), why.russian()),
        NoPicture::Simulated => "у робота в симуляторе нет картинки с камеры".to_owned(),
        NoPicture::NoneYet => "картинки ещё нет".to_owned(),
        NoPicture::Silent(seconds) => format!("камера ничего не даёт уже {seconds} с"),
        NoPicture::NoReader(os) => os.russian(),
        NoPicture::End => "trikd завершается".to_owned(),
    }
}
