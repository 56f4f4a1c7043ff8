"""tools/validate force_fabric: q/p of force and fabric beside that of the contacts, in biaxial tests to 15 %.

    force_fabric.py RVELAB WORK RESULTS

The relation (rvelab/measure/anisotropy.hpp) takes, of each direction, the mean force and the mean branch, and multiplies them. Of the last
state its prediction stands beside those of the means of their product, to the same order, and of all orders to 12."""

import csv
import json
import pathlib

import numpy as np

import harness
from harness import once, packed, records, rvelab, sets, verdict, work

CASES = {"discs": ("pack_dense",), "bedded ellipses, b/a 0.5": ("pack_bedded", 0.5), "bedded ellipses, b/a 0.3": ("pack_bedded", 0.3)}
BAR = 0.05


def tested(name, recipe, aspect=None):
    """Record file of the test and the beginning of the names of its last state."""
    base = name.replace(" ", "_").replace("/", "").replace(",", "")
    shape = [f"grains.{end}_aspect_ratio={aspect}" for end in ("smallest", "largest")] if aspect else []
    out = once(work / f"{base}.h5", "run", "biaxial", "--specimen", packed(recipe, f"{base}_S", *shape),
               *sets("test.pressure_Pa=100e3", "stage.compression.to_strain=0.15",
                     'output.quantities=["stress_force_fabric"]'))
    rvelab("export", out, "--format", "csv", "-o", work / base, "--force")
    return out, work / base


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def columns(rows, *names):
    return np.array([[float(row[name]) for name in names] for row in rows])


def contacts_of(base):
    """Normals, forces and branches of the contacts (n, 2)."""
    grains, contacts = rows_of(f"{base}.particles.csv"), rows_of(f"{base}.contacts.csv")
    lattice = np.array(json.loads(pathlib.Path(f"{base}.json").read_text())["hSize"])
    position, number = columns(grains, "x", "y"), {row["id"]: k for k, row in enumerate(grains)}
    first, second = ([number[row[name]] for row in contacts] for name in ("id1", "id2"))
    branch = position[second] - position[first] + columns(contacts, "sx", "sy") @ lattice.T
    if "nx" in contacts[0]:
        normal = columns(contacts, "nx", "ny")
    else:  # round grains
        normal = branch / np.linalg.norm(branch, axis=1, keepdims=True)
    return normal, columns(contacts, "fn") * normal + columns(contacts, "fsx", "fsy"), branch


def waves(angle, order):
    return np.stack([np.ones_like(angle), *(of(k * angle) for k in range(2, order + 1, 2) for of in (np.cos, np.sin))], axis=1)


def predictions(normal, force, branch):
    """q/p along the deviator of the contacts: theirs; of the products of mean force and mean branch to the second order, with normals to the
    fourth; of the means of their products, likewise; of the products of the means to order 12."""
    def part(tensor):
        return 0.5 * (tensor + tensor.T)
    stress = part(np.einsum("ci,cj->ij", force, branch))
    deviator = stress - 0.5 * np.trace(stress) * np.eye(2)
    along = deviator / np.linalg.norm(deviator)
    angle, around = np.arctan2(normal[:, 1], normal[:, 0]), np.linspace(0, 2 * np.pi, 721)[:-1]

    def frames(angles):  # of the direction and across it
        return np.stack([np.stack([np.cos(angles), np.sin(angles)], 1), np.stack([-np.sin(angles), np.cos(angles)], 1)], axis=1)

    own = frames(angle)
    f, l = (np.einsum("cki,ci->ck", own, each) for each in (force, branch))

    def fitted(values, order):
        return waves(around, order) @ np.linalg.lstsq(waves(angle, order), values, rcond=None)[0]

    def ratio(order_normals, order, together):
        density = waves(around, order_normals) @ (waves(angle, order_normals).mean(0) * np.r_[1, [2] * order_normals])
        if together:
            local = fitted(np.einsum("ck,cm->ckm", f, l).reshape(-1, 4), order).reshape(-1, 2, 2)
        else:
            local = np.einsum("ak,am->akm", fitted(f, order), fitted(l, order))
        whole = part(np.einsum("a,aki,akm,amj->ij", density, frames(around), local, frames(around)))
        return np.sqrt(2) * np.sum(whole * along) / np.trace(whole)

    return (np.sqrt(2) * np.sum(stress * along) / np.trace(stress), ratio(4, 2, False), ratio(4, 2, True), ratio(12, 12, False),
            np.corrcoef(f[:, 0] - waves(angle, 4) @ np.linalg.lstsq(waves(angle, 4), f[:, 0], rcond=None)[0],
                        l[:, 0] - waves(angle, 4) @ np.linalg.lstsq(waves(angle, 4), l[:, 0], rcond=None)[0])[0, 1])


def main():
    print("q/p at 15 %: of the contacts; of force and fabric: products of means, second order; means of products, second order; products of means,\n"
          "order 12; correlation of normal force and branch of one direction\n")
    for name, case in CASES.items():
        out, state = tested(name, *case)
        stress, stage, predicted = records(out, "stress_Pa", "stage", "stress_force_fabric").values()
        stress, predicted = -stress[:, :2, :2], predicted.reshape(len(stage), -1)[:, 0]
        principal = np.linalg.eigvalsh(0.5 * (stress + stress.transpose(0, 2, 1)))
        measured = harness.sine_of(principal[:, 1], principal[:, 0])
        largest = np.abs(predicted - measured)[stage == stage.max()].max()
        exact, means, products, orders, correlation = predictions(*contacts_of(state))
        print(f"{name:<28} {exact:.3f}  {means:.3f}  {products:.3f}  {orders:.3f}  {correlation:6.2f}")
        verdict(f"{name}: largest difference over the path", f"{largest:.3f}", f"{BAR}", largest <= BAR,
                abs(products - exact) < 0.01 and abs(orders - exact) > BAR and correlation < -0.1,
                f"force and branch of one direction vary together (correlation {correlation:.2f}), and the relation multiplies their means: to order 12 "
                f"these give {orders:.3f} at the end, the means of their products, which are exact to the second order, {products:.3f} of {exact:.3f}")


if __name__ == "__main__":
    harness.main(main)
