//! Python with threads: they take turns in one, as generators.
//!
//! Owns what is different from plain Python: each function is a generator, and a thread that waits yields. The controller's own
//! runtime has no `Threading` for Python, and threads of Python cannot be ended by others.

use super::super::super::code::Turn;
use super::super::super::print::{Dialect, Printer, Row, Syntax, Tables, call};
use super::{HELPERS, PYTHON, assembled};

/// The language.
pub(in super::super::super) const TURNS: Dialect = Dialect {
    tables: Tables {
        turn,
        ..PYTHON.tables
    },
    syntax: Syntax {
        call: "yield from self.$1($2)",
        ..PYTHON.syntax
    },
    helpers: &ALL,
    assemble,
    ..PYTHON
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
    "Turns turns",
    "
class Turns:
  \"\"\"Threads that take turns: one runs until it waits.\"\"\"

  def __init__(self):
    self.threads, self.order, self.current = [], 0, None

  def step(self, thread):
    caller, self.current = self.current, thread
    self.order += 1
    thread['order'] = self.order
    try:
      thread['due'] = next(thread['run'])
    except StopIteration:
      thread['ended'] = True
    self.current = caller

  def find(self, name):
    found = [thread for thread in self.threads if thread['name'] == name and not thread['ended']]
    return found[0] if found else None

  def may_end(self):
    \"\"\"Who was killed goes no further.\"\"\"
    if self.current and self.current['ended']:
      yield 0

  def begin(self, name, run):
    thread = {'name': name, 'run': run(), 'mail': [], 'due': 0, 'order': 0, 'ended': False, 'receives': False}
    self.threads.append(thread)
    self.step(thread)

  def start(self, name, run):
    self.begin(name, run)
    yield from self.may_end()

  def wait(self, ms):
    yield script.time() + max(ms, 10)

  def join(self, name):
    while self.find(name):
      yield from self.wait(10)

  def kill(self, name):
    thread = self.find(name)
    if thread:
      thread['ended'] = True
    yield from self.may_end()

  def send(self, name, text):
    thread = self.find(name)
    if thread:
      thread['mail'].append(text)
      # The thread that waited for it goes first.
      if thread['receives']:
        self.step(thread)
    yield from self.may_end()

  def receive(self, waits):
    me = self.current
    while waits and not me['mail']:
      me['receives'] = True
      yield float('inf')
      me['receives'] = False
    return me['mail'].pop(0) if me['mail'] else ''

  def button_code(self, waits):
    while True:
      code = brick.keys().buttonCode(False)
      if code != -1 or not waits:
        return code
      yield from self.wait(20)

  def mail(self, waits):
    while waits and not mailbox.hasMessages():
      yield from self.wait(100)
    return mailbox.receive(False)

  def run(self, main):
    self.begin('main', main)
    while True:
      self.threads = [thread for thread in self.threads if not thread['ended']]
      if not self.threads:
        return
      first = min(self.threads, key=lambda thread: (thread['due'], thread['order']))
      rest = min(first['due'] - script.time(), 1000)
      if rest > 0:
        script.wait(rest)
      if first['due'] <= script.time():
        self.step(first)


turns = Turns()",
);

fn turn(turn: Turn) -> Row {
    use Turn::*;
    match turn {
        Wait => call("yield from turns.wait($1)"),
        AnyButton => call("(yield from turns.button_code($1))"),
        Mail => call("(yield from turns.mail($1))"),
        Start => call("yield from turns.start($1, $2)"),
        Join => call("yield from turns.join($1)"),
        Kill => call("yield from turns.kill($1)"),
        Send => call("yield from turns.send($1, $2)"),
        Receive => call("(yield from turns.receive(True))"),
        ReceiveNow => call("(yield from turns.receive(False))"),
    }
}

fn assemble(printer: &Printer<'_>) -> String {
    assembled(printer, true)
}
