"""Counted work held against a baseline: what grew, what shrank.

Counts are the same for any number of threads and any load of the machine; a processor of another kind
may round rays elsewhere, so they have a tolerance. Errors that are stated stand beside the counts: less
work must not be bought with more error.
"""

import dataclasses

COUNT = 0.02  # share by which a count, or a stated error, may lie above its baseline
MEMORY = 0.25  # the same of the largest resident size: allocators and libraries differ
MEMORY_MB = 16.0  # ... and besides


@dataclasses.dataclass
class Change:
    case: str
    name: str
    baseline: float
    found: float

    @property
    def share(self):
        return self.found / self.baseline - 1.0 if self.baseline else float("inf")


def slack(name, baseline):
    """How far a number may be from its baseline and still be the same."""
    if name == "memory_mb":
        return MEMORY * baseline + MEMORY_MB
    if name.startswith("error."):
        return COUNT * baseline
    # What was not counted at all stays so: nothing is traced that a scene does not need.
    return max(COUNT * baseline, 1.0) if baseline else 0.0


def compare(baseline, found):
    """(regressions, gains, complaints): Changes beyond the slack in both directions, and what cannot be
    compared at all, as lines. Both arguments are {case: {"command": text, "numbers": {name: number}}}."""
    regressions, gains, complaints = [], [], []
    for case in sorted(baseline.keys() | found.keys()):
        if case not in baseline or case not in found:
            complaints.append(f"{case}: only in " + ("the baseline" if case in baseline else "this run"))
            continue
        old, new = baseline[case], found[case]
        if old["command"] != new["command"]:
            complaints.append(f"{case}: the baseline is of another command: {old['command']}")
            continue
        for name in sorted(old["numbers"].keys() | new["numbers"].keys()):
            if name not in new["numbers"]:
                complaints.append(f"{case}: {name} is no longer counted")
                continue
            change = Change(case, name, old["numbers"].get(name, 0), new["numbers"][name])
            allowed = slack(name, change.baseline)
            # Written so that a number that is none fails.
            if not change.found <= change.baseline + allowed:
                regressions.append(change)
            elif change.found < change.baseline - allowed:
                gains.append(change)
    return regressions, gains, complaints


def table(changes):
    """Columns that line up; the largest changes first."""
    rows = [("case", "number", "baseline", "found", "change")]
    for c in sorted(changes, key=lambda c: -abs(c.share)):
        rows.append(
            (
                c.case,
                c.name,
                f"{c.baseline:.6g}",
                f"{c.found:.6g}",
                f"{100 * c.share:+.1f} %" if c.baseline else "new",
            )
        )
    widths = [max(len(row[i]) for row in rows) for i in range(5)]
    return "\n".join(
        "  ".join(
            cell.ljust(width) if i < 2 else cell.rjust(width) for i, (cell, width) in enumerate(zip(row, widths))
        ).rstrip()
        for row in rows
    )
