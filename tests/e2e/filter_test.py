"""Every method that reads one image: through `filter` (PNG and EXR, in and out) and through `run`, with the same result."""

from __future__ import annotations

import json

from program import ProgramTest, main

RUN_FRAME = "000001.exr"


class Filter(ProgramTest):
    def methods(self) -> list[dict]:
        return json.loads(self.aaresolve("list", "--json").stdout)["methods"]

    def same(self, a, b) -> None:
        """Equal pixels: compare finds no error at all."""
        figures = json.loads(self.aaresolve("compare", a, b, "--json").stdout)
        text = json.dumps(figures)
        self.assertIn('"psnr": "Inf"', text, f"{a} and {b} differ: {text}")

    def test_every_method_of_one_image(self) -> None:
        shot = self.folder / "shot"
        size = ("--size", "120x70", "--frames", "1", "--jitter", "none", "--for", "noaa")
        self.aaresolve("synth", "clutter", "-o", shot, *size)
        frame = shot / "frames" / RUN_FRAME
        listed = [m for m in self.methods() if m["passes"] == ["color"] and not m["temporal"]]
        single = [m["id"] for m in listed]
        # resolver/methods/method.h: methods of reference alone may have no intermediate image.
        with_layers = {m["id"] for m in listed if m["family"] != "reference"}
        self.assertGreater(len(single), 10)
        self.assertIn("cmaa2", single)
        out = self.folder / "run"
        chosen = [word for m in single for word in ("-m", m)]
        self.aaresolve(
            "run", shot, *chosen, "-o", out, "-q", "--write", "exr,png", "--debug-layers"
        )
        self.aaresolve("filter", "noaa", frame, self.folder / "in.png")
        for method in single:
            with self.subTest(method=method):
                exr, png = self.folder / f"{method}.exr", self.folder / f"{method}.png"
                layers = self.folder / f"{method}.layers.exr"
                debug = ("--debug-layers", layers) if method in with_layers else ()
                self.aaresolve("filter", method, frame, exr, *debug)
                self.same(exr, out / method / RUN_FRAME)
                self.aaresolve("filter", method, frame, png)
                self.same(png, out / method / RUN_FRAME.replace(".exr", ".png"))
                from_png = self.folder / f"{method}.from.png"
                self.aaresolve("filter", method, self.folder / "in.png", from_png)
                self.assertEqual(from_png.read_bytes()[:4], b"\x89PNG")
                written = (out / method / RUN_FRAME.replace(".exr", ".layers.exr")).exists()
                self.assertEqual(written, layers.exists())
                if method in with_layers:
                    self.assertTrue(
                        written, f"{method} has no debug layers: its debugLayers() returns none"
                    )
                    other = out / method / RUN_FRAME.replace(".exr", ".layers.exr")
                    self.assertEqual(layers.read_bytes(), other.read_bytes())

    def test_blend_space_is_the_files_space(self) -> None:
        """A method told to blend encoded values writes the same picture to PNG and, linearised, to EXR."""
        shot, out = self.folder / "shot", self.folder / "run"
        self.synth("clutter", shot, (90, 60), 1, "--jitter", "none")
        spec = "smaa1x:blendSpace=encoded"
        self.aaresolve("run", shot, "-m", spec, "-o", out, "-q", "--write", "exr,png")
        folder = out / "smaa1x_blendSpace=encoded"
        png = self.folder / "again.png"
        self.aaresolve("filter", "noaa", folder / RUN_FRAME, png)
        self.same(png, folder / RUN_FRAME.replace(".exr", ".png"))

    def test_dithered_codes(self) -> None:
        """Noise instead of rounding, the same in every run; refused where nothing is rounded by it."""
        shot, out = self.folder / "shot", self.folder / "run"
        self.synth("zone_plate", shot, (64, 48), 2, "--jitter", "none")
        frame = shot / "frames" / RUN_FRAME
        plain, one, again = (self.folder / f"{n}.png" for n in ("plain", "one", "again"))
        self.aaresolve("filter", "noaa", frame, plain)
        for picture in (one, again):
            self.aaresolve("filter", "noaa", frame, picture, "--dither")
        self.assertEqual(one.read_bytes(), again.read_bytes())
        self.assertNotEqual(one.read_bytes(), plain.read_bytes())
        difference = json.loads(self.aaresolve("compare", one, plain, "--json").stdout)["pooled"][
            "mse"
        ]
        self.assertLess(65025 * difference, 1.0, "a code at most")
        self.aaresolve(
            "run",
            shot,
            "-m",
            "noaa",
            "-o",
            out,
            "-q",
            "--write",
            "png",
            "--write-frames",
            "all",
            "--dither",
        )
        self.same(out / "noaa" / RUN_FRAME.replace(".exr", ".png"), one)
        self.refused(
            2, "filter", "noaa", frame, self.folder / "a.exr", "--dither", says=("--dither", "EXR")
        )
        for words, says in ((("exr",), "png"), (("png", "--quantise", "8"), "--quantise")):
            self.refused(
                2, "run", shot, "-m", "noaa", "-o", out, "--dither", "--write", *words, says=("--dither", says)
            )  # fmt: skip

    def test_methods_of_more_passes_are_refused(self) -> None:
        image = self.folder / "in.png"
        shot = self.folder / "shot"
        self.synth("circles", shot, (32, 32), 1, "--jitter", "none")
        self.aaresolve("filter", "noaa", shot / "frames" / RUN_FRAME, image)
        refused = [m["id"] for m in self.methods() if m["passes"] != ["color"]]
        self.assertGreater(len(refused), 10)
        for method in refused:
            with self.subTest(method=method):
                self.refused(
                    2,
                    "filter",
                    method,
                    image,
                    self.folder / "out.png",
                    says=(method, "aaresolve run"),
                )
        self.refused(2, "filter", "fxaa311", image, self.folder / "out.jpg", says=(".png or .exr",))


if __name__ == "__main__":
    main()
