"""From Blender scenes to figures, small: build or import the scene, export, check, run. The published order must hold."""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path

import pictures
from program import PROGRAM, ROOT, ProgramTest, main, run_blender


# A Blender of another Debian cannot start what was built for this one: make bundle makes one that it can.
PROGRAM_IN_BLENDER = os.environ.get("AA_PROGRAM_IN_BLENDER") or str(PROGRAM)
ALL_PASSES = "albedo,depth,normal,object,motion,subsamples,edges,segments"
OBJ = """# as other programs write it: y up, quads, groups, two materials, texture coordinates
mtllib model.mtl
o fence
v -2 0 0\nv 2 0 0\nv 2 2.4 0\nv -2 2.4 0
vt 0 0\nvt 3 0\nvt 3 2\nvt 0 2
vn 0 0 1
usemtl leaves
f 1/1/1 2/2/1 3/3/1 4/4/1
o house
v -1.5 0 -3\nv 1.5 0 -3\nv 1.5 2 -3\nv -1.5 2 -3\nv -1.5 0 -5\nv 1.5 0 -5\nv 1.5 2 -5\nv -1.5 2 -5\nv 0 3.2 -3\nv 0 3.2 -5
usemtl bricks
f 5/1 6/2 7/3 8/4
f 6/1 10/2 11/3 7/4
f 9/1 5/2 8/3 12/4
f 8/1 7/2 13/3
f 7/1 11/2 14/3 13/4
f 12/1 8/2 13/3 14/4
o ground
v -12 0 6\nv 12 0 6\nv 12 0 -14\nv -12 0 -14
f 15/1 16/2 17/3 18/4
"""
MTL = """newmtl leaves
Kd 1 1 1\nmap_Kd leaves.png\nmap_d leaves.png
newmtl bricks
Kd 0.8 0.8 0.8\nmap_Kd bricks.png
"""


class FromBlender(ProgramTest):
    def blender(self, *arguments: object) -> None:
        done = run_blender(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])

    def export(self, blend: Path, shot: Path, *options: object) -> None:
        before = hashlib.sha256(blend.read_bytes()).hexdigest()
        self.blender(
            blend,
            "--python-exit-code",
            9,
            "-P",
            ROOT / "blender_addon/aa_resolve/headless.py",
            "--",
            "--out",
            shot,
            *options,
        )
        self.assertEqual(
            before, hashlib.sha256(blend.read_bytes()).hexdigest(), "the user's file was changed"
        )

    def test_foreign_scene(self) -> None:
        """A model of another program, with textures and cut-outs: every pass of it passes every check."""
        (self.folder / "model.obj").write_text(OBJ)
        (self.folder / "model.mtl").write_text(MTL)
        bricks = lambda x, y: (200, 90 + 60 * ((x // 4 + y // 2) % 2), 60, 255)
        (self.folder / "bricks.png").write_bytes(pictures.square_png(16, 4, bricks))
        leaf = lambda x, y: (
            40,
            140,
            60,
            255 if (x - 16) ** 2 + (y - 16) ** 2 < 150 else 0,
        )  # noqa: E731
        (self.folder / "leaves.png").write_bytes(pictures.square_png(32, 4, leaf))
        blend, shot = self.folder / "scene.blend", self.folder / "shot"
        script = Path(__file__).parent / "foreign_scene.py"
        self.blender(
            "--factory-startup",
            "--python-exit-code",
            9,
            "-P",
            script,
            "--",
            self.folder / "model.obj",
            blend,
        )
        self.export(
            blend, shot, "--frames", "1-3", "--for", "uncharted,rsaa", "--passes", ALL_PASSES, "--resolution", "160x90",
            "--truth-samples", 16,
        )  # fmt: skip
        manifest = json.loads((shot / "shot.json").read_text())
        self.assertEqual(sorted(manifest["objects"].values()), ["fence", "ground", "house"])
        self.assertFalse(manifest["static"])
        self.aaresolve("check", shot)
        self.aaresolve(
            "run",
            shot,
            "-m",
            "noaa",
            "-m",
            "uncharted",
            "-m",
            "rsaa",
            "-o",
            self.folder / "out",
            "-q",
        )

    def test_scenes_pass_the_check(self) -> None:
        """Fibres, cut-outs, wires with a skeleton: every scene of scenes/ in small, with every pass it can have."""
        for name, variants in (
            ("hairball", ("--rotating", "--fibres", 200)),
            ("flowers", ("--sway",)),
            ("wires", ()),
        ):
            with self.subTest(name):
                blend, shot = self.folder / f"{name}.blend", self.folder / name
                self.blender(
                    "--factory-startup",
                    "--python-exit-code",
                    9,
                    "-P",
                    ROOT / f"scenes/{name}.py",
                    "--",
                    "--out",
                    blend,
                    *variants,
                )
                self.export(
                    blend, shot, "--frames", "1-2", "--for", "uncharted", "--passes", ALL_PASSES, "--resolution", "96x54",
                    "--truth-frames", "none", "--subsamples", "d3d2",
                )  # fmt: skip
                self.aaresolve("check", shot)

    def test_export_and_compare(self) -> None:
        """The panel's button: export, run the methods, contact sheet in the image editor's place, report."""
        blend, shot = self.folder / "scene.blend", self.folder / "shot"
        self.blender(
            "--factory-startup",
            "--python-exit-code",
            9,
            "-P",
            ROOT / "scenes/moving_sphere.py",
            "--",
            "--out",
            blend,
        )
        script = self.folder / "compare.py"
        script.write_text(
            f"""
import sys, bpy
sys.path.insert(0, {str(ROOT / "blender_addon")!r})
import aa_resolve
from aa_resolve.panel import running, watch
bpy.context.preferences.addons.new().module = "aa_resolve"
aa_resolve.register()
bpy.context.preferences.addons["aa_resolve"].preferences.resolver = {PROGRAM_IN_BLENDER!r}
settings = bpy.context.scene.aa_resolve
settings.out, settings.first, settings.last = {str(shot)!r}, 1, 3
settings.use_resolution, settings.resolution = True, (96, 54)
settings.truth_samples, settings.method_fxaa311 = 4, True
settings.widgets_taaSimplest.set_k = 0.8
assert bpy.ops.aa_resolve.compare() == {{"FINISHED"}}, running.State.result
best = watch.look_now(bpy.context.scene).outcome.best
assert best and best[0].gain is not None, best
sheet = bpy.data.images.load({str(shot)!r} + "_results/sheet.png")
assert sheet.size[0] > 96, sheet.size[:]
assert bpy.ops.aa_resolve.open_report.poll()
for kind in ("TAA", "EVERYTHING"):  # no chosen method refuses a shot that moves
    bpy.ops.aa_resolve.use_preset(kind=kind)
    settings.out, settings.truth_samples = {str(shot)!r} + kind, 2
    settings.use_scene_range, settings.first, settings.last = False, 1, 2
    settings.use_resolution, settings.resolution = True, (96, 54)
    assert bpy.ops.aa_resolve.compare() == {{"FINISHED"}}, running.State.result
aa_resolve.unregister()
"""
        )
        self.blender(blend, "--python-exit-code", 9, "-P", script)
        results = json.loads((self.folder / "shot_results/results.json").read_text())
        self.assertEqual(
            [m["text"] for m in results["methods"]], ["noaa", "fxaa311", "taaSimplest:k=0.8"]
        )

    def test_hard_edges(self) -> None:
        blend, shot, out = self.folder / "scene.blend", self.folder / "shot", self.folder / "out"
        self.blender(
            "--factory-startup",
            "--python-exit-code",
            9,
            "-P",
            ROOT / "scenes/hard_edges.py",
            "--",
            "--out",
            blend,
        )
        before = hashlib.sha256(blend.read_bytes()).hexdigest()
        methods = ["noaa", "fxaa311", "uncharted", "unchartedNorm", "accum"]
        self.blender(
            blend, "--python-exit-code", 9, "-P", ROOT / "blender_addon/aa_resolve/headless.py", "--",
            "--out", shot, "--for", ",".join(methods), "--passes", "normal,object", "--resolution", "240x136",
            "--frames", "1-16", "--truth-samples", 16,
        )  # fmt: skip
        self.assertEqual(
            before, hashlib.sha256(blend.read_bytes()).hexdigest(), "the user's file was changed"
        )
        self.aaresolve("check", shot)
        self.aaresolve("run", shot, *[word for m in methods for word in ("-m", m)], "-o", out, "-q")
        results = json.loads((out / "results.json").read_text())
        psnr = {m["text"]: m["pooled"]["psnr"] for m in results["methods"]}
        self.assertGreater(psnr["accum"], psnr["unchartedNorm"])
        self.assertGreater(psnr["unchartedNorm"], psnr["uncharted"])
        self.assertGreater(psnr["fxaa311"], psnr["noaa"])


main()
