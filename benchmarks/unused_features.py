#!/usr/bin/env python3
"""What a feature costs a scene that does not use it: instructions (callgrind) and memory (largest
resident size, median of ten runs) with the feature enabled against the same run without it, on one thread.

    cmake --preset release && cmake --build build/release --target atrium
    benchmarks/unused_features.py build/release/bin/atrium > table.md

With the program of a build that leaves something out, a row of what its presence costs (ATRIUM_WITH_OPENMESH
is none: it mends meshes, which every scene uses):

    cmake --preset release -B build/without -DATRIUM_WITH_OPENSUBDIV=OFF -DATRIUM_BUILD_TESTS=OFF
    cmake --build build/without --target atrium
    benchmarks/unused_features.py build/release/bin/atrium --without build/without/bin/atrium

What no option turns off is counted by its functions' share of the instructions of one run, what they call
included.

Also start-up: processor time of the process before a scene is read, over 50 runs. Instructions do
not depend on what else runs on the machine.
"""
import argparse
import base64
import functools
import pathlib
import re
import resource
import statistics
import subprocess
import sys
import tempfile

ROOM = """atrium: 1
unit: nit
{head}materials:
  wall: {{body: 0.7}}
  lamp: {{body: 0.5, emission: 100}}
{materials}objects:
  - {{name: room, material: wall, {group}box: {{min: [0, 0, 0], max: [3, 2.5, 4], inside: true}}}}
  - {{name: block, material: wall, box: {{min: [1, 0, 1], max: [2, 1, 2]}}}}
  - {{name: lamp, material: lamp, {group}polygon: [[1, 2.4, 1], [2, 2.4, 1], [2, 2.4, 2], [1, 2.4, 2]]}}
cameras:
  - {{name: inside, perspective: {{eye: [1.5, 1.2, 3.8], target: [1.5, 1, 0], yfov: 60}}}}
{cameras}"""

UNUSED_MATERIALS = """  glass: {medium: solid, ior: 1.5}
  window: {medium: pane, ior: 1.5}
  gold: {ior: {n: 0.2, k: 3}, c: 10}
  sheet: {k_tp_df: 1, body: 0.4, body_transmission: 0.3}
"""
UNUSED_IMAGE = "  painted: {body_texture: grey.png}\n"
UNUSED_CAMERAS = "".join(
    f"  - {{name: c{i}, panorama: {{eye: [1, 1, {1 + 0.1 * i}], target: [0, 1, 0]}}}}\n" for i in range(8))

PIXEL = base64.b64decode("iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCBd81ytgAAAABJRU5ErkJggg==")

DIRECT = "render room.yaml -o room.pfm --method direct --size 32x24 --samples 4 --threads 1 --quiet"
HYBRID = "render room.yaml -o room.pfm --error 0.5 --size 32x24 --threads 1 --quiet"
PATH = "render room.yaml -o room.pfm --method path --size 32x24 --samples 8 --threads 1 --quiet"

# name, command, scene and options with the feature enabled but unused, scene and options without
FEATURES = [
    ("pane detection, no glass", DIRECT, {}, "", {}, "--no-pane-detection"),
    ("choice of spectral lanes, grey scene", DIRECT, {}, "", {}, "--spectrum grey"),
    ("materials of glass, panes, metal, sheets that no object has", DIRECT,
     {"materials": UNUSED_MATERIALS}, "", {}, ""),
    ("an image that no object has", DIRECT, {"materials": UNUSED_IMAGE}, "", {}, ""),
    ("eight more cameras", DIRECT, {"cameras": UNUSED_CAMERAS}, "", {}, ""),
    ("openings to the sky, no sky", DIRECT, {}, "", {"head": "portals: {find: false}\n"}, ""),
    ("air that absorbs, by nothing", DIRECT, {"head": "medium: {extinction: 0}\n"}, "", {}, ""),
    ("limit of time that is not reached", DIRECT, {}, "--time-limit 100000", {}, ""),
    ("one light group", DIRECT, {"group": "light_group: day, "}, "", {}, ""),
    ("statistics of the run", DIRECT, {}, "--stats stats.json", {}, ""),
    ("hybrid: pane detection, no glass", HYBRID, {}, "", {}, "--no-pane-detection"),
    ("hybrid: choice of spectral lanes, grey scene", HYBRID, {}, "", {}, "--spectrum grey"),
    ("hybrid: materials of mirrors, glass, lobes, sheets that no object has", HYBRID,
     {"materials": UNUSED_MATERIALS}, "", {}, ""),
    ("hybrid: openings to the sky, no sky", HYBRID, {}, "", {"head": "portals: {find: false}\n"}, ""),
    ("hybrid: air that absorbs, by nothing", HYBRID, {"head": "medium: {extinction: 0}\n"}, "", {}, ""),
    ("hybrid: one light group", HYBRID, {"group": "light_group: day, "}, "", {}, ""),
    ("hybrid: eight more cameras", HYBRID, {"cameras": UNUSED_CAMERAS}, "", {}, ""),
    ("hybrid: limits of time and memory that are not reached", HYBRID, {},
     "--time-limit 100000 --memory-limit 20000", {}, ""),
    ("path: choice of paths from both ends, no caustics", PATH, {"materials": UNUSED_MATERIALS}, "", {}, ""),
    ("path: a checkpoint that is not taken up", PATH, {}, "--checkpoint kept", {}, ""),
]

# What no option turns off: name, function, command.
STAGES = [
    ("photons for the flux balance, nothing specular", "trace_photons", HYBRID),
    ("choice of hot patches", "choose_hot", HYBRID),
    ("importance of a view that sees every wall", "view_importance", HYBRID),
    ("search for lamps smaller than a pixel, none", "SmallLamps::SmallLamps", DIRECT),
]


def instructions(command, folder):
    run = subprocess.run(["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out"]
                         + command, capture_output=True, text=True, check=True, cwd=folder)
    return int(re.search(r"Collected : (\d+)", run.stderr).group(1))


def resident_mb(command, folder):
    """Median of ten runs: with random addresses some runs have half a megabyte less."""
    code = ("import resource, subprocess, sys; subprocess.run(sys.argv[1:], check=True); "
            "print(resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss)")
    sizes = [int(subprocess.run([sys.executable, "-c", code] + command, capture_output=True, text=True,
                                check=True, cwd=folder).stdout) for _ in range(10)]
    return statistics.median(sizes) / 1024


@functools.cache
def measure(atrium, folder, template, room, options):
    (pathlib.Path(folder) / "room.yaml").write_text(room)
    command = [atrium] + template.split() + options.split()
    return instructions(command, folder), resident_mb(command, folder)


@functools.cache
def inclusive(atrium, folder, template):
    """Of a run of the plain room: all instructions, and a list of (those of a function and what it calls, its name)."""
    (pathlib.Path(folder) / "room.yaml").write_text(room({}))
    whole = instructions([atrium] + template.split(), folder)
    listing = subprocess.run(["callgrind_annotate", "--inclusive=yes", "--threshold=100", f"{folder}/callgrind.out"],
                             capture_output=True, text=True, check=True).stdout
    return whole, [(int(count.replace(",", "")), name)
                   for count, name in re.findall(r"^ *([\d,]+) \([^)]*\)(.*)$", listing, re.M)]


def share_of(atrium, folder, template, function):
    """Share of a function and what it calls; of the outermost where it calls others of that name."""
    whole, functions = inclusive(atrium, folder, template)
    return max((count for count, name in functions if function in name), default=0) / whole


def room(parts):
    return ROOM.format(**({"head": "", "materials": "", "group": "", "cameras": ""} | parts))


def cpu_ms(command):
    times = []
    for _ in range(50):
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        subprocess.run(command, capture_output=True, check=True)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        times.append(1e3 * (after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime))
    return statistics.median(times)


def start_up(atrium, folder):
    scene = pathlib.Path(folder) / "triangle.yaml"
    scene.write_text("atrium: 1\nmaterials: {m: {body: 0.5}}\n"
                     "objects: [{name: t, material: m, polygon: [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}]\n")
    print("| process | processor time, median of 50 [ms] | instructions [million] |\n| --- | --- | --- |")
    for name, command in [("`atrium --version`", [atrium, "--version"]),
                          ("`atrium info` of one triangle", [atrium, "info", str(scene)])]:
        print(f"| {name} | {cpu_ms(command):.1f} | {instructions(command, folder) / 1e6:.1f} |")


def left_out(atrium, other):
    """Options of CMake that are on in the build of one program and off in that of the other."""
    on, off = (set(re.findall(rf"^ATRIUM_WITH_(\w+):BOOL={value}$",
                              (pathlib.Path(program).parents[1] / "CMakeCache.txt").read_text(), re.M))
               for program, value in ((atrium, "ON"), (other, "OFF")))
    return ", ".join(sorted(on & off))


def row(name, with_it, without):
    """Prints it; whether instructions or memory differ by 2 % or more."""
    difference = [100 * (a / b - 1) for a, b in zip(with_it, without)]
    print(f"| {name} | {with_it[0] / 1e6:.1f} | {without[0] / 1e6:.1f} | {difference[0]:+.2f} % | "
          f"{with_it[1]:.1f} | {without[1]:.1f} | {difference[1]:+.2f} % |", flush=True)
    return max(difference) >= 2.0


def resolved(path):
    return str(pathlib.Path(path).resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("atrium", type=resolved)
    parser.add_argument("--without", type=resolved, default=[], action="append", metavar="PROGRAM",
                        help="of a build with fewer features (repeatable)")
    parser.add_argument("--only", default="", metavar="TEXT", help="features with TEXT in their name")
    arguments = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        (pathlib.Path(folder) / "grey.png").write_bytes(PIXEL)
        start_up(arguments.atrium, folder)
        print("\n| feature, enabled and not used | instructions with [million] | without | difference | "
              "memory with [MB] | without | difference |\n| --- | --- | --- | --- | --- | --- | --- |")
        for name, template, scene, options, plain, off in FEATURES:
            if arguments.only not in name:
                continue
            failed |= row(name, measure(arguments.atrium, folder, template, room(scene), options),
                          measure(arguments.atrium, folder, template, room(plain), off))
        for other in arguments.without:
            for method, template in (("direct", DIRECT), ("hybrid", HYBRID), ("path", PATH)):
                failed |= row(f"{method}: {left_out(arguments.atrium, other)} in the build",
                              *(measure(p, folder, template, room({}), "") for p in (arguments.atrium, other)))
        print("\n| without an option | share of instructions |\n| --- | --- |")
        for name, function, template in STAGES:
            if arguments.only in name:
                print(f"| {name} | {100 * share_of(arguments.atrium, folder, template, function):.2f} % |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
