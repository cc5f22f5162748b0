#!/usr/bin/env python3
"""How far hybrid and path tracer differ on a set of models, class of light paths by class.

Renders every model with both methods at a small size and writes a table: bias of the mean and RMS
after 8x8 block averaging, the path tracer's own noise subtracted with its confidence interval.

    benchmarks/models.py MODEL... [--out docs/models.md] [--size 128x96] [--path-samples 1024]
"""
import argparse
import json
import pathlib
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
CLASSES = ["C1", "C2", "C3", "C4", "C5", "C6"]


def run(atrium, *args):
    result = subprocess.run([atrium, *map(str, args)], capture_output=True, text=True, check=False)
    if result.returncode != 0:
        raise SystemExit(f"atrium {' '.join(map(str, args))}\n{result.stderr}")
    return result.stdout


def render(atrium, model, folder, method, size, samples, seed):
    image = folder / f"{model.stem}-{method}.exr"
    stats = folder / f"{model.stem}-{method}.json"
    run(atrium, "render", model, "-o", image, "--size", size, "--samples", samples, "--method", method,
        "--seed", seed, "--components", "--stats", stats, "--quiet")
    return image, json.loads(stats.read_text())


def percent(x):
    return f"{100 * x:.2f}"


def share(measure):
    if measure is None:
        return "-"
    return f"{100 * measure['share']:.1f} ({100 * measure['difference']:+.2f})"


def cpu(stats):
    return sum(phase["cpu"] for phase in stats["phases"].values())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+", type=pathlib.Path)
    parser.add_argument("--atrium", default=ROOT / "build/release/bin/atrium", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--keep", type=pathlib.Path, help="folder that keeps the images")
    parser.add_argument("--size", default="128x96")
    parser.add_argument("--samples", default=256, type=int, help="of the hybrid")
    parser.add_argument("--path-samples", default=1024, type=int)
    args = parser.parse_args()

    scratch = tempfile.TemporaryDirectory()
    folder = args.keep or pathlib.Path(scratch.name)
    folder.mkdir(parents=True, exist_ok=True)
    rows, terms = [], []
    for model in args.models:
        hybrid, hybrid_stats = render(args.atrium, model, folder, "hybrid", args.size, args.samples, 1)
        path, path_stats = render(args.atrium, model, folder, "path", args.size, args.path_samples, 2)
        whole = json.loads(run(args.atrium, "compare", hybrid, path, "--json"))
        block = whole["block"]
        rows.append(f"| {model.stem} | {percent(whole['bias'])} ± {percent(2 * whole['bias_standard_error'])} "
                    f"| {percent(block['value'])} ({percent(block['low'])} to {percent(block['high'])}) "
                    f"| {percent(block['reference_noise'])} | {percent(whole['pixel']['value'])} "
                    f"| {cpu(hybrid_stats):.0f} | {cpu(path_stats):.0f} |")
        by_class = whole.get("terms", {})
        terms.append("| " + model.stem + " | " + " | ".join(share(by_class.get(c)) for c in CLASSES) + " |")
        print(rows[-1], terms[-1], sep="\n", flush=True)

    text = "\n".join([
        f"Size {args.size}; hybrid {args.samples}, path {args.path_samples} samples per pixel.", "",
        "| model | bias % (95 %) | block RMS % (95 %) | reference's block noise % | pixel RMS % | hybrid CPU s | path CPU s |",
        "| --- | --- | --- | --- | --- | --- | --- |", *rows, "",
        "Share of the image's light by term in %, and in brackets hybrid minus path in % of the whole light:", "",
        "| model | " + " | ".join(CLASSES) + " |", "| --- |" + " --- |" * len(CLASSES), *terms, ""])
    if args.out:
        args.out.write_text(text)


if __name__ == "__main__":
    main()
