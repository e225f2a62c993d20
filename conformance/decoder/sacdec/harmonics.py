# SPDX-License-Identifier: Apache-2.0
"""The harmonic basis of components and patches, and its fingerprint: spec.md 6.4 and 6.6."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg

from .errors import StreamError, require
from .i_frame import SideInformation
from .limits import Limits
from .sequence_header import SequenceHeader
from .shape import Edges, laplacian, uneven_weights
from .vertices import Mesh

MOST_DENSE = 250  # vertices; more make a dense eigenproblem slow
MOST_RESTARTS = 60  # of Lanczos; surfaces take a few


@dataclass
class Harmonics:
    """Harmonics `vectors` [n_c, l_c] of vertices from `begin` on, with their eigenvalues [l_c]."""

    begin: int
    values: np.ndarray
    vectors: np.ndarray


def generic_numbers(integers: np.ndarray) -> np.ndarray:
    """G of spec.md 6.4.3."""
    return ((integers.astype(np.uint64) + np.uint64(1)) * np.uint64(2654435761) % np.uint64(2**32)) / 2**31 - 1


def scale_and_sign(begin: int, values: np.ndarray, vectors: np.ndarray, masses: np.ndarray) -> Harmonics:
    """spec.md 6.4.3: a constant harmonic 0, mean squares of 1, and signs."""
    vectors = vectors.copy()
    values = np.maximum(values, 0)
    vectors[:, 0] = 1
    values[0] = 0
    vectors /= np.sqrt((masses[:, None] * vectors**2).sum(axis=0) / masses.sum())
    negative = generic_numbers(np.arange(len(vectors))) @ vectors < 0
    negative[0] = False
    vectors[:, negative] *= -1
    return Harmonics(begin, values, vectors)


def exact_basis(matrix: sp.csc_matrix, masses: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The `count` smallest eigenpairs of L h = lambda D h (6.4), D the diagonal of the masses.

    Both sides are scaled by D^(-1/2), which makes an ordinary symmetric eigenproblem.
    """
    n = len(masses)
    root = sp.diags(1 / np.sqrt(masses))
    scaled = (root @ matrix @ root).tocsc()
    if n <= MOST_DENSE or 2 * count >= n:
        values, vectors = scipy.linalg.eigh(scaled.toarray(), subset_by_index=(0, count - 1))
    else:
        start = generic_numbers(np.arange(n))
        values, vectors = sp.linalg.eigsh(scaled, count, sigma=-1.0, v0=start, maxiter=MOST_RESTARTS)
        ascending = np.argsort(values)
        values, vectors = values[ascending], vectors[:, ascending]
    return values, root @ vectors


def farthest_points(grid: np.ndarray, count: int) -> tuple[list[int], int]:
    """spec.md 6.4.4 step 1: the samples, and the greatest squared distance of a vertex to its nearest one."""
    samples = [0]
    nearest = ((grid - grid[0]) ** 2).sum(axis=1)
    while len(samples) < count:
        samples.append(int(np.argmax(nearest)))  # the smallest number of several
        nearest = np.minimum(nearest, ((grid - grid[samples[-1]]) ** 2).sum(axis=1))
    return samples, int(nearest.max())


def radial_functions(grid: np.ndarray, samples: list[int], covering: int) -> np.ndarray:
    """spec.md 6.4.4 step 2: S [n_c, s]."""
    radius = 3 * np.sqrt(max(covering, 1))
    functions = np.empty((len(grid), len(samples)))
    for i, sample in enumerate(samples):
        t = np.sqrt(((grid - grid[sample]) ** 2).sum(axis=1)) / radius
        functions[:, i] = np.where(t < 1, (1 - t) ** 4 * (4 * t + 1), 0)
    return functions / functions.sum(axis=1, keepdims=True)


def reduced_basis(
    matrix: sp.csc_matrix, masses: np.ndarray, grid: np.ndarray, samples: int, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """spec.md 6.4.4: Rayleigh-Ritz in radial functions, one inverse iteration, Rayleigh-Ritz again."""
    functions = radial_functions(grid, *farthest_points(grid, samples))
    d = sp.diags(masses)
    _, small = scipy.linalg.eigh(
        functions.T @ (matrix @ functions), functions.T @ (d @ functions), subset_by_index=(0, count - 1)
    )
    h = functions @ small
    z = scipy.sparse.linalg.splu((matrix + d).tocsc()).solve(d @ h)
    values, mixed = scipy.linalg.eigh(z.T @ (matrix @ z), z.T @ (d @ z))
    return values, z @ mixed


def _run_matrix(mesh: Mesh, edges: Edges, weights: np.ndarray, begin: int, end: int) -> sp.csc_matrix:
    """The Laplacian (6.4.2) of the vertices from `begin` to `end` - 1 and the edges with both ends in them."""
    inside = np.all((edges.ends >= begin) & (edges.ends < end), axis=1)
    ends = edges.ends[inside] - begin
    return laplacian(end - begin, ends, uneven_weights(ends, weights[inside], mesh.grid[begin:end]))


def _uses_reduced(samples: int, grid: np.ndarray) -> bool:
    """spec.md 6.4: whether a component's basis is the reduced one."""
    return 0 < samples < len(grid) and len(np.unique(grid, axis=0)) >= samples


def _check_limits(mesh: Mesh, side: SideInformation, header: SequenceHeader, limits: Limits) -> None:
    """spec.md 9: harmonics, basis_values and basis_work."""
    values = work = 0
    for n, l in zip(np.diff(mesh.components).tolist(), side.harmonics):
        require(l <= limits.harmonics, 44, f"a component of {l} harmonics")
        values += n * l
        work += 10 * n * l * l
        samples = side.samples_per_harmonic * l
        if 0 < samples < n:
            work += samples**3
        elif 2 * l + 20 >= n:
            work += n**3
    if header.detail_step > 0:
        values += header.vertices * header.patch_size
        work += 10 * header.vertices * header.patch_size**2
    require(values <= limits.basis_values, 44, f"a basis of {values} values")
    require(work <= limits.basis_work, 44, f"a basis that costs {work} multiplications")


def component_harmonics(
    mesh: Mesh,
    edges: Edges,
    weights: np.ndarray,
    masses: np.ndarray,
    side: SideInformation,
    header: SequenceHeader,
    limits: Limits,
) -> list[Harmonics]:
    """spec.md 6.4: the harmonics of each component."""
    _check_limits(mesh, side, header, limits)
    result = []
    for begin, end, count in zip(mesh.components, mesh.components[1:], side.harmonics):
        own_masses, grid = masses[begin:end], mesh.grid[begin:end]
        samples = side.samples_per_harmonic * count
        matrix = _run_matrix(mesh, edges, weights, begin, end)
        try:
            if _uses_reduced(samples, grid):
                values, vectors = reduced_basis(matrix, own_masses, grid, samples, count)
            else:
                values, vectors = exact_basis(matrix, own_masses, count)
        except (np.linalg.LinAlgError, sp.linalg.ArpackError, RuntimeError) as error:
            raise StreamError(45, f"the harmonics of vertices {begin} to {end - 1}: {error}") from error
        result.append(scale_and_sign(begin, values, vectors, own_masses))
    return result


def patch_harmonics(mesh: Mesh, edges: Edges, weights: np.ndarray) -> list[Harmonics]:
    """spec.md 6.4.5: all harmonics of each patch."""
    result = []
    for begin, end in zip(mesh.patches, mesh.patches[1:]):
        matrix = _run_matrix(mesh, edges, weights, begin, end)
        ones = np.ones(end - begin)
        try:
            values, vectors = exact_basis(matrix, ones, end - begin)
        except np.linalg.LinAlgError as error:
            raise StreamError(45, f"the harmonics of the patch of vertices {begin} to {end - 1}: {error}") from error
        result.append(scale_and_sign(begin, values, vectors, ones))
    return result


def fingerprint(components: Sequence[Harmonics], patches: Sequence[Harmonics]) -> tuple[float, float]:
    """F_0 and F_1 of spec.md 6.6, rounded to binary32."""
    values = sum(component.values.sum() for component in components)
    vectors = 0.0
    for part in itertools.chain(components, patches):
        n, count = part.vectors.shape
        of_vertex = generic_numbers(7 * np.arange(n) % 2**32)
        of_harmonic = generic_numbers(3 * np.arange(1, count))
        vectors += of_harmonic @ (of_vertex @ part.vectors[:, 1:]) / n
    with np.errstate(over="ignore"):
        return float(np.float32(values)), float(np.float32(vectors))


def check_fingerprint(
    components: Sequence[Harmonics], patches: Sequence[Harmonics], expected: tuple[float, float]
) -> None:
    """spec.md 6.6: refuses a stream whose harmonics are others."""
    f_0, f_1 = fingerprint(components, patches)
    agrees = abs(f_0 - expected[0]) <= 1e-5 * abs(f_0) + 1e-6 and abs(f_1 - expected[1]) <= 1e-5 * abs(f_1) + 1e-5
    require(agrees, 46, f"the fingerprint of the harmonics is {(f_0, f_1)}, the stream's {expected}")
