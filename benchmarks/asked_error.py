#!/usr/bin/env python3
"""Whether pictures have the error that was asked for, over many seeds.

Renders every scene with --error or --error-block as whole processes, each seed with a radiosity of
its own, compares with a path traced reference, whose noise is subtracted, and writes a table:
RMS over the seeds of what was found, the second worst of 20 (95 %), what the pictures stated, all
in shares of the error asked for; bias of the mean luminance; CPU seconds and rays of the process.

    cmake --preset release && cmake --build build/release --target atrium
    benchmarks/asked_error.py [--out docs/asked_error.md] [--seeds 20] [--only TEXT]
"""
import argparse
import concurrent.futures
import math
import pathlib
import statistics
import sys
import tempfile

from suite import program

ROOT = pathlib.Path(__file__).resolve().parent.parent
SIZE = "96x72"
# scene: samples of the reference, errors of pixels, errors of blocks
SCENES = {
    "scenes/cornell/cornell.yaml": (4096, [0.1, 0.05], [0.02, 0.01]),
    "scenes/benchmark/mirror_atrium.yaml": (2048, [0.1], [0.02, 0.01]),
    "scenes/benchmark/cornell_glass.yaml": (8192, [0.1], [0.02]),
    "scenes/benchmark/cove_office.yaml": (2048, [0.1, 0.05], [0.05, 0.02]),
    "scenes/benchmark/corridor_door.yaml": (2048, [0.1], [0.02]),
    "scenes/benchmark/daylit_atrium.yaml": (512, [0.2], [0.05]),
    "../shared/scenes/modern_hall.glb": (2048, [0.1], [0.02, 0.01]),
}


def measure(args, scene, reference, kind, asked, folder):
    option = "--error" if kind == "pixel" else "--error-block"

    def one(seed):
        picture = folder / f"{seed}.exr"
        cost, stats = program.atrium(args.atrium, "render", scene, "-o", picture, "--size", SIZE, option, asked,
                                     "--seed", seed, "--threads", 1)
        found = program.compare(args.atrium, picture, reference)
        return cost, stats, found

    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        return list(pool.map(one, range(1, args.seeds + 1)))


def row(scene, kind, asked, runs):
    found = sorted(found[kind]["value"] / asked for _, _, found in runs)
    stated = [stats["error"]["estimate" if kind == "pixel" else "estimate_block"] / asked for _, stats, _ in runs]
    bias = [100 * found["bias"] for _, _, found in runs]
    missed = sum(stats["error"]["stopped_by"] != "error" for _, stats, _ in runs)
    worst = found[math.ceil(0.95 * len(found)) - 1]
    cells = [scene.stem, f"{100 * asked:g} % of {kind}s",
             f"{math.sqrt(statistics.mean(v * v for v in found)):.2f}", f"{worst:.2f}", f"{statistics.mean(stated):.2f}",
             f"{statistics.mean(bias):+.2f} ± {statistics.stdev(bias) / math.sqrt(len(bias)):.2f}",
             f"{statistics.mean(cost.cpu for cost, _, _ in runs):.1f}",
             f"{statistics.mean(program.rays_of(stats['counters']) for _, stats, _ in runs):.2g}",
             f"{100 * runs[0][2][kind]['reference_noise']:.2g} %", str(missed)]
    return "| " + " | ".join(cells) + " |"


def page(seeds, measured, rows, skipped):
    """What is known so far; written after every row, so an interrupt loses no more than one."""
    text = f"""# Found against asked error

Made by `benchmarks/asked_error.py`: {seeds} seeds, each a whole process with a radiosity of its own, {SIZE} pixels, one
thread. *found*: RMS over the seeds against path tracing ({", ".join(measured)} samples of a pixel), its noise subtracted; *95 %*: the
worst of that share of the seeds; *stated*: what the pictures say of themselves, in the mean; all three in shares of the error
asked for. *bias*: of the mean luminance, with its standard error over the seeds. *noise*: of the reference, of pixels or of
blocks. *missed*: runs that did not reach the error asked for, by what they state.

| scene | asked | found | 95 % | stated | bias % | CPU s | rays | noise | missed |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
""" + "\n".join(rows) + "\n"
    if skipped:
        text += f"\nSkipped, models that were not there: {', '.join(skipped)}.\n"
    return text


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--atrium", default=ROOT / "build/release/bin/atrium", type=pathlib.Path)
    parser.add_argument("--out", default=ROOT / "docs/asked_error.md", type=pathlib.Path)
    parser.add_argument("--seeds", default=20, type=int)
    parser.add_argument("--jobs", default=2, type=int, help="processes at once, of one thread each")
    parser.add_argument("--only", default="", help="scenes whose name contains this")
    args = parser.parse_args()
    if args.seeds < 2:
        parser.error("--seeds: at least 2")
    references = ROOT / "build/benchmarks/references"
    references.mkdir(parents=True, exist_ok=True)
    rows, skipped, measured = [], [], []
    for name, (samples, pixels, blocks) in SCENES.items():
        scene = (ROOT / name).resolve()
        if args.only not in scene.stem:
            continue
        if not scene.exists():
            skipped.append(scene.stem)
            continue
        reference = program.path_reference(args.atrium, scene, references, SIZE, samples)
        measured.append(f"{scene.stem} {samples}")
        for kind, asked in [("pixel", e) for e in pixels] + [("block", e) for e in blocks]:
            with tempfile.TemporaryDirectory() as folder:
                rows.append(row(scene, kind, asked, measure(args, scene, reference, kind, asked, pathlib.Path(folder))))
            print(rows[-1], file=sys.stderr, flush=True)
            args.out.write_text(page(args.seeds, measured, rows, skipped), encoding="utf-8")


if __name__ == "__main__":
    main()
