# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on as a user gets it: installed from its zip, exporting by its operators, and gone without a trace."""

from __future__ import annotations

import glob
import hashlib
import json
import os
import subprocess
import sys
import types
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
    assert "the .blend file has changed" in str(error), error
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
    assert "--period was 16 and now is 8" in str(error), error
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


def digest(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


def test_manifests_agree() -> None:
    """blender_manifest.toml (4.2 and later) keeps the rules of extensions and says what bl_info says."""
    import tomllib

    import aa_resolve

    folder = os.path.join(t.ROOT, "blender_addon", "aa_resolve")
    with open(os.path.join(folder, "blender_manifest.toml"), "rb") as file:
        manifest = tomllib.load(file)
    for name in ("schema_version", "id", "version", "name", "tagline", "maintainer", "type"):
        assert isinstance(manifest[name], str) and manifest[name], name
    assert manifest["schema_version"] == "1.0.0" and manifest["type"] == "add-on"
    assert manifest["id"] == os.path.basename(folder) and manifest["id"].isidentifier()
    assert len(manifest["tagline"]) <= 64 and manifest["tagline"][-1].isalnum()
    assert tuple(map(int, manifest["version"].split("."))) == aa_resolve.bl_info["version"]
    assert tuple(map(int, manifest["blender_version_min"].split("."))) >= (4, 2, 0)
    assert all(text.startswith("SPDX:") for text in manifest["license"])
    assert set(manifest["tags"]) <= {
        "Animation",
        "Import-Export",
        "Render",
    }  # of Blender's own list
    for permission, reason in manifest["permissions"].items():
        assert permission in ("files", "network", "clipboard", "camera", "microphone")
        assert len(reason) <= 64 and reason[-1].isalnum(), reason
    assert aa_resolve.bl_info["blender"] == (3, 4, 0)


def test_only_compat_knows_versions() -> None:
    """Names that differ between Blender versions are asked for in one file."""
    folder = os.path.join(t.ROOT, "blender_addon", "aa_resolve")
    paths = sorted(glob.glob(os.path.join(folder, "**", "*.py"), recursive=True))
    assert len(paths) > 30, paths
    for path in paths:
        name = os.path.relpath(path, folder)
        if name != "compat.py":
            with open(path, encoding="utf-8") as file:
                text = file.read()
            assert "app.version " not in text and "app.version[" not in text, name
            assert "hasattr(" not in text, f"{name}: ask compat.py"
            for moved in ('"OPEN_EXR_MULTILAYER"', ".cycles.displacement_method"):
                assert moved not in text, f"{name}: ask compat.py"


def test_settings_of_later_versions() -> None:
    """What moved since 3.4, on stand-ins that refuse as those versions do (none of them is installed here)."""
    from aa_resolve import compat

    class ImageSettings50:
        """A format that does not belong to the media type cannot be chosen."""

        media_type, use_exr_interleave, _format = "IMAGE", False, "PNG"

        @property
        def file_format(self) -> str:
            return self._format

        @file_format.setter
        def file_format(self, name: str) -> None:
            if (name == "OPEN_EXR_MULTILAYER") != (self.media_type == "MULTI_LAYER_IMAGE"):
                raise TypeError(f"enum {name} not found")
            self._format = name

    settings = ImageSettings50()
    compat.set_multilayer_exr(settings)
    assert settings.file_format == "OPEN_EXR_MULTILAYER" and settings.use_exr_interleave
    old = bpy.context.scene.render.image_settings
    compat.set_multilayer_exr(old)
    assert old.file_format == "OPEN_EXR_MULTILAYER"

    new = types.SimpleNamespace(displacement_method="BOTH", cycles=types.SimpleNamespace())
    assert compat.displacement_method(new) == "BOTH"  # 4.1
    material = bpy.data.materials.new("Displaced")
    material.cycles.displacement_method = "DISPLACEMENT"
    assert compat.displacement_method(material) == "DISPLACEMENT"


def test_the_panel_says_what_it_shows() -> None:
    """The command line of the panel's job, parsed, holds the values of the properties, and what has no effect is unsaid."""
    import aa_resolve
    from aa_resolve.command_line import build_parser, settings_from

    aa_resolve.register()
    scene = bpy.context.scene
    shown = scene.aa_resolve

    def said() -> object:
        return settings_from(build_parser().parse_args(shown.options("/out")), scene)

    plain = said()
    assert (plain.out, plain.frames[-1], plain.truth_frames) == ("/out", 16, [1, 8, 16])
    assert (plain.samples, plain.truth_samples, plain.pattern) == (1, 256, "d3d8")
    assert plain.resolution is None and plain.ambient is None and not plain.overwrite
    shown.first, shown.last, shown.truth = 3, 5, "ALL"
    shown.use_resolution, shown.resolution = True, (64, 40)
    shown.samples, shown.truth_samples, shown.period, shown.jitter = 2, 7, 5, "r2"
    shown.use_ambient, shown.ambient, shown.color_type = True, (0.25, 0.5, 0.125), "half"
    shown.pattern, shown.overwrite, shown.method_rsaa = "d3d4", True, True
    full = said()
    assert (
        full.frames == [3, 4, 5] and full.truth_frames == [3, 4, 5] and full.resolution == (64, 40)
    )
    assert (full.samples, full.truth_samples, full.period, full.jitter) == (2, 7, 5, "r2")
    assert (full.ambient, full.color_type) == ((0.25, 0.5, 0.125), "half")
    assert (full.pattern, full.overwrite) == ("d3d4", True)
    assert set(full.methods) == {"noaa", "rsaa", "taaSimplest"}
    shown.lighting, shown.method_rsaa, shown.method_taaSimplest = "as-is", False, False
    words = shown.options("/out")
    for flag in ("--ambient", "--subsamples", "--jitter", "--period"):
        assert flag not in words, words
    assert "--color-type" in words and said().lighting == "as-is"
    aa_resolve.unregister()


def test_installed_from_zip() -> None:
    scene = t.new_scene(32, 18)
    t.add_camera(scene)
    t.add_sun(scene)
    scene.cycles.samples = 77
    t.key(t.add_object(scene, "Cube"), "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    blend = t.save(scene, os.path.join(FOLDER, "scene.blend"))
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
    script = os.path.join(FOLDER, "panel.py")
    with open(script, "w", encoding="utf-8") as file:
        file.write(SCRIPT.format(folder=FOLDER))
    environment = {**os.environ, "BLENDER_USER_SCRIPTS": os.path.join(FOLDER, "scripts")}
    os.makedirs(os.path.join(FOLDER, "scripts", "addons"))
    done = subprocess.run(
        [bpy.app.binary_path, "-b", "--factory-startup", blend, "--python-exit-code", "9", "-P", script],
        capture_output=True, text=True, timeout=150, env=environment,
    )  # fmt: skip
    assert done.returncode == 0 and "PANEL OK" in done.stdout, (
        done.stdout[-3000:] + done.stderr[-3000:]
    )


def test_job_reports_and_cancels() -> None:
    """What the modal operator relies on: progress comes in without blocking, cancel leaves finished frames."""
    from aa_resolve.panel import job

    scene = t.new_scene(32, 18)
    t.add_camera(scene)
    t.add_sun(scene)
    t.key(t.add_object(scene, "Cube"), "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    t.save(scene, os.path.join(FOLDER, "job.blend"))
    before = digest(os.path.join(FOLDER, "job.blend"))
    out = os.path.join(FOLDER, "job_shot")
    folder, blend = job.copy_of_open_file()
    assert bpy.data.filepath == os.path.join(
        FOLDER, "job.blend"
    ), "the copy does not become the open file"
    command = job.export_command(
        blend, ["--out", out, "--frames", "1-400", "--truth-frames", "none"]
    )
    work = job.Job([job.Step("Export", command)], folder)
    work.start()
    while work.poll() and work.done < 3:
        pass
    assert 0.0 < work.fraction < 0.5 and not work.error, (work.fraction, work.error)
    work.cancel()
    assert not os.path.exists(folder), "the copy is gone"
    assert digest(os.path.join(FOLDER, "job.blend")) == before, "the user's file is as it was"
    with open(os.path.join(out, "shot.json"), encoding="utf-8") as file:
        shot = json.load(file)
    assert len(shot["frames"]) >= 3
    for entry in shot["frames"]:
        t.read_part(os.path.join(out, entry["file"]), "color")
    failing = job.Job(
        [job.Step("Export", job.export_command("/nowhere.blend", ["--out", out]))], FOLDER + "/none"
    )
    failing.start()
    while failing.poll():
        pass
    assert failing.error, "a failing child is an error with a sentence"


if __name__ == "__main__":
    t.main(
        test_manifests_agree,
        test_only_compat_knows_versions,
        test_settings_of_later_versions,
        test_the_panel_says_what_it_shows,
        test_installed_from_zip,
        test_job_reports_and_cancels,
    )
