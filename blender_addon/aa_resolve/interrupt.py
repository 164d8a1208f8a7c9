# SPDX-License-Identifier: GPL-3.0-or-later
"""Ctrl-C and a request to terminate end an export at once, whatever Blender is doing, and leave a valid shot.

Blender's own Ctrl-C only asks a running render to stop: between two renders it is forgotten, and Cycles looks for it
after a step of its work, which takes minutes when there are many samples. A handler in Python would wait for the render
as well, because it runs between two instructions of the main thread. So the signal's number goes through a socket to a
thread, which runs while Cycles renders.
"""

from __future__ import annotations

import os
import shutil
import signal
import socket
import sys
import threading
from typing import Callable

import bpy

from .errors import Cancelled

_SIGNALS = (signal.SIGINT, signal.SIGTERM)

_clean_up: list[Callable[[], None]] = []
_sockets: list[socket.socket] = []
_leaving = threading.Event()


def watch() -> None:
    """From now on these signals end the process with ``Cancelled``'s exit code and one line. Main thread only."""
    if _sockets:
        return
    receiver, sender = socket.socketpair()
    sender.setblocking(False)
    _sockets.extend((receiver, sender))  # kept open, and so alive, until the process ends
    signal.set_wakeup_fd(sender.fileno(), warn_on_full_buffer=False)
    for number in _SIGNALS:
        signal.signal(number, lambda *_: None)  # the system's default would end the process itself
    threading.Thread(target=_wait, args=(receiver,), daemon=True).start()


def before_leaving(action: Callable[[], None]) -> None:
    """Adds something to do when a signal ends the process; it runs beside the main thread."""
    _clean_up.append(action)


def give_way() -> None:
    """To be called on the way out of a failure: where a signal is ending the process, nothing else is said."""
    if _leaving.is_set():
        threading.Event().wait()


def _wait(receiver: socket.socket) -> None:
    while receiver.recv(1)[0] not in _SIGNALS:
        pass
    _leaving.set()
    try:
        for action in _clean_up:
            action()
        shutil.rmtree(bpy.app.tempdir, ignore_errors=True)
        print(f"error: {Cancelled()}", file=sys.stderr, flush=True)
    finally:
        os._exit(Cancelled.exit_code)  # the main thread may be inside a render for minutes
