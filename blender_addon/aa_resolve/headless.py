# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of the exporter.

    blender -b FILE.blend --python-exit-code 9 -P headless.py -- --out SHOT --frames 1-16 --for noaa,taaSimplest

Exit codes: 0 done, 1 stopped by the user, 2 wrong usage, 3 the scene or a file cannot serve, 9 a fault of this
program. Errors are one line on standard error. The .blend file is only read.
"""

from __future__ import annotations

import os
import sys
import time

import bpy

if __package__ in (None, ""):
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    import aa_resolve  # noqa: F401  (makes the relative imports below work when Blender runs this file)

    __package__ = "aa_resolve"

from . import ADDON_VERSION  # noqa: E402
from .command_line import build_parser, settings_from  # noqa: E402
from .errors import Cancelled, SceneError, UsageError  # noqa: E402
from .estimate import estimate  # noqa: E402
from .export import Exporter  # noqa: E402
from .progress import Progress  # noqa: E402
from .store import Store  # noqa: E402


def run(argv: list[str]) -> int:
    """Exports the open file; returns the exit code."""
    try:
        arguments = build_parser().parse_args(argv)
        progress = Progress(arguments.json)
        scene = bpy.context.scene
        settings = settings_from(arguments, scene)
        if arguments.estimate:
            return estimate(scene, settings, progress)
        started = time.perf_counter()
        exporter = Exporter(scene, settings, progress, ADDON_VERSION)
        exporter.prepare()
        store = Store(settings.out, arguments.claim_timeout)
        store.open(
            {
                **settings.fingerprint(),
                "static": exporter.static,
                "version": ADDON_VERSION,
                "blender": bpy.app.version_string,
            },
            settings.overwrite,
        )
        summary = exporter.run(store)
        seconds = time.perf_counter() - started
        finished = f", {summary.skipped} were finished before" if summary.skipped else ""
        elsewhere = (
            f", {summary.elsewhere} are being made by other processes" if summary.elsewhere else ""
        )
        for name, cost in summary.costs.items():
            size = f", {cost.bytes / 1e6:.2f} MB" if cost.bytes else ""
            progress.say(
                "cost",
                f"{name}: {cost.seconds:.2f} s{size}",
                **{"pass": name, "seconds": round(cost.seconds, 3), "bytes": cost.bytes},
            )
        progress.say(
            "done",
            f"{os.path.join(settings.out, 'shot.json')}: {summary.rendered} pictures in {seconds:.1f} s"
            f"{finished}{elsewhere}",
            shot=os.path.join(store.folder, "shot.json"),
            rendered=summary.rendered,
            skipped=summary.skipped,
            elsewhere=summary.elsewhere,
            seconds=round(seconds, 3),
        )
        return 0
    except (UsageError, SceneError, Cancelled) as error:
        print(f"error: {error}", file=sys.stderr, flush=True)
        return error.exit_code


if __name__ == "__main__":
    sys.exit(run(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []))
