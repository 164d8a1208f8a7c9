"""report_names_test.py PROGRAM ROOT BROWSER: what must not be cut in a report and its sections: long texts of methods,
numbers on paper, tables on a window of 1280 px, the help on a phone; and what a run without truth must not claim."""

from __future__ import annotations

import json
import shutil
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(sys.argv[2]).resolve() / "tests/e2e"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
BROWSER = sys.argv[3]
del sys.argv[3]  # unittest reads the rest

from devtools import Browser, Page  # noqa: E402
from program import ProgramTest, main  # noqa: E402

LONG = (
    "raptor:lumaDiff=printed,filterDomain=printed,historyClamp=off,dilation=none,ycocg=on,"
    "sharpen=0.1"
)
METHODS = ("noaa", "fxaa311", "smaa1x", "karis", LONG)
DRAWN = "!window.aaViewer || aaViewer.idle()"


class Names(ProgramTest):
    @classmethod
    def setUpClass(cls) -> None:
        cls.shared = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        cls.browser = Browser(BROWSER, Path(cls.shared.name) / "profile")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.browser.close()
        cls.shared.cleanup()

    def page(self, file: Path, width: int, height=900, **how) -> Page:
        page = Page(self.browser, width, height, **how)
        page.open(file)
        page.wait(DRAWN)
        return page

    def methods(self) -> list[str]:
        return [word for m in METHODS for word in ("-m", m)]

    def run_of_long_names(self) -> Path:
        run = Path(self.shared.name) / "run"
        if not run.exists():
            shot = Path(self.shared.name) / "shot"
            self.synth("moving", shot, (320, 180), 4)
            written = ("--write-frames", "all", "-o", run, "-q")
            self.aaresolve("run", shot, *self.methods(), "--metrics", "flip,ssimRgb", *written)
            small = ("--size", "48x27", "--frames", "4", "--long-frames", "128")
            self.aaresolve("stability", *self.methods(), *small, "-o", run, "-q")
            with_device(run / "stability.json")
        return run

    def report(self, run: Path, name: str) -> Path:
        file = self.folder / name
        self.aaresolve("report", run, "-o", file)
        return file

    def nothing_leaves_its_box(self, page: Page, width: int) -> None:
        self.assertLessEqual(page.value("document.documentElement.scrollWidth"), width)
        leaving = page.value(
            """[...document.querySelectorAll("p, li, dd, figcaption, .legend, .legend button")].filter((e) => e.getClientRects().length &&
              (e.scrollWidth > e.clientWidth + 1 && getComputedStyle(e).display !== "inline" || e.getBoundingClientRect().right > innerWidth + 1))
              .map((e) => e.textContent.slice(0, 60))"""
        )
        self.assertEqual(leaving, [])

    def names_of_charts_are_whole(self, page: Page) -> None:
        # The names of bars, in lines that lie within the axis, and of points, within the chart.
        told = page.value(
            """["gain", "flicker"].map((id) => {
              const { scales: { y }, ctx } = Chart.getChart(id);
              ctx.font = `12px ${Chart.defaults.font.family}`;
              return y.ticks.map((t) => [[t.label].flat().join(""), Math.max(...[t.label].flat().map((line) => ctx.measureText(line).width)) <= y.width]);
            })"""
        )
        for names in told:
            self.assertIn(LONG, [name for name, _ in names])
            self.assertTrue(all(fits for _, fits in names), names)
        legend = page.value(
            "[...document.getElementById('scatter').closest('figure').querySelectorAll('.legend button')].map((b) => b.textContent)"
        )
        self.assertEqual(sorted(legend), sorted([*METHODS, "best for its cost"]))
        outside = page.value(
            """[...document.querySelectorAll(".legend button")].filter((b) => b.getClientRects().length).filter((b) => {
              const box = b.closest("figure").getBoundingClientRect(), own = b.getBoundingClientRect();
              return own.left < box.left || own.right > box.right || b.scrollWidth > b.clientWidth;
            }).length"""
        )
        self.assertEqual(outside, 0)

    def labels_keep_their_figures(self, page: Page) -> None:
        page.value("aaViewer.set({ shown: ['truth', '0', '1', '2', '3', '4'], mode: 'side' })")
        page.wait(DRAWN)
        cut = page.value(
            """[...document.querySelectorAll("#stage .label")].filter((l) => { const f = l.querySelector(".figure"), own = f.getBoundingClientRect(), box = l.getBoundingClientRect();
              return f.scrollWidth > f.clientWidth || own.right > box.right + 0.5 || own.bottom > box.bottom + 0.5; }).map((l) => l.textContent.slice(-20))"""
        )
        self.assertEqual(cut, [])

    def test_long_names(self) -> None:
        file = self.report(self.run_of_long_names(), "report.html")
        for width, touch in ((1280, False), (390, True)):
            page = self.page(file, width, touch=touch)
            with self.subTest(width=width):
                self.nothing_leaves_its_box(page, width)
                self.names_of_charts_are_whole(page)
                self.labels_keep_their_figures(page)
                self.assertEqual(page.errors(), [])
            page.close()
        # What was drawn for one width is drawn anew for another.
        page = self.page(file, 1280)
        page.call(
            "Emulation.setDeviceMetricsOverride",
            width=390,
            height=844,
            deviceScaleFactor=1,
            mobile=False,
        )
        page.wait("Chart.getChart('gain').width < 390")
        self.names_of_charts_are_whole(page)
        page.close()

    def test_tables_at_1280(self) -> None:
        page = self.page(self.report(self.run_of_long_names(), "report.html"), 1280)
        cut = "[...document.querySelectorAll('.scroll')].filter((s) => s.scrollWidth > s.clientWidth).map((s) => s.querySelector('table').id)"
        self.assertEqual(page.value(cut), [])
        heads = page.value("document.querySelector('#stability-figures thead').innerText")
        for head in ("GPU exact", "GPU fast", "Recovers after"):
            self.assertIn(head, heads)
        # Where a table is wider, it says so, those of later sections too.
        page.call(
            "Emulation.setDeviceMetricsOverride",
            width=800,
            height=900,
            deviceScaleFactor=1,
            mobile=False,
        )
        page.wait(f"{cut}.includes('stability-figures')")
        page.wait("!document.querySelector('#stability .more-columns').hidden")
        page.close()

    def test_paper(self) -> None:
        file = self.report(self.run_of_long_names(), "report.html")
        for width in (1032, 718):  # A4 on its side and upright, less the margins
            page = self.page(file, width)
            page.call("Emulation.setEmulatedMedia", media="print")
            page.value("dispatchEvent(new Event('beforeprint'))")
            broken = page.value(
                """[...document.querySelectorAll("td")].flatMap((td) => [...td.childNodes, ...[...td.querySelectorAll("small")].flatMap((s) => [...s.childNodes])])
                  .filter((n) => n.nodeType === 3 && /^[+−]?[\\d.]+$/.test(n.textContent)).filter((n) => {
                    const range = document.createRange();
                    range.selectNodeContents(n);
                    return range.getClientRects().length > 1;
                  }).map((n) => n.textContent)"""
            )
            self.assertEqual(broken, [], width)
            page.close()

    def test_help_on_a_phone(self) -> None:
        page = self.page(self.report(self.run_of_long_names(), "report.html"), 390, 600, touch=True)
        page.value("document.querySelector('[data-c=help]').click()")
        page.wait("document.querySelector('dialog.help').open")
        scrolls = "(() => { const d = document.querySelector('dialog.help'); return [d.scrollTop, d.scrollHeight > d.clientHeight]; })()"
        self.assertEqual(page.value(scrolls), [0, True])
        page.close()

    def test_memory_is_of_this_size(self) -> None:
        run = self.run_of_long_names()
        results = json.loads((run / "results.json").read_text())
        page = self.page(self.report(run, "report.html"), 1400)
        heads = page.value(
            "[...document.querySelectorAll('#price-figures thead button')].map((b) => b.textContent.replaceAll('\\u00a0', ' '))"
        )
        self.assertIn("Kept at 320 × 180, MB", heads)
        rows = page.value(
            "Object.fromEntries([...document.querySelectorAll('#price-figures tbody tr')].map((r) => [r.cells[0].firstChild.parentElement.innerText.split('\\n')[0], [...r.cells].slice(1).map((c) => c.innerText.split('\\n')[0])]))"
        )
        methods = {m["text"]: m for m in results["methods"]}
        for name in ("fxaa311", "smaa1x", "karis"):
            m = methods[name]
            self.assertEqual(
                rows[name][heads.index("Kept at 320 × 180, MB")], f"{m['stateBytes'] / 1e6:.2f}"
            )
            beyond = sum(
                m[k] - methods["noaa"][k] for k in ("inputBytes", "targetBytes", "stateBytes")
            )
            self.assertEqual(
                rows[name][heads.index("All beyond noaa at 320 × 180, MB")], f"{beyond / 1e6:.2f}"
            )
        page.close()

    def test_without_truth(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (96, 64), 4)
        described = json.loads((shot / "shot.json").read_text())
        described.pop("truth")
        for frame in described["frames"]:
            frame.pop("truth")
        (shot / "shot.json").write_text(json.dumps(described))
        shutil.rmtree(shot / "truth")
        for pictures in ("truth", "all"):
            run = self.folder / pictures
            self.aaresolve(
                "run", shot, "-m", "noaa,smaa1x,karis", "--write-frames", pictures, "-o", run, "-q"
            )
            page = self.page(self.report(run, f"{pictures}.html"), 1280)
            text = page.value("document.querySelector('body').innerText")
            for claim in ("against the ground truth", "Over time", "PSNR"):
                self.assertNotIn(claim, text)
            self.assertIn("without ground truth", text)
            self.assertEqual("only times and pictures can be compared" in text, pictures == "all")
            self.assertEqual("--write-frames all" in text, pictures == "truth")
            self.assertEqual(
                page.value("!document.getElementById('viewer').hidden"), pictures == "all"
            )
            shown = page.value(
                "[...document.querySelectorAll('figure')].filter((f) => f.querySelector('canvas[role=img]') && f.getClientRects().length).length"
            )
            self.assertEqual(shown, 0, "a chart without anything in it")
            self.assertEqual(page.errors(), [])
            page.close()


def with_device(file: Path) -> None:
    """The columns of a graphics device, whether the machine that tests has one or not."""
    study = json.loads(file.read_text())
    study["device"] = study.get("device") or {"name": "a card", "kind": "discrete"}
    for m in study["methods"]:
        for key in ("gpuExact", "gpuFast"):
            m[key] = (
                m.get(key)
                or m.get("float")
                or {"max": 1.2e-7, "rms": 3.4e-8, "ulp": 12, "notFinite": 0}
            )
    file.write_text(json.dumps(study))


main()
