"""Cemented and moist specimens where files are damaged, runs are killed, and the machine is another. Arguments: a folder to work in,
then unittest's.

One test on 64 discs with bonds, most of which break, and bridges of water; RVELAB_PROGRAM names what is tested."""
import os
import shutil
import signal
import struct
import subprocess
import sys
import time
import unittest
import warnings
from pathlib import Path

import h5py
import numpy as np
import rvelab

folder = Path(sys.argv.pop(1)) if len(sys.argv) > 1 else Path(".")
program = os.environ["RVELAB_PROGRAM"]
TEST = """[test]
name = "cemented and moist"
pressure_Pa = 20e3
[output]
snapshots_every = 20
quantities = ["bonds", "bonds_broken_in_tension", "bonds_broken_in_shear", "bond_stress_Pa", "bridges", "bridge_stress_Pa"]
[[stage]]
name = "first"
kind = "isotropic"
[[stage]]
kind = "cement"
young_modulus_Pa = 50e6
tensile_strength_Pa = 100e3
cohesion_Pa = 100e3
friction_angle_deg = 30
strength_scatter = 0.2
[[stage]]
kind = "water"
suction_Pa = 100
[[stage]]
kind = "isotropic"
[[stage]]
kind = "compression"
axis = "y"
to_strain = 0.02
record_every = 0.0005
lateral = "constant_stress"
"""
GO_ON = '[test]\nname = "on"\n[[stage]]\nkind = "simple_shear"\nto_strain = 1e-3\nrecord_every = 5e-4\n'
NAN = float("nan")


def call(*words: object, environment: dict | None = None) -> tuple[int, str]:
    done = subprocess.run([program, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=120,
                          env={**os.environ, **(environment or {})})
    return done.returncode, done.stderr


def setUpModule() -> None:
    warnings.simplefilter("ignore", rvelab.RvelabWarning)
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    (folder / "test.toml").write_text(TEST)
    (folder / "on.toml").write_text(GO_ON)
    for words in (["pack", "pack_dense", "-o", "S.h5", "--set", "pack.number=64"],
                  ["run", "test.toml", "--specimen", "S.h5", "-o", "R.h5"]):
        code, errors = call(*words)
        if code != 0:
            raise RuntimeError(errors)


def numbers_of(path: Path) -> dict[str, bytes]:
    """All of a file but the time that its test took."""
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, each: found.update({name: each[()].tobytes()})
                        if isinstance(each, h5py.Dataset) and each.dtype.kind in "fiu" and "wall" not in name else None)
    return found


def crc32c(data: bytes) -> int:
    table = []
    for value in range(256):
        for _ in range(8):
            value = (value >> 1) ^ (0x82F63B78 if value & 1 else 0)
        table.append(value)
    total = 0xFFFFFFFF
    for each in data:
        total = table[(total ^ each) & 255] ^ (total >> 8)
    return total ^ 0xFFFFFFFF


def sealed(change) -> Path:
    """A specimen that another program changed and gave a seal that fits: the end of the test."""
    path = folder / "changed.h5"
    with h5py.File(folder / "R.h5") as source, h5py.File(path, "w") as file:
        for name, value in source.attrs.items():
            file.attrs[name] = value
        file.attrs["format"] = np.bytes_(b"rvelab specimen")
        for name in source["specimen"]:
            source.copy(f"specimen/{name}", file)
        change(file)
    data = path.read_bytes()
    head = b"rveseal\n" + struct.pack("<QI", len(data), 1)
    path.write_bytes(data + head + struct.pack("<I", crc32c(data + head)))
    return path


def value(name: str, at: object, number: float):
    def change(file: h5py.File) -> None:
        numbers = file[name][...]
        numbers[at] = number
        file[name][...] = numbers
    return change


def rows(table: str, order: list[int]):
    def change(file: h5py.File) -> None:
        for each in file[table].values():
            numbers = each[...]
            numbers[:len(order)] = numbers[order]
            each[...] = numbers
    return change


def without(name: str):
    return lambda file: file.__delitem__(name)


class Damage(unittest.TestCase):
    def answers(self, change, *words: str) -> str:
        """Refused when it is opened, with one line in which `words` stand."""
        code, errors = call("inspect", sealed(change).name)
        self.assertEqual((code, errors.count("\n")), (2, 1), errors)
        for word in words:
            self.assertIn(word, errors)
        self.assertEqual(call("run", "on.toml", "--specimen", "changed.h5", "-o", "on.h5", "--force")[0], 2)

    def test_what_bonds_and_bridges_cannot_be_is_refused_by_name(self) -> None:
        with h5py.File(folder / "R.h5") as file:
            intact = int(np.flatnonzero(file["specimen/bonds/broken"][:] == 0)[3])
        self.assertEqual(call("inspect", sealed(lambda file: None).name)[0], 0)
        for change, *words in (
                (value("bonds/broken", 0, 3), "bonds/broken[0] = 3", "0 to 2"),
                (value("bonds/broken", 0, 0.5), "bonds/broken[0] = 0.5", "whole"),
                (value("bonds/radius_m", 0, 0), "bonds/radius_m[0] = 0"),
                (value("bonds/length_m", 0, np.inf), "bonds/length_m[0] = inf"),
                (value("bonds/length_m", intact, 5), f"bonds/length_m[{intact}] = 5"),
                (value("bonds/normal_stiffness_Pa_m", 0, -1), "bonds/normal_stiffness_Pa_m[0] = -1"),
                (value("bonds/tensile_strength_Pa", 0, -1), "bonds/tensile_strength_Pa[0] = -1"),
                (value("bonds/cohesion_Pa", 0, NAN), "bonds/cohesion_Pa[0] = nan"),
                (value("bonds/moment_factor", 0, 2), "bonds/moment_factor[0] = 2"),
                (value("bonds/shear_force_N", (intact, 1), 1), f"bonds/shear_force_N[{intact}, 1] = 1", "2D"),
                (value("bonds/bending_moment_N_m", (intact, 2), NAN), f"bonds/bending_moment_N_m[{intact}, 2] = nan"),
                (value("bonds/released_energy_J", 0, -1), "bonds/released_energy_J[0] = -1"),
                (value("bonds/j", 0, 99999), "bonds/j[0] = 99999"),
                (value("bonds/image", (0, 2), 1), "bonds/image[0, 2] = 1", "2D"),
                (value("bonds/image", (0, 0), 2**31 - 1), "bonds/image[0, 0] = 2147483647"),
                (value("bonds/image", (intact, 0), 50), f"bonds/length_m[{intact}]"),
                (rows("bonds", [0, 0]), "bonds[1]", "stands twice"), (rows("bonds", [1, 0]), "bonds[1]", "out of order"),
                (without("bonds/radius_m"), "bonds/radius_m is missing"),
                (value("water/suction_Pa", 0, -1), "water/suction_Pa[0] = -1"), (value("water/suction_Pa", 0, 0), "water/suction_Pa = 0"),
                (value("water/volume_ratio", 0, -1), "water/volume_ratio[0] = -1"),
                (value("water/volume_ratio", 0, 0.01), "water/volume_ratio = 0.01"),
                (value("water/contact_angle_deg", 0, 90), "water/contact_angle_deg[0] = 90"),
                (value("water/surface_tension_N_m", 0, 0), "water/surface_tension_N_m[0] = 0"),
                (without("water"), "bridges without water"), (value("bridges/present", 0, 2), "bridges/present[0] = 2"),
                (value("bridges/present", 0, 0), "bridges/present[0] = 0", "allowed: 1"),
                (value("bridges/present", 0, 0.5), "bridges/present[0] = 0.5", "allowed: 1"),
                (value("bridges/rupture_gap_m", 0, -1), "bridges/rupture_gap_m[0] = -1"),
                (value("bridges/pull_3", 0, NAN), "bridges/pull_3[0] = nan"),
                (value("bridges/image", (0, 1), -2**31), "bridges/image[0, 1] = -2147483648"),
                (rows("bridges", [0, 0]), "bridges[1]", "stands twice")):
            with self.subTest(words[0]):
                self.answers(change, *words)

    def test_odd_values_within_their_ranges_end_in_a_result_or_one_line(self) -> None:
        for change in (value("bonds/radius_m", 0, 1e300), value("bonds/normal_stiffness_Pa_m", 14, 1e300),
                       value("bonds/shear_stiffness_Pa_m", 14, 1e30), value("bonds/shear_force_N", (14, 0), 1e300),
                       value("bonds/normal_stiffness_Pa_m", 14, 0), value("bonds/twisting_moment_N_m", 14, 1),
                       value("bonds/image", (0, 0), 1000), value("bridges/image", (60, 0), 77), value("bridges/rupture_gap_m", 0, 1),
                       value("bridges/scale_N", 0, 1e300), value("water/suction_Pa", 0, 1e300), value("water/suction_Pa", 0, 1e-300),
                       without("bonds"), without("bridges")):
            sealed(change)
            code, errors = call("run", "on.toml", "--specimen", "changed.h5", "-o", "on.h5", "--force")
            self.assertIn(code, (0, 1, 2), errors)
            self.assertLessEqual(len([line for line in errors.splitlines() if "warning" not in line]), 1, errors)

    def test_a_flipped_bit_in_any_column_is_refused(self) -> None:
        whole = (folder / "R.h5").read_bytes()
        with h5py.File(folder / "R.h5") as file:
            places = {f"{group}/{name}": each.id.get_offset() + each.id.get_storage_size() // 2
                      for group in ("specimen/bonds", "specimen/bridges", "specimen/water", "snapshots/000020/bonds", "snapshots/000020/bridges")
                      for name, each in file[group].items()}
        self.assertGreater(len(places), 70)
        for name, at in places.items():
            with self.subTest(name):
                (folder / "flipped.h5").write_bytes(whole[:at] + bytes([whole[at] ^ 16]) + whole[at + 1:])
                code, errors = call("inspect", "flipped.h5")
                self.assertEqual(code, 2)
                self.assertIn("is damaged", errors)


class Export(unittest.TestCase):
    def test_shear_forces_of_bonds_are_arrows_across_them_in_paraview(self) -> None:
        self.assertEqual(call("export", "R.h5", "--format", "xdmf", "-o", "X.xdmf")[0], 0)
        with h5py.File(folder / "X.xdmf.h5") as exported, h5py.File(folder / "R.h5") as file:
            bonds = exported[sorted(exported)[-1]]["bonds"]
            points, force, broken = bonds["points_m"][:], bonds["shear_force_N"][:], bonds["broken"][:]
            component = file["specimen/bonds/shear_force_N"][:, 0]
        branch = points[1::2] - points[0::2]
        size = np.linalg.norm(force, axis=1)
        self.assertGreater((size > 0).sum(), 5)
        self.assertTrue((size[broken > 0] == 0).all())
        np.testing.assert_allclose(size, abs(component), rtol=1e-12)
        self.assertLess(abs(np.einsum("bi,bi->b", force, branch)).max(), 1e-12 * size.max() * np.linalg.norm(branch, axis=1).max())


class SameBits(unittest.TestCase):
    def test_a_killed_run_goes_on_to_the_same_bits(self) -> None:
        words = [program, "run", "test.toml", "--specimen", "S.h5", "-o", "K.h5", "--resume", "--checkpoint-every", "0.02"]
        journal, kills = folder / "K.h5.journal", 0
        for writes in range(1, 7):  # killed when its journal has grown so many times
            running = subprocess.Popen(words, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            size, grown = journal.stat().st_size if journal.exists() else 0, 0
            while running.poll() is None and grown < writes:
                now = journal.stat().st_size if journal.exists() else 0
                grown += now > size
                size = now
                time.sleep(0.001)
            if running.poll() is None:
                running.send_signal(signal.SIGKILL)
                kills += 1
            running.wait()
        self.assertGreaterEqual(kills, 3)
        self.assertEqual(subprocess.run(words, cwd=folder, capture_output=True).returncode, 0)
        self.assertEqual(numbers_of(folder / "K.h5"), numbers_of(folder / "R.h5"))

    def test_instruction_sets_have_the_same_bits(self) -> None:
        for name in ("scalar", "baseline"):
            code, errors = call("run", "test.toml", "--specimen", "S.h5", "-o", f"{name}.h5", environment={"RVELAB_ISA": name})
            self.assertEqual(code, 0, errors)
            self.assertEqual(numbers_of(folder / f"{name}.h5"), numbers_of(folder / "R.h5"), name)

    def test_threads_and_pool_files_have_the_same_bits(self) -> None:
        def moved(workers: int) -> tuple[bytes, bytes]:
            pool = rvelab.Pool(counted_ids=True, workers=workers)
            rves = pool.spawn(pool.template(folder / "R.h5"), 4)
            sigma = [pool.trial(rves, np.array([[[0, 1e-4 * (k + 1), 0], [0, -2e-4, 0], [0, 0, 0]] for k in range(4)])).sigma.tobytes()]
            pool.commit(rves)
            pool.write(folder / "P.h5")
            again = rvelab.Pool(workers=workers)
            again.read(folder / "P.h5")
            return sigma[0], (folder / "P.h5").read_bytes()
        self.assertEqual(moved(1), moved(2))


if __name__ == "__main__":
    unittest.main()
