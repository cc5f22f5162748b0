#!/usr/bin/env python3
"""CPU seconds to an asked error: hybrid against path tracing, whole processes.

  benchmarks/equal_error.py SCENE... --references FOLDER [--size 96x72] [--errors 0.1,0.05,0.02]
                            [--blocks 0.05,0.02,0.01] [--limit 120] [--atrium PROGRAM] [--out FILE]

Each picture is asked for with --error (or --error-block) and judged against a path traced reference
of the same view (made if it is missing). `-`: the time limit came first; behind it what was reached.
"""
import argparse
import json
import os
import pathlib
import resource
import subprocess
import tempfile


def cpu_of_children():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command):
    before = cpu_of_children()
    subprocess.run(command, check=True, stderr=subprocess.DEVNULL)
    return cpu_of_children() - before


def reference_of(options, scene):
    path = pathlib.Path(options.references) / (
        f"{pathlib.Path(scene).stem}-path-{options.size}-{options.reference_samples}.exr")
    if not path.exists():
        run([options.atrium, "render", scene, "-o", str(path), "--size", options.size, "--method",
             "path", "--samples", str(options.reference_samples), "--seed", "24301", "--quiet"])
    return str(path)


def measure(options, scene, method, kind, error, reference):
    """(CPU seconds, found error, stopped by) of one picture."""
    with tempfile.TemporaryDirectory() as folder:
        image, stats = os.path.join(folder, "a.exr"), os.path.join(folder, "s.json")
        cpu = run([options.atrium, "render", scene, "-o", image, "--size", options.size, "--method",
                   method, "--error" if kind == "pixel" else "--error-block", str(error),
                   "--time-limit", str(options.limit), "--stats", stats, "--quiet"])
        with open(stats, encoding="utf-8") as file:
            stopped_by = json.load(file)["error"]["stopped_by"]
        compared = subprocess.run([options.atrium, "compare", image, reference, "--json"],
                                  check=True, capture_output=True, text=True)
        return cpu, json.loads(compared.stdout)[kind]["value"], stopped_by


def cell(cpu, found, stopped_by):
    text = f"{cpu:.1f} s ({100 * found:.2g} %)"
    return text if stopped_by == "error" else "- " + text


def numbers(text):
    return [float(word) for word in text.split(",") if word]


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--references", default=".")
    parser.add_argument("--reference-samples", type=int, default=4096)
    parser.add_argument("--size", default="96x72")
    parser.add_argument("--errors", type=numbers, default=[0.1, 0.05, 0.02])
    parser.add_argument("--blocks", type=numbers, default=[0.05, 0.02, 0.01])
    parser.add_argument("--limit", type=float, default=120, help="of one picture [s]")
    parser.add_argument("--atrium", default="build/release/bin/atrium")
    parser.add_argument("--out", default="")
    options = parser.parse_args()

    lines = ["| scene | asked | hybrid: CPU (found) | path: CPU (found) | path / hybrid |",
             "| --- | --- | ---: | ---: | ---: |"]
    for scene in options.scenes:
        reference = reference_of(options, scene)
        asked = [("pixel", e) for e in options.errors] + [("block", e) for e in options.blocks]
        for kind, error in asked:
            hybrid = measure(options, scene, "hybrid", kind, error, reference)
            path = measure(options, scene, "path", kind, error, reference)
            more = "> " if path[2] != "error" else ""
            lines.append(f"| {pathlib.Path(scene).stem} | {100 * error:g} % per {kind} | "
                         f"{cell(*hybrid)} | {cell(*path)} | {more}{path[0] / hybrid[0]:.1f} |")
            print(lines[-1], flush=True)
    text = "\n".join(lines) + "\n"
    if options.out:
        pathlib.Path(options.out).write_text(text, encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
