//! What goes wrong while a data-flow program runs, in words.
//!
//! Owns the texts in both languages. Where something is wrong is known to who finds it.

use crate::limits;
pub(crate) use crate::words::{
    bad_width, busy_instant, loop_step, no_choice, too_large_number, too_large_token,
    too_many_names,
};
use crate::words::{list, short, what};
use lang_expr::Value;
use lang_text::near;
use lang_text::problem::Words;

pub(crate) fn unit() -> Words {
    Words::new(
        "a control token came here, which has no value: connect a data output",
        "сюда пришёл управляющий сигнал без значения: присоедините выход с данными",
    )
}

pub(crate) fn unit_read(name: &str) -> Words {
    Words::new(
        format!("{name} got a control token, which has no value: connect a data output"),
        format!("в {name} пришёл управляющий сигнал без значения: присоедините выход с данными"),
    )
}

pub(crate) fn unbound(name: &str) -> Words {
    Words::new(
        format!("{name} has no value yet"),
        format!("у {name} ещё нет значения"),
    )
}

pub(crate) fn no_whole(value: &Value) -> Words {
    Words::new(
        format!("{} is not a whole number", what(value)),
        format!("{} не целое число", what(value)),
    )
}

pub(crate) fn no_truth(value: &Value) -> Words {
    Words::new(
        format!("{} is neither true nor false", what(value)),
        format!("{} ни истина, ни ложь", what(value)),
    )
}

pub(crate) fn no_text(value: &Value) -> Words {
    Words::new(
        format!("{} is not a text", what(value)),
        format!("{} не текст", what(value)),
    )
}

pub(crate) fn no_list(value: &Value) -> Words {
    Words::new(
        format!("{} is not a list", what(value)),
        format!("{} не список", what(value)),
    )
}

pub(crate) fn wrong_count(found: usize, wanted: usize) -> Words {
    Words::new(
        format!("a list of {wanted} numbers is needed, this one has {found} items"),
        format!("нужен список из {wanted} чисел, а в этом элементов: {found}"),
    )
}

pub(crate) fn list_short(found: usize, wanted: usize) -> Words {
    Words::new(
        format!("a list of at least {wanted} items is needed, this one has {found}"),
        format!("нужен список хотя бы из {wanted} элементов, а в этом: {found}"),
    )
}

pub(crate) fn too_many_variables() -> Words {
    Words::new(
        "the program has too many variables, or its values are too large together",
        "в программе слишком много переменных, или все значения вместе слишком велики",
    )
}

/// What a new version cannot do because of the types that variables have in the program that runs.
pub(crate) fn kept_types(why: &Words, kept: &[(String, String)]) -> Words {
    let shown = |is: &str| -> String {
        let all = kept.iter().take(limits::LISTED_MAX);
        let all = all.map(|(name, of)| format!("{} {is}{of}", short(name)));
        all.collect::<Vec<_>>().join(", ")
    };
    let (english, russian) = (shown("is of type "), shown("имеет тип "));
    Words::new(
        format!(
            "{}; variables keep the types that they have in the running program, where {english}: start the program anew, or take another variable",
            why.english.trim_end_matches('.')
        ),
        format!(
            "{}; переменные сохраняют типы, которые у них есть в работающей программе, а там {russian}: запустите программу заново или возьмите другую переменную",
            why.russian.trim_end_matches('.')
        ),
    )
}

pub(crate) fn queue_full(places: u16) -> Words {
    Words::new(
        format!(
            "{places} tokens wait here already, and the policy of this queue is error: the other inputs get fewer tokens"
        ),
        format!(
            "здесь уже ждут значений: {places}, а правило этой очереди - error: на другие входы значений приходит меньше"
        ),
    )
}

pub(crate) fn queue_overflows(places: u16) -> Words {
    Words::new(
        format!(
            "{places} tokens wait here already, so the oldest ones are lost: the other inputs get fewer tokens; `latest` keeps only the newest one"
        ),
        format!(
            "здесь уже ждут значений: {places}, поэтому самые старые пропадают: на другие входы значений приходит меньше; `latest` хранит только новейшее"
        ),
    )
}

pub(crate) fn busy() -> Words {
    Words::new(
        "tokens that come while it waits are lost: switch 'keep' on if they have to wait their turn",
        "значения, пришедшие во время ожидания, пропадают: включите 'keep', если они должны ждать своей очереди",
    )
}

pub(crate) fn kept_overflow(places: usize) -> Words {
    Words::new(
        format!(
            "there is room for at most {places} tokens that wait their turn, so the oldest ones are lost: they come faster than they are let go"
        ),
        format!(
            "мест для ждущих своей очереди не больше {places}, поэтому самые старые значения пропадают: они приходят быстрее, чем уходят"
        ),
    )
}

pub(crate) fn kept_too_heavy() -> Words {
    Words::new(
        "the tokens that wait in this program are too large together, so some that come here are lost: keep fewer of them, or shorter ones",
        "ждущие в программе значения вместе слишком велики, поэтому часть приходящих сюда пропадает: храните меньше значений или более короткие",
    )
}

pub(crate) fn runaway(most: u32, blocks: &[String]) -> Words {
    let names = list(blocks.iter().map(String::as_str));
    Words::new(
        format!(
            "blocks have reacted {most} times within one instant without an end ({names}): put a 'Wait and send' into the cycle"
        ),
        format!(
            "блоки сработали {most} раз в одно мгновение, и конца не видно ({names}): поставьте в цикл ожидание"
        ),
    )
}

pub(crate) fn too_many_tokens(most: usize) -> Words {
    Words::new(
        format!("more than {most} tokens are on their way within one instant"),
        format!("в одно мгновение в пути больше {most} значений"),
    )
}

pub(crate) fn assigning_text() -> Words {
    Words::new(
        "a text that comes as a token is computed, and must not assign variables",
        "текст, пришедший как значение, вычисляется и не может менять переменные",
    )
}

pub(crate) fn unknown_in_text(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!(
            "a text that comes as a token is computed, and '{name}' in it is no variable; a text that is none of code is \
             sent without 'Evaluate'"
        ),
        format!(
            "текст, пришедший как значение, вычисляется, а '{name}' в нём не переменная; просто текст посылают без \
             'Evaluate'"
        ),
    )
}

pub(crate) fn no_reading(device: &str) -> Words {
    Words::new(
        format!(
            "the robot has no such device, or it says nothing: {device}; a simulated robot gets its sensors from its world"
        ),
        format!(
            "у робота нет такого устройства, или оно молчит: {device}; датчики виртуального робота задаёт его мир"
        ),
    )
}

pub(crate) fn no_reading_later() -> Words {
    Words::new(
        "the robot has no such device, or it says nothing: when this block is started, the program ends with an error",
        "у робота нет такого устройства, или оно молчит: когда этот блок запустится, программа закончится ошибкой",
    )
}

pub(crate) fn sensor_missing_later(name: &str) -> Words {
    Words::new(
        format!(
            "the robot has no such device, or it says nothing: {name}; when this text is computed, the program ends with an error"
        ),
        format!(
            "у робота нет такого устройства, или оно молчит: {name}; когда этот текст будет вычислен, программа закончится ошибкой"
        ),
    )
}

pub(crate) fn reading_failed() -> Words {
    Words::new(
        "the sensor says nothing for a while, so no tokens come from it",
        "датчик временно молчит, поэтому значений от него нет",
    )
}

pub(crate) fn sensor_missing(name: &str) -> Words {
    Words::new(
        format!("{name} says nothing: the robot has no such sensor"),
        format!("{name} молчит: у робота нет такого датчика"),
    )
}

pub(crate) fn other_camera(text: &str) -> Words {
    Words::new(
        format!(
            "'{}' is not the sensor of the camera that is wanted here (line, object or color)",
            short(text)
        ),
        format!(
            "'{}' не тот датчик камеры, который здесь нужен (line, object или color)",
            short(text)
        ),
    )
}

pub(crate) fn no_file(file: &str) -> Words {
    Words::new(
        format!("there is no file '{}' that could be read here", short(file)),
        format!(
            "файла '{}', который можно прочитать, здесь нет",
            short(file)
        ),
    )
}

pub(crate) fn file_too_long(file: &str, most: usize) -> Words {
    Words::new(
        format!("'{}' has more than {most} words or lines", short(file)),
        format!("в '{}' больше {most} слов или строк", short(file)),
    )
}

pub(crate) fn asks_the_robot() -> Words {
    Words::new(
        "an expression from outside reads no sensors and no random numbers, and prints nothing",
        "выражение снаружи не читает датчиков и случайных чисел и ничего не печатает",
    )
}

pub(crate) fn assigns_aside() -> Words {
    Words::new(
        "an expression from outside reads variables and assigns none",
        "выражение снаружи читает переменные и не присваивает",
    )
}

/// What a person assigns is no number that a program can compute with.
pub(crate) fn not_finite(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!("{name} would be infinite or no number, and motors and waits need one"),
        format!("{name} станет бесконечностью или не числом, а моторам и ожиданиям нужно число"),
    )
}

pub(crate) fn no_variable(name: &str, known: &[&str]) -> Words {
    let near = near::did_you_mean(name, known.iter().copied());
    let there = list(known.iter().copied());
    let (english, russian) = match known {
        [] => (String::new(), String::new()),
        [..] => (format!("; it has: {there}"), format!("; есть: {there}")),
    };
    Words::new(
        format!(
            "the program has no variable '{}' with a value{english}{}",
            short(name),
            near.english
        ),
        format!(
            "в программе нет переменной '{}' со значением{russian}{}",
            short(name),
            near.russian
        ),
    )
}

pub(crate) fn no_such_variable<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Words {
    let near = near::did_you_mean(name, known);
    Words::new(
        format!(
            "the program has no variable '{}'{}",
            short(name),
            near.english
        ),
        format!(
            "в программе нет переменной '{}'{}",
            short(name),
            near.russian
        ),
    )
}

pub(crate) fn sensor_gives_tokens(name: &str) -> Words {
    Words::new(
        format!(
            "{} is a sensor, whose readings are tokens: stop at a block that gets them, with a condition on data",
            short(name)
        ),
        format!(
            "{} - датчик, его показания приходят сигналами: остановитесь на блоке, который их получает, с условием на data",
            short(name)
        ),
    )
}

pub(crate) fn never_changes(name: &str) -> Words {
    Words::new(
        format!("{} is no variable and never changes", short(name)),
        format!("{} - не переменная и никогда не меняется", short(name)),
    )
}

pub(crate) fn only_looked_at() -> Words {
    Words::new(
        "an expression that is only looked at cannot assign; == compares",
        "в просматриваемом выражении не может быть присваивания; сравнивает ==",
    )
}

/// Kinds of tokens.
pub(crate) const A_TRUTH: [&str; 2] = ["a truth", "логическое значение"];
pub(crate) const A_NUMBER: [&str; 2] = ["a number", "число"];
pub(crate) const A_TEXT: [&str; 2] = ["a text", "текст"];
pub(crate) const A_LIST: [&str; 2] = ["a list", "список"];

pub(crate) fn unit_stays() -> Words {
    Words::new(
        "the token that comes next has no value: there is nothing to change",
        "следующий сигнал без значения: менять нечего",
    )
}

pub(crate) fn token_keeps_kind([english, russian]: [&str; 2]) -> Words {
    Words::new(
        format!(
            "the token that comes next is {english} and stays one: the blocks after it expect that"
        ),
        format!(
            "следующее значение — {russian}, и другим стать не может: этого ждут блоки после него"
        ),
    )
}

pub(crate) fn token_stays_whole() -> Words {
    Words::new(
        "the token that comes next is a whole number of at most 32 bits and stays one: the blocks after it expect that",
        "следующее значение — целое число не больше чем в 32 бита, и другим стать не может: этого ждут блоки после него",
    )
}

pub(crate) fn no_value_yet() -> Words {
    Words::new("no value yet", "значения ещё нет")
}

pub(crate) fn starts_by_itself() -> Words {
    Words::new(
        "this block gives readings by itself: stop at the block after it",
        "этот блок сам даёт показания: остановитесь на блоке после него",
    )
}

pub(crate) fn repeats_by_itself() -> Words {
    Words::new(
        "this block gives numbers by itself, one each time that its time is over: stop at the block after it",
        "этот блок сам даёт числа, по одному, когда проходит его время: остановитесь на блоке после него",
    )
}

pub(crate) fn only_passes() -> Words {
    Words::new(
        "tokens pass this port without a reaction: stop at the block after it",
        "через этот порт сигналы проходят без реакции: остановитесь на блоке после него",
    )
}
