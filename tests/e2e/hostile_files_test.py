"""Files and folders that somebody made to do harm, or that went wrong in a way nobody thinks of: what they say of themselves
reaches neither another folder nor the terminal, asks for no memory that it cannot fill, and ends in one line."""

from __future__ import annotations

import json
import os
import resource
import shutil
import struct
import sys
from pathlib import Path

import pictures
from program import ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "tests/fuzz"))

import exr  # noqa: E402

BELL = "\x1b]0;owned\x07"  # what a terminal would obey


def little_memory() -> None:
    resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))


class HostileFiles(ProgramTest):
    def setUp(self) -> None:
        super().setUp()
        self.shot, self.run_folder = self.folder / "shot", self.folder / "run"
        self.synth("two_planes", self.shot, (24, 16), 2, "-q")

    def run_methods(self, *options: object, out: Path | None = None) -> None:
        self.aaresolve(
            *("run", self.shot, "-m", "noaa", "-m", "taaSimplest", "-q"),
            *("-o", out or self.run_folder, *options),
            errors="surrogateescape",
        )

    def edit(self, path: Path, change) -> None:
        document = json.loads(path.read_text())
        change(document)
        path.write_text(json.dumps(document))

    def test_names_do_not_reach_the_terminal(self) -> None:
        values = [0.5] * 4
        for name in (f"A{BELL}\nB", "C\x9bD"):  # the second is a control character of Latin-1
            picture = self.folder / "picture.exr"
            exr.write(
                picture,
                2,
                2,
                {f"{name}.{c}": values for c in "RGB"} | {f"x.{c}": values for c in "RGB"},
                {},
            )
            line = self.refused(
                3, "filter", "noaa", picture, self.folder / "o.png", says=("--layer",)
            )
            self.assertTrue(line.isprintable(), repr(line))
        self.edit(self.shot / "shot.json", lambda j: j.update(name=f"a{BELL}\nb"))
        said = self.aaresolve("check", self.shot).stdout
        self.assertTrue(all(line.isprintable() for line in said.splitlines()), repr(said))
        self.run_methods()
        self.edit(
            self.run_folder / "results.json", lambda j: j["methods"][0].update(text=f"noaa{BELL}")
        )
        said = self.aaresolve("gate", self.run_folder, self.run_folder, "--all").stdout
        self.assertTrue(all(line.isprintable() for line in said.splitlines()), repr(said))

    def test_names_are_text_in_pages(self) -> None:
        self.run_methods("--write", "png")
        evil = "</script><!--<script>alert(1)</script><b>\u202eabc\u00e4"
        self.edit(
            self.run_folder / "results.json",
            lambda j: (j["shot"].update(name=evil), j["methods"][1].update(title=evil)),
        )
        self.aaresolve("report", self.run_folder, "-o", self.folder / "report.html")
        page = (self.folder / "report.html").read_text("utf-8")
        self.assertNotIn("<script>alert", page)
        self.assertNotIn("<b>\u202e", page)

    def test_no_name_leads_out_of_the_folder(self) -> None:
        """Results say which pictures a later run replaces, and which a report shows."""
        self.run_methods("--write", "png")
        precious = self.folder / "precious" / "noaa" / "000001.png"
        precious.parent.mkdir(parents=True)
        precious.write_bytes(b"mine")
        results = (self.run_folder / "results.json").read_text()
        for change, says in (
            (lambda j: j["run"].update(maps={"../../precious": "x"}), "run.maps"),
            (lambda j: j["methods"][0].update(folder="../precious/noaa"), "folder"),
            (lambda j: j["methods"][0].update(folder=str(precious.parent)), "folder"),
            (
                lambda j: j["methods"][0]["frames"][0].update(image="../precious/noaa/000001.png"),
                "image",
            ),
            (lambda j: j["truth"].update(images={"1": "/etc/passwd"}), "truth.images"),
        ):
            (self.run_folder / "results.json").write_text(results)
            self.edit(self.run_folder / "results.json", change)
            self.refused(
                3, "report", self.run_folder, "-o", self.folder / "r.html", says=(says, "below the run's folder"),
            )  # fmt: skip
            self.run_methods("--write", "png")
            self.assertEqual(precious.read_bytes(), b"mine")

    def test_no_integer_is_cut_off(self) -> None:
        self.run_methods()
        results = (self.run_folder / "results.json").read_text()
        for value in (1e300, -1, 2**63, "24", None):
            (self.run_folder / "results.json").write_text(results)
            self.edit(self.run_folder / "results.json", lambda j: j["shot"].update(resolution=[value, 16]) if value != -1 else j["methods"][0].update(stateBytes=-1))  # fmt: skip
            self.refused(
                3, "gate", self.run_folder, self.run_folder, says=("expected a whole number",)
            )

    def test_what_does_not_end_is_no_file(self) -> None:
        os.mkfifo(self.folder / "pipe.exr")
        (self.folder / "zero.png").symlink_to("/dev/zero")
        for name in ("pipe.exr", "zero.png"):
            self.refused(
                3,
                "filter",
                "noaa",
                self.folder / name,
                self.folder / "o.png",
                says=("pipe or a device",),
            )
        for place, command in (
            (self.shot / "shot.json", ("check", self.shot)),
            (self.folder / "r" / "results.json", ("report", self.folder / "r", "-o", self.folder / "r.html")),
            (self.folder / "a.key.json", ("survey", "score", self.folder / "a.json", "--survey", self.folder / "a.key.json", "-o", self.folder / "s")),
        ):  # fmt: skip
            place.parent.mkdir(exist_ok=True)
            place.unlink(missing_ok=True)
            place.symlink_to("/dev/zero")
            self.refused(3, *command, says=(place.name,))

    def test_paths_that_no_system_takes(self) -> None:
        (self.folder / "loop").symlink_to("loop")
        for path in (self.folder / "loop", self.folder / ("x" * 300), self.folder / "loop" / "a"):
            self.refused(3, "check", path, says=(str(path)[:20],))
            self.refused(3, "filter", "noaa", path, self.folder / "o.png", says=(str(path)[:20],))
            self.refused(3, "compare", path, path, says=(str(path)[:20],))
            self.refused(3, "report", path, "-o", self.folder / "o.html", says=(str(path)[:20],))

    def test_what_may_not_be_read_is_not_missing(self) -> None:
        """Every kind of file: closed, it is said to be so; away, it is missing."""
        self.run_methods()
        layout, answers = self.folder / "layout.json", self.folder / "answers.json"
        for file in (layout, answers):
            file.write_text("{}")
        engine = self.folder / "engine"
        (engine / "color").mkdir(parents=True)
        shutil.copy(self.shot / "frames/000001.exr", engine / "color/1.exr")
        results, out = self.run_folder / "results.json", ("-o", self.folder / "o.html")
        picture, frame = (
            next((self.run_folder / "noaa").glob("*.exr")),
            self.shot / "frames/000002.exr",
        )
        cases = (
            (results, ("report", self.run_folder, *out)),
            (results, ("gate", self.run_folder, self.run_folder)),
            (results, ("sheet", self.run_folder)),
            (picture, ("filter", "noaa", picture, self.folder / "o.png")),
            (picture, ("compare", picture, picture)),
            (frame, ("run", self.shot, "-m", "noaa", "-o", self.folder / "o", "-q")),
            (self.shot / "shot.json", ("check", self.shot)),
            (layout, ("import", engine, "--layout", layout, "-o", self.folder / "i", "-q")),
            (answers, ("survey", "score", answers, "--survey", answers, "-o", self.folder / "s")),
        )
        # Root may read everything, so that another must try.
        other = {"user": 65534} if os.geteuid() == 0 else {}
        for path in (self.folder, *self.folder.rglob("*")):
            path.chmod(0o777 if path.is_dir() else 0o666)
        for file, command in cases:
            file.chmod(0)
            self.refused(3, *command, says=(f"{file}: cannot be read (Permission denied); check its permissions",), **other)  # fmt: skip
            if file.parent != self.folder:
                file.chmod(0o666)
                file.parent.chmod(0)
                self.refused(3, *command, says=("Permission denied", "permissions"), **other)  # fmt: skip
                file.parent.chmod(0o777)
            away = file.rename(file.with_suffix(".away"))
            self.refused(3, *command, says=(f"{file}: no such file",), **other)
            away.rename(file).chmod(0o666)

    def test_sizes_ask_for_no_memory(self) -> None:
        """Of a picture whose file cannot hold it, of an attribute, of one of many channels."""
        big = self.folder / "big.tif"
        big.write_bytes(pictures.tiff(16384, 16384, bytes(16)))
        self.refused(
            3,
            "filter",
            "noaa",
            big,
            self.folder / "o.png",
            says=("big.tif",),
            preexec_fn=little_memory,
        )
        attribute = self.folder / "attribute.exr"
        exr.write(attribute, 2, 2, {c: [0.5] * 4 for c in "RGB"}, {"about": "x"})
        whole = attribute.read_bytes()
        at = whole.index(b"about\0string\0") + len(b"about\0string\0")
        attribute.write_bytes(whole[:at] + struct.pack("<i", 0x7FFFFFF0) + whole[at + 4 :])
        self.refused(
            3,
            "filter",
            "noaa",
            attribute,
            self.folder / "o.png",
            says=("'about'", "larger than the file"),
            preexec_fn=little_memory,
        )
        # OpenEXR reads some by their type alone, and would go on in the middle of them.
        for kind, longer, words in (
            (b"dataWindow\0box2i\0", 4, ("'dataWindow'", "20 bytes", "16")),
            (b"channels\0chlist\0", 1, ("'channels'", "other than its size")),
        ):
            start = whole.index(kind) + len(kind)
            size = struct.unpack_from("<i", whole, start)[0]
            end = start + 4 + size
            attribute.write_bytes(
                whole[:start]
                + struct.pack("<i", size + longer)
                + whole[start + 4 : end]
                + bytes(longer)
                + whole[end:]
            )
            self.refused(3, "filter", "noaa", attribute, self.folder / "o.png", says=words)  # fmt: skip

    def test_a_history_that_takes_for_ever_is_refused(self) -> None:
        self.edit(self.shot / "shot.json", lambda j: j["jitter"].update(period=2**31 - 1))
        self.refused(
            3, "run", self.shot, "-m", "taaSimplest", "-o", self.run_folder, "-q", "--history", "full",
            says=("jitter.period", "full history"),
        )  # fmt: skip

    def test_paths_that_are_no_utf8(self) -> None:
        folder = Path(os.fsdecode(os.fsencode(self.folder) + b"/caf\xe9"))
        self.folder = folder
        folder.mkdir()
        self.shot.rename(folder / "shot")
        self.shot = folder / "shot"
        self.run_methods("--write", "png", out=folder / "run")
        picture = folder / "run/noaa/000002.png"
        for command in (("check", self.shot, "--json"), ("compare", picture, picture, "--json")):
            json.loads(self.aaresolve(*command, errors="surrogateescape").stdout)
        json.loads((folder / "run/results.json").read_bytes().decode("utf-8"))
        self.aaresolve(
            "report", folder / "run", "-o", folder / "report.html", errors="surrogateescape"
        )

    def test_frames_before_0(self) -> None:
        """A frame's number says which is meant, 0 and those below it, too."""
        shot, run = self.folder / "before", self.run_folder
        self.synth("moving", shot, (24, 16), 3, "-q")
        self.edit(
            shot / "shot.json", lambda j: [f.update(frame=f["frame"] - 2) for f in j["frames"]]
        )
        self.aaresolve("run", shot, "-m", "noaa", "-o", run, "-q", "--write-frames", "all", "--write", "exr,png")  # fmt: skip
        pages = {}
        for frame in (-1, 0, 1):
            page = self.folder / f"{frame}.png"
            self.aaresolve("sheet", run, "--frame", frame, "-o", page)
            pages[page.read_bytes()] = frame
        self.aaresolve("sheet", run, "-o", self.folder / "last.png")
        self.assertEqual(len(pages), 3)
        self.assertEqual(pages[(self.folder / "last.png").read_bytes()], 1)
        line = self.refused(
            3, "sheet", run, "--frame", "-2", "-o", self.folder / "s.png", says=("frame -2",)
        )
        self.assertLess(len(line), 200)
        out = ("-o", self.folder / "again", "-q")
        self.aaresolve("run", shot, "-m", "noaa", "--external", f"b={run / 'noaa'}", *out)
        results = json.loads((self.folder / "again/results.json").read_text())
        noaa, same = (m["frames"] for m in results["methods"])
        self.assertEqual([f["frame"] for f in same], [-1, 0, 1])
        for one, other in zip(noaa, same, strict=True):
            self.assertEqual(one["metrics"]["mse"], other["metrics"]["mse"])


if __name__ == "__main__":
    main()
