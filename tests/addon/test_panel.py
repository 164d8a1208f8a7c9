# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel: what it shows is what the exporter and the resolver are told, and what it says of scene and disk is true."""

from __future__ import annotations

import glob
import json
import math
import os
import sys
import types

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import aa_resolve, bpy  # noqa: E402


def registered() -> object:
    """The settings of a new scene with the add-on switched on."""
    t.new_scene(64, 36)
    if not hasattr(bpy.types.Scene, "aa_resolve"):
        aa_resolve.register()
    return bpy.context.scene.aa_resolve


def test_manifests_agree() -> None:
    """blender_manifest.toml (4.2 and later) keeps the rules of extensions and says what bl_info says."""
    import tomllib

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
    t.set_displacement_method(material, "DISPLACEMENT")
    assert compat.displacement_method(material) == "DISPLACEMENT"


def test_the_panel_says_what_it_shows() -> None:
    """The command line of the panel's job, parsed, holds the values of the properties, and what has no effect is unsaid."""
    from aa_resolve.command_line import build_parser, settings_from

    shown = registered()
    scene = bpy.context.scene

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
    assert (plain.texture_filter, plain.mip_bias, plain.unjitter_textures) == ("none", 0.0, False)
    shown.mip_bias, shown.unjitter_textures = -0.3, True
    words = shown.options("/out")
    assert "--mip-bias" not in words and "--unjitter-textures" not in words, words
    shown.texture_filter, shown.method_taaSimplest = "mip", True
    full = said()
    assert (full.texture_filter, full.mip_bias, full.unjitter_textures) == ("mip", -0.3, True)
    shown.jitter = "none"
    assert not said().unjitter_textures, "without jitter there is none to take back"


def test_the_scenes_range_has_its_steps() -> None:
    """As on the command line; first, middle and last of what is exported get truth. A long range is said shortly."""
    shown = registered()
    scene = bpy.context.scene
    shown.use_scene_range, shown.truth = True, "ENDS"
    for first, last, step, frames, truth in (
        (1, 9, 4, [1, 5, 9], [1, 5, 9]),
        (2, 12, 3, [2, 5, 8, 11], [2, 5, 11]),
        (2, 4, 9, [2], [2]),
        (3, 6, 1, [3, 4, 5, 6], [3, 4, 6]),
    ):
        scene.frame_start, scene.frame_end, scene.frame_step = first, last, step
        full = settings_said(shown.options("/out"))
        assert (full.frames, full.truth_frames) == (frames, truth), (full.frames, full.truth_frames)
    assert shown.options("/out")[3] == "3-6", shown.options("/out")
    scene.frame_step, shown.use_scene_range, shown.first, shown.last = 2, False, 1, 4
    assert settings_said(shown.options("/out")).frames == [1, 2, 3, 4], "a range of the panel's own"


def test_parameters_are_edited_and_said() -> None:
    """Every parameter of every method has a widget with its range and default; changed ones reach the command lines."""
    from aa_resolve import registry
    from aa_resolve.panel import parameters as p

    shown = registered()
    counted = 0
    for name, method in registry.load_methods().items():
        for item in method["parameters"]:
            counted += 1
            group = getattr(shown, p.widgets_property(name))
            kind = group.bl_rna.properties[p.widget_name(item["name"])]
            assert item.get("help", "")[:20] in kind.description, kind.description
            assert max(map(len, kind.description.split("\n"))) < 120, "no line is cut off"
            value = getattr(group, p.widget_name(item["name"]))
            if item["type"] == "flag":
                assert value == (item["default"] == "on"), (name, item)
            elif "choices" in item:
                assert value == item["default"] and len(kind.enum_items) == len(item["choices"])
            else:
                assert abs(value - item["default"]) <= 1e-6 * max(1, abs(value)), (name, item)
                assert abs(kind.hard_min - item["min"]) < 1e-6 and kind.hard_max == item["max"]
    assert counted > 300, counted
    shown.method_smaa1x = shown.method_karis = True
    karis, smaa = shown.widgets_karis, shown.widgets_smaa1x
    karis.set_alpha, karis.set_box, karis.set_unjitter = 0.1, "variance", True
    smaa.set_predication, smaa.set_threshold = "depth", 0.2
    assert shown.parameters_karis == "alpha=0.1,box=variance,unjitter=on", shown.parameters_karis
    said = {text.partition(":")[0]: text for text in shown.method_texts()}
    assert said["karis"] == "karis:" + shown.parameters_karis and said["noaa"] == "noaa", said
    assert said["smaa1x"] == "smaa1x:predication=depth", "a threshold acts with preset=custom only"
    smaa.set_preset = "custom"
    assert "threshold=0.2" in shown.method_texts()[1], shown.method_texts()
    words = shown.options("/out")
    assert words[words.index("--for") + 1] == ",".join(shown.method_texts())
    full = settings_said(words)
    assert "depth" in full.centre_passes, "passes follow the parameters"
    karis.set_alpha = 0.04
    assert shown.parameters_karis == "box=variance,unjitter=on", "a default is not said"
    bpy.ops.aa_resolve.reset_parameters(method="karis", parameter="box")
    assert shown.parameters_karis == "unjitter=on" and karis.set_box == "minmax"
    bpy.ops.aa_resolve.reset_parameters(method="karis", parameter="")
    assert shown.parameters_karis == ""
    shown.parameters_karis = "alpha=0.5,gone=3,box=sphere,gamma=100"
    assert shown.changed_parameters("karis") == {"alpha": "0.5"}, "what the table does not know"
    tiny = {"name": "x", "min": 0.0, "max": 1e9}
    assert [p.number_text(value) for value in (1e-5, 2.5e7, 0.1)] == ["0.00001", "25000000", "0.1"]
    assert registry.is_known_value(tiny, "12") and not registry.is_known_value(tiny, "-1")
    path = os.path.join(t.temporary_folder(), "kept.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    kept = bpy.context.scene.aa_resolve
    assert kept.parameters_karis == "alpha=0.5,gone=3,box=sphere,gamma=100"
    assert kept.widgets_smaa1x.set_preset == "custom" and kept.method_karis


def settings_said(words: list[str]) -> object:
    """The exporter's settings for a command line."""
    from aa_resolve.command_line import build_parser, settings_from

    return settings_from(build_parser().parse_args(words), bpy.context.scene)


def test_starts_and_families() -> None:
    """Each preset that the add-on brings can be exported as it stands; families are chosen as a whole."""
    from aa_resolve import registry
    from aa_resolve.panel import presets
    from aa_resolve.panel.properties import families

    shown = registered()
    scene = bpy.context.scene
    scene.render.resolution_x, scene.render.resolution_y = 1920, 1080
    scene.frame_current = 7
    counts = {}
    for kind, known in presets.BUILT_IN.items():
        assert bpy.ops.aa_resolve.use_preset(kind=kind) == {"FINISHED"}
        assert set(shown.chosen()) == set(known.methods), kind
        assert not shown.method_accum, "the resolver refuses a moving shot to it"
        counts[kind] = len(shown.chosen())
        settings = settings_said(shown.options("/out"))
        assert len(settings.frames) == (known.frames or 250), settings.frames
        assert settings.frames[0] == (7 if known.frames else 1)
        assert settings.resolution == ((480, 270) if known.small else None)
    assert settings.pattern == "d3d4" and settings.truth_frames == settings.frames
    assert counts["QUICK"] == 5 and counts["EVERYTHING"] == len(registry.load_methods()) - 2, counts
    bpy.ops.aa_resolve.choose_family(family="temporal", chosen=False)
    assert not set(families()["temporal"]) & set(shown.chosen())
    bpy.ops.aa_resolve.choose_family(family="spatial", chosen=True)
    assert set(families()["spatial"]) <= set(shown.chosen())
    assert sum(map(len, families().values())) == len(registry.load_methods())


def test_sets_of_methods() -> None:
    """All, none, and what the program says that the shot serves, which is asked of that shot."""
    from aa_resolve import registry
    from aa_resolve.panel import preferences

    shown = registered()
    assert bpy.ops.aa_resolve.choose_set(kind="ALL") == {"FINISHED"}
    assert set(shown.chosen()) == set(registry.load_methods())
    assert bpy.ops.aa_resolve.choose_set(kind="NONE") == {"FINISHED"}
    assert shown.chosen() == []
    folder = t.temporary_folder()
    shown.out = os.path.join(folder, "shot")
    program = os.path.join(folder, "aaresolve")
    with open(program, "w", encoding="utf-8") as file:
        file.write(
            "#!/bin/sh\n"
            f'[ "$1" = --version ] && echo {aa_resolve.ADDON_VERSION} && exit\n'
            f'[ "$*" = "list --shot {shown.out} --json" ] || {{ echo "asked: $*" >&2; exit 3; }}\n'
            'echo \'{"methods": [{"id": "noaa", "whyNot": ""},'
            ' {"id": "msaa", "whyNot": "its frames lack subsamples"}, {"id": "mlaa", "whyNot": ""}]}\'\n'
        )
    os.chmod(program, 0o755)
    before = preferences.preferred
    preferences.preferred = lambda: program
    try:
        assert bpy.ops.aa_resolve.choose_set(kind="RUNNABLE") == {"FINISHED"}
        assert sorted(shown.chosen()) == ["mlaa", "noaa"], shown.chosen()
        for nowhere in ("", "//shot"):  # of a file that is not saved
            shown.out = nowhere
            try:
                bpy.ops.aa_resolve.choose_set(kind="RUNNABLE")
                raise AssertionError("without a folder there is no shot to ask of")
            except RuntimeError as error:
                assert "folder for the shot" in str(error) and "Trace" not in str(error), error
        shown.out = os.path.join(folder, "other")
        with open(program, "a", encoding="utf-8") as file:
            file.write("exit 3\n")
        try:
            bpy.ops.aa_resolve.choose_set(kind="RUNNABLE")
            raise AssertionError("what the program refuses must be told")
        except RuntimeError as error:
            assert "asked" in str(error) or "3" in str(error), error
    finally:
        preferences.preferred = before
    assert sorted(shown.chosen()) == ["mlaa", "noaa"], "a refusal must change nothing"


def test_a_shot_has_a_folder_of_its_own() -> None:
    """Blender's working folder is nobody's shot: an empty path and a relative one are refused, ~ is the user's own."""
    from aa_resolve.panel import running, watch

    shown = registered()
    scene = bpy.context.scene
    folder = t.temporary_folder()
    before, home = os.getcwd(), os.environ["HOME"]
    os.chdir(folder)
    os.environ["HOME"] = folder
    try:
        for out in ("", "shot", "./shot", "~nobody_at_all/shot", "//shot"):
            shown.out = out
            told = watch.look_now(scene).shot
            assert told.refused and "folder for the shot" in told.text, (out, told)
            try:
                bpy.ops.aa_resolve.export()
                raise AssertionError(f"'{out}' must be refused")
            except RuntimeError as error:
                assert told.text in str(error), error
        assert os.listdir(folder) == []
        shown.out = "~/shots/a"
        assert running.shot_folder(scene) == os.path.join(folder, "shots", "a")
        assert not watch.look_now(scene).shot.refused
        bpy.ops.wm.save_as_mainfile(filepath=os.path.join(folder, "saved.blend"))
        shown.out = "//shot/"
        assert running.shot_folder(scene) == os.path.join(folder, "shot")
    finally:
        os.chdir(before)
        os.environ["HOME"] = home


def test_for_takes_sets() -> None:
    """What `aaresolve run -m` takes, `--for` does: families and all, once each, beside methods with parameters."""
    from aa_resolve import registry
    from aa_resolve.errors import UsageError

    spatial = [n for n, m in registry.load_methods().items() if m["family"] == "spatial"]
    parsed = registry.parse_choices(["noaa,spatial", "karis:box=variance,alpha=0.1"])
    assert [choice.id for choice in parsed] == ["noaa", *spatial, "karis"]
    assert parsed[-1].parameters == {"box": "variance", "alpha": "0.1"}
    assert len(registry.parse_choices(["all"])) == len(registry.load_methods())
    try:
        registry.parse_choices(["spatial:x=1"])
        raise AssertionError("a set has no parameters")
    except UsageError as error:
        assert "spatial" in str(error)


def test_the_look_is_foretold() -> None:
    """What the panel says of 'No Noise' is what the exporter then does, and a scene without such things hears nothing."""
    from aa_resolve.panel import look, watch
    from aa_resolve.scene import lighting

    shown = registered()
    scene = bpy.context.scene
    t.add_camera(scene)
    scene.cycles.max_bounces = 0
    t.add_sun(scene)
    assert look.changes_without_noise(scene) == []
    assert (
        lighting.set_up(scene, scene.view_layers[0], "noise-free", None, t.temporary_folder()).notes
        == []
    )
    scene.cycles.max_bounces = 8
    for kind in ("AREA", "POINT", "SPOT"):
        light = bpy.data.lights.new(f"The {kind.lower()}", kind)
        if kind != "AREA":
            light.shadow_soft_size = 0.5
        scene.collection.objects.link(bpy.data.objects.new(light.name, light))
    scene.world = bpy.data.worlds.new("Sky")
    told = "; ".join(watch.look_now(scene).changes)
    for word in ("'The area'", "'The point'", "'The spot'", "ambient", "bounces"):
        assert word in told, told
    assert "'Sun'" not in told and "glow" not in told, told
    done = " ".join(
        lighting.set_up(scene, scene.view_layers[0], "noise-free", (0.5, 0.5, 0.5), "").notes
    )
    for word in ("'The area'", "'The point'", "'The spot'", "ambient", "bounces"):
        assert word in done, done
    shown.lighting = "as-is"
    facts = watch.look_now(scene)
    assert not facts.changes and any("4 lights" in cause for cause in facts.noise), facts
    assert facts.engine == ""
    scene.render.engine = "BLENDER_WORKBENCH"
    assert "Workbench" in watch.look_now(scene).engine and "Cycles" in watch.look_now(scene).engine
    scene.render.engine = t.eevee_engine()
    assert "EEVEE" in watch.look_now(scene).engine


def ranking(folder: str) -> dict:
    """Results as the resolver writes them: three methods and a reference, one pair the other way round."""

    def method(name, family, psnr):
        return {"text": name, "title": name.upper(), "family": family, "pooled": {"psnr": psnr}}

    def pair(first, second, gain, low, high, resolved=True):
        return {
            "first": first, "second": second, "gainDb": gain, "gainLow95": low,
            "gainHigh95": high, "resolved": resolved,
        }  # fmt: skip

    content = {
        "methods": [
            method("noaa", "reference", 30.0),
            method("accum", "reference", "Inf"),
            method("smaa1x", "spatial", 35.0),
            method("karis:alpha=0.1", "temporal", 36.0),
            method("fxaa311", "spatial", 31.0),
            method("dlaa", "spatial", 29.0),
        ],
        "pairs": [
            pair("noaa", "smaa1x", -5.0, -6.0, -4.5),
            pair("karis:alpha=0.1", "noaa", 6.0, 5.5, 6.5),
            pair("smaa1x", "karis:alpha=0.1", -1.0, -3.0, 1.0, False),
            pair("fxaa311", "noaa", 1.0, -0.04, 2.0),
        ],
    }
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "results.json"), "w", encoding="utf-8") as file:
        json.dump(content, file)
    return content


def test_results_are_found_on_disk() -> None:
    """The ranking comes from the folder beside the shot, in a new session too; damage is told."""
    from aa_resolve.panel import outcome, watch

    shown = registered()
    scene = bpy.context.scene
    folder = t.temporary_folder()
    shown.out = os.path.join(folder, "shot")
    assert watch.look_now(scene).outcome is None
    results = shown.out + "_results"
    ranking(results)
    found = watch.look_now(scene).outcome
    assert [rank.text for rank in found.best] == ["karis:alpha=0.1", "smaa1x", "fxaa311"]
    assert [rank.gain for rank in found.best] == [(6, 5.5, 6.5), (5, 4.5, 6), (1, -0.04, 2)]
    assert [rank.told_apart for rank in found.best] == [True, False, True]
    words = [outcome.lines_of(place, rank) for place, rank in enumerate(found.best, 1)]
    assert words[0][0] == "1. KARIS:ALPHA=0.1 (alpha=0.1): 36.0 dB", words
    assert "+5.0 dB over no anti-aliasing" in words[1][1] and "+4.5 to +6.0" in words[1][1]
    assert "not told apart" in words[1][2] and "0.0 to +2.0" in words[2][1], words
    for ends, wanted in {
        (-math.inf, math.inf): "(no interval)",
        (-math.inf, -7.25): "(95\u00a0%: below -7.2)",
        (1.5, math.inf): "(95\u00a0%: above +1.5)",
    }.items():
        rank = outcome.Rank("fxaa1", "FXAA", 30.0, (2.0, *ends), True)
        assert outcome.lines_of(1, rank)[1] == f"+2.0 dB over no anti-aliasing {wanted}"
    assert found.files == () and not bpy.ops.aa_resolve.open_sheet.poll()
    open(os.path.join(results, "sheet.png"), "w").close()
    watch.look_now(scene)
    assert bpy.ops.aa_resolve.open_sheet.poll() and not bpy.ops.aa_resolve.open_report.poll()
    blend = os.path.join(folder, "scene.blend")
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    bpy.ops.wm.read_homefile(use_empty=True)
    assert watch.of(bpy.context.scene).outcome is None, "another file"
    bpy.ops.wm.open_mainfile(filepath=blend)
    scene = bpy.context.scene
    assert len(watch.look_now(scene).outcome.best) == 3, "found again"
    content = ranking(results)
    content["run"] = {"complete": False, "framesAsked": 16}
    content["methods"][0]["frames"] = [{}, {}, {}]
    content["methods"][1]["pooled"] = None
    with open(os.path.join(results, "results.json"), "w", encoding="utf-8") as file:
        json.dump(content, file)
    found = watch.look_now(scene).outcome
    assert (
        found.trouble == "not finished: 3 of 16 frames; press Export and Compare again"
        and not found.best
    )
    content["run"]["complete"] = True
    with open(os.path.join(results, "results.json"), "w", encoding="utf-8") as file:
        json.dump(content, file)
    assert len(watch.look_now(scene).outcome.best) == 3, "a method without figures has no place"
    with open(os.path.join(results, "results.json"), "w", encoding="utf-8") as file:
        file.write('{"methods": [')
    assert "cannot be read" in watch.look_now(scene).outcome.trouble
    scene.aa_resolve.out = "//beside"
    bpy.ops.wm.read_homefile(use_empty=True)
    assert watch.look_now(bpy.context.scene).outcome is None, "no folder before the file is saved"


def test_looking_is_not_drawing() -> None:
    """What the panel's drawing asks for is there at once: neither the scene is walked through nor the disk read."""
    from aa_resolve.panel import look, outcome, watch

    registered()
    scene = bpy.context.scene
    before = watch.look_now(scene)

    def refuse(*_arguments) -> None:
        raise AssertionError("drawing must not do this")

    kept = look.changes_without_noise, outcome.stamp_of
    look.changes_without_noise = outcome.stamp_of = refuse
    try:
        assert watch.of(scene) == before
    finally:
        look.changes_without_noise, outcome.stamp_of = kept


if __name__ == "__main__":
    t.main(
        test_manifests_agree,
        test_only_compat_knows_versions,
        test_settings_of_later_versions,
        test_the_panel_says_what_it_shows,
        test_the_scenes_range_has_its_steps,
        test_parameters_are_edited_and_said,
        test_starts_and_families,
        test_sets_of_methods,
        test_a_shot_has_a_folder_of_its_own,
        test_for_takes_sets,
        test_the_look_is_foretold,
        test_results_are_found_on_disk,
        test_looking_is_not_drawing,
    )
