"""Surveys without a browser: which questions are made of what is asked, what is noted, what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path

from program import ROOT, ProgramTest, main

METHODS = "noaa fxaa311 taaSimplest uncharted smaa1x".split()


class Survey(ProgramTest):
    def run_of(self, names: list[str], size: tuple[int, int] = (96, 64)) -> Path:
        self.synth("moving", self.folder / "shot", size, 4)
        methods = [word for m in names for word in ("-m", m)]
        run = self.folder / "runs/moving"
        self.aaresolve(
            "run", self.folder / "shot", *methods, "--write-frames", "all", "-o", run, "-q"
        )
        return run

    def made(self, run: Path, *arguments: object) -> tuple[dict, str]:
        """The key, and what was noted."""
        out = self.folder / "survey"
        done = self.aaresolve(
            "survey", "make", run, "-o", out, "--overwrite", "--quiet", *arguments
        )
        return json.loads((out / "survey.key.json").read_text()), done.stderr

    def methods_of(self, key: dict) -> list[list[str]]:
        return [[p["method"] for p in q["pictures"]] for q in key["questions"]]

    def test_questions(self) -> None:
        run = self.run_of(METHODS)
        key, noted = self.made(run)
        self.assertEqual(self.methods_of(key), [METHODS])
        self.assertEqual(key["questions"][0]["region"], [0, 0, 96, 64])
        self.assertEqual(key["questions"][0]["frames"], [4])
        self.assertEqual(noted, "")
        # What was shown is measured there: all of the last frame, as the run did.
        shown = key["questions"][0]["pictures"][0]["shown"]
        results = json.loads((run / "results.json").read_text())
        last = results["methods"][0]["frames"][-1]["metrics"]
        self.assertAlmostEqual(shown["psnr"], last["psnr"], places=9)
        self.assertAlmostEqual(shown["ssimLuma"], last["ssimLuma"], places=9)
        self.assertEqual(set(shown), {"psnr", "ssimLuma", "flip", "fmagMse"})
        pooled = results["methods"][0]["pooled"]["psnr"]
        self.assertAlmostEqual(key["questions"][0]["pictures"][0]["run"]["psnr"], pooled)
        key, _ = self.made(
            run, "-m", "smaa1x", "-m", "noaa", "-Q", "pairs", "-Q", "rating frames=2-3"
        )
        self.assertEqual(self.methods_of(key), [["smaa1x", "noaa"]] * 2)
        # Commas as everywhere, in the option and in a question; -q is no progress.
        comma, _ = self.made(
            run, "-m", "smaa1x,noaa", "--question", "pairs", "-Q", "rank truth,noaa fxaa311"
        )
        self.assertEqual(self.methods_of(comma), [["smaa1x", "noaa"], ["truth", "noaa", "fxaa311"]])
        quiet = self.aaresolve("survey", "make", run, "-q", "-o", self.folder / "quiet.html")
        self.assertEqual(quiet.stderr, "")
        self.refused(
            2, "survey", "make", run, "-q", "rank noaa", "-o", self.folder / "quiet.html",
            says=("'rank noaa' is a question", "--question"),
        )  # fmt: skip
        self.assertEqual([q["kind"] for q in key["questions"]], ["pair", "rating"])
        self.assertEqual(key["questions"][1]["frames"], [2, 3])
        self.assertEqual(key["questions"][1]["framesPerSecond"], 24)
        # A region changes what was seen, so also its figures; the same picture keeps its code.
        key, _ = self.made(
            run, "-Q", "rank region=1,2,30,20", "-Q", "pair noaa smaa1x region=1,2,30,20"
        )
        self.assertNotEqual(key["questions"][0]["pictures"][0]["shown"]["psnr"], shown["psnr"])
        code = [{p["method"]: p["code"] for p in q["pictures"]} for q in key["questions"]]
        self.assertEqual(code[0]["smaa1x"], code[1]["smaa1x"])

    def test_of_a_run_of_a_region_against_a_method(self) -> None:
        self.run_of(METHODS[:2])
        run = self.folder / "against"
        methods = [word for m in METHODS[:3] for word in ("-m", m)]
        against = ("--reference", "fxaa311", "--region", "8,4,40,32")
        self.aaresolve("run", self.folder / "shot", *methods, *against, "-o", run, "-q")
        key, _ = self.made(run)
        self.assertEqual(key["questions"][0]["region"], [8, 4, 40, 32])
        shown = {p["method"]: p["shown"] for p in key["questions"][0]["pictures"]}
        self.assertEqual(shown["fxaa311"], {})  # what the others are held against
        self.assertIn("psnr", shown["noaa"])

    def test_of_every_run_or_of_one(self) -> None:
        one = self.run_of(METHODS[:2])
        two = self.folder / "other"
        two.symlink_to(one)
        same = self.folder / "again/moving"
        same.parent.mkdir()
        same.symlink_to(one)
        key, _ = self.made(one, two, "-Q", "rank", "-Q", "pair run=other", "-Q", "rating run=1")
        self.assertEqual(
            [(q["kind"], q["run"]) for q in key["questions"]],
            [("rank", "moving"), ("rank", "other"), ("pair", "other"), ("rating", "moving")],
        )
        key, _ = self.made(one, same)
        self.assertEqual([q["run"] for q in key["questions"]], ["moving", str(same)])

    def test_many_methods_are_shared_out(self) -> None:
        names = [*METHODS, *"mlaa fxaa1 nfaa dlaa".split()]
        run = self.run_of(names)
        # Seven to rank: two questions, the first method in each.
        seven = [word for m in names[1:8] for word in ("-m", m)]
        key, _ = self.made(run, *seven)
        self.assertEqual(self.methods_of(key), [[names[1], *names[2:5]], [names[1], *names[5:8]]])
        key, _ = self.made(run)  # nine: five and five
        self.assertEqual([len(group) for group in self.methods_of(key)], [5, 5])

    def test_codes_are_by_chance_or_from_a_seed(self) -> None:
        run = self.run_of(METHODS[:3])
        page = self.folder / "survey/survey.html"
        self.made(run, "--seed", 1)
        first = page.read_bytes()
        self.made(run, "--seed", 1)
        self.assertEqual(first, page.read_bytes())
        # The key of a survey is not lost by making another.
        again = ("survey", "make", run, "-o", page)
        self.refused(3, *again, says=("survey.key.json", "which its answers need", "--overwrite"))
        self.assertEqual(first, page.read_bytes())
        self.aaresolve(*again, "--overwrite")
        self.assertNotEqual(first, page.read_bytes())

    def test_no_name_of_a_method_is_in_the_page(self) -> None:
        run = self.run_of(METHODS)
        self.made(run, "-Q", "rank", "-Q", "pair noaa truth")
        page = (self.folder / "survey/survey.html").read_text()
        readable = re.sub(r'"data:image/png;base64,[^"]*"', "", page)
        self.assertLess(len(readable), len(page))
        # The colours of methods are the same in every page.
        common = (ROOT / "resolver/report/web/common.js").read_text()
        self.assertIn(common, readable)
        readable = readable.replace(common, "")
        for word in [*METHODS, "truth"]:
            self.assertNotIn(word, readable)

    def test_what_misleads_is_noted(self) -> None:
        run = self.run_of(METHODS[:2])
        _, noted = self.made(run, "-Q", "pair text=Is smaa1x, or fxaa311, better?")
        self.assertIn("q1: its text names the method fxaa311", noted)
        self.assertNotIn("same pixels", noted)
        _, noted = self.made(run, "-Q", "pair region=0,0,1,1")
        self.assertIn("q1: noaa and fxaa311 have the same pixels here", noted)

    def test_questions_are_checked(self) -> None:
        run = self.run_of(METHODS, (240, 160))
        page = self.folder / "survey.html"

        def refused(question: str, *says: str) -> None:
            self.refused(2, "survey", "make", run, "-o", page, "-Q", question, says=says)

        refused("ranks noaa", "did you mean 'rank'?")
        refused("rank noaa fxaa31", "no method 'fxaa31' in moving", "did you mean 'fxaa311'?")
        refused("rank noaa noaa", "named twice")
        refused("rank noaa", "two methods or more")
        refused("pair noaa fxaa311 smaa1x", "expected two methods")
        refused("rating truth", "a method beside truth")
        refused("rank zoon=2", "did you mean 'zoom='?")
        refused("rank zoom=0", "zoom: expected a whole number from 1 to 16")
        refused("rank fps=fast", "fps: expected 0.1 to 240")
        refused("rank region=200,0,100,100", "not all within the picture", "240 x 160")
        refused("rank region=auto:9", "auto or auto:WxH")
        refused("rank frame=9", "one of 1 to 4")
        refused("rank frames=4-4", "two or more")
        refused("rank frame=1 frames=all", "exclude each other")
        refused("rank run=other", "one of moving")
        self.assertFalse(page.exists())
        questions = self.folder / "questions.txt"
        questions.write_text("# comment\n\nrank\nrank fxaa")
        asked = ("survey", "make", run, "-o", page, "--questions", questions)
        self.refused(3, *asked, says=("questions.txt: line 4: no method 'fxaa'",))
        questions.write_text("# comment")
        self.refused(3, *asked, says=("expected a question per line, found none",))
        self.refused(2, "survey", "mak", says=("expected make or score, found 'mak'",))
        self.refused(2, "survey", says=("expected make or score, found nothing",))

    def test_bad_answers_are_refused(self) -> None:
        key, _ = self.made(self.run_of(METHODS[:2]), "-Q", "rank", "-Q", "pair")
        page = self.folder / "survey/survey.html"
        codes = [p["code"] for p in key["questions"][0]["pictures"]]
        good = {
            "format": "aaresolve-survey-answers",
            "version": 1,
            "survey": key["survey"],
            "participant": "p",
            "answers": [
                {
                    "question": "q1",
                    "shown": codes,
                    "ranks": {codes[0]: 2, codes[1]: 1},
                    "seconds": 1,
                },
                {"question": "q2", "shown": codes, "better": codes[1], "seconds": 1},
            ],
        }
        first, bad = self.folder / "first.json", self.folder / "bad.json"
        first.write_text(json.dumps(good))
        score = ("survey", "score", first, "--survey", page)
        self.assertIn("too few: 1 participant", self.aaresolve(*score).stderr)

        def refused(text: str, *says: str) -> None:
            bad.write_text(text)
            self.refused(3, "survey", "score", first, bad, "--survey", page, says=(str(bad), *says))

        refused(json.dumps(good)[:50], "not valid JSON at line 1, column 51")
        refused(json.dumps({**good, "survey": "0"}), "survey: expected", 'found "0"')
        refused(json.dumps({**good, "answers": good["answers"][:1]}), "none to q2")
        good["answers"][1]["better"] = codes[0]
        refused(json.dumps(good), "of the same participant (p)", "keep one of the two files")
        self.refused(
            3,
            "survey",
            "score",
            self.folder / "none.json",
            "--survey",
            page,
            says=("no such file",),
        )
        (self.folder / "survey/survey.key.json").unlink()
        self.refused(3, *score, says=("survey.key.json: no such file", "the key"))


main()
