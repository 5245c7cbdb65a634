"""Drives a square of 30 cm by its encoders: python3 square.py [TREE]"""

import os
import signal
import sys
import time

TREE = sys.argv[1] if len(sys.argv) > 1 else os.environ.get('TRIK_TREE', '/trikfs')

# Degrees of a wheel of 56 mm for 300 mm ahead, and for a quarter of a turn with wheels 155 mm apart.
SIDE = 614
CORNER = 249

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


def read_wheels():
    return read_number('encoders/left/value'), read_number('encoders/right/value')


def power_for(missing):
    """The power that brings a wheel nearer to its goal."""
    return max(-30, min(30, int(missing / 5)))


def turn_wheels(left_degrees, right_degrees):
    """Turns the wheels by so many degrees. Goals grow from leg to leg, so small errors do not add up."""
    global left_goal, right_goal
    left_goal += left_degrees
    right_goal += right_degrees
    while True:
        left, right = read_wheels()
        left_power, right_power = power_for(left_goal - left), power_for(right_goal - right)
        drive(left_power, right_power)
        if left_power == 0 and right_power == 0:
            return
        time.sleep(0.02)


left_goal, right_goal = read_wheels()
for _ in range(4):
    turn_wheels(SIDE, SIDE)
    turn_wheels(-CORNER, CORNER)
