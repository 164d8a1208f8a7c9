# SPDX-License-Identifier: GPL-3.0-or-later
"""A shot is static only where no frame can differ from the others: each scene here rests as it is built, and changes with
the one thing that is then set."""

from __future__ import annotations

import os
import sys
from typing import Callable

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

FRAMES = (1, 2, 3)


def scene_with_ball() -> tuple[bpy.types.Scene, bpy.types.Object]:
    scene = t.new_scene(16, 9)
    t.add_camera(scene)
    t.add_sun(scene)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=2)
    ball = bpy.context.object
    ball.data.materials.append(t.diffuse("Matt", (0.5, 0.5, 0.5)))
    return scene, ball


def pictures(folder: str) -> bpy.types.Image:
    """A picture for each frame, each brighter than the one before; loaded as one picture."""
    for frame in FRAMES:
        image = bpy.data.images.new("Made", 4, 4)
        image.pixels = [frame / len(FRAMES)] * 64
        image.filepath_raw = os.path.join(folder, f"{frame:04d}.png")
        image.file_format = "PNG"
        image.save()
        bpy.data.images.remove(image)
    return bpy.data.images.load(os.path.join(folder, "0001.png"))


def excluded(scene, item: bpy.types.Object) -> None:
    """Moves an object to a collection that the view layer leaves out."""
    helpers = bpy.data.collections.new("Helpers")
    scene.collection.children.link(helpers)
    for holder in item.users_collection:
        holder.objects.unlink(item)
    helpers.objects.link(item)
    scene.view_layers[0].layer_collection.children["Helpers"].exclude = True


def displaced(ball, kind: str) -> bpy.types.Texture:
    displace = ball.modifiers.new("Displace", "DISPLACE")
    displace.texture = bpy.data.textures.new("Bumps", kind)
    return displace.texture


def texture_of_a_modifier() -> Callable[[], None]:
    _, ball = scene_with_ball()
    texture = displaced(ball, "CLOUDS")
    return lambda: t.key(texture, "noise_scale", {1: 0.3, 3: 1.5})


def sequence_in_a_texture() -> Callable[[], None]:
    _, ball = scene_with_ball()
    texture = displaced(ball, "IMAGE")
    texture.image = pictures(t.temporary_folder())
    user = texture.image_user
    user.frame_duration, user.frame_start, user.use_auto_refresh = len(FRAMES), 1, True
    return lambda: setattr(texture.image, "source", "SEQUENCE")


def tracked_clip() -> Callable[[], None]:
    scene, ball = scene_with_ball()
    folder = t.temporary_folder()
    bpy.data.images.remove(pictures(folder))
    clip = bpy.data.movieclips.load(os.path.join(folder, "0001.png"))
    track = clip.tracking.tracks.new(name="Track", frame=1)
    for frame in FRAMES:
        track.markers.insert_frame(frame, co=(0.2 * frame, 0.5))

    def follow() -> None:
        constraint = ball.constraints.new("FOLLOW_TRACK")
        constraint.use_active_clip = constraint.use_3d_position = False
        constraint.clip, constraint.track, constraint.camera = clip, "Track", scene.camera

    return follow


def place_read_by_a_material(excludes: bool) -> Callable[[], None]:
    scene, ball = scene_with_ball()
    armature = t.add_object(scene, "Helper", bpy.data.armatures.new("Helper"))
    tree = ball.data.materials[0].node_tree
    place, checker = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeTexChecker")
    place.object = armature
    tree.links.new(place.outputs["Object"], checker.inputs["Vector"])
    tree.links.new(checker.outputs[0], tree.nodes["Diffuse BSDF"].inputs["Color"])
    if excludes:
        excluded(scene, armature)
    return lambda: t.key(armature, "location", {1: (0, 0, 0), 3: (2, 0, 0)})


def strands() -> tuple[bpy.types.Scene, bpy.types.ParticleSystem]:
    scene, ball = scene_with_ball()
    ball.modifiers.new("Hair", "PARTICLE_SYSTEM")
    system = ball.particle_systems[0]
    system.settings.type, system.settings.count = "HAIR", 20
    return scene, system


def hair_in_a_field() -> Callable[[], None]:
    _, system = strands()
    system.settings.effector_weights.apply_to_hair_growing = True
    bpy.ops.object.effector_add(type="FORCE", location=(1, 1, 1))
    force = bpy.context.object.field
    force.strength = 5.0
    return lambda: t.key(force, "strength", {1: 0.0, 3: 9.0})


def settings_of_hair() -> Callable[[], None]:
    _, system = strands()
    return lambda: t.key(system.settings, "root_radius", {1: 1.0, 3: 2.0})


def normals_alone() -> Callable[[], None]:
    _, ball = scene_with_ball()
    for face in ball.data.polygons:
        face.use_smooth = True
    t.smooth_by_angle(ball.data, 3.1)
    edit = ball.modifiers.new("Normals", "NORMAL_EDIT")
    return lambda: t.key(edit, "offset", {1: (0, 0, 1), 3: (5, 0, 1)})


def volume_of_a_mesh() -> Callable[[], None]:
    scene, ball = scene_with_ball()
    cloud = t.add_object(scene, "Cloud", bpy.data.volumes.new("Cloud"))
    filled = cloud.modifiers.new("Fill", "MESH_TO_VOLUME")
    filled.object = ball
    return lambda: t.key(filled, "density", {1: 1.0, 3: 2.0})


def sequence_given_to_nodes() -> Callable[[], None]:
    _, ball = scene_with_ball()
    tree = t.geometry_group("Nodes")
    tree.links.new(tree.nodes["Start"].outputs[0], tree.nodes["End"].inputs[0])
    reader = tree.nodes.new("GeometryNodeImageTexture")
    ball.modifiers.new("Nodes", "NODES").node_group = tree
    image = reader.inputs["Image"].default_value = pictures(t.temporary_folder())
    return lambda: setattr(image, "source", "SEQUENCE")


def check(build: Callable[..., Callable[[], None]], *arguments) -> None:
    """That the scene is static without the change and is not with it."""
    for changes in (False, True):
        change = build(*arguments)
        if changes:
            change()
        out = os.path.join(t.temporary_folder(), "s")
        shot = t.export(out, "--frames", "1-3", "--truth-frames", "none")
        assert shot["static"] != changes, (build.__name__, arguments, changes, shot["notes"])


def test_textures_and_clips() -> None:
    check(texture_of_a_modifier)
    check(sequence_in_a_texture)
    check(tracked_clip)
    check(sequence_given_to_nodes)


def test_places_that_only_a_material_reads() -> None:
    check(place_read_by_a_material, False)
    check(place_read_by_a_material, True)


def test_what_no_vertex_tells() -> None:
    check(hair_in_a_field)
    check(settings_of_hair)
    check(normals_alone)
    check(volume_of_a_mesh)


def test_the_frames_of_a_sequence_are_shown() -> None:
    """The way from the file to the picture: each frame's depth is that of its own picture."""
    sequence_in_a_texture()()
    out = os.path.join(t.temporary_folder(), "s")
    options = ("--passes", "depth", "--truth-frames", "none", "--jitter", "none")
    shot = t.export(out, "--frames", "1-3", *options)
    depths = [
        float(t.read_part(os.path.join(out, entry["file"]), "depth")["Z"].min())
        for entry in shot["frames"]
    ]
    assert np.all(np.diff(depths) < -0.1), depths  # it grows towards the camera


if __name__ == "__main__":
    t.main(
        test_textures_and_clips,
        test_places_that_only_a_material_reads,
        test_what_no_vertex_tells,
        test_the_frames_of_a_sequence_are_shown,
    )
