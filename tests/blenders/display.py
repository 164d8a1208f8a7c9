# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender with a window where there is no screen: Xvfb, a display in memory, and drawing in software."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WIDTH, HEIGHT = 1400, 1000
LIMIT_SECONDS = 600
CANNOT_BE_HAD = 77  # exit code where no window can be had here
_BEGUN = "begun"  # a file that says that Blender has its window


def begun(folder: str) -> None:
    """To be called by the script once it runs in Blender."""
    with open(os.path.join(folder, _BEGUN), "w", encoding="utf-8"):
        pass


def _skipped(why: str) -> int:
    print(f"SKIPPED: no window can be had here: {why}", file=sys.stderr, flush=True)
    return CANNOT_BE_HAD


def run(script: str, folder: str, *words: str, flags: tuple[str, ...] = ()) -> int:
    """Runs ``script`` in the Blender that BLENDER names (else ``blender``) with FOLDER and ``words`` behind ``--``; the
    exit code, CANNOT_BE_HAD where there is no window. The add-on is installed, from the sources. The display's memory
    is FOLDER/Xvfb_screen0."""
    if not shutil.which("Xvfb"):
        return _skipped("Xvfb is missing: apt-get install xvfb")
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
    mark = os.path.join(folder, _BEGUN)
    if os.path.exists(mark):
        os.unlink(mark)
    reading, writing = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", folder],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )  # fmt: skip
    try:
        os.close(writing)
        with os.fdopen(reading) as said:
            number = said.readline().strip()
        if not number:
            return _skipped("Xvfb does not start")
        scripts = os.path.join(folder, "scripts")
        os.makedirs(os.path.join(scripts, "addons"), exist_ok=True)
        installed = os.path.join(scripts, "addons", "aa_resolve")
        if not os.path.islink(installed):
            os.symlink(os.path.join(ROOT, "blender_addon", "aa_resolve"), installed)
        environment = {
            **os.environ,
            "DISPLAY": f":{number}",
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "BLENDER_USER_SCRIPTS": scripts,
        }
        command = [os.environ.get("BLENDER") or "blender", "--factory-startup", *flags]
        command += [
            "--python-exit-code",
            "9",
            "--window-geometry",
            "0",
            "0",
            str(WIDTH),
            str(HEIGHT),
        ]
        command += ["-P", os.path.abspath(script), "--", folder, *words]
        code = subprocess.run(command, env=environment, timeout=LIMIT_SECONDS).returncode
        if code and not os.path.exists(mark):
            return _skipped(
                f"Blender ended with {code} before it had one; drawing in software needs libgl1-mesa-dri"
            )
        return code
    finally:
        server.terminate()
        server.wait()
