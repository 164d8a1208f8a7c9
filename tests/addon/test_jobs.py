# SPDX-License-Identifier: GPL-3.0-or-later
"""The panel's work in child processes: progress, cancel, comparison, preview of the light, and what they leave."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import aa_resolve, bpy, np  # noqa: E402

FOLDER = t.temporary_folder()


def digest(path: str) -> str:
    with open(path, "rb") as file:
        return hashlib.sha256(file.read()).hexdigest()


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
    for number, word in ((9, "memory"), (11, "crashed"), (15, "stopped")):
        # What it said before, in the events of its progress and on its stderr, is not why it ended.
        script = f'echo \'{{"event": "x", "text": "frame 8"}}\'; echo noise >&2; kill -{number} $$'
        killed = job.Job([job.Step("Export", ["/bin/sh", "-c", script])], FOLDER + "/none")
        killed.start()
        while killed.poll():
            pass
        assert killed.error.startswith("Export: ") and word in killed.error, killed.error
        assert "valid" in killed.error and "noise" not in killed.error, killed.error


PROGRAM = """#!{python}
import json, os, sys
words = sys.argv[1:]
if words == ["--version"]:
    print("{version}")
    raise SystemExit
with open({log!r}, "a") as file:
    file.write(json.dumps(words) + "\\n")
if words[0] == "list":
    names = words[1 : words.index("--shot")]
    if any(":" in name for name in names):
        raise SystemExit("unknown method")
    methods = [dict(id=name, whyNot="this shot moves" if name == "accum" else "") for name in names]
    print(json.dumps(dict(methods=methods)))
elif words[0] == "run":
    out = words[words.index("-o") + 1]
    os.makedirs(out, exist_ok=True)
    method = dict(text="noaa", title="No anti-aliasing", family="reference", pooled=dict(psnr=30.0))
    with open(os.path.join(out, "results.json"), "w") as file:
        json.dump(dict(methods=[method], pairs=[]), file)
elif words[0] == "sheet":
    import base64
    with open(words[words.index("-o") + 1], "wb") as file:
        file.write(base64.b64decode({png!r}))
else:
    open(words[words.index("-o") + 1], "w").close()
"""
PNG = "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="


def program(version: str, log: str = "/dev/null") -> str:
    """A stand-in for aaresolve that notes what it is asked for."""
    path = os.path.join(t.temporary_folder(), "aaresolve")
    with open(path, "w", encoding="utf-8") as file:
        file.write(PROGRAM.format(python=sys.executable, version=version, log=log, png=PNG))
    os.chmod(path, 0o755)
    return path


def preferences():
    """The add-on's preferences, with the add-on switched on. A new scene takes them away."""
    addons = bpy.context.preferences.addons
    if "aa_resolve" not in addons:
        addons.new().module = "aa_resolve"
    if not hasattr(bpy.types.Scene, "aa_resolve"):
        aa_resolve.register()
    return addons["aa_resolve"].preferences


def moving_scene(name: str) -> bpy.types.Scene:
    """A lit cube on its way, saved."""
    scene = t.new_scene(32, 18)
    t.add_camera(scene)
    t.add_sun(scene).data.angle = 0.1
    t.key(t.add_object(scene, "Cube"), "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    t.save(scene, os.path.join(FOLDER, name))
    return scene


def test_preferences_tell_missing_from_wrong() -> None:
    """Found with version and place; none, a path that leads nowhere, and another version are told apart."""
    from aa_resolve.panel import preferences as shown

    wanted = preferences()
    good, old = program(aa_resolve.ADDON_VERSION), program("0.0.9")
    told = {}
    for name, path in (("good", good), ("old", old), ("wrong", "/nowhere/aaresolve"), ("", "")):
        wanted.resolver = path
        assert shown.verdict() == ("", "") or shown.wait_for_check() is None
        bpy.ops.aa_resolve.check_program()
        told[name] = shown.verdict()
    found, problem = told["good"]
    assert aa_resolve.ADDON_VERSION in found and good in found and not problem, told
    assert "0.0.9" in told["old"][0] and aa_resolve.ADDON_VERSION in told["old"][1], told
    assert not told["wrong"][0] and "/nowhere/aaresolve" in told["wrong"][1], told
    if not told[""][0]:
        assert "not found" in told[""][1] and told[""][1] != told["wrong"][1], told


def test_compare_runs_the_chosen() -> None:
    """Export, run with the parameters of the panel, sheet and report; the ranking is there afterwards."""
    from aa_resolve.panel import watch
    from aa_resolve.panel.running import State

    scene = moving_scene("compare.blend")
    wanted = preferences()
    shown = scene.aa_resolve
    log = os.path.join(t.temporary_folder(), "log")
    shown.out = os.path.join(FOLDER, "compared")
    shown.first, shown.last, shown.truth_samples = 1, 2, 2
    shown.widgets_taaSimplest.set_k, shown.method_accum = 0.8, True
    wanted.resolver = "/nowhere/aaresolve"
    try:
        bpy.ops.aa_resolve.compare()
        raise AssertionError("a program that is not there must be noticed")
    except RuntimeError as error:
        assert "/nowhere/aaresolve" in str(error), error
    wanted.resolver = program(aa_resolve.ADDON_VERSION, log)
    was_dirty = bpy.data.is_dirty  # without a window Blender 4.3 calls a file so that it just saved
    assert bpy.ops.aa_resolve.compare() == {"FINISHED"}
    with open(log, encoding="utf-8") as file:
        asked = [json.loads(line) for line in file]
    assert [words[0] for words in asked] == ["list", "run", "sheet", "report"], asked
    assert set(asked[0][1:4]) == {"accum", "noaa", "taaSimplest"}, asked[0]
    assert asked[0][4:] == ["--shot", shown.out, "--json"], asked[0]
    assert asked[1][1] == shown.out and asked[1][2:6] == ["-m", "noaa", "-m", "taaSimplest:k=0.8"]
    assert asked[1][6] == "-o" and State.result.endswith(
        "; without accum (this shot moves)"
    ), asked[1]
    facts = watch.look_now(scene)
    assert facts.outcome.best[0].text == "noaa" and len(facts.outcome.files) == 2, facts
    assert not bpy.data.images, "the sheet is shown beside the file, not in it"
    assert bpy.data.is_dirty == was_dirty, "the file is as it was, so that the export resumes"
    shown.method_noaa = shown.method_taaSimplest = False
    try:
        bpy.ops.aa_resolve.compare()
        raise AssertionError("without a method there is nothing to run")
    except RuntimeError as error:
        assert "No chosen method can run" in str(error) and "this shot moves" in str(error), error


def test_a_stale_estimate_goes() -> None:
    """An estimate stays while what it was made for stays, and goes with any setting that it depends on."""
    from aa_resolve.panel import watch
    from aa_resolve.panel.running import State

    scene = moving_scene("estimate.blend")
    preferences()
    shown = scene.aa_resolve
    shown.out, shown.first, shown.last = os.path.join(FOLDER, "estimated"), 1, 3

    def change_size() -> None:
        scene.render.resolution_x = 40

    for change in (
        lambda: setattr(shown, "last", 4),
        lambda: setattr(shown, "method_karis", True),
        lambda: setattr(shown, "truth_samples", 17),
        change_size,
    ):
        State.estimate, State.estimate_for = "about 3 s", watch.wish_of(scene)
        shown.out = shown.out + "_elsewhere"
        watch.look_now(scene)
        assert State.estimate, "where the shot lies costs nothing"
        change()
        watch.look_now(scene)
        assert not State.estimate, change
    assert bpy.ops.aa_resolve.estimate() == {"FINISHED"}
    watch.look_now(scene)
    assert "about" in State.estimate and State.result == ""


def picture(path: str) -> np.ndarray:
    """H x W x channels, of a PNG."""
    source = t.oiio.ImageInput.open(path)
    return source.read_image(0, 0, 0, source.spec().nchannels, "float")


def test_preview_shows_both_lights() -> None:
    """One frame in the scene's own light and without noise, side by side, labelled; the scene stays as it is."""
    scene = moving_scene("preview.blend")
    preferences()
    sky = bpy.data.worlds.new("Sky")
    sky.use_nodes = True
    sky.node_tree.nodes["Background"].inputs["Color"].default_value = (0.0, 0.0, 1.0, 1.0)
    scene.world = sky
    scene.view_settings.view_transform = "Standard"
    scene.render.resolution_x, scene.render.resolution_y = 960, 540
    scene.frame_set(4)
    # The sun alone on one side: without the sky's light the side in shadow differs.
    sky.cycles_visibility.diffuse = False
    before = set(bpy.data.objects), scene.render.engine, scene.frame_current
    bpy.data.lights["Sun"].energy = 0.0
    sky.cycles_visibility.diffuse = True
    scene.aa_resolve.use_ambient, scene.aa_resolve.ambient = True, (1.0, 0.0, 0.0)
    assert bpy.ops.aa_resolve.preview_light() == {"FINISHED"}
    assert (set(bpy.data.objects), scene.render.engine, scene.frame_current) == before
    assert not bpy.data.images, "it is shown beside the file, not in it"
    pixels = picture(os.path.join(bpy.app.tempdir, f"aa_resolve_light_{os.getpid()}.png"))
    height, width = pixels.shape[:2]
    assert width == 2 * 480 + 6 and height == 270 + 26, (width, height)
    label, left, right = pixels[:26], pixels[26:, :480], pixels[26:, 486:]
    for part in (label[:, :480], label[:, 486:]):
        assert (part[:, :, 0] > 0.7).mean() > 0.01, "letters"
        assert (part[:, :, 0] > 0.7).mean() < 0.3
    assert np.abs(label[:, :480] - label[:, 486:966]).max() > 0.5, "each side has its own label"
    changed = np.abs(left - right)[:, :, :3].max(-1) > 0.1
    assert (
        0.005 < changed.mean() < 0.5
    ), "the cube is lit by the sky or by the ambient, the sky is the same"
    row, column = np.argwhere(changed).mean(0).astype(int)
    assert left[row, column, 2] > left[row, column, 0] + 0.1, "blue light of the sky"
    assert right[row, column, 0] > right[row, column, 2] + 0.1, "the ambient of the panel"


def test_preview_of_a_file_in_another_space() -> None:
    """The preview shows the same colours whatever space the file computes in."""
    if not hasattr(bpy.data, "colorspace"):
        return  # before 5.0 there is one
    shown = []
    for space in ("Linear Rec.709", "ACEScg"):
        scene = t.new_scene(16, 9)
        preferences()
        t.add_camera(scene)
        scene.world = bpy.data.worlds.new("Red")
        background = scene.world.node_tree.nodes["Background"]
        background.inputs["Color"].default_value = (0.9, 0.02, 0.02, 1.0)
        scene.view_settings.view_transform = "Standard"
        bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=True)
        assert bpy.ops.aa_resolve.preview_light() == {"FINISHED"}
        light = picture(os.path.join(bpy.app.tempdir, f"aa_resolve_light_{os.getpid()}.png"))
        shown.append(light[30, 8, :3])
    assert 0.1 < shown[0][1] < shown[0][0], "red, and not as red as can be"
    assert np.abs(shown[0] - shown[1]).max() < 2 / 255, shown


def test_python_runs_as_in_the_session() -> None:
    """The child runs the file's Python where this Blender does, and what it notes is kept for the panel."""
    from aa_resolve.panel import job
    from aa_resolve.panel.running import State

    preferences()
    path = os.path.join(FOLDER, "driven.blend")

    def allowed(expression: str, script: bool, trusted: bool) -> bool:
        """Opens a file with a driver, and maybe a script; whether a child may run them."""
        scene = t.new_scene(16, 9)
        t.add_camera(scene)
        t.add_sun(scene)
        curve = t.add_object(scene, "Cube").driver_add("location", 0)
        curve.driver.use_self, curve.driver.expression = True, expression
        if script:
            text = bpy.data.texts.new("helper.py")
            text.write("import bpy")
            text.use_module = True
        t.save(scene, path)
        bpy.ops.wm.open_mainfile(filepath=path, use_scripts=trusted)
        bpy.context.scene.frame_set(1)
        shown = bpy.context.scene.aa_resolve
        shown.out, shown.overwrite = os.path.join(FOLDER, "driven"), True
        shown.first, shown.last, shown.truth = 1, 2, "NONE"
        return "--enable-autoexec" in job.script_command(path, "x.py", [])

    def notes() -> str:
        assert bpy.ops.aa_resolve.export() == {"FINISHED"}
        return "; ".join(State.notes)

    needs_permission = "0 * self.scale.x + frame / 5"
    assert not allowed(needs_permission, False, False) and "not allowed to run" in notes()
    assert allowed(needs_permission, False, True) and "not allowed" not in notes(), State.notes
    out = bpy.context.scene.aa_resolve.out
    assert not t.read_manifest(out)["static"], "it moves as in the session"
    assert allowed("frame / 5", True, True) and not allowed("frame / 5", True, False)
    for harmless in ("frame / 5", "[frame, 2][0]", "sum([frame])"):
        for trusted in (False, True):
            assert not allowed(harmless, False, trusted), "nothing shows that the user trusts it"
    bpy.context.preferences.filepaths.use_scripts_auto_execute = True
    assert "--enable-autoexec" in job.script_command(path, "x.py", [])
    bpy.context.preferences.filepaths.use_scripts_auto_execute = False


def test_cancel_stops_and_says_so() -> None:
    """What the Cancel button does; Esc while an animation plays, or beside the Render tab, is let through."""
    from aa_resolve.panel import job, running
    from aa_resolve.panel.running import State

    scene = moving_scene("cancel.blend")
    preferences()
    shown = scene.aa_resolve
    shown.out, shown.first, shown.last = os.path.join(FOLDER, "cancelled"), 1, 400
    assert not bpy.ops.aa_resolve.cancel.poll()
    folder, blend = job.copy_of_open_file()
    words = shown.options(shown.out)
    work = job.Job([job.Step("Export", job.export_command(blend, words))], folder)
    running.begin(work)
    assert State.running is work and not bpy.ops.aa_resolve.export.poll()
    while work.poll() and work.done < 2:
        pass
    bpy.ops.wm.read_homefile(use_empty=True)
    assert State.running is work, "another file is opened, the work goes on"
    assert bpy.ops.aa_resolve.cancel() == {"FINISHED"}
    assert State.running is None and "Stopped" in State.result and not os.path.exists(folder)
    assert not State.failed and work.cancelled


def test_the_panel_says_what_a_shot_lacks() -> None:
    """Nothing of a shot that is not begun; then what is kept and what is to be rendered, and what would be refused."""
    from aa_resolve.panel import watch

    scene = moving_scene("added.blend")
    preferences()
    shown = scene.aa_resolve
    shown.out = os.path.join(FOLDER, "added")
    shown.first, shown.last, shown.truth, shown.truth_samples = 1, 2, "ALL", 2
    assert watch.look_now(scene).shot.text == ""
    bpy.ops.wm.save_mainfile()
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    told = watch.look_now(scene).shot
    assert not told.refused and "The shot has 2 frames" in told.text, told
    assert "nothing to render" in told.text, told
    records = os.path.join(shown.out, ".aa", "frames")
    for name in ("._000001.json", ".DS_Store", "000001 2.json", "x.json.coming"):
        with open(os.path.join(records, name), "wb") as file:
            file.write(b"\0\x05\x16\x07")
    assert watch.shot.look(scene, shown.out) == told, "what a system adds is no record"
    listed = os.listdir

    def closed(path: str) -> list[str]:
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), path)

    os.listdir = closed
    try:
        refused = watch.shot.look(scene, shown.out)
    finally:
        os.listdir = listed
    assert refused.refused and f"{records}: Permission denied" in refused.text, refused
    shown.method_karis = True
    shown.last = 3
    told = watch.look_now(scene).shot
    assert "depth" in told.text and "1 frame" in told.text and "1 truth" in told.text, told
    shown.period = 8
    told = watch.look_now(scene).shot
    assert told.refused and "'Period' was 16 and now is 8" in told.text, told
    shown.period, shown.use_resolution, shown.resolution = 16, True, (40, 20)
    sized = watch.look_now(scene).shot
    assert sized.refused and "'Resolution' was the scene's and now is 40x20" in sized.text, sized
    shown.use_resolution = False
    assert "--" not in told.text and not told.other_scene, "a panel speaks by its labels"
    shown.overwrite = True
    told = watch.look_now(scene).shot
    assert told.text == "The old shot will be replaced" and not told.refused
    shown.overwrite, shown.period = False, 16
    shown.method_smaaS2x, shown.method_rsaa, shown.pattern = True, True, "d3d8"
    told = watch.look_now(scene).shot
    assert told.refused and "smaaS2x" in told.text, told


def test_one_of_two_view_layers_is_chosen() -> None:
    """Two in use are refused, by the panel's label and before anything is begun; the chosen one is exported and shown."""
    from aa_resolve.panel import watch

    scene = moving_scene("layers.blend")
    preferences()
    shown = scene.aa_resolve
    shown.out = os.path.join(FOLDER, "layers")
    shown.first, shown.last, shown.truth, shown.truth_samples = 1, 2, "NONE", 2
    assert "--view-layer" not in shown.options("/out") and not watch.look_now(scene).shot.refused
    things = bpy.data.collections.new("Things")
    scene.collection.children.link(things)
    things.objects.link(bpy.data.objects["Cube"])
    scene.collection.objects.unlink(bpy.data.objects["Cube"])
    scene.view_layers.new("Empty").layer_collection.children["Things"].exclude = True
    told = watch.look_now(scene).shot
    assert told.refused and "choose one with 'Layer'" in told.text, told
    shown.view_layer = "Empty"
    assert not watch.look_now(scene).shot.refused
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    color = t.read_part(os.path.join(shown.out, "frames", "000001.exr"), "color")
    assert all(np.ptp(color[name]) == 0.0 for name in "RGB"), "nothing but the world"
    shown.view_layer = scene.view_layers[0].name
    told = watch.look_now(scene).shot
    assert told.refused and "'Layer' was Empty" in told.text, told
    shown.overwrite = True
    assert bpy.ops.aa_resolve.preview_light() == {"FINISHED"}
    light = picture(os.path.join(bpy.app.tempdir, f"aa_resolve_light_{os.getpid()}.png"))
    assert np.ptp(light[26:, : light.shape[1] // 2 - 3]) > 0.1, "the layer with the cube"
    shown.view_layer = "Gone"
    assert "has no layer 'Gone'" in watch.look_now(scene).shot.text


def test_a_saved_file_is_added_to() -> None:
    """The panel's settings lie in the file, so that choosing a method changes it: the user may vouch for the scene."""
    from aa_resolve.panel import watch

    scene = moving_scene("vouched.blend")
    preferences()
    shown = scene.aa_resolve
    shown.out = os.path.join(FOLDER, "vouched")
    shown.first, shown.last, shown.truth, shown.truth_samples = 1, 2, "NONE", 2
    bpy.ops.wm.save_mainfile()
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    first = os.path.join(shown.out, "frames", "000001.exr")
    before = t.read_part(first, "color")
    shown.method_karis = True
    bpy.ops.wm.save_mainfile()
    told = watch.look_now(scene).shot
    assert told.refused and told.other_scene and "'Same Scene'" in told.text, told
    try:
        bpy.ops.aa_resolve.export()
        raise SystemExit("unasked, another file adds nothing")
    except RuntimeError as error:
        assert "the .blend file, or a script" in str(error) and "Error: '" in str(error), error
    shown.same_scene = True
    told = watch.look_now(scene).shot
    assert not told.refused and "to render: depth for 2 frames" in told.text, told
    kept = watch.shot.has_unsaved_changes
    watch.shot.has_unsaved_changes = lambda: True  # as in a window before the file is saved
    try:
        assert not watch.shot.look(scene, shown.out).refused
    finally:
        watch.shot.has_unsaved_changes = kept
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    after = t.read_part(first, "color")
    assert all((before[name] == after[name]).all() for name in before), "what was there is kept"
    assert t.read_part(first, "depth")
    shown.period = 8
    told = watch.look_now(scene).shot
    assert told.refused and "'Period' was 16" in told.text, "it vouches for the scene alone"


def test_two_scenes_have_two_shots() -> None:
    """The panel exports the scene that is shown, and says that the folder of one holds none of the other."""
    from aa_resolve.panel import watch

    moving_scene("two_scenes.blend")
    preferences()
    first = bpy.context.scene
    second = bpy.data.scenes.new("Second")
    second.camera, second.render.engine = first.camera, "CYCLES"
    second.render.resolution_x = second.render.resolution_y = 8
    t.add_object(second, "Only here")
    bpy.ops.wm.save_mainfile()
    for scene in (first, second):
        bpy.context.window.scene = scene
        shown = scene.aa_resolve
        shown.out, shown.first, shown.last, shown.truth = "//two_scenes", 1, 1, "NONE"
        told = watch.look_now(scene).shot
        assert told.refused == (scene == second), told
        if scene == first:
            assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    assert "the scene was Scene and now is Second" in told.text and not told.other_scene, told
    try:
        bpy.ops.aa_resolve.export()
        raise AssertionError("another scene must be refused")
    except RuntimeError as error:
        assert "now is Second" in str(error), error
    shown.out = "//second"
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}
    shot = t.read_manifest(os.path.join(FOLDER, "second"))
    assert shot["resolution"] == [8, 8], shot["resolution"]


def test_paint_that_is_not_saved_is_refused() -> None:
    """The copy of the file holds an image as it was saved: what was painted since would be missing without a word."""
    scene = moving_scene("painted.blend")
    preferences()
    paint, unused = (bpy.data.images.new(name, 4, 4) for name in ("Paint", "Elsewhere"))
    for image in (paint, unused):
        image.pixels = [1.0, 0.0, 0.0, 1.0] * 16
        image.pack()
    material = t.diffuse("Painted", (0.5, 0.5, 0.5))
    node = material.node_tree.nodes.new("ShaderNodeTexImage")
    node.image = paint
    bpy.data.objects["Cube"].data.materials.append(material)
    shown = scene.aa_resolve
    shown.out, shown.first, shown.last, shown.truth = "//painted", 1, 1, "NONE"
    bpy.ops.wm.save_mainfile()
    for image in (paint, unused):
        image.pixels = [0.0, 1.0, 0.0, 1.0] * 16
    for start in (bpy.ops.aa_resolve.export, bpy.ops.aa_resolve.preview_light):
        try:
            start()
            raise AssertionError("what is not saved must be named")
        except RuntimeError as error:
            assert "'Paint'" in str(error) and "Elsewhere" not in str(error), error
    assert not os.path.exists(os.path.join(FOLDER, "painted"))
    paint.pack()
    assert bpy.ops.aa_resolve.export() == {"FINISHED"}


def test_disk_caches_are_seen() -> None:
    """The copy that is exported finds the disk caches beside the original file, and removes nothing of them."""
    from aa_resolve.panel import job

    moving_scene("cached.blend")
    cache = os.path.join(FOLDER, "blendcache_cached")
    os.makedirs(cache)
    with open(os.path.join(cache, "a.bphys"), "w", encoding="utf-8") as file:
        file.write("baked")
    folder, blend = job.copy_of_open_file()
    seen = os.path.join(folder, "blendcache_scene", "a.bphys")
    assert os.path.basename(blend) == "scene.blend" and os.path.exists(seen)
    job.Job([], folder).cancel()
    assert not os.path.exists(folder) and os.path.exists(os.path.join(cache, "a.bphys"))


if __name__ == "__main__":
    t.main(
        test_job_reports_and_cancels,
        test_preferences_tell_missing_from_wrong,
        test_compare_runs_the_chosen,
        test_a_stale_estimate_goes,
        test_preview_shows_both_lights,
        test_preview_of_a_file_in_another_space,
        test_python_runs_as_in_the_session,
        test_cancel_stops_and_says_so,
        test_the_panel_says_what_a_shot_lacks,
        test_one_of_two_view_layers_is_chosen,
        test_a_saved_file_is_added_to,
        test_two_scenes_have_two_shots,
        test_paint_that_is_not_saved_is_refused,
        test_disk_caches_are_seen,
    )
