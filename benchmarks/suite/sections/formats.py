"""The whole process from file to picture, for the same scene in four formats."""

from suite import meshes, program, rooms
from suite.table import count, megabytes, seconds, table

NAME = "formats"
TITLE = "From file to picture"

PHASES = ("load", "mesh", "direct", "radiosity", "render", "write")
LARGEST_YAML = 100000  # triangles; scene files have at most 16 MiB


def scene_of(folder, kind, triangles):
    """(scene file, bytes of what holds the mesh)"""
    mesh = meshes.spheres(triangles)
    name = f"things-{triangles}"
    if kind == "YAML":
        text = f"mesh: {meshes.yaml_mesh(mesh)}"
    else:
        ending, write = {
            "OBJ": ("obj", meshes.write_obj),
            "GLB": ("glb", meshes.write_glb),
            "PLY": ("ply", meshes.write_ply),
        }[kind]
        write(mesh, folder / f"{name}.{ending}")
        text = f"file: {name}.{ending}"
    file = folder / f"{name}-{kind.lower()}.yaml"
    file.write_text(rooms.furnished(text), encoding="utf-8")
    held = file if kind == "YAML" else folder / text.removeprefix("file: ")
    return file, held.stat().st_size


def measure(context):
    folder, rows = context.folder("formats"), []
    for triangles in (10000, 100000, 1000000):
        for kind in ("YAML", "OBJ", "GLB", "PLY"):
            if kind == "YAML" and triangles > LARGEST_YAML:
                continue
            scene, size = scene_of(folder, kind, triangles)
            cost, stats = program.repeated(
                lambda scene=scene: program.atrium(
                    context.atrium,
                    "render",
                    scene,
                    "-o",
                    folder / "picture.exr",
                    "--quality",
                    "draft",
                    "--size",
                    "128x96",
                )
            )
            rows.append(
                cost.as_dict()
                | {
                    "kind": kind,
                    "triangles": stats["scene"]["triangles"],
                    "bytes": size,
                    "phases": {p: stats["phases"].get(p, {"wall": 0.0, "cpu": 0.0}) for p in PHASES},
                    "rays": sum(part["rays"] for part in stats["rays"].values()),
                    "elements": stats["radiosity"]["elements"],
                    "error": stats["error"]["estimate"],
                }
            )
            print(kind, triangles, f"{cost.cpu:.1f} s CPU, {cost.wall:.1f} s wall", flush=True)
    return rows


def page(data, _images):
    rows = [
        [
            r["kind"],
            count(r["triangles"]),
            count(r["elements"]),
            f"{r['bytes'] / 1e6:.1f}",
            *(f"{r['phases'][p]['cpu']:.2f}" for p in PHASES),
            seconds(r["cpu"]),
            seconds(r["wall"]),
            megabytes(r["memory"]),
            count(r["rays"]),
            f"{100 * r['error']:.1f} %",
        ]
        for r in data
    ]
    return f"""A room with 64 spheres, which are an inline mesh of the scene file, or in a file that it names:
reading, repair and tessellation are *load*, together with building Embree's hierarchy; *mesh*, *direct* and
*radiosity* are the solve. CPU seconds of two cores by phase, whole processes to a layered EXR of 128x96 pixels,
`--quality draft`, seed 1, median of three under 2 s. The rest of the process's CPU seconds is its start and end,
and the image module, which loads meanwhile. *stated*: RMS error of pixels.

{table(["format", "triangles", "elements", "MB of file", *PHASES, "CPU s", "wall s", "MB", "rays", "stated"], rows)}"""
