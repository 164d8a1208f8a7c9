# SPDX-License-Identifier: GPL-3.0-or-later
"""Motion is exact: every pixel's motion against the projection of the very point it shows.

The point is found from the exported depth; where it was a frame ago follows from the known affine movement of its
object; both are projected by formulas of the support module.
"""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import Vector, bpy, np  # noqa: E402

LIMIT_PX = 0.001
FRAME = 5


def stage(width: int = 64, height: int = 36):
    scene = t.new_scene(width, height)
    camera = t.add_camera(scene)
    t.add_object(scene, "Still", None, (-1.5, 1.0, 0.4), (0.3, 0.2, 0.5))
    t.add_object(scene, "Behind", None, (0.5, 4.0, 1.0), (0.1, 0.7, 0.2), (2.0, 1.0, 1.5))
    return scene, camera


def placements(scene, frame: int) -> tuple[dict[str, np.ndarray], object]:
    """World matrix by object name, and the camera's projection, at a frame."""
    scene.frame_set(frame)
    bpy.context.view_layer.update()
    render = scene.render
    matrices = {item.name: np.array(item.matrix_world, np.float64) for item in scene.objects}
    projection = t.Projection(scene.camera, render.resolution_x, render.resolution_y)
    return matrices, projection


def exported(out: str, frames: str, *options: str) -> dict:
    """A shot of the open scene that a method with history could use, without truth; returns shot.json."""
    return t.export(
        out, "--frames", frames, "--for", "taaSimplest", "--truth-frames", "none", *options
    )


def check(scene, label: str, moves=None, minimum: float = 0.3, limit: float = LIMIT_PX) -> dict:
    """Exports frame 5 after 4 and compares.

    ``moves``: object name -> function(points, name in the shot) that takes current world points to those of the frame
    before, for everything that is not a rigid object."""
    before, projection_before = placements(scene, FRAME - 1)
    now, projection_now = placements(scene, FRAME)
    out = os.path.join(t.temporary_folder(), "shot")
    shot = exported(out, f"{FRAME - 1}-{FRAME}", "--passes", "object,depth")
    entry = shot["frames"][1]
    path = os.path.join(out, entry["file"])
    motion = t.stacked(t.read_part(path, "motion"), "motion.X motion.Y").astype(np.float64)
    depth = t.read_part(path, "depth")["Z"].astype(np.float64)
    ids = t.read_part(path, "object")["id"]
    height, width = depth.shape
    x, y = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    x, y = x + entry["jitter"][0], y + entry["jitter"][1]
    worst, largest = 0.0, 0.0
    for identity in np.unique(ids):
        pixels = ids == identity
        here = np.stack([x[pixels], y[pixels]], -1)
        if identity == 0:
            direction = projection_now.unproject(x[pixels], y[pixels], np.full(pixels.sum(), 1.0e7))
            origin = projection_now.unproject(x[pixels][:1], y[pixels][:1], np.zeros(1))
            past = projection_before.project(direction if projection_now.perspective else origin)
            if not projection_now.perspective:
                past = here  # an orthographic camera sees one direction of the background
        else:
            name = shot["objects"][str(identity)]
            points = projection_now.unproject(x[pixels], y[pixels], depth[pixels])
            if moves and name.split(" #")[0] in moves:
                points = moves[name.split(" #")[0]](points, name)
            else:
                move = before[name] @ np.linalg.inv(now[name])
                points = points @ move[:3, :3].T + move[:3, 3]
            past = projection_before.project(points)
        expected = here - past
        error = np.abs(motion[pixels] - expected).max()
        worst, largest = max(worst, error), max(largest, np.abs(expected).max())
        assert (
            error <= limit
        ), f"{label}: id {identity}: {error:.5f} px (motion up to {np.abs(expected).max():.2f})"
    assert largest >= minimum, f"{label}: nothing moved ({largest} px)"
    print(
        f"     {label}: largest motion {largest:.2f} px, worst error {worst:.6f} px",
        file=sys.stderr,
    )
    return shot


def test_camera() -> None:
    for label, path, values in (
        ("pan", "location", {1: (0, -8, 1), 11: (1.5, -8, 1.4)}),
        ("dolly", "location", {1: (0, -8, 1), 11: (0.3, -5, 1)}),
        ("turn", "rotation_euler", {1: (1.5, 0, 0), 11: (1.52, 0.0, 0.3)}),
        ("roll", "rotation_euler", {1: (1.5, 0, 0), 11: (1.5, 0.4, 0)}),
    ):
        scene, camera = stage()
        t.key(camera, path, values)
        check(scene, label)


def test_lens() -> None:
    scene, camera = stage()
    t.key(camera.data, "lens", {1: 30.0, 11: 60.0})
    check(scene, "zoom")
    scene, camera = stage()
    t.key(camera.data, "lens", {1: 30.0, 11: 50.0})
    t.key(camera, "rotation_euler", {1: (1.5, 0, 0), 11: (1.5, 0.1, 0.3)})
    t.key(camera.data, "shift_x", {1: 0.0, 11: 0.3})
    t.key(camera.data, "shift_y", {1: 0.1, 11: -0.1})
    check(scene, "zoom, turn and shift")
    scene, camera = stage()
    camera.data.type, camera.data.ortho_scale = "ORTHO", 7.0
    t.key(camera.data, "ortho_scale", {1: 6.0, 11: 9.0})
    check(scene, "orthographic zoom")
    scene, camera = stage()
    camera.data.type, camera.data.ortho_scale = "ORTHO", 7.0
    t.key(camera, "location", {1: (0, -8, 1), 11: (1.5, -8, 0.4)})
    t.key(camera.data, "shift_x", {1: 0.0, 11: 0.2})
    check(scene, "orthographic pan and shift")


def test_lens_by_strips_and_drivers() -> None:
    """Whatever animates the lens: strips of the non-linear animation, drivers."""
    scene, camera = stage()
    t.key(camera.data, "lens", {1: 30.0, 11: 60.0})
    animation = camera.data.animation_data
    action, animation.action = animation.action, None
    animation.nla_tracks.new().strips.new("Zoom", 1, action)
    check(scene, "zoom by a strip")
    scene, camera = stage()
    for path, expression in (("lens", "30 + 3 * frame"), ("shift_x", "0.03 * frame")):
        camera.data.driver_add(path).driver.expression = expression
    check(scene, "zoom and shift by drivers")


def test_orthographic() -> None:
    """An orthographic camera that pans, rolls and turns, over still, rigid and bending objects."""

    def make(width=64, height=36, scale=7.0):
        scene, camera = stage(width, height)
        camera.data.type, camera.data.ortho_scale = "ORTHO", scale
        return scene, camera

    for label, path, values in (
        ("pan", "location", {1: (0, -8, 1), 11: (1.5, -8, 1.4)}),
        ("roll", "rotation_euler", {1: (1.5, 0, 0), 11: (1.5, 0.4, 0)}),
        ("turn", "rotation_euler", {1: (1.5, 0, 0), 11: (1.5, 0.0, 0.5)}),
        ("tilt", "rotation_euler", {1: (1.4, 0, 0), 11: (1.6, 0.0, 0.0)}),
    ):
        scene, camera = make()
        t.key(camera, path, values)
        check(scene, f"orthographic {label}")
    for width, height, fit in ((36, 64, "AUTO"), (64, 36, "VERTICAL")):
        scene, camera = make(width, height, 5.0)
        camera.data.sensor_fit = fit
        t.key(camera.data, "shift_y", {1: -0.1, 11: 0.2})
        t.key(camera.data, "ortho_scale", {1: 5.0, 11: 7.0})
        t.key(camera, "location", {1: (0, -8, 1), 11: (1.5, -7, 1.4)})
        t.key(camera, "rotation_euler", {1: (1.4, 0, 0), 11: (1.5, 0.2, 0.5)})
        moving = t.add_object(scene, "Moving", None, (0, -1, 0.5))
        t.key(moving, "location", {1: (-1.5, -1, 0), 11: (1.5, 3, 1)})
        t.key(moving, "rotation_euler", {1: (0, 0, 0), 11: (0.3, 0.2, 0.9)})
        check(scene, f"orthographic, everything moves, {width} x {height} {fit}")
    scene, camera = make()
    holder = bpy.data.objects.new("Holder", None)
    scene.collection.objects.link(holder)
    camera.parent = holder
    holder.scale = (2.0, 2.0, 2.0)
    camera.location = (0, -4, 0.5)
    t.key(holder, "rotation_euler", {1: (0, 0, 0), 11: (0, 0, 0.6)})
    check(scene, "orthographic, held by what turns")


def test_border() -> None:
    """In a border the motion is that of the same pixels of the full picture."""

    def make():
        scene, camera = stage()
        t.key(camera.data, "lens", {1: 30.0, 11: 60.0})
        t.key(camera, "rotation_euler", {1: (1.5, 0, 0), 11: (1.5, 0.1, 0.3)})
        return scene

    def motion_of(scene):
        out = os.path.join(t.temporary_folder(), "shot")
        shot = exported(out, "4-5")
        path = os.path.join(out, shot["frames"][1]["file"])
        return t.stacked(t.read_part(path, "motion"), "motion.X motion.Y"), shot

    full, _ = motion_of(make())
    scene = make()
    scene.render.use_border = True
    scene.render.border_min_x, scene.render.border_max_x = 0.25, 0.75
    scene.render.border_min_y, scene.render.border_max_y = 0.25, 0.5
    part, shot = motion_of(scene)
    left, top = shot["window"]["offset"]
    height, width = part.shape[:2]
    assert (left, top, width, height) == (16, 18, 32, 9), (left, top, width, height)
    assert np.abs(part - full[top : top + height, left : left + width]).max() <= LIMIT_PX
    scene = make()  # 0.7 of 20 rows are 14 in Blender's floats, 13.99 in longer ones
    scene.render.resolution_y = 20
    scene.render.use_border, scene.render.border_min_x, scene.render.border_max_x = True, 0.0, 1.0
    scene.render.border_min_y, scene.render.border_max_y = 0.1, 0.7
    part, shot = motion_of(scene)
    assert part.shape[:2] == (12, 64) and shot["window"]["offset"] == [0, 6], shot["window"]


def test_rigid() -> None:
    scene, camera = stage()
    moving = t.add_object(scene, "Moving", None, (0, -1, 0.5))
    t.key(moving, "location", {1: (-1.5, -1, 0), 11: (1.5, -0.5, 1)})
    t.key(moving, "rotation_euler", {1: (0, 0, 0), 11: (0.3, 0.2, 0.9)})
    t.key(moving, "scale", {1: (1, 1, 1), 11: (1.5, 0.8, 1.2)})
    t.key(camera, "location", {1: (0, -8, 1), 11: (0.5, -7, 1.4)})
    check(scene, "move, turn and scale under a moving camera")


def test_shape_key() -> None:
    """The key stretches the cube along x: an affine map at every value."""
    scene, _ = stage()
    item = t.add_object(scene, "Shape", None, (0.4, -1, 0.5), (0, 0, 0.4))
    item.shape_key_add(name="Basis")
    stretched = item.shape_key_add(name="Stretched")
    for point in stretched.data:
        point.co.x *= 3.0
    t.key(stretched, "value", {1: 0.0, 11: 1.0})
    world = np.array(item.matrix_basis, np.float64)

    def move(points, _name):
        local = (points - world[:3, 3]) @ np.linalg.inv(world[:3, :3]).T
        local[:, 0] *= (1 + 2 * 0.3) / (1 + 2 * 0.4)
        return local @ world[:3, :3].T + world[:3, 3]

    check(scene, "shape key", {"Shape": move})


def test_armature() -> None:
    scene, _ = stage()
    data = bpy.data.armatures.new("Bones")
    rig = bpy.data.objects.new("Rig", data)
    scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 0), (0, 0, 1)
    bpy.ops.object.mode_set(mode="OBJECT")
    item = t.add_object(scene, "Skin", None, (0, 0, 0))
    for vertex in item.data.vertices:
        vertex.co += Vector((0.8, -1.0, 0.6))
    group = item.vertex_groups.new(name="Bone")
    group.add(range(8), 1.0, "REPLACE")
    item.modifiers.new("Armature", "ARMATURE").object = rig
    pose = rig.pose.bones["Bone"]
    pose.rotation_mode = "XYZ"
    pose.keyframe_insert("rotation_euler", frame=1)
    pose.rotation_euler = (0.2, 0.8, 0.3)
    pose.keyframe_insert("rotation_euler", frame=11)
    poses = {}
    for frame in (FRAME - 1, FRAME):
        scene.frame_set(frame)
        bpy.context.view_layer.update()
        rest = data.bones["Bone"].matrix_local
        poses[frame] = np.array(pose.matrix @ rest.inverted(), np.float64)
    move = poses[FRAME - 1] @ np.linalg.inv(poses[FRAME])
    check(scene, "armature", {"Skin": lambda points, _: points @ move[:3, :3].T + move[:3, 3]})


def test_collection_instance() -> None:
    scene, _ = stage()
    source = bpy.data.collections.new("Source")
    part = bpy.data.objects.new("Part", t.cube_mesh("Part", 0.8))
    source.objects.link(part)
    empty = bpy.data.objects.new("Instance", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", source
    scene.collection.objects.link(empty)
    t.key(empty, "location", {1: (-1, -1.5, 0), 11: (1.4, -1, 1)})
    t.key(empty, "rotation_euler", {1: (0, 0, 0), 11: (0.3, 0.2, 0.9)})
    matrices = {}
    for frame in (FRAME - 1, FRAME):
        scene.frame_set(frame)
        bpy.context.view_layer.update()
        matrices[frame] = np.array(empty.matrix_world, np.float64)
    move = matrices[FRAME - 1] @ np.linalg.inv(matrices[FRAME])
    shot = check(
        scene,
        "collection instance",
        {"Part": lambda points, _: points @ move[:3, :3].T + move[:3, 3]},
    )
    assert any(name.startswith("Part #") for name in shot["objects"].values()), shot["objects"]


def instances_of(name: str) -> dict[str, np.ndarray]:
    """Matrices of the instances of an object by their persistent number."""
    found = {}
    for instance in bpy.context.evaluated_depsgraph_get().object_instances:
        if instance.is_instance and instance.object.name == name:
            number = ".".join(str(part) for part in instance.persistent_id if part != 2147483647)
            found[number] = np.array(instance.matrix_world, np.float64)
    return found


def check_instances(scene, label: str, name: str) -> dict:
    """Like ``check`` for instances, which are known by their number in the names of the shot."""
    scene.frame_set(FRAME - 1)
    before = instances_of(name)
    scene.frame_set(FRAME)
    now = instances_of(name)
    assert len(now) > 2 and set(now) == set(
        before
    ), f"{label}: {len(before)} and {len(now)} instances"

    def move(points, label_in_shot):
        number = label_in_shot.split(" #")[1].split(" of ")[0]
        change = before[number] @ np.linalg.inv(now[number])
        return points @ change[:3, :3].T + change[:3, 3]

    shot = check(scene, label, {name: move})
    seen = [value for value in shot["objects"].values() if value.startswith(f"{name} #")]
    assert len(seen) > 2 and len(set(seen)) == len(seen), seen
    return shot


def grains(
    scene: bpy.types.Scene, count: int, first: int, last: int, size: float
) -> bpy.types.Object:
    """An upright emitter of cubes that live for ever and fall not, born from frame ``first`` to ``last``."""
    source = t.add_object(scene, "Grain", t.cube_mesh("Grain", 1.0), (0, -40, 0))
    mesh = bpy.data.meshes.new("Emitter")
    mesh.from_pydata([(-2, -1, 0), (2, -1, 0), (2, -1, 2.4), (-2, -1, 2.4)], [], [(0, 1, 2, 3)])
    emitter = t.add_object(scene, "Emitter", mesh)
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end = count, first, last
    settings.lifetime, settings.physics_type = 1000, "NEWTON"
    settings.normal_factor, settings.effector_weights.gravity = 0.0, 0.0
    settings.render_type, settings.instance_object, settings.particle_size = "OBJECT", source, size
    return emitter


def test_particles() -> None:
    """Cubes on a moving emitter: particle instances."""
    scene, _ = stage()
    settings = grains(scene, 14, -20, -10, 0.35).particle_systems[0].settings
    settings.object_factor, settings.factor_random = 0.0, 1.2
    for frame in range(-20, FRAME + 2):
        scene.frame_set(frame)
    check_instances(scene, "particles", "Grain")


def test_geometry_nodes() -> None:
    """Instances on the points of a grid whose object moves."""
    scene, _ = stage()
    source = t.add_object(scene, "Leaf", t.cube_mesh("Leaf", 0.5), (0, -40, 0))
    mesh = bpy.data.meshes.new("Points")
    mesh.from_pydata([(x, -1, z) for x in (-1.5, -0.5, 0.5, 1.5) for z in (0.1, 1.2)], [], [])
    item = t.add_object(scene, "Points", mesh)
    tree = t.geometry_group("Scatter")
    start, end = tree.nodes["Start"], tree.nodes["End"]
    scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = source
    info.inputs["As Instance"].default_value = True
    tree.links.new(start.outputs[0], scatter.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs[0], end.inputs[0])
    item.modifiers.new("Scatter", "NODES").node_group = tree
    t.key(item, "location", {1: (-1, 0, 0), 11: (1, 0.5, 0.4)})
    t.key(item, "rotation_euler", {1: (0, 0, 0), 11: (0.1, 0.2, 0.3)})
    check_instances(scene, "geometry nodes", "Leaf")


def test_meshes_made_by_nodes() -> None:
    """Instances of a mesh that no object holds; without a material the shot says that they share one id."""
    for material in (t.diffuse, None):
        scene, _ = stage()
        mesh = bpy.data.meshes.new("Points")
        mesh.from_pydata([(x, -1, z) for x in (-1.5, -0.5, 0.5, 1.5) for z in (0.1, 1.2)], [], [])
        item = t.add_object(scene, "Points", mesh)
        tree = t.geometry_group("Scatter")
        scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
        cube = tree.nodes.new("GeometryNodeMeshCube")
        cube.inputs["Size"].default_value = (0.5, 0.5, 0.5)
        made = cube.outputs["Mesh"]
        if material:
            paint = tree.nodes.new("GeometryNodeSetMaterial")
            paint.inputs["Material"].default_value = t.diffuse("Paint", (0.5, 0.5, 0.5))
            tree.links.new(made, paint.inputs["Geometry"])
            made = paint.outputs[0]
        tree.links.new(tree.nodes["Start"].outputs[0], scatter.inputs["Points"])
        tree.links.new(made, scatter.inputs["Instance"])
        tree.links.new(scatter.outputs[0], tree.nodes["End"].inputs[0])
        item.modifiers.new("Scatter", "NODES").node_group = tree
        t.key(item, "location", {1: (-1, 0, 0), 11: (1, 0.5, 0.4)})
        t.key(item, "rotation_euler", {1: (0, 0, 0), 11: (0.1, 0.2, 0.3)})
        if material:
            shot = check_instances(scene, "meshes made by nodes", "Points")
        else:
            shot = check(scene, "meshes made by nodes, no material")
        shared = [note for note in shot["notes"] if "nodes of Points make share one id" in note]
        assert len(shared) == (0 if material else 1), shot["notes"]


def move_by_time(item: bpy.types.Object) -> None:
    """Gives an object nodes that move its points by 0.1 along x a frame."""
    tree = t.geometry_group("Move")
    place = tree.nodes.new("GeometryNodeSetPosition")
    time = tree.nodes.new("GeometryNodeInputSceneTime")
    times, vector = tree.nodes.new("ShaderNodeMath"), tree.nodes.new("ShaderNodeCombineXYZ")
    times.operation, times.inputs[1].default_value = "MULTIPLY", 0.1
    tree.links.new(time.outputs["Frame"], times.inputs[0])
    tree.links.new(times.outputs[0], vector.inputs[0])
    tree.links.new(vector.outputs[0], place.inputs["Offset"])
    tree.links.new(tree.nodes["Start"].outputs[0], place.inputs["Geometry"])
    tree.links.new(place.outputs[0], tree.nodes["End"].inputs[0])
    item.modifiers.new("Move", "NODES").node_group = tree


def moved_by_time(points: np.ndarray, _name: str) -> np.ndarray:
    return points - np.array((0.1, 0.0, 0.0))


def test_deforming_nodes() -> None:
    """Nodes that move all points: by the scene's time and, where Blender has it, by a simulation."""
    scene, _ = stage()
    item = t.add_object(scene, "Shape", None, (0.4, -1, 0.5))
    move_by_time(item)
    check(scene, "moved by nodes", {"Shape": moved_by_time})

    if not hasattr(bpy.types, "GeometryNodeSimulationInput"):  # since 3.6
        return
    scene, _ = stage()
    item = t.add_object(scene, "Shape", None, (0.0, -1, 0.5))
    tree = t.geometry_group("Simulate")
    begin = tree.nodes.new("GeometryNodeSimulationInput")
    end = tree.nodes.new("GeometryNodeSimulationOutput")
    begin.pair_with_output(end)
    place = tree.nodes.new("GeometryNodeSetPosition")
    place.inputs["Offset"].default_value = (0.1, 0, 0)
    tree.links.new(tree.nodes["Start"].outputs[0], begin.inputs["Geometry"])
    tree.links.new(begin.outputs["Geometry"], place.inputs["Geometry"])
    tree.links.new(place.outputs[0], end.inputs["Geometry"])
    tree.links.new(end.outputs["Geometry"], tree.nodes["End"].inputs[0])
    item.modifiers.new("Simulate", "NODES").node_group = tree
    for frame in range(1, FRAME + 2):
        scene.frame_set(frame)
    check(scene, "simulated", {"Shape": moved_by_time})


def test_subdivision() -> None:
    scene, _ = stage()
    item = t.add_object(scene, "Moving", None, (0, -1, 0.5))
    modifier = item.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels, modifier.render_levels = 1, 2
    t.key(item, "location", {1: (-1.5, -1, 0), 11: (1.5, -0.5, 1)})
    t.key(item, "rotation_euler", {1: (0, 0, 0), 11: (0.3, 0.2, 0.9)})
    check(scene, "subdivision")


def test_hair_curves() -> None:
    """Objects of the new hair system; Cycles rounds strands more."""
    if "add_curves" not in bpy.types.Curves.bl_rna.functions:  # before 4.0 scripts cannot make any
        return

    def hairy():
        scene, _ = stage()
        data, count = bpy.data.hair_curves.new("Hair"), 200
        data.add_curves([4] * count)
        roots = np.random.default_rng(1).uniform((-0.5, -1.5, -0.5), (0.5, -0.5, 0.5), (count, 3))
        points = roots[:, None] + np.linspace(0, 1, 4)[:, None] * np.array((0.2, 0, 0.8))
        data.attributes["position"].data.foreach_set("vector", points.astype(np.float32).ravel())
        radius = data.attributes.get("radius") or data.attributes.new("radius", "FLOAT", "POINT")
        radius.data.foreach_set("value", np.full(4 * count, 0.02, np.float32))
        item = bpy.data.objects.new("Hair", data)
        scene.collection.objects.link(item)
        return scene, item

    scene, item = hairy()
    t.key(item, "location", {1: (-1, 0, 0.3), 11: (1, 0, 0.7)})
    check(scene, "hair curves")
    scene, item = hairy()
    move_by_time(item)
    check(scene, "hair curves moved by nodes", {"Hair": moved_by_time})


def test_one_action_for_several_owners() -> None:
    """Since 4.4 an action has a slot for each of its owners."""
    if "action_slot" not in bpy.types.AnimData.bl_rna.properties:
        return
    scene, camera = stage()
    one = t.add_object(scene, "One", None, (0, -1, 0.5))
    other = t.add_object(scene, "Other", None, (1, -1, 0.5))
    t.key(one, "location", {1: (-1.5, -1, 0), 11: (1.5, -0.5, 1)})
    action = one.animation_data.action
    for owner, kind in ((other, "OBJECT"), (camera.data, "CAMERA")):
        owner.animation_data_create().action = action
        owner.animation_data.action_slot = action.slots.new(kind, owner.name)
    t.key(other, "location", {1: (1.5, -1, 0), 11: (-1.5, -0.5, 1)})
    t.key(camera.data, "lens", {1: 30.0, 11: 60.0})
    t.key(camera.data, "shift_x", {1: 0.0, 11: 0.2})
    assert len(action.slots) == 3 and len(t.curves_of(camera.data)) == 2
    check(scene, "one action")


def test_hidden_before_is_invalid() -> None:
    """What was hidden a frame ago has no motion; the shot says so instead of giving 0."""
    scene, _ = stage()
    item = t.add_object(scene, "Appears", None, (0, -2, 0.5))
    t.key(item, "location", {1: (-1.5, -2, 0.5), 11: (1.5, -2, 0.5)})
    item.hide_render = True
    item.keyframe_insert("hide_render", frame=FRAME - 1)
    item.hide_render = False
    item.keyframe_insert("hide_render", frame=FRAME)
    out = os.path.join(t.temporary_folder(), "shot")
    shot = exported(out, "4-6", "--passes", "object")
    entry = shot["frames"][1]
    identity = {name: int(key) for key, name in shot["objects"].items()}["Appears"]
    path = os.path.join(out, entry["file"])
    pixels = t.read_part(path, "object")["id"] == identity
    motion = t.read_part(path, "motion")["motion.X"]
    assert pixels.any() and (motion[pixels] == 1e6).all() and (np.abs(motion[~pixels]) < 1e3).all()
    assert entry["motion_invalid"] == {
        "objects": ["Appears"],
        "pixels": int(pixels.sum()),
        "value": 1e6,
    }
    assert "motion_invalid" not in shot["frames"][2]


def decimated(item: bpy.types.Object) -> bpy.types.Object:
    """Gives an object fewer vertices in frame 5 than in frame 4."""
    item.modifiers.new("Subdivision", "SUBSURF").levels = 3
    t.key(item.modifiers.new("Decimate", "DECIMATE"), "ratio", {4: 1.0, 6: 0.3})
    return item


def sphere_by_time(item: bpy.types.Object) -> None:
    """Nodes that show an instance of a sphere with as many segments as the frame has a number."""
    tree = t.geometry_group("Sphere")
    sphere, time = tree.nodes.new("GeometryNodeMeshUVSphere"), tree.nodes.new(
        "GeometryNodeInputSceneTime"
    )
    paint = tree.nodes.new("GeometryNodeSetMaterial")
    paint.inputs["Material"].default_value = t.diffuse("Paint", (0.5, 0.5, 0.5))
    instance = tree.nodes.new("GeometryNodeGeometryToInstance")
    tree.links.new(time.outputs["Frame"], sphere.inputs["Segments"])
    tree.links.new(sphere.outputs["Mesh"], paint.inputs["Geometry"])
    tree.links.new(paint.outputs[0], instance.inputs[0])
    tree.links.new(instance.outputs[0], tree.nodes["End"].inputs[0])
    item.modifiers.new("Sphere", "NODES").node_group = tree


def test_changing_topology_is_invalid() -> None:
    """Of every kind of object, and of instances."""

    def mesh(scene):
        decimated(t.add_object(scene, "Changing", None, (0, -2, 0.5)))

    def metaball(scene):
        balls = [bpy.data.metaballs.new(name) for name in ("Ball", "Other ball")]
        for data, name in zip(balls, ("Changing", "Changing.001")):
            data.resolution = data.render_resolution = 0.2
            data.elements.new().radius = 1.0
            item = bpy.data.objects.new(name, data)
            scene.collection.objects.link(item)
            item.location = (0, -1, 0.5)
        t.key(item, "location", {1: (-1, -1, 0.5), 11: (2, -1, 0.5)})

    def curve(scene):
        data = bpy.data.curves.new("Curve", "CURVE")
        data.dimensions, data.bevel_depth = "3D", 0.2
        spline = data.splines.new("POLY")
        spline.points.add(9)
        for index, point in enumerate(spline.points):
            point.co = (0.3 * index - 1.5, -1, 0.5 + 0.1 * (index % 2), 1)
        scene.collection.objects.link(bpy.data.objects.new("Changing", data))
        t.key(data, "bevel_factor_end", {1: 0.2, 11: 1.0})

    def text(scene):
        data = bpy.data.curves.new("Text", "FONT")
        data.body = "HHHH"
        item = bpy.data.objects.new("Changing", data)
        scene.collection.objects.link(item)
        item.location, item.rotation_euler = (-1, -1, 0), (1.5, 0, 0)
        t.key(data, "extrude", {4: 0.0, 5: 0.4})

    def instance(scene):
        source = bpy.data.collections.new("Source")
        item = bpy.data.objects.new("Changing", t.cube_mesh("Changing"))
        source.objects.link(decimated(item))
        empty = bpy.data.objects.new("Instance", None)
        empty.instance_type, empty.instance_collection = "COLLECTION", source
        empty.location = (0, -1.5, 0.5)
        scene.collection.objects.link(empty)

    def instance_of_nodes(scene):
        sphere_by_time(t.add_object(scene, "Changing", None, (0, -1, 0.5)))

    for make in (mesh, metaball, curve, text, instance, instance_of_nodes):
        scene, _ = stage()
        make(scene)
        out = os.path.join(t.temporary_folder(), "shot")
        shot = exported(out, "4-5", "--passes", "object")
        entry = shot["frames"][1]
        assert "motion_invalid" in entry, make.__name__
        names = entry["motion_invalid"]["objects"]
        assert [name.split(" #")[0] for name in names] == ["Changing"], (make.__name__, names)
        path = os.path.join(out, entry["file"])
        ids, motion = t.read_part(path, "object")["id"], t.read_part(path, "motion")["motion.X"]
        changing = [int(key) for key, name in shot["objects"].items() if name in names]
        pixels = np.isin(ids, changing)
        assert (motion[pixels] == 1e6).all() and (
            np.abs(motion[~pixels]) < 1e3
        ).all(), make.__name__


def test_cuts() -> None:
    """A marker that binds another camera, and a jump of one camera, drop the history."""
    scene, camera = stage()
    other = t.add_camera(scene, (6, -5, 2))
    scene.camera = camera
    for name, frame, bound in (("A", 1, camera), ("B", 5, other)):
        scene.timeline_markers.new(name, frame=frame).camera = bound
    out = os.path.join(t.temporary_folder(), "shot")
    shot = exported(out, "3-6")
    assert [entry["reset"] for entry in shot["frames"]] == [True, False, True, False]
    assert shot["frames"][1]["camera"]["view"] != shot["frames"][2]["camera"]["view"]
    scene, camera = stage()
    camera.rotation_euler = (1.5, 0, 0)
    camera.keyframe_insert("rotation_euler", frame=4)
    camera.rotation_euler = (1.5, 0, 2.0)
    camera.keyframe_insert("rotation_euler", frame=5)
    shot = t.export(
        os.path.join(t.temporary_folder(), "s"),
        "--frames",
        "3-6",
        "--for",
        "taaSimplest",
        "--truth-frames",
        "none",
    )
    assert [entry["reset"] for entry in shot["frames"]] == [True, False, True, False]
    scene, camera = stage()
    t.key(camera, "location", {1: (0, -8, 1), 11: (0.5, -7, 1.4)})
    shot = t.export(
        os.path.join(t.temporary_folder(), "s"),
        "--frames",
        "1-2,4-5",
        "--for",
        "taaSimplest",
        "--truth-frames",
        "none",
    )
    assert [entry["reset"] for entry in shot["frames"]] == [
        True,
        False,
        True,
        False,
    ], "a gap drops the history"


def test_cameras_of_an_excluded_collection() -> None:
    """They look from where they are, first frame and all, as they do out of a collection that is shown."""

    def found(kind: str, frames: str, excludes: bool) -> list:
        scene, camera = stage()
        other = t.add_camera(scene, (6, -5, 2))
        other.data.type = kind
        rig = t.add_object(scene, "Rig", bpy.data.armatures.new("Rig"))
        other.parent = rig
        t.key(rig, "location", {1: (0, 0, 0), 11: (0, 0, 4)})
        helpers = bpy.data.collections.new("Helpers")
        scene.collection.children.link(helpers)
        for item in (other, rig):
            scene.collection.objects.unlink(item)
            helpers.objects.link(item)
        scene.view_layers[0].layer_collection.children["Helpers"].exclude = excludes
        for frame, bound in ((1, camera), (4, other)):
            scene.timeline_markers.new(bound.name, frame=frame).camera = bound
        shot = exported(os.path.join(t.temporary_folder(), "shot"), frames)
        return [shot["static"], *(entry["camera"] for entry in shot["frames"])]

    for kind in ("PERSP", "ORTHO"):
        for frames in ("3-5", "4-5"):
            shown = found(kind, frames, False)
            assert found(kind, frames, True) == shown, (kind, frames)
            assert not shown[0] and shown[-1] != shown[-2], "can fail"


def resets(make, frames: str = "3-6") -> list[bool]:
    scene, camera = stage()
    make(scene, camera)
    out = os.path.join(t.temporary_folder(), "s")
    shot = exported(out, frames)
    return [entry["reset"] for entry in shot["frames"]]


def test_jumps_of_the_camera() -> None:
    """A jump aside and a jump ahead drop the history; a fast pan does not, nor does following something fast."""

    def jump(target):
        def make(scene, camera):
            t.add_object(scene, "Wall", None, (0, 9, 0), (0, 0, 0), (90, 1, 90))
            camera.rotation_euler = (1.5, 0, 0)
            t.key(camera, "location", {4: (0, -8, 1), 5: target})
            for curve in t.curves_of(camera):
                curve.extrapolation = "CONSTANT"

        return make

    assert resets(jump((25, -8, 1))) == [True, False, True, False], "aside"
    assert resets(jump((-1.4, -1.2, 0.7))) == [True, False, True, False], "ahead"
    assert resets(jump((1.0, -7.0, 1))) == [True, False, False, False], "a step is no jump"

    def follow(scene, camera):
        t.add_object(scene, "Car", None, (0, -2, 1), (0, 0, 0), (9, 1, 6)).parent = camera
        camera.rotation_euler = (1.5708, 0, 0)
        scene.objects["Car"].location = (0, 0, -6)
        t.key(camera, "location", {1: (0, -8, 1), 11: (300, -8, 1)})

    assert resets(follow) == [
        True,
        False,
        False,
        False,
    ], "what it follows stands still in the picture"


def test_new_instances_are_invalid() -> None:
    """Particles that are born in a frame have no motion there; those that were there before have."""
    scene, _ = stage()
    emitter = grains(scene, 24, 1, 9, 0.4)
    emitter.show_instancer_for_render = False
    for frame in range(1, FRAME + 2):
        scene.frame_set(frame)
    numbers = {}
    for frame in (FRAME - 1, FRAME):
        scene.frame_set(frame)
        numbers[frame] = set(instances_of("Grain"))
    born = numbers[FRAME] - numbers[FRAME - 1]
    assert born and numbers[FRAME - 1], numbers
    out = os.path.join(t.temporary_folder(), "shot")
    shot = exported(out, f"{FRAME - 1}-{FRAME}", "--passes", "object")
    entry = shot["frames"][1]
    path = os.path.join(out, entry["file"])
    ids, motion = t.read_part(path, "object")["id"], t.read_part(path, "motion")["motion.X"]
    new = old = 0
    for identity in set(np.unique(ids)) - {0}:
        name = shot["objects"][str(identity)]
        if not name.startswith("Grain #"):
            continue
        pixels = motion[ids == identity]
        if name.split(" #")[1].split(" of ")[0] in born:
            new += 1
            assert (pixels == 1e6).all() and name in entry["motion_invalid"]["objects"], name
        else:
            old += 1
            assert (np.abs(pixels) < 1e3).all(), name
    assert new >= 2 and old >= 4, (new, old, numbers, shot["objects"])


if __name__ == "__main__":
    t.main(
        test_camera,
        test_lens,
        test_lens_by_strips_and_drivers,
        test_orthographic,
        test_border,
        test_rigid,
        test_shape_key,
        test_armature,
        test_collection_instance,
        test_particles,
        test_geometry_nodes,
        test_meshes_made_by_nodes,
        test_deforming_nodes,
        test_subdivision,
        test_hair_curves,
        test_one_action_for_several_owners,
        test_hidden_before_is_invalid,
        test_changing_topology_is_invalid,
        test_cuts,
        test_cameras_of_an_excluded_collection,
        test_jumps_of_the_camera,
        test_new_instances_are_invalid,
    )
