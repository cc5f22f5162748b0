#!/usr/bin/env python3
"""A walk through models: what the solve and every later frame cost, and how much frames flicker.

  benchmarks/walk.py MODEL... [--frames 60] [--size 256x256] [--quality normal]
                     [--flicker-size 96x96] [--pairs 2] [--reference-samples 512]
                     [--atrium PROGRAM] [--keep FOLDER] [--out FILE]

The path of MODEL is benchmarks/walks/MODEL.yaml. Flicker: the error of a frame less that of the one
before it, relative as the errors of `atrium compare` are, RMS over pixels and channels of pairs in
the middle of the walk, against references of the same solution with many samples. Noise that is
independent from frame to frame has sqrt(2) times the error of one frame; noise that stands on the
screen has less. "still": the same for a camera that stands still.
"""
import argparse
import array
import json
import math
import os
import pathlib
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
SOLVING = ("rays.row", "rays.direct", "rays.photon", "rays.probe")


def render(options, model, path, frames, outputs, extra):
    command = [options.atrium, "render", model, "--path", str(path), "--frames", str(frames),
               "--quality", options.quality, "--quiet", *extra]
    for output in outputs:
        command += ["-o", output]
    subprocess.run(command, check=True)


def read_pfm(file):
    """Width, height and R, G, B floats, rows from the bottom."""
    with open(file, "rb") as f:
        assert f.readline().strip() == b"PF"
        width, height = (int(word) for word in f.readline().split())
        f.readline()
        values = array.array("f")
        values.frombytes(f.read())
    return width, height, values


def luminance(values):
    return [0.2126 * values[i] + 0.7152 * values[i + 1] + 0.0722 * values[i + 2]
            for i in range(0, len(values), 3)]


def scales(width, height, values):
    """What errors are relative to: mean luminance of 5x5 pixels, 5 % of the median besides."""
    y = luminance(values)
    lit = sorted(v for v in y if v > 0)
    floor = 0.05 * lit[len(lit) // 2]
    result = []
    for row in range(height):
        for column in range(width):
            around = [y[r * width + c]
                      for r in range(max(0, row - 2), min(height, row + 3))
                      for c in range(max(0, column - 2), min(width, column + 3))]
            result.append(sum(around) / len(around) + floor)
    return result


def errors(frame, reference):
    width, height, truth = read_pfm(reference)
    scale = scales(width, height, truth)
    values = read_pfm(frame)[2]
    return [(values[i] - truth[i]) / scale[i // 3] for i in range(len(truth))]


def rms(values):
    return math.sqrt(sum(v * v for v in values) / len(values))


def flicker(options, model, path, solution, folder):
    """(error of a frame, flicker with one seed for all frames, with one seed per frame)."""
    middle = options.frames // 2
    size = ["--size", options.flicker_size, "--solution", solution]
    single, same, own = [], [], []
    for pair in range(options.pairs):
        first = max(1, middle - 5 * pair)
        e = {}
        for seed in (1, 2):
            name = os.path.join(folder, f"seed{seed}.pfm")
            render(options, model, path, options.frames, [name],
                   size + ["--frame-range", f"{first}-{first + 1}", "--seed", str(seed)])
        reference = os.path.join(folder, "reference.pfm")
        render(options, model, path, options.frames, [reference],
               size + ["--frame-range", f"{first}-{first + 1}", "--seed", "77", "--no-filter",
                       "--samples", str(options.reference_samples)])
        for seed in (1, 2):
            for frame in (first, first + 1):
                e[seed, frame] = errors(os.path.join(folder, f"seed{seed}-{frame:04d}.pfm"),
                                        os.path.join(folder, f"reference-{frame:04d}.pfm"))
        single.append(rms(e[1, first]))
        same.append(rms([b - a for a, b in zip(e[1, first], e[1, first + 1])]))
        own.append(rms([b - a for a, b in zip(e[1, first], e[2, first + 1])]))
    return rms(single), rms(same), rms(own)


def still(options, model, solution, folder):
    """RMS of the difference of two frames of a camera that stands still, largest value apart."""
    path = os.path.join(folder, "still.yaml")
    text = (HERE / "walks" / f"{pathlib.Path(model).stem}.yaml").read_text(encoding="utf-8")
    head, keys = text.split("keys:\n")
    with open(path, "w", encoding="utf-8") as file:
        file.write(head + "keys:\n" + keys.splitlines()[0] + "\n")
    render(options, model, path, 2, [os.path.join(folder, "still.pfm")],
           ["--size", options.flicker_size, "--solution", solution])
    a, b = (read_pfm(os.path.join(folder, f"still-000{i}.pfm"))[2] for i in (1, 2))
    return rms([y - x for x, y in zip(a, b)])


def measure(options, model, folder):
    stem = pathlib.Path(model).stem
    path = HERE / "walks" / f"{stem}.yaml"
    stats = os.path.join(folder, "stats.json")
    pictures = options.keep or folder
    render(options, model, path, options.frames, [os.path.join(pictures, f"{stem}.png")],
           ["--size", options.size, "--stats", stats])
    with open(stats, encoding="utf-8") as file:
        s = json.load(file)
    solve_rays = sum(s["counters"][kind] for kind in SOLVING)
    later = sum(v["counters"][kind] for v in s["views"] for kind in SOLVING)
    cpu = [v["cpu"] for v in s["views"]]
    solve_cpu = sum(s["phases"].get(p, {"cpu": 0})["cpu"] for p in ("mesh", "direct", "radiosity"))
    error = [v["error_estimate"] for v in s["views"]]
    rays = s["rays"]["render"]
    costs = (f"| {stem} | {len(cpu)} | {solve_rays:.2g} | {solve_cpu:.1f} | {later} | "
             f"{sum(cpu) / len(cpu):.2f} | {max(cpu):.2f} | "
             f"{rays['per_cpu_second'] / 1e6:.1f} | {100 * rays['embree_share']:.0f} % | "
             f"{100 * min(error):.1f}-{100 * max(error):.1f} % | "
             f"{sum(v['fireflies'] for v in s['views'])} | "
             f"{sum(v['counters']['samples.dropped'] for v in s['views'])} | "
             f"{s['peak_memory_mb']:.0f} |")
    solution = os.path.join(folder, f"{stem}.atrium")
    subprocess.run([options.atrium, "solve", model, "-o", solution, "--quality", options.quality,
                    "--quiet"], check=True)
    single, same, own = flicker(options, model, path, solution, folder)
    steady = (f"| {stem} | {100 * single:.2f} % | {100 * same:.2f} % | {same / single:.2f} | "
              f"{100 * own:.2f} % | {own / single:.2f} | {still(options, model, solution, folder):g} |")
    return costs, steady


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+")
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--size", default="256x256")
    parser.add_argument("--quality", default="normal")
    parser.add_argument("--flicker-size", default="96x96")
    parser.add_argument("--pairs", type=int, default=2)
    parser.add_argument("--reference-samples", type=int, default=512)
    parser.add_argument("--atrium", default="build/release/bin/atrium")
    parser.add_argument("--keep", default="", help="folder for the frames")
    parser.add_argument("--out", default="")
    options = parser.parse_args()

    costs = ["| model | frames | rays of solving | CPU s | ... in frames | CPU s per frame | largest | "
             "million rays per CPU s | Embree | estimated error | fireflies | dropped | MB |",
             "| --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: | ---: |"]
    steady = ["| model | error of a frame | flicker, one seed | of the error | flicker, own seeds | "
              "of the error | still |",
              "| --- | ---: | ---: | ---: | ---: | ---: | ---: |"]
    for model in options.models:
        with tempfile.TemporaryDirectory() as folder:
            a, b = measure(options, model, folder)
        costs.append(a)
        steady.append(b)
        print(a, b, sep="\n", flush=True)
    text = "\n".join(costs) + "\n\n" + "\n".join(steady) + "\n"
    if options.out:
        pathlib.Path(options.out).write_text(text, encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
