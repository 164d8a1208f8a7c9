# SPDX-License-Identifier: GPL-3.0-or-later
"""Presses Export and Compare in a Blender that has the add-on's zip and nothing else of this project's:

blender -b --python-exit-code 9 -P compare_in_blender.py -- OUT [ZIP]

With ZIP the add-on is first installed as the buttons do it: Install, and from 4.2 on Install from Disk. No package is
imported but Blender's own.
"""

import os
import sys

import bpy

arguments = sys.argv[sys.argv.index("--") + 1 :]
out = arguments[0]
if len(arguments) > 1:
    if hasattr(bpy.context.preferences, "extensions"):
        bpy.ops.extensions.package_install_files(
            filepath=arguments[1], repo="user_default", enable_on_install=True
        )
    else:
        bpy.ops.preferences.addon_install(filepath=arguments[1])
        bpy.ops.preferences.addon_enable(module="aa_resolve")

scene = bpy.context.scene  # the cube, camera and light that Blender starts with
scene.render.engine = "CYCLES"
scene.render.resolution_x, scene.render.resolution_y = 64, 36
cube = bpy.data.objects["Cube"]
for frame in (1, 3):
    cube.location.x = 0.1 * frame
    cube.keyframe_insert("location", frame=frame)
bpy.ops.wm.save_as_mainfile(filepath=out + ".blend")
settings = scene.aa_resolve
settings.out = out
settings.first, settings.last = 1, 2
settings.truth_samples = 8
for name in settings.chosen():
    setattr(settings, "method_" + name, False)
for name in ("noaa", "fxaa311", "taaSimplest"):
    setattr(settings, "method_" + name, True)

assert bpy.ops.aa_resolve.compare() == {"FINISHED"}
for name in ("sheet.png", "report.html", "results.json"):
    path = os.path.join(out + "_results", name)
    assert os.path.getsize(path) > 1000, path
sheet = bpy.data.images["sheet.png"]
assert min(sheet.size) > 100, list(sheet.size)
print("COMPARED", bpy.app.version_string)
