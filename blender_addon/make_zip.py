# SPDX-License-Identifier: GPL-3.0-or-later
"""Packs the add-on into one zip that Blender installs: ``python3 make_zip.py build/aa_resolve.zip``.

The same sources give the same bytes: names are sorted, times are fixed.
"""

from __future__ import annotations

import os
import sys
import zipfile

FOLDER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "aa_resolve")
SUFFIXES = (".py", ".json", ".toml")


def pack(path: str) -> list[str]:
    """Writes the zip; returns the names in it."""
    names = sorted(
        os.path.relpath(os.path.join(folder, name), FOLDER).replace(os.sep, "/")
        for folder, _, files in os.walk(FOLDER)
        for name in files
        if name.endswith(SUFFIXES)
    )
    temporary = path + ".tmp"
    with zipfile.ZipFile(temporary, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in names:
            entry = zipfile.ZipInfo(f"aa_resolve/{name}", (1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            with open(os.path.join(FOLDER, name), "rb") as file:
                archive.writestr(entry, file.read())
    os.replace(temporary, path)
    return names


if __name__ == "__main__":
    if len(sys.argv) != 2:
        print("usage: make_zip.py OUT.zip", file=sys.stderr)
        sys.exit(2)
    print(f"{sys.argv[1]}: {len(pack(sys.argv[1]))} files")
