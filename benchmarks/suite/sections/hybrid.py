"""CPU and wall seconds to an asked error: hybrid against path tracing, whole processes."""

from suite import document, plot, program
from suite.table import megabytes, percent, seconds, table

NAME = "hybrid"
TITLE = "Hybrid against path tracing at equal error"

SIZE = "96x72"
LIMIT = 60  # of one picture [s]
# scene: samples of the reference, and the errors asked for by measure
SCENES = {
    "cornell/cornell": (4096, {"pixel": [0.1, 0.05, 0.02], "block": [0.02, 0.01, 0.005]}),
    "benchmark/small_room": (2048, {"pixel": [0.1, 0.05, 0.02], "block": [0.02, 0.01]}),
    "benchmark/mirror_atrium": (1024, {"pixel": [0.1, 0.05], "block": [0.02, 0.01]}),
    "benchmark/cove_office": (1024, {"pixel": [0.1], "block": [0.05, 0.02]}),
    "benchmark/cornell_glass": (1024, {"pixel": [0.1], "block": [0.02]}),
    "benchmark/corridor_door": (1024, {"pixel": [0.1], "block": [0.02]}),
    "benchmark/daylit_atrium": (512, {"pixel": [0.2], "block": [0.05]}),
    "modern_hall.glb": (2048, {"pixel": [0.1], "block": [0.02, 0.01]}),
}
MORE = {
    "benchmark/mirror_atrium": {"pixel": [0.02], "block": []},
    "benchmark/cove_office": {"pixel": [0.05], "block": [0.01]},
    "benchmark/cornell_glass": {"pixel": [0.05], "block": [0.01]},
    "benchmark/corridor_door": {"pixel": [0.05], "block": [0.01]},
    "benchmark/daylit_atrium": {"pixel": [0.1], "block": [0.02]},
    "modern_hall.glb": {"pixel": [0.05], "block": []},
}
METHODS = ("hybrid", "path")


def name_of(scene):
    return scene.split("/")[-1].removesuffix(".glb")


def file_of(context, scene):
    """A scene of this repository, or a model that is not part of it and lies beside it, or does not."""
    return context.root.parent / "shared/scenes" / scene if scene.endswith(".glb") else context.scene(scene)


def picture(context, scene, method, kind, error, reference):
    """One asked error: what it cost, what was found, and whether it was reached."""
    image = context.folder("pictures") / "hybrid.exr"
    option = "--error" if kind == "pixel" else "--error-block"
    cost, stats = program.repeated(
        lambda: program.atrium(
            context.atrium,
            "render",
            file_of(context, scene),
            "-o",
            image,
            "--size",
            SIZE,
            "--method",
            method,
            option,
            error,
            "--time-limit",
            LIMIT,
            "--seed",
            1,
        )
    )
    found = program.compare(context.atrium, image, reference)[kind]
    return cost.as_dict() | {
        "found": found["value"],
        "low": found["low"],
        "high": found["high"],
        "noise": found["reference_noise"],
        "stated": stats["error"]["estimate" if kind == "pixel" else "estimate_block"],
        "rays": program.rays_of(stats["counters"]),
        "reached": stats["error"]["stopped_by"] == "error",
    }


def measure(context):
    data = {}
    for scene, (samples, errors) in SCENES.items():
        lines = data.setdefault(name_of(scene), [])
        if not file_of(context, scene).exists():
            print(f"{name_of(scene)}: skipped, there is no {file_of(context, scene)}", flush=True)
            continue
        reference = program.path_reference(
            context.atrium, file_of(context, scene), context.folder("references"), SIZE, samples
        )
        for kind, asked in errors.items():
            for error in asked + (MORE.get(scene, {}).get(kind, []) if context.thorough else []):
                line = {"kind": kind, "asked": error}
                for method in METHODS:
                    line[method] = picture(context, scene, method, kind, error, reference)
                print(
                    scene,
                    kind,
                    error,
                    [f"{line[m]['cpu']:.1f} s {line[m]['found']:.4f}" for m in METHODS],
                    flush=True,
                )
                lines.append(line)
    return data


def reached(p):
    """A solve that the limit of time cut short may be followed by a picture that believes in it."""
    return p["reached"] and p["wall"] < LIMIT


def ratio(hybrid, path):
    if not reached(hybrid):
        return ""
    return ("" if reached(path) else "> ") + f"{path['cpu'] / hybrid['cpu']:.1f}"


def converged(p, asked):
    """Whether the reference has so little noise, of pixels or of blocks, that it can judge the error."""
    return p["noise"] <= asked / 4


def cells(p, asked):
    found = f"{percent(p['found'])} ({percent(p['low'])} - {percent(p['high'])})"
    found = ("" if converged(p, asked) else "~ ") + found
    return [("" if reached(p) else "- ") + seconds(p["cpu"]), seconds(p["wall"]), megabytes(p["memory"]), found]


def panels(scene, lines):
    for measure_name, title in (("cpu", "CPU seconds"), ("wall", "wall seconds")):
        series = []
        for kind in ("pixel", "block"):
            for method in METHODS:
                some = [line[method] for line in lines if line["kind"] == kind]
                series.append(
                    plot.Series(
                        f"{method}, {kind}s",
                        [p[measure_name] for p in some],
                        [100 * p["found"] for p in some],
                        kind == "block",
                        f"{method}, pixels",
                    )
                )
        yield plot.Panel(scene, title, "error found [%]", series)


def page(data, images):
    rows = []
    for scene, lines in data.items():
        for line in lines:
            h, p = line["hybrid"], line["path"]
            rows.append(
                [
                    scene,
                    f"{100 * line['asked']:g} % of {line['kind']}s",
                    *cells(h, line["asked"]),
                    *cells(p, line["asked"]),
                    ratio(h, p),
                ]
            )
    plot.write(images / "hybrid.svg", [p for scene, lines in data.items() if lines for p in panels(scene, lines)])
    samples = {name_of(scene): samples for scene, (samples, _) in SCENES.items()}
    references = ", ".join(f"{scene} {samples[scene]}" for scene, lines in data.items() if lines)
    skipped = "".join(f"- {scene}: skipped, a model that was not there\n" for scene, lines in data.items() if not lines)
    costs = ["CPU s", "wall s", "MB", "found"]
    head = ["scene", "asked", *(f"hybrid: {c}" for c in costs), *(f"path: {c}" for c in costs), "CPU path / hybrid"]
    return f"""Both methods are asked for an error (`--error` of pixels, `--error-block` of 8x8 blocks), so the path
tracer samples adaptively, too; {SIZE} pixels, seed 1, start and solve included. *found*: against a path traced reference
({references} samples of a pixel, seed {program.REFERENCE_SEED}), its noise subtracted, with the 95 % interval, which is wide
where the reference is noisy; `~`: this noise, of pixels or of blocks, is more than a quarter of the error asked.
`-`: the limit of {LIMIT} s of wall time came first. Under 2 s: median of three runs.
{skipped and chr(10) + skipped}
{table(head, rows, 2)}
{document.image("hybrid.svg", "Error found against CPU and wall seconds, hybrid and path tracing")}
So small a picture is the hard case for the hybrid: its solve does not get cheaper with fewer pixels, and few pixels
can share light. Blocks average the path tracer's noise, but not the error of the radiosity.
"""
