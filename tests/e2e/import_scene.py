"""Inside Blender: a small scene with a moving, zooming camera, and its frames as Blender itself writes them.

usage: blender -b --factory-startup --python-exit-code 9 -P import_scene.py -- BLEND FOLDER
"""

from __future__ import annotations

import os
import sys

import bpy

blend, folder = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
scene = bpy.context.scene
scene.world = bpy.data.worlds.new("World")
scene.world.use_nodes = True
scene.world.node_tree.nodes["Background"].inputs[0].default_value = (0.1, 0.2, 0.4, 1)
# Lit by one delta light, without bounces: nothing is noisy at one sample, so edges can be registered exactly.
visibility = scene.world.cycles_visibility
visibility.diffuse = visibility.glossy = visibility.transmission = visibility.scatter = False


def add(kind: str, index: int, location, color) -> bpy.types.Object:
    """A mesh with a colour of its own and the pass index `index`."""
    getattr(bpy.ops.mesh, f"primitive_{kind}_add")(location=location)
    made = bpy.context.object
    made.pass_index = index
    material = bpy.data.materials.new(made.name)
    material.use_nodes = True
    material.node_tree.nodes["Principled BSDF"].inputs["Base Color"].default_value = (*color, 1)
    made.data.materials.append(material)
    return made


floor = add("plane", 1, (0, 0, -1), (0.5, 0.5, 0.5))
floor.scale = (6, 6, 1)
cube = add("cube", 2, (-1.2, 0, 0), (0.8, 0.2, 0.1))
add("uv_sphere", 3, (1.3, 1, 0), (0.1, 0.6, 0.2))
light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
light.data.angle = 0
light.rotation_euler = (0.6, 0.3, 0)
scene.collection.objects.link(light)
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
camera.rotation_euler = (1.45, 0, 0)
scene.collection.objects.link(camera)
scene.camera = camera
for frame in range(0, 6):
    camera.location = (0.15 * frame, -7 + 0.2 * frame, 0.6)
    camera.rotation_euler[2] = 0.02 * frame
    camera.data.lens = 35 + 1.5 * frame
    camera.keyframe_insert("location", frame=frame)
    camera.keyframe_insert("rotation_euler", frame=frame)
    camera.data.keyframe_insert("lens", frame=frame)
    cube.location[0] = -1.2 + 0.1 * frame
    cube.keyframe_insert("location", frame=frame)
scene.frame_start, scene.frame_end = 1, 3
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = (
    96,
    54,
    100,
)
scene.cycles.use_denoising = False
scene.cycles.use_adaptive_sampling = False
scene.cycles.light_sampling_threshold = 0
scene.cycles.max_bounces = 0
layer = bpy.context.view_layer
for switch in (
    "z",
    "normal",
    "vector",
    "object_index",
    "diffuse_color",
    "glossy_color",
    "transmission_color",
    "emit",
    "environment",
):
    setattr(layer, f"use_pass_{switch}", True)
layer.use_pass_cryptomatte_object = True
layer.cycles.denoising_store_passes = True
bpy.ops.wm.save_as_mainfile(filepath=blend)

if hasattr(scene.render.image_settings, "media_type"):
    scene.render.image_settings.media_type = "MULTI_LAYER_IMAGE"
scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER"
scene.render.image_settings.color_depth = "32"
# 64: the edges of so small a truth are registered to 0.15 px only where it is quiet, in every Blender.
for samples, seed, name in ((1, 0, "frames"), (64, 1, "a"), (64, 2, "b")):
    scene.cycles.samples = samples
    scene.cycles.seed = seed
    scene.cycles.pixel_filter_type = "BOX" if samples > 1 else "BLACKMAN_HARRIS"
    scene.cycles.filter_width = 0.01
    scene.render.filepath = os.path.join(folder, name, "shot_")
    bpy.ops.render.render(animation=True)
