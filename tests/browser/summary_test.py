"""summary_test.py PROGRAM ROOT BROWSER: the page of several runs, opened from disk without a network, in light and dark
and from 390 to 1400 px wide: tables, their sorting, the choice of a figure, charts, runs of one shot held together."""

from __future__ import annotations

import json
import re
from pathlib import Path

from visited_page import PageTest, main

METHODS = ("noaa", "fxaa311", "smaa1x", "taaSimplest")
# Reads the page as it is, then sorts by the mean and asks for another figure.
VISITOR = """
<pre id="collected"></pre>
<script>
  const told = {}, all = (css) => [...document.querySelectorAll(css)].map((e) => e.innerText);
  told.width = innerWidth;
  told.overflow = document.documentElement.scrollWidth - innerWidth;
  told.ground = getComputedStyle(document.body).backgroundColor;
  told.words = all("#words li");
  told.mean = all("#mean tbody tr");
  told.scenes = all("#scenes thead th");
  told.gains = all("#scenes tbody tr");
  told.title = document.querySelector("h1").innerText;
  told.heads = all("#mean thead th");
  told.tones = (id) => Object.fromEntries([...document.querySelectorAll(`#${id} tbody tr`)].map((r) => [r.cells[0].innerText.split("\\n")[0], r.cells[1].className]));
  told.meanTones = told.tones("mean");
  told.sceneTones = told.tones("scenes");
  told.bars = [...Chart.getChart(document.getElementById("gains")).data.datasets[0].backgroundColor].map((c) => c === css("--quiet"));
  told.links = [...document.querySelectorAll("#subtitle a")].map((a) => a.getAttribute("href"));
  told.select = getComputedStyle(document.getElementById("figure")).borderTopLeftRadius;
  told.against = all("#against tbody tr");
  told.chart = Chart.getChart(document.getElementById("gains")).data.labels;
  document.querySelector("#mean thead button").click();
  document.querySelector("#mean thead button").click();
  told.sorted = all("#mean tbody th");
  const pick = document.getElementById("figure");
  told.figures = [...pick.options].map((o) => o.value);
  pick.value = "psnr";
  pick.dispatchEvent(new Event("change"));
  told.psnr = all("#scenes tbody tr");
  document.getElementById("collected").textContent = JSON.stringify(told);
</script>
"""


class SummaryPage(PageTest):
    def test_methods_over_scenes(self) -> None:
        methods = [word for m in METHODS for word in ("-m", m)]
        for scene, frames in (("moving", 4), ("half_planes", 4)):
            self.synth(scene, self.folder / scene, (96, 64), frames)
            self.aaresolve(
                "run", self.folder / scene, *methods, "--write", "none", "-q",
                "-o", self.folder / f"runs/{scene}",
            )  # fmt: skip
        changed = ("-m", "noaa", "-m", "taaSimplest", "-m", "smaa1x:preset=LOW")
        self.aaresolve(
            "run", self.folder / "moving", *changed, "--write", "none", "-q",
            "-o", self.folder / "runs/again",
        )  # fmt: skip
        runs = [self.folder / f"runs/{name}" for name in ("moving", "half_planes", "again")]
        self.aaresolve("report", runs[1], "--embed", "none")
        done = self.aaresolve("report", *runs)
        page = self.folder / "runs/summary.html"
        self.assertEqual(Path(done.stdout.strip()), page)
        results = [json.loads((r / "results.json").read_text()) for r in runs]
        visited = self.folder / "visited.html"
        visited.write_text(page.read_text() + VISITOR)
        grounds = set()
        for width, dark in ((1400, False), (390, True)):
            look = ["--blink-settings=preferredColorScheme=0"] if dark else []
            told = self.collected(self.open(visited, f"--window-size={width},900", *look))
            grounds.add(told["ground"])
            self.assertLessEqual(told["overflow"], 0, told["width"])
        self.assertEqual(len(grounds), 2)
        self.holds(told, results)
        self.one_scene([runs[0], runs[2]])
        twice = self.aaresolve("report", runs[0], runs[0], expect=2)
        self.assertIn("given twice", twice.stderr)

    def one_scene(self, runs: list[Path]) -> None:
        """Runs of one scene say nothing of other scenes, and the page claims nothing about them."""
        page, visited = self.folder / "one.html", self.folder / "one_visited.html"
        self.aaresolve("report", *runs, "-o", page)
        visited.write_text(page.read_text() + VISITOR)
        told = self.collected(self.open(visited, "--window-size=1400,900"))
        self.assertEqual(told["title"], "Runs of moving")
        for words in ("Scenes", "Worst", "Mean"):
            self.assertNotIn(words, "".join(told["heads"]))
        self.assertNotIn("scene", told["words"][0])
        self.assertNotEqual(told["select"], "0px")
        # Grey in the chart is uncoloured in the table, and one rule holds in both tables.
        for method, grey in zip(told["chart"], told["bars"]):
            self.assertEqual(told["meanTones"][method] == "", grey, method)
            if told["sceneTones"].get(method) is not None and method != "smaa1x:preset=LOW":
                self.assertEqual(told["meanTones"][method], told["sceneTones"][method], method)
        # An interval with one end is shown and coloured as one with two.
        open_ended = '{"gain":-11.39,"low":"-Inf","high":-7.25,"resolved":true,"why":"no"}'
        text, found = re.subn(
            r'("text":"fxaa311"[^{]*"mean":){[^}]*}',
            rf"\1{open_ended}",
            visited.read_text(),
            count=1,
        )
        self.assertEqual(found, 1)
        visited.write_text(text)
        told = self.collected(self.open(visited, "--window-size=1400,900"))
        row = next(row for row in told["mean"] if row.startswith("fxaa311"))
        self.assertIn("−11.39\nbelow −7.25", row)
        self.assertNotIn("not resolved", row)
        self.assertEqual(told["meanTones"]["fxaa311"], "worse")
        self.assertFalse(told["bars"][told["chart"].index("fxaa311")])

    def holds(self, told: dict, results: list[dict]) -> None:
        self.assertEqual(told["scenes"][1:], ["moving (moving)", "half_planes", "moving (again)"])
        self.assertIn("gains most over no anti-aliasing", told["words"][0])
        self.assertEqual(told["title"], "Methods over scenes")
        self.assertIn("Scenes", "".join(told["heads"]))
        self.assertEqual(told["links"], ["half_planes/report.html"])
        self.assertEqual(len(told["mean"]), len(METHODS) + 1)
        # noaa stands where gains turn negative, with the scenes that it was run in.
        gains = [
            re.search(r"\n?\t([+−]?[\d.]+)\n", row)[1].replace("−", "-") for row in told["mean"]
        ]
        place = next(k for k, row in enumerate(told["mean"]) if row.startswith("noaa"))
        self.assertTrue(all(float(g) >= 0 for g in gains[:place]), gains)
        self.assertIn("\t2\t", told["mean"][place])
        self.assertEqual(len(told["chart"]), len(METHODS))

        def gain(result: dict, method: str) -> float:
            for pair in result["pairs"]:
                if {pair["first"], pair["second"]} == {"noaa", method}:
                    return pair["gainDb"] * (1 if pair["first"] == method else -1)
            raise KeyError(method)

        # Of the scene that was run twice the last run counts where it has the method.
        mean = {row.split()[0]: row for row in told["mean"]}
        for method, first in (("fxaa311", 0), ("taaSimplest", 2)):
            expected = (gain(results[first], method) + gain(results[1], method)) / 2
            self.assertIn(f"{expected:+.2f}".replace("-", "−"), mean[method])
        self.assertIn("taaSimplest", "".join(told["against"]))
        self.assertIn("equal", "".join(told["against"]))
        found = {
            m: float(re.search(r"[+−]\d+\.\d\d", row)[0].replace("−", "-"))
            for m, row in mean.items()
            if m != "noaa"
        }
        in_both = [v for m, v in found.items() if m != "smaa1x:preset=LOW"]
        self.assertEqual(in_both, sorted(in_both, reverse=True))
        self.assertEqual(told["sorted"][0].split()[0], min(found, key=found.get))
        for figure in ("gain", "psnr", "ssimLuma", "flip", "nsPerPixel"):
            self.assertIn(figure, told["figures"])
        psnr = results[0]["methods"][0]["pooled"]["psnr"]
        self.assertIn(f"{psnr:.2f}", next(row for row in told["psnr"] if row.startswith("noaa")))


main()
