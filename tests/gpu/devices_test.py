"""Devices by name and number, and every way in which there is none: one clear line, exit code 3 (usage: 2)."""

from __future__ import annotations

import json
import os

from gpu import GpuTest, main, need_device


class Devices(GpuTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot = self.folder / "shot"
        self.synth("moving", self.shot, (16, 12), 2)

    def run_on(self, device: str, *more: object) -> tuple[object, ...]:
        return (
            "run",
            self.shot,
            "-m",
            "karis",
            "-o",
            self.folder / "out",
            "-q",
            *more,
            "--device",
            device,
        )

    def test_chosen_by_number_and_name(self) -> None:
        devices = json.loads(self.aaresolve("devices", "--json").stdout)
        name = devices[0]["name"]
        self.assertIn(name, self.aaresolve("devices").stdout)
        for text in ("vulkan", "vulkan:0", "vulkan:" + name.split()[0].upper()):
            self.aaresolve(*self.run_on(text))
            results = json.loads((self.folder / "out/results.json").read_text(encoding="utf-8"))
            device = results["run"]["device"]
            self.assertEqual((device["name"], device["judged"]), (name, True))
            method = results["methods"][0]
            self.assertGreater(method["deviceSecondsMedian"], 0)
            self.assertEqual(method["nsPerPixel"], 0)  # it did not run on the processor

    def test_times_beside_the_processor(self) -> None:
        self.aaresolve(*self.run_on("vulkan", "--device-times"))
        results = json.loads((self.folder / "out/results.json").read_text(encoding="utf-8"))
        self.assertFalse(results["run"]["device"]["judged"])
        self.assertGreater(results["methods"][0]["deviceSecondsMedian"], 0)
        self.assertGreater(results["methods"][0]["nsPerPixel"], 0)
        self.aaresolve("report", self.folder / "out")
        self.aaresolve("sheet", self.folder / "out")

    def test_refused(self) -> None:
        self.refused(3, *self.run_on("vulkan:99"), says=("no such usable device", "0 "))
        self.refused(3, *self.run_on("vulkan:nobody's card"), says=("no such usable device",))
        self.refused(2, *self.run_on("metal"), says=("vulkan:NUMBER", "metal"))
        self.refused(2, *self.run_on("cpu", "--gpu-validate"), says=("no effect",))
        self.refused(2, *self.run_on("cpu", "--device-times"), says=("no effect",))
        self.refused(2, *self.run_on("vulkan", "--debug-layers"), says=("--debug-layers", "cpu"))
        self.refused(
            3, *self.run_on("vulkan", "--gpu-shaders", self.folder / "none"), says=("SPIR-V",)
        )

    def test_no_driver(self) -> None:
        nothing = {**os.environ, "VK_ICD_FILENAMES": "/nowhere", "VK_DRIVER_FILES": "/nowhere"}
        self.refused(3, *self.run_on("vulkan"), says=("driver", "--device cpu"), env=nothing)

    def test_damaged_shader(self) -> None:
        folder = self.folder / "spirv/temporal"
        folder.mkdir(parents=True)
        (folder / "karis.spv").write_bytes(b"no shader")
        self.refused(
            3,
            *self.run_on("vulkan", "--gpu-shaders", self.folder / "spirv"),
            says=("karis.spv", "SPIR-V"),
        )


if __name__ == "__main__":
    need_device()
    main()
