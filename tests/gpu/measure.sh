#!/bin/sh
# Checks every shader against the kernels on this machine's graphics card and times them all, in at most four minutes.
# Needs the program and a Vulkan driver, nothing else. The page docs/gpu.md is made from such a file:
#
#   tests/gpu/measure.sh build/aaresolve measured.json            sh and the program only, no Python
#   python3 tests/gpu/page.py measured.json > docs/gpu.md
#
# Send measured.json in: figures of a card that the page does not have are welcome. For another machine:
# tests/gpu/bundle.sh build/aaresolve FOLDER, copy FOLDER there, and run FOLDER/measure.sh there.
#
#   DEVICE   vulkan (the first card), vulkan:N, vulkan:NAME      SIZES   "1600x900 1920x1080 3840x2160"
#   RUNS     frames timed per method and size, 200               LIMIT   seconds after which no new size begins, 180
set -eu
here=$(cd "$(dirname "$0")" && pwd)
program=${1:-$here/aaresolve}
out=${2:-measured.json}
device=${DEVICE:-vulkan}
sizes=${SIZES:-1600x900 1920x1080 3840x2160}
runs=${RUNS:-200}
limit=${LIMIT:-180}
started=$(date +%s)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
say() { echo "[$(($(date +%s) - started)) s] $*" >&2; }

"$program" devices >&2
# The analytic shots hold every pass; the pictures are small, because every pixel is compared.
say "making frames"
for scene in half_planes thin_lines moving; do
    for pattern in d3d8 d3d2; do
        "$program" synth $scene -o "$work/$pattern/$scene" --size 240x135 --frames 16 --subsamples $pattern --subsample-color -q
    done
done
"$program" synth half_planes -o "$work/still" --size 240x135 --frames 64 --subsamples d3d2 --subsample-color -q
{
    printf '{"format": "aaresolve-gpu", "version": 1, "date": "%s",\n"system": "%s",\n"devices": ' "$(date -u +%F)" "$(uname -srm)"
    "$program" devices --json
    for kind in "exact fast" "exact double" "fast double"; do
        set -- $kind
        printf ',\n"%s": [' "$1-$2"
        comma=
        for scene in half_planes thin_lines moving; do
            say "comparing the shaders ($1) with the kernels ($2) on $scene"
            printf '%s' "$comma"
            "$program" verify "$work/d3d8/$scene" --device "$device" --gpu-precision $1 --precision $2 --json -q
            printf ,
            # These are made for two sub-samples.
            "$program" verify "$work/d3d2/$scene" -m smaaS2x,smaa4x --device "$device" --gpu-precision $1 --precision $2 --json -q
            comma=,
        done
        printf ']'
    done
    for precision in exact fast; do
        say "64 frames of a still scene, $precision"
        "$program" run "$work/still" -o "$work/ran" --device "$device" --gpu-precision $precision --write none -q --json \
            -m noaa,temporal >"$work/run.json"
        printf ',\n"run-%s": ' $precision
        cat "$work/run.json"
    done
    for precision in exact fast; do
        printf ',\n"bench-%s": [' $precision
        comma=
        for size in $sizes; do
            [ $(($(date +%s) - started)) -lt "$limit" ] || { say "no time left for $size, $precision"; continue; }
            say "timing at $size, $precision"
            printf '%s' "$comma"
            "$program" bench --device "$device" --gpu-precision $precision --size "$size" --runs "$runs" --json \
                -m reference,spatial,geometry,temporal
            comma=,
        done
        printf ']'
    done
    printf '}\n'
} >"$work/measured.json"
mv "$work/measured.json" "$out"
say "written: $out"
