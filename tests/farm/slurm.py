"""A Slurm of one's own on the loopback: controller, munge and two nodes in a temporary folder; nothing of the machine's.

    with Slurm(folder) as slurm:
        subprocess.run(["sbatch", ...], env=slurm.environment)
        slurm.kill("two")   # as if the machine lost its power
"""

from __future__ import annotations

import getpass
import os
import shutil
import signal
import socket
import subprocess
import time
from pathlib import Path

DAEMONS = ("munged", "slurmctld", "slurmd")
NODES = ("one", "two")
_START_SECONDS = 300.0  # on a machine with other work
# Two nodes of one processor each. Nothing needs root or control groups: processes are followed by their group. A job of a
# dead node waits until its credential has expired, hence that short life.
_CONFIGURATION = """\
ClusterName=farm
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=cred_expire=10,socket={folder}/munge.sock
CredType=cred/munge
SlurmctldPort={ports[0]}
SlurmctldPidFile={folder}/slurmctld.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdPidFile={folder}/%n.pid
SlurmdLogFile={folder}/%n.log
SlurmdSpoolDir={folder}/%n
StateSaveLocation={folder}/state
PlugStackConfig={folder}/plugstack.conf
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU_Memory
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SlurmdTimeout=10
InactiveLimit=0
KillWait=2
MinJobAge=86400
SchedulerParameters=batch_sched_delay=0,sched_interval=1
NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=1 RealMemory={memory}
NodeName=two NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=1 RealMemory={memory}
PartitionName=farm Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""
_MEMORY_MB = 8000  # that a node says it has; no more than a promise here


def missing() -> list[str]:
    """Daemons and commands that are not there."""
    return [name for name in (*DAEMONS, "sbatch", "scontrol") if not _path_of(name)]


def _path_of(name: str) -> str | None:
    return shutil.which(name, path=f"{os.environ.get('PATH', '')}:/usr/sbin:/sbin")


def _free_ports(count: int) -> list[int]:
    held = [socket.socket() for _ in range(count)]
    for s in held:
        s.bind(("127.0.0.1", 0))
    ports = [s.getsockname()[1] for s in held]
    for s in held:
        s.close()
    return ports


class Slurm:
    """Starts with ``with``, and ends all that it has started there."""

    def __init__(self, folder: Path, nodes: tuple[str, ...] = NODES) -> None:
        self.folder, self.nodes = folder, nodes
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}
        self._daemons: dict[str, subprocess.Popen] = {}

    def __enter__(self) -> Slurm:
        self.folder.mkdir(parents=True)
        self.folder.chmod(0o755)  # munge wants its socket to be within reach of all
        (self.folder / "state").mkdir()
        (self.folder / "plugstack.conf").write_text("")
        key = self.folder / "munge.key"
        key.touch(0o600)
        key.write_bytes(os.urandom(1024))
        text = _CONFIGURATION.format(
            host=socket.gethostname(),
            user=getpass.getuser(),
            folder=self.folder,
            ports=_free_ports(3),
            memory=_MEMORY_MB,
        )
        (self.folder / "slurm.conf").write_text(text)
        try:
            parts = (
                "key-file:munge.key",
                "socket:munge.sock",
                "pid-file:munged.pid",
                "seed-file:munge.seed",
            )
            options = [f"--{o}={self.folder / f}" for o, f in (part.split(":") for part in parts)]
            self._start("munged", "munged", "--foreground", "--force", *options)
            self._wait("munge's socket", (self.folder / "munge.sock").exists)
            self._start("slurmctld", "slurmctld", "-D", "-i")
            for name in self.nodes:
                self._start(name, "slurmd", "-D", "-N", name)
            self._wait("idle nodes", lambda: self._idle() == len(self.nodes))
        except BaseException:
            self.__exit__()
            raise
        return self

    def __exit__(self, *_unused: object) -> None:
        for name in self.nodes:
            self.kill(name)
        for daemon in reversed(self._daemons.values()):
            daemon.terminate()
        for daemon in self._daemons.values():
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

    def _start(self, what: str, program: str, *options: str) -> None:
        with open(self.folder / f"{what}.out", "wb") as said:
            self._daemons[what] = subprocess.Popen(
                [str(_path_of(program)), *options],
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=said,
                stderr=said,
            )

    def _wait(self, what: str, is_there) -> None:
        end = time.monotonic() + _START_SECONDS
        while not is_there():
            dead = [name for name, daemon in self._daemons.items() if daemon.poll() is not None]
            if dead or time.monotonic() > end:
                said = "\n".join(
                    f"{name}: {line}"
                    for name in dead or self._daemons
                    for line in (self.folder / f"{name}.out").read_text().splitlines()[-3:]
                )
                raise SystemExit(f"Slurm: expected {what} within {_START_SECONDS:.0f} s\n{said}")
            time.sleep(0.2)

    def _idle(self) -> int:
        said = self.ask("sinfo", "-h", "-N", "-t", "idle", "-o", "%N")
        return len(said.split())

    def ask(self, *command: str) -> str:
        """What one of Slurm's commands says."""
        return subprocess.run(command, env=self.environment, capture_output=True, text=True).stdout

    def kill(self, node: str) -> None:
        """The node, its jobs and all of their processes at once."""
        daemon = self._daemons.get(node)
        if daemon is None:
            return
        daemon.kill()
        daemon.wait()
        # A job's processes know their node, and Slurm's step, which has no environment to see, is the parent of one.
        while victims := self.processes_of(node):
            for pid in victims | {parent for p in victims if (parent := self._step_above(p))}:
                try:
                    os.kill(pid, signal.SIGKILL)
                except ProcessLookupError:
                    pass

    def processes_of(self, node: str) -> set[int]:
        """The node's jobs, and what these have started."""
        wanted = {f"SLURM_CONF={self.environment['SLURM_CONF']}", f"SLURMD_NODENAME={node}"}
        found = set()
        for folder in Path("/proc").glob("[0-9]*"):
            try:
                words = {*(folder / "environ").read_bytes().decode(errors="replace").split("\0")}
                dead = (folder / "stat").read_text().rpartition(")")[2].split()[0] == "Z"
            except OSError:
                continue
            if wanted <= words and not dead:
                found.add(int(folder.name))
        return found

    def _step_above(self, pid: int) -> int | None:
        """The process of Slurm that has started this one, if one has."""
        try:
            parent = int(Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[1])
            name = Path(f"/proc/{parent}/comm").read_text().strip()
        except OSError:
            return None
        return parent if name == "slurmstepd" else None
