# SPDX-License-Identifier: GPL-3.0-or-later
"""What the world shines: the mean of its radiance, and the suns of its sky textures, which a mean cannot stand for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import bpy
import numpy as np
from mathutils import Vector

from .. import compat
from . import rendering
from .ownership import is_animated

_PANORAMA = 64, 32  # pixels
_SUN_PIXELS = 32  # of a square view of a sun
_SUN_MARGIN = 1.5  # width of that view, in diameters


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
    with _Sky(scene, world, folder) as sky, _without_discs(world):
        sky.camera.data.type = "PANO"
        compat.panorama_settings(sky.camera.data).panorama_type = "EQUIRECTANGULAR"
        picture = sky.look(Vector((0.0, 1.0, 0.0)), width, height) * scene.cycles.film_exposure
    weight = np.sin((np.arange(height) + 0.5) / height * math.pi)[:, None, None]
    mean = (picture * weight).sum(axis=(0, 1)) / (weight.sum() * width)
    return float(mean[0]), float(mean[1]), float(mean[2])


def suns_of(scene: bpy.types.Scene, world: bpy.types.World, folder: str) -> list[SkySun]:
    """The suns that sky textures draw on the world; of a texture that nothing shows, none."""
    nodes = list(_discs(compat.shader_tree(world), set()))
    suns: list[SkySun] = []
    if not nodes:
        return suns
    with _Sky(scene, world, folder) as sky, _without_discs(world):
        for node in nodes:
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


def _discs(tree: bpy.types.NodeTree | None, seen: set[str]) -> Iterator[bpy.types.Node]:
    """Sky textures that draw a sun."""
    if tree is None or tree.name in seen:
        return
    seen.add(tree.name)
    for node in tree.nodes:
        if node.bl_idname == "ShaderNodeTexSky" and node.sun_disc:
            if node.sky_type not in ("PREETHAM", "HOSEK_WILKIE"):
                yield node
        elif node.bl_idname == "ShaderNodeGroup":
            yield from _discs(node.node_tree, seen)


class _without_discs:
    """Within this context no sky texture of the world draws its sun."""

    def __init__(self, world: bpy.types.World) -> None:
        self.nodes = list(_discs(compat.shader_tree(world), set()))

    def __enter__(self) -> None:
        for node in self.nodes:
            node.sun_disc = False

    def __exit__(self, *_exception) -> None:
        for node in self.nodes:
            node.sun_disc = True


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
