# Helpers of every Python script in the tests: the places, waiting for conditions, expecting errors.
import errno, fcntl, linecache, mmap, os, random, resource, select, signal, struct, subprocess, sys, threading, time

M, D = os.environ.get('MNT', ''), os.environ.get('DIR', '')
# As the other tests have it, and less than a whole script may take.
LIMIT = 80


def eventually(holds, what='condition'):
    deadline, pause = time.monotonic() + LIMIT, 0.0002
    while not holds():
        assert time.monotonic() < deadline, 'not in time: ' + what
        time.sleep(pause)
        pause = min(pause * 2, 0.02)


def error_of(call, *args):
    """Name of the OSError that a call raises, or None."""
    try:
        call(*args)
    except OSError as error:
        return errno.errorcode[error.errno]
    return None


def expect(name, call, *args):
    got = error_of(call, *args)
    assert got == name, 'expected %s, got %s' % (name, got)


def open_ro(path, flags=0):
    return os.open(path, os.O_RDONLY | flags)


def feed(name):
    """The writing end of a named pipe that never waits."""
    return os.open(os.path.join(D, name), os.O_RDWR | os.O_NONBLOCK)


def text(path):
    with open(path) as file:
        return file.read()


def answer(path):
    """What one reading of a file gives: its text, or the name of the error. Two readings may see two moments."""
    try:
        return text(path)
    except OSError as error:
        return errno.errorcode[error.errno]


def stat_of(path, key):
    for line in text(path).splitlines():
        if line.split()[0] == key:
            return float(line.split()[1])
    raise AssertionError('no %s in %s' % (key, path))


def read_exactly(fd, size, piece=1 << 20):
    got = b''
    while len(got) < size:
        new = os.read(fd, min(piece, size - len(got)))
        assert new, 'end of file after %d of %d bytes' % (len(got), size)
        got += new
    return got


def asleep(pid):
    with open('/proc/%d/stat' % pid) as file:
        return file.read().rsplit(')', 1)[1].split()[0] in 'SD'


def has_open(pid, path):
    """Whether a process has a file open whose path ends so. A descriptor that closes between the two looks is none."""
    folder = '/proc/%d/fd' % pid
    for number in os.listdir(folder):
        try:
            if os.readlink(os.path.join(folder, number)).endswith(path):
                return True
        except FileNotFoundError:
            pass
    return False


def ready(fd, events=select.POLLIN, ms=0):
    poller = select.poll()
    poller.register(fd, events)
    return [bits for _, bits in poller.poll(ms)]


def forked(action):
    """Runs an action in a child; returns its number."""
    pid = os.fork()
    if pid == 0:
        try:
            action()
        except BaseException as error:
            print('child:', repr(error), file=sys.stderr, flush=True)
            os._exit(1)
        os._exit(0)
    return pid


def ended(pid):
    """Waits for a child, at most LIMIT seconds; returns its exit code or minus the signal."""
    result = []

    def gone():
        got, status = os.waitpid(pid, os.WNOHANG)
        if got:
            result.append(os.waitstatus_to_exitcode(status))
        return got
    eventually(gone, 'the end of child %d' % pid)
    return result[0]


_script = os.environ.pop('TRIK_SCRIPT')
linecache.cache['script'] = (len(_script), None, _script.splitlines(True), 'script')
exec(compile(_script, 'script', 'exec'), globals())
