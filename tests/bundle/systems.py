"""Small Debian systems that lack all but what each is named for, and commands run in them.

They are made and kept as those of tests/blenders/debian.py are, in the same folder. Nothing that runs in one changes it:
/tmp inside is in memory, and what is handed in is mounted there.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "blenders"))

import debian  # noqa: E402
from debian import CannotBeHad  # noqa: E402,F401


@dataclass(frozen=True)
class System:
    """What mmdebstrap is asked for."""

    suite: str
    variant: str
    packages: tuple[str, ...] = ()
    further: tuple[str, ...] = ()
    settle: Callable[[Path], None] | None = None  # once it is filled

    @property
    def options(self) -> tuple[str, ...]:
        shared = [o for o in debian.OPTIONS if not re.match("--(variant|include)=", o)]
        include = [f"--include={','.join(self.packages)}"] if self.packages else []
        return (f"--variant={self.variant}", *include, *shared, *self.further)

    @property
    def recipe(self) -> str:
        return hashlib.sha256(repr(self.options).encode()).hexdigest()[:16]


# Without even a C++ library or apt: what Debian calls essential, and no more.
BARE = {f"bare-{suite}": System(suite, "essential") for suite in ("bookworm", "trixie", "sid")}
# Blender, and what Debian's lacks of the packages that are part of blender.org's: numpy, which most add-ons need, and in
# sid two that Blender's own extensions need.
BLENDER = {
    "blender-trixie": System("trixie", "apt", ("blender", "python3-numpy")),
    "blender-sid": System(
        "sid", "apt", ("blender", "python3-numpy", "python3-cattr", "python3-requests")
    ),
}
# A driver that loads the newest C++ library there is.
VULKAN = {"vulkan-sid": System("sid", "essential", ("libvulkan1", "mesa-vulkan-drivers"))}


def settle_links(root: Path) -> None:
    """Links hold from outside; BLAS is where its package's script would have put it."""
    for link in filter(Path.is_symlink, (root / "usr").rglob("*")):
        target = os.readlink(link)
        if target.startswith("/"):
            link.unlink()
            link.symlink_to(os.path.relpath(f"{root}{target}", link.parent))
    libraries = root / "usr/lib/aarch64-linux-gnu"
    for kind in ("blas", "lapack"):
        (libraries / f"lib{kind}.so.3").symlink_to(f"{kind}/lib{kind}.so.3")


# What a program for 64-bit Arm is compiled against and runs on: unpacked, and never entered.
ARM_PACKAGES = (
    "libopenimageio-dev,libopenexr-dev,libpng-dev,libfreetype-dev,libcairo2-dev,libwebp-dev,libgif-dev,libglm-dev,"
    "nlohmann-json3-dev,libcli11-dev,libxxhash-dev,libtbb-dev,libdeflate-dev,libisal-dev,libgtest-dev,libgmock-dev,fonts-dejavu-core"
)
ARM = {
    f"arm64-{suite}": System(
        suite,
        "extract",
        tuple(ARM_PACKAGES.split(",")),
        (
            "--architecture=arm64",
            "--hook-dir=/usr/share/mmdebstrap/hooks/merged-usr",
        ),
        settle_links,
    )
    for suite in ("bookworm", "trixie", "sid")
}
ALL = {**BARE, **BLENDER, **VULKAN, **ARM}

# A mount namespace of its own: nothing stays mounted however this ends.
ENTER = r"""
set -eu
root=$1; shift
mount -t tmpfs -o size=1g inside "$root/tmp"
for place in /proc /sys /dev; do mkdir -p "$root$place"; mount --rbind $place "$root$place"; done
while [ "$1" != -- ]; do
    mkdir -p "$root/tmp/$2"
    mount --rbind "$1" "$root/tmp/$2"
    shift 2
done
shift
mkdir "$root/tmp/home"
exec chroot "$root" /usr/bin/env -i HOME=/tmp/home LANG=C.UTF-8 PATH=/usr/local/bin:/usr/bin:/bin:/usr/sbin:/sbin \
    sh -c 'cd /tmp/home && exec "$@"' sh "$@"
"""


def root_of(name: str) -> Path:
    """The folder of a system, made when there is none; raises CannotBeHad."""
    system, folder = ALL[name], debian.cache_folder()
    whole = folder / name / "made.json"

    def is_whole() -> bool:
        return whole.exists() and json.loads(whole.read_text())["recipe"] == system.recipe

    with debian.locked(folder, name, exclusive=True) as lock:
        if not is_whole():
            debian.check_means(folder)
            making = folder / f"{name}.making"
            debian.remove(making)
            making.mkdir()
            try:
                debian.say(f"making {name} in {folder / name}")
                debian.fill(making / "root", system.suite, lock, system.options)
                if system.settle:
                    system.settle(making / "root")
                (making / "made.json").write_text(json.dumps({"recipe": system.recipe}))
                debian.remove(folder / name)
                making.rename(folder / name)
            finally:
                debian.remove(making)
    return folder / name / "root"


def run(
    name: str, shared: dict[Path, str], *command: str, timeout: float = 600
) -> subprocess.CompletedProcess:
    """Runs a command in a system; each folder of `shared` is below /tmp there, under the name given."""
    root = root_of(name)
    namespace = ["unshare", "--mount", "--propagation", "private"]
    if not debian.may_mount():
        namespace[1:1] = ["--user", "--map-root-user"]
    mounts = [word for folder, inside in shared.items() for word in (str(folder), inside)]
    with debian.locked(debian.cache_folder(), name, exclusive=False):
        return subprocess.run(
            [*namespace, "sh", "-c", ENTER, "sh", str(root), *mounts, "--", *command],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=timeout,
        )
