#!/bin/sh
# report_test.sh PROGRAM BROWSER: makes a report of a synthetic shot and opens it from disk, without network. The page must
# draw its table and charts, and its console must stay empty of errors. The viewer has report_viewer_test.py.
set -eu
program=$1
browser=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
"$program" synth moving -o "$folder/shot" --frames 3 >/dev/null
"$program" run "$folder/shot" -m noaa -m fxaa311 -m taaSimplest -m uncharted -m unchartedNorm -o "$folder/run" -q >/dev/null
"$program" stability -m noaa,uncharted --size 48x27 --frames 4 --long-frames 128 --device cpu -o "$folder/run" -q >/dev/null
"$program" report "$folder/run" -o "$folder/report.html" >/dev/null

# A visitor who sorts by PSNR.
cat >>"$folder/report.html" <<'VISITOR'
<script>
  document.querySelector("#figures thead button").click();
</script>
VISITOR

"$browser" --headless=new --no-sandbox --disable-gpu --user-data-dir="$folder/profile" --host-resolver-rules="MAP * ~NOTFOUND" \
    --enable-logging=stderr --virtual-time-budget=20000 --dump-dom "file://$folder/report.html" >"$folder/dom.html" 2>"$folder/log"

sed -i 's/<wbr>//g' "$folder/dom.html"  # where a name may be broken

failed=0
expect() { # WHAT PATTERN COUNT: at least COUNT lines or places of the drawn page match
    found=$(grep -oE "$2" "$folder/dom.html" | wc -l)
    [ "$found" -ge "$3" ] || { echo "report: $1: expected at least $3, found $found"; failed=1; }
}
if grep -E 'CONSOLE' "$folder/log" | grep -iE 'error|uncaught|failed|refused'; then
    echo "report: errors in the browser's console"
    failed=1
fi
expect "rows of the table" '<th scope="row">(noaa|fxaa311|taaSimplest|uncharted|unchartedNorm)<small' 5
expect "sortable columns" 'aria-sort="none"' 6
expect "a sorted column" 'aria-sort="descending"' 1
expect "sentences" '<li>' 2
expect "charts that were drawn" '<canvas id="(scatter|gain|frames)"[^>]*style="[^"]*(width|height)' 3
expect "figures over time" 'Flicker in motion' 1
expect "charts over time" '<canvas id="(flicker|ghost)"[^>]*style="[^"]*(width|height)' 2
expect "memory" 'Kept at 480&nbsp;×&nbsp;270, MB' 1
expect "stability, where it was measured" '>(The accuracy that speed costs|16-bit [0-9.]+)' 2
expect "what stability was not measured of" 'Not measured: fxaa311, taaSimplest, unchartedNorm' 1
expect "labels of the viewer's pictures" 'class="label"' 4
expect "places that differ" '<canvas width="48" height="48"' 3
expect "parameters" 'What was run' 1
exit $failed
