# SPDX-License-Identifier: GPL-3.0-or-later
"""Inside Blender: imports an OBJ with its MTL and textures, puts a moving camera and a sun before it, saves a .blend.

    blender -b --factory-startup --python-exit-code 9 -P foreign_scene.py -- MODEL.obj OUT.blend
"""

import sys

import bpy

model, out = sys.argv[sys.argv.index("--") + 1 :]
bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.obj_import(filepath=model)
scene = bpy.context.scene
sun = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
sun.rotation_euler = (0.9, 0.1, 0.4)
scene.collection.objects.link(sun)
camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
scene.collection.objects.link(camera)
scene.camera = camera
for frame, location, turn in ((1, (-0.5, -9.0, 2.0), 0.0), (11, (0.6, -8.0, 2.2), -0.08)):
    camera.location, camera.rotation_euler = location, (1.45, 0.0, turn)
    for path in ("location", "rotation_euler"):
        camera.keyframe_insert(path, frame=frame)
bpy.ops.wm.save_as_mainfile(filepath=out)
