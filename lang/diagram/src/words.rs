//! What is said of diagrams, in English and Russian: links, threads, subprograms, devices.
//!
//! Owns the words. Where the original program has a text, the English one is that text, and the Russian one too where it
//! is known from recorded runs.

use super::limits;
use lang_text::near::did_you_mean;
use lang_text::problem::Words;

/// The beginning of a word that may be very long.
pub(super) fn shortened(text: &str) -> Box<str> {
    text[..text.floor_char_boundary(limits::ORDER_WORD_BYTES_MAX)].into()
}

pub(super) fn too_many_links() -> Words {
    Words::new("Too many outgoing links", "Слишком много исходящих связей")
}

pub(super) fn no_links() -> Words {
    Words::new(
        "No outgoing links, please connect this block to something or use Final Node to end program",
        "Нет исходящих связей. Пожалуйста, подключите этот блок к чему-нибудь или используйте блок \"Конец\", чтобы завершить выполнение программы",
    )
}

pub(super) fn loose_link() -> Words {
    Words::new(
        "Outgoing link is not connected",
        "Исходящая связь ни с чем не соединена",
    )
}

pub(super) fn two_links() -> Words {
    Words::new(
        "There must be exactly TWO links outgoing from if block",
        "От условного блока должно отходить ровно ДВЕ связи",
    )
}

pub(super) fn guard_twice(guard: &str) -> Words {
    Words::new(
        format!("Two links marked with '{guard}' found"),
        format!("Две связи помечены '{guard}'"),
    )
}

pub(super) fn no_true_or_false() -> Words {
    Words::new(
        "There must be at least one link with \"true\" or \"false\" marker on it",
        "Хотя бы одна связь должна быть помечена \"true\" или \"false\"",
    )
}

pub(super) fn two_bodies() -> Words {
    Words::new(
        "Two links marked as \"body\" found",
        "Две связи помечены как тело цикла (\"iteration\")",
    )
}

pub(super) fn no_body() -> Words {
    Words::new(
        "There must be a link with \"body\" marker on it",
        "Нужна связь, помеченная как тело цикла (\"iteration\")",
    )
}

pub(super) fn no_way_out() -> Words {
    Words::new(
        "There must be a non-marked outgoing link",
        "Нужна исходящая связь без пометки",
    )
}

pub(super) fn switch_needs_two() -> Words {
    Words::new(
        "There must be at list TWO links outgoing from switch block",
        "Из блока «Выбор» должны выходить хотя бы ДВЕ связи",
    )
}

pub(super) fn two_defaults() -> Words {
    Words::new(
        "There must be exactly one link without marker on it (default branch)",
        "Должна быть ровно одна связь без пометки (ветка по умолчанию)",
    )
}

pub(super) fn no_default() -> Words {
    Words::new(
        "There must be a link without marker on it (default branch)",
        "Нужна связь без пометки (ветка по умолчанию)",
    )
}

pub(super) fn branch_twice(guard: &str) -> Words {
    Words::new(
        format!("Duplicate case branch: '{guard}'"),
        format!("Ветка '{guard}' повторяется"),
    )
}

pub(super) fn fork_needs_two() -> Words {
    Words::new(
        "There must be at least two outgoing links",
        "Должно быть хотя бы две исходящие связи",
    )
}

pub(super) fn thread_twice(id: &str) -> Words {
    Words::new(
        format!("Cannot create two threads with the same id {id}"),
        format!("Невозможно создать две задачи с одинаковыми идентификаторами {id}"),
    )
}

pub(super) fn fork_without_me(id: &str) -> Words {
    Words::new(
        format!(
            "There must be a link that has its 'Guard' property set to the current thread id {id}"
        ),
        format!("Одна из связей должна быть помечена именем текущей задачи: {id}"),
    )
}

pub(super) fn join_needs_name() -> Words {
    Words::new(
        "Link outgoing from join block must have surviving thread id in its 'Guard' property",
        "Связь из блока «Слияние задач» должна быть помечена именем задачи, которая продолжится",
    )
}

pub(super) fn thread_is_there(id: &str) -> Words {
    Words::new(
        format!("Cannot create new thread with already occupied id {id}"),
        format!("Задача с именем {id} уже выполняется"),
    )
}

pub(super) fn too_many_threads(limit: usize) -> Words {
    Words::new(
        format!("Threads limit exceeded. Maximum threads count is {limit}"),
        format!("Слишком много задач: не больше {limit}"),
    )
}

pub(super) fn no_such_thread(id: &str) -> Words {
    Words::new(
        format!("Killing non-existent thread {id}"),
        format!("Попытка завершить несуществующий поток {id}"),
    )
}

pub(super) fn nobody_to_kill() -> Words {
    Words::new(
        "Need to specify a thread to be stopped",
        "Укажите, какую задачу завершить",
    )
}

pub(super) fn nobody_to_send_to() -> Words {
    Words::new(
        "Need to specify a receiving thread in 'Thread' property",
        "Укажите в свойстве «Задача», кому отправить сообщение",
    )
}

pub(super) fn nothing_to_receive_into() -> Words {
    Words::new(
        "Need to specify variable which will contain received message",
        "Укажите переменную для полученного сообщения",
    )
}

pub(super) fn mailbox_full(thread: &str, limit: usize) -> Words {
    Words::new(
        format!("Thread {thread} does not read its messages: {limit} are waiting"),
        format!("Задача {thread} не читает сообщения: их уже {limit}"),
    )
}

pub(super) fn no_entry() -> Words {
    Words::new(
        "No entry point found, please add Initial Node to a diagram",
        "Не найдено начало программы. Пожалуйста, добавьте блок \"Начало\"",
    )
}

pub(super) fn several_entries() -> Words {
    Words::new(
        "This diagram has several Initial Nodes; only the first one is used",
        "На этой диаграмме несколько блоков «Начало»; работает только первый",
    )
}

pub(super) fn no_main() -> Words {
    Words::new(
        "There is no diagram to run",
        "Нет диаграммы, которую можно выполнить",
    )
}

pub(super) fn stack_overflow() -> Words {
    Words::new(
        "Stack overflow",
        "Переполнение стека: подпрограммы вызывают друг друга слишком глубоко",
    )
}

pub(super) fn bad_name(name: &str) -> Words {
    Words::new(
        format!("Please enter valid c-style name for subprogram \"{name}\""),
        format!("Имя подпрограммы \"{name}\" не годится: нужны буквы, цифры и подчёркивания"),
    )
}

pub(super) fn no_such_subprogram() -> Words {
    Words::new(
        "The subprogram of this call is not in the project: the program will stay here for ever",
        "Подпрограммы этого вызова нет в проекте: программа останется здесь навсегда",
    )
}

pub(super) fn endless_call(name: &str) -> Words {
    Words::new(
        format!("Subprogram \"{name}\" calls itself at once and never comes back"),
        format!("Подпрограмма \"{name}\" сразу вызывает саму себя и никогда не вернётся"),
    )
}

pub(super) fn comment_in_flow() -> Words {
    Words::new(
        "A comment must have no incoming links",
        "В комментарий не должны входить связи",
    )
}

pub(super) fn too_many_input_links() -> Words {
    Words::new(
        "There should be a maximum of TWO links outgoing from input block",
        "Из блока «Ввод» могут выходить не больше ДВУХ связей",
    )
}

pub(super) fn cancel_twice() -> Words {
    Words::new(
        "Only one link with \"cancel\" is allowed",
        "Только одна связь может быть помечена \"cancel\"",
    )
}

pub(super) fn no_cancel() -> Words {
    Words::new(
        "One of the outgoing links must be marked with \"cancel\"",
        "Одна из исходящих связей должна быть помечена \"cancel\"",
    )
}

pub(super) fn no_next() -> Words {
    Words::new(
        "Link to the next statement is missing",
        "Нет связи со следующим блоком",
    )
}

pub(super) fn must_answer() -> Words {
    Words::new("You must input some value!", "Нужно ввести значение!")
}

pub(super) fn answer_does_not_fit(variable: &str) -> Words {
    Words::new(
        format!(
            "The program cannot do with this what it does with '{variable}': a number is written as 5, a text as 'five'."
        ),
        format!(
            "С таким ответом программа не сможет сделать того, что делает с '{variable}': число пишут как 5, текст как \
             'пять'."
        ),
    )
}

pub(super) fn not_configured(device: &str, port: &str) -> Words {
    Words::new(
        format!("{device} is not configured on port {port}"),
        format!("{device}: на порту {port} ничего не подключено"),
    )
}

pub(super) fn other_sensor(port: &str) -> Words {
    Words::new(
        format!("Sensor on port {port} does not correspond to blocks on the diagram."),
        format!("Датчик на порту {port} не подходит к блокам на диаграмме."),
    )
}

pub(super) fn no_lidar() -> Words {
    Words::new("Lidar is not configured.", "Лидар не подключён.")
}

pub(super) fn no_button(name: &str) -> Words {
    Words::new(
        format!("Incorrect button port {name}"),
        format!("Нет кнопки {name}"),
    )
}

pub(super) fn unknown_port(name: &str) -> Words {
    Words::new(
        format!("There is no port {name} on TRIK; it is left out"),
        format!("У ТРИК нет порта {name}; он пропускается"),
    )
}

pub(super) fn unknown_block(kind: &str) -> Words {
    Words::new(
        format!("Block {kind} is not known; it is passed through"),
        format!("Блок {kind} неизвестен; он ничего не делает"),
    )
}

pub(super) fn foreign_block(name: &str, kit: &str) -> Words {
    Words::new(
        format!(
            "Block {name} of {kit} is not for TRIK; it is passed through. Use the block of TRIK in its place"
        ),
        format!(
            "Блок {name} набора {kit} не для ТРИК; он ничего не делает. Замените его блоком ТРИК"
        ),
    )
}

pub(super) fn other_kit(kind: &str) -> Words {
    Words::new(
        format!("Block {kind} is for another kit of TRIK; it is passed through"),
        format!("Блок {kind} для другого набора ТРИК; он ничего не делает"),
    )
}

pub(super) fn never_matches(guard: &str) -> Words {
    Words::new(
        format!(
            "The guard '{guard}' is compared in lower case, so a text with capitals never meets it"
        ),
        format!(
            "Пометка '{guard}' сравнивается строчными буквами: текст с заглавными с ней не совпадёт"
        ),
    )
}

pub(super) fn ignored_link(guard: &str) -> Words {
    Words::new(
        format!("The link marked with '{guard}' is ignored"),
        format!("Связь с пометкой '{guard}' не учитывается"),
    )
}

pub(super) fn unreachable() -> Words {
    Words::new(
        "No way leads to this block",
        "К этому блоку не ведёт ни один путь",
    )
}

pub(super) fn never_called(name: &str) -> Words {
    Words::new(
        format!("Diagram \"{name}\" is never run"),
        format!("Диаграмма \"{name}\" никогда не выполняется"),
    )
}

pub(super) fn unknown_choice(value: &str) -> Words {
    Words::new(
        format!("'{value}' is none of the words that this property may have"),
        format!("У этого свойства не может быть значения '{value}'"),
    )
}

pub(super) fn too_large(nodes: usize, limit: usize) -> Words {
    Words::new(
        format!("The project has {nodes} blocks; at most {limit} can be run"),
        format!("В проекте {nodes} блоков; выполнить можно не больше {limit}"),
    )
}

/// Whether a guard is the one for a question without an answer, in either language.
pub(super) fn is_cancel(guard: &str) -> bool {
    let guard = guard.to_lowercase();
    guard == "cancel" || guard == "отмена"
}

pub(super) fn not_read(sensor: &str) -> Words {
    Words::new(
        format!("The program does not read {sensor}, so its value is not known here"),
        format!("Программа не читает {sensor}, поэтому его значение здесь неизвестно"),
    )
}

pub(super) fn only_looked(function: &str) -> Words {
    Words::new(
        format!(
            "{function} would change the run; an expression that is only looked at cannot have it"
        ),
        format!(
            "{function} изменила бы ход программы; в просматриваемом выражении её быть не может"
        ),
    )
}

pub(super) fn open_brace() -> Words {
    Words::new(
        "This brace is not closed: write } behind the expression, as in {n}",
        "Эта скобка не закрыта: после выражения нужна }, например {n}",
    )
}

pub(super) fn empty_braces() -> Words {
    Words::new(
        "There is nothing between these braces: write an expression, as in {n}",
        "Между этими скобками пусто: напишите выражение, например {n}",
    )
}

/// What a person assigns is no number that a program can compute with.
pub(super) fn not_finite(variable: &str) -> Words {
    Words::new(
        format!("{variable} would be infinite or no number, and motors and waits need one"),
        format!("{variable} станет бесконечностью или не числом, а моторам и таймерам нужно число"),
    )
}

/// What a person assigns is nothing, or more than one value.
pub(super) fn one_expression(variable: &str) -> Words {
    Words::new(
        format!("one expression is wanted after {variable}=, as in {variable}=2 + 3"),
        format!("после {variable}= нужно одно выражение, например {variable}=2 + 3"),
    )
}

pub(super) fn assigns() -> Words {
    Words::new(
        "An expression that is only looked at cannot assign; == compares",
        "В просматриваемом выражении не может быть присваивания; сравнивает ==",
    )
}

pub(super) fn never_changes(name: &str) -> Words {
    Words::new(
        format!("{name} is no variable and never changes"),
        format!("{name} - не переменная и никогда не меняется"),
    )
}

pub(super) fn no_variable(name: &str, known: &[&str]) -> Words {
    let (name, near) = (shortened(name), did_you_mean(name, known.iter().copied()));
    let mut list = known[..known.len().min(limits::NAMES_LISTED_MAX)].join(", ");
    if known.len() > limits::NAMES_LISTED_MAX {
        list.push_str(", ...");
    }
    let (english, russian) = match known {
        [] => (String::new(), String::new()),
        [..] => (format!("; it has: {list}"), format!("; есть: {list}")),
    };
    Words::new(
        format!(
            "the program has no variable '{name}'{english}{}",
            near.english
        ),
        format!(
            "в программе нет переменной '{name}'{russian}{}",
            near.russian
        ),
    )
}

pub(super) fn no_name(text: &str) -> Words {
    Words::new(
        format!("{text:?} is no name of a variable"),
        format!("{text:?} - не имя переменной"),
    )
}

pub(super) fn kit_of_patch() -> Words {
    Words::new(
        "The new version is for another kit than the program that runs; stop it and start the new one",
        "Новая версия - для другого конструктора; остановите программу и запустите новую",
    )
}

pub(super) fn block_gone(thread: &str) -> Words {
    Words::new(
        format!("The new version does not have this block, at which thread {thread} is"),
        format!("В новой версии нет этого блока, а поток {thread} находится в нём"),
    )
}
