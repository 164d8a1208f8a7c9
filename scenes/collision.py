# SPDX-License-Identifier: MIT
"""collision: two balls of fine shards fly at each other, meet and burst.

After the moment of collision in the chart of the RSAA talk: methods that rebuild a pixel from few surfaces lose their
quality where many small ones that have nothing to do with each other share it. Until frame 40 the shards, triangles of
two to three pixels at 480 x 270, lie edge to edge on two striped balls. There these touch; from then on every shard
flies and turns on its own, and the two clouds pass through each other. What follows is sub-pixel geometry without
order, densest just after the burst; towards frame 100 most shards have left the view.

usage: blender -b --python-exit-code 9 -P scenes/collision.py -- --out build/scenes/collision.blend
"""

from __future__ import annotations

import math
import os
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import common as c  # noqa: E402  (the folder of this file is no package)

FRAMES = 100
TOUCH = 40  # frame
RADIUS = 1.25  # metres; a pixel is 0.025 m wide there
HEIGHT = 2.3  # of the balls' centres
START = 4.6  # distance of a centre from the middle at frame 1
ROWS = 60  # of shards from pole to pole


def shards_of_sphere() -> list[tuple[c.Vector, c.Vector, c.Vector]]:
    """Triangles of nearly one size that close the sphere, in rings."""
    found = []
    for row in range(ROWS):
        upper, lower = math.pi * row / ROWS, math.pi * (row + 1) / ROWS
        count = max(4, round(2.0 * ROWS * math.sin((upper + lower) / 2.0)))
        for step in range(count):
            here, there = (2.0 * math.pi * (step + k) / count for k in (0, 1))
            a, b = _on_sphere(upper, here), _on_sphere(upper, there)
            d, e = _on_sphere(lower, here), _on_sphere(lower, there)
            found += [corners for corners in ((a, d, e), (a, e, b)) if _area(corners) > 1.0e-6]
    return found


def _on_sphere(polar: float, azimuth: float) -> c.Vector:
    around = math.sin(polar)
    place = (around * math.cos(azimuth), around * math.sin(azimuth), math.cos(polar))
    return RADIUS * c.Vector(place)


def _area(corners) -> float:
    a, b, d = corners
    return 0.5 * (b - a).cross(d - a).length


def burst(corners, towards: float, chance: random.Random) -> list[c.Vector]:
    """Where the corners of a shard are at the last frame; ``towards`` is the ball's direction of flight along x."""
    centre = sum(corners, c.Vector()) / 3.0
    out = centre.normalized()
    # On from the flight, aside from the hit, and each a little differently.
    speed = c.Vector((3.2 * towards, 0.0, 0.6)) + 6.5 * out
    speed += 2.0 * c.Vector([chance.uniform(-1.0, 1.0) for _ in range(3)])
    axis = c.Vector([chance.gauss(0.0, 1.0) for _ in range(3)])
    turn = c.Matrix.Rotation(chance.uniform(0.5, 2.4), 3, axis)
    return [centre + speed + turn @ (corner - centre) for corner in corners]


def stripe_of(corners, count: int) -> int:
    """Which of ``count`` surfaces a shard of the whole ball shows: six stripes from pole to pole, askew."""
    centre = sum(corners, c.Vector()).normalized()
    height = centre.dot(c.Vector((0.48, -0.36, 0.8)))
    return int(3.0 * (height + 1.0)) % count


def add_ball(name: str, towards: float, surfaces, seed: int) -> None:
    """A ball as one mesh whose shape key holds its shards after the burst."""
    chance = random.Random(seed)
    shards = shards_of_sphere()
    vertices = [corner for corners in shards for corner in corners]
    faces = [(3 * index, 3 * index + 1, 3 * index + 2) for index in range(len(shards))]
    ball = c.add_mesh(name, vertices, faces, surfaces[0])
    for surface in surfaces[1:]:
        ball.data.materials.append(surface)
    for polygon, corners in zip(ball.data.polygons, shards):
        polygon.material_index = stripe_of(corners, len(surfaces))
    ball.shape_key_add(name="Whole")
    key = ball.shape_key_add(name="Burst")
    places = [place for corners in shards for place in burst(corners, towards, chance)]
    key.data.foreach_set("co", [value for place in places for value in place])
    start, touch = (-towards * START, 0.0, HEIGHT), (-towards * RADIUS, 0.0, HEIGHT)
    c.key_linear(ball, "location", [(1, start), (TOUCH, touch), (FRAMES, touch)])
    for frame, value in ((1, 0.0), (TOUCH, 0.0), (FRAMES, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    for curve in c.curves_of(ball.data.shape_keys):
        for point in curve.keyframe_points:
            point.interpolation = "LINEAR"


def build(arguments) -> None:
    """Makes the scene in the open (empty) file."""
    scene = c.new_scene(arguments.resolution, FRAMES)
    c.add_sky(scene, horizon=(0.66, 0.77, 0.90), zenith=(0.14, 0.32, 0.68))
    c.add_box(
        "Floor", (-40.0, -20.0, -0.2), (40.0, 40.0, 0.0), c.material("Floor", (0.5, 0.46, 0.4))
    )
    wall = c.material("Wall", (0.36, 0.24, 0.19))
    c.add_box("Wall", (-12.0, 5.0, 0.0), (12.0, 5.4, 3.4), wall)
    warm = [(0.75, 0.20, 0.07), (0.85, 0.50, 0.10), (0.42, 0.06, 0.05), (0.90, 0.78, 0.55)]
    cool = [(0.05, 0.15, 0.50), (0.10, 0.45, 0.55), (0.04, 0.05, 0.16), (0.72, 0.82, 0.90)]
    for name, towards, colours, seed in (("Left", 1.0, warm, 1), ("Right", -1.0, cool, 2)):
        surfaces = [
            c.material(f"{name} {index + 1}", colour) for index, colour in enumerate(colours)
        ]
        add_ball(f"{name} Ball", towards, surfaces, seed)
    c.add_sun(scene, azimuth_degrees=-62.0, height_degrees=42.0)
    c.add_camera(scene, location=(0.0, -10.5, 2.5), target=(0.0, 0.0, 2.3), lens_mm=31.0)


if __name__ == "__main__":
    c.run(__file__, __doc__, build)
