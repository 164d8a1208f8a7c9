"""From a Blender scene to figures, small: build the scene, export, check, run. The published order must hold."""

from __future__ import annotations

import hashlib
import json

from program import ROOT, ProgramTest, main, run_blender


class FromBlender(ProgramTest):
    def blender(self, *arguments: object) -> None:
        done = run_blender(*arguments)
        self.assertEqual(done.returncode, 0, done.stdout[-2000:] + done.stderr[-2000:])

    def test_hard_edges(self) -> None:
        blend, shot, out = self.folder / "scene.blend", self.folder / "shot", self.folder / "out"
        self.blender("--factory-startup", "--python-exit-code", 9, "-P", ROOT / "scenes/hard_edges.py", "--", "--out", blend)
        before = hashlib.sha256(blend.read_bytes()).hexdigest()
        methods = ["noaa", "fxaa311", "uncharted", "unchartedNorm", "accum"]
        self.blender(
            blend, "--python-exit-code", 9, "-P", ROOT / "blender_addon/aa_resolve/headless.py", "--",
            "--out", shot, "--for", ",".join(methods), "--passes", "normal,object", "--resolution", 240, 136,
            "--frames", "1-16", "--truth-samples", 16,
        )  # fmt: skip
        self.assertEqual(before, hashlib.sha256(blend.read_bytes()).hexdigest(), "the user's file was changed")
        self.aaresolve("check", shot)
        self.aaresolve("run", shot, *[word for m in methods for word in ("-m", m)], "-o", out, "-q")
        results = json.loads((out / "results.json").read_text())
        psnr = {m["text"]: m["pooled"]["psnr"] for m in results["methods"]}
        self.assertGreater(psnr["accum"], psnr["unchartedNorm"])
        self.assertGreater(psnr["unchartedNorm"], psnr["uncharted"])
        self.assertGreater(psnr["fxaa311"], psnr["noaa"])


main()
