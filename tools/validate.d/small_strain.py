"""Stiffness at small strain against pressure by contact law: small_strain.py PROGRAM WORK RESULTS [SPECIMENS]

Specimens of pack_hertz, 500 grains with the moduli of glass, packed by each law at 50 kPa, compressed in doubling steps to 800 kPa; at each
pressure G0, the mean of the three shear stiffnesses of the network with every contact stuck (probe, method = "linear"). The
exponent n of G0 ~ p^n is that of a straight line through the logarithms.

By its contacts alone G0 goes with p^(1/3) for smooth spheres and with p^(1/2) for cones (Goddard 1990); for rough surfaces with
p^0.61 while asperities give way, p^0.37 in the transition, p^(1/3) beyond (Otsubo et al. 2017: 1 - 1/n of the force's exponents
2.59, 1.58, 3/2). A specimen is a little above, since contacts are gained, which `z` shows. Sands have 0.4 to 0.6."""

import json

import numpy as np

import harness
from harness import bars, in_turn, once, packed, sets, verdict, work

PRESSURES = [50e3, 100e3, 200e3, 400e3, 800e3]
LAWS = {  # name, settings
    "smooth": ("smooth spheres (Hertz)", ["contact.law=hertz_mindlin"]),
    "rough_01": ("rough, S_q = 0.1 um", ["contact.law=hertz_rough", "material.roughness_m=1e-7"]),
    "rough_03": ("rough, S_q = 0.3 um", ["contact.law=hertz_rough", "material.roughness_m=3e-7"]),
    "rough_1": ("rough, S_q = 1 um", ["contact.law=hertz_rough", "material.roughness_m=1e-6"]),
    "cones": ("cones of slope 0.02", ["contact.law=cones", "material.cone_slope=0.02"]),
}
GLASS = ["pack.number=500", "material.young_modulus_Pa=70e9", "target.pressure_Pa=50e3"]


def protocol():
    stages = ['[test]\nname = "small strain"\npressure_Pa = 50e3\n[[stage]]\nkind = "isotropic"\nshear = "zero_strain"\n']
    for k, pressure in enumerate(PRESSURES):
        if k > 0:
            stages.append(f'[[stage]]\nname = "to{k}"\nkind = "pressure_path"\nto_Pa = [{pressure}]\n')
        stages.append(f'[[stage]]\nname = "relax{k}"\nkind = "relax"\nunbalanced = 1e-7\nmax_steps = 1000000\n'
                      f'[[stage]]\nname = "probe{k}"\nkind = "probe"\nmethod = "linear"\n')
    path = work / "small_strain.toml"
    harness.write(path, "".join(stages))
    return path


def test(path, law, seed):
    """G0 (Pa) at each pressure, contacts a grain at each but the first, which has no record."""
    specimen = packed("pack_hertz", f"{law}_{seed}", f"pack.seed={seed}", *GLASS, *LAWS[law][1])
    found = work / f"{law}_{seed}.json"

    def run(out):
        out.write_text(json.dumps(harness.answer("run", path, "--specimen", specimen, "-o", work / f"R_{law}_{seed}.h5",
                                                 "--force")))
    once(found, path, make=run)
    answer = json.loads(found.read_text())
    stiffness = [np.reshape(answer[f"stiffness_Pa_probe{k}"], (6, 6)) for k in range(len(PRESSURES))]
    records = harness.records(work / f"R_{law}_{seed}.h5", "stage", "coordination_number")
    contacts = [records["coordination_number"][records["stage"] == stage][-1]
                for stage in sorted({int(s) for s in records["stage"]})]
    return [np.diag(c)[3:].mean() for c in stiffness], contacts


def exponents(modulus):
    """Of each doubling of the pressure."""
    return np.diff(np.log2(modulus))


@bars
def judge(moduli):
    """moduli: by law, by specimen, by pressure, Pa."""
    fitted = {law: [np.polyfit(np.log(PRESSURES), np.log(each), 1)[0] for each in rows] for law, rows in moduli.items()}
    mean = {law: float(np.mean(each)) for law, each in fitted.items()}
    rough = [mean[law] for law in ("rough_01", "rough_03", "rough_1")]
    at_first = {law: float(np.mean(rows, axis=0)[0]) for law, rows in moduli.items()}
    verdict("exponent of smooth spheres", f"{mean['smooth']:.3f}", "0.333 to 0.40", 0.333 <= mean["smooth"] <= 0.40)
    verdict("exponent of cones", f"{mean['cones']:.3f}", "0.50 to 0.57", 0.50 <= mean["cones"] <= 0.57)
    verdict("exponents of rough surfaces, 0.1, 0.3, 1 um", ", ".join(f"{n:.3f}" for n in rough),
            "growing with S_q, to 0.66", mean["smooth"] < rough[0] < rough[1] < rough[2] < 0.66)
    verdict("G0 at 50 kPa over that of smooth spheres, 0.1, 0.3, 1 um",
            ", ".join(f"{at_first[law] / at_first['smooth']:.2f}" for law in ("rough_01", "rough_03", "rough_1")),
            "falling with S_q", at_first["smooth"] > at_first["rough_01"] > at_first["rough_03"] > at_first["rough_1"])


def draw(moduli):
    plot = harness.pyplot()
    figure, axes = plot.subplots(figsize=(6, 4.5))
    for law, (name, _) in LAWS.items():
        axes.loglog(np.array(PRESSURES) / 1e3, np.mean(moduli[law], axis=0) / 1e6, "o-", label=name)
    reach = np.array([60.0, 600.0])
    for power, style in ((1 / 3, ":"), (1 / 2, "--")):
        axes.loglog(reach, 250 * (reach / reach[0]) ** power, "k" + style, linewidth=0.8, label=f"p^{power:.2g}")
    axes.set_xlabel("p, kPa")
    axes.set_ylabel("G0, MPa")
    axes.legend(fontsize=8)
    figure.tight_layout()
    figure.savefig(harness.results / "small_strain.png", dpi=110)


def main():
    seeds = range(1, 1 + int((harness.words or [3])[0]))
    tests = [(law, seed) for law in LAWS for seed in seeds]
    path = protocol()
    found = dict(zip(tests, in_turn(lambda each: test(path, *each), tests)))
    moduli = {law: [found[law, seed][0] for seed in seeds] for law in LAWS}
    print(f"{'law':24} {'':10}" + "".join(f"{p / 1e3:8.0f}" for p in PRESSURES) + "  kPa   exponent by a line")
    for law, (name, _) in LAWS.items():
        contacts = np.mean([found[law, seed][1] for seed in seeds], axis=0)
        mean = np.mean(moduli[law], axis=0)
        fitted = [np.polyfit(np.log(PRESSURES), np.log(each), 1)[0] for each in moduli[law]]
        print(f"{name:24} {'G0, MPa':10}" + "".join(f"{g / 1e6:8.1f}" for g in mean) +
              f"        {harness.in_words(fitted, digits=3)}")
        print(f"{'':24} {'exponent':10}{'':8}" + "".join(f"{n:8.3f}" for n in exponents(mean)))
        print(f"{'':24} {'z':10}{'':8}" + "".join(f"{z:8.2f}" for z in contacts))
    print()
    draw(moduli)
    judge(moduli)


if __name__ == "__main__":
    harness.main(main)
