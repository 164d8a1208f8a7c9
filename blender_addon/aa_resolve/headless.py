# SPDX-License-Identifier: GPL-3.0-or-later
"""Command line of the exporter.

    blender -b FILE.blend --python-exit-code 9 -P headless.py -- --out SHOT --frames 1-16 --for noaa,taaSimplest

A shot that is there is added to: what it lacks is said first, then rendered. Every failure ends with one line on
standard error; exit codes stand in ``--help``. The .blend file is only read.
"""

from __future__ import annotations

import argparse
import os
import sys
import time

import bpy

if __package__ in (None, ""):
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
    import aa_resolve  # noqa: F401  (makes the relative imports below work when Blender runs this file)

    __package__ = "aa_resolve"

from . import ADDON_VERSION, interrupt  # noqa: E402
from .adding import missing  # noqa: E402
from .command_line import build_parser, settings_from  # noqa: E402
from .errors import Cancelled, UsageError, trace_of, way_out  # noqa: E402
from .estimate import Estimate, estimate  # noqa: E402
from .export import Exporter, Summary  # noqa: E402
from .identity import scripts_before  # noqa: E402
from .progress import Progress  # noqa: E402
from .settings import Settings  # noqa: E402
from .store import Store  # noqa: E402

_ASK_ABOVE_SECONDS = 600.0  # a range that nobody named: a forgotten --frames must not cost a night


def run(argv: list[str]) -> int:
    """Exports the open file; returns the exit code."""
    try:
        arguments = build_parser().parse_args(argv)
        interrupt.watch()
        progress = Progress(arguments.json)
        _export(arguments, bpy.context.scene, progress)
        return 0
    except (Exception, KeyboardInterrupt) as error:
        interrupt.give_way()
        line, code = way_out(error)
        print(f"error: {line}\n{trace_of(error)}", end="", file=sys.stderr, flush=True)
        return code


def _export(arguments: argparse.Namespace, scene: bpy.types.Scene, progress: Progress) -> None:
    started = time.perf_counter()
    settings = settings_from(arguments, scene)
    store = Store(settings.out, arguments.claim_timeout)
    interrupt.before_leaving(store.abandon)
    if not arguments.frames:
        _say_range(scene, progress)
    if not (arguments.source or arguments.same_scene):
        _say_scripts(progress)
    if arguments.plan:
        _say_plan(settings, store, progress)
        return
    exporter = Exporter(scene, settings, progress, ADDON_VERSION)
    exporter.prepare()
    lacked = exporter.missing(store)
    progress.say("missing", lacked.sentence(), **lacked.values())
    if arguments.estimate or (lacked.work and not arguments.frames):
        cost = estimate(exporter, store, lacked)
        progress.say("estimate", cost.sentence(), **cost.values())
        if arguments.estimate:
            return
        _confirm(cost, arguments, progress)
    exporter.open(store)
    _say_end(exporter.run(store), settings, progress, time.perf_counter() - started)


def _say_range(scene: bpy.types.Scene, progress: Progress) -> None:
    first, last, step = scene.frame_start, scene.frame_end, scene.frame_step
    text = f"the scene's frames {first}-{last}"
    if step > 1:
        text += (
            f" in its steps of {step}: no frame has the one before it, so every frame starts anew for methods that "
            f"accumulate; --frames {first}-{last} takes them all"
        )
    progress.say("note", f"note: {text}", note=text)


def _say_scripts(progress: Progress) -> None:
    names = [script.name for script in scripts_before(sys.argv)]
    if names:
        text = (
            f"the shot is of the file and of what {', '.join(names)} made of it: it is added to while all stay as "
            "they are; of a script that does another thing each time, --source names the scene"
        )
        progress.say("note", f"note: {text}", note=text)


def _say_plan(settings: Settings, store: Store, progress: Progress) -> None:
    """What is there and what is missing, from the shot alone."""
    lacked = missing(settings, store)
    if lacked.changed:
        raise UsageError(store.other_settings(lacked.changed))
    progress.say("missing", lacked.sentence(), **lacked.values())


def _confirm(cost: Estimate, arguments: argparse.Namespace, progress: Progress) -> None:
    """Asks before a long export of a range that was not named. Raises where nobody agrees."""
    if arguments.yes or cost.seconds <= _ASK_ABOVE_SECONDS:
        return
    if arguments.json or not (sys.stdin and sys.stdin.isatty()):
        raise UsageError(
            f"the scene's range takes about {cost.amount()}: add --yes to export all of it, or choose with --frames"
        )
    progress.ask(f"The scene's range takes about {cost.amount()}. Go on? [y/N] ")
    if sys.stdin.readline().strip().lower() not in ("y", "yes"):
        raise Cancelled("stopped before the first picture; nothing was written")


def _say_end(summary: Summary, settings: Settings, progress: Progress, seconds: float) -> None:
    for name, cost in summary.costs.items():
        size = f", {cost.bytes / 1e6:.2f} MB" if cost.bytes else ""
        progress.say(
            "cost",
            f"{name}: {cost.seconds:.2f} s{size}",
            **{"pass": name, "seconds": round(cost.seconds, 3), "bytes": cost.bytes},
        )
    finished = f", {summary.skipped} were finished before" if summary.skipped else ""
    elsewhere = (
        f", {summary.elsewhere} are being made by other processes" if summary.elsewhere else ""
    )
    shot = os.path.join(os.path.abspath(settings.out), "shot.json")
    progress.say(
        "done",
        f"{os.path.join(settings.out, 'shot.json')}: {summary.rendered} pictures in {seconds:.1f} s"
        f"{finished}{elsewhere}",
        shot=shot,
        rendered=summary.rendered,
        skipped=summary.skipped,
        elsewhere=summary.elsewhere,
        seconds=round(seconds, 3),
    )


if __name__ == "__main__":
    sys.exit(run(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []))
