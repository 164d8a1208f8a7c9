# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: processor seconds of each sort of picture of the open scene's shot, as a line of JSON; for costs.py.

    blender -b -t 1 SCENE.blend --python-exit-code 9 -P scenes/farm/measure_costs.py -- SIZES SAMPLES EXPORTER_OPTIONS...

At each of SIZES (96x54,384x216) one picture of each sort, and the truth by each of SAMPLES (2,8). Processor time of the
process, which other programs on the machine hardly lengthen. The second picture of a sort is timed: the first also pays
for what the following ones find ready.
"""

from __future__ import annotations

import json
import os
import resource
import sys
from collections.abc import Callable
from pathlib import Path

import bpy

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))

from aa_resolve.adding import Missing, lacking  # noqa: E402
from aa_resolve.command_line import build_parser, settings_from  # noqa: E402
from aa_resolve.export import Exporter  # noqa: E402
from aa_resolve.progress import Progress  # noqa: E402


def spent() -> float:
    """User + system seconds of this process and its threads."""
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def seconds(work: Callable[[], object]) -> float:
    before = spent()
    work()
    return round(spent() - before, 4)


def prepared(words: list[str], progress: Progress) -> Exporter:
    """An exporter of the file as it lies on disk: preparing changes the scene in memory."""
    bpy.ops.wm.open_mainfile(filepath=bpy.data.filepath)
    scene = bpy.context.scene
    arguments = build_parser().parse_args([*words, "--out", "unused"])
    exporter = Exporter(scene, settings_from(arguments, scene), progress, "costs")
    exporter.prepare()
    return exporter


def wanted(exporter: Exporter) -> Missing:
    """All pictures of the shot."""
    return lacking(exporter.settings, exporter.plan.passes_of, exporter.static, None)


def measured(exporter: Exporter, samples: list[int]) -> dict[str, object]:
    """Seconds of a picture of each kind; of truth by its samples."""
    file = os.path.join(bpy.app.tempdir, "picture.exr")
    pictures, found = exporter.pictures, {}
    first, second = exporter.settings.frames[0], exporter.settings.frames[-1]
    for item, _ in wanted(exporter).groups():
        if item.kind == "truth":
            pictures.truth(first, file, samples[0])
            found["truth"] = [seconds(lambda: pictures.truth(second, file, n)) for n in samples]
        else:
            pictures.frame(item.kind, first, file)
            found[item.kind] = seconds(lambda: pictures.frame(item.kind, second, file))
    return found


def main(sizes: list[str], samples: list[int], words: list[str]) -> None:
    blender, progress = spent(), Progress(True)
    every = prepared([*words, "--resolution", sizes[0]], progress)
    of_job = ",".join(map(str, every.settings.frames[:2]))
    job = [*words, "--frames", of_job, "--resolution"]
    before = spent()
    prepared([*job, sizes[0]], progress)
    start = blender + spent() - before
    found = {
        "start": round(start, 2),
        "pictures": {item.kind: count for item, count in wanted(every).groups()},
        "seconds": {size: measured(prepared([*job, size], progress), samples) for size in sizes},
    }
    progress.say("costs", f"costs: {found}", blender=bpy.app.version_string, found=found)


after = sys.argv[sys.argv.index("--") + 1 :]
main(after[0].split(","), [int(n) for n in after[1].split(",")], after[2:])
