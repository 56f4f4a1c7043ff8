"""Liquid bridges: the table of the laboratory's law, and how well laws of bridges meet the Young-Laplace equation.

    capillary.py PROGRAM WORK RESULTS table rvelab/interaction/bridge_table.hpp   writes the table (half a minute)
    capillary.py PROGRAM WORK RESULTS rows tests/data/interaction/bridges.csv     exact bridges off the table's points, for the test
    capillary.py PROGRAM WORK RESULTS compare [ROWS.csv ...]                      errors of the laws; ROWS as tests/data/interaction/young_laplace.csv

The table holds, of bridges of given volume, rupture gap over V^(1/3), force over 1 - gap/h and suction times h, h the height of
the toroid's meniscus; of bridges of given suction, rupture gap over h, force and volume over h^2. Each is a series of
Chebyshev polynomials in (size of the bridge)^(1/4), contact angle, unlikeness of radii, sqrt(1 - gap/rupture)."""
import csv
import pathlib
import sys

import numpy as np

import harness
from young_laplace import bridge, chebyshev_points, contact_guess, curves, pi, sampled, solve

chebyshev = np.polynomial.chebyshev.chebvander
UNIT = 1e-7                       # of the integers in the table
STEPS = np.array([0, .02, .05, .1, .2, .3, .4, .5, .6, .7, .8, .85, .9, .95, .97, .99, 1])


def value_of(kind, size, theta, a):
    """Volume over R^3, or suction times R/gamma, of a size: V^(1/3)/R1, or gamma cos(theta)/(S R1), R1 the smaller radius."""
    return (size / (1 + a)) ** 3 if kind == "volume" else np.cos(theta) * (1 + a) / size


def in_contact(kind, sizes, theta, a):
    """Bridges at gap 0, for ascending sizes, each from the one before."""
    p = {"theta": theta, "a": a}

    def at(y, v):
        y = y.copy()
        if kind == "suction":
            y[1] = v

        def residual(y):
            g1, g2, s, w = bridge(y, p)
            return np.stack([g1, g2, w / v - 1, s / np.sqrt(v)] if kind == "volume" else [g1, g2, s * v])
        return solve(y, p, [0, 1, 2, 3] if kind == "volume" else [0, 2, 3], residual, 15)

    now = 1e-4 if kind == "volume" else 1e-6
    v = value_of(kind, now, theta, a)
    y, bad = at(contact_guess(2 * v / pi if kind == "volume" else (2 * np.cos(theta) / v) ** 2, theta, a), v)
    found, last = [], None
    for size in sizes:
        n = max(1, int(np.ceil(abs(np.log(size / now)) / 0.25)))
        for k in range(n):
            new = now * (size / now) ** (1 / (n - k))
            if last is None:
                guess = y * (new / now) ** np.array((.75, -1.5, 1.5, 1.5) if kind == "volume" else (.5, -1, 1, 1))[:, None]
            else:
                guess = y + (y - last[0]) / np.log(now / last[1]) * np.log(new / now)
            guess[0] = np.where(guess[0] > 0, guess[0], y[0])
            before = (y, now)
            y, bad = at(guess, value_of(kind, new, theta, a))
            last, now = before, new
        if np.max(bad) > 1e-9:
            sys.exit(f"capillary: no bridge in contact of {kind} size {size:g}: residual {np.max(bad):g}")
        found.append(y)
    return found


def solved(kind, sizes, theta, a, t):
    """value, theta, a, energy, force, other, rupture: one row for each size and pair of (theta, a)."""
    if kind == "volume":   # equal spheres above 31 degrees tilt before the symmetric bridge folds: a trace of unlikeness
        a = np.where((theta > 0.5) & (a < 1e-3), 1e-3, a)
    y = in_contact(kind, sizes, theta, a)
    m = len(sizes)
    v = np.concatenate([value_of(kind, size, theta, a) for size in sizes])
    c = curves(v, np.tile(theta, m), np.tile(a, m), np.concatenate(y, 1), kind)
    return (v, np.tile(theta, m), np.tile(a, m)) + sampled(c, t)


def ratios(kind, v, theta, t, force, other, rupture):
    """What the table holds."""
    if kind == "volume":
        s = rupture[:, None] * (1 - t * t)
        h = np.sqrt(s * s + (2 * v / pi)[:, None])
        return rupture / np.cbrt(v), force / (1 - s / h), other * h
    h = 2 * np.cos(theta) / v
    return rupture / h, force, other / (h * h)[:, None]


class Panel:
    def __init__(self, name, kind, sizes, angles, shape, least):
        self.name, self.kind, self.shape, self.least = name, kind, shape, least
        self.low, self.high = (size ** 0.25 for size in sizes)
        self.first, self.last = np.radians(angles)

    def unlike(self, a):
        return np.sqrt(a) if self.kind == "volume" else a

    def fit(self):
        u = [(chebyshev_points(n) + 1) / 2 for n in self.shape]
        sizes = (self.low + (self.high - self.low) * u[0][::-1]) ** 4
        theta, a = (x.ravel() for x in np.meshgrid(self.first + (self.last - self.first) * u[1],
                                                   u[2] ** 2 if self.kind == "volume" else u[2], indexing="ij"))
        v, th, _, _, force, other, rupture = solved(self.kind, sizes, theta, a, u[3])
        self.series = []
        for f, least in zip(ratios(self.kind, v, th, u[3], force, other, rupture), self.least):
            f = f.reshape(self.shape[:3] + f.shape[1:])[::-1]
            for axis in range(f.ndim):
                n = f.shape[axis]
                f = np.moveaxis(np.tensordot(np.linalg.inv(chebyshev(chebyshev_points(n), n - 1)), f, (1, axis)), 0, axis)
            if f.ndim == 3:
                f = f[..., None]
            self.series.append(np.round(np.where(np.abs(f) > least, f, 0) / UNIT).astype(int))
        return self

    def at(self, size, theta, a, t):
        where = (2 * (min(max(size ** 0.25, self.low), self.high) - self.low) / (self.high - self.low) - 1,
                 2 * (theta - self.first) / (self.last - self.first) - 1, 2 * self.unlike(a) - 1)
        values = []
        for f in self.series:
            f = f * UNIT
            for x in where:
                f = np.tensordot(chebyshev(np.array([x]), f.shape[0] - 1)[0], f, (0, 0))
            values.append(chebyshev(2 * np.asarray(t) - 1, len(f) - 1) @ f)
        return values


def panels():
    return [Panel("wetting", "volume", (1e-3, 0.1 ** (1 / 3)), (0, 30), (10, 6, 7, 16), (1e-6, 3e-5, 3e-5)),
            Panel("poorly_wetting", "volume", (1e-2, 0.1 ** (1 / 3)), (30, 45), (8, 5, 8, 14), (1e-5, 3e-4, 3e-4)),
            Panel("suction", "suction", (3e-5, 0.3), (0, 45), (9, 6, 6, 12), (1e-6, 1e-6, 1e-6))]


def wrapped(numbers, indent="    ", width=118):
    lines, line = [], indent
    for n in numbers:
        text = f"{n},"
        if len(line) + len(text) > width:
            lines.append(line)
            line = indent
        line += text
    return "\n".join(lines + [line])


def write_table(path):
    out = ["// Made by tools/validate.d/capillary.py table; what it holds stands there and in capillary.hpp.", "#pragma once", "",
           "namespace rvelab::interaction::bridge_table {", "", "// clang-format off",
           "struct Series { int points; const unsigned char* length; const int* coefficient; };",
           "struct Panel { double low, high, first_angle, last_angle; int sizes, angles, radii; Series rupture, force, other; };", ""]
    for panel in panels():
        panel.fit()
        names = []
        for what, f in zip(("rupture", "force", "other"), panel.series):
            rows = f.reshape(-1, f.shape[-1])
            lengths = [int(np.max(np.nonzero(r)[0])) + 1 if np.any(r) else 0 for r in rows]
            name = f"{panel.name}_{what}"
            out += [f"inline constexpr unsigned char {name}_length[] = {{", wrapped(lengths), "};",
                    f"inline constexpr int {name}[] = {{", wrapped(c for r, n in zip(rows, lengths) for c in r[:n]), "};"]
            names.append(f"{{{f.shape[-1]}, {name}_length, {name}}}")
        nu, nth, na, _ = panel.shape
        out += [f"inline constexpr Panel {panel.name} = {{{panel.low:.17g}, {panel.high:.17g}, {panel.first:.17g}, {panel.last:.17g}, "
                f"{nu}, {nth}, {na},", "    " + ", ".join(names) + "};", ""]
    out += [f"inline constexpr double unit = {UNIT:g};", "// clang-format on", "", "}  // namespace rvelab::interaction::bridge_table", ""]
    pathlib.Path(path).write_text("\n".join(out))


# Laws of the literature, radius R = 2 R1 R2/(R1 + R2) = 1, force over 2 pi gamma.

def willett(gap, v, theta):
    """Willett, Adams, Johnson and Seville 2000, Langmuir 16, 9396: the fit of their appendix; below 50 degrees, V < 0.1."""
    L, q = np.log(v), theta
    f1 = ((-0.44507 + 0.050832 * q - 1.1466 * q**2) + (-0.1119 - 0.000411 * q - 0.1490 * q**2) * L
          + (-0.012101 - 0.0036456 * q - 0.01255 * q**2) * L**2 + (-0.0005 - 0.0003505 * q - 0.00029076 * q**2) * L**3)
    f2 = ((1.9222 - 0.57473 * q - 1.2918 * q**2) + (-0.0668 - 0.1201 * q - 0.22574 * q**2) * L
          + (-0.0013375 - 0.0068988 * q - 0.01137 * q**2) * L**2)
    f3 = ((1.268 - 0.01396 * q - 0.23566 * q**2) + (0.198 + 0.092 * q - 0.06418 * q**2) * L
          + (0.02232 + 0.02238 * q - 0.009853 * q**2) * L**2 + (0.0008585 + 0.001318 * q - 0.00053 * q**2) * L**3)
    f4 = ((-0.010703 + 0.073776 * q - 0.34742 * q**2) + (0.03345 + 0.04543 * q - 0.09056 * q**2) * L
          + (0.0018574 + 0.004456 * q - 0.006257 * q**2) * L**2)
    s = np.log(np.maximum(gap, 1e-12) / 2 / np.sqrt(v))
    return np.exp(f1 - f2 * np.exp(f3 * s + f4 * s * s))


def willett_short(gap, v, theta):
    """Willett et al. 2000, eq. 12."""
    s = gap / 2 / np.sqrt(v)
    return np.cos(theta) / (1 + 2.1 * s + 10 * s * s)


def rabinovich(gap, v, theta, surface_term=False):
    """Rabinovich, Esayanur and Moudgil 2005, Langmuir 21, 10992, eq. 19 and its d_sp."""
    gap = np.maximum(gap, 1e-12)
    root = np.sqrt(1 + 2 * v / (pi * gap * gap)) - 1
    force = np.cos(theta) / (1 + 1 / root)
    if surface_term:
        alpha = np.sqrt(gap * root)
        force = force + np.sin(alpha) * np.sin(theta + alpha)
    return force


def table_force(all_panels):
    def law(gap, v, theta, a):
        panel = all_panels[0] if theta <= all_panels[0].last else all_panels[1]
        rupture = panel.at(np.cbrt(v) * (1 + a), theta, a, [0.0])[0][0] * np.cbrt(v)
        if gap > rupture:
            return 0.0
        t = np.sqrt(1 - gap / rupture)
        return panel.at(np.cbrt(v) * (1 + a), theta, a, [t])[1][0] * (1 - gap / np.sqrt(gap * gap + 2 * v / pi))
    return law


def exact_rows(count, seed, most_angle):
    rng, rows = np.random.default_rng(seed), []
    for _ in range(count):
        theta = rng.uniform(0, np.radians(most_angle), 8)
        a = np.where(rng.uniform(size=8) < 0.3, 0, rng.uniform(size=8))
        size = np.sort(np.exp(rng.uniform(np.log(1e-2), np.log(0.1) / 3, 2)))
        v, th, aa, energy, force, suction, rupture = solved("volume", size, theta, a, STEPS)
        rows += [dict(v=v[i], theta=th[i], a=aa[i], rupture=rupture[i], gap=rupture[i] * (1 - STEPS**2), energy=energy[i],
                      force=force[i], suction=suction[i]) for i in range(len(v))]
    return rows


def oracle_rows(path):
    groups = {}
    for r in csv.DictReader(open(path)):
        groups.setdefault((r["volume"], r["radius_2"], r["contact_angle_deg"]), []).append((float(r["gap"]), float(r["force"])))
    rows = []
    for (v, r2, angle), pairs in groups.items():
        r2 = float(r2)
        R = 2 * r2 / (1 + r2)
        gap, force = np.array(pairs).T
        rows.append(dict(v=float(v) / R**3, theta=np.radians(float(angle)), a=(r2 - 1) / (r2 + 1), gap=np.maximum(gap, 0) / R,
                         force=force / (2 * pi * R)))
    return rows


def report(title, rows, laws, exact):
    print(f"\n{title}: {sum(len(r['gap']) for r in rows)} bridges; error of the force over the exact force at that gap, per cent")
    print(f"{'law':36}{'median':>10}{'90 %':>10}{'largest':>10}   {'gap < 0.8 of rupture: median':>30}{'largest':>10}")
    for name, law in laws.items():
        error, early = [], []
        for r in rows:
            f = np.array([law(g, r["v"], r["theta"], r["a"]) for g in r["gap"]])
            e = np.abs(f / r["force"] - 1) * 100
            error.append(e)
            early.append(e[r["gap"] < 0.8 * r.get("rupture", np.max(r["gap"]))])
        error, early = np.concatenate(error), np.concatenate(early)
        print(f"{name:36}{np.median(error):10.3g}{np.quantile(error, 0.9):10.3g}{np.max(error):10.3g}   "
              f"{np.median(early):30.3g}{np.max(early):10.3g}")
    if not exact:
        return
    print(f"{'rupture gap':36}{'median':>10}{'':10}{'largest':>10}")
    lian = lambda v, theta: (1 + theta / 2) * np.cbrt(v)
    ruptures = {"Lian et al. 1993": lambda r: lian(r["v"], r["theta"]),
                "Willett et al. 2000": lambda r: lian(r["v"], r["theta"]) * (1 + np.cbrt(r["v"]) / 10),
                "table": lambda r: exact[0 if r["theta"] <= exact[0].last else 1].at(
                    np.cbrt(r["v"]) * (1 + r["a"]), r["theta"], r["a"], [0.0])[0][0] * np.cbrt(r["v"])}
    for name, gap in ruptures.items():
        e = np.array([abs(gap(r) / r["rupture"] - 1) * 100 for r in rows])
        print(f"{name:36}{np.median(e):10.3g}{'':10}{np.max(e):10.3g}")


def compare(paths):
    made = [panel.fit() for panel in panels()]
    laws = {"Willett et al. 2000, fit": lambda g, v, th, a: willett(g, v, th),
            "Willett et al. 2000, eq. 12": lambda g, v, th, a: willett_short(g, v, th),
            "Rabinovich et al. 2005": lambda g, v, th, a: rabinovich(g, v, th),
            "Rabinovich et al. 2005, both terms": lambda g, v, th, a: rabinovich(g, v, th, True),
            "table": table_force(made)}
    for path in paths:
        report(pathlib.Path(path).name, oracle_rows(path), laws, None)
    report("contact angles 0 to 30 degrees, off the table's points", exact_rows(8, 11, 30), laws, made)
    rows = [r for r in exact_rows(12, 12, 45) if r["theta"] > np.radians(30)]
    report("contact angles 30 to 45 degrees, off the table's points", rows, laws, made)
    rng = np.random.default_rng(13)
    panel, errors = made[2], []
    for _ in range(6):
        theta, a = rng.uniform(0, panel.last, 8), np.where(rng.uniform(size=8) < 0.3, 0, rng.uniform(size=8))
        size = np.sort(np.exp(rng.uniform(np.log(1e-4), np.log(0.3), 2)))
        v, th, aa, _, force, other, rupture = solved("suction", size, theta, a, STEPS)
        for i in range(len(v)):
            exact = ratios("suction", v[i:i + 1], th[i], STEPS, force[i:i + 1], other[i:i + 1], rupture[i:i + 1])
            found = panel.at(np.cos(th[i]) * (1 + aa[i]) / v[i], th[i], aa[i], STEPS)
            errors.append([abs(found[0][0] / exact[0][0] - 1), np.median(abs(found[1] / exact[1][0] - 1)), np.max(abs(found[1] / exact[1][0] - 1)),
                           np.max(abs(found[2] / exact[2][0] - 1))])
    e = np.array(errors) * 100
    print(f"\ngiven suction, contact angles 0 to 45 degrees, {e.shape[0] * len(STEPS)} bridges; largest errors of the table, per cent")
    print(f"rupture gap {np.max(e[:, 0]):.2g}, force {np.max(e[:, 2]):.2g} (median {np.median(e[:, 1]):.2g}), volume {np.max(e[:, 3]):.2g}")


def write_rows(path):
    """For R1 = 1, gamma = 1: volumes off the table's points, then suctions."""
    rng = np.random.default_rng(5)
    with open(path, "w") as f:
        f.write("held,radius_2,contact_angle,volume,gap,suction,force,energy,rupture_gap\n")
        for kind, most in (("volume", 30), ("volume", 45), ("suction", 45)):
            for k in range(3):
                theta = rng.uniform(0 if most != 45 or kind == "suction" else np.radians(32), np.radians(most), 2)
                a = np.array([0.0, rng.uniform(0.1, 0.9)])
                size = np.exp(rng.uniform(np.log(2e-2), np.log(0.4 if kind == "volume" else 0.3), 1))
                t = np.array([1.0, 0.95, 0.8, 0.6, 0.4, 0.2])
                v, th, aa, energy, force, other, rupture = solved(kind, size, theta, a, t)
                for i in range(len(v)):
                    r2, R = (1 + aa[i]) / (1 - aa[i]), 1 + aa[i]
                    for j in range(len(t)):
                        volume, suction = (v[i], other[i, j]) if kind == "volume" else (other[i, j], v[i])
                        row = [r2, th[i], volume * R**3, rupture[i] * (1 - t[j] ** 2) * R, suction / R, force[i, j] * 2 * pi * R,
                               energy[i, j] * 2 * pi * R * R, rupture[i] * R]
                        f.write(kind + "," + ",".join(f"{x:.9g}" for x in row) + "\n")


def main():
    kind, *paths = harness.words or [""]
    if kind in ("table", "rows") and len(paths) == 1:
        (write_table if kind == "table" else write_rows)(paths[0])
    elif kind == "compare":
        compare(paths)
    else:
        sys.exit("capillary: give table FILE, rows FILE or compare [ROWS.csv ...]\n" + __doc__)


if __name__ == "__main__":
    harness.main(main)
