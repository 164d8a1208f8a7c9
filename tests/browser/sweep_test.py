"""sweep_test.py PROGRAM ROOT BROWSER: the page of a sweep in a real browser: curves with bands, heat map, table, choices."""

from __future__ import annotations

import re
from pathlib import Path

from visited_page import PageTest, main

# Chooses every figure, each parameter along, and reads what is drawn.
VISITOR = """
<pre id="collected"></pre>
<script>
  const $ = (id) => document.getElementById(id);
  const pick = (id, value) => { const e = $(id); e.value = value; e.dispatchEvent(new Event("change")); };
  const told = { figures: [], along: [] };
  const heat = () => [...document.querySelectorAll(".heat tbody tr")].map((row) => [...row.querySelectorAll("td")].map((td) => td.textContent));
  for (const option of $("figure").options) {
    pick("figure", option.value);
    const chart = Chart.getChart("curve");
    told.figures.push({ title: option.textContent, sets: chart.data.datasets.length, bands: chart.data.datasets.filter((d) => d.band).length,
      legend: chart.legend.legendItems.map((i) => i.text), caption: $("curve-title").textContent, heat: heat() });
  }
  pick("figure", 0);
  for (const option of $("along").options) {
    pick("along", option.value);
    const line = Chart.getChart("curve").data.datasets.filter((d) => !d.band);
    told.along.push({ name: option.textContent, lines: line.map((d) => [d.label, d.data.map((p) => p.x)]),
      band: Chart.getChart("curve").data.datasets.filter((d) => d.band).every((d, i, all) => d.data.every((p, k) => i % 2 || p.y <= all[i + 1].data[k].y)) });
  }
  pick("along", 0);
  const fills = { [css("--panel")]: "hollow", [css("--quiet")]: "grey" };
  told.fills = Chart.getChart("curve").data.datasets.flatMap((d) => d.pointBackgroundColor ?? []).map((c) => fills[c] ?? "filled");
  told.table = $("all").innerText;
  told.note = $("curve-note").textContent;
  const canvas = $("curve"), image = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  told.drawn = image.some((v, i) => i % 4 === 3 && v > 0);
  told.contrast = [...document.querySelectorAll(".heat td")].every((td) => {
    const rgb = (c) => c.match(/[0-9.]+/g).map(Number).map((v) => v / 255).map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
    const luminance = (c) => { const [r, g, b] = rgb(c); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
    const style = getComputedStyle(td), a = luminance(style.color), b = luminance(style.backgroundColor);
    return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05) >= 4.5;
  });
  told.wide = document.documentElement.scrollWidth <= innerWidth;
  $("collected").textContent = JSON.stringify(told);
</script>
"""


class Sweep(PageTest):
    def test_curves_and_heat_map(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (96, 64), 5, "-q")
        vary = (
            "--vary",
            "kmin=0.5..0.9:0.2",
            "--vary",
            "kmax=0.95,0.98",
            "--vary",
            "sharpen=none,norm",
        )
        self.aaresolve("sweep", shot, "-m", "uncharted", *vary, "-o", out, "-q")
        visited = self.folder / "visited.html"
        visited.write_text((out / "sweep.html").read_text() + VISITOR)
        for window in ("1400,900", "800,900", "390,844"):
            for dark in ((), ("--force-dark-mode", "--blink-settings=preferredColorScheme=0")):
                drawn = self.open(
                    visited, "--virtual-time-budget=20000", f"--window-size={window}", *dark
                )
                self.told(self.collected(drawn), drawn)

    def test_values_that_cannot_be_judged(self) -> None:
        """A picture too small to hold values against each other: said of each of them, and never as if told apart."""
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (16, 16), 3, "-q")
        vary = ("--vary", "kmin=0.5,0.7,0.9", "--vary", "kmax=0.95,0.98")
        said = self.aaresolve("sweep", shot, "-m", "uncharted", *vary, "-o", out, "-q").stdout
        self.assertIn("to hold it against 5 other values this picture is too small", said)
        visited = self.folder / "visited.html"
        visited.write_text((out / "sweep.html").read_text() + VISITOR)
        drawn = self.open(visited, "--virtual-time-budget=20000", "--window-size=1280,900")
        told = self.collected(drawn)
        cells = [cell for row in told["figures"][0]["heat"] for cell in row[:3]]
        self.assertEqual(sorted(c[-1] for c in cells), ["?"] * 5 + ["★"])
        self.assertNotIn("hollow", told["fills"])
        self.assertEqual(told["fills"].count("grey"), 5)
        self.assertIn("too small to hold it against the best", told["note"])
        self.assertEqual(told["table"].count("? too small to judge"), 5)
        self.assertNotIn("no interval", told["table"])

    def told(self, told: dict, drawn: str) -> None:
        self.assertTrue(told["drawn"])
        self.assertTrue(told["contrast"])
        self.assertTrue(told["wide"], "the page itself does not scroll sideways")
        titles = [f["title"] for f in told["figures"]]
        self.assertIn("Gain over no anti-aliasing, dB", titles[0])
        self.assertIn("Difference from the best value, dB", titles[1])
        self.assertTrue(any("Flicker" in t for t in titles))
        for f in told["figures"][:2]:
            self.assertEqual(
                (f["sets"], f["bands"]), (6, 4), f["title"]
            )  # two curves, each with its band
            self.assertEqual(f["legend"], ["kmax=0.95", "kmax=0.98"])
        self.assertEqual(told["figures"][2]["bands"], 0)
        self.assertIn("against kmin: up is better", told["figures"][0]["caption"])
        for f in told["figures"]:
            self.assertEqual([len(row) for row in f["heat"]], [3, 3])
        self.assertEqual("".join(map("".join, told["figures"][0]["heat"])).count("★"), 1)
        lines = {a["name"]: a["lines"] for a in told["along"]}
        self.assertEqual([x for _, x in lines["kmin"]], [[0.5, 0.7, 0.9]] * 2)
        self.assertEqual({tuple(x) for _, x in lines["sharpen"]}, {("none", "norm")})
        self.assertTrue(all(a["band"] for a in told["along"]))
        self.assertEqual(len(re.findall(r'<th scope="row">uncharted:<wbr>kmin', drawn)), 12)
        self.assertIn("is best, PSNR", drawn)


main()
