"""Parameter sweeps: every combination once, the same figures as `run`, whatever the memory allows at a time."""

from __future__ import annotations

import csv
import json

from program import ProgramTest, main


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
            "sweep", self.shot, "-m", "uncharted:kmax=0.95", *vary, "-o", out, "-q"
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
            said.append(done.stdout.splitlines()[-2])
        self.assertIn("6 variants in 1 pass ", said[0])
        self.assertNotIn("1 pass ", said[1])
        self.assertEqual(
            [m["pooled"] for m in self.results(outs[0])["methods"]],
            [m["pooled"] for m in self.results(outs[1])["methods"]],
        )
        self.assertEqual(self.results(outs[0])["pairs"], self.results(outs[1])["pairs"])
        images = [
            {p.relative_to(out): p.read_bytes() for p in sorted(out.rglob("*.exr"))} for out in outs
        ]
        self.assertEqual(images[0], images[1])

    def test_usage(self) -> None:
        def refuse(says: str, *vary: str, method: str = "uncharted") -> None:
            words = [w for v in vary for w in ("--vary", v)]
            self.refused(
                2, "sweep", self.shot, "-m", method, *words, "-o", self.folder / "o", says=(says,)
            )

        refuse("NAME=VALUE", "kmin")
        refuse("NAME=VALUE", "kmin=")
        refuse("NAME=VALUE", "kmin=0.5,0.5")
        refuse("varied twice", "kmin=0.1,0.2", "kmin=0.3")
        refuse("did you mean 'kmin'", "kmni=0.5")
        refuse("0 to 1", "kmin=0.5,2")
        refuse("more than 256", "kmin=" + ",".join(str(i / 1000) for i in range(300)))
        refuse("varied and fixed", "kmin=0.1,0.2", method="uncharted:kmin=0.5")
        self.assertFalse((self.folder / "o").exists(), "a refused sweep leaves nothing behind")


main()
