# SPDX-License-Identifier: GPL-3.0-or-later
"""What the world shines: the mean of its radiance, and the suns of its sky textures, which a mean cannot stand for.

Measured is what surfaces receive. A camera may see another world, by Light Path nodes or because the world is hidden
from it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector

from .. import compat
from . import rendering
from .ownership import is_animated, release
from .shader_nodes import feed_instead, nodes_within

_PANORAMA = 64, 32  # pixels
_SUN_PIXELS = 32  # of a square view of a sun
_SUN_MARGIN = 1.5  # width of that view, in diameters

# What a Light Path node says of the ray that leaves a diffuse surface for the world; of all else it says 0.
_DIFFUSE_RAY = {"Is Diffuse Ray", "Is Reflection Ray", "Ray Depth", "Diffuse Depth"}
_SAME_FOR_ALL_RAYS = "Ray Length"  # that ends in the world


@dataclass
class SkySun:
    """The disc of a sky texture: where it stands and its irradiance on a plane that faces it (linear RGB)."""

    towards: Vector
    irradiance: np.ndarray
    moves: bool  # its place is animated


def mean_radiance(
    scene: bpy.types.Scene, world: bpy.types.World, folder: str
) -> tuple[float, float, float]:
    """Mean over the sphere without the discs of suns, scaled as the scene's film: a small panorama of the empty world,
    weighted by solid angle."""
    width, height = _PANORAMA
    with _Received(world) as seen, _Sky(scene, seen, folder) as sky, _without_discs(seen):
        sky.camera.data.type = "PANO"
        compat.panorama_settings(sky.camera.data).panorama_type = "EQUIRECTANGULAR"
        picture = sky.look(Vector((0.0, 1.0, 0.0)), width, height) * scene.cycles.film_exposure
    weight = np.sin((np.arange(height) + 0.5) / height * math.pi)[:, None, None]
    mean = (picture * weight).sum(axis=(0, 1)) / (weight.sum() * width)
    return float(mean[0]), float(mean[1]), float(mean[2])


def suns_of(scene: bpy.types.Scene, world: bpy.types.World, folder: str) -> list[SkySun]:
    """The suns that sky textures draw on the world; of a texture that nothing shows, none."""
    suns: list[SkySun] = []
    if not any(_discs(compat.shader_tree(world))):
        return suns
    with _Received(world) as seen, _Sky(scene, seen, folder) as sky, _without_discs(seen) as discs:
        for node in discs:
            # Cycles: azimuth from +y, clockwise seen from above.
            flat = math.cos(node.sun_elevation)
            towards = Vector(
                (
                    flat * math.sin(node.sun_rotation),
                    flat * math.cos(node.sun_rotation),
                    math.sin(node.sun_elevation),
                )
            )
            angle = _SUN_MARGIN * node.sun_size
            sky.camera.data.type = "PERSP"
            sky.camera.data.angle = angle
            dark = sky.look(towards, _SUN_PIXELS, _SUN_PIXELS)
            node.sun_disc = True
            bright = sky.look(towards, _SUN_PIXELS, _SUN_PIXELS)
            node.sun_disc = False
            pixel = (
                2.0 * math.tan(angle / 2.0) / _SUN_PIXELS
            ) ** 2  # steradians: the view is small
            irradiance = np.maximum(bright - dark, 0.0).sum(axis=(0, 1)) * pixel
            moves = any(is_animated(node, name) for name in ("sun_elevation", "sun_rotation"))
            if irradiance.max() > 0.0:
                suns.append(SkySun(towards, irradiance, moves))
    return suns


def _discs(tree: bpy.types.NodeTree | None) -> Iterator[bpy.types.Node]:
    """Sky textures that draw a sun."""
    for node in nodes_within(tree):
        if node.bl_idname == "ShaderNodeTexSky" and node.sun_disc:
            if node.sky_type not in ("PREETHAM", "HOSEK_WILKIE"):
                yield node


class _without_discs:
    """Within this context no sky texture of the world draws its sun."""

    def __init__(self, world: bpy.types.World) -> None:
        self.nodes = list(_discs(compat.shader_tree(world)))

    def __enter__(self) -> list[bpy.types.Node]:
        for node in self.nodes:
            node.sun_disc = False
        return self.nodes

    def __exit__(self, *_exception) -> None:
        for node in self.nodes:
            node.sun_disc = True


class _Received:
    """Within this context a world that looks to a camera as the given one does to diffuse surfaces: that one itself, or
    a copy where the two differ."""

    def __init__(self, world: bpy.types.World) -> None:
        self.world = world
        self.copies: list[bpy.types.ID] = []

    def __enter__(self) -> bpy.types.World:
        visibility = self.world.cycles_visibility
        if visibility.camera and not _asks_for_the_ray(compat.shader_tree(self.world)):
            return self.world
        copy = self.world.copy()
        self.copies.append(copy)
        release(copy.cycles_visibility, "camera")
        copy.cycles_visibility.camera = True
        self._answer(compat.shader_tree(copy), {})
        return copy

    def __exit__(self, *_exception) -> None:
        bpy.data.batch_remove(self.copies)

    def _answer(
        self, tree: bpy.types.NodeTree | None, known: dict[str, bpy.types.NodeTree]
    ) -> None:
        """Lets Light Path nodes speak of a diffuse ray; groups that hold some are copied. ``known``: by their names."""
        for node in list(tree.nodes) if tree else ():
            if node.bl_idname == "ShaderNodeGroup" and _asks_for_the_ray(node.node_tree):
                name = node.node_tree.name_full
                if name not in known:
                    known[name] = node.node_tree.copy()
                    self.copies.append(known[name])
                    self._answer(known[name], known)
                node.node_tree = known[name]
            elif node.bl_idname == "ShaderNodeLightPath":
                for name in node.outputs.keys():
                    if node.outputs[name].is_linked and name != _SAME_FOR_ALL_RAYS:
                        answer = tree.nodes.new("ShaderNodeValue")
                        answer.outputs[0].default_value = float(name in _DIFFUSE_RAY)
                        feed_instead(tree, node, name, answer)


def _asks_for_the_ray(tree: bpy.types.NodeTree | None) -> bool:
    """True where a tree, or a group in it, has a Light Path node."""
    return any(node.bl_idname == "ShaderNodeLightPath" for node in nodes_within(tree))


class _Sky:
    """A scene of its own that holds nothing but the world and a camera."""

    def __init__(self, scene: bpy.types.Scene, world: bpy.types.World, folder: str) -> None:
        self.of, self.world, self.folder = scene, world, folder

    def __enter__(self) -> _Sky:
        self.scene = bpy.data.scenes.new("AA Resolve World")
        self.scene.world = self.world
        data = bpy.data.cameras.new("AA Resolve World")
        self.camera = bpy.data.objects.new("AA Resolve World", data)
        self.scene.collection.objects.link(self.camera)
        self.scene.camera = self.camera
        self.scene.frame_set(self.of.frame_current)
        return self

    def __exit__(self, *_exception) -> None:
        bpy.data.scenes.remove(self.scene)

    def look(self, towards: Vector, width: int, height: int) -> np.ndarray:
        """Radiance (H x W x 3) of a view in one direction."""
        self.camera.rotation_euler = towards.to_track_quat("-Z", "Y").to_euler()
        self.scene.render.resolution_x, self.scene.render.resolution_y = width, height
        layer = self.scene.view_layers[0]
        rendering.prepare(self.scene, layer)
        rendering.request_passes(layer, {"Depth"})
        rendering.sample_pixel_area(self.scene, 16, 0)
        layers = rendering.render(self.scene, layer, self.folder)
        return layers.get("Combined")[:, :, :3].astype(np.float64)
