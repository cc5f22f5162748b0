#!/usr/bin/env python3
"""Hybrid and reference compared class of light paths by class.

Renders every scene with --method path once and with the hybrid for several seeds (each with its own
radiosity), with --classes, and writes for every class its share of the reference's light and the
mean difference, hybrid minus reference, with its 95 % interval: the noise of the reference and the
spread of the hybrid's seeds in quadrature (Student's t for the latter). A class that differs by more
is marked.

    benchmarks/light_classes.py [SCENE...] [--out docs/light_classes.md] [--size 64x48]
"""
import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHIPPED = ["cornell/cornell", "furnace/furnace", "glass_and_mirror/glass_and_mirror", "lounge/lounge", "office/office",
           "benchmark/furnished_room", "benchmark/mirror_atrium", "benchmark/small_room", "benchmark/small_sun",
           "benchmark/sun_patch", "benchmark/white_corridor"]
STUDENT = {2: 12.71, 3: 4.30, 4: 3.18, 5: 2.78, 6: 2.57, 8: 2.36}  # 97.5 %, by number of seeds
CLASSES = ["LE", "LSE", "LDE", "LDSE", "LSDE", "LSDSE", "LDDE", "LDDSE", "LSDDE", "LSDDSE", "LDDDE", "LDDDSE"]


def run(atrium, *args):
    result = subprocess.run([atrium, *map(str, args)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"atrium {' '.join(map(str, args))}\n{result.stderr}")
    return result.stdout


def render(args, scene, folder, method, samples, seed):
    image, stats = folder / f"{scene.stem}-{method}-{seed}.exr", folder / "stats.json"
    run(args.atrium, "render", scene, "-o", image, "--size", args.size, "--samples", samples, "--method", method,
        "--seed", seed, "--classes", "--quiet", "--stats", stats)
    return image, json.loads(stats.read_text())


def cell(comparisons, name, lacking):
    values = [c["classes"][name] for c in comparisons]
    share = values[0]["share"]
    difference = statistics.mean(v["difference"] for v in values)
    if share == 0.0 and difference == 0.0:
        return "", False
    spread = statistics.stdev(v["difference"] for v in values) / math.sqrt(len(values))
    # The difference to one and the same reference: its noise does not shrink with the seeds.
    interval = math.hypot(values[0]["interval"], STUDENT[len(values)] * spread)
    off = abs(difference) > interval + 5e-6
    mark = "\\*" if off and not (lacking and name in lacking) else "†" if off else ""
    return f"{100 * share:.2f}: {100 * difference:+.3f} ± {100 * interval:.3f}{mark}", off


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenes", nargs="*", type=pathlib.Path,
                        default=[ROOT / "scenes" / f"{name}.yaml" for name in SHIPPED])
    parser.add_argument("--atrium", default=ROOT / "build/release/bin/atrium", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--size", default="64x48")
    parser.add_argument("--samples", default=64, type=int, help="of the hybrid")
    parser.add_argument("--path-samples", default=256, type=int)
    parser.add_argument("--seeds", default=3, type=int, choices=STUDENT, help="of the hybrid")
    args = parser.parse_args()

    table, remarks = [], []
    with tempfile.TemporaryDirectory() as scratch:
        folder = pathlib.Path(scratch)
        for scene in args.scenes:
            path, stats = render(args, scene, folder, "path", args.path_samples, 1000)
            lacking = " ".join(stats["reference"]["missing"]).split(":")[0].split(", ")
            hybrids = [render(args, scene, folder, "hybrid", args.samples, seed + 1)[0] for seed in range(args.seeds)]
            found = [json.loads(run(args.atrium, "compare", hybrid, path, "--json")) for hybrid in hybrids]
            cells = [cell(found, name, lacking)[0] for name in CLASSES]
            ends = "both ends" if stats["reference"]["paths_from_lights"] else "the eye"
            table.append(f"| {scene.stem} ({ends}) | " + " | ".join(cells) + " |")
            print(table[-1], flush=True)

    text = "\n".join([
        "# Classes of light paths", "",
        "`benchmarks/light_classes.py --out docs/light_classes.md`"
        f" ({args.size}, hybrid {args.samples} samples and {args.seeds} seeds, reference {args.path_samples} samples).", "",
        "Share of the reference's light in %, and hybrid minus reference in % of all light with its 95 % interval. In",
        "brackets: where the reference's paths start. \\* differs by more than the interval (1 in 20 does by chance;",
        "the interval knows noise, not what elements smear). † the reference says that it lacks part of this class",
        "(`reference.missing` of `--stats`). Names of classes: `libtrace/include/trace/light_classes.h`.", "",
        "| scene | " + " | ".join(CLASSES) + " |", "| --- |" + " --- |" * len(CLASSES), *table, ""])
    if args.out:
        args.out.write_text(text)


if __name__ == "__main__":
    main()
