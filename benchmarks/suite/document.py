"""docs/benchmarks.md and its plots, from the results of all sections."""

import re
import textwrap

from suite import results

HEAD = """# Benchmarks

Made by one command, which keeps what each section found and composes this page from it:

```sh
scripts/install_deps.sh build bench
cmake --preset release -DATRIUM_BUILD_BENCHMARKS=ON && cmake --build --preset release
benchmarks/run.py                       # all sections, then this page
benchmarks/run.py --only hybrid,micro   # some of them, the others as they were
benchmarks/run.py --compose             # only this page
benchmarks/run.py --quick               # counted work against its baseline (a test of ctest)
```

CPU is user and system time of whole processes, wall what a clock shows, MB the largest resident size. Errors of
pictures are those of [architecture.md](architecture.md), Error measures, unless a section says otherwise. Seeds are
fixed: the same command counts the same work again; only seconds change.
"""


def where(found):
    m = found["machine"]
    other = (
        f"other work had {100 * found['other_work']:.0f} % of the cores meanwhile"
        if found["other_work"] >= 0.02
        else "nothing else ran"
    )
    thorough = "; --thorough" if found["thorough"] else ""
    return wrapped(
        f"*{m['cpu']}, {m['cores']} cores, {m['memory_gb']} GB; {m['compiler']}; commit {m['commit']}, {m['date']}; "
        f"{found['seconds'] / 60:.1f} minutes, {other}{thorough}.*"
    )


def wrapped(text):
    """Prose in lines of equal length; tables, pictures, lists and code as they are."""
    blocks = re.split(r"\n{2,}", text.strip())
    return (
        "\n\n".join(
            (
                b
                if b.startswith(("|", "!", "#", "-", "`" * 3))
                else "\n".join(textwrap.wrap(b, 118, break_long_words=False, break_on_hyphens=False))
            )
            for b in blocks
        )
        + "\n"
    )


def compose(sections, context):
    images = context.docs / "images" / "benchmarks"
    parts = [HEAD]
    for section in sections:
        parts.append(f"## {section.TITLE}\n")
        found = results.load(section, context.results)
        if found is None:
            parts.append(f"Not measured yet: `benchmarks/run.py --only {section.NAME}`.\n")
            continue
        parts.append(where(found))
        parts.append(wrapped(section.page(found["data"], images)))
    (context.docs / "benchmarks.md").write_text("\n".join(parts), encoding="utf-8")


def image(name, text):
    return f"![{text}](images/benchmarks/{name})\n"
