"""What sections found, kept as one JSON file each, so that they may be run at different times."""

import json

from suite import machine


def file_of(folder, name):
    return folder / f"{name}.json"


def measure(section, context):
    """Runs a section and keeps what it found, with where and beside how much other work."""
    with machine.OtherWork() as other:
        data = section.measure(context)
    found = {
        "machine": machine.describe(context.atrium, context.root),
        "seconds": round(other.seconds),
        "other_work": round(other.share, 3),
        "thorough": context.thorough,
        "data": data,
    }
    context.results.mkdir(parents=True, exist_ok=True)
    file_of(context.results, section.NAME).write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    return found


def load(section, folder):
    file = file_of(folder, section.NAME)
    return json.loads(file.read_text(encoding="utf-8")) if file.exists() else None
