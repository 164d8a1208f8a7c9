# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the add-on into one zip that Blender installs, with or without the program:

    python3 make_zip.py OUT.zip [--program BUNDLE]

One layout serves every Blender: a folder ``aa_resolve`` with ``bl_info``, which 3.4 to 4.1 install as an add-on, and in
it ``blender_manifest.toml``, by which 4.2 and later install the same file as an extension. BUNDLE is the folder that
`make bundle` fills; with it the zip is for Linux on x86-64 alone, and its manifest says so.

The same sources give the same bytes: names are sorted, times are fixed.
"""

from __future__ import annotations

import argparse
import os
import re
import sys
import zipfile

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "aa_resolve")
SUFFIXES = (".py", ".json", ".toml")
MANIFEST = "blender_manifest.toml"
PROGRAM_PLATFORM = "linux-x64"


def files_below(folder: str) -> list[str]:
    """Paths relative to the folder, sorted."""
    return sorted(
        os.path.relpath(os.path.join(place, name), folder).replace(os.sep, "/")
        for place, _, names in os.walk(folder)
        for name in names
    )


def manifest_for(platform: str, text: str) -> str:
    """The manifest with one platform in place of all."""
    changed, count = re.subn(
        r"^platforms = \[.*?\]", f'platforms = ["{platform}"]', text, flags=re.M | re.S
    )
    if count != 1:
        raise ValueError(f"{MANIFEST}: expected one line 'platforms = [...]', found {count}")
    return changed


def pack(path: str, program: str = "") -> list[str]:
    """Writes the zip; returns the names in it."""
    sources = {
        f"aa_resolve/{name}": os.path.join(FOLDER, name)
        for name in files_below(FOLDER)
        if name.endswith(SUFFIXES)
    }
    if program:
        for name in files_below(program):
            sources[f"aa_resolve/bundle/{name}"] = os.path.join(program, name)
    temporary = path + ".tmp"
    with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name, source in sorted(sources.items()):
            entry = zipfile.ZipInfo(name, (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            mode = 0o755 if os.stat(source).st_mode & 0o100 and program else 0o644
            entry.external_attr = mode << 16
            with open(source, "rb") as file:
                content = file.read()
            if program and name == f"aa_resolve/{MANIFEST}":
                content = manifest_for(PROGRAM_PLATFORM, content.decode()).encode()
            archive.writestr(entry, content)
    os.replace(temporary, path)
    return sorted(sources)


def main() -> int:
    parser = argparse.ArgumentParser(description="Packs the add-on into one zip.")
    parser.add_argument("out", metavar="OUT.zip")
    parser.add_argument("--program", metavar="BUNDLE", default="", help="folder of `make bundle`")
    arguments = parser.parse_args()
    launcher = os.path.join(arguments.program, "bin", "aaresolve")
    if arguments.program and not os.path.exists(launcher):
        print(f"error: --program: {launcher} is missing; run `make bundle` first", file=sys.stderr)
        return 3
    count = len(pack(arguments.out, arguments.program))
    size = os.path.getsize(arguments.out) / 1e6
    print(f"{arguments.out}: {count} files, {size:.1f} MB")
    return 0


if __name__ == "__main__":
    sys.exit(main())
