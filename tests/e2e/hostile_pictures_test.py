"""Pictures that are not what they seem: through `compare` and `filter`, which must say what they met. OpenImageIO writes them."""

from __future__ import annotations

import json
import math
from pathlib import Path

from program import ProgramTest, main

try:
    import numpy as np
    import OpenImageIO as oiio
except ImportError:  # both come with the package python3-openimageio
    np = oiio = None

W, H = 32, 24


def ramp(channels: int = 3, scale: float = 1.0):
    y, x, c = np.mgrid[0:H, 0:W, 0:channels]
    return (((x * 7 + y * 13 + c * 5) % 61) / 60 * scale).astype(np.float32)


def write(
    path: Path, pixels, kind: str = "float", names: list[str] | None = None, **attributes
) -> Path:
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    if names:
        spec.channelnames = tuple(names)
    for name, value in attributes.items():
        if hasattr(spec, name):
            setattr(spec, name, value)
        else:
            spec.attribute(name, value)
    # Colours of PNG and TIFF are straight: OpenImageIO would divide them by alpha.
    spec.attribute("oiio:UnassociatedAlpha", 1)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec), out.geterror()
    assert out.write_image(pixels), out.geterror()
    out.close()
    return path


def read(path: Path):
    """Pixels and description, colours as they are stored."""
    straight = oiio.ImageSpec()
    straight.attribute("oiio:UnassociatedAlpha", 1)
    file = oiio.ImageInput.open(str(path), straight)
    assert file, oiio.geterror()
    spec, pixels = file.spec(), file.read_image("float")
    file.close()
    return pixels, spec


class HostilePictures(ProgramTest):
    def setUp(self) -> None:
        if oiio is None:
            self.skipTest("needs the package python3-openimageio")
        super().setUp()

    def compare(self, a: Path, b: Path, *options: object, expect: int = 0) -> dict:
        metrics = "mse,psnr,ssim,flip"
        done = self.aaresolve(
            "compare", a, b, "--metrics", metrics, "--json", *options, expect=expect
        )
        return json.loads(done.stdout)

    def test_what_is_no_number_is_never_good(self) -> None:
        black = write(self.folder / "black.exr", np.zeros((H, W, 3), np.float32))
        white = write(self.folder / "white.exr", np.ones((H, W, 3), np.float32))
        for value, good in ((math.nan, black), (math.inf, white), (-math.inf, black)):
            with self.subTest(value=value):
                broken = write(self.folder / "b.exr", np.full((H, W, 3), value, np.float32))
                for a, b in ((broken, good), (good, broken), (broken, broken)):
                    found = self.compare(a, b)
                    self.assertAlmostEqual(found["pooled"]["mse"], 1.0, places=5)
                    self.assertLess(found["pooled"]["ssimLuma"], 0.1)
                    self.assertEqual(
                        found["nonFinite"],
                        {"a": W * H * 3 * (a == broken), "b": W * H * 3 * (b == broken)},
                    )
                    failed = self.compare(a, b, "--fail-below", "psnr=0", expect=1)
                    self.assertIn("which no figure calls good", " ".join(failed["failures"]))
                    raw = self.compare(a, b, "--non-finite", "raw")
                    self.assertEqual(set(raw["pooled"].values()), {"NaN"})
                    self.compare(a, b, "--non-finite", "raw", "--fail-below", "psnr=1", expect=1)
                    self.refused(
                        3, "compare", a, b, "--non-finite", "strict", says=("b.exr", "pixel (0, 0)")
                    )
        # One value of many: said, and the gate fails whatever the figure.
        pixels = ramp()
        clean = write(self.folder / "clean.exr", pixels)
        pixels[3, 5, 1] = math.nan
        one = write(self.folder / "one.exr", pixels)
        done = self.aaresolve("compare", one, clean)
        self.assertIn("1 NaN", done.stdout)
        self.aaresolve("compare", one, clean, "--fail-below", "psnr=1", expect=1)
        self.assertEqual(self.compare(clean, clean, "--fail-below", "psnr=99")["nonFinite"]["a"], 0)

    def test_filter_counts_what_it_replaces(self) -> None:
        pixels = ramp()
        pixels[8, 9] = math.inf, math.nan, -1
        source = write(self.folder / "in.exr", pixels)
        out = self.folder / "out.exr"
        for method in ("noaa", "smaa1x", "cmaa2", "fxaa311", "mlaa", "dlaa", "nfaa"):
            with self.subTest(method=method):
                said = self.aaresolve("filter", method, source, out).stdout
                self.assertIn("1 NaN, 1 Inf, 1 negative", said)
                self.assertTrue(np.isfinite(read(out)[0]).all())
        said = self.aaresolve("filter", "noaa", source, out, "--non-finite", "raw").stdout
        self.assertIn("2 values of the result are no numbers", said)
        self.refused(
            3,
            "filter",
            "noaa",
            source,
            out,
            "--non-finite",
            "strict",
            says=("in.exr", "pixel (9, 8)"),
        )

    def test_run_and_bench_count(self) -> None:
        shot, out = self.folder / "shot", self.folder / "out"
        self.synth("moving", shot, (48, 32), 2, "--for", "noaa", "--inject-nan", "10", "7")
        run = ("run", shot, "-m", "noaa", "-o", out, "-q")
        good = json.loads(self.aaresolve(*run, "--json").stdout)
        self.assertGreater(good["run"]["sanitised"]["colourNan"], 0)
        self.assertNotIn("nonFinite", good["methods"][0]["frames"][0])
        raw = json.loads(self.aaresolve(*run, "--json", "--non-finite", "raw").stdout)
        counts = [f.get("nonFinite", 0) for f in raw["methods"][0]["frames"]]
        self.assertGreater(sum(counts), 0)
        self.assertLess(
            raw["methods"][0]["frames"][0]["metrics"]["psnr"],
            good["methods"][0]["frames"][0]["metrics"]["psnr"],
        )
        broken = next(i for i, n in enumerate(counts) if n)
        self.assertEqual(raw["methods"][0]["frames"][broken]["metrics"]["relMse"], "NaN")
        self.assertIn("are no numbers", self.aaresolve(*run, "--non-finite", "raw").stdout)
        bench = ("bench", "-m", "noaa", "--shot", shot, "--frames", "2", "--repeats", "1")
        self.assertIn("colourNan", self.aaresolve(*bench).stdout)
        raw = json.loads(self.aaresolve(*bench, "--json", "--non-finite", "raw").stdout)
        row = raw["methods"][0]
        self.assertGreater(row["nonFinite"], 0)
        self.assertEqual(row["maxError"], "Inf")

    def test_alpha_is_not_applied_and_is_kept(self) -> None:
        pixels = np.round(ramp(4) * 255) / 255
        pixels[..., 3] = 0
        a = write(self.folder / "a.png", pixels, "uint8")
        other = pixels.copy()
        other[..., :3] = 1 - other[..., :3]
        b = write(self.folder / "b.png", other, "uint8")
        self.assertLess(self.compare(a, b)["pooled"]["psnr"], 20)
        pixels[..., 3] = 128 / 255
        half = write(self.folder / "half.png", pixels, "uint8")
        opaque = write(self.folder / "opaque.png", pixels[..., :3], "uint8")
        found = self.compare(half, opaque)
        self.assertEqual(found["pooled"]["psnr"], "Inf")
        self.assertEqual(found["alpha"], {"notOpaqueA": W * H, "notOpaqueB": 0, "differs": W * H})
        self.assertIn("alpha is not compared", self.aaresolve("compare", half, opaque).stdout)
        out = self.folder / "out.png"
        self.aaresolve("filter", "noaa", half, out)
        np.testing.assert_allclose(read(out)[0], pixels, atol=1e-6)
        self.refused(3, "filter", "noaa", half, self.folder / "out.exr", says=("half.png", "alpha"))
        linear = write(self.folder / "a.exr", pixels)
        self.aaresolve("filter", "noaa", linear, self.folder / "out.exr")
        np.testing.assert_allclose(read(self.folder / "out.exr")[0], pixels, atol=1e-6)
        self.refused(3, "filter", "noaa", linear, out, says=("a.exr", "alpha"))

    def test_data_window_is_no_picture_of_its_own(self) -> None:
        def at(x: int, y: int) -> Path:
            window = {"x": x, "y": y, "full_width": 64, "full_height": 48}
            return write(self.folder / f"at_{x}_{y}.exr", ramp(), **window)

        a, b = at(10, 5), at(20, 15)
        self.assertLess(self.compare(a, b)["pooled"]["psnr"], 40)
        self.assertEqual(self.compare(a, a)["pooled"]["psnr"], "Inf")
        out = self.folder / "out.exr"
        self.aaresolve("filter", "smaa1x", a, out)
        spec = read(out)[1]
        self.assertEqual((spec.x, spec.y, spec.width, spec.height), (10, 5, W, H))
        self.assertEqual((spec.full_width, spec.full_height), (64, 48))
        self.aaresolve("filter", "noaa", a, self.folder / "out.png")
        self.assertEqual(read(self.folder / "out.png")[0].shape[:2], (48, 64))

    def test_the_layer_that_is_meant(self) -> None:
        rgb = ["R", "G", "B"]

        def layers(name: str, *parts: tuple[str, float]) -> Path:
            pixels = np.concatenate([ramp(3, scale) for _, scale in parts], axis=2)
            names = [f"{layer}.{c}" for layer, _ in parts for c in rgb]
            return write(self.folder / name, pixels, "half", names)

        a = layers("a.exr", ("ViewLayer.AO", 1), ("ViewLayer.Combined", 1))
        b = layers("b.exr", ("ViewLayer.AO", 1), ("ViewLayer.Combined", 0.1))
        found = self.compare(a, b)
        self.assertLess(found["pooled"]["psnr"], 20)
        self.assertEqual(found["layerA"], "ViewLayer.Combined")
        self.assertEqual(self.compare(a, b, "--layer", "AO")["pooled"]["psnr"], "Inf")
        said = self.aaresolve("filter", "noaa", b, self.folder / "o.exr").stdout
        self.assertIn("layer 'ViewLayer.Combined'", said)
        self.assertAlmostEqual(float(read(self.folder / "o.exr")[0].max()), 0.1, places=3)
        unclear = layers("c.exr", ("L.AO", 1), ("L.Mist", 1))
        self.refused(3, "compare", unclear, unclear, says=("'L.AO', 'L.Mist'", "--layer"))
        self.compare(unclear, unclear, "--layer", "Mist")
        self.refused(3, "filter", "noaa", a, self.folder / "o.exr", "--layer", "X", says=("'X'",))

    def test_light_that_a_method_cuts_off_is_said(self) -> None:
        bright = write(self.folder / "bright.exr", ramp(3, 4.0))
        out = self.folder / "o.exr"
        for method, says in (("fxaa311", True), ("mlaa", True), ("noaa", False)):
            said = self.aaresolve("filter", method, bright, out).stdout
            self.assertEqual("cut off at 1" in said, says, said)
        said = self.aaresolve(
            "filter", "fxaa311", write(self.folder / "dim.exr", ramp()), out
        ).stdout
        self.assertNotIn("cut off", said)

    def test_every_storage_that_can_be_written(self) -> None:
        """Kinds, compressions and namings give one picture; what is none is named."""
        pixels = np.round(ramp() * 64) / 64  # of which no lossy compression makes anything else
        plain = write(self.folder / "plain.exr", pixels)
        names = (
            ["R", "G", "B"],
            ["red", "green", "blue"],
            ["L.R", "L.G", "L.B"],
            ["a.b.c.r", "a.b.c.g", "a.b.c.b"],
        )
        for compression in (
            "none",
            "rle",
            "zip",
            "zips",
            "piz",
            "pxr24",
            "b44",
            "b44a",
            "dwaa",
            "dwab",
        ):
            limit = 25 if compression[:3] in ("b44", "dwa") else 80
            for kind in ("half", "float"):
                for tile in (0, 16):
                    for channels in names if compression == "zip" else names[:1]:
                        file = write(
                            self.folder / "x.exr", pixels, kind, channels,
                            compression=compression, tile_width=tile, tile_height=tile,
                        )  # fmt: skip
                        psnr = self.compare(file, plain)["pooled"]["psnr"]
                        with self.subTest(compression=compression, kind=kind, tile=tile):
                            self.assertTrue(psnr == "Inf" or psnr > limit, psnr)
        turned = write(self.folder / "turned.tif", np.rot90(pixels).copy(), Orientation=6)
        self.assertEqual(read(turned)[1]["Orientation"], 6)
        straight = write(self.folder / "straight.tif", pixels)
        self.assertEqual(self.compare(turned, straight)["pooled"]["psnr"], "Inf")


if __name__ == "__main__":
    main()
