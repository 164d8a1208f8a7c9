# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures as a rasteriser reads them: at coordinates without the jitter, and from mip maps with a bias.

Cycles looks textures up at one point of the surface: it has no mip maps and tells nodes no screen derivatives. Both are
built here from nodes that it has, in the open scene that is never saved [Castorina 2023].

* Where the surface lies a pixel to the right and below follows from the camera: the ray of that pixel meets the tangent
  plane, dP = s (e - d (n.e) / (n.d)), with the view direction d of view z 1, the pixel's width as e and the depth s.
* What a texture coordinate v changes over dP follows from a Bump node: with height v, distance a and the geometric
  normal n it gives the normal n' = n - a grad v up to its length, so that grad v . dP = (n - n').dP / (a n'.n), exact
  on a flat triangle. The distance keeps the angle from n to n' small beside that of the view: before 4.0 Cycles turns
  normals back whose mirror direction would lie below the surface.

With the jitter j a texture is read at v - (jx dv/dx + jy dv/dy). The mip level is log2 of the longer of the two steps
in texels, plus the bias; level k is a copy of the image, box-filtered k times in linear light.

Truth reads the textures as they are: all numbers of the nodes are 0 there.
"""

from __future__ import annotations

from collections.abc import Iterator

import bpy

from .. import compat
from .camera import CameraState, Frame
from .mip_images import pyramid, why_no_pyramid
from .shader_nodes import Builder, Socket, new_group, upstream

_BUMPED = ("ShaderNodeBump", "ShaderNodeDisplacement", "ShaderNodeVectorDisplacement")
_GRAZING = 1.0e-4  # the least |n.d|: nearer to edge-on, steps would pass every texture's size
# Angle from n to n', over the cosine of the view, per texel in a pixel: at 100 texels still a twentieth of that cosine,
# at a tenth of a texel 800 times what a float can tell.
_BEND = 5.0e-4
_PROCEDURAL_SIZE = 100.0  # in place of an image's texels


class TextureReading:
    """The textures of the open scene, changed as asked; ``aim`` before each picture."""

    def __init__(self, filter: str, bias: float, unjitter: bool) -> None:
        self.notes: list[str] = []
        self._filter, self._bias, self._unjitter = filter == "mip", bias, unjitter
        self._state: bpy.types.NodeTree | None = None
        if not (self._filter or unjitter):
            return
        self._state = _state_group()
        self._steps = _steps_group(self._state)
        self._levels: dict[str, bpy.types.NodeTree] = {}
        self._left: dict[str, list[str]] = {}
        read = filtered = 0
        for title, tree in list(_trees()):
            here, with_levels = self._change(title, tree)
            read, filtered = read + here, filtered + with_levels
        self._tell(read, filtered)

    def aim(self, camera: CameraState, frame: Frame, offset: tuple[float, float]) -> None:
        """The nodes' numbers for a frame whose samples lie at ``offset`` (pixels, y down) from the centres."""
        jitter = offset if self._unjitter else (0.0, 0.0)
        self._set(
            width=2.0 / (frame.width * camera.projection[0, 0]),
            height=2.0 / (frame.height * camera.projection[1, 1]),
            perspective=float(camera.kind == "perspective"),
            jitter_x=jitter[0],
            jitter_y=jitter[1],
            filtered=float(self._filter),
        )

    def rest(self) -> None:
        """Textures as they are: for truth."""
        self._set(width=0.0, height=0.0, perspective=0.0, jitter_x=0.0, jitter_y=0.0, filtered=0.0)

    def _set(self, **numbers: float) -> None:
        if self._state is not None:
            for name, value in numbers.items():
                self._state.nodes[name].outputs[0].default_value = value

    def _change(self, title: str, tree: bpy.types.NodeTree) -> tuple[int, int]:
        """Gives the textures of one tree other coordinates and levels; how many of either."""
        textures = [node for node in tree.nodes if _is_texture(node)]
        bumped = _feeds_bump(tree)
        reasons = {node.name: _why_not_read(node, bumped) for node in textures}
        steps: dict[str, bpy.types.Node] = {}
        read = filtered = 0
        for node in textures:
            name = f"{title}: {node.label or node.name}"
            reason = reasons[node.name]
            is_image = node.bl_idname == "ShaderNodeTexImage"
            no_levels = (reason or why_no_pyramid(node)) if self._filter and is_image else None
            if reason is None and (self._unjitter or (is_image and no_levels is None)):
                step = self._steps_of(tree, node, steps)
                if self._unjitter:
                    read += 1
                if self._filter and is_image and no_levels is None:
                    self._add_levels(tree, node, step)
                    filtered += 1
            if reason and (self._unjitter or is_image):
                self._left.setdefault(reason, []).append(name)
            elif no_levels:
                self._left.setdefault(no_levels, []).append(name)
            elif self._filter and not is_image:
                self._left.setdefault("a procedural texture has no mip maps", []).append(name)
        return read, filtered

    def _steps_of(
        self, tree: bpy.types.NodeTree, node: bpy.types.Node, known: dict[str, bpy.types.Node]
    ) -> bpy.types.Node:
        """The group that knows the steps of a texture's coordinates; it now stands before the texture."""
        build, socket = Builder(tree), node.inputs["Vector"]
        if socket.is_linked:
            source = socket.links[0].from_socket
        else:  # as Cycles does without a link
            name = "UV" if node.bl_idname == "ShaderNodeTexImage" else "Generated"
            source = build.node("ShaderNodeTexCoord").outputs[name]
        is_image = node.bl_idname == "ShaderNodeTexImage" and node.image
        size = float(max(node.image.size)) if is_image else _PROCEDURAL_SIZE
        origin = (source.node.name, source.identifier) if socket.is_linked else source.name
        key = repr((origin, size))
        if key not in known:
            known[key] = build.group(self._steps, Vector=source, Size=size or _PROCEDURAL_SIZE)
        tree.links.new(known[key].outputs["Vector"], socket)
        return known[key]

    def _add_levels(
        self, tree: bpy.types.NodeTree, node: bpy.types.Node, step: bpy.types.Node
    ) -> None:
        """Lets the pyramid of an image stand where its node stood."""
        build = Builder(tree)
        targets = {
            name: [link.to_socket for link in node.outputs[name].links]
            for name in ("Color", "Alpha")
        }
        key = repr((node.image.name, node.interpolation, node.extension))
        if key not in self._levels:
            self._levels[key] = _levels_group(node, self._state, self._bias)
        mip = build.group(
            self._levels[key],
            Vector=step.outputs["Vector"],
            Right=step.outputs["Right"],
            Down=step.outputs["Down"],
            Color=node.outputs["Color"],
            Alpha=node.outputs["Alpha"],
        )
        for name, sockets in targets.items():
            for socket in sockets:
                tree.links.new(mip.outputs[name], socket)

    def _tell(self, read: int, filtered: int) -> None:
        done = []
        if self._unjitter:
            done.append(f"{read} read at coordinates without jitter")
        if self._filter:
            done.append(f"{filtered} filtered by mip maps with bias {self._bias:g}")
        self.notes.append("textures: " + ", ".join(done) + "; truth reads them as they are")
        for reason, names in self._left.items():
            shown = ", ".join(names[:4]) + (f" and {len(names) - 4} more" if names[4:] else "")
            self.notes.append(f"textures left as they are ({reason}): {shown}")


def _trees() -> Iterator[tuple[str, bpy.types.NodeTree]]:
    """Trees of materials and of the groups in them, each once, with the name of what uses it."""
    waiting = [(item.name, compat.shader_tree(item)) for item in bpy.data.materials if item.users]
    seen: set[int] = set()  # by address: the trees of all materials have one name
    while waiting:
        title, tree = waiting.pop(0)
        if tree is None or tree.as_pointer() in seen:
            continue
        seen.add(tree.as_pointer())
        inner = [node.node_tree for node in tree.nodes if node.bl_idname == "ShaderNodeGroup"]
        waiting += [(group.name, group) for group in inner if group]
        yield title, tree


def _is_texture(node: bpy.types.Node) -> bool:
    """True for what looks a pattern up on a surface; environments and skies are looked up by direction."""
    return (
        node.bl_idname.startswith("ShaderNodeTex")
        and "Vector" in node.inputs
        and node.bl_idname not in ("ShaderNodeTexEnvironment", "ShaderNodeTexSky")
        and any(socket.is_linked for socket in node.outputs)
    )


def _feeds_bump(tree: bpy.types.NodeTree) -> set[str]:
    """Names of nodes from which heights are made: there Cycles shifts coordinates itself."""
    found: set[str] = set()
    for node in tree.nodes:
        if node.bl_idname in _BUMPED:
            sockets = list(node.inputs)
        elif node.bl_idname == "ShaderNodeOutputMaterial":
            sockets = [node.inputs["Displacement"]]
        else:
            continue
        for socket in sockets:
            if socket.name != "Normal":
                found.update(item.name for item in upstream(socket))
    return found


def _why_not_read(node: bpy.types.Node, bumped: set[str]) -> str | None:
    """Why the steps of a texture's coordinates cannot be known; None where they can."""
    if node.id_data.library is not None:
        return "its material is in a linked library"
    if node.name in bumped:
        return "bump or displacement is made from it"
    for item in upstream(node.inputs["Vector"]):
        if item.bl_idname.startswith("ShaderNodeTex") and _is_texture(item):
            return "another texture displaces its coordinates"
        if item.bl_idname in (*_BUMPED, "ShaderNodeGroup", "NodeGroupInput"):
            return "its coordinates come out of a node group or a bump"
    return None


def _state_group() -> bpy.types.NodeTree:
    """The numbers of the current picture, in one place for all materials."""
    names = ("width", "height", "perspective", "jitter_x", "jitter_y", "filtered")
    tree = new_group("AA Resolve Picture", {}, dict.fromkeys(names, "Float"))
    build = Builder(tree)
    end = build.node("NodeGroupOutput")
    for name in names:
        build.feed(end.inputs[name], build.number(name))
    return tree


def _steps_group(state: bpy.types.NodeTree) -> bpy.types.NodeTree:
    """Vector in; out: the vector at the pixel's centre, and its steps to the right and down by one pixel. Size is how
    many steps of interest the vector has from 0 to 1."""
    tree = new_group(
        "AA Resolve Steps",
        {"Vector": "Vector", "Size": "Float"},
        {"Vector": "Vector", "Right": "Vector", "Down": "Vector"},
    )
    build = Builder(tree)
    given = build.node("NodeGroupInput").outputs
    vector = given["Vector"]
    picture = build.group(state).outputs
    normal = build.node("ShaderNodeNewGeometry").outputs["True Normal"]
    right, down, across = _surface_steps(build, picture, normal)
    distance = build.math("MULTIPLY", build.math("MULTIPLY", across, _BEND), given["Size"])
    parts = build.node("ShaderNodeSeparateXYZ")
    build.feed(parts.inputs[0], vector)
    joined = [build.node("ShaderNodeCombineXYZ") for _ in range(2)]
    for axis in range(3):
        bump = build.node("ShaderNodeBump")
        compat.set_whole_filter_width(bump)
        build.feed(bump.inputs["Strength"], 1.0)
        build.feed(bump.inputs["Distance"], distance)
        build.feed(bump.inputs["Height"], parts.outputs[axis])
        build.feed(bump.inputs["Normal"], normal)
        bent = bump.outputs[0]
        length = build.math("MULTIPLY", build.vector("DOT_PRODUCT", bent, normal), distance)
        bend = build.vector("SUBTRACT", normal, bent)
        for step, target in zip((right, down), joined):
            change = build.math("DIVIDE", build.vector("DOT_PRODUCT", bend, step), length)
            build.feed(target.inputs[axis], change)
    steps = [item.outputs[0] for item in joined]
    moved = vector
    for step, jitter in zip(steps, ("jitter_x", "jitter_y")):
        moved = build.vector("SUBTRACT", moved, build.scale(step, picture[jitter]))
    end = build.node("NodeGroupOutput")
    for name, source in zip(("Vector", "Right", "Down"), (moved, *steps)):
        build.feed(end.inputs[name], source)
    return tree


def _surface_steps(build: Builder, picture, normal: Socket) -> tuple[Socket, Socket, Socket]:
    """World-space steps on the tangent plane to the pixels on the right and below, and a pixel's width at the surface
    times the cosine of the view."""
    camera = build.node("ShaderNodeCameraData").outputs
    ahead = (0.0, 0.0, 1.0)  # Cycles' camera looks along +z, y up
    lies = build.turned(normal, "WORLD", "CAMERA")
    depth = camera["View Z Depth"]
    parts = build.node("ShaderNodeSeparateXYZ")
    build.feed(parts.inputs[0], camera["View Vector"])
    slope = build.scale(camera["View Vector"], build.math("DIVIDE", 1.0, parts.outputs["Z"]))
    aside = build.vector("SUBTRACT", slope, ahead)
    direction = build.vector("ADD", build.scale(aside, picture["perspective"]), ahead)
    farther = build.math("SUBTRACT", depth, 1.0)
    scale = build.math("ADD", build.math("MULTIPLY", farther, picture["perspective"]), 1.0)
    facing = build.vector("DOT_PRODUCT", lies, direction)  # below 0: normals face the camera
    facing = build.math("MINIMUM", facing, -_GRAZING)
    made = []
    for axis, size in (((1.0, 0.0, 0.0), "width"), ((0.0, -1.0, 0.0), "height")):
        tilt = build.math("DIVIDE", build.vector("DOT_PRODUCT", lies, axis), facing)
        step = build.vector("SUBTRACT", axis, build.scale(direction, tilt))
        step = build.scale(step, build.math("MULTIPLY", scale, picture[size]))
        made.append(build.turned(step, "CAMERA", "WORLD"))
    flat = build.math("DIVIDE", facing, build.vector("LENGTH", direction))
    flat = build.math("MULTIPLY", flat, -1.0)
    across = build.math("MULTIPLY", build.math("MULTIPLY", scale, picture["width"]), flat)
    return made[0], made[1], across


def _levels_group(
    node: bpy.types.Node, state: bpy.types.NodeTree, bias: float
) -> bpy.types.NodeTree:
    """An image's colour and alpha at the level of its coordinates' steps; level 0 comes from its own node."""
    sockets = {"Color": "Color", "Alpha": "Float"}
    tree = new_group(
        f"AA Resolve Levels of {node.image.name}",
        {"Vector": "Vector", "Right": "Vector", "Down": "Vector", **sockets},
        sockets,
    )
    build = Builder(tree)
    given = build.node("NodeGroupInput").outputs
    size = (*(float(side) for side in node.image.size), 0.0)
    lengths = []
    for name in ("Right", "Down"):
        texels = build.vector("MULTIPLY", given[name], size)
        lengths.append(build.vector("LENGTH", texels))
    longest = build.math("MAXIMUM", build.math("MAXIMUM", *lengths), 1.0e-20)
    level = build.math("ADD", build.math("LOGARITHM", longest, 2.0), bias)
    level = build.math("MULTIPLY", level, build.group(state).outputs["filtered"])
    color, alpha = given["Color"], given["Alpha"]
    for index, image in enumerate(pyramid(node)):
        texture = build.node(
            "ShaderNodeTexImage",
            image=image,
            interpolation="Linear",
            extension=node.extension,
        )
        build.feed(texture.inputs["Vector"], given["Vector"])
        share = build.math("SUBTRACT", level, float(index))
        share.node.use_clamp = True
        color = _mixed(build, share, color, texture.outputs["Color"])
        alpha = build.math(
            "MULTIPLY_ADD",
            share,
            build.math("SUBTRACT", texture.outputs["Alpha"], alpha),
            alpha,
        )
    end = build.node("NodeGroupOutput")
    build.feed(end.inputs["Color"], color)
    build.feed(end.inputs["Alpha"], alpha)
    return tree


def _mixed(build: Builder, share: Socket, first: Socket, second: Socket) -> Socket:
    node = build.node("ShaderNodeMixRGB", blend_type="MIX")
    for name, source in (("Fac", share), ("Color1", first), ("Color2", second)):
        build.feed(node.inputs[name], source)
    return node.outputs["Color"]
