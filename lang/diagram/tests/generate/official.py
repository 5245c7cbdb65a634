"""Reads programs in Python, with zero bytes between, and tells which names neither they nor TRIK's runtime have.

The methods are those of the original's interfaces as docs/user/javascript.md names them, without what its runtime for
Python lacks: `Threading`, `brick.smile` and `brick.sadSmile`.
"""

import ast
import builtins
import sys

METHODS = {
    'brick': '''motor sensor encoder keys display led battery accelerometer gyroscope lineSensor colorSensor objectSensor
        soundSensor lidar irCamera getStillImage pwmCapture fifo eventDevice stopEventDevice i2c smBusI2c gamepad marker
        configure playSound playTone say stop motorPorts sensorPorts encoderPorts pwmCapturePorts''',
    'script': '''wait time random timer run quit system writeToFile writeData readAll removeFile getPhoto timeInterval
        reset''',
    'mailbox': '''connect joinNetwork send receive hasMessages myHullNumber setHullNumber serverIp myIp isConnected isEnabled
        hasServer renewIp clearQueue stopWaiting''',
    'gamepad': 'isPadPressed padX padY wheel buttonWasPressed buttonIsPressed isConnected disconnect reset',
}
METHODS = {name: set(words.split()) for name, words in METHODS.items()}


def check(text):
  title = text.partition('\n')[0]
  tree = ast.parse(text)
  known = set(dir(builtins)) | set(METHODS)
  for node in ast.walk(tree):
    if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
      known.add(node.name)
    if isinstance(node, ast.arg):
      known.add(node.arg)
    if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
      known.add(node.id)
    if isinstance(node, ast.Import):
      known.update(alias.name for alias in node.names)
  for node in ast.walk(tree):
    if isinstance(node, ast.Name) and node.id not in known:
      print(title, 'line %d: nobody defines %s' % (node.lineno, node.id))
    if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in METHODS:
      if node.attr not in METHODS[node.value.id]:
        print(title, 'line %d: the official %s has no %s' % (node.lineno, node.value.id, node.attr))


for program in sys.stdin.read().split('\0'):
  check(program)
