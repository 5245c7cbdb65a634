//! Rows of the blocks that steer the flow: beginning and end, conditions, loops, threads, subprograms, variables.
//!
//! Owns rows: one for each thing that a block can do, but `Copy`, `Act` and `Wait`.

use super::Content::{Number, Raw};
use super::Type::{Statements, Text, Truth, Whole};
use super::act::Operand::{self, Written};
use super::act::{Act, script};
use super::example::{Stimulus, example, waits, within};
use super::parts::{ENVELOPE, block, expression, flag, property, variable};
use super::{Category, Does, Property, Row, Silent};
use crate::brick::Command;

const fn row(
    kind: &'static str,
    shown: [&'static str; 2],
    does: Does,
    properties: &'static [Property],
    text: [&'static str; 2],
) -> Row {
    block(Category::Algorithms, kind, shown, does, properties, text)
}

pub(super) const ROWS: &[Row] = &[
    Row {
        icon: "<path class=\"f\" d=\"M-8 -11L12 0L-8 11z\"/>",
        examples: &[within("* > print(1) > end", &[], &[], &["print \"1\""])],
        ..row(
            "InitialNode",
            ["Initial Node", "Начало"],
            Does::Start,
            &[],
            [
                "The program or the subprogram begins here. A diagram has one, with one link out of it.",
                "Здесь начинается программа или подпрограмма. В диаграмме одно такое начало, и из него выходит одна связь.",
            ],
        )
    },
    Row {
        icon: "<rect class=\"f\" x=\"-9\" y=\"-9\" width=\"18\" height=\"18\"/>",
        examples: &[within("start > print(1) > *", &[], &[], &["print \"1\""])],
        ..row(
            "FinalNode",
            ["Final Node", "Конец"],
            Does::End,
            &[],
            [
                "The diagram ends here: a subprogram returns, a thread ends. Other threads go on.",
                "Здесь диаграмма заканчивается: подпрограмма возвращается, задача завершается. Другие задачи продолжаются.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-11 -5h22M-11 5h22\"/>",
        examples: &[within(
            "start > * > print(x) > end",
            &[("value", "2 + 3")],
            &[],
            &["print \"5\""],
        )],
        ..row(
            "VariableInit",
            ["Variable Initialization", "Инициализация переменной"],
            Does::Assign,
            &[
                variable("variable", "x"),
                property("value", ["Value", "Значение"], Raw, "0"),
            ],
            [
                "Assigns a value to a variable. The text `variable = value` is run as a statement.",
                "Присваивает переменной значение. Текст `переменная = значение` выполняется как оператор.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M0 -15L15 0L0 15L-15 0z\"/>",
        examples: &[
            within(
                "start > x=1 > * =true> print(1) > end; * =false> print(2) > end",
                &[],
                &[],
                &["print \"1\""],
            ),
            within(
                "start > x=0 > * =true> print(1) > end; * =false> print(2) > end",
                &[],
                &[],
                &["print \"2\""],
            ),
        ],
        ..row(
            "IfBlock",
            ["Condition", "Условие"],
            Does::If,
            &[expression(
                "Condition",
                ["Condition", "Условие"],
                Truth,
                "x > 0",
            )],
            [
                "Takes one of two branches. Exactly two links go out; their guards are `true` and `false`, and one of them may be left blank.",
                "Выбирает одну из двух ветвей. Выходят ровно две связи с условиями `true` и `false`; одно из них можно не писать.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-12 -12L0 2M12 -12L0 2V14\"/>",
        examples: &[within(
            "start > IfBlock:Condition=true =true> * > print(2) > end; IfBlock:Condition=true =false> *",
            &[],
            &[],
            &["print \"2\""],
        )],
        ..row(
            "FiBlock",
            ["End if", "Конец условия"],
            Does::Merge,
            &[],
            [
                "Branches meet here. It does nothing.",
                "Здесь ветви сходятся. Блок ничего не делает.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M11 -7a13 13 0 1 0 2 11M13 -14v8h-8\"/>",
        examples: &[within(
            "start > x=0 > * =iteration> print(x) > x=x+1 > *; * > print(2) > end",
            &[("Condition", "x < 2")],
            &[],
            &["print \"0\"", "print \"1\"", "print \"2\""],
        )],
        ..row(
            "PreconditionalLoop",
            ["Pre-conditional Loop", "Цикл с предусловием"],
            Does::While,
            &[expression(
                "Condition",
                ["Condition", "Условие"],
                Truth,
                "x > 0",
            )],
            [
                "Runs its body as long as the condition holds. The link into the body has the guard `iteration`, the other one is blank.",
                "Выполняет тело, пока верно условие. У связи в тело условие `iteration`, у другой его нет.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M11 -7a13 13 0 1 0 2 11M13 -14v8h-8\"/>",
        examples: &[within(
            "start > * =iteration> print(1) > *; * > print(2) > end",
            &[("Iterations", "2")],
            &[],
            &["print \"1\"", "print \"1\"", "print \"2\""],
        )],
        ..row(
            "Loop",
            ["Loop", "Цикл"],
            Does::Loop,
            &[expression(
                "Iterations",
                ["Iterations", "Итерации"],
                Whole,
                "10",
            )],
            [
                "Runs its body a number of times. The link into the body has the guard `iteration`, the other one is blank. The counter belongs to the block, not to the thread: a thread that leaves the body by another link finds it part-way when it comes back.",
                "Выполняет тело заданное число раз. У связи в тело условие `iteration`, у другой его нет. Счётчик принадлежит блоку, а не задаче: если задача выйдет из тела по другой связи и вернётся, счёт продолжится.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M0 -14V-2M0 -2L-13 12M0 -2V12M0 -2L13 12\"/>",
        examples: &[
            within(
                "start > x='b' > * =a> print(1) > end; * =b> print(2) > end; * > print(3) > end",
                &[],
                &[],
                &["print \"2\""],
            ),
            within(
                "start > x='c' > * =a> print(1) > end; * =b> print(2) > end; * > print(3) > end",
                &[],
                &[],
                &["print \"3\""],
            ),
        ],
        ..row(
            "SwitchBlock",
            ["Switch", "Выбор"],
            Does::Switch,
            &[expression(
                "Expression",
                ["Expression", "Выражение"],
                Text,
                "x",
            )],
            [
                "Takes the link whose guard is the value of the expression, otherwise the blank one. Guards are converted to lower case and values are not, so a guard with capitals never matches a text.",
                "Идёт по связи, условие которой равно значению выражения, иначе по связи без условия. Условия переводятся в строчные буквы, а значения нет, поэтому условие с прописными буквами не совпадёт ни с каким текстом.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M8 -13q-8 -3 -8 6v14q0 8 -8 6M-8 0h16\"/>",
        examples: &[example(
            &[("Body", "x = 1; print(x + 1)")],
            &["print \"2\""],
        )],
        ..row(
            "Function",
            ["Function", "Выражение"],
            Does::Statements,
            &[expression(
                "Body",
                ["Expression", "Выражение"],
                Statements,
                "",
            )],
            [
                "Runs statements: assignments and calls, divided by `;` or lines.",
                "Выполняет операторы: присваивания и вызовы, разделённые `;` или строками.",
            ],
        )
    },
    Row {
        icon: "<rect class=\"i\" x=\"-14\" y=\"-10\" width=\"28\" height=\"20\"/><path class=\"i\" d=\"M-9 -10v20M9 -10v20\"/>",
        examples: &[within(
            "start > * > print(2) > end | start > print(1) > end",
            &[],
            &[],
            &["print \"1\"", "print \"2\""],
        )],
        ..row(
            "Subprogram",
            ["Subprogram", "Подпрограмма"],
            Does::Call,
            &[],
            [
                "Runs another diagram and then goes on. Arguments are assigned to variables with the names of the parameters; when the subprogram returns, these variables get their previous values back.",
                "Выполняет другую диаграмму и продолжает. Аргументы присваиваются переменным с именами параметров; когда подпрограмма возвращается, эти переменные получают прежние значения.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-14 -4h28M-9 -4v14M9 -4v14M0 -14v10\"/>",
        examples: &[within(
            "start > * =main> print(1) > end; * =b> print(2) > end",
            &[],
            &[],
            &["print \"2\"", "print \"1\""],
        )],
        ..row(
            "Fork",
            ["Fork", "Параллельные задачи"],
            Does::Fork,
            &[],
            [
                "Starts a thread for each link; the guard is the name of the thread. One link has the name of the present thread, or is blank, and continues it.",
                "Запускает задачу для каждой связи; условие связи - имя задачи. У одной связи имя нынешней задачи или никакого, она её продолжает.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-14 4h28M-9 4v-14M9 4v-14M0 4v10\"/>",
        examples: &[within(
            "start > Fork =main> * =main> print(1) > end; Fork =b> Timer:Delay=50 > print(2) > *",
            &[],
            &[],
            &["print \"2\"", "print \"1\""],
        )],
        ..row(
            "Join",
            ["Join", "Слияние задач"],
            Does::Join,
            &[],
            [
                "Threads meet here. The guard of the link out of it names the thread that goes on when all have come; the others end.",
                "Здесь задачи сходятся. Условие выходящей связи называет задачу, которая пойдёт дальше, когда придут все; остальные завершаются.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-10 -10L10 10M10 -10L-10 10\"/>",
        examples: &[within(
            "start > Fork =main> * > end; Fork =b> Timer:Delay=50 > print(1) > end",
            &[("Thread", "b")],
            &[],
            &[],
        )],
        ..row(
            "KillThread",
            ["Kill Thread", "Завершить задачу"],
            Does::Kill,
            &[property("Thread", ["Thread", "Задача"], Raw, "main")],
            [
                "Ends a thread by its name.",
                "Завершает задачу с этим именем.",
            ],
        )
    },
    Row {
        icon: "<rect class=\"i\" x=\"-12\" y=\"-12\" width=\"24\" height=\"24\" rx=\"4\"/><circle class=\"f\" cx=\"-5\" cy=\"-5\" r=\"2.5\"/><circle class=\"f\" cx=\"5\" cy=\"5\" r=\"2.5\"/><circle class=\"f\" r=\"2.5\"/>",
        examples: &[within(
            "start > * > print(x) > end",
            &[],
            &[(0, Stimulus::Random(7))],
            &["print \"7\""],
        )],
        ..row(
            "Randomizer",
            ["Random Initialization", "Случайное число"],
            Does::Random,
            &[
                variable("Variable", "x"),
                expression("LowerBound", ["From", "От"], Whole, "0"),
                expression("UpperBound", ["To", "До"], Whole, "10"),
            ],
            [
                "Assigns a random integer between two bounds, both included.",
                "Присваивает случайное целое число между двумя границами, включая их.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-7 -6a7 7 0 1 1 9 7q-2 1 -2 4M0 12v1\"/>",
        examples: &[within(
            "start > * > print(x) > end",
            &[],
            &[(50, Stimulus::Answer("2 + 3"))],
            &["print \"5\""],
        )],
        ..row(
            "Input",
            ["Input", "Ввод"],
            Does::Ask,
            &[
                variable("variable", "x"),
                property(
                    "default",
                    ["Default value", "Значение по умолчанию"],
                    Raw,
                    "",
                ),
                property("prompt", ["Prompt", "Приглашение"], Raw, ""),
            ],
            [
                "Asks the user for a value; the answer is an expression. A link with the guard `cancel` is taken if there is no answer.",
                "Спрашивает значение у человека; ответ - выражение. Если ответа нет, программа идёт по связи с условием `cancel`.",
            ],
        )
    },
    Row {
        icon: "<path class=\"i\" d=\"M-12 -8h24M-12 0h24M-12 8h14\"/>",
        examples: &[within(
            "*; start > print(1) > end",
            &[],
            &[],
            &["print \"1\""],
        )],
        ..row(
            "CommentBlock",
            ["Comment", "Комментарий"],
            Does::Comment,
            &[property(
                "Comment",
                ["Comment", "Комментарий"],
                Raw,
                "Enter some text here...",
            )],
            [
                "A comment. No link may end at it.",
                "Комментарий. Ни одна связь не может вести к нему.",
            ],
        )
    },
    Row {
        category: Category::Actions,
        icon: ENVELOPE,
        examples: &[within(
            "start > Fork =main> ReceiveMessageThreads:Variable=x > print(x) > end; Fork =b> * > end",
            &[("Thread", "main"), ("Message", "1 + 1")],
            &[],
            &["print \"2\""],
        )],
        ..row(
            "SendMessageThreads",
            ["Send Message To Thread", "Отправить сообщение в задачу"],
            Does::Send,
            &[
                property("Thread", ["Thread", "Задача"], Raw, ""),
                expression("Message", ["Message", "Сообщение"], Text, ""),
            ],
            [
                "Sends a message to a thread by its name. A message to a thread that does not exist is lost.",
                "Отправляет сообщение задаче с этим именем. Сообщение задаче, которой нет, теряется.",
            ],
        )
    },
    Row {
        category: Category::Actions,
        icon: "<circle class=\"i\" r=\"13\"/><circle class=\"f\" r=\"6\"/>",
        examples: &[
            within(
                "start > * > print(x) > end",
                &[],
                &[(75, Stimulus::Number("Down", 1))],
                &["print \"108\""],
            ),
            within(
                "start > * > print(x) > end",
                &[("Wait", "false")],
                &[],
                &["print \"-1\""],
            ),
        ],
        ..row(
            "GetButtonCode",
            ["Get Button Code", "Код кнопки"],
            Does::AnyButton,
            &[
                variable("Variable", "x"),
                flag("Wait", ["Wait", "Ждать"], "true"),
            ],
            [
                "Assigns the code of a pressed button: Left 105, Right 106, Up 103, Down 108, Enter 28, Power 116, Esc 1. Without `Wait` it assigns -1 if none is pressed. It checks every 20 ms, the first time after 20 ms.",
                "Присваивает код нажатой кнопки: влево 105, вправо 106, вверх 103, вниз 108, Enter 28, Power 116, Esc 1. Без `Ждать` присваивает -1, если ничего не нажато. Проверяет каждые 20 мс, первый раз через 20 мс.",
            ],
        )
    },
    Row {
        category: Category::Wait,
        icon: "<circle class=\"i\" r=\"13\"/><path class=\"i\" d=\"M0 -8V0L6 4\"/>",
        examples: &[waits(&[("Delay", "25 + 50")], &[], 110)],
        ..row(
            "Timer",
            ["Timer", "Таймер"],
            Does::Timer,
            &[expression(
                "Delay",
                ["Delay (ms)", "Задержка (мс)"],
                Whole,
                "1000",
            )],
            [
                "Waits for a number of milliseconds, rounded up to a multiple of 10, at least 10.",
                "Ждёт заданное число миллисекунд, округлённое вверх до кратного 10, не меньше 10.",
            ],
        )
    },
    Row {
        category: Category::Wait,
        icon: ENVELOPE,
        examples: &[
            within(
                "start > x=1 > * > print(x) > end",
                &[("Variable", "x"), ("Synchronized", "false")],
                &[],
                &["print \"1\""],
            ),
            within(
                "start > Fork =main> * > print(x) > end; Fork =b> Timer:Delay=50 > SendMessageThreads:Thread=main,Message=7 > end",
                &[("Variable", "x")],
                &[],
                &["print \"7\""],
            ),
        ],
        ..row(
            "ReceiveMessageThreads",
            [
                "Receive Message From Thread",
                "Получить сообщение из задачи",
            ],
            Does::Receive,
            &[
                variable("Variable", ""),
                flag("Synchronized", ["Synchronized", "Ждать сообщения"], "true"),
            ],
            [
                "Takes the next message for the present thread. The message is an expression: a text must have been sent with its quotes. If there is none, it waits, or goes on if it is not synchronized.",
                "Берёт следующее сообщение для нынешней задачи. Сообщение - выражение: текст должен быть отправлен в кавычках. Если сообщений нет, ждёт или, без синхронизации, продолжает.",
            ],
        )
    },
    Row {
        category: Category::Wait,
        silent: Silent::WithoutMailbox,
        icon: ENVELOPE,
        examples: &[within(
            "start > * > print(x) > end",
            &[("Variable", "x")],
            &[(75, Stimulus::Mail("hi"))],
            &["print \"hi\""],
        )],
        ..row(
            "TrikWaitForMessage",
            ["Wait for Message", "Ждать сообщения"],
            Does::Mail,
            &[
                variable("Variable", ""),
                flag("Synchronized", ["Synchronized", "Ждать сообщения"], "true"),
            ],
            [
                "Assigns the next message of another robot, as a text. It checks every 100 ms. If it is not synchronized and there is none, it assigns an empty text.",
                "Присваивает следующее сообщение другого робота, как текст. Проверяет каждые 100 мс. Без синхронизации и без сообщений присваивает пустой текст.",
            ],
        )
    },
    Row {
        category: Category::Actions,
        silent: Silent::WithoutMailbox,
        icon: ENVELOPE,
        examples: &[example(&[], &["join 192.168.77.1 8889 1"])],
        ..row(
            "TrikJoinNetwork",
            ["Join Network", "Подключиться к сети"],
            Does::Act(&Act::command(
                |with| Command::Join {
                    address: with.written,
                    port: with.number(0),
                    hull: with.wholes[0],
                },
                &[script(
                    &[Written, Operand::Number(0), Operand::Whole(0)],
                    "mailbox.joinNetwork($1, $2, $3)",
                )],
            )),
            &[
                property("Address", ["Address", "Адрес"], Raw, "192.168.77.1"),
                property("IPPort", ["Port", "Порт"], Number, "8889"),
                expression("HullNumber", ["Hull Number", "Бортовой номер"], Whole, "1"),
            ],
            [
                "Takes a hull number and connects to the mailbox of another robot.",
                "Берёт бортовой номер и подключается к почте другого робота.",
            ],
        )
    },
];
