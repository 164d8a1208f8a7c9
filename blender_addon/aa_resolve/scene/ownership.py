# SPDX-License-Identifier: GPL-3.0-or-later
"""What the exporter sets, it owns: nothing in the file may set it again at the next frame.

F-curves, strips of the NLA and drivers are evaluated whenever the frame changes and would undo what Python has set: a
keyed seed makes both halves of a truth the same picture, a keyed sample count a truth of one sample. ``own`` sets
properties and takes exactly their animation away, in the open scene that is never saved; ``follow`` lets one property
show what another says, animated or not. What was taken away is told by ``notes``."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

import bpy

from .. import compat

_NUMBERED = re.compile(r"\[\d+\]")
_taken: dict[str, list[str]] = {}  # data path -> what it belonged to, since notes were last told
# What was set of scenes: (scene, data path) -> holder, name, value.
_kept: dict[tuple[str, str], tuple[bpy.types.bpy_struct, str, object]] = {}


def begin() -> None:
    """Forgets what an earlier export owned."""
    _taken.clear()
    _kept.clear()
    for called in _called():
        if set_again in called:
            called.remove(set_again)


def hold_against_handlers() -> None:
    """Calls ``set_again`` after all other functions that run at changes of the frame."""
    for called in _called():
        called.append(set_again)


def _called() -> tuple[list, ...]:
    handlers = bpy.app.handlers
    return handlers.frame_change_post, handlers.render_init, handlers.render_pre


def own(holder: bpy.types.bpy_struct, **values) -> None:
    """Sets properties of a data-block, or of a struct inside one, for good. Names may lead through further structs
    (``{"cycles.samples": 1}``)."""
    for name, value in values.items():
        if release(holder, name):
            _taken.setdefault(_path(holder, name), []).append(_title(holder.id_data))
        target, last = _reach(holder, name)
        if not _holds(getattr(target, last), value):
            setattr(target, last, value)
        if isinstance(holder.id_data, bpy.types.Scene):
            _kept[holder.id_data.name, _path(holder, name)] = target, last, value


def own_if_present(holder: bpy.types.bpy_struct, **values) -> None:
    """``own`` for what only some versions of Blender have."""
    own(holder, **compat.known(holder, values))


def follow(holder: bpy.types.bpy_struct, name: str, source: str) -> None:
    """Lets ``name`` show what ``source`` (of the same struct) says in every frame, also where that is animated."""
    moves = is_animated(holder, source)
    release(holder, name)
    value = getattr(holder, source)
    if not _holds(getattr(holder, name), value):
        setattr(holder, name, value)
    if moves:
        follow_other(holder, name, holder, source)


def follow_other(
    holder: bpy.types.bpy_struct,
    name: str,
    other: bpy.types.bpy_struct,
    source: str,
    factor: float = 1.0,
) -> None:
    """Drives ``name`` by ``factor`` times a property of ``other``, which may be in another data-block."""
    release(holder, name)
    driver = holder.driver_add(name).driver
    driver.type = "SCRIPTED"
    variable = driver.variables.new()
    variable.name = "other"
    target = variable.targets[0]
    target.id_type = compat.id_kind(other.id_data)
    target.id = other.id_data
    target.data_path = _path(other, source)
    driver.expression = f"other * {factor!r}"  # simple: Blender evaluates it without Python


def is_animated(holder: bpy.types.bpy_struct, name: str) -> bool:
    """True when a curve, a strip or a driver sets the property."""
    return any(_sets(curve, holder, name) for curve in _curves(holder))


def may_render(item: bpy.types.Object) -> bool:
    """False for an object that is hidden in every render."""
    return not item.hide_render or is_animated(item, "hide_render")


def is_animated_within(holder: bpy.types.bpy_struct) -> bool:
    """True when a curve, a strip or a driver sets anything inside a struct of a data-block."""
    prefix = holder.path_from_id()
    return any(curve.data_path.startswith(prefix) for curve in _curves(holder))


def has_animation(block: bpy.types.ID) -> bool:
    """True when a curve, a strip or a driver sets anything of a data-block."""
    return bool(_curves(block))


def release(holder: bpy.types.bpy_struct, name: str) -> bool:
    """Takes the animation of one property away; True where there was some."""
    animation = _animation(holder)
    if animation is None:
        return False
    found = False
    for source in _sources(animation):
        if not any(_sets(curve, holder, name) for curve in compat.action_curves(source)):
            continue
        compat.own_action(source)
        for curve in compat.action_curves(source):
            if _sets(curve, holder, name):
                compat.remove_curve(source, curve)
        found = True
    for driver in list(animation.drivers):
        if _sets(driver, holder, name):
            animation.drivers.remove(driver)
            found = True
    return found


def set_again(*_handler) -> None:
    """Sets once more what was set of scenes: a handler that comes after those of the file."""
    for key, (holder, name, value) in list(_kept.items()):
        try:
            if not _holds(getattr(holder, name), value):
                setattr(holder, name, value)
        except ReferenceError:  # a scene that the exporter made and removed
            del _kept[key]


def notes() -> list[str]:
    """One sentence per setting whose animation was taken away since the last call."""
    told = []
    for path, owners in _taken.items():
        shown = ", ".join(sorted(set(owners))[:4])
        further = f" and {len(set(owners)) - 4} more" if len(set(owners)) > 4 else ""
        told.append(
            f"the animation of '{path}' ({shown}{further}) is switched off: the export sets it itself"
        )
    _taken.clear()
    return told


def _curves(holder: bpy.types.bpy_struct) -> list[bpy.types.FCurve]:
    """Curves and drivers of the holder's data-block."""
    animation = _animation(holder)
    if animation is None:
        return []
    curves = list(animation.drivers)
    for source in _sources(animation):
        curves += compat.action_curves(source)
    return curves


def _animation(holder: bpy.types.bpy_struct) -> bpy.types.AnimData | None:
    return getattr(holder.id_data, "animation_data", None)  # a collection has none


def _sources(animation: bpy.types.AnimData) -> Iterator:
    """The block's own action, then all strips of the NLA, those inside of others as well."""
    if animation.action is not None:
        yield animation
    waiting = [strip for track in animation.nla_tracks for strip in track.strips]
    while waiting:
        strip = waiting.pop()
        waiting.extend(strip.strips)
        if strip.action is not None:
            yield strip


def _path(holder: bpy.types.bpy_struct, name: str) -> str:
    """Data path of a property as curves hold it."""
    if isinstance(holder, bpy.types.ID):
        return name
    return f"{holder.path_from_id()}.{name}"


def _sets(curve: bpy.types.FCurve, holder: bpy.types.bpy_struct, name: str) -> bool:
    """True when a curve or driver of the holder's block is one of this property."""
    found = curve.data_path
    if found == _path(holder, name):
        return True
    # A path may name a member of a list by its number as well: view_layers[0].samples.
    prefix, _, last = found.rpartition(".")
    if not _NUMBERED.search(prefix) or last != name.rpartition(".")[2]:
        return False
    try:
        return holder.id_data.path_resolve(prefix) == _reach(holder, name)[0]
    except ValueError:  # the path leads nowhere
        return False


def _reach(holder: bpy.types.bpy_struct, name: str) -> tuple[bpy.types.bpy_struct, str]:
    *way, last = name.split(".")
    for step in way:
        holder = getattr(holder, step)
    return holder, last


def _holds(found: object, value: object) -> bool:
    """True when a property has the value; Blender's floats have 24 bits."""
    if isinstance(value, float) and isinstance(found, float):
        return math.isclose(found, value, rel_tol=1e-7)
    return found == value


def _title(block: bpy.types.ID) -> str:
    return f"{block.bl_rna.name.lower()} '{block.name}'"
