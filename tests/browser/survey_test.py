"""survey_test.py PROGRAM ROOT BROWSER: a survey from end to end. The page is opened from disk without a network, answered
by a script as seven participants, left and taken up again; the saved answers are scored and held to values by hand."""

from __future__ import annotations

import json
import re
from pathlib import Path

from visited_page import ROOT, PageTest, main

PARTICIPANTS = 7
ALL_TIMERS = "--virtual-time-budget=10000000"
METHODS = ("noaa", "fxaa311", "taaSimplest", "uncharted", "smaa1x")
QUESTIONS = """# Stills, then one that is played.
rank noaa fxaa311 taaSimplest uncharted zoom=2 region=20,30,200,120 text=Look at the edges.

pairs noaa fxaa311 smaa1x region=auto:120x80 zoom=3
rating noaa smaa1x zoom=8
rank noaa taaSimplest truth frames=all fps=30 text=Which is steadiest?
"""


def wishes(who: int) -> dict[str, dict]:
    """What participant `who` thinks, by question and method."""
    order = ["fxaa311", "taaSimplest", "uncharted", "noaa"]
    if who >= 5:
        order[:2] = reversed(order[:2])
    return {
        "q1": {"kind": "rank", "values": {m: r + 1 for r, m in enumerate(order)}},
        "q2": {"kind": "pair", "better": "fxaa311"},  # over noaa
        "q3": {"kind": "pair", "better": "smaa1x"},  # over noaa
        "q4": {"kind": "pair", "better": "fxaa311" if who == 0 else "smaa1x"},
        "q5": {"kind": "rating", "values": {"noaa": 2, "smaa1x": 5 - who % 2}},
        "q6": {"kind": "rank", "values": {"truth": 1, "noaa": 2, "taaSimplest": 3}},
    }


# Answers as a visitor does: by clicks, the first ranking by keys. Once, in the middle, the page is loaded anew.
VISITOR = """
<pre id="collected"></pre>
<script type="module">
  const wishes = WISHES, $ = (id) => document.getElementById(id), images = JSON.parse($("data").textContent).images;
  const told = JSON.parse(sessionStorage.getItem("told") ?? '{"answers": [], "checks": {}}');
  const check = (what, ok) => { told.checks[what] = (told.checks[what] ?? true) && Boolean(ok); };
  const press = (key) => document.body.dispatchEvent(new KeyboardEvent("keydown", { key, bubbles: true }));
  const remember = () => sessionStorage.setItem("told", JSON.stringify(told));
  const click = (input) => { input.click(); };
  const codes = () => [...document.querySelectorAll("#pictures figure")].map((f) => f.dataset.picture);
  const checked = () => [...document.querySelectorAll("#answer input:checked")].map((i) => i.name + i.value).join();
  const rate = (code, value) => click(document.querySelector(`#answer input[name="${code}"][value="${value}"]`));
  const answer = (wish) => {
    const here = codes(), own = wish[here.join()] ?? Object.entries(wish).find(([set]) => set.split(",").sort().join() === here.slice().sort().join())[1];
    check("as many pictures as tabs", $("tabs").children.length === here.length);
    if (own.kind === "pair") {
      $("next").click();
      check("no question is skipped", $("said").textContent.includes("Choose"));
      press(String(here.indexOf(own.better) + 1));
      check("a pair is said", $("said").textContent.includes("is better"));
    } else if (own.kind === "rank") {
      rate(here[0], 1);
      rate(here[1], 1); // takes the first rank away from the other
      check("no rank twice", document.querySelectorAll('#answer input[value="1"]:checked').length === 1);
      here.forEach((code, k) => { press(String.fromCharCode(97 + k)); press(String(own.values[code])); });
      check("the order is said", $("said").textContent.startsWith("Best to worst: " + String.fromCharCode(65 + here.findIndex((c) => own.values[c] === 1))));
    } else for (const code of here) rate(code, own.values[code]);
  };
  // Of pictures that are larger than their window all show the same place.
  const scrolled = () => {
    const ports = [...document.querySelectorAll(".window")];
    press("a");
    if (ports[0].scrollWidth <= ports[0].clientWidth) return;
    ports[0].scrollTo(300, 200);
    press("b");
    check("the same place of all", ports[1].scrollLeft === 300 && ports[1].scrollTop === 200 && ports[0].closest("figure").hidden);
  };
  if (told.reloaded) {
    check("taken up where it was left", $("question-title").textContent === told.reloaded.title && checked() === told.reloaded.checked);
    told.reloaded = null;
    $("next").click();
  }
  while (told.answers.length < wishes.length) {
    if (!$("welcome").hidden) $("begin").click();
    while ($("end").hidden) {
      answer(wishes[told.answers.length]);
      if (!told.wasReloaded && $("question-title").textContent.startsWith("Question 3 ")) {
        told.wasReloaded = true;
        told.reloaded = { title: $("question-title").textContent, checked: checked() };
        remember();
        location.reload();
        await new Promise(() => {});
      }
      if ($("question-title").textContent.startsWith("Question 2 ")) { // there and back
        const before = checked();
        $("back").click();
        check("answers are there when one goes back", document.querySelectorAll("#answer input:checked").length > 0);
        $("next").click();
        check("and when one returns", checked() === before);
      }
      const canvas = document.querySelector("#pictures canvas");
      if (canvas) {
        await new Promise((done) => setTimeout(done, 500));
        const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
        check("what is played is drawn", data.some((v, i) => i % 4 < 3 && v > 0));
        check("it plays", $("play").textContent === "Pause" && !$("play").hidden);
        press(" ");
        check("it stops", $("play").textContent === "Play");
      } else {
        const image = document.querySelector("#pictures img");
        // Not decode(): the browser's virtual time waits for what is loaded and runs on while a picture is decoded.
        while (!image.complete || !image.naturalWidth) await new Promise((done) => setTimeout(done, 5));
        const perPixel = image.getBoundingClientRect().width / image.naturalWidth * devicePixelRatio;
        scrolled();
        check("whole pixels", Math.abs(perPixel - Math.round(perPixel)) < 1e-3);
      }
      $("next").click();
    }
    if (told.answers.length === 2) {
      $("remarks").value = "The <third> one & all";
      $("remarks").dispatchEvent(new Event("input"));
    }
    told.answers.push($("answers").value);
    $("save").click();
    check("the file has a name", $("saved").textContent.includes(".json"));
    $("another").click();
    $("another-yes").click();
    check("another begins anew", !$("welcome").hidden);
  }
  $("collected").textContent = JSON.stringify(told);
</script>
"""


def pcg32(seed: int):
    """The page's generator [O'Neill 2014], so that an order follows from the seed alone."""
    word = seed
    while True:
        old, word = word, (word * 6364136223846793005 + 1442695040888963407) % 2**64
        shifted, turn = ((word >> 18) ^ word) >> 27 & 0xFFFFFFFF, word >> 59
        yield (shifted >> turn | shifted << ((32 - turn) & 31)) & 0xFFFFFFFF


class Survey(PageTest):
    def make(self) -> tuple[Path, dict]:
        self.synth("moving", self.folder / "shot", (240, 160), 4)
        methods = [word for m in METHODS for word in ("-m", m)]
        run = self.folder / "runs/moving"
        self.aaresolve(
            "run", self.folder / "shot", *methods, "--write-frames", "all", "-o", run, "-q"
        )
        (self.folder / "questions.txt").write_text(QUESTIONS)
        page = self.folder / "survey.html"
        self.aaresolve(
            "survey",
            "make",
            run,
            "-o",
            page,
            "--questions",
            self.folder / "questions.txt",
            "--title",
            "Edges & <lines>",
        )
        return page, json.loads((self.folder / "survey.key.json").read_text())

    def test_from_end_to_end(self) -> None:
        page, key = self.make()
        source = page.read_text()
        self.assertIn("<title>Edges &amp; &lt;lines&gt;</title>", source)
        told = self.visit(page, source, key)
        self.assertEqual([what for what, ok in told["checks"].items() if not ok], [])
        for what in ("taken up where it was left", "the same place of all", "it plays"):
            self.assertIn(what, told["checks"])
        answers = [json.loads(text) for text in told["answers"]]
        self.assertEqual(len({a["participant"] for a in answers}), PARTICIPANTS)
        self.assertEqual(answers[2]["remarks"], "The <third> one & all")
        self.blinding_can_be_undone(key, answers)
        files = []
        for i, text in enumerate(told["answers"]):
            files.append(self.folder / f"answers{i}.json")
            files[-1].write_text(text)
        again = self.folder / "again.json"
        again.write_text(told["answers"][0])
        done = self.aaresolve(
            "survey", "score", *files, again, "--survey", page, "-o", self.folder / "scores"
        )
        self.assertIn("again.json: the same answers as", done.stderr)
        self.assertIn("remark of", done.stdout)
        self.scores_are(json.loads((self.folder / "scores/scores.json").read_text()))
        self.assertEqual(len((self.folder / "scores/scores.csv").read_text().splitlines()), 13)
        self.scores_are_drawn(self.folder / "scores/scores.html")

    def visit(self, page: Path, source: str, key: dict) -> dict:
        # No participant reads a method's name, in no part of the file.
        readable = re.sub(r'"data:image/png;base64,[^"]*"', "", source)
        common = (ROOT / "resolver/report/web/common.js").read_text()  # in every page alike
        self.assertIn(common, readable)
        readable = readable.replace(common, "")
        for method in METHODS + ("ground truth",):
            self.assertNotIn(method, readable)
        by_code = []
        for who in range(PARTICIPANTS):
            mine = {}
            for q in key["questions"]:
                code = {p["method"]: p["code"] for p in q["pictures"]}
                wish = dict(wishes(who)[q["id"]])
                if "values" in wish:
                    wish["values"] = {code[m]: v for m, v in wish["values"].items()}
                else:
                    wish["better"] = code[wish["better"]]
                mine[",".join(code.values())] = wish
            by_code.append(mine)
        visited = self.folder / "visited.html"
        visited.write_text(source + VISITOR.replace("WISHES", json.dumps(by_code)))
        drawn = self.open(visited, ALL_TIMERS, timeout=170)
        return self.collected(drawn)

    def blinding_can_be_undone(self, key: dict, answers: list[dict]) -> None:
        for a in answers:
            random = pcg32(a["seed"])
            next(random)

            def shuffled(items: list) -> list:
                items = list(items)
                for i in range(len(items) - 1, 0, -1):
                    k = next(random) * (i + 1) // 2**32
                    items[i], items[k] = items[k], items[i]
                return items

            shown = {
                q["id"]: shuffled(sorted(p["code"] for p in q["pictures"]))
                for q in key["questions"]
            }
            stills = shuffled([q["id"] for q in key["questions"] if len(q["frames"]) == 1])
            played = shuffled([q["id"] for q in key["questions"] if len(q["frames"]) > 1])
            self.assertEqual([x["question"] for x in a["answers"]], stills + played)
            for x in a["answers"]:
                self.assertEqual(x["shown"], shown[x["question"]])
        orders = {json.dumps([x["shown"] for x in a["answers"]]) for a in answers}
        self.assertGreater(len(orders), PARTICIPANTS // 2)  # each their own

    def scores_are(self, scores: dict) -> None:
        self.assertEqual(scores["participants"], PARTICIPANTS)
        self.assertTrue(any("few: 7 participants" in note for note in scores["notes"]))
        sets = {tuple(s["questions"]): s for s in scores["sets"]}
        value = lambda ids: {p["method"]: p["score"]["value"] for p in sets[ids]["pictures"]}
        # Five of seven have fxaa311 first: (5 * 1 + 2 * 2) / 7.
        self.assert_near(
            value(("q1",)),
            {"fxaa311": 9 / 7, "taaSimplest": 12 / 7, "uncharted": 3, "noaa": 4},
        )
        self.assertEqual(sets[("q1",)]["pictures"][0]["counts"], [5, 2, 0, 0])
        # W = 12 S / (m^2 (n^3 - n)); rank sums 9, 12, 21, 28 about 17.5: S = 225.
        self.assertAlmostEqual(sets[("q1",)]["kendallW"], 12 * 225 / (49 * 60))
        pairs = sets[("q2", "q3", "q4")]
        self.assertEqual(
            {p["method"]: (p["won"], p["asked"]) for p in pairs["pictures"]},
            {"smaa1x": (13, 14), "fxaa311": (8, 14), "noaa": (0, 14)},
        )
        self.assertEqual([p["method"] for p in pairs["pictures"]], ["smaa1x", "fxaa311", "noaa"])
        self.assertAlmostEqual(sum(p["score"]["value"] for p in pairs["pictures"]), 0)
        # Four of seven give 5, three give 4.
        self.assert_near(value(("q5",)), {"smaa1x": 32 / 7, "noaa": 2})
        self.assert_near(value(("q6",)), {"truth": 1, "noaa": 2, "taaSimplest": 3})
        self.assertEqual(len(sets[("q6",)]["frames"]), 4)
        # Rank correlation of q1 by hand, from the figures that the key holds.
        q1 = sets[("q1",)]
        psnr = [p["shown"]["psnr"] for p in q1["pictures"]]  # best first
        pairs_of = [(a, b) for a in range(4) for b in range(a + 1, 4)]
        tau = sum(1 if psnr[a] > psnr[b] else -1 for a, b in pairs_of) / 6
        found = next(a for a in q1["agreement"] if a["figure"] == "psnr" and a["of"] == "shown")
        self.assertAlmostEqual(found["kendallTau"]["value"], tau)
        self.assertIsNotNone(found["kendallTau"]["low95"])
        self.assertTrue(any(a["figure"] == "flip" for a in scores["agreement"]))

    def assert_near(self, found: dict[str, float], expected: dict[str, float]) -> None:
        self.assertEqual(list(found), list(expected))  # best first
        for method, value in expected.items():
            self.assertAlmostEqual(found[method], value, msg=method)

    def scores_are_drawn(self, page: Path) -> None:
        drawn = self.open(page, ALL_TIMERS, timeout=170)
        self.assertEqual(len(re.findall(r'<canvas [^>]*style="[^"]*(?:width|height)', drawn)), 8)
        pictures = re.findall(r'<img src="data:image/png;base64,[^"]+" alt="([^"]+)"', drawn)
        self.assertEqual(len(pictures), 12)
        self.assertIn("fxaa311 is best, 1.29", drawn)
        self.assertIn("Kendall's W 0.92", drawn)
        self.assertIn("8 of 14; by Wilson ", drawn)  # beside the bootstrap's under the score


main()
