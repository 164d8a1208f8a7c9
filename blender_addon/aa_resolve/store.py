# SPDX-License-Identifier: GPL-3.0-or-later
"""The shot's folder: records of finished work, claims of several processes, and shot.json made from them.

    SHOT/shot.json             rewritten after every step from the records of what is finished
    SHOT/frames, SHOT/truth    pictures
    SHOT/.aa/settings.json     fingerprint of the export
    SHOT/.aa/frames/000001.json, SHOT/.aa/truth/000001.json   one record per finished file
    SHOT/.aa/claims            who works on what
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import socket
import time
from typing import Iterator

from .errors import SceneError, UsageError
from .fingerprint import difference
from .manifest import content_of


def write_json(path: str, content: dict) -> None:
    """Writes under a temporary name and renames; one line per member of the top level."""
    temporary = f"{path}.{os.getpid()}.tmp"
    try:
        with open(temporary, "w", encoding="utf-8") as file:
            file.write(_layout(content))
        os.replace(temporary, path)
    except OSError as error:
        with contextlib.suppress(OSError):
            os.unlink(temporary)
        raise SceneError(f"{path}: cannot be written: {error.strerror}") from error


def _layout(content: dict) -> str:
    lines = []
    for key, value in content.items():
        if isinstance(value, list) and value and isinstance(value[0], dict):
            inner = ",\n".join("    " + json.dumps(item, ensure_ascii=False) for item in value)
            lines.append(f"  {json.dumps(key)}: [\n{inner}\n  ]")
        else:
            lines.append(f"  {json.dumps(key)}: {json.dumps(value, ensure_ascii=False)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


def _read_json(path: str) -> dict:
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise SceneError(
            f"{path}: cannot be read ({error}); delete the shot folder and export again"
        ) from error


class Store:
    """One shot folder."""

    def __init__(self, folder: str, claim_timeout_seconds: float) -> None:
        self.folder = os.path.abspath(folder)
        self.private = os.path.join(self.folder, ".aa")
        self._timeout = claim_timeout_seconds
        self._identity = {"host": socket.gethostname(), "pid": os.getpid()}

    def open(self, fingerprint: dict, overwrite: bool) -> None:
        """Makes the folder, or checks that what lies there was made with the same settings."""
        settings = os.path.join(self.private, "settings.json")
        if overwrite and os.path.isdir(self.private):
            for name in ("frames", "centre", "truth", ".aa"):
                shutil.rmtree(os.path.join(self.folder, name), ignore_errors=True)
            with contextlib.suppress(FileNotFoundError):
                os.unlink(os.path.join(self.folder, "shot.json"))
        if (
            os.path.isdir(self.folder)
            and not os.path.isdir(self.private)
            and os.listdir(self.folder)
        ):
            raise UsageError(
                f"--out: '{self.folder}' is not empty and holds no export; choose a new folder"
            )
        try:
            for name in ("frames", "truth", ".aa/frames", ".aa/centre", ".aa/truth", ".aa/claims"):
                os.makedirs(os.path.join(self.folder, name), exist_ok=True)
        except OSError as error:
            raise SceneError(f"--out: '{self.folder}' cannot be made: {error.strerror}") from error
        with self.locked():
            self._remove_leftovers()
            if not os.path.exists(settings):
                write_json(settings, fingerprint)
                return
            changed = difference(_read_json(settings), fingerprint)
        if changed:
            raise UsageError(
                f"--out: '{self.folder}' holds an export with other settings: {changed}; "
                "choose a new folder, or replace it with --overwrite"
            )

    def _remove_leftovers(self) -> None:
        """Half-written files of processes that died here; a file of another machine goes after the time-out."""
        for path, _, names in os.walk(self.folder):
            for name in names:
                owner = name.split(".")[-2:-1]
                if not name.endswith(".tmp") or not owner[0].isdigit():
                    continue
                leftover = os.path.join(path, name)
                with contextlib.suppress(OSError):
                    alive = os.path.exists(f"/proc/{owner[0]}") or not os.path.isdir("/proc")
                    if not alive or time.time() - os.path.getmtime(leftover) > self._timeout:
                        os.unlink(leftover)

    @contextlib.contextmanager
    def locked(self) -> Iterator[None]:
        """Only one process at a time; the system frees the lock of a process that dies."""
        with open(os.path.join(self.private, "lock"), "a+", encoding="utf-8") as file:
            if os.name == "nt":
                import msvcrt

                file.seek(0)
                while True:
                    with contextlib.suppress(OSError):
                        msvcrt.locking(file.fileno(), msvcrt.LK_LOCK, 1)
                        break
            else:
                import fcntl

                fcntl.flock(file, fcntl.LOCK_EX)
            yield

    def _claim_path(self, kind: str, frame: int) -> str:
        return os.path.join(self.private, "claims", f"{kind}-{frame:06d}.json")

    def _is_abandoned(self, path: str) -> bool:
        try:
            with open(path, encoding="utf-8") as file:
                owner = json.load(file)
            age = time.time() - os.path.getmtime(path)
        except (OSError, ValueError):
            return True
        if owner.get("host") == self._identity["host"] and os.name != "nt":
            try:
                os.kill(owner["pid"], 0)
            except ProcessLookupError:
                return True
            except PermissionError:
                pass
            return owner["pid"] == self._identity["pid"]
        return age > self._timeout

    def claim(self, kind: str, frame: int) -> bool:
        """Takes a piece of work unless it is finished or a living process has it."""
        with self.locked():
            if self.record(kind, frame) is not None:
                return False
            os.makedirs(os.path.join(self.folder, kind), exist_ok=True)
            path = self._claim_path(kind, frame)
            if os.path.exists(path) and not self._is_abandoned(path):
                return False
            write_json(path, self._identity)
            return True

    def release(self, kind: str, frame: int) -> None:
        """Gives a claim back."""
        with contextlib.suppress(FileNotFoundError):
            os.unlink(self._claim_path(kind, frame))

    def picture(self, kind: str, frame: int) -> str:
        """Path of a picture file relative to the shot."""
        return f"{kind}/{frame:06d}.exr"

    def record(self, kind: str, frame: int) -> dict | None:
        """The record of a finished piece of work whose picture is still complete, else None."""
        path = os.path.join(self.private, kind, f"{frame:06d}.json")
        picture = os.path.join(self.folder, self.picture(kind, frame))
        if not os.path.exists(path) or not os.path.exists(picture):
            return None
        record = _read_json(path)
        return record if record.get("file_bytes") == os.path.getsize(picture) else None

    def finish(self, kind: str, frame: int, record: dict, head: dict, frames: list[int]) -> None:
        """Notes a piece of work as finished and brings shot.json up to date."""
        picture = os.path.join(self.folder, self.picture(kind, frame))
        record = {**record, "file_bytes": os.path.getsize(picture)}
        with self.locked():
            write_json(os.path.join(self.private, kind, f"{frame:06d}.json"), record)
            self.release(kind, frame)
            self.write_manifest(head, frames)

    def write_manifest(self, head: dict, frames: list[int]) -> None:
        """shot.json from the records of all finished frames. Call it under the lock."""
        write_json(os.path.join(self.folder, "shot.json"), content_of(self, head, frames))
