"""Follows a dark line on a bright floor until Ctrl-C: python3 line.py [TREE]"""

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
    # The sensors look at the floor beside the line; the one that sees the line has the larger number.
    left = read_number('sensors/floor_left/value')
    right = read_number('sensors/floor_right/value')
    turn = (left - right) // 4
    drive(20 - turn, 20 + turn)
    time.sleep(0.02)
