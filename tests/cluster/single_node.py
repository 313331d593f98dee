"""A SLURM of one node whose files are all in one directory."""

import getpass
import os
import secrets
import shutil
import socket
import subprocess
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from time import monotonic, sleep

TEMPLATE = Path(__file__).with_name("slurm.conf.in")
DAEMONS = ("munged --foreground", "slurmctld -D", "slurmd -D")
SECONDS_TO_START = 30.0
SUPERUSER_PATH = os.pathsep.join(("/usr/local/sbin", "/usr/sbin", "/sbin"))


@dataclass(frozen=True)
class SlurmNode:
    """A running SLURM, with the environment of its commands."""

    environment: dict[str, str]

    def query(self, *command: str) -> str:
        """Output of a command of SLURM."""
        return subprocess.run(
            command,
            env=self.environment,
            check=True,
            capture_output=True,
            text=True,
            timeout=30,
        ).stdout


@contextmanager
def slurm_node(directory: Path, cpus: int) -> Iterator[SlurmNode]:
    """Start a SLURM with `cpus` CPUs in a new directory, and stop it with its jobs.

    Raises
    ------
    RuntimeError
        If it does not start in time, with the output of its daemons.
    """
    for name in ("state", "spool", "bin"):
        (directory / name).mkdir(parents=True)
    configuration = directory / "slurm.conf"
    configuration.write_text(filled_in(directory, cpus), encoding="utf-8")
    key = directory / "munge.key"
    key.write_bytes(secrets.token_bytes(128))
    key.chmod(0o600)
    inherited = {
        name: of
        for name, of in os.environ.items()
        if not name.startswith(("SLURM_", "SBATCH_"))
    }
    path = os.pathsep.join((str(directory / "bin"), os.environ["PATH"], SUPERUSER_PATH))
    node = SlurmNode(inherited | {"PATH": path, "SLURM_CONF": str(configuration)})
    # SLURM_CONF is not in the environment of jobs, which call srun.
    wrapper = directory / "bin/srun"
    srun = shutil.which("srun", path=path)
    wrapper.write_text(
        f'#!/bin/sh\nSLURM_CONF={configuration} exec {srun} "$@"\n', encoding="utf-8"
    )
    wrapper.chmod(0o755)
    # munged refuses a socket that other users cannot reach, unless forced.
    munge = ["--force", f"--key-file={key}", f"--socket={directory}/munge.socket"]
    munge += [
        f"--{kind}-file={directory}/munged.{kind}" for kind in ("pid", "log", "seed")
    ]
    with ExitStack() as stack:
        for daemon in DAEMONS:
            command = [*daemon.split(), *(munge if daemon.startswith("munged") else [])]
            output = stack.enter_context((directory / f"{command[0]}.out").open("w"))
            process = subprocess.Popen(
                command, env=node.environment, stdout=output, stderr=output
            )
            stack.enter_context(process)  # waits for its end
            stack.callback(process.kill)
        wait_until_idle(node, directory)
        stack.callback(node.query, "scancel", f"--user={getpass.getuser()}")
        yield node


def filled_in(directory: Path, cpus: int) -> str:
    """The configuration of the node."""
    with socket.socket() as controller, socket.socket() as worker:
        for opened in (controller, worker):
            opened.bind(("127.0.0.1", 0))
        ports = [opened.getsockname()[1] for opened in (controller, worker)]
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    values = {
        "HOST": socket.gethostname().partition(".")[0],
        "CPUS": cpus,
        "MEMORY_MB": int(0.9 * memory / 2**20),
        "USER": getpass.getuser(),
        "DIRECTORY": directory,
        "CONTROLLER_PORT": ports[0],
        "WORKER_PORT": ports[1],
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    for name, value in values.items():
        text = text.replace(f"@{name}@", str(value))
    return text


def wait_until_idle(node: SlurmNode, directory: Path) -> None:
    end = monotonic() + SECONDS_TO_START
    while monotonic() < end:
        try:
            if node.query("sinfo", "--noheader", "--format=%T").strip() == "idle":
                return
        except subprocess.SubprocessError:
            pass
        sleep(0.2)
    outputs = [
        path.read_text(encoding="utf-8")[-1500:] for path in directory.glob("*.out")
    ]
    raise RuntimeError("SLURM does not start:\n" + "\n".join(outputs))
