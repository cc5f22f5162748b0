"""Hot paths, one thread: Google Benchmark's JSON of hot_paths and material_benchmark."""

import json

from suite import program
from suite.table import table

NAME = "micro"
TITLE = "Hot paths"

NANOSECONDS = {"ns": 1.0, "us": 1e3, "ms": 1e6, "s": 1e9}
MATERIALS = "^model/(Lambert|metal, smooth|metal, rough|plastic, rough, coupled|glass, smooth|glass, rough)/.*/3$"


def fastest(context, name, *options):
    """{name: its fastest repetition}: whatever else the machine does only adds."""
    _, text = program.run(
        [
            context.built(name),
            "--benchmark_format=json",
            f"--benchmark_repetitions={9 if context.thorough else 5}",
            "--benchmark_enable_random_interleaving=true",
            *options,
        ]
    )
    best = {}
    for run in json.loads(text)["benchmarks"]:
        if run.get("run_type") == "aggregate":
            continue
        found = {"ns": run["cpu_time"] * NANOSECONDS[run["time_unit"]]}
        found |= {key: run[key] for key in ("items_per_second", "entries", "sides") if key in run}
        if run["run_name"] not in best or found["ns"] < best[run["run_name"]]["ns"]:
            best[run["run_name"]] = found
    return best


def measure(context):
    return {
        "paths": fastest(context, "hot_paths", "--benchmark_min_time=0.2"),
        "materials": fastest(
            context, "material_benchmark", "--benchmark_min_time=0.02", f"--benchmark_filter={MATERIALS}"
        ),
    }


def rates(paths):
    """{(scene, kind): {what: million rays per second}}"""
    found = {}
    for name, run in sorted(paths.items()):
        first, *rest = name.split("/")
        if first == "rays":
            found.setdefault(rest[0], {})[rest[1]] = run["items_per_second"] / 1e6
    return found


def share(part, whole):
    return f"{part:.2f} ({100 * part / whole:.0f} %)"


def ray_tables(paths):
    closest, shadow = [], []
    for kind, rate in rates(paths).items():
        if "bare rtcOccluded1" in rate:
            bare = rate["bare rtcOccluded1"]
            shadow.append(
                [kind, f"{bare:.2f}", share(rate["RayQuery"], bare), share(rate["Shading, through panes"], bare)]
            )
            continue
        one, many = rate["bare rtcIntersect1"], rate["bare rtcIntersect1M"]
        closest.append(
            [
                kind,
                f"{one:.2f}",
                f"{many:.2f}",
                f"{rate['bare rtcIntersect8']:.2f}",
                share(rate["RayQuery, one by one"], one),
                share(rate["RayQuery, many at once"], many),
                share(rate["Shading, surface points"], one),
            ]
        )
    return (
        table(
            [
                "closest hit",
                "bare, one",
                "bare, 1M",
                "bare, 8",
                "RayQuery, one by one (of bare one)",
                "many at once (of bare 1M)",
                "with surface point (of bare one)",
            ],
            closest,
        ),
        table(
            ["shadow rays", "bare, opaque only", "RayQuery, opaque only", "transmittance through panes and masks"],
            shadow,
        ),
    )


def nanoseconds(run):
    return f"{run['ns']:.3g}" if run["ns"] < 1000 else f"{run['ns']:,.0f}"


def look_up_table(paths):
    fields = sorted(name for name in paths if name.startswith("field/"))
    rows = [[name.removeprefix("field/"), nanoseconds(paths[name])] for name in fields]
    rows += [
        [f"{what} of one of {count} lamps", nanoseconds(paths[f"lights/{key}/{count}"])]
        for key, what in (("sample", "choice and point"), ("density", "density of a hit"))
        for count in (1, 100, 10000)
    ]
    return table(["look-up", "ns"], rows)


def material_table(materials):
    models = {}
    for name, run in sorted(materials.items()):
        _, model, what, _ = name.split("/")
        models.setdefault(model, {})[what] = nanoseconds(run)
    return table(
        ["material, 3 lanes", "evaluate [ns]", "sample [ns]", "density [ns]"],
        [[m, t.get("eval", ""), t.get("sample", ""), t.get("pdf", "")] for m, t in models.items()],
    )


def page(data, _images):
    paths = data["paths"]
    closest, shadow = ray_tables(paths)
    trace, solve = paths["rows/trace"], paths["rows/solve"]
    return f"""One thread, CPU time, fastest repetition, all in one run (`hot_paths`, `material_benchmark`;
Google Benchmark). Million rays per second; *bare* is Embree alone with the same geometry, instances, masks, flags
(robust) and rays, filling its structures from ours included, so the share in brackets is what the checks,
counters and hits of `RayQuery` leave of the ceiling. building: 16 furnished rooms; daylit_atrium: 232,460
triangles with instances and panes. Rays to lamps pass panes only in the last column, which also asks more than
one ray then.

{closest}
{shadow}
{look_up_table(paths)}
{material_table(data["materials"])}
All models, with the lanes that a scene may need: [material-speed.md](material-speed.md).

Rows of the building ({solve["sides"]:,.0f} sides, 64 rays each): traced at
{trace["items_per_second"] / 1e6:.2f} million rays per second, {solve["entries"] / 1e6:.2f} million entries;
solved in {solve["ns"] / 1e6:.1f} ms for one source, {solve["items_per_second"] / 1e6:.0f} million entries per
second. `row_rays` compares these rays with Embree and says how the chunks would fill more threads. """
