"""Python under a judge: the module `trik` in model time, one thread at a time.

Begins behind a text that has made `channel` and `setting`: of a process of its own, or of a browser. Whatever concerns the
robot or time is a question to the judge; time passes only while all threads wait, or for a program that asks or computes for
long.
"""

import _thread
import itertools
import os
import random
import sys
import threading
import time
import types

EPOCH = 1767225600.0
# Steps of the interpreter for one look at the judge: some 5000 lines.
LOOK_STEPS = 20000
# From Python 3.12 on a loop of one line has lines, and steps are not told to who asks for them only when a call begins.
HAS_LINES = sys.version_info >= (3, 12)
STEPS_OF_EVENT = 4 if HAS_LINES else 1
FOREVER = float('inf')

now = 0.0


class Link:
    """Questions to the judge, through `channel`."""

    def send(self, word, text=''):
        channel.send(word, text)

    def ask(self, word, text=''):
        """The judge's answer; a failure is an OSError."""
        global now
        stand()
        kind, at, answer = channel.ask(word, text).split(':', 2)
        now = float(at)
        if kind == 'ok':
            return answer
        number, _, reason = answer.partition(':')
        raise OSError(int(number), reason)


link = Link()


def stand():
    """Who looks on is told at which line of its program the thread is that runs."""
    if not watched:
        return
    frame = sys._getframe(1)
    while frame and not frame.f_code.co_filename.startswith(folder):
        frame = frame.f_back
    if frame:
        file = frame.f_code.co_filename
        link.send('at', '%s\n%d\n%s' % (running.name, frame.f_lineno, '' if file == own_file else file[len(folder):]))


class Task:
    """A thread: who holds the turn runs, all others stand at their gates."""

    def __init__(self, is_daemon, name):
        self.name = name.replace('\n', ' ')
        self.gate = _thread.allocate_lock()
        self.gate.acquire()
        self.due, self.order, self.wanted = FOREVER, next(orders), lambda: True
        self.is_done, self.is_killed, self.is_daemon = False, False, is_daemon

    def is_ready(self):
        return self.is_killed or self.due <= now or (self.wanted is not None and self.wanted())


orders = itertools.count()
running = Task(False, 'main')
tasks = [running]


def following():
    """Who runs next; time passes if nobody can."""
    while True:
        ready = [task for task in tasks if task.is_ready()]
        if ready:
            return min(ready, key=lambda task: (min(task.due, now), task.order))
        due = min(task.due for task in tasks)
        link.ask('wait', '' if due == FOREVER else repr(due))


def hand_over():
    global running
    me, running = running, following()
    if running is not me:
        running.gate.release()
        me.gate.acquire()
    me.due, me.wanted = FOREVER, None
    if me.is_killed:
        raise SystemExit


def block(wanted, due=FOREVER):
    """Until something is so, or a time."""
    stand()
    me = running
    me.wanted, me.due, me.order = wanted, due, next(orders)
    hand_over()


def give_way():
    block(lambda: True)


def sleep(seconds):
    if seconds < 0:
        raise ValueError('sleep length must be non-negative')
    block(None, now + seconds * 1000)


class Lock:
    def __init__(self):
        self.is_taken = False

    def acquire(self, blocking=True, timeout=-1):
        if self.is_taken:
            if not blocking:
                return False
            block(lambda: not self.is_taken, FOREVER if timeout is None or timeout < 0 else now + timeout * 1000)
            if self.is_taken:
                return False
        self.is_taken = True
        return True

    def release(self):
        if not self.is_taken:
            raise RuntimeError('release unlocked lock')
        self.is_taken = False

    def locked(self):
        return self.is_taken

    def __enter__(self):
        self.acquire()
        return True

    def __exit__(self, *_):
        self.release()

    def _at_fork_reinit(self):
        self.is_taken = False


class Thread(threading.Thread):
    task = None

    def start(self):
        if self.task is not None:
            raise RuntimeError('threads can only be started once')
        if len(tasks) >= 64:
            raise RuntimeError('a judged program has at most 64 threads at once')
        self.task = Task(self.daemon, str(self.name))
        try:
            # It waits at its gate.
            _thread.start_new_thread(self._live, ())
        except RuntimeError:
            self.task = None
            raise
        tasks.append(self.task)
        give_way()

    def _live(self):
        global running
        self.task.gate.acquire()
        self._ident = _thread.get_ident()
        threading._active[self._ident] = self
        sys.settrace(trace)
        try:
            if not self.task.is_killed:
                self.run()
        except SystemExit:
            pass
        except BaseException:
            threading.excepthook(threading.ExceptHookArgs([*sys.exc_info(), self]))
        sys.settrace(None)
        threading._active.pop(self._ident, None)
        self.task.is_done = True
        if watched:
            link.send('gone', self.task.name)
        tasks.remove(self.task)
        running = following()
        running.gate.release()

    def join(self, timeout=None):
        task = self.task
        if task is None:
            raise RuntimeError('cannot join thread before it is started')
        block(lambda: task.is_done, FOREVER if timeout is None else now + timeout * 1000)

    def is_alive(self):
        return self.task is not None and not self.task.is_done


steps = 0


def trace(frame, event, _):
    """Who computes for long without asking takes time as well."""
    global steps
    if event == 'call':
        if not frame.f_code.co_filename.startswith(folder):
            return None
        # A loop of one line has no lines to count in an older Python.
        frame.f_trace_opcodes, frame.f_trace_lines = not HAS_LINES, HAS_LINES
        return trace
    steps += STEPS_OF_EVENT
    if steps >= LOOK_STEPS:
        steps = 0
        link.ask('look')
        if running.is_killed:
            raise SystemExit
    return trace


def clocks():
    """Model time instead of all clocks."""
    time.sleep = sleep
    time.time = lambda: EPOCH + now / 1000
    time.time_ns = lambda: int((EPOCH * 1000 + now) * 1_000_000)
    for name in ('monotonic', 'perf_counter', 'process_time', 'thread_time'):
        setattr(time, name, lambda: now / 1000)
        setattr(time, name + '_ns', lambda: int(now * 1_000_000))
    threading._time = time.monotonic
    threading._allocate_lock = threading.Lock = Lock
    threading._CRLock, threading.RLock = None, threading._PyRLock
    threading.Thread = Thread
    sys.modules.pop('queue', None)


def module(text):
    """The module `trik`, whose files the judge has."""
    trik = types.ModuleType('trik')
    trik.__file__ = '<trik>'
    sys.modules['trik'] = trik
    exec(compile(text, '<trik>', 'exec'), trik.__dict__)

    class File(trik._File):
        def __init__(self, path, flags=os.O_RDONLY):
            self.path, self.flags, self.fd = path, flags, None

        def text(self):
            return link.ask('read', self.path)

        def write(self, text):
            link.ask('write', self.path + '\n' + text)

        def close(self):
            pass

    class Helper:
        def ask(self, line, data=b''):
            link.ask('draw', line.replace('\n', '\\n'))
            return b''

    def stream(path, size):
        import struct
        while True:
            piece = link.ask('stream', path)
            if piece and path == 'keys/device':
                yield struct.pack('=7i', *(int(word) for word in piece.split()))
            elif piece:
                yield piece.encode()
            sleep(0.01)

    def mail(self):
        while True:
            try:
                text = link.ask('mail')
            except OSError:
                return
            trik._mail.put(text)
            trik._events.put((trik.mailbox.newMessage, (-1, text)))

    def receive(self, wait=True):
        while True:
            mail(self)
            if not trik._mail.empty():
                return trik._mail.get()
            if not wait:
                return ''
            sleep(0.01)

    def post_office(mailbox=None):
        while True:
            mail(mailbox)
            sleep(0.01)

    class Marker:
        def down(self, color='black'):
            link.ask('write', 'marker/value\n' + str(color))

        def up(self):
            link.ask('write', 'marker/value\n')

    def random(self, a, b):
        a, b = trik._whole(a, 'random'), trik._whole(b, 'random')
        return int(link.ask('random', '%d %d' % (min(a, b), max(a, b))))

    def kill(self, name):
        thread = self._threads.get(name)
        if thread and thread.is_alive():
            thread.task.is_killed = True
            give_way()

    send = trik.Threads.sendMessage

    def send_message(self, name, text):
        send(self, name, text)
        give_way()

    trik._File, trik._helper, trik._stream = File, Helper(), stream
    trik._files.clear()
    trik._has = trik._is_there = lambda path: link.ask('has', path) == '1'
    trik._names = lambda path: link.ask('names', path).split()
    trik._channel, trik._tell_failure = link, tell_failure
    trik.Mailbox._ask = lambda self, words: link.ask('mailbox', words)
    trik.Mailbox.receive = receive
    trik.Mailbox.hasMessages = lambda self: (mail(self), not trik._mail.empty())[1]
    trik.mailbox.newMessage.start = post_office
    trik.Threads.killThread, trik.Threads.sendMessage = kill, send_message
    trik.Brick.marker = lambda self: Marker()
    script = trik.Script
    script.random = random
    script.system = lambda self, command, synchronously=False: int(link.ask('system', command) or 0)
    script.writeToFile = lambda self, file, text: link.ask('append', '%s\n%s' % (file, text)) and None
    script.writeData = lambda self, file, data: link.ask('append', '%s\n%s' % (file, bytes(data).decode('latin-1'))) and None
    script.readAll = lambda self, file: link.ask('file', file).splitlines(True)
    script.removeFile = lambda self, file: link.ask('remove', file) and None
    return trik


class Remarks:
    """Standard error: told to whom it may concern."""

    encoding, errors = 'utf-8', 'replace'

    def write(self, text):
        if text.strip():
            link.send('info', text.rstrip('\n'))
        return len(text)

    def flush(self):
        pass


def tell_failure():
    """The line of the program first, then the calls that have led there."""
    kind, error, trace = sys.exc_info()
    sys.stdout.flush()
    frames = []
    while trace:
        code = trace.tb_frame.f_code
        if code.co_filename.startswith(folder):
            frames.append((code.co_name, code.co_filename[len(folder):], trace.tb_lineno))
        trace = trace.tb_next
    if isinstance(error, SyntaxError) and (error.filename or '').startswith(folder):
        frames.append(('<module>', error.filename[len(folder):], error.lineno or 1))
        error = error.msg
    said = '%s: %s' % (kind.__name__, error) if str(error) else kind.__name__
    line = 'Line %d: ' % frames[-1][2] if frames else ''
    calls = ''.join('\n%s at %s:%d' % frame for frame in reversed(frames))
    link.send('error', line + said + calls)


def question(prompt=''):
    try:
        return link.ask('input', str(prompt))
    except OSError:
        raise EOFError('nobody answers any more') from None


def main():
    import builtins
    global folder, own_file, watched
    trik_text, path, program, seed, is_watched = setting()
    random.seed(seed)
    os.urandom = lambda count: random.randbytes(count)
    folder, own_file = os.path.dirname(path) + os.sep, path
    clocks()
    trik = module(trik_text)
    sys.stdout, sys.stderr = trik._Output(), Remarks()
    builtins.input = question
    sys.path.insert(0, folder)
    sys.argv = [path]
    sys.unraisablehook = lambda _: None
    space = trik._namespace('__main__')
    trik._direct_space = space
    space['__file__'] = path
    code = 0
    try:
        compiled = compile(program, path, 'exec')
        watched = is_watched
        sys.settrace(trace)
        exec(compiled, space)
        sys.settrace(None)
        me = running
        block(lambda: all(task.is_daemon or task is me for task in tasks))
    except SystemExit as end:
        code = 0 if end.code in (None, 0) else 1
    except BaseException:
        sys.settrace(None)
        tell_failure()
        code = 1
    sys.settrace(None)
    sys.stdout.flush()
    channel.end(str(code))


folder = own_file = ''
watched = False
main()
