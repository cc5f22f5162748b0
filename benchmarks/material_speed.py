#!/usr/bin/env python3
"""Turns the JSON of material_benchmark into the tables of docs/material-speed.md.

    cmake --preset release -DATRIUM_BUILD_BENCHMARKS=ON
    cmake --build build/release --target material_benchmark
    build/release/bin/material_benchmark --benchmark_format=json \\
        --benchmark_repetitions=7 --benchmark_min_time=0.02 > speed.json
    benchmarks/material_speed.py speed.json [more.json ...] --out docs/material-speed.md

Of all repetitions in all files the fastest counts: whatever else runs on the machine only adds.
"""
import argparse
import json
import pathlib
import sys

UNITS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
LANES = ["1", "3", "8"]


def read(paths):
    """{name: (fastest CPU time [ns], max_error or None)} in the order of the first file, and the
    machine."""
    best, context = {}, {}
    for path in paths:
        data = json.loads(pathlib.Path(path).read_text())
        context = data["context"]
        for run in data["benchmarks"]:
            if run.get("run_type") == "aggregate":
                continue
            name = run["run_name"]
            time = run["cpu_time"] * UNITS[run["time_unit"]]
            known = best.get(name)
            if known is None or time < known[0]:
                best[name] = (time, run.get("max_error"))
    return best, context


def grid(rows, header):
    lines = ["| " + " | ".join(header) + " |", "| " + " | ".join(["---"] * len(header)) + " |"]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows]) + "\n"


def error(value):
    return "" if value is None else f"{value:.1e}"


def groups(best, kind):
    """[(middle names, {lanes: (time, error)})] of the benchmarks kind/.../lanes, in order."""
    found = {}
    for name, result in best.items():
        first, *middle, lanes = name.split("/")
        if first == kind:
            found.setdefault(tuple(middle), {})[lanes] = result
    return list(found.items())


def times(by_lanes, scale=1.0):
    return [f"{by_lanes[n][0] / scale:.1f}" if n in by_lanes else "" for n in LANES]


def fresnel_tables(best):
    """Times hardly depend on the material: one column per lane count (the fastest material), and
    the error of every material (eight lanes) beside them."""
    forms, materials = {}, []
    for (material, form), by_lanes in groups(best, "fresnel"):
        if material not in materials:
            materials.append(material)
        entry = forms.setdefault(form, {"times": {}, "errors": {}})
        for lanes, (time, err) in by_lanes.items():
            old = entry["times"].get(lanes, (float("inf"), None))
            entry["times"][lanes] = min(old, (time, None), key=lambda pair: pair[0])
            if lanes == "8":
                entry["errors"][material] = err
    rows = [
        [form, *times(e["times"]), *[error(e["errors"].get(m)) for m in materials]]
        for form, e in forms.items()
    ]
    header = ["form", *[f"ns, N = {n}" for n in LANES], *[f"error {m}" for m in materials]]
    return grid(rows, header)


def construct_table(best):
    chosen = {}
    for (material, label), by_lanes in groups(best, "construct"):
        bound, form = label.split(" = ")
        for lanes, (time, err) in by_lanes.items():
            key = (material, f"{float(bound.split()[1]):g}")
            chosen.setdefault(key, {})[lanes] = f"{form}, {error(err)}, {time / 1e3:.1f}"
    rows = [[*key, *[cell.get(n, "") for n in LANES]] for key, cell in chosen.items()]
    return grid(rows, ["material", "bound", *[f"N = {n}: form, error, us" for n in LANES]])


def model_table(best):
    models = {}
    for (model, what), by_lanes in groups(best, "model"):
        models.setdefault(model, {})[what] = times(by_lanes)
    whats = ["eval", "sample", "pdf"]
    rows = [[m, *[" / ".join(by.get(w, [""])) for w in whats]] for m, by in models.items()]
    return grid(rows, ["model", *[f"{w}, N = {' / '.join(LANES)}" for w in whats]])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("json", nargs="+", help="output of material_benchmark")
    parser.add_argument("--out", type=pathlib.Path, help="Markdown file (default: standard output)")
    options = parser.parse_args()
    best, context = read(options.json)
    if not best:
        sys.exit("no benchmarks in " + ", ".join(options.json))
    text = f"""# Speed of materials

ns per call (CPU time), one thread, release build for any x86-64 (SSE2); {context['num_cpus']} CPUs at
{context['mhz_per_cpu']} MHz, {context['date'][:10]}. The machine was busy with other work: each number is the
fastest of all repetitions, so read them as lower ends, good to some 10 %. N is the number of lanes (1 grey, 3
RGB, 8 bands). Inputs are random, from a table; calls do not wait for each other. Made by
`benchmarks/material_speed.py`, see there for the command.

## Fresnel forms

`FresnelTerm<N>`, coefficients made once per material; last row: from n and k, lane by lane. Errors: largest absolute
one of F over all angles, eight lanes over 430-670 nm.

{fresnel_tables(best)}
## What a bound on the error picks

Form, its largest error, and the time to measure forms until one fits (once per side of a material).

{construct_table(best)}
## Models

Directions as the model scatters them.

{model_table(best)}"""
    if options.out:
        options.out.write_text(text)
    else:
        print(text)


if __name__ == "__main__":
    main()
