"""Contact sheets in every format, read again by other programs: pages, loops, strips, and pixels that are the run's."""

from __future__ import annotations

import io
import json
import re
import shutil
import subprocess
import unittest
from pathlib import Path

from exr_pixels import parts_of
from program import ProgramTest, main

try:
    import numpy
    from PIL import Image
except ImportError:  # PNG alone is then read, by nobody but ourselves
    Image = None
NEEDS_PIL = unittest.skipUnless(Image, "needs python3-pil and python3-numpy")
NEEDS_POPPLER = unittest.skipUnless(
    Image and all(map(shutil.which, ("pdftoppm", "pdfimages", "pdftotext", "pdfinfo"))),
    "needs poppler-utils, python3-pil and python3-numpy",
)
METHODS = ("noaa", "fxaa311", "smaa1x:preset=HIGH", "uncharted")
SIZE = (160, 96)
CROP = (30, 20, 24, 16)
ZOOM = 4  # whole frames are drawn by 3
FRAMES = 6


def pixels(image) -> "numpy.ndarray":
    return numpy.asarray(image.convert("RGB"))


def picture(file: Path) -> "numpy.ndarray":
    with Image.open(file) as image:
        return pixels(image)


def codes_of(exr: Path) -> "numpy.ndarray":
    """8-bit sRGB codes, from the definition, of a float EXR whose lines hold B, G and R one after the other."""
    width, height = SIZE
    planes = numpy.frombuffer(parts_of(exr)[""], "<f4").reshape(height, 3, width)
    linear = planes[:, ::-1].transpose(0, 2, 1).astype(float).clip(0, 1)
    encoded = numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return numpy.floor(255 * encoded + 0.5).astype(numpy.uint8)


def packed(drawn) -> "numpy.ndarray":
    return drawn.astype(numpy.uint32) @ numpy.array([65536, 256, 1], numpy.uint32)


def places(drawn, crop, zoom: int) -> list[tuple[int, int]]:
    """Top left corners (x, y) where the crop, every pixel a square of `zoom`, lies in the picture."""
    wanted = packed(crop.repeat(zoom, axis=0).repeat(zoom, axis=1))
    drawn = packed(drawn)
    height, width = wanted.shape
    corners = numpy.argwhere(
        drawn[: len(drawn) - height + 1, : drawn.shape[1] - width + 1] == wanted[0, 0]
    )
    return [
        (x, y)
        for y, x in corners
        if drawn[y, x + width - 1] == wanted[0, -1]
        and (drawn[y : y + height, x : x + width] == wanted).all()
    ]


class Sheet(ProgramTest):
    run_folder: Path

    @classmethod
    def setUpClass(cls) -> None:
        import tempfile

        cls._kept = tempfile.TemporaryDirectory()
        cls.run_folder = Path(cls._kept.name) / "run"

    @classmethod
    def tearDownClass(cls) -> None:
        cls._kept.cleanup()

    def setUp(self) -> None:
        super().setUp()
        if self.run_folder.exists():
            return
        self.synth("moving", self.folder / "shot", SIZE, FRAMES)
        words = [w for m in METHODS for w in ("-m", m)]
        self.aaresolve(
            "run",
            self.folder / "shot",
            *words,
            "--write-frames",
            "all",
            "-o",
            self.run_folder,
            "-q",
        )

    def sheet(self, name: str, *options: object) -> list[Path]:
        done = self.aaresolve("sheet", self.run_folder, "-o", self.folder / name, *options)
        return [Path(line) for line in done.stdout.splitlines()]

    def crop_of(self, method: str, frame: int):
        """The codes of a method's crop, from the EXR that the run wrote."""
        results = json.loads((self.run_folder / "results.json").read_text())
        if method == "truth":
            file = results["truth"]["images"][str(frame)]
        else:
            found = next(m for m in results["methods"] if m["text"] == method)
            file = next(f["image"] for f in found["frames"] if f["frame"] == frame)
        x, y, width, height = CROP
        return codes_of(self.run_folder / file)[y : y + height, x : x + width]

    crop = ("--crop", ",".join(map(str, CROP)) + ":corner", "--zoom", str(ZOOM))

    @NEEDS_PIL
    def test_png_and_webp_hold_the_runs_pixels(self) -> None:
        (png,) = self.sheet("s.png", *self.crop)
        (webp,) = self.sheet("s.webp", *self.crop)
        drawn = picture(png)
        self.assertEqual(webp.read_bytes()[8:12], b"WEBP")
        self.assertTrue((picture(webp) == drawn).all(), "WebP without loss")
        for method in METHODS:
            found = places(drawn, self.crop_of(method, FRAMES), ZOOM)
            self.assertEqual(len(found), 1, method)
        (again,) = self.sheet("again.webp", *self.crop)
        self.assertEqual(again.read_bytes(), webp.read_bytes())

    @NEEDS_PIL
    def test_grid_and_methods(self) -> None:
        (png,) = self.sheet("g.png", *self.crop, "--arrange", "grid", "--methods", "spatial,noaa")
        drawn = picture(png)
        rows, columns = set(), []
        for method in ("smaa1x:preset=HIGH", "fxaa311", "noaa"):
            ((x, y),) = places(drawn, self.crop_of(method, FRAMES), ZOOM)
            rows.add(y), columns.append(x)
        self.assertEqual(len(rows), 1)
        self.assertEqual(len(set(columns)), 3)
        results = json.loads((self.run_folder / "results.json").read_text())
        by_psnr = {m["text"]: -m["pooled"]["psnr"] for m in results["methods"]}
        names = ("smaa1x:preset=HIGH", "fxaa311", "noaa")
        by_place = [name for _, name in sorted(zip(columns, names))]
        self.assertEqual(by_place, sorted(names, key=by_psnr.get), "best first")
        self.assertEqual(places(drawn, self.crop_of("uncharted", FRAMES), ZOOM), [])

    @NEEDS_PIL
    def test_strips_over_time(self) -> None:
        (png,) = self.sheet("t.png", *self.crop, "--frames", "2..4,6")
        drawn = picture(png)
        found = {}
        for method in METHODS:
            for frame in (2, 3, 4, 6):
                at = places(drawn, self.crop_of(method, frame), ZOOM)
                self.assertEqual(len(at), 1, (method, frame))
                found[method, frame] = at[0]
            self.assertEqual(places(drawn, self.crop_of(method, 5), ZOOM), [])
        self.assertEqual(len({x for x, _ in found.values()}), 4)
        self.assertEqual(len({y for _, y in found.values()}), len(METHODS))

    @NEEDS_PIL
    def test_loops(self) -> None:
        for name, exact in (("l.apng", True), ("l.webp", True), ("l.gif", False)):
            (file,) = self.sheet(name, *self.crop, "--loop", "methods", "--fps", "2")
            loop = Image.open(io.BytesIO(file.read_bytes()))
            self.assertEqual(loop.n_frames, 1 + len(METHODS), name)
            self.assertEqual(loop.info.get("loop"), 0, name)
            seen = []
            for i in range(loop.n_frames):
                loop.seek(i)
                seen.append(pixels(loop))
                self.assertEqual(round(loop.info["duration"]), 500, name)
            for method in METHODS:
                crop = self.crop_of(method, FRAMES)
                holding = [i for i, shown in enumerate(seen) if places(shown, crop, ZOOM)]
                if exact:
                    self.assertEqual(len(holding), 1, (name, method))
            self.assertTrue(any((seen[0] != shown).any() for shown in seen), name)
        (file,) = self.sheet("f.apng", *self.crop, "--frames", "1-6")
        loop = Image.open(io.BytesIO(file.read_bytes()))
        self.assertEqual(loop.n_frames, 6)
        for frame in range(1, 7):
            loop.seek(frame - 1)
            for method in METHODS:
                self.assertEqual(
                    len(places(pixels(loop), self.crop_of(method, frame), ZOOM)), 1, (frame, method)
                )

    @NEEDS_PIL
    def test_gif_with_few_colours_is_exact_and_others_near(self) -> None:
        (gif,) = self.sheet("n.gif", *self.crop, "--loop", "methods")
        (apng,) = self.sheet("n.apng", *self.crop, "--loop", "methods")
        one, other = (Image.open(io.BytesIO(f.read_bytes())) for f in (gif, apng))
        for i in range(one.n_frames):
            one.seek(i), other.seek(i)
            apart = numpy.abs(pixels(one).astype(int) - pixels(other).astype(int))
            self.assertLess(apart.mean(), 1.0)

    @NEEDS_POPPLER
    def test_pdf_has_text_as_text_and_pictures_without_loss(self) -> None:
        for page, points in (
            ("a4", (842, 595)),
            ("a4-portrait", (595, 842)),
            ("slide", (960, 540)),
        ):
            (pdf,) = self.sheet(f"{page}.pdf", *self.crop, "--page", page)
            info = subprocess.run(
                ["pdfinfo", pdf], capture_output=True, text=True, check=True
            ).stdout
            size = re.search(r"Page size:\s+([\d.]+) x ([\d.]+)", info)
            self.assertEqual((round(float(size[1])), round(float(size[2]))), points)
            text = subprocess.run(
                ["pdftotext", "-layout", pdf, "-"], capture_output=True, text=True, check=True
            ).stdout
            for word in ("fxaa311", "preset=HIGH", "corner", "PSNR", "Ground truth"):
                self.assertIn(word, text)
            self.assertNotIn("...", text)
            subprocess.run(["pdfimages", "-png", pdf, self.folder / page], check=True)
            embedded = [picture(f) for f in self.folder.glob(f"{page}-*.png")]
            for method in METHODS:
                crop = self.crop_of(method, FRAMES)
                same = [e for e in embedded if e.shape == crop.shape and (e == crop).all()]
                self.assertGreaterEqual(len(same), 1, (page, method))
        # Drawn at its own resolution, the page has the crop's pixels as squares.
        subprocess.run(
            [
                "pdftoppm",
                "-r",
                "144",
                "-png",
                "-aa",
                "no",
                self.folder / "a4.pdf",
                self.folder / "drawn",
            ],
            check=True,
        )
        drawn = [picture(f) for f in sorted(self.folder.glob("drawn-*.png"))]
        self.assertEqual(drawn[0].shape[:2], (1190, 1684))
        for method in METHODS:
            crop = self.crop_of(method, FRAMES)
            self.assertGreaterEqual(sum(len(places(d, crop, ZOOM)) for d in drawn), 1, method)
        first = (self.folder / "slide.pdf").read_bytes()
        self.sheet("slide.pdf", *self.crop, "--page", "slide")
        self.assertEqual((self.folder / "slide.pdf").read_bytes(), first, "same input, same bytes")

    @NEEDS_PIL
    def test_pages_of_pictures_are_numbered(self) -> None:
        written = self.sheet("p.png", *self.crop, "--page", "a4")
        sizes = {picture(f).shape for f in written}
        self.assertEqual(sizes, {(1190, 1684, 3)})
        if len(written) > 1:
            self.assertEqual(
                [f.name for f in written], [f"p-{i + 1}.png" for i in range(len(written))]
            )
        (light,) = self.sheet("light.png", *self.crop, "--light")
        (dark,) = self.sheet("dark.png", *self.crop, "--dark")
        self.assertEqual(tuple(picture(light)[1, 1]), (255, 255, 255))
        self.assertLess(picture(dark)[1, 1].max(), 40)

    def test_without_the_module_png_and_apng_remain(self) -> None:
        alone = self.folder / "bin" / "aaresolve"
        alone.parent.mkdir()
        import program

        shutil.copy2(program.PROGRAM, alone)
        for name, code in (("s.png", 0), ("s.apng", 0), ("s.pdf", 3), ("s.webp", 3), ("s.gif", 3)):
            done = subprocess.run(
                [alone, "sheet", self.run_folder, "-o", self.folder / name],
                capture_output=True,
                text=True,
            )
            self.assertEqual(done.returncode, code, name + done.stderr)
            if code:
                self.assertIn("aaresolve_documents.so", done.stderr)
                self.assertEqual(len(done.stderr.splitlines()), 1)
                self.assertFalse((self.folder / name).exists())

    def test_of_a_run_without_truth(self) -> None:
        shot, run = self.folder / "shot", self.folder / "blind"
        self.synth("moving", shot, SIZE, 3)
        manifest = json.loads((shot / "shot.json").read_text())
        for frame in manifest["frames"]:
            del frame["truth"]
        (shot / "shot.json").write_text(json.dumps(manifest))
        asked = ("run", shot, "-m", "noaa,fxaa311", "-o", run, "-q")
        told = self.aaresolve(*asked).stdout
        for words in ("none of these frames has a ground truth", "--reference METHOD", "all\n"):
            self.assertIn(words, told)
        for words in ("PSNR", "gain dB", "SSIM", "sRGB"):
            self.assertNotIn(words, told)
        # What is advised helps.
        for command in (("sheet", run), ("survey", "make", run, "-o", self.folder / "s.html")):
            self.refused(3, *command, says=("has an image; run again with --write-frames all",))
        told = self.aaresolve(*asked, "--write-frames", "all", "--maps", "error").stdout
        self.assertNotIn("--write-frames", told)
        self.assertIn("no figures and no maps", told)
        self.assertNotIn("maps/error", told)
        self.aaresolve("sheet", run)
        self.refused(3, "sheet", run, "--columns", "crops,flip", says=("--columns flip", "truth"))
        self.refused(3, "gate", run, run, says=("the base has no figures",))
        self.aaresolve("survey", "make", run, "-q", "-o", self.folder / "s.html")
        self.assertIn("PSNR", self.aaresolve(*asked, "--reference", "fxaa311").stdout)
        self.aaresolve(*asked, "--write", "none")
        self.refused(3, "sheet", run, says=("--write exr --write-frames all",))

    def test_pictures_of_one_column_fit_every_page(self) -> None:
        """The heads of their columns were one letter wide and higher than a page."""
        shot, run = self.folder / "narrow", self.folder / "narrow_run"
        self.synth("moving", shot, (1, 300), 2, "-q")
        self.aaresolve("run", shot, "-m", "noaa,fxaa311", "-o", run, "-q")
        for page in ("free", "a4", "a4-portrait", "slide"):
            self.aaresolve("sheet", run, "--page", page, "-o", self.folder / f"{page}.png")

    def test_what_is_refused(self) -> None:
        def refuse(code: int, *options: object, says: str, name: str = "o.png") -> None:
            line = self.refused(
                code, "sheet", self.run_folder, "-o", self.folder / name, *options, says=(says,)
            )
            self.assertLess(len(line), 500)

        refuse(2, "--frame", "last", says="--frame = last")
        refuse(3, "--frame", "0", says="no image of frame 0")
        refuse(3, "--frame", "77", says="no image of frame 77")
        refuse(3, "--frames", "7-9", says="it has pictures of 1 to 6")
        refuse(2, "--frames", "4..2", says="numbers and ranges")
        refuse(2, "--crop", "1,2,3", says="X,Y,WIDTH,HEIGHT")
        refuse(2, "--crop", "150,2,30,30", says="160 x 96 px")
        refuse(2, "--columns", "frame,everything", says="found 'everything'")
        refuse(2, "--methods", "fxaa", says="no method or family 'fxaa'")
        refuse(2, "--zoom", "0", says="--zoom")
        refuse(2, "--page", "a5", says="--page")
        refuse(2, "--loop", "methods", says="expected -o NAME.gif")
        refuse(2, "--loop", "frames", name="o.gif", says="--frames")
        refuse(2, "--page", "a4", name="o.gif", says="no effect on a loop")
        refuse(2, "--crop", "0,0,160,96", "--zoom", "20", "--page", "a4", says="do not fit")
        refuse(2, says="found '.jpeg'", name="o.jpeg")
        refuse(2, says="found none", name="sheet")
        refuse(1, says="No such file or directory", name="no/such/folder/o.png")
        refuse(1, says="No such file or directory", name="no/such/folder/o.pdf")
        self.assertEqual([f.name for f in self.folder.iterdir() if f.name.startswith("o.")], [])


main()
