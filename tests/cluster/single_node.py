"""A SLURM of one node in a directory of its own, started and stopped again without a trace elsewhere."""

from __future__ import annotations

import getpass
import os
import re
import secrets
import shutil
import signal
import socket
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep

TEMPLATE = Path(__file__).with_name("slurm.conf.in")
DAEMONS = ("slurmd", "slurmctld", "munged")  # in the order in which they are stopped
SECONDS_TO_START, SECONDS_TO_STOP = 30.0, 20.0
SUPERUSER_PATH = os.pathsep.join(("/usr/local/sbin", "/usr/sbin", "/sbin"))


@dataclass(frozen=True)
class SlurmNode:
    """A running SLURM: its directory, and the environment that its commands need."""

    directory: Path
    environment: dict[str, str]

    def query(self, *command: str) -> str:
        """What a command of SLURM prints."""
        return subprocess.run(
            command, env=self.environment, check=True, capture_output=True, text=True, timeout=30
        ).stdout

    def port(self, name: str) -> int:
        """A port that its configuration names."""
        text = (self.directory / "slurm.conf").read_text(encoding="utf-8")
        return int(re.findall(rf"^{name}=(\d+)$", text, re.MULTILINE)[0])


@contextmanager
def slurm_node(directory: Path, cpus: int) -> Iterator[SlurmNode]:
    """Start a SLURM whose files all lie in an empty directory, and stop it again, jobs and daemons.

    Parameters
    ----------
    directory : Path
        Where its files are put.
    cpus : int
        How many CPUs it gives to jobs.

    Raises
    ------
    RuntimeError
        If it does not come up in time, with what its daemons said.
    """
    for name in ("state", "spool"):
        (directory / name).mkdir()
    configuration = directory / "slurm.conf"
    configuration.write_text(
        _fill_in(TEMPLATE.read_text(encoding="utf-8"), directory, cpus), encoding="utf-8"
    )
    _wrap_srun(directory / "bin", configuration)
    key = directory / "munge.key"
    key.write_bytes(secrets.token_bytes(128))
    key.chmod(0o600)
    environment = _environment()
    path = os.pathsep.join((str(directory / "bin"), environment["PATH"]))
    node = SlurmNode(directory, environment | {"PATH": path, "SLURM_CONF": str(configuration)})
    # By force: other users cannot reach its socket, nor need they.
    munged = ["munged", "--force", f"--key-file={key}", f"--socket={directory}/munge.socket"]
    munged += [f"--{kind}-file={directory}/munged.{kind}" for kind in ("pid", "log", "seed")]
    try:
        for command in (munged, ["slurmctld"], ["slurmd"]):
            _start(command, node)
        _wait_until_idle(node)
        yield node
    finally:
        _stop(node)


def daemon_pid(node: SlurmNode, daemon: str) -> int | None:
    """Process id of a daemon of this SLURM, if it runs."""
    try:
        pid = int((node.directory / f"{daemon}.pid").read_text(encoding="ascii"))
        name, _, rest = Path(f"/proc/{pid}/stat").read_text(encoding="ascii").partition(") ")
    except (OSError, ValueError):
        return None
    ended = rest.startswith("Z")  # and nobody has asked for its exit code
    return pid if name.endswith(f"({daemon}") and not ended else None


def _environment() -> dict[str, str]:
    inherited = {key: value for key, value in os.environ.items() if not key.startswith(("SLURM_", "SBATCH_"))}
    return inherited | {"PATH": os.pathsep.join((os.environ["PATH"], SUPERUSER_PATH))}


def _wrap_srun(directory: Path, configuration: Path) -> None:
    """Put an srun into a directory that finds the configuration: jobs lose SLURM_CONF before they call it."""
    srun = shutil.which("srun", path=_environment()["PATH"])
    directory.mkdir()
    wrapper = directory / "srun"
    wrapper.write_text(f'#!/bin/sh\nSLURM_CONF={configuration} exec {srun} "$@"\n', encoding="utf-8")
    wrapper.chmod(0o755)


def _fill_in(template: str, directory: Path, cpus: int) -> str:
    controller_port, worker_port = _free_ports(2)
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    values = {
        "HOST": socket.gethostname().partition(".")[0],
        "CPUS": cpus,
        "MEMORY_MB": int(0.9 * memory / 2**20),
        "USER": getpass.getuser(),
        "DIRECTORY": directory,
        "CONTROLLER_PORT": controller_port,
        "WORKER_PORT": worker_port,
    }
    for name, value in values.items():
        template = template.replace(f"@{name}@", str(value))
    return template


def _free_ports(n: int) -> list[int]:
    sockets = [socket.socket() for _ in range(n)]
    try:
        for opened in sockets:
            opened.bind(("127.0.0.1", 0))
        return [opened.getsockname()[1] for opened in sockets]
    finally:
        for opened in sockets:
            opened.close()


def _start(command: list[str], node: SlurmNode) -> None:
    """Start a daemon, which goes into the background by itself."""
    output = node.directory / f"{command[0]}.start"
    with output.open("w", encoding="utf-8") as file:
        done = subprocess.run(
            command, env=node.environment, stdout=file, stderr=file, timeout=SECONDS_TO_START
        )
    if done.returncode:
        raise RuntimeError(f"{command[0]} does not start: {output.read_text(encoding='utf-8').strip()}")


def _wait_until_idle(node: SlurmNode) -> None:
    end = monotonic() + SECONDS_TO_START
    while monotonic() < end:
        try:
            if node.query("sinfo", "--noheader", "--format=%T").strip() == "idle":
                return
        except subprocess.SubprocessError:
            pass
        sleep(0.2)
    logs = [(node.directory / f"{name}.log").read_text(encoding="utf-8")[-1500:] for name in DAEMONS]
    raise RuntimeError("SLURM does not come up:\n" + "\n".join(logs))


def _stop(node: SlurmNode) -> None:
    """Cancel what is left, then end each daemon by its process id, with force if it does not go."""
    if daemon_pid(node, "slurmctld"):
        subprocess.run(["scancel", f"--user={getpass.getuser()}"], env=node.environment, timeout=30)
    for daemon in DAEMONS:
        for number in (signal.SIGTERM, signal.SIGKILL):
            if (pid := daemon_pid(node, daemon)) is None:
                break
            os.kill(pid, number)
            end = monotonic() + SECONDS_TO_STOP
            while daemon_pid(node, daemon) and monotonic() < end:
                sleep(0.05)
