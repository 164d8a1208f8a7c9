"""The study's figures and sentences, on analytic shots: what they say must follow from the figures, both ways."""

from __future__ import annotations

import sys
from program import PROGRAM, ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "scenes/reproduce"))

import studies  # noqa: E402
from catalogue import MOVING, RSAA, SHOTS, SUBSAMPLES  # noqa: E402
from figures import Difference, Run, across, signed, verdict  # noqa: E402
from shots import Workshop, make, scene_sources  # noqa: E402


class Reproduce(ProgramTest):
    def run_of(self, scene: str, methods: str, *options: object) -> Run:
        shot, out = self.folder / scene, self.folder / f"{scene}.run"
        self.aaresolve("synth", scene, "-o", shot, "--size", "96x64", "-q", *options)
        words = [w for m in methods.split() for w in ("-m", m)]
        self.aaresolve("run", shot, *words, "-o", out, "--write", "none", "-q")
        return Run(out)

    def test_verdicts(self) -> None:
        gain = Difference(1.5, 1.0, 2.0, True)
        self.assertEqual(verdict(gain), "**Yes**, 1.50 dB better (95 %: +1.00 to +2.00).")
        self.assertEqual(verdict(-gain), "**No**, 1.50 dB worse (95 %: +1.00 to +2.00).")
        self.assertEqual(
            verdict(-gain, "worse", "better"), "**No**, 1.50 dB better (95 %: +1.00 to +2.00)."
        )
        unsure = Difference(0.1, -0.1, 0.3, False)
        self.assertEqual(
            verdict(unsure), "**Not resolved**: 0.10 dB better (95 %: −0.10 to +0.30)."
        )
        self.assertEqual(
            verdict(-unsure), "**Not resolved**: 0.10 dB worse (95 %: −0.10 to +0.30)."
        )
        hidden = Difference(0.04, 0.03, 0.05, False)
        self.assertIn("**Not resolved beside the truth's noise**: 0.04 dB better", verdict(hidden))
        self.assertEqual(
            str(hidden), "+0.04 dB (+0.03 to +0.05), not resolved beside the truth's noise"
        )
        self.assertIn("Cannot be said", verdict(None))
        self.assertEqual(
            [signed(v) for v in (1.234, -1.234, 0.0, -0.004)], ["+1.23", "−1.23", "0.00", "−0.004"]
        )

    def test_moving(self) -> None:
        known = set(self.aaresolve("list").stdout.split())
        methods = [m for m in MOVING["methods"].split() if m.split(":")[0].split("+")[0] in known]
        run = self.run_of("moving", " ".join(methods), "--frames", 12, "--subsamples", "d3d8")
        # The order of a pair decides the sign and nothing else.
        there, back = run.gain("uncharted", "noaa"), run.gain("noaa", "uncharted")
        self.assertEqual((there.db, there.low, there.high), (-back.db, -back.high, -back.low))
        self.assertTrue(there.resolved and there.low < there.db < there.high < 0)
        # Pairing by tiles gives what the program's own bootstrap gives.
        again = across(run, "uncharted", run, "noaa")
        self.assertAlmostEqual(again.db, there.db, places=9)
        self.assertAlmostEqual(again.low, there.low, delta=0.3 * (there.high - there.low) + 0.05)
        # A fill changes the rejected pixels alone: the error of the others is the same.
        plain, filled = run.methods["accumReject"], run.methods["accumReject+fill=smaa1x"]
        self.assertGreater(plain["rejected"]["share"], 0)
        frames = plain["frames"][1:]
        for a, b in zip(frames, filled["frames"][1:]):
            values = 96 * 64 * 3
            rest = [f["metrics"]["mse"] * values - f["rejected"]["squares"] for f in (a, b)]
            self.assertAlmostEqual(rest[0], rest[1], delta=1e-6 * values)
        page = "\n".join(studies.motion_page({"moving_sphere": run}).lines)
        self.assertIn("exactly where history was rejected", page)
        self.assertEqual(page.count("| `"), len(methods))
        ghost = run.over_time("master", "unchartedNorm", "ghost")
        self.assertIn(verdict(ghost, "less", "more"), page)

    def test_geometry(self) -> None:
        options = ("--jitter", "none", "--frames", 1, "--subsample-color", "--subsamples")
        methods = f"noaa mlaa {SUBSAMPLES} {RSAA}"
        runs = {"hard_edges": self.run_of("two_planes", methods, *options, "d3d8")}
        page = "\n".join(studies.geometry_page(runs).lines)
        self.assertIn(verdict(runs["hard_edges"].gain("rsaa", "msaa")), page)
        # What ran on another shot alone has no error here to be placed by: by name, the same in every run.
        more = [
            f"msaa:filter={f}"
            for f in ("tent", "gaussian", "tent,diameter=1.5", "bspline", "mitchell", "cubic")
        ]
        runs["hard_edges.s4"] = self.run_of(
            "half_planes", " ".join(["noaa", "msaa", "rsaa", *more]), *options, "d3d4"
        )
        page = "\n".join(studies.geometry_page(runs).lines)
        places = [page.index(f"| `{m}` |") for m in sorted(more)]
        self.assertEqual(places, sorted(places))

    def test_sources_of_a_scene(self) -> None:
        """A building block that changes renders anew what it builds, and nothing else."""
        wall = {path.name for path in scene_sources("wall")}
        self.assertEqual(
            wall, {"wall.py", "common.py", "facade.py", "materials.py", "shapes.py"}, wall
        )
        village = {path.name for path in scene_sources("village")}
        self.assertIn("masonry.py", village)
        self.assertNotIn("facade.py", village)

    def test_shots(self) -> None:
        for shot in SHOTS.values():
            if shot.truth_of:
                lender = SHOTS[shot.truth_of]
                self.assertEqual(
                    (shot.scene, shot.variant, shot.size),
                    (lender.scene, lender.variant, lender.size),
                )
        shop = Workshop(PROGRAM, "no blender", self.folder, "quick", {"noaa"})
        folder = make(SHOTS, SHOTS["synth_moving"], shop)
        self.assertTrue((folder / "shot.json").exists())
        self.assertTrue(shop.serves("noaa") and not shop.serves("noaa+fill=none"))


main()
