"""The pages: every link leads somewhere, every command in them is one that the programs take, the tour is taken."""

from __future__ import annotations

import functools
import re
import shlex
import subprocess
from pathlib import Path

from program import PROGRAM, ROOT, ProgramTest, main

PAGES = sorted(
    page
    for pattern in ("*.md", "docs/**/*.md", "scenes/*.md", "shaders/*.md")
    for page in ROOT.glob(pattern)
)
LINK = re.compile(r"(?<!\!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)|<img src=\"([^\"]+)\"")
# Behind these words stand methods.
METHODS = ("-m", "--method", "--for", "--with", "--reference", "plan", "filter")
# A word in a command that stands for what the reader has: SHOT, OUT, "...".
PLACEHOLDER = re.compile(r"[A-Z_0-9]*|.*\.\.\..*")


def anchors(page: Path) -> set[str]:
    """As GitHub makes them of headings."""
    found = set()
    for heading in re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.M):
        plain = re.sub(r"[^\w\- ]", "", heading.replace("`", "")).strip().lower()
        found.add(plain.replace(" ", "-"))
    return found


def broken_links(page: Path) -> list[str]:
    text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.S)
    found = []
    for groups in LINK.findall(text):
        target = next(filter(None, groups))
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        to = page.parent / path if path else page
        if not to.exists():
            found.append(f"{page}: {target}: no such file")
        elif anchor and anchor not in anchors(to):
            found.append(f"{page}: {target}: no such heading")
    return found


def commands(text: str) -> list[list[str]]:
    """Command lines of the blocks of a page: indented or fenced, with lines that go on, without comments."""
    blocks, fenced, before = [], False, ""
    for line in text.splitlines():
        if line.startswith("```"):
            fenced = not fenced
        elif fenced or (
            line.startswith("    ") and (not before.strip() or before.startswith("    "))
        ):
            blocks.append(line.strip())
            before = "    "
            continue
        before = line
    joined = re.sub(r"\\\n\s*", " ", "\n".join(blocks))
    found = []
    for line in joined.splitlines():
        try:
            words = shlex.split(line, comments=True)
        except ValueError:  # prose with an apostrophe
            continue
        if words:
            found.append(words)
    return found


class Docs(ProgramTest):
    @functools.cache
    def offered(self, *words: str) -> list[str]:
        said = self.aaresolve("completion", "words", "--", *words).stdout
        return [line.split("\t")[0] for line in said.splitlines()]

    def wrong_in(self, words: list[str]) -> str:
        """What the program does not know of a command line (its name left out); empty: nothing."""
        path: list[str] = []
        while len(path) < len(words) and words[len(path)] in self.offered(*path, ""):
            path.append(words[len(path)])
        if not path and not PLACEHOLDER.fullmatch(words[0]) and not words[0].startswith("-"):
            return f"no command {words[0]}"
        options = self.offered(*path, "-")
        for before, word in zip(["", *words], words):
            if word in ("|", ">", "2>", "&&", ";", "<"):
                break
            if word.startswith("-") and not re.fullmatch(r"-[\d.]+", word):
                if word.split("=")[0] not in options:
                    return f"no option {word}"
            elif before in METHODS:
                # What only a shot can say is left to the shot.
                items = re.sub(r"\brunnable(:\w+)?", "all", word).split(",")
                shown = ",".join(i for i in items if not PLACEHOLDER.fullmatch(i))
                done = subprocess.run([PROGRAM, "plan", shown], capture_output=True, text=True)
                if shown and done.returncode:
                    return done.stderr.strip()
        return ""

    def test_links_lead_somewhere(self) -> None:
        self.assertGreater(len(PAGES), 20)
        found = [fault for page in PAGES for fault in broken_links(page)]
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_every_page_is_in_the_index(self) -> None:
        index = (ROOT / "docs/README.md").read_text()
        for page in ROOT.glob("docs/*.md"):
            if page.name != "README.md":
                self.assertIn(f"({page.name}", index, f"docs/README.md: add {page.name}")

    def test_commands_are_those_of_the_programs(self) -> None:
        makefile = (ROOT / "Makefile").read_text()
        exporter = "\n".join(
            p.read_text() for p in (ROOT / "blender_addon/aa_resolve").rglob("*.py")
        )
        exporter += (ROOT / "scenes/common.py").read_text()
        exporter += "\n".join(p.read_text() for p in (ROOT / "scenes").glob("*.py"))
        seen, faults = 0, []
        for page in PAGES:
            for words in commands(page.read_text(encoding="utf-8")):
                name = words[0].split("/")[-1]
                fault = ""
                if name == "aaresolve":
                    fault, seen = self.wrong_in(words[1:]), seen + 1
                elif name == "make":
                    for target in [w for w in words[1:] if re.fullmatch(r"[a-z][a-z-]*", w)]:
                        if not re.search(rf"^{target}:", makefile, re.M):
                            fault = f"no target {target}"
                elif any(w.endswith("headless.py") for w in words) and "--" in words:
                    for word in words[words.index("--") + 1 :]:
                        if word.startswith("--") and f'"{word.split("=")[0]}"' not in exporter:
                            fault = f"the exporter has no option {word}"
                if fault:
                    faults.append(f"{page.relative_to(ROOT)}: {shlex.join(words)}: {fault}")
        self.assertGreater(seen, 15, "commands are no longer found")
        self.assertEqual(faults, [], "\n" + "\n".join(faults))

    def test_what_is_wrong_is_found(self) -> None:
        self.assertIn("--colour", self.wrong_in(["run", "SHOT", "--colour"]))
        self.assertIn("reprot", self.wrong_in(["reprot"]))
        self.assertIn("fxaa9", self.wrong_in(["run", "SHOT", "-m", "noaa,fxaa9"]))
        self.assertEqual(
            self.wrong_in(["run", "SHOT", "-m", "runnable:spatial,M", "-o", "OUT"]), ""
        )
        page = self.folder / "page.md"
        page.write_text("# One\n[a](page.md#one) [b](page.md#two) [c](gone.md)\n")
        self.assertEqual(
            [fault.split(": ")[1] for fault in broken_links(page)], ["page.md#two", "gone.md"]
        )

    def test_the_tour(self) -> None:
        """The commands of the README, as they stand there."""
        readme = (ROOT / "README.md").read_text()
        tour = readme.split("<!-- tour -->")[1].split("\n\n")[1]
        lines = commands("\n" + tour)
        self.assertGreaterEqual(len(lines), 4)
        for words in lines:
            self.assertEqual(words[0], "aaresolve")
            self.aaresolve(*words[1:], cwd=self.folder)
        for made in re.findall(r"`(tour/run/\S+)`", readme):
            self.assertTrue((self.folder / made).exists(), made)


main()
