"""Tables of Markdown."""


def table(head, rows, text_columns=1):
    """The first columns are text, the rest numbers."""
    marks = ["---" if i < text_columns else "---:" for i in range(len(head))]
    lines = [head, marks, *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def seconds(value):
    return f"{value:.3g}" if value < 100 else f"{value:.0f}"


def percent(share):
    return f"{100 * share:.2g} %" if share < 0.995 else f"{100 * share:.0f} %"


def count(value):
    """1234: 1,234; 12345678: 1.23e7."""
    if value < 1e6:
        return f"{value:,.0f}"
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def megabytes(value):
    return f"{value:.0f}"
