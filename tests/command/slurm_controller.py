# SPDX-FileCopyrightText: 2026 Body Moments contributors
# SPDX-License-Identifier: GPL-3.0-or-later
"""A Slurm of one node: controller, worker and authentication as processes of this test, in a folder
of its own.
"""

import getpass
import os
import shutil
import socket
import subprocess
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

_FOLDERS = os.pathsep.join([os.environ.get("PATH", ""), "/usr/sbin", "/sbin"])
PROGRAMS = {
    name: shutil.which(name, path=_FOLDERS)
    for name in ("munged", "slurmctld", "slurmd", "sbatch", "scontrol", "squeue", "sinfo")
}
_START = 30.0  # seconds
_SETTINGS = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller_port}
SlurmdPort={worker_port}
AuthInfo=socket={folder}/munge.socket
SlurmUser={user}
SlurmdUser={user}
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
KillWait=5
SchedulerParameters=sched_interval=1,batch_sched_delay=0
NodeName={host} RealMemory=16000 NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""


class NotStarted(Exception):
    """No controller came up here; what the processes said is the message."""


@contextmanager
def slurm(folder: Path) -> Iterator[dict[str, str]]:
    """A controller that takes jobs within the block, and the environment in which the commands find
    it.

    folder: new, short enough for a socket's name. Raises NotStarted.
    """
    for name in ("state", "spool"):
        (folder / name).mkdir()
    key = folder / "munge.key"
    key.write_bytes(os.urandom(1024))
    key.chmod(0o600)
    values = {
        "host": socket.gethostname().split(".")[0],
        "user": getpass.getuser(),
        "folder": folder,
    }
    ports = {"controller_port": _free_port(), "worker_port": _free_port()}
    settings = folder / "slurm.conf"
    settings.write_text(_SETTINGS.format(**values, **ports))
    places = {
        "socket": "munge.socket",
        "pid-file": "munged.pid",
        "log-file": "munged.log",
        "seed-file": "munge.seed",
    }
    munged = ["munged", "--foreground", "--force", "--key-file", key]
    munged += [word for name, place in places.items() for word in ("--" + name, folder / place)]
    environment = {**os.environ, "SLURM_CONF": str(settings)}
    with ExitStack() as ends:
        said = ends.enter_context(open(folder / "said", "wb"))

        def run(*words: object) -> None:
            command = [PROGRAMS[str(words[0])], *map(str, words[1:])]
            process = subprocess.Popen(
                command, env=environment, stdout=said, stderr=said, stdin=subprocess.DEVNULL
            )
            ends.callback(process.wait)
            ends.callback(process.terminate)

        run(*munged)
        _wait(folder, (folder / "munge.socket").exists)
        run("slurmctld", "-D", "-i", "-f", settings)
        run("slurmd", "-D", "-f", settings)
        _wait(folder, lambda: asked(environment, "sinfo", "-h", "-o", "%t") == "idle")
        yield environment
        asked(environment, "scontrol", "shutdown")


def asked(environment: dict[str, str], *words: object) -> str:
    """The answer of one of Slurm's commands, empty where it fails."""
    command = [PROGRAMS[str(words[0])], *map(str, words[1:])]
    ended = subprocess.run(command, env=environment, capture_output=True, text=True, timeout=60)
    return "" if ended.returncode else ended.stdout.strip()


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def _wait(folder: Path, condition) -> None:
    end = time.monotonic() + _START
    while not condition():
        if time.monotonic() > end:
            raise NotStarted((folder / "said").read_text(errors="replace")[-2000:])
        time.sleep(0.1)
