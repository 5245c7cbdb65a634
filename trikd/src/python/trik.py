"""The robot for Python programs: brick, script, mailbox and gamepad, by the names of the TRIK controller.

Everything is a file of the mounted tree; trikd is asked only for the mailbox. What cannot be read is an OSError with
the reason in the file `fault` beside it, except where programs of old expect a number: a distance without an echo
is -1, a pad that nobody touches is at -101.
"""

import builtins
import ctypes
import errno
import heapq
import io
import itertools
import json
import math
import os
import queue
import random as _random
import re
import shutil
import struct
import subprocess
import sys
import threading
import time
import traceback

# The name of the controller's own module; programs import either.
sys.modules.setdefault('TRIK', sys.modules[__name__])

_ROOT = os.environ.get('TRIK_TREE', '/trikfs')
_STALE = {errno.ENOTCONN, errno.ENODEV, errno.ESTALE, errno.ECONNABORTED}


class _File:
    """One file of the tree, opened once."""

    def __init__(self, path, flags=os.O_RDONLY):
        self.path, self.flags, self.fd = os.path.join(_ROOT, path), flags, None

    def _do(self, work):
        for last in (False, True):
            try:
                if self.fd is None:
                    self.fd = os.open(self.path, self.flags | os.O_CLOEXEC)
                return work(self.fd)
            except OSError as error:
                self.close()
                if last or error.errno not in _STALE:
                    raise OSError(error.errno, error.strerror, self.path) from None

    def text(self):
        return self._do(lambda fd: os.pread(fd, 4096, 0)).decode().rstrip('\0\n')

    def numbers(self):
        return [float(word) if '.' in word or 'e' in word else int(word) for word in self.text().split()]

    def number(self):
        numbers = self.numbers()
        if not numbers:
            raise OSError(errno.ENODATA, 'there is no number', self.path)
        return numbers[0]

    def write(self, text):
        self._do(lambda fd: os.pwrite(fd, text.encode(), 0))

    def close(self):
        fd, self.fd = self.fd, None
        if fd is not None:
            os.close(fd)


_files = {}


def _file(path, flags=os.O_RDONLY):
    if (path, flags) not in _files:
        _files[path, flags] = _File(path, flags)
    return _files[path, flags]


def _number(value, what):
    """A finite number, or a text with one; whatever else there is must not move anything."""
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise ValueError('%s: %r is no number' % (what, value))
    return number


def _whole(value, what, least=-2**31, most=2**31 - 1):
    """The whole number of it, as the controller takes numbers: cut towards zero, and to its range."""
    return int(max(least, min(most, _number(value, what))))


def _has(directory):
    return os.path.isdir(os.path.join(_ROOT, directory))


def _is_there(path):
    return os.path.exists(os.path.join(_ROOT, path))


def _names(directory):
    try:
        return sorted(os.listdir(os.path.join(_ROOT, directory)))
    except FileNotFoundError:
        return []


def _ports(group):
    """Names of connectors. The second names that a robot file gives them count only where it has no others."""
    names = _names(group)
    return [name for name in names if re.fullmatch('[A-Z]{1,2}[0-9]{1,2}', name)] or names


class _Channel:
    """Frames to and from trikd."""

    def __init__(self, fd):
        self.fd, self.buffer, self.lock = fd, b'', threading.Lock()

    def send(self, word, text=''):
        payload = (word + ':' + text).encode('utf-8', 'replace')
        frame = b'%d:%s' % (len(payload), payload)
        with self.lock:
            while frame:
                frame = frame[os.write(self.fd, frame):]

    def receive(self):
        """The next frame; None when trikd is gone."""
        while True:
            head, colon, rest = self.buffer.partition(b':')
            if colon and len(rest) >= int(head):
                frame, self.buffer = rest[:int(head)], rest[int(head):]
                if frame:
                    return frame.decode('utf-8', 'replace')
                continue
            piece = os.read(self.fd, 65536)
            if not piece:
                return None
            self.buffer += piece


class _Output(io.TextIOBase):
    """What is printed, line by line, in one order with failures."""

    encoding, errors = 'utf-8', 'replace'

    def __init__(self):
        self._rest, self._lock = '', threading.RLock()

    def writable(self):
        return True

    def fileno(self):
        return 1

    def write(self, text):
        with self._lock:
            *lines, self._rest = (self._rest + text).split('\n')
            for line in lines:
                _channel.send('print', line + '\n')
            if len(self._rest) > 4096:
                self.flush()
        return len(text)

    def flush(self):
        with self._lock:
            rest, self._rest = self._rest, ''
            if rest and _channel:
                _channel.send('print', rest)


_channel = None
_events = queue.Queue()
_answers = queue.Queue()
_mail = queue.Queue()
_directs = queue.Queue()
web = {}


def _listen():
    while True:
        try:
            frame = _channel.receive()
        except OSError:
            frame = None
        if frame is None:
            os._exit(1)
        word, _, rest = frame.partition(':')
        if word == 'direct':
            _directs.put(rest)
            _events.put(None)
        elif word == 'answer':
            _answers.put(rest)
        elif word == 'mail':
            hull, _, text = rest.partition(':')
            _mail.put(text)
            _events.put((mailbox.newMessage, (int(hull), text)))
        elif word == 'web':
            _channel.send('web', json.dumps({str(key): str(value) for key, value in web.items()}))


class _Signal:
    """Something that happens; functions that are connected are called by script.run()."""

    def __init__(self, start=None):
        self.functions, self.start = [], start

    def connect(self, function):
        self.functions.append(function)
        if self.start:
            start, self.start = self.start, None
            threading.Thread(target=start, daemon=True).start()

    def disconnect(self, function=None):
        self.functions = [other for other in self.functions if function is not None and other is not function]

    def _call(self, arguments):
        for function in list(self.functions):
            function(*arguments)


def _watched(read):
    """A signal with values and time, 50 times a second from the first connection on."""
    def watch():
        while True:
            try:
                _events.put((signal, (read(), int(time.time() * 1000))))
            except OSError:
                pass
            time.sleep(0.02)
    signal = _Signal(watch)
    return signal


def _stream(path, size):
    """Pieces of a stream of the tree for ever."""
    while True:
        try:
            fd = os.open(os.path.join(_ROOT, path), os.O_RDONLY | os.O_CLOEXEC)
            try:
                while True:
                    piece = os.read(fd, size)
                    if not piece:
                        break
                    yield piece
            finally:
                os.close(fd)
        except OSError:
            pass
        time.sleep(0.25)


# What motors are told passes here: a debugger stops no thread inside this module, and none may turn a motor while all
# motors rest for a stop. Who holds it calls nothing in Python but this module, where a debugger could stop a thread.
_gate = threading.RLock()
_is_held = False
# The newest stop that was held and the newest that is over: the debugger may call out of order, in several threads.
_stop_held = _stop_over = 0
# What motors do when they go on, by their places.
_resting = {}


def _place(directory):
    """The place of a motor in the tree, which has the same file at a second name too."""
    group = directory.partition('/')[0]
    for port in _ports(group):
        values = [os.path.join(_ROOT, place, 'value') for place in (directory, '%s/%s' % (group, port))]
        try:
            if os.path.samefile(*values):
                return '%s/%s/' % (group, port)
        except OSError:
            pass
    return directory + '/'


def _most(place):
    is_angle = place.startswith('servos') and _file(place + 'units').text() != '%'
    return 90 if is_angle else 100


def _turn(file, power, end):
    """Some servos have nothing below the middle, and go as far as they go: to the end, which power motors have not."""
    try:
        file.write('%d\n' % power)
    except OSError as error:
        if error.errno != errno.ERANGE or not end:
            raise
        file.write('0\n' if power < 0 else '%d\n' % end)


class Motor:
    def __init__(self, directory, servo):
        self._value, self._servo = directory + '/value', servo
        self._switch = directory + ('/power' if servo else '/brake')
        self._place, self._told = _place(directory), set()
        self._most = _most(self._place)

    def setPower(self, power, constrain=True):
        power = _whole(power, 'setPower', -self._most, self._most)
        file = _file(self._value, os.O_WRONLY)
        with _gate:
            _resting.pop(self._place, None)
            # A power motor that is told 0 is at rest, whatever stands still.
            if _is_held and (power or self._servo):
                _resting[self._place] = power
            else:
                _turn(file, power, self._servo and self._most)

    def power(self):
        return _file(self._value).number()

    def powerOff(self):
        file = _file(self._switch if self._servo else self._value, os.O_WRONLY)
        with _gate:
            _resting.pop(self._place, None)
            file.write('0\n')

    def brake(self, ms=500):
        if self._servo:
            return self.powerOff()
        file = _file(self._switch, os.O_WRONLY)
        with _gate:
            _resting.pop(self._place, None)
            # One that rests for a debugger stands still already.
            if not _is_held:
                file.write('1\n')
        time.sleep(max(0, _whole(ms, 'brake')) / 1000)
        self.setPower(0)

    def setPeriod(self, us=20000):
        _once(self._told, 'motor.setPeriod', 'the tree sets the period of pulses by the type of the motor; nothing is changed')


class Sensor:
    def __init__(self, directory):
        self._value, self._raw = _file(directory + '/value'), _file(directory + '/raw')
        self._distance = os.path.basename(directory)[:1] == 'D'

    def read(self):
        try:
            return self._value.number()
        except OSError:
            # Without an echo there is no distance, and programs expect -1.
            if self._distance and self._raw.number() == -1:
                return -1
            raise

    def readRawData(self):
        return self._raw.number()


class Encoder(Sensor):
    def __init__(self, directory):
        super().__init__(directory)
        self._zero = _file(directory + '/value', os.O_WRONLY)

    def reset(self):
        self._zero.write('0\n')


class KeysEnum:
    Left, Up, Down, Enter, Right, Power, Esc = 105, 103, 108, 28, 106, 116, 1


class Events:
    Sync, Key, Relative, Absolute, Misc = range(5)


class MouseEventCodes:
    """Numbers of linux/input-event-codes.h under the names of the controller."""

    X, Y, Wheel = 0, 1, 8
    LeftBtn, RightBtn, MiddleBtn = 272, 273, 274


class PadEventCodes:
    """As MouseEventCodes."""

    BtnA, BtnB, BtnC, BtnX, BtnY, BtnZ = range(304, 310)
    BtnTL, BtnTR, BtnTL2, BtnTR2, BtnSelect, BtnStart = range(310, 316)
    X, Y, Z, Rx, Ry, Rz, Throttle, Rudder, Wheel, Gas, Break = range(11)
    Hat0X, Hat0Y, Hat1X, Hat1Y = range(16, 20)


_KEY_ORDER = [116, 103, 1, 105, 106, 108, 28]


class Keys:
    def __init__(self):
        self._state, self._latched, self._codes = dict.fromkeys(_KEY_ORDER, 0), set(), queue.Queue()
        self._lock, self._started = threading.Lock(), False
        self.buttonPressed = _Signal(self._start)

    def _start(self):
        with self._lock:
            started, self._started = self._started, True
        if not started:
            threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        size = 4 * len(_KEY_ORDER)
        for piece in _stream('keys/device', size):
            if len(piece) != size:
                continue
            for code, value in zip(_KEY_ORDER, struct.unpack('=7i', piece)):
                if value != self._state[code]:
                    self._state[code] = value
                    if value:
                        self._latched.add(code)
                        self._codes.put(code)
                    _events.put((self.buttonPressed, (code, value)))

    def wasPressed(self, code):
        self._start()
        code = _whole(code, 'wasPressed')
        if code in self._latched:
            self._latched.discard(code)
            return True
        return False

    def isPressed(self, code):
        code = _whole(code, 'isPressed')
        try:
            return dict(zip(_KEY_ORDER, _file('keys/value', os.O_RDONLY | os.O_NONBLOCK).numbers())).get(code, 0) != 0
        except BlockingIOError:
            return False  # No key was touched since the start.

    def buttonCode(self, wait=True):
        self._start()
        try:
            return self._codes.get(block=wait)
        except queue.Empty:
            return -1

    def reset(self):
        self._latched.clear()
        while self.buttonCode(False) != -1:
            pass


class Led:
    def _set(self, green, red):
        _file('led/green/value', os.O_WRONLY).write('%d\n' % green)
        _file('led/red/value', os.O_WRONLY).write('%d\n' % red)

    def green(self):
        self._set(1, 0)

    def red(self):
        self._set(0, 1)

    def orange(self):
        self._set(1, 1)

    def off(self):
        self._set(0, 0)


class Battery:
    def readVoltage(self):
        return _file('battery/value').number()

    def readRawDataVoltage(self):
        return _file('battery/raw').number()


class Accelerometer:
    def __init__(self):
        self.newData = _watched(self.read)

    def read(self):
        return _file('accelerometer/value').numbers()

    def readRawData(self):
        return _file('accelerometer/raw').numbers()


class Gyroscope:
    _TURN = 360000
    _NO_VALUES = 'the gyroscope calibrates itself whenever the robot rests; its bias stands in the robot file'

    def __init__(self):
        # What is left of a calibration, since the tree measures the bias by itself: where forward is.
        self._forward, self._waits = 0, None
        self.newData, self.calibrationFinished = _watched(self.read), _Signal()

    def read(self):
        rates, tilt = _file('gyroscope/value').numbers(), _file('gyroscope/tilt').numbers()
        heading = _file('gyroscope/heading').number()
        if self._forward:
            turned = heading - self._forward
            heading = turned - self._TURN * math.floor(turned / self._TURN + 0.5)
        return rates + [int(time.time() * 1e6) % (1 << 31)] + tilt + [heading]

    def readRawData(self):
        return _file('gyroscope/raw').numbers()

    def calibrate(self, ms):
        """After this time the heading begins at 0."""
        ms, self._waits = max(0, _whole(ms, 'calibrate')), object()
        threading.Thread(target=self._finish, args=(self._waits, ms), daemon=True).start()

    def _finish(self, mine, ms):
        time.sleep(ms / 1000)
        while self._waits is mine:
            try:
                self._forward = _file('gyroscope/heading').number()
            except OSError:
                time.sleep(0.02)
                continue
            self._waits = None
            _events.put((self.calibrationFinished, ()))

    def isCalibrated(self):
        if self._waits is not None:
            return False
        try:
            _file('gyroscope/value', os.O_RDONLY | os.O_NONBLOCK).number()
        except OSError:
            return False
        return True

    def getCalibrationValues(self):
        raise TypeError('gyroscope.getCalibrationValues: ' + self._NO_VALUES)

    def setCalibrationValues(self, values):
        raise TypeError('gyroscope.setCalibrationValues: ' + self._NO_VALUES)


class Lidar:
    def read(self):
        """Distances in mm, one for each degree."""
        return _file('lidar/value').numbers()


def _cell(values, row, column, what):
    side = round(len(values) ** 0.5)
    row, column = _whole(row, what), _whole(column, what)
    if not (1 <= row <= side and 1 <= column <= side):
        raise IndexError('%s has cells 1 to %d, not %d, %d' % (what, side, row, column))
    return values[(row - 1) * side + column - 1]


def _never(what, why):
    """A signal that would never come says so when somebody wants it."""
    class Never(_Signal):
        def connect(self, function):
            raise TypeError('%s: %s' % (what, why))
    return Never()


class IrCamera:
    _NO_PICTURE = 'the tree has no picture of the infrared camera; readSensor() gives its cells'

    def __init__(self):
        self.imageUpdated = _never('irCamera.imageUpdated', self._NO_PICTURE)
        self.sensorUpdated = _never('irCamera.sensorUpdated', 'the tree tells no changes of the infrared camera; use a timer')
        self.stopped = _never('irCamera.stopped', 'the infrared camera does not stop')

    def init(self):
        _file('ir_camera/value').numbers()

    def stop(self):
        pass

    def readSensor(self, row, column):
        return _cell(_file('ir_camera/value').numbers(), row, column, 'irCamera')

    def getImage(self):
        raise TypeError('irCamera.getImage: ' + self._NO_PICTURE)


class Fifo:
    """Lines of a text node of the tree."""

    _LINES_MAX = 4096

    def __init__(self, path):
        self._lines, self.newLine, self.newData = queue.Queue(), _Signal(), _Signal()
        threading.Thread(target=self._watch, args=(path,), daemon=True).start()

    def _watch(self, path):
        for piece in _stream(path, 4096):
            for line in piece.replace(b'\0', b'\n').decode('utf-8', 'replace').split('\n'):
                if not line:
                    continue
                if self._lines.qsize() >= self._LINES_MAX:
                    self._take()
                self._lines.put(line)
                for signal, value in ((self.newLine, line), (self.newData, list(line.encode()))):
                    if signal.functions:
                        _events.put((signal, (value,)))

    def _take(self, wait=False):
        try:
            return self._lines.get(block=wait)
        except queue.Empty:
            return None

    def read(self):
        return self._take(True)

    def readRaw(self):
        return list('\n'.join(iter(self._take, None)).encode())

    def hasLine(self):
        return not self._lines.empty()

    def hasData(self):
        return self.hasLine()


class Camera:
    def __init__(self, place):
        self._place, self._name = place, place.rpartition('/')[2]
        self._file = _File(place + '/value', os.O_RDONLY | os.O_NONBLOCK)
        self._colour = _File(place + '/hsv', os.O_RDONLY | os.O_NONBLOCK)
        self._untold, self.stopped = None, _Signal()

    def init(self, show=False):
        # The sensor runs while its files are open.
        self._untold = None
        self.read()
        self._untold = bool(show)
        self._tell()

    def _write(self, name, text):
        """Whether the sensor has heard it: it runs a while after init()."""
        try:
            _file('%s/%s' % (self._place, name), os.O_WRONLY).write(text)
        except OSError as error:
            if error.errno != errno.ENODEV:
                raise
            return False
        return True

    def _tell(self):
        if self._untold is not None and self._write('video_out', '%d\n' % self._untold):
            self._untold = None

    def detect(self):
        self.getDetectParameters()
        end = time.monotonic() + 3
        while not self._write('detect', '1\n'):
            if time.monotonic() > end:
                raise OSError(errno.ENODEV, 'the sensor does not run: was init() called before?', self._name)
            time.sleep(0.02)

    def read(self, row=None, column=None):
        self._tell()
        try:
            numbers = self._file.numbers()
        except BlockingIOError:
            numbers = [0, 0, 0]
        if self._name != 'color':
            return numbers
        colour = 0
        if len(numbers) >= 4:
            colour = numbers[0] if row is None else _cell(numbers, row, 1 if column is None else column, 'colorSensor')
        return [colour >> 16 & 255, colour >> 8 & 255, colour & 255]

    def getDetectParameters(self):
        try:
            return self._colour.numbers()
        except BlockingIOError:
            return []  # Nothing was detected yet.

    def stop(self):
        self._untold = None
        self._file.close()
        self._colour.close()
        _events.put((self.stopped, ()))


def _once(told, what, why):
    """A failure that ends no program is told once."""
    if what not in told:
        told.add(what)
        if _channel:
            _channel.send('info', '%s: %s' % (what, why))
        else:
            print('info: %s: %s' % (what, why), file=sys.stderr)


class _Helper:
    """`trikd draw`, a process beside this one that draws and reads pictures."""

    def __init__(self):
        self._process, self._lock = None, threading.Lock()

    def ask(self, line, data=b''):
        """The bytes of its answer; a failure is an OSError with its text."""
        line = line.replace('\n', '\\n').encode('utf-8', 'replace') + b'\n' + data
        with self._lock:
            if self._process is None or self._process.poll() is not None:
                program = os.environ.get('TRIKD') or shutil.which('trikd') or 'trikd'
                self._process = subprocess.Popen([program, 'draw', '--answers', '--tree', _ROOT],
                                                 stdin=subprocess.PIPE, stdout=subprocess.PIPE)
            self._process.stdin.write(line)
            self._process.stdin.flush()
            state, _, rest = self._process.stdout.readline().decode('utf-8', 'replace').strip().partition(' ')
            if state == 'ok':
                return self._process.stdout.read(int(rest))
        raise OSError(rest or 'trikd draw has ended')


_helper = _Helper()


def getPhoto():
    """A small picture of the camera, 160 x 120: one number for each point."""
    rgb = _helper.ask('photo 160 120')
    return [red << 16 | green << 8 | blue for red, green, blue in zip(rgb[::3], rgb[1::3], rgb[2::3])]


class Display:
    """What is drawn goes to the helper. What goes wrong is told once."""

    def __init__(self):
        self._told = set()

    def _order(self, name, line, data=b''):
        try:
            _helper.ask(line, data)
        except OSError as error:
            _once(self._told, 'display.' + name, error)

    def addLabel(self, text, x, y, fontSize=-1):
        self._order('addLabel', 'label %s %s %s %s' % (x, y, fontSize, text))

    def removeLabels(self):
        self._order('removeLabels', 'removelabels')

    def showImage(self, file):
        self._order('showImage', 'image ' + os.path.abspath(file))

    def show(self, pixels, width, height, format='rgb32'):
        numbers = struct.pack('<%di' % len(pixels), *((int(part) + 2**31) % 2**32 - 2**31 for part in pixels))
        self._order('show', 'show %d %d %s %d' % (width, height, format, len(pixels)), numbers)

    def drawLine(self, x1, y1, x2, y2):
        self._order('drawLine', 'line %s %s %s %s' % (x1, y1, x2, y2))

    def drawPoint(self, x, y):
        self._order('drawPoint', 'point %s %s' % (x, y))

    def drawRect(self, x, y, width, height, filled=False):
        self._order('drawRect', 'rect %s %s %s %s %d' % (x, y, width, height, bool(filled)))

    def drawEllipse(self, x, y, width, height, filled=False):
        self._order('drawEllipse', 'ellipse %s %s %s %s %d' % (x, y, width, height, bool(filled)))

    def drawArc(self, x, y, width, height, start, span):
        self._order('drawArc', 'arc %s %s %s %s %s %s' % (x, y, width, height, start, span))

    def setPainterColor(self, name):
        self._order('setPainterColor', 'color %s' % name)

    def setPainterWidth(self, pixels):
        self._order('setPainterWidth', 'width %s' % pixels)

    def setBackground(self, name):
        self._order('setBackground', 'background %s' % name)

    def redraw(self):
        self._order('redraw', 'redraw')

    def clear(self):
        self._order('clear', 'clear')

    def hide(self):
        self._order('hide', 'hide')

    def reset(self):
        self._order('reset', 'clear')


class PwmCapture:
    def __init__(self, directory):
        self._directory = directory

    def frequency(self):
        return _file(self._directory + '/raw').numbers()

    def duty(self):
        return _file(self._directory + '/duty_cycle').number()

    def dutyRaw(self):
        raise TypeError('pwmCapture.dutyRaw: the driver tells no raw width of pulses; duty() gives percent')


class I2c:
    """A device on a bus: bytes at the position of a register, as the tree has them."""

    def __init__(self, bus, address, wide, order):
        bus, address = _whole(bus, 'bus'), _whole(address, 'address')
        if not 3 <= address <= 0x77:
            raise ValueError('address %s is not 3 to 119 (0x77)' % address)
        path = 'i2c/bus%d/device' % bus
        if not _is_there(path):
            raise FileNotFoundError(errno.ENOENT, 'there is no bus %d' % bus, os.path.join(_ROOT, path))
        self._file = _File(path, os.O_RDWR)
        self._base, self._most = (address << 16) + (wide << 24), 0xffff if wide else 0xff
        # Words go out like this, but come in with the low byte first, as TRIK has it.
        self._order = order

    def _place(self, register):
        register = _whole(register, 'register')
        if not 0 <= register <= self._most:
            raise ValueError('register %s is not 0 to %d' % (register, self._most))
        return self._base + register

    def send(self, register, value, mode='b'):
        value = _whole(value, 'value')
        bytes_ = (value & 0xffff).to_bytes(2, self._order) if mode == 'w' else bytes([value & 255])
        place = self._place(register)
        self._file._do(lambda fd: os.pwrite(fd, bytes_, place))

    def read(self, register, mode='b'):
        return int.from_bytes(bytes(self.readX(register, 2 if mode == 'w' else 1)), 'little')

    def readX(self, register, count):
        place = self._place(register)
        return list(self._file._do(lambda fd: os.pread(fd, count, place)))


class _Narrowed:
    """Events of one type or of one code; `on` is their signal."""

    def __init__(self):
        self.on, self._inner = _Signal(), {}

    def _get(self, number):
        return self._inner.setdefault(int(number), _Narrowed())

    code = _get


class EventDevice(_Narrowed):
    """The events of an input device: on(event, code, value, time), and less of it at each level below."""

    onEvent = _Narrowed._get
    _EVENT = struct.Struct('<HHiq')

    def __init__(self, path):
        super().__init__()
        self._runs = True
        os.close(os.open(os.path.join(_ROOT, path), os.O_RDONLY | os.O_CLOEXEC))
        threading.Thread(target=self._read, args=(path,), daemon=True).start()

    def _read(self, path):
        for piece in _stream(path, self._EVENT.size * 64):
            if not self._runs:
                break
            for event in self._EVENT.iter_unpack(piece[:len(piece) // self._EVENT.size * self._EVENT.size]):
                _events.put((self, event))

    def _call(self, event):
        kind, code, value, time_us = event
        if not self._runs:
            return
        self.on._call((kind, code, value, time_us))
        kinds = self._inner.get(kind)
        if kinds:
            kinds.on._call((code, value, time_us))
            codes = kinds._inner.get(code)
            if codes:
                codes.on._call((value, time_us))

    def _stop(self):
        # The thread that reads closes the file when it next has something, or ends with the program.
        self._runs = False


class SoundSensor(Camera):
    def volume(self, coefficient):
        self._write('volume', '%d\n' % _whole(coefficient, 'volume', 0, 100))


class Brick:
    def __init__(self):
        self._made, self._keys, self._display, self._told = {}, Keys(), Display(), set()
        self.stopped, self.resetCompleted = _Signal(), _Signal()

    def _absent(self, what, port, kinds):
        """Nothing is plugged in there: said once, because what is called on None is an error that names no port."""
        there = [name for directory, _ in kinds for name in _ports(directory)]
        _once(self._told, '%s(%s)' % (what, port), 'nothing is plugged in there; plugged in are ' + (', '.join(there) or 'none'))

    def _port(self, what, port, kinds, file=''):
        port = str(port)
        for directory, make in kinds:
            place = '%s/%s' % (directory, port)
            plain = '/' not in port and port not in ('', '.', '..')
            if (place, file) not in self._made and plain and _is_there(os.path.join(place, file)):
                self._made[place, file] = make(place)
            if (place, file) in self._made:
                return self._made[place, file]
        if what:
            self._absent(what, port, kinds)
        return None

    def motor(self, port):
        kinds = [('motors', lambda place: Motor(place, False)), ('servos', lambda place: Motor(place, True))]
        return self._port('brick.motor', port, kinds)

    def sensor(self, port):
        return self._port('brick.sensor', port, [('sensors', Sensor)])

    def encoder(self, port):
        return self._port('brick.encoder', port, [('encoders', Encoder)])

    def keys(self):
        return self._keys

    def led(self):
        return Led()

    def display(self):
        return self._display

    def smile(self):
        self._display._order('smile', 'smile')

    def sadSmile(self):
        self._display._order('sadSmile', 'sadsmile')

    def getStillImage(self):
        return _helper.ask('photo 320 240')

    def pwmCapture(self, port):
        return self._port('', port, [('servos', PwmCapture)], 'duty_cycle')

    def pwmCapturePorts(self):
        return [port for port in _ports('servos') if self.pwmCapture(port)]

    def battery(self):
        return Battery()

    def _one(self, place, make):
        if place not in self._made and _has(place):
            self._made[place] = make()
        return self._made.get(place)

    def accelerometer(self):
        return self._one('accelerometer', Accelerometer)

    def gyroscope(self):
        return self._one('gyroscope', Gyroscope)

    def _camera(self, place, make=Camera):
        return self._one(place, lambda: make(place))

    def lineSensor(self, port=None):
        return self._camera('camera/line')

    def objectSensor(self, port=None):
        return self._camera('camera/object')

    def colorSensor(self, port=None):
        return self._camera('camera/color')

    def soundSensor(self, port=None):
        return self._camera('microphones', SoundSensor)

    def i2c(self, bus, address, regSize=1):
        return I2c(bus, address, regSize == 2, 'big')

    def smBusI2c(self, bus, address):
        return I2c(bus, address, False, 'little')

    def eventDevice(self, file):
        path = self._eventPath(file)
        if path not in self._made and _has(os.path.dirname(path)):
            try:
                self._made[path] = EventDevice(path)
            except OSError as error:
                if error.errno != errno.ENODEV:
                    raise
        return self._made.get(path)

    def stopEventDevice(self, file):
        device = self._made.pop(self._eventPath(file), None)
        if device:
            device._stop()

    @staticmethod
    def _eventPath(file):
        return 'input/%s/device' % re.sub('[^A-Za-z0-9_-]', '_', str(file).rpartition('/')[2])

    def lidar(self, port=None):
        return self._one('lidar', Lidar)

    def irCamera(self):
        return self._one('ir_camera', IrCamera)

    def fifo(self, port):
        place = str(port)
        is_plain = len(place.split('/')) <= 3 and all(re.fullmatch('[A-Za-z0-9_-]+', part) for part in place.split('/'))
        if not is_plain or not _is_there(place + '/device'):
            return None
        return self._one(place, lambda: Fifo(place + '/device'))

    def configure(self, port, kind):
        """The robot file says what is plugged in. Cameras need nothing."""
        if kind not in ('lineSensor', 'objectSensor', 'colorSensor'):
            _once(self._told, 'brick.configure of %s' % port, 'the robot file says what is plugged in; nothing is changed')

    def gamepad(self):
        return gamepad

    def __getattr__(self, name):
        raise AttributeError('brick.%s: the tree of the robot has no file for it' % name)

    def marker(self):
        return None

    def playSound(self, file):
        _file('sound/play/value', os.O_WRONLY).write(os.path.abspath(file))

    def playTone(self, hz, ms):
        hz, ms = _whole(hz, 'playTone'), _whole(ms, 'playTone')
        if hz >= 0 and ms > 0:
            tone = (max(20, min(7000, hz)), min(10000, ms))
            _file('sound/tone/value', os.O_WRONLY).write('%d %d\n' % tone)

    def say(self, text):
        _file('sound/say/value', os.O_WRONLY).write(str(text))

    def motorPorts(self, kind=None):
        groups = {'powerMotor': ['motors'], 'servoMotor': ['servos']}.get(kind, ['motors', 'servos'])
        return [name for group in groups for name in _ports(group)]

    def sensorPorts(self, kind=None):
        begins = {'analogSensor': 'A', 'digitalSensor': 'D', 'rangeSensor': 'D'}.get(kind, '')
        return [name for name in _ports('sensors') if name.startswith(begins)]

    def encoderPorts(self):
        return _ports('encoders')

    def _rest(self):
        file = _file('stop', os.O_WRONLY)
        with _gate:
            # Nothing turns after a stop of the debugger either.
            _resting.clear()
            file.write('1\n')
        if _is_there('display/device'):
            self._display.hide()

    def stop(self):
        self._rest()
        _events.put((self.stopped, ()))

    def reset(self):
        self._rest()
        self._keys.reset()
        _events.put((self.resetCompleted, ()))


class Timer:
    """Calls what is connected to `timeout` each time its period is over, in script.run()."""

    def __init__(self, ms):
        self.timeout, self._turn, self._runs, self._once = _Signal(), 0, False, False
        self.start(ms)

    def _plan(self, at):
        """The next time; those that were planned before count no longer."""
        self._turn += 1
        self._at = at
        script._schedule(at, self._turn, self)

    def start(self, ms=None):
        if ms is not None:
            self._period = max(0, _whole(ms, 'timer')) / 1000
        self._runs = True
        self._plan(time.monotonic() + self._period)

    def stop(self):
        self._runs = False

    def isActive(self):
        return self._runs

    def interval(self):
        return round(self._period * 1000)

    def setInterval(self, ms):
        self._period = max(0, _whole(ms, 'timer')) / 1000
        if self._runs:
            self._plan(time.monotonic() + self._period)

    def isSingleShot(self):
        return self._once

    def setSingleShot(self, on):
        self._once = bool(on)

    def remainingTime(self):
        return max(0, round((self._at - time.monotonic()) * 1000)) if self._runs else -1

    def _fire(self, now):
        if self._once:
            self._runs = False
        else:
            # A period of 0 is one of 1 ms: others want to run as well.
            self._plan(max(now, self._at + max(0.001, self._period)))
        self.timeout._call(())


class Script:
    def __init__(self):
        self._due, self._order, self._quits = [], itertools.count(), False
        self._runs = False

    def _schedule(self, at, turn, timer):
        heapq.heappush(self._due, (at, next(self._order), turn, timer))

    def wait(self, ms):
        time.sleep(max(0, _whole(ms, 'wait')) / 1000)

    def isInEventDrivenMode(self):
        return self._runs

    def repeat(self, ms, function):
        timer = Timer(ms)
        timer.timeout.connect(function)
        return timer

    def reset(self):
        """Stops all timers."""
        for _, _, _, timer in self._due:
            timer.stop()
        self._due = []

    def time(self):
        return int(time.time() * 1000)

    def timeInterval(self, first, second):
        return _whole(second, 'timeInterval') - _whole(first, 'timeInterval') & 0x7fffffff

    def random(self, least, greatest):
        least, greatest = _whole(least, 'random'), _whole(greatest, 'random')
        return _random.randint(min(least, greatest), max(least, greatest))

    def timer(self, ms):
        return Timer(ms)

    def system(self, command, synchronously=False):
        # What helpers say is not what the program says.
        quiet = dict.fromkeys(('stdin', 'stdout', 'stderr'), subprocess.DEVNULL)
        process = subprocess.Popen(['sh', '-c', str(command)], **quiet)
        return process.wait() if synchronously else 0

    def getPhoto(self):
        return getPhoto()

    def writeToFile(self, file, text):
        with open(file, 'a', encoding='utf-8') as out:
            out.write(str(text))

    def writeData(self, file, data):
        with open(file, 'ab') as out:
            out.write(bytes(data))

    def readAll(self, file):
        with open(file, encoding='utf-8', errors='replace') as text:
            return text.readlines()

    def removeFile(self, file):
        try:
            os.remove(file)
        except FileNotFoundError:
            pass

    def quit(self):
        self._quits = True
        _events.put(None)

    def run(self):
        """Event-driven from here on: calls what is connected, until quit()."""
        if _channel:
            _channel.send('events')
        self._quits, self._runs = False, True
        while not self._quits:
            now = time.monotonic()
            while self._due and self._due[0][0] <= now and not self._quits:
                _, _, turn, timer = heapq.heappop(self._due)
                if timer._runs and timer._turn == turn:
                    timer._fire(now)
            while not _directs.empty():
                _evaluate(_directs.get())
            wait = max(0, self._due[0][0] - time.monotonic()) if self._due else None
            try:
                event = _events.get(timeout=wait)
            except queue.Empty:
                continue
            if event:
                event[0]._call(event[1])


class Threads:
    """Threads of a program by their names, with messages; all variables are shared."""

    def __init__(self):
        self._threads, self._mail, self._lock = {}, {}, threading.Lock()

    def _box(self, name):
        with self._lock:
            return self._mail.setdefault(name, queue.Queue())

    def startThread(self, name, function):
        known = self._threads.get(name)
        if known and known.is_alive():
            raise ValueError('the thread %s runs already' % name)
        thread = threading.Thread(target=self._run, args=(function,), name=name)
        self._threads[name] = thread
        thread.start()

    def _run(self, function):
        try:
            function()
        except SystemExit:
            pass
        except BaseException:
            # The program ends with the first thread that fails, also when nobody can be told.
            try:
                _show_failure()
                _tell_failure()
                sys.stdout.flush()
            finally:
                os._exit(1)

    def joinThread(self, name):
        thread = self._threads.get(name)
        if thread:
            thread.join()

    def killThread(self, name):
        """Ends a thread before its next statement."""
        thread = self._threads.get(name)
        if thread and thread.is_alive():
            raised = ctypes.py_object(SystemExit)
            ctypes.pythonapi.PyThreadState_SetAsyncExc(ctypes.c_ulong(thread.ident), raised)

    def sendMessage(self, name, text):
        self._box(name).put(str(text))

    def reset(self):
        """Ends all threads but the main one and itself."""
        mine = threading.current_thread()
        for name, thread in list(self._threads.items()):
            if thread is not mine:
                self.killThread(name)

    def receiveMessage(self, wait=True):
        mine = threading.current_thread()
        box = self._box('main' if mine is threading.main_thread() else mine.name)
        try:
            return box.get(block=wait)
        except queue.Empty:
            return ''


class Mailbox:
    def __init__(self):
        self.newMessage, self._waiting = _Signal(), 0

    def _ask(self, words):
        if not _channel:
            raise OSError('there is no mailbox without trikd')
        _channel.send('mailbox', words)
        return _answers.get()

    def connect(self, ip, port=None):
        self._ask('connect %s %s' % (ip, '' if port is None else _whole(port, 'connect')))

    def joinNetwork(self, ip, port=-1, hull=-1):
        self._ask('join %s %d %d' % (ip or '-', _whole(port, 'joinNetwork'), _whole(hull, 'joinNetwork')))

    def send(self, hull, text=None):
        if text is None:
            hull, text = -1, hull
        self._ask('send %d %s' % (_whole(hull, 'send'), text))

    def receive(self, wait=True):
        self._waiting += bool(wait)
        try:
            return _mail.get(block=wait)
        except queue.Empty:
            return ''
        finally:
            self._waiting -= bool(wait)

    def stopWaiting(self):
        """Ends receive() in other threads, which then gives an empty text."""
        for _ in range(self._waiting):
            _mail.put('')

    def reset(self):
        self.clearQueue()

    def hasMessages(self):
        return not _mail.empty()

    def clearQueue(self):
        while self.receive(False):
            pass

    def myHullNumber(self):
        return int(self._ask('hull'))

    def setHullNumber(self, hull):
        self._ask('hull %d' % _whole(hull, 'setHullNumber'))

    def serverIp(self):
        return self._ask('server')

    def myIp(self):
        return self._ask('ip')

    def isConnected(self):
        return self._ask('connected') == '1'

    def isEnabled(self):
        return self._ask('enabled') == '1'

    def hasServer(self):
        return self._ask('server') != ''

    def renewIp(self):
        self._ask('renew')


class Gamepad:
    def __init__(self):
        self._seen = None
        for name in ('pad', 'padUp', 'button', 'wheelEvent', 'custom', 'connected'):
            setattr(self, name, _Signal(self._start))
        self.disconnected = _Signal(self._look)
        self._started, self._heard, self._told = False, False, set()

    def _look(self):
        was = self.isConnected()
        while True:
            time.sleep(0.5)
            now = self.isConnected()
            if was and not now:
                self._heard = False
                _events.put((self.disconnected, ()))
            was = now

    def _start(self):
        if not self._started:
            self._started = True
            threading.Thread(target=self._watch, daemon=True).start()

    def _watch(self):
        for piece in _stream('gamepad/text/device', 4096):
            for line in piece.replace(b'\0', b'\n').decode('utf-8', 'replace').splitlines():
                words = line.split()
                try:
                    self._line(words, line)
                except (ValueError, IndexError):
                    pass

    def _line(self, words, line):
        if not words:
            return
        if not self._heard:
            self._heard = True
            _events.put((self.connected, ()))
        if words[0] == 'pad' and words[2] == 'up':
            _events.put((self.padUp, (int(words[1]),)))
        elif words[0] == 'pad':
            _events.put((self.pad, tuple(int(word) for word in words[1:4])))
        elif words[0] == 'btn':
            _events.put((self.button, (int(words[1]), 0 if words[2:] == ['up'] else 1)))
        elif words[0] == 'wheel':
            _events.put((self.wheelEvent, (int(words[1]),)))
        elif words[0] == 'custom':
            _events.put((self.custom, (line.partition(' ')[2],)))

    def _numbers(self, name, missing):
        try:
            return _file('gamepad/' + name, os.O_RDONLY | os.O_NONBLOCK).numbers()
        except OSError:
            return missing

    def _pad(self, pad):
        return self._numbers('pad%d/value' % _whole(pad, 'pad'), [0, 0, 0])

    def isPadPressed(self, pad):
        return self._pad(pad)[2] != 0

    def padX(self, pad):
        x, _, touched = self._pad(pad)
        return x if touched else -101

    def padY(self, pad):
        _, y, touched = self._pad(pad)
        return y if touched else -101

    def wheel(self):
        return self._numbers('wheel/value', [-101])[0]

    @staticmethod
    def _button(button):
        button = _whole(button, 'button')
        if not 1 <= button <= 5:
            raise IndexError('a gamepad has buttons 1 to 5, not %d' % button)
        return button

    def buttonIsPressed(self, button):
        return self._numbers('buttons/value', [0] * 5)[self._button(button) - 1] != 0

    def buttonWasPressed(self, button):
        button = self._button(button)
        presses = self._numbers('buttons/presses', [0] * 5)
        if self._seen is None:
            self._seen = [0] * 5
        was = presses[button - 1] != self._seen[button - 1]
        self._seen[button - 1] = presses[button - 1]
        return was

    def isConnected(self):
        return self._numbers('buttons/value', None) is not None

    def reset(self):
        self._seen = self._numbers('buttons/presses', [0] * 5)

    def disconnect(self):
        _once(self._told, 'gamepad.disconnect', 'a gamepad ends its connection itself; nothing is changed')


script = Script()
mailbox = Mailbox()
gamepad = Gamepad()
Threading = Threads()
brick = Brick()

for _letter, _count in (('A', 6), ('D', 3), ('M', 4), ('E', 4), ('S', 6)):
    for _index in range(1, _count + 1):
        globals()['%s%d' % (_letter, _index)] = '%s%d' % (_letter, _index)

__all__ = [
    'brick', 'script', 'getPhoto', 'mailbox', 'gamepad', 'web', 'Threading',
    'KeysEnum', 'Events', 'MouseEventCodes', 'PadEventCodes',
] + [
    name for name in list(globals()) if name[:1] in 'ADMES' and name[1:].isdigit()
]


def _namespace(name):
    space = {key: globals()[key] for key in __all__}
    space.update({'__name__': name, '__builtins__': builtins})
    return space


_direct_space = None


def _tell_failure():
    """The traceback without the lines of this module."""
    sys.stdout.flush()
    kind, error, trace = sys.exc_info()
    while trace and trace.tb_frame.f_code.co_filename == __file__:
        trace = trace.tb_next
    _channel.send('error', ''.join(traceback.format_exception(kind, error, trace)))


_debugger = None


def _attach(address, secret):
    """Lets the program be debugged by who listens there; returns when all breakpoints are known."""
    global _debugger
    # It would print that modules inside the interpreter are not seen, which no program of a robot has.
    os.environ.setdefault('PYDEVD_DISABLE_FILE_VALIDATION', '1')
    try:
        import debugpy
    except ImportError:
        _channel.send('error', 'debugpy is needed to debug Python, and this robot has none: type there: %s -m pip install debugpy\n' % sys.executable)
        sys.exit(1)
    import socket
    host, _, port = address.rpartition(':')
    debugpy.configure(subProcess=False)
    connect = socket.socket.connect

    def introduce(self, place):
        for left in (2, 1, 0):
            try:
                connect(self, place)
                break
            except socket.timeout:
                raise
            except OSError as error:
                # A network may be gone for a moment.
                if not left:
                    raise
                if left == 2:
                    _channel.send('info', 'the debugger at %s cannot be reached: %s; trying again' % (address, error))
                time.sleep(1)
        if secret != '-':
            # Before debugpy says anything, so that no other process is taken for this one.
            self.sendall((secret + '\n').encode())
    try:
        socket.socket.connect = introduce
        debugpy.connect((host.strip('[]'), int(port)))
    except BaseException as error:
        # A debugger that is not there ends the program inside debugpy.
        _channel.send('error', 'the debugger at %s cannot be reached: %s\n' % (address, error))
        sys.exit(1)
    finally:
        socket.socket.connect = connect
    debugpy.wait_for_client()
    _debugger = debugpy


def _stop_on_entry():
    """The debugger stops before the first line of the program."""
    from _pydevd_bundle.pydevd_api import PyDevdAPI
    PyDevdAPI().stop_on_entry()


def _show_failure():
    """A debugger may stop where nobody has caught an exception, before the program ends because of it."""
    show = getattr(_debugger, 'trigger_exception_handler', None)
    if show:
        try:
            show()
        except BaseException:
            # The program fails because of its own exception, and says that one.
            pass


_told_stop = ''


def _tell_stop(is_stopped=True):
    """Tells the robot where a debugger has stopped the program, or that it goes on; the thread that began it comes first."""
    global _told_stop
    told = ''
    if is_stopped:
        folder = os.path.dirname((_direct_space or {}).get('__file__', ''))
        frames = sys._current_frames()
        main = frames.pop(threading.main_thread().ident, None)
        for frame in [main, *frames.values()]:
            while frame and os.path.dirname(frame.f_code.co_filename) != folder:
                frame = frame.f_back
            if frame:
                told = '%d %s' % (frame.f_lineno, os.path.basename(frame.f_code.co_filename))
                break
    if told != _told_stop and _channel:
        _channel.send('stopped', told)
        _told_stop = told


def _hold(stop):
    """Motors rest because a debugger has stopped all threads; what it calls when it has, and again until all rest.

    True: all do. From here on they stay so: what threads tell them counts when they go on. Stops have numbers from 1 on.
    """
    global _is_held, _stop_held
    # Nobody waits long for a thread whose motor does not answer: the others are to rest.
    is_closed = _gate.acquire(timeout=0.5)
    try:
        if stop <= _stop_over:
            return True
        _is_held, _stop_held = True, max(stop, _stop_held)
        do_rest = all([_let_rest('%s/%s/' % (group, port)) for group in ('motors', 'servos') for port in _ports(group)]) and is_closed
    finally:
        if is_closed:
            _gate.release()
    # After the motors: the robot may be slow to hear.
    _tell_stop()
    return do_rest


def _let_rest(place):
    """Whether a motor rests."""
    is_servo = place.startswith('servos')
    try:
        if is_servo and _file(place + 'power').number() != 1:
            return True
        told = _file(place + 'value').number()
        if told or is_servo:
            _file(place + ('power' if is_servo else 'value'), os.O_WRONLY).write('0\n')
            # What it was told at rest is newer.
            _resting.setdefault(place, told)
        return True
    except FileNotFoundError:
        # A port of a servo that measures pulses has no switch.
        return True
    except OSError:
        return False


def _go_on(stop):
    """Motors do again what they did or were told at rest, but for those that somebody else has told something."""
    global _is_held, _stop_over
    with _gate:
        _stop_over = max(stop, _stop_over)
        if _stop_held > stop:
            return
        _is_held = False
        _tell_stop(False)
        while _resting:
            place, told = _resting.popitem()
            try:
                is_servo = place.startswith('servos')
                is_off = not _file(place + ('power' if is_servo else 'value')).number()
                if is_off:
                    _turn(_file(place + 'value', os.O_WRONLY), told, is_servo and _most(place))
            except OSError:
                pass


def _evaluate(code):
    try:
        exec(compile(code, '<direct>', 'exec'), _direct_space)
    except Exception:
        _tell_failure()


def _main():
    global _channel, _direct_space
    # Standard input becomes empty, so that input() and children do not take what trikd says.
    fd = os.dup(0)
    null = os.open(os.devnull, os.O_RDONLY)
    os.dup2(null, 0)
    os.close(null)
    _channel = _Channel(fd)
    sys.stdout = _Output()
    first = _channel.receive()
    word, _, rest = (first or ':').partition(':')
    listener = threading.Thread(target=_listen, daemon=True)
    # A debugger holds and shows the threads of the program, and this is none.
    listener.pydev_do_not_trace = listener.is_pydev_daemon_thread = True
    listener.start()
    _direct_space = _namespace('__main__')
    if word == 'start':
        script.run()
        return
    address = secret = None
    if word == 'debugpy':
        address, secret, rest = rest.split(' ', 2)
    sys.path.insert(0, os.path.dirname(rest))
    sys.argv = [rest]
    _direct_space['__file__'] = rest
    try:
        with open(rest, 'rb') as file:
            text = file.read()
        code = compile(text, rest, 'exec')
        if address:
            _attach(address, secret)
        exec(code, _direct_space)
    except SystemExit:
        raise
    except BaseException:
        try:
            _show_failure()
            _tell_failure()
            sys.stdout.flush()
        finally:
            if _debugger:
                # A debugger would stop once more, at the exit.
                os._exit(1)
        sys.exit(1)
    finally:
        sys.stdout.flush()
