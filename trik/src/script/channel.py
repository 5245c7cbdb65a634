"""The way of a judged Python program to its judge: frames over standard input."""

import os
import socket

# The channel is standard input; nobody else shall read it or print into it.
link_fd = os.dup(0)
null = os.open(os.devnull, os.O_RDWR)
for number in (0, 1, 2):
    os.dup2(null, number)
os.close(null)
os.register_at_fork(after_in_child=lambda: os.close(link_fd))


class Channel:
    """Frames to and from the judge."""

    def __init__(self):
        self.socket = socket.socket(fileno=link_fd)
        self.buffer = b''

    def send(self, word, text=''):
        payload = (word + ':' + text).encode('utf-8', 'replace')
        try:
            self.socket.sendall(b'%d:%s' % (len(payload), payload))
        except OSError:
            os._exit(1)

    def receive(self):
        while True:
            head, colon, rest = self.buffer.partition(b':')
            if colon and len(rest) >= int(head):
                frame, self.buffer = rest[:int(head)], rest[int(head):]
                return frame.decode('utf-8', 'replace')
            try:
                piece = self.socket.recv(65536)
            except OSError:
                piece = b''
            if not piece:
                os._exit(1)
            self.buffer += piece

    def ask(self, word, text):
        self.send(word, text)
        return self.receive()

    def end(self, code):
        self.send('end', code)
        self.receive()


channel = Channel()


def setting():
    """The module trik, the path and text of the program, the seed, and whether somebody looks on."""
    module = channel.receive()
    path, _, program = channel.receive().partition('\n')
    return module, path, program, int(channel.receive()), channel.receive() == '1'
