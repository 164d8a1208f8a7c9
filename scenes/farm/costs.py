# SPDX-License-Identifier: MIT
"""What the theses' full study costs: processor time measured per picture, pixel and sample, and the hours on many nodes.

usage: costs.py PROGRAM OUT DOCS [--pieces N] | costs.py --page-only DOCS

Writes farm-costs.json and farm-costs.md to DOCS, and the hours into farm.md beside DOCS. Each rendered shot of
`make reproduce FULL=1` is measured small, at two sizes and two numbers of samples, through which lines are laid; two
shots also at their full size, which says how well the lines hold. A piece takes seconds and is kept in OUT; --pieces
measures so many now.
"""

from __future__ import annotations

import hashlib
import json
import os
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "reproduce"))

import experiments  # noqa: E402
import measured  # noqa: E402
from catalogue import SHOTS  # noqa: E402
from costs_page import write_page  # noqa: E402
from reproduce import needed_shots  # noqa: E402
from shots import Shot, Workshop, build_scene, export_words, exporter  # noqa: E402

SIZES, SAMPLES = ("96x54", "384x216"), (4, 16)
CHECKED = ("hairball_unlit", "atrium_flying")
CHECK_SAMPLES = (4,)
JUDGED = dict(size="480x270", frames=8)  # of the synthetic shot on which methods are timed


def study() -> dict[str, Shot]:
    """The rendered shots in their full form."""
    known = experiments.load(SHOTS)
    shots = {name: SHOTS[name].in_form("full") for name in needed_shots([], known, SHOTS)}
    return {n: shot for n, shot in shots.items() if not shot.scene.startswith("synth:")}


def scene_of(shot: Shot) -> str:
    return " ".join([shot.scene, *shot.variant])


def children_seconds(work: Callable[[], object]) -> float:
    """Processor seconds of the programs that ``work`` calls."""
    before = _spent()
    work()
    return round(_spent() - before, 2)


def _spent() -> float:
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _busy() -> float:
    """Processor seconds of all programs since the machine's start."""
    first = Path("/proc/stat").read_text().splitlines()[0].split()[1:]
    user, nice, system, _, _, interrupts, soft, *_ = map(int, first)
    return (user + nice + system + interrupts + soft) / os.sysconf("SC_CLK_TCK")


def machine(shop: Workshop) -> dict:
    words = ["bench", "-m", "noaa", "--size", "8x8", "--frames", 1, "--no-error", "--json"]
    return json.loads(shop.run("machine", [shop.program, *words]))["machine"]


def judging(shop: Workshop) -> dict:
    """A run of the methods of a moving shot, all figures with it: processor ns per method, frame and pixel."""
    shot, methods = shop.out / "synth", SHOTS["synth_moving"].methods.split()
    ids = ",".join(dict.fromkeys(m.split("+")[0] for m in methods))
    words = ["synth", "moving", "-o", shot, "-q", "--for", ids]
    words += ["--size", JUDGED["size"], "--frames", JUDGED["frames"]]
    shop.run("synth", [shop.program, *words])
    run = [shop.program, "run", shot, "-o", shop.out / "run", "--write", "none", "-q", "-j", 1]
    run += [w for m in methods for w in ("-m", m)]
    seconds = children_seconds(lambda: shop.run("run", run))
    width, height = map(int, JUDGED["size"].split("x"))
    count = len(methods) * JUDGED["frames"] * width * height
    return {"methods": len(methods), **JUDGED, "nsPerPixel": round(1e9 * seconds / count, 1)}


def built(shot: Shot, shop: Workshop) -> Path:
    """The shot's scene."""
    blend = shop.out / "scenes" / f"{_stem(shot)}.blend"
    return blend if blend.exists() else build_scene(shop, *_building(shot))


def _building(shot: Shot) -> tuple:
    return _stem(shot), shot.scene, shot.variant, SIZES[-1], 1


def _stem(shot: Shot) -> str:
    return scene_of(shot).replace(" ", "_")


def pictures_of(
    name: str, shot: Shot, shop: Workshop, sizes: tuple[str, ...], samples: tuple[int, ...]
) -> dict:
    """What measure_costs.py finds of a shot."""
    script = [*exporter(shop, built(shot, shop), 1)[:-2], HERE / "measure_costs.py", "--"]
    words = [",".join(sizes), ",".join(map(str, samples)), *export_words(shot, shop)]
    before = time.monotonic(), _busy(), _spent()
    said = shop.run(f"costs.{name}", [*script, *words])
    clock, all_of_them, ours = (
        b - a for a, b in zip(before, (time.monotonic(), _busy(), _spent()))
    )
    line = next(line for line in said.splitlines() if line.startswith('{"event": "costs"'))
    found = json.loads(line)
    others = round(max(0.0, all_of_them - ours) / clock, 2)
    return {"blender": found["blender"], "othersBusy": others, **found["found"]}


def described(shot: Shot) -> dict:
    """What of a shot decides its costs, beside what was measured."""
    return {
        "scene": scene_of(shot),
        "size": list(shot.size),
        "truthSamples": shot.truth_samples,
        "truthOf": shot.truth_of,
        "methods": len(shot.all_methods()),
    }


def pieces(shop: Workshop) -> dict[str, Callable[[], object]]:
    found: dict[str, Callable[[], object]] = {
        "machine": lambda: machine(shop),
        "judging": lambda: judging(shop),
    }
    for name, shot in study().items():
        found.setdefault(
            f"scene {scene_of(shot)}",
            lambda shot=shot: children_seconds(lambda: build_scene(shop, *_building(shot))),
        )
        found[f"shot {name}"] = lambda name=name, shot=shot: {
            **described(shot),
            **pictures_of(name, shot, shop, SIZES, SAMPLES),
        }
    for name in CHECKED:
        shot = study()[name]
        size = "{}x{}".format(*shot.size)
        found[f"check {name}"] = lambda name=name, shot=shot, size=size: pictures_of(
            f"{name}.check", shot, shop, (size,), CHECK_SAMPLES
        )
    return found


def measure(program: Path, out: Path, docs: Path, most: int | None) -> bool:
    """At most so many pieces; writes farm-costs.json and returns True when none is missing."""
    shop = Workshop(program, os.environ.get("BLENDER", "blender"), out, "full")
    listed = json.loads(shop.run("list", [program, "list", "--json"]))
    shop.known = {m["id"] for m in listed["methods"]}
    file = out / f"{hashlib.sha256((HERE / 'measure_costs.py').read_bytes()).hexdigest()[:16]}.json"
    kept = json.loads(file.read_text()) if file.exists() else {}
    every = pieces(shop)
    for name in [n for n in every if n not in kept][:most]:
        kept[name] = every[name]()
        file.write_text(json.dumps(kept))
        print(name, flush=True)
    if any(name not in kept for name in every):
        return False

    def of(kind: str) -> dict:
        return {n.removeprefix(kind): kept[n] for n in every if n.startswith(kind)}

    content = {
        "machine": kept["machine"], "judging": kept["judging"], "sizes": SIZES, "samples": SAMPLES,
        "checkSamples": CHECK_SAMPLES, "scenes": of("scene "), "shots": of("shot "), "checks": of("check "),
    }  # fmt: skip
    measured.write_document(docs, "farm-costs", content)
    return True


if __name__ == "__main__":
    sys.exit(measured.main(sys.argv[1:], __doc__, "farm-costs", measure, write_page))
