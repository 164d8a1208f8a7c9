# SPDX-License-Identifier: GPL-3.0-or-later
"""What Python sees of the evaluated scene is what the renderer shows: levels of subdivision, resolutions, counts,
visibility, and a node that asks who looks."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve.scene import ownership, render_levels  # noqa: E402


def vertices(item) -> int:
    evaluated = item.evaluated_get(bpy.context.evaluated_depsgraph_get())
    count = len(evaluated.to_mesh().vertices)
    evaluated.to_mesh_clear()
    return count


def as_rendered(scene) -> None:
    ownership.begin()
    render_levels.show_what_renders(scene, scene.view_layers[0])
    scene.frame_set(scene.frame_current)


def edges_of(scene) -> np.ndarray:
    out = os.path.join(t.temporary_folder(), "s")
    shot = t.export(
        out, "--frames", "1", "--truth-frames", "none", "--passes", "edges,object", "--for", "gbaa"
    )
    path = os.path.join(out, shot["frames"][0]["file"])
    edges = t.stacked(t.read_part(path, "edges"), "edge.X edge.Y")
    shown = t.read_part(path, "object")["id"] > 0
    return edges[shown]


def round_scene(levels: int, rendered: int):
    scene = t.new_scene(96, 54)
    t.add_camera(scene)
    t.add_sun(scene)
    item = t.add_object(scene, "Ball", t.cube_mesh("Ball", 3.0), (0, 0, 0.5))
    modifier = item.modifiers.new("Levels", "SUBSURF")
    modifier.levels, modifier.render_levels = levels, rendered
    return scene, item


def test_edges_of_a_sphere_are_the_renderers() -> None:
    """Viewport 0 (a cube), render 3 (a sphere of 1,538 vertices): distances to edges are those of viewport 3."""
    found = edges_of(round_scene(0, 3)[0])
    expected = edges_of(round_scene(3, 3)[0])
    assert found.shape == expected.shape and np.array_equal(found, expected)
    near = (np.abs(found).min(axis=1) < 0.5).mean()
    assert near > 0.2, f"only {near:.2f} of the sphere's pixels know an edge"


def test_levels_of_modifiers() -> None:
    scene, item = round_scene(0, 2)
    as_rendered(scene)
    assert vertices(item) == 98
    screw = t.add_object(scene, "Screw")
    modifier = screw.modifiers.new("Screw", "SCREW")
    modifier.steps, modifier.render_steps = 2, 11
    flat = vertices(screw)
    as_rendered(scene)
    assert vertices(screw) > 3 * flat
    hidden = t.add_object(scene, "Hidden")
    modifier = hidden.modifiers.new("Array", "ARRAY")
    modifier.count, modifier.show_viewport, modifier.show_render = 3, False, True
    shown = t.add_object(scene, "Shown")
    modifier = shown.modifiers.new("Array", "ARRAY")
    modifier.count, modifier.show_viewport, modifier.show_render = 3, True, False
    as_rendered(scene)
    assert vertices(hidden) == 24 and vertices(shown) == 8


def test_every_modifier_with_two_levels_is_known() -> None:
    """Blender's own list: a property for the viewport or the renderer alone must be in the table."""
    both = {"show_viewport", "show_render"}
    for name in dir(bpy.types):
        kind = getattr(bpy.types, name)
        if not isinstance(kind, type) or not issubclass(kind, bpy.types.Modifier):
            continue
        for item in kind.bl_rna.properties:
            if item.identifier in both or not (
                "render" in item.identifier or "viewport" in item.identifier
            ):
                continue
            known = {
                name for pairs in render_levels.LEVELS.values() for pair in pairs for name in pair
            }
            assert item.identifier in known, f"{name}.{item.identifier}"


def test_simplify() -> None:
    scene, item = round_scene(3, 3)
    scene.render.use_simplify = True
    scene.render.simplify_subdivision, scene.render.simplify_subdivision_render = 0, 2
    as_rendered(scene)
    assert vertices(item) == 98


def test_curves_texts_and_metaballs() -> None:
    scene = t.new_scene(32, 18)
    curve = bpy.data.curves.new("Curve", "CURVE")
    curve.dimensions, curve.bevel_depth = "3D", 0.1
    spline = curve.splines.new("BEZIER")
    spline.bezier_points.add(1)
    spline.bezier_points[1].co = (1, 1, 0)
    curve.resolution_u, curve.render_resolution_u = 2, 20
    item = t.add_object(scene, "Curve", curve)
    coarse = vertices(item)
    as_rendered(scene)
    assert vertices(item) > 5 * coarse, (coarse, vertices(item))
    ball = bpy.data.metaballs.new("Ball")
    ball.elements.new()
    ball.resolution, ball.render_resolution = 1.0, 0.25
    drop = t.add_object(scene, "Ball", ball)
    bpy.context.view_layer.update()
    coarse = vertices(drop)
    as_rendered(scene)
    assert vertices(drop) > 4 * max(coarse, 1), (coarse, vertices(drop))


def test_particles_and_instancers() -> None:
    scene = t.new_scene(32, 18)
    leaf = t.add_object(scene, "Leaf", t.cube_mesh("Leaf", 0.1), (5, 0, 0))
    emitter = t.add_object(scene, "Emitter")
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.type, settings.render_type, settings.instance_object = "HAIR", "OBJECT", leaf
    settings.count, settings.display_percentage = 10, 30
    settings.child_type = "SIMPLE"
    shown = "child_percent" if hasattr(settings, "child_percent") else "child_nbr"
    setattr(settings, shown, 2)
    settings.rendered_child_count = 7
    emitter.show_instancer_for_viewport, emitter.show_instancer_for_render = True, False
    as_rendered(scene)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    count = sum(item.is_instance for item in depsgraph.object_instances)
    assert count == 70, count
    assert "Emitter" not in [
        item.object.name for item in depsgraph.object_instances if item.show_self
    ]


def test_visibility() -> None:
    """Nothing that renders is missing from the evaluated scene, however it is hidden in the viewport."""
    scene = t.new_scene(32, 18)
    eye, screen, filed = (t.add_object(scene, name) for name in ("Eye", "Screen", "Filed"))
    eye.hide_set(True)
    screen.hide_viewport = True
    collection = bpy.data.collections.new("Folder")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(filed)
    collection.objects.link(filed)
    scene.view_layers[0].layer_collection.children["Folder"].hide_viewport = True
    t.key(screen, "hide_viewport", {1: True, 2: True})
    as_rendered(scene)
    seen = {item.object.name for item in bpy.context.evaluated_depsgraph_get().object_instances}
    assert {"Eye", "Screen", "Filed"} <= seen, seen


def test_the_chosen_view_layer_is_the_one_that_is_read() -> None:
    scene, item = round_scene(0, 1)
    collection = bpy.data.collections.new("Left out")
    scene.collection.children.link(collection)
    scene.collection.objects.unlink(item)
    collection.objects.link(item)
    source = bpy.data.collections.new("Source")  # in the scene by an instance alone
    part = bpy.data.objects.new("Part", t.cube_mesh("Part", 0.5))
    part.location = (0.9, 0, 0.2)
    source.objects.link(part)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", source
    collection.objects.link(empty)
    second = scene.view_layers.new(
        "A view layer whose name is longer than any pass would allow, by far"
    )
    scene.view_layers[0].layer_collection.children["Left out"].exclude = True
    name = second.name
    folder = t.temporary_folder()
    bpy.ops.wm.open_mainfile(filepath=t.save(scene, os.path.join(folder, "layers.blend")))
    out = os.path.join(folder, "s")
    shot = t.export(
        out, "--frames", "1", "--truth-frames", "none", "--passes", "edges,object",
        "--view-layer", name, "--for", "rsaa",
    )  # fmt: skip
    path = os.path.join(out, shot["frames"][0]["file"])
    edges = t.stacked(t.read_part(path, "edges"), "edge.X edge.Y")
    assert (np.abs(edges).min(axis=-1) < 0.5).any(), "no edge of what the chosen layer shows"
    assert any(name.startswith("Part") for name in shot["objects"].values()), shot["objects"]
    assert "pixels_without_edges" not in shot["frames"][0], shot["frames"][0]


def test_a_node_that_asks_who_looks() -> None:
    if not hasattr(bpy.types, "GeometryNodeIsViewport"):
        return
    scene = t.new_scene(32, 18)
    item = t.add_object(scene, "Cube")
    tree = t.geometry_group("Tree")
    nodes, link = tree.nodes, tree.links.new
    group_in, group_out = nodes["Start"], nodes["End"]
    asks = nodes.new("GeometryNodeIsViewport")
    switch = nodes.new("GeometryNodeSwitch")
    switch.input_type = "GEOMETRY"
    fine = nodes.new("GeometryNodeSubdivideMesh")
    link(group_in.outputs[0], fine.inputs[0])
    sockets = [socket for socket in switch.inputs if socket.type == "GEOMETRY" and socket.enabled]
    question = next(
        socket for socket in switch.inputs if socket.type == "BOOLEAN" and socket.enabled
    )
    link(asks.outputs[0], question)
    link(fine.outputs[0], sockets[0])  # false: in a render
    link(group_in.outputs[0], sockets[1])
    link(next(socket for socket in switch.outputs if socket.enabled), group_out.inputs[0])
    item.modifiers.new("Nodes", "NODES").node_group = tree
    assert vertices(item) == 8
    as_rendered(scene)
    assert vertices(item) == 26


if __name__ == "__main__":
    t.main(
        test_edges_of_a_sphere_are_the_renderers,
        test_levels_of_modifiers,
        test_every_modifier_with_two_levels_is_known,
        test_simplify,
        test_curves_texts_and_metaballs,
        test_particles_and_instancers,
        test_visibility,
        test_the_chosen_view_layer_is_the_one_that_is_read,
        test_a_node_that_asks_who_looks,
    )
