# SPDX-License-Identifier: MIT
"""Published figures that the studies are compared with; facts copied from their tables.

A = [Oliveros 2018] (1600 x 900, 8-bit images, truth of 128 samples). C = [Reshetov 2012], the talk.
"""

from __future__ import annotations

# PSNR gain over no anti-aliasing, dB: tables 5.2 to 5.11 of A, the scenes that we have.
METHODS = {
    "FXAA": "fxaa1:preset=5",
    "SMAA": "smaa1x:preset=ULTRA",
    "Uncharted": "uncharted",
    "Master": "master",
}
GAINS = {
    "hard_edges": ("Hard edges (5.8)", {"FXAA": 1.25, "SMAA": 1.92, "Uncharted": -4.01, "Master": 3.96}),
    "flowers": ("Sponza flowers (5.7)", {"FXAA": 2.69, "SMAA": 2.30, "Uncharted": -6.01, "Master": 5.31}),
    "hairball_unlit": ("Hairball, silhouette (5.10)", {"FXAA": 3.23, "SMAA": 2.43, "Uncharted": -3.02, "Master": 6.35}),
    "hairball": ("Hairball, lit (5.11)", {"FXAA": 2.99, "SMAA": 1.84, "Uncharted": -0.47, "Master": 7.57}),
}  # fmt: skip
# Mean MSE over 100 frames in motion, 8-bit units squared: tables 5.9 and 5.13 of A.
MOVING_MSE = {
    "moving_sphere": ("Sphere (5.9)", {"Uncharted": 28.634, "Master": 19.501}),
    "hairball_rotating": ("Hairball, lit, rotating (5.13)", {"Uncharted": 875.687, "Master": 671.202}),
}  # fmt: skip
# Table 5.1 of A: PSNR in the Sponza atrium with a static sphere.
SHARPEN = {"uncharted": 26.391, "unchartedNorm": 38.669, "master": 38.980}
# C: RSAA with 8 sub-samples, SADP and tuning over no anti-aliasing; RSAA with 4; MLAA.
RSAA_GAIN, RSAA4_LOSS, MLAA_GAIN = 10.0, 2.0, 5.0
