# SPDX-License-Identifier: GPL-3.0-or-later
"""Many settings exist twice, once for the viewport and once for the renderer: visibility, levels of subdivision, counts
of particles, resolutions of curves.

What Python sees of the evaluated scene is the viewport's: edges, segments, vertex counts and movement come from there.
Here the viewport's are made to say what the renderer's say, in memory, also where those are animated."""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import compat
from .ownership import follow, may_render, own, own_if_present

# Modifier -> pairs of what the viewport reads and what the renderer reads.
LEVELS: dict[str, tuple[tuple[str, str], ...]] = {
    "SUBSURF": (("levels", "render_levels"),),
    "MULTIRES": (("levels", "render_levels"),),
    "SCREW": (("steps", "render_steps"),),
    "OCEAN": (("viewport_resolution", "resolution"),),
}
_PARTICLES = {
    "child_percent": "rendered_child_count",  # since 4.0
    "child_nbr": "rendered_child_count",
    "display_step": "render_step",
}
_SIMPLIFIED = (
    ("simplify_subdivision", "simplify_subdivision_render"),
    ("simplify_child_particles", "simplify_child_particles_render"),
)


def show_what_renders(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> list[str]:
    """Makes the evaluated scene agree with what the renderer sees; sentences about what cannot be made to."""
    if bpy.context.window is not None:  # the evaluated scene is that of the window's view layer
        bpy.context.window.scene = scene
        bpy.context.window.view_layer = view_layer
    # Else the first change of the frame evaluates a layer that was not shown before, and does not tell the objects that
    # only instances show where they stand: in 3.4 they fall back to the origin at their next change.
    view_layer.update()
    for layer in _layer_collections(view_layer.layer_collection):
        layer.hide_viewport = False  # no property that animation could reach
    for collection in bpy.data.collections:
        if not collection.hide_render:
            own(collection, hide_viewport=False)
    for item in bpy.data.objects:
        own(item, hide_viewport=False)
        follow(item, "show_instancer_for_viewport", "show_instancer_for_render")
        if item.name in view_layer.objects and item.library is None:
            item.hide_set(False, view_layer=view_layer)
        for modifier in item.modifiers:
            follow(modifier, "show_viewport", "show_render")
            for shown, rendered in LEVELS.get(modifier.type, ()):
                follow(modifier, shown, rendered)
    for particles in bpy.data.particles:
        own(particles, display_percentage=100, display_method="RENDER")
        for shown, rendered in compat.known(particles, _PARTICLES).items():
            follow(particles, shown, rendered)
    for curve in bpy.data.curves:
        _show_rendered_curve(curve)
    for ball in bpy.data.metaballs:
        follow(ball, "resolution", "render_resolution")
    for shown, rendered in _SIMPLIFIED:
        follow(scene.render, shown, rendered)
    own_if_present(scene.render, use_simplify_normals=False)  # the viewport's alone
    for tree in bpy.data.node_groups:
        if tree.bl_idname == "GeometryNodeTree":
            _answer_for_the_renderer(tree)
    return _notes_on_adaptive_subdivision(scene)


def _layer_collections(top: bpy.types.LayerCollection) -> Iterator[bpy.types.LayerCollection]:
    yield top
    for child in top.children:
        yield from _layer_collections(child)


def _show_rendered_curve(curve: bpy.types.Curve) -> None:
    """The renderer's resolution of a curve or surface; 0 means the viewport's."""
    for direction in ("u", "v"):
        name = f"resolution_{direction}"
        wanted = getattr(curve, f"render_{name}")
        if wanted == 0:
            continue
        own(curve, **{name: wanted})
        for spline in curve.splines:
            own(spline, **{name: wanted})


def _answer_for_the_renderer(tree: bpy.types.NodeTree) -> None:
    """Node Is Viewport is replaced by what it says in a render."""
    for node in list(tree.nodes):
        if node.bl_idname != "GeometryNodeIsViewport":
            continue
        no = tree.nodes.new("FunctionNodeInputBool")
        no.boolean = False
        for link in list(node.outputs[0].links):
            tree.links.new(no.outputs[0], link.to_socket)
        tree.nodes.remove(node)


def _notes_on_adaptive_subdivision(scene: bpy.types.Scene) -> list[str]:
    names = [
        item.name for item in scene.objects if may_render(item) and compat.is_diced(scene, item)
    ]
    if not names:
        return []
    return [
        f"edges of {', '.join(names)} are those before adaptive subdivision, which only the renderer knows"
    ]
