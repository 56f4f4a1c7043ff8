"""Young's modulus of a simple cubic array of rigid spheres bonded in an elastic matrix, along an edge of the cube: an octant of the
cell between planes of symmetry, in hexahedra along rays from the sphere's centre, extrapolated with the square of their size."""
import numpy as np
import scipy.sparse as sparse
from scipy.sparse.linalg import spsolve

CORNERS = np.array([[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1], [-1, -1, 1], [1, -1, 1], [1, 1, 1], [-1, 1, 1]])


def mesh(radius, n, layers):
    """Nodes and hexahedra of the unit cell's octant: n x n on each outer face, layers between sphere and face."""
    numbers, nodes, cells = {}, [], []

    def node(face, a, b, k):
        corner = [0, 0, 0]
        corner[face], corner[(face + 1) % 3], corner[(face + 2) % 3] = n, a, b
        key = (*corner, k)
        if key not in numbers:
            numbers[key] = len(nodes)
            outer = 0.5 * np.array(corner) / n
            far = np.linalg.norm(outer)
            nodes.append(outer / far * (radius + (far - radius) * k / layers))
        return numbers[key]

    for face, a, b, k in np.ndindex(3, n, n, layers):
        cells.append([node(face, a + i, b + j, k + m) for m in (0, 1) for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))])
    return np.array(nodes), np.array(cells)


def stiffness_matrix(nodes, cells, nu):
    """Of a matrix of Young's modulus 1: trilinear, eight points of Gauss."""
    lame, shear = nu / ((1 + nu) * (1 - 2 * nu)), 1 / (2 * (1 + nu))
    law = np.diag([shear] * 6)
    law[:3, :3] = lame
    law[range(3), range(3)] = lame + 2 * shear
    own = np.zeros((len(cells), 24, 24))
    for point in CORNERS / np.sqrt(3):
        one = 1 + CORNERS * point
        slopes = CORNERS * np.stack([one[:, 1] * one[:, 2], one[:, 0] * one[:, 2], one[:, 0] * one[:, 1]], axis=1) / 8
        jacobian = np.einsum("eni,nj->eji", nodes[cells], slopes)
        along = np.einsum("nj,eij->eni", slopes, np.linalg.inv(jacobian))
        strain = np.zeros((len(cells), 6, 24))
        for row, parts in enumerate(((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))):
            i, j = parts
            strain[:, row, i::3] += along[:, :, j]
            if i != j:
                strain[:, row, j::3] += along[:, :, i]
        own += np.einsum("eai,ab,ebj,e->eij", strain, law, strain, np.abs(np.linalg.det(jacobian)), optimize=True)
    unknowns = (3 * cells[:, :, None] + np.arange(3)).reshape(len(cells), 24)
    return sparse.csr_matrix((own.ravel(), (np.repeat(unknowns, 24, axis=1).ravel(), np.tile(unknowns, (1, 24)).ravel())))


def young_of_mesh(radius, nu, n):
    """The faces stay planes; those along the load are free of force as a whole, the sphere stands still."""
    nodes, cells = mesh(radius, n, n + 2)
    number = np.full(3 * len(nodes), -1)
    inner = np.linalg.norm(nodes, axis=1) < radius * (1 + 1e-9)
    planes = [np.flatnonzero(np.abs(nodes[:, i] - 0.5) < 1e-9) * 3 + i for i in range(3)]
    held = np.concatenate([np.flatnonzero(inner | (np.abs(nodes[:, i]) < 1e-9)) * 3 + i for i in range(3)])
    single = np.setdiff1d(np.arange(len(number)), np.concatenate([held, *planes]))
    number[single] = np.arange(len(single))
    for i, plane in enumerate(planes):
        number[plane] = len(single) + i
    rows = np.flatnonzero(number >= 0)
    joined = sparse.csr_matrix((np.ones(len(rows)), (rows, number[rows])), shape=(len(number), len(single) + 3))
    whole = (joined.T @ stiffness_matrix(nodes, cells, nu) @ joined).tocsc()
    moved = np.ones(whole.shape[0])  # of the loaded face 1, strain 2
    moved[:-1] = spsolve(whole[:-1, :-1], -whole[:-1, -1].toarray().ravel())
    return (whole @ moved)[-1] / 0.25 / 2


def young_of_array(radius, nu):
    """Over that of the matrix; radius over the edge of the cell."""
    coarse, fine = young_of_mesh(radius, nu, 4), young_of_mesh(radius, nu, 8)
    return fine + (fine - coarse) / 3
