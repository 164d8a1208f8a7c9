"""viewer_speed.py REPORT.html [--browser CHROMIUM]: how fast a report's viewer is in a headless browser without a graphics
card. Prints one line per measurement; it is no test, since it measures speed."""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from devtools import Browser, Page  # noqa: E402

IDLE = "window.aaViewer && aaViewer.idle()"
# Times in ms between frames of the screen while `during` runs; and how many frames of the shot were shown.
WATCHED = """(async () => {
  const { state, set } = aaViewer, gaps = [], shown = new Set(), began = performance.now();
  let last = began, changes = 0, before = state.frame;
  %s
  for (let now = began; now - began < %d; ) {
    now = await new Promise(requestAnimationFrame);
    gaps.push(now - last);
    last = now;
    if (state.frame !== before) { changes++; before = state.frame; }
    %s
  }
  %s
  gaps.sort((a, b) => a - b);
  const at = (share) => gaps[Math.min(gaps.length - 1, Math.floor(share * gaps.length))];
  return { median: at(0.5), late: at(0.95), most: gaps.at(-1), screens: gaps.length, changes, seconds: (last - began) / 1000 };
})()"""
SPACE = "document.getElementById('stage').dispatchEvent(new KeyboardEvent('keydown', { key: ' ', bubbles: true }));"


def main() -> None:
    line = argparse.ArgumentParser(description=__doc__)
    line.add_argument("report", type=Path)
    line.add_argument("--browser", default="chromium")
    line.add_argument("--width", type=int, default=1400)
    asked = line.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        browser = Browser(asked.browser, Path(folder) / "profile")
        began = time.monotonic()
        page = Page(browser, asked.width, 900)
        page.open(asked.report.resolve(), "")
        page.wait(IDLE, 120)
        print(f"{asked.report.stat().st_size / 1e6:.1f} MB")
        print(f"open until drawn: {time.monotonic() - began:.2f} s")
        sources = page.value("aaViewer.data.views[0].pictures.length")
        frames = page.value("aaViewer.data.views[0].frames.length")
        print(f"{frames} frames, {sources} pictures")
        # Unpacking: one method's whole sequence.
        one = page.value(
            """(() => { const { pictures, data } = aaViewer, times = [];
            for (const f of data.views[0].frames) { const t = performance.now(); pictures.get(0, "7", f); times.push(performance.now() - t); }
            times.sort((a, b) => a - b); return times[times.length >> 1]; })()"""
        )
        print(f"unpack one picture: {one:.1f} ms (median of a sequence)")
        for panes in (2, 4, 9):
            page.value(
                f"""aaViewer.set({{ shown: ["truth", "0", "1", "2", "3", "4", "5", "6", "8"].slice(0, {panes}), mode: "side", kind: "picture", zoom: null }})"""
            )
            page.wait(IDLE)
            for name in ("first time round", "again"):
                got = page.value(WATCHED % (SPACE, 3000, "", SPACE))
                print(
                    f"play {panes} side by side, {name}: {got['changes'] / got['seconds']:.1f} frames/s of "
                    f"{page.value('aaViewer.state.fps')}; screen {got['median']:.0f} ms, 95 % {got['late']:.0f}, most {got['most']:.0f}"
                )
            got = page.value(
                WATCHED
                % (
                    "aaViewer.stage.zoomTo(4);",
                    2000,
                    "aaViewer.stage.panBy(3, 2);",
                    "set({ zoom: null });",
                )
            )
            print(
                f"drag {panes} side by side: screen {got['median']:.0f} ms, 95 % {got['late']:.0f}, most {got['most']:.0f}"
            )
        page.value("""aaViewer.set({ shown: ["truth", "0", "1", "2"], mode: "side" })""")
        for kind in ("signed", "error", "ssim", "flip", "flicker", "xt"):
            took = page.value(
                f"""(async () => {{ const t = performance.now(); aaViewer.set({{ kind: "{kind}" }});
                do await new Promise(requestAnimationFrame); while (!aaViewer.idle()); return performance.now() - t; }})()"""
            )
            print(f"{kind}, 4 pictures: {took:.0f} ms")
        for error in page.errors():
            print("console:", error)
        browser.close()


if __name__ == "__main__":
    main()
