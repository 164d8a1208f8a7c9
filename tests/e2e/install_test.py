"""`cmake --install` into a temporary prefix, and the installed program at work; one version number for everything."""

from __future__ import annotations

import ast
import json
import os
import re
import subprocess
import zipfile
from pathlib import Path

from program import PROGRAM, ROOT, ProgramTest, main

BUILD = Path(os.environ.get("AA_BUILD", PROGRAM.parent))


def version_of(root: Path) -> str:
    """The number that all others must be."""
    project = re.search(
        r"^project\(\w+ VERSION ([\d.]+) ", (root / "CMakeLists.txt").read_text(), re.M
    )
    assert project, "CMakeLists.txt: no project(... VERSION ...)"
    return project[1]


def versions(root: Path) -> dict[str, str]:
    """File: the number that stands in it."""
    addon = root / "blender_addon/aa_resolve"
    info = next(
        ast.literal_eval(node.value)
        for node in ast.parse((addon / "__init__.py").read_text()).body
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "bl_info"
    )
    manifest = re.search(r'^version = "(.*)"', (addon / "blender_manifest.toml").read_text(), re.M)
    newest = re.search(r"^## (\S+)", (root / "CHANGELOG.md").read_text(), re.M)
    return {
        "blender_addon/aa_resolve/__init__.py (bl_info)": ".".join(map(str, info["version"])),
        "blender_addon/aa_resolve/blender_manifest.toml": manifest[1] if manifest else "none",
        "blender_addon/aa_resolve/methods.json (`make docs`)": json.loads(
            (addon / "methods.json").read_text()
        )["version"],
        "CHANGELOG.md (its newest heading)": newest[1] if newest else "none",
    }


class Install(ProgramTest):
    def test_one_version_number(self) -> None:
        wanted = version_of(ROOT)
        wrong = [
            f"{file}: {number}, but CMakeLists.txt: {wanted}"
            for file, number in versions(ROOT).items()
            if number != wanted
        ]
        self.assertEqual(wrong, [], "\n" + "\n".join(wrong))
        self.assertEqual(self.aaresolve("--version").stdout.strip(), wanted)

    def test_the_installed_program_runs(self) -> None:
        prefix = self.folder / "prefix"
        subprocess.run(
            ["cmake", "--install", BUILD, "--prefix", prefix], check=True, capture_output=True
        )
        program = prefix / "bin/aaresolve"

        def run(*arguments: object) -> str:
            """From elsewhere and without the source tree's help."""
            return subprocess.run(
                [program, *map(str, arguments)],
                check=True,
                capture_output=True,
                text=True,
                cwd=self.folder,
            ).stdout

        self.assertEqual(run("--version").strip(), version_of(ROOT))
        run("synth", "circles", "-o", "shot", "--size", "32x24", "--frames", "2")
        run("run", "shot", "-m", "noaa", "-m", "fxaa311", "-o", "out", "-q")
        run("report", "out", "-o", "report.html")
        self.assertIn("fxaa311", (self.folder / "report.html").read_text())
        run("sheet", "out", "-o", "sheet.pdf")
        self.assertEqual((self.folder / "sheet.pdf").read_bytes()[:5], b"%PDF-")
        with zipfile.ZipFile(prefix / "share/aaresolve/aa_resolve.zip") as addon:
            self.assertIn("aa_resolve/__init__.py", addon.namelist())
        pages = prefix / "share/doc/aaresolve"
        for file in (
            "man/man1/aaresolve.1", "bash-completion/completions/aaresolve",
            "zsh/site-functions/_aaresolve", "fish/vendor_completions.d/aaresolve.fish",
        ):  # fmt: skip
            self.assertIn("aaresolve", (prefix / "share" / file).read_text(), file)
        for page in (
            "README.md",
            "CHANGELOG.md",
            "LICENSE",
            "docs/methods.md",
            "docs/results/README.md",
        ):
            self.assertTrue((pages / page).exists(), page)


if __name__ == "__main__":
    main()
