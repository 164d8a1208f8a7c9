# SPDX-License-Identifier: GPL-3.0-or-later
"""Light models. Colour and ground truth always share one.

``noise-free``: what one sample per pixel can render exactly. Every light becomes a delta light without size, no
bounces, the world is seen by the camera only, and its mean colour comes back as ``ambient * DiffCol``. Cycles
picks one light at random per sample; several lights are therefore rendered one by one and added:

    color = sum_k Combined_k - (K - 1) (Emit + Env) + ambient * DiffCol

``as-is``: the scene's own light, with noise that only more samples reduce.
"""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import dataclass, field

import bpy
import numpy as np

from .. import compat
from ..errors import SceneError
from . import rendering, world_light
from .light_sources import (
    emissive_materials,
    instancers_of,
    is_portal,
    lights_of,
    noise_causes,
    shown_several_times,
    switched_on,
)
from .ownership import is_animated, own, own_if_present

# Size of an area light that shines from one point, metres. Cycles' own power, beam and spread hold for it, which are not
# the same in all versions; every ray to it meets its centre, to what a float can tell.
_POINT_SIZE = 1.0e-6


@dataclass
class LightPlan:
    """How colour is put together: the lights to render one by one and the ambient radiance (linear RGB)."""

    model: str
    lights: list[bpy.types.Object] = field(default_factory=list)
    ambient: tuple[float, float, float] = (0.0, 0.0, 0.0)
    notes: list[str] = field(default_factory=list)
    transparent_film: bool = False
    empty_passes: set[str] = field(default_factory=set)  # of Cycles, known to be 0 everywhere

    @property
    def passes(self) -> set[str]:
        """Passes of Cycles that ``compose`` reads."""
        needed = {"Combined"}
        if any(self.ambient):
            needed.add("DiffCol")
        if len(self.lights) > 1:
            needed |= {"Emit", "Env"}
        return needed - self.empty_passes

    @property
    def further_passes(self) -> set[str]:
        """Those that it reads of the second and further lights."""
        return {"Combined", "Emit", "Env"} - self.empty_passes

    def left_out(self, read: frozenset[str]) -> list[str]:
        """Passes of Cycles that are not rendered although several lights or ``read`` (what passes of the shot are made
        from) would read them, each with its reason."""
        if len(self.lights) < 2 and not read & {"Emit", "Env"}:
            return []
        reasons = {
            "Emit": "emission (no material emits)",
            "Env": "background (the film is transparent)"
            if self.transparent_film
            else "background (the scene has no world)",
        }
        return [text for name, text in reasons.items() if name in self.empty_passes]


def set_up(
    scene: bpy.types.Scene,
    view_layer: bpy.types.ViewLayer,
    model: str,
    ambient: tuple[float, float, float] | None,
    folder: str,
    frames: Collection[int] = (),
) -> LightPlan:
    """Brings the open scene (in memory) to the light model and says what had to change. It stands in the first of the
    shot's ``frames``, which matter where lights are switched on later.

    ``ambient`` None: the mean colour of the world, where it lights surfaces at all."""
    world = compat.world_of(scene, view_layer)
    plan = LightPlan(model, transparent_film=scene.render.film_transparent and world is not None)
    emissive = emissive_materials()
    if not emissive:
        plan.empty_passes.add("Emit")
    if world is None or plan.transparent_film:
        plan.empty_passes.add("Env")  # Combined does not hold it either
    if world is None or model == "noise-free":
        for item in filter(is_portal, bpy.data.objects):
            # What it lets in, the ambient stands for; the only light, it makes Cycles 4.3 and 5.2 crash.
            own(item, hide_render=True)
    if model == "as-is":
        causes = noise_causes(scene, 1)
        if causes:
            plan.notes.append(
                f"light as it is; noisy at few samples because of {', '.join(causes)}"
            )
        return plan
    cycles = scene.cycles
    changes = []
    if cycles.max_bounces > 0:
        changes.append("no bounces")
    own(
        cycles,
        max_bounces=0,
        diffuse_bounces=0,
        glossy_bounces=0,
        transmission_bounces=0,
        volume_bounces=0,
        caustics_reflective=False,
        caustics_refractive=False,
    )
    own_if_present(cycles, use_fast_gi=False)
    world_lights = False
    if world:
        visibility = world.cycles_visibility
        world_lights = visibility.diffuse
        own(visibility, diffuse=False, glossy=False, transmission=False, scatter=False)
        own(world.cycles, sampling_method="NONE")
    if ambient is not None:
        plan.ambient = ambient
    elif world_lights:
        plan.ambient = world_light.mean_radiance(scene, world, folder)
    if any(plan.ambient):
        red, green, blue = plan.ambient
        changes.append(
            f"ambient ({red:.3g}, {green:.3g}, {blue:.3g}) in place of light from the world"
        )
    if world_lights:
        changes += _add_sky_suns(scene, world, folder)
    plan.lights = lights_of(scene, switched_on(scene, frames))
    changes += [change for change in map(_make_delta, plan.lights) if change]
    for material in emissive:
        own(material, **compat.light_sampling_off(material))
    if emissive:
        changes.append("emitting meshes light nothing else")
    instancers = instancers_of(plan.lights)
    for item in bpy.data.objects:
        if item.type == "LIGHT" or item in instancers:
            continue  # there the same switches mean whom the light shines on (instancers: since Blender 5)
        # What is left of a path after its first hit could only find emitters, at random.
        own(
            item,
            visible_diffuse=False,
            visible_glossy=False,
            visible_transmission=False,
            visible_volume_scatter=False,
        )
    glowing = sorted(
        item.name
        for item in instancers
        if any(slot.material in emissive for slot in item.material_slots)
    )
    if glowing:
        plan.notes.append(
            f"emitting meshes that instance lights ({', '.join(glowing)}) shine as the lights do: noise remains"
        )
    if len(plan.lights) > 1:
        changes.append(f"{len(plan.lights)} lights rendered one by one and added")
    if changes:
        plan.notes.append("noise-free light: " + ", ".join(changes))
    several = shown_several_times(plan.lights)
    if several:
        plan.notes.append(
            f"instanced lights ({', '.join(several)}) are several at once: noise remains"
        )
    return plan


def _add_sky_suns(scene: bpy.types.Scene, world: bpy.types.World, folder: str) -> list[str]:
    """Lights for the suns of sky textures; returns what changed."""
    changes = []
    for sun in world_light.suns_of(scene, world, folder):
        light = bpy.data.lights.new("AA Resolve Sky Sun", "SUN")
        light.angle = 0.0
        light.energy = float(sun.irradiance.max())
        light.color = sun.irradiance / sun.irradiance.max()
        item = bpy.data.objects.new("AA Resolve Sky Sun", light)
        item.rotation_euler = sun.towards.to_track_quat("Z", "Y").to_euler()
        scene.collection.objects.link(item)
        changes.append(
            "the sky's sun is a light without size"
            + (", at rest where it stands in the first frame" if sun.moves else "")
        )
    return changes


def _make_delta(item: bpy.types.Object) -> str:
    """Takes the size from a light; returns what changed. Its transform, nodes, colour and light linking stay."""
    light = item.data.copy()
    cycles = {"use_multiple_importance_sampling": False, "is_caustics_light": False}
    own(light, **{f"cycles.{name}": value for name, value in cycles.items()})
    if not compat.is_normalized(light):
        _keep_strength(item, light)
    if light.type == "AREA":
        change = f"area light '{item.name}' shines from its centre"
        # Of a round one Cycles takes points by their area, without the cancellation of solid angles.
        own(light, shape="DISK", size=_POINT_SIZE)
    else:
        size = "angle" if light.type == "SUN" else "shadow_soft_size"
        change = f"'{item.name}' without size" if getattr(light, size) > 0.0 else ""
        own(light, **{size: 0.0})
    item.data = light
    return change


def _keep_strength(item: bpy.types.Object, light: bpy.types.Light) -> None:
    """Normalizes a light whose power is meant per area of its surface (a sun: per solid angle)."""
    area = _emitting_area(item, light)
    sizes = ("angle", "shadow_soft_size", "size", "size_y", "shape")
    moves = {name for name in (*sizes, "energy", "exposure") if is_animated(light, name)}
    if moves & set(sizes) or {"energy", "exposure"} <= moves:
        raise SceneError(
            f"light '{item.name}': its size is animated and its power is not normalized; switch on Normalize in its "
            "settings, or use --lighting as-is"
        )
    own(light, normalize=True)
    if "energy" in moves:
        own(light, exposure=light.exposure + math.log2(area))
    else:
        own(light, energy=light.energy * area)


def _emitting_area(item: bpy.types.Object, light: bpy.types.Light) -> float:
    """What Cycles multiplies the power of a light with that is not normalized (square metres; sun: steradians)."""
    if light.type == "SUN":
        return math.pi * math.sin(light.angle / 2.0) ** 2 or 1.0
    if light.type != "AREA":
        return 4.0 * (
            math.pi * light.shadow_soft_size**2 or 1.0
        )  # the object's scale does not count
    placement = item.matrix_world
    height = light.size_y if light.shape in ("RECTANGLE", "ELLIPSE") else light.size
    area = light.size * height * placement.col[0].xyz.cross(placement.col[1].xyz).length
    return area * (math.pi / 4.0 if light.shape in ("DISK", "ELLIPSE") else 1.0)


def check_visibility_animation(plan: LightPlan) -> None:
    """Lights that are rendered one by one must not switch themselves on and off."""
    if len(plan.lights) < 2:
        return
    for item in plan.lights:
        if is_animated(item, "hide_render"):
            raise SceneError(
                f"light '{item.name}': its render visibility is animated, and several lights are rendered one by one; "
                "animate its strength instead, or use --lighting as-is"
            )


class only_light:
    """Within this context one light shines (None: none at all)."""

    def __init__(self, plan: LightPlan, light: bpy.types.Object | None) -> None:
        self.plan, self.light = plan, light

    def __enter__(self) -> None:
        self.saved = {item: item.hide_render for item in self.plan.lights}
        for item in self.plan.lights:
            item.hide_render = item != self.light

    def __exit__(self, *_exception) -> None:
        for item, hidden in self.saved.items():
            item.hide_render = hidden


def compose(plan: LightPlan, renders: list[rendering.Layers], view: str = "") -> np.ndarray:
    """Colour (H x W x 4, linear, A as Cycles gives it) from one render per light, or from one of all lights."""
    first = renders[0].get("Combined", view)
    color = first.astype(np.float64)
    for further in renders[1:]:
        color[:, :, :3] += further.get("Combined", view)[:, :, :3].astype(np.float64)
        for name in {"Emit", "Env"} - plan.empty_passes:
            color[:, :, :3] -= further.get(name, view)
    if any(plan.ambient):
        color[:, :, :3] += renders[0].get("DiffCol", view) * np.asarray(plan.ambient)
    return color.astype(np.float32)


def no_light(plan: LightPlan, scene: bpy.types.Scene) -> only_light:
    """Context in which no light shines, so that shading costs nothing."""
    every = LightPlan(plan.model, [*lights_of(scene), *filter(is_portal, scene.objects)])
    return only_light(every, None)
