"""The study as a workflow: its configuration, its plan, and what it says when something is missing. No picture is made;
tests/farm does that. The plan needs snakemake, which `make farm` installs; without it that part is skipped."""

from __future__ import annotations

import copy
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path
from unittest import skipUnless

from program import PROGRAM, ROOT, ProgramTest, main

sys.path.insert(0, str(ROOT / "scenes/farm"))

sys.path.insert(0, str(ROOT / "scenes/reproduce"))

from costs_page import Costs, hours, jobs_of, line  # noqa: E402
from nodes import Job, wall_seconds  # noqa: E402
from study import BadStudy, study_of  # noqa: E402

SNAKEMAKE = shutil.which("snakemake")
SMALL = {
    "out": "out",
    "scenes": ["hard_edges", {"scene": "hairball --rotating", "frames": "1-3,8", "truth_frames": "2,8"}],
    "frames": "1-5",
    "frames_per_job": 2,
    "size": "96x54",
    "samples": 1,
    "truth_samples": 16,
    "truth_frames": "all",
    "methods": ["noaa", "accumReject+fill=smaa1x:preset=LOW"],
    "export": "",
    "run": "--metrics flip",
    "claim_timeout": 60,
    "jobs": {
        kind: {"threads": 1, "memory_mb": 1000, "minutes": 5}
        for kind in ("scene", "export", "truth", "run", "pages")
    },
}  # fmt: skip


class Configuration(ProgramTest):
    def test_parts(self) -> None:
        study = study_of(SMALL)
        still, moving = study.entries.values()
        self.assertEqual(still.parts(), ["1-2", "3-4", "5"])
        self.assertEqual(still.parts_with_truth(), still.parts())
        self.assertEqual((moving.name, moving.flags), ("hairball_rotating", ("--rotating",)))
        self.assertEqual(moving.parts(), ["1-2", "3,8"])
        words = moving.export_words("3,8", with_truth=True)
        self.assertEqual(words[words.index("--truth-frames") + 1], "8")
        self.assertEqual(words[words.index("--for") + 1], "noaa,accumReject,smaa1x:preset=LOW")
        none = study_of({**SMALL, "truth_frames": "none", "scenes": ["wall"]}).entries["wall"]
        self.assertEqual(none.parts_with_truth(), [])
        self.assertEqual(moving.run_words()[-2:], ["--metrics", "flip"])

    def test_mistakes_are_told(self) -> None:
        def scene(**members: object) -> dict:
            return {"scenes": [{"scene": "wall", **members}]}

        cases = (
            ({"sice": "96x54"}, "unknown key 'sice'; known: "),
            ({"scenes": []}, "scenes: expected a list of scenes, found []"),
            ({"scenes": ["wal"]}, "scenes, entry 1: expected one of arched_window, "),
            ({"scenes": ["common"]}, "found 'common'"),
            ({"scenes": ["wall", "wall"]}, "scenes, entry 2: wall is there already"),
            (scene(frame=3), "scenes, entry 1: unknown key 'frame'"),
            (scene(frames="3-1"), "frames: expected frames as 1-16 or 1,4,8-10, found '3-1'"),
            (scene(frames=[1, 2]), "frames: expected"),
            (scene(truth_frames="9"), "truth_frames: expected some of the frames 1-5, found 9"),
            (scene(size="96"), "size: expected WxH as 480x270, found '96'"),
            (scene(methods=""), "methods: expected at least one"),
            (scene(samples=0), "samples: expected a whole number above 0, found 0"),
            (scene(name="a b"), "name: expected letters"),
            (scene(export='"'), "export: expected words"),
            ({"out": "a b"}, "out: expected a folder"),
            ({"claim_timeout": 0}, "claim_timeout: expected seconds above 0, found 0"),
            (
                {"jobs": {"scene": {}}},
                "jobs: expected scene, export, truth, run, pages, found scene",
            ),
        )
        for change, says in cases:
            with self.assertRaises(BadStudy) as told:
                study_of({**copy.deepcopy(SMALL), **change})
            self.assertIn(says, str(told.exception), change)
            self.assertNotIn("\n", str(told.exception))
        without = {k: v for k, v in SMALL.items() if k != "frames"}
        self.assertRaisesRegex(BadStudy, "expected the key 'frames'", study_of, without)

    def test_states_of_slurm(self) -> None:
        """A job whose node died waits again; one that Slurm has forgotten is tried again."""
        answers = {
            "1": "RUNNING",
            "2": "PENDING",
            "3": "COMPLETED",
            "4": "TIMEOUT",
            "5": "NODE_FAIL",
        }
        words = {
            "1": "running",
            "2": "running",
            "3": "success",
            "4": "failed",
            "5": "failed",
            "6": "failed",
        }
        stand_in = self.folder / "scontrol"
        lines = [
            f'{job}) echo "JobId={job} JobState={state} Reason=None" ;;'
            for job, state in answers.items()
        ]
        script = ["#!/bin/sh", 'case "$4" in', *lines, '*) echo "slurm_load_jobs error: Invalid job id specified" >&2; exit 1 ;;', "esac"]  # fmt: skip
        stand_in.write_text("\n".join(script) + "\n")
        stand_in.chmod(0o755)
        (self.folder / "sacct").write_text("#!/bin/sh\nexit 1\n")
        (self.folder / "sacct").chmod(0o755)
        environment = {**os.environ, "PATH": f"{self.folder}:{os.environ['PATH']}"}
        for job, word in words.items():
            done = subprocess.run(
                [ROOT / "scenes/farm/slurm/status.py", job], capture_output=True, text=True, env=environment
            )  # fmt: skip
            self.assertEqual((done.stdout.strip(), done.returncode), (word, 0), (job, done.stderr))


class CostsOfTheFullStudy(ProgramTest):
    def test_jobs_wait_for_one_another(self) -> None:
        first = Job(2.0)
        parts = [Job(3.0, [first]) for _ in range(4)]
        last = Job(1.0, parts)
        chain = [first, *parts, last]
        self.assertEqual(wall_seconds(chain), 6.0)
        self.assertEqual(wall_seconds(chain, 1), 15.0)
        self.assertEqual(wall_seconds(chain, 2), 9.0)
        # The one with the longest way behind it goes first, though others stand before it.
        early = [Job(4.0), Job(1.0)]
        self.assertEqual(wall_seconds([*early, Job(5.0, [early[1]])], 1), 10.0)
        self.assertEqual(wall_seconds([*early, Job(5.0, [early[1]])], 2), 6.0)

    def document(self) -> dict:
        """A picture: 1 s and 1 ms per pixel. Truth: 2 s, 1 ms per pixel, 0.5 ms per pixel and sample of each half."""
        frame = lambda px: 1 + 1e-3 * px  # noqa: E731
        truth = lambda px, n: 2 + 1e-3 * px + 2 * 0.5e-3 * n * px  # noqa: E731
        seconds = {f"{w}x10": {"frames": frame(10 * w), "centre": frame(10 * w),
                               "truth": [truth(10 * w, n) for n in (2, 8)]} for w in (10, 20)}  # fmt: skip
        shot = dict(
            scene="wall",
            size=[100, 100],
            truthSamples=64,
            truthOf="",
            methods=2,
            blender="3",
            start=5.0,
        )
        lender = {**shot, "pictures": {"frames": 3, "centre": 1, "truth": 1}, "seconds": seconds}
        lent = {**lender, "truthOf": "lender", "pictures": {"frames": 3}}
        return {
            "machine": {"processor": "P", "system": "S"}, "judging": {"nsPerPixel": 1e5}, "sizes": list(seconds),
            "samples": [2, 8], "scenes": {"wall": 7.0}, "shots": {"lender": lender, "lent": lent},
        }  # fmt: skip

    def test_full_size_from_two_small_ones(self) -> None:
        document = self.document()
        cost = Costs(document["shots"]["lender"], document)
        self.assertAlmostEqual(cost.picture("frames"), 11.0)
        self.assertAlmostEqual(cost.truth(64), 2 + 10 + 640.0)
        self.assertEqual(line([(1, 2.0), (2, 1.0)], 9), 1.0, "noise makes no pixel free")
        jobs = jobs_of(document)
        begin = 7 + 5 + 11 + 11
        run = 1e-4 * 2 * 3 * 1e4
        self.assertAlmostEqual(
            sum(j.seconds for j in jobs["lender"]), begin + 2 * 16 + 5 + 652 + run
        )
        self.assertAlmostEqual(sum(j.seconds for j in jobs["lent"]), 3 * 16 + run)
        every = [j for of_shot in jobs.values() for j in of_shot]
        self.assertAlmostEqual(
            wall_seconds(every), begin + 657 + run, msg="the lent truth is waited for"
        )
        self.assertIn("results/farm-costs.md", "\n".join(hours(document)))


@skipUnless(SNAKEMAKE, "snakemake is not here; `make farm` installs it")
class Plan(ProgramTest):
    def snakemake(self, *options: str, expect: int = 0, **environment: str) -> str:
        done = subprocess.run(
            [str(SNAKEMAKE), "-s", str(ROOT / "scenes/Snakefile"), *options],
            cwd=self.folder,
            env={**os.environ, "AARESOLVE": str(PROGRAM), "XDG_CACHE_HOME": str(self.folder), **environment},
            capture_output=True,
            text=True,
        )  # fmt: skip
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done.stdout + done.stderr

    def jobs(self, *options: str) -> dict[str, int]:
        """What is planned, by rule."""
        said = self.snakemake("-n", *options)
        found = re.findall(r"^(\w+) +(\d+) +\d+ +\d+$", said, re.M)
        self.assertTrue(found or "Nothing to be done" in said, said)
        return {rule: int(count) for rule, count in found}

    def test_the_plan(self) -> None:
        study = ("--config", "out=study", "scenes=[hard_edges, wires]", "frames=1-4")
        wanted = dict(scene=2, begun=2, frames=4, truth=4, run=2, pages=2, study=1, all=1, total=18)
        self.assertEqual(self.jobs("--profile", str(ROOT / "scenes/farm/slurm"), *study), wanted)
        # Where everything has its mark, two more frames are a job of each sort, and what follows from them.
        for rule in ("scene", "begun", "frames.1-2", "frames.3-4", "truth.1-2", "truth.3-4", "run"):
            for name in ("hard_edges", "wires"):
                mark = self.folder / f"study/{name}/jobs/{rule}"
                mark.parent.mkdir(parents=True, exist_ok=True)
                mark.touch()
        pages = self.folder / "study/pages"
        pages.mkdir()
        for file in ("hard_edges.png", "hard_edges.html", "wires.png", "wires.html", "study.html"):
            (pages / file).touch()
        now = os.path.getmtime(pages / "study.html")
        for mark in sorted(self.folder.glob("study/*/jobs/*")):
            order = ("scene", "begun", "frames", "truth", "run").index(mark.name.split(".")[0])
            os.utime(mark, (now - 10 + order, now - 10 + order))
        self.assertEqual(self.jobs(*study), {})
        more = dict(frames=2, truth=2, run=2, pages=2, study=1, all=1, total=10)
        self.assertEqual(self.jobs(*study[:-1], "frames=1-6"), more)

    def test_what_is_wrong_is_said(self) -> None:
        said = self.snakemake("-n", "--config", "frames=4-1", expect=1)
        self.assertIn("the study's configuration: scenes, entry 1: frames: expected frames", said)
        for value, says in (
            ("3", "jobs: expected a table, found 3"),
            ("{truth: 4}", "jobs, truth: expected a table, found '4'"),
        ):
            self.assertIn(says, self.snakemake("-n", "--config", f"jobs={value}", expect=1))
        said = self.snakemake(
            "--cores", "1", "--config", "out=study", expect=1, AARESOLVE="/none/aaresolve", BLENDER="/none/blender"
        )  # fmt: skip
        self.assertIn("Blender: '/none/blender' was not found", said)
        self.assertIn("aaresolve: '/none/aaresolve' was not found", said)
        self.assertFalse((self.folder / "study").exists())


if not SNAKEMAKE:
    print(
        "farm: SKIPPED, THE PLAN WAS NOT TESTED: snakemake is not here; `make farm` installs it",
        file=sys.stderr,
    )
main()
