# SPDX-License-Identifier: MIT
"""What is rendered and what is run on it: the shots, and the methods that each of them is for."""

from __future__ import annotations

from shots import Shot

SPATIAL = (
    "noaa fxaa1:preset=3 fxaa1:preset=5 fxaa311:preset=12 fxaa311:preset=39 fxaacs fxaaconsole mlaa cmaa2 "
    "smaa1x:preset=LOW smaa1x:preset=MEDIUM smaa1x:preset=HIGH smaa1x:preset=ULTRA dlaa nfaa ssssaa"
)
EDGES = "gbaa gpaa d2e"
SUBSAMPLES = "msaa csaa:slots=4 dmsaa deaa sraa sraa:ids=always sbaa sbaa:ids=off"
UNCHARTED = "uncharted unchartedNorm unchartedNoSharpen"
# Each part of `master` switched off or read otherwise; its colour box open everywhere (minAlias=1); and a first frame
# that does not keep its weight (warmup=ramp).
ABLATIONS = (
    "master master:unjitter=off master:model=off master:depth=off master:depthTemporal=off master:sobel=off "
    "master:sobelTemporal=off master:sharpen=none master:sharpen=none,minAlias=1"
)
RAMPED = "unchartedNoSharpen:warmup=ramp master:sharpen=none,warmup=ramp"
RAPTOR = (
    "raptor raptor:lumaDiff=printed raptor:filterDomain=printed,lumaDiff=printed raptor:sharpen=0"
)
BOXES = "inside karis salvi falcor donut"  # with `raptor`, `uncharted*` and `master`: history held by a box of colours
IDENTITY = "accumReject accumReject:objectIds=off accumReject:depthTest=off"
FILLS = "accumReject+fill=smaa1x accumReject+fill=fxaa311 fsr2n+fill=smaa1x"
TEMPORAL = f"taaSimplest {UNCHARTED} {ABLATIONS} {RAPTOR} {BOXES} fsr2n {IDENTITY} {FILLS}"
RSAA = (
    "rsaa rsaa:tuning=off rsaa:measure=depth rsaa:measure=normal rsaa:measure=depth,tuning=off "
    "rsaa:measure=normal,tuning=off rsaa:ids=off rsaa:measure=depth,ids=off rsaa:measure=normal,ids=off "
    "rsaa:training=halfPlanes"
)


def _shots(*all_shots: Shot) -> dict[str, Shot]:
    return {shot.name: shot for shot in all_shots}


T2MSAA = dict(
    methods="noaa t2msaa t2msaa:space=linear",
    pattern="d3d2",
    truth_of="hard_edges",
    period=2,
    frames=8,
    quick_frames=8,
)
STILL = dict(frames=1, quick_frames=1, jitter="none", period=1)  # centre samples alone
MOVING = dict(
    methods=f"{SPATIAL} {TEMPORAL} dmsaa sraa rsaa accumReject+fill=rsaa",
    pattern="d3d8",
    passes="normal,object,subsamples",
    truth_samples=64,
    quick_truth_samples=16,
)

SHOTS = _shots(
    Shot(
        "hard_edges", "hard_edges",
        f"{SPATIAL} {EDGES} {SUBSAMPLES} {RSAA} {TEMPORAL} {RAMPED} accum:samples=16",
        pattern="d3d8", truth_samples=256, quick_truth_samples=64, jitter="thesis",
    ),
    Shot(
        "hard_edges.s2", "hard_edges", "noaa msaa msaa:space=encoded smaaS2x", pattern="d3d2", truth_of="hard_edges",
        **STILL,
    ),
    Shot(
        "hard_edges.s4", "hard_edges", f"noaa {SUBSAMPLES} msaa:space=encoded rsaa", pattern="d3d4",
        truth_of="hard_edges", **STILL,
    ),
    Shot("hard_edges.s16", "hard_edges", f"noaa {SUBSAMPLES} rsaa", pattern="d3d16", truth_of="hard_edges", **STILL),
    Shot("hard_edges.grid2", "hard_edges", "noaa ssaa", pattern="grid2", truth_of="hard_edges", **STILL),
    Shot("hard_edges.grid4", "hard_edges", "noaa ssaa", pattern="grid4", truth_of="hard_edges", **STILL),
    Shot(
        "hard_edges.t2x", "hard_edges", "noaa smaaT2x", truth_of="hard_edges",
        jitter="smaaT2x", period=2, frames=8, quick_frames=8,
    ),
    Shot(  # alternates between two opposite ones of the four sub-samples
        "hard_edges.4x", "hard_edges", "noaa smaa4x", pattern="d3d4", truth_of="hard_edges",
        jitter="none", period=1, frames=8, quick_frames=8,
    ),
    # As published: two sub-samples, frames moved by 0.25, 0.1875 or 0.125 px.
    Shot("hard_edges.t2msaa", "hard_edges", jitter="t2msaa", **T2MSAA),
    Shot("hard_edges.t2msaa1875", "hard_edges", jitter="t2msaa1875", **T2MSAA),
    Shot("hard_edges.t2msaa125", "hard_edges", jitter="t2msaa125", **T2MSAA),
    Shot("hard_edges.asaa", "hard_edges", "noaa asaa", truth_of="hard_edges", jitter="quadrantGaussian"),
    Shot(
        "hard_edges.accum128", "hard_edges", "noaa accum:samples=128", truth_of="hard_edges", period=128,
        frames=128, quick_frames=128,
    ),
    Shot(
        "hairball", "hairball", f"{SPATIAL} {SUBSAMPLES} {RSAA} {TEMPORAL} accum:samples=16", pattern="d3d8",
        truth_samples=256, quick_truth_samples=32, jitter="thesis",
    ),
    Shot("hairball.s4", "hairball", f"noaa {SUBSAMPLES} rsaa", pattern="d3d4", truth_of="hairball", **STILL),
    Shot("hairball.s16", "hairball", f"noaa {SUBSAMPLES} rsaa", pattern="d3d16", truth_of="hairball", **STILL),
    Shot(
        "hairball_unlit", "hairball", f"{SPATIAL} {TEMPORAL} accum:samples=16", variant=("--unlit",),
        jitter="thesis",
    ),
    Shot(
        "flowers_close", "flowers", f"{SPATIAL} {TEMPORAL} msaa rsaa accum:samples=16", variant=("--close",), pattern="d3d8",
        jitter="thesis",
    ),
    Shot("moving_sphere", "moving_sphere", frames=32, quick_frames=16, **MOVING),
    Shot("hairball_rotating", "hairball", variant=("--rotating",), frames=24, quick_frames=12, **MOVING),
    Shot("wires", "wires", frames=24, quick_frames=12, **MOVING),
    Shot("synth_moving", "synth:moving", f"{SPATIAL} {TEMPORAL}", frames=40, quick_frames=24),
    Shot("synth_thin_motion", "synth:thin_motion", f"{SPATIAL} {TEMPORAL}", frames=40, quick_frames=24),
)  # fmt: skip

# What each step of the protocol of [Oliveros 2018] (scenes/experiments/protocols.toml) does to these methods on hard_edges.
STEPS = {
    "linear light, from frame 0": (),
    "linear light, full history": ("--history", "full"),
    "displayed values, from frame 0": ("--display", "identity"),
    "displayed values, full history": ("--display", "identity", "--history", "full"),
    "the same as 8-bit images": ("--display", "identity", "--history", "full", "--quantise", "8"),
}
STEP_METHODS = "noaa uncharted unchartedNorm master master:unjitter=off accum:samples=16"
# Run once more in that protocol: T2MSAA between MSAA of 2 and of 4 in one space.
DISPLAYED = {
    "hard_edges.s2": "noaa msaa",
    "hard_edges.s4": "noaa msaa",
    "hard_edges.t2msaa": "noaa t2msaa",
    "hard_edges.t2msaa1875": "noaa t2msaa",
    "hard_edges.t2msaa125": "noaa t2msaa",
}

# Seconds on two processors at 480 x 270: a jittered frame, and a sample of truth in both halves together; for the
# estimate, until the machine's own times are known.
COSTS = {
    "hard_edges": (0.15, 0.12), "moving_sphere": (0.2, 0.1), "hairball": (0.3, 0.1), "flowers": (0.3, 0.18),
    "wires": (0.2, 0.09), "atrium": (0.6, 0.3), "village": (0.6, 0.26), "collision": (0.5, 0.2), "synth:moving": (0.02, 0.0),
    "synth:thin_motion": (0.02, 0.0),
}  # fmt: skip
OTHER_COSTS = (0.2, 0.1)

# Contact sheets beside the pages: name -> shot and methods.
PICTURES = {
    "moving_sphere": (
        "moving_sphere",
        "noaa smaa1x:preset=ULTRA uncharted unchartedNorm master taaSimplest accumReject accumReject+fill=smaa1x",
    ),
    "hairball": (
        "hairball",
        "noaa mlaa smaa1x:preset=ULTRA rsaa msaa unchartedNorm master accum:samples=16",
    ),
}

# On half-planes, where the program has the command `angles`.
ANGLES = f"{SPATIAL} {EDGES} {SUBSAMPLES} {RSAA} uncharted unchartedNorm unchartedNoSharpen master accumReject karis salvi"
