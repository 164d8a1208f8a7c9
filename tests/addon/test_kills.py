# SPDX-License-Identifier: GPL-3.0-or-later
"""An export is killed at any moment, and the clock is set back: no half of a picture is taken for a whole one, and the same
command again makes the same shot, to the bit.

AA_FAULTS=N: so many kills (default 3); AA_FAULTS_SEED=S."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402

FOLDER = t.temporary_folder()
COUNT = int(os.environ.get("AA_FAULTS", "3"))
RANDOM = random.Random(os.environ.get("AA_FAULTS_SEED", "1"))
OPTIONS = (
    *("--for", "taaSimplest", "--passes", "object,depth", "--frames", "1-4"),
    *("--truth-samples", "4", "--truth-frames", "1,4"),
)


def make_blend() -> str:
    scene = t.new_scene(32, 18)
    t.add_sun(scene)
    t.add_camera(scene)
    item = t.add_object(scene, "Cube", None, (0, 0, 0.5))
    item.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    return t.save(scene, os.path.join(FOLDER, "scene.blend"))


BLEND = make_blend()


def pictures(shot: str) -> dict[str, str]:
    """Digest of every picture that stands under its own name."""
    found = {}
    for kind in ("frames", "truth"):
        folder = os.path.join(shot, kind)
        for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
            if name.endswith(".exr"):
                with open(os.path.join(folder, name), "rb") as file:
                    found[f"{kind}/{name}"] = hashlib.sha256(file.read()).hexdigest()
    return found


def manifest(shot: str) -> dict:
    """shot.json less what depends on the clock and the name of the folder."""
    plain = t.read_manifest(shot)
    plain.pop("name")
    for entry in plain["frames"]:
        entry.pop("render_seconds")
    return plain


def exported(out: str) -> tuple[dict[str, str], dict]:
    done = subprocess.run(
        t.blender_command(BLEND, "--out", out, *OPTIONS),
        capture_output=True,
        text=True,
        timeout=600,
    )
    assert done.returncode == 0, (out, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    left = [name for _, _, names in os.walk(out) for name in names if ".tmp" in name]
    assert not left and not os.listdir(os.path.join(out, ".aa", "claims")), left
    return pictures(out), manifest(out)


def started(out: str) -> tuple[subprocess.Popen, float]:
    """An export, and the moment when it first touched its folder."""
    process = subprocess.Popen(
        t.blender_command(BLEND, "--out", out, *OPTIONS),
        stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, start_new_session=True,
    )  # fmt: skip
    while process.poll() is None and not os.path.exists(out):
        time.sleep(0.002)
    return process, time.monotonic()


def test_a_kill_at_any_moment() -> None:
    whole = exported(os.path.join(FOLDER, "whole"))
    process, began = started(os.path.join(FOLDER, "timed"))
    process.wait()
    lasts = time.monotonic() - began
    early = {"before": 0, "between": 0, "after": 0}
    for number in range(COUNT):
        out = os.path.join(FOLDER, f"killed {number}")
        process, _ = started(out)
        after = RANDOM.uniform(0, lasts)
        time.sleep(after)
        what = f"kill {number} after {after:.3f} of {lasts:.3f} s"
        with contextlib.suppress(ProcessLookupError):  # it came to its end before
            os.killpg(process.pid, signal.SIGKILL)
        assert process.wait() in (0, -signal.SIGKILL), (what, process.returncode)
        if process.returncode == 0:
            lasts = min(lasts, after)  # the machine has less to do than it had
        there = pictures(out)
        assert there.items() <= whole[0].items(), what
        if os.path.exists(os.path.join(out, "shot.json")):
            for entry in t.read_manifest(out)["frames"]:
                for key in ("file", "truth"):
                    assert key not in entry or entry[key] in there, (what, entry)
        early["before" if not there else "after" if there == whole[0] else "between"] += 1
        again = exported(out)
        assert again == whole, what
        shutil.rmtree(out)
    print(f"     {COUNT} kills: {json.dumps(early)}", file=sys.stderr)


def test_a_clock_that_is_set_back() -> None:
    """What was written lies in the future then: a picture stays finished, a dead machine's claim does not hold for ever."""
    out = os.path.join(FOLDER, "future")
    whole = exported(out)
    frame = os.path.join(out, "frames", "000002.exr")
    os.unlink(frame)
    claim = os.path.join(out, ".aa", "claims", "frames-000002.json")
    with open(claim, "w", encoding="utf-8") as file:
        json.dump({"host": "another", "pid": 1}, file)
    year = time.time() + 365 * 24 * 3600
    for path, _, names in os.walk(out):
        for name in names:
            os.utime(os.path.join(path, name), (year, year))
    inodes = {
        name: os.stat(os.path.join(out, name)).st_ino for name in whole[0] if "000002" not in name
    }
    assert exported(out) == whole
    assert {
        name: os.stat(os.path.join(out, name)).st_ino for name in inodes
    } == inodes, "what was there stays"


if __name__ == "__main__":
    t.main(test_a_kill_at_any_moment, test_a_clock_that_is_set_back)
