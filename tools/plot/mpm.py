"""Figures of rvelab-mpm runs: fields of the material points at one time, a film of them, and histories.

    mpm.py RUN --field eps_q -o eps_q.png              # the last frame; --frame 3, --field void_ratio, velocity, ...
    mpm.py RUN --field eps_q --film -o film.gif        # all frames
    mpm.py RUN --energy -o energy.png                  # shares of energy
    mpm.py RUN... --force plate.force_y --against plate.displacement_y -o force.png    # any columns of history.csv
    mpm.py RUN --segregation -o segregation.png        # rocks ahead of the soil and above it, by classes of size
    mpm.py RUN --network 0 1 -o chains.png             # force chains of watched points (output.networks = true)

RUN is the folder that rvelab-mpm wrote. Points are drawn at their deformed positions, in their deformed shapes. Of saturated
soil also --field pore_pressure_Pa, excess_pore_pressure_Pa, pore_pressure_ratio, seepage. Rocks are drawn in grey, as the
ellipsoids that their axes span, terrain as a line through its heights, in space the lowest along y."""

import argparse
import functools
import pathlib
import tomllib

from records import STYLE, plt  # first: it names a missing package
import chains
import h5py
import numpy as np
import state as states
from matplotlib.collections import PolyCollection
from matplotlib.ticker import FuncFormatter

# Label, colours, and whether zero is in the middle of the scale.
FIELDS = {"eps_q": ("deviatoric strain $\\varepsilon_q$", "viridis", False),
          "eps_v": ("volumetric strain $\\varepsilon_v$, compression positive", "coolwarm", True),
          "void_ratio": ("void ratio $e$", "coolwarm", False),
          "rotation_deg": ("rotation (degrees, anticlockwise positive)", "RdBu_r", True),
          "fabric_anisotropy": ("fabric anisotropy $F_a$", "viridis", False),
          "velocity": ("speed (m/s)", "magma", False), "displacement": ("displacement (m)", "viridis", False),
          "p_Pa": ("mean pressure $p$ (kPa)", "viridis", False), "q_Pa": ("deviator $q$ (kPa)", "viridis", False),
          "plastic_strain": ("plastic strain", "viridis", False),
          "pore_pressure_Pa": ("pore pressure (kPa)", "Blues", False),
          "excess_pore_pressure_Pa": ("excess pore pressure (kPa)", "RdBu_r", True),
          "pore_pressure_ratio": ("excess pore pressure over $\\sigma'_{v0}$", "RdBu_r", True),
          "seepage": ("seepage (m/s)", "magma", False)}
# Where the name of a field is not that of the dataset.
DATASETS = {"velocity": "velocity_m_s", "displacement": "displacement_m", "seepage": "seepage_m_s"}


def frames_of(run):
    frames = sorted(pathlib.Path(run).glob("points_*.h5"))
    if not frames:
        raise ValueError(f"{run}: no points_*.h5 there; give the folder of a run of rvelab-mpm")
    return frames


def history_of(run):
    """Columns of history.csv by their names; an empty cell is nan."""
    path = pathlib.Path(run) / "history.csv"
    if not path.exists():
        raise ValueError(f"{run}: no history.csv there; give the folder of a run of rvelab-mpm")
    names = path.open().readline().strip().split(",")
    return dict(zip(names, np.atleast_2d(np.genfromtxt(path, delimiter=",", skip_header=1)).T))


def named(column):
    """Name of a column of history.csv and its unit as a label has it: plate.force_y_N is plate.force_y (N)."""
    for end, unit in (("_N_s", " (N s)"), ("_N", " (N)"), ("_J", " (J)"), ("_m", " (m)"), ("_s", " (s)")):
        if column.endswith(end):
            return column.removesuffix(end), unit
    return column, ""


def column_of(run, history, name):
    """The column of history.csv of that name, its unit at the end or left out."""
    found = [column for column in history if name in (column, named(column)[0])]
    if not found:
        raise ValueError(f"{run}: history.csv has no column {name}; it has " + ", ".join(history))
    return found[0]


def read(frame, field):
    """Time, corners of the points (n, 4, 2) and values; in space, the points as seen along y."""
    with h5py.File(frame, "r") as file:
        name = DATASETS.get(field, field)
        if name not in file:
            raise ValueError(f"{frame}: has no {field}; it is a measure of saturated soil, and the scene has no [fluid]")
        values = file[name][()]
        if values.ndim == 2:
            values = np.linalg.norm(values, axis=1)
        position, F = file["position_m"][()], file["deformation_gradient"][()].reshape(-1, 3, 3)
        volume = file["volume_m3"][()]
        first = position - file["displacement_m"][()]
        time = float(file["time_s"][0])
    axes = [0, 1] if np.all(position[:, 2] == 0) else [0, 2]
    # Sides of the points at the start, from the spacing of the whole ones; those cut at rocks are smaller by their volume, and
    # grains of a table are squares. Stretched ones are drawn no longer than three times that.
    d = 2 if axes == [0, 1] else 3
    at_start = volume / np.linalg.det(F[:, :d, :d])
    whole = at_start > 0.999 * at_start.max()
    positions = [np.unique(np.round(first[whole, a], 9)) for a in axes]
    lattice = np.mean(whole) > 0.1
    sides = [np.min(np.diff(x)) if lattice and len(x) > 1 else at_start.max() ** (1 / d)
             for x in positions]
    corner = 0.5 * np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * sides
    stretch = F[:, axes][:, :, axes]
    scale = np.minimum(1, 3 / np.maximum(np.linalg.norm(stretch, axis=(1, 2)) / 2**0.5, 1e-9))
    scale *= (at_start / at_start.max()) ** (1 / d)
    return time, position[:, None, axes] + np.einsum("nij,kj->nki", stretch * scale[:, None, None], corner), values


def size_of(box):
    """Inches: five wide, as high as the points and the label of the colours need."""
    width, height = box[:, 1] - box[:, 0]
    return (5, min(6, max(2.6, 0.9 + 4 * height / width))) if height < width else (4.2, 5)


def limits_of(frame, field, values):
    """Of the colours; one value everywhere gets a range of its own, which a film needs too."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        raise ValueError(f"{frame}: no point has {field}; it is a measure of other materials")
    low, high = np.percentile(finite, [1, 99])
    if FIELDS[field][2]:
        low, high = -max(abs(low), abs(high)), max(abs(low), abs(high))
    return (low, high) if low < high else (low - 1, high + 1)


def outlines_of_rocks(frame):
    """Closed curves (n, 49, 2) of the rocks of a frame, seen as the points are; none without rocks."""
    path = frame.with_name(frame.name.replace("points_", "rocks_"))
    if not path.exists():
        return np.zeros((0, 49, 2))
    with h5py.File(path, "r") as file:
        centre, axes = file["position_m"][()], file["turned_half_axes_m"][()].reshape(-1, 3, 3)
    with h5py.File(frame, "r") as file:
        plane = [0, 1] if np.all(file["position_m"][()][:, 2] == 0) and np.all(centre[:, 2] == 0) else [0, 2]
    # The outline of an ellipsoid A u, |u| = 1, seen along an axis, is that of the ellipse with the root of (A A^T) there.
    around = np.linspace(0, 2 * np.pi, 49)
    circle = np.stack([np.cos(around), np.sin(around)])
    seen = axes[:, plane] if plane == [0, 2] else axes[:, :2, :2]
    square = np.einsum("nik,njk->nij", seen, seen)
    return centre[:, None, plane] + np.einsum("nij,jk->nki", np.linalg.cholesky(square), circle)


@functools.cache
def ground_of(run):
    """Lines (x, heights) of the terrain of a run as it was at the start; in space the lowest along y. None without its
    scene."""
    path = run / "scene.toml"
    scene = tomllib.loads(path.read_text()) if path.exists() else {}
    lines = []
    for body in scene.get("body", []):
        if body["kind"] == "terrain":
            heights = np.min(body["heights_m"], axis=0) + body["centre_m"][-1]
            lines.append((body["centre_m"][0] + body["spacing_m"] * np.arange(len(heights)), heights))
    return lines


def draw(figure, frame, field, limits, box):
    time, corners, values = read(frame, field)
    label, colours, centred = FIELDS[field]
    axes = figure.add_subplot()
    axes.grid(False)
    if limits is None:
        limits = limits_of(frame, field, values)
    patches = PolyCollection(corners, array=values, cmap=colours, edgecolors="none")
    patches.set_clim(*limits)
    axes.add_collection(patches)
    axes.add_collection(PolyCollection(outlines_of_rocks(pathlib.Path(frame)), facecolors="0.75", edgecolors="0.2",
                                       linewidths=0.7))
    for x, heights in ground_of(pathlib.Path(frame).parent):
        axes.plot(x, heights, color="0.3", linewidth=1)
    axes.set_xlim(box[0])
    axes.set_ylim(box[1])
    axes.set_aspect("equal")
    axes.set_xlabel("x (m)")
    axes.set_ylabel("height (m)")
    axes.set_title(f"t = {time:.3g} s", fontsize=10)
    in_kPa = FuncFormatter(lambda value, _: f"{value / 1e3:g}") if field.endswith("_Pa") else None
    figure.colorbar(patches, label=label, shrink=0.9, aspect=14, format=in_kPa)


def box_of(frames, field):
    """What all the frames need."""
    low, high = [], []
    for frame in frames:
        corners = np.concatenate([read(frame, field)[1].reshape(-1, 2),
                                  outlines_of_rocks(pathlib.Path(frame)).reshape(-1, 2)])
        low.append(corners.min(axis=0))
        high.append(corners.max(axis=0))
    low, high = np.min(low, axis=0), np.max(high, axis=0)
    margin = 0.02 * (high - low)
    return np.stack([low - margin, high + margin]).T


def frame_of(frames, options):
    if not -len(frames) <= options.frame < len(frames):
        raise ValueError(f"--frame {options.frame}: {options.runs[0]} has {len(frames)} frames; allowed: 0 to "
                         f"{len(frames) - 1}, or -1 to {-len(frames)} from the end; give one of them")
    return frames[options.frame]


def field_figure(options):
    frames = frames_of(options.runs[0])
    if options.film:
        import film
        count = film.save(film.pictures_of_fields(options.runs[0], options.field, options.limits), options.output, 8)
        return f"{options.output}: {count} frames of {options.field}"
    frame = frame_of(frames, options)
    box = box_of([frame], options.field)
    figure = plt.figure(figsize=size_of(box))
    draw(figure, frame, options.field, options.limits, box)
    figure.savefig(options.output)
    return f"{options.output}: {options.field} of {frame.name}"


def energy_figure(options):
    figure, axes = plt.subplots(figsize=(5.5, 3.5))
    for run in options.runs:
        h = history_of(run)
        for name, label in (("kinetic_J", "kinetic"), ("potential_J", "potential, change"),
                            ("stress_work_J", "work of the stress"), ("mapping_loss_J", "lost in mapping"),
                            ("residual_J", "not accounted for")):
            axes.plot(h["time_s"], h[name], label=label if run == options.runs[0] else None)
    axes.set_xlabel("time (s)")
    axes.set_ylabel("energy (J)")
    axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
    figure.savefig(options.output, bbox_inches="tight")
    return f"{options.output}: energies of {', '.join(options.runs)}"


def force_figure(options):
    figure, axes = plt.subplots(figsize=(5.5, 3.5))
    curves = []
    for run in options.runs:
        h = history_of(run)
        x, y = (column_of(run, h, name) for name in (options.against, options.force))
        curves.append((h[x], h[y]))
    # A plate on its way down is drawn by its settlement, and the axis says so.
    (x_name, x_unit), (y_name, y_unit) = named(x), named(y)
    kilo = y_unit == " (N)"
    down = x_unit == " (m)" and max(along.max() for along, _ in curves) <= 0
    for run, (along, force) in zip(options.runs, curves):
        axes.plot(-along if down else along, force / 1e3 if kilo else force, label=pathlib.Path(run).name)
    axes.set_xlabel(("$-$" if down else "") + x_name + x_unit)
    axes.set_ylabel(y_name + (" (kN)" if kilo else y_unit))
    axes.legend()
    figure.savefig(options.output)
    return f"{options.output}: {y} against {x} of {', '.join(options.runs)}"


def network_figure(options):
    """Force chains of watched points side by side, in the laboratory frame: stretched and turned as the points are."""
    run, points = pathlib.Path(options.runs[0]), options.network
    frame = frame_of(frames_of(run), options).stem.removeprefix("points_")
    with h5py.File(run / f"points_{frame}.h5", "r") as file:
        time = float(file["time_s"][0])
    figure, all_axes = plt.subplots(1, len(points), figsize=(4.6 * len(points), 5), squeeze=False)
    told = []
    for axes, point in zip(all_axes[0], points):
        path = run / f"network_{point}_{frame}.h5"
        if not path.exists():
            raise ValueError(f"{path}: is not there; run the scene with output.networks = true, and give the numbers of "
                             "its output.watched_points_m, from 0")
        state = states.read_state(path)
        mean, strong = chains.draw_network(axes, state)
        axes.set_title(f"point {point} at {time:.3g} s, red above the mean of {mean:.3g} N", fontsize=10, loc="left")
        told.append(f"point {point}: {len(state.normal_force)} contacts, {strong} above the mean of {mean:.3g} N")
    figure.tight_layout()
    figure.savefig(options.output)
    return f"{options.output}: " + "; ".join(told)


def segregation_figure(options):
    import segregation
    return segregation.figure(options.runs[0], frames_of(options.runs[0]), options.output)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", help="folders of runs")
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument("--field", choices=sorted(FIELDS))
    what.add_argument("--energy", action="store_true")
    what.add_argument("--force", help="a column of history.csv: plate.force_y, or with its unit kinetic_J")
    what.add_argument("--segregation", action="store_true", help="mean positions of rocks minus that of the soil")
    what.add_argument("--network", type=int, nargs="+", help="numbers of watched points, from 0")
    parser.add_argument("--against", default="time", help="the same for the other axis: plate.displacement_y; default: time")
    parser.add_argument("--frame", type=int, default=-1, help="number of the frame; negative: from the end")
    parser.add_argument("--film", action="store_true", help="all frames, as GIF or MP4")
    parser.add_argument("--limits", type=float, nargs=2, metavar=("LOW", "HIGH"), help="of the colours; pressures in Pa")
    parser.add_argument("-o", "--output", required=True)
    options = parser.parse_args()
    try:
        if options.limits is not None and not options.limits[0] < options.limits[1]:
            raise ValueError("--limits {:g} {:g}: are no range; allowed: LOW below HIGH; exchange or correct them".format(
                *options.limits))
        with plt.rc_context(STYLE):
            draw_it = (energy_figure if options.energy else force_figure if options.force
                       else segregation_figure if options.segregation
                       else network_figure if options.network is not None else field_figure)
            print(draw_it(options))
    except ValueError as error:
        parser.error(" ".join(str(error).split()))
    except OSError as error:
        parser.error(f"{error.filename or options.output}: {error.strerror or error}; give a path in an existing folder")


if __name__ == "__main__":
    main()
