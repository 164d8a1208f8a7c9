"""A model of one's own goes the whole way: a tree of 36,000 triangles, its leaves cut out of cards by alpha."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path

import pictures
from program import ROOT, ProgramTest, main, run_blender

TRUNK_RINGS, TRUNK_SIDES = 100, 30
CARDS = 15000


def in_leaf(x: int, y: int, size: int = 64) -> bool:
    across, along = abs((x + 0.5) / size * 2 - 1), (y + 0.5) / size * 2 - 1
    return across < 0.7 * (1 - along * along)


def write_tree(folder: Path) -> int:
    """tree.obj with its materials and pictures; returns how many triangles it has. Half of the leaves take their alpha
    from a mask, half from the colour picture."""
    generator = random.Random(4)
    lines, triangles = ["mtllib tree.mtl", "o trunk"], 0
    for ring in range(TRUNK_RINGS + 1):
        height, radius = 3.0 * ring / TRUNK_RINGS, 0.3 - 0.2 * ring / TRUNK_RINGS
        for side in range(TRUNK_SIDES):
            angle = 2 * math.pi * side / TRUNK_SIDES
            lines.append(
                f"v {radius * math.cos(angle):.4f} {height:.4f} {radius * math.sin(angle):.4f}"
            )
    lines.append("usemtl bark")
    for ring in range(TRUNK_RINGS):
        for side in range(TRUNK_SIDES):
            here, there = 1 + ring * TRUNK_SIDES, 1 + (ring + 1) * TRUNK_SIDES
            following = (side + 1) % TRUNK_SIDES
            lines.append(f"f {here + side} {there + side} {there + following} {here + following}")
            triangles += 2
    first = (TRUNK_RINGS + 1) * TRUNK_SIDES
    lines += ["vt 0 0", "vt 1 0", "vt 1 1", "vt 0 1"]
    for half, name in enumerate(("mask", "packed")):
        lines += [f"o leaves_{name}", f"usemtl {name}"]
        for _ in range(CARDS // 2):
            away = [generator.gauss(0.0, 1.0) for _ in range(3)]
            reach = (1.4 * generator.random() ** (1 / 3)) / math.hypot(*away)
            centre = [reach * away[0], 3.4 + reach * away[1], reach * away[2]]
            right = [generator.uniform(-0.09, 0.09) for _ in range(3)]
            up = [generator.uniform(-0.12, 0.12) for _ in range(3)]
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                lines.append(
                    "v "
                    + " ".join(f"{c + a * r + b * u:.4f}" for c, r, u in zip(centre, right, up))
                )
            lines.append("f " + " ".join(f"{first + 1 + k}/{1 + k}" for k in range(4)))
            first += 4
            triangles += 2
    (folder / "tree.obj").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "tree.mtl").write_text(
        "newmtl bark\nKd 0.3 0.2 0.1\n"
        "newmtl mask\nKd 0.1 0.4 0.05\nmap_Kd green.png\nmap_d mask.png\n"
        "newmtl packed\nKd 0.5 0.4 0.05\nmap_Kd leaf.png\n",
        encoding="utf-8",
    )
    (folder / "green.png").write_bytes(
        pictures.square_png(64, 4, lambda x, y: (40, 120 + x, 30, 255))
    )
    (folder / "mask.png").write_bytes(
        pictures.square_png(64, 1, lambda x, y: (255 * in_leaf(x, y),))
    )
    (folder / "leaf.png").write_bytes(
        pictures.square_png(64, 4, lambda x, y: (150, 110, 30, 255 * in_leaf(x, y)))
    )
    return triangles


class FromFile(ProgramTest):
    def blender(self, *arguments: object, expect: int = 0) -> str:
        done = run_blender(*arguments)
        said = done.stdout + done.stderr
        self.assertEqual(done.returncode, expect, said[-2000:])
        return said

    def scene(self, *options: object, expect: int = 0) -> str:
        script = ROOT / "scenes/from_file.py"
        return self.blender(
            "--factory-startup", "--python-exit-code", 9, "-P", script, "--", self.folder / "tree.obj", *options,
            expect=expect,
        )  # fmt: skip

    def test_tree(self) -> None:
        triangles = write_tree(self.folder)
        self.assertGreaterEqual(triangles, 30000)
        blend, shot, out = (
            self.folder / "built/tree.blend",
            self.folder / "shot",
            self.folder / "out",
        )
        said = self.scene("--out", blend, "--turn", 1)
        self.assertIn(f"3 meshes, {triangles} triangles", said)
        self.assertIn("up to date", self.scene("--out", blend, "--turn", 1))
        methods = ["noaa", "fxaa311", "taaSimplest", "msaa", "rsaa"]
        self.blender(
            blend, "--python-exit-code", 9, "-P", ROOT / "blender_addon/aa_resolve/headless.py", "--",
            "--out", shot, "--for", ",".join(methods), "--subsamples", "d3d4", "--resolution", "240x136",
            "--frames", "1-4", "--truth-samples", 64, "--truth-frames", "1,4",
        )  # fmt: skip
        self.aaresolve("check", shot)
        self.aaresolve("run", shot, *[word for m in methods for word in ("-m", m)], "-o", out, "-q")
        results = json.loads((out / "results.json").read_text())
        psnr = {m["text"]: m["pooled"]["psnr"] for m in results["methods"]}
        # Sub-samples of the cut-outs, and not of the cards: only then do they come near the truth.
        self.assertGreater(psnr["msaa"], psnr["noaa"] + 3)
        self.assertGreater(psnr["rsaa"], psnr["noaa"])

    def test_what_is_missing_is_named(self) -> None:
        write_tree(self.folder)
        for name in ("leaf.png", "mask.png"):
            (self.folder / name).unlink()
        blend = self.folder / "tree.blend"
        said = self.scene("--out", blend, expect=3)
        self.assertIn("leaf.png", said)
        self.assertIn("mask.png", said)
        self.assertNotIn("green.png", said.split("error: ")[1].splitlines()[0])
        self.assertFalse(blend.exists())
        self.scene("--out", blend, "--ignore-missing")
        (self.folder / "tree.mtl").unlink()
        self.assertIn("tree.mtl", self.scene("--out", blend, expect=3).split("error: ")[1])


main()
