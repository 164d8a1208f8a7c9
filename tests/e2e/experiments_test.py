"""Published tables as data: their files, the shots that they share, and what outcomes say of claims, on analytic shots."""

from __future__ import annotations

import json
import math
import sys
from dataclasses import replace
from xml.etree import ElementTree

from program import PROGRAM, ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "scenes/reproduce"))

import chart  # noqa: E402
import experiments  # noqa: E402
import outcomes  # noqa: E402
import shots  # noqa: E402
import tables  # noqa: E402
from catalogue import SHOTS  # noqa: E402
from experiments import Claim, Experiment, Protocol  # noqa: E402
from reproduce import estimate, needed_shots  # noqa: E402
from runs import run_methods  # noqa: E402
from shots import Shot, Workshop, is_ready, make  # noqa: E402


class Files(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.catalogue = dict(SHOTS)
        self.known = experiments.load(self.catalogue)

    def test_every_file_is_whole(self) -> None:
        for key, e in self.known.items():
            texts = [
                *e.methods.values(),
                *e.protocol.beside,
                *e.protocol.parts,
                *(o[k] for o in e.options for k in ("with", "without")),
                *(row["method"] for row in e.rows),
            ]
            self.aaresolve(
                "plan", *dict.fromkeys(texts)
            )  # names, parameters, values; none without effect
            columns = e.published.get("columns")
            for name, row in e.published.items():
                if columns and name != "columns":
                    self.assertEqual(len(row), len(columns), (key, name))
            for claim in e.claims:
                names = claim.of if isinstance(claim.of, list) else [claim.of]
                for name in names:
                    if isinstance(name, str) and name not in self.known:
                        rows = [row["name"] for row in e.rows]
                        self.assertIn(name, [*e.methods, *e.shots, *rows], (key, claim))
            for name in (*e.shots.values(), *e.on):
                shot = self.catalogue[name]
                scene = shot.scene.removeprefix("synth:")
                self.assertTrue(
                    shot.scene != scene or (ROOT / f"scenes/{scene}.py").exists(), (key, scene)
                )

    def test_published_triples_agree(self) -> None:
        """PSNR and RMSD follow from MSE: what was copied wrongly would not."""
        for key, e in self.known.items():
            columns = e.published.get("columns", [])
            if not {"mse", "rmse", "psnr"} <= set(columns):
                continue
            for name in (n for n in e.published if n != "columns"):
                row = dict(zip(columns, e.published[name]))
                self.assertAlmostEqual(
                    row["rmse"], math.sqrt(row["mse"]), delta=0.002, msg=f"{key} {name}"
                )
                self.assertAlmostEqual(
                    row["psnr"], 10 * math.log10(255**2 / row["mse"]), delta=0.005, msg=f"{key} {name}"
                )  # fmt: skip

    def test_shots_are_shared(self) -> None:
        self.assertEqual(self.known["oliveros-5.1"].shots, self.known["oliveros-5.6"].shots)
        main = self.known["oliveros-5.8"].shots["main"]
        self.assertEqual(main, "hard_edges", "the studies' export serves the table")
        self.assertIn("master", self.catalogue[main].all_methods())
        first, second = (self.known[k].shots for k in ("linkoping-5.1", "linkoping-5.17"))
        self.assertEqual(first["main"], second["main"])
        self.assertNotEqual(
            first["t2msaa"], second["t2msaa"], "the jitter before projection is another picture"
        )
        sizes = self.known["oliveros-4.1"].shots
        self.assertEqual(len(set(sizes.values())), 2, "two truths, two shots")
        for shot in self.catalogue.values():
            if shot.truth_of:
                lender = self.catalogue[shot.truth_of]
                for form in ("quick", "whole", "full"):
                    self.assertEqual(shot.in_form(form).size, lender.in_form(form).size, shot.name)
        wanted = needed_shots(
            ["linkoping-5.17"], {"linkoping-5.17": self.known["linkoping-5.17"]}, self.catalogue
        )
        self.assertEqual(wanted[0], self.catalogue[second["s2"]].truth_of, "a lender comes first")

    def test_bad_files_are_told(self) -> None:
        good = (experiments.FOLDER / "oliveros-5.8.toml").read_text()
        protocols = (experiments.FOLDER / "protocols.toml").read_text()
        cases = (
            (good.replace('kind = "table"', 'kind = "tabel"'), "kind: expected table"),
            (good.replace("frames = 16", "frame = 16"), "unknown key 'frame'"),
            (
                good.replace('protocol = "oliveros still"', 'protocol = "still"'),
                "protocol: expected oliveros still",
            ),
            (good.replace("better =", "bester ="), "a claim: expected one of better"),
            (good + "\n[[", "bad.toml"),
            (good.replace('title = "Hard edges"\n', ""), "expected the key 'title'"),
        )
        before = experiments.FOLDER
        try:
            experiments.FOLDER = self.folder
            (self.folder / "protocols.toml").write_text(protocols)
            for text, expected in cases:
                (self.folder / "bad.toml").write_text(text)
                with self.assertRaises(experiments.BadExperiment) as told:
                    experiments.load(dict(SHOTS))
                self.assertIn(expected, str(told.exception))
                self.assertNotIn("\n", str(told.exception).split("(at")[0])
        finally:
            experiments.FOLDER = before


class Outcomes(ProgramTest):
    METHODS = {
        "No AA": "noaa",
        "SMAA": "smaa1x:preset=ULTRA",
        "Master": "master",
        "Uncharted": "uncharted",
    }

    def outcome(
        self, scene: str, kind: str, published: dict, claims: list[Claim],
        flags: tuple[str, ...] = ("--display", "identity", "--quantise", "8"), **more,
    ) -> outcomes.Outcome:  # fmt: skip
        shot = Shot(
            scene,
            f"synth:{scene}",
            "",
            frames=8,
            quick_frames=8,
            size=(96, 64),
            jitter="thesis",
            serves="noaa master",
        )
        listed = self.aaresolve("list").stdout.split()
        shop = Workshop(PROGRAM, "no blender", self.folder, "quick", set(listed))
        e = Experiment(
            "test", kind, "Nobody 2000", "1", "Test", "A test.",
            Protocol(flags=flags, codes=255.0), shots={"main": scene},
            methods=self.METHODS, published=published, claims=tuple(claims), **more,
        )  # fmt: skip
        return outcomes.of(e, {scene: shot}, shop, {})

    def test_table(self) -> None:
        names = list(self.METHODS)
        claims = [
            Claim("a", "better", ["Master", "Uncharted"], {}),
            Claim(
                "b",
                "better",
                ["Uncharted", "Master"],
                {"else": "Because.", "why": [["what it is", "master", "uncharted"]]},
            ),
            Claim("c", "near", ["Master", "Master"], {"within": 0.5}),
            Claim("d", "best", "Uncharted", {}),
        ]
        published = {"columns": ["psnr"], **{n: [30.0 + i] for i, n in enumerate(names)}}
        o = self.outcome("half_planes", "table", published, claims)
        ours = {n: o.by_name[n]["psnr"] for n in names}
        for n in names:  # the units of the protocol
            self.assertAlmostEqual(
                ours[n], 10 * math.log10(255**2 / o.by_name[n]["mse"]), places=6
            )
        sign = lambda v: (v > 0) - (v < 0)  # noqa: E731
        pairs = [(a, b) for i, a in enumerate(names) for b in names[:i]]
        tau = sum(sign(ours[a] - ours[b]) for a, b in pairs) / len(pairs)
        self.assertAlmostEqual(o.taus["psnr"], tau)
        d = o.gain("Master", "Uncharted")
        self.assertTrue(d.resolved and d.db > 0, d)
        self.assertEqual(
            [v.answer for v in o.verdicts], ["holds", "does not hold", "holds", "does not hold"]
        )
        self.assertEqual(o.verdicts[1].reasons, ["Because.", f"Measured: what it is {d}."])
        again = run_methods(
            o.folders["main"], "another name", o.experiment.texts(), o.shop, o.experiment.protocol.flags, "exr"
        )  # fmt: skip
        self.assertEqual(again.folder, o.run.folder, "the same run under another name")
        some = o.run.with_methods_alone(["noaa", "master"], self.folder / "some")
        self.assertEqual(list(some.methods), ["noaa", "master"])
        self.assertEqual(some.gain("master"), o.run.gain("master"))
        self.aaresolve("sheet", some.folder, "-o", self.folder / "sheet.png")
        page = "\n".join(tables.source_page("T", [o], {}, {}).lines)
        self.assertIn(f"| Master (`master`) | 32.00 / {ours['Master']:.2f} |", page)
        agreement = "\n".join(tables.agreement_page([o], {"Nobody 2000": "t.md"}).lines)
        self.assertIn("2 claims **holds**", agreement)
        self.assertIn("(t.md#1-test)", agreement)

    def test_table_of_gains(self) -> None:
        """As a talk gives them; of one method or none there is no order."""
        two = {"columns": ["gain"], "SMAA": [1.0], "Master": [2.0]}
        o = self.outcome("half_planes", "table", two, [])
        self.assertEqual(o.taus["gain"], 1.0 if o.gain("Master").db > o.gain("SMAA").db else -1.0)
        page = "\n".join(tables.source_page("T", [o], {}, {}).lines)
        self.assertIn("| SMAA (`smaa1x:preset=ULTRA`) | +1.00 | ", page)
        self.assertEqual(self.outcome("half_planes", "table", {"columns": ["gain"]}, []).taus, {})

    def test_ghosts(self) -> None:
        row = {k: [1.0, 2.0, 1.5, 3, 4] for k in ("mse", "psnr", "snr", "ssimLuma")}
        o = self.outcome("moving", "ghosts", {"Uncharted": row, "Master": row}, [])
        best, worst, mean, at_best, at_worst = outcomes.extremes(o, "Master", "mse")
        frames = [65025 * f["metrics"]["mse"] for f in o.run.methods["master"]["frames"]]
        self.assertEqual(
            (at_best, at_worst), (frames.index(min(frames)), frames.index(max(frames)))
        )
        self.assertAlmostEqual(best, min(frames))
        self.assertAlmostEqual(worst, max(frames))
        self.assertAlmostEqual(mean, sum(frames) / len(frames))
        top, low, *_ = outcomes.extremes(o, "Master", "psnr")
        self.assertGreater(top, low)
        page = "\n".join(tables.source_page("T", [o], {}, {}).lines)
        self.assertIn(f"3, 4 / {at_best}, {at_worst}", page)

    def test_codes(self) -> None:
        """Written pictures against a truth that is not rounded."""
        rows = (
            {"name": "floats", "method": "accum", "write": "exr"},
            {"name": "codes", "method": "accum", "write": "png"},
            {"name": "dithered", "method": "accum", "write": "png", "flags": ["--dither"]},
        )
        pairs = (["codes", "dithered"], ["dithered", "codes"])
        claims = [Claim("a", "lower", pair, {"figure": "mse"}) for pair in pairs]
        more = dict(flags=("--display", "identity"), rows=rows, on=("half_plane",))
        o = self.outcome("half_plane", "codes", {}, claims, **more)
        self.assertEqual(set(o.by_name["codes"]), {"banding", "grain", "mse", "psnr"})
        self.assertNotEqual(o.by_name["floats"]["mse"], o.by_name["codes"]["mse"])
        endings = {name: picture.suffix for name, picture in o.pictures.items()}
        written = {"floats": ".exr", "codes": ".png", "dithered": ".png", "Truth": ".exr"}
        self.assertEqual(endings, written)
        self.assertEqual({v.answer for v in o.verdicts}, {"holds", "does not hold"})
        page = "\n".join(tables.source_page("T", [o], {}, {}).lines)
        self.assertIn("| dithered (`accum --dither`, PNG) |", page)

    def test_variants(self) -> None:
        catalogue = {
            name: Shot(
                name, "synth:half_planes", "", frames=4, quick_frames=4, size=(96, 64), jitter=jitter, period=4
            )
            for name, jitter in (("main", "halton23"), ("other", "r2"))
        }  # fmt: skip
        listed = self.aaresolve("list").stdout.split()
        shop = Workshop(PROGRAM, "no blender", self.folder, "quick", set(listed))
        claims = tuple(
            Claim("a", "better_shot", pair, {"method": "TAA"})
            for pair in (["main", "other"], ["other", "main"])
        )
        e = Experiment(
            "test", "variants", "Nobody 2000", "1", "Test", "A test.", Protocol(),
            shots={"main": "main", "other": "other"}, methods={"TAA": "taaSimplest", "No AA": "noaa"},
            published={"columns": ["psnr"]}, claims=claims,
        )  # fmt: skip
        o = outcomes.of(e, catalogue, shop, {})
        self.assertEqual(
            {v.answer for v in o.verdicts}, {"holds", "does not hold"}, "what one says the other denies"
        )  # fmt: skip
        self.assertIn("| other (", "\n".join(tables.source_page("T", [o], {}, {}).lines))

    def test_series(self) -> None:
        claims = [
            Claim("a", "dips", "Uncharted", {"by": -100.0, "over": "No AA"}),
            Claim("b", "above_in_moment", ["Master", "Uncharted"], {}),
        ]
        o = self.outcome("moving", "series", {}, claims, moment=(3, 5))
        psnr = {
            t: [f["metrics"]["psnr"] for f in o.run.methods[t]["frames"]]
            for t in ("noaa", "master", "uncharted")
        }
        gains = outcomes.gains_over_time(o, "Master")
        self.assertEqual(list(gains), list(range(1, 9)))
        self.assertAlmostEqual(gains[4], psnr["master"][3] - psnr["noaa"][3])
        inside, outside = outcomes.moment(o, "Master")
        self.assertEqual((len(inside), len(outside)), (3, 5))
        ahead = [a - b for a, b in zip(psnr["master"][2:5], psnr["uncharted"][2:5])]
        answer = (
            "holds" if min(ahead) > 0 else "does not hold" if sum(ahead) < 0 else "holds on some"
        )
        self.assertEqual([v.answer for v in o.verdicts], ["holds", answer])
        self.assertIn("in frames 3 to 5", "\n".join(tables.source_page("T", [o], {}, {}).lines))

    def test_rates(self) -> None:
        o = self.outcome("moving", "rates", {}, [])
        self.assertEqual(o.by_name["No AA"]["color"], 1)
        self.assertEqual(o.by_name["No AA"]["bytes"], 12, "three floats")
        self.assertEqual(o.by_name["Master"]["history"], 1)

    def test_estimate_and_cache(self) -> None:
        shot = replace(SHOTS["synth_moving"], size=(64, 36), quick_frames=4)
        shop = Workshop(PROGRAM, "no blender", self.folder, "quick", {"noaa"})
        self.assertFalse(is_ready(shot, shop))
        make({shot.name: shot}, shot, shop)
        self.assertTrue(is_ready(shot, shop))
        self.assertFalse(is_ready(replace(shot, period=8), shop), "another content")
        self.assertIn("to render", estimate(["synth_moving"], shop))

    def test_a_lent_truth_is_renewed(self) -> None:
        """A lender with a better truth gives that to its borrowers, too, without another render of theirs."""
        plain = Shot("lender", "synth:half_planes", "", frames=2, quick_frames=2, size=(48, 32))
        lent = replace(plain, name="borrower", truth_of="lender", jitter="r2")
        both = {s.name: s for s in (plain, lent)}
        shop = Workshop(PROGRAM, "no blender", self.folder, "quick", {"noaa"})
        lender, borrower = (make(both, s, shop) for s in both.values())
        shots._lend_truth(lender, borrower)
        text = json.loads((lender / "shot.json").read_text())
        self.assertTrue(shots._has_lent_truth(lender, borrower))
        path = next(f["truth"] for f in text["frames"] if "truth" in f)
        better = (lender / path).read_bytes() + b"better"
        (lender / path).unlink()
        (lender / path).write_bytes(better)
        text["truth"]["samples_per_half"] = 512
        (lender / "shot.json").write_text(json.dumps(text))
        make(both, lent, shop)
        self.assertEqual((borrower / path).read_bytes(), better)
        ours = json.loads((borrower / "shot.json").read_text())
        self.assertEqual(ours["truth"]["samples_per_half"], 512)

    def test_curves(self) -> None:
        path = self.folder / "a.svg"
        lines = {"low": [1.0, math.inf, 1.0], "A & B": [2.0, 2.0, 3.0], "near": [2.0, 2.0, 2.99]}
        chart.write_svg(path, lines, "T < U", "dB")
        drawn = [e for e in ElementTree.parse(path).getroot().iter() if e.tag.endswith("}text")]
        self.assertEqual(
            path.read_text().count('<path d="M'), 8, "five lines at 1, 1.5 ... 3, three curves"
        )
        self.assertNotIn("inf", path.read_text())
        self.assertEqual(drawn[0].text, "T < U")
        heights = {e.text: float(e.get("y")) for e in drawn if e.text in lines}
        self.assertLess(
            heights["A & B"] + chart.NAME_HEIGHT, heights["near"] + 0.11, "no name on another"
        )
        self.assertLess(heights["near"] + 100, heights["low"], "each where its line ends")

    def test_ticks_are_round(self) -> None:
        for (low, high), wanted in {
            (0, 19.3): [0, 5, 10, 15],
            (18.2, 24.9): [20, 22, 24],
            (1, 3): [1, 1.5, 2, 2.5, 3],
            (-0.5, 0.5): [-0.4, -0.2, 0, 0.2, 0.4],
            (0, 66e-4): [0, 2e-3, 4e-3, 6e-3],
        }.items():
            found = chart.ticks(low, high)
            self.assertEqual(len(found), len(wanted), f"{low} to {high}: {found}")
            for a, b in zip(found, wanted):
                self.assertAlmostEqual(a, b)

    def test_names_stand_apart(self) -> None:
        self.assertEqual(chart.apart([10, 50, 90], 15, 0, 100), [10, 50, 90])
        self.assertEqual(chart.apart([50, 50, 50], 15, 0, 100), [35, 50, 65])
        self.assertEqual(chart.apart([99, 100], 15, 0, 100), [85, 100])
        self.assertEqual(chart.apart([1, 0], 15, 0, 100), [15, 0])
        found = chart.apart([40, 44, 58, 61], 15, 0, 100)
        for a, b in zip(found, found[1:]):
            self.assertGreaterEqual(b - a, 15 - 1e-9)


main()
