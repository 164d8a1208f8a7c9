# SPDX-License-Identifier: GPL-3.0-or-later
"""Textures as a rasteriser reads them: without the jitter, and from mip maps; truth and everything else as before."""

from __future__ import annotations

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import support as t  # noqa: E402
from support import bpy, np  # noqa: E402

from aa_resolve import jitter  # noqa: E402
from aa_resolve.errors import UsageError  # noqa: E402

SIDE = 64


def image_of(pixels: np.ndarray, name: str = "Pattern") -> bpy.types.Image:
    """Float image without colour management; rows from the bottom, as Blender keeps them."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height, alpha=True, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    image.pixels.foreach_set(np.ascontiguousarray(pixels, np.float32).ravel())
    image.update()
    image.pack()
    return image


def emitting(item, node_of) -> bpy.types.NodeTree:
    """Gives an object a material that shows what ``node_of(tree)`` returns: a socket."""
    material = bpy.data.materials.new("Shown")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(node_of(tree), shader.inputs["Color"])
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    item.data.materials.append(material)
    return tree


def show_image(image, extension="REPEAT", interpolation="Linear", scale=1.0):
    """``node_of`` for an image behind a Mapping node."""

    def build(tree):
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.extension, node.interpolation = image, extension, interpolation
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        mapping = tree.nodes.new("ShaderNodeMapping")
        mapping.inputs["Scale"].default_value = (scale, scale, scale)
        tree.links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])
        tree.links.new(mapping.outputs[0], node.inputs["Vector"])
        return node.outputs["Color"]

    return build


def plane(scene, half=1.0, tilt=0.0):
    """A square with the texture once across; upright and facing -y at tilt 0."""
    mesh = bpy.data.meshes.new("Plane")
    corners = [(-half, 0, -half), (half, 0, -half), (half, 0, half), (-half, 0, half)]
    mesh.from_pydata(corners, [], [(0, 1, 2, 3)])
    layer = mesh.uv_layers.new(name="UVMap")
    for corner, place in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1))):
        corner.uv = place
    return t.add_object(scene, "Plane", mesh, rotation=(tilt, 0, 0))


def orthographic(scene, height: float):
    """A camera in front of the plane that sees a square of this side."""
    camera = t.add_camera(scene, (0, -5, 0), (0, 0, 0))
    camera.data.type, camera.data.ortho_scale = "ORTHO", height
    return camera


def pixels_of(*options: str, kind: str = "frames", part: str = "color") -> np.ndarray:
    """H x W x 3 of frame 1, and of truth where asked."""
    out = os.path.join(t.temporary_folder(), "shot")
    if kind == "frames":
        options = (*options, "--truth-frames", "none")
    t.export(out, "--frames", "1", *options)
    return t.stacked(t.read_part(os.path.join(out, kind, "000001.exr"), part), "R G B")


def noise(seed: int = 5, side: int = SIDE) -> np.ndarray:
    pixels = np.random.default_rng(seed).uniform(0.05, 0.95, (side, side, 4))
    pixels[..., 3] = 1.0
    return pixels


def one_level(*options: str, extension="REPEAT", size=SIDE // 2) -> np.ndarray:
    """A picture whose pixels each cover 2 x 2 texels (at size 32), on their borders."""
    scene = t.new_scene(size, size)
    orthographic(scene, 2.0)
    emitting(plane(scene), show_image(image_of(noise()), extension))
    return pixels_of("--jitter", "none", "--for", "noaa", *options)


def box(pixels: np.ndarray, times: int) -> np.ndarray:
    for _ in range(times):
        height, width = pixels.shape[:2]
        pixels = pixels.reshape(height // 2, 2, width // 2, 2, -1).mean(axis=(1, 3))
    return pixels[..., :3]


def test_levels_are_box_means() -> None:
    """At 2, 4 and 8 texels a pixel the level is 1, 2 and 3: the mean of the texels that the pixel covers."""
    for level in (1, 2, 3):
        found = one_level("--texture-filter", "mip", size=SIDE >> level)
        expected = box(noise(), level)[::-1]  # a picture's rows begin at the top
        assert np.abs(found - expected).max() < 2e-4, (level, np.abs(found - expected).max())
    unfiltered = one_level(size=SIDE >> 3)
    assert np.abs(unfiltered - box(noise(), 3)[::-1]).max() > 0.1


def test_bias_moves_the_level() -> None:
    """Bias -1 at 4 texels a pixel reads level 1, bias -0.5 lies halfway, and less than level 0 is the picture itself."""
    options = ("--texture-filter", "mip", "--mip-bias")
    whole = one_level("--texture-filter", "mip", size=SIDE // 4)
    sharp = one_level(*options, "-1", size=SIDE // 4)
    half = one_level(*options, "-0.5", size=SIDE // 4)
    # Pixels lie on the corners of four texels of level 1: their bilinear mean is the texel of level 2.
    assert np.abs(half - 0.5 * (whole + sharp)).max() < 2e-4
    point = one_level(size=SIDE // 4)
    least = one_level(*options, "-16", size=SIDE // 4)
    assert np.array_equal(point, least)


def test_slant_and_distance_decide() -> None:
    """Seen in perspective the level is that of the longer step of the coordinates from pixel to pixel, worked out here
    from the projection."""
    scene = t.new_scene(64, 48)
    camera = t.add_camera(scene, (0.3, -6.0, 2.0), (0.0, 0.0, 0.0), 30.0)
    item = plane(scene, half=8.0, tilt=1.45)
    # Alternating columns: level 0 shows 0 to 1, all further levels 0.5.
    columns = np.zeros((256, 256, 4))
    columns[:, ::2, :3] = 1.0
    columns[..., 3] = 1.0
    emitting(item, show_image(image_of(columns)))
    found = pixels_of("--jitter", "none", "--for", "noaa", "--texture-filter", "mip")[..., 0]
    view = t.Projection(camera, 64, 48)
    rotation = np.array(item.matrix_world.to_3x3())
    normal = rotation @ np.array([0.0, -1.0, 0.0])
    place = np.array(camera.location)

    def uv_at(x, y):
        far = view.unproject(x, y, np.full(x.shape, 1.0)) - place
        hit = place - far * ((place @ normal) / (far @ normal))[:, None]
        local = hit @ rotation
        return (local[:, [0, 2]] + 8.0) / 16.0

    y, x = np.mgrid[0:48, 0:64].reshape(2, -1) + 0.5
    centre = uv_at(x, y)
    # Central differences over a hundredth of a pixel: the derivative.
    right = (uv_at(x + 0.005, y) - uv_at(x - 0.005, y)) * 100.0 * 256.0
    down = (uv_at(x, y + 0.005) - uv_at(x, y - 0.005)) * 100.0 * 256.0
    level = np.log2(np.maximum(np.linalg.norm(right, axis=1), np.linalg.norm(down, axis=1)))
    inside = ((centre > 0.01) & (centre < 0.99)).all(axis=1)
    place_in_row = centre[:, 0] * 256.0 - 0.5
    low = np.floor(place_in_row)
    share = place_in_row - low
    point = np.where(low % 2 == 0, 1.0 - share, share)
    expected = point + np.clip(level, 0.0, 1.0) * (0.5 - point)
    wrong = np.abs(found.ravel() - expected)[inside]
    assert inside.sum() > 500 and level[inside].min() < 0.7 and level[inside].max() > 1.0
    assert wrong.max() < 0.02, wrong.max()


def shifted_scene(kind: str):
    """A textured plane that fills the view of a camera with a border, a shift and a slant."""
    scene = t.new_scene(48, 32)
    camera = t.add_camera(scene, (0.3, -5.0, 1.0), (0.1, 0.0, 0.1), 50.0)
    camera.data.shift_x = 0.06
    item = plane(scene, half=5.0, tilt=0.5)
    smooth = np.ones((32, 32, 4))
    y, x = np.mgrid[0:32, 0:32] / 32.0 * 2.0 * np.pi
    smooth[..., 0] = 0.5 + 0.4 * np.sin(x)
    smooth[..., 1] = 0.5 + 0.4 * np.sin(y)
    smooth[..., 2] = 0.5 + 0.4 * np.sin(x + y)
    if kind == "image":
        emitting(item, show_image(image_of(smooth), scale=6.0, interpolation="Cubic"))
    else:

        def wave(tree):
            node = tree.nodes.new("ShaderNodeTexWave")
            node.inputs["Scale"].default_value = 1.5
            if kind == "object":
                coordinates = tree.nodes.new("ShaderNodeTexCoord")
                tree.links.new(coordinates.outputs["Object"], node.inputs["Vector"])
            return node.outputs["Color"]  # without a link: Generated

        emitting(item, wave)
    if kind == "object":
        camera.data.type, camera.data.ortho_scale = "ORTHO", 3.0
    return scene


def test_textures_without_jitter() -> None:
    """With --unjitter-textures a jittered frame of one plane shows what the frame at the pixel centres shows."""
    original = jitter.jitter_at
    for kind in ("image", "object", "generated"):
        for offset in ((0.4, -0.3), (-0.45, 0.0)):
            shown = {}
            for name, place, more in (
                ("centre", (0.0, 0.0), ()),
                ("jittered", offset, ()),
                ("unjittered", offset, ("--unjitter-textures",)),
            ):
                shifted_scene(kind)
                jitter.jitter_at = lambda *_arguments, place=place: place
                try:
                    shown[name] = pixels_of("--for", "taaSimplest", *more)
                finally:
                    jitter.jitter_at = original
            before = np.abs(shown["jittered"] - shown["centre"]).max()
            after = np.abs(shown["unjittered"] - shown["centre"]).max()
            assert before > 0.01 and after < 0.03 * before, (kind, offset, before, after)


def test_truth_is_untouched() -> None:
    """Truth is, bit for bit, that of an export without these options; so is a frame at the centres, unfiltered."""
    pictures = []
    for options in ((), ("--texture-filter", "mip", "--unjitter-textures")):
        shifted_scene("image")
        out = os.path.join(t.temporary_folder(), "shot")
        t.export(out, "--frames", "1-2", "--truth-samples", "4", "--for", "taaSimplest", *options)
        truth = os.path.join(out, "truth", "000001.exr")
        pictures.append(np.stack([t.stacked(t.read_part(truth, half), "R G B") for half in "ab"]))
    assert np.array_equal(*pictures)


def test_alpha_and_curves() -> None:
    """An sRGB picture is averaged in linear light, and colour counts by its alpha."""
    encoded = np.zeros((2, 2, 4))
    encoded[..., 3] = 1.0
    encoded[0, 0], encoded[1, 1] = (1, 1, 1, 1), (1, 1, 1, 1)
    scene = t.new_scene(8, 8)
    orthographic(scene, 2.0)
    image = bpy.data.images.new("Bytes", 2, 2, alpha=True)
    image.pixels.foreach_set(encoded.astype(np.float32).ravel())
    image.update()
    image.pack()
    emitting(plane(scene), show_image(image, scale=37.0))
    found = pixels_of("--jitter", "none", "--for", "noaa", "--texture-filter", "mip")
    assert np.abs(found - 0.5).max() < 1e-3, found.max()  # averaged as encoded it would be 0.214

    clear = np.zeros((2, 2, 4))
    clear[0, 0] = (0.8, 0.4, 0.2, 1.0)
    from aa_resolve.scene.mip_images import levels

    (level,) = levels(clear.astype(np.float32))
    assert np.allclose(level[0, 0], (0.8, 0.4, 0.2, 0.25), atol=1e-6), level
    odd = np.arange(5, dtype=np.float32).reshape(1, 5, 1).repeat(4, axis=2)
    first = levels(odd, packed=True)[0]
    # Two texels of two and a half each: (0 + 1 + 2/2) / 2.5 and (2/2 + 3 + 4) / 2.5.
    assert np.allclose(first[0, :, 0], (0.8, 3.2), atol=1e-6), first


def test_what_is_left_is_said() -> None:
    """Textures that cannot be read so stay bit for bit as they were, and a note names them and the reason."""
    kinds = {
        "bump": "bump or displacement is made from it",
        "closest": "every texel is meant to be seen",
        "procedural": "a procedural texture has no mip maps",
        "warped": "another texture displaces its coordinates",
    }
    for kind, reason in kinds.items():
        pictures = []
        for options in ((), ("--texture-filter", "mip")):
            scene = t.new_scene(16, 16)
            t.add_camera(scene, (0, -5, 0), (0, 0, 0))
            t.add_sun(scene, rotation=(1.2, 0.0, 0.3))
            item = plane(scene, half=4.0)
            image = image_of(noise())

            def build(tree, kind=kind, image=image):
                node = tree.nodes.new("ShaderNodeTexImage")
                node.image = image
                node.interpolation = "Closest" if kind == "closest" else "Linear"
                if kind == "procedural":
                    return tree.nodes.new("ShaderNodeTexVoronoi").outputs["Color"]
                if kind == "warped":
                    other = tree.nodes.new("ShaderNodeTexNoise")
                    tree.links.new(other.outputs["Color"], node.inputs["Vector"])
                if kind == "bump":
                    bump = tree.nodes.new("ShaderNodeBump")
                    tree.links.new(node.outputs["Color"], bump.inputs["Height"])
                    return bump.outputs[0]
                return node.outputs["Color"]

            emitting(item, build)
            out = os.path.join(t.temporary_folder(), "shot")
            shot = t.export(
                out, *"--frames 1 --truth-frames none --for noaa --jitter none".split(), *options
            )
            path = os.path.join(out, "frames", "000001.exr")
            pictures.append(t.stacked(t.read_part(path, "color"), "R G B"))
        assert np.array_equal(*pictures), kind
        assert any(reason in note for note in shot["notes"]), (kind, shot["notes"])


def test_every_material_and_group() -> None:
    """Textures of several materials and of a group within one are all read; a group that two materials share once."""
    scene = t.new_scene(32, 32)
    orthographic(scene, 2.0)
    image = image_of(noise())
    for half, place in ((0.5, -0.5), (0.5, 0.5)):
        item = plane(scene, half=half)
        item.location.x = place
        emitting(item, show_image(image))
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    t.add_group_socket(inner, "NodeSocketColor", "Color", True)
    end = inner.nodes.new("NodeGroupOutput")
    inner.links.new(show_image(image)(inner), end.inputs[0])

    def grouped(tree):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = inner
        return node.outputs[0]

    for place in (-2.0, 2.0):
        item = plane(scene, half=0.5)
        item.location.z = place
        emitting(item, grouped)
    out = os.path.join(t.temporary_folder(), "shot")
    options = "--frames 1 --truth-frames none --for noaa --jitter none --texture-filter mip"
    shot = t.export(out, *options.split())
    assert any("3 filtered by mip maps" in note for note in shot["notes"]), shot["notes"]


def test_misuse() -> None:
    shifted_scene("image")
    for options, says in (
        (("--mip-bias", "-0.25"), "without --texture-filter mip"),
        (("--unjitter-textures", "--jitter", "none"), "without a jitter"),
        (("--for", "taaSimplest", "--unjitter-textures", "--jitter-projection", "pre"), "pre"),
        (("--texture-filter", "mip", "--mip-bias", "40"), "expected -16.0 to 16.0"),
    ):
        try:
            pixels_of(*options)
        except UsageError as error:
            assert says in str(error), (options, str(error))
        else:
            raise AssertionError(f"{options} was taken")


if __name__ == "__main__":
    t.main(
        test_levels_are_box_means,
        test_bias_moves_the_level,
        test_slant_and_distance_decide,
        test_textures_without_jitter,
        test_truth_is_untouched,
        test_alpha_and_curves,
        test_what_is_left_is_said,
        test_every_material_and_group,
        test_misuse,
    )
