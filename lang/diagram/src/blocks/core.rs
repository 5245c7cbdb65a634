//! Rows of the blocks that steer the flow: beginning and end, conditions, loops, threads, subprograms, variables.
//!
//! Owns rows only.

use super::Content::{Number, Raw};
use super::Type::{Statements, Text, Truth, Whole};
use super::act::Operand::{self, Written};
use super::act::{Act, example, script};
use super::{Category, Does, ENVELOPE, Kits, Property, Row, Silent};
use super::{expression, flag, property, variable};
use crate::brick::Command;

const fn row(
    kind: &'static str,
    shown: &'static str,
    does: Does,
    properties: &'static [Property],
    text: &'static str,
) -> Row {
    Row {
        kind,
        shown,
        category: Category::Algorithms,
        kits: Kits::Both,
        silent: Silent::Never,
        properties,
        text,
        does,
    }
}

pub(super) const ROWS: &[Row] = &[
    row(
        "InitialNode",
        "Initial Node",
        Does::Start,
        &[],
        "The program or the subprogram begins here. A diagram has one, with one link out of it.",
    ),
    row(
        "FinalNode",
        "Final Node",
        Does::End,
        &[],
        "The diagram ends here: a subprogram returns, a thread ends. Other threads go on.",
    ),
    row(
        "VariableInit",
        "Variable Initialization",
        Does::Assign,
        &[
            variable("variable", "x"),
            property("value", "Value", Raw, "0"),
        ],
        "Assigns a value to a variable. The text `variable = value` is run as a statement.",
    ),
    row(
        "IfBlock",
        "Condition",
        Does::If,
        &[expression("Condition", "Condition", Truth, "x > 0")],
        "Takes one of two branches. Exactly two links go out; their guards are `true` and `false`, and one of them may be left blank.",
    ),
    row(
        "FiBlock",
        "End if",
        Does::Merge,
        &[],
        "Branches meet here. It does nothing.",
    ),
    row(
        "PreconditionalLoop",
        "Pre-conditional Loop",
        Does::While,
        &[expression("Condition", "Condition", Truth, "x > 0")],
        "Runs its body as long as the condition holds. The link into the body has the guard `iteration`, the other one is blank.",
    ),
    row(
        "Loop",
        "Loop",
        Does::Loop,
        &[expression("Iterations", "Iterations", Whole, "10")],
        "Runs its body a number of times. The link into the body has the guard `iteration`, the other one is blank. The counter belongs to the block, not to the thread: a thread that leaves the body by another link finds it part-way when it comes back.",
    ),
    row(
        "SwitchBlock",
        "Switch",
        Does::Switch,
        &[expression("Expression", "Expression", Text, "x")],
        "Takes the link whose guard is the value of the expression, otherwise the blank one. Guards are converted to lower case and values are not, so a guard with capitals never matches a text.",
    ),
    row(
        "Function",
        "Function",
        Does::Statements,
        &[expression("Body", "Body", Statements, "")],
        "Runs statements: assignments and calls, divided by `;` or lines.",
    ),
    row(
        "Subprogram",
        "Subprogram",
        Does::Call,
        &[],
        "Runs another diagram and then goes on. Arguments are assigned to variables with the names of the parameters; when the subprogram returns, these variables get their previous values back.",
    ),
    row(
        "Fork",
        "Fork",
        Does::Fork,
        &[],
        "Starts a thread for each link; the guard is the name of the thread. One link has the name of the present thread, or is blank, and continues it.",
    ),
    row(
        "Join",
        "Join",
        Does::Join,
        &[],
        "Threads meet here. The guard of the link out of it names the thread that goes on when all have come; the others end.",
    ),
    row(
        "KillThread",
        "Kill Thread",
        Does::Kill,
        &[property("Thread", "Thread", Raw, "main")],
        "Ends a thread by its name.",
    ),
    row(
        "Randomizer",
        "Random Initialization",
        Does::Random,
        &[
            variable("Variable", "x"),
            expression("LowerBound", "From", Whole, "0"),
            expression("UpperBound", "To", Whole, "10"),
        ],
        "Assigns a random integer between two bounds, both included.",
    ),
    row(
        "Input",
        "Input",
        Does::Ask,
        &[
            variable("variable", "x"),
            property("default", "Default value", Raw, ""),
            property("prompt", "Prompt", Raw, ""),
        ],
        "Asks the user for a value; the answer is an expression. A link with the guard `cancel` is taken if there is no answer.",
    ),
    row(
        "CommentBlock",
        "Comment",
        Does::Comment,
        &[property(
            "Comment",
            "Comment",
            Raw,
            "Enter some text here...",
        )],
        "A comment. No link may end at it.",
    ),
    Row {
        category: Category::Actions,
        ..row(
            "SendMessageThreads",
            "Send Message To Thread",
            Does::Send,
            &[
                property("Thread", "Thread", Raw, ""),
                expression("Message", "Message", Text, ""),
            ],
            "Sends a message to a thread by its name. A message to a thread that does not exist is lost.",
        )
    },
    Row {
        category: Category::Actions,
        ..row(
            "GetButtonCode",
            "Get Button Code",
            Does::AnyButton,
            &[variable("Variable", "x"), flag("Wait", "Wait", "true")],
            "Assigns the code of a pressed button: Left 105, Right 106, Up 103, Down 108, Enter 28, Power 116, Esc 1. Without `Wait` it assigns -1 if none is pressed. It checks every 20 ms, the first time after 20 ms.",
        )
    },
    Row {
        category: Category::Wait,
        ..row(
            "Timer",
            "Timer",
            Does::Timer,
            &[expression("Delay", "Delay (ms)", Whole, "1000")],
            "Waits for a number of milliseconds, rounded up to a multiple of 10, at least 10.",
        )
    },
    Row {
        category: Category::Wait,
        ..row(
            "ReceiveMessageThreads",
            "Receive Message From Thread",
            Does::Receive,
            &[
                variable("Variable", ""),
                flag("Synchronized", "Synchronized", "true"),
            ],
            "Takes the next message for the present thread. The message is an expression: a text must have been sent with its quotes. If there is none, it waits, or goes on if it is not synchronized.",
        )
    },
    Row {
        category: Category::Wait,
        silent: Silent::WithoutMailbox,
        ..row(
            "TrikWaitForMessage",
            "Wait for Message",
            Does::Mail,
            &[
                variable("Variable", ""),
                flag("Synchronized", "Synchronized", "true"),
            ],
            "Assigns the next message of another robot, as a text. It checks every 100 ms. If it is not synchronized and there is none, it assigns an empty text.",
        )
    },
    Row {
        category: Category::Actions,
        silent: Silent::WithoutMailbox,
        ..row(
            "TrikJoinNetwork",
            "Join Network",
            Does::Act(
                &Act::command(
                    |with| Command::Join {
                        address: with.written,
                        port: with.number(0),
                        hull: with.wholes[0],
                    },
                    &[script(
                        &[Written, Operand::Number(0), Operand::Whole(0)],
                        "mailbox.joinNetwork($1, $2, $3)",
                    )],
                )
                .icon(ENVELOPE)
                .examples(&[example(&[], &["join 192.168.77.1 8889 1"])]),
            ),
            &[
                property("Address", "Address", Raw, "192.168.77.1"),
                property("IPPort", "Port", Number, "8889"),
                expression("HullNumber", "Hull Number", Whole, "1"),
            ],
            "Takes a hull number and connects to the mailbox of another robot.",
        )
    },
];
