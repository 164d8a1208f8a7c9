"""What a new method or metric needs in other files than its own. Each message names the file to touch.

What lies in the method's own file: tests/property/checklist_test.cpp. CONTRIBUTING.md walks through both.
"""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path

from program import ROOT, ProgramTest, main

METHODS = "resolver/methods"
# In a header: a function that makes a descriptor. It is in a registry, or an example that tests alone run.
DESCRIPTOR = re.compile(r"^MethodDescriptor (\w+Descriptor)\(\);", re.MULTILINE)
METRIC = re.compile(r"^Metric (\w+Metric)\(\);", re.MULTILINE)
EXAMPLE = "skeleton.h"
# An enum read by the position of its text: whoever reorders either changes what the other means.
CAST = re.compile(r"\b([A-Z]\w+)\(\w+(?:\.|->)choiceIndex\(")


def unregistered(root: Path, folder: str, declared: re.Pattern[str]) -> list[str]:
    """Descriptors under `folder` that its registry.cpp does not hold."""
    registry = (root / folder / "registry.cpp").read_text()
    return [
        f"{folder}/registry.cpp: {name}() of {header.relative_to(root)} is missing; add its line and its #include"
        for header in sorted((root / folder).rglob("*.h"))
        if header.name != EXAMPLE
        for name in declared.findall(header.read_text())
        if f"{name}()," not in registry
    ]


def lone_kernels(root: Path) -> list[str]:
    """Kernel text that no other file calls for: a header that was forgotten or misnamed."""
    sources = {p: p.read_text() for p in (root / METHODS).rglob("*") if p.suffix in {".h", ".cpp"}}
    found = []
    for path in sorted(p for p in sources if p.name.endswith(".kernel.cpp")):
        for table in re.findall(r"AA_DEFINE_TABLE\([\w:]+, (\w+)\)", sources[path]):
            if not any(f"{table}For(" in text for other, text in sources.items() if other != path):
                found.append(
                    f"{path.relative_to(root)}: nothing calls {table}For(exec); run it in resolve()"
                )
    return found


def casts(root: Path) -> list[str]:
    return [
        f"{path.relative_to(root)}: {enum}(...choiceIndex(...)); declare one table of Choice<{enum}> and read it with "
        f"chosen() ({METHODS}/params.h)"
        for path in sorted((root / METHODS).rglob("*.cpp"))
        for enum in CAST.findall(path.read_text())
    ]


def without_test(root: Path) -> list[str]:
    """Methods whose folder holds no test that names them."""
    found = []
    for header in sorted((root / METHODS).rglob("*.h")):
        if not DESCRIPTOR.search(header.read_text()):
            continue
        include = f'#include "{header.relative_to(root / "resolver")}"'
        ids = re.findall(r'\.id = "(\w+)"', header.with_suffix(".cpp").read_text())
        tests = [p.read_text() for p in (root / METHODS).rglob("*_test.cpp")]
        if not any(include in t or any(f'"{i}' in t for i in ids) for t in tests):
            test = header.with_name(header.stem + "_test.cpp").relative_to(root)
            found.append(
                f"{test}: missing; the property tests know no method's definition, so test it there"
            )
    return found


def stale_docs(root: Path, markdown: str, listed: dict) -> list[str]:
    """Generated pages that are not what the program says now."""
    found = []
    page = (root / "docs/methods.md").read_text()
    for method in listed["methods"]:
        if f"`{method['id']}`" not in page:
            found.append(f"docs/methods.md: lacks '{method['id']}'; run `make docs`")
    if not found and page != markdown:
        found.append(
            "docs/methods.md: is not what `aaresolve list --markdown` prints; run `make docs`"
        )
    if json.loads((root / "blender_addon/aa_resolve/methods.json").read_text()) != listed:
        found.append(
            "blender_addon/aa_resolve/methods.json: is not what `aaresolve list --json` prints; run `make docs`"
        )
    precision = (root / "docs/precision.md").read_text()
    for method in listed["methods"]:
        if method["family"] == "temporal" and f"`{method['id']}`" not in precision:
            found.append(f"docs/precision.md: lacks '{method['id']}'; run `make docs`")
    stability = (root / "docs/results/stability.md").read_text()
    for method in listed["methods"]:
        if f"| `{method['id']}` |" not in stability:
            found.append(f"docs/results/stability.md: lacks '{method['id']}'; run `make docs`")
    bits = json.loads((root / "tests/e2e/same_bits.json").read_text())
    for method in listed["methods"]:
        if not any(method["id"] in shot for shot in bits.values()):
            found.append(f"tests/e2e/same_bits.json: lacks '{method['id']}'; run `make bits`")
    return found


def stale_metrics(root: Path, table: str, displays: str) -> list[str]:
    """The page of metrics holds the program's table, and every display that the help lists."""
    page = (root / "docs/metrics.md").read_text()
    found = []
    if table not in page:
        found.append("docs/metrics.md: its table is not the program's; run `make docs`")
    for name, title in re.findall(r"^ +((?:standard|sdr)_\w+)  +(\S.*)$", displays, re.MULTILINE):
        if f"| `{name}` | {title} |" not in page:
            found.append(f"docs/metrics.md: lacks the display '{name}' as {title}")
    return found


class Checklist(ProgramTest):
    def listed(self) -> tuple[str, dict]:
        return (
            self.aaresolve("list", "--markdown").stdout,
            json.loads(self.aaresolve("list", "--json").stdout),
        )

    def metrics(self) -> tuple[str, str]:
        return (
            self.aaresolve("list", "--metrics", "--markdown").stdout,
            self.aaresolve("compare", "--help").stdout,
        )

    def none(self, found: list[str]) -> None:
        self.assertEqual(found, [], "\n" + "\n".join(found))

    def test_every_method_and_metric_is_registered(self) -> None:
        self.none(unregistered(ROOT, METHODS, DESCRIPTOR))
        self.none(unregistered(ROOT, "resolver/metrics", METRIC))

    def test_every_kernel_is_called(self) -> None:
        self.none(lone_kernels(ROOT))

    def test_enums_are_read_by_their_texts(self) -> None:
        self.none(casts(ROOT))

    def test_every_method_has_a_test(self) -> None:
        self.none(without_test(ROOT))

    def test_generated_pages_are_fresh(self) -> None:
        self.none(stale_docs(ROOT, *self.listed()))
        self.none(stale_metrics(ROOT, *self.metrics()))

    def test_the_program_does_not_show_the_examples(self) -> None:
        self.assertNotIn("keleton", self.aaresolve("list").stdout)
        self.refused(2, "list", "spatialSkeleton", says=("spatialSkeleton",))

    def test_what_was_forgotten_is_found(self) -> None:
        """Each rule is able to fail, and its message names the file."""
        root = self.folder / "tree"
        for folder in ("resolver", "docs", "blender_addon", "tests"):
            shutil.copytree(ROOT / folder, root / folder)
        header = root / METHODS / "spatial/newest.h"
        header.write_text("MethodDescriptor newestDescriptor();\n")
        source = root / METHODS / "spatial/newest.cpp"
        source.write_text('{.id = "newest"}\nBox(p.choiceIndex("box"));\n')
        kernel = root / METHODS / "spatial/newest.kernel.cpp"
        kernel.write_text("AA_DEFINE_TABLE(aa::NewestKernels, newestKernels) = {};\n")
        (root / "resolver/metrics/mae.h").write_text("Metric maeMetric();\n")
        markdown, listed = self.listed()
        newest = {"id": "newest", "family": "temporal"}
        for found, file, says in (
            (
                unregistered(root, METHODS, DESCRIPTOR),
                f"{METHODS}/registry.cpp",
                "spatial/newest.h",
            ),
            (
                unregistered(root, "resolver/metrics", METRIC),
                "resolver/metrics/registry.cpp",
                "maeMetric()",
            ),
            (lone_kernels(root), f"{METHODS}/spatial/newest.kernel.cpp", "newestKernelsFor"),
            (casts(root), f"{METHODS}/spatial/newest.cpp", "Choice<Box>"),
            (without_test(root), f"{METHODS}/spatial/newest_test.cpp", "missing"),
            (
                stale_docs(root, markdown, {**listed, "methods": [*listed["methods"], newest]}),
                "docs/methods.md",
                "`make docs`",
            ),
            (stale_metrics(root, "| `newest` |", ""), "docs/metrics.md", "`make docs`"),
            (stale_metrics(root, "", "  sdr_newest  a screen"), "docs/metrics.md", "sdr_newest"),
        ):
            with self.subTest(file=file):
                self.assertTrue(found, "nothing found")
                self.assertTrue(found[0].startswith(file + ": "), found[0])
                self.assertIn(says, found[0])


main()
