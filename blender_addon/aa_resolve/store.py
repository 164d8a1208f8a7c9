# SPDX-License-Identifier: GPL-3.0-or-later
"""The shot's folder: records of finished work, claims of several processes, and shot.json made from them.

    SHOT/shot.json             rewritten after every step from the records of what is finished
    SHOT/frames, SHOT/truth    pictures
    SHOT/.aa/settings.json     what decides the content of every picture, and what all of them were asked to serve
    SHOT/.aa/frames/000001.json, SHOT/.aa/centre/..., SHOT/.aa/truth/...   one record per finished file
    SHOT/.aa/claims            who works on what

A picture is replaced (when passes are added to it) together with its record: the new record is written beside the old
one, the picture renamed, the record renamed. A process that dies in between leaves the old picture or the new one, and
in either case the record that belongs to it.
"""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import socket
import time
from dataclasses import dataclass, field
from typing import Callable, Iterator

from .errors import SceneError, UsageError
from .fingerprint import UNNAMED_SCENE, difference, reason_against
from .manifest import content_of

KINDS = ("frames", "centre", "truth")  # of pictures; each has a folder
_COMING = ".coming"  # ends the name of the record of a picture that is about to take its place
_RECORD = re.compile(rf"(-?[0-9]+)\.json(?:{re.escape(_COMING)})?")  # not what a system adds beside
_LAYOUT = 2  # of .aa: records that say which passes a picture holds


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


def _age(path: str) -> float:
    """Seconds since the file was written; since a clock may be set back, one of the future is as old as it is ahead."""
    return abs(time.time() - os.path.getmtime(path))


def _read_json(path: str) -> dict:
    try:
        with open(path, encoding="utf-8") as file:
            return json.load(file)
    except (OSError, ValueError) as error:
        raise SceneError(
            f"{path}: cannot be read ({error}); delete the shot folder and export again"
        ) from error


@dataclass
class Stored:
    """What a shot's folder holds."""

    content: dict  # what decides the content of every picture (Settings.fingerprint and the exporter's own)
    methods: list[str] = field(default_factory=list)  # that it was asked to serve, over all exports
    name: str = ""
    pattern: str = ""  # of the sub-samples, as shot.json states it
    records: dict[str, dict[int, dict]] = field(default_factory=dict)  # by kind and frame

    @property
    def first_frame(self) -> int:
        """The frame with which the jitter begins."""
        return self.content["first_frame"]

    def passes_of(self, kind: str) -> set[str]:
        """Passes of the shot: those of the first finished picture of a kind, as the resolver takes it."""
        records = self.records[kind]
        return set(records[min(records)]["passes"]) if records else set()


class Store:
    """One shot folder."""

    def __init__(self, folder: str, claim_timeout_seconds: float) -> None:
        self.folder = os.path.abspath(folder)
        self.private = os.path.join(self.folder, ".aa")
        self._settings = os.path.join(self.private, "settings.json")
        self._timeout = claim_timeout_seconds
        self._content: dict = {}  # of the export that this process joined
        self._identity = {"host": socket.gethostname(), "pid": os.getpid()}
        self._claimed: set[tuple[str, int]] = set()  # kinds and frames

    def stored(self) -> Stored | None:
        """What the folder holds, read without changing anything; None where no picture is finished.

        Raises UsageError for a folder that holds something else."""
        if not os.path.exists(self._settings):
            ours = os.path.isdir(self.private)
            if os.path.isdir(self.folder) and not ours and os.listdir(self.folder):
                raise UsageError(
                    f"--out: '{self.folder}' is not empty and holds no export; choose a new folder"
                )
            return None
        known = _read_json(self._settings)
        if known.get("layout") != _LAYOUT:
            raise UsageError(
                f"--out: '{self.folder}' holds an export of another version of the add-on; choose a new folder, or "
                "replace it with --overwrite"
            )
        records = {kind: self._records(kind) for kind in KINDS}
        if not any(records.values()):
            return None
        return Stored(known["content"], known["methods"], known["name"], known["pattern"], records)

    def _records(self, kind: str) -> dict[int, dict]:
        folder = os.path.join(self.private, kind)
        names = os.listdir(folder) if os.path.isdir(folder) else []
        numbers = {int(found[1]) for name in names if (found := _RECORD.fullmatch(name))}
        found = {number: self.record(kind, number) for number in sorted(numbers)}
        return {number: record for number, record in found.items() if record is not None}

    def changed(self, content: dict) -> str | None:
        """What differs from the content that the folder holds, in words; None where ``content`` can join it."""
        stored = self.stored()
        return reason_against(stored.content, content) if stored else None

    def refuse_other(self, content: dict) -> None:
        """Raises UsageError when the folder was made with settings that make other pictures."""
        changed = self.changed(content)
        if changed:
            raise UsageError(self.other_settings(changed))

    def other_settings(self, changed: str) -> str:
        """Why an export cannot join the shot."""
        way = "choose a new folder, or replace it with --overwrite"
        if changed == difference({"source": ""}, {"source": "another"}):
            way += ", or add --same-scene where no picture shows what changed"
        elif changed == UNNAMED_SCENE:
            way += ", or add --same-scene where it shows this one"
        return f"--out: '{self.folder}' holds an export with other settings: {changed}; {way}"

    def open(
        self, content: dict, methods: list[str], name: str, pattern: str | None, overwrite: bool
    ) -> None:
        """Makes the folder, or joins the export that lies there; ``pattern`` None keeps the one that it has.

        Raises UsageError when that was made with settings that make other pictures."""
        if overwrite and os.path.isdir(self.private):
            for folder in (*KINDS, ".aa"):
                shutil.rmtree(os.path.join(self.folder, folder), ignore_errors=True)
            with contextlib.suppress(FileNotFoundError):
                os.unlink(os.path.join(self.folder, "shot.json"))
        self.stored()  # refuses a folder of somebody else's before anything is made in it
        try:
            for folder in ("frames", "truth", *(f".aa/{kind}" for kind in (*KINDS, "claims"))):
                os.makedirs(os.path.join(self.folder, folder), exist_ok=True)
        except OSError as error:
            raise SceneError(f"--out: '{self.folder}' cannot be made: {error.strerror}") from error
        with self.locked():
            self._remove_leftovers()
            if not self._is_begun():
                known = {"layout": _LAYOUT, "content": content, "methods": [], "pattern": ""}
            else:
                known = _read_json(self._settings)
                changed = reason_against(known["content"], content)
                if changed:
                    raise UsageError(self.other_settings(changed))
                known["content"]["static"] = content["static"]
            known["methods"] = list(dict.fromkeys([*known["methods"], *methods]))
            known["name"] = name or known.get("name") or os.path.basename(self.folder)
            known["pattern"] = pattern or known["pattern"]
            write_json(self._settings, known)
            self._content = content

    def _is_begun(self) -> bool:
        """True when a picture is finished, or a living process makes one: then its settings hold for all others."""
        if not os.path.exists(self._settings):
            return False
        if self.stored() is not None:
            return True
        claims = os.path.join(self.private, "claims")
        return any(
            not self._is_abandoned(os.path.join(claims, name)) for name in os.listdir(claims)
        )

    def abandon(self) -> None:
        """Gives back what this process has begun, its claims and its half-written files, for good: the lock is kept until
        the process ends, so that another thread of it begins nothing more."""
        if not os.path.isdir(self.private):
            return
        self._end = self.locked()
        self._end.__enter__()
        for kind, frame in sorted(self._claimed):
            self.release(kind, frame)
        for path, _, names in os.walk(self.folder):
            for name in names:
                if name.endswith(f".{os.getpid()}.tmp"):
                    with contextlib.suppress(OSError):
                        os.unlink(os.path.join(path, name))

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
                    if not alive or _age(leftover) > self._timeout:
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
            age = _age(path)
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

    def claim(self, kind: str, frame: int, lacks: Callable[[dict | None], bool]) -> bool:
        """Takes a piece of work unless its record (None: no picture yet) lacks nothing or a living process has it.

        Raises UsageError when another process has begun an export with other settings in this folder meanwhile.
        """
        with self.locked():
            changed = difference(self._content, _read_json(self._settings)["content"])
            if changed:
                raise UsageError(self.other_settings(changed))
            if not lacks(self.record(kind, frame)):
                return False
            os.makedirs(os.path.join(self.folder, kind), exist_ok=True)
            path = self._claim_path(kind, frame)
            if os.path.exists(path) and not self._is_abandoned(path):
                return False
            self._claimed.add((kind, frame))
            write_json(path, self._identity)
            return True

    def release(self, kind: str, frame: int) -> None:
        """Gives a claim back, and removes what was not finished."""
        for path in (self.unfinished(kind, frame), self._claim_path(kind, frame)):
            with contextlib.suppress(FileNotFoundError):
                os.unlink(path)
        self._claimed.discard((kind, frame))

    def picture(self, kind: str, frame: int) -> str:
        """Path of a picture file relative to the shot."""
        return f"{kind}/{frame:06d}.exr"

    def unfinished(self, kind: str, frame: int) -> str:
        """Path under which a picture is made; ``finish`` gives it its name."""
        return os.path.join(self.folder, f"{self.picture(kind, frame)}.{os.getpid()}.tmp")

    def _record_path(self, kind: str, frame: int) -> str:
        return os.path.join(self.private, kind, f"{frame:06d}.json")

    def record(self, kind: str, frame: int) -> dict | None:
        """The record of a finished picture that is still complete, else None."""
        try:
            size = os.path.getsize(os.path.join(self.folder, self.picture(kind, frame)))
        except OSError:
            return None
        path = self._record_path(kind, frame)
        for candidate in (path, path + _COMING):
            if os.path.exists(candidate):
                record = _read_json(candidate)
                if record.get("file_bytes") == size:
                    return record
        return None

    def finish(self, kind: str, frame: int, record: dict, head: dict) -> int:
        """Puts a picture that was made under ``unfinished`` in its place, notes it and brings shot.json up to date;
        returns its bytes."""
        made, path = self.unfinished(kind, frame), self._record_path(kind, frame)
        record = {**record, "file_bytes": os.path.getsize(made)}
        with self.locked():
            old = self.record(kind, frame)
            if old is not None:
                write_json(path, old)  # where it was the coming one of a process that died
            write_json(path + _COMING, record)
            try:
                os.replace(made, os.path.join(self.folder, self.picture(kind, frame)))
                os.replace(path + _COMING, path)
            except OSError as error:
                raise SceneError(f"{path}: cannot be written: {error.strerror}") from error
            self.release(kind, frame)
            self.write_manifest(head)
        return record["file_bytes"]

    def write_manifest(self, head: dict) -> None:
        """shot.json from the records of all finished frames, if there are any. Call it under the lock."""
        stored = self.stored()
        content = content_of(stored, head) if stored else None
        if content is not None:
            write_json(os.path.join(self.folder, "shot.json"), content)
