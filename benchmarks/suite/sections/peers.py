"""Other programs on the same scenes: cost at equal error, and whether converged pictures are the same."""

import statistics

from suite import document, peer_scenes, peers, plot, program
from suite.peer_scenes import GLASS, METAL
from suite.table import megabytes, percent, seconds, table

NAME = "peers"
TITLE = "Other programs"

REFERENCE_SAMPLES, REFERENCE_SEED = 4096, 97
CONVERGED_SEEDS = (11, 12, 13)
CONVERGED_SAMPLES = 1024
LIMIT = 90  # a budget is left out if the one before took longer [s]


def render(peer, scene, folder, budget, seed):
    file = folder / f"{scene.name}{peer.ending}"
    file.write_text(peer.write(scene, peers.SIZE), encoding="utf-8")
    out = folder / "picture.exr"
    for old in (out, out.with_suffix(".hdr")):
        old.unlink(missing_ok=True)
    cost = peer.render(file, scene, budget, seed, out)
    return cost, out if out.exists() else out.with_suffix(".hdr")


def reference_of(context, scene, folder):
    file = context.folder("references") / f"peers-{scene.name}-{REFERENCE_SAMPLES}.exr"
    if not file.exists():
        path = peers.Atrium(context, "path")
        _, out = render(path, scene, folder, REFERENCE_SAMPLES, REFERENCE_SEED)
        out.replace(file)
    return file


def series(context, peer, scene, folder, reference):
    rows = []
    for budget in peer.budgets:
        cost, out = program.repeated(lambda: render(peer, scene, folder, budget, 1))
        found = program.compare(context.atrium, out, reference)
        rows.append(
            cost.as_dict()
            | {
                "budget": budget,
                "pixel": found["pixel"]["value"],
                "block": found["block"]["value"],
                "bias": found["bias"],
            }
        )
        print(scene.name, peer.name, budget, f"{cost.cpu:.1f} s {rows[-1]['pixel']:.4f}", flush=True)
        if cost.wall > LIMIT:
            break
    return rows


def converged(context, peer, scene, folder, reference):
    """Mean difference of the luminance from the reference's over seeds, with standard errors of both."""
    biases, own = [], 0.0
    for seed in CONVERGED_SEEDS:
        _, out = render(peer, scene, folder, CONVERGED_SAMPLES, seed)
        found = program.compare(context.atrium, out, reference)
        biases.append(found["bias"])
        own = found["bias_standard_error"]
    return {
        "bias": statistics.mean(biases),
        "error": statistics.stdev(biases) / len(biases) ** 0.5,
        "reference_error": own,
        "pixel": found["pixel"]["value"],
        "block": found["block"]["value"],
    }


def measure(context):
    folder = context.folder("peers")
    data = {"programs": [], "scenes": {name: {} for name in peer_scenes.SCENES}, "converged": {}}
    for peer in peers.all_programs(context):
        missing = peer.missing()
        data["programs"].append(
            {"name": peer.name, "missing": missing, "unit": peer.unit, "version": "" if missing else peer.version()}
        )
        if missing:
            print(f"{peer.name}: skipped, {missing}", flush=True)
            continue
        for name, make in peer_scenes.SCENES.items():
            scene = make()
            if not scene.surfaces() <= peer.knows:
                print(f"{peer.name}: {name} skipped, not all of its materials are known", flush=True)
                continue
            reference = reference_of(context, scene, folder)
            data["scenes"][name][peer.name] = series(context, peer, scene, folder, reference)
            if peer.name.startswith("Mitsuba") and not data["converged"].get(name):
                data["converged"][name] = converged(context, peer, scene, folder, reference) | {"name": peer.name}
    return data


def converged_text(data):
    if not data["converged"]:
        return ""
    rows = []
    for name, c in data["converged"].items():
        both = (c["error"] ** 2 + c["reference_error"] ** 2) ** 0.5
        rows.append(
            [
                name,
                f"{c['name']}, {CONVERGED_SAMPLES} samples",
                f"{100 * c['bias']:+.3f} %",
                f"{100 * both:.3f} %",
                f"{abs(c['bias']) / both:.1f}",
            ]
        )
    return f"""Two programs that share no code, on what converged pictures show: mean luminance of
{len(CONVERGED_SEEDS)} pictures (seeds {', '.join(str(s) for s in CONVERGED_SEEDS)}) against the reference
(Atrium's path tracer, {REFERENCE_SAMPLES} samples of a pixel, seed {REFERENCE_SEED}), and the standard error of
that difference, both sides' noise included.

{table(["scene", "second method", "difference", "standard error", "in standard errors"], rows, 2)}
"""


def panels(scene, by_program):
    for key, title in (("cpu", "CPU seconds"), ("wall", "wall seconds")):
        for kind in ("pixel", "block"):
            yield plot.Panel(
                f"{scene}, {kind}s",
                title,
                "relative RMS error [%]",
                [
                    plot.Series(name, [r[key] for r in rows], [100 * r[kind] for r in rows])
                    for name, rows in by_program.items()
                ],
            )


def page(data, images):
    units = {p["name"]: p["unit"] for p in data["programs"]}
    rows = [
        [
            scene,
            name,
            f"{units[name]} {r['budget']}",
            seconds(r["cpu"]),
            seconds(r["wall"]),
            megabytes(r["memory"]),
            percent(r["pixel"]),
            percent(r["block"]),
            f"{100 * r['bias']:+.2f} %",
        ]
        for scene, by_program in data["scenes"].items()
        for name, runs in by_program.items()
        for r in runs
    ]
    plot.write(images / "peers.svg", [p for scene, runs in data["scenes"].items() for p in panels(scene, runs)])
    there = "; ".join(f"{p['name']} ({p['version']})" for p in data["programs"] if not p["missing"])
    lacking = "".join(f"- {p['name']}: skipped, {p['missing']}\n" for p in data["programs"] if p["missing"])
    head = ["scene", "program", "budget", "CPU s", "wall s", "MB", "RMS of pixels", "of 8x8 blocks", "bias"]
    return f"""One description (`benchmarks/suite/peer_scenes.py`) of four scenes, written in each program's own
format: *box*, a Cornell box of simple colours, *cove*, a room whose lamps shine at the ceiling only, *gloss*, the box
with both blocks of rough metal (GGX, alpha {METAL.alpha:g}, n {METAL.n:g}, k {METAL.k:g}), and *glass*, the box with
the tall block of clear glass (n {GLASS.ior:g}), whose caustics light the floor. A program runs what it can express:
POV-Ray has no such lobe, and its glass shows what lies behind it as that of the others does. Mitsuba takes masking
and shadowing of a facet as independent, Atrium's lobe as correlated by height: for alpha {METAL.alpha:g} that takes
0.01 % of the light that the metal reflects at 60°, 0.13 % at 75°, less at smaller angles.
{peers.SIZE[0]}x{peers.SIZE[1]} pixels, whole processes with all threads, errors in linear radiance. Seed 1; under 2 s
median of three. Here: {there}.
{lacking and chr(10) + lacking}
```sh
apt-get install povray libllvm19 && python3 -m venv --system-site-packages build/python
build/python/bin/pip install mitsuba pyradiance   # pyradiance has Radiance's programs; those on the PATH go before
build/python/bin/python benchmarks/run.py --only peers
```

{converged_text(data)}{table(head, rows, 3)}
{document.image("peers.svg", "Error against CPU and wall seconds by program")}
Mitsuba's samples are independent ones, its start (Python, and compiling for `llvm_ad_rgb`) counts as part of the
process; POV-Ray finds lamps by its radiosity only, as none of its light sources shines by the cosine. Radiance runs
one thread, and its pictures keep 8 bits and a common exponent of a pixel's channels; its rpict alone finds no
caustics, and its metals have another lobe. Atrium's hybrid shares light between pixels, the others do not, but
Radiance and POV-Ray keep indirect light between pixels.
"""
