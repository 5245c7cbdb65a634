"""Goes to the wall ahead and stops 20 cm before it: python3 wall.py [TREE]"""

import os
import signal
import sys
import time

TREE = sys.argv[1] if len(sys.argv) > 1 else os.environ.get('TRIK_TREE', '/trikfs')

# Motors that stay open until the program ends come to rest then, also after Ctrl-C.
LEFT = os.open(TREE + '/motors/left/value', os.O_WRONLY)
RIGHT = os.open(TREE + '/motors/right/value', os.O_WRONLY)
signal.signal(signal.SIGINT, signal.SIG_DFL)


def drive(left, right):
    os.write(LEFT, b'%d' % left)
    os.write(RIGHT, b'%d' % right)


def read_number(name):
    with open(TREE + '/' + name) as file:
        return int(file.read())


while True:
    try:
        power = (read_number('sensors/front/value') - 20) * 2
        if power == 0:
            break
        power = max(-30, min(30, power))
        drive(power, power)
    except OSError:
        # No echo: nobody knows how far the wall is.
        drive(0, 0)
    time.sleep(0.02)
drive(0, 0)
