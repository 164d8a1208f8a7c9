"""A shader with a sign, an axis or a colour space turned round must not pass the comparison with the kernels."""

from __future__ import annotations

from gpu import GpuTest, main, need_device

LIMIT = 3e-5
# What is wrong, the shader, the method that runs it, the file and the change.
FAULTS = (
    (
        "motion's sign",
        "temporal/karis",
        "karis",
        "common/reproject.glsl",
        "d = -motion;",
        "d = motion;",
    ),
    (
        "y direction of the motion",
        "temporal/karis",
        "karis",
        "common/reproject.glsl",
        "d = -motion;",
        "d = vec2(-motion.x, motion.y);",
    ),
    (
        "jitter's sign in the filter",
        "temporal/karis",
        "karis",
        "temporal/karis.comp",
        "return weights[k] * toneWeight",
        "return weights[8 - k] * toneWeight",
    ),
    (
        "jitter's sign where the frame is un-jittered",
        "temporal/karis",
        "karis:unjitter=on",
        "common/temporal.glsl",
        "texelAt(currentImage, p, frame.readOffset)",
        "texelAt(currentImage, p, -frame.readOffset)",
    ),
    (
        "colour space",
        "temporal/karis",
        "karis",
        "common/temporal.glsl",
        "return texelAt(currentImage, p, frame.readOffset).rgb;",
        "return srgbEncode(texelAt(currentImage, p, frame.readOffset).rgb);",
    ),
)


class Negative(GpuTest):
    def test_each_fault_is_found(self) -> None:
        shot = self.folder / "shot"
        self.synth("moving", shot, (64, 48), 4)
        for name, shader, method, file, old, new in FAULTS:
            with self.subTest(name):
                right = self.verify(shot, [method])[method]
                self.assertLessEqual(right["max"], LIMIT)
                folder = self.changed(shader, file, old, new)
                wrong = self.verify(shot, [method], "--gpu-shaders", folder)[method]
                self.assertGreater(wrong["max"], 100 * LIMIT)
                self.aaresolve(
                    *("verify", shot, "-m", method, "-q", "--limit", LIMIT),
                    *("--gpu-shaders", folder),
                    expect=1,
                )


if __name__ == "__main__":
    need_device()
    main()
