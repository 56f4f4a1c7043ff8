"""Curves of records: tests of one kind averaged over their specimens; colours, labels, legends, axes.

Tests are of one kind if group (folder), protocol, material, number of grains, pressure (within 3 %), void ratio at the
start (no gap above 0.02) and name of the stage are the same: they differ only by their specimen. A curve is their mean on
a common grid of strains, its band the standard deviation over the specimens. If pressures differ the colour shows the
pressure, dark to light, and the line style the group; otherwise the colour shows the difference.
"""

import dataclasses
from dataclasses import dataclass

import records  # first: it names a missing package
import matplotlib.pyplot as plt
import numpy as np
from matplotlib import ticker

QUALITATIVE = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#56b4e9", "#e69f00", "#000000")  # Okabe and Ito
DASHES = ("-", (0, (5, 2)), (0, (1, 1.2)), (0, (6, 2, 1, 2)), (0, (3, 1, 1, 1, 1, 1)))
VOID_RATIO_GAP, PRESSURE_GAP = 0.02, 0.03
GRID = 400  # points of a mean curve


@dataclass
class Curve:
    """Tests that differ only by their specimen."""

    stages: list
    colour: object
    dashes: object
    label: str
    rest: tuple  # what curves of one kind of tests at several pressures share

    @property
    def turns(self):
        return any(stage.cyclic for stage in self.stages)

    def mean(self, value, of=lambda stage: stage.strain):
        """Grid of strains, mean and standard deviation of value(stage) over the specimens; as far as all of them go."""
        if len(self.stages) == 1:
            x, y = of(self.stages[0]), value(self.stages[0])
            return x, y, np.zeros_like(y)
        columns = [(of(stage), value(stage)) for stage in self.stages]
        sign = -1 if np.mean([x[-1] - x[0] for x, _ in columns]) < 0 else 1
        begin, end = max((sign * x).min() for x, _ in columns), min((sign * x).max() for x, _ in columns)
        grid = np.linspace(begin, end, GRID)
        rows = []
        for x, y in columns:
            order = np.argsort(sign * x, kind="stable")
            rows.append(np.interp(grid, sign * x[order], y[order]))
        return sign * grid, np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1)

    def draw(self, axes, value, of=lambda stage: stage.strain, label=True, each=False, scale=(1, 1)):
        """Mean and band of value against of, both times scale; each test separately if strains reverse or on request."""
        label = self.label if label else None
        line = {"color": self.colour, "linestyle": self.dashes}
        if self.turns or each:
            for stage in self.stages:
                axes.plot(scale[0] * of(stage), scale[1] * value(stage), linewidth=0.8, alpha=0.8, label=label, **line)
                label = None
            return
        x, y, deviation = self.mean(value, of)
        axes.plot(scale[0] * x, scale[1] * y, label=label, **line)
        if len(self.stages) > 1:
            axes.fill_between(scale[0] * x, scale[1] * (y - deviation), scale[1] * (y + deviation), color=self.colour,
                              alpha=0.18, linewidth=0)


def joined(stages):
    """Stages of one file that go on driving the same strain as one stage, strains counted from the start of the first."""
    whole = []
    for stage in stages:
        last = whole[-1] if whole else None
        if last is None or (last.path, last.kind, last.axis, last.keys.get("lateral"), last.keys.get("normal")) != (
                stage.path, stage.kind, stage.axis, stage.keys.get("lateral"), stage.keys.get("normal")) or (
                last.drained and last.pressure != stage.pressure):
            whole.append(stage)
            continue
        end = last.deformation[-1]
        deformation = np.concatenate([last.deformation, stage.deformation @ end])
        if stage.kind == "compression":
            a = "xyz".index(stage.axis)
            strain = 1 - deformation[:, a, a]
        else:
            strain = np.concatenate([last.strain, last.strain[-1] + stage.strain])
        columns = {name: np.concatenate([last.columns[name], values]) for name, values in stage.columns.items()
                   if name in last.columns}
        whole[-1] = dataclasses.replace(
            last, name=f"{last.name}, {stage.name}", label=f"{last.label}, {stage.name}", strain=strain,
            stress=np.concatenate([last.stress, stage.stress]), deformation=deformation,
            held=np.concatenate([last.held, stage.held]), columns=columns, parts=last.parts + [len(last.strain)])
    return whole


def classes(values, gap):
    """The number of the class of each value, and the mean of each class: a class ends where the next value is more than
    gap above."""
    order = np.argsort(values, kind="stable")
    number, of = 0, np.zeros(len(values), int)
    for k in range(1, len(order)):
        number += values[order[k]] - values[order[k - 1]] > gap
        of[order[k]] = number
    return of, [float(np.mean(np.asarray(values)[of == k])) for k in range(number + 1)]


def first_void_ratio(stage):
    return float(stage.columns["void_ratio"][0]) if stage.has("void_ratio") else 0.0


def kinds_of(stages):
    """For each stage the five properties that distinguish kinds of tests, and their labels."""
    pressures = np.array([stage.pressure for stage in stages])
    logs = np.log(np.maximum(np.abs(pressures), 1e-300))
    of_pressure, means = classes(logs, PRESSURE_GAP)
    of_void, voids = classes([first_void_ratio(stage) for stage in stages], VOID_RATIO_GAP)
    # The void ratio falls with the pressure of a test: it distinguishes specimens only at equal pressure.
    for k in range(len(means)):
        here = np.flatnonzero(of_pressure == k)
        own, _ = classes([first_void_ratio(stages[row]) for row in here], VOID_RATIO_GAP)
        of_void[here] = own
    keys = [(stage.origin.group, (stage.origin.settings, stage.origin.material, stage.origin.grains), int(pressure),
             int(void), stage.name) for stage, pressure, void in zip(stages, of_pressure, of_void)]
    return keys, np.exp(means)


def curves_of(stages, colour_by="auto"):
    """One Curve for each kind of test, by pressure, then in the order given."""
    keys, pressures = kinds_of(stages)
    kinds = list(dict.fromkeys(keys))
    kinds.sort(key=lambda kind: kind[2])
    varies = {name: len({kind[k] for kind in kinds}) > 1
              for k, name in enumerate(("group", "settings", "pressure", "void", "stage"))}
    by_pressure = varies["pressure"] and (colour_by == "pressure" or colour_by == "auto" and not varies["group"])
    rest = list(dict.fromkeys(rest_of(kind) for kind in sorted(kinds, key=keys.index)))
    shades = plt.get_cmap("viridis")(np.linspace(0.05, 0.85, len(pressures)))
    steps = sorted({kind[2] for kind in kinds})
    curves = []
    for kind, label in zip(kinds, labels_of(kinds, stages, keys, varies, pressures)):
        members = [stage for stage, key in zip(stages, keys) if key == kind]
        place, step = rest.index(rest_of(kind)), steps.index(kind[2])
        colour = shades[kind[2]] if by_pressure else QUALITATIVE[place % len(QUALITATIVE)]
        dashes = DASHES[(place if by_pressure else step) % len(DASHES)]
        curves.append(Curve(members, colour, dashes, label, rest_of(kind)))
    return curves


def rest_of(kind):
    """A kind of tests at all its pressures."""
    return kind[:2] + kind[3:]


def labels_of(kinds, stages, keys, varies, pressures):
    """For each kind the label of its curve, and its number of specimens."""
    labels, files = [], []
    for kind in kinds:
        members = [stage for stage, key in zip(stages, keys) if key == kind]
        words = [kind[0]] if varies["group"] else []
        if varies["pressure"] or not any(varies[name] for name in ("group", "stage", "void")):
            carried = pressures[kind[2]] > 1e-6  # Pa; a gas at a rate begins without contacts
            words.append(f"{records.plain(pressures[kind[2]] / 1e3)} kPa" if carried else "no pressure at the start")
        if varies["stage"]:
            words.append(members[0].name)
        if varies["void"]:
            words.append(f"$e_0$ = {np.mean([first_void_ratio(stage) for stage in members]):.3f}")
        labels.append(", ".join(words))
        files.append(list(dict.fromkeys(stage.path for stage in members)))
    # Tests of different settings or materials with equal labels have the name of their first file as label.
    told = [f"{own[0].stem}, {label}" if labels.count(label) > 1 else label for label, own in zip(labels, files)]
    return [label + (f" (n = {len(own)})" if len(own) > 1 else "") for label, own in zip(told, files)]


def legend(axes, title=None):
    """Outside of the curves, at the upper right; none for a single curve that needs no name."""
    handles, labels = axes.get_legend_handles_labels()
    if handles:
        axes.legend(loc="upper left", bbox_to_anchor=(1.01, 1.02), fontsize=8, title=title, title_fontsize=8,
                    alignment="left", ncols=1 + len(handles) // 25)


def band_in_words(curves):
    """Title of a legend: what a band is; None where there is none."""
    several = any(len(curve.stages) > 1 and not curve.turns for curve in curves)
    return "mean and standard deviation\nof n specimens" if several else None


def log_axis(axis, values):
    """A logarithmic axis that accepts zeros and negative values (they are not drawn), and shows numbers within a decade."""
    values = np.asarray(values, float)
    values = values[np.isfinite(values) & (values > 0)]
    if len(values) == 0:
        raise ValueError("no value above 0 for a logarithmic axis; give records with a pressure above 0")
    low, high = float(values.min()), float(values.max())
    if high < 1.05 * low:
        return  # a single point needs no logarithm
    axis._set_axes_scale("log", nonpositive="mask")
    # Half of a tenth of the span beside the values.
    room = (high / low) ** 0.05
    (axis.axes.set_xlim if axis.axis_name == "x" else axis.axes.set_ylim)(low / room, high * room)
    axis.set_major_locator(ticker.LogLocator(base=10, subs=ticks_of_decade(low / room, high * room), numticks=30))
    axis.set_minor_locator(ticker.LogLocator(base=10, subs=np.arange(1, 10), numticks=30))
    axis.set_major_formatter(ticker.FuncFormatter(lambda value, _: f"{value:g}"))
    axis.set_minor_formatter(ticker.NullFormatter())


def ticks_of_decade(low, high):
    """Multiples of a power of ten that make four numbers or more between low and high, the fewest that do."""
    finest = [1.0]
    for finest in ((1.0,), (1.0, 3.0), (1.0, 2.0, 5.0), (1.0, 2.0, 3.0, 5.0, 7.0), tuple(np.arange(1.0, 10.0)),
                   tuple(np.arange(1.0, 10.0, 0.5)), tuple(np.arange(1.0, 10.0, 0.2)), tuple(np.arange(1.0, 10.0, 0.1))):
        powers = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1)
        ticks = np.outer(powers, finest)
        if np.sum((ticks >= low) & (ticks <= high)) >= 4:
            break
    return finest


def least_span(axes, axis, least):
    """Widens an axis that would show round-off or a tolerance, and writes its numbers in full."""
    low, high = axes.get_xlim() if axis == "x" else axes.get_ylim()
    if high - low < least:
        (axes.set_xlim if axis == "x" else axes.set_ylim)(0.5 * (low + high - least), 0.5 * (low + high + least))
    axes.ticklabel_format(axis=axis, useOffset=False)


def length_unit(size):
    """Factor and name of the unit in which a specimen of this size, m, has numbers between 1 and 1000."""
    for factor, name in ((1, "m"), (1e3, "mm"), (1e6, "µm")):
        if size * factor >= 1:
            return factor, name
    return 1e9, "nm"


def add_options(parser, output):
    """Common options of the figures of curves."""
    parser.add_argument("records", nargs="+", help="record files, or folders of them")
    parser.add_argument("-o", "--output", default=output, help="figure to write (PNG, PDF or SVG)")
    parser.add_argument("--colour", choices=["auto", "pressure", "group"], default="auto",
                        help="what the colour goes with; a group is a folder")
    parser.add_argument("--each", action="store_true", help="draw every specimen instead of mean and band")
