"""A case of the benchmark: case.toml with its tables, read and checked. The format is described in README.md.

Standard library alone: YADE's Python reads it too.
"""
import csv
import math
import os
import tomllib
from dataclasses import dataclass

COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")
PLACES = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
STRESSES = tuple(f"sigma_{name}_Pa" for name in COMPONENTS)
STRAINS = ("eps_xx", "eps_yy", "eps_zz")

LAWS = {"linear": ("young_modulus_Pa", "stiffness_ratio"), "hertz_mindlin": ("young_modulus_Pa", "poisson_ratio")}
OF_ANY_LAW = ("kind", "density_kg_m3", "friction", "rolling_stiffness", "rolling_friction", "restitution")


class CaseError(Exception):
    """What is wrong with a file of a case, where, and what to do."""


@dataclass
class Grain:
    x: tuple
    r: float


@dataclass
class Leg:
    gradient: list     # F - I at its end, from where the leg before ended
    records: int
    held_Pa: dict      # {"xx": stress}: normal stresses that are held instead of their strain


@dataclass
class Specimen:
    file: str
    cell: tuple
    grains: list


class Case:
    """Attributes by the names of the file: title, dimension, law (a table), rate_1_s (0: quasi-static), legs, specimens."""

    def __init__(self, folder):
        self.folder = folder
        self.path = os.path.join(folder, "case.toml")
        try:
            with open(self.path, "rb") as file:
                found = tomllib.load(file)
        except FileNotFoundError:
            raise CaseError(f"{self.path}: no such file; a case is a folder with case.toml, see README.md") from None
        except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
            raise CaseError(f"{self.path}: not TOML: {error}") from None
        top = self._table(found, "", {"case": dict, "law": dict, "path": dict, "specimen": list, "reference": dict})
        about = self._table(top["case"], "case", {"title": str, "dimension": int, "sentence": str})
        self.name = os.path.basename(os.path.abspath(folder))
        self.title, self.dimension, self.sentence = about["title"], about["dimension"], about["sentence"]
        if self.dimension not in (2, 3):
            self._wrong("case.dimension", self.dimension, "2 (discs) or 3 (spheres)")
        self._read_law(top["law"])
        self._read_path(top["path"])
        self._read_reference(top["reference"])
        self.specimens = [self._specimen(one, k) for k, one in enumerate(top["specimen"])]
        if not self.specimens:
            self._wrong("specimen", "an empty list", "one table [[specimen]] at least")

    def _wrong(self, key, value, allowed):
        raise CaseError(f"{self.path}: {key} is {value}; allowed: {allowed}")

    def _table(self, found, name, keys, optional=()):
        """`found` with exactly these keys, {key: type}; float takes whole numbers too."""
        dot = name + "." if name else ""
        for key in found:
            if key not in keys:
                raise CaseError(f"{self.path}: unknown key {dot}{key}; known: {', '.join(dot + k for k in keys)}")
        for key, kind in keys.items():
            if key not in found:
                if key in optional:
                    continue
                raise CaseError(f"{self.path}: {dot}{key} is missing; see README.md for what it means")
            kinds = (int, float) if kind is float else (kind,)
            if not isinstance(found[key], kinds) or isinstance(found[key], bool):
                self._wrong(dot + key, repr(found[key]), {str: "a text", int: "a whole number", float: "a number",
                                                          dict: "a table", list: "a list"}[kind])
            if kind is float and not math.isfinite(found[key]):
                self._wrong(dot + key, found[key], "a finite number")
        return found

    def _read_law(self, found):
        kind = found.get("kind")
        if kind not in LAWS:
            self._wrong("law.kind", repr(kind), " or ".join(LAWS))
        keys = {key: float for key in (*LAWS[kind], *OF_ANY_LAW[1:])}
        optional = ("rolling_stiffness", "rolling_friction", "restitution")
        law = self._table(found, "law", {"kind": str, **keys}, optional)
        for key in ("young_modulus_Pa", "density_kg_m3"):
            if law[key] <= 0:
                self._wrong("law." + key, law[key], "above 0")
        for key in ("stiffness_ratio", "friction", "rolling_stiffness", "rolling_friction"):
            if law.get(key, 0) < 0:
                self._wrong("law." + key, law[key], "0 or more")
        if not -1 < law.get("poisson_ratio", 0) <= 0.5:
            self._wrong("law.poisson_ratio", law["poisson_ratio"], "above -1 to 0.5")
        if ("rolling_stiffness" in law) != ("rolling_friction" in law):
            raise CaseError(f"{self.path}: law.rolling_stiffness and law.rolling_friction belong together: give both or none")
        if not 0 < law.get("restitution", 1) <= 1:
            self._wrong("law.restitution", law["restitution"], "above 0 to 1")
        self.law = law
        self.rolling = "rolling_stiffness" in law

    def _read_path(self, found):
        found = self._table(found, "path", {"rate_1_s": float, "leg": list})
        self.rate = float(found["rate_1_s"])
        if self.rate < 0:
            self._wrong("path.rate_1_s", self.rate, "0 (quasi-static) or above")
        self.legs = []
        for k, one in enumerate(found["leg"]):
            name, d = f"path.leg[{k}]", self.dimension
            one = self._table(one, name, {"gradient": list, "records": int, "held_Pa": dict}, ("held_Pa",))
            g = one["gradient"]
            if len(g) != d or any(not isinstance(row, list) or len(row) != d or
                                  not all(isinstance(v, (int, float)) and math.isfinite(v) for v in row) for row in g):
                self._wrong(name + ".gradient", g, f"{d} rows of {d} numbers, F - I at the end of the leg")
            if one["records"] < 1:
                self._wrong(name + ".records", one["records"], "1 or more")
            held = one.get("held_Pa", {})
            for key, value in held.items():
                if key not in COMPONENTS[:d] or not isinstance(value, (int, float)):
                    self._wrong(f"{name}.held_Pa.{key}", value, f"numbers for {', '.join(COMPONENTS[:d])}, tension positive")
            full = [[float(g[i][j]) if i < d and j < d else 0.0 for j in range(3)] for i in range(3)]
            self.legs.append(Leg(full, one["records"], held))
        if not self.legs:
            self._wrong("path.leg", "an empty list", "one table [[path.leg]] at least")

    def _read_reference(self, found):
        keys = {"made_by": str, "windows": int, "first_record": int}
        self.reference = self._table(found, "reference", keys, ("windows", "first_record"))
        self.windows = found.get("windows", 0)
        self.first_record = found.get("first_record", 1)

    def _specimen(self, one, k):
        name = f"specimen[{k}]"
        one = self._table(one, name, {"grains": str, "cell_m": list})
        cell = one["cell_m"]
        if len(cell) != 3 or not all(isinstance(v, (int, float)) and 0 < v < math.inf for v in cell):
            self._wrong(name + ".cell_m", cell, "three lengths above 0; in 2D the third is the thickness")
        path = os.path.join(self.folder, one["grains"])
        grains, wanted = [], ["id", "x_m", "y_m", "z_m", "r_m"]
        try:
            with open(path, encoding="utf-8", newline="") as file:
                rows = list(csv.reader(file))
        except OSError as error:
            raise CaseError(f"{path}: {error.strerror}; {name}.grains of {self.path} names it") from None
        if not rows or rows[0] != wanted:
            raise CaseError(f"{path}: the first line is {','.join(rows[0]) if rows else 'missing'}; it must be {','.join(wanted)}")
        for number, row in enumerate(rows[1:], 2):
            try:
                numbers = [float(word) for word in row[1:]]
                right = len(row) == 5 and int(row[0]) == len(grains) + 1 and all(map(math.isfinite, numbers)) and numbers[3] > 0
            except ValueError:
                right = False
            if not right:
                raise CaseError(f"{path}, line {number}: '{','.join(row)}' is no grain; needed: id ({len(grains) + 1} here), "
                                "three coordinates and a radius above 0, in m")
            grains.append(Grain(tuple(numbers[:3]), numbers[3]))
        if len(grains) < 2:
            raise CaseError(f"{path}: {len(grains)} grains; a specimen has two at least")
        return Specimen(path, tuple(float(v) for v in cell), grains)

    # ---- What codes need of it

    @property
    def disc(self):
        return self.dimension == 2

    def lacks(self, *features):
        """The first of these features that the case has: 'rolling', 'hertz rolling', 'discs', 'shear', 'held', 'rate'."""
        has = {"rolling": self.rolling, "hertz": self.law["kind"] == "hertz_mindlin", "discs": self.disc,
               "shear": any(leg.gradient[i][j] for leg in self.legs for i in range(3) for j in range(3) if i != j),
               "held": any(leg.held_Pa for leg in self.legs), "hertz rolling": False, "rate": self.rate > 0,
               "linear dashpot": "restitution" in self.law and self.law["kind"] == "linear"}
        has["hertz rolling"] = has["hertz"] and has["rolling"]
        return next((feature for feature in features if has[feature]), None)

    def mass(self, r, thickness):
        rho = self.law["density_kg_m3"]
        return rho * (math.pi * r * r * thickness if self.disc else 4 / 3 * math.pi * r**3)

    def pair(self, ri, rj):
        """Constants of two grains: kn, kt, kr, cap of the rolling moment over f_n. Hertz: those before sqrt(overlap)."""
        law, mean = self.law, 2 * ri * rj / (ri + rj)
        if law["kind"] == "linear":
            kn = law["young_modulus_Pa"] * mean
            kt = law["stiffness_ratio"] * kn
        else:
            e, nu, root = law["young_modulus_Pa"], law["poisson_ratio"], math.sqrt(mean / 2)
            kn = 4 / 3 * root * e / (2 * (1 - nu * nu))
            kt = 8 * root * e / (4 * (2 - nu) * (1 + nu))
        return kn, kt, law.get("rolling_stiffness", 0) * kt * ri * rj, law.get("rolling_friction", 0) * min(ri, rj)

    def damping_ratio(self):
        """zeta of the coefficient of restitution."""
        log = -math.log(self.law.get("restitution", 1))
        return log / math.hypot(math.pi, log)

    def contact_time(self):
        """sqrt(m/k) of the smallest grains, s, with k the stiffness at the largest overlap of the start: codes scale their
        steps by it."""
        best = math.inf
        for specimen in self.specimens:
            grains, cell = specimen.grains, specimen.cell
            r, overlap = min(g.r for g in grains), 0.0
            for i, a in enumerate(grains):
                for b in grains[:i]:
                    d = [u - v - c * round((u - v) / c) for u, v, c in zip(a.x, b.x, cell)][:self.dimension]
                    overlap = max(overlap, a.r + b.r - math.hypot(*d))
            kn = self.pair(r, r)[0]
            if self.law["kind"] == "hertz_mindlin":
                kn *= 1.5 * math.sqrt(overlap)
            best = min(best, math.sqrt(self.mass(r, cell[2]) / kn))
        return best

    def duration(self):
        """Of the path at its rate, s; the rate is that of the largest component of a leg's gradient."""
        return sum(self.length(k) for k in range(len(self.legs))) / self.rate

    def end(self, k):
        """F - I at the end of leg k; -1: the start."""
        return self.legs[k].gradient if k >= 0 else [[0.0] * 3 for _ in range(3)]

    def length(self, k):
        """Of leg k: the largest component of its change of F that is prescribed."""
        held = self.legs[k].held_Pa
        return max(abs(self.end(k)[i][j] - self.end(k - 1)[i][j]) for i in range(3) for j in range(3)
                   if i != j or COMPONENTS[i] not in held)

    def targets(self):
        """F - I at each record, in turn: (leg, matrix). Held components are left at 0."""
        found = []
        for k, leg in enumerate(self.legs):
            a, b = self.end(k - 1), leg.gradient
            for n in range(1, leg.records + 1):
                f = n / leg.records
                found.append((leg, [[a[i][j] + f * (b[i][j] - a[i][j]) for j in range(3)] for i in range(3)]))
        return found


def folder_of(name):
    return os.path.join(os.path.dirname(os.path.abspath(__file__)), "cases", name)


def names():
    with open(folder_of("order.txt"), encoding="utf-8") as file:
        return file.read().split()
