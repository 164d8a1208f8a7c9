# SPDX-License-Identifier: MIT
"""A study of scenes x frames x methods as its configuration describes it; what the workflow's rules need of it.

Every mistake is a BadStudy of one line: the key, what was expected, what was found.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

SCENES = Path(__file__).resolve().parents[1]
JOBS = ("scene", "export", "truth", "run", "pages")  # kinds of job, each with its needs
_NEEDS = ("threads", "memory_mb", "minutes")
_OF_A_SCENE = (
    "frames", "frames_per_job", "size", "samples", "truth_samples", "truth_frames", "methods", "export", "run",
)  # fmt: skip
_OF_ALL = ("out", "scenes", "claim_timeout", "jobs")


class BadStudy(Exception):
    """What is wrong with the configuration."""


@dataclass(frozen=True)
class Entry:
    """One scene of the study."""

    name: str  # of its folder
    scene: str
    flags: tuple[str, ...]
    frames: tuple[int, ...]
    frames_per_job: int
    size: str
    samples: int
    truth_samples: int
    truth_frames: tuple[int, ...] | None  # None: all
    methods: tuple[str, ...]
    export: tuple[str, ...]
    run: tuple[str, ...]

    def parts(self) -> list[str]:
        """The frames, a job's at a time."""
        step = self.frames_per_job
        return [_in_words(self.frames[i : i + step]) for i in range(0, len(self.frames), step)]

    def parts_with_truth(self) -> list[str]:
        """Those of them of which some frames are to have truth."""
        wanted = {*self.frames} if self.truth_frames is None else {*self.truth_frames}
        return [part for part in self.parts() if wanted & {*numbers(part)}]

    def export_words(self, frames: str, with_truth: bool) -> list[str]:
        """Options of the exporter for some of the frames, without its folder."""
        ids = dict.fromkeys(m.split("+")[0] for m in self.methods)
        fills = [w for m in self.methods for w in m.split("+")[1:] if w.startswith("fill=")]
        ids.update(dict.fromkeys(w.removeprefix("fill=") for w in fills))
        words = ["--for", ",".join(ids), "--name", self.name, "--resolution", self.size]
        words += ["--frames", frames, "--samples", str(self.samples)]
        wanted = [n for n in numbers(frames) if self.truth_frames is None or n in self.truth_frames]
        if with_truth and wanted:
            words += [
                "--truth-frames",
                _in_words(wanted),
                "--truth-samples",
                str(self.truth_samples),
            ]
        else:
            words += ["--truth-frames", "none"]
        return [*words, *self.export]

    def run_words(self) -> list[str]:
        """Options of `aaresolve run`, without its folders."""
        return [word for m in self.methods for word in ("-m", m)] + list(self.run)


@dataclass(frozen=True)
class Study:
    """All of it."""

    out: str
    claim_timeout: float
    entries: dict[str, Entry]  # by name
    jobs: dict[str, dict[str, int]]


def check_tables(config: Mapping) -> None:
    """Before Snakemake puts the user's tables and ours together, and fails in its own words where one is none."""
    jobs = config.get("jobs", {})
    kinds = jobs.items() if isinstance(jobs, Mapping) else ()
    for where, value in (("jobs", jobs), *((f"jobs, {kind}", needs) for kind, needs in kinds)):
        if not isinstance(value, Mapping):
            raise BadStudy(f"{where}: expected a table, found {value!r}")


def study_of(config: Mapping) -> Study:
    """Reads what Snakemake has put together from the files and `--config`. Raises BadStudy."""
    for key in config:
        if key not in (*_OF_ALL, *_OF_A_SCENE):
            known = ", ".join(sorted((*_OF_ALL, *_OF_A_SCENE)))
            raise BadStudy(f"unknown key '{key}'; known: {known}")
    for key in (*_OF_ALL, *_OF_A_SCENE):
        if key not in config:
            raise BadStudy(f"expected the key '{key}'")
    listed = config["scenes"]
    if isinstance(listed, str):
        listed = [listed]
    if not isinstance(listed, list) or not listed:
        raise BadStudy(f"scenes: expected a list of scenes, found {listed!r}")
    shared = {key: config[key] for key in _OF_A_SCENE}
    entries: dict[str, Entry] = {}
    for number, wish in enumerate(listed, 1):
        entry = _entry(f"scenes, entry {number}", wish, shared)
        if entry.name in entries:
            raise BadStudy(f"scenes, entry {number}: {entry.name} is there already")
        entries[entry.name] = entry
    out = config["out"]
    if not isinstance(out, str) or not out or re.search(r"[\s{}]", out):
        raise BadStudy(f"out: expected a folder whose path has no blanks or braces, found {out!r}")
    timeout = config["claim_timeout"]
    if isinstance(timeout, bool) or not isinstance(timeout, (int, float)) or timeout <= 0:
        raise BadStudy(f"claim_timeout: expected seconds above 0, found {timeout!r}")
    return Study(out.rstrip("/"), float(timeout), entries, _jobs(config["jobs"]))


def _jobs(wish: object) -> dict[str, dict[str, int]]:
    if not isinstance(wish, Mapping) or {*wish} != {*JOBS}:
        raise BadStudy(f"jobs: expected {', '.join(JOBS)}, found {_shown(wish)}")
    for kind, needs in wish.items():
        if not isinstance(needs, Mapping) or {*needs} != {*_NEEDS}:
            raise BadStudy(f"jobs, {kind}: expected {', '.join(_NEEDS)}, found {_shown(needs)}")
        for key, value in needs.items():
            _count(f"jobs, {kind}: {key}", value)
    return {kind: dict(needs) for kind, needs in wish.items()}


def _shown(value: object) -> str:
    return ", ".join(map(str, value)) if isinstance(value, Mapping) else repr(value)


def _entry(where: str, wish: object, shared: Mapping) -> Entry:
    if isinstance(wish, str):
        wish = {"scene": wish}
    if not isinstance(wish, Mapping) or "scene" not in wish:
        raise BadStudy(
            f"{where}: expected a scene with its flags, or a table with `scene`, found {wish!r}"
        )
    for key in wish:
        if key not in ("scene", "name", *_OF_A_SCENE):
            raise BadStudy(
                f"{where}: unknown key '{key}'; known: scene, name, {', '.join(_OF_A_SCENE)}"
            )
    all_of = {**shared, **wish}
    words = _words(f"{where}: scene", wish["scene"])
    if not words or words[0] not in scenes():
        raise BadStudy(f"{where}: expected one of {', '.join(scenes())}, found '{' '.join(words)}'")
    name = wish.get("name", "_".join(word.strip("-") for word in words))
    if not isinstance(name, str) or not re.fullmatch(r"[\w.-]+", name):
        raise BadStudy(
            f"{where}: name: expected letters, digits, _ . -, found {name!r}; give it one by `name`"
        )
    size = all_of["size"]
    if not isinstance(size, str) or not re.fullmatch(r"[1-9]\d*x[1-9]\d*", size):
        raise BadStudy(f"{where}: size: expected WxH as 480x270, found {size!r}")
    frames = _frames(f"{where}: frames", all_of["frames"])
    truth: tuple[int, ...] | None = None
    if all_of["truth_frames"] == "none":
        truth = ()
    elif all_of["truth_frames"] != "all":
        truth = _frames(f"{where}: truth_frames", all_of["truth_frames"])
        if not {*truth} <= {*frames}:
            raise BadStudy(
                f"{where}: truth_frames: expected some of the frames {_in_words(frames)}, found {_in_words(truth)}"
            )
    methods = tuple(_words(f"{where}: methods", all_of["methods"]))
    if not methods:
        raise BadStudy(f"{where}: methods: expected at least one")
    counts = {k: _count(f"{where}: {k}", all_of[k]) for k in ("frames_per_job", "samples", "truth_samples")}  # fmt: skip
    further = {k: tuple(_words(f"{where}: {k}", all_of[k])) for k in ("export", "run")}
    return Entry(
        name, words[0], tuple(words[1:]), frames, size=size, truth_frames=truth, methods=methods, **counts, **further
    )  # fmt: skip


def scenes() -> list[str]:
    """Names of the scenes: the files that have a command line."""
    return sorted(
        p.stem for p in SCENES.glob("*.py") if "__main__" in p.read_text(encoding="utf-8")
    )


def _words(where: str, value: object) -> list[str]:
    """A list of words, or a text of them."""
    if isinstance(value, str):
        try:
            return shlex.split(value)
        except ValueError as error:
            raise BadStudy(f"{where}: expected words, found {value!r}: {error}") from None
    if isinstance(value, list) and all(isinstance(word, (str, int, float)) for word in value):
        return [str(word) for word in value]
    raise BadStudy(f"{where}: expected words, found {value!r}")


def _count(where: str, value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise BadStudy(f"{where}: expected a whole number above 0, found {value!r}")
    return value


def _frames(where: str, value: object) -> tuple[int, ...]:
    try:
        found = numbers(str(value)) if isinstance(value, (int, str)) else []
    except ValueError:
        found = []
    if not found:
        raise BadStudy(f"{where}: expected frames as 1-16 or 1,4,8-10, found {value!r}")
    return tuple(found)


def numbers(frames: str) -> list[int]:
    """Frames as 1-16 or 1,4,8-10, ascending. Raises ValueError."""
    found: set[int] = set()
    for part in frames.split(","):
        first, dash, last = part.partition("-")
        found.update(range(int(first), int(last if dash else first) + 1))
    return sorted(found)


def _in_words(frames: tuple[int, ...] | list[int]) -> str:
    """1-4 or 1,4,8."""
    first, last = frames[0], frames[-1]
    if len(frames) > 1 and len(frames) == last - first + 1:
        return f"{first}-{last}"
    return ",".join(map(str, frames))
