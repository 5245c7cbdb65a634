//! Why an order to the world is not done, in Russian.
//!
//! Owns the texts. The English ones stand with the errors.

use super::{BadOrder, ORDERS};
use crate::limits;

/// The sentence.
pub(super) fn russian(why: &BadOrder) -> String {
    match why {
        BadOrder::NoOrders => {
            "вокруг этого робота нет мира, которым можно распоряжаться: выберите другого робота"
                .to_owned()
        }
        BadOrder::Unknown(words) => format!(
            "'{words}' - не распоряжение: есть {}",
            ORDERS.replace(" or ", " и ")
        ),
        BadOrder::Ticks => format!(
            "для step нужно от 1 до {} шагов по 10 мс",
            limits::STEPS_ORDERED
        ),
        BadOrder::Speed(word) => {
            let (least, most) = (limits::MIN_SPEED, limits::MAX_SPEED);
            format!("скорость бывает от {least} до {most}, а не '{word}'")
        }
        BadOrder::Place(words) => format!(
            "'{words}' - не место: напишите метры от {} до {} и градусы",
            -limits::PLACE_M,
            limits::PLACE_M
        ),
        BadOrder::Outside => "это место за стенами комнаты".to_owned(),
        BadOrder::NoThing(number) => format!("в этом мире нет предмета номер {number}"),
        BadOrder::OwnRoom => {
            "у этого робота своя комната; другие миры принимает только робот от `trik up --field`"
                .to_owned()
        }
        BadOrder::Locked => {
            "проект этого мира закрыл его: стены и предметы остаются на местах".to_owned()
        }
        BadOrder::RobotLocked => "проект этого мира закрыл место робота".to_owned(),
        BadOrder::Unread(file, why) => {
            format!("{file}: {}", lang_text::problem::of_system(why))
        }
        BadOrder::Field(file, why) => format!("{file}: {}", why.russian),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lang_text::problem::Words;

    #[test]
    fn why_an_order_is_not_done_is_said_in_russian() {
        let text = || "x".to_owned();
        for why in [
            BadOrder::NoOrders,
            BadOrder::Unknown(text()),
            BadOrder::Ticks,
            BadOrder::Speed(text()),
            BadOrder::Place(text()),
            BadOrder::Outside,
            BadOrder::NoThing(3),
            BadOrder::OwnRoom,
            BadOrder::Locked,
            BadOrder::RobotLocked,
            BadOrder::Unread(text(), "Permission denied (os error 13)".to_owned()),
            BadOrder::Field(text(), Words::new("no world", "не мир")),
        ] {
            let words = why.words();
            assert_ne!(words.english, words.russian);
            let is_russian = |c: char| ('а'..='я').contains(&c);
            assert!(words.russian.chars().any(is_russian), "{}", words.russian);
        }
    }
}
