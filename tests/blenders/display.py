# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender with a window where there is no screen: Xvfb, a display in memory, and drawing in software."""

from __future__ import annotations

import os
import subprocess

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WIDTH, HEIGHT = 1400, 1000
LIMIT_SECONDS = 600


def run(script: str, folder: str, *words: str, flags: tuple[str, ...] = ()) -> int:
    """Runs ``script`` in the Blender that BLENDER names (else ``blender``) with FOLDER and ``words`` behind ``--``; the
    exit code. The add-on is installed, from the sources. The display's memory is FOLDER/Xvfb_screen0.
    """
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
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
            raise SystemExit("Xvfb does not start")
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
        return subprocess.run(command, env=environment, timeout=LIMIT_SECONDS).returncode
    finally:
        server.terminate()
        server.wait()
