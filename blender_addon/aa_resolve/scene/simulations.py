# SPDX-License-Identifier: GPL-3.0-or-later
"""Simulations: what a frame shows depends on all frames before it.

An export looks at frames out of order (the one before and the one after each), which a simulation without a bake answers
with nonsense. So all that is not baked is run once, in order, in memory, before the first picture.

Caches on disk lie beside the .blend in a folder of its name. A scene that has some is first moved (in memory, to a
temporary file) beside links to them and its caches are read to memory: nothing here can write or delete the user's."""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass

import bpy

from .. import compat
from .shader_nodes import nodes_within

# Modifiers that simulate, and where their state is kept.
WITH_POINT_CACHE = ("CLOTH", "SOFT_BODY", "DYNAMIC_PAINT", "PARTICLE_SYSTEM")
_LINKED_FOLDER = "blendcache_{}"


@dataclass
class _Cache:
    owner: str
    cache: bpy.types.PointCache
    block: bpy.types.ID

    @property
    def file_prefix(self) -> str:
        """How its files on disk begin."""
        return f"{self.cache.name or self.block.name.encode().hex().upper()}_"


def run(scene: bpy.types.Scene, frames: list[int]) -> list[str]:
    """Runs what is not baked up to the frame after the last; sentences about what was done and what cannot be."""
    last = frames[-1] + 1
    told = _notes_on_lost_caches(scene) + _notes_on_lost_bakes()
    _keep_disks_untouched(scene)
    unbaked = [known for known in _point_caches(scene) if not known.cache.is_baked]
    steps = _domains_that_replay(scene) + _with_simulation_zones(scene)
    names = sorted({known.owner for known in unbaked} | {name for name, _ in steps})
    if not names:
        return told + _notes_on_domains(scene)
    begin = min([known.cache.frame_start for known in unbaked] + [first for _, first in steps])
    for known in unbaked:
        known.cache.frame_end = max(known.cache.frame_start + 1, min(known.cache.frame_end, last))
        known.cache.frame_step = 1  # no property that animation could reach
    if steps:
        for number in range(begin, last + 1):
            scene.frame_set(number)
    if unbaked:
        bpy.ops.ptcache.bake_all(bake=True)
    told.append(
        f"{_some(names)}: simulated without a bake; run once from frame {begin} to {max(begin, last)} for this export"
    )
    return told + _notes_on_domains(scene)


def _point_caches(scene: bpy.types.Scene) -> Iterator[_Cache]:
    """Every point cache that the picture depends on."""
    world = scene.rigidbody_world
    if world is not None and world.enabled and world.collection and len(world.collection.objects):
        yield _Cache("the rigid bodies", world.point_cache, scene)
    for item in bpy.data.objects:
        if item.name not in scene.objects:
            continue
        for modifier in item.modifiers:
            if not modifier.show_render:
                continue
            if modifier.type in ("CLOTH", "SOFT_BODY"):
                yield _Cache(item.name, modifier.point_cache, item)
            elif modifier.type == "DYNAMIC_PAINT" and modifier.canvas_settings:
                for surface in modifier.canvas_settings.canvas_surfaces:
                    if surface.is_active and surface.surface_format == "VERTEX":
                        yield _Cache(item.name, surface.point_cache, item)
            elif modifier.type == "PARTICLE_SYSTEM":
                system = modifier.particle_system
                if system.settings.type == "EMITTER" or system.use_hair_dynamics:
                    yield _Cache(item.name, system.point_cache, item)


def _domains(scene: bpy.types.Scene) -> Iterator[tuple[bpy.types.Object, bpy.types.bpy_struct]]:
    """Domains of fluid and smoke."""
    for item in scene.objects:
        for modifier in item.modifiers:
            if modifier.type == "FLUID" and modifier.fluid_type == "DOMAIN":
                yield item, modifier.domain_settings


def _domains_that_replay(scene: bpy.types.Scene) -> list[tuple[str, int]]:
    """Domains that simulate while frames are played, each with its first frame."""
    found = []
    for item, domain in _domains(scene):
        if domain.cache_type == "REPLAY":
            # Playing writes and deletes files: not those of the user.
            domain.cache_directory = os.path.join(bpy.app.tempdir, "aa_resolve_fluid", item.name)
            found.append((item.name, domain.cache_frame_start))
    return found


def _notes_on_domains(scene: bpy.types.Scene) -> list[str]:
    names = [
        item.name
        for item, domain in _domains(scene)
        if domain.cache_type != "REPLAY" and not domain.has_cache_baked_data
    ]
    if not names:
        return []
    return [f"fluid domain {_some(names)} has not been baked: Blender shows nothing of it"]


def _with_simulation_zones(scene: bpy.types.Scene) -> list[tuple[str, int]]:
    """Objects whose geometry nodes hold a simulation, each with its first frame."""
    found = []
    for item in scene.objects:
        for modifier in item.modifiers:
            if modifier.type == "NODES" and modifier.node_group and modifier.show_render:
                if simulates(modifier.node_group):
                    found.append((item.name, scene.frame_start))
    return found


def simulates(tree: bpy.types.NodeTree) -> bool:
    """True when a geometry-nodes tree holds a simulation zone, itself or in a group."""
    return any(node.bl_idname == "GeometryNodeSimulationInput" for node in nodes_within(tree))


def cache_folder(blend: str) -> str:
    """Folder beside a .blend in which Blender keeps its caches."""
    folder, name = os.path.split(blend)
    return os.path.join(folder, _LINKED_FOLDER.format(os.path.splitext(name)[0]))


def link_caches(blend: str, copy: str) -> None:
    """Lets a copy of the open .blend find the caches of the original: links in the folder where it looks for them, or
    copies where the system has no links."""
    if not blend:
        return
    original, wanted = cache_folder(blend), cache_folder(copy)
    if os.path.isdir(original) and not os.path.exists(wanted):
        os.makedirs(wanted)
        for name in os.listdir(original):
            if os.path.isfile(os.path.join(original, name)):
                _link(os.path.join(original, name), os.path.join(wanted, name))
    for _, folder in _bakes_of_nodes():
        beside = os.path.normpath(folder.removeprefix("//"))
        if folder.startswith("//") and not beside.startswith(
            os.pardir
        ):  # else it is out of the copy's reach
            source, target = (os.path.join(os.path.dirname(path), beside) for path in (blend, copy))
            if os.path.isdir(source) and not os.path.lexists(target):
                os.makedirs(os.path.dirname(target), exist_ok=True)
                _link(source, target)


def _link(source: str, target: str) -> None:
    try:
        os.symlink(os.path.realpath(source), target)
    except OSError:  # Windows without the right to make links
        copy = shutil.copytree if os.path.isdir(source) else shutil.copy2
        copy(source, target)


def _bakes_of_nodes() -> Iterator[tuple[bpy.types.Object, str]]:
    """Folders of what geometry nodes baked to disk; 4.3 does not find them anew when a file is saved elsewhere."""
    for item in bpy.data.objects:
        if item.library is None:
            for modifier in item.modifiers:
                for folder in compat.bake_folders(modifier):
                    yield item, folder


def _keep_disks_untouched(scene: bpy.types.Scene) -> None:
    """Reads caches from disk to memory, of a copy: to switch a cache's disk off deletes its files."""
    on_disk = [known.cache for known in _point_caches(scene) if known.cache.use_disk_cache]
    if not on_disk or not bpy.data.filepath:
        return
    copy = os.path.join(tempfile.mkdtemp(dir=bpy.app.tempdir), "scene.blend")
    link_caches(bpy.data.filepath, copy)
    bpy.ops.wm.save_as_mainfile(filepath=copy, check_existing=False)  # from here on this is open
    for cache in on_disk:
        cache.use_disk_cache = False


def _notes_on_lost_caches(scene: bpy.types.Scene) -> list[str]:
    """Caches that count as baked, and whose files are not there."""
    folder = cache_folder(bpy.data.filepath)
    files = os.listdir(folder) if os.path.isdir(folder) else []
    lost = []
    for known in _point_caches(scene):
        cache = known.cache
        if cache.use_disk_cache and cache.is_baked and not cache.use_external:
            if not any(name.startswith(known.file_prefix) for name in files):
                lost.append(known)
    for known in lost:
        known.cache.use_disk_cache = False
        with bpy.context.temp_override(point_cache=known.cache):
            bpy.ops.ptcache.free_bake()
    if not lost:
        return []
    names = sorted({known.owner for known in lost})
    return [f"the cache of {_some(names)} is not in '{folder}', where its bake left it"]


def _notes_on_lost_bakes() -> list[str]:
    lost = {
        item.name
        for item, folder in _bakes_of_nodes()
        if not os.path.isdir(bpy.path.abspath(folder))
    }
    if not lost:
        return []
    names = _some(sorted(lost))
    return [f"the bake of the geometry nodes of {names} is not found: they are computed anew"]


def _some(names: list[str]) -> str:
    """Up to four names, and how many further ones there are."""
    return ", ".join(names[:4]) + (f" and {len(names) - 4} more" if len(names) > 4 else "")
