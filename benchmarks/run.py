#!/usr/bin/env python3
"""Runs the benchmarks and writes docs/benchmarks.md.

  benchmarks/run.py                        all sections, then the page; what each found is kept
  benchmarks/run.py --only hybrid,micro    these sections, then the page with the others as they were
  benchmarks/run.py --compose              only the page
  benchmarks/run.py --quick [--renew]      counted work of small runs against benchmarks/quick_baseline.json

Needs scripts/install_deps.sh bench and a build with -DATRIUM_BUILD_BENCHMARKS=ON; --quick needs only
the program. Other programs that are compared with run if they are there (docs/benchmarks.md says how
to get them).
"""

import argparse
import dataclasses
import importlib.util
import pathlib
import sys
import time

from suite import document, program, quick, results
from suite.sections import SECTIONS

ROOT = pathlib.Path(__file__).resolve().parent.parent


@dataclasses.dataclass
class Context:
    """What a section may use."""

    root: pathlib.Path
    atrium: pathlib.Path  # the program; others that are built lie beside it
    results: pathlib.Path  # folder of results, references and scenes that are made
    docs: pathlib.Path
    thorough: bool

    def built(self, name):
        return self.atrium.parent / name

    def scene(self, name):
        return self.root / "scenes" / f"{name}.yaml"

    def folder(self, name):
        path = self.results / name
        path.mkdir(parents=True, exist_ok=True)
        return path


def parse():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    known = ",".join(SECTIONS)
    parser.add_argument("--only", metavar="NAME,...", default=known, help=f"sections to run (default: {known})")
    parser.add_argument("--compose", action="store_true", help="write the page from kept results")
    parser.add_argument("--thorough", action="store_true", help="smaller errors, longer sweeps, more repetitions")
    parser.add_argument("--quick", action="store_true", help="compare counted work with the baseline")
    parser.add_argument("--renew", action="store_true", help="with --quick: write the baseline")
    path = pathlib.Path
    parser.add_argument("--atrium", type=path, default=ROOT / "build/release/bin/atrium", help="the program")
    parser.add_argument("--results", type=path, default=ROOT / "build/benchmarks", help="where results are kept")
    parser.add_argument("--docs", type=path, default=ROOT / "docs", help="where the page goes")
    parser.add_argument("--baseline", type=path, default=ROOT / "benchmarks/quick_baseline.json", help="of --quick")
    options = parser.parse_args()
    unknown = [name for name in options.only.split(",") if name not in SECTIONS]
    if options.renew and not options.quick:
        parser.error("--renew belongs to --quick")
    if unknown:
        parser.error(f"no section '{unknown[0]}' (known: {known})")
    return options


def run_sections(names, context):
    """False if one of them failed; the others are measured all the same."""
    complete = True
    for name in names:
        start = time.monotonic()
        print(f"== {name}", flush=True)
        try:
            results.measure(SECTIONS[name], context)
        except program.Failed as failure:
            print(f"run.py: {name}: {failure}", file=sys.stderr, flush=True)
            complete = False
        print(f"== {name}: {time.monotonic() - start:.0f} s", flush=True)
    return complete


def main():
    options = parse()
    atrium = options.atrium.resolve()
    if not atrium.exists():
        sys.exit(f"run.py: {atrium} is not there: cmake --preset release && cmake --build --preset release")
    if options.quick:
        return quick.main(atrium, ROOT, options.baseline, options.renew)
    if importlib.util.find_spec("matplotlib") is None:
        sys.exit("run.py: no Python module matplotlib: scripts/install_deps.sh bench")
    context = Context(ROOT, atrium, options.results.resolve(), options.docs.resolve(), options.thorough)
    complete = options.compose or run_sections(options.only.split(","), context)
    document.compose(SECTIONS.values(), context)
    return 0 if complete else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except program.Failed as failure:
        sys.exit(f"run.py: {failure}")
