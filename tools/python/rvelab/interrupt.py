"""Ctrl-C in a long call of the library. Python notes a signal at once, but runs its handler after the call: a second
thread reads Python's wake-up descriptor and interrupts the call."""
from __future__ import annotations

import contextlib
import os
import signal
import socket
import threading
from ctypes import c_void_p
from threading import get_ident
from time import monotonic
from typing import Any

from .library import call, functions, library, tell

_lock = threading.Lock()
_main = threading.main_thread().ident
_working: c_void_p | None = None  # the pool in use by the main thread
_told = False  # that pool was interrupted
_ends: tuple[socket.socket, socket.socket] | None = None
_theirs: int | None = None  # the descriptor of an event loop, restored after the call
_look_at = 0.0  # s, time of the next check of the descriptor, which takes as long as a short call


def _watch(received: socket.socket) -> None:
    global _told
    while signals := received.recv(64):
        if _theirs is not None:
            with contextlib.suppress(OSError):
                os.write(_theirs, signals)
        if signal.SIGINT in signals and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
            with _lock:
                pool = _working
                if pool is not None:
                    _told = True  # from here on the end of the call waits for what follows
                    if _working is pool:
                        library.rvelab_interrupt(pool, 1)


def _go_on(pool: c_void_p) -> None:
    global _told
    with _lock:
        library.rvelab_interrupt(pool, 0)
        _told = False


def _listen() -> None:
    global _ends, _theirs, _look_at
    if _ends is None:
        _ends = socket.socketpair()
        _ends[1].setblocking(False)
        threading.Thread(target=_watch, args=_ends[:1], name="rvelab: Ctrl-C", daemon=True).start()
    try:
        before = signal.set_wakeup_fd(_ends[1].fileno(), warn_on_full_buffer=False)
    except ValueError:  # an interpreter that takes no signals
        before = -1
    if before in (-1, _ends[1].fileno()):
        _look_at = monotonic() + 0.002
    else:
        _theirs = before


def _in_child() -> None:
    global _lock, _main, _working, _told, _ends, _theirs, _look_at
    if _ends is not None:
        signal.set_wakeup_fd(-1)  # the one of the parent
        for end in _ends:
            end.close()
    _lock, _main, _working, _told, _ends = threading.Lock(), get_ident(), None, False, None
    _theirs, _look_at = None, 0.0


os.register_at_fork(after_in_child=_in_child)


def long_call(name: str, pool: c_void_p, *arguments: Any, batch: Any = None, result: Any = None) -> None:
    """library.call for calls that may be long. Of the main thread Ctrl-C ends them with KeyboardInterrupt, unless the
    program has a handler of its own for SIGINT, which runs when the call has ended."""
    global _working, _theirs
    if get_ident() != _main:
        return call(name, pool, *arguments, batch=batch, result=result)
    if monotonic() > _look_at:
        _listen()
    _working = pool
    try:
        status = functions[name](pool, *arguments)
    finally:
        _working = None
        if _told:
            _go_on(pool)
        if _theirs is not None:
            signal.set_wakeup_fd(_theirs)
            _theirs = None
    if status != 0:
        tell(status, name, pool, result if batch is None else batch, batch)
