# SPDX-License-Identifier: GPL-3.0-or-later
"""Passes (conventions 3): depth, normals, ids, albedo, colour, truth, and only the parts that are needed."""

from __future__ import annotations

import json
import math
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

ALL = "albedo,depth,normal,object,motion"


def exported(*options: str) -> tuple[dict, str]:
    out = os.path.join(t.temporary_folder(), "shot")
    return t.export(out, *options), out


def floor_scene(kind: str = "PERSP"):
    """A floor of 16 m under the sky."""
    scene = t.new_scene(64, 36)
    camera = t.add_camera(scene, (0, -8, 5), (0, 0, 0.5))
    camera.data.type, camera.data.ortho_scale = kind, 20.0
    camera.data.clip_end = 500.0
    mesh = bpy.data.meshes.new("Floor")
    mesh.from_pydata([(-8, -8, 0), (8, -8, 0), (8, 8, 0), (-8, 8, 0)], [], [(0, 1, 2, 3)])
    floor = t.add_object(scene, "Floor", mesh)
    floor.data.materials.append(t.diffuse("Green", (0.2, 0.6, 0.1)))
    return scene, camera, floor


def test_depth_is_planar() -> None:
    for kind in ("PERSP", "ORTHO"):
        scene, camera, _ = floor_scene(kind)
        projection = t.Projection(camera, 64, 36)
        shot, out = exported("--frames", "3", "--passes", ALL, "--truth-frames", "none")
        path = os.path.join(out, "frames/000003.exr")
        depth = t.read_part(path, "depth")["Z"].astype(np.float64)
        sky = depth >= 1e9
        assert sky.any() and not sky.all() and (depth[sky] == 1e10).all()
        x, y = np.meshgrid(np.arange(64) + 0.5, np.arange(36) + 0.5)
        x, y = x + shot["frames"][0]["jitter"][0], y + shot["frames"][0]["jitter"][1]
        near = projection.unproject(x, y, np.full(x.shape, 1.0))
        far = projection.unproject(x, y, np.full(x.shape, 2.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            expected = 1.0 + near[..., 2] / (
                near[..., 2] - far[..., 2]
            )  # where the ray meets z = 0
        hit = ~sky
        error = np.abs(depth[hit] / expected[hit] - 1.0).max()
        # Planar to 1e-6; an orthographic ray starts at a float position and meets the floor at a slant.
        assert error < (1e-6 if kind == "PERSP" else 2e-6), f"{kind}: relative error {error}"
        projected = np.array(shot["frames"][0]["camera"]["projection"]).reshape(4, 4)
        view = np.array(shot["frames"][0]["camera"]["view"]).reshape(4, 4)
        points = projection.unproject(x[hit], y[hit], depth[hit])
        clip = np.c_[points, np.ones(len(points))] @ view.T @ projected.T
        ndc = clip[:, :3] / clip[:, 3:]
        assert (
            np.abs((ndc[:, 0] + 1) * 32 - x[hit]).max() < 1e-3
        ), "matrices of the manifest carry no jitter"
        assert np.abs((1 - ndc[:, 1]) * 18 - y[hit]).max() < 1e-3
        assert (np.abs(ndc[:, 2]) <= 1.0).all()


def test_normals() -> None:
    scene, camera, floor = floor_scene()
    t.add_object(scene, "Cube", None, (0, -2, 1), (0.3, 0.5, 0.7))
    _, out = exported("--frames", "1", "--passes", ALL, "--truth-frames", "none")
    path = os.path.join(out, "frames/000001.exr")
    normal = t.stacked(t.read_part(path, "normal"), "N.X N.Y N.Z").astype(np.float64)
    ids, depth = t.read_part(path, "object")["id"], t.read_part(path, "depth")["Z"]
    length = np.linalg.norm(normal, axis=-1)
    assert (length[depth >= 1e9] == 0).all() and np.abs(length[depth < 1e9] - 1).max() < 1e-6
    names = t.read_manifest(out)["objects"]
    identity = {name: int(key) for key, name in names.items()}
    assert np.abs(normal[ids == identity["Floor"]] - (0, 0, 1)).max() < 1e-6, "world space"
    axes = np.array(bpy.data.objects["Cube"].matrix_world, np.float64)[:3, :3]
    along = np.abs(normal[ids == identity["Cube"]] @ axes).max(axis=-1)
    assert np.abs(along - 1).max() < 1e-6


def test_ids() -> None:
    scene = t.new_scene()
    t.add_camera(scene)
    shared = t.cube_mesh("Shared", 0.5)
    for index in range(12):
        t.add_object(scene, f"Item {index}", shared, (index % 4 - 1.5, 0, index // 4 * 0.8 - 0.2))
    shot, out = exported("--frames", "1", "--passes", "object", "--truth-frames", "none")
    ids = t.read_part(os.path.join(out, "frames/000001.exr"), "object")["id"]
    assert ids.dtype == np.uint32
    seen = set(np.unique(ids)) - {0}
    assert seen == {int(key) for key in shot["objects"]} and len(seen) == 12
    assert sorted(shot["objects"].values()) == sorted(f"Item {index}" for index in range(12))
    assert (ids == 0).any(), "background is 0"


def test_albedo_recipe() -> None:
    """One material per object against the table of base colours.

    Since 4.0 a Principled shader shares the light among its layers, and rough metal keeps some between its facets: what
    it then shows (second expectation) is the same from 4.3 to 5.2."""

    def principled(name, **values):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        shader = material.node_tree.nodes["Principled BSDF"]
        shader.inputs["Base Color"].default_value = (0.8, 0.4, 0.2, 1)
        for key, value in values.items():
            t.shader_input(shader, key.replace("_", " ")).default_value = value
        return material

    def simple(name, node, **values):
        material = bpy.data.materials.new(name)
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        shader = tree.nodes.new(node)
        for key, value in values.items():
            shader.inputs[key].default_value = value
        output = tree.nodes.new("ShaderNodeOutputMaterial")
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
        return material

    base = (0.8, 0.4, 0.2)
    shared = bpy.app.version >= (4, 0, 0)
    scene = t.new_scene(112, 16)
    glossy = "ShaderNodeBsdfGlossy"
    colour = {"Color": (*base, 1)}
    table = [
        (t.diffuse("Diffuse", base), base, base, 1e-4),
        (principled("Plain", Specular=0.0), base, base, 1e-3),
        (principled("Specular"), (0.84, 0.44, 0.24), (0.8075, 0.4224, 0.2299), 1e-3),
        (principled("Metal", Metallic=1.0, Roughness=0.5), base, (0.7857, 0.3796, 0.1868), 1e-3),
        (principled("Shiny", Metallic=1.0, Roughness=0.2), None, base, 1e-3),
        (principled("Coat", Clearcoat=1.0), (0.84, 0.44, 0.24), (0.8152, 0.4455, 0.2607), 1e-3),
        (principled("Sheen", Sheen=1.0), (0.84, 0.44, 0.24), (0.8111, 0.4332, 0.2443), 1e-3),
        (principled("Skin", Subsurface=0.5), None, (0.8075, 0.4224, 0.2299), 1e-3),
        (principled("Clear", Transmission=1.0), None, (0.8980, 0.6455, 0.4676), 1e-3),
        (
            principled("Glowing", Specular=0.0, Emission=(1, 0.5, 0.25, 1), Emission_Strength=2.0),
            base, base, 1e-3,
        ),
        (simple("Lamp", "ShaderNodeEmission", **colour), base, base, 1e-4),
        (simple("Glossy", glossy, **colour, Roughness=0.5), base, (0.7850, 0.3787, 0.1861), 1e-3),
        (simple("Mirror", glossy, **colour, Roughness=0.0), base, base, 1e-3),
        (simple("Glass", "ShaderNodeBsdfGlass", **colour, Roughness=0.0), base, base, 1e-3),
    ]  # fmt: skip
    camera = t.add_camera(scene, (0, -12, 0), (0, 0, 0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 14.0
    t.add_sun(scene)
    for index, (material, *_) in enumerate(table):
        item = t.add_object(
            scene, material.name, t.cube_mesh(material.name, 0.9), (index - 6.5, 0, 0)
        )
        item.data.materials.append(material)
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (0.2, 0.3, 0.4, 1)
    scene.world = world
    shot, out = exported("--frames", "1", "--passes", "albedo,object", "--truth-frames", "none")
    path = os.path.join(out, "frames/000001.exr")
    albedo = t.stacked(t.read_part(path, "albedo"), "albedo.R albedo.G albedo.B")
    ids = t.read_part(path, "object")["id"]
    names = {name: int(key) for key, name in shot["objects"].items()}
    for material, before, since, tolerance in table:
        expected = since if shared else before
        if expected is None:
            continue
        pixels = albedo[ids == names[material.name]]
        error = np.abs(np.median(pixels, axis=0) - expected).max()
        assert error <= tolerance, f"{material.name}: {np.median(pixels, axis=0)} for {expected}"
    assert np.abs(albedo[ids == 0] - (0.2, 0.3, 0.4)).max() < 1e-4, "background shows the world"


def test_only_what_is_required() -> None:
    scene, _, _ = floor_scene()
    t.add_sun(scene)
    shot, out = exported("--frames", "1-3", "--for", "taaSimplest", "--truth-samples", "4")
    assert shot["static"] is True and any("motion" in note for note in shot["notes"])
    assert t.part_names(os.path.join(out, "frames/000002.exr")) == ["color"]
    assert [entry["truth"] for entry in shot["frames"]] == ["truth/000001.exr"] * 3
    assert os.listdir(os.path.join(out, "truth")) == ["000001.exr"]
    scene, camera, _ = floor_scene()
    t.key(camera, "location", {1: (0, -8, 1), 11: (1.5, -8, 1.4)})
    shot, out = exported(
        "--frames", "1-3", "--for", "taaSimplest", "--truth-frames", "1,3", "--truth-samples", "4"
    )
    assert shot["static"] is False
    assert t.part_names(os.path.join(out, "frames/000002.exr")) == ["color", "motion"]
    assert [entry.get("truth") for entry in shot["frames"]] == [
        "truth/000001.exr",
        None,
        "truth/000003.exr",
    ]
    assert set(shot["frames"][0]["bytes"]) == {"color", "motion", "truth"}
    assert {"color", "truth"} <= set(shot["frames"][0]["render_seconds"])


def test_static_is_found_by_evaluation() -> None:
    """Animation outside the range does not make a shot a moving one; a material that changes does."""
    scene, camera, floor = floor_scene()
    t.key(floor, "location", {20: (0, 0, 0), 30: (0, 0, 1)})
    for curve in t.curves_of(floor):
        curve.extrapolation = "CONSTANT"
    assert exported("--frames", "1-3", "--truth-frames", "none")[0]["static"] is True
    scene, camera, floor = floor_scene()
    t.key(floor, "location", {1: (0, 0, 0), 30: (0, 0, 1)})
    floor.hide_viewport = True  # still rendered
    assert exported("--frames", "1-3", "--truth-frames", "none")[0]["static"] is False
    scene, camera, floor = floor_scene()
    socket = floor.data.materials[0].node_tree.nodes["Diffuse BSDF"].inputs["Color"]
    socket.keyframe_insert("default_value", frame=1)
    assert exported("--frames", "1-3", "--truth-frames", "none")[0]["static"] is False


def test_what_changes_without_moving_is_not_static() -> None:
    """Whatever a material can read of an object, and what makes it appear."""

    def glowing():
        scene, _, floor = floor_scene()
        floor.data.uv_layers.new(name="UV")
        material = bpy.data.materials.new("Glow")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        glow, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new(
            "ShaderNodeOutputMaterial"
        )
        tree.links.new(glow.outputs[0], output.inputs["Surface"])
        floor.data.materials.clear()
        floor.data.materials.append(material)

        def reads(kind, output, **values):
            node = tree.nodes.new(kind)
            for name, value in values.items():
                setattr(node, name, value)
            tree.links.new(node.outputs[output], glow.inputs["Color"])

        return floor, reads

    def color():
        floor, reads = glowing()
        reads("ShaderNodeObjectInfo", "Color")
        t.key(floor, "color", {1: (0, 0, 0, 1), 5: (1, 1, 1, 1)})

    def own_property():
        floor, reads = glowing()
        reads("ShaderNodeAttribute", "Fac", attribute_type="OBJECT", attribute_name="glow")
        for frame, value in ((1, 0.0), (5, 1.0)):
            floor["glow"] = value
            floor.keyframe_insert('["glow"]', frame=frame)

    def texture_coordinates():
        floor, reads = glowing()
        reads("ShaderNodeUVMap", "UV")
        warp = floor.modifiers.new("Warp", "UV_WARP")
        warp.uv_layer = "UV"
        t.key(warp, "offset", {1: (0, 0), 5: (1, 1)})

    def visibility():
        floor, _ = glowing()
        t.key(floor, "visible_camera", {1: False, 3: True})

    def attribute_of_nodes():
        floor, reads = glowing()
        reads("ShaderNodeAttribute", "Fac", attribute_name="glow")
        tree = t.geometry_group("Store")
        store, time = (
            tree.nodes.new("GeometryNodeStoreNamedAttribute"),
            tree.nodes.new("GeometryNodeInputSceneTime"),
        )
        store.inputs["Name"].default_value = "glow"
        value = next(item for item in store.inputs if item.name == "Value" and item.enabled)
        tree.links.new(time.outputs["Seconds"], value)
        tree.links.new(tree.nodes["Start"].outputs[0], store.inputs["Geometry"])
        tree.links.new(store.outputs[0], tree.nodes["End"].inputs[0])
        floor.modifiers.new("Store", "NODES").node_group = tree

    for change in (color, own_property, texture_coordinates, visibility, attribute_of_nodes):
        change()
        shot, out = exported("--frames", "1-4", "--truth-frames", "none")
        means = [
            float(t.read_part(os.path.join(out, entry["file"]), "color")["R"].mean())
            for entry in shot["frames"]
        ]
        assert not shot["static"] and means[3] > means[0] + 0.01, (change.__name__, means)


def test_color_and_truth_share_one_light() -> None:
    """A matt floor under the sun: colour = albedo * irradiance / pi, in every frame and in both halves."""
    scene, _, _ = floor_scene()
    sun = t.add_sun(scene, strength=2.0, rotation=(0.6, 0, 0))
    sun.data.angle = 0.1  # taken away by noise-free light
    shot, out = exported(
        "--frames",
        "1-2",
        "--passes",
        "depth",
        "--truth-samples",
        "8",
        "--ambient",
        "0.1",
        "0.2",
        "0.3",
    )
    expected = np.array((0.2, 0.6, 0.1)) * (
        2.0 * math.cos(0.6) / math.pi + np.array((0.1, 0.2, 0.3))
    )
    for number in (1, 2):
        path = os.path.join(out, f"frames/{number:06d}.exr")
        color = t.stacked(t.read_part(path, "color"), "R G B")
        floor = t.read_part(path, "depth")["Z"] < 1e9
        assert np.abs(color[floor] - expected).max() < 1e-5, color[floor][0]
    truth = os.path.join(out, "truth/000001.exr")
    assert t.part_names(truth) == ["a", "b"]
    halves = [t.stacked(t.read_part(truth, name), "R G B") for name in "ab"]
    inside = np.zeros_like(floor)
    inside[24:, :] = True
    for half in halves:
        assert np.abs(half[inside] - expected).max() < 1e-5
    assert not np.array_equal(*halves), "two seeds"
    assert shot["truth"] == {"samples_per_half": 8, "filter": "box", "filter_width": 1.0}


def test_truth_is_the_box_mean() -> None:
    """The truth's edge pixels against exact coverage of a half plane, both halves without a shift."""
    scene = t.new_scene(32, 32)
    camera = t.add_camera(scene, (0, -10, 0), (0, 0, 0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", 32.0  # one pixel is one metre
    slope = 0.3
    mesh = bpy.data.meshes.new("Half")
    mesh.from_pydata(
        [(-60, 0, -60 * slope), (60, 0, 60 * slope), (60, 0, -99), (-60, 0, -99)],
        [],
        [(0, 1, 2, 3)],
    )
    item = t.add_object(scene, "Half", mesh)
    material = t.diffuse("White", (1, 1, 1))
    item.data.materials.append(material)
    t.add_sun(scene, strength=math.pi, rotation=(math.pi / 2, 0, 0))
    _, out = exported("--frames", "1", "--truth-samples", "256")
    truth = os.path.join(out, "truth/000001.exr")
    fine = (np.arange(64) + 0.5) / 64
    x, y = np.meshgrid(np.arange(32), np.arange(32))
    below = (16 - y[..., None, None] - fine[:, None]) < slope * (
        x[..., None, None] + fine[None, :] - 16
    )
    coverage = below.mean(axis=(-1, -2))
    for half in "ab":
        value = t.read_part(truth, half)["R"].astype(np.float64)
        error = value - coverage
        assert np.abs(error).max() < 0.05, np.abs(error).max()
        partial = (coverage > 0.02) & (coverage < 0.98)
        assert (
            abs(error[partial].mean()) < 0.004
        ), f"half {half} is shifted: mean error {error[partial].mean()}"


def test_the_table_of_passes() -> None:
    """Every pass of methods.json can be exported and holds the channels and types that stand there."""
    with open(
        os.path.join(t.ROOT, "blender_addon/aa_resolve/methods.json"), encoding="utf-8"
    ) as file:
        table = json.load(file)["passes"]
    scene, _, _ = floor_scene()
    t.add_sun(scene)
    t.key(t.add_object(scene, "Cube"), "location", {1: (-1, 0, 0.5), 11: (1, 0.4, 0.8)})
    names = [row["name"] for row in table]
    sizes = {"float": 4, "uint": 4}
    expected: dict[str, dict[str, str]] = {}
    for row in table:
        part = expected.setdefault(row["part"], {})
        views = ("s00.", "s01.") if row["perSubSample"] else ("",)
        own = {item["name"]: item["type"] for item in row["channels"]}
        size = 0 if row.get("list") else sum(sizes[kind] for kind in own.values())
        assert row["bytesPerPixel"] == size, row
        part.update({view + name: kind for view in views for name, kind in own.items()})
        part.update({item["name"]: item["type"] for item in row.get("shared", ())})
    expected["color"]["A"] = "float"  # as Cycles gives it; no method reads it
    shot, out = exported(
        "--frames", "2", "--truth-frames", "none", "--passes", ",".join(names), "--subsamples", "d3d2"
    )  # fmt: skip
    path = os.path.join(out, "frames/000002.exr")
    assert set(t.part_names(path)) == set(expected), t.part_names(path)
    for name, channels in expected.items():
        found = t.read_part(path, name)
        assert set(found) == set(channels), (name, sorted(found))
        for channel, pixels in found.items():
            kind = "uint" if pixels.dtype == np.uint32 else "float"
            assert kind == channels[channel], (name, channel)
    assert not shot["static"] and set(expected) <= set(shot["frames"][0]["bytes"])


def test_half_floats() -> None:
    scene, _, _ = floor_scene()
    t.add_sun(scene)
    _, out = exported("--frames", "1", "--color-type", "half", "--truth-frames", "none")
    source = t.oiio.ImageInput.open(os.path.join(out, "frames/000001.exr"))
    assert str(source.spec().format) == "half"


if __name__ == "__main__":
    t.main(
        test_depth_is_planar,
        test_normals,
        test_ids,
        test_albedo_recipe,
        test_only_what_is_required,
        test_static_is_found_by_evaluation,
        test_what_changes_without_moving_is_not_static,
        test_color_and_truth_share_one_light,
        test_truth_is_the_box_mean,
        test_the_table_of_passes,
        test_half_floats,
    )
