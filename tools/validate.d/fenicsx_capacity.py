"""tools/validate fenicsx_footing, fenicsx_wall: capacities by finite elements of dolfinx with RVEs in their points.

footing: `footing`, pack_medium, surcharge 100 kPa, to a settlement of a fifth of the width: rough over two meshes, and
smooth. Asked: the largest pressure lies between the formulas' by the angle at 15 % of strain and by that at the peak of
the same specimens. Beside it Mohr-Coulomb points on these meshes and two finer ones, which tell what the meshes do.

wall: `wall`, active and passive, smooth and rough. Asked: the extreme K lies between those of Coulomb's wedge (of
Rankine where the wall is smooth) by the same two angles, with the wall friction of the reactions.

    fenicsx_capacity.py RVELAB WORK RESULTS footing|wall"""
import re

import numpy as np

import harness
from fenicsx import COUNTS, case, number
from harness import bars, verdict, work


@bars
def judge_footing(runs, meshes):
    print("points  base    elements under half of it  largest pressure over the surcharge, at  by the angle at 15 %  "
          "at the peak  iterations an increment")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['elements']:26}  {each['largest']:35.2f} {each['at']:.3f}  "
              f"{each['low']:19.1f}  {each['high']:11.1f}  {each['iterations']:23.2f}")
    print("\nMohr-Coulomb points on the same meshes (fenicsx_soil.py): largest pressure over the formula's by their angle;\n"
          "mobilised: angle of the RVEs that shear by more than 10 % in the end\n"
          "points  base    angle at 15 %: degrees, without dilation, associated   mobilised: degrees, largest pressure "
          "without dilation, grains over it")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['phi']:22.1f} {each['plain'] / each['low']:17.2f} "
              f"{each['associated'] / each['low']:11.2f}   {each['mobilised']:18.1f} {each['as_mobilised']:35.2f} "
              f"{each['largest'] / each['as_mobilised']:16.2f}")
    for elements, plain, associated in meshes:
        print(f"{'':8}rough, {elements} elements {plain:20.2f} {associated:11.2f}")
    print()
    for each in runs.values():
        verdict(f"N_q, {each['base']} base, elements under half of it: {each['elements']}", f"{each['largest']:.2f}",
                f"{each['low']:.1f} to {each['high']:.1f}", each["low"] <= each["largest"] <= each["high"],
                abs(each["largest"] / each["as_mobilised"] - 1) <= 0.15,
                f"RVEs that shear by more than 10 % mobilise {each['mobilised']:.1f} degrees, not the {each['phi']:.1f} of "
                f"biaxial tests at 15 %; Mohr-Coulomb points of that angle without dilation carry "
                f"{each['as_mobilised']:.1f} on this mesh (of {each['phi']:.1f} degrees {each['plain']:.1f}: the mesh adds "
                f"{each['plain'] / each['low'] - 1:.0%}); the {1 - each['largest'] / each['as_mobilised']:.0%} that are left are not "
                "isolated")


def mobilised(folder):
    """Friction angle, degrees, of the points of a checkpoint that shear by more than 10 %, weighted by that strain."""
    with np.load(folder / "checkpoint/host.npz") as file:
        sigma, F = file["sigma"], file["F"]
    stretch = np.linalg.svd(F, compute_uv=False)
    shear = np.log(stretch[:, 0] / stretch[:, 1])
    low, high = np.linalg.eigvalsh(sigma).T  # tension positive
    weight = np.where(shear > 0.1, shear, 0)
    return np.degrees(np.arcsin(np.sum(weight * (high - low)) / np.sum(weight * -(high + low))))


def footing():
    runs = {}
    for base, elements in (("rough", 1), ("rough", 2), ("smooth", 2)):
        name, smooth = f"{base}_{elements}", ["--smooth"] if base == "smooth" else []
        curve, printed = case(name, "footing", "--grains", "100", "--to", "0.2", "--first", "4e-3", "--elements", elements,
                              "--keep", "1000000", *smooth)
        formula = re.search(r"by the formula ([\d.]+) by .* \(peak\), ([\d.]+) by ([\d.]+)", printed)
        high, low, phi = map(float, formula.groups())
        angle = mobilised(work / name)

        ratio = curve["pressure_ratio"]
        runs[name] = dict(base=base, elements=elements, largest=ratio.max(), at=curve["t"][ratio.argmax()], low=low,
                          high=high, phi=phi, plain=soil(elements, phi, 0, *smooth), mobilised=angle,
                          associated=soil(elements, phi, phi, *smooth), as_mobilised=soil(elements, angle, 0, *smooth),
                          **{key: number(each, printed) for key, each in COUNTS.items()})
    meshes = [[elements, soil(elements, phi, 0) / low, soil(elements, phi, phi) / low] for elements in (3, 4)]
    judge_footing(runs, meshes)


def soil(elements, phi, psi, *smooth):
    """Largest pressure over the surcharge of Mohr-Coulomb points of these angles, degrees."""
    found = case(f"soil_{elements}_{phi:.2f}_{psi:.2f}{''.join(smooth)}", f"{phi:.2f},{psi:.2f}", "--elements", elements,
                 "--to", "0.1", "--first", "4e-3", *smooth,
                 program=(harness.ROOT / "tools/validate.d/fenicsx_soil.py",))
    return found[0]["pressure_ratio"].max()


@bars
def judge_wall(runs):
    print("wall             extreme K, at   wall friction  Rankine at the peak, at 15 %  Coulomb at the peak, at 15 %  "
          "angles     points")
    for name, each in runs.items():
        print(f"{name.replace('_', ', '):15}  {each['extreme']:9.3f} {each['at']:.3f}  {each['delta']:13.1f}  "
              f"{each['rankine'][0]:19.3f} {each['rankine'][1]:8.3f}  {each['coulomb'][0]:19.3f} "
              f"{each['coulomb'][1]:8.3f}  {each['angles'][0]:.1f} {each['angles'][1]:.1f}  {each['points']:5.0f}")
    for name, each in runs.items():
        low, high = sorted(each["coulomb"])
        what = "Rankine" if each["delta"] == 0 else "Coulomb"
        verdict(f"K, {name.replace('_', ', ')}, beside {what}'s by the angles at 15 % and at the peak",
                f"{each['extreme']:.3f}", f"{low:.3f} to {high:.3f}", low <= each["extreme"] <= high)


def wall():
    runs = {}
    for side in ("active", "passive"):
        options = ["--to", "0.03"] if side == "active" else ["--to", "0.06", "--first", "2e-3", "--passive"]
        for base in ("smooth", "rough"):
            curve, printed = case(f"wall_{side}_{base}", "wall", "--grains", "100", "--elements", "4", *options,
                                  *(["--rough"] if base == "rough" else []))
            K = curve["K"]
            at = K.argmin() if side == "active" else K.argmax()

            def theory(name):
                rows = re.findall(r"([\d.]+) by ([\d.]+) degrees", re.search(f"{name} (.*)", printed).group(1))
                return np.array(rows, float).T
            runs[f"{side}_{base}"] = dict(extreme=K[at], at=curve["t"][at], delta=curve["wall_friction_deg"][at],
                                          rankine=theory("Rankine")[0], coulomb=theory("Coulomb")[0],
                                          angles=theory("Coulomb")[1], points=number(COUNTS["points"], printed))
    judge_wall(runs)


def main():
    {"footing": footing, "wall": wall}[harness.words[0]]()
    return False


if __name__ == "__main__":
    harness.main(main)
