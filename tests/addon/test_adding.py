# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot is added to: passes, frames, truth and sub-samples that it lacks, nothing else, and what is there stays to the
bit. What was added is what an export of everything at once would have made."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve import adding, identity, store as storing  # noqa: E402
from aa_resolve.command_line import build_parser, settings_from  # noqa: E402
from aa_resolve.errors import UsageError  # noqa: E402

FOLDER = t.temporary_folder()
EVERYTHING = "albedo,depth,edges,motion,normal,object,segments,subsampleColor,subsamples"
# One method that accumulates frames and one that reads the pixel centres.
BOTH_KINDS = ("--for", "taaSimplest,fxaa311")


def make_blend() -> str:
    """Flat and smooth surfaces, two lights, glossy and emitting materials, and another camera from frame 4 on."""
    scene = t.new_scene(40, 24)
    for turn in (0.3, 1.4):
        t.add_sun(scene, 1.5, (0.6, 0.2, turn))
    item = t.add_object(scene, "Cube", None, (-1, 0, 0.5))
    item.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    bpy.ops.mesh.primitive_uv_sphere_add(segments=16, ring_count=8, location=(1.2, 0, 0.6))
    ball = bpy.context.object
    for face in ball.data.polygons:
        face.use_smooth = True
    shiny = bpy.data.materials.new("Shiny")
    shiny.use_nodes = True
    shader = next(n for n in shiny.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    shader.inputs["Metallic"].default_value = 0.6
    shader.inputs["Base Color"].default_value = (0.8, 0.4, 0.1, 1.0)
    ball.data.materials.append(shiny)
    lamp = t.add_object(scene, "Lamp", t.cube_mesh("Lamp", 0.5), (0, 1.5, 1.5))
    glow = bpy.data.materials.new("Glow")
    glow.use_nodes = True
    tree = glow.node_tree
    emission = tree.nodes.new("ShaderNodeEmission")
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    lamp.data.materials.append(glow)
    for frame, name, place in ((1, "First", (0, -8, 1)), (4, "Second", (2, -7, 2))):
        marker = scene.timeline_markers.new(name, frame=frame)
        marker.camera = t.add_camera(scene, place)
    return t.save(scene, os.path.join(FOLDER, "scene.blend"))


BLEND = make_blend()


def opened() -> bpy.types.Scene:
    """The scene as saved: an export changes the open one."""
    bpy.ops.wm.open_mainfile(filepath=BLEND)
    return bpy.context.scene


def of_the_file(options: tuple[str, ...]) -> list[str]:
    """Options for this process, in which a test ran on the scene, as for one in which nothing did."""
    return ["--source", identity.file_identity(BLEND), *options]


def exported(out: str, *options: str) -> dict:
    opened()
    return t.export(out, *of_the_file(options))


def lacking(out: str, *options: str) -> adding.Missing:
    words = ["--out", out, *of_the_file(options)]
    settings = settings_from(build_parser().parse_args(words), opened())
    return adding.missing(settings, storing.Store(out, 1.0))


def files(out: str) -> dict[str, bytes]:
    """Content of every picture."""
    found = {}
    for kind in storing.KINDS:
        folder = os.path.join(out, kind)
        for name in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
            with open(os.path.join(folder, name), "rb") as file:
                found[f"{kind}/{name}"] = file.read()
    return found


def without_times(out: str) -> dict:
    plain = t.read_manifest(out)
    for entry in plain["frames"]:
        entry.pop("render_seconds")
    plain.pop("name")
    plain["methods"].sort()
    return plain


def assert_same_shot(one: str, other: str) -> None:
    """Every part alike to the bit; smooth normals of two renders may differ by rounding."""
    assert files(one).keys() == files(other).keys(), (files(one).keys(), files(other).keys())
    for name, content in files(one).items():
        if content == files(other)[name]:
            continue
        paths = os.path.join(one, name), os.path.join(other, name)
        assert t.part_names(paths[0]) == t.part_names(paths[1]), name
        for part in t.part_names(paths[0]):
            channels, others = (t.read_part(path, part) for path in paths)
            assert channels.keys() == others.keys(), (name, part)
            for channel, pixels in channels.items():
                smooth = ".N." in f".{channel}" or channel.startswith("N.")
                error = np.abs(pixels.astype(np.float64) - others[channel]).max()
                assert error <= (1e-6 if smooth else 0.0), (name, part, channel, error)
    ours, theirs = without_times(one), without_times(other)
    for shot in (ours, theirs):
        for entry in shot["frames"]:
            entry.pop("bytes")  # of normals that differ by rounding
    assert ours == theirs, (ours, theirs)


def parts_of(path: str) -> dict[str, dict]:
    return {name: t.read_part(path, name) for name in t.part_names(path)}


def assert_is_valid(out: str) -> None:
    """Whatever was interrupted: every frame that is listed is there with the passes of the first one, as it claims."""
    shot = t.read_manifest(out)
    assert shot["frames"] and shot["frames"][0]["reset"]
    for kind in ("file", "centre"):
        first = shot["frames"][0].get(kind)
        if first is None:
            continue
        needed = set(t.part_names(os.path.join(out, first)))
        for entry in shot["frames"]:
            path = os.path.join(out, entry[kind])
            assert needed <= set(t.part_names(path)), (path, needed)
            for part in needed:
                t.read_part(path, part)
            if "subsamples" in needed:
                count = len(shot["subsamples"]["positions"])
                views = {name[:3] for name in t.read_part(path, "subsamples") if name[0] == "s"}
                assert len(views) == count, (path, views, count)


def test_added_step_by_step_is_exported_at_once() -> None:
    whole, grown = os.path.join(FOLDER, "whole"), os.path.join(FOLDER, "grown")
    truth = ("--truth-samples", "4", "--truth-frames")
    exported(
        whole, "--frames", "1-5", "--for", "taaSimplest,fxaa311,rsaa", "--passes", EVERYTHING, *truth, "1,5"
    )  # fmt: skip
    exported(grown, "--frames", "1-2", "--for", "taaSimplest", "--truth-frames", "none")
    steps = (
        ("--frames", "1-2", "--passes", "object", "--truth-frames", "none"),
        ("--frames", "4-5", *truth, "5"),
        ("--frames", "3", *truth, "none"),  # closes the gap
        *(("--frames", "1", "--passes", name, *truth, "none") for name in EVERYTHING.split(",")),
        ("--frames", "1-5", "--for", "fxaa311", "--truth-frames", "none"),
        ("--frames", "2", "--for", "rsaa", *truth, "none"),
        ("--frames", "1-5", *truth, "1"),
    )
    for step in steps:
        before = files(grown)
        shot = exported(grown, *step)
        assert_is_valid(grown)
        assert before.keys() <= files(grown).keys(), step
        for name in before:
            if name.startswith("frames"):
                old = set(t.part_names(os.path.join(grown, name)))
                assert "color" in old
        for entry in shot["frames"]:
            present = set(t.part_names(os.path.join(grown, entry["file"])))
            assert set(entry["bytes"]) - {"centre", "truth"} == present, (step, entry["bytes"])
    assert [entry["reset"] for entry in shot["frames"]] == [True, False, False, True, False]
    assert_same_shot(whole, grown)
    assert not lacking(grown, "--frames", "1-5", "--passes", EVERYTHING, *truth, "1,5").work


def test_old_parts_are_copied_bit_for_bit() -> None:
    out = os.path.join(FOLDER, "copied")
    exported(out, "--frames", "1-2", "--passes", "depth,normal", "--truth-samples", "2")
    before, pixels = files(out), parts_of(os.path.join(out, "frames/000001.exr"))
    done = t.run_headless(
        BLEND, "--out", out, "--frames", "1-2", "--passes", "object", "--truth-samples", "2", "--json"
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    events = [json.loads(line) for line in done.stdout.splitlines() if line.startswith("{")]
    said = next(event for event in events if event["event"] == "missing")
    assert said["kept"]["frames"] == 2 and said["kept"]["truth"] == 2, said
    assert said["kept"]["frames_passes"] == ["color", "depth", "normal"], said
    assert said["render"] == [
        {"kind": "frames", "pictures": 2, "passes": ["object"], "adds": True}
    ], said
    assert "object for 2 frames" in said["text"] and "kept: 2 frames" in said["text"], said
    # Nothing but the pass was made; the leading frame, by which a reader knows the passes, comes last.
    made = [event for event in events if event["event"] in ("frame", "truth", "centre")]
    assert [event["frame"] for event in made] == [2, 1], made
    for event in made:
        assert set(event["passes"]["seconds"]) == {"object", "write"}, event
        assert set(event["passes"]["bytes"]) == {"object"}, event
    after = files(out)
    for name in before:
        if name.startswith("truth"):
            assert after[name] == before[name]
            continue
        # What is compressed is found again as it was, block by block.
        assert len(after[name]) > len(before[name])
        old, new = storing_blocks(before[name]), storing_blocks(after[name])
        assert old == {part: blocks for part, blocks in new.items() if part in old}
    for part, channels in parts_of(os.path.join(out, "frames/000001.exr")).items():
        for channel, plane in channels.items() if part in pixels else ():
            assert np.array_equal(plane, pixels[part][channel]), (part, channel)


def storing_blocks(content: bytes) -> dict[str, list]:
    """Header and compressed blocks of every part, by the part's name."""
    from aa_resolve import exr

    parts, _ = exr._stored_in(memoryview(content))
    return {part.name: [part.header, *part.blocks] for part in parts}


def test_what_is_no_longer_wanted_stays() -> None:
    out = os.path.join(FOLDER, "kept")
    exported(out, "--frames", "1-3", *BOTH_KINDS, "--passes", "object", "--truth-samples", "4")
    before = files(out)
    shot = exported(out, "--frames", "1", "--for", "noaa", "--truth-samples", "2")
    assert files(out) == before
    assert len(shot["frames"]) == 3 and shot["truth"]["samples_per_half"] == 4
    assert set(shot["methods"]) == {"taaSimplest", "fxaa311", "noaa"}
    # A frame that is added later gets what the shot has.
    exported(out, "--frames", "4", "--truth-frames", "none")
    assert t.part_names(os.path.join(out, "frames/000004.exr")) == t.part_names(
        os.path.join(out, "frames/000001.exr")
    )
    assert os.path.exists(os.path.join(out, "centre/000004.exr"))


def test_truth_of_more_samples() -> None:
    out = os.path.join(FOLDER, "truth")
    exported(out, "--frames", "1-2", "--truth-samples", "2")
    before = files(out)
    said = lacking(out, "--frames", "1-2", "--truth-samples", "8")
    assert "2 truths again with more samples" in said.sentence(), said.sentence()
    assert [(item.kind, item.number) for item in said.work] == [("truth", 1), ("truth", 2)]
    shot = exported(out, "--frames", "1-2", "--truth-samples", "8")
    assert shot["truth"]["samples_per_half"] == 8
    for name, content in files(out).items():
        assert (content == before[name]) == name.startswith("frames"), name
    fresh = os.path.join(FOLDER, "truth_fresh")
    exported(fresh, "--frames", "1-2", "--truth-samples", "8")
    assert_same_shot(fresh, out)


def test_another_pattern_renders_subsamples_alone() -> None:
    out, fresh = os.path.join(FOLDER, "pattern"), os.path.join(FOLDER, "pattern_fresh")
    passes = ("--passes", "subsamples,object", "--truth-frames", "none")
    exported(out, "--frames", "1-3", *passes, "--subsamples", "d3d4")
    before = {number: parts_of(os.path.join(out, f"frames/00000{number}.exr")) for number in (1, 3)}
    # Without a word about the pattern the shot's own stays.
    assert not lacking(out, "--frames", "1-3", *passes).work
    try:
        lacking(out, "--frames", "1-3", "--for", "rsaa:S=8")
        raise SystemExit("methods that the pattern does not serve must be refused")
    except UsageError as error:
        assert "d3d4" in str(error) and "--subsamples d3d8" in str(error), error
    exported(out, "--frames", "1", *passes, "--subsamples", "d3d2")
    exported(fresh, "--frames", "1-3", *passes, "--subsamples", "d3d2")
    assert_same_shot(fresh, out)
    for number, parts in before.items():
        after = parts_of(os.path.join(out, f"frames/00000{number}.exr"))
        for name in ("color", "object"):
            for channel, plane in parts[name].items():
                assert np.array_equal(plane, after[name][channel]), (number, name, channel)


def test_killed_at_any_step_of_an_addition() -> None:
    """A process that dies while a picture takes its place leaves the old one or the new one, with its record."""
    out = os.path.join(FOLDER, "dies")
    exported(out, "--frames", "1-3", "--passes", "depth", "--truth-frames", "none")
    replace, calls = os.replace, []

    class Died(BaseException):
        pass

    steps = 0
    while True:
        steps += 1
        calls.clear()

        def dying(source, target) -> None:
            calls.append(target)
            if len(calls) == steps:
                raise Died
            replace(source, target)

        os.replace = dying
        try:
            exported(out, "--frames", "1-3", "--passes", "object", "--truth-frames", "none")
            break
        except Died:
            pass
        finally:
            os.replace = replace
        assert_is_valid(out)
        held = storing.Store(out, 1.0).stored()
        assert sorted(held.records["frames"]) == [1, 2, 3], (steps, calls[-1])
        for number, record in held.records["frames"].items():
            there = t.part_names(os.path.join(out, f"frames/00000{number}.exr"))
            assert set(there) == set(record["passes"]), (steps, number, there, record["passes"])
    assert steps > 6, "each addition has several steps, and each of them was the last once"
    fresh = os.path.join(FOLDER, "dies_fresh")
    exported(fresh, "--frames", "1-3", "--passes", "depth,object", "--truth-frames", "none")
    assert_same_shot(fresh, out)


def test_kill_of_a_process_that_adds() -> None:
    out = os.path.join(FOLDER, "killed")
    exported(out, "--frames", "1-4", "--passes", "depth", "--truth-frames", "none")
    options = ("--out", out, "--frames", "1-4", "--passes", "subsamples", "--truth-frames", "none")
    process = subprocess.Popen(
        t.blender_command(BLEND, *options, "--json"), stdout=subprocess.PIPE, text=True
    )
    for line in process.stdout:
        if '"event": "frame"' in line:
            break
    process.send_signal(signal.SIGKILL)
    process.wait()
    process.stdout.close()
    assert_is_valid(out)
    done = t.run_headless(BLEND, *options, "--json")
    assert done.returncode == 0, done.stderr
    end = next(json.loads(line) for line in done.stdout.splitlines() if '"event": "done"' in line)
    assert 0 < end["rendered"] < 4, "what had been added before stays"
    assert not [name for _, _, names in os.walk(out) for name in names if ".tmp" in name]
    fresh = os.path.join(FOLDER, "killed_fresh")
    exported(fresh, "--frames", "1-4", "--passes", "depth,subsamples", "--truth-frames", "none")
    assert_same_shot(fresh, out)


def test_two_processes_add() -> None:
    """Two that add the same share the frames; two that add different passes leave a valid shot with both."""
    out, fresh = os.path.join(FOLDER, "two"), os.path.join(FOLDER, "two_fresh")
    none = ("--truth-frames", "none")
    exported(out, "--frames", "1-4", *none)
    for wishes in (("object", "object"), ("depth", "normal")):
        processes = [
            subprocess.Popen(
                t.blender_command(BLEND, "--out", out, "--frames", "1-4", "--passes", name, *none, "--json"),
                stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
            )
            for name in wishes
        ]  # fmt: skip
        rendered = 0
        for process in processes:
            output, errors = process.communicate(timeout=120)
            assert process.returncode == 0, errors
            rendered += sum(json.loads(x)["rendered"] for x in output.splitlines() if '"done"' in x)
        assert_is_valid(out)
        if wishes[0] == wishes[1]:
            assert rendered == 4, f"every picture is made once, {rendered} were made"
    exported(out, "--frames", "1-4", "--passes", "depth,normal,object", *none)
    exported(fresh, "--frames", "1-4", "--passes", "depth,normal,object", *none)
    assert_same_shot(fresh, out)


@contextmanager
def another_file(name: str) -> Iterator[tuple[bpy.types.Scene, bpy.types.Object]]:
    """Within this the tests' .blend is another one: a cube in the sun, to be keyed and saved."""
    global BLEND
    before, BLEND = BLEND, os.path.join(FOLDER, name)
    try:
        scene = t.new_scene(32, 20)
        t.add_camera(scene)
        t.add_sun(scene)
        yield scene, t.add_object(scene, "Cube", None, (0, 0, 0.5), (0.2, 0.3, 0.4))
    finally:
        BLEND = before


def test_a_static_shot_is_added_to() -> None:
    """Its one truth and its one centre picture are added once, and motion never is."""
    with another_file("static.blend") as (scene, _):
        t.save(scene, BLEND)
        out, fresh = os.path.join(FOLDER, "static"), os.path.join(FOLDER, "static_fresh")
        wish = (*BOTH_KINDS, "--passes", "object,motion", "--truth-samples", "4")
        exported(out, "--frames", "1-3", "--for", "taaSimplest", "--truth-frames", "none")
        said = lacking(out, "--frames", "1-4", *wish)
        kinds = [(item.kind, item.number) for item in said.work]
        assert sorted(kinds) == [
            ("centre", 1), ("frames", 1), ("frames", 2), ("frames", 3), ("frames", 4), ("truth", 1)
        ], kinds  # fmt: skip
        exported(out, "--frames", "1-4", *wish)
        exported(fresh, "--frames", "1-4", *wish)
        assert_same_shot(fresh, out)


def test_a_trial_is_extended() -> None:
    """From rest into motion and from motion into rest: the shot is that of all its frames at once."""
    with another_file("starts.blend") as (scene, item):
        t.key(item, "location", {3: (0, 0, 0.5), 5: (1, 0, 0.5), 9: (1, 0, 0.5)})
        for curve in t.curves_of(item):
            curve.extrapolation = "CONSTANT"
        t.save(scene, BLEND)
        wish = (*BOTH_KINDS, "--passes", "object", "--truth-samples", "4")
        for trial, static, whole in (
            ("1-3", True, "1-5"),
            ("1", False, "1-3"),
            ("5", False, "5-8"),
        ):
            out = os.path.join(FOLDER, f"trial{trial}")
            assert exported(out, "--frames", trial, *wish)["static"] == static
            said = lacking(out, "--frames", whole, "--truth-samples", "4")
            assert not said.changed and ("if something moves" in said.sentence()) == static, said
            shot = exported(out, "--frames", whole, "--truth-samples", "4")
            assert not shot["static"]
            if static:
                exported(f"{out}_fresh", "--frames", whole, *wish)
                assert_same_shot(f"{out}_fresh", out)
            else:
                names = t.part_names(os.path.join(out, shot["frames"][-1]["file"]))
                assert "motion" in names, names
                assert len({entry["truth"] for entry in shot["frames"]}) == len(shot["frames"])
            assert_is_valid(out)


def test_a_shot_that_was_wrongly_at_rest_is_refused() -> None:
    """Its frames show the first one: they cannot be those of a shot that moves."""
    out = os.path.join(FOLDER, "wrong_rest")
    exported(out, "--frames", "2-3", "--truth-frames", "none")
    path = os.path.join(out, ".aa", "settings.json")
    held = storing._read_json(path)
    held["content"]["static"] = True
    storing.write_json(path, held)
    before = files(out)
    try:
        exported(out, "--frames", "2-4", "--truth-frames", "none")
        raise AssertionError("it was added to")
    except UsageError as error:
        assert "show one and the same, and something moves in them" in str(error), error
    assert files(out) == before


def test_what_makes_other_pictures_is_refused() -> None:
    out = os.path.join(FOLDER, "refused")
    exported(out, "--frames", "2-3", "--for", "taaSimplest", "--truth-frames", "none")
    before = files(out)
    for options, expected in (
        (("--samples", "2"), "--samples was 1 and now is 2"),
        (("--resolution", "20x12"), "--resolution was the scene's and now is 20x12"),
        (("--lighting", "as-is"), "--lighting was noise-free"),
        (("--no-instance-ids",), "--no-instance-ids was off and now is on"),
        (("--ambient", "1", "0", "0.5"), "--ambient was the world's mean and now is 1.0,0.0,0.5"),
        (("--jitter", "none"), "--jitter was halton23 and now is none"),
        (("--period", "8"), "--period was 16 and now is 8"),
        (("--source", "another"), "the .blend file, or a script that ran on it, has changed"),
    ):
        wish = ("--frames", "2-3", "--passes", "object", "--truth-frames", "none", *options)
        assert expected in (lacking(out, *wish).changed or ""), (options, lacking(out, *wish))
        try:
            exported(out, *wish)
            raise SystemExit(f"{options} must be refused")
        except UsageError as error:
            assert expected in str(error) and "--overwrite" in str(error), error
            assert ("--same-scene" in str(error)) == (options[0] == "--source"), error
    wish = ("--frames", "2-3", "--passes", "object", "--truth-frames", "none")
    assert lacking(out, *wish, "--source", "another", "--same-scene").changed is None
    try:
        lacking(out, "--frames", "1-3")
        raise SystemExit("a frame before the jitter's first must be refused")
    except UsageError as error:
        assert "begins with frame 2" in str(error), error
    assert files(out) == before


def test_methods_at_the_centres_have_theirs_beside_a_jitter() -> None:
    """A jitter that is asked for moves no frame of methods that read the pixel centres, as truth is centred, too."""
    plain, both = (os.path.join(FOLDER, name) for name in ("centred", "jittered"))
    wish = ("--frames", "1", "--for", "fxaa311,gbaa", "--truth-frames", "none")
    exported(plain, *wish)
    shot = exported(both, *wish, "--jitter", "halton23")
    entry = shot["frames"][0]
    assert entry["jitter"] != [0, 0] and entry["centre"] == "centre/000001.exr", entry
    for part in ("color", "edges"):
        ours = t.read_part(os.path.join(both, entry["centre"]), part)
        theirs = t.read_part(os.path.join(plain, "frames/000001.exr"), part)
        for channel, pixels in theirs.items():
            assert np.array_equal(ours[channel], pixels), (part, channel)


def test_an_option_younger_than_the_shot_is_at_its_default() -> None:
    """A shot begun before an option existed is resumed where the option keeps its default, and refused elsewhere."""
    out = os.path.join(FOLDER, "older")
    wish = ("--frames", "1", "--for", "taaSimplest", "--truth-frames", "none")
    exported(out, *wish)
    path = os.path.join(out, ".aa", "settings.json")
    with open(path, encoding="utf-8") as file:
        stored = json.load(file)
    for young in ("texture_filter", "mip_bias", "unjitter_textures", "scene"):
        del stored["content"][young]
    storing.write_json(path, stored)
    before = files(out)
    assert lacking(out, *wish).changed is None
    exported(out, "--frames", "1-2", *wish[2:])
    assert files(out).keys() > before.keys() and before.items() <= files(out).items()
    changed = lacking(out, *wish, "--texture-filter", "mip").changed or ""
    assert changed == "--texture-filter was none and now is mip", changed


def test_another_scene_of_the_file_is_refused() -> None:
    """A shot is of one scene. One that does not name its scene goes on where the file holds no other that could be meant,
    and else where the user vouches."""
    blend, out = (os.path.join(FOLDER, name) for name in ("two.blend", "one_of_two"))
    first = t.new_scene(8, 8)
    first.name = "First"
    t.add_camera(first)
    second = bpy.data.scenes.new("Second")
    second.camera = first.camera
    t.save(first, blend)
    wish = ("--out", out, "--frames", "1", "--truth-frames", "none")

    def refused(scene: str, *options: str) -> str:
        bpy.ops.wm.open_mainfile(filepath=blend)
        bpy.context.window.scene = bpy.data.scenes[scene]
        bpy.context.scene.render.engine = "CYCLES"
        try:
            t.export(*wish[1:], *options)
        except UsageError as error:
            return str(error)
        return ""

    assert refused("First") == "" and refused("First") == ""
    before = files(out)
    for options in ((), ("--same-scene",)):
        told = refused("Second", *options)
        assert "the scene was First and now is Second; choose" in told, told
        assert "--same-scene" not in told, told
    path = os.path.join(out, ".aa", "settings.json")
    with open(path, encoding="utf-8") as file:
        stored = json.load(file)
    assert stored["content"].pop("scene") == "First"
    storing.write_json(path, stored)
    for scene in ("First", "Second"):
        told = refused(scene)
        assert "which scene" in told and "--same-scene where it shows this one" in told, told
    assert refused("First", "--same-scene") == "" and files(out) == before


if __name__ == "__main__":
    t.main(
        test_added_step_by_step_is_exported_at_once,
        test_old_parts_are_copied_bit_for_bit,
        test_what_is_no_longer_wanted_stays,
        test_truth_of_more_samples,
        test_another_pattern_renders_subsamples_alone,
        test_killed_at_any_step_of_an_addition,
        test_kill_of_a_process_that_adds,
        test_two_processes_add,
        test_a_static_shot_is_added_to,
        test_a_trial_is_extended,
        test_a_shot_that_was_wrongly_at_rest_is_refused,
        test_what_makes_other_pictures_is_refused,
        test_methods_at_the_centres_have_theirs_beside_a_jitter,
        test_an_option_younger_than_the_shot_is_at_its_default,
        test_another_scene_of_the_file_is_refused,
    )
