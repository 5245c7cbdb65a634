"""The robot for generated Python: each call is a line to the test, which holds the stand-in and says who runs."""

import os
import sys
import threading

_turns = {0: threading.Event()}
_numbers = {threading.get_ident(): 0}
_out = os.fdopen(os.dup(1), 'w', encoding='utf-8', newline='\n')
_in = os.fdopen(os.dup(0), 'r', encoding='utf-8', newline='\n')
_names = {'main': 0}


def _say(*words):
  escaped = [str(word).replace('\\', '\\\\').replace('\t', '\\t').replace('\n', '\\n') for word in words]
  _out.write('\t'.join(escaped) + '\n')
  _out.flush()


def _ask(*words):
  _say(*words)
  line = _in.readline()
  if not line:
    os._exit(0)
  return line.rstrip('\n')


def _turn(*words):
  """Gives the turn to whom the test names, and waits for it."""
  me = _numbers[threading.get_ident()]
  answer = _ask(*words)
  if answer == 'quit':
    os._exit(0)
  following = int(answer)
  if following != me:
    _turns[me].clear()
    _turns[following].set()
    _turns[me].wait()


def _end(number):
  answer = _ask('end', number)
  if answer == 'quit':
    os._exit(0)
  _turns[int(answer)].set()


class _Motor:
  def __init__(self, port):
    self.port = port

  def setPower(self, power):
    _say('power' if self.port[0] == 'M' else 'servo', self.port, power)

  def powerOff(self):
    _say('off', self.port)


class _Sensor:
  def __init__(self, port):
    self.port = port

  def read(self, *_):
    return int(_ask('scalar', self.port))

  def reset(self):
    _say('reset', self.port)


class _Vector:
  def __init__(self, port, mode=''):
    self.port, self.mode = port, mode

  def read(self, *_):
    return [int(word) for word in _ask('vector', self.port).split()]

  def init(self, show):
    _say('camera', self.mode, int(show))

  def detect(self):
    _say('detect', self.mode)

  def calibrate(self, _):
    _say('calibrate')


class _Objects(_Vector):
  def read(self):
    return [int(_ask('scalar', 'ObjectSensor%sPort' % part)) for part in ('X', 'Y', 'Size')]


class _Keys:
  def isPressed(self, code):
    return _ask('key', code) != '0'

  def buttonCode(self, wait):
    while True:
      script.wait(20)
      code = int(_ask('anykey'))
      if code != -1 or not wait:
        return code


class _Led:
  def __getattr__(self, color):
    return lambda: _say('led', color)


class _Display:
  def addLabel(self, text, x, y, size):
    _say('label', x, y, size, text)

  def showImage(self, file):
    _say('smile', ['media/trik_smile_normal.png', 'media/trik_smile_sad.png'].index(file))

  def redraw(self):
    _say('redraw')

  def clear(self):
    _say('clear')

  def setPainterColor(self, color):
    _say('pen', color)

  def setPainterWidth(self, width):
    _say('width', width)

  def setBackground(self, color):
    _say('background', color)

  def drawPoint(self, *numbers):
    _say('pixel', *numbers)

  def drawLine(self, *numbers):
    _say('line', *numbers)

  def drawRect(self, *numbers):
    _say('rectangle', *map(int, numbers))

  def drawEllipse(self, *numbers):
    _say('ellipse', *map(int, numbers))

  def drawArc(self, *numbers):
    _say('arc', *numbers)


class _Marker:
  def down(self, color):
    _say('marker', color)

  def up(self):
    _say('markerup')


class _Brick:
  motor = staticmethod(_Motor)
  sensor = staticmethod(_Sensor)
  encoder = staticmethod(_Sensor)
  keys = staticmethod(_Keys)
  led = staticmethod(_Led)
  display = staticmethod(_Display)
  marker = staticmethod(_Marker)

  def gyroscope(self):
    return _Vector('GyroscopePort')

  def accelerometer(self):
    return _Vector('AccelerometerPort')

  def lidar(self):
    return _Vector('LidarPort')

  def lineSensor(self, _):
    return _Vector('LineSensorPort', 'line')

  def colorSensor(self, _):
    return _Vector('ColorSensorPort', 'color')

  def objectSensor(self, _):
    return _Objects('', 'object')

  def configure(self, port, kind):
    assert port == 'video2' and kind in ('lineSensor', 'objectSensor', 'colorSensor'), kind

  def playSound(self, file):
    _say('sound', file)

  def playTone(self, hertz, ms):
    _say('tone', hertz, ms)

  def say(self, text):
    _say('say', text)

  def stop(self):
    _say('rest')


class _Script:
  def wait(self, ms):
    _turn('wait', _numbers[threading.get_ident()], ms)

  def time(self):
    return int(_ask('time'))

  def random(self, low, high):
    return int(_ask('random', low, high))

  def system(self, command):
    _say('system', command)

  def writeToFile(self, file, text):
    _say('append', file, text)

  def removeFile(self, file):
    _say('remove', file)


def _print(text):
  _say('print', text)


brick = _Brick()
script = _Script()
with open(sys.argv[1], encoding='utf-8') as file:
  text = file.read()
space = {'__name__': '__main__', 'brick': brick, 'script': script, 'print': _print}
exec(compile(text, sys.argv[1], 'exec'), space)
_end(0)
threading.Event().wait()
