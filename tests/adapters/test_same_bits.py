"""One drained biaxial path by every host interface: the stress bits are those of the C interface. Arguments: a folder
with discs.h5, librvelab_umat.so.

Each host holds the lateral stress itself: three tries of an increment from one state, the third accepted. A host without
tries (VUMAT) is given the accepted increments. Gradients are those from the start of an increment on, with F - I exact,
so that all hand the same bits in."""
import ctypes
import os
import sys
import unittest
import warnings
from ctypes import c_double, c_int, c_size_t
from pathlib import Path

import numpy as np

folder, library = Path(sys.argv.pop(1)).resolve(), str(Path(sys.argv.pop(1)).resolve())
(folder / "same_bits.toml").write_text('[[material]]\nnumber = 1\nspecimen = "discs.h5"\n')
os.environ |= {"RVELAB_SPECIMEN": str(folder / "discs.h5"), "RVELAB_UMAT": str(folder / "same_bits.toml")}
os.chdir(folder)

import micro_simulation  # noqa: E402  reads its environment
import rvelab  # noqa: E402
from mgis_client import Behaviour, Point, symmetric  # noqa: E402

STEPS, AXIAL = 30, -(2.0**-12)
LIBRARY = ctypes.CDLL(library)
FIRST = rvelab.Rve(folder / "discs.h5").sigma
HELD = FIRST[0, 0]


def reference(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)


def components(sigma: np.ndarray) -> np.ndarray:
    """11 22 33 12."""
    return np.array([sigma[0, 0], sigma[1, 1], sigma[2, 2], (sigma[0, 1] + sigma[1, 0]) / 2])


class CInterface:
    name = "C interface"

    def __init__(self) -> None:
        self.pool = rvelab.Pool(workers=1)
        self.rve = self.pool.spawn(self.pool.template(folder / "discs.h5"))

    def attempt(self, dH: np.ndarray) -> np.ndarray:
        return self.pool.trial(self.rve, dH[None]).sigma[0].ravel()

    def accept(self) -> None:
        self.pool.commit(self.rve)


class Umat:
    name = "UMAT"

    def __init__(self) -> None:
        self.start = np.zeros(2), components(FIRST)

    def attempt(self, dH: np.ndarray) -> np.ndarray:
        self.statev, self.stress = (array.copy() for array in self.start)
        F0, F1 = np.eye(3), np.eye(3) + dH
        ddsdde, props, zeros, pnewdt = np.zeros(16), np.array([1.0]), np.zeros(9), np.ones(1)
        one, two, three, four = (ctypes.byref(c_int(n)) for n in (1, 2, 3, 4))
        none = None
        LIBRARY.umat_(*map(reference, (self.stress, self.statev, ddsdde)), none, none, none, none, none, none, none, none,
                      reference(zeros), none, none, none, none, none, none, b"SAND", three, one, four, two,
                      reference(props), one, none, none, reference(pnewdt), none, reference(F0), reference(F1), one, one,
                      one, one, one, one, c_size_t(4))
        if pnewdt[0] != 1:
            raise RuntimeError("the increment is too large")
        return self.stress

    def accept(self) -> None:
        self.start = self.statev, self.stress

    expected = staticmethod(components)


class Vumat:
    name = "VUMAT"

    def __init__(self) -> None:
        self.state, self.stress = np.zeros(2), components(FIRST)

    def step(self, dH: np.ndarray) -> np.ndarray:
        F = np.eye(3) + dH
        new, state, props, time = np.zeros(4), np.zeros(2), np.array([1.0]), np.ones(1)
        old_gradient, gradient = np.array([1.0, 1, 1, 0, 0]), np.array([F[0, 0], F[1, 1], F[2, 2], F[0, 1], F[1, 0]])
        zero, one, two, three = (ctypes.byref(c_int(n)) for n in (0, 1, 2, 3))
        none = None
        LIBRARY.vumat_(one, three, one, two, zero, one, zero, *3 * [reference(time)], b"SAND", none, none, reference(props),
                       none, none, none, none, none, reference(old_gradient), none, reference(self.stress),
                       reference(self.state), none, none, none, none, reference(gradient), none, reference(new),
                       reference(state), none, none)
        self.stress, self.state = new, state
        return new

    expected = staticmethod(components)


class Mgis:
    name = "MGIS"

    def __init__(self) -> None:
        self.point = Point(Behaviour(library, "GranularRve", "PlaneStrain"), FIRST, [1, 0])
        self.none = self.point.s0["gradients"].copy()

    def attempt(self, dH: np.ndarray) -> np.ndarray:
        self.point.set(np.eye(3) + dH)
        if self.point.call() != 1:
            raise RuntimeError(self.point.message)
        return self.point.s1["thermodynamic_forces"].copy()

    def accept(self) -> None:
        self.point.update()
        self.point.s0["gradients"][:] = self.none

    @staticmethod
    def expected(sigma: np.ndarray) -> np.ndarray:
        return symmetric(sigma, 4)


class MicroManager:
    name = "Micro Manager"

    def __init__(self) -> None:
        self.one = micro_simulation.MicroSimulation(0)
        self.one.initialize()
        self.checkpoint = self.one.get_state()

    def attempt(self, dH: np.ndarray) -> np.ndarray:
        self.one.set_state(self.checkpoint)
        rows = self.one.solve({"dH_" + axis: dH[i] for i, axis in enumerate("xyz")}, 1.0)
        return np.array([rows["sigma_" + axis] for axis in "xyz"]).ravel()

    def accept(self) -> None:
        self.checkpoint = self.one.get_state()

    expected = staticmethod(np.ravel)


def increment(lateral: float) -> np.ndarray:
    return np.diag([np.round(lateral * 2.0**40) / 2.0**40, AXIAL, 0])


def held(host: CInterface | Umat | Mgis | MicroManager) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Increments that hold the lateral stress by a secant, and their stresses."""
    increments, stresses, before, slope = [], [], HELD, -2.0 * HELD * 100
    lateral = 0.5 * abs(AXIAL)
    for _ in range(STEPS):
        tried = host.attempt(increment(lateral))[0]
        other = lateral + (HELD - tried) / slope
        tried_other = host.attempt(increment(other))[0]
        if tried_other != tried and other != lateral:
            slope = np.clip((tried_other - tried) / (other - lateral), -50 * HELD, -5000 * HELD)
        lateral = other + (HELD - tried_other) / slope
        increments.append(increment(lateral))
        stresses.append(host.attempt(increments[-1]))
        host.accept()
    return increments, stresses


class SameBits(unittest.TestCase):
    def test_one_biaxial_path_by_every_interface(self) -> None:
        warnings.simplefilter("ignore", rvelab.RvelabWarning)
        increments, stresses = held(CInterface())
        stresses = [sigma.reshape(3, 3) for sigma in stresses]
        self.assertLess(stresses[-1][1, 1], 2 * FIRST[1, 1])  # it was loaded, and the lateral stress held
        self.assertLess(max(abs(sigma[0, 0] / HELD - 1) for sigma in stresses), 0.02)
        hosts = [Umat(), Mgis(), MicroManager()]
        found = [(host, *held(host)) for host in hosts]
        vumat = Vumat()
        found.append((vumat, increments, [vumat.step(dH) for dH in increments]))
        print(f"{'':14} sigma_xx and sigma_yy of increment {STEPS}, Pa; increments with the bits of the C interface")
        print(f"{CInterface.name:14} {stresses[-1][0, 0]:.17g} {stresses[-1][1, 1]:.17g}")
        for host, path, told in found:
            same = sum(a.tobytes() == b.tobytes() and host.expected(sigma).tobytes() == c.tobytes()
                       for a, b, sigma, c in zip(increments, path, stresses, told, strict=True))
            print(f"{host.name:14} {told[-1][0]:.17g} {told[-1][4 if len(told[-1]) == 9 else 1]:.17g}  {same} of {STEPS}")
            with self.subTest(host.name):
                self.assertEqual(same, STEPS)


if __name__ == "__main__":
    unittest.main()
