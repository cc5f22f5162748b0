#!/usr/bin/env python3
"""How the radiosity pass does on a set of models: cost, stated error, and whether the flux balances.

Runs `atrium solve MODEL --stats` for each and writes a table. The verdict asks that the flux that
was counted as absorbed and as escaped, neither made from the other, meets what the lights emit
within three standard errors and within half the asked error.

    benchmarks/radiosity_models.py MODEL... [--out docs/radiosity_models.md] [--error 0.05] [-- OPTION...]
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

from suite import program

ROOT = pathlib.Path(__file__).resolve().parent.parent
HEAD = ("| model | triangles | elements | rays (million) | wall s | CPU s | error estimate % | emitted | absorbed % "
        "| escaped % | missing % (s.e.) | balance | peak MB |")


def solve(atrium, model, options):
    """Statistics of one run, or the program's complaint."""
    with tempfile.TemporaryDirectory() as folder:
        stats = pathlib.Path(folder) / "stats.json"
        command = [atrium, "solve", model, "-o", pathlib.Path(folder) / "out.atrium", "--stats", stats, "--quiet",
                   *options]
        result = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False)
        if result.returncode != 0:
            return None, result.stderr.strip() or f"exit code {result.returncode}"
        return json.loads(stats.read_text()), ""


def verdict(flux, asked_error):
    missing = flux["emitted"] - flux["absorbed"] - flux["escaped"]
    if not flux["emitted"] > 0:
        return "no light"
    within_noise = abs(missing) <= 3 * flux["standard_error"]
    within_target = abs(missing) <= 0.5 * asked_error * flux["emitted"]
    if within_noise and within_target:
        return "pass"
    return "**fail**: " + " and ".join(
        text for bad, text in ((not within_noise, "more than 3 s.e."), (not within_target, "more than half the error"))
        if bad)


def row(model, stats, asked_error):
    counters, flux = stats["counters"], stats["radiosity"]["flux"]
    rays = program.rays_of(counters)
    emitted = flux["emitted"]
    share = (lambda x: f"{100 * x / emitted:.2f}") if emitted > 0 else (lambda x: "-")
    missing = emitted - flux["absorbed"] - flux["escaped"]
    wall = stats["wall"]
    cpu = sum(phase["cpu"] for phase in stats["phases"].values())
    return (f"| {model.stem} | {stats['scene']['triangles']} | {counters['elements']} | {rays / 1e6:.1f} | {wall:.1f} "
            f"| {cpu:.1f} | {100 * stats['radiosity']['error_estimate']:.2f} | {emitted:.4g} "
            f"| {share(flux['absorbed'])} | {share(flux['escaped'])} "
            f"| {share(missing)} ({share(flux['standard_error'])}) | {verdict(flux, asked_error)} "
            f"| {stats['peak_memory_mb']:.0f} |")


def main():
    arguments, options = sys.argv[1:], []
    if "--" in arguments:
        at = arguments.index("--")
        arguments, options = arguments[:at], arguments[at + 1:]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="+", type=pathlib.Path)
    parser.add_argument("--atrium", default=ROOT / "build/release/bin/atrium", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--error", default=0.05, type=float, help="asked relative error, half of it bounds the balance")
    args = parser.parse_args(arguments)

    rows = []
    for model in args.models:
        stats, complaint = solve(args.atrium, model, options)
        rows.append(row(model, stats, args.error) if stats else f"| {model.stem} | {complaint} |" + " |" * 11)
        print(rows[-1], flush=True)
    text = "\n".join([
        "# Radiosity on models", "",
        "Written by `benchmarks/radiosity_models.py`" + (f" with `{' '.join(options)}`" if options else "") + ".",
        "Missing: emitted minus absorbed minus escaped, each counted on its own; balance passes within three standard "
        f"errors and {50 * args.error:g} % of the emitted flux.", "", HEAD,
        "| --- |" + " ---: |" * 10 + " --- | ---: |", *rows, ""])
    if args.out:
        args.out.write_text(text)


if __name__ == "__main__":
    main()
