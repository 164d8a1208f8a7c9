"""What `make bundle` and `make addon` made, in systems where nothing is installed.

    python3 tests/bundle/run.py BUILD [unittest's options]

The program in Debian 12, 13 and sid without a C++ library: from a shot to results, contact sheet and report, with the
bits of the program that was built; with the driver of the newest Debian. The zip with the program in Debian 13 and sid
with Blender, numpy (which Debian's own Blender lacks there) and no other package, and in this machine's Blender. A
system that cannot be had is named, and skipped.
"""

from __future__ import annotations

import filecmp
import os
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "addon"))

import in_blender  # noqa: E402
import systems  # noqa: E402

BUILD = Path(sys.argv.pop(1)).resolve() if len(sys.argv) > 1 else Path("build").resolve()
ZIP, ZIP_WITH_PROGRAM = BUILD / "aa_resolve.zip", BUILD / "aa_resolve-linux-x64.zip"

# What a user does first. The shot is analytic, so that no Blender is needed.
SHOT_TO_REPORT = """
set -e
"$1" --version
"$1" synth circles -o "$2/shot" --size 64x36 --frames 3
"$1" check "$2/shot"
"$1" run "$2/shot" -m noaa -m fxaa311 -m taaSimplest -o "$2/out" -q
"$1" sheet "$2/out" -o "$2/out/sheet.png"
"$1" report "$2/out" -o "$2/out/report.html"
"""


def last_words(done: subprocess.CompletedProcess) -> str:
    return "\n" + (done.stdout + done.stderr)[-3000:]


class BundleTest(unittest.TestCase):
    def setUp(self) -> None:
        self.folder = Path(tempfile.mkdtemp(prefix="aa_bundle_test_"))
        self.addCleanup(shutil.rmtree, self.folder)

    def inside(
        self, name: str, shared: dict[Path, str], *command: str
    ) -> subprocess.CompletedProcess:
        try:
            return systems.run(name, shared, *command)
        except systems.CannotBeHad as reason:
            print(f"bundle: SKIPPED, NOTHING WAS TESTED IN {name}: {reason}", file=sys.stderr)
            raise unittest.SkipTest(f"{name}: {reason}")


class Program(BundleTest):
    def setUp(self) -> None:
        super().setUp()
        (archive,) = BUILD.glob("aaresolve-*-linux-x64.tar.gz")
        subprocess.run(["tar", "-xf", archive, "-C", self.folder], check=True)
        (self.bundle,) = self.folder.glob("aaresolve-*")
        self.work = self.folder / "work"
        self.work.mkdir()
        self.shared = {self.bundle: "bundle", self.work: "work"}

    def shell(self, name: str, script: str, *arguments: str) -> subprocess.CompletedProcess:
        """The bundle is at /tmp/bundle there, and /tmp/work stays."""
        return self.inside(name, self.shared, "sh", "-c", script, "sh", *arguments)

    def in_bare(self, suite: str) -> None:
        name = f"bare-{suite}"
        there = self.shell(name, SHOT_TO_REPORT, "/tmp/bundle/bin/aaresolve", "/tmp/work")
        self.assertEqual(there.returncode, 0, last_words(there))
        here = self.folder / "here"
        here.mkdir()
        built = subprocess.run(
            ["sh", "-c", SHOT_TO_REPORT, "sh", BUILD / "aaresolve", here],
            capture_output=True,
            text=True,
        )
        self.assertEqual(built.returncode, 0, last_words(built))
        compared = 0
        for mine in sorted(here.rglob("*")):
            if mine.suffix in (".exr", ".png") and mine.name != "sheet.png":  # which shows times
                theirs = self.work / mine.relative_to(here)
                self.assertTrue(filecmp.cmp(mine, theirs, shallow=False), theirs)
                compared += 1
        self.assertGreaterEqual(compared, 9)
        for page in ("sheet.png", "report.html"):
            self.assertGreater((self.work / "out" / page).stat().st_size, 10_000, page)

        for isa, flag in (("v2", "sse4_2"), ("v3", "avx2"), ("v4", "avx512vl")):
            if flag not in Path("/proc/cpuinfo").read_text():
                continue
            done = self.inside(
                name,
                self.shared,
                *("/tmp/bundle/bin/aaresolve", "run", "/tmp/work/shot", "-m", "taaSimplest"),
                *("--isa", isa, "-o", f"/tmp/work/{isa}", "-q"),
            )
            self.assertEqual(done.returncode, 0, last_words(done))
        # None of these systems has Vulkan.
        devices = self.inside(name, self.shared, "/tmp/bundle/bin/aaresolve", "devices")
        self.assertEqual(devices.returncode, 3, last_words(devices))
        self.assertIn("libvulkan", devices.stderr)
        jpeg = self.work / "picture.jpg"
        jpeg.write_bytes(b"\xff\xd8\xff\xe0" + bytes(64))
        other = self.inside(
            name,
            self.shared,
            *(
                "/tmp/bundle/bin/aaresolve",
                "filter",
                "fxaa311",
                "/tmp/work/picture.jpg",
                "/tmp/o.png",
            ),
        )
        self.assertEqual(other.returncode, 3, last_words(other))
        self.assertIn("convert the file to PNG or EXR", other.stderr)

    def test_in_debian_12(self) -> None:
        self.in_bare("bookworm")

    def test_in_debian_13(self) -> None:
        self.in_bare("trixie")

    def test_in_sid(self) -> None:
        self.in_bare("sid")

    def test_with_a_newer_driver(self) -> None:
        """Mesa's loads the system's C++ library; with an older one before it there would be no device."""
        shot = 'set -e; "$1" devices; "$1" synth circles -o /tmp/s --size 32x24 --frames 2 -q;'
        run = '"$1" run /tmp/s -m fxaa311 --device vulkan -o /tmp/o -q'
        done = self.shell("vulkan-sid", shot + run, "/tmp/bundle/bin/aaresolve")
        self.assertEqual(done.returncode, 0, last_words(done))
        self.assertIn("llvmpipe", done.stdout)
        ours = next(self.bundle.glob("lib/unless-newer/libstdc++*"))
        shadowed = f'LD_LIBRARY_PATH=/tmp/bundle/lib/unless-newer/{ours.name} "$1" devices'
        negative = self.shell("vulkan-sid", shadowed, "/tmp/bundle/libexec/aaresolve")
        self.assertNotIn("llvmpipe", negative.stdout, "the launcher would not be needed")

    def test_the_newer_of_two_libraries(self) -> None:
        """Numbers are compared and not letters: 6.0.9 is older than 6.0.30."""
        (ours,) = self.bundle.glob("lib/unless-newer/libstdc++.so.*/libstdc++.so.6")
        for version, taken in (("6.0.9", ours.parent), ("6.0.999", self.folder / "system")):
            system = self.folder / "system"
            shutil.rmtree(system, ignore_errors=True)
            system.mkdir()
            shutil.copy(ours, system / f"libstdc++.so.{version}")
            (system / "libstdc++.so.6").symlink_to(f"libstdc++.so.{version}")
            done = subprocess.run(
                [self.bundle / "bin/aaresolve", "--version"],
                env={**os.environ, "LD_LIBRARY_PATH": str(system), "LD_DEBUG": "libs"},
                capture_output=True,
                text=True,
            )
            self.assertEqual(done.returncode, 0, last_words(done))
            # The launcher has had a look at the system's; the program comes last.
            started = re.findall(r"calling init: (\S+/libstdc\+\+\.so\.6)", done.stderr)
            self.assertEqual(started[-1], f"{taken}/libstdc++.so.6")

    def test_a_bundle_that_is_not_whole(self) -> None:
        (self.bundle / "libexec/aaresolve").unlink()
        done = subprocess.run(
            [self.bundle / "bin/aaresolve", "--version"], capture_output=True, text=True
        )
        self.assertEqual(done.returncode, 3, last_words(done))
        self.assertRegex(
            done.stderr, "^error: .*libexec/aaresolve: .*unpack the whole bundle again\n$"
        )

    def test_every_part_has_its_licence(self) -> None:
        licences = self.bundle / "share/doc/aaresolve/licences"
        for part in (
            "libopenexr",
            "libimath",
            "libtbb",
            "libpng",
            "libdeflate",
            "libisal",
            "libfreetype",
            "libbrotli",
            "zlib",
        ):
            self.assertTrue(list(licences.glob(f"{part}*.txt")), part)
        for part in ("libstdc++6", "libgcc-s1", "fonts-dejavu-core", "npm-chart.js", "libglm-dev"):
            self.assertTrue((licences / f"{part}.txt").exists(), part)

    def test_the_program_alone_is_found_in_its_folder(self) -> None:
        """Nothing of the machine that it was built on is named in it but the dynamic loader."""
        dynamic = subprocess.run(
            ["readelf", "-d", self.bundle / "libexec/aaresolve"],
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        self.assertIn("Library rpath: [$ORIGIN/../lib]", dynamic)


class AddOn(BundleTest):
    def pressed_in(self, name: str) -> None:
        zips = self.folder / "zips"
        zips.mkdir()
        shutil.copy(ZIP_WITH_PROGRAM, zips)
        script = f"""
            set -e
            if python3 -c 'import OpenImageIO' 2>/dev/null; then echo "not bare"; exit 1; fi
            blender --command extension validate /tmp/zips/{ZIP_WITH_PROGRAM.name}
            blender --command extension install-file -r user_default --enable /tmp/zips/{ZIP_WITH_PROGRAM.name}
            blender -b --python-exit-code 9 -P /tmp/tests/compare_in_blender.py -- /tmp/work/shot
        """
        work = self.folder / "work"
        work.mkdir()
        done = self.inside(
            name, {zips: "zips", HERE: "tests", work: "work"}, "sh", "-c", script, "sh"
        )
        self.assertEqual(done.returncode, 0, last_words(done))
        self.assertIn("COMPARED", done.stdout)

    def test_in_debian_13(self) -> None:
        self.pressed_in("blender-trixie")

    def test_in_sid(self) -> None:
        self.pressed_in("blender-sid")

    def test_in_the_blender_here(self) -> None:
        """Installed as the buttons of its version do it."""
        blender = in_blender.blender()
        home = self.folder / "home"
        home.mkdir()
        done = subprocess.run(
            [blender, "-b", "--factory-startup", "--python-exit-code", "9"]
            + ["-P", HERE / "compare_in_blender.py", "--", self.folder / "shot", ZIP_WITH_PROGRAM],
            env={**in_blender.environment(), "BLENDER_USER_RESOURCES": str(home)},
            capture_output=True,
            text=True,
        )
        self.assertEqual(done.returncode, 0, last_words(done))
        self.assertIn("COMPARED", done.stdout)
        (program,) = home.rglob("aa_resolve/bundle/bin/aaresolve")
        self.assertTrue(os.access(program, os.X_OK))


class Zip(BundleTest):
    """What is in the two zips."""

    def test_one_folder_and_the_platform(self) -> None:
        for path, platform in (
            (ZIP, '"windows-x64"'),
            (ZIP_WITH_PROGRAM, 'platforms = ["linux-x64"]'),
        ):
            with zipfile.ZipFile(path) as archive:
                names = archive.namelist()
                self.assertEqual({name.split("/")[0] for name in names}, {"aa_resolve"})
                manifest = archive.read("aa_resolve/blender_manifest.toml").decode()
                self.assertIn(platform, manifest)
        self.assertIn("aa_resolve/bundle/libexec/aaresolve", names)

    def test_the_same_bytes_again(self) -> None:
        packer = HERE.parents[1] / "blender_addon/make_zip.py"
        (program,) = (BUILD / "bundle").glob("aaresolve-*")
        again = self.folder / "again.zip"
        subprocess.run(
            [sys.executable, packer, again, "--program", program], check=True, capture_output=True
        )
        self.assertTrue(filecmp.cmp(again, ZIP_WITH_PROGRAM, shallow=False))


if __name__ == "__main__":
    unittest.main(verbosity=2)
