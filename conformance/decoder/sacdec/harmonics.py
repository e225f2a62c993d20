# SPDX-License-Identifier: Apache-2.0
"""The harmonics of components and patches, and their fingerprint: spec.md 6.4 and 6.6."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg
import scipy.sparse as sp
import scipy.sparse.linalg

from .errors import StreamError, require
from .handles import Blend, blend_of_all, blend_of_handles, handle_count
from .i_frame import SideInformation
from .limits import Limits
from .sequence_header import SequenceHeader
from .shape import Edges, laplacian, uneven_edges
from .vertices import Mesh

MOST_DENSE = 250  # vertices; more make a dense eigenproblem slow
MOST_RESTARTS = 60  # of Lanczos; surfaces take a few


@dataclass
class Harmonics:
    """Harmonics of vertices from `begin` on, with their eigenvalues `values` [l_c].

    `columns` [functions, l_c] are their coefficients z, `vectors` [n_c, l_c] their values at vertices, Psi z.
    """

    begin: int
    values: np.ndarray
    columns: np.ndarray
    vectors: np.ndarray


def generic_numbers(integers: np.ndarray) -> np.ndarray:
    """G of spec.md 6.4.3."""
    return ((integers.astype(np.uint64) + np.uint64(1)) * np.uint64(2654435761) % np.uint64(2**32)) / 2**31 - 1


def scale_and_sign(blend: Blend, values: np.ndarray, columns: np.ndarray, masses: np.ndarray) -> Harmonics:
    """spec.md 6.4.3: a constant harmonic 0, mean squares of 1, and signs."""
    columns = columns.copy()
    values = np.maximum(values, 0)
    columns[:, 0] = blend.constant()
    values[0] = 0
    vectors = blend.functions @ columns
    factors = 1 / np.sqrt((masses[:, None] * vectors**2).sum(axis=0) / masses.sum())
    negative = generic_numbers(np.arange(len(vectors))) @ vectors < 0
    negative[0] = False
    factors[negative] *= -1
    return Harmonics(blend.begin, values, columns * factors, vectors * factors)


def exact_basis(matrix: sp.csc_matrix, masses: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The `count` smallest eigenpairs of L h = lambda D h (6.4.6), D the diagonal of the masses.

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


def leader_count(harmonics: int, handles: int) -> int:
    """How many of a component's handles lead: spec.md 6.4.6."""
    return min(handles, (4 * harmonics + 2) // 3)


def blended_basis(
    blend: Blend, matrix: sp.csc_matrix, masses: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """spec.md 6.4.6, "Otherwise": eigenvalues [count] and columns z [4 H, count], from the Laplacian [n_c, n_c]."""
    s, _ = blend.stiffness(matrix)
    g = (blend.functions.T @ sp.diags(masses) @ blend.functions).tocsc()
    solver = scipy.sparse.linalg.splu((s + g).tocsc())
    z = np.zeros((s.shape[0], leader_count(count, len(blend.handles))))
    z[blend.translations(), blend.leader_of] = 1
    for _ in range(2):
        y = solver.solve(g @ z)
        values, mixed = scipy.linalg.eigh(y.T @ (s @ y), y.T @ (g @ y), subset_by_index=(0, count - 1))
        z = y @ mixed
    return values, z


def _check_limits(
    mesh: Mesh, side: SideInformation, header: SequenceHeader, limits: Limits, payload_bytes: int
) -> None:
    """spec.md 9: harmonics, basis_values, and the work of the I-frame's payload and of a frame."""
    values = work = frame_work = 0
    for n, l in zip(np.diff(mesh.components).tolist(), side.harmonics):
        require(l <= limits.harmonics, 44, f"a component of {l} harmonics")
        handles = handle_count(n, l, side.handles_per_harmonic, header.reference_shape)
        b = 2 * l + 20
        if handles is not None:
            values += 5 * handles * l
            e = 4 * l // 3
            work += 6000 * n + 4 * handles * e * (6 * e + handles) + 15 * e**3
            frame_work += 9 * l * handles + 3 * l * 4 * handles
            continue
        values += n * l
        frame_work += 12 * l * n
        if l == 1:
            work += n
        else:
            work += 10 * n**3 if b >= n or n <= 96 else 5 * b * b * n
    if header.detail_step > 0:
        values += header.vertices * header.patch_size
        work += 10 * header.vertices * header.patch_size**2
    most = min(limits.basis_work, limits.free_work + limits.work_per_byte * payload_bytes)
    require(values <= limits.basis_values, 44, f"a basis of {values} values")
    require(work <= most, 44, f"a basis that costs {work} multiplications")
    require(frame_work <= limits.frame_work, 44, f"a frame that costs {frame_work} multiplications")


def _component_blend(
    mesh: Mesh, ends: np.ndarray, shape: np.ndarray, begin: int, end: int, handles: int | None, harmonics: int
) -> Blend:
    """spec.md 6.4.4 for the component of the vertices from `begin` to `end` - 1, `ends` counted from `begin`."""
    if handles is None:
        return blend_of_all(begin, end - begin)
    leaders = leader_count(harmonics, handles)
    return blend_of_handles(begin, ends, mesh.grid[begin:end], shape[begin:end], handles, leaders)


def component_harmonics(
    mesh: Mesh,
    edges: Edges,
    weights: np.ndarray,
    masses: np.ndarray,
    shape: np.ndarray,
    side: SideInformation,
    header: SequenceHeader,
    limits: Limits,
    payload_bytes: int,
) -> tuple[list[Blend], list[Harmonics]]:
    """spec.md 6.4: the handles and the harmonics of each component.

    `weights` [e] and `masses` [n] are those on M'0, whose positions are `shape` [n, 3]; `payload_bytes` are those of
    the I-frame. Rules R44 and R45.
    """
    _check_limits(mesh, side, header, limits, payload_bytes)
    blends, result = [], []
    for begin, end, count in zip(mesh.components, mesh.components[1:], side.harmonics):
        handles = handle_count(end - begin, count, side.handles_per_harmonic, header.reference_shape)
        ends, uneven = uneven_edges(edges, weights, mesh.grid, begin, end)
        blend = _component_blend(mesh, ends, shape, begin, end, handles, count)
        matrix = laplacian(end - begin, ends, uneven)
        own_masses = masses[begin:end]
        try:
            if handles is None:
                values, columns = exact_basis(matrix, own_masses, count)
            else:
                values, columns = blended_basis(blend, matrix, own_masses, count)
        except (np.linalg.LinAlgError, sp.linalg.ArpackError, RuntimeError, ValueError) as error:
            raise StreamError(45, f"the harmonics of vertices {begin} to {end - 1}: {error}") from error
        blends.append(blend)
        result.append(scale_and_sign(blend, values, columns, own_masses))
    return blends, result


def patch_harmonics(mesh: Mesh, edges: Edges, weights: np.ndarray) -> list[Harmonics]:
    """spec.md 6.4.7: all harmonics of each patch."""
    result = []
    for begin, end in zip(mesh.patches, mesh.patches[1:]):
        matrix = laplacian(end - begin, *uneven_edges(edges, weights, mesh.grid, begin, end))
        ones = np.ones(end - begin)
        try:
            values, columns = exact_basis(matrix, ones, end - begin)
        except np.linalg.LinAlgError as error:
            raise StreamError(45, f"the harmonics of the patch of vertices {begin} to {end - 1}: {error}") from error
        result.append(scale_and_sign(blend_of_all(begin, end - begin), values, columns, ones))
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
