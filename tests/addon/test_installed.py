# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on as a user gets it: installed from its zip, exporting by its operators, and gone without a trace."""

from __future__ import annotations

import glob
import hashlib
import os
import subprocess
import sys
import zipfile

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy  # noqa: E402

FOLDER = t.temporary_folder()
SCRIPT = """
import bpy, hashlib, json, os, sys
folder = {folder!r}
def digest(path):
    return hashlib.sha256(open(path, "rb").read()).hexdigest()
before = set(dir(bpy.types))
bpy.ops.preferences.addon_install(filepath=os.path.join(folder, "aa_resolve.zip"))
bpy.ops.preferences.addon_enable(module="aa_resolve")
assert "/scripts/" in sys.modules["aa_resolve"].__file__, sys.modules["aa_resolve"].__file__
blend = bpy.data.filepath
hash_before = digest(blend)
scene = bpy.context.scene
settings = scene.aa_resolve
settings.out = os.path.join(folder, "shot")
settings.first, settings.last = 2, 4
settings.truth_samples = 8
assert settings.chosen() == ["noaa", "taaSimplest"], settings.chosen()
tooltip = settings.bl_rna.properties["method_taaSimplest"].description
assert "motion" in tooltip, tooltip
bpy.data.objects["Cube"].location.z += 0.25
scene.frame_set(3)
assert bpy.ops.aa_resolve.export() == {{"FINISHED"}}
assert scene.frame_current == 3 and scene.render.engine == "CYCLES" and scene.cycles.samples == 77
assert len(bpy.data.objects) == 3, [item.name for item in bpy.data.objects]
assert digest(blend) == hash_before
shot = json.load(open(os.path.join(folder, "shot", "shot.json")))
assert [entry["frame"] for entry in shot["frames"]] == [2, 3, 4]
assert [bool(entry.get("truth")) for entry in shot["frames"]] == [True, True, True]
assert bpy.ops.aa_resolve.estimate() == {{"FINISHED"}}
bpy.data.objects["Cube"].location.z += 0.25
bpy.ops.wm.save_mainfile()
try:
    bpy.ops.aa_resolve.export()
    raise SystemExit("a changed file must not continue an old export")
except RuntimeError as error:
    assert "the .blend file, or a script" in str(error), error
settings.overwrite = True
assert bpy.ops.aa_resolve.export() == {{"FINISHED"}}
settings.overwrite = False
bpy.ops.wm.save_mainfile()
hash_before = digest(blend)
settings.period = 8
try:
    bpy.ops.aa_resolve.export()
    raise SystemExit("a changed setting must be noticed")
except RuntimeError as error:
    assert "'Period' was 16 and now is 8" in str(error), error
for name in settings.chosen():
    setattr(settings, "method_" + name, False)
try:
    bpy.ops.aa_resolve.export()
    raise SystemExit("no method must be noticed")
except RuntimeError as error:
    assert "at least one method" in str(error), error
settings.period, settings.method_noaa = 5, True
bpy.ops.aa_resolve.add_preset(name="Fast")
settings.period, settings.method_noaa = 16, False
preset = [os.path.join(path, "Fast.py") for path in bpy.utils.preset_paths("aa_resolve")]
bpy.ops.script.execute_preset(filepath=preset[0], menu_idname="AA_RESOLVE_MT_presets")
assert settings.period == 5 and settings.method_noaa, "presets come back"
bpy.ops.preferences.addon_disable(module="aa_resolve")
assert not hasattr(bpy.types.Scene, "aa_resolve")
left = [name for name in set(dir(bpy.types)) - before if "resolve" in name.lower()]
assert not left, left
print("PANEL OK")
"""

EXTENSION = """
import bpy, json, os, sys
folder, module = {folder!r}, "bl_ext.user_default.aa_resolve"
assert bpy.ops.extensions.package_install_files(
    filepath=os.path.join(folder, "aa_resolve.zip"), repo="user_default", enable_on_install=True
) == {{"FINISHED"}}
assert "aa_resolve" not in sys.modules, "known by the extension's name alone"
here = sys.modules[module].__file__
assert here.startswith(folder) and "/extensions/user_default/" in here.replace(os.sep, "/"), here
kept = bpy.context.preferences.addons[module].preferences
kept.resolver = os.path.join(folder, "nothing")
assert sys.modules[module + ".panel.preferences"].preferred() == kept.resolver
scene = bpy.context.scene
settings = scene.aa_resolve
settings.out = os.path.join(folder, "shot_of_extension")
settings.first, settings.last, settings.truth = 2, 3, "NONE"
assert bpy.ops.aa_resolve.export() == {{"FINISHED"}}
shot = json.load(open(os.path.join(settings.out, "shot.json")))
assert [entry["frame"] for entry in shot["frames"]] == [2, 3]
try:
    bpy.ops.aa_resolve.compare()
    raise SystemExit("the program that the preferences name is not there")
except RuntimeError as error:
    assert kept.resolver in str(error), error
settings.period = 5
bpy.ops.aa_resolve.add_preset(name="Kept")
settings.period = 16
preset = [os.path.join(path, "Kept.py") for path in bpy.utils.preset_paths("aa_resolve")]
bpy.ops.script.execute_preset(filepath=preset[0], menu_idname="AA_RESOLVE_MT_presets")
assert settings.period == 5, "presets come back"
bpy.ops.wm.save_userpref()
print("EXTENSION OK")
"""
EXTENSION_AGAIN = """
import bpy, os
kept = bpy.context.preferences.addons["bl_ext.user_default.aa_resolve"].preferences
assert kept.resolver == os.path.join({folder!r}, "nothing"), kept.resolver
bpy.ops.preferences.addon_disable(module="bl_ext.user_default.aa_resolve")
assert not hasattr(bpy.types.Scene, "aa_resolve")
print("EXTENSION OK")
"""


def small_scene() -> str:
    """A cube that moves, saved."""
    scene = t.new_scene(32, 18)
    t.add_camera(scene)
    t.add_sun(scene)
    scene.cycles.samples = 77
    t.key(t.add_object(scene, "Cube"), "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    return t.save(scene, os.path.join(FOLDER, "scene.blend"))


def run_script(blend: str, text: str, *flags: str, **environment: str) -> None:
    """In a Blender of its own; its last words are that all is well."""
    script = os.path.join(FOLDER, "panel.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(text.format(folder=FOLDER))
    done = subprocess.run(
        [bpy.app.binary_path, "-b", *flags, blend, "--python-exit-code", "9", "-P", script],
        capture_output=True, text=True, timeout=150, env={**os.environ, **environment},
    )  # fmt: skip
    assert done.returncode == 0 and " OK" in done.stdout, done.stdout[-3000:] + done.stderr[-3000:]


def test_installed_as_an_extension() -> None:
    """From 4.2 on the same zip is an extension: a module of another name, with preferences, presets and an export."""
    if not hasattr(bpy.context.preferences, "extensions"):
        return  # before 4.2
    blend = small_scene()
    packer = os.path.join(t.ROOT, "blender_addon", "make_zip.py")
    archive = os.path.join(FOLDER, "aa_resolve.zip")
    subprocess.run([sys.executable, packer, archive], check=True, capture_output=True)
    places = {
        f"BLENDER_USER_{name}": os.path.join(FOLDER, "user", name.lower())
        for name in ("CONFIG", "SCRIPTS", "EXTENSIONS", "DATAFILES")
    }
    for place in places.values():
        os.makedirs(place)
    run_script(blend, EXTENSION, "--factory-startup", **places)
    run_script(blend, EXTENSION_AGAIN, **places)


def test_installed_from_zip() -> None:
    blend = small_scene()
    packer = os.path.join(t.ROOT, "blender_addon", "make_zip.py")
    archive = os.path.join(FOLDER, "aa_resolve.zip")
    subprocess.run([sys.executable, packer, archive], check=True, capture_output=True)
    sources = glob.glob(
        os.path.join(t.ROOT, "blender_addon", "aa_resolve", "**", "*.py"), recursive=True
    )
    with zipfile.ZipFile(archive) as file:
        packed = [name for name in file.namelist() if name.endswith(".py")]
    assert len(packed) == len(sources) and "aa_resolve/passes/table.py" in packed, packed
    with open(archive, "rb") as file:
        first = hashlib.sha256(file.read()).digest()
    subprocess.run([sys.executable, packer, archive], check=True, capture_output=True)
    with open(archive, "rb") as file:
        assert hashlib.sha256(file.read()).digest() == first, "the zip is the same each time"
    os.makedirs(os.path.join(FOLDER, "scripts", "addons"))
    scripts = os.path.join(FOLDER, "scripts")
    run_script(blend, SCRIPT, "--factory-startup", BLENDER_USER_SCRIPTS=scripts)


if __name__ == "__main__":
    t.main(test_installed_from_zip, test_installed_as_an_extension)
