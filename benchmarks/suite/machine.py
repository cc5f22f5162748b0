"""What was measured where: processor, compiler, commit, date, and how much else the machine did."""

import datetime
import os
import pathlib
import re
import resource
import subprocess
import time


def cpu_model():
    for line in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
        if line.startswith("model name"):
            return line.split(":", 1)[1].strip()
    return "unknown processor"


def memory_gb():
    return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9


def first_line(command, folder=None):
    """Of a program's answer; empty if there is no such program."""
    try:
        run = subprocess.run(command, capture_output=True, text=True, check=True, cwd=folder)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return (run.stdout.strip().splitlines() or [""])[0]


def compiler(atrium):
    """As CMake found it for the build that the program is of."""
    cache = atrium.parent.parent / "CMakeCache.txt"
    text = cache.read_text(encoding="utf-8") if cache.exists() else ""
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.+)$", text, re.M)
    return first_line([found.group(1), "--version"]) if found else "unknown compiler"


def describe(atrium, root):
    commit = first_line(["git", "rev-parse", "--short", "HEAD"], root)
    changed = first_line(["git", "status", "--porcelain", "--", "apps", "lib*", "CMakeLists.txt"], root)
    return {
        "cpu": cpu_model(),
        "cores": os.cpu_count(),
        "memory_gb": round(memory_gb()),
        "compiler": compiler(atrium),
        "commit": commit + (" with changes" if changed else ""),
        "date": datetime.datetime.now(datetime.timezone.utc).strftime("%Y-%m-%d"),
    }


def busy_seconds():
    """CPU seconds of all processes since the machine started."""
    words = pathlib.Path("/proc/stat").read_text(encoding="utf-8").splitlines()[0].split()
    user, nice, system, _idle, _io, irq, soft, steal = (int(word) for word in words[1:9])
    return (user + nice + system + irq + soft + steal) / os.sysconf("SC_CLK_TCK")


class OtherWork:
    """Share of the machine's cores that others had while the block ran."""

    @staticmethod
    def own_seconds():
        parts = [resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
        return sum(p.ru_utime + p.ru_stime for p in parts)

    def __enter__(self):
        self.start = time.monotonic(), busy_seconds(), self.own_seconds()
        return self

    def __exit__(self, *_):
        wall, busy, own = (
            now - then for now, then in zip((time.monotonic(), busy_seconds(), self.own_seconds()), self.start)
        )
        self.seconds = wall
        self.share = max(0.0, busy - own) / (wall * os.cpu_count())
