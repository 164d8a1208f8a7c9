# SPDX-License-Identifier: GPL-3.0-or-later
"""Object ids, unique per object and per instance.

Cycles' object index tells objects apart, but every instance (particle, collection or geometry-nodes instance)
carries the index of its source. Their Object Info > Random value differs; an extra output of every material (an
AOV) records it, weighted by the material's opacity, because outputs add up along a ray that passes cut-outs.

Ids: 1..32767 for objects in the order of their names, 2^31 and above for instances (a hash of source and instance,
stable over frames), 0 for the background.
"""

from __future__ import annotations

import zlib

import bpy
import numpy as np

from ..errors import SceneError
from . import object_index
from .instance_output import CHANNEL, add_output, give_every_mesh_a_material, override_material
from .ownership import own
from .rendering import Layers

_UNUSED = 2147483647  # fills persistent ids up
_TOLERANCE = (
    1.0e-6  # of Random in [0, 1]: it went through float and, with many samples, through a mean
)


class ObjectIds:
    """Sets the indices of the open scene's objects and reads ids from renders."""

    def __init__(
        self, scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer, tell_instances: bool
    ) -> None:
        self.notes: list[str] = []
        object_index.keep_own()
        self.table: dict[int, str] = {0: ""}
        for index, item in enumerate(sorted(bpy.data.objects, key=lambda item: item.name_full), 1):
            own(item, pass_index=index)
            self.table[index] = item.name_full
        self._indices = {name: index for index, name in self.table.items()}
        self._names: dict[int, str] = {}
        self._by_random: dict[tuple[str, int], int] = {}
        self._instances: dict[int, tuple[np.ndarray, np.ndarray]] = {}
        self.tells_instances = tell_instances and _may_instance(scene)
        if self.tells_instances:
            view_layer.aovs.add().name = CHANNEL
            view_layer.aovs[CHANNEL].type = "VALUE"
            give_every_mesh_a_material()
            hidden = [material.name for material in bpy.data.materials if not add_output(material)]
            if hidden:
                self.notes.append(
                    f"instances with material {', '.join(hidden)} share one id: its opacity is made inside a node group"
                )
            bare = _makers_of_bare_meshes()
            if bare:
                self.notes.append(
                    f"instances of meshes that the nodes of {', '.join(bare)} make share one id: give the meshes a "
                    "material (node Set Material)"
                )

    def look(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Takes note of the instances of the current frame."""
        self._instances = {}
        if not self.tells_instances:
            return
        found: dict[str, list[tuple[int, str]]] = {}
        for instance in depsgraph.object_instances:
            if instance.is_instance and instance.object:
                number = ".".join(str(part) for part in instance.persistent_id if part != _UNUSED)
                parent = instance.parent.name_full if instance.parent else ""
                source = instance.object.original.name_full
                label = f"{source} #{number}" + (f" of {parent}" if parent else "")
                found.setdefault(source, []).append((instance.random_id & 0xFFFFFFFF, label))
        taken: dict[int, str] = {}
        self._by_random = {}
        indices = self._indices
        for source in sorted(found):
            if source not in indices:
                continue
            pairs = sorted(set(found[source]))
            ids = []
            for random, label in pairs:
                identity = 0x80000000 | zlib.crc32(f"{source}:{random}".encode()) & 0x7FFFFFFF
                while taken.get(identity, label) != label:
                    identity = 0x80000000 | (identity + 1) & 0x7FFFFFFF
                taken[identity] = label
                ids.append(identity)
                self._by_random[source, random] = identity
            values = np.array(
                [np.float32(random) * np.float32(1.0 / 4294967295.0) for random, _ in pairs],
                np.float64,
            )
            self._instances[indices[source]] = values, np.array(ids, np.uint32)
        self._names.update(taken)

    def identify(self, instance: bpy.types.DepsgraphObjectInstance, shown: set[int]) -> int | None:
        """Id among ``shown`` of an entry of the depsgraph that ``look`` has seen: its own, or its source's where
        instances are not told apart. None where neither is shown."""
        name = instance.object.original.name_full
        own = None
        if instance.is_instance:
            own = self._by_random.get((name, instance.random_id & 0xFFFFFFFF))
        for identity in (own, self._indices.get(name)):
            if identity in shown and identity:
                return identity
        return None

    def of_instances(self, keys) -> list[int]:
        """Ids of instances by (source, random id); those that are not told apart have none."""
        return [self._by_random[key] for key in keys if key in self._by_random]

    def resolve(self, layers: Layers, view: str = "") -> np.ndarray:
        """Ids (H x W uint32) of a render."""
        index = np.rint(layers.get("IndexOB", view)[:, :, 0]).astype(np.int32)
        strange = index[
            (index < 0) | (index >= len(self.table))
        ]  # the table counts from 0 without gaps
        if strange.size:
            raise SceneError(
                f"the render shows the object index {strange.min()}, which no object was given: is an object's pass "
                "index animated or driven? Remove that animation"
            )
        ids = index.astype(np.uint32)
        if not self._instances:
            return ids
        random = layers.get(CHANNEL, view)[:, :, 0].astype(np.float64)
        for source, (values, identities) in self._instances.items():
            pixels = index == source
            if not pixels.any():
                continue
            seen = random[pixels]
            right = (
                np.clip(np.searchsorted(values, seen), 1, len(values) - 1)
                if len(values) > 1
                else np.zeros_like(seen, int)
            )
            left = np.maximum(right - 1, 0)
            nearest = np.where(
                np.abs(values[left] - seen) <= np.abs(values[right] - seen), left, right
            )
            matched = np.abs(values[nearest] - seen) <= _TOLERANCE
            ids[pixels] = np.where(matched, identities[nearest], np.uint32(source))
        return ids

    def names(self, ids: np.ndarray) -> dict[str, str]:
        """Id -> name of everything in ``ids``, for shot.json."""
        seen = [int(value) for value in np.unique(ids) if value]
        return {str(value): self._names.get(value) or self.table.get(value, "") for value in seen}

    def override(self) -> bpy.types.Material:
        """Override material that keeps instances apart."""
        material = override_material()
        if self.tells_instances:
            add_output(material)
        return material


def _makers_of_bare_meshes() -> list[str]:
    """Objects whose geometry nodes make instances of meshes without a material: Cycles' default surface has no
    output to tell them apart, and no object holds these meshes that could be given one."""
    if not any(item.type == "NODES" for each in bpy.data.objects for item in each.modifiers):
        return []
    makers = set()
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        item = instance.object
        if instance.is_instance and item and item.type == "MESH" and instance.parent:
            own = instance.parent.original == item.original  # not the instance of another object
            if own and len(item.data.polygons) and not any(item.data.materials):
                makers.add(item.original.name_full)
    return sorted(makers)


def _may_instance(scene: bpy.types.Scene) -> bool:
    for item in bpy.data.objects:
        if item.instance_type != "NONE":
            return True
        if any(
            system.settings.render_type in ("OBJECT", "COLLECTION")
            for system in item.particle_systems
        ):
            return True
        if any(modifier.type == "NODES" and modifier.node_group for modifier in item.modifiers):
            return True
    return False
