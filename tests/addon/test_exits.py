# SPDX-License-Identifier: GPL-3.0-or-later
"""Every way out of the command line says one line on standard error: faults of ours, of the system, of the scene; what
the scene lacks; and a linked file that has changed."""

from __future__ import annotations

import os
import subprocess
import sys
import wave

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


def test_files_that_no_render_reads() -> None:
    """A picture that only an editor shows, a sound and what the sequencer plays may change, go, and come to be; a picture
    is missed where a surface shows it."""
    from aa_resolve.scene.linked import identity_of_linked, notes_on_missing

    folder = t.temporary_folder()
    looked, heard, worn = (os.path.join(folder, name) for name in ("a.png", "b.wav", "c.png"))

    def write(path: str, value: int) -> None:
        with open(path, "wb") as file, wave.open(file, "wb") as sound:
            sound.setparams((1, 1, 8000, 0, "NONE", ""))
            sound.writeframes(bytes([value]) * 800)

    scene = t.new_scene(16, 9)
    camera = t.add_camera(scene)
    for path in (looked, heard, worn):
        write(path, 10)
    material = t.diffuse("Painted", (1, 1, 1))
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = bpy.data.images.load(worn)
    plain = identity_of_linked()
    bpy.data.images.load(looked).use_fake_user = True
    assert identity_of_linked() == plain, "a picture that was opened for a look"
    editor = scene.sequence_editor_create()
    strips = (
        editor.strips if hasattr(editor, "strips") else editor.sequences
    )  # the latter before 5.0
    strips.new_image("Shot", looked, 1, 1)
    strips.new_sound("Sound", heard, 2, 1)
    assert identity_of_linked() == plain, "strips of the sequencer"
    for path in (looked, heard):
        write(path, 20)
    assert identity_of_linked() == plain
    camera.data.background_images.new().image = bpy.data.images.load(looked)
    for path in (looked, heard):
        os.unlink(path)
    assert notes_on_missing() == [], "no surface shows it"
    write(worn, 20)
    assert identity_of_linked() != plain, "what a render reads counts"
    os.unlink(worn)
    assert ["c.png" in note for note in notes_on_missing()] == [True]


if __name__ == "__main__":
    t.main(
        test_a_fault_of_ours_is_one_line,
        test_a_traceback_on_demand,
        test_the_systems_faults,
        test_linked_files_that_change_or_are_missing,
        test_files_that_no_render_reads,
    )
