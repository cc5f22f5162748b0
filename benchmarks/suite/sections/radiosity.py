"""Solvers of the radiosity at equal error: drives radiosity_cost, which writes docs/radiosity-cost.md."""

import re

from suite import document, plot, program
from suite.table import percent, seconds, table

NAME = "radiosity"
TITLE = "Radiosity solvers"

GOALS = (0.1, 0.05, 0.02)
# The page docs/radiosity-cost.md: scene and about how many elements.
SCENES = {
    "furnished_room": 20000,
    "white_corridor": 20000,
    "sun_patch": 20000,
    "mirror_atrium": 20000,
    "office_floor": 60000,
}
EFFORT = "--errors 0.1 0.05 0.02 --scales 1 --paths 64 256 --receivers 300 --reference-rays 5e7".split()
OPTIONS = [*EFFORT, "--shooting", 0]
# Shooting needs a scene that it can finish.
SMALL = ["small_room@2000", *EFFORT, *"--shooting 0.2 0.05 0.01 --shooting-elements 1500".split()]
COLUMNS = (
    "method",
    "effort",
    "rays",
    "rays per side",
    "CPU s",
    "wall s",
    "peak MB",
    "RMS error",
    "95 % interval",
    "best 99 %",
    "p95 / RMS",
    "bias",
    "statistical",
    "absolute",
    "own estimate",
    "points",
    "interpolated",
)


def number(text):
    """3.2e6, 12.5 % or nothing."""
    found = re.match(r"\s*([+-]?[0-9.]+(?:e[+-]?[0-9]+)?)\s*(%?)", text)
    return None if not found else float(found.group(1)) * (0.01 if found.group(2) else 1.0)


def read_tables(text):
    """{scene: rows} of what radiosity_cost prints."""
    scenes = {}
    for part in ("\n" + text).split("\n## ")[1:]:
        rows = scenes.setdefault(part.split("\n", 1)[0].strip(), [])
        for line in part.splitlines():
            cells = [cell.strip() for cell in line.split("|")[1:-1]]
            if len(cells) != len(COLUMNS) or cells[0] == "method" or set(cells[0]) <= set("-: "):
                continue
            by = dict(zip(COLUMNS, cells))
            rows.append(
                {
                    "method": by["method"].split(",")[0],
                    "effort": by["effort"],
                    "rays": number(by["rays"]),
                    "cpu": number(by["CPU s"]),
                    "wall": number(by["wall s"]),
                    "memory": number(by["peak MB"]),
                    "rms": number(by["RMS error"]),
                    "statistical": number(by["statistical"]),
                    "stated": number(by["own estimate"]),
                    "interval": by["95 % interval"],
                }
            )
    return scenes


def cost(context, words):
    scene = [
        str(context.root / "scenes/benchmark" / f"{w.split('@')[0]}.yaml@{w.split('@')[1]}") if "@" in str(w) else w
        for w in words
    ]
    _, text = program.run([context.built("radiosity_cost"), *scene, "--cache", context.folder("references")])
    return text


def measure(context):
    scenes = [f"{name}@{elements}" for name, elements in SCENES.items()]
    data = read_tables(cost(context, [*scenes, *OPTIONS, "--docs", context.docs]))
    return data | read_tables(cost(context, SMALL))


def to_goal(rows, goal, key):
    """Cost of the cheapest row that has the error; nothing is interpolated."""
    met = [r[key] for r in rows if r["rms"] is not None and r["rms"] <= goal and r[key] is not None]
    return seconds(min(met)) if met else "-"


def by_method(rows):
    methods = {}
    for row in rows:
        methods.setdefault(row["method"], []).append(row)
    return methods


def panels(scene, rows):
    for key, title in (("cpu", "CPU seconds"), ("wall", "wall seconds")):
        series = []
        for name, some in by_method(rows).items():
            series.append(plot.Series(name, [r[key] for r in some], [100 * (r["rms"] or 0.0) for r in some]))
            if name.startswith("rows"):
                series.append(
                    plot.Series(
                        f"{name}, statistical",
                        [r[key] for r in some],
                        [100 * (r["statistical"] or 0.0) for r in some],
                        True,
                        name,
                    )
                )
        yield plot.Panel(scene, title, "RMS error of irradiance [%]", series)


def page(data, images):
    plot.write(images / "radiosity.svg", [p for scene, rows in data.items() for p in panels(scene, rows)])
    lines = []
    for scene, rows in data.items():
        for method, some in by_method(rows).items():
            best = min((r["rms"] for r in some if r["rms"] is not None), default=None)
            memory = max((r["memory"] or 0.0 for r in some), default=0.0)
            lines.append(
                [
                    scene,
                    method,
                    *(to_goal(some, g, "cpu") for g in GOALS),
                    *(to_goal(some, g, "wall") for g in GOALS),
                    "-" if best is None else percent(best),
                    f"{memory:.0f}" if memory else "",
                ]
            )
    heads = [f"{100 * g:g} %: {what} s" for what in ("CPU", "wall") for g in GOALS]
    return f"""`radiosity_cost` solves to growing effort and judges total irradiance at 300 patches of 0.2 m
against path tracing that knows nothing of elements. *rows*: a fixed effort; *rows by error*: `--error` 10, 5, 2
%; *shooting*: until 20, 5, 1 % of the flux is left (small_room only, 1,500 elements); *path tracing*: of every
element side. Seconds of the cheapest run that has the error; `-`: none has. Rays, intervals, statistical errors
and what the solver states of itself: [radiosity-cost.md](radiosity-cost.md), which the same command writes. What the
mesh resolves limits the error of rows there, whatever the rays.

{table(["scene", "method", *heads, "least error", "MB"], lines, 2)}
{document.image("radiosity.svg", "RMS error of irradiance against CPU and wall seconds, by solver")}"""
