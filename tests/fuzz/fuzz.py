"""Damaged input through the real program: every case must end in time with exit code 0, 2 or 3 (1 where a check or a
comparison may find something) and, when refused, with one line that says why.

    python3 tests/fuzz/fuzz.py build/aaresolve --runs 120             a fixed set of cases
    python3 tests/fuzz/fuzz.py build/aaresolve --seconds 300 --seed 7 as many as there is time for
    python3 tests/fuzz/fuzz.py build/aaresolve --case 4711 --seed 7   one case again, its files kept
    python3 tests/fuzz/fuzz.py build/aaresolve --seeds FOLDER         whole inputs for the targets of targets.h

Each case is made from (seed, number) alone, so it is the same on every machine. Standard library only.
"""

from __future__ import annotations

import argparse
import json
import random
import resource
import shutil
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path

import exr
import mutate
import seeds

HEADER_BYTES = 700
METHODS = [
    "noaa",
    "fxaa311:preset=12",
    "smaa1x:preset=HIGH",
    "uncharted",
    "taaSimplest",
    "rsaa:measure=depth",
    "unchartedNorm+fill=fxaa311",
]
# A run needs some memory even for small pictures; a damaged size must not take the machine's.
MEMORY_BYTES = 4 << 30
FILE_BYTES = 64 << 20


class Corpus:
    """Whole files to damage, made by the program itself."""

    def __init__(self, program: Path, folder: Path) -> None:
        self.program, self.folder = program, folder
        size = ["--size", "24x16", "--frames", "2", "-q"]
        self._call(
            "synth",
            "two_planes",
            "-o",
            folder / "shot",
            "--subsamples",
            "d3d2",
            "--subsample-color",
            *size,
        )
        self._call(
            "run",
            folder / "shot",
            "-m",
            "noaa",
            "-m",
            "taaSimplest",
            "-o",
            folder / "run",
            "-q",
            "--write",
            "exr,png",
            "--write-frames",
            "all",
        )
        values = [0.01 * i for i in range(24 * 16)]
        names = [
            "Combined.R",
            "Combined.G",
            "Combined.B",
            "Combined.A",
            "Depth.Z",
            "Vector.X",
            "Vector.Y",
            "Vector.Z",
            "Vector.W",
        ]
        names += [
            "Normal.X",
            "Normal.Y",
            "Normal.Z",
            "Denoising Albedo.R",
            "Denoising Albedo.G",
            "Denoising Albedo.B",
        ]
        channels = {f"ViewLayer.{n}": values for n in names}
        channels["ViewLayer.IndexOB.X"] = [float(i % 3) for i in range(24 * 16)]
        (folder / "native").mkdir()
        for frame in (1, 2):
            exr.write(
                folder / "native" / f"{frame:04d}.exr",
                24,
                16,
                channels,
                {"Frame": str(frame), "cycles.ViewLayer.samples": "1"},
            )
        shutil.copy(folder / "shot/shot.json", folder / "notes.json")
        self._survey(folder / "survey")

    def _survey(self, folder: Path) -> None:
        """A survey's page, key and answers."""
        questions = [w for kind in ("rank", "pair", "rating") for w in ("-Q", kind)]
        self._call("survey", "make", self.folder / "run", "-o", folder, "--quiet", *questions)
        key = json.loads((folder / "survey.key.json").read_text())
        codes = [p["code"] for p in key["questions"][0]["pictures"]]
        given = [
            {"ranks": {c: r + 1 for r, c in enumerate(codes)}},
            {"better": codes[0]},
            {"ratings": dict.fromkeys(codes, 4)},
        ]
        answers = {
            "format": "aaresolve-survey-answers",
            "version": 1,
            "survey": key["survey"],
            "participant": "p",
            "answers": [
                {"question": q["id"], "shown": codes, "seconds": 1.5, **own}
                for q, own in zip(key["questions"], given)
            ],
        }
        (folder / "answers.json").write_text(json.dumps(answers, indent=1))

    def write_seeds(self, to: Path) -> None:
        """A folder of whole inputs per target (targets.h). They are small, since a search tries thousands a second; those
        whose names begin with "bad-" must be refused."""

        def keep(target: str, name: str, content: bytes | str | dict) -> None:
            if isinstance(content, dict):
                content = json.dumps(content, separators=(",", ":"))
            folder = to / target
            folder.mkdir(parents=True, exist_ok=True)
            folder.joinpath(name).write_bytes(
                content if isinstance(content, bytes) else content.encode()
            )

        def keep_file(target: str, path: Path, name: str = "") -> None:
            content = path.read_bytes()
            if path.suffix == ".json":
                content = json.dumps(json.loads(content), separators=(",", ":")).encode()
            keep(target, name or path.name, content)

        for target, path in (
            ("manifest", "shot/shot.json"),
            ("notes", "notes.json"),
            ("results", "run/results.json"),
            ("key", "survey/survey.key.json"),
            ("png", "run/noaa/000001.png"),
            ("parts", "run/noaa/000001.exr"),
        ):
            keep_file(target, self.folder / path)
        self._write_frames(keep_file)
        seeds.write_documents(keep)
        seeds.write_results(keep, json.loads((self.folder / "run/results.json").read_text()))
        seeds.write_blender_frames(keep, self.folder / "seed.exr")
        seeds.write_pictures(keep, self.folder / "seed.exr")
        for i, method in enumerate(METHODS):
            keep("method", f"{i}.txt", method)
        self._write_kinds(keep)

    def _write_frames(self, keep_file) -> None:
        """Of a shot of the size of targets.cpp."""
        shot = self.folder / "small"
        self._call(
            *("synth", "two_planes", "-o", shot, "--size", "8x6", "--frames", "1", "-q"),
            *("--subsamples", "d3d2", "--subsample-color"),
        )
        keep_file("frame", min((shot / "frames").iterdir()))
        truth = min((shot / "truth").iterdir())
        keep_file("parts", truth, "truth.exr")
        keep_file("truth", truth)

    @staticmethod
    def _write_kinds(keep) -> None:
        """EXRs of every compression and PNGs of every kind, by OpenImageIO."""
        try:
            import OpenImageIO as oiio  # noqa: PLC0415
        except ModuleNotFoundError:
            print("no seeds of every compression: this Python has no OpenImageIO")
            return

        def written(name: str, channels: tuple[str, ...], kind: str, **attributes) -> bytes:
            spec = oiio.ImageSpec(17, 9, len(channels), kind)
            spec.channelnames = channels
            for key, value in attributes.items():
                spec.attribute(key.replace("_", ":"), value)
            image = oiio.ImageBuf(spec)
            for y in range(9):
                for x in range(17):
                    image.setpixel(x, y, [(x * y + c) % 7 / 7 for c in range(len(channels))])
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, name)
                if not image.write(str(path)):
                    raise RuntimeError(image.geterror())
                return path.read_bytes()

        for compression in ("none", "rle", "zips", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"):
            name = f"{compression}.exr"
            keep(
                "parts", name, written(name, ("R", "G", "B", "Z"), "half", compression=compression)
            )
        for kind, bits in (("uint8", 8), ("uint16", 16)):
            for channels in (("Y",), ("Y", "A"), ("R", "G", "B"), ("R", "G", "B", "A")):
                name = f"{''.join(channels)}{bits}.png"
                keep("png", name, written(name, channels, kind))

    def _call(self, *arguments) -> None:
        subprocess.run([self.program, *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


class Case:
    """One damaged input and the command that reads it."""

    def __init__(self, corpus: Corpus, seed: int, number: int, folder: Path) -> None:
        self.rng = random.Random(f"{seed}/{number}")
        self.number, self.folder, self.corpus = number, folder, corpus
        self.allowed = {0, 2, 3}
        self.arguments: list[str] = []
        kinds = [
            self.manifest,
            self.manifest,
            self.frame,
            self.frame,
            self.frame,
            self.truth,
            self.image,
            self.native,
            self.native,
        ]
        kinds += [self.notes, self.results, self.method, self.compare]
        kinds += [self.answers, self.question]
        kinds[number % len(kinds)]()

    def _copy(self, name: str) -> Path:
        source, target = self.corpus.folder / name, self.folder / name
        (shutil.copytree if source.is_dir() else shutil.copy)(source, target)
        return target

    def _damage(self, path: Path, header: int = HEADER_BYTES) -> None:
        path.write_bytes(mutate.mutate_bytes(self.rng, path.read_bytes(), header))

    def _read_shot(self, shot: Path) -> None:
        if self.rng.random() < 0.5:
            self.allowed.add(1)  # a check may find something
            self.arguments = ["check", str(shot), "-q", "-j", "1"]
        else:
            chosen = self.rng.sample(METHODS, 2)
            self.arguments = [
                "run",
                str(shot),
                "-m",
                chosen[0],
                "-m",
                chosen[1],
                "-o",
                str(self.folder / "out"),
                "-q",
                "-j",
                "1",
            ]
            if self.rng.random() < 0.3:
                self.arguments += ["--non-finite", "strict"]

    def manifest(self) -> None:
        shot = self._copy("shot")
        path = shot / "shot.json"
        path.write_text(
            mutate.mutate_json(self.rng, path.read_text()),
            encoding="utf-8",
            errors="surrogateescape",
        )
        self._read_shot(shot)

    def frame(self) -> None:
        shot = self._copy("shot")
        self._damage(
            self.rng.choice(
                sorted((shot / "frames").iterdir()) + sorted((shot / "centre").iterdir())
            ),
            3000,
        )
        self._read_shot(shot)

    def truth(self) -> None:
        shot = self._copy("shot")
        self._damage(next((shot / "truth").iterdir()))
        self._read_shot(shot)

    def image(self) -> None:
        kind = self.rng.choice(["png", "exr"])
        path = self.folder / f"in.{kind}"
        shutil.copy(next((self.corpus.folder / "run/noaa").glob(f"*.{kind}")), path)
        self._damage(path, 120 if kind == "png" else HEADER_BYTES)
        self.arguments = ["filter", "fxaa311", str(path), str(self.folder / f"out.{kind}")]

    def compare(self) -> None:
        path = self.folder / "b.exr"
        good = next((self.corpus.folder / "run/noaa").glob("*.exr"))
        shutil.copy(good, path)
        self._damage(path)
        self.allowed.add(1)
        self.arguments = ["compare", str(good), str(path), "--json"]

    def native(self) -> None:
        self._damage(self._copy("native") / "0002.exr", 1600)
        if self.rng.random() < 0.5:
            self._damage(self.folder / "native" / "0001.exr", 1600)
        self.arguments = [
            "import",
            str(self.folder / "native"),
            "-o",
            str(self.folder / "shot"),
            "-q",
            "-j",
            "1",
        ]
        if self.rng.random() < 0.3:
            self.arguments += [
                "--truth",
                str(self.folder / "native"),
                str(self.corpus.folder / "native"),
            ]

    def notes(self) -> None:
        path = self._copy("notes.json")
        path.write_text(
            mutate.mutate_json(self.rng, path.read_text()),
            encoding="utf-8",
            errors="surrogateescape",
        )
        native = self.corpus.folder / "native"
        self.arguments = [
            "import",
            str(native),
            "-o",
            str(self.folder / "shot"),
            "-q",
            "--jitter",
            str(path),
            "--camera",
            str(path),
        ]

    def results(self) -> None:
        run = self._copy("run")
        path = run / "results.json"
        path.write_text(
            mutate.mutate_json(self.rng, path.read_text()),
            encoding="utf-8",
            errors="surrogateescape",
        )
        command = self.rng.choice(["report", "sheet", "gate"])
        if command == "gate":
            self.allowed.add(1)  # damage may make a figure worse
            self.arguments = [
                "gate",
                str(self.corpus.folder / "run"),
                str(run),
                "--tol",
                "time=50%",
            ]
            return
        self.arguments = [
            command,
            str(run),
            "-o",
            str(self.folder / f"out.{'html' if command == 'report' else 'png'}"),
        ]

    def answers(self) -> None:
        survey = self._copy("survey")
        path = survey / self.rng.choice(["answers.json", "answers.json", "survey.key.json"])
        path.write_text(
            mutate.mutate_json(self.rng, path.read_text()),
            encoding="utf-8",
            errors="surrogateescape",
        )
        self.arguments = ["survey", "score", str(survey / "answers.json")]
        self.arguments += ["--survey", str(survey / "survey.html"), "-o", str(survey / "scores")]

    def question(self) -> None:
        good = "rank noaa taaSimplest frames=1-2 fps=8 region=2,3,16,8 zoom=2 text=Look here."
        asked = mutate.mutate_text(self.rng, good).replace("\0", "")
        self.arguments = ["survey", "make", str(self.corpus.folder / "run"), "-Q", asked]
        self.arguments += ["-o", str(self.folder / "survey"), "-j", "1"]

    def method(self) -> None:
        self.arguments = [
            "plan",
            mutate.mutate_text(self.rng, self.rng.choice(METHODS)).replace("\0", ""),
        ]
        if self.rng.random() < 0.4:
            varied = mutate.mutate_text(self.rng, "kmin=0.5,0.9")
            shot = str(self.corpus.folder / "shot")
            self.arguments = [
                "sweep",
                shot,
                "-m",
                "uncharted",
                "--vary",
                varied,
                "-o",
                str(self.folder / "out"),
                "-q",
                "-j",
                "1",
            ]


def limit(memory: bool) -> None:
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_BYTES, FILE_BYTES))
    if memory:  # a sanitised program reserves terabytes of addresses
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY_BYTES, MEMORY_BYTES))


def fault(case: Case, program: Path, timeout: float, memory: bool) -> str:
    """What is wrong with the program's answer; empty when nothing is."""
    try:
        done = subprocess.run(
            [str(program), *case.arguments],
            capture_output=True,
            timeout=timeout,
            preexec_fn=lambda: limit(memory),
            stdin=subprocess.DEVNULL,
        )
    except subprocess.TimeoutExpired:
        return f"no end within {timeout:.0f} s"
    error = done.stderr.decode("utf-8", "replace")
    if done.returncode not in case.allowed:
        return f"exit code {done.returncode}: {error[-400:].strip()}"
    if "Sanitizer" in error or "runtime error:" in error:
        return error[:2000]
    said = [line for line in error.splitlines() if line.startswith("aaresolve: ")]
    if done.returncode in (2, 3) and len(said) != 1:
        return f"exit code {done.returncode} with {len(said)} lines of explanation: {error[-400:].strip()}"
    return ""


def main() -> int:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("program", type=Path)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--runs", type=int, help="number of cases")
    parser.add_argument("--seconds", type=float, help="instead of --runs: until then")
    parser.add_argument("--case", type=int, help="this case only; its files stay")
    parser.add_argument(
        "--keep", type=Path, default=Path("build/fuzz"), help="where failing inputs go"
    )
    parser.add_argument(
        "--timeout", type=float, default=60, help="seconds until a case counts as hanging"
    )
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seeds", type=Path, help="only write whole inputs there")
    parser.add_argument(
        "--no-memory-limit", action="store_true", help="for programs built with sanitisers"
    )
    o = parser.parse_args()
    program = o.program.resolve()
    numbers = iter([o.case]) if o.case is not None else iter(range(o.runs if o.runs else 10**9))
    end = time.monotonic() + o.seconds if o.seconds else None
    failures: list[str] = []
    count = 0
    lock = threading.Lock()
    with tempfile.TemporaryDirectory() as root:
        (Path(root) / "corpus").mkdir()
        corpus = Corpus(program, Path(root) / "corpus")
        if o.seeds:
            shutil.rmtree(o.seeds, ignore_errors=True)
            corpus.write_seeds(o.seeds)
            return 0

        def work() -> None:
            nonlocal count
            while end is None or time.monotonic() < end:
                with lock:
                    number = next(numbers, None)
                if number is None:
                    return
                folder = Path(root) / f"case{number}"
                folder.mkdir()
                case = Case(corpus, o.seed, number, folder)
                wrong = fault(case, program, o.timeout, not o.no_memory_limit)
                with lock:
                    count += 1
                    if wrong:
                        failures.append(
                            f"case {number} (seed {o.seed}): aaresolve {' '.join(case.arguments)}\n    {wrong}"
                        )
                        print(failures[-1], flush=True)
                    if wrong or o.case is not None:
                        kept = o.keep / f"seed{o.seed}_case{number}"
                        shutil.rmtree(kept, ignore_errors=True)
                        shutil.copytree(folder, kept)
                shutil.rmtree(folder, ignore_errors=True)

        threads = [threading.Thread(target=work) for _ in range(o.jobs)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    print(
        f"{count} cases, {len(failures)} failures (seed {o.seed})"
        + (f"; inputs in {o.keep}" if failures else "")
    )
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
