# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way out of the command line says one line on standard error: faults of ours, of the system, of the scene; what
the scene lacks; and a linked file that has changed."""

from __future__ import annotations

import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy  # noqa: E402

FOLDER = t.temporary_folder()
SHORT = ("--frames", "1", "--truth-frames", "none")


def make_blend(name: str) -> str:
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    t.add_sun(scene)
    t.add_object(scene, "Cube", None, (0, 0, 0.5))
    return t.save(scene, os.path.join(FOLDER, name))


def run_spoiled(spoiling: str, **environment: str) -> tuple[int, list[str]]:
    """Exit code and what our program says on stderr, in a process where a function has been replaced."""
    blend = make_blend("spoiled.blend")
    script = os.path.join(FOLDER, "spoiled.py")
    out = os.path.join(t.temporary_folder(), "s")
    with open(script, "w", encoding="utf-8") as file:
        file.write(
            "import sys, os, errno\n"
            f"sys.path.insert(0, {os.path.join(t.ROOT, 'blender_addon')!r})\n"
            "from aa_resolve import headless, exr, export\n"
            f"{spoiling}\n"
            f"code = headless.run(['--out', {out!r}, *{SHORT!r}])\n"
            "print('END', file=sys.stderr, flush=True)\n"
            "sys.exit(code)\n"
        )
    done = subprocess.run(
        [bpy.app.binary_path, "-b", "--factory-startup", blend, "--python-exit-code", "9", "-P", script],
        capture_output=True, text=True, timeout=120, env={**os.environ, **environment},
    )  # fmt: skip
    lines = done.stderr.splitlines()
    first = next((i for i, line in enumerate(lines) if line.startswith("error: ")), None)
    assert first is not None and "END" in lines, done.stderr
    return done.returncode, lines[first : lines.index("END")]


FAULT = "def broken(*_): raise ValueError('two\\nlines')\nheadless.Exporter.run = broken"


def test_a_fault_of_ours_is_one_line() -> None:
    code, lines = run_spoiled(FAULT)
    assert code == 9 and len(lines) == 1, (code, lines)
    for word in ("a fault of AA Resolve", "ValueError", "headless.py:", "two lines", "TRACEBACK"):
        assert word in lines[0], lines


def test_a_traceback_on_demand() -> None:
    code, lines = run_spoiled(FAULT, AA_RESOLVE_TRACEBACK="1")
    assert code == 9 and lines[1].startswith("Traceback") and len(lines) > 3, lines


def test_the_systems_faults() -> None:
    for number, word in (("ENOSPC", "No space left"), ("EACCES", "Permission denied")):
        code, lines = run_spoiled(
            f"def broken(path, parts): raise OSError(errno.{number}, os.strerror(errno.{number}), path)\n"
            "exr.write_parts = broken"
        )
        assert code == 3 and len(lines) == 1, (code, lines)
        assert word in lines[0] and "000001" in lines[0], lines
    code, lines = run_spoiled("def broken(*_): raise MemoryError()\nexr.write_parts = broken")
    assert code == 3 and lines[0].startswith("error: out of memory"), lines
    code, lines = run_spoiled("def broken(*_): raise KeyboardInterrupt()\nexr.write_parts = broken")
    assert code == 1 and lines[0].startswith("error: stopped"), lines


def linking_blend(library: str) -> str:
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    t.add_sun(scene)
    with bpy.data.libraries.load(library, link=True) as (_, wanted):
        wanted.objects = ["Cube"]
    scene.collection.objects.link(wanted.objects[0])
    picture = bpy.data.images.new("Picture", 4, 4)
    picture.filepath_raw = os.path.join(FOLDER, "picture.png")
    picture.file_format = "PNG"
    picture.save()
    material = t.diffuse("Painted", (1, 1, 1))
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(os.path.join(FOLDER, "picture.png"))
    plane = t.add_object(scene, "Plane", None, (1, 0, 0))
    plane.data.materials.append(material)
    return t.save(scene, os.path.join(FOLDER, "linking.blend"))


def test_linked_files_that_change_or_are_missing() -> None:
    library = make_blend("library.blend")
    blend = linking_blend(library)
    out = os.path.join(FOLDER, "linked")
    first = t.run_headless(blend, "--out", out, *SHORT)
    assert first.returncode == 0 and "missing" not in first.stdout, first.stdout + first.stderr
    again = t.run_headless(blend, "--out", out, *SHORT)
    assert again.returncode == 0 and "finished before" in again.stdout, again.stderr
    scene = t.new_scene(16, 9)
    t.add_object(scene, "Cube", None, (0, 0, 1.5))
    t.save(scene, library)
    changed = t.run_headless(blend, "--out", out, *SHORT)
    assert changed.returncode == 2 and "a file that the scene uses" in changed.stderr, (
        changed.returncode,
        changed.stderr,
    )
    os.unlink(library)
    os.unlink(os.path.join(FOLDER, "picture.png"))
    lacking = t.run_headless(blend, "--out", os.path.join(FOLDER, "lacking"), *SHORT)
    assert lacking.returncode == 0, lacking.stderr
    assert "library.blend' is missing" in lacking.stdout, lacking.stdout
    assert "'picture.png' is missing" in lacking.stdout, lacking.stdout


if __name__ == "__main__":
    t.main(
        test_a_fault_of_ours_is_one_line,
        test_a_traceback_on_demand,
        test_the_systems_faults,
        test_linked_files_that_change_or_are_missing,
    )
