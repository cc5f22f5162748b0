"""How cost grows with one number of a scene or of a run at a time."""

from suite import document, meshes, plot, program, rooms
from suite.table import count, megabytes, percent, seconds, table

NAME = "scaling"
TITLE = "Scaling"

DRAFT = ["--quality", "draft", "--size", "64x48"]


def sphere_room(folder, triangles):
    file, mesh = folder / f"spheres-{triangles}.yaml", folder / f"spheres-{triangles}.ply"
    if not mesh.exists():
        meshes.write_ply(meshes.spheres(triangles), mesh)
    file.write_text(rooms.furnished(f"file: {mesh.name}"), encoding="utf-8")
    return file


def written(folder, name, text):
    file = folder / f"{name}.yaml"
    file.write_text(text, encoding="utf-8")
    return file


def sweeps(context):
    """(title, name of the number, its values, (scene, command and options) of a value)"""
    folder = context.folder("scaling")
    shipped = context.scene
    more = context.thorough
    return [
        (
            "Triangles",
            "about",
            [1e3, 1e4, 1e5, 1e6, 2e6],
            lambda n: (sphere_room(folder, int(n)), ["render", *DRAFT]),
        ),
        (
            "Elements",
            "memory limit [MB]",
            [10, 20, 40, 80, 160] + ([320, 640] if more else []),
            lambda n: (
                shipped("benchmark/corridor_door"),
                ["solve", "--quality", "high" if more else "normal", "--memory-limit", n],
            ),
        ),
        (
            "Lights",
            "lamps",
            [1, 10, 100, 1000, 10000],
            lambda n: (written(folder, f"lamps-{n}", rooms.lamps(n)), ["render", *DRAFT]),
        ),
        (
            "Reflectance",
            "reflectance",
            [0.2, 0.5, 0.8, 0.9, 0.95, 0.99],
            lambda r: (written(folder, f"grey-{r}", rooms.grey(r)), ["render", *DRAFT]),
        ),
        (
            "Image size",
            "pixels across",
            [32, 64, 128, 256, 512] + ([1024] if more else []),
            lambda n: (shipped("cornell/cornell"), ["render", "--quality", "draft", "--size", f"{n}x{n}"]),
        ),
        (
            "Threads",
            "threads",
            [1, 2, 4],
            lambda n: (
                shipped("benchmark/furnished_room"),
                ["render", "--quality", "normal", "--size", "128x96", "--threads", n],
            ),
        ),
    ]


def run(context, scene, command):
    out = context.folder("pictures") / ("scaling.atrium" if command[0] == "solve" else "scaling.pfm")
    cost, stats = program.repeated(lambda: program.atrium(context.atrium, command[0], scene, "-o", out, *command[1:]))
    rays = stats["rays"]
    radiosity, error = stats["radiosity"], stats["error"]
    return cost.as_dict() | {
        "triangles": stats["scene"]["triangles"],
        "elements": radiosity.get("elements", 0),
        "iterations": radiosity.get("iterations", 0),
        "load": stats["phases"]["load"]["wall"],
        "solve_rays": rays.get("solve", {}).get("rays", 0),
        "render_rays": rays.get("render", {}).get("rays", 0),
        "radiosity_error": radiosity.get("error_estimate", 0.0),
        "pixel_error": error["estimate"] if stats.get("views") else None,
    }


def measure(context):
    data = []
    for title, number, values, make in sweeps(context):
        rows = []
        for value in values:
            scene, command = make(value)
            rows.append({"value": value} | run(context, scene, command))
            print(
                title,
                value,
                f"{rows[-1]['cpu']:.1f} s CPU, {rows[-1]['wall']:.1f} s, {rows[-1]['memory']:.0f} MB",
                flush=True,
            )
        data.append({"title": title, "number": number, "rows": rows})
    return data


def sweep_table(sweep):
    rows = [
        [
            f"{r['value']:,.12g}",
            count(r["triangles"]),
            count(r["elements"]),
            r["iterations"],
            seconds(r["cpu"]),
            seconds(r["wall"]),
            seconds(r["load"]),
            count(r["solve_rays"]),
            count(r["render_rays"]),
            megabytes(r["memory"]),
            percent(r["radiosity_error"]),
            "" if r["pixel_error"] is None else percent(r["pixel_error"]),
        ]
        for r in sweep["rows"]
    ]
    return table(
        [
            sweep["number"],
            "triangles",
            "elements",
            "iterations",
            "CPU s",
            "wall s",
            "of it loading",
            "rays of solving",
            "rays of the picture",
            "MB",
            "stated: irradiance",
            "stated: pixels",
        ],
        rows,
    )


def panel(sweep):
    counted = sweep["title"].lower()  # what came of the value that was asked for, where that is counted
    found = counted in ("elements", "triangles")
    x = [r[counted] if found else r["value"] for r in sweep["rows"]]
    return plot.Panel(
        sweep["title"],
        counted if found else sweep["number"],
        "seconds; MB",
        [
            plot.Series("CPU seconds", x, [r["cpu"] for r in sweep["rows"]]),
            plot.Series("wall seconds", x, [r["wall"] for r in sweep["rows"]]),
            plot.Series("MB", x, [r["memory"] for r in sweep["rows"]], True),
        ],
    )


def page(data, images):
    plot.write(images / "scaling.svg", [panel(sweep) for sweep in data])
    parts = [f"**{s['title']}.** {NOTES[s['title']]}\n\n{sweep_table(s)}" for s in data]
    return f"""One number at a time, whole processes from file to picture (or solution), seed 1, all threads
unless said; under 2 s the median of three. *stated*: the RMS errors that the program gives of its irradiance and
its pixels. Scenes are generated (`benchmarks/suite/rooms.py`, `meshes.py`) or lie in `scenes/`.

{chr(10).join(parts)}
{document.image("scaling.svg", "Cost against triangles, elements, lights, reflectance, image size and threads")}"""


NOTES = {
    "Triangles": "A room with 64 spheres in one PLY file, draft, 64x48 pixels. Elements keep the limit of a draft; "
    "what the largest rows cost is reading, facets and Embree's hierarchy.",
    "Elements": "corridor_door solved under a limit of memory, which is what decides about the elements.",
    "Lights": "A hall with lamps of 2 cm, always of the same flux together and none of them in the picture, draft, 64x48.",
    "Reflectance": "A closed room in which everything but the lamp reflects the same, draft, 64x48 pixels: rays hardly "
    "grow with the bounces, iterations of the solver do a little.",
    "Image size": "cornell, draft: the solve is the same for all.",
    "Threads": "furnished_room, normal, 128x96 pixels.",
}
