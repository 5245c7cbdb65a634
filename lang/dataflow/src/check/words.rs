//! What several blocks together show before anything runs, in words.
//!
//! Owns the texts in both languages. Where something is wrong is known to who finds it.

pub(crate) use crate::words::busy_instant;
use crate::words::{list, short};
use lang_expr::reserved::FUNCTIONS;
use lang_text::near;
use lang_text::problem::Words;

pub(crate) const A_VALUE: [&str; 2] = ["a value", "значение"];
pub(crate) const A_UNIT: [&str; 2] = ["a control token", "управляющий сигнал"];
pub(crate) const A_TRUTH: [&str; 2] = ["a truth", "логическое значение"];
pub(crate) const A_WHOLE: [&str; 2] = ["a whole number", "целое число"];
pub(crate) const A_NUMBER: [&str; 2] = ["a number", "число"];
pub(crate) const A_TEXT: [&str; 2] = ["a text", "текст"];
pub(crate) const A_WORD: [&str; 2] = ["a text that is no number", "текст, который не число"];
pub(crate) const A_LIST: [&str; 2] = ["a list", "список"];

pub(crate) fn does_not_fit(comes: [&str; 2], wanted: [&str; 2], count: Option<u8>) -> Words {
    let (english, russian) = match count {
        Some(count) => (format!(" of {count}"), format!(" из {count}")),
        None => (String::new(), String::new()),
    };
    Words::new(
        format!(
            "{} comes here, but {}{english} is needed",
            comes[0], wanted[0]
        ),
        format!(
            "сюда приходит {}, а нужно: {}{russian}",
            comes[1], wanted[1]
        ),
    )
}

pub(crate) fn number_as_text() -> Words {
    Words::new(
        "a text comes here that is a number, and counts as that: write the number without quotes",
        "сюда приходит текст, который читается как число: напишите число без кавычек",
    )
}

pub(crate) fn no_list_for(comes: [&str; 2], count: usize) -> Words {
    Words::new(
        format!(
            "{} comes here, but its {count} variables take the items of a list: connect one, or name one variable",
            comes[0]
        ),
        format!(
            "сюда приходит {}, а переменных {count}, и они берут элементы списка: присоедините список или назовите одну переменную",
            comes[1]
        ),
    )
}

pub(crate) fn short_list(has: u16, count: usize) -> Words {
    Words::new(
        format!("a list of {has} comes here, but it has {count} variables: each takes an item"),
        format!("сюда приходит список из {has}, а переменных {count}: каждая берёт по элементу"),
    )
}

pub(crate) fn other_kind(name: &str, comes: [&str; 2], is: [&str; 2]) -> Words {
    let name = short(name);
    Words::new(
        format!(
            "{} comes here, but `{name}` gets {} elsewhere, and a variable keeps its kind: take another variable",
            comes[0], is[0]
        ),
        format!(
            "сюда приходит {}, а в другом месте `{name}` получает {}, и вид переменной не меняется: возьмите другую",
            comes[1], is[1]
        ),
    )
}

pub(crate) fn unit_here(port: &str) -> Words {
    Words::new(
        format!("a control token comes to {port}, which has no value: connect a data output"),
        format!("в {port} приходит управляющий сигнал без значения: присоедините выход с данными"),
    )
}

/// `property`: a text like IO0; `name`: what it assigns to, if that is a name.
pub(crate) fn assigns_last(property: &str, port: &str, name: Option<&str>) -> Words {
    let output = property.trim_start_matches('I');
    let value = name.map_or_else(|| "...".to_owned(), short);
    Words::new(
        format!(
            "the last statement of {property} assigns, so {output} gives a control token, which has no value for {port}: write `; {value}` after it"
        ),
        format!(
            "последнее выражение в {property} - присваивание, поэтому {output} даёт управляющий сигнал без значения для {port}: допишите после него `; {value}`"
        ),
    )
}

pub(crate) fn no_word(comes: [&str; 2], choices: &[&str]) -> Words {
    let all = list(choices.iter().copied());
    Words::new(
        format!(
            "{} comes here, but one of these words is needed: {all}",
            comes[0]
        ),
        format!("сюда приходит {}, а нужно одно из слов: {all}", comes[1]),
    )
}

pub(crate) fn unlinked() -> Words {
    Words::new(
        "this input has no edge, so the block never fires: connect it",
        "к этому входу ничего не присоединено, поэтому блок никогда не сработает: присоедините",
    )
}

pub(crate) fn unlinked_name(name: &str, flag: &str) -> Words {
    Words::new(
        format!("it reads {name}, which has no edge: connect it, or switch '{flag}' off"),
        format!(
            "он читает {name}, а к этому входу ничего не присоединено: присоедините или выключите '{flag}'"
        ),
    )
}

/// `meant`: the name that is like it.
pub(crate) fn never_assigned(name: &str, meant: Option<&str>) -> Words {
    let name = short(name);
    match meant {
        Some(meant) => Words::new(
            format!(
                "{name} is never given a value; did you mean '{}'?",
                short(meant)
            ),
            format!(
                "{name} нигде не получает значения; может быть, '{}'?",
                short(meant)
            ),
        ),
        None => Words::new(
            format!(
                "{name} is never given a value: write `{name} = ...` in a Variable that is started first"
            ),
            format!(
                "{name} нигде не получает значения: напишите `{name} = ...` в переменной, которая запускается первой"
            ),
        ),
    }
}

pub(crate) fn no_function(name: &str) -> Words {
    let known = || FUNCTIONS.iter().map(|(name, ..)| *name);
    let near = near::did_you_mean(name, known());
    let (name, all) = (short(name), list(known()));
    Words::new(
        format!(
            "there is no function {name}{}; there are: {all}",
            near.english
        ),
        format!("функции {name} нет{}; есть: {all}", near.russian),
    )
}

pub(crate) fn read_first(name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!(
            "{name} is read before it has a value, because nothing else gives it one: write `{name} = 0`, or what it has to be first, in a Variable that is started first"
        ),
        format!(
            "{name} читается раньше, чем получает значение, потому что больше его ничто не задаёт: напишите `{name} = 0` или другое начальное значение в переменной, которая запускается первой"
        ),
    )
}

pub(crate) fn idle_statement() -> Words {
    Words::new(
        "nobody takes this value, because another statement follows: is an operator missing between them?",
        "это значение никто не берёт, потому что дальше следует ещё одно выражение: не пропущен ли между ними знак операции?",
    )
}

pub(crate) fn empty_condition() -> Words {
    Words::new(
        "the condition is empty: write one, such as `data > 0`",
        "условие пустое: напишите его, например `data > 0`",
    )
}

pub(crate) fn no_order(sign: &str) -> Words {
    Words::new(
        format!(
            "`{sign}` compares a number with a text, and neither is smaller: write a number without quotes"
        ),
        format!(
            "`{sign}` сравнивает число с текстом, и ни одно из них не меньше: напишите число без кавычек"
        ),
    )
}

pub(crate) fn assigning_condition() -> Words {
    Words::new(
        "the condition assigns a value and compares nothing: write `==` to compare",
        "условие присваивает значение и ничего не сравнивает: для сравнения напишите `==`",
    )
}

pub(crate) fn constant_condition() -> Words {
    Words::new(
        "the condition is the same for every token, because it reads nothing: compare `data` with something, or leave the block out",
        "условие одинаково для всех значений, потому что ничего не читает: сравните с чем-нибудь `data` или уберите блок",
    )
}

pub(crate) fn kinds_differ(one: [&str; 2], other: [&str; 2]) -> Words {
    Words::new(
        format!(
            "the condition compares {} with {}: compare values of one kind",
            one[0], other[0]
        ),
        format!(
            "в условии сравниваются {} и {}: сравнивайте значения одного вида",
            one[1], other[1]
        ),
    )
}

pub(crate) fn cycle(blocks: &[String], count: usize) -> Words {
    let more = if count > blocks.len() { ", ..." } else { "" };
    let names = blocks.join(", ");
    Words::new(
        format!(
            "tokens can run around within one instant ({names}{more}): put a 'Wait and send' into the cycle, unless a condition ends it"
        ),
        format!(
            "значения могут бежать по кругу в одно мгновение ({names}{more}): поставьте в цикл ожидание, если его не кончает условие"
        ),
    )
}

fn ring(blocks: &[String], count: usize) -> String {
    let more = if count > blocks.len() { ", ..." } else { "" };
    format!("{}{more}", blocks.join(", "))
}

pub(crate) fn dead_ring(blocks: &[String], count: usize) -> Words {
    let names = ring(blocks, count);
    Words::new(
        format!(
            "nothing starts it: these blocks only lead to each other ({names}), and a block into which an edge leads does not begin by itself; let a block without incoming edges, such as a Value generator, lead here as well"
        ),
        format!(
            "ничто его не запускает: эти блоки ведут только друг к другу ({names}), а блок, к которому ведёт линия, сам не начинает; проведите сюда ещё линию от блока без входящих линий, например от значения"
        ),
    )
}

pub(crate) fn waiting_ring(port: &str, blocks: &[String], count: usize) -> Words {
    let names = ring(blocks, count);
    Words::new(
        format!(
            "no token ever comes to {port}, because what leads here waits for it ({names}): let a block without incoming edges, such as a Value generator, give {port} its first token"
        ),
        format!(
            "в {port} никогда ничего не придёт, потому что то, что сюда ведёт, само этого ждёт ({names}): пусть первое значение в {port} даст блок без входящих линий, например значение"
        ),
    )
}

pub(crate) fn only_parameters(starts: &[&str]) -> Words {
    Words::new(
        format!(
            "nothing starts it, because only parameters of it are connected: lead an edge to {}",
            starts.join(" or ")
        ),
        format!(
            "ничто его не запускает, потому что присоединены только параметры: проведите линию к {}",
            starts.join(" или ")
        ),
    )
}

pub(crate) fn empty_text(port: &str, property: &str) -> Words {
    Words::new(
        format!(
            "nothing ever comes from {port}, because {property} is empty: write it, or draw the edge from another output"
        ),
        format!(
            "из {port} никогда ничего не выходит, потому что {property} пусто: заполните его или проведите линию от другого выхода"
        ),
    )
}

pub(crate) fn own_input(port: &str, input: &str) -> Words {
    Words::new(
        format!(
            "nothing ever comes from {port}, because it is computed when a token comes to {input}, to which no edge leads: connect {input}"
        ),
        format!(
            "из {port} никогда ничего не выходит, потому что он вычисляется, когда значение приходит в {input}, а туда ничего не ведёт: присоедините {input}"
        ),
    )
}

pub(crate) fn no_out_port(port: &str, name: &str) -> Words {
    let name = short(name);
    Words::new(
        format!(
            "nothing ever comes from {port}, because the subprogram '{name}' has no output port {port}: put one in, or draw the edge from another output"
        ),
        format!(
            "из {port} никогда ничего не выходит, потому что в подпрограмме '{name}' нет выхода {port}: поставьте его или проведите линию от другого выхода"
        ),
    )
}

pub(crate) fn nothing_held() -> Words {
    Words::new(
        "nothing ever comes from OUT, where only what came to DATA leaves: draw the edge from CF_OUT, or connect DATA",
        "из OUT никогда ничего не выходит, потому что оттуда уходит только пришедшее в DATA: проведите линию от CF_OUT или присоедините DATA",
    )
}

pub(crate) fn over_at_once() -> Words {
    Words::new(
        "the program ends in the instant in which it begins, because nothing in it waits, counts or reads a sensor, and then motors rest: let a 'Wait and send' follow",
        "программа кончается в то же мгновение, когда начинается, потому что в ней ничто не ждёт, не считает и не читает датчик, и моторы стоят: поставьте следом ожидание",
    )
}

pub(crate) fn too_much_power(power: i32, counts: i32) -> Words {
    Words::new(
        format!("a power of {power} counts as {counts}: write a number from -100 to 100"),
        format!("мощность {power} считается за {counts}: напишите число от -100 до 100"),
    )
}

pub(crate) fn borders_swapped(from: i32, to: i32) -> Words {
    Words::new(
        format!(
            "the upper border {to} is below the lower one {from}, so they count as {to} to {from}: swap them"
        ),
        format!(
            "верхняя граница {to} меньше нижней {from}, поэтому числа будут от {to} до {from}: поменяйте их местами"
        ),
    )
}

pub(crate) fn no_input() -> Words {
    Words::new(
        "no edge comes to it, and it cannot begin by itself: it does nothing",
        "к нему ничего не присоединено, а сам он начать не может: он ничего не делает",
    )
}

pub(crate) fn stop_unlinked() -> Words {
    Words::new(
        "no edge comes to it, so it ends nothing: connect what has to end the program",
        "к нему ничего не присоединено, и он ничего не кончает: присоедините то, что должно завершить программу",
    )
}

pub(crate) fn start_ignored() -> Words {
    Words::new(
        "a start means nothing to a function that has inputs: it fires when its tokens come",
        "для функции с входами сигнал запуска ничего не значит: она срабатывает, когда приходят значения",
    )
}

pub(crate) fn unused() -> Words {
    Words::new(
        "nobody takes what it gives: connect its output, or delete it",
        "его значения никто не берёт: присоедините выход или удалите блок",
    )
}

pub(crate) fn encoder_silent() -> Words {
    Words::new(
        "this encoder gives nothing until it is reset: set its flag, or connect its input",
        "этот энкодер молчит, пока его не обнулят: поставьте флажок или присоедините вход",
    )
}

pub(crate) fn empty_loop() -> Words {
    Words::new(
        "nothing happens at its numbers: connect OUT, or take a 'Wait and send' if it only has to wait",
        "при его числах ничего не происходит: присоедините OUT или возьмите ожидание, если нужно только ждать",
    )
}

pub(crate) fn no_numbers([first, last, step]: [i32; 3]) -> Words {
    Words::new(
        format!(
            "it counts from {first} to {last} by steps of {step}, so there is no number for OUT: change one of the three"
        ),
        format!(
            "он считает от {first} до {last} с шагом {step}, поэтому чисел для OUT нет: измените одно из трёх"
        ),
    )
}

pub(crate) fn no_wait(ms: i32, least: u32) -> Words {
    Words::new(
        format!(
            "{ms} ms: it waits {least} ms, the shortest time there is; write how long it has to wait"
        ),
        format!("{ms} мс: он ждёт {least} мс, меньше не бывает; напишите, сколько ждать"),
    )
}

pub(crate) fn wait_falls_behind(period: u32, takes: u32) -> Words {
    Words::new(
        format!(
            "a token comes every {period} ms and each is held for {takes} ms, so they queue up and grow old: make the time shorter, or switch 'keep' off"
        ),
        format!(
            "значение приходит каждые {period} мс, а ждёт каждое {takes} мс, поэтому они копятся и устаревают: уменьшите время или выключите 'keep'"
        ),
    )
}

pub(crate) fn no_window(ms: i32) -> Words {
    Words::new(
        format!(
            "{ms} ms: its window is over at once, so the other stream always comes through; write a time longer than that between the tokens that open it"
        ),
        format!(
            "{ms} мс: окно кончается сразу, поэтому другой поток проходит всегда; напишите время больше промежутка между открывающими значениями"
        ),
    )
}

pub(crate) fn two_writers(ports: &str, names: &[String; 2]) -> Words {
    let [one, other] = names;
    Words::new(
        format!(
            "{one} and {other} both drive {ports} and nothing decides between them, so the last one to speak counts: put a Flow replacer or a Flow delay before one of them, or one If or Switch before both"
        ),
        format!(
            "{one} и {other} управляют {ports}, и ничто не выбирает между ними, поэтому действует сказанное последним: поставьте подавление или торможение перед одним из них либо общее условие или выбор перед обоими"
        ),
    )
}

pub(crate) fn short_window(ms: i32, period: u32) -> Words {
    Words::new(
        format!(
            "its time of {ms} ms is shorter than the {period} ms between the tokens that open it, so the other stream comes through in between"
        ),
        format!(
            "его время {ms} мс меньше {period} мс между открывающими значениями, поэтому в промежутке проходит другой поток"
        ),
    )
}

pub(crate) fn rates_differ(ports: [&str; 2]) -> Words {
    let [fast, slow] = ports;
    Words::new(
        format!(
            "tokens come to {fast} more often than to {slow}, so they queue up and grow old: give the edge to {fast} the policy latest"
        ),
        format!(
            "в {fast} значения приходят чаще, чем в {slow}, поэтому они копятся и устаревают: задайте линии к {fast} правило latest"
        ),
    )
}
