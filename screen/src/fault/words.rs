//! Why an order or a picture is refused, in Russian.
//!
//! Owns the texts. The English ones stand with the errors; readers of pictures have words of their own.

use super::Fault;
use crate::limits;

/// The sentence.
pub(super) fn russian(why: &Fault) -> String {
    match why {
        Fault::LongOrder => format!("в распоряжении не больше {} байт", limits::ORDER_BYTES),
        Fault::Order(verb, orders) => {
            format!("'{verb}' - не распоряжение для дисплея; есть {orders}")
        }
        Fault::Number(verb, count, word) => {
            format!("для {verb} сначала нужны числа, всего {count}, а не '{word}'")
        }
        Fault::MoreWords(verb, count, words) => {
            format!("для {verb} нужны только числа, всего {count}: '{words}' лишнее")
        }
        Fault::Labels => format!(
            "надписей уже {}: вызовите removeLabels()",
            limits::LABELS_MAX
        ),
        Fault::Colour(name, names) => {
            format!("'{name}' - не цвет; есть {names} и #rrggbb")
        }
        Fault::NoPicture => "это картинка не в PNG и не в JPEG".to_owned(),
        Fault::Jpeg(why) => format!("картинка JPEG не читается: {why}"),
        Fault::Png(why) => format!("картинка PNG не читается: {why}"),
        Fault::Pixels(width, height) => format!(
            "в картинке {width} x {height} пикселей, а можно не больше {} в ряду и {} всего",
            limits::SIDE_MAX,
            limits::PICTURE_PIXELS
        ),
        Fault::PngSize => "картинка PNG слишком велика".to_owned(),
        Fault::Format(name) => {
            format!("'{name}' - не формат пикселей; есть rgb32, rgb888 и grayscale8")
        }
        Fault::Side(size) => format!("{size} - не ширина и не высота"),
        Fault::FewNumbers(width, height, needed, there) => {
            format!("для {width} x {height} пикселей нужно чисел {needed}, а их {there}")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn why_an_order_is_refused_is_said_in_russian() {
        let text = || "x".to_owned();
        for why in [
            Fault::LongOrder,
            Fault::Order(text(), "a, b"),
            Fault::Number(text(), 2, text()),
            Fault::MoreWords(text(), 2, text()),
            Fault::Labels,
            Fault::Colour(text(), "red"),
            Fault::NoPicture,
            Fault::Jpeg(text()),
            Fault::Png(text()),
            Fault::Pixels(1, 2),
            Fault::PngSize,
            Fault::Format(text()),
            Fault::Side(-1),
            Fault::FewNumbers(1, 2, 2, 1),
        ] {
            assert!(why.to_string().is_ascii(), "{why}");
            let is_russian = |c: char| ('а'..='я').contains(&c);
            assert!(why.russian().chars().any(is_russian), "{}", why.russian());
        }
    }
}
