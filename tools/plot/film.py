#!/usr/bin/env python3
"""A film of grains and force chains, or of fields: film.py R.h5|RUN -o film.mp4 (or film.gif).

Of a record file, its snapshots (run the test with --set output.snapshots_every=10) and its end: grains and force chains
(--field chains), grains coloured by their mean stress (--field p), or bonds and cracks (--field bonds, drawn as by
bonds.py), and below q/p against the strain of the stage with the state of the frame marked. Of a folder that rvelab-mpm
wrote, any field of its material points (--field eps_q, ...).
MP4 (H.264) is made by ffmpeg, GIF by Pillow; without -o MP4 if ffmpeg is installed.
"""

import argparse
import pathlib
import shutil
import subprocess

import records  # first: it names a missing package
import bonds
import chains
import state as states
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PatchCollection

FIELDS = ("chains", "p", "bonds")  # of grains


def picture_of(figure):
    """Pixels (height, width, 3) of a figure; both even, as H.264 requires."""
    figure.canvas.draw()
    pixels = np.asarray(figure.canvas.buffer_rgba())[:, :, :3]
    plt.close(figure)
    return np.ascontiguousarray(pixels[:pixels.shape[0] // 2 * 2, :pixels.shape[1] // 2 * 2])


def save(pictures, output, fps):
    """Writes pictures of one size, as MP4 or GIF by the name of the output; how many."""
    kind = pathlib.Path(output).suffix.lower()
    if not pathlib.Path(output).resolve().parent.is_dir():
        raise ValueError(f"{output}: its folder is not there; give a path in an existing folder")
    if kind == ".gif":
        return save_gif(pictures, output, fps)
    if kind != ".mp4":
        raise ValueError(f"{output}: no film; allowed: *.mp4, *.gif; give one of these names")
    if shutil.which("ffmpeg") is None:
        raise ValueError(f"{output}: MP4 needs ffmpeg, which is not installed; apt-get install ffmpeg, or give *.gif")
    return save_mp4(pictures, output, fps)


def save_gif(pictures, output, fps):
    try:
        from PIL import Image
    except ModuleNotFoundError as missing:
        raise ValueError(f"{output}: GIF needs Pillow; apt-get install python3-pil, or give *.mp4") from missing
    # By coverage: a median cut of colours drops those of a few thin lines.
    made = [Image.fromarray(picture).quantize(64, Image.Quantize.MAXCOVERAGE) for picture in pictures]
    made[0].save(output, save_all=True, append_images=made[1:], duration=int(1000 / fps), loop=0, optimize=True)
    return len(made)


def save_mp4(pictures, output, fps):
    pictures = iter(pictures)
    first = next(pictures)
    size = f"{first.shape[1]}x{first.shape[0]}"
    with subprocess.Popen(
            ["ffmpeg", "-loglevel", "error", "-y", "-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", size,
             "-framerate", str(fps), "-i", "-", "-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "23", "-movflags",
             "+faststart", str(output)], stdin=subprocess.PIPE, stderr=subprocess.PIPE) as encoder:
        count = 0
        try:
            for picture in (first, *pictures):
                encoder.stdin.write(picture.tobytes())
                count += 1
            encoder.stdin.close()
        except BrokenPipeError:
            pass
        told = encoder.stderr.read().decode(errors="replace").strip()
    if encoder.returncode != 0:
        raise ValueError(f"{output}: ffmpeg could not write it ({told.splitlines()[-1] if told else 'no message'}); give "
                         "another folder, or *.gif")
    return count


def box_of(found):
    """Limits of both axes, m, that contain the cell and the grains of every state."""
    corners = np.concatenate([chains.outline_of(state) for state in found])
    room = max(state.mean_diameter for state in found)
    return np.stack([corners.min(axis=0) - room, corners.max(axis=0) + room])


def draw_pressures(axes, state, largest):
    """Grains coloured by their mean stress; the mappable of the colours."""
    scale, unit = chains.unit_of(state)
    rows = np.flatnonzero(chains.in_slab(state, state.position))
    if state.dimension == 3:
        rows = rows[np.argsort(-state.position[rows, 1])]
    p = np.trace(state.grain_stress, axis1=1, axis2=2)[rows] / state.dimension / 1e3
    grains = PatchCollection(chains.patches_of(state, scale, rows), cmap="magma_r", edgecolor="0.5", linewidth=0.3)
    grains.set_array(p)
    grains.set_clim(0, largest / 1e3)
    axes.grid(False)
    axes.add_collection(grains)
    outline = np.append(chains.outline_of(state), chains.outline_of(state)[:1], axis=0) * scale
    axes.plot(*outline.T, "k--", linewidth=1.0)
    axes.set_aspect("equal")
    axes.set_xlabel(f"x ({unit})")
    axes.set_ylabel(f"{'xyz'[state.dimension - 1]} ({unit})")
    return grains


def largest_pressure(found):
    """Pa: of 99 in 100 grains over all states."""
    return float(np.percentile([np.trace(stress) / state.dimension for state in found for stress in state.grain_stress], 99))


def mark_state(axes, stages, state):
    """q/p against the driving strain of the stage that the state is of, and where in it the state is."""
    for stage in stages:
        here = state.record - stage.first_record
        if not 0 <= here < len(stage.strain):
            continue
        axes.plot(100 * stage.strain, stage.mobilised(), color="0.4", linewidth=1.0)
        axes.plot(100 * stage.strain[here], stage.mobilised()[here], "o", color=chains.STRONG, markersize=6)
        axes.set_xlabel(stage.strain_in_words())
    axes.set_ylabel("$q/p$")
    axes.set_ylim(bottom=0)


def pictures_of_grains(path, field):
    """Pictures of the states of a record file (of a specimen file one)."""
    found = states.every_state(path)
    if len(found) > 1 and found[-1].record == found[-2].record:
        found.pop()
    if len(found) < 2:
        raise ValueError(f"{path}: holds one state and no snapshots; run the test with --set output.snapshots_every=10")
    if field == "bonds":
        found = [state for state in found if len(state.bonds.broken)]  # those after the cement
        if not found:
            raise ValueError(f"{path}: holds no bonds; run a test with a [[stage]] of kind = \"cement\"")
    stages = records.stages_of(path)
    box, largest = box_of(found), largest_pressure(found)
    scale, _ = chains.unit_of(found[0])
    width, height = box[1] - box[0]
    for state in found:
        figure = plt.figure(figsize=(6, min(9, 1.9 + 5 * height / width)), dpi=110, layout="constrained")
        above, below = figure.subplots(2, 1, height_ratios=(max(2.0, 4.5 * height / width), 1))
        if field == "chains":
            mean, _ = chains.draw_network(above, state)
            above.set_title(f"normal forces, mean {chains.force_in_words(mean)}", fontsize=9, loc="left")
        elif field == "bonds":
            bonds.draw_bonds(above, state)
            intact, tension, shear = bonds.counts(state)
            above.set_title(f"bonds: {intact} intact (grey), {tension} broken in tension (red), {shear} in shear (blue)", fontsize=9, loc="left")
        else:
            figure.colorbar(draw_pressures(above, state, largest), ax=above, label="mean stress of the grain (kPa)")
        above.set_xlim(*scale * box[:, 0])
        above.set_ylim(*scale * box[:, 1])
        mark_state(below, stages, state)
        yield picture_of(figure)


def pictures_of_fields(run, field, limits=None):
    """Pictures of the frames of rvelab-mpm in one scale of colours, wide enough for all of them."""
    import mpm
    if field not in mpm.FIELDS:
        raise ValueError(f"--field {field}: {run} is a run of rvelab-mpm; allowed: {', '.join(sorted(mpm.FIELDS))}; give one")
    frames = mpm.frames_of(run)
    some = frames[:: max(1, len(frames) // 8)] + frames[-1:]
    box = mpm.box_of(some, field)
    if limits is None:
        each = np.array([mpm.limits_of(frame, field, mpm.read(frame, field)[2]) for frame in some[1:]])
        limits = each[:, 0].min(), each[:, 1].max()
    for frame in frames:
        figure = plt.figure(figsize=mpm.size_of(box), layout="constrained")
        mpm.draw(figure, frame, field, limits, box)
        yield picture_of(figure)


def read(paths):
    if len(paths) != 1:
        raise ValueError(f"{' '.join(paths)}: one film at a time; give one record file or one folder of rvelab-mpm")
    return paths[0]


def draw(path, options):
    output = options.output or ("film.mp4" if shutil.which("ffmpeg") else "film.gif")
    if pathlib.Path(path).is_dir():
        field = "eps_q" if options.field == "chains" else options.field
        count = save(pictures_of_fields(path, field), output, options.fps)
        return f"{output}: {count} frames of {field}"
    if options.field not in FIELDS:
        raise ValueError(f"--field {options.field}: {path} is a record file; allowed: {', '.join(FIELDS)}; give one of them")
    count = save(pictures_of_grains(path, options.field), output, options.fps)
    return f"{output}: {count} frames of {options.field}"


def between_1_and_60(text):
    if not 1 <= float(text) <= 60:
        raise argparse.ArgumentTypeError(f"{text}: no rate of a film; allowed: 1 to 60")
    return float(text)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(prog="film.py", description=__doc__.splitlines()[0])
    parser.add_argument("records", nargs="+", metavar="R.h5|RUN", help="record file, or folder of rvelab-mpm")
    parser.add_argument("-o", "--output", help="film to write, *.mp4 or *.gif")
    parser.add_argument("--field", default="chains", help="chains (default), p, bonds; of rvelab-mpm eps_q (default), ...")
    parser.add_argument("--fps", type=between_1_and_60, default=10, help="frames a second, default 10")
    records.run(draw, parser, read=read)
