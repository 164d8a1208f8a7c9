"""The study of scenes/farm on one machine and on a Slurm of its own, interrupted and resumed: always the same bytes.

    python3 tests/farm/farm.py PROGRAM [--only NAME ...] [--config KEY=VALUE ...]

Each way is a study in an empty folder; those after the first are held against it. Needs snakemake and, for Slurm, its
daemons: `make test-farm` installs them.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import same
import slurm

ROOT = Path(__file__).resolve().parents[2]
_MIDWAY = 3  # jobs that are done by then
_WAIT_SECONDS = 3600.0  # for a picture that is being made, on a machine with other work


class Farm:
    """Runs the workflow in a folder of its own for each way."""

    def __init__(self, program: Path, folder: Path, config: list[str]) -> None:
        self.folder, self.config = folder, config
        self.seconds: dict[
            str, float
        ] = {}  # of the workflow alone, by way, where it was not interrupted
        self._started: list[subprocess.Popen] = []
        self.environment = {
            **os.environ,
            "AARESOLVE": str(program),
            "XDG_CACHE_HOME": str(folder / "cache"),
            "CI": "true",  # Snakemake 7 looks after jobs of a cluster each second then, else every ten
        }

    def start(self, name: str, *options: str, **environment: str) -> subprocess.Popen:
        """The workflow in the way's folder, whose output is the study `study`."""
        work = self.folder / name
        work.mkdir(exist_ok=True)
        command = ["snakemake", "-s", str(ROOT / "scenes/Snakefile"), *options]
        command += ["--config", *self.config, "out=study"]
        with open(work / "log", "ab") as log:
            process = subprocess.Popen(
                command,
                cwd=work,
                env={**self.environment, **environment},
                stdout=log,
                stderr=log,
                start_new_session=True,
            )
        self._started.append(process)
        return process

    def end(self) -> None:
        """Ends what a failure has left."""
        for process in self._started:
            if process.poll() is None:
                os.killpg(process.pid, signal.SIGKILL)
                process.wait()

    def run(self, name: str, *options: str, **environment: str) -> None:
        """The same to its end, which must be a good one."""
        started = time.monotonic()
        self.ends_well(name, self.start(name, *options, **environment))
        self.seconds[name] = time.monotonic() - started

    def ends_well(self, name: str, process: subprocess.Popen) -> None:
        if process.wait() != 0:
            log = self.folder / name / "log"
            last = "\n".join(log.read_text(errors="replace").splitlines()[-30:])
            raise SystemExit(f"farm: {name}: failed, see {log}\n{last}")

    def study(self, name: str) -> Path:
        return self.folder / name / "study"

    def claims(self, name: str) -> list[Path]:
        """Pictures that are being made."""
        return list(self.study(name).glob("*/shot/.aa/claims/*.json"))

    def marks(self, name: str) -> int:
        """Jobs that are done."""
        return len(list(self.study(name).glob("*/jobs/*")))


def wait_for(what: str, found: Callable[[], object], process: subprocess.Popen) -> object:
    """What ``found`` gives, as soon as it gives something, while the process goes on."""
    end = time.monotonic() + _WAIT_SECONDS
    while process.poll() is None and time.monotonic() < end:
        if result := found():
            return result
        time.sleep(0.05)
    raise SystemExit(f"farm: there was no moment with {what}")


def owner(claim: Path) -> int:
    """The process that has it; 0 where it has just been given back."""
    try:
        return json.loads(claim.read_text())["pid"]
    except (OSError, ValueError):
        return 0


def one(farm: Farm) -> str:
    """one process, one job at a time"""
    farm.run("one", "--cores", "1")
    return ""


def two(farm: Farm) -> str:
    """two jobs at once"""
    farm.run("two", "--cores", "2")
    return ""


def stopped(farm: Farm) -> str:
    """two jobs at once, all of it killed midway, and begun again"""
    first = farm.start("stopped", "--cores", "2")
    claim = wait_for("a picture being made", lambda: _midway(farm, "stopped"), first)
    os.killpg(first.pid, signal.SIGKILL)
    first.wait()
    done = farm.marks("stopped")
    farm.run("stopped", "--unlock")
    farm.run("stopped", "--cores", "2", "--rerun-incomplete")
    return f"killed after {done} jobs, while {claim} was made"


def _midway(farm: Farm, name: str) -> str:
    claims = farm.claims(name)
    return claims[0].stem if claims and farm.marks(name) >= _MIDWAY else ""


def elsewhere(farm: Farm) -> str:
    """a picture that a machine has begun which is no more"""
    work = farm.folder / "elsewhere"
    shutil.copytree(farm.folder / "one", work)
    shot = next(iter(farm.study("elsewhere").glob("*/shot")))
    record = sorted((shot / ".aa/frames").glob("*.json"))[-1]
    (shot / "frames" / f"{record.stem}.exr").unlink()
    record.unlink()
    claim = shot / f".aa/claims/frames-{record.stem}.json"
    claim.write_text('{"host": "a-machine-that-is-gone", "pid": 1}\n')
    for mark in (shot.parent / "jobs").glob("frames.*"):
        mark.unlink()
    (work / "log").unlink()
    process = farm.start("elsewhere", "--cores", "1")
    log = work / "log"
    wait_for(
        "the job waiting for that machine",
        lambda: "being made elsewhere" in log.read_text(errors="replace"),
        process,
    )
    os.utime(claim, (0.0, 0.0))  # as if claim_timeout had passed
    farm.ends_well("elsewhere", process)
    return "waited for it, then made it"


def slurm_one(farm: Farm) -> str:
    """Slurm, one worker"""
    with slurm.Slurm(farm.folder / "slurm-one", slurm.NODES[:1]) as cluster:
        farm.run("slurm_one", *_PROFILE, **cluster_of(cluster))
    return ""


def slurm_two(farm: Farm) -> str:
    """Slurm, two workers"""
    with slurm.Slurm(farm.folder / "slurm-two") as cluster:
        farm.run("slurm_two", *_PROFILE, **cluster_of(cluster))
    return ""


def slurm_killed(farm: Farm) -> str:
    """Slurm, two workers, one of them killed midway"""
    name, node = "slurm_killed", slurm.NODES[1]
    with slurm.Slurm(farm.folder / "slurm-killed") as cluster:
        process = farm.start(name, *_PROFILE, **cluster_of(cluster))

        def its_claim() -> str:
            if farm.marks(name) < _MIDWAY:
                return ""
            claims = {owner(c): c.stem for c in farm.claims(name)}
            return next((claims[p] for p in cluster.processes_of(node) if p in claims), "")

        claim = wait_for("a picture being made by the second worker", its_claim, process)
        done = farm.marks(name)
        cluster.kill(node)
        farm.ends_well(name, process)
        lost = cluster.ask("scontrol", "-o", "show", "jobs")
        if "Restarts=1" not in lost:
            raise SystemExit(
                f"farm: {name}: expected a job of the dead worker to be begun again\n{lost}"
            )
    return f"killed after {done} jobs, while it made {claim}"


def cluster_of(cluster: slurm.Slurm) -> dict[str, str]:
    return {"SLURM_CONF": cluster.environment["SLURM_CONF"]}


_PROFILE = ("--profile", str(ROOT / "scenes/farm/slurm"), "--latency-wait", "5")
WAYS = {f.__name__: f for f in (one, two, stopped, elsewhere, slurm_one, slurm_two, slurm_killed)}


def main(argv: list[str]) -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program", type=Path)
    parser.add_argument("--only", nargs="+", choices=WAYS, default=list(WAYS), help="beside `one`")
    parser.add_argument(
        "--config", nargs="+", default=[], metavar="KEY=VALUE", help="another study"
    )
    parser.add_argument("--keep", type=Path, help="a folder that stays; else a temporary one")
    a = parser.parse_args(argv)
    lacks = [n for n in ("snakemake",) if not shutil.which(n)] + slurm.missing()
    if lacks:
        print(
            f"farm: {', '.join(lacks)}: not here; `make test-farm` installs them", file=sys.stderr
        )
        return 3
    for number in (signal.SIGINT, signal.SIGTERM):  # ends what runs, and leaves nothing
        signal.signal(number, lambda caught, _: sys.exit(128 + caught))
    folder = a.keep.absolute() if a.keep else Path(tempfile.mkdtemp(prefix="aa_farm_"))
    folder.mkdir(exist_ok=True)
    kept = bool(a.keep)
    try:
        failed = tried(Farm(a.program.resolve(), folder, a.config), {"one", *a.only})
        kept = kept or failed
    except BaseException as stop:
        kept = kept or not (isinstance(stop, SystemExit) and isinstance(stop.code, int))
        raise
    finally:
        if kept:
            print(f"farm: what was made lies in {folder}", file=sys.stderr)
        else:
            shutil.rmtree(folder)
    return int(failed)


def tried(farm: Farm, names: set[str]) -> bool:
    """Goes the ways of these names and says how each went; true where one has other bytes than the first."""
    failed, wanted = False, {}
    for name, way in WAYS.items():
        if name not in names:
            continue
        started = time.monotonic()
        try:
            said = way(farm)
        finally:
            farm.end()
        seconds = time.monotonic() - started
        found = same.content(farm.study(name))
        wanted = wanted or found
        different = same.differences(wanted, found)
        failed = failed or bool(different)
        verdict = (
            f"DIFFERENT: {', '.join(different[:5])}"
            if different
            else "same bytes" * (name != "one")
        )
        words = ", ".join(filter(None, (f"{len(found)} files", verdict, said)))
        print(f"farm: {way.__doc__}: {seconds:.0f} s, {words}", flush=True)
    for what, one, two in (("jobs at once", "one", "two"), ("workers of Slurm", "slurm_one", "slurm_two")):  # fmt: skip
        if {one, two} <= names:
            share, load = farm.seconds[two] / farm.seconds[one], os.getloadavg()[1]
            print(f"farm: two {what} took {share:.2f} of the time of one (load {load:.1f})")
    return failed


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
