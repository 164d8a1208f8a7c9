# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulations without a bake are run in order; caches on disk are found and never harmed."""

from __future__ import annotations

import hashlib
import os
import shutil
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.panel import job  # noqa: E402
from aa_resolve.scene import ownership, simulations  # noqa: E402

LAST = 8


def cloth(scene, name: str, x: float = 0.0) -> bpy.types.Object:
    """A patch that falls and hangs by its own weight."""
    mesh = bpy.data.meshes.new(name)
    places = [(0.2 * i, 0.2 * j, 0.0) for j in range(5) for i in range(5)]
    faces = [(k, k + 1, k + 6, k + 5) for k in range(20) if k % 5 != 4]
    mesh.from_pydata(places, [], faces)
    item = t.add_object(scene, name, mesh, (x, 0, 1))
    modifier = item.modifiers.new("Cloth", "CLOTH")
    modifier.point_cache.name = name
    modifier.point_cache.frame_end = 100
    return item


def rigid(scene) -> bpy.types.Object:
    item = t.add_object(scene, "Stone", None, (3, 0, 2))
    bpy.context.view_layer.objects.active = item
    bpy.ops.rigidbody.object_add()
    return item


def emitter(scene) -> bpy.types.Object:
    item = t.add_object(scene, "Spring", None, (-3, 0, 2))
    item.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = item.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end = 20, 1, 4
    return item


def place(scene, item, number: int) -> float:
    """One number that says where an object of these is at a frame."""
    scene.frame_set(number)
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    if item.particle_systems:
        return sum(particle.location.z for particle in evaluated.particle_systems[0].particles)
    if item.name == "Stone":
        return evaluated.matrix_world.translation.z
    mesh = evaluated.to_mesh()
    mean = sum(vertex.co.z for vertex in mesh.vertices) / len(mesh.vertices)
    evaluated.to_mesh_clear()
    return mean


def all_kinds():
    scene = t.new_scene(32, 18)
    scene.frame_start, scene.frame_end = 1, 20
    items = [cloth(scene, "Patch"), rigid(scene), emitter(scene)]
    scene.frame_set(1)
    return scene, items


def test_frames_out_of_order_are_those_in_order() -> None:
    scene, items = all_kinds()
    ordered = {}
    for number in range(1, LAST + 1):
        for item in items:
            ordered[item.name, number] = place(scene, item, number)
    assert abs(ordered["Patch", LAST] - ordered["Patch", 2]) > 0.05, "it falls"
    scene, items = all_kinds()
    ownership.begin()
    told = simulations.run(scene, [6, 7])
    assert len(told) == 1 and "simulated without a bake" in told[0] and "1 to 8" in told[0], told
    for name in ("Patch", "Spring", "the rigid bodies"):
        assert name in told[0], told
    items[0].modifiers.new("Fine", "TRIANGULATE")  # what would reset a cache that is not baked
    for number in (LAST, 3, 7, 2, LAST):
        for item in items:
            found = place(scene, item, number)
            assert abs(found - ordered[item.name, number]) < 1e-4, (item.name, number)


def test_an_export_says_so_and_moves() -> None:
    scene, items = all_kinds()
    t.add_camera(scene)
    t.add_sun(scene)
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(out, "--frames", "6-7", "--truth-frames", "none", "--for", "taaSimplest")
    assert any("simulated without a bake" in note for note in shot["notes"]), shot["notes"]
    assert not shot["static"]


def test_baked_simulations_are_left_alone() -> None:
    scene, items = all_kinds()
    bpy.ops.ptcache.bake_all(bake=True)
    assert simulations.run(scene, [6, 7]) == []


def test_simulation_zones() -> None:
    if not hasattr(bpy.types, "GeometryNodeSimulationInput"):
        return
    scene = t.new_scene(32, 18)
    scene.frame_start = 1
    item = t.add_object(scene, "Cube")
    tree = t.geometry_group("Tree")
    nodes, link = tree.nodes, tree.links.new
    before, after = nodes.new("GeometryNodeSimulationInput"), nodes.new(
        "GeometryNodeSimulationOutput"
    )
    before.pair_with_output(after)
    lift = nodes.new("GeometryNodeTransform")
    lift.inputs["Translation"].default_value = (0, 0, 1)
    link(nodes["Start"].outputs[0], before.inputs["Geometry"])
    link(before.outputs["Geometry"], lift.inputs[0])
    link(lift.outputs[0], after.inputs["Geometry"])
    link(after.outputs["Geometry"], nodes["End"].inputs[0])
    item.modifiers.new("Nodes", "NODES").node_group = tree
    told = simulations.run(scene, [5, 6])
    assert len(told) == 1 and "Cube" in told[0], told
    heights = [round(place(scene, item, number), 3) for number in (6, 3, 5)]
    assert heights == [6.0, 3.0, 5.0], heights


def contents(folder: str) -> dict[str, tuple[str, float]]:
    found = {}
    for name in sorted(os.listdir(folder)):
        path = os.path.join(folder, name)
        with open(path, "rb") as file:
            found[name] = hashlib.sha256(file.read()).hexdigest(), os.path.getmtime(path)
    return found


def disk_scene(folder: str) -> tuple[str, str]:
    """A file with two caches on disk, one of them baked; its path and that of its caches."""
    scene = t.new_scene(32, 18)
    scene.frame_end = 10
    t.add_camera(scene)
    t.add_sun(scene)
    baked, loose = cloth(scene, "Baked"), cloth(scene, "Loose", 1.5)
    path = t.save(scene, os.path.join(folder, "flag.blend"))
    for item in (baked, loose):
        item.modifiers[0].point_cache.frame_end = 10
        item.modifiers[0].point_cache.use_disk_cache = True
    with bpy.context.temp_override(point_cache=baked.modifiers[0].point_cache):
        bpy.ops.ptcache.bake(bake=True)
    t.save(scene, path)
    return path, os.path.join(folder, "blendcache_flag")


def exported(blend: str) -> tuple[str, np.ndarray]:
    """What an export said, and the ids of its last frame."""
    out = os.path.join(t.temporary_folder(), "s")
    done = t.run_headless(
        blend, "--out", out, "--frames", "8", "--truth-frames", "none", "--passes", "object"
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, t.read_part(os.path.join(out, "frames/000008.exr"), "object")["id"]


def test_caches_on_disk_are_found_and_not_harmed() -> None:
    folder = t.temporary_folder()
    blend, caches = disk_scene(folder)
    before = contents(caches)
    assert len(before) >= 10, before
    said, shown = exported(blend)
    assert contents(caches) == before, "the user's caches are as they were"
    assert "Loose" in said and "Baked" not in said, said
    bpy.ops.wm.open_mainfile(filepath=blend)
    copied, copy = job.copy_of_open_file()
    said, linked = exported(copy)
    shutil.rmtree(copied)  # as the panel does at the end of its job
    assert "Baked" not in said and np.array_equal(linked, shown), said
    assert contents(caches) == before
    # And a copy that finds none: said, and simulated anew.
    lone = os.path.join(t.temporary_folder(), "lone.blend")
    bpy.ops.wm.save_as_mainfile(filepath=lone, copy=True, check_existing=False)
    said, alone = exported(lone)
    assert "the cache of Baked is not in" in said, said
    assert (alone != shown).mean() < 0.02, "what is simulated anew falls the same way"


def nodes_that_rise(scene) -> bpy.types.Object:
    """A cube that geometry nodes lift by the frame; where Blender bakes nodes, at rest by a bake of frame 1 on disk."""
    item = t.add_object(scene, "Cube")
    modifier = item.modifiers.new("Nodes", "NODES")
    modifier.node_group = tree = t.geometry_group("Rising")
    time = tree.nodes.new("GeometryNodeInputSceneTime")
    up = tree.nodes.new("ShaderNodeCombineXYZ")
    lift = tree.nodes.new("GeometryNodeSetPosition")
    chain = [tree.nodes["Start"], lift, tree.nodes["End"]]
    if hasattr(bpy.types, "GeometryNodeBake"):
        bake = tree.nodes.new("GeometryNodeBake")
        if not bake.bake_items:  # in recent versions it begins with none
            bake.bake_items.new("GEOMETRY", "Geometry")
        chain.insert(2, bake)
    for start, end in zip(chain, chain[1:]):
        tree.links.new(start.outputs[0], end.inputs[0])
    tree.links.new(time.outputs["Frame"], up.inputs["Z"])
    tree.links.new(up.outputs[0], lift.inputs["Offset"])
    return item


def bake_on_disk(item: bpy.types.Object) -> None:
    modifier = item.modifiers[0]
    bpy.context.view_layer.update()
    bake = modifier.bakes[0]
    bake.bake_mode, modifier.bake_target = "STILL", "DISK"
    bpy.context.view_layer.objects.active = item
    item.select_set(True)
    bpy.ops.object.geometry_node_bake_single(
        session_uid=item.session_uid, modifier_name=modifier.name, bake_id=bake.bake_id
    )


def test_bakes_of_nodes_are_found() -> None:
    """The panel's copy finds them, removes nothing of them, and a file without them says so."""
    from aa_resolve import compat

    folder = t.temporary_folder()
    scene = t.new_scene(16, 9)
    item = nodes_that_rise(scene)
    blend = t.save(scene, os.path.join(folder, "rising.blend"))
    baked = os.path.join(folder, "blendcache_rising", "Cube_Nodes")
    kept = compat.bake_folders
    if hasattr(bpy.types, "GeometryNodeBake"):
        bake_on_disk(item)
        t.save(scene, blend)
    else:
        assert kept(item.modifiers[0]) == [], "such bakes are younger than this Blender"
        compat.bake_folders = lambda _: ["//blendcache_rising/Cube_Nodes", "//../elsewhere"]
        os.makedirs(os.path.join(baked, "1", "blobs"))
    try:
        assert os.listdir(baked)
        copied, copy = job.copy_of_open_file()
        assert os.path.exists(
            os.path.join(copied, "blendcache_rising", "Cube_Nodes", *os.listdir(baked)[:1])
        )
        bpy.ops.wm.open_mainfile(filepath=copy)
        item = bpy.data.objects["Cube"]
        if kept is compat.bake_folders:
            assert place(bpy.context.scene, item, 5) == 1.0, "as the bake of frame 1 has it"
            assert simulations.run(bpy.context.scene, [5]) == []
        shutil.rmtree(copied)  # as the panel does at the end of its job
        assert os.listdir(baked)
        shutil.rmtree(baked)
        bpy.ops.wm.open_mainfile(filepath=blend)
        told = simulations.run(bpy.context.scene, [5])
        assert len(told) == 1 and "geometry nodes of Cube is not found" in told[0], told
    finally:
        compat.bake_folders = kept


if __name__ == "__main__":
    t.main(
        test_frames_out_of_order_are_those_in_order,
        test_an_export_says_so_and_moves,
        test_baked_simulations_are_left_alone,
        test_simulation_zones,
        test_caches_on_disk_are_found_and_not_harmed,
        test_bakes_of_nodes_are_found,
    )
