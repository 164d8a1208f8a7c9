# SPDX-License-Identifier: GPL-3.0-or-later
"""Work in child processes for the panel: the export on a copy of the open file, then the resolver.

Nothing here blocks and nothing here touches the scene: a thread reads what a child prints, ``poll`` hands it out.
"""

from __future__ import annotations

import json
import os
import queue
import re
import shutil
import signal
import subprocess
import tempfile
import threading
from collections.abc import Callable
from dataclasses import dataclass, field

import bpy

from ..identity import file_identity
from ..options import as_labels
from ..scene.simulations import link_caches
from ..settings import Settings
from . import trust

_ROOM = os.path.dirname(os.path.abspath(__file__))
HEADLESS = os.path.join(os.path.dirname(_ROOM), "headless.py")
_NAME_OF_COPY = "scene"
_SHOW_IMAGES = {"MATERIAL", "NODETREE", "WORLD", "LIGHT", "TEXTURE"}  # of Blender's kinds of data
_PATIENCE_SECONDS = 1.0  # for a child that is asked to end


@dataclass
class Step:
    """One command of a job, with the sentence that is shown while it runs. What depends on the steps before is asked when
    its turn comes, and raises RuntimeError where there is nothing to run."""

    title: str
    command: list[str] | Callable[[], list[str]]


@dataclass
class Job:
    """Commands that run one after the other; a failure or ``cancel`` ends the chain.

    ``finish`` is called once after the last step went well and returns the sentence that the panel then shows.
    """

    steps: list[Step]
    folder: str
    finish: Callable[[Job], str] = lambda finished: finished.message
    done: int = 0
    total: int = 0
    message: str = ""
    error: str = ""
    cancelled: bool = False
    notes: list[str] = field(default_factory=list)
    _process: subprocess.Popen | None = None
    _lines: queue.Queue = field(default_factory=queue.Queue)
    _errors: list[str] = field(default_factory=list)
    _readers: list[threading.Thread] = field(default_factory=list)

    def start(self) -> None:
        """Begins with the first step."""
        self._launch()

    def _launch(self) -> None:
        step = self.steps[0]
        self.message = step.title
        self.done = self.total = 0
        self._errors = []
        try:
            command = step.command() if callable(step.command) else step.command
        except RuntimeError as error:
            self.error = str(error)
            return
        try:
            process = subprocess.Popen(
                command,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                encoding="utf-8",
                errors="replace",
            )
        except OSError as error:
            self.error = f"{command[0]}: cannot be started: {error.strerror}"
            return
        self._process = process
        self._readers = [
            threading.Thread(target=_drain, args=(stream, target), daemon=True)
            for stream, target in (
                (process.stdout, self._lines.put),
                (process.stderr, self._errors.append),
            )
        ]
        for reader in self._readers:
            reader.start()

    def poll(self) -> bool:
        """Takes in what happened since the last call; False when everything is over."""
        ended = self._process is not None and self._process.poll() is not None
        if ended:
            for reader in self._readers:  # what the child said last
                reader.join(timeout=1.0)
        while True:
            try:
                self._take(self._lines.get_nowait())
            except queue.Empty:
                break
        if self.error:
            return self._end()
        if not ended:
            return self._process is not None
        if self._process.returncode != 0:
            self.error = as_labels(self._why_failed(self._process.returncode), Settings)
            return self._end()
        self.steps.pop(0)
        if not self.steps:
            try:
                self.message = self.finish(self)
            except (RuntimeError, OSError, ValueError) as error:
                self.error = str(error)
            return self._end()
        self._launch()
        return True

    def _why_failed(self, code: int) -> str:
        """The child's own last word, or what became of it."""
        title = self.steps[0].title
        if code < 0:  # whatever it said before was not of its end
            return f"{title}: {_ended_by(-code)}; finished frames are valid"
        told = [line.strip() for line in self._errors if line.strip()]
        said = [line for line in told if line.startswith("error")] or told[-1:]
        return re.sub(r"^error: ", "", said[-1]) if said else f"{title}: ended with code {code}"

    def _take(self, line: str) -> None:
        if not line.startswith("{"):
            return
        try:
            event = json.loads(line)
        except ValueError:
            return
        kind = event.get("event")
        if kind in ("frame", "centre", "truth"):
            self.done += 1
            self.total = self.done + event["remaining"]
        if kind == "note":
            self.notes.append(as_labels(event["note"], Settings))
        if "text" in event:
            self.message = event["text"]

    @property
    def fraction(self) -> float:
        """Share of the current step's pictures that are finished, 0 to 1."""
        return self.done / self.total if self.total else 0.0

    def cancel(self) -> None:
        """Ends the running child. Finished frames stay valid, an export resumes."""
        self.cancelled = True
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(timeout=_PATIENCE_SECONDS)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._end()

    def _end(self) -> bool:
        shutil.rmtree(self.folder, ignore_errors=True)
        return False


def _ended_by(number: int) -> str:
    """What a signal means for a process that it ended, in words."""
    known = {item.value: item.name for item in signal.Signals}
    name = known.get(number, f"signal {number}")
    if name == "SIGKILL":
        return f"was killed from outside ({name}), as the system does where memory is short"
    if name in ("SIGTERM", "SIGINT", "SIGHUP"):
        return f"was stopped from outside ({name})"
    return f"the program crashed ({name})"


def _drain(stream, target) -> None:
    for line in stream:
        target(line)
    stream.close()


def unsaved_images() -> list[str]:
    """Names of images of the scene whose pixels a copy of the file lacks: they were painted and neither saved nor packed."""
    painted = {image for image in bpy.data.images if image.is_dirty}
    if not painted:
        return []
    users = bpy.data.user_map(subset=painted, value_types=_SHOW_IMAGES)
    return sorted(image.name for image in painted if users[image])


def copy_of_open_file() -> tuple[str, str]:
    """Saves a copy of the open scene, changed or not, beside nothing of the user's; returns folder and path.

    Disk caches of simulations lie beside a file, in a folder of its name: the copy is shown the way to them.
    """
    folder = tempfile.mkdtemp(prefix="aa_resolve_")
    path = os.path.join(folder, f"{_NAME_OF_COPY}.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path, copy=True, check_existing=False)
    link_caches(bpy.data.filepath, path)
    return folder, path


def has_unsaved_changes() -> bool:
    """True when the open file is not what lies on disk. Without a window there is nobody to change it but scripts, whose
    changes Blender does not notice, and 4.3 calls every file changed."""
    return not bpy.data.filepath or bpy.data.is_dirty and not bpy.app.background


def identity_of_open_file() -> str | None:
    """Identity by which an export resumes: the content of the saved file; None while changes are unsaved.

    Without one the copy's own bytes decide, which differ each time: a scene that may have changed never continues an
    old export unnoticed."""
    path = bpy.data.filepath
    if not has_unsaved_changes() and os.path.exists(path):
        return file_identity(path)
    return None


def script_command(blend: str, script: str, words: list[str]) -> list[str]:
    """Command line of a child that opens ``blend`` and runs a script of the add-on."""
    command = [bpy.app.binary_path, "-b"]
    if trust.runs_scripts():
        command.append("--enable-autoexec")
    return [*command, blend, "--python-exit-code", "9", "-P", script, "--", *words]


def export_command(blend: str, options: list[str]) -> list[str]:
    """Command line of a child that exports ``blend``."""
    return script_command(blend, HEADLESS, [*options, "--json"])
