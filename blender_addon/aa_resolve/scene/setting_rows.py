# SPDX-License-Identifier: GPL-3.0-or-later
"""Settings of a render that can be keyed, and what becomes of their animation: rows of features.py."""

from __future__ import annotations

from .feature import Feature, HANDLED, NOTHING, REFUSED, SHOWN

_LEVELS = "render_levels:show_what_renders"
_OWNED = "ownership:own"
_REFUSE = "suitability:refuse_unsuitable"

ROWS: tuple[Feature, ...] = (
    Feature(
        "setting",
        "cycles.pixel_filter_type cycles.filter_width cycles.samples cycles.sample_offset "
        "cycles.seed cycles.use_animated_seed",
        HANDLED,
        "set by the export; curves, strips and drivers on it are switched off and named",
        _OWNED,
    ),
    Feature(
        "setting",
        "cycles.use_sample_subset cycles.sample_subset_length cycles.scrambling_distance "
        "cycles.auto_scrambling_distance cycles.use_pixel_jitter cycles.sampling_pattern "
        "cycles.use_guiding cycles.direct_light_sampling_type render.use_texture_cache",
        HANDLED,
        "the same",
        _OWNED,
    ),
    Feature(
        "setting",
        "cycles.use_adaptive_sampling cycles.use_denoising cycles.light_sampling_threshold "
        "cycles.sample_clamp_* cycles.time_limit",
        HANDLED,
        "the same: off",
        _OWNED,
    ),
    Feature(
        "setting",
        "cycles.max_bounces cycles.diffuse_bounces cycles.glossy_bounces "
        "cycles.transmission_bounces cycles.volume_bounces cycles.caustics_* cycles.use_fast_gi",
        HANDLED,
        "the same in noise-free light: none; as-is keeps them",
        _OWNED,
    ),
    Feature(
        "setting",
        "render.film_transparent",
        HANDLED,
        "the same: as in the first frame. The background is then black with alpha 0",
        _OWNED,
    ),
    Feature("setting", "render.use_multiview", REFUSED, "stereo: a shot holds one camera", _REFUSE),
    Feature(
        "setting",
        "render.use_overwrite render.use_persistent_data render.use_stamp",
        HANDLED,
        "set by the export",
        _OWNED,
    ),
    Feature(
        "setting",
        "layer.samples layer.use layer.pass_alpha_threshold layer.use_pass_* "
        "layer.cycles.denoising_store_passes layer.cycles.use_pass_* layer.cycles.pass_debug_* "
        "layer.cycles.pass_render*",
        HANDLED,
        "passes are those that the shot needs",
        _OWNED,
    ),
    Feature(
        "setting",
        "layer.pass_cryptomatte_* layer.active_* layer.use_motion_blur "
        "layer.use_freestyle layer.use_grease_pencil layer.cycles.*",
        NOTHING,
        "further passes are not read",
    ),
    Feature(
        "setting",
        "layer.use_ao layer.use_sky layer.use_solid layer.use_strand layer.use_volumes",
        SHOWN,
        "what the layer shows",
    ),
    Feature(
        "setting",
        "render.simplify_subdivision render.simplify_child_particles render.use_simplify_normals",
        HANDLED,
        "those of the renderer",
        _LEVELS,
    ),
    Feature(
        "setting",
        "render.use_simplify render.simplify_*_render render.simplify_volumes "
        "render.use_high_quality_normals render.threads* render.hair_*",
        SHOWN,
        "as in a render",
    ),
    Feature(
        "setting",
        "render.simplify_gpencil* render.use_stamp_* render.stamp_* render.*bake* "
        "render.dither_intensity render.filter_size render.line_thickness* render.metadata_input "
        "render.motion_blur_* render.preview_* render.sequencer_* render.compositor_* "
        "render.use_new_cpu_compositor render.use_sequencer_* render.anisotropic_filter",
        NOTHING,
        "burnt in, for the viewport, or after rendering; motion blur is switched off and noted",
    ),
    Feature(
        "setting",
        "cycles.film_* cycles.transparent_max_bounces cycles.min_* cycles.blur_glossy "
        "cycles.use_light_tree cycles.*guiding* cycles.ao_* "
        "cycles.fast_gi_method cycles.volume_* cycles.texture_* cycles.dicing_rate "
        "cycles.offscreen_dicing_scale cycles.max_subdivisions cycles.*_cull* cycles.feature_set "
        "cycles.shading_system cycles.device cycles.debug_* "
        "cycles.tile_size cycles.use_auto_tile cycles.use_layer_samples cycles.adaptive_*",
        SHOWN,
        "as in a render, the same for frames and truth",
    ),
    Feature(
        "setting",
        "cycles.preview_* cycles.use_preview_* cycles.denois* cycles.rolling_shutter_* "
        "cycles.motion_blur_position cycles.bake_type",
        NOTHING,
        "for the viewport, the denoiser, motion blur or baking",
    ),
)
