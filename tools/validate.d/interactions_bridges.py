"""Bridges of water between two spheres, rvelab beside YADE's ViscElCap laws: for tools/validate interactions_peers."""
import pathlib

import numpy as np

import interactions_packing as packings
from harness import verdict

YADE = pathlib.Path(__file__).with_name("interactions_bridges_yade.py")
SURFACE_TENSION = 0.0728
PAIR = """
[contact]
law = "linear_stiffness"
[[material]]
name = "heavy"                # moved by the cell alone
density_kg_m3 = 1e20
normal_stiffness_N_m = 1e3
tangential_stiffness_N_m = 1e3
friction = 0.3
"""
WATER = """
[test]
name = "water"
dimension = 3
[loading]
mode = "quasi_static"
[[stage]]
kind = "water"
volume_ratio = {volume}
contact_angle_deg = {angle}
surface_tension_N_m = {tension}
"""
# radii, volume over the cube of the smaller, contact angle; the error that capillary.txt has of Willett's fit: 3.2 % at most
CASES = [((1e-3, 1e-3), 1e-3, 0), ((1e-3, 1e-3), 1e-2, 20), ((1e-3, 2e-3), 1e-3, 0), ((1e-3, 2e-3), 1e-2, 20)]
LAWS = ["Willett_numeric", "Willett_analytic", "Rabinovich", "Lambert", "Weigert"]


def pulls(program, folder, radii, volume, angle, gaps):
    """Of rvelab: two spheres that touch and get water, then are moved apart with their cell; its stress is the force."""
    (first, second), edge = radii, 10 * max(radii)
    overlap = 1e-6 * min(radii)
    (folder / "pair.csv").write_text(f"id,x,y,z,r\n0,{-0.5 * (first + second)!r},0,0,{first!r}\n"
                                     f"1,{0.5 * (first + second) - overlap!r},0,0,{second!r}\n")
    (folder / "pair.toml").write_text(PAIR)
    (folder / "water.toml").write_text(WATER.format(volume=volume, angle=angle, tension=SURFACE_TENSION))
    packings.run([program, "import", folder / "pair.csv", "--cell", f"{edge},{edge},{edge}", "--material",
                  folder / "pair.toml", "-o", folder / "pair.h5", "--force"])
    packings.run([program, "run", folder / "water.toml", "--specimen", folder / "pair.h5", "-o", folder / "wet.h5",
                  "--force"])
    rve, found = packings.rvelab.Rve(str(folder / "wet.h5")), []

    def length():
        x = rve.array("grains/position_m")
        return x[1, 0] - x[0, 0]

    for gap in gaps:
        rve.apply(np.diag([(first + second + gap) / length() - 1, 0, 0]), 1e-6)
        found.append(rve.stress[0, 0] * np.linalg.det(rve.lattice) / length())
    return np.array(found)


def bridges(program, folder):
    print("\nBridges of given volume between two spheres: YADE's force over rvelab's to 0.8 of the rupture gap, and the gap at "
          "which it ruptures\n")
    for radii, volume, angle in CASES:
        small = min(radii)
        rupture = (1 + 0.5 * np.radians(angle)) * (volume * small**3) ** (1 / 3)
        gaps = np.r_[1e-5 * small, np.linspace(0.02, 1.6, 80) * rupture]
        job = {"radii": radii, "volume": volume * small**3, "angle_deg": angle, "surface_tension": SURFACE_TENSION,
               "laws": LAWS, "gaps": gaps.tolist()}
        own = pulls(program, folder, radii, volume, angle, gaps)
        end = gaps[own > 1e-9 * own[0]][-1]
        before = gaps < 0.8 * end
        for law, force in packings.in_yade(YADE, folder, job).items():
            force = np.array(force)
            error, last = np.abs(force[before] / own[before] - 1), gaps[force > 0][-1]
            name = f"radii 1:{max(radii) / small:g}, V = {volume:g} r^3, {angle} degrees: {law}"
            text = f"{100 * np.median(error):.1f} %, {100 * error.max():.1f} %"
            if law == "Willett_numeric":
                verdict(name, text, "3.2 % at most", error.max() < 0.032, width=64)
            else:
                print(f"{name:64} {text:22} -")
            if law == LAWS[0]:
                print(f"{'    ruptures at':64} {last / small:.4f} r; rvelab {end / small:.4f} r")
