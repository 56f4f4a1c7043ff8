#!/usr/bin/python3
"""Simple shear of one RVE at constant volume, increment by increment, as in a continuum code.

    element_test.py SPECIMEN.h5 [GAMMA]

Prints gamma, shear stress and normal stress across the shear plane, p in Pa, and the fabric anisotropy. The stresses
are those of `rvelab run` on a protocol with the stage kind = "simple_shear", to_strain = GAMMA, record_every = 1e-4,
bit for bit: the program and a continuum code drive the same RVE."""
import sys
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))  # of a checkout; PYTHONPATH comes first
import rvelab


def shear(specimen: str, gamma: float, step: float = 1e-4) -> np.ndarray:
    """Stress (n, 3, 3), Pa, tension positive, after 0, step, 2 step, ... gamma."""
    rve = rvelab.Rve(specimen)
    along, normal = (0, 1) if rve.dimension == 2 else (0, 2)
    stresses = [rve.apply(np.zeros((3, 3)))]
    deformation = np.eye(3)
    for k in range(1, round(gamma / step) + 1):
        dH = np.zeros((3, 3))  # F_inc - I, so that F_inc F has the shear wanted
        dH[along, normal] = k * step - deformation[along, normal]
        stresses.append(rve.apply(dH))
        deformation = (np.eye(3) + dH) @ deformation
        if k % 10 == 0:
            sigma = stresses[-1]
            print(f"{k * step:.4f} {sigma[along, normal]:10.1f} {sigma[normal, normal]:10.1f} {rve.p:10.1f} "
                  f"{rve.fabric_anisotropy:.4f}")
    return np.array(stresses)


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit("element_test.py SPECIMEN.h5 [GAMMA]")
    shear(sys.argv[1], float(sys.argv[2]) if len(sys.argv) > 2 else 0.005)
