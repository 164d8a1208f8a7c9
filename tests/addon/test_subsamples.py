# SPDX-License-Identifier: GPL-3.0-or-later
"""Sub-samples: several views in one render equal separate renders; the mask agrees with ids and SADP."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve import jitter  # noqa: E402


def scene_with_edges(width: int = 48, height: int = 32):
    scene = t.new_scene(width, height)
    t.add_camera(scene, (0, -8, 2), (0, 0, 0.5))
    t.add_sun(scene)
    random = np.random.default_rng(3)
    for index in range(14):
        place = (random.uniform(-3, 3), random.uniform(-1, 3), random.uniform(-1, 2.5))
        item = t.add_object(
            scene,
            f"Cube {index}",
            None,
            place,
            random.uniform(0, 3, 3),
            random.uniform(0.2, 1.0, 3),
        )
        item.data.materials.append(t.diffuse(f"Colour {index}", random.uniform(0.1, 0.9, 3)))
    return scene


def exported(*options: str) -> tuple[dict, dict[str, np.ndarray], str]:
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(out, "--frames", "1", "--truth-frames", "none", *options)
    path = os.path.join(out, "frames/000001.exr")
    return shot, t.read_part(path, "subsamples"), path


def rendered_at(offset: tuple[float, float]) -> str:
    """Path of a plain frame of the same scene, one sample per pixel at ``offset``."""
    scene_with_edges()
    original = jitter.jitter_at
    jitter.jitter_at = lambda *_arguments: offset
    try:
        out = os.path.join(t.temporary_folder(), "single")
        t.export(out, "--frames", "1", "--truth-frames", "none", "--passes", "depth,normal,object")
    finally:
        jitter.jitter_at = original
    return os.path.join(out, "frames/000001.exr")


def test_views_equal_separate_renders() -> None:
    """Sub-sample k of a frame is the frame rendered at jitter + position k, to the bit; at the centres jitter is 0."""
    for sequence in ("none", "halton23"):
        scene_with_edges()
        shot, samples, _ = exported(
            "--passes", "subsamples,subsampleColor", "--subsamples", "d3d4", "--jitter", sequence
        )
        assert shot["subsamples"]["pattern"] == "d3d4"
        assert shot["subsamples"]["positions"] == [
            list(pair) for pair in jitter.pattern_positions("d3d4")
        ]
        jitter_x, jitter_y = shot["frames"][0]["jitter"]
        assert (sequence == "none") == (jitter_x == jitter_y == 0.0)
        for index, (x, y) in enumerate(shot["subsamples"]["positions"]):
            path = rendered_at((jitter_x + x, jitter_y + y))
            view = f"s{index:02d}"
            pairs = [
                (samples[f"{view}.Z"], t.read_part(path, "depth")["Z"]),
                (samples[f"{view}.id"], t.read_part(path, "object")["id"]),
            ]
            normal, color = t.read_part(path, "normal"), t.read_part(path, "color")
            pairs += [(samples[f"{view}.{axis}"], normal[axis]) for axis in ("N.X", "N.Y", "N.Z")]
            pairs += [(samples[f"{view}.{axis}"], color[axis]) for axis in "RGB"]
            for one, other in pairs:
                assert one.dtype == other.dtype and np.array_equal(one, other), (sequence, view)
    wrong = rendered_at(tuple(shot["subsamples"]["positions"][0]))
    assert not np.array_equal(samples["s00.id"], t.read_part(wrong, "object")["id"]), "can fail"


def test_jittered_and_centre_frames() -> None:
    """One shot for both kinds of methods: sub-samples of the centre frame lie at the positions themselves."""
    scene_with_edges()
    out = os.path.join(t.temporary_folder(), "shot")
    shot = t.export(out, "--frames", "1-2", "--truth-frames", "none", "--for", "t2msaa,ssaa")
    assert shot["subsamples"]["pattern"] == "d3d8" and shot["static"]
    entry = shot["frames"][1]
    assert entry["jitter"] != [0.0, 0.0] and entry["centre"] == "centre/000001.exr"
    x, y = shot["subsamples"]["positions"][5]
    for file, offset in (
        (entry["centre"], (x, y)),
        (entry["file"], (entry["jitter"][0] + x, entry["jitter"][1] + y)),
    ):
        color = t.read_part(rendered_at(offset), "color")
        samples = t.read_part(os.path.join(out, file), "subsamples")
        assert np.array_equal(samples["s05.R"], color["R"]), file


def test_names_of_cameras_do_not_matter() -> None:
    """Each camera's views lie at their places, however long its name and however like the name of another one."""

    def ids_by_name(*names: str) -> list[np.ndarray]:
        scene = scene_with_edges()
        for frame, name in enumerate(names, 1):
            camera = t.add_camera(scene, (2 * frame - 3, -8, 2), (0, 0, 0.5))
            camera.name = name
            assert camera.name == name
            scene.timeline_markers.new(name, frame=frame).camera = camera
        frames = ("--frames", f"1-{len(names)}", "--truth-frames", "none")
        out = os.path.join(t.temporary_folder(), "shot")
        options = ("--passes", "object,subsamples", "--subsamples", "d3d2")
        shot = t.export(out, *frames, *options)
        parts = [t.read_part(os.path.join(out, e["file"]), "subsamples") for e in shot["frames"]]
        return [part[f"s{view:02d}.id"] for part in parts for view in (0, 1)]

    # 63 bytes, the most that Blender takes; they begin with the same 20 characters.
    alike = [("\u30ab" * 21)[:-1] + last for last in "\u30e1\u30e9"]
    found, wanted = ids_by_name(*alike), ids_by_name("Y", "Z")  # ids follow the names' order
    assert all(np.array_equal(*pair) for pair in zip(found, wanted))
    assert len({ids.tobytes() for ids in wanted}) == 4, "can fail"


def test_methods_choose_the_pattern() -> None:
    from aa_resolve import registry
    from aa_resolve.errors import UsageError

    def chosen(text: str, asked: str | None = None) -> str | None:
        return registry.pattern_from(registry.parse_choices([text]), asked)

    assert chosen("smaaS2x") == "d3d2" and chosen("smaa4x") == "d3d4"
    assert chosen("smaa4x,smaaS2x") == "d3d2", "which serves both"
    assert chosen("rsaa") is None and chosen("rsaa", "d3d16") == "d3d16"
    assert chosen("rsaa:S=4,smaa4x") == "d3d4"
    for text, asked in (("smaaS2x,rsaa:S=8", None), ("smaaS2x", "d3d8")):
        try:
            chosen(text, asked)
            raise SystemExit(f"{text} {asked} must be refused")
        except UsageError as error:
            assert "smaaS2x wants d3d2" in str(error), error


def test_override_keeps_the_geometry() -> None:
    """Without colour the override material is used; depth, normals and ids stay the same."""
    scene_with_edges()
    _, plain, path = exported("--passes", "subsamples", "--subsamples", "d3d2")
    scene_with_edges()
    _, shaded, _ = exported("--passes", "subsamples,subsampleColor", "--subsamples", "d3d2")
    assert "s00.R" not in plain and "s00.R" in shaded
    for name in plain:
        if ".N." in name:  # rounded elsewhere in the shader: the last bit may differ
            assert np.abs(plain[name] - shaded[name]).max() < 1e-6, name
        else:
            assert np.array_equal(plain[name], shaded[name]), name
    scene_with_edges()
    only_color = exported("--passes", "subsampleColor", "--subsamples", "d3d2")[1]
    assert sorted(only_color) == ["s00.B", "s00.G", "s00.R", "s01.B", "s01.G", "s01.R"]


def scalar_mask(centre, others) -> int:
    """The clustering of RSAA (decisions 32), one pixel, step by step."""

    def dissimilarity(a, b) -> float:
        if a["id"] != b["id"]:
            return 2.0
        if a["id"] == 0:
            return 0.0
        offset = b["point"] - a["point"]
        distance = float(np.linalg.norm(offset))
        if distance < 1e-6 * max(1.0, a["depth"]):
            return 1.0 - float(a["normal"] @ b["normal"])
        direction = offset / distance
        return abs(float(a["normal"] @ direction)) + abs(float(b["normal"] @ direction))

    distances = [dissimilarity(centre, other) for other in others]
    largest = max(distances)
    if largest < 0.2:
        return (1 << len(others)) - 1
    similar = [value <= largest / 2 for value in distances]
    near = [0.0] + [value for value, bit in zip(distances, similar) if bit]
    far = [value for value, bit in zip(distances, similar) if not bit]
    mean_near, mean_far = sum(near) / len(near), sum(far) / len(far)
    return sum(
        1 << k
        for k, value in enumerate(distances)
        if abs(value - mean_near) <= abs(value - mean_far)
    )


def test_mask() -> None:
    from aa_resolve.passes import surface_mask

    scene = scene_with_edges()
    projection = t.Projection(scene.camera, 48, 32)
    pixels, surface_mask._BAND_PIXELS = (
        surface_mask._BAND_PIXELS,
        5 * 48,
    )  # six bands and a smaller one
    try:
        shot, samples, path = exported(
            "--passes", "subsamples,depth,normal,object", "--subsamples", "d3d8"
        )
    finally:
        surface_mask._BAND_PIXELS = pixels
    mask = samples["mask"]
    assert mask.dtype == np.uint32
    depth, ids = t.read_part(path, "depth")["Z"], t.read_part(path, "object")["id"]
    normal = t.stacked(t.read_part(path, "normal"), "N.X N.Y N.Z")
    jittered = shot["frames"][0]["jitter"]

    def record(row, column, offset, z, n, identity):
        point = projection.unproject(
            np.array([column + 0.5 + offset[0]]),
            np.array([row + 0.5 + offset[1]]),
            np.array([float(z)]),
        )[0]
        return {
            "point": point,
            "normal": n.astype(np.float64),
            "id": int(identity),
            "depth": float(z),
        }

    different = 0
    for row in range(32):
        for column in range(48):
            centre = record(
                row, column, jittered, depth[row, column], normal[row, column], ids[row, column]
            )
            others = []
            for k, position in enumerate(shot["subsamples"]["positions"]):
                offset = (jittered[0] + position[0], jittered[1] + position[1])
                n = np.array([samples[f"s{k:02d}.N.{axis}"][row, column] for axis in "XYZ"])
                others.append(
                    record(
                        row,
                        column,
                        offset,
                        samples[f"s{k:02d}.Z"][row, column],
                        n,
                        samples[f"s{k:02d}.id"][row, column],
                    )
                )
            different += scalar_mask(centre, others) != int(mask[row, column])
    partial = (mask != 255).mean()
    assert 0.1 < partial < 0.9, partial
    assert different == 0, f"{different} masks differ"


def test_cutouts_use_real_materials() -> None:
    """Leaves with holes: depth and ids of sub-samples see through the holes."""
    scene = t.new_scene(48, 32)
    t.add_camera(scene, (0, -8, 0), (0, 0, 0))
    t.add_sun(scene)
    wall = t.add_object(scene, "Wall", None, (0, 3, 0), (0, 0, 0), (9, 0.1, 9))
    wall.data.materials.append(t.diffuse("Grey", (0.5, 0.5, 0.5)))
    mesh = bpy.data.meshes.new("Leaf")
    mesh.from_pydata([(-2, 0, -2), (2, 0, -2), (2, 0, 2), (-2, 0, 2)], [], [(0, 1, 2, 3)])
    leaf = t.add_object(scene, "Leaf", mesh)
    material = bpy.data.materials.new("Holes")
    material.use_nodes = True
    tree = material.node_tree
    checker = tree.nodes.new("ShaderNodeTexChecker")
    checker.inputs["Scale"].default_value = 2.0
    coordinates = tree.nodes.new("ShaderNodeTexCoord")
    tree.links.new(coordinates.outputs["Generated"], checker.inputs["Vector"])
    tree.links.new(checker.outputs["Fac"], tree.nodes["Principled BSDF"].inputs["Alpha"])
    leaf.data.materials.append(material)
    shot, samples, path = exported(
        "--passes", "subsamples,object,depth", "--subsamples", "d3d2", "--jitter", "none"
    )
    names = {name: int(key) for key, name in shot["objects"].items()}
    ids = samples["s00.id"]
    inside = np.zeros(ids.shape, bool)
    inside[10:22, 18:30] = True
    share = (ids[inside] == names["Leaf"]).mean()
    assert 0.3 < share < 0.7, f"the leaf covers {share:.2f} of its area"
    assert any("cut-outs" in note for note in shot["notes"])
    assert (samples["s00.Z"][ids == names["Wall"]] > 9).all() and (
        samples["s00.Z"][ids == names["Leaf"]] < 9
    ).all()


def test_cutouts_are_found_wherever_they_come_from() -> None:
    """Given by nodes, by the view layer, by an animated alpha, by an object that appears; and what has a volume but no
    surface. The sub-sample at the pixel's centre shows what the frame shows."""

    def clear():
        material = bpy.data.materials.new("Clear")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        shader = tree.nodes.new("ShaderNodeBsdfTransparent")
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
        return material

    def by_nodes(_scene, pane):
        tree = t.geometry_group("Paint")
        paint = tree.nodes.new("GeometryNodeSetMaterial")
        paint.inputs["Material"].default_value = clear()
        tree.links.new(tree.nodes["Start"].outputs[0], paint.inputs["Geometry"])
        tree.links.new(paint.outputs[0], tree.nodes["End"].inputs[0])
        pane.modifiers.new("Paint", "NODES").node_group = tree

    def by_the_view_layer(scene, _pane):
        scene.view_layers[0].material_override = clear()

    def by_animation(_scene, pane):
        material = bpy.data.materials.new("Fades")
        material.use_nodes = True
        alpha = material.node_tree.nodes["Principled BSDF"].inputs["Alpha"]
        for frame, value in ((2, 0.0), (1, 1.0)):
            alpha.default_value = value
            alpha.keyframe_insert("default_value", frame=frame)
        pane.data.materials.append(material)

    def by_appearing(_scene, pane):
        pane.data.materials.append(clear())
        for frame, hidden in ((2, False), (1, True)):
            pane.hide_render = hidden
            pane.keyframe_insert("hide_render", frame=frame)

    def by_a_volume(_scene, pane):
        material = clear()
        tree = material.node_tree
        output = tree.get_output_node("CYCLES")
        tree.links.remove(output.inputs["Surface"].links[0])
        gas = tree.nodes.new("ShaderNodeVolumeAbsorption")
        tree.links.new(gas.outputs[0], output.inputs["Volume"])
        pane.data.materials.append(material)

    for make in (by_nodes, by_the_view_layer, by_animation, by_appearing, by_a_volume):
        scene = t.new_scene(48, 32)
        t.add_camera(scene, (0, -8, 0), (0, 0, 0))
        t.add_object(scene, "Wall", None, (0, 3, 0), (0, 0, 0), (2, 0.1, 2))
        make(scene, t.add_object(scene, "Pane", None, (0, 0, 0), (0, 0, 0), (1, 0.1, 1)))
        out = os.path.join(t.temporary_folder(), "shot")
        shot = t.export(
            out, "--frames", "1-2", "--truth-frames", "none", "--passes", "subsamples,object,depth",
            "--subsamples", "d3d1", "--jitter", "none",
        )  # fmt: skip
        assert "Pane" not in shot["objects"].values() or make is by_animation, make.__name__
        for entry in shot["frames"]:
            path = os.path.join(out, entry["file"])
            samples = t.read_part(path, "subsamples")
            assert np.array_equal(samples["s00.id"], t.read_part(path, "object")["id"]), (
                make.__name__,
                entry["file"],
            )
            assert np.array_equal(samples["s00.Z"], t.read_part(path, "depth")["Z"]), make.__name__


def test_instanced_leaves_of_a_moving_shot() -> None:
    """Instances of leaves whose outline an image holds, over several frames: every sub-sample shows one leaf, at its
    place, or the wall."""
    for way in ("principled", "mix"):
        scene = t.new_scene(48, 32)
        camera = t.add_camera(scene, (0, -8, 0), (0, 0, 0))
        t.key(camera, "location", {1: (0, -8, 0), 11: (1, -8, 0)})
        t.add_sun(scene)
        wall = t.add_object(scene, "Wall", None, (0, 5, 0), (0, 0, 0), (30, 0.1, 30))
        wall.data.materials.append(t.diffuse("Grey", (0.5, 0.5, 0.5)))
        image = bpy.data.images.new("Outline", 16, 16, alpha=True)
        row, column = np.mgrid[0:16, 0:16] - 7.5
        pixels = np.ones((16, 16, 4), np.float32)
        pixels[..., 3] = row * row + 2 * column * column < 50
        image.pixels.foreach_set(pixels.ravel())
        material = t.diffuse("Leaf", (0.2, 0.5, 0.1))
        tree = material.node_tree
        texture = tree.nodes.new("ShaderNodeTexImage")
        texture.image, texture.interpolation = image, "Closest"
        end = tree.get_output_node("CYCLES")
        if way == "principled":
            shader = tree.nodes.new("ShaderNodeBsdfPrincipled")
            tree.links.new(texture.outputs["Alpha"], shader.inputs["Alpha"])
        else:
            shader, clear = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new(
                "ShaderNodeBsdfTransparent"
            )
            tree.links.new(texture.outputs["Alpha"], shader.inputs[0])
            tree.links.new(clear.outputs[0], shader.inputs[1])
            tree.links.new(end.inputs["Surface"].links[0].from_socket, shader.inputs[2])
        tree.links.new(shader.outputs[0], end.inputs["Surface"])
        mesh = bpy.data.meshes.new("Leaf")
        mesh.from_pydata([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [], [(0, 1, 2, 3)])
        layer = mesh.uv_layers.new(name="UVMap")
        for index, corner in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
            layer.data[index].uv = corner
        mesh.materials.append(material)
        collection = bpy.data.collections.new("Leaves")
        collection.objects.link(bpy.data.objects.new("Leaf", mesh))
        for index in range(3):
            twig = bpy.data.objects.new(f"Twig {index}", None)
            twig.instance_type, twig.instance_collection = "COLLECTION", collection
            twig.location = (1.1 * index - 1.1, 0.5 * index, 0.3 * index)
            scene.collection.objects.link(twig)
        out = os.path.join(t.temporary_folder(), "shot")
        shot = t.export(out, "--frames", "1-3", "--for", "rsaa", "--truth-frames", "none")
        assert len(shot["objects"]) == 4, shot["objects"]
        for entry in shot["frames"]:
            samples = t.read_part(os.path.join(out, entry["file"]), "subsamples")
            for index in range(len(shot["subsamples"]["positions"])):
                ids, depth = samples[f"s{index:02d}.id"], samples[f"s{index:02d}.Z"]
                for identity, name in shot["objects"].items():
                    seen = depth[ids == int(identity)]
                    place = 8.0 + 0.5 * int(name[-1]) if name != "Wall" else 12.95
                    assert len(seen) > 20 and np.abs(seen - place).max() < 1e-4, (way, name)


def test_uint_channels_are_exact() -> None:
    """Ids share a part with floats; every 32-bit value survives, and OpenImageIO reads what this package writes."""
    from aa_resolve import exr

    values = np.array(
        [
            [0, 1, 2, 255],
            [32767, 65536, 16777217, 2147483648],
            [4294967295, 4294967294, 3, 123456789],
        ]
    )
    floats = np.array(
        [[0.1, 1e10, -1.5, 1e-30], [3.0, 7.0, 0.3, 1 / 3], [1e5, -1e10, 2.5, 65504.0]], np.float32
    )
    path = os.path.join(t.temporary_folder(), "mixed.exr")
    halves = np.array([[0.1, 2.0, -3.0, 0.0]] * 3, np.float16)
    noise = np.random.default_rng(1).integers(0, 1 << 32, (37, 5), np.uint32)
    square = np.add.outer(np.arange(37), np.arange(5)).astype(np.float32) / 3
    for compression in exr.COMPRESSIONS:
        small = [
            exr.Part(
                "mixed",
                ("id", "Z", "A"),
                ("uint", "float", "half"),
                [values, floats, halves],
                compression,
            ),
            exr.Part(
                "flat", ("Y", "X"), ("float", "float"), np.ones((3, 4, 2), np.float32), compression
            ),
        ]
        large = [
            exr.Part("noise", ("n",), ("uint",), noise[:, :, None], compression),
            exr.Part("both", ("b", "a"), ("float", "uint"), [square, noise], compression),
        ]
        for chosen in (small, large, small[:1], large[:1]):
            sizes = exr.write_parts(path, chosen)
            assert t.part_names(path) == [part.name for part in chosen] == list(sizes), compression
            assert sum(sizes.values()) < os.path.getsize(path)
            for part in chosen:
                back = t.read_part(path, part.name)  # by OpenImageIO
                for name, plane in zip(part.channels, part.planes()):
                    assert np.array_equal(back[name], plane), (compression, part.name, name)
        own = exr.read_channels(path)
        assert np.array_equal(own["n"], noise), compression


def test_passes_with_and_without_a_copy() -> None:
    """Passes of a render are views of the file where its channels allow; their values are the same either way."""
    from aa_resolve import exr
    from aa_resolve.scene import rendering

    path = os.path.join(t.temporary_folder(), "layers.exr")
    pixels = np.random.default_rng(2).normal(size=(19, 7, 9)).astype(np.float32)
    channels = (
        [f"L.Combined.{c}" for c in "RGBA"] + [f"L.Vector.s01.{c}" for c in "XYZW"] + ["L.Depth.Z"]
    )
    for kind in ("float", "half"):
        for compression in exr.COMPRESSIONS:
            part = exr.Part("", tuple(channels), (kind,) * 9, pixels, compression)
            exr.write_parts(path, [part])
            stored = pixels.astype(np.float16 if kind == "half" else np.float32).astype(np.float32)
            layers = rendering.Layers(rendering._group(exr.read_channels(path), "L", ("s01",)))
            for name, view, right in (
                ("Combined", "", stored[:, :, :4]),
                ("Vector", "s01", stored[:, :, 4:8]),
                ("Depth", "", stored[:, :, 8:]),
            ):
                found = layers.get(name, view)
                assert found.dtype == np.float32 and np.array_equal(found, right), (name, kind)
                plane = layers.planes[name, view][0]
                in_order = name != "Vector"  # W comes before X in a file
                assert np.shares_memory(found, plane) == (kind == "float" and in_order), (
                    name,
                    kind,
                )


if __name__ == "__main__":
    t.main(
        test_uint_channels_are_exact,
        test_passes_with_and_without_a_copy,
        test_views_equal_separate_renders,
        test_jittered_and_centre_frames,
        test_names_of_cameras_do_not_matter,
        test_methods_choose_the_pattern,
        test_override_keeps_the_geometry,
        test_mask,
        test_cutouts_use_real_materials,
        test_cutouts_are_found_wherever_they_come_from,
        test_instanced_leaves_of_a_moving_shot,
    )
