"""Runs a program as a whole process and says what it took."""

import dataclasses
import json
import os
import pathlib
import shutil
import statistics
import subprocess
import tempfile
import time


REFERENCE_SEED = 24301


class Failed(Exception):
    """A program that did not end as it should; the text has its last words."""


@dataclasses.dataclass
class Cost:
    cpu: float  # user and system [s]
    wall: float  # [s]
    memory: float  # largest resident size [MB]

    def as_dict(self):
        return dataclasses.asdict(self)


def run(command, folder=None, environment=None):
    """Cost and standard output of a command that must succeed.

    The kernel starts a child's largest resident size at that of the process it was forked from, so
    this one imports nothing large.
    """
    command = [str(word) for word in command]
    if shutil.which(command[0]) is None:
        raise Failed(f"no program {command[0]}")
    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        start = time.perf_counter()
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=out,
            stderr=err,
            cwd=folder,
            env=None if environment is None else os.environ | environment,
        )
        _, status, used = os.wait4(process.pid, 0)
        wall = time.perf_counter() - start
        process.returncode = os.waitstatus_to_exitcode(status)
        out.seek(0)
        err.seek(0)
        text, complaint = out.read().decode(errors="replace"), err.read().decode(errors="replace")
    if process.returncode != 0:
        raise Failed(f"{' '.join(command)}: exit code {process.returncode}\n{complaint.strip()[-2000:]}")
    return Cost(used.ru_utime + used.ru_stime, wall, used.ru_maxrss * 1024 / 1e6), text


def atrium(program, *arguments):
    """Cost and `--stats` of one run of atrium; the memory is what the program itself saw."""
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "stats.json"
        cost, _ = run([program, *arguments, "--stats", file, "--quiet"])
        stats = json.loads(file.read_text(encoding="utf-8"))
    cost.memory = stats["peak_memory_mb"]
    return cost, stats


def rays_of(counters):
    """All rays that were traced, of the counters of `--stats`."""
    return sum(n for name, n in counters.items() if name.startswith("rays.") and name != "rays.refused")


def path_reference(program, scene, folder, size, samples):
    """A picture by path tracing, with a seed that no other picture has; kept in the folder for later runs."""
    file = folder / f"{scene.stem}-{size}-{samples}.exr"
    if not file.exists():
        atrium(program, "render", scene, "-o", file, "--size", size, "--method", "path", "--samples", samples,
               "--seed", REFERENCE_SEED)
    return file


def median(costs):
    """Of every number on its own."""
    return Cost(*(statistics.median(getattr(c, field.name) for c in costs) for field in dataclasses.fields(Cost)))


def repeated(once):
    """once() returns a Cost and something else; runs of less than 2 s are made three times, for the median of
    their costs and what the last one returned."""
    cost, rest = once()
    costs = [cost]
    while cost.wall < 2.0 and len(costs) < 3:
        cost, rest = once()
        costs.append(cost)
    return median(costs), rest


def compare(program, picture, reference):
    """The error measures of `atrium compare`."""
    _, text = run([program, "compare", picture, reference, "--json"])
    return json.loads(text)
