# SPDX-License-Identifier: GPL-3.0-or-later
"""Files that the scene uses and the .blend does not hold: libraries, pictures, caches. Which are missing, and by what an
export notices that one has changed; and a scene that comes from a library itself."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterator

import bpy

from .. import compat


def identity_of_linked() -> str:
    """SHA-256 over the content of every file that a render of the open scene reads, wherever it lies.

    Of a sequence of pictures the first counts. Blender's own files, which recent ones link for their brushes, do not.
    """
    own = bpy.utils.system_resource("DATAFILES")
    unread = _unread()
    contents = {
        _digest(path)
        for path in set(bpy.utils.blend_paths(absolute=True, packed=False, local=False))
        if os.path.isfile(path) and not path.startswith(own) and _plain(path) not in unread
    }
    return hashlib.sha256("".join(sorted(contents)).encode()).hexdigest()


def _unread() -> set[str]:
    """Files that no render reads: of pictures and clips that only an editor shows, of sounds, and of the sequencer, which
    an export switches off."""
    paths = {True: set(), False: set()}  # by whether a render may read them
    for block, users in _users_of([*bpy.data.images, *bpy.data.movieclips]).items():
        paths[bool(users)].add(_path(block.filepath, block))
    for sound in bpy.data.sounds:
        paths[False].add(_path(sound.filepath, sound))
    for scene in bpy.data.scenes:
        for strip in compat.strips(scene):
            paths[False].update(_path(file, scene) for file in _files_of(strip))
    return paths[False] - paths[True]


def _users_of(blocks: list[bpy.types.ID]) -> dict[bpy.types.ID, set[bpy.types.ID]]:
    """The data-blocks that use each of them; an editor that shows one is none."""
    return bpy.data.user_map(subset=blocks) if blocks else {}


def _files_of(strip: bpy.types.bpy_struct) -> Iterator[str]:
    """Of a strip of the sequencer, if it plays a movie or pictures."""
    if strip.type == "MOVIE":
        yield strip.filepath
    elif strip.type == "IMAGE":
        yield from (os.path.join(strip.directory, one.filename) for one in strip.elements)


def _path(path: str, block: bpy.types.ID) -> str:
    return _plain(bpy.path.abspath(path, library=block.library))


def _plain(path: str) -> str:
    return os.path.normpath(os.path.abspath(path))


def _digest(path: str) -> str:
    digest = hashlib.sha256()
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(1 << 20), b""):
            digest.update(block)
    return digest.hexdigest()


def local(scene: bpy.types.Scene) -> bpy.types.Scene:
    """The scene, in memory a part of the open file: nothing can be added to one that is linked from another."""
    return scene if scene.library is None else scene.make_local()


def notes_on_missing() -> list[str]:
    """Sentences about files that are not where the scene looks for them, and what is then rendered in their place."""
    told = []
    gone = sorted(
        library.filepath
        for library in bpy.data.libraries
        if not os.path.exists(bpy.path.abspath(library.filepath, library=library.parent))
    )
    if gone:
        told.append(
            f"the linked file {_some(gone)} is missing: what the scene links from it is not in the shot"
        )
    images = [
        image.name
        for image, users in _users_of(list(bpy.data.images)).items()
        if any(map(_shades, users)) and _is_missing_picture(image)
    ]
    if images:
        told.append(f"the picture of {_some(sorted(images))} is missing: its surfaces are magenta")
    for blocks, what in (
        (bpy.data.cache_files, "cache"),
        (bpy.data.volumes, "volume"),
    ):
        names = [
            block.name
            for block in blocks
            if block.users and block.filepath and not _exists(block.filepath, block)
        ]
        if names:
            told.append(f"the file of {what} {_some(sorted(names))} is missing: it stays empty")
    caches = [
        item.name
        for item in bpy.data.objects
        for modifier in item.modifiers
        if modifier.type == "MESH_CACHE" and not _exists(modifier.filepath, item)
    ]
    if caches:
        told.append(f"the mesh cache of {_some(sorted(caches))} is missing: it does not move")
    return told


def _shades(user: bpy.types.ID) -> bool:
    """True for a user of a picture that may put it onto a surface: no backdrop, reference, brush or compositor."""
    if isinstance(user, bpy.types.Object):
        return user.type != "EMPTY"
    return not isinstance(
        user, (bpy.types.Camera, bpy.types.Brush, bpy.types.Scene, bpy.types.CompositorNodeTree)
    )


def _is_missing_picture(image: bpy.types.Image) -> bool:
    """True for a picture that should come from a file and does not."""
    if image.source not in ("FILE", "SEQUENCE", "MOVIE", "TILED") or not image.filepath:
        return False
    if image.packed_file is not None or len(getattr(image, "packed_files", ())):
        return False
    path = image.filepath
    if image.source == "TILED":
        number = str(image.tiles[0].number)
        path = path.replace("<UDIM>", number)
        if "<UVTILE>" in path:
            return False  # named in another way; Blender finds it or paints it magenta
    return not _exists(path, image)


def _exists(path: str, block: bpy.types.ID) -> bool:
    return os.path.exists(bpy.path.abspath(path, library=block.library))


def _some(names: list[str]) -> str:
    """Up to four names, and how many further ones there are."""
    shown = ", ".join(f"'{name}'" for name in names[:4])
    return shown + (f" and {len(names) - 4} more" if len(names) > 4 else "")
