# SPDX-License-Identifier: MIT
"""The shots of the studies: which scene, which frames, how good a truth; rendered by Blender, resumable.

Several shots may show one scene with other sub-samples or another jitter. Their truth is the same picture, so it is
rendered once and hard-linked (`truth_of`).
"""

from __future__ import annotations

import filecmp
import hashlib
import json
import os
import re
import shutil
import subprocess
import time
from concurrent.futures import Future
from dataclasses import dataclass, field, replace
from pathlib import Path
from threading import Lock

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Shot:
    """One export. Samples are per pixel and half of the truth; `quick_*` serve the short form of the study."""

    name: str
    scene: str  # of the folder scenes, or synth:NAME for an analytic one with exact truth
    methods: str  # methods that the studies run on it, separated by blanks; they and `serves` decide the passes
    variant: tuple[str, ...] = ()  # flags of the scene
    frames: int = 16
    quick_frames: int = 16
    truth_samples: int = 128
    quick_truth_samples: int = 32
    jitter: str = "halton23"
    period: int = 16
    pattern: str = ""  # of sub-samples
    passes: str = ""  # of the jittered frames, beyond what the methods read
    truth_of: str = ""  # another shot of the same scene, variant and frames
    truth: bool = True
    serves: str = ""  # methods of published tables
    truth_frames: str = ""  # those that have truth; empty: all
    own_truth: bool = False  # the number of samples is what is asked: never another shot's truth
    first: int = 1  # number of the first frame
    jitter_projection: str = "post"
    size: tuple[int, int] = (480, 270)
    quick_size: tuple[int, int] | None = None  # of the short form
    published_size: tuple[int, int] | None = None  # of the full form: as its source has it
    export: tuple[str, ...] = field(
        default=(), repr=False
    )  # further words of the exporter's command line

    def all_methods(self) -> list[str]:
        """Whatever is run on it."""
        return list(dict.fromkeys([*self.methods.split(), *self.serves.split()]))

    def in_form(self, form: str) -> "Shot":
        """Itself with the numbers of frames and samples and the size of one form of the study."""
        if form == "quick":
            return replace(
                self,
                frames=self.quick_frames,
                truth_samples=self.quick_truth_samples,
                size=self.quick_size or self.size,
            )
        if form == "full" and self.published_size:
            return replace(self, size=self.published_size)
        return self


@dataclass
class Workshop:
    """Where things are and how they are called."""

    program: Path
    blender: str
    out: Path
    form: str  # quick, whole or full
    known: set[str] = field(default_factory=set)  # method ids of the program and of the add-on
    temporal: set[str] | None = None  # those of them that accumulate frames; None: any may
    threads: int = 0  # of one call of the program; 0: all processors
    runs: dict[str, Future] = field(default_factory=dict)  # by what they are made of
    lock: Lock = field(default_factory=Lock)

    def run(self, what: str, command: list[object]) -> str:
        """Runs a command, keeps its output in a log; a failure ends the study with its last lines."""
        log = self.out / "logs" / f"{what.replace('/', '.')}.log"
        log.parent.mkdir(parents=True, exist_ok=True)
        environment = dict(os.environ)
        # Blender's own Python takes its modules from the python3 of PATH: another one would mislead it.
        places = [p for p in environment.get("PATH", "").split(":") if p]
        environment["PATH"] = ":".join(
            p for p in places if p == "/usr/bin" or not os.path.exists(os.path.join(p, "python3"))
        )
        words = [str(word) for word in command]
        try:
            done = subprocess.run(words, capture_output=True, text=True, env=environment)
        except OSError as error:
            way = "; BLENDER says which Blender" if words[0] == self.blender else ""
            raise SystemExit(f"{what}: cannot run '{words[0]}': {error.strerror}{way}") from None
        log.write_text(done.stdout + done.stderr)
        if done.returncode != 0:
            last = "\n".join((done.stdout + done.stderr).strip().splitlines()[-5:])
            raise SystemExit(f"{what}: failed (exit {done.returncode}), see {log}\n{last}")
        return done.stdout

    def folder(self, shot: Shot) -> Path:
        return self.out / self.form / shot.name

    def serves(self, method: str) -> bool:
        """Whether the program has the method and every method that fills its rejected pixels."""
        return all(name in self.known for name in _ids(method))

    def accumulates(self, method: str) -> bool:
        """Whether the frames before the judged one matter to a method."""
        return self.temporal is None or not self.temporal.isdisjoint(_ids(method))


def _ids(method: str) -> list[str]:
    """The method's id and those of the methods that fill its rejected pixels."""
    parts = method.split("+")
    ids = [parts[0].split(":")[0]]
    return ids + [p.split("=", 1)[1].split(":")[0] for p in parts[1:] if p.startswith("fill=")]


def make(shots: dict[str, Shot], shot: Shot, shop: Workshop) -> Path:
    """Exports what is not there yet; returns the shot's folder."""
    started = time.monotonic()
    folder = shop.folder(shot)
    if is_ready(shot, shop):
        if shot.truth_of and not _has_lent_truth(make_folder(shop, shots[shot.truth_of]), folder):
            _lend_truth(make_folder(shop, shots[shot.truth_of]), folder)
            print(f"  shot {shot.name}: truth of {shot.truth_of} as it is now", flush=True)
        return folder
    shot = shot.in_form(shop.form)
    wish = _identity(shot, shop)
    size = "{}x{}".format(*shot.size)
    if shot.scene.startswith("synth:"):
        command = [shop.program, "synth", shot.scene.split(":")[1], "-o", folder, "-q"]
        command += ["--frames", shot.frames, "--size", size]
        command += ["--jitter", shot.jitter, "--period", shot.period]
        command += ["--subsamples", shot.pattern] if shot.pattern else []
        shop.run(f"synth.{shot.name}", command)
        return _ready(shop, shot, wish, started, "exact truth", folder)
    stem = "_".join([shot.scene, *(v.strip("-") for v in shot.variant), size])
    blend = build_scene(shop, stem, shot.scene, shot.variant, size)
    command = [
        *exporter(shop, blend),
        "--out",
        folder,
        "--resolution",
        size,
        *export_words(shot, shop),
    ]
    try:
        said = shop.run(f"export.{shot.name}", command)
    except SystemExit as refusal:  # the exporter never mixes two exports in one folder
        if "holds an export with other settings" not in str(refusal):
            raise
        print(f"  shot {shot.name}: its settings have changed, rendered anew", flush=True)
        said = shop.run(f"export.{shot.name}", [*command, "--overwrite"])
    if shot.truth_of:
        _lend_truth(make_folder(shop, shots[shot.truth_of]), folder)
    done = [line.split(": ", 1)[-1] for line in said.splitlines() if "pictures in" in line]
    return _ready(shop, shot, wish, started, done[-1] if done else "ready", folder)


def export_words(shot: Shot, shop: Workshop) -> list[object]:
    """Options of the exporter for a shot in its form, without its folder and size."""
    ids = [m.split("+")[0] for m in shot.all_methods() if shop.serves(m)]
    words: list[object] = ["--for", ",".join(dict.fromkeys(ids)), "--name", shot.name]
    words += ["--frames", f"{shot.first}-{shot.first + shot.frames - 1}"]
    words += ["--truth-samples", shot.truth_samples]
    words += ["--jitter", shot.jitter, "--period", shot.period]
    if shot.jitter_projection != "post":
        words += ["--jitter-projection", shot.jitter_projection]
    if shot.pattern:
        words += ["--subsamples", shot.pattern]
    words += shot.export
    if shot.passes:
        words += ["--passes", shot.passes]
    if shot.truth_of or not shot.truth:
        words += ["--truth-frames", "none"]
    elif shot.truth_frames:
        words += ["--truth-frames", shot.truth_frames]
    return words


def build_scene(
    shop: Workshop, stem: str, scene: str, variant: tuple[str, ...], size: str, threads: int = 0
) -> Path:
    """The scene's .blend at this size, by its name; one that is up to date is kept."""
    blend = shop.out / "scenes" / f"{stem}.blend"
    command = [*_blender(shop, threads), "--factory-startup", "--python-exit-code", 9]
    command += ["-P", ROOT / f"scenes/{scene}.py", "--", "--out", blend, *variant]
    shop.run(f"scene.{stem}", [*command, "--resolution", size])
    return blend


def exporter(shop: Workshop, blend: Path, threads: int = 0) -> list[object]:
    """The exporter's command line without its options."""
    headless = ROOT / "blender_addon/aa_resolve/headless.py"
    return [*_blender(shop, threads), blend, "--python-exit-code", 9, "-P", headless, "--"]


def _blender(shop: Workshop, threads: int) -> list[object]:
    """Blender without a window; 0 threads: one per processor."""
    return [shop.blender, "-b", *(("-t", threads) if threads else ())]


def _ready(shop: Workshop, shot: Shot, wish: str, started: float, what: str, folder: Path) -> Path:
    stamp = _stamp(shot, shop)
    stamp.parent.mkdir(exist_ok=True)
    stamp.write_text(wish)
    seconds = time.monotonic() - started
    spent = spent_before(shop)
    # A resumed export took less than a whole one: what is remembered is the longest.
    key = f"{shop.form}.{shot.name}"
    spent[key] = max(spent.get(key, 0.0), seconds)
    (shop.out / _SPENT).write_text(json.dumps(spent, indent=1))
    print(f"  shot {shot.name}: {what} ({seconds:.0f} s)", flush=True)
    return folder


def scene_sources(name: str) -> list[Path]:
    """The scene's file and what it imports of its folder, and so on."""
    found = [ROOT / f"scenes/{name}.py"]
    for path in found:  # grows meanwhile
        for word in re.findall(
            r"^(?:import|from) (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE
        ):
            block = ROOT / f"scenes/{word}.py"
            if block.exists() and block not in found:
                found.append(block)
    return sorted(found)


_SPENT = "seconds.json"  # of each shot's export


def spent_before(shop: Workshop) -> dict[str, float]:
    """Seconds that exports took on this machine, by form and name of the shot."""
    path = shop.out / _SPENT
    return json.loads(path.read_text()) if path.exists() else {}


def is_ready(shot: Shot, shop: Workshop) -> bool:
    """Whether the shot is there as it is described now."""
    stamp = _stamp(shot, shop)
    if not stamp.exists() or not (shop.folder(shot) / "shot.json").exists():
        return False
    return stamp.read_text() == _identity(shot.in_form(shop.form), shop)


def _stamp(shot: Shot, shop: Workshop) -> Path:
    """The file that says of what the shot was made."""
    return shop.out / "stamps" / f"{shop.form}.{shot.name}"


def _identity(shot: Shot, shop: Workshop) -> str:
    """What decides the shot's content: its description and the sources of scene and exporter."""
    digest = hashlib.sha256(f"{replace(shot, methods='', serves='')}".encode())
    digest.update(" ".join(shot.export).encode())
    if shot.scene.startswith("synth:"):
        sources = [shop.program]
    else:
        sources = scene_sources(shot.scene)
        sources += sorted((ROOT / "blender_addon/aa_resolve").rglob("*.py"))
        # Of the registry only what decides the passes: a better help text renders nothing anew.
        registry = json.loads((ROOT / "blender_addon/aa_resolve/methods.json").read_text())[
            "methods"
        ]
        ids = {m.split(":")[0].split("+")[0] for m in shot.all_methods()}
        digest.update(repr([(m["id"], m["passes"]) for m in registry if m["id"] in ids]).encode())
    for path in sources:
        digest.update(path.read_bytes())
    return digest.hexdigest()


def make_folder(shop: Workshop, shot: Shot) -> Path:
    """The folder of a shot that must be there already."""
    folder = shop.folder(shot)
    if not (folder / "shot.json").exists():
        raise SystemExit(f"{folder}: expected a finished shot, whose truth is to be lent")
    return folder


def _has_lent_truth(lender: Path, borrower: Path) -> bool:
    """Whether the lender's truth is still that which it has lent: of more samples it is another one."""
    source, manifest = (json.loads((f / "shot.json").read_text()) for f in (lender, borrower))
    if source["truth"] != manifest.get("truth"):
        return False
    lent = {f["truth"] for f in manifest["frames"] if "truth" in f}
    return all(
        (borrower / path).exists()
        and (lender / path).exists()
        and (
            os.path.samefile(lender / path, borrower / path)
            or filecmp.cmp(lender / path, borrower / path, shallow=False)
        )
        for path in lent
    )


def _lend_truth(lender: Path, borrower: Path) -> None:
    """Gives a shot without truth that of another one: the same scene at the same frames."""
    manifest = json.loads((borrower / "shot.json").read_text())
    source = json.loads((lender / "shot.json").read_text())
    truths = {f["frame"]: f["truth"] for f in source["frames"] if "truth" in f}
    if not truths or not (
        source["static"] or truths.keys() & {f["frame"] for f in manifest["frames"]}
    ):
        raise SystemExit(f"{lender}: no truth of the frames that {borrower} has")
    for entry in manifest["frames"]:
        path = next(iter(truths.values())) if source["static"] else truths.get(entry["frame"])
        if path is None:  # a frame that is not judged
            continue
        target = borrower / path
        target.parent.mkdir(exist_ok=True)
        target.unlink(missing_ok=True)
        try:
            os.link(lender / path, target)
        except OSError:  # another file system
            shutil.copyfile(lender / path, target)
        entry["truth"] = path
    manifest["truth"] = source["truth"]
    (borrower / "shot.json").write_text(json.dumps(manifest, indent=1) + "\n")
