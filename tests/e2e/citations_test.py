"""What a file cites can be opened: keys of docs/sources.md, numbers of conventions.md and decisions.md."""

from __future__ import annotations

import bisect
import os
import re
import tempfile
import unittest
from pathlib import Path

from program import ROOT, main

SUFFIXES = {
    "",
    *".h .hpp .cpp .glsl .comp .py .js .html .css .json .toml .md .txt .sh .cmake".split(),
}
# Documents that lie beside the repository and not in it.
ELSEWHERE = re.compile(
    r"methods/[01]\d\b|\b[Ss]eeds? 00\d|\bseeds[/]\d|/work[/]shared|\b(?:DESIGN|STYLE|kernels|blender-facts|review)[.]md"
)
# [Karis 2014], [Oliveros 2018, eq 3.1], [Stejmar n.d.]; no link of Markdown.
KEY = re.compile(
    r"\[([A-Z][^\[\]\",;(){}=]{0,40} (?:(?:19|20)\d\d[a-z]?|n\.d\.))(?:, [^\[\]]*)?\](?!\()"
)
NUMBER = r"\d+(?:\.\d+)?"
OURS = re.compile(rf"\b(conventions|decisions) ({NUMBER}(?:(?:, | and | to ){NUMBER}\b(?![.\w]))*)")
# A sentence goes on over line breaks, comment marks and the two halves of a broken string.
BREAK = re.compile(r"\"[ ]*\n\s*\"|\s*\n[ \t]*(?://+|#+|\*|>)?[ \t]*")


def files(root: Path) -> list[Path]:
    found = []
    for folder, inner, names in os.walk(root):
        skipped = (".", "build", "node_modules", "__pycache__")
        inner[:] = sorted(i for i in inner if not i.startswith(skipped))
        found += [Path(folder, n) for n in sorted(names) if Path(n).suffix in SUFFIXES]
    return found


def flattened(text: str) -> tuple[str, list[int]]:
    """The text on one line, and where in it each line of the file begins."""
    parts, starts, at, length = [], [0], 0, 0
    for m in BREAK.finditer(text):
        between = "" if m[0].startswith('"') else " "
        parts += [text[at : m.start()], between]
        length += m.start() - at + len(between)
        starts += [length] * m[0].count("\n")
        at = m.end()
    return "".join(parts) + text[at:], starts


def headings(page: Path, pattern: str) -> list[str]:
    return re.findall(pattern, page.read_text(encoding="utf-8"), re.MULTILINE)


def problems(root: Path) -> list[str]:
    keys = headings(root / "docs/sources.md", r"^- \*\*\[([^\]]+)\]\*\*")
    numbers = {
        "conventions": headings(root / "docs/conventions.md", r"^##+ (\d+(?:\.\d+)?) "),
        "decisions": headings(root / "docs/decisions.md", r"^##+ (\d+) "),
    }
    found = [
        f"docs/sources.md: [{k}] is defined twice"
        for k in sorted({k for k in keys if keys.count(k) > 1})
    ]
    for path in files(root):
        if path.name == Path(__file__).name:  # holds examples of what is wrong
            continue
        try:
            text = path.read_text(encoding="utf-8")
        except UnicodeDecodeError:
            continue
        flat, starts = flattened(text)

        def report(m: re.Match, what: str) -> None:
            line = bisect.bisect_right(starts, m.start())
            found.append(f"{path.relative_to(root)}:{line}: {what}")

        for m in ELSEWHERE.finditer(flat):
            report(m, f"cites '{m[0]}', which is not in the repository")
        for m in KEY.finditer(flat):
            if m[1] not in keys:
                report(m, f"cites [{m[1]}], which docs/sources.md does not define")
        for m in OURS.finditer(flat):
            cited = re.findall(NUMBER, m[2])
            for first, last in re.findall(r"(\d+) to (\d+)\b(?!\.)", m[2]):
                cited += map(str, range(int(first), int(last) + 1))
            for n in dict.fromkeys(cited):
                if n not in numbers[m[1]]:
                    report(m, f"cites {m[1]} {n}, which docs/{m[1]}.md does not have")
    return found


class Citations(unittest.TestCase):
    def test_every_citation_can_be_opened(self) -> None:
        found = problems(ROOT)
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_what_cannot_be_opened_is_found(self) -> None:
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            (root / "docs").mkdir()
            (root / "docs/sources.md").write_text("- **[Good 2001]** A: *B*.\n")
            (root / "docs/conventions.md").write_text("## 7 Blocks\n\n### 7.1 Reads\n")
            (root / "docs/decisions.md").write_text("### 5 Weights\n\n### 6 Boxes\n")
            (root / "fine.h").write_text(
                "// [Good 2001, eq 3.1], conventions 7 and 7.1; decisions 5 to 6, as decisions\n// 5.\n"
            )
            self.assertEqual(problems(root), [])
            wrong = (
                'f("[Bad 2002, 4.1]");', "// [Bad\n// 2002]", '"[Good "\n    "2003]"', "// conventions 8",
                "// conventions 7.2", "// decisions 5, 7", "// decisions 4 to 6", "// methods/06 B0", "// seed 001",
            )  # fmt: skip
            for text in wrong:
                (root / "wrong.cpp").write_text("int x;\n" + text + "\n")
                found = problems(root)
                self.assertEqual(len(found), 1, (text, found))
                self.assertTrue(found[0].startswith("wrong.cpp:2: "), found[0])


main()
