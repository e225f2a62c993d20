# SPDX-License-Identifier: Apache-2.0
"""From coefficients to positions: spec.md 6.5."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse.linalg

from .errors import StreamError, require
from .group import CodedFrame, PlaneRows
from .harmonics import Harmonics
from .residuals import CORRECTION, DETAIL, DISPLACEMENT, MOTION
from .sequence_header import SequenceHeader
from .shape import Edges, edge_weights, laplacian
from .vertices import Mesh


def rotations(u: np.ndarray) -> np.ndarray:
    """R(u) of spec.md 6.5.2 for rotation vectors [n, 3], in radians: matrices [n, 3, 3]."""
    t = np.sqrt((u**2).sum(axis=1))
    near = t < 1e-4
    safe = np.where(near, 1, t)
    s = np.where(near, 1 - t**2 / 6, np.sin(t) / safe)
    # 1 - cos(t) without cancellation
    c = np.where(near, 0.5 - t**2 / 24, 2 * np.sin(t / 2) ** 2 / safe**2)
    x, y, z = u.T
    rows = [
        [1 - c * (y * y + z * z), c * x * y - s * z, c * x * z + s * y],
        [c * x * y + s * z, 1 - c * (x * x + z * z), c * y * z - s * x],
        [c * x * z - s * y, c * y * z + s * x, 1 - c * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), 2, 0)


def deformation_gradients(channels: np.ndarray) -> np.ndarray:
    """J of spec.md 6.5.2 for motion channels [n, 9]: matrices [n, 3, 3]."""
    xx, yy, zz, xy, xz, yz = channels[:, 3:].T
    stretch = np.moveaxis(np.array([[1 + xx, xy, xz], [xy, 1 + yy, yz], [xz, yz, 1 + zz]]), 2, 0)
    return rotations(channels[:, :3]) @ stretch


def plane_fields(
    vertices: int,
    bases: Sequence[Harmonics],
    rows: Sequence[tuple[int, int]],
    coefficients: np.ndarray,
    units: np.ndarray,
) -> np.ndarray:
    """f of spec.md 6.5.1: values [vertices, channels] from the coefficients of `rows`, pairs (c, k); `units` are unit_c."""
    place = {pair: row for row, pair in enumerate(rows)}
    fields = np.zeros((vertices, coefficients.shape[1]))
    for c, basis in enumerate(bases):
        n, count = basis.vectors.shape
        own = coefficients[[place[c, k] for k in range(count)]]
        fields[basis.begin : basis.begin + n] = basis.vectors @ (own * units[c])
    return fields


class PoissonSystem:
    """spec.md 6.5.3 for one reference shape y [n, 3].

    Setting the gradient of the sum over edges to 0 gives, with the Laplacian of the weights on y,
    (L x)_a = sum over edges (a, b) of w_ab (J_a + J_b) / 2 (y_a - y_b). x is determined but for a translation of each
    component; so each component's first vertex is held, and its mean moved to where it belongs.
    """

    def __init__(self, mesh: Mesh, edges: Edges, masses: np.ndarray, reference: np.ndarray) -> None:
        self.mesh, self.edges, self.masses, self.reference = mesh, edges, masses, reference
        self.weights = edge_weights(edges, mesh.triangles, reference)
        self.free = np.setdiff1d(np.arange(len(reference)), mesh.components[:-1])
        self.solver = None
        if len(self.free):
            matrix = laplacian(len(reference), edges.ends, self.weights)[self.free][:, self.free]
            try:
                self.solver = scipy.sparse.linalg.splu(matrix.tocsc())
            except (RuntimeError, ValueError) as error:
                raise StreamError(57, f"the system of a reference shape: {error}") from error

    def solve(self, gradients: np.ndarray) -> np.ndarray:
        """x [n, 3] for the deformation gradients [n, 3, 3]."""
        a, b = self.edges.ends.T
        y = self.reference
        mean = (gradients[a] + gradients[b]) / 2
        pull = self.weights[:, None] * np.einsum("eij,ej->ei", mean, y[a] - y[b])
        right = np.zeros_like(y)
        np.add.at(right, a, pull)
        np.subtract.at(right, b, pull)
        x = np.zeros_like(y)
        if self.solver:
            x[self.free] = self.solver.solve(right[self.free])
        for begin, end in zip(self.mesh.components, self.mesh.components[1:]):
            masses = self.masses[begin:end, None]
            x[begin:end] += (masses * (y[begin:end] - x[begin:end])).sum(axis=0) / masses.sum()
        return x


class Reconstruction:
    """Makes the frames of a stream; what does not change from frame to frame is computed once."""

    def __init__(
        self,
        header: SequenceHeader,
        mesh: Mesh,
        edges: Edges,
        masses: np.ndarray,
        components: list[Harmonics],
        patches: list[Harmonics],
        rows: PlaneRows,
    ) -> None:
        self.header, self.mesh, self.edges, self.masses = header, mesh, edges, masses
        self.components, self.patches, self.rows = components, patches, rows
        self.m0 = first_shape(header, mesh)
        self.centre = masses @ self.m0
        self.of_m0: PoissonSystem | None = None
        self.previous = self.m0  # x' of the frame before in the group

    def frame(self, coded: CodedFrame) -> np.ndarray:
        """spec.md 6.5: positions [n, 3] of a frame. A group's frames must come in display order."""
        header = self.header
        from_m0 = header.reference_shape == 0 or coded.intra
        reference = self.m0 if from_m0 else self.previous
        x = reference
        if np.any(coded.planes[MOTION].coefficients):
            x = self._system(from_m0).solve(deformation_gradients(self._motion(coded)))
        x = x + self._displacement(coded)
        self.previous = x
        rigid = np.array(coded.rigid, np.float64)
        rotation = rotations(header.rotation_step * rigid[None, :3])[0]
        translation = header.translation_step * rigid[3:]
        positions = (x - self.centre) @ rotation.T + self.centre + translation
        with np.errstate(over="ignore", invalid="ignore"):
            require(bool(np.all(np.isfinite(positions.astype(np.float32)))), 57, "a position beyond binary32")
        return positions

    def _system(self, from_m0: bool) -> PoissonSystem:
        if not from_m0:
            return PoissonSystem(self.mesh, self.edges, self.masses, self.previous)
        if self.of_m0 is None:
            self.of_m0 = PoissonSystem(self.mesh, self.edges, self.masses, self.m0)
        return self.of_m0

    def _units(self, step: float, power: float) -> np.ndarray:
        """step / 16 * (n / n_c)^power of each component: unit_c of spec.md 6.5.1."""
        return step / 16 * (self.header.vertices / np.diff(self.mesh.components)) ** power

    def _motion(self, coded: CodedFrame) -> np.ndarray:
        coefficients = coded.planes[MOTION].coefficients
        units = self._units(self.header.motion_step, 1 / 4)
        return plane_fields(self.header.vertices, self.components, self.rows.harmonics, coefficients, units)

    def _displacement(self, coded: CodedFrame) -> np.ndarray:
        """The sum of the displacement, detail and correction planes, [n, 3] in model units."""
        header, planes = self.header, coded.planes
        total = plane_fields(
            header.vertices,
            self.components,
            self.rows.harmonics,
            planes[DISPLACEMENT].coefficients,
            self._units(header.displacement_step, 1 / 2),
        )
        if DETAIL in planes:
            units = header.detail_step / 16 / np.sqrt(np.diff(self.mesh.patches))
            total += plane_fields(
                header.vertices, self.patches, self.rows.patch_harmonics, planes[DETAIL].coefficients, units
            )
        if CORRECTION in planes:
            total += planes[CORRECTION].coefficients * (header.correction_step / 16)
        return total


def first_shape(header: SequenceHeader, mesh: Mesh) -> np.ndarray:
    """M'0, spec.md 4: positions [n, 3]."""
    return np.array(header.origin) + header.cell * mesh.grid.astype(np.float64)
