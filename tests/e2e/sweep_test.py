"""Parameter sweeps: every combination once, the same figures as `run`, whatever the memory allows at a time."""

from __future__ import annotations

import csv
import json
import re

from program import ProgramTest, digests, main


class Sweep(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot = self.folder / "shot"
        self.synth("moving", self.shot, (64, 40), 5, "--for", "noaa,uncharted", "-q")

    def results(self, out) -> dict:
        return json.loads((out / "results.json").read_text())

    def test_all_combinations_as_run_measures_them(self) -> None:
        out, again = self.folder / "sweep", self.folder / "run"
        vary = ("--vary", "kmin=0.5,0.9", "--vary", "sharpen=none,norm")
        done = self.aaresolve(
            "sweep",
            self.shot,
            "-m",
            "uncharted:kmax=0.95",
            *vary,
            "-o",
            out,
            "-q",
            "--metrics",
            "flip,ssimRgb",
        )
        texts = [m["text"] for m in self.results(out)["methods"]]
        expected = [
            f"uncharted:kmax=0.95,kmin={k},sharpen={s}"
            for k in ("0.5", "0.9")
            for s in ("none", "norm")
        ]
        self.assertEqual(texts, ["noaa", *expected])
        rows = done.stdout.splitlines()[1:6]
        psnr = [float(row.split()[1]) for row in rows]
        self.assertEqual(psnr, sorted(psnr, reverse=True))
        self.aaresolve("run", self.shot, *[w for t in texts for w in ("-m", t)], "-o", again, "-q")
        figures = [
            {m["text"]: (m["pooled"], m["temporal"]) for m in self.results(o)["methods"]}
            for o in (out, again)
        ]
        self.assertEqual(figures[0], figures[1])
        self.assertEqual(self.results(out)["pairs"], self.results(again)["pairs"])
        tables = []
        for folder in (out, again):
            with (folder / "results.csv").open() as file:
                tables.append(
                    [(row["method"], row["frame"], row["psnr"]) for row in csv.DictReader(file)]
                )
        self.assertGreaterEqual(len(tables[0]), 5 * 5)
        self.assertEqual(tables[0], tables[1])
        self.aaresolve("sheet", out, "-o", self.folder / "sheet.png")
        self.aaresolve("report", out, "-o", self.folder / "report.html")
        self.assertIn("kmin=0.9", (self.folder / "report.html").read_text())

    def test_little_memory_means_more_passes_and_the_same_results(self) -> None:
        outs = [self.folder / "one", self.folder / "many"]
        said = []
        for out, memory in zip(outs, ("2048", "1")):
            done = self.aaresolve(
                "sweep",
                self.shot,
                "-m",
                "uncharted",
                "--vary",
                "kmin=0.1,0.3,0.5,0.7,0.9",
                "-o",
                out,
                "-q",
                "--memory",
                memory,
            )
            said.append(next(x for x in done.stdout.splitlines() if " variants in " in x))
        self.assertIn("6 variants in 1 pass ", said[0])
        self.assertNotIn("1 pass ", said[1])
        self.assertEqual(
            [m["pooled"] for m in self.results(outs[0])["methods"]],
            [m["pooled"] for m in self.results(outs[1])["methods"]],
        )
        self.assertEqual(self.results(outs[0])["pairs"], self.results(outs[1])["pairs"])
        images = [digests(out) for out in outs]
        self.assertEqual(images[0], images[1])

    def test_ranges_and_the_best_in_words(self) -> None:
        out = self.folder / "ranges"
        done = self.aaresolve(
            "sweep",
            self.shot,
            "-m",
            "uncharted",
            "--vary",
            "kmin=0.1,0.8..0.95:0.05",
            "-o",
            out,
            "-q",
        )
        texts = [m["text"] for m in self.results(out)["methods"]]
        self.assertEqual(
            texts,
            ["noaa", *(f"uncharted:kmin={k}" for k in ("0.1", "0.8", "0.85", "0.9", "0.95"))],
        )
        results = self.results(out)
        best = max(results["methods"][1:], key=lambda m: m["pooled"]["psnr"])
        words = next(
            line for line in done.stdout.splitlines() if line.startswith("uncharted: kmin=")
        )
        self.assertIn(best["text"].split(":")[1] + " is best", words)
        self.assertRegex(words, r"over no anti-aliasing \(95 %: [+-]\d+\.\d\d to [+-]\d+\.\d\d\)")
        # Those that its words say cannot be told apart from it are those of the pairs.
        index = texts.index(best["text"])
        alike = {
            texts[p["first"] + p["second"] - index]
            for p in results["pairs"]
            if index in (p["first"], p["second"]) and not p["resolved"]
        } - {"noaa"}
        for text in texts[1:]:
            value = text.split("=")[1]
            told = re.search(
                rf"(?<![\d.]){re.escape(value)}(?![\d.])", words.split(" over no anti")[1]
            )
            if len(alike) < 3 and text != best["text"]:
                self.assertEqual(bool(told), text in alike, words)
        page = (out / "sweep.html").read_text()
        self.assertIn(f"curves: {out}/sweep.html", done.stdout)
        data = json.loads(page.split('id="data">')[1].split("</script>")[0].replace("<\\/", "</"))
        self.assertEqual(data["axes"][0]["values"], ["0.1", "0.8", "0.85", "0.9", "0.95"])
        self.assertEqual([v["best"] for v in data["variants"]].count(True), 1)
        self.assertEqual({v["text"] for v in data["variants"] if v["alike"]}, alike)
        # Here less is better: at the end of what was tried one is told to go on, at the parameter's own end not.
        self.assertEqual(best["text"], "uncharted:kmin=0.1")
        self.assertIn(
            "lies at the lower end of the values that were tried; go on below 0.1.", done.stdout
        )
        limit = self.aaresolve(
            "sweep", self.shot, "-m", "uncharted", "--vary", "kmin=0,0.4,0.9", "-o", out, "-q"
        )
        self.assertIn("uncharted: kmin=0 is best", limit.stdout)
        self.assertNotIn("go on", limit.stdout)
        whole = self.folder / "whole"
        self.aaresolve(
            "sweep",
            self.shot,
            "-m",
            "uncharted",
            "--vary",
            "kmin=0..1",
            "--vary",
            "kmax=1",
            "-o",
            whole,
            "-q",
            "--json",
        )
        self.assertEqual(
            [m["text"] for m in self.results(whole)["methods"][1:]],
            ["uncharted:kmin=0,kmax=1", "uncharted:kmin=1,kmax=1"],
        )

    def test_usage(self) -> None:
        def refuse(says: str, *vary: str, method: str = "uncharted") -> None:
            words = [w for v in vary for w in ("--vary", v)]
            self.refused(
                2, "sweep", self.shot, "-m", method, *words, "-o", self.folder / "o", says=(says,)
            )

        refuse("NAME=VALUE", "kmin")
        refuse("NAME=VALUE", "kmin=")
        refuse("NAME=VALUE", "kmin=0.5,0.5")
        refuse("FIRST..LAST:STEP", "kmin=0.5..0.9")
        refuse("FIRST..LAST:STEP", "kmin=0.5..0.9:0")
        refuse("FIRST..LAST:STEP", "kmin=0.5..0.9:-0.1")
        refuse("FIRST..LAST:STEP", "kmin=a..b:c")
        refuse("that ascends", "kmin=0.9..0.5:0.1")
        refuse("different values", "kmin=0.5,0.4..0.6:0.1")
        refuse("more than 256", "kmin=0..1:0.0001")
        refuse("varied twice", "kmin=0.1,0.2", "kmin=0.3")
        refuse("did you mean 'kmin'", "kmni=0.5")
        refuse("0 to 1", "kmin=0.5,2")
        refuse("more than 256", "kmin=" + ",".join(str(i / 1000) for i in range(300)))
        refuse("varied and fixed", "kmin=0.1,0.2", method="uncharted:kmin=0.5")
        self.assertFalse((self.folder / "o").exists(), "a refused sweep leaves nothing behind")


main()
