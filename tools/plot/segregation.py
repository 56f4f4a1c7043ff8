"""Rocks of a run of rvelab-mpm against the soil around them: means over the frames, a part of tools/plot/mpm.py."""

import pathlib

from records import plt  # first: it names a missing package
import curves as kinds
import h5py
import numpy as np


def classes_of(radius):
    """Names and members of at most two classes of size, of like numbers: one where the largest is within a fifth of the
    smallest."""
    if radius.max() < 1.2 * radius.min():
        return {f"rocks, {2e3 * radius.mean():.3g} mm": np.ones(len(radius), bool)}
    small = radius < np.median(radius)
    if not small.any():  # half of them are the smallest
        small = radius <= radius.min()
    return {f"{name}, {2e3 * radius[each].mean():.3g} mm": each
            for name, each in (("smaller rocks", small), ("larger rocks", ~small))}


def means_of(frames):
    """Times (s), and for each class the mean position (m) minus that of the soil, by mass."""
    times, means = [], {}
    for frame in frames:
        path = frame.with_name(frame.name.replace("points_", "rocks_"))
        if not path.exists():
            raise ValueError(f"{path}: is not there; segregation is of runs with [[rock]] or [[rocks]]")
        with h5py.File(path, "r") as file:
            place, radius, mass = (file[name][()] for name in ("position_m", "radius_m", "mass_kg"))
            times.append(float(file["time_s"][0]))
        with h5py.File(frame, "r") as file:
            soil, F = file["position_m"][()], file["deformation_gradient"][()].reshape(-1, 3, 3)
            volume = file["volume_m3"][()]
        if len(soil) == 0:
            raise ValueError(f"{frame}: has no soil that rocks could part from; segregation is of runs with [[region]]")
        # By the volumes at the start, which are as their masses in soil of one density.
        d = 2 if np.all(soil[:, 2] == 0) else 3
        middle = np.average(soil, axis=0, weights=volume / np.linalg.det(F[:, :d, :d]))
        for name, members in classes_of(radius).items():
            means.setdefault(name, []).append(np.average(place[members], axis=0, weights=mass[members]) - middle)
    return np.array(times), {name: np.array(each) for name, each in means.items()}


def figure(run, frames, output):
    times, means = means_of(frames)
    up = 2 if any(np.any(each[:, 2] != 0) for each in means.values()) else 1
    canvas, panels = plt.subplots(1, 2, figsize=(8.6, 3.6), sharex=True)
    for axes, axis, label in zip(panels, (0, up), ("ahead of the soil", "above the soil")):
        scale, unit = kinds.length_unit(max(np.abs(each[:, axis]).max() for each in means.values()) or 1)
        axes.axhline(0, color="0.6", linewidth=0.8)
        for name, each in means.items():
            axes.plot(times, scale * each[:, axis], label=name)
        axes.locator_params(axis="x", nbins=6)
        axes.set_xlabel("time (s)")
        axes.set_ylabel(f"mean place, {label} ({unit})")
    handles, labels = panels[0].get_legend_handles_labels()
    canvas.tight_layout(rect=(0, 0, 1, 0.92))
    canvas.legend(handles, labels, loc="upper center", ncols=2, frameon=False)
    canvas.savefig(output)
    last = "; ".join(f"{name}: {of_length(each[-1, 0])} along x, {of_length(each[-1, up])} up" for name, each in means.items())
    return f"{output}: {pathlib.Path(run).name}, {last}"


def of_length(value):
    scale, unit = kinds.length_unit(abs(value) or 1)
    return f"{scale * value:+.3g} {unit}"
