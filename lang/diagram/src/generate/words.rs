//! What is said when a diagram cannot be written in a language, in English and Russian.

use super::code::{Operation, Robot, Truth, Turn};
use lang_text::problem::Words;

pub(super) fn too_many_blocks(count: usize) -> Words {
    Words::new(
        format!(
            "The project has {count} blocks; a program of so many would help nobody. Divide it into smaller projects."
        ),
        format!(
            "В проекте {count} блоков; программа такого размера бесполезна. Разделите проект на несколько."
        ),
    )
}

pub(super) fn too_many_threads() -> Words {
    Words::new(
        "There are too many threads and subprograms for one program. Use fewer.",
        "Слишком много потоков и подпрограмм для одной программы. Сделайте их меньше.",
    )
}

pub(super) fn no_beginning() -> Words {
    Words::new(
        "No entry point found, please add Initial Node to a diagram.",
        "Не найдена точка входа: добавьте на диаграмму начальный узел.",
    )
}

pub(super) fn unclear_thread() -> Words {
    Words::new(
        "Several threads come here, and which way each of them goes depends on its name. A program as text cannot say that: draw the block for each thread.",
        "Сюда приходят несколько потоков, и путь каждого зависит от его имени. Текстовая программа так не умеет: нарисуйте блок для каждого потока.",
    )
}

pub(super) fn no_own_branch() -> Words {
    Words::new(
        "No link out of this fork continues the present thread: give one the thread's name, or leave it blank.",
        "Ни одна связь из этого блока не продолжает текущий поток: укажите на одной имя потока или оставьте её пустой.",
    )
}

pub(super) fn no_subprogram() -> Words {
    Words::new(
        "The subprogram of this block is not in the project. Choose another one.",
        "Подпрограммы этого блока нет в проекте. Выберите другую.",
    )
}

pub(super) fn no_questions(language: &str) -> Words {
    Words::new(
        format!(
            "The block Input asks the person at the editor, whom a program in {language} on the robot cannot ask. Use a variable instead."
        ),
        format!(
            "Блок «Ввод» спрашивает человека за редактором; программа на языке {language} на роботе спросить его не может. Используйте переменную."
        ),
    )
}

pub(super) fn no_line_of_code() -> Words {
    Words::new(
        "A line of a program in JavaScript cannot be taken over into another program. Write it with blocks, or use a command of the shell.",
        "Строку программы на JavaScript нельзя перенести в другую программу. Запишите её блоками или командой оболочки.",
    )
}

pub(super) fn ports_must_be_plain() -> Words {
    Words::new(
        "Ports must be written as they are, as M3, M4: a program as text has a command for each.",
        "Порты нужно указать прямо, например M3, M4: в текстовой программе для каждого своя команда.",
    )
}

pub(super) fn port_must_be_plain() -> Words {
    Words::new(
        "The port must be written as it is, as sensor(\"A1\").",
        "Порт нужно указать прямо, например sensor(\"A1\").",
    )
}

pub(super) fn unknown_port(name: &str) -> Words {
    Words::new(
        format!("There is no port {name}. Choose one that the robot has."),
        format!("Порта {name} нет. Выберите порт, который есть у робота."),
    )
}

pub(super) fn too_deep() -> Words {
    Words::new(
        "The expression nests too deeply. Divide it, with variables for its parts.",
        "Слишком глубокая вложенность выражения. Разделите его с помощью переменных.",
    )
}

pub(super) fn bad_number(text: &str) -> Words {
    Words::new(
        format!("{text} is no number that can be written."),
        format!("{text} нельзя записать как число."),
    )
}

pub(super) fn no_value() -> Words {
    Words::new(
        "This gives no value: an expression is needed here.",
        "Здесь нет значения: нужно выражение.",
    )
}

pub(super) fn no_target() -> Words {
    Words::new(
        "Only a variable or an element of a table can be assigned to.",
        "Присвоить значение можно только переменной или элементу таблицы.",
    )
}

pub(super) fn no_value_ever(name: &str) -> Words {
    Words::new(
        format!("Undeclared identifier: {name}. No block gives it a value."),
        format!("Неизвестный идентификатор: {name}. Ни один блок не присваивает ему значение."),
    )
}

pub(super) fn read_only(name: &str) -> Words {
    Words::new(
        format!("Variable {name} is read-only"),
        format!("Переменная {name} доступна только для чтения"),
    )
}

pub(super) fn unknown_function(name: &str) -> Words {
    Words::new(
        format!("Unknown function: {name}"),
        format!("Неизвестная функция: {name}"),
    )
}

pub(super) fn wrong_count(name: &str, count: usize) -> Words {
    Words::new(
        format!("The function {name} takes {count} parameters."),
        format!("У функции {name} должно быть параметров: {count}."),
    )
}

pub(super) fn no_such_kind(name: &str, language: &str) -> Words {
    Words::new(
        format!(
            "The variable {name} has values of several kinds, which {language} does not allow. Use one variable for each kind."
        ),
        format!(
            "У переменной {name} значения разных типов, {language} так не умеет. Заведите переменную для каждого типа."
        ),
    )
}

/// Something that a language cannot say at all.
pub(super) fn cannot(operation: Operation, language: &str) -> Words {
    let (english, russian) = thing(operation);
    Words::new(
        format!("Programs in {language} cannot do what {english} does. Choose another language."),
        format!(
            "Программы на {language} не умеют того, что делает {russian}. Выберите другой язык."
        ),
    )
}

/// Something that a program does without.
pub(super) fn left_out(operation: Operation, language: &str) -> Words {
    let (english, russian) = thing(operation);
    Words::new(
        format!("{english} is left out: programs in {language} cannot do it."),
        format!("{russian} пропущен: программы на {language} этого не умеют."),
    )
}

/// What a person knows it as: mostly the name of a block.
fn thing(operation: Operation) -> (String, String) {
    let block = |english: &str, russian: &str| {
        (
            format!("the block {english}"),
            format!("блок \"{russian}\""),
        )
    };
    match operation {
        Operation::Command(command) => block(command.english, command.russian),
        Operation::Read(reading) => (reading.english.into(), reading.russian.into()),
        Operation::Robot(Robot::Redraw) => ("drawing".into(), "вывод на экран".into()),
        Operation::Turn(turn) => match turn {
            Turn::Mail => block("Wait for Message", "Получить сообщение"),
            Turn::Send => block("Send Message To Thread", "Послать сообщение потоку"),
            Turn::Receive | Turn::ReceiveNow => block(
                "Receive Message From Thread",
                "Получить сообщение от потока",
            ),
            Turn::Start | Turn::Join | Turn::Kill => ("threads".into(), "потоки".into()),
            Turn::AnyButton => block("Get Button Code", "Код кнопки"),
            Turn::Wait => block("Timer", "Таймер"),
        },
        Operation::Truth(Truth::EqualAny | Truth::NotEqualAny) => (
            "a comparison of values of any kind".into(),
            "сравнение значений любого типа".into(),
        ),
        // All languages have words for these.
        Operation::Number(_)
        | Operation::Truth(_)
        | Operation::Conversion(_)
        | Operation::Function(_)
        | Operation::Element(_)
        | Operation::Robot(_) => (format!("{operation:?}"), format!("{operation:?}")),
    }
}

/// Why threads of JavaScript are not those of the controller.
pub(super) fn shared_variables(names: &str) -> Words {
    Words::new(
        format!(
            "Several threads use {names}, so the threads take turns in one engine, as generators: trikd runs that, the first runtimes of TRIK do not."
        ),
        format!(
            "Эти переменные нужны нескольким потокам: {names}. Поэтому потоки работают по очереди в одной среде, как генераторы: trikd это выполнит, первые среды ТРИК - нет."
        ),
    )
}

pub(super) fn copied_blocks(function: &str) -> Words {
    Words::new(
        format!(
            "Some blocks stand several times in {function}: branches share them in the diagram."
        ),
        format!(
            "Некоторые блоки повторяются в {function}: на диаграмме они общие для нескольких ветвей."
        ),
    )
}

pub(super) fn by_states(function: &str) -> Words {
    Words::new(
        format!(
            "The arrows of {function} cross so much that it became a loop over a variable that says where the program is."
        ),
        format!(
            "Стрелки в {function} так переплетены, что получился цикл по переменной, которая помнит, где находится программа."
        ),
    )
}
