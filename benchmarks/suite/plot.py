"""Log-log plots as SVG that is the same for the same numbers."""

import dataclasses


@dataclasses.dataclass
class Series:
    name: str
    x: list
    y: list
    dashed: bool = False
    like: str = ""  # has the colour of the series of this name


@dataclasses.dataclass
class Panel:
    title: str
    x_title: str
    y_title: str
    series: list


def number(value, _=None):
    return f"{value:g}"


def between(value, _=None):
    """Labels of 2 and 5 times a power of ten."""
    return number(value) if f"{value:e}"[0] in "25" else ""


def wide(low, high):
    """At least a power of ten, so that flat curves look flat."""
    grow = max(1.0, (10.0 / (high / low)) ** 0.5)
    return low / grow, high * grow


def draw(panel, axes, colours):
    import matplotlib.ticker as ticker

    for series in panel.series:
        points = [(x, y) for x, y in zip(series.x, series.y) if x and y and x > 0 and y > 0]
        colour = colours.setdefault(series.like or series.name, f"C{len(colours) % 10}")
        axes.plot(
            [p[0] for p in points],
            [p[1] for p in points],
            "--" if series.dashed else "-",
            color=colour,
            marker="o",
            markersize=3.5,
            linewidth=1.3,
            label=series.name,
        )
    axes.set(xscale="log", yscale="log", title=panel.title, xlabel=panel.x_title, ylabel=panel.y_title)
    axes.grid(True, which="major", linewidth=0.6, alpha=0.6)
    axes.grid(True, which="minor", linewidth=0.3, alpha=0.4)
    axes.set_xlim(wide(*axes.get_xlim()))
    axes.set_ylim(wide(*axes.get_ylim()))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_major_formatter(ticker.FuncFormatter(number))
        axis.set_minor_formatter(ticker.NullFormatter())
        low, high = axis.get_view_interval()
        if high / low < 100:  # few powers of ten: label between them, too
            axis.set_minor_formatter(ticker.FuncFormatter(between))


def write(file, panels, columns=2):
    """One picture of the panels; a series has the same colour in all of them."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams.update(
        {
            "svg.hashsalt": "atrium",
            "svg.fonttype": "path",
            "font.size": 8.5,
            "axes.titlesize": 9.5,
            "legend.fontsize": 7.5,
        }
    )
    from matplotlib import pyplot

    rows = -(-len(panels) // columns)
    figure, grid = pyplot.subplots(rows, columns, figsize=(4.9 * columns, 3.7 * rows), squeeze=False)
    colours = {}
    for axes, panel in zip(grid.flat, panels):
        draw(panel, axes, colours)
        if len(panel.series) > 1:
            axes.legend(framealpha=0.8)
    for axes in list(grid.flat)[len(panels) :]:
        axes.set_visible(False)
    figure.tight_layout()
    file.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(file, metadata={"Date": None, "Creator": None})
    pyplot.close(figure)
