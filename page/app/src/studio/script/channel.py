"""The way of a judged Python program to its judge in a browser: a call for each question.

The module `trik_link` is the page's: it has the call and what the program begins with.
"""

import _thread
import errno

import trik_link

# Numbers of failures are those of Linux on the way, and others here.
ERRNO = {'2': errno.ENOENT, '11': errno.EAGAIN}


class Channel:
    """Questions and answers of the judge."""

    def send(self, word, text=''):
        self.ask(word, text)

    def ask(self, word, text):
        told = trik_link.ask(word, text)
        if told == 'over':
            # The run is decided, and the page ends this Worker.
            raise SystemExit
        kind, at, answer = told.split(':', 2)
        if kind == 'ok':
            return told
        number, _, reason = answer.partition(':')
        return '%s:%s:%d:%s' % (kind, at, ERRNO.get(number, errno.EIO), reason)

    def end(self, code):
        trik_link.ask('end', code)


channel = Channel()


def setting():
    """The module trik, the path and text of the program, the seed, and whether somebody looks on."""
    return trik_link.module, trik_link.path, trik_link.program, trik_link.seed, True


def no_threads(*_):
    raise RuntimeError('a program has one thread in the browser; on a robot and under trik check it may have more')


_thread.start_new_thread = no_threads
