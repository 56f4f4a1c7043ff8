"""Drained biaxial compression at three points of a macro mesh, each an RVE, by preCICE and its Micro Manager.

    export RVELAB_SPECIMEN=S.h5              # a specimen of discs (rvelab pack)
    python3 macro.py &                       # in this folder
    micro-manager-precice micro-manager-config.json

A macro code in miniature: it compresses its points along y, one slower than the other, and finds the strain along x that
holds sigma_xx. That is an iteration in each time window: the first participant writes dH, the RVEs return the stress,
and preCICE takes both back to the start of the window until sigma_x changes by less than precice-config.xml allows.
biaxial.csv has the increments that were accepted, and their stresses."""
import csv

import numpy as np
import precice

MESH, LATERAL = "macro-mesh", -100e3  # Pa, tension positive: the stress that is held
AXIAL = np.array([-1e-4, -2e-4, -3e-4])  # increment of dH_yy in each window, by point

participant = precice.Participant("Macro", "precice-config.xml", 0, 1)
points = participant.set_mesh_vertices(MESH, np.array([[0.5, 0.5], [1.5, 0.5], [2.5, 0.5]]))
participant.initialize()

lateral = -0.5 * AXIAL  # increment of dH_xx: a guess
stiffness = np.full(len(AXIAL), 3e7)  # Pa, of sigma_xx against dH_xx: a guess, then by secants
tried = None  # lateral increment and stress of the iteration before
rows = []
while participant.is_coupling_ongoing():
    if participant.requires_writing_checkpoint():
        tried = None  # a new window; this code's own state is its rows, which only accepted windows add to
    dt = participant.get_max_time_step_size()
    none = np.zeros(len(AXIAL))
    participant.write_data(MESH, "dH_x", points, np.column_stack([lateral, none]))
    participant.write_data(MESH, "dH_y", points, np.column_stack([none, AXIAL]))
    participant.advance(dt)
    repeated = participant.requires_reading_checkpoint()
    # Back at the start of the window the new stresses are those of its end, else those of now.
    when = participant.get_max_time_step_size() if repeated else 0.0
    sigma = np.stack([participant.read_data(MESH, "sigma_" + axis, points, when) for axis in "xy"], axis=1)
    if not repeated:
        rows += [(len(rows) // len(AXIAL) + 1, k, lateral[k], AXIAL[k], sigma[k, 0, 0], sigma[k, 1, 1])
                 for k in range(len(AXIAL))]
        continue
    stress = sigma[:, 0, 0]
    if tried is not None:
        with np.errstate(divide="ignore", invalid="ignore"):
            secant = (stress - tried[1]) / (lateral - tried[0])
        stiffness = np.where(np.isfinite(secant), np.clip(secant, 1e6, 1e9), stiffness)
    tried = lateral, stress
    lateral = lateral + (LATERAL - stress) / stiffness
participant.finalize()

with open("biaxial.csv", "w", newline="") as file:
    writer = csv.writer(file)
    writer.writerow(("window", "point", "dH_xx", "dH_yy", "sigma_xx", "sigma_yy"))
    writer.writerows((*row[:2], *(repr(float(value)) for value in row[2:])) for row in rows)
for window, k, _, _, sigma_xx, sigma_yy in rows[-len(AXIAL):]:
    print(f"window {window}, point {k}: sigma_xx {sigma_xx / 1e3:.1f} kPa, sigma_yy {sigma_yy / 1e3:.1f} kPa")
