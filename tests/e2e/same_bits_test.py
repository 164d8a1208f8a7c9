"""Every method on small synthetic shots gives the bits in same_bits.json, whatever compiler and libraries built it.

    python3 tests/e2e/same_bits_test.py build/aaresolve . --update     rewrites the file: `make bits`

A method that differs here and nowhere else in the suite is the build's doing: another compiler, libm or library.
The shots themselves are hashed, too: where they differ, the methods are not to blame. The host's code calls libm in
double (sin, cos, exp, log, pow, atan2, acos, hypot); glibc 2.36, 2.41 and 2.43 give the same bits for these, with and
without FMA others, which rounding to float hides in these shots. In float only cbrt and acos differ; nothing calls them.
"""

from __future__ import annotations

import hashlib
import json
import sys

import exr_pixels
from program import ROOT, ProgramTest, main

FILE = ROOT / "tests/e2e/same_bits.json"
SIZE = ("--size", "96x54", "--frames", "4")
# Shot: scene and sub-sample pattern. Together they serve every method.
SHOTS = {"half_planes": "d3d2", "moving": "d3d4", "two_planes": "d3d8"}
# What a shot does not serve: csaa has 4 slots; a disc has no straight edges; accum is for static shots.
NOT_SERVED = {
    "half_planes": {"csaa"},
    "moving": {"accum", "gbaa", "gpaa", "d2e"},
    "two_planes": set(),
}
# Variants that run code of their own; each method also runs with its defaults.
VARIANTS = [
    "accum:space=encoded",
    "fxaa1:preset=5",
    "fxaa311:preset=39",
    "fxaacs:preset=39",
    "resolve:filter=gaussian",
    "resolve:filter=mitchell",
    "resolve:filter=lanczos",
    "resolve:filter=blackmanHarris",
    "uncharted:history=catmullRom",
    "uncharted:historyBits=8",
]


def digest(pixels: bytes) -> str:
    return hashlib.sha256(pixels).hexdigest()


class SameBits(ProgramTest):
    def found(self) -> dict[str, dict[str, str]]:
        """Shot: method, or pass of the shot's last frame: SHA-256 of its float pixels (a method's over all frames)."""
        methods = json.loads(self.aaresolve("list", "--json").stdout)["methods"]
        bits = {}
        for scene, pattern in SHOTS.items():
            shot, out = self.folder / scene, self.folder / f"{scene}.out"
            self.aaresolve(
                "synth",
                scene,
                "-o",
                shot,
                "-q",
                *SIZE,
                "--subsamples",
                pattern,
                "--subsample-color",
            )
            served = [m["id"] for m in methods if pattern in m.get("patterns", [pattern])]
            served = [m for m in served if m not in NOT_SERVED[scene]]
            specs = served + [v for v in VARIANTS if v.split(":")[0] in served]
            chosen = [word for spec in specs for word in ("-m", spec)]
            self.aaresolve(
                "run", shot, *chosen, "-o", out, "-q", "--write", "exr", "--write-frames", "all"
            )
            here = bits[scene] = {}
            for folder in sorted(f for f in shot.iterdir() if f.is_dir()):
                last = exr_pixels.parts_of(max(folder.glob("*.exr")))
                here.update(
                    {f"input {folder.name}/{part}": digest(last[part]) for part in sorted(last)}
                )
            for spec in specs:
                frames = sorted((out / spec.replace(":", "_")).glob("*.exr"))
                self.assertEqual(len(frames), 4, spec)
                here[spec] = digest(b"".join(exr_pixels.parts_of(f)[""] for f in frames))
        unserved = {m["id"] for m in methods}.difference(*bits.values())
        self.assertFalse(unserved, "no shot of this test serves these methods: add one to SHOTS")
        return bits

    def test_bits(self) -> None:
        found = self.found()
        if UPDATE:
            FILE.write_text(json.dumps(found, indent=1) + "\n")
        wanted = json.loads(FILE.read_text())
        differ = [
            f"{shot}: {name}"
            for shot in {**wanted, **found}
            for name in {**wanted.get(shot, {}), **found.get(shot, {})}
            if found.get(shot, {}).get(name) != wanted.get(shot, {}).get(name)
        ]
        advice = "if a method was meant to change, `make bits`; otherwise this build computes something else"
        if differ:
            self.fail(
                "other bits than in same_bits.json:\n  " + "\n  ".join(differ) + f"\n{advice}"
            )


UPDATE = "--update" in sys.argv
if __name__ == "__main__":
    main()
