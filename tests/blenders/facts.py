# SPDX-License-Identifier: GPL-3.0-or-later
"""What the exporter rests on, measured in the running Blender: nothing here is concluded from its version.

    blender -b --factory-startup --python-exit-code 9 -P tests/blenders/facts.py [-- NAME ...]

Each fact is one function that gives a short value; equal Blenders give equal words, so figures are rounded to what matters.
One line `FACT {json}` each; facts_table.py makes a table of several Blenders' lines. What the exporter does about a
fact stands beside it.
"""

from __future__ import annotations

import glob
import json
import math
import os
import re
import subprocess
import sys
import traceback
from dataclasses import dataclass
from typing import Callable

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "addon"))
import support as t  # noqa: E402
from support import bpy, np, oiio  # noqa: E402
from aa_resolve import compat  # noqa: E402

WIDTH, HEIGHT = 96, 54


@dataclass
class Fact:
    """A question, the function that answers it, and what of the add-on depends on the answer."""

    group: str
    question: str
    depends: str
    decides: bool
    measure: Callable[[], str]


FACTS: list[Fact] = []


def check_places(depends: str) -> None:
    """A place that is named must be there."""
    for name in re.findall(r"\bcompat\.(\w+)", depends):
        assert hasattr(compat, name), f"compat.py has no {name}"
    for path in re.findall(r"\b\w+/\w+\.py", depends):
        assert os.path.exists(os.path.join(t.ROOT, "blender_addon/aa_resolve", path)), path


def fact(group: str, question: str, depends: str, decides: bool = False):
    """Enters a function into the table; `decides`: the exporter would be another one if it were otherwise."""

    def enter(measure: Callable[[], str]) -> Callable[[], str]:
        check_places(depends)
        FACTS.append(Fact(group, question, depends, decides, measure))
        return measure

    return enter


# ---- scenes and pictures


def plain_scene(width: int = WIDTH, height: int = HEIGHT):
    """Point-sampled and without indirect light, as the exporter renders; no light in it."""
    scene = t.new_scene(width, height)
    bpy.context.preferences.edit.keyframe_new_interpolation_type = "LINEAR"
    cycles = scene.cycles
    cycles.samples, cycles.seed = 1, 0
    cycles.pixel_filter_type, cycles.filter_width = "BLACKMAN_HARRIS", 0.01
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.light_sampling_threshold = 0.0
    cycles.max_bounces = 0
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_object_index = True
    return scene


def boxes(scene) -> None:
    """A floor and five turned boxes with object indices, all diffuse."""
    material = t.diffuse("Grey", (0.8, 0.4, 0.2))
    for index in range(5):
        place = (-2.4 + 1.2 * index, 0.3 * index, 0.5 + 0.1 * index)
        item = t.add_object(scene, f"Box{index}", None, place, (0.2 * index, 0.3, 0.5 * index))
        item.data.materials.append(material)
        item.pass_index = index + 1
    floor = t.add_object(scene, "Floor", t.cube_mesh("Floor", 8.0), (0, 0, -4.0))
    floor.data.materials.append(material)
    floor.pass_index = 9


def rendered(scene, interleave: bool = True) -> str:
    """Path of the multilayer EXR that Blender writes of the present frame."""
    folder = t.temporary_folder()
    settings = scene.render.image_settings
    if hasattr(settings, "media_type"):
        settings.media_type = "MULTI_LAYER_IMAGE"
    settings.file_format, settings.color_depth = "OPEN_EXR_MULTILAYER", "32"
    if hasattr(settings, "use_exr_interleave"):
        settings.use_exr_interleave = interleave
    scene.render.filepath = os.path.join(folder, "frame")
    bpy.ops.render.render(write_still=True)
    (path,) = glob.glob(os.path.join(folder, "*.exr"))
    return path


def parts_of(path: str) -> list[tuple[str, list[str]]]:
    """Name and channels of each part."""
    source, found = oiio.ImageInput.open(path), []
    while source.seek_subimage(len(found), 0):
        spec = source.spec()
        found.append((spec.getattribute("oiio:subimagename") or "", list(spec.channelnames)))
    return found


def picture(scene) -> dict[str, np.ndarray]:
    """Renders; channels without their view layer's name: `Depth.Z`, `Combined.R`, each H x W."""
    source, channels, index = oiio.ImageInput.open(rendered(scene)), {}, 0
    layer = bpy.context.view_layer.name
    while source.seek_subimage(index, 0):
        spec = source.spec()
        pixels = np.asarray(source.read_image(index, 0, 0, spec.nchannels, "float"))
        pixels = pixels.reshape(spec.height, spec.width, spec.nchannels)
        for number, name in enumerate(spec.channelnames):
            channels[name.removeprefix(f"{layer}.")] = pixels[:, :, number]
        index += 1
    return channels


def layer_of(channels: dict[str, np.ndarray], names: str, kind: str = "RGB") -> np.ndarray:
    """H x W x C of the first of `names` (separated by |) that is there."""
    for name in names.split("|"):
        if f"{name}.{kind[0]}" in channels:
            return np.stack([channels[f"{name}.{letter}"] for letter in kind], -1)
    raise KeyError(f"none of {names} among {sorted(channels)}")


IDS, DIFFUSE = "IndexOB|Object Index", "DiffCol|Diffuse Color"
GLOSSY, EMISSION = "GlossCol|Glossy Color", "Emit|Emission"


def below(value: float, limit: float, unit: str = "") -> str:
    """Noise is not a difference between Blenders."""
    return f"below {limit:g}{unit}" if value < limit else f"{value:.3g}{unit}"


def has(owner, *names: str) -> str:
    """Which of the properties there are."""
    return ", ".join(name for name in names if hasattr(owner, name)) or "none"


# ---- sampling


def partly_covered(kind: str, width: float, samples: int) -> int:
    """Pixels of an emitting, turned square that are neither full nor empty."""
    scene = plain_scene()
    t.add_camera(scene, (0, -8, 0), (0, 0, 0))
    material = bpy.data.materials.new("Light")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(shader.outputs[0], tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"])
    square = t.add_object(scene, "Square", None, (0, 0, 0), (0.0, 0.3, 0.0), (3.0, 0.01, 2.0))
    square.data.materials.append(material)
    cycles = scene.cycles
    cycles.pixel_filter_type, cycles.filter_width, cycles.samples = kind, width, samples
    red = picture(scene)["Combined.R"]
    return int(((red > 1e-4) & (red < 1 - 1e-4)).sum())


@fact(
    "sampling",
    "BLACKMAN_HARRIS of width 0.01 at 16 samples is point-sampled",
    "scene/rendering.py",
    decides=True,
)
def narrow_filter() -> str:
    found = partly_covered("BLACKMAN_HARRIS", 0.01, 16)
    return "yes" if found <= 4 else f"no: {found} pixels are mixed"


@fact(
    "sampling", "BOX is 1 pixel wide whatever its width", "truth: scene/rendering.py", decides=True
)
def box_width() -> str:
    widths = [partly_covered("BOX", width, 16) for width in (0.01, 1.0, 1.5)]
    return "yes" if len(set(widths)) == 1 and widths[0] > 50 else f"no: {widths}"


@fact(
    "sampling",
    "sample 0 lies at the pixel's centre, with any filter",
    "scene/camera.py",
    decides=True,
)
def first_sample() -> str:
    worst = 0.0
    for kind, width in (("BLACKMAN_HARRIS", 0.01), ("BLACKMAN_HARRIS", 1.5), ("BOX", 1.0)):
        scene = plain_scene()
        camera = t.add_camera(scene)
        boxes(scene)
        scene.cycles.pixel_filter_type, scene.cycles.filter_width = kind, width
        bpy.context.view_layer.use_pass_position = True
        channels = picture(scene)
        points = layer_of(channels, "Position", "XYZ")
        seen = t.Projection(camera, WIDTH, HEIGHT).project(points.reshape(-1, 3))
        x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
        apart = np.abs(seen - np.stack([x.ravel(), y.ravel()], -1)).max(-1)
        worst = max(worst, apart[channels["Depth.Z"].ravel() < 1e9].max())
    return below(worst, 0.002, " px")


@fact(
    "sampling",
    "jitter by the camera's shift, against a render 8 times as large",
    "scene/camera.py",
    decides=True,
)
def jitter() -> str:
    scene = plain_scene(8 * WIDTH, 8 * HEIGHT)
    camera = t.add_camera(scene)
    boxes(scene)
    fine = picture(scene)
    scene.render.resolution_x, scene.render.resolution_y = WIDTH, HEIGHT
    ids = depths = 0
    for column, row in ((0, 0), (7, 2), (3, 6), (5, 5)):
        right, down = (column + 0.5) / 8 - 0.5, (row + 0.5) / 8 - 0.5
        camera.data.shift_x, camera.data.shift_y = right / WIDTH, -down / WIDTH
        coarse = picture(scene)
        wanted = layer_of(fine, IDS, "X")[row::8, column::8, 0]
        ids += int((layer_of(coarse, IDS, "X")[..., 0] != wanted).sum())
        near = np.isclose(coarse["Depth.Z"], fine["Depth.Z"][row::8, column::8], rtol=1e-4)
        depths += int((~near).sum())
    return f"{ids} ids, {depths} depths differ"


@fact(
    "sampling",
    "of 16 samples depth and object index show one that is at the centre",
    "passes/geometry.py",
)
def only_first_sample() -> str:
    scene = plain_scene()
    t.add_camera(scene)
    boxes(scene)
    scene.cycles.filter_width = 1.5
    one = picture(scene)
    scene.cycles.samples = 16
    many = picture(scene)
    same = np.array_equal(one["Depth.Z"], many["Depth.Z"])
    ids = np.array_equal(layer_of(one, IDS, "X"), layer_of(many, IDS, "X"))
    return f"depth {'yes' if same else 'no'}, index {'yes' if ids else 'no'}"


@fact("sampling", "depth of the background", "scene/camera.py: BACKGROUND_DEPTH")
def background_depth() -> str:
    scene = plain_scene()
    t.add_camera(scene)
    return f"{picture(scene)['Depth.Z'].max():g}"


@fact("sampling", "greatest object index that comes back", "scene/instances.py")
def greatest_index() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    item = t.add_object(scene, "Box", t.cube_mesh("Box", 4.0))
    try:
        item.pass_index = 40000
    except (TypeError, ValueError):
        return "40000 is refused"
    return f"{layer_of(picture(scene), IDS, 'X').max():g}"


# ---- motion


def vectors(prepare: Callable, moved: Callable | None = None, orthographic: bool = False):
    """Vector pass at frame 2, the true positions before and after, and those seen through the present projection."""
    scene = plain_scene()
    camera = t.add_camera(scene)
    if orthographic:
        camera.data.type, camera.data.ortho_scale = "ORTHO", 8.0
    boxes(scene)
    bpy.context.view_layer.use_pass_vector = True
    prepare(camera)
    projections = {}
    for frame in (1, 3, 2):
        scene.frame_set(frame)
        projections[frame] = t.Projection(camera, WIDTH, HEIGHT)
    channels = picture(scene)
    x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)
    depth = channels["Depth.Z"]
    hit = depth < 1e9
    points = projections[2].unproject(x.ravel(), y.ravel(), np.where(hit, depth, 1.0).ravel())
    here = np.stack([x, y], -1)
    true = {f: projections[f].project(points).reshape(here.shape) for f in (1, 3)}
    seen = {}
    for frame in (1, 3):
        present = t.Projection(camera, WIDTH, HEIGHT)
        present.to_view = projections[frame].to_view
        seen[frame] = present.project(points).reshape(here.shape)
    vector = layer_of(channels, "Vector", "XYZW")
    return here, vector, true, seen, hit


def agreement(prepare: Callable, orthographic: bool = False) -> str:
    """Whether Vector.XY holds the whole motion or that through the present projection."""
    here, vector, true, seen, hit = vectors(prepare, orthographic=orthographic)
    before = here + vector[..., :2] * (1, -1)
    whole = np.abs(before - true[1]).max(-1)[hit].max()
    present = np.abs(before - seen[1]).max(-1)[hit].max()
    if whole < 0.002:
        return "the whole motion" if present > 0.002 else "exact"
    if present < 0.002:
        return "without it: both frames by the present projection"
    still = np.abs(vector[..., :2]).max(-1)[hit].max()
    return f"{whole:.2f} px from the truth, {present:.2f} px from the present projection" + (
        " (vectors are 0)" if still == 0 else ""
    )


def keyed(owner, path: str, first, last, index: int = -1) -> None:
    """From frame 1 to frame 3, straight."""
    for frame, value in ((1, first), (3, last)):
        if index >= 0:
            getattr(owner, path)[index] = value
        else:
            setattr(owner, path, value)
        owner.keyframe_insert(path, frame=frame, index=index)


def pan(camera) -> None:
    keyed(camera, "rotation_euler", camera.rotation_euler[2], camera.rotation_euler[2] + 0.2, 2)


def dolly(camera) -> None:
    keyed(camera, "location", -8.0, -7.0, 1)


def slide(camera) -> None:
    keyed(camera, "location", 0.0, 1.0, 0)


MOTION = "passes/motion.py; scene/camera.py"


@fact("motion", "Vector: XY = before - now, ZW = now - after, pixels, y up", MOTION, decides=True)
def vector_signs() -> str:
    here, vector, true, _seen, hit = vectors(lambda c: (pan(c), dolly(c)))
    before = np.abs(here + vector[..., :2] * (1, -1) - true[1]).max(-1)[hit].max()
    after = np.abs(here - vector[..., 2:] * (1, -1) - true[3]).max(-1)[hit].max()
    return "yes" if max(before, after) < 0.002 else f"no: {before:.3g} and {after:.3g} px apart"


@fact("motion", "Vector of the background when the camera turns", MOTION, decides=True)
def vector_of_background() -> str:
    _here, vector, _true, _seen, hit = vectors(pan)
    return "0" if not vector[~hit].any() else f"up to {np.abs(vector[~hit]).max():.2f} px"


@fact("motion", "Vector with an animated lens", MOTION, decides=True)
def vector_lens() -> str:
    return agreement(lambda c: keyed(c.data, "lens", 35.0, 45.0))


@fact("motion", "Vector with an animated lens and a moving camera", MOTION)
def vector_lens_dolly() -> str:
    return agreement(lambda c: (keyed(c.data, "lens", 35.0, 45.0), dolly(c)))


@fact("motion", "Vector with an animated shift", MOTION, decides=True)
def vector_shift() -> str:
    return agreement(lambda c: keyed(c.data, "shift_x", 0.0, 0.1))


@fact("motion", "Vector with an animated orthographic scale", MOTION, decides=True)
def vector_scale() -> str:
    return agreement(lambda c: keyed(c.data, "ortho_scale", 7.0, 9.0), orthographic=True)


@fact("motion", "Vector of a moving orthographic camera", MOTION)
def vector_ortho() -> str:
    return agreement(slide, orthographic=True)


@fact(
    "motion", "Vector of a moving camera with a constant shift, as jitter is", MOTION, decides=True
)
def vector_constant_shift() -> str:
    def shifted(camera) -> None:
        camera.data.shift_x, camera.data.shift_y = 0.3 / WIDTH, -0.2 / WIDTH
        pan(camera)
        dolly(camera)

    return agreement(shifted)


@fact("motion", "Vector of an object hidden in the frame before", "passes/motion.py: _is_wrong")
def vector_of_hidden() -> str:
    scene = plain_scene()
    t.add_camera(scene)
    item = t.add_object(scene, "Box", t.cube_mesh("Box", 2.0))
    bpy.context.view_layer.use_pass_vector = True
    keyed(item, "location", -1.0, 1.0, 0)
    for frame, hidden in ((1, True), (2, False)):
        item.hide_render = hidden
        item.keyframe_insert("hide_render", frame=frame)
    scene.frame_set(2)
    channels = picture(scene)
    hit = channels["Depth.Z"] < 1e9
    vector = layer_of(channels, "Vector", "XY")[hit]
    return "0" if not vector.any() else f"up to {np.abs(vector).max():.2f} px"


@fact("motion", "Vector with motion blur on", "scene/rendering.py: motion blur is off")
def vector_with_blur() -> str:
    scene = plain_scene()
    camera = t.add_camera(scene)
    boxes(scene)
    bpy.context.view_layer.use_pass_vector = True
    pan(camera)
    scene.render.use_motion_blur = True
    scene.frame_set(2)
    channels = picture(scene)
    if not any(name.startswith("Vector") for name in channels):
        return "not written"
    return "0" if not layer_of(channels, "Vector", "XY").any() else "written"


# ---- colour


def facing(material, light: Callable | None = None, noise: bool = False) -> dict[str, np.ndarray]:
    """A plane of that material that fills the picture, seen straight on from 4 m."""
    scene = plain_scene(17, 9)  # odd: the middle pixel looks straight down
    t.add_camera(scene, (0, 0, 4.0), (0, 0, 0))
    scene.camera.rotation_euler = (0, 0, 0)
    plane = t.add_object(scene, "Plane", t.cube_mesh("Plane", 20.0), (0, 0, -10.0))
    plane.data.materials.append(material())
    layer = bpy.context.view_layer
    layer.cycles.denoising_store_passes = True
    layer.use_pass_diffuse_color = layer.use_pass_glossy_color = True
    layer.use_pass_transmission_color = layer.use_pass_emit = True
    if light:
        light(scene)
    return picture(scene)


def principled(**inputs):
    """Base colour .8 .4 .2; inputs by the names that any Blender has, with | between."""

    def make():
        material = bpy.data.materials.new("Principled")
        material.use_nodes = True
        (node,) = (n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
        node.inputs["Base Color"].default_value = (0.8, 0.4, 0.2, 1.0)
        for names, value in inputs.items():
            socket = next(node.inputs[n] for n in ALIASES[names] if n in node.inputs)
            socket.default_value = value
        return material

    return make


ALIASES = {
    "specular": ("Specular", "Specular IOR Level"),
    "emission": ("Emission", "Emission Color"),
    "strength": ("Emission Strength",),
    "metallic": ("Metallic",),
    "coat": ("Clearcoat", "Coat Weight"),
}


def middle(pixels: np.ndarray) -> str:
    return " ".join(f"{value:.3g}" for value in pixels[4, 8])


ALBEDO = "passes/albedo.py"


@fact(
    "colour", "sockets of Principled: specular, emission, coat, subsurface", "compat.emission_color"
)
def sockets() -> str:
    plain_scene()
    material = principled()()
    (node,) = (n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    words = ("Specular", "Emission", "Coat", "coat", "Subsurface", "Transmission", "Sheen")
    chosen = ("Radius", "Scale", "IOR", "Anisotropy", "Roughness", "Normal", "Tint", "Strength")
    found = [i.name for i in node.inputs if any(word in i.name for word in words)]
    return ", ".join(n for n in found if not n.endswith(chosen)) or "none"


@fact(
    "colour",
    "emission of a new Principled: colour, strength",
    "compat.emission_color; light_sources.py",
)
def emission_default() -> str:
    plain_scene()
    material = principled()()
    (node,) = (n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    colour = next(node.inputs[n] for n in ALIASES["emission"] if n in node.inputs)
    return f"{colour.default_value[0]:g}, {node.inputs['Emission Strength'].default_value:g}"


@fact("colour", "denoising albedo: diffuse .8 .4 .2", ALBEDO)
def albedo_diffuse() -> str:
    shader = facing(lambda: t.diffuse("Diffuse", (0.8, 0.4, 0.2)))
    return middle(layer_of(shader, "Denoising Albedo"))


@fact("colour", "denoising albedo: Principled as it comes", ALBEDO, decides=True)
def albedo_principled() -> str:
    return middle(layer_of(facing(principled()), "Denoising Albedo"))


@fact("colour", "denoising albedo: Principled without specular", ALBEDO)
def albedo_matte() -> str:
    return middle(layer_of(facing(principled(specular=0.0)), "Denoising Albedo"))


@fact("colour", "denoising albedo: Principled, metallic 1", ALBEDO)
def albedo_metal() -> str:
    return middle(layer_of(facing(principled(metallic=1.0)), "Denoising Albedo"))


@fact("colour", "denoising albedo contains emission (2 of white)", ALBEDO)
def albedo_emission() -> str:
    material = principled(specular=0.0, emission=(1, 1, 1, 1), strength=2.0)
    channels = facing(material)
    albedo, emitted = layer_of(channels, "Denoising Albedo"), layer_of(channels, EMISSION)
    return f"{middle(albedo)}; Emission pass {middle(emitted)}"


@fact(
    "colour",
    "sum of the colour passes: Principled as it comes",
    "not used: " + ALBEDO,
    decides=True,
)
def colour_sum() -> str:
    channels = facing(principled())
    return middle(layer_of(channels, DIFFUSE) + layer_of(channels, GLOSSY))


@fact(
    "colour",
    "view transform of a new scene",
    "display transforms are aaresolve's; exports are linear",
)
def view_transform() -> str:
    bpy.ops.wm.read_factory_settings(use_empty=False)
    return bpy.context.scene.view_settings.view_transform


@fact("colour", "film exposure and view transform touch the EXR", "exporter sets neither")
def view_in_file() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    boxes(scene)
    t.add_sun(scene)
    before = picture(scene)["Combined.R"]
    scene.view_settings.exposure, scene.view_settings.gamma = 2.0, 1.5
    display = np.abs(picture(scene)["Combined.R"] - before).max()
    scene.cycles.film_exposure = 2.0
    film = np.abs(picture(scene)["Combined.R"] - 2.0 * before).max()
    return f"view {'no' if display == 0 else 'yes'}, film {'yes' if film < 1e-5 else 'no'}"


# ---- light


def lamp(scene, kind: str, place=(0.0, 0.0, 2.0), **settings):
    """A light that looks down."""
    data = bpy.data.lights.new(kind, kind)
    item = bpy.data.objects.new(kind, data)
    item.location = place
    for name, value in settings.items():
        setattr(data, name, value)
    scene.collection.objects.link(item)
    return data


def noise(*lights: tuple[str, dict]) -> str:
    """Share of pixels that one sample shows otherwise than 64 do. Two seeds would not tell: the first sample of some
    Blenders is the same for both."""
    scene = plain_scene()
    t.add_camera(scene)
    boxes(scene)
    for number, (kind, settings) in enumerate(lights):
        lamp(scene, kind, (2.0 * number - 1.0, -2.0, 4.0), energy=300.0, **settings)
    one = layer_of(picture(scene), "Combined")
    scene.cycles.samples = 64
    many = layer_of(picture(scene), "Combined")
    if not many.any():
        return "no light at all"
    apart = np.abs(one - many).max(-1) > 0.02 * np.abs(many).max()
    share = 100.0 * apart.mean()
    return (
        "none"
        if share < 0.5
        else f"{10 * round(share / 10):.0f} % of pixels"
        if share > 5
        else f"{share:.1f} % of pixels"
    )


@fact(
    "light",
    "the first sample depends on the seed (two lights)",
    "tests: noise is found by more samples",
)
def seed_matters() -> str:
    scene = plain_scene()
    t.add_camera(scene)
    boxes(scene)
    for place in ((-1, -2, 4), (1, -2, 4)):
        lamp(scene, "POINT", place, energy=300.0, shadow_soft_size=0.0)
    pictures = []
    for seed in (0, 7):
        scene.cycles.seed = seed
        pictures.append(layer_of(picture(scene), "Combined"))
    return "yes" if (pictures[0] != pictures[1]).any() else "no"


LIGHTS = "scene/lighting.py"


@fact("light", "noise at 1 sample: point light of radius 0", LIGHTS, decides=True)
def noise_point() -> str:
    return noise(("POINT", {"shadow_soft_size": 0.0}))


@fact("light", "noise at 1 sample: spot light of radius 0", LIGHTS, decides=True)
def noise_spot() -> str:
    return noise(("SPOT", {"shadow_soft_size": 0.0, "spot_size": 2.0}))


@fact("light", "noise at 1 sample: sun of angle 0", LIGHTS, decides=True)
def noise_sun() -> str:
    return noise(("SUN", {"angle": 0.0}))


@fact(
    "light", "noise at 1 sample: round area light of 1e-6 m", LIGHTS + ": _POINT_SIZE", decides=True
)
def noise_area() -> str:
    return noise(("AREA", {"size": 1e-6, "shape": "DISK"}))


@fact("light", "area light of size 0", LIGHTS + ": _POINT_SIZE is not 0")
def area_of_nothing() -> str:
    return "dark" if noise(("AREA", {"size": 0.0})) == "no light at all" else "shines"


@fact("light", "noise at 1 sample: area light of 1 m", LIGHTS)
def noise_area_large() -> str:
    return noise(("AREA", {"size": 1.0}))


@fact("light", "noise at 1 sample: two point lights of radius 0", LIGHTS, decides=True)
def noise_two() -> str:
    return noise(*[("POINT", {"shadow_soft_size": 0.0})] * 2)


@fact("light", "one light after the other, summed, against 1024 samples of both", LIGHTS)
def sum_of_lights() -> str:
    scene = plain_scene(32, 18)
    t.add_camera(scene)
    boxes(scene)
    for place in ((-1, -2, 4), (1, -2, 4)):
        lamp(scene, "POINT", place, energy=300.0, shadow_soft_size=0.0)
    lights = [item for item in scene.objects if item.type == "LIGHT"]
    total = 0.0
    for light in lights:
        for other in lights:
            other.hide_render = other is not light
        total = total + layer_of(picture(scene), "Combined")
    for other in lights:
        other.hide_render = False
    scene.cycles.samples = 1024
    both = layer_of(picture(scene), "Combined")
    return below(
        abs(float((total - both).mean())) / float(both.mean()), 0.005, " of the mean apart"
    )


def against_formula(kind: str, expected: float, samples: int = 1, **settings) -> str:
    """Radiance below a light 2 m above a white diffuse plane, through the formula's."""

    def lit(scene) -> None:
        lamp(scene, kind, **settings)
        scene.cycles.samples = samples

    channels = facing(lambda: t.diffuse("White", (1.0, 1.0, 1.0)), lit)
    return f"{float(layer_of(channels, 'Combined')[4, 8, 0]) / expected:.2f}"


@fact("light", "point of power P at d, through P/(4 pi^2 d^2)", LIGHTS)
def power_point() -> str:
    wanted = 100.0 / (4 * math.pi**2 * 4)
    return against_formula("POINT", wanted, energy=100.0, shadow_soft_size=0.0)


@fact("light", "spot of power P at d, through P/(4 pi^2 d^2)", LIGHTS)
def power_spot() -> str:
    wanted = 100.0 / (4 * math.pi**2 * 4)
    return against_formula(
        "SPOT", wanted, energy=100.0, shadow_soft_size=0.0, spot_size=2.0, spot_blend=0.0
    )


@fact("light", "area of power P and 0.1 m at d, through P/(pi^2 d^2)", LIGHTS + ": stand-in")
def power_area() -> str:
    wanted = 100.0 / (math.pi**2 * 4)
    return against_formula("AREA", wanted, samples=256, energy=100.0, size=0.1)


@fact("light", "round area of power P and 0.1 m at d, through P/(pi^2 d^2)", LIGHTS + ": stand-in")
def power_disk() -> str:
    wanted = 100.0 / (math.pi**2 * 4)
    return against_formula("AREA", wanted, samples=256, energy=100.0, size=0.1, shape="DISK")


@fact("light", "areas of 1e-6 m, round and square, through one of 0.1 m", LIGHTS + ": round")
def power_tiny_area() -> str:
    found = []
    for shape in ("DISK", "SQUARE"):
        large = float(against_formula("AREA", 1.0, samples=256, energy=1000.0, size=0.1))
        found.append(against_formula("AREA", large, energy=1000.0, size=1e-6, shape=shape))
    return ", ".join(value if float(value) < 2 else "thousands" for value in found)


@fact("light", "point of power P and radius 0.1 m at d, through P/(4 pi^2 d^2)", LIGHTS)
def power_sphere() -> str:
    wanted = 100.0 / (4 * math.pi**2 * 4)
    return against_formula("POINT", wanted, samples=256, energy=100.0, shadow_soft_size=0.1)


@fact("light", "sun of strength S, through S/pi", LIGHTS)
def power_sun() -> str:
    return against_formula("SUN", 3.0 / math.pi, energy=3.0, angle=0.0)


@fact("light", "properties of a light that older ones lack", "compat.is_normalized")
def light_properties() -> str:
    plain_scene()
    light = bpy.data.lights.new("Point", "POINT")
    return has(light, "normalize", "exposure", "use_soft_falloff", "use_temperature")


@fact("light", "light linking", LIGHTS + ": asked by hasattr")
def light_linking() -> str:
    scene = plain_scene()
    return has(t.add_object(scene, "Box"), "light_linking")


@fact("light", "models of the sky texture", "scene/world_light.py")
def sky_models() -> str:
    plain_scene()
    world = bpy.data.worlds.new("World")
    world.use_nodes = True
    sky = world.node_tree.nodes.new("ShaderNodeTexSky")
    items = [item.identifier for item in sky.bl_rna.properties["sky_type"].enum_items]
    return f"{', '.join(items)}; new: {sky.sky_type}"


@fact("light", "sky texture with a sun disc in an unlit picture at 1 sample", LIGHTS)
def sky_picture() -> str:
    scene = plain_scene()
    t.add_camera(scene, (0, -8, 1.0), (0, 0, 3.5))
    boxes(scene)
    scene.world = bpy.data.worlds.new("World")
    scene.world.use_nodes = True
    nodes = scene.world.node_tree.nodes
    background = next(n for n in nodes if n.type == "BACKGROUND")
    sky = nodes.new("ShaderNodeTexSky")
    scene.world.node_tree.links.new(sky.outputs[0], background.inputs[0])
    visibility = scene.world.cycles_visibility
    visibility.diffuse = visibility.glossy = visibility.transmission = visibility.scatter = False
    pictures = []
    for seed in (0, 7):
        scene.cycles.seed = seed
        channels = picture(scene)
        pictures.append(layer_of(channels, "Combined"))
    surfaces = channels["Depth.Z"] < 1e9
    seen = float(pictures[0][~surfaces].mean()) if (~surfaces).any() else 0.0
    lit = float(pictures[0][surfaces].max())
    words = "without noise" if np.array_equal(*pictures) else "noisy"
    return (
        f"{words}, {'seen' if seen > 0 else 'not seen'}, surfaces {'lit' if lit > 1e-6 else 'dark'}"
    )


@fact(
    "light",
    "material keeps its emission from being sampled as a light",
    "compat.light_sampling_off",
)
def emission_sampling() -> str:
    plain_scene()
    return has(bpy.data.materials.new("M").cycles, "emission_sampling", "sample_as_light")


# ---- files


def use_views(scene) -> None:
    """As many as are added from now on, all in one file."""
    scene.render.use_multiview, scene.render.views_format = True, "MULTIVIEW"
    if hasattr(scene.render.image_settings, "media_type"):
        scene.render.image_settings.media_type = "MULTI_LAYER_IMAGE"
    scene.render.image_settings.file_format = (
        "OPEN_EXR_MULTILAYER"  # the choice below depends on it
    )
    scene.render.image_settings.views_format = "MULTIVIEW"
    for view in list(scene.render.views):
        view.use = False


@fact(
    "files",
    "several cameras in one render, against renders of each",
    "scene/views.py",
    decides=True,
)
def multi_view() -> str:
    offsets = ((0.0, 0.0), (0.3, -0.2), (-0.4, 0.1), (0.2, 0.45))
    scene = plain_scene()
    camera = t.add_camera(scene)
    boxes(scene)
    t.add_sun(scene)
    single = []
    for right, down in offsets:
        camera.data.shift_x, camera.data.shift_y = right / WIDTH, -down / WIDTH
        single.append(picture(scene))
    camera.data.shift_x = camera.data.shift_y = 0.0
    render = scene.render
    use_views(scene)
    for number, (right, down) in enumerate(offsets):
        view = render.views.new(f"k{number}")
        view.camera_suffix = f".k{number}"
        data = camera.data.copy()
        item = bpy.data.objects.new(f"Camera.k{number}", data)
        scene.collection.objects.link(item)
        item.parent = camera
        data.shift_x, data.shift_y = right / WIDTH, -down / WIDTH
    scene.camera = bpy.data.objects["Camera.k0"]
    channels = picture(scene)
    worst = 0.0
    for number, alone in enumerate(single):
        for name in ("Depth.Z", "Combined.R", "Combined.G"):
            part, letter = name.split(".")
            known = [
                n for n in channels if n in (f"{part}.k{number}.{letter}", f"k{number}.{name}")
            ]
            if not known:
                return f"views are named otherwise: {sorted(channels)[:4]}"
            worst = max(worst, float(np.abs(channels[known[0]] - alone[name]).max()))
    return "equal to the last bit" if worst == 0.0 else f"differs by {worst:.2g}"


def full_scene():
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    layer = bpy.context.view_layer
    for name in ("position", "normal", "vector", "diffuse_color", "glossy_color"):
        setattr(layer, f"use_pass_{name}", True)
    layer.use_pass_transmission_color = layer.use_pass_emit = layer.use_pass_environment = True
    layer.cycles.denoising_store_passes = True
    return scene


@fact("files", "names of the passes in a multilayer EXR", "compat.PASS_NAMES")
def pass_names() -> str:
    scene = full_scene()
    layer = bpy.context.view_layer.name
    names = []
    for part, channels in parts_of(rendered(scene)):
        for channel in channels:
            name = channel.removeprefix(f"{layer}.").rsplit(".", 1)[0]
            names.append(name)
    return ", ".join(sorted(set(names)))


@fact("files", "interleaved or not can be chosen", "compat.set_multilayer_exr")
def interleave_choice() -> str:
    return has(plain_scene().render.image_settings, "use_exr_interleave", "media_type")


@fact("files", "parts of a multilayer EXR: as it comes, interleaved", "compat.set_multilayer_exr")
def exr_parts() -> str:
    counts = []
    for interleave in (False, True):
        parts = parts_of(rendered(full_scene(), interleave))
        named = f" ('{parts[0][0]}', ...)" if len(parts) > 1 else ""
        counts.append(f"{len(parts)}{named}")
    return "; ".join(counts)


@fact(
    "files",
    "parts of an EXR of two views, and where the view's name stands",
    "exr.py; scene/views.py",
)
def view_names() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    use_views(scene)
    for name in ("k0", "k1"):
        scene.render.views.new(name).camera_suffix = f".{name}"
        item = bpy.data.objects.new(f"Camera.{name}", scene.camera.data)
        item.matrix_world = scene.camera.matrix_world
        scene.collection.objects.link(item)
    scene.camera = bpy.data.objects["Camera.k0"]
    parts = parts_of(rendered(scene))
    depth = [c for _name, channels in parts for c in channels if "Depth" in c and "k1" in c]
    return f"{len(parts)}; {depth[0] if depth else 'no such channel'}"


@fact(
    "files",
    "pixels of the Render Result without a window",
    "exr.py: the file is read back",
    decides=True,
)
def render_result() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    rendered(scene)
    return f"{len(bpy.data.images['Render Result'].pixels) if 'Render Result' in bpy.data.images else 0}"


@fact(
    "files",
    "lines on stdout and stderr for one rendered frame",
    "support.py, job.py: read our own lines only",
)
def said() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    scene.cycles.samples = 16
    blend = t.save(scene, os.path.join(t.temporary_folder(), "scene.blend"))
    out = os.path.join(t.temporary_folder(), "frame")
    command = [bpy.app.binary_path, "-b", "--factory-startup", blend, "-o", out, "-f", "1"]
    done = subprocess.run(command, capture_output=True, text=True)
    lines = [line for line in done.stdout.splitlines() if line.strip()]
    first = next(
        (line for line in lines if "Sample" in line or "Fra:" in line), "no line of progress"
    )
    words = "time and category first" if first[:2].isdigit() else f"'{first[:4]}...'"
    extra = sum("Traceback" in line for line in done.stderr.splitlines())
    many = "many lines" if len(lines) > 10 else "few lines"
    return f"{many}; progress: {words}; {extra} of its own tracebacks"


# ---- what Blender's files hold


@fact("data", "F-curves of an action", "compat.action_curves")
def actions() -> str:
    scene = plain_scene()
    item = t.add_object(scene, "Box")
    item.keyframe_insert("location", frame=1)
    action = item.animation_data.action
    words = has(action, "fcurves", "layers")
    return f"{words}{'; ' + str(len(action.slots)) + ' slot' if hasattr(action, 'slots') else ''}"


@fact("data", "geometry nodes: owner of a tree's inputs", "asked by hasattr")
def node_interface() -> str:
    plain_scene()
    return has(bpy.data.node_groups.new("Tree", "GeometryNodeTree"), "interface", "inputs")


@fact("data", "hair curves: made by Python, seen by Cycles, Vector of them", "scene/suitability.py")
def hair_curves() -> str:
    scene = plain_scene()
    if not hasattr(bpy.data, "hair_curves"):
        return "no such data"
    t.add_camera(scene, (0, -4, 0), (0, 0, 0))
    bpy.context.view_layer.use_pass_vector = True
    data = bpy.data.hair_curves.new("Hair")
    if not hasattr(data, "add_curves"):
        return "data, but no way to add curves"
    data.add_curves([3] * 9)
    points = np.array(
        [(x * 0.2 - 0.8, 0.0, z * 0.5 - 0.5) for x in range(9) for z in range(3)], np.float32
    )
    data.position_data.foreach_set("vector", points.ravel())
    for point in data.points:
        point.radius = 0.03
    item = bpy.data.objects.new("Hair", data)
    item.pass_index = 3
    scene.collection.objects.link(item)
    keyed(item, "location", 0.0, 0.4, 0)
    scene.frame_set(2)
    channels = picture(scene)
    hit = layer_of(channels, IDS, "X")[..., 0] == 3
    if not hit.any():
        return "made, not seen"
    moved = layer_of(channels, "Vector", "X")[hit]
    expected = -0.2 * 40.0 / 36.0 * WIDTH / 4.0
    near = np.abs(moved - expected).max()
    return f"made, seen, Vector {'right' if near < 0.15 else f'{near:.2f} px off'}"


@fact(
    "data",
    "instances: Object Info's Random in an AOV is the depsgraph's random_id",
    "scene/instances.py",
)
def instance_random() -> str:
    scene = plain_scene()
    t.add_camera(scene)
    group = bpy.data.collections.new("Group")
    source = t.add_object(scene, "Source", t.cube_mesh("Source", 0.8))
    scene.collection.objects.unlink(source)
    group.objects.link(source)
    for number in range(3):
        holder = t.add_object(scene, f"Holder{number}", None, (number - 1.0, 0.0, 0.5))
        scene.collection.objects.unlink(holder)
        holder = bpy.data.objects.new(f"Instance{number}", None)
        holder.location = (number - 1.0, 0.0, 0.5)
        holder.instance_type, holder.instance_collection = "COLLECTION", group
        scene.collection.objects.link(holder)
    layer = bpy.context.view_layer
    output = layer.aovs.add()
    output.name, output.type = "Chance", "VALUE"
    material = bpy.data.materials.new("Chance")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    target = nodes.new("ShaderNodeOutputAOV")
    setattr(target, "aov_name" if hasattr(target, "aov_name") else "name", "Chance")
    chance = nodes.new("ShaderNodeObjectInfo").outputs["Random"]
    material.node_tree.links.new(chance, target.inputs["Value"])
    layer.material_override = material
    channels = picture(scene)
    (name,) = (n for n in channels if n.startswith("Chance"))
    seen = set(np.unique(channels[name][channels["Depth.Z"] < 1e9]).tolist())
    known = bpy.context.evaluated_depsgraph_get().object_instances
    wanted = [np.float32((i.random_id & 0xFFFFFFFF) / 0xFFFFFFFF) for i in known if i.is_instance]
    found = sum(any(abs(value - chance) < 1e-6 for chance in seen) for value in wanted)
    return f"{found} of {len(wanted)}"


def share_of_front(alpha: float) -> str:
    """Pixels in which the index of a sheet of that alpha is found, of the rest that of a wall behind."""
    scene = plain_scene(32, 18)
    t.add_camera(scene, (0, -4, 0), (0, 0, 0))
    material = principled()()
    (node,) = (n for n in material.node_tree.nodes if n.type == "BSDF_PRINCIPLED")
    node.inputs["Alpha"].default_value = alpha
    sheet = bpy.data.meshes.new("Sheet")
    corners = [(x, 0.0, z) for x, z in ((-9, -9), (9, -9), (9, 9), (-9, 9))]
    sheet.from_pydata(corners, [], [(0, 1, 2, 3)])
    front = t.add_object(scene, "Sheet", sheet)
    front.data.materials.append(material)
    front.pass_index = 1
    back = t.add_object(scene, "Wall", None, (0, 3, 0), (0, 0, 0), (30, 0.1, 30))
    back.pass_index = 2
    scene.cycles.transparent_max_bounces = 8
    bpy.context.view_layer.pass_alpha_threshold = 0.5
    share = (layer_of(picture(scene), IDS, "X") == 1).mean()
    return {0.0: "behind", 1.0: "the surface"}.get(float(share), "either by chance")


@fact("data", "index at alpha 1, 0.7, 0.3, 0 and a pass threshold of 0.5", "scene/rendering.py")
def alpha_threshold() -> str:
    return ", ".join(share_of_front(alpha) for alpha in (1.0, 0.7, 0.3, 0.0))


@fact("data", "smooth by angle", "compat.corner_normals")
def auto_smooth() -> str:
    plain_scene()
    mesh = bpy.data.meshes.new("M")
    words = has(mesh, "use_auto_smooth")
    operator = "shade_auto_smooth" in dir(bpy.ops.object)
    return f"property of the mesh: {words}; modifier: {'yes' if operator else 'no'}"


@fact("data", "adaptive subdivision: its owner", "compat.is_diced")
def adaptive() -> str:
    scene = plain_scene()
    item = t.add_object(scene, "Box")
    modifier = item.modifiers.new("Subdivision", "SUBSURF")
    owners = [
        name
        for name, owner in (("object.cycles", item.cycles), ("modifier", modifier))
        if hasattr(owner, "use_adaptive_subdivision")
    ]
    return f"{', '.join(owners) or 'none'}; feature set: {has(scene.cycles, 'feature_set')}"


@fact("data", "displacement: bump or true", "compat.displacement_method")
def displacement() -> str:
    plain_scene()
    material = bpy.data.materials.new("M")
    owners = (("material", material), ("material.cycles", material.cycles))
    return ", ".join(n for n, owner in owners if hasattr(owner, "displacement_method")) or "none"


@fact("data", "compositor: its nodes", "compat.compositor_in_use")
def compositor() -> str:
    return has(plain_scene(), "node_tree", "compositing_node_group")


@fact("data", "panorama: its owner", "compat.panorama_settings")
def panorama() -> str:
    plain_scene()
    camera = bpy.data.cameras.new("C")
    owners = (("camera", camera), ("camera.cycles", getattr(camera, "cycles", None)))
    return ", ".join(name for name, owner in owners if hasattr(owner, "panorama_type")) or "none"


@fact("data", "name of an AOV output node", "compat.name_aov_output")
def aov() -> str:
    plain_scene()
    material = bpy.data.materials.new("M")
    material.use_nodes = True
    node = material.node_tree.nodes.new("ShaderNodeOutputAOV")
    return "aov_name" if hasattr(node, "aov_name") else "name"


@fact("data", "strips of the sequencer", "compat.strips")
def sequencer() -> str:
    editor = plain_scene().sequence_editor_create()
    return has(editor, "strips_all", "sequences_all")


@fact("data", "Grease Pencil: types of object", "scene/feature_rows.py")
def grease_pencil() -> str:
    items = bpy.types.Object.bl_rna.properties["type"].enum_items
    return ", ".join(i.identifier for i in items if "PENCIL" in i.identifier) or "none"


@fact(
    "data", "ids of render engines that can be set", "asked; headless.py says what it renders with"
)
def engines() -> str:
    scene = plain_scene()
    found = []
    for name in ("BLENDER_EEVEE", "BLENDER_EEVEE_NEXT", "BLENDER_WORKBENCH", "CYCLES"):
        try:
            scene.render.engine = name
            found.append(name)
        except TypeError:
            pass
    return ", ".join(found)


@fact("data", "extension platform", "blender_manifest.toml and bl_info: both in the zip")
def extensions() -> str:
    return "yes" if hasattr(bpy.context.preferences, "extensions") else "no"


@fact("data", "a progress bar in panels", "compat.draw_progress")
def progress_bar() -> str:
    return "yes" if "progress" in bpy.types.UILayout.bl_rna.functions else "no"


@fact("data", "new scene: samples, adaptive, denoise, light tree", "scene/rendering.py sets each")
def defaults() -> str:
    bpy.ops.wm.read_factory_settings(use_empty=False)
    cycles = bpy.context.scene.cycles
    tree = getattr(cycles, "use_light_tree", "no such")
    return f"{cycles.samples}, {cycles.use_adaptive_sampling}, {cycles.use_denoising}, {tree}"


@fact("data", "sequences of samples", "compat.sampling_pattern")
def patterns() -> str:
    cycles, found = plain_scene().cycles, []
    for name in ("SOBOL", "PROGRESSIVE_MULTI_JITTER", "TABULATED_SOBOL", "BLUE_NOISE", "AUTOMATIC"):
        try:
            cycles.sampling_pattern = name
            found.append(name)
        except TypeError:
            pass
    return ", ".join(found)


@fact("data", "a part of all samples", "compat.samples_from")
def subset() -> str:
    return has(plain_scene().cycles, "sample_offset", "use_sample_subset")


@fact("data", "world of a view layer", "compat.world_of")
def layer_world() -> str:
    plain_scene()
    return has(bpy.context.view_layer, "world_override")


@fact("data", "denoising on in a render", "scene/rendering.py: denoising is off", decides=True)
def denoiser() -> str:
    scene = plain_scene(16, 9)
    t.add_camera(scene)
    scene.cycles.use_denoising = True
    try:
        picture(scene)
    except RuntimeError as error:
        return f"refused: {str(error).strip().splitlines()[0][:60]}"
    return "works"


@fact("data", "Python, numpy", "stdlib and numpy only")
def python() -> str:
    return f"{sys.version_info[0]}.{sys.version_info[1]}, {np.__version__}"


def main() -> None:
    wanted = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    print("BLENDER " + json.dumps(bpy.app.version_string), flush=True)
    for entry in FACTS:
        name = entry.measure.__name__
        if wanted and name not in wanted:
            continue
        try:
            value = entry.measure()
        except Exception as error:  # a fact that cannot be measured is a fact
            traceback.print_exc()
            value = f"not measured: {type(error).__name__}: {str(error).splitlines()[0][:80]}"
        row = {**vars(entry), "measure": name, "value": value}
        print(f"\nFACT {json.dumps(row)}", flush=True)


main()
sys.exit(0)  # a render that was refused would count as Blender's own failure
