"""tools/validate fenicsx_footing, fenicsx_wall: capacities by finite elements of dolfinx with RVEs in their points.

footing: `footing`, pack_medium, surcharge 100 kPa, to a settlement of a fifth of the width: rough over two meshes, and
smooth. Asked: the largest pressure lies between the formulas' by the angle at 15 % of strain and by that at the peak of
the same specimens. Beside it Mohr-Coulomb points on these meshes and two finer ones. N_q is exact for associated flow, so
that associated points tell what the meshes do. Points without dilation carry less: as a guide N_q by Davis' (1968) reduced
angle, tan phi' = sin phi there (from memory).

wall: `wall`, active and passive, smooth and rough. Asked: the extreme K lies between those of Coulomb's wedge (of
Rankine where the wall is smooth) by the same two angles, with the wall friction of the reactions; K of the rough wall
over that of the smooth one lies between Coulomb's by both. The angles are means of each side's two runs, of which
both test the same specimens at nearly the same pressure.

    fenicsx_capacity.py RVELAB WORK RESULTS footing|wall"""
import re
import sys

import numpy as np

import harness
from fenicsx import COUNTS, case, number
from harness import bars, verdict, work

sys.path.insert(0, str(harness.ROOT / "tools/python"))
from rvelab.fenicsx.footing import n_q  # noqa: E402
from rvelab.fenicsx.wall import coulomb  # noqa: E402


@bars
def judge_footing(runs, meshes):
    print("points  base    elements under half of it  largest pressure over the surcharge, at  by the angle at 15 %  "
          "at the peak  iterations an increment")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['elements']:26}  {each['largest']:35.2f} {each['at']:.3f}  "
              f"{each['low']:19.1f}  {each['high']:11.1f}  {each['iterations']:23.2f}")
    phi = next(iter(runs.values()))["phi"]
    davis = np.degrees(np.arctan(np.sin(np.radians(phi))))
    exact, reduced = (n_q(np.radians(angle)) for angle in (phi, davis))
    print("\nMohr-Coulomb points on the same meshes (fenicsx_soil.py), to a settlement of 0.1 and of 0.2: largest pressure\n"
          "over the formula's by their angle. Associated: what the mesh adds, since the formula is exact for them. Without\n"
          f"dilation: N_q by Davis' angle of {davis:.1f} degrees is {reduced:.2f}, {reduced / exact:.2f} of that by {phi:.1f} degrees. "
          "Mobilised: angle of the RVEs that\nshear by more than 10 % at the end of their run (settlement 0.20, not at the largest "
          "pressure); pressure of points of it\nwithout dilation at the settlement of the grains' largest\n"
          "points  base    angle at 15 %: degrees, associated to 0.1, 0.2, without dilation to 0.1, 0.2   mobilised: degrees, "
          "pressure, grains over it")
    for each in runs.values():
        print(f"{each['points']:6.0f}  {each['base']:6}  {each['phi']:22.1f} "
              f"{each['associated'][0] / exact:18.2f} {each['associated'][1] / exact:4.2f} {each['plain'][0] / exact:24.2f} "
              f"{each['plain'][1] / exact:4.2f}   {each['mobilised']:18.1f} {each['as_mobilised']:9.2f} "
              f"{each['largest'] / each['as_mobilised']:16.2f}")
    for elements, plain, associated in meshes:
        print(f"{'':8}{f'rough, {elements} elements':<30}{associated[0] / exact:18.2f} {associated[1] / exact:4.2f} "
              f"{plain[0] / exact:24.2f} {plain[1] / exact:4.2f}")
    print()
    for each in runs.values():
        verdict(f"N_q, {each['base']} base, elements under half of it: {each['elements']}", f"{each['largest']:.2f}",
                f"{each['low']:.1f} to {each['high']:.1f}", each["low"] <= each["largest"] <= each["high"],
                reason=f"not isolated: at the end of the run RVEs that shear by more than 10 % mobilise {each['mobilised']:.1f} "
                f"degrees, not the {each['phi']:.1f} of biaxial tests at 15 %; Mohr-Coulomb points of that angle without dilation "
                f"carry {each['as_mobilised']:.1f} on this mesh at that settlement, "
                f"{each['as_mobilised'] / each['largest'] - 1:.0%} more than the grains")


def mobilised(folder):
    """Friction angle, degrees, of the points of the last checkpoint that shear by more than 10 %, weighted by that strain."""
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
        at = curve["t"][ratio.argmax()]
        runs[name] = dict(base=base, elements=elements, largest=ratio.max(), at=at, low=low,
                          high=high, phi=phi, plain=soil(elements, phi, 0, *smooth), mobilised=angle,
                          associated=soil(elements, phi, phi, *smooth), as_mobilised=soil(elements, angle, 0, *smooth, to=at)[0],
                          **{key: number(each, printed) for key, each in COUNTS.items()})
    meshes = [[elements, soil(elements, phi, 0), soil(elements, phi, phi)] for elements in (3, 4)]
    judge_footing(runs, meshes)


def soil(elements, phi, psi, *smooth, to=0.1):
    """Largest pressure over the surcharge of Mohr-Coulomb points of these angles, degrees, up to a settlement, and to 0.2."""
    curve, _ = case(f"soil_{elements}_{phi:.2f}_{psi:.2f}{''.join(smooth)}", f"{phi:.2f},{psi:.2f}", "--elements", elements,
                 "--to", "0.2", "--first", "4e-3", *smooth,
                 program=(harness.ROOT / "tools/validate.d/fenicsx_soil.py",))
    settlement, ratio = curve["t"], curve["pressure_ratio"]
    if settlement[-1] < 0.2 * (1 - 1e-9):
        sys.exit(f"soil of {phi:.2f}, {psi:.2f} degrees over {elements} elements ends at {settlement[-1]:.3f}")
    return ratio[settlement <= to * (1 + 1e-9)].max(), ratio.max()


@bars
def judge_wall(runs):
    print("wall             extreme K, at, at the end of the run   wall friction  angles of its tests: at the peak, at 15 %  "
          "Rankine, Coulomb by the means of the side at the peak, at 15 %  points")
    theory = {}
    for name, each in runs.items():
        side = name.split("_")[0]
        phi = np.radians(np.mean([runs[f"{side}_{base}"]["angles"] for base in ("smooth", "rough")], axis=0))
        rankine, theory[name] = (coulomb(phi, np.radians(delta), side == "passive") for delta in (0, each["delta"]))
        print(f"{name.replace('_', ', '):15}  {each['extreme']:9.3f} {each['at']:.3f}  {'yes' if each['last'] else 'no':>18}   "
              f"{each['delta']:13.1f}  {each['angles'][0]:30.1f} {each['angles'][1]:5.1f}  {rankine[0]:37.3f} {rankine[1]:.3f}, "
              f"{theory[name][0]:.3f} {theory[name][1]:.3f}  {each['points']:6.0f}")
    for name, each in runs.items():
        low, high = sorted(theory[name])
        what = "Rankine" if each["delta"] == 0 else "Coulomb"
        verdict(f"K, {name.replace('_', ', ')}, beside {what}'s by the angles at 15 % and at the peak",
                f"{each['extreme']:.3f}", f"{low:.3f} to {high:.3f}", low <= each["extreme"] <= high)
    for side in ("active", "passive"):
        smooth, rough = (runs[f"{side}_{base}"] for base in ("smooth", "rough"))
        found, (low, high) = rough["extreme"] / smooth["extreme"], sorted(theory[f"{side}_rough"] / theory[f"{side}_smooth"])
        verdict(f"K, {side}, rough over smooth, beside Coulomb's", f"{found:.3f}", f"{low:.3f} to {high:.3f}",
                low <= found <= high, reason="not isolated" + (
                    "; the smooth wall's K is that at the end of its run; where it goes on as before the ratio is further away"
                    if smooth["last"] else ""))


def wall():
    runs = {}
    for side in ("active", "passive"):
        options = ["--to", "0.03"] if side == "active" else ["--to", "0.06", "--first", "2e-3", "--passive"]
        for base in ("smooth", "rough"):
            curve, printed = case(f"wall_{side}_{base}", "wall", "--grains", "100", "--elements", "4", *options,
                                  *(["--rough"] if base == "rough" else []))
            K = curve["K"]
            at = K.argmin() if side == "active" else K.argmax()
            angles = re.findall(r"by ([\d.]+) degrees", re.search("Coulomb .*", printed).group())
            runs[f"{side}_{base}"] = dict(extreme=K[at], at=curve["t"][at], last=at == len(K) - 1,
                                          delta=curve["wall_friction_deg"][at], angles=list(map(float, angles)),
                                          points=number(COUNTS["points"], printed))
    judge_wall(runs)


def main():
    {"footing": footing, "wall": wall}[harness.words[0]]()
    return False


if __name__ == "__main__":
    harness.main(main)
