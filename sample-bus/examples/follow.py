#!/usr/bin/env python3
"""Prints every event of a node, with a note where some were missed: follow.py MOUNTPOINT NODE [COUNT].

Needs nothing but Python. Copy the class into your program.
"""
import errno
import mmap
import os
import re
import struct
import sys
import time


class Samples:
    """The events of one node in shared memory; docs/user/sample-bus.md explains the numbers."""

    def __init__(self, mountpoint, node):
        def name(path):
            plain = re.compile(rb'[A-Za-z0-9._/-]')
            pieces = (bytes([byte]) for byte in os.fsencode(path))
            escaped = b''.join(piece if plain.match(piece) else b'%%%02X' % ord(piece) for piece in pieces)
            return escaped.replace(b'/', b'+')
        mountpoint = os.path.realpath(mountpoint)
        folder = b'/dev/shm/trikfs' + name(mountpoint)
        if os.lstat(folder).st_uid != os.stat(mountpoint).st_uid:
            raise PermissionError(errno.EACCES, 'not of the owner of the tree', os.fsdecode(folder))
        self.path = os.fsdecode(folder + b'/' + name(node))
        # A node is sampled while somebody has its value open; an attribute is a file itself. First, so that what the ring
        # has is new.
        for value in os.path.join(mountpoint, node, 'value'), os.path.join(mountpoint, node):
            try:
                self.value = open(value, 'rb', buffering=0)
                break
            except OSError:
                self.value = None
        with open(self.path, 'rb') as file:
            found = os.fstat(file.fileno())
            self.file = (found.st_dev, found.st_ino)
            self.memory = mmap.mmap(file.fileno(), 0, prot=mmap.PROT_READ)
        magic, self.header, self.slot_bytes, self.slots, self.tuple_bytes = struct.unpack_from('=8s4I', self.memory)
        if magic != b'TRIKSMP1' or self.header + self.slots * self.slot_bytes > len(self.memory):
            raise ValueError('not a ring of samples')
        self.last = 0

    def _number(self, at):
        return struct.unpack_from('=I', self.memory, at)[0]

    def get(self, sequence):
        """(sequence, time in ns, bytes), or None if the event is not there. A failure raises OSError."""
        at = self.header + (sequence & (self.slots - 1)) * self.slot_bytes
        begin, end, size, error, time_ns = struct.unpack_from('=IIIiQ', self.memory, at)
        data = self.memory[at + 32:at + 32 + min(size, self.tuple_bytes)]
        if sequence == 0 or end != sequence or self._number(at) != sequence or begin != sequence:
            return None
        if error:
            raise OSError(error, os.strerror(error))
        return sequence, time_ns, data

    def newest(self):
        """The newest value, never one that is too old; None if there is none yet."""
        stale_ms, state, newest = struct.unpack_from('=3I', self.memory, 24)
        if state:
            raise OSError(errno.ESTALE, 'the node is gone')
        event = self.get(newest)
        if event and stale_ms and time.monotonic_ns() - event[1] > stale_ms * 1_000_000:
            raise TimeoutError(errno.ETIMEDOUT, 'the newest sample is too old')
        return event

    def next(self):
        """(events missed, event or None): what comes after the last one."""
        newest, kept, missed = self._number(32), self.slots - 1, 0
        following = (self.last + 1) % (1 << 32) or 1
        if newest in (0, self.last):
            return 0, None
        if (newest - following) % (1 << 32) >= kept:
            oldest = (newest - kept + 1) % (1 << 32) or 1
            missed = (oldest - following) % (1 << 32) if self.last else 0
            following = oldest
        self.last = following - 1
        try:
            event = self.get(following)
        except OSError:
            self.last = following
            raise
        if event:
            self.last = following
        return missed, event

    def is_current(self):
        """Whether this is still the node's ring; ask when nothing has come for a while."""
        try:
            found = os.stat(self.path)
        except OSError:
            return False
        return self._number(28) == 0 and (found.st_dev, found.st_ino) == self.file


def follow(mountpoint, node, left):
    samples, idle_ms = Samples(mountpoint, node), 0
    while left != 0:
        try:
            missed, event = samples.next()
        except OSError as error:
            print(samples.last, 'error', error.strerror, flush=True)
            left -= 1
            continue
        if missed:
            print('missed', missed)
        if event:
            print(event[0], event[1], event[2][:16].hex(), flush=True)
            left, idle_ms = left - 1, 0
            continue
        idle_ms += 1
        if idle_ms % 100 == 0 and not samples.is_current():
            sys.exit(f'{node}: gone')
        time.sleep(0.001)


def main():
    if len(sys.argv) < 3:
        sys.exit('usage: follow.py MOUNTPOINT NODE [COUNT]')
    try:
        follow(sys.argv[1], sys.argv[2], int((sys.argv + ['-1'])[3]))
    except (OSError, ValueError) as error:
        sys.exit(f'{sys.argv[2]}: {error}')


if __name__ == '__main__':
    main()
