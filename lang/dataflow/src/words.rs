//! What can be wrong with a data-flow program, in words.
//!
//! Owns the texts in both languages. Where something is wrong is known to who finds it.

use crate::blocks::{Direction, Row};
use crate::limits::{self, LISTED_MAX, QUEUE_MAX, REPEATED_MAX};
use lang_expr::Value;
use lang_text::near;
use lang_text::problem::{Locale, Words};

/// Names as a list, which is cut.
pub(crate) fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.into_iter().collect();
    let more = if names.len() > LISTED_MAX {
        ", ..."
    } else {
        ""
    };
    let shown = &names[..names.len().min(LISTED_MAX)];
    format!("{}{more}", shown.join(", "))
}

/// The beginning of a text that may be very long.
pub(crate) fn short(text: &str) -> String {
    let mut shown: String = text.chars().take(REPEATED_MAX).collect();
    if shown.len() < text.len() {
        shown.push_str("...");
    }
    shown
}

// Choosing.

pub(crate) fn runs_where_called(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!("diagram '{name}' is a subprogram, which runs only where a block calls it"),
        format!(
            "диаграмма '{name}' — подпрограмма: она выполняется только там, где её вызывает блок"
        ),
    )
}

pub(crate) fn several_named(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!(
            "several diagrams here have the name '{name}', so it does not say which one is meant: give them names of their own"
        ),
        format!(
            "здесь несколько диаграмм с именем '{name}', поэтому неясно, какая нужна: дайте им разные имена"
        ),
    )
}

pub(crate) fn no_main_named<'a>(name: &str, mains: impl Iterator<Item = &'a str> + Clone) -> Words {
    let meant = near::did_you_mean(name, mains.clone());
    let (name, mains) = (short(name), list(mains));
    if mains.is_empty() {
        return Words::new(
            format!("there is no diagram '{name}' here: the project has none that can be run"),
            format!(
                "диаграммы '{name}' здесь нет: в проекте нет ни одной, которую можно запустить"
            ),
        );
    }
    Words::new(
        format!(
            "there is no diagram '{name}' that can be run here; there are: {mains}{}",
            meant.in_locale(Locale::English)
        ),
        format!(
            "диаграммы '{name}', которую можно запустить, здесь нет; есть: {mains}{}",
            meant.in_locale(Locale::Russian)
        ),
    )
}

// Reading.

pub(crate) fn lost_child(element: &str) -> Words {
    Words::new(
        format!(
            "the diagram lists this {}, but its file is not in the save",
            short(element)
        ),
        format!(
            "диаграмма называет этот {}, но файла нет в сохранении",
            short(element)
        ),
    )
}

pub(crate) fn not_graphical() -> Words {
    Words::new(
        "the diagram lists a logical object instead of a graphical one; it is left out",
        "в диаграмме на месте графического объекта логический; он пропущен",
    )
}

pub(crate) fn listed_twice() -> Words {
    Words::new(
        "it is listed twice; the first place counts",
        "он указан дважды; считается первое место",
    )
}

pub(crate) fn no_logical() -> Words {
    Words::new(
        "its logical object is missing, so its properties are not known: delete the block and draw it again",
        "её логического объекта нет, поэтому свойства неизвестны: удалите блок и поставьте заново",
    )
}

pub(crate) fn former_name(element: &str, now: &str) -> Words {
    Words::new(
        format!("'{element}' is the name that '{now}' had before 2016-07-12; it is read as that"),
        format!("'{element}' - имя, которое '{now}' носил до 12.07.2016; читается как он"),
    )
}

/// A former block that drew any shape, and cannot be read as one that draws this one.
pub(crate) fn no_painter(element: &str, shape: Option<&str>) -> Words {
    let list = |locale| {
        let all = crate::blocks::painted();
        let all = all.map(|(shape, row)| format!("{shape} - '{}'", row.shown_in(locale)));
        all.collect::<Vec<_>>().join(", ")
    };
    let (english, russian) = (list(Locale::English), list(Locale::Russian));
    let shape = short(shape.unwrap_or_default());
    Words::new(
        format!(
            "'{element}' is a block of an old version, and what it draws is not known from its shape '{shape}': draw one of these instead: {english}"
        ),
        format!(
            "'{element}' - блок старой версии, и по его фигуре '{shape}' не понять, что он рисует: поставьте вместо него один из этих: {russian}"
        ),
    )
}

/// A port that only a former block had.
pub(crate) fn gone_port(name: &str, row: &Row) -> Words {
    Words::new(
        format!(
            "the port {name} is of an old version, and '{}' has none: delete this edge, and set colours by a block 'Paint settings'",
            row.shown
        ),
        format!(
            "порт {name} был у старой версии, у '{}' его нет: удалите эту линию и задавайте цвета блоком 'Кисть и фон'",
            row.russian
        ),
    )
}

pub(crate) fn unknown_policy(word: &str) -> Words {
    Words::new(
        format!(
            "a queue has no policy '{}': it is fifo, latest or error; fifo counts",
            short(word)
        ),
        format!(
            "у очереди нет правила '{}': оно fifo, latest или error; считается fifo",
            short(word)
        ),
    )
}

pub(crate) fn unknown_capacity(word: &str) -> Words {
    Words::new(
        format!(
            "'{}' is not a number of places from 1 to 1024; 1024 counts",
            short(word)
        ),
        format!(
            "'{}' не число мест от 1 до 1024; считается 1024",
            short(word)
        ),
    )
}

// Blocks, ports, properties.

pub(crate) fn no_main() -> Words {
    Words::new(
        "the project has no data-flow diagram that is run: a program as text begins with `diagram \"NAME\"`, subprograms run only where blocks call them, and `run nothing` says that no diagram is run",
        "в проекте нет потоковой диаграммы, которая выполняется: программа в виде текста начинается с `diagram \"ИМЯ\"`, подпрограммы выполняются только там, где их вызывают блоки, а `run nothing` значит, что не выполняется ничего",
    )
}

pub(crate) fn unknown_element(element: &str) -> Words {
    let known = crate::blocks::table().map(|row| row.element);
    let near = near::did_you_mean(element, known);
    Words::new(
        format!(
            "the data-flow language has no block '{}'{}",
            short(element),
            near.english
        ),
        format!(
            "в потоковом языке нет блока '{}'{}",
            short(element),
            near.russian
        ),
    )
}

pub(crate) fn port_in_main() -> Words {
    Words::new(
        "input and output ports belong in subprograms: in a main diagram there is no call that they could belong to",
        "входы и выходы бывают только в подпрограммах: у главной диаграммы нет вызова, к которому они относились бы",
    )
}

pub(crate) fn never_called() -> Words {
    Words::new(
        "nothing that runs calls it, so nothing of it happens: put a 'User block' where it is needed, or delete it",
        "ничто из того, что выполняется, её не вызывает: поставьте вызов там, где она нужна, или удалите её",
    )
}

pub(crate) fn calls_main() -> Words {
    Words::new(
        "it calls a main diagram; only subprograms can be called",
        "он вызывает главную диаграмму; вызвать можно только подпрограмму",
    )
}

pub(crate) fn calls_nothing() -> Words {
    Words::new(
        "the subprogram that it calls is not in the project, or is of the other language",
        "подпрограммы, которую он вызывает, нет в проекте, или она на другом языке",
    )
}

pub(crate) fn dangling() -> Words {
    Words::new(
        "this edge is not attached at both ends: attach it or delete it",
        "эта линия присоединена не обоими концами: присоедините её или удалите",
    )
}

pub(crate) fn twin_edge() -> Words {
    Words::new(
        "another edge connects the same two ports, so each token comes twice: delete one of them",
        "те же два порта соединяет ещё одна линия, поэтому каждое значение приходит дважды: удалите одну из них",
    )
}

pub(crate) fn no_port(number: i32, count: usize) -> Words {
    let last = count.saturating_sub(1);
    // What is beyond all was not that number in the save.
    if number == i32::MAX || number == i32::MIN {
        return Words::new(
            format!("it has no port of the number that the edge says: its ports are 0 to {last}"),
            format!("у него нет порта с номером, который назван в линии: порты от 0 до {last}"),
        );
    }
    Words::new(
        format!("it has no port {number}: its ports are 0 to {last}"),
        format!("у него нет порта {number}: порты от 0 до {last}"),
    )
}

pub(crate) fn wrong_way(port: &str, wanted: Direction) -> Words {
    match wanted {
        Direction::Out => Words::new(
            format!(
                "an edge begins at {port}, which is an input: draw it from an output to an input"
            ),
            format!("линия начинается у {port}, а это вход: проведите её от выхода ко входу"),
        ),
        Direction::In => Words::new(
            format!(
                "an edge ends at {port}, which is an output: draw it from an output to an input"
            ),
            format!("линия кончается у {port}, а это выход: проведите её от выхода ко входу"),
        ),
    }
}

pub(crate) fn recursion(name: &str) -> Words {
    Words::new(
        format!(
            "the subprogram '{}' calls itself by this call, so it would never end",
            short(name)
        ),
        format!(
            "подпрограмма '{}' через этот вызов вызывает сама себя и никогда не кончилась бы",
            short(name)
        ),
    )
}

pub(crate) fn too_deep(most: usize) -> Words {
    Words::new(
        format!("calls nest deeper than {most}"),
        format!("вызовы вложены глубже, чем {most}"),
    )
}

pub(crate) fn too_many_instances(most: usize) -> Words {
    Words::new(
        format!(
            "the program has more than {most} diagrams at work: each call of a subprogram is one"
        ),
        format!("в программе больше {most} работающих диаграмм: каждый вызов подпрограммы - одна"),
    )
}

pub(crate) fn too_large(nodes: usize, edges: usize) -> Words {
    Words::new(
        format!(
            "the program has more than {nodes} blocks or {edges} edges, those of called subprograms counted for each call"
        ),
        format!(
            "в программе больше {nodes} блоков или {edges} линий, считая подпрограммы при каждом вызове"
        ),
    )
}

pub(crate) fn too_much_text(most: usize) -> Words {
    let most = most >> 20;
    Words::new(
        format!(
            "the program has more than {most} MiB of text in names and properties; each call of a subprogram has a copy of its own, so make its texts shorter or the calls fewer"
        ),
        format!(
            "в именах и свойствах программы больше {most} МиБ текста; у каждого вызова подпрограммы своя копия, поэтому сократите её тексты или число вызовов"
        ),
    )
}

pub(crate) fn too_large_token() -> Words {
    Words::new(
        format!(
            "this value is too large for a token: a list has at most {} items, a text at most {} bytes",
            limits::ITEMS_MAX,
            limits::TEXT_BYTES_MAX
        ),
        format!(
            "это значение слишком велико: в списке не больше {} элементов, в тексте не больше {} байт",
            limits::ITEMS_MAX,
            limits::TEXT_BYTES_MAX
        ),
    )
}

pub(crate) fn busy_instant(most: u32) -> Words {
    Words::new(
        format!(
            "more than {most} reactions of blocks come in one instant, which is all that there is room for: let some of them wait"
        ),
        format!(
            "в одно мгновение блоки срабатывают больше {most} раз, а больше нельзя: пусть часть из них подождёт"
        ),
    )
}

pub(crate) fn too_many_names(most: usize) -> Words {
    Words::new(
        format!(
            "the program has more than {most} names: its variables, sensors and functions, and for each block, in each call, the inputs that its expressions read (`data`, `I0`); join blocks, or read less in them"
        ),
        format!(
            "в программе больше {most} имён: это переменные, датчики, функции и для каждого блока при каждом вызове входы, которые читают его выражения (`data`, `I0`); объедините блоки или читайте в них меньше"
        ),
    )
}

pub(crate) fn queues_differ() -> Words {
    Words::new(
        "edges that end at one port must agree on its queue: give them the same Policy and Capacity, in a text the same `latest`, `fifo N` or `error N`",
        "линии к одному порту должны одинаково описывать его очередь: задайте им одни и те же Policy и Capacity, в тексте одно и то же `latest`, `fifo N` или `error N`",
    )
}

pub(crate) fn no_queue(port: &str) -> Words {
    Words::new(
        format!(
            "what this edge says of a queue has no effect, because {port} waits for no other input: leave it out"
        ),
        format!(
            "сказанное этой линией об очереди не действует, потому что {port} не ждёт других входов: уберите это"
        ),
    )
}

pub(crate) fn other_capacity(places: usize, counts: usize) -> Words {
    Words::new(
        format!(
            "a queue of {places} places counts as {counts}: write a number from 1 to {QUEUE_MAX}"
        ),
        format!(
            "очередь из {places} мест считается за {counts}: напишите число от 1 до {QUEUE_MAX}"
        ),
    )
}

pub(crate) fn not_chosen(runs: &str) -> Words {
    let runs = short(runs);
    Words::new(
        format!(
            "it is not run, because '{runs}' is: in a program as text, write `run` after the name of the one that has to run; in a save the first one counts"
        ),
        format!(
            "она не запускается, потому что запускается '{runs}': в программе-тексте напишите `run` после имени той, что нужна; в сохранении считается первая"
        ),
    )
}

pub(crate) fn no_such_input(port: &str, name: &str) -> Words {
    Words::new(
        format!(
            "tokens that come to {port} are lost: the subprogram '{}' has no input port {port}",
            short(name)
        ),
        format!(
            "значения на входе {port} пропадают: в подпрограмме '{}' нет входа {port}",
            short(name)
        ),
    )
}

pub(crate) fn no_variable(text: &str) -> Words {
    Words::new(
        format!(
            "'{}' is not a name of a variable: write `name`, `name = value`, or several divided by `;`",
            short(text)
        ),
        format!(
            "'{}' не имя переменной: напишите `имя`, `имя = значение` или несколько через `;`",
            short(text)
        ),
    )
}

pub(crate) fn no_number(text: &str) -> Words {
    Words::new(
        format!(
            "'{}' is not a number, and this property is not computed",
            short(text)
        ),
        format!("'{}' не число, а это свойство не вычисляется", short(text)),
    )
}

/// What a value is, as a person reads it.
pub(crate) fn what(value: &Value) -> String {
    short(&value.brief())
}

pub(crate) fn too_large_number(value: &Value) -> Words {
    Words::new(
        format!(
            "{} is too large: whole numbers are from -{} to {}",
            what(value),
            i32::MAX,
            i32::MAX
        ),
        format!(
            "{} слишком велико: целые числа - от -{} до {}",
            what(value),
            i32::MAX,
            i32::MAX
        ),
    )
}

pub(crate) fn number_too_large(text: &str) -> Words {
    Words::new(
        format!(
            "{} is beyond the numbers that this property takes: -{} to {}",
            short(text),
            i32::MAX,
            i32::MAX
        ),
        format!(
            "{} вне чисел, которые берёт это свойство: от -{} до {}",
            short(text),
            i32::MAX,
            i32::MAX
        ),
    )
}

pub(crate) fn bad_period(time: i32) -> Words {
    Words::new(
        format!("{time} ms: the time must be above 0"),
        format!("{time} мс: время должно быть больше 0"),
    )
}

pub(crate) fn negative_time(time: i32) -> Words {
    Words::new(
        format!("{time} ms: a time below 0 counts as 0; write 0 or more"),
        format!("{time} мс: время меньше 0 считается нулём; напишите 0 или больше"),
    )
}

pub(crate) fn bad_width() -> Words {
    Words::new("the width must be above 0", "ширина должна быть больше 0")
}

pub(crate) fn no_choice(text: &str, choices: &[&str]) -> Words {
    let all = list(choices.iter().copied());
    Words::new(
        format!("'{}' is none of {all}", short(text)),
        format!("'{}' нет среди {all}", short(text)),
    )
}

pub(crate) fn no_sensor<'a>(name: &str, known: impl Iterator<Item = &'a str>) -> Words {
    let near = near::did_you_mean(name, known);
    Words::new(
        format!("there is no sensor '{}'{}", short(name), near.english),
        format!("датчика '{}' нет{}", short(name), near.russian),
    )
}

pub(crate) fn no_device_port(name: &str) -> Words {
    Words::new(
        format!("the controller has no port '{}'", short(name)),
        format!("у контроллера нет порта '{}'", short(name)),
    )
}

pub(crate) fn write_input(name: &str) -> Words {
    Words::new(
        format!(
            "'{}' only tells readings, so nothing can be written there",
            short(name)
        ),
        format!(
            "'{}' только сообщает показания, записать туда ничего нельзя",
            short(name)
        ),
    )
}

pub(crate) fn loop_step() -> Words {
    Words::new(
        "the step is 0, so the loop would never end",
        "шаг равен 0, поэтому цикл никогда не кончился бы",
    )
}
