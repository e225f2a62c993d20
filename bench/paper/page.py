# SPDX-License-Identifier: Apache-2.0
"""Pages in Markdown, and their plots."""
import os
import textwrap

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.ticker import FuncFormatter, LogLocator, NullLocator  # noqa: E402

# Text is written as text, not as outlines, and equal figures give files of equal bytes.
plt.rcParams.update(
    {
        "svg.fonttype": "none",
        "svg.hashsalt": "sac",
        "font.size": 9,
        "axes.grid": True,
        "axes.axisbelow": True,
        "grid.color": "#dddddd",
        "legend.frameon": False,
        "font.family": "sans-serif",
        "font.sans-serif": ["Helvetica", "Arial", "DejaVu Sans", "sans-serif"],
    }
)


def g(value, digits=4):
    """-> a value as tables show it, with a given number of digits"""
    if value is None:
        return "-"
    if isinstance(value, (int, str)):
        return str(value)
    text = f"{value:.{digits}g}"
    return f"{value:.0f}" if "e+" in text else text


class Page:
    """A page of docs/paper: a claim of the paper, whether it held, and the figures."""

    def __init__(self, directory, pictures, name, title):
        self.directory, self.pictures, self.name, self.title, self.verdict = directory, pictures, name, title, ""
        self.blocks = [f"# {title}"]

    def text(self, text):
        """Adds paragraphs, which empty lines separate in `text`."""
        self.blocks += [textwrap.fill(" ".join(paragraph.split()), 120) for paragraph in text.strip().split("\n\n")]

    def heading(self, text):
        self.blocks.append(f"## {text}")

    def claim(self, text, checks):
        """Adds a claim and its checks. A check is (a sentence, whether it is true as a bool or as the share of cases,
        the figures that show it)."""
        so = [float(check[1]) for check in checks]
        self.verdict = "held" if min(so) == 1 else "held in part" if max(so) > 0 else "did not hold"
        self.text(f"**The claim:** {text}")
        self.blocks.append(f"**Here it {self.verdict}:**")
        self.table(
            ["what would have to hold", "does it", "figures"],
            [[c[0], "yes" if x == 1 else "in part" if x > 0 else "no", c[2]] for c, x in zip(checks, so)],
            "lll",
        )

    def table(self, head, rows, align=None):
        """Adds a table. `align` has l or r for each column; by default the first is aligned left, the others right."""
        align = align or "l" + "r" * (len(head) - 1)
        lines = [head, ["---" if a == "l" else "--:" for a in align], *([g(c) for c in row] for row in rows)]
        self.blocks.append("\n".join("| " + " | ".join(line) + " |" for line in lines))

    def plot(self, draw, panels, caption, height=3.1):
        """Draws a picture and names it in the page. `draw` gets `panels` axes. The file is NAME.svg for the first
        picture of a page, NAME-2.svg for the second. Pictures are large and not kept with the pages."""
        before = sum(".svg`" in block for block in self.blocks)
        file = f"{self.name}-{before + 1}.svg" if before else f"{self.name}.svg"
        figure, axes = plt.subplots(1, panels, figsize=(9, height), squeeze=False)
        draw(*axes[0])
        for axis in (axis for a in axes[0] for axis in (a.xaxis, a.yaxis) if axis.get_scale() == "log"):
            low, high = axis.get_view_interval()
            axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 200 * low else (1,)))
            axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            axis.set_minor_locator(NullLocator())
        figure.tight_layout()
        figure.savefig(os.path.join(self.pictures, file), metadata={"Date": None}, facecolor="white")
        plt.close(figure)
        self.blocks.append(f"Picture `{file}`: {caption}.")

    def write(self):
        with open(os.path.join(self.directory, self.name + ".md"), "w") as f:
            f.write("\n\n".join(self.blocks) + "\n")


def curve(axes, points, x, y, label, style="o-", **more):
    """Draws a curve through points, which are results or (x, y) pairs."""
    pairs = sorted((p[x], p[y]) for p in points)
    axes.plot(*zip(*pairs), style, label=label, markersize=3.5, linewidth=1.2, **more)


def scales(axes, x_label, y_label, log_x=True, log_y=True):
    axes.set_xlabel(x_label)
    axes.set_ylabel(y_label)
    if log_x:
        axes.set_xscale("log")
    if log_y:
        axes.set_yscale("log")
