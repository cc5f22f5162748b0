"""Counted work of small runs against a baseline: `run.py --quick`. No number is a time."""

import json
import pathlib
import tempfile
import time

from suite import counted, program

# name: (arguments, name of the result). Small, but each with what makes its kind of scene costly.
CASES = {
    "box draft": ("render cornell/cornell --size 96x96 --quality draft", "a.exr"),
    "box to an error": ("render cornell/cornell --size 64x64 --error 0.05", "a.pfm"),
    "box by paths": ("render cornell/cornell --size 64x64 --method path --samples 32", "a.pfm"),
    "box direct": ("render cornell/cornell --size 96x96 --method direct --samples 16", "a.pfm"),
    "caustics": ("render benchmark/cornell_glass --size 64x64 --quality draft", "a.pfm"),
    "caustics by paths": ("render benchmark/cornell_glass --size 48x48 --method path --samples 16", "a.pfm"),
    "glass and mirror": ("render glass_and_mirror/glass_and_mirror --size 64x48 --quality draft", "a.pfm"),
    "cove": ("render benchmark/cove_office --size 64x48 --error 0.1", "a.pfm"),
    "daylight": ("render benchmark/daylit_atrium --size 48x48 --quality draft", "a.pfm"),
    "blocks to an error": ("render benchmark/corridor_door --size 64x48 --error-block 0.05", "a.exr"),
    "small error of blocks": ("render cornell/cornell --size 64x48 --error-block 0.01", "a.pfm"),
    "subdivision": ("render lounge/lounge --size 64x48 --quality draft", "a.pfm"),
    "solve a floor": ("solve benchmark/office_floor --quality draft", "a.atrium"),
    "solve to an error": ("solve benchmark/furnished_room --error 0.1", "a.atrium"),
    "mirrors": ("solve benchmark/mirror_atrium --error 0.1", "a.atrium"),
    "by shooting": ("solve cornell/cornell --quality draft --solver shooting --memory-limit 1", "a.atrium"),
    "by a matrix": ("solve benchmark/small_room --quality draft --solver matrix", "a.atrium"),
    "sensors": ("measure benchmark/small_room --workplane 0.85 --spacing 0.5 --quality draft", "a.csv"),
}


def numbers_of(stats, output):
    """{name: number} of one run; what is 0 is left out, and so stays 0."""
    numbers = {name: value for name, value in stats["counters"].items() if value}
    numbers["bytes.written"] = output.stat().st_size
    numbers["memory_mb"] = round(stats["peak_memory_mb"], 1)
    radiosity = stats["radiosity"]
    if radiosity["done"]:
        numbers["bytes.radiosity"] = radiosity["memory"]["peak"]
        stated = radiosity.get("error", stats["error"])
        numbers["error.radiosity"], numbers["error.mesh"] = stated["estimate"], stated["mesh"]
    for view in stats.get("views", []):
        numbers["rounds"] = view["rounds"]
        numbers["error.pixel"], numbers["error.block"] = view["error_estimate"], view["block_error_estimate"]
    return {name: value if isinstance(value, int) else float(f"{value:.6g}") for name, value in numbers.items()}


def run_case(atrium, scenes, command, result):
    words = command.split()
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / result
        _, stats = program.atrium(atrium, words[0], scenes / f"{words[1]}.yaml", "-o", output, *words[2:])
        return {"command": command, "numbers": numbers_of(stats, output)}


def count(atrium, root):
    """{case: {"command", "numbers"}} of all cases."""
    found = {}
    for name, (command, result) in CASES.items():
        start = time.monotonic()
        found[name] = run_case(atrium, root / "scenes", command, result)
        print(f"{time.monotonic() - start:5.1f} s  {name}", flush=True)
    return found


def write(found, file):
    file.write_text(json.dumps(found, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def check(found, file):
    """Says what changed; 0 if nothing grew."""
    baseline = json.loads(file.read_text(encoding="utf-8"))
    regressions, gains, complaints = counted.compare(baseline, found)
    for complaint in complaints:
        print(complaint)
    if regressions:
        print("\nmore work, memory or error than the baseline:\n" + counted.table(regressions))
    if gains:
        print("\nless than the baseline:\n" + counted.table(gains))
    if regressions or gains or complaints:
        print("\nIf this is meant: benchmarks/run.py --quick --renew, and say why in the commit.")
    return 1 if regressions or complaints else 0


def main(atrium, root, file, renew):
    found = count(atrium, root)
    if renew:
        write(found, file)
        return 0
    return check(found, file)
