# SPDX-License-Identifier: GPL-3.0-or-later
"""Whatever the user's render settings are, the shot is the same: each is handled, or refused with a sentence."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402


def exported(*options: str) -> tuple[dict, str]:
    out = os.path.join(t.temporary_folder(), "shot")
    return t.export(out, *options), out


def moving_cube(width: int = 48, height: int = 27):
    scene = t.new_scene(width, height)
    camera = t.add_camera(scene)
    t.add_sun(scene)
    item = t.add_object(scene, "Cube", None, (0, 0, 0.5), (0.2, 0.3, 0.4))
    item.data.materials.append(t.diffuse("Colour", (0.3, 0.5, 0.7)))
    t.key(item, "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    return scene, camera


def use_everything(scene, camera) -> None:
    """Every setting of a production render that a shot must not carry."""
    render, cycles = scene.render, scene.cycles
    render.use_motion_blur, render.motion_blur_shutter = True, 1.0
    camera.data.dof.use_dof, camera.data.dof.aperture_fstop = True, 0.2
    camera.data.dof.focus_distance = 2.0
    cycles.use_denoising = cycles.use_adaptive_sampling = True
    cycles.samples, cycles.pixel_filter_type, cycles.filter_width = 512, "GAUSSIAN", 4.0
    cycles.use_animated_seed, cycles.time_limit = True, 0.001
    render.use_freestyle = True
    render.film_transparent = False
    scene.view_settings.exposure, scene.view_settings.gamma = 3.0, 0.5
    render.use_stamp = True
    scene.view_layers[0].samples = 7
    switches = {  # what some versions have
        cycles: {
            "use_guiding": True,
            "use_pixel_jitter": True,
            "use_sample_subset": True,
            "sample_offset": 7,
            "sample_subset_length": 3,
            "scrambling_distance": 0.2,
            "auto_scrambling_distance": True,
            "use_light_tree": False,
            "direct_light_sampling_type": "FORWARD_PATH_TRACING",
        },
        render: {"use_texture_cache": True, "use_auto_generate_texture_cache": False},
    }
    for owner, values in switches.items():
        for name, value in values.items():
            if hasattr(owner, name):
                setattr(owner, name, value)
    for pattern in ("SOBOL", "SOBOL_BURLEY", "BLUE_NOISE"):
        try:
            cycles.sampling_pattern = pattern
        except TypeError:
            pass  # not in this version
    layer = scene.view_layers[0]
    for owner in (layer, layer.cycles):
        for name in owner.bl_rna.properties.keys():
            if name.startswith(("use_pass_", "pass_debug_", "denoising_pass_")):
                setattr(owner, name, True)
    tree = t.compositor_tree(scene)
    layers, invert = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeInvert")
    tree.links.new(layers.outputs["Image"], invert.inputs["Color"])
    if hasattr(scene, "compositing_node_group"):  # since 5.0
        t.add_group_socket(tree, "NodeSocketColor", "Image", True)
        end = tree.nodes.new("NodeGroupOutput")
    else:
        end = tree.nodes.new("CompositorNodeComposite")
    tree.links.new(invert.outputs["Color"], end.inputs["Image"])


def test_nothing_of_a_production_render_is_left() -> None:
    pictures, notes = [], []
    for change in (None, use_everything):
        scene, camera = moving_cube()
        if change:
            change(scene, camera)
        shot, out = exported(
            "--frames", "3-4", "--for", "taaSimplest,rsaa", "--truth-samples", "4", "--truth-frames", "3"
        )  # fmt: skip
        notes.append(" ".join(shot["notes"]))
        content = {}
        for kind in ("frames", "centre", "truth"):
            for name in sorted(os.listdir(os.path.join(out, kind))):
                with open(os.path.join(out, kind, name), "rb") as file:
                    content[f"{kind}/{name}"] = file.read()
        pictures.append(content)
    assert len(pictures[0]) == 5 and set(pictures[0]) == set(pictures[1])
    for name in pictures[0]:
        assert pictures[0][name] == pictures[1][name], f"{name} differs"
    for word in ("motion blur", "depth of field", "denoiser", "compositor", "Freestyle"):
        assert word in notes[1] and word not in notes[0].replace("denoiser", ""), (word, notes)


def test_halves_of_a_truth_share_no_sample() -> None:
    """Cycles puts its first sample of every pixel at the centre, whatever the seed; the truth begins after it."""
    scene = t.new_scene(32, 32)
    camera = t.add_camera(scene, (0, -10, 0), (0, 0, 0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 32.0
    mesh = bpy.data.meshes.new("Wall")
    mesh.from_pydata([(-40, 0, -40), (40, 0, -40), (40, 0, 40), (-40, 0, 40)], [], [(0, 1, 2, 3)])
    material = bpy.data.materials.new("Gradient")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    window = tree.nodes.new("ShaderNodeTexCoord").outputs["Window"]
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(window, emission.inputs["Color"])
    tree.links.new(emission.outputs[0], output.inputs["Surface"])
    mesh.materials.append(material)
    t.add_object(scene, "Wall", mesh)
    _, out = exported("--frames", "1", "--truth-samples", "1", "--jitter", "none")
    path = os.path.join(out, "truth/000001.exr")
    x = (np.arange(32) + 0.5) / 32
    a, b = (32 * (t.read_part(path, half)["R"].astype(np.float64) - x) for half in "ab")
    for offsets in (a, b):  # pixels, from the centres
        assert np.abs(offsets).max() < 0.51 and 0.2 < offsets.std() < 0.35, offsets.std()
        assert (np.abs(offsets) < 1e-3).mean() < 0.05, "samples at the centre"
    assert (
        abs(np.corrcoef(a.ravel(), b.ravel())[0, 1]) < 0.2
    ), "samples of the halves belong together"


def test_working_space_of_the_file() -> None:
    """A file that computes in ACEScg is exported with the same colours, and the shot says so."""
    if not hasattr(bpy.data, "colorspace"):
        return  # before 5.0
    shown = []
    for space in ("Linear Rec.709", "ACEScg"):
        scene, _ = moving_cube()
        bpy.data.objects["Sun"].data.color = (1.0, 0.5, 0.25)
        bpy.ops.wm.set_working_color_space(working_space=space, convert_colors=True)
        shot, out = exported("--frames", "3", "--passes", "albedo", "--truth-frames", "none")
        assert ("ACEScg" in " ".join(shot["notes"])) == (space == "ACEScg"), shot["notes"]
        path = os.path.join(out, "frames/000003.exr")
        color = t.stacked(t.read_part(path, "color"), "R G B")
        albedo = t.stacked(t.read_part(path, "albedo"), "albedo.R albedo.G albedo.B")
        shown.append(np.concatenate([color, albedo]))
    assert np.abs(shown[0] - shown[1]).max() < 1e-4, np.abs(shown[0] - shown[1]).max()
    assert np.abs(albedo.max(axis=(0, 1)) - (0.3, 0.5, 0.7)).max() < 1e-4, albedo.max(axis=(0, 1))


def test_one_of_two_view_layers() -> None:
    """The chosen layer decides what is seen."""
    scene, _ = moving_cube()
    extra = bpy.data.collections.new("Extra")
    scene.collection.children.link(extra)
    extra.objects.link(bpy.data.objects.new("Other", t.cube_mesh("Other", 0.7)))
    extra.objects["Other"].location = (0.5, -2, 1.0)
    second = scene.view_layers.new("Without")
    second.layer_collection.children["Extra"].exclude = True
    shot, _ = exported(
        "--frames", "3", "--passes", "object", "--truth-frames", "none", "--view-layer", "Without"
    )
    assert set(shot["objects"].values()) == {"Cube"}, shot["objects"]
    scene, _ = moving_cube()
    scene.view_layers.new("Second")
    from aa_resolve.errors import SceneError

    try:
        exported("--frames", "3", "--view-layer", "Third", "--truth-frames", "none")
        raise SystemExit("an unknown layer must be refused")
    except SceneError as error:
        assert "no layer 'Third'" in str(error), error


def test_displacement_cutouts_and_bump_reach_the_subsamples() -> None:
    """grid1 has its one sub-sample where the frame has its own: the same geometry, to the bit, or the materials of
    the sub-samples are not those of the frame."""
    for way in ("plain", "displaced", "cut out", "bumped"):
        scene = t.new_scene(48, 32)
        t.add_camera(scene, (0, -8, 3), (0, 0, 0))
        t.add_sun(scene)
        side = 33
        points = [(x / 8 - 2, y / 8 - 2, 0) for x in range(side) for y in range(side)]
        faces = [
            (x * side + y, (x + 1) * side + y, (x + 1) * side + y + 1, x * side + y + 1)
            for x in range(side - 1)
            for y in range(side - 1)
        ]
        mesh = bpy.data.meshes.new("Ground")
        mesh.from_pydata(points, [], faces)
        t.add_object(scene, "Ground", mesh)
        t.add_object(scene, "Below", None, (0, 2, -1), (0, 0, 0), (9, 9, 0.1))
        material = t.diffuse("Rough", (0.5, 0.4, 0.3))
        mesh.materials.append(material)
        tree = material.node_tree
        checker = tree.nodes.new("ShaderNodeTexChecker")
        checker.inputs["Scale"].default_value = 1.5
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Object"], checker.inputs["Vector"])
        output = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeOutputMaterial")
        if way == "displaced":
            t.set_displacement_method(material, "DISPLACEMENT")
            move = tree.nodes.new("ShaderNodeDisplacement")
            move.inputs["Scale"].default_value = 0.5
            tree.links.new(checker.outputs["Fac"], move.inputs["Height"])
            tree.links.new(move.outputs[0], output.inputs["Displacement"])
        if way == "cut out":
            clear, mix = tree.nodes.new("ShaderNodeBsdfTransparent"), tree.nodes.new(
                "ShaderNodeMixShader"
            )
            tree.links.new(checker.outputs["Fac"], mix.inputs[0])
            tree.links.new(clear.outputs[0], mix.inputs[1])
            tree.links.new(output.inputs["Surface"].links[0].from_socket, mix.inputs[2])
            tree.links.new(mix.outputs[0], output.inputs["Surface"])
        if way == "bumped":
            bump = tree.nodes.new("ShaderNodeBump")
            tree.links.new(checker.outputs["Fac"], bump.inputs["Height"])
            shader = next(n for n in tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse")
            tree.links.new(bump.outputs[0], shader.inputs["Normal"])
        shot, out = exported(
            "--frames", "1", "--truth-frames", "none", "--passes", "depth,normal,object,subsamples,edges",
            "--subsamples", "grid1",
        )  # fmt: skip
        path = os.path.join(out, "frames/000001.exr")
        samples = t.read_part(path, "subsamples")
        depth = t.read_part(path, "depth")["Z"]
        assert np.array_equal(samples["s00.Z"], depth), way
        assert np.array_equal(samples["s00.id"], t.read_part(path, "object")["id"]), way
        assert (samples["mask"] == 1).all(), way
        normal = t.stacked(t.read_part(path, "normal"), "N.X N.Y N.Z")
        apart = np.abs(t.stacked(samples, "s00.N.X s00.N.Y s00.N.Z") - normal).max()
        assert apart < 1e-6, (way, apart)
        if way == "bumped":
            assert (normal[..., 2] < 0.99).any(), "the bump bends normals of the flat ground"
        note = " ".join(shot["notes"])
        assert ("shading of sub-samples" in note) == (way == "plain"), note
        assert ("real materials" in note) == (way != "plain"), note
        assert ("before displacement" in note) == (way == "displaced"), note
        if way == "displaced":
            heights = 1.0 / depth  # a plane is linear in them
            assert np.abs(np.diff(heights, 2, axis=0)).max() > 1e-3, "the ground is displaced"


def test_what_was_left_out_is_one_line() -> None:
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    for index in range(2):
        t.add_sun(scene, rotation=(0.6, 0.2, index))
    t.add_object(scene, "Cube")
    shot, _ = exported(
        "--frames", "1-2", "--passes", "motion,object,subsamples", "--truth-frames", "none"
    )
    lines = [note for note in shot["notes"] if "left out" in note]
    assert len(lines) == 1, shot["notes"]
    for reason in (
        "motion (nothing is animated",
        "shading of sub-samples (override material",
        "emission (no material emits)",
        "background (the scene has no world)",
        "ids of instances (nothing is instanced)",
    ):
        assert reason in lines[0], (reason, lines[0])


def test_costs_of_every_pass() -> None:
    """Seconds and bytes by pass in the manifest, for every part that the files hold."""
    moving_cube()
    shot, out = exported(
        "--frames", "3-4", "--for", "taaSimplest,rsaa,gbaa", "--passes", "segments,object,albedo",
        "--truth-samples", "4", "--truth-frames", "3",
    )  # fmt: skip
    for entry in shot["frames"]:
        parts = t.part_names(os.path.join(out, entry["file"]))
        assert set(parts) <= set(entry["bytes"]), (parts, entry["bytes"])
        size = os.path.getsize(os.path.join(out, entry["file"]))
        assert 0.5 * size < sum(entry["bytes"][name] for name in parts) < size
        assert entry["bytes"]["centre"] > 0 and entry["render_seconds"]["centre.color"] > 0
        assert {"color", "motion", "segments", "write"} <= set(entry["render_seconds"])
    assert shot["frames"][0]["bytes"]["truth"] > 0 and "truth" not in shot["frames"][1]["bytes"]


def test_light_as_it_is() -> None:
    """Without noise-free light colour and truth show the scene's own light: soft sun, world, bounces."""

    def make():
        scene = t.new_scene(24, 16)
        t.add_camera(scene, (0, -8, 5), (0, 0, 0.5), 60)
        t.add_sun(scene, strength=2.0).data.angle = 0.2
        mesh = bpy.data.meshes.new("Floor")
        mesh.from_pydata([(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)], [], [(0, 1, 2, 3)])
        t.add_object(scene, "Floor", mesh).data.materials.append(t.diffuse("Red", (0.7, 0.2, 0.1)))
        world = bpy.data.worlds.new("World")
        world.use_nodes = True
        world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.3, 0.4, 0.6, 1)
        scene.world = world
        scene.cycles.max_bounces = 4

    make()
    shot, out = exported(
        "--frames", "1", "--lighting", "as-is", "--samples", "256", "--truth-samples", "256",
        "--jitter", "none",
    )  # fmt: skip
    color = t.stacked(t.read_part(os.path.join(out, "frames/000001.exr"), "color"), "R G B")
    truth = t.stacked(t.read_part(os.path.join(out, "truth/000001.exr"), "a"), "R G B")
    error = np.abs(color.mean(axis=(0, 1)) / truth.mean(axis=(0, 1)) - 1).max()
    assert error < 0.02, f"colour and truth differ by {error:.3f}"
    note = " ".join(shot["notes"])
    assert "sun 'Sun' with an angle of 11 degrees (soft shadows)" in note, note
    assert "light from the world" in note and "indirect light" in note, note
    make()
    _, other = exported("--frames", "1", "--truth-frames", "none", "--jitter", "none")
    plain = t.stacked(t.read_part(os.path.join(other, "frames/000001.exr"), "color"), "R G B")
    assert np.abs(plain.mean(axis=(0, 1)) / color.mean(axis=(0, 1)) - 1).max() < 0.15, "a like look"


if __name__ == "__main__":
    t.main(
        test_nothing_of_a_production_render_is_left,
        test_halves_of_a_truth_share_no_sample,
        test_working_space_of_the_file,
        test_one_of_two_view_layers,
        test_displacement_cutouts_and_bump_reach_the_subsamples,
        test_what_was_left_out_is_one_line,
        test_costs_of_every_pass,
        test_light_as_it_is,
    )
