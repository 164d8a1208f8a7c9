#!/usr/bin/env bash
# Two scenes from nothing to contact sheets: build the .blend, export a shot, check it, run methods, draw, report.
# Usage: demo.sh PROGRAM OUT
set -euo pipefail
program=$1
out=$2
here=$(dirname "$0")
blender=${BLENDER:-blender}
mkdir -p "$out"
started=$(date +%s)

# scene NAME EXPORTER_FLAGS... : methods come from $methods
scene() {
    name=$1
    shift
    blend=$out/$name.blend
    echo "== $name"
    "$blender" -b --factory-startup --python-exit-code 9 -P "$here/$name.py" -- --out "$blend" >"$out/$name.log" 2>&1 ||
        { tail -5 "$out/$name.log" >&2; exit 1; }
    ids=$(echo "$methods" | sed 's/[:+][^ ]*//g; s/ /,/g')
    "$blender" -b "$blend" --python-exit-code 9 -P "$here/../blender_addon/aa_resolve/headless.py" -- \
        --out "$out/$name/shot" --for "$ids" --resolution 480x270 --name "$name" --passes normal,object "$@" |
        { grep -v '^Blender\|^Read blend\|^$' || true; }
    "$program" check "$out/$name/shot"
    set --
    for m in $methods; do set -- "$@" -m "$m"; done
    "$program" run "$out/$name/shot" "$@" -o "$out/$name/results" --quiet
    "$program" sheet "$out/$name/results" -o "$out/$name/sheet.png"
    "$program" report "$out/$name/results" -o "$out/$name/report.html"
}

methods="noaa fxaa311:preset=39 smaa1x:preset=ULTRA taaSimplest uncharted unchartedNorm unchartedNoSharpen master accum"
scene hard_edges --frames 1-16 --truth-samples 128
# Ghosts and flicker are judged between frames that follow each other, so these have truth.
methods="noaa fxaa311:preset=39 smaa1x:preset=ULTRA taaSimplest uncharted unchartedNorm unchartedNoSharpen master accumReject"
scene moving_sphere --frames 1-16 --truth-samples 32 --truth-frames 5-16

echo
echo "done in $(($(date +%s) - started)) s; look at"
for name in hard_edges moving_sphere; do
    echo "  $out/$name/sheet.png   $out/$name/report.html"
done
