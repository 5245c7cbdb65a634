//! JavaScript whose threads share variables: they take turns in one engine, as generators.
//!
//! Owns what is different from plain JavaScript: each function is a generator, and a thread that waits yields. `Threading` of
//! the controller gives each thread an engine of its own, in which others' variables never change.

use super::super::super::code::Turn;
use super::super::super::print::{Dialect, Printer, Row, Syntax, Tables, call};
use super::{HELPERS, JAVASCRIPT, assembled};

/// The language.
pub(in super::super::super) const TURNS: Dialect = Dialect {
    tables: Tables {
        turn,
        ..JAVASCRIPT.tables
    },
    syntax: Syntax {
        call: "yield* $1($2)",
        ..JAVASCRIPT.syntax
    },
    function: "$1",
    helpers: &ALL,
    assemble,
    ..JAVASCRIPT
};

const ALL: [(&str, &str); HELPERS.len() + 1] = {
    let mut all = [HELPER; HELPERS.len() + 1];
    let mut at = 0;
    while at < HELPERS.len() {
        all[at] = HELPERS[at];
        at += 1;
    }
    all
};

const HELPER: (&str, &str) = (
    "turns",
    "
// Threads take turns: one runs until it waits.
var turns = {
    threads: [],
    order: 0,
    current: null,
    step: function(thread) {
        var caller = turns.current;
        turns.order += 1;
        thread.order = turns.order;
        turns.current = thread;
        var next = thread.run.next();
        turns.current = caller;
        thread.due = next.value;
        if (next.done)
            thread.ended = true;
    },
    find: function(name) {
        return turns.threads.find(function(thread) { return thread.name == name && !thread.ended; });
    },
    // Who was killed goes no further.
    mayEnd: function*() {
        if (turns.current && turns.current.ended)
            yield 0;
    },
    begin: function(name, run) {
        var thread = { name: name, run: run(), mail: [], due: 0, ended: false, receives: false };
        turns.threads.push(thread);
        turns.step(thread);
    },
    start: function*(name, run) {
        turns.begin(name, run);
        yield* turns.mayEnd();
    },
    wait: function*(ms) {
        yield script.time() + Math.max(ms, 10);
    },
    join: function*(name) {
        while (turns.find(name))
            yield* turns.wait(10);
    },
    kill: function*(name) {
        var thread = turns.find(name);
        if (thread)
            thread.ended = true;
        yield* turns.mayEnd();
    },
    send: function*(name, text) {
        var thread = turns.find(name);
        if (thread) {
            thread.mail.push(text);
            // The thread that waited for it goes first.
            if (thread.receives)
                turns.step(thread);
        }
        yield* turns.mayEnd();
    },
    receive: function*(waits) {
        var me = turns.current;
        while (waits && me.mail.length == 0) {
            me.receives = true;
            yield Infinity;
            me.receives = false;
        }
        return me.mail.length == 0 ? \"\" : me.mail.shift();
    },
    buttonCode: function*(waits) {
        for (;;) {
            var code = brick.keys().buttonCode(false);
            if (code != -1 || !waits)
                return code;
            yield* turns.wait(20);
        }
    },
    mail: function*(waits) {
        while (waits && !mailbox.hasMessages())
            yield* turns.wait(100);
        return mailbox.receive(false);
    },
    run: function(main) {
        turns.begin(\"main\", main);
        for (;;) {
            turns.threads = turns.threads.filter(function(thread) { return !thread.ended; });
            if (turns.threads.length == 0)
                return;
            var first = turns.threads.reduce(function(one, other) {
                var isEarlier = other.due < one.due || other.due == one.due && other.order < one.order;
                return isEarlier ? other : one;
            });
            var rest = Math.min(first.due - script.time(), 1000);
            if (rest > 0)
                script.wait(rest);
            if (first.due <= script.time())
                turns.step(first);
        }
    }
};",
);

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("yield* turns.wait($1)"),
        Start => call("yield* turns.start($1, $2)"),
        Join => call("yield* turns.join($1)"),
        Kill => call("yield* turns.kill($1)"),
        Send => call("yield* turns.send($1, $2)"),
        Receive => call("(yield* turns.receive(true))"),
        ReceiveNow => call("(yield* turns.receive(false))"),
        AnyButton => call("(yield* turns.buttonCode($1))"),
        Mail => call("(yield* turns.mail($1))"),
    }
}

fn assemble(printer: &Printer<'_>) -> String {
    assembled(printer, true)
}
