# SPDX-License-Identifier: GPL-3.0-or-later
"""Every instance has an id of its own, stable over frames, also seen through the holes of another one."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402


def exported(*options: str) -> tuple[dict, str]:
    out = os.path.join(t.temporary_folder(), "shot")
    return t.export(out, "--truth-frames", "none", *options), out


def ids_of(shot: dict, out: str, index: int) -> np.ndarray:
    return t.read_part(os.path.join(out, shot["frames"][index]["file"]), "object")["id"]


def source_collection(name: str, material=None):
    collection = bpy.data.collections.new(name)
    part = bpy.data.objects.new(f"{name} Part", t.cube_mesh(f"{name} Part", 0.6))
    if material:
        part.data.materials.append(material)
    collection.objects.link(part)
    return collection


def place(scene, collection, name: str, location):
    empty = bpy.data.objects.new(name, None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.location = location
    scene.collection.objects.link(empty)
    return empty


def test_distinct_and_stable() -> None:
    scene = t.new_scene(96, 54)
    camera = t.add_camera(scene)
    t.key(camera, "location", {1: (0, -8, 1), 11: (0.5, -8, 1.2)})
    collection = source_collection("Tree")
    for index in range(9):
        place(scene, collection, f"Instance {index}", (index % 5 * 0.9 - 1.8, 0, index // 5 * 0.9))
    t.add_object(scene, "Alone", None, (0, 2, 1.2))
    t.add_object(scene, "Real", collection.objects[0].data, (2.4, 0, 1.4))
    shot, out = exported("--frames", "1-3", "--passes", "object")
    names = shot["objects"]
    trees = [
        key
        for key, name in names.items()
        if name.startswith("Tree Part #") and " of Instance" in name
    ]
    assert len(trees) == 9 and all(int(key) >= 1 << 31 for key in trees), names
    assert {"Alone", "Real"} <= set(names.values()), names
    per_frame = [set(np.unique(ids_of(shot, out, index))) - {0} for index in range(3)]
    assert per_frame[0] == per_frame[1] == per_frame[2] == {int(key) for key in names}
    centroids = []
    for index in range(3):
        ids = ids_of(shot, out, index)
        centroids.append({key: np.argwhere(ids == int(key)).mean(axis=0) for key in trees})
    for key in trees:  # the camera moves by far less than the instances are apart
        assert np.abs(centroids[0][key] - centroids[2][key]).max() < 3, key


def test_without_instance_ids() -> None:
    scene = t.new_scene(48, 27)
    t.add_camera(scene)
    collection = source_collection("Tree")
    for index in range(4):
        place(scene, collection, f"Instance {index}", (index - 1.5, 0, 0.5))
    shot, _ = exported("--frames", "1", "--passes", "object", "--no-instance-ids")
    assert list(shot["objects"].values()) == ["Tree Part"], shot["objects"]


def test_through_cutouts() -> None:
    """Three instances of a leaf full of holes, one behind the other: each id, and nothing else, is seen."""
    for way in ("principled", "mix"):
        scene = t.new_scene(96, 54)
        t.add_camera(scene, (0, -8, 0), (0, 0, 0), 60)
        material = bpy.data.materials.new("Leaf")
        material.use_nodes = True
        tree = material.node_tree
        checker = tree.nodes.new("ShaderNodeTexChecker")
        checker.inputs["Scale"].default_value = 3.0
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        tree.links.new(coordinates.outputs["Generated"], checker.inputs["Vector"])
        principled = tree.nodes["Principled BSDF"]
        if way == "principled":
            tree.links.new(checker.outputs["Fac"], principled.inputs["Alpha"])
        else:
            clear, mix = tree.nodes.new("ShaderNodeBsdfTransparent"), tree.nodes.new(
                "ShaderNodeMixShader"
            )
            tree.links.new(checker.outputs["Fac"], mix.inputs["Fac"])
            tree.links.new(clear.outputs[0], mix.inputs[1])
            tree.links.new(principled.outputs[0], mix.inputs[2])
            tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
        mesh = bpy.data.meshes.new("Leaf")
        mesh.from_pydata([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [], [(0, 1, 2, 3)])
        mesh.materials.append(material)
        collection = bpy.data.collections.new("Leaves")
        collection.objects.link(bpy.data.objects.new("Leaf", mesh))
        for index, location in enumerate(((0, 0, 0), (0.4, 1, 0.3), (-0.3, 2, -0.2))):
            place(scene, collection, f"Instance {index}", location)
        shot, out = exported("--frames", "1", "--passes", "object,depth", "--jitter", "none")
        ids = ids_of(shot, out, 0)
        depth = t.read_part(os.path.join(out, shot["frames"][0]["file"]), "depth")["Z"]
        assert len(shot["objects"]) == 3, (way, shot["objects"])
        for key, name in shot["objects"].items():
            expected = 8.0 + int(name[-1])
            seen = depth[ids == int(key)]
            assert len(seen) > 40 and np.abs(seen - expected).max() < 1e-4, (
                way,
                name,
                len(seen),
                np.unique(seen),
            )


def test_meshes_without_material() -> None:
    """Cycles' default surface has no nodes; instances of it are told apart all the same, linked ones too."""
    library = os.path.join(t.temporary_folder(), "library.blend")
    for linked in (False, True):
        scene = t.new_scene(48, 27)
        t.add_camera(scene)
        t.add_sun(scene)
        if linked:
            with bpy.data.libraries.load(library, link=True) as (_, wanted):
                wanted.collections = ["Bare"]
            (collection,) = wanted.collections
        else:
            collection = source_collection("Bare")
            bpy.data.libraries.write(library, {collection})
        for index in range(3):
            place(scene, collection, f"Instance {index}", (index - 1.0, 0, 0.5))
        shot, out = exported("--frames", "1", "--passes", "object")
        assert len(shot["objects"]) == 3, (linked, shot["objects"])
        color = t.read_part(os.path.join(out, "frames/000001.exr"), "color")
        assert color["R"].max() > 0.3, "and it still looks like a surface"


def test_surfaces_that_are_nothing() -> None:
    """A material that gives no light back is a black surface, whether ids of instances are asked for or not."""

    def unlit(tree, output):
        shader = tree.nodes.new("ShaderNodeEmission")
        shader.inputs["Strength"].default_value = 0.0
        tree.links.new(shader.outputs[0], output.inputs["Surface"])

    def nothing(tree, output):
        pass

    def without_output(tree, output):
        tree.nodes.remove(output)

    def for_another_renderer(tree, output):
        output.target = "EEVEE"
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], output.inputs["Surface"])

    def muted(tree, output):
        shader = tree.nodes.new("ShaderNodeBsdfDiffuse")
        tree.links.new(shader.outputs[0], output.inputs["Surface"])
        shader.mute = True

    def muted_hole(tree, output):
        """Of two shaders the muted mixture hands on the first."""
        mix = tree.nodes.new("ShaderNodeMixShader")
        mix.inputs[0].default_value = 1.0
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[1])
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], mix.inputs[2])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])
        mix.mute = True

    def muted_link(tree, output):
        shader = tree.nodes.new("ShaderNodeBsdfTransparent")
        tree.links.new(shader.outputs[0], output.inputs["Surface"]).is_muted = True

    def mixed_with_nothing(tree, output):
        mix = tree.nodes.new("ShaderNodeMixShader")
        mix.inputs[0].default_value = 1.0
        tree.links.new(tree.nodes.new("ShaderNodeBsdfDiffuse").outputs[0], mix.inputs[1])
        tree.links.new(mix.outputs[0], output.inputs["Surface"])

    def glowing_gas(tree, output):
        """What adds light to what is behind it; the camera sees through."""
        both = tree.nodes.new("ShaderNodeAddShader")
        tree.links.new(tree.nodes.new("ShaderNodeBsdfTransparent").outputs[0], both.inputs[0])
        tree.links.new(tree.nodes.new("ShaderNodeEmission").outputs[0], both.inputs[1])
        tree.links.new(both.outputs[0], output.inputs["Surface"])

    surfaces = (
        unlit,
        nothing,
        without_output,
        for_another_renderer,
        muted,
        muted_hole,
        muted_link,
        mixed_with_nothing,
    )
    for make in (*surfaces, glowing_gas):
        scene = t.new_scene(48, 27)
        t.add_camera(scene, (0, -8, 0), (0, 0, 0))
        material = bpy.data.materials.new("Special")
        material.use_nodes = True
        tree = material.node_tree
        tree.nodes.clear()
        make(tree, tree.nodes.new("ShaderNodeOutputMaterial"))
        place(scene, source_collection("Front", material), "In front", (0, 0, 0))
        behind = source_collection("Behind", t.diffuse("Grey", (0.5, 0.5, 0.5)))
        place(scene, behind, "At the back", (0, 2, 0)).scale = (3, 1, 3)
        shot, out = exported(
            "--frames",
            "1",
            "--passes",
            "object,subsamples",
            "--subsamples",
            "d3d1",
            "--jitter",
            "none",
        )
        names = {"Behind Part #0 of At the back"}
        if make is not glowing_gas:
            names.add("Front Part #0 of In front")
        assert set(shot["objects"].values()) == names, (make.__name__, shot["objects"])
        path = os.path.join(out, shot["frames"][0]["file"])
        seen = t.read_part(path, "subsamples")["s00.id"]
        assert np.array_equal(seen, ids_of(shot, out, 0)), make.__name__


def shows_index(way: str):
    """A material that shines as bright as a tenth of the object index."""
    material = bpy.data.materials.new(way)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new(
        "ShaderNodeOutputMaterial"
    )
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    tenth = tree.nodes.new("ShaderNodeMath")
    tenth.operation, tenth.inputs[1].default_value = "DIVIDE", 10.0
    tree.links.new(tenth.outputs[0], shader.inputs["Strength"])
    if way == "node":
        source = tree.nodes.new("ShaderNodeObjectInfo").outputs["Object Index"]
    elif way == "attribute":
        node = tree.nodes.new("ShaderNodeAttribute")
        node.attribute_type, node.attribute_name = "OBJECT", "pass_index"
        source = node.outputs["Fac"]
    else:
        group = bpy.data.node_groups.new("Index", "ShaderNodeTree")
        t.add_group_socket(group, "NodeSocketFloat", "Index", True)
        inner = group.nodes.new("ShaderNodeObjectInfo").outputs["Object Index"]
        group.links.new(inner, group.nodes.new("NodeGroupOutput").inputs[0])
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        source = node.outputs[0]
    tree.links.new(source, tenth.inputs[0])
    return material


def test_materials_and_drivers_read_the_scenes_own_object_index() -> None:
    """The export tells objects apart by other indices; nothing in the picture shows them."""
    scene = t.new_scene(64, 36)
    t.add_camera(scene)
    expected = {}
    for index, way in enumerate(("node", "attribute", "group")):
        item = t.add_object(scene, way, None, (index * 1.2 - 1.8, 0, 0.5))
        item.data.materials.append(shows_index(way))
        item.pass_index, expected[way] = 7 - index, 0.7 - 0.1 * index
    collection = source_collection("Tree", bpy.data.materials["node"])
    collection.objects[0].pass_index, expected["Tree Part"] = 3, 0.3
    place(scene, collection, "Instance", (1.8, 0, 0.5))
    driven = t.add_object(scene, "Driven", None, (0, 0, -9))
    material = t.diffuse("Black", (0, 0, 0))
    driven.data.materials.append(material)
    driver = driven.driver_add("location", 2).driver
    driver.type = "AVERAGE"
    target = driver.variables.new().targets[0]
    target.id, target.data_path = bpy.data.objects["attribute"], "pass_index"
    shot, out = exported("--frames", "1", "--passes", "object", "--lighting", "as-is")
    color = t.read_part(os.path.join(out, shot["frames"][0]["file"]), "color")["R"]
    ids = ids_of(shot, out, 0)
    names = {name.split(" #")[0]: int(key) for key, name in shot["objects"].items()}
    assert names.keys() == expected.keys(), names
    for name, value in expected.items():
        seen = color[ids == names[name]]
        assert len(seen) > 20 and np.abs(seen - np.float32(value)).max() < 1e-6, (name, seen)
    assert driven.matrix_world.translation.z == 6.0, driven.matrix_world


if __name__ == "__main__":
    t.main(
        test_distinct_and_stable,
        test_without_instance_ids,
        test_through_cutouts,
        test_meshes_without_material,
        test_surfaces_that_are_nothing,
        test_materials_and_drivers_read_the_scenes_own_object_index,
    )
