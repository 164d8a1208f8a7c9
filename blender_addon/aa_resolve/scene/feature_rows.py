# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects, modifiers, physics, lights, cameras and files of a scene, and what becomes of them: rows of features.py."""

from __future__ import annotations

from .feature import Feature, HANDLED, NOTED, NOTHING, REFUSED, SHOWN

_LEVELS = "render_levels:show_what_renders"
_SIMULATED = "simulations:run"
_OFF = "suitability:switch_off"
_REFUSE = "suitability:refuse_unsuitable"

ROWS: tuple[Feature, ...] = (
    Feature("object", "MESH", SHOWN, "every pass"),
    Feature(
        "object",
        "CURVE SURFACE META FONT",
        HANDLED,
        "every pass, at the renderer's resolution",
        _LEVELS,
    ),
    Feature(
        "object",
        "CURVES",
        NOTED,
        "hair strands: all passes but edges and segments, strands are no triangles",
        "surfaces:notes_on_edges",
    ),
    Feature("object", "POINTCLOUD", NOTED, "points: all passes but edges and segments", _OFF),
    Feature(
        "object",
        "VOLUME",
        NOTED,
        "colour only: a volume has no surface; depth, normal, id and motion are those behind it",
        _OFF,
    ),
    Feature(
        "object",
        "GPENCIL GREASEPENCIL",
        NOTED,
        "left out: Blender draws it over the finished picture, without depth and id",
        _OFF,
    ),
    Feature("object", "ARMATURE LATTICE EMPTY", SHOWN, "what they move or instance"),
    Feature("object", "LIGHT", HANDLED, "see Lights", "lighting:set_up"),
    Feature("object", "CAMERA", HANDLED, "see Cameras", "camera:camera_state"),
    Feature("object", "LIGHT_PROBE SPEAKER", NOTHING, "not in pictures of Cycles"),
    Feature(
        "modifier",
        "SUBSURF MULTIRES SCREW",
        HANDLED,
        "levels of the renderer; adaptive subdivision is noted: edges are those before it",
        _LEVELS,
    ),
    Feature(
        "modifier",
        "OCEAN",
        HANDLED,
        "resolution of the renderer; it depends on the frame alone",
        _LEVELS,
    ),
    Feature(
        "modifier",
        "CLOTH SOFT_BODY FLUID DYNAMIC_PAINT PARTICLE_SYSTEM COLLISION",
        HANDLED,
        "see Physics",
        _SIMULATED,
    ),
    Feature(
        "modifier",
        "EXPLODE PARTICLE_INSTANCE",
        HANDLED,
        "as their particles; motion is marked invalid where the number of vertices changes",
        "movement:frame_state",
    ),
    Feature(
        "modifier",
        "NODES",
        HANDLED,
        "geometry nodes: instances have ids of their own, Is Viewport answers as in a render, "
        "simulation zones run first",
        _LEVELS,
    ),
    Feature(
        "modifier",
        "MESH_CACHE MESH_SEQUENCE_CACHE",
        HANDLED,
        "a missing file is noted",
        "linked:notes_on_missing",
    ),
    Feature("modifier", "MESH_TO_VOLUME VOLUME_DISPLACE", NOTED, "volumes have no surface", _OFF),
    Feature(
        "modifier",
        "BUILD DECIMATE REMESH SKIN WELD BOOLEAN MASK VOLUME_TO_MESH TRIANGULATE EDGE_SPLIT",
        HANDLED,
        "motion is marked invalid in frames in which the number of vertices changes",
        "movement:frame_state",
    ),
    Feature(
        "modifier",
        "ARRAY BEVEL MIRROR SOLIDIFY WIREFRAME DATA_TRANSFER NORMAL_EDIT WEIGHTED_NORMAL "
        "UV_PROJECT UV_WARP VERTEX_WEIGHT_* ARMATURE CAST CURVE DISPLACE HOOK LAPLACIANDEFORM "
        "LATTICE MESH_DEFORM SHRINKWRAP SIMPLE_DEFORM SMOOTH CORRECTIVE_SMOOTH LAPLACIANSMOOTH "
        "SURFACE_DEFORM WARP WAVE SURFACE",
        SHOWN,
        "every pass; visible in the viewport or not, as in a render",
        _LEVELS,
    ),
    Feature(
        "modifier",
        "GREASE_PENCIL_* GP_* LINEART",
        NOTED,
        "left out with their Grease Pencil objects",
        _OFF,
    ),
    Feature(
        "physics",
        "cloth soft_body dynamic_paint",
        HANDLED,
        "without a bake: run once in memory, from the start of the cache to the last frame; a "
        "note says so",
        _SIMULATED,
    ),
    Feature("physics", "rigid_body", HANDLED, "the same", _SIMULATED),
    Feature(
        "physics",
        "NEWTON KEYED BOIDS FLUID",
        HANDLED,
        "particles that emit, the same; hair with dynamics too",
        _SIMULATED,
    ),
    Feature("physics", "NO", SHOWN, "particles that stay where they are"),
    Feature(
        "physics",
        "fluid",
        HANDLED,
        "Replay runs in memory and in a temporary folder; a Modular or All domain without a bake "
        "is noted: Blender shows nothing of it",
        _SIMULATED,
    ),
    Feature(
        "physics",
        "simulation_zone",
        HANDLED,
        "geometry nodes: run once in memory, in order",
        _SIMULATED,
    ),
    Feature("physics", "force_field collision", SHOWN, "act within the simulations"),
    Feature(
        "physics",
        "disk_cache",
        HANDLED,
        "found beside the original also for the panel's copy, and so are bakes of geometry nodes; read through links, "
        "never written; a missing one is noted",
        "simulations:link_caches",
    ),
    Feature(
        "light",
        "POINT SUN SPOT",
        HANDLED,
        "noise-free light takes their size; as-is keeps it. Several of which one's visibility is animated "
        "are refused in noise-free light, shown in the first frame or later. Instanced ones shine, too: one at several places at once, by "
        "collections, faces, particles or nodes, stays noisy, which is noted",
        "lighting:set_up",
    ),
    Feature(
        "light",
        "AREA",
        HANDLED,
        "noise-free light lets it shine from its centre, its animated power included; a portal "
        "does not shine",
        "lighting:set_up",
    ),
    Feature(
        "file",
        "light from the world",
        HANDLED,
        "noise-free light takes the mean of what surfaces receive, also where the camera sees another "
        "world, as ambient light, and the sun of a sky texture, as it stands at the first frame, as a "
        "light without size",
        "lighting:set_up",
    ),
    Feature(
        "file",
        "light and shadow linking, a light's temperature, exposure and Normalize",
        HANDLED,
        "kept; an animated size with Normalize off is refused in noise-free light",
        "lighting:set_up",
    ),
    Feature(
        "camera",
        "PERSP ORTHO",
        HANDLED,
        "lens, shift, scale, sensor and clipping may be animated; depth of field is switched off "
        "and noted",
        "camera:camera_state",
    ),
    Feature("camera", "PANO CUSTOM", REFUSED, "no matrix describes them", "camera:camera_state"),
    Feature(
        "file",
        "linked library, picture, cache",
        NOTED,
        "a missing one is named; one that changes is noticed when an export goes on, but for sounds, strips of the "
        "sequencer and pictures that only an editor shows",
        "linked:notes_on_missing",
    ),
    Feature(
        "file",
        "Python driver",
        NOTED,
        "one that Blender was not allowed to run is named",
        "scripts:notes_on_blocked",
    ),
    Feature(
        "file",
        "script that runs at every frame",
        NOTED,
        "what it sets of the export's settings is set back",
        "scripts:hold_against_handlers",
    ),
    Feature(
        "file",
        "camera bound to a marker",
        HANDLED,
        "looks from its marker on, unless it is hidden in renders",
        "cuts:CameraCuts",
    ),
    Feature(
        "file",
        "driver, constraint or node that reads the scene's camera",
        HANDLED,
        "it reads the user's, not the jittered one; Python in a driver that does is noted",
        "active_camera:CameraReaders",
    ),
    Feature(
        "file",
        "several view layers",
        REFUSED,
        "until --view-layer, Layer in the panel, chooses one",
        _REFUSE,
    ),
    Feature(
        "file",
        "view layer: long name, excluded collections, material override",
        HANDLED,
        "as rendered",
        _LEVELS,
    ),
    Feature(
        "file",
        "holdout (object, collection or shader)",
        NOTED,
        "a hole: black, with the depth, id and motion of the background",
        _OFF,
    ),
    Feature(
        "file",
        "shadow catcher",
        NOTED,
        "an ordinary surface: Cycles doubles its passes otherwise",
        _OFF,
    ),
    Feature(
        "file",
        "working space that is not Rec.709 (Blender 5)",
        NOTED,
        "colours are converted: a shot is linear Rec.709",
        _REFUSE,
    ),
    Feature("file", "volume in a material or the world", NOTED, "has no surface", _OFF),
    Feature(
        "file",
        "half-transparent, cut-out or displaced material",
        NOTED,
        "see the notes of the export",
        "surfaces:semi_transparent_note",
    ),
    Feature(
        "file",
        "render border, pixel aspect",
        HANDLED,
        "the shot shows the border only",
        "camera:frame_of",
    ),
    Feature(
        "file",
        "motion blur, Freestyle, compositor, sequencer, denoiser",
        NOTED,
        "switched off",
        _REFUSE,
    ),
    Feature(
        "file",
        "picture as a texture",
        SHOWN,
        "read at a point, as Cycles does. With --texture-filter mip frames read mip maps, by the longer step of the "
        "coordinates from pixel to pixel, with --mip-bias; truth never. Noted and left: movies, tiles, Closest, "
        "projections other than Flat, colour spaces other than sRGB and linear",
        "textures:TextureReading",
    ),
    Feature(
        "file",
        "texture made by nodes (Noise, Brick, ...)",
        SHOWN,
        "read at a point: Blender has no mip maps of it",
        "textures:TextureReading",
    ),
    Feature(
        "file",
        "coordinates of textures with --unjitter-textures",
        HANDLED,
        "those of the pixel's centre. Noted and left: textures from which bump or displacement is made, whose "
        "coordinates another texture displaces or a node group gives, and materials in linked libraries; never: "
        "environments and light",
        "textures:TextureReading",
    ),
    Feature(
        "file",
        "linked scene as the open one",
        HANDLED,
        "made local in memory",
        "linked:local",
    ),
    Feature(
        "file",
        "bump, normal map",
        SHOWN,
        "in the normals of frames and sub-samples alike; sub-samples then use the real materials, which is noted and takes "
        "up to twice their time. Without them normals at the rims of smooth glossy surfaces, which Cycles bends there, are "
        "up to 6 degrees from the frame's (0.2 % of the pixels of 25 balls)",
        "surfaces:lost_under_override",
    ),
    Feature(
        "file",
        "Object Index in nodes and drivers",
        HANDLED,
        "the scene's own, though the export tells objects apart by another; where it is animated, which is noted, that of "
        "the first frame",
        "object_index:keep_own",
    ),
    Feature("file", "more than 32767 objects", REFUSED, "Cycles tells no more apart", _REFUSE),
    Feature("file", "Eevee or another engine", NOTED, "Cycles renders", _REFUSE),
)
