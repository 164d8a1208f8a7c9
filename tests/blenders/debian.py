"""Blenders of other Debians: makes, keeps and removes the small systems that they run in.

    python3 tests/blenders/debian.py get trixie          makes or reuses one; prints the path of its Blender
    python3 tests/blenders/debian.py run trixie COMMAND  runs COMMAND with BLENDER set to that path; makes nothing
    python3 tests/blenders/debian.py clean               removes every system that nobody uses

The path is a wrapper (wrapper.sh) that is called as any `blender` is; all else runs on this machine. The systems lie in
$AA_BLENDERS or ~/.cache/aa-resolve/blenders; mmdebstrap fills them from the mirror of Debian that this machine's own apt
sources name, or from $AA_DEBIAN_MIRROR. Exit code 77: it cannot be had here, and a line on stderr says why.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from contextlib import contextmanager
from pathlib import Path
from typing import Iterator

SUITES = ("trixie", "sid")  # Debian 13, and the newest there is
CANNOT_BE_HAD = 77  # the SKIP_RETURN_CODE of the tests' CMakeLists.txt
WRAPPER = Path(__file__).resolve().with_name("wrapper.sh")
OPTIONS = (
    "--variant=apt",
    "--include=blender,python3-numpy,python3-openimageio",
    "--include=libgl1,libegl1,libgl1-mesa-dri",  # windows, drawn in software
    # 1.1 GB instead of 4 to unpack; a system that a power cut breaks is made anew.
    "--dpkgopt=path-exclude=/usr/share/doc/*",
    "--dpkgopt=path-exclude=/usr/share/man/*",
    "--dpkgopt=path-exclude=/usr/share/locale/*",
    "--dpkgopt=force-unsafe-io",
    '--aptopt=Acquire::Languages "none"',
    # A mirror frozen in time has a sid whose index has expired. Signatures are checked all the same.
    '--aptopt=Acquire::Check-Valid-Until "false"',
)
RECIPE = hashlib.sha256(repr(OPTIONS).encode()).hexdigest()[:16]
NEEDED_BYTES = 2_500_000_000  # the system, and beside it its packages while they are unpacked
# Of this machine's apt settings, those that decide how a mirror is reached.
REACH = re.compile(r"Acquire::.*(proxy|cainfo|capath|sslcert|sslkey|verify-)", re.IGNORECASE)


class CannotBeHad(Exception):
    """Says in one line why there is no such Blender here."""


def cache_folder() -> Path:
    if chosen := os.environ.get("AA_BLENDERS"):
        return Path(chosen).absolute()
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "aa-resolve/blenders"


def say(text: str) -> None:
    print(f"blenders: {text}", file=sys.stderr, flush=True)


def output_of(*command: str) -> str | None:
    """None when it fails."""
    try:
        done = subprocess.run(command, capture_output=True, text=True)
    except FileNotFoundError:
        return None
    return done.stdout if done.returncode == 0 else None


def may_mount() -> bool:
    """False for a user, and for root in a container that may not mount."""
    return output_of("unshare", "--mount", "true") is not None


def mirror() -> str:
    """The archive of Debian that this machine's own packages come from."""
    if chosen := os.environ.get("AA_DEBIAN_MIRROR"):
        return chosen
    release = Path("/etc/os-release")
    if not release.exists() or not re.search(r"^ID=debian$", release.read_text(), re.MULTILINE):
        raise CannotBeHad("this is no Debian, so no mirror is known: set AA_DEBIAN_MIRROR to one")
    layout = ("--format", "$(REPO_URI) $(RELEASE) $(COMPONENT)", "Created-By: Packages")
    for line in (output_of("apt-get", "indextargets", *layout) or "").splitlines():
        uri, suite, component = line.split()
        if uri.startswith("http") and component == "main" and "-" not in suite:
            return uri
    raise CannotBeHad("apt's sources name no mirror by http: set AA_DEBIAN_MIRROR to one")


def reach_options() -> list[str]:
    """Proxy and certificates of this machine's apt, for mmdebstrap's."""
    dump = output_of("apt-config", "dump", "--no-empty", "--format", '%f "%v"%n', "Acquire") or ""
    return [f"--aptopt={line}" for line in dump.splitlines() if REACH.match(line)]


def check_means(folder: Path) -> None:
    """What can be known before an hour of trying."""
    for tool, package in (("mmdebstrap", "mmdebstrap"), ("unshare", "util-linux")):
        if not shutil.which(tool):
            raise CannotBeHad(f"{tool} is missing: apt-get install {package}")
    if not may_mount():
        namespace = ("unshare", "--user", "--map-root-user", "--mount", "true")
        if output_of(*namespace) is None:
            raise CannotBeHad("neither root's right to mount nor user namespaces are to be had")
        if not shutil.which("newuidmap") or output_of("unshare", "--map-auto", "true") is None:
            raise CannotBeHad(
                "a user needs newuidmap (apt-get install uidmap) and lines in /etc/subuid, /etc/subgid"
            )
    free = shutil.disk_usage(folder).free
    if free < NEEDED_BYTES:
        raise CannotBeHad(
            f"{folder} has {free / 1e9:.1f} GB free and {NEEDED_BYTES / 1e9:.1f} are needed:"
            " set AA_BLENDERS to a folder with more"
        )


def remove(folder: Path) -> None:
    """Never through a mount: what somebody mounted below stays whole."""
    if not folder.exists():
        return
    below = f"{folder.resolve()}/"
    for line in Path("/proc/self/mountinfo").read_text().splitlines():
        if f"{line.split()[4]}/".startswith(below):
            raise CannotBeHad(f"{line.split()[4]} is mounted: umount it, then {folder} can go")
    subprocess.run(["chmod", "-R", "u+rwX", str(folder)], capture_output=True)
    subprocess.run(["rm", "-rf", "--one-file-system", str(folder)], check=True)


@contextmanager
def locked(folder: Path, suite: str, exclusive: bool) -> Iterator[int]:
    """Shared while a system is used, by the wrapper too; exclusive while it is made or removed. Gives the lock's file."""
    try:
        folder.mkdir(parents=True, exist_ok=True)
        handle = os.open(folder / f"{suite}.lock", os.O_RDWR | os.O_CREAT, 0o666)
    except OSError as error:
        raise CannotBeHad(f"{error.filename} cannot be written ({error.strerror}): set AA_BLENDERS")
    try:
        kind = fcntl.LOCK_EX if exclusive else fcntl.LOCK_SH
        try:
            fcntl.flock(handle, kind | fcntl.LOCK_NB)
        except BlockingIOError:
            say(f"waiting for another run that {'uses' if exclusive else 'makes'} {suite}")
            fcntl.flock(handle, kind)
        yield handle
    finally:
        os.close(handle)


def is_whole(system: Path) -> bool:
    try:
        return json.loads((system / "made.json").read_text())["recipe"] == RECIPE
    except (OSError, ValueError, KeyError):
        return False


def end_together(processes: list[subprocess.Popen]) -> list[int]:
    """Their exit codes. Whatever interrupts the waiting ends them, and what they started, first."""
    try:
        return [process.wait() for process in processes]
    except BaseException:
        for process in processes:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
        raise


def fill(root: Path, suite: str, lock: int, options: tuple[str, ...] = OPTIONS) -> None:
    """Debian's packages, unpacked and configured, below `root`."""
    command = ["mmdebstrap", *options, *reach_options()]
    source = f"deb {mirror()} {suite} main"
    log = root.with_name("mmdebstrap.log")
    with log.open("w") as said:
        # A child that outlives this process keeps the lock, so that nobody makes the same at the same time.
        shared = {"stderr": said, "pass_fds": (lock,), "start_new_session": True}
        if may_mount():
            mount = ["unshare", "--mount", "--propagation", "private"]
            command = [*mount, *command, "--mode=root", suite, str(root), source]
            processes = [subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=said, **shared)]
        else:
            # Everything belongs to the user, so that a namespace with this one user suffices afterwards.
            root.mkdir()
            command += ["--mode=unshare", "--format=tar", suite, "-", source]
            unpack = ["tar", "-x", "-C", str(root), "--no-same-owner", "--exclude=./dev/*"]
            packing = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, **shared
            )
            processes = [packing, subprocess.Popen(unpack, stdin=packing.stdout, **shared)]
            packing.stdout.close()
        done = end_together(processes)
    if any(done):
        errors = [line for line in log.read_text(errors="replace").splitlines() if line.strip()]
        marked = [line for line in errors if re.match(r"E: |Err:|tar: ", line.strip())]
        told = (marked or errors or ["it said nothing"])[0].strip()
        raise CannotBeHad(f"mmdebstrap could not make it: {told[:200]}")


def make(folder: Path, suite: str, lock: int) -> None:
    """Under another name until it is whole and its Blender has started."""
    system = folder / suite
    making = folder / f"{suite}.making"
    remove(making)
    check_means(folder)
    started = time.monotonic()
    say(f"making {suite} in {system}: about 300 MB are fetched")
    making.mkdir()
    try:
        fill(making / "root", suite, lock)
        for written in ("etc/apt/sources.list", "etc/apt/apt.conf.d/99mmdebstrap"):
            (making / "root" / written).unlink(missing_ok=True)  # nothing is installed later
        shutil.copy(WRAPPER, making / "blender")
        started_once = subprocess.run(
            [str(making / "blender"), "--version"], capture_output=True, text=True
        )
        version = re.search(r"Blender (\S+)", started_once.stdout)
        if not version:
            why = (started_once.stderr.strip() or "it says nothing").splitlines()[-1]
            raise CannotBeHad(f"the Blender of {suite} does not start: {why}")
        seconds = round(time.monotonic() - started)
        made = {"recipe": RECIPE, "blender": version[1], "seconds": seconds, "at": time.ctime()}
        (making / "made.json").write_text(json.dumps(made, indent=1))
        remove(system)
        making.rename(system)
    finally:
        remove(making)
    say(f"{suite} has Blender {version[1]}; made in {seconds} s")


def existing(suite: str) -> Path:
    """The Blender of a system that is there."""
    folder = cache_folder()
    with locked(folder, suite, exclusive=False):
        if not is_whole(folder / suite):
            raise CannotBeHad(
                f"{suite} has not been made: python3 tests/blenders/debian.py get {suite}"
            )
        return current_wrapper(folder / suite)


def current_wrapper(system: Path) -> Path:
    """A clone's wrapper may be newer than the system."""
    wrapper = system / "blender"
    if wrapper.read_bytes() != WRAPPER.read_bytes():
        fresh = system / f"blender.{os.getpid()}"
        shutil.copy(WRAPPER, fresh)
        fresh.rename(wrapper)
    return wrapper


def get(suite: str) -> Path:
    """The path of a suite's Blender, made when there is none; raises CannotBeHad."""
    folder = cache_folder()
    with locked(folder, suite, exclusive=False):
        if is_whole(folder / suite):
            return current_wrapper(folder / suite)
    with locked(folder, suite, exclusive=True) as lock:
        if not is_whole(folder / suite):
            make(folder, suite, lock)
        return current_wrapper(folder / suite)


def clean() -> None:
    folder = cache_folder()
    for lock in sorted(folder.glob("*.lock")):
        with locked(folder, lock.stem, exclusive=True):
            for system in (folder / lock.stem, folder / f"{lock.stem}.making"):
                if system.exists():
                    remove(system)
                    say(f"removed {system}")


def main(arguments: list[str]) -> int:
    signal.signal(
        signal.SIGTERM, lambda *_: sys.exit(143)
    )  # so that what was begun is cleared away
    try:
        if len(arguments) == 2 and arguments[0] == "get":
            print(get(arguments[1]))
        elif len(arguments) >= 3 and arguments[0] == "run":
            environment = {**os.environ, "BLENDER": str(existing(arguments[1]))}
            return subprocess.run(arguments[2:], env=environment).returncode
        elif arguments == ["clean"]:
            clean()
        else:
            print(__doc__, file=sys.stderr)
            return 2
    except CannotBeHad as reason:
        say(f"SKIPPED {' '.join(arguments[1:2])}: {reason}")
        return CANNOT_BE_HAD
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
