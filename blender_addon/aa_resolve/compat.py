# SPDX-License-Identifier: GPL-3.0-or-later
"""The only file that knows Blender versions: pass names and the properties that were renamed or moved."""

from __future__ import annotations

import bpy
import numpy as np

VERSION: tuple[int, int, int] = bpy.app.version

# Pass name in the shot exporter -> names in multilayer EXRs of Blender 3.x/4.x and of 5.x.
PASS_NAMES: dict[str, tuple[str, ...]] = {
    "Combined": ("Combined",),
    "Depth": ("Depth",),
    "Normal": ("Normal",),
    "Vector": ("Vector",),
    "Position": ("Position",),
    "IndexOB": ("IndexOB", "Object Index"),
    "DiffCol": ("DiffCol", "Diffuse Color"),
    "GlossCol": ("GlossCol", "Glossy Color"),
    "TransCol": ("TransCol", "Transmission Color"),
    "Emit": ("Emit", "Emission"),
    "Env": ("Env", "Environment"),
    "Denoising Albedo": ("Denoising Albedo",),
    "Denoising Normal": ("Denoising Normal",),
}


def set_if_present(owner, name: str, value) -> bool:
    """Sets a property that only some versions have; True when it exists."""
    if hasattr(owner, name):
        setattr(owner, name, value)
        return True
    return False


def known(owner, values: dict[str, object]) -> dict[str, object]:
    """Those of ``values`` that are properties in this version."""
    return {name: value for name, value in values.items() if hasattr(owner, name)}


def light_sampling_off(material: bpy.types.Material) -> dict[str, object]:
    """What to set so that emission of this material is no longer picked as a light."""
    if hasattr(material.cycles, "emission_sampling"):  # since 3.5
        return {"cycles.emission_sampling": "NONE"}
    return {"cycles.sample_as_light": False}


def shader_tree(owner: bpy.types.Material | bpy.types.World | bpy.types.Light):
    """The shader nodes that a material, world or light uses; None where it has none."""
    return owner.node_tree if getattr(owner, "use_nodes", True) else None  # since 5.0 all use them


def world_of(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> bpy.types.World | None:
    """The world that a view layer renders with."""
    return getattr(view_layer, "world_override", None) or scene.world  # overrides since 4.3


def is_normalized(light: bpy.types.Light) -> bool:
    """True when a light's power does not grow with its size: always before 4.5."""
    return getattr(light, "normalize", True)


def samples_from(cycles, first: int, count: int) -> dict[str, object]:
    """What to set so that a render takes ``count`` samples of Cycles' sequences, beginning with ``first``."""
    if not hasattr(cycles, "use_sample_subset"):
        return {"samples": count, "sample_offset": first}
    return {  # since 5.0 an offset begins a part of all samples, and alone says nothing
        "samples": first + count,
        "sample_offset": first,
        "use_sample_subset": first > 0,
        "sample_subset_length": count,
    }


def sampling_pattern(cycles) -> str:
    """The one sequence of samples that all versions have."""
    before = cycles.sampling_pattern
    try:
        cycles.sampling_pattern = "TABULATED_SOBOL"  # since 3.6
    except TypeError:
        return "PROGRESSIVE_MULTI_JITTER"  # under its first name
    cycles.sampling_pattern = before
    return "TABULATED_SOBOL"


def pass_switches(owner: bpy.types.bpy_struct) -> list[str]:
    """Switches of all passes that this version knows, of a view layer or of Cycles' part of it."""
    return [
        item.identifier
        for item in owner.bl_rna.properties
        if item.type == "BOOLEAN"
        and item.identifier.startswith(("use_pass_", "pass_debug_", "pass_render"))
    ]


def render_in_rec709() -> str | None:
    """Lets the open file compute with the primaries of BT.709; the colour space that it had before, if another."""
    space = getattr(getattr(bpy.data, "colorspace", None), "working_space", "Linear Rec.709")
    if space == "Linear Rec.709":  # all files before 5.0
        return None
    bpy.ops.wm.set_working_color_space(working_space="Linear Rec.709", convert_colors=True)
    return space


def colors_are_albedos() -> bool:
    """True where Cycles' colour passes add up to what a surface reflects of uniform light: since 4.0, whose Principled
    shader shares the light among its layers. Before, its glossy colour is white and its diffuse one above 1.
    """
    return VERSION >= (4, 0, 0)


def emission_color(node: bpy.types.Node) -> bpy.types.NodeSocket | None:
    """The socket of a Principled BSDF that colours its emission."""
    return node.inputs.get("Emission") or node.inputs.get("Emission Color")  # the latter since 4.0


def panorama_settings(camera: bpy.types.Camera):
    """Owner of ``panorama_type``: Cycles' own settings in 3.4, the camera in 4.3 and since."""
    return camera if hasattr(camera, "panorama_type") else camera.cycles


def name_aov_output(node: bpy.types.Node, name: str) -> None:
    """Connects an AOV Output node to the AOV of that name."""
    if not set_if_present(
        node, "aov_name", name
    ):  # since 4.2 the label and the output's name are apart
        node.name = name


def add_group_socket(tree: bpy.types.NodeTree, kind: str, name: str, is_output: bool) -> None:
    """Declares an input or output of a node group, such as ("NodeSocketVector", "Vector")."""
    if hasattr(tree, "interface"):  # since 4.0
        tree.interface.new_socket(name, in_out="OUTPUT" if is_output else "INPUT", socket_type=kind)
    else:
        (tree.outputs if is_output else tree.inputs).new(kind, name)


def set_whole_filter_width(bump: bpy.types.Node) -> None:
    """Lets a Bump node compare heights that lie a whole pixel apart, as it always did before 5.0."""
    if "Filter Width" in bump.inputs:
        bump.inputs["Filter Width"].default_value = 1.0


def strips(scene: bpy.types.Scene) -> list:
    """Strips of the sequencer."""
    editor = scene.sequence_editor
    if editor is None:
        return []
    return list(getattr(editor, "strips_all", None) or getattr(editor, "sequences_all", []))


def set_multilayer_exr(settings) -> None:
    """Image settings for one multilayer EXR with every pass and view in the same part."""
    set_if_present(
        settings, "media_type", "MULTI_LAYER_IMAGE"
    )  # since 5.0 it decides which formats there are
    settings.file_format = "OPEN_EXR_MULTILAYER"
    set_if_present(settings, "use_exr_interleave", True)  # else, since 5.0, a part for every pass


def set_png(settings) -> None:
    """Image settings for one 8-bit PNG with the scene's view transform."""
    set_if_present(settings, "media_type", "IMAGE")  # since 5.0 it decides which formats there are
    settings.file_format = "PNG"
    settings.color_mode, settings.color_depth = "RGB", "8"


def displacement_method(material: bpy.types.Material) -> str:
    """``BUMP`` where displacement only bends normals: Cycles' own setting before 4.1, the material's since."""
    owner = material if hasattr(material, "displacement_method") else material.cycles
    return owner.displacement_method


def is_diced(scene: bpy.types.Scene, item: bpy.types.Object) -> bool:
    """True when Cycles subdivides this object itself, as fine as the picture needs it."""
    last = item.modifiers[-1] if len(item.modifiers) else None
    if last is None or last.type != "SUBSURF" or not last.show_render:
        return False
    if hasattr(last, "use_adaptive_subdivision"):  # since 5.0
        return last.use_adaptive_subdivision
    return scene.cycles.feature_set == "EXPERIMENTAL" and item.cycles.use_adaptive_subdivision


def set_compositing(scene: bpy.types.Scene, enabled: bool) -> None:
    """Compositor and sequencer on or off for renders."""
    scene.render.use_compositing = enabled
    scene.render.use_sequencer = enabled


def compositor_in_use(scene: bpy.types.Scene) -> bool:
    """True when renders of this scene pass through compositor nodes."""
    if hasattr(scene, "compositing_node_group"):  # since 5.0
        return scene.render.use_compositing and scene.compositing_node_group is not None
    return scene.render.use_compositing and scene.use_nodes and scene.node_tree is not None


def curve_lists(holder) -> list:
    """The collections of F-curves by which an animated block's current action, or a strip of its NLA, moves it."""
    action = holder.action if holder else None
    if action is None:
        return []
    if not hasattr(holder, "action_slot"):  # before 4.4
        return [action.fcurves]
    # An action may serve several owners, each with a slot; its own fcurves, until 5.0, are those of the first one.
    bags = [
        strip.channelbag(holder.action_slot)
        for layer in action.layers
        for strip in layer.strips
        if holder.action_slot is not None
    ]
    return [bag.fcurves for bag in bags if bag]


def action_curves(holder) -> list:
    """The F-curves of ``curve_lists``."""
    return [curve for curves in curve_lists(holder) for curve in curves]


def remove_curve(holder, curve) -> None:
    """Takes one F-curve out of ``curve_lists``."""
    for curves in curve_lists(holder):
        if curve in list(curves):
            curves.remove(curve)
            return


def own_action(holder) -> None:
    """Gives an animated block or an NLA strip an action of its own where it shares one, so that a curve can be taken
    out of it alone."""
    action = holder.action
    if action is None or (action.users < 2 and action.library is None):
        return
    slot = getattr(holder, "action_slot", None)
    handle = slot.handle if slot else None
    holder.action = action.copy()
    if handle is not None:  # since 4.4
        holder.action_slot = next(slot for slot in holder.action.slots if slot.handle == handle)


def id_kind(block: bpy.types.ID) -> str:
    """Kind of a data-block as the target of a driver wants it."""
    if hasattr(block, "id_type"):  # since 4.0
        return block.id_type
    kind = next(base for base in type(block).__mro__ if bpy.types.ID in base.__bases__).__name__
    return {"MetaBall": "META", "ParticleSettings": "PARTICLE"}.get(kind, kind.upper())


def inputs_of_nodes(modifier: bpy.types.NodesModifier) -> list[object]:
    """What geometry nodes are given by their modifier."""
    if not hasattr(modifier, "properties"):
        return [modifier[name] for name in modifier.keys()]
    inputs = modifier.properties.inputs  # in 5.2
    held = (getattr(inputs, known.identifier) for known in inputs.bl_rna.properties)
    return [item.value for item in held if hasattr(item, "value")]


def corner_normals(mesh: bpy.types.Mesh) -> np.ndarray:
    """L x 3: the normals that shade the corners of all polygons, with flat faces, sharp marks and custom normals."""
    normals = np.empty(3 * len(mesh.loops), np.float32)
    if hasattr(mesh, "corner_normals"):  # since 4.1
        mesh.corner_normals.foreach_get("vector", normals)
        return normals.reshape(-1, 3)
    if mesh.use_auto_smooth:
        mesh.calc_normals_split()
        mesh.loops.foreach_get("normal", normals)
        return normals.reshape(-1, 3)
    vertices = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", vertices)
    at_vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("normal", at_vertices)
    counts, smooth = np.empty(len(mesh.polygons), np.int32), np.empty(len(mesh.polygons), bool)
    mesh.polygons.foreach_get("loop_total", counts)
    mesh.polygons.foreach_get("use_smooth", smooth)
    if smooth.all():
        return at_vertices.reshape(-1, 3).take(vertices, axis=0)
    of_faces = np.empty(3 * len(mesh.polygons), np.float32)
    mesh.polygons.foreach_get("normal", of_faces)
    # The corners of a mesh lie polygon by polygon.
    return np.where(
        np.repeat(smooth, counts)[:, None],
        at_vertices.reshape(-1, 3)[vertices],
        np.repeat(of_faces.reshape(-1, 3), counts, axis=0),
    )


def bake_folders(modifier: bpy.types.Modifier) -> list[str]:
    """Where the bakes on disk of a geometry-nodes modifier lie; there are none before 3.6."""
    own = getattr(modifier, "bake_directory", getattr(modifier, "simulation_bake_directory", ""))
    if not hasattr(modifier, "bakes"):  # before 4.1
        return [own] if own else []
    found = []
    for bake in modifier.bakes:
        target = getattr(bake, "bake_target", "DISK")  # since 4.3 it may be in the .blend
        if target == "INHERIT":
            target = modifier.bake_target
        if target == "DISK":
            found.append(bake.directory if bake.use_custom_path else own)
    return [folder for folder in dict.fromkeys(found) if folder]


def path_options() -> set[str]:
    """Options of a property that holds a path and may begin with ``//``: since 4.5 others are marked as wrong there."""
    return {"PATH_SUPPORTS_BLEND_RELATIVE"} if VERSION >= (4, 5, 0) else set()


def is_cycles_available() -> bool:
    """True when the Cycles add-on is enabled."""
    return hasattr(bpy.types.Scene, "cycles")


def draw_progress(layout: bpy.types.UILayout, fraction: float) -> None:
    """A progress bar, or its percentage where layouts have none (before 4.0)."""
    if hasattr(layout, "progress"):
        layout.progress(factor=fraction, text=f"{100 * fraction:.0f} %")
    else:
        filled = int(round(20 * fraction))
        layout.label(text=f"[{'#' * filled}{'.' * (20 - filled)}] {100 * fraction:.0f} %")
