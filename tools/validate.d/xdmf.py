"""ParaView reads what `rvelab export --format xdmf` writes: blocks, numbers of points and lines, arrays, outline.

Needs python3-paraview and python3-numpy (Debian).
"""

import sys

import numpy
from paraview import servermanager
from paraview.simple import Delete, UpdatePipeline, XDMFReader, Xdmf3ReaderT
from vtkmodules.util.numpy_support import vtk_to_numpy

import harness
from harness import answer, imported, rvelab, sets, work

GRAIN_ARRAYS = {"radius_m": 1, "id": 1, "material": 1, "fluctuation_velocity_m_s": 3, "fluctuation_spin_rad_s": 3,
                "stress_Pa": 9, "contacts": 1}
CONTACT_ARRAYS = {"force_N": 3, "normal_force_N": 1, "overlap_m": 1, "sliding": 1}


def expect(condition, what):
    if not condition:
        sys.exit(f"xdmf: {what}")


def leaves(data, found):
    """Blocks of a nested multi-block by their names."""
    for k in range(data.GetNumberOfBlocks()):
        block = data.GetBlock(k)
        if block is None:
            continue
        if block.IsA("vtkMultiBlockDataSet"):
            leaves(block, found)
        else:
            found[data.GetMetaData(k).Get(data.NAME())] = block
    return found


def arrays(attributes):
    return {attributes.GetArrayName(k): attributes.GetArray(k).GetNumberOfComponents()
            for k in range(attributes.GetNumberOfArrays())}


def points(block):
    return vtk_to_numpy(block.GetPoints().GetData())


def check(reader, grains, contacts, dimension, lattice, stress):
    blocks = leaves(servermanager.Fetch(reader), {})
    expect(set(blocks) == {"grains", "contacts", "cell"}, f"blocks are {sorted(blocks)}")
    expect(blocks["grains"].GetNumberOfPoints() == grains, "number of grains")
    expect(arrays(blocks["grains"].GetPointData()) == GRAIN_ARRAYS, arrays(blocks["grains"].GetPointData()))
    expect(blocks["contacts"].GetNumberOfCells() == contacts, "number of contacts")
    expect(arrays(blocks["contacts"].GetCellData()) == CONTACT_ARRAYS, arrays(blocks["contacts"].GetCellData()))
    expect(blocks["cell"].GetNumberOfCells() == (4 if dimension == 2 else 12), "edges of the outline")

    # The outline spans the cell vectors, and every centre lies in it.
    corners = points(blocks["cell"])
    inverse = numpy.linalg.inv(lattice)
    fraction = corners @ inverse.T
    expect(numpy.allclose(abs(fraction[:, :dimension]), 0.5, atol=1e-12), "corners of the outline")
    centres = points(blocks["grains"]) @ inverse.T
    expect(abs(centres).max() <= 0.5 + 1e-12, "centres within the outline")

    # The network carries the stress that rvelab reports.
    ends = points(blocks["contacts"]).reshape(-1, 2, 3)
    force = vtk_to_numpy(blocks["contacts"].GetCellData().GetArray("force_N"))
    volume = abs(numpy.linalg.det(lattice))
    network = -numpy.einsum("ck,cl->kl", force, ends[:, 1] - ends[:, 0]) / volume
    expect(numpy.allclose(network, stress, atol=1e-9 * abs(stress).max()), f"stress of the contacts:\n{network}")


def main():
    for name, dimension in (("dense", 2), ("hertz", 3)):
        test, out = work / f"{name}.test.h5", work / f"{name}.xdmf"
        rvelab("run", "simple_shear", "--specimen", imported(name), "-o", test, "--force",
               *sets("stage.shear.to_strain=0.03", "stage.shear.record_every=0.03"))
        rvelab("export", test, "--format", "xdmf", "-o", out, "--force")
        shown = answer("inspect", test)
        lattice, stress = numpy.array(shown["rotation"]) @ numpy.array(shown["lattice_m"]), numpy.array(shown["stress_Pa"])
        for kind, reader in (("XDMFReader", XDMFReader(FileNames=[str(out)])),
                             ("Xdmf3ReaderT", Xdmf3ReaderT(FileName=[str(out)]))):
            UpdatePipeline(proxy=reader)
            check(reader, shown["grains"], shown["contacts"], dimension, lattice, stress)
            print(f"xdmf: {name}: {kind} found {shown['grains']} grains, {shown['contacts']} contacts, the cell, the stress")
            Delete(reader)


if __name__ == "__main__":
    harness.main(main)
