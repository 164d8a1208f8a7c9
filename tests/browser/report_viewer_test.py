"""report_viewer_test.py PROGRAM ROOT BROWSER: the report's viewer in a real browser, opened from disk without a network
and used with mouse, keys and fingers at three widths, light and dark. What it shows is held to the EXR files, what it
computes to the program's figures."""

from __future__ import annotations

import json
import math
import random
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenImageIO as oiio

sys.path.insert(0, str(Path(sys.argv[2]).resolve() / "tests/e2e"))
sys.path.insert(0, str(Path(__file__).resolve().parent))
BROWSER = sys.argv[3]
del sys.argv[3]  # unittest reads the rest

from devtools import Browser, Page  # noqa: E402
from program import ProgramTest, main  # noqa: E402

METHODS = ("noaa", "fxaa311", "smaa1x", "taaSimplest", "uncharted")
SIZE = (240, 160)
FRAMES = 6
# A second ends when all that was asked for is drawn.
IDLE = "window.aaViewer && aaViewer.idle()"


def exr(file: Path) -> np.ndarray:
    image = oiio.ImageInput.open(str(file))
    pixels = image.read_image("float")[..., :3]
    image.close()
    return pixels


def encoded(linear: np.ndarray) -> np.ndarray:
    v = np.clip(linear.astype(np.float64), 0, 1)
    return np.where(v <= 0.0031308, 12.92 * v, 1.055 * np.power(v, 1 / 2.4) - 0.055)


class Viewer(ProgramTest):
    """One browser for all tests, and one run of the moving shot."""

    @classmethod
    def setUpClass(cls) -> None:
        cls.shared = tempfile.TemporaryDirectory()
        cls.browser = Browser(BROWSER, Path(cls.shared.name) / "profile")

    @classmethod
    def tearDownClass(cls) -> None:
        cls.browser.close()
        cls.shared.cleanup()

    def run_of(
        self, scene: str, *options: object, size=SIZE, frames=FRAMES, methods=METHODS
    ) -> Path:
        folder = Path(self.shared.name) / scene
        if not folder.exists():
            self.synth(scene, folder / "shot", size, frames)
            named = [word for m in methods for word in ("-m", m)]
            written = ("--write-frames", "all", "-o", folder / "run", "-q")
            self.aaresolve("run", folder / "shot", *named, *written, *options)
        return folder / "run"

    def moving(self) -> Path:
        return self.run_of("moving", "--metrics", "flip,ssimRgb")

    def report(self, run: Path, name: str, *options: object) -> Path:
        page = self.folder / name
        said = self.aaresolve("report", run, "-o", page, *options).stdout
        self.assertIn(f"{page.stat().st_size / 1e6:.1f} MB", said)
        return page

    def page(self, file: Path, width: int, height=900, fragment="", **how) -> Page:
        page = Page(self.browser, width, height, **how)
        page.open(file, fragment)
        page.wait(IDLE)
        return page

    # ---- what is shown is what was written ----
    def expected(self, run: Path, results: dict, source: str, frame: int) -> np.ndarray:
        if source == "truth":
            return exr(run / results["truth"]["images"][str(frame)])
        frames = results["methods"][int(source)]["frames"]
        return exr(run / next(f["image"] for f in frames if f["frame"] == frame))

    def pixels_are_the_files(self, page: Page, run: Path, results: dict, *, floats: bool) -> None:
        chance, asked = random.Random(1), []
        sources = ["truth"] + [str(k) for k in range(len(METHODS))]
        for _ in range(1000):
            asked.append(
                [
                    chance.choice(sources),
                    chance.choice(range(1, FRAMES + 1)),
                    chance.randrange(SIZE[0]),
                    chance.randrange(SIZE[1]),
                ]
            )
        member = "linear" if floats else "codes"
        found = page.value(
            f"""{json.dumps(asked)}.map(([source, frame, x, y]) => {{
              const p = aaViewer.pictures.get(0, source, frame), i = 3 * (y * p.w + x);
              return [...p.{member}.subarray(i, i + 3), ...p.codes.subarray(i, i + 3)];
            }})"""
        )
        files: dict = {}
        for (source, frame, x, y), got in zip(asked, found):
            if (source, frame) not in files:
                files[source, frame] = self.expected(run, results, source, frame)
            linear = files[source, frame][y, x]
            if floats:
                self.assertEqual(got[:3], [float(v) for v in linear])
            exact = 255 * encoded(linear)
            for code, value in zip(got[3:], exact):
                # The program rounds in float: within a thousandth of the border either code is right.
                near = {math.floor(value + 0.5 - 1e-3), math.floor(value + 0.5 + 1e-3)}
                self.assertIn(code, near, (source, frame, x, y))

    def screen_shows_the_codes(self, page: Page) -> None:
        """At 3 screen pixels per pixel, each of them on the stage has its picture's code."""
        wrong = page.value(
            """(async () => {
              const { state, set, stage, pictures } = aaViewer;
              set({ shown: ["0", "1"], mode: "side", kind: "picture", ev: 0, zoom: 3, x: 100.3, y: 70.7, pin: null, region: null });
              await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
              const canvas = document.querySelector("#stage canvas"), box = canvas.getBoundingClientRect();
              const shown = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
              let wrong = 0, seen = 0;
              stage.panes().forEach((pane, k) => {
                const p = pictures.get(0, state.shown[k], state.frame);
                for (let py = Math.ceil(pane.top); py < pane.top + pane.height - 1; py++)
                  for (let px = Math.ceil(pane.left); px < pane.left + pane.width - 1; px++) {
                    const at = stage.placeAt(box.left + px + 0.5, box.top + py + 0.5, pane), x = Math.floor(at.x), y = Math.floor(at.y);
                    if (x < 0 || y < 0 || x >= p.w || y >= p.h) continue;
                    const i = 3 * (y * p.w + x), j = 4 * (py * canvas.width + px);
                    seen++;
                    for (let c = 0; c < 3; c++) if (shown.data[j + c] !== p.codes[i + c]) { wrong++; break; }
                  }
              });
              return [wrong, seen];
            })()"""
        )
        self.assertEqual(wrong[0], 0)
        self.assertGreater(wrong[1], 100_000)

    def figures_are_the_programs(self, page: Page, results: dict) -> None:
        frame = FRAMES
        for k, method in enumerate(results["methods"]):
            metrics = next(f["metrics"] for f in method["frames"] if f["frame"] == frame)
            mse, ssim, flip, map_mean = page.value(
                f"""(() => {{
                  const get = (s) => aaViewer.pictures.get(0, s, {frame}), t = get("{k}"), r = get("truth");
                  const what = (kind) => ({{ view: 0, kind, source: "{k}", against: "truth", frame: {frame}, ev: 0 }});
                  return [viewerMeasure.mse(t, r), aaViewer.paint.meanOf(what("ssim")), aaViewer.paint.meanOf(what("flip")),
                    viewerMeasure.meanOf({{ ...viewerMeasure.rms(t, r), values: viewerMeasure.rms(t, r).values.map((v) => v * v) }})];
                }})()"""
            )
            self.assertAlmostEqual(mse / metrics["mse"], 1, delta=1e-5)
            self.assertAlmostEqual(map_mean / mse, 1, delta=1e-9)
            self.assertAlmostEqual(ssim, metrics["ssimLuma"], delta=1e-6)
            self.assertAlmostEqual(flip, metrics["flip"], delta=1e-4)

    def test_exact(self) -> None:
        run = self.moving()
        results = json.loads((run / "results.json").read_text())
        codes, floats = self.report(run, "codes.html"), self.report(run, "floats.html", "--hdr")
        page = self.page(codes, 1400)
        self.pixels_are_the_files(page, run, results, floats=False)
        self.screen_shows_the_codes(page)
        self.assertEqual(page.errors(), [])
        page.close()
        page = self.page(floats, 1400)
        self.pixels_are_the_files(page, run, results, floats=True)
        self.screen_shows_the_codes(page)
        self.figures_are_the_programs(page, results)
        # Two stops darker is a quarter of the light, beyond white, too.
        self.assertTrue(
            page.value(
                """(() => {
                  const p = { linear: Float32Array.of(0, 0.25, 1, 2, 4, 64), displayReferred: false };
                  return [...aaViewer.pictures.exposed(p, -2)].join() === "0,71,137,188,255,255";
                })()"""
            )
        )
        self.assertEqual(page.errors(), [])
        page.close()

    def test_flicker_of_a_static_shot(self) -> None:
        run = self.run_of("thin_lines", size=(96, 64), frames=8, methods=("noaa", "taaSimplest"))
        results = json.loads((run / "results.json").read_text())
        page = self.page(self.report(run, "still.html", "--hdr"), 800)
        for k, method in enumerate(results["methods"]):
            mean = page.value(
                f"""aaViewer.paint.meanOf({{ view: 0, kind: "flicker", source: "{k}", against: "truth", frame: 8, ev: 0 }})"""
            )
            self.assertAlmostEqual(mean, method["temporal"]["flickerStatic"], delta=1e-3)
        self.assertEqual(page.errors(), [])

    # ---- what a visitor does ----
    def stage_box(self, page: Page) -> tuple[float, float, float, float]:
        page.wait(IDLE)
        return tuple(
            page.value(
                "(() => { const b = document.getElementById('stage').getBoundingClientRect(); return [b.left, b.top, b.width, b.height]; })()"
            )
        )

    def state(self, page: Page, *names: str):
        page.wait(IDLE)
        found = page.value(f"{json.dumps(names)}.map((n) => aaViewer.state[n])")
        return found[0] if len(names) == 1 else found

    def by_keys(self, page: Page) -> None:
        self.assertEqual(self.state(page, "mode"), "side")
        for key in "3142":
            page.key(key)
            self.assertEqual(self.state(page, "mode", "current"), ["flip", int(key) - 1])
        for key, mode in {"s": "side", "w": "wipe", "b": "blink", "v": "flip"}.items():
            page.key(key)
            self.assertEqual(self.state(page, "mode"), mode)
        page.key("w")
        page.key("1", shift=True)
        page.key("3")
        self.assertEqual(self.state(page, "current", "second"), [0, 2])
        kinds = {
            "d": "signed",
            "a": "absolute",
            "e": "error",
            "m": "ssim",
            "l": "flip",
            "k": "flicker",
        }
        for key, kind in {**kinds, "x": "xt", "y": "yt", "p": "picture"}.items():
            page.key(key)
            self.assertEqual(self.state(page, "kind"), kind)
            said = page.value(
                "document.querySelector('#stage .scale:not([hidden])')?.textContent ?? ''"
            )
            self.assertEqual(bool(said), kind in kinds.values(), kind)
            if kind in ("error", "ssim", "flip", "flicker"):
                label = page.value(
                    "document.querySelector('#stage .label:last-child .figure').textContent"
                )
                self.assertRegex(label, r"^(frame \d+: (RMSE|SSIM|FLIP)|flicker) [\d.e-]+$")
        page.key("s")
        for key, ev in (("]", 0.5), ("]", 1), ("[", 0.5), ("\\", 0)):
            page.key(key)
            self.assertEqual(self.state(page, "ev"), ev)
        for key, frame in ((",", FRAMES - 1), (",", FRAMES - 2), (".", FRAMES - 1)):
            page.key(key)
            self.assertEqual(self.state(page, "frame"), frame)
        page.value("document.getElementById('stage').focus()")
        for key, frame in (("Home", 1), ("End", FRAMES)):
            page.key(key)
            self.assertEqual(self.state(page, "frame"), frame)
        page.key("o")
        self.assertEqual(self.state(page, "zoom"), 1)
        page.key("+")
        page.key("+")
        self.assertEqual(self.state(page, "zoom"), 3)
        x = self.state(page, "x")
        page.key("ArrowRight")
        self.assertGreater(self.state(page, "x"), x)
        page.key("Enter")
        pin = self.state(page, "pin")
        page.key("ArrowRight")
        page.key("ArrowDown")
        self.assertEqual(self.state(page, "pin"), [pin[0] + 1, pin[1] + 1])
        page.key("Escape")
        page.key("f")
        self.assertEqual(self.state(page, "pin", "zoom"), [None, None])
        for key, dialog in (("?", "help"), ("c", "choose")):
            page.key(key)
            page.wait(f"document.querySelector('dialog.{dialog}').open")
            page.key("Escape")
            page.wait(f"!document.querySelector('dialog.{dialog}').open")
        page.key(" ")
        page.wait("aaViewer.state.frame === 2")
        page.wait("aaViewer.state.frame === 4")
        page.key(" ")
        page.key("b")
        page.wait("aaViewer.state.current === 2")
        page.key("s")

    def by_mouse(self, page: Page) -> None:
        left, top, width, height = self.stage_box(page)
        x, y = left + width / 8, top + height / 5
        place = f"(() => {{ const p = aaViewer.stage.placeAt({x}, {y}); return [p.x, p.y]; }})()"
        before = page.value(place)
        page.wheel(x, y, -600)
        page.wait("aaViewer.state.zoom > 3")
        after = page.value(place)
        for a, b in zip(before, after):  # the pixel under the pointer stays there
            self.assertAlmostEqual(a, b, delta=0.75)
        view = self.state(page, "x", "y")
        page.drag(x, y, x - 30, y - 24)
        zoom = page.value("aaViewer.stage.camera().zoom")
        moved = self.state(page, "x", "y")
        self.assertAlmostEqual(moved[0] - view[0], 30 / zoom, delta=0.01)
        self.assertAlmostEqual(moved[1] - view[1], 24 / zoom, delta=0.01)
        self.assertIsNone(self.state(page, "pin"))
        # The exact values of all methods at the pixel under the pointer, and of one that is kept.
        page.mouse("mouseMoved", x + 9, y + 9)
        page.wait(
            f"document.querySelectorAll('#values li').length === {len(METHODS) + 1} && "
            "[...document.querySelectorAll('#values li')].every((l) => l.querySelector('code'))"
        )
        at = page.value(
            f"(() => {{ const p = aaViewer.stage.placeAt({x + 9}, {y + 9}); return [Math.floor(p.x), Math.floor(p.y)]; }})()"
        )
        said = page.value(
            "[...document.querySelectorAll('#values li')].map((l) => [l.dataset.source, l.querySelector('code').textContent.trim().split(/\\s+/).map(Number)])"
        )
        for source, codes in said:
            self.assertEqual(
                codes,
                page.value(
                    f"(() => {{ const p = aaViewer.pictures.get(0, '{source}', aaViewer.state.frame), i = 3 * ({at[1]} * p.w + {at[0]}); return [...p.codes.subarray(i, i + 3)]; }})()"
                ),
            )
        page.click(x + 9, y + 9)
        self.assertEqual(self.state(page, "pin"), at)
        page.click(x + 9, y + 9)
        self.assertIsNone(self.state(page, "pin"))
        # A region and its figures.
        page.drag(x - 20, y - 10, x + 40, y + 30, shift=True)
        region = self.state(page, "region")
        for got, drawn in zip(region[2:], (60, 40)):
            self.assertIn(got, (math.ceil(drawn / zoom), math.ceil(drawn / zoom) + 1))
        page.wait(
            "document.querySelectorAll('#region-figures tbody tr').length === %d" % len(METHODS)
        )
        wrong = page.value(
            """(() => {
              const [x0, y0, w, h] = aaViewer.state.region, r = aaViewer.pictures.get(0, "truth", aaViewer.state.frame);
              return aaViewer.figures.rows().filter(({ source, mse, psnr }) => {
                const t = aaViewer.pictures.get(0, source, aaViewer.state.frame);
                let sum = 0;
                for (let y = y0; y < y0 + h; y++) for (let x = x0; x < x0 + w; x++) for (let c = 0; c < 3; c++)
                  sum += ((t.codes[3 * (y * t.w + x) + c] - r.codes[3 * (y * t.w + x) + c]) / 255) ** 2;
                const own = sum / (3 * w * h);
                return Math.abs(own - mse) > 1e-12 || (own > 0 && Math.abs(psnr + 10 * Math.log10(own)) > 1e-9);
              }).length;
            })()"""
        )
        self.assertEqual(wrong, 0)
        page.key("Escape")
        self.assertIsNone(self.state(page, "region"))
        # Zooming out ends at the whole picture, and from there the wheel scrolls the page.
        page.wheel(x, y, 4000)
        page.wait("aaViewer.state.zoom === null")
        page.wheel(x, y, 300)
        page.wait("scrollY > 100")
        page.value("scrollTo(0, 0)")
        # The wipe's bar.
        page.key("w")
        page.wait(IDLE)
        left, top, width, height = self.stage_box(page)
        page.drag(left + width / 2, top + height / 2, left + width * 0.75, top + height / 2)
        self.assertAlmostEqual(self.state(page, "wipe"), 0.75, delta=0.01)
        self.assertIsNone(self.state(page, "zoom"))  # the bar moved, not the picture
        page.key("s")
        page.wait(IDLE)
        # Another picture in a place, the frame's slider, a crop that leads to its place.
        page.value(
            """(() => {
              const choose = document.querySelector("#stage .label select");
              choose.value = "3";
              choose.dispatchEvent(new Event("change"));
              const frame = document.querySelector("[data-c=frame]");
              frame.value = 1;
              frame.dispatchEvent(new Event("input"));
            })()"""
        )
        self.assertEqual(self.state(page, "frame"), 2)
        self.assertEqual(self.state(page, "shown")[0], "3")
        page.value("document.querySelector('.thumbs button').click()")
        page.wait("aaViewer.state.zoom > 1")
        self.assertTrue(
            page.value(
                """(() => {
                  const { frame } = aaViewer.state, [x, y, w, h] = aaViewer.data.places.find((p) => p.frame === frame).windows[0];
                  return aaViewer.state.x === x + w / 2 && aaViewer.state.y === y + h / 2;
                })()"""
            )
        )
        page.value("document.getElementById('details').scrollIntoView()")
        page.wait("document.querySelectorAll('#crops button').length >= %d" % (len(METHODS) + 1))
        page.value("document.querySelector('#crops button:last-child').click()")
        page.wait("scrollY < 400")
        page.value("aaViewer.set({ zoom: null, kind: 'error' })")
        page.wait(IDLE)
        link = page.value("(document.querySelector('[data-c=link]').click(), location.hash)")
        self.assertIn("kind=error", link)

    def by_touch(self, page: Page) -> None:
        left, top, width, height = self.stage_box(page)
        x, y = left + width / 2, top + height / 2
        page.touch("touchStart", (x - 40, y), (x + 40, y))
        for apart in (55, 70, 90):
            page.touch("touchMove", (x - apart, y), (x + apart, y))
        page.touch("touchEnd")
        page.wait("aaViewer.state.zoom > 1.5")
        view = self.state(page, "x", "y")
        page.touch("touchStart", (x + 60, y + 30))
        for k in (8, 16, 24):
            page.touch("touchMove", (x + 60 - k, y + 30))
        page.touch("touchEnd")
        self.assertGreater(self.state(page, "x"), view[0])
        page.touch("touchStart", (x + 40, y + 20))
        page.touch("touchEnd")
        self.assertIsNotNone(self.state(page, "pin"))
        page.wait("document.querySelectorAll('#values li code').length > 1")

    def fits(self, page: Page, width: int) -> None:
        self.assertLessEqual(page.value("document.documentElement.scrollWidth"), width)

    def test_used(self) -> None:
        run = self.moving()
        file = self.report(run, "report.html")
        for width, dark in ((1400, False), (800, True)):
            page = self.page(file, width, dark=dark)
            with self.subTest(width=width):
                self.by_keys(page)
                self.by_mouse(page)
                self.fits(page, width)
                fragment = page.value("location.hash")
                self.assertEqual(page.errors(), [])
            page.close()
        for dark in (False, True):
            page = self.page(file, 390, 844, dark=dark, touch=True)
            with self.subTest(width=390, dark=dark):
                self.assertEqual(self.state(page, "mode"), "wipe")
                self.by_touch(page)
                self.fits(page, 390)
                self.assertEqual(page.errors(), [])
            page.close()
        # A link leads back to what was shown.
        page = self.page(file, 1400, fragment=fragment)
        self.assertEqual(self.state(page, "kind", "frame"), ["error", 2])
        self.assertEqual(page.errors(), [])
        page.close()

    def test_paper_and_wide_screens(self) -> None:
        run = self.moving()
        file = self.report(run, "report.html")
        for width in (1400, 1600, 1920):
            page = self.page(file, width)
            cut = page.value(
                "[...document.querySelectorAll('.scroll')].filter((s) => s.scrollWidth > s.clientWidth).map((s) => s.querySelector('table').id)"
            )
            self.assertEqual(cut, [], width)
            page.close()
        page = self.page(file, 1040)  # A4 on its side less the margins, in CSS px
        page.call("Emulation.setEmulatedMedia", media="print")
        page.value("dispatchEvent(new Event('beforeprint'))")
        beyond = page.value(
            """[...document.querySelectorAll("main *")].filter((e) => e.getBoundingClientRect().right > innerWidth + 1 &&
              getComputedStyle(e).visibility !== "hidden").map((e) => e.tagName + "#" + e.id + "." + e.className)"""
        )
        self.assertEqual(beyond, [])
        self.assertTrue(page.pdf().startswith(b"%PDF"))
        self.assertEqual(page.errors(), [])

    # ---- tables and charts ----
    def contrast(self, page: Page, colours: list[str]) -> float:
        """The least of these colours against the panel."""
        return page.value(
            f"""(() => {{
              const pen = document.createElement("canvas").getContext("2d");
              const light = (colour) => {{
                pen.fillStyle = colour;
                pen.fillRect(0, 0, 1, 1);
                const [r, g, b] = [...pen.getImageData(0, 0, 1, 1).data].map((c) => (c / 255 <= 0.04045 ? c / 255 / 12.92 : ((c / 255 + 0.055) / 1.055) ** 2.4));
                return 0.2126 * r + 0.7152 * g + 0.0722 * b + 0.05;
              }};
              const panel = light(css("--panel"));
              return Math.min(...{json.dumps(colours)}.map(light).map((l) => Math.max(l, panel) / Math.min(l, panel)));
            }})()"""
        )

    def table(self, page: Page, name: str) -> tuple[list[str], list[list[str]]]:
        return tuple(
            page.value(
                f"""[[...document.querySelectorAll("#{name} thead th + th button")].map((b) => [b.textContent, b.title]),
                  [...document.querySelectorAll("#{name} tbody tr")].map((r) => [...r.children].map((c) => c.firstChild.textContent + [...c.childNodes].slice(1).filter((n) => n.nodeType === 3).map((n) => n.textContent).join("")))]"""
            )
        )

    def test_tables(self) -> None:
        run = self.moving()
        results = json.loads((run / "results.json").read_text())
        page = self.page(self.report(run, "tables.html"), 1400)
        by_psnr = sorted(results["methods"], key=lambda m: -m["pooled"]["psnr"])
        self.assertNotEqual(by_psnr[-1]["id"], "noaa")  # or its place says nothing
        for name in ("figures", "time-figures", "price-figures"):
            heads, rows = self.table(page, name)
            self.assertEqual([r[0] for r in rows], [m["text"] for m in by_psnr], name)
            for k, (title, about) in enumerate(heads):
                self.assertGreater(len(about), 10, title)
                self.assertTrue(any(r[k + 1] != "–" for r in rows), f"{title} has no value")
            notes = f"document.getElementById('{name}').closest('.scroll').nextElementSibling"
            self.assertEqual(
                page.value(f"[...{notes}.querySelectorAll('dt')].map((d) => d.textContent)"),
                [title for title, _ in heads],
            )
        heads = [title for title, _ in self.table(page, "price-figures")[0]]
        self.assertNotIn("Passes, s per frame", heads)  # a synthetic shot is not rendered
        said = page.value("document.getElementById('price-note').textContent")
        self.assertIn("how long its passes took", said)
        title = page.value("document.getElementById('time-title').textContent")
        self.assertEqual(title, "Over time: flicker and ghosts")
        # The caption speaks of what is there.
        note = page.value("document.getElementById('figures-note').textContent")
        self.assertNotIn("“to”", note)
        # A gain has a colour where it is resolved, and nowhere else.
        pairs = {p["second"]: p["resolved"] for p in results["pairs"] if p["first"] == "noaa"}
        toned = page.value(
            "Object.fromEntries([...document.querySelectorAll('#figures tbody tr')].map((r) => [r.cells[0].innerText.split('\\n')[0], r.cells[2].className]))"
        )
        for method, resolved in pairs.items():
            self.assertEqual(bool(toned[method]), resolved, method)
        # Every pair that is not told apart can be read, each from both sides.
        page.value("document.getElementById('unresolved-pairs').open = true")
        unresolved = [p for p in results["pairs"] if not p["resolved"]]
        self.assertEqual(
            page.value("document.getElementById('unresolved-pairs').hidden"), not unresolved
        )
        page.wait(
            f"document.querySelectorAll('#unresolved-pairs tbody tr').length || {int(not unresolved)}"
        )
        cells = page.value(
            "[...document.querySelectorAll('#unresolved-pairs tbody tr')].map((r) => [r.cells[0].textContent, [...r.cells].slice(1).map((c) => c.textContent).join(', ')])"
        )
        listed = {(a, b) for a, others in cells for b in others.split(", ") if b != "–"}
        expected = {(p["first"], p["second"]) for p in unresolved}
        self.assertEqual(listed, expected | {(b, a) for a, b in expected})
        label = page.value("document.querySelector('#stage .label:last-child .figure').textContent")
        self.assertRegex(label, rf"^frame {FRAMES}: \d+\.\d\d dB$")
        self.assertEqual(page.errors(), [])

    def test_charts(self) -> None:
        run = self.moving()
        results = json.loads((run / "results.json").read_text())
        page = self.page(self.report(run, "charts.html"), 1400)
        ticks = page.value("Chart.getChart('scatter').scales.x.ticks.map((t) => t.value)")
        self.assertGreater(len(ticks), 1)
        for tick in ticks:
            self.assertIn(round(tick / 10 ** math.floor(math.log10(tick) + 1e-9), 6), (1, 2, 5))
        front, best = [], -math.inf
        for m in sorted(results["methods"], key=lambda m: m["nsPerPixel"]):
            if m["pooled"]["psnr"] > best:
                best = m["pooled"]["psnr"]
                front.append(m["text"])
        named = page.value("Chart.getChart('scatter').names.map((n) => n.text)")
        self.assertEqual(sorted(named), sorted(front))
        # All methods at once: no two look alike, and some of them alone look as they do among all.
        listed = json.loads(self.aaresolve("list", "--json").stdout)
        ids = [m["id"] for m in listed["methods"]]
        rows = ids + ["fxaa311"] * 5
        looks = page.value(f"methodLooks({json.dumps(rows)})")
        self.assertEqual(len({(k["colour"], k["marker"], k["turn"]) for k in looks}), len(rows))
        few = page.value(f"methodLooks({json.dumps(ids[:12])})")
        kept = sum(a["colour"] == b["colour"] for a, b in zip(few, looks))
        self.assertGreater(kept, len(few) / 2)
        turned = page.value(f"methodLooks({json.dumps(ids[:12][::-1])})")
        self.assertEqual(turned[::-1], few)
        self.assertIn(
            "No whisker",
            page.value("document.getElementById('gain').closest('figure').textContent"),
        )
        # Lines: what is drawn is named, the others can be asked for.
        page.value("(window.frames_ = Chart.getChart('frames'), true)")
        for button, drawn in (("None", 0), ("All", len(METHODS))):
            page.value(
                f"[...document.querySelectorAll('#frames')].map((c) => [...c.closest('figure').querySelectorAll('details.lines button')].find((b) => b.textContent === '{button}').click())"
            )
            self.assertEqual(page.value("frames_.getVisibleDatasetCount()"), drawn)
            self.assertEqual(page.value("frames_.legend.legendItems.length"), drawn)
        # Charts beside each other fill their row.
        short = page.value(
            """[...document.querySelectorAll(".charts")].flatMap((box) => {
              const rows = new Map(), figures = [...box.children].map((f) => f.getBoundingClientRect()).filter((b) => b.width);
              for (const b of figures) rows.set(b.top, Math.max(rows.get(b.top) ?? 0, b.right));
              return [...rows.values()].filter((right) => Math.abs(right - box.getBoundingClientRect().right) > 1);
            })"""
        )
        self.assertEqual(short, [])
        # Names of details break between words, and the pictures above them stand in line.
        page.value("document.getElementById('details').scrollIntoView()")
        page.wait(f"document.querySelectorAll('#crops button').length >= {len(METHODS) + 1}")
        crooked = page.value(
            """[...document.querySelectorAll("#crops button")].filter((b) => b.querySelector("span").scrollWidth > b.clientWidth ||
              Math.abs(b.querySelector("canvas").getBoundingClientRect().top - b.getBoundingClientRect().top) > 2).length"""
        )
        self.assertEqual(crooked, 0)
        self.assertEqual(
            page.value("breakable('unchartedNoSharpen').filter((p) => p.tagName).length"), 2
        )
        self.assertEqual(page.errors(), [])

    def test_narrow_and_dark(self) -> None:
        file = self.report(self.moving(), "narrow.html")
        page = self.page(file, 1400)
        page.resize(390, 844)
        page.wait("innerWidth === 390")
        page.wait(IDLE)
        page.wait(
            "[...document.querySelectorAll('.chart canvas')].every((c) => c.getBoundingClientRect().width <= c.parentElement.clientWidth + 1)"
        )
        self.fits(page, 390)
        for box in ("figure", ".scroll"):
            beyond = page.value(
                f"[...document.querySelectorAll('{box}')].filter((f) => f.getBoundingClientRect().right > innerWidth).length"
            )
            self.assertEqual(beyond, 0, box)
        # The stage's pixels are square on the screen, the pictures' too.
        stage = page.value(
            "(() => { const c = document.querySelector('#stage canvas'), b = c.getBoundingClientRect(); return [c.width / b.width, c.height / b.height, b.right]; })()"
        )
        self.assertAlmostEqual(stage[0], stage[1], delta=0.01)
        self.assertLessEqual(stage[2], 391)
        # What is cut says so until its end is seen, and keeps the names and their rules in sight.
        cut = "[...document.querySelectorAll('.scroll')].filter((s) => s.clientWidth && s.scrollWidth > s.clientWidth + 1)"
        self.assertGreater(page.value(f"{cut}.length"), 1)
        page.wait(f"{cut}.every((s) => !s.previousElementSibling.hidden)")
        page.value(
            "(window.box = document.getElementById('time-figures').closest('.scroll'), box.scrollLeft = 1e4)"
        )
        page.wait("box.previousElementSibling.classList.contains('seen')")
        left, rule = page.value(
            """(() => { const th = box.querySelector("tbody th"); return [th.getBoundingClientRect().left - box.getBoundingClientRect().left - box.clientLeft,
              [th, th.nextElementSibling].map((c) => getComputedStyle(c).borderBottomWidth)]; })()"""
        )
        self.assertAlmostEqual(left, 0, delta=1)
        self.assertEqual(rule, ["1px", "1px"])
        self.assertEqual(
            page.value("getComputedStyle(box.querySelector('table')).borderCollapse"), "separate"
        )
        self.assertEqual(page.errors(), [])
        page.close()
        for dark in (False, True):
            page = self.page(file, 800, dark=dark)
            colours = page.value("[...methodColours, methodColour('noaa'), methodColour('truth')]")
            arrows = page.value(
                "getComputedStyle(document.querySelector('#figures thead button'), '::after').color"
            )
            for name, shown in (("series", colours), ("sort arrows", [arrows])):
                self.assertGreaterEqual(self.contrast(page, shown), 3, (name, dark))
            page.close()

    def test_embed(self) -> None:
        run = self.moving()
        full, crops = self.report(run, "full.html"), self.report(
            run, "crops.html", "--embed", "crops"
        )
        none = self.report(run, "none.html", "--embed", "none")
        self.assertLess(none.stat().st_size, crops.stat().st_size)
        page = self.page(crops, 1400)
        self.assertGreater(page.value("aaViewer.data.views.length"), 0)
        self.assertEqual(page.value("aaViewer.data.views[0].window.slice(2)"), [128, 128])
        self.assertEqual(page.errors(), [])
        page = Page(self.browser, 1400, 900)
        page.open(none)
        self.assertTrue(
            page.value(
                "document.getElementById('viewer').hidden && document.getElementById('details').hidden"
            )
        )
        self.assertEqual(page.errors(), [])
        limit = (full.stat().st_size - none.stat().st_size) / 2e6
        said = self.aaresolve("report", run, "-o", self.folder / "few.html", "--embed-limit", limit)
        self.assertIn("left out by --embed-limit", said.stdout)
        page = self.page(self.folder / "few.html", 1400)
        frames = page.value("aaViewer.data.views[0].frames")
        self.assertTrue(1 <= len(frames) < FRAMES and frames[-1] == FRAMES, frames)
        self.refused(2, "report", run, "--embed", "some", says=("--embed",))


main()
