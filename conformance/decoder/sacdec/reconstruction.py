# SPDX-License-Identifier: Apache-2.0
"""From coefficients to positions: spec.md 6.5."""

from collections.abc import Sequence

import numpy as np
import scipy.sparse.linalg

from .errors import StreamError, require
from .group import CodedFrame, PlaneRows
from .handles import Blend
from .harmonics import Harmonics
from .residuals import CORRECTION, DETAIL, DISPLACEMENT, MOTION
from .sequence_header import SequenceHeader
from .shape import Edges, edge_weights, laplacian, uneven_edges
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


def fields(
    bases: Sequence[np.ndarray], rows: Sequence[tuple[int, int]], coefficients: np.ndarray, units: np.ndarray
) -> list[np.ndarray]:
    """f of spec.md 6.5.1 of each component or patch: values [.., channels] at what its basis [.., l_c] is given at.

    `rows` are the pairs (c, k) of the rows of `coefficients`; `units` are unit_c.
    """
    place = {pair: row for row, pair in enumerate(rows)}
    result = []
    for c, basis in enumerate(bases):
        own = coefficients[[place[c, k] for k in range(basis.shape[1])]]
        result.append(basis @ (own * units[c]))
    return result


class BlendSystem:
    """spec.md 6.5.3 for one component and its reference shape y [n_c, 3].

    x = Psi z, and the rows of z are numbered as the text says. Setting the gradient of the sum to 0 gives, with J_a the
    blend of the handles' J at vertex a, S z = Psi^T p + r J: p_a is the sum over edges (a, b) of w_ab (J_a + J_b) / 2
    (y_a - y_b), and r J adds to the rows of the first kind the columns of the handles' J. z is determined but for a
    translation; so the first handle is held, and the mean moved to where it belongs.
    """

    def __init__(
        self, blend: Blend, ends: np.ndarray, weights: np.ndarray, masses: np.ndarray, reference: np.ndarray
    ) -> None:
        """`ends` [e, 2] are the component's edges, `weights` [e] their uneven weights on y, `masses` [n_c] of M'0."""
        self.blend, self.ends, self.weights, self.masses, self.reference = blend, ends, weights, masses, reference
        s, self.r = blend.stiffness(laplacian(len(reference), ends, weights))
        self.free = np.delete(np.arange(s.shape[0]), blend.translations()[0])
        self.solver = None
        if len(self.free):
            try:
                self.solver = scipy.sparse.linalg.splu(s[self.free][:, self.free].tocsc())
            except (RuntimeError, ValueError) as error:
                raise StreamError(57, f"the system of a reference shape: {error}") from error

    def solve(self, gradients: np.ndarray) -> np.ndarray:
        """z [functions, 3] for the deformation gradients [H, 3, 3]."""
        a, b = self.ends.T
        y = self.reference
        blended = (self.blend.weights @ gradients.reshape(-1, 9)).reshape(-1, 3, 3)
        pull = self.weights[:, None] * np.einsum("eij,ej->ei", (blended[a] + blended[b]) / 2, y[a] - y[b])
        pulls = np.zeros_like(y)
        np.add.at(pulls, a, pull)
        np.subtract.at(pulls, b, pull)
        right = self.blend.functions.T @ pulls
        if self.r:
            right.reshape(-1, 4, 3)[:, :3] += self.r * gradients.transpose(0, 2, 1)
        z = np.zeros_like(right)
        if self.solver:
            z[self.free] = self.solver.solve(right[self.free])
        away = y - self.blend.functions @ z
        z[self.blend.translations()] += self.masses @ away / self.masses.sum()
        return z


class Reconstruction:
    """Makes the frames of a segment; what does not change from frame to frame is computed once."""

    def __init__(
        self,
        header: SequenceHeader,
        mesh: Mesh,
        edges: Edges,
        masses: np.ndarray,
        blends: list[Blend],
        components: list[Harmonics],
        patches: list[Harmonics],
        rows: PlaneRows,
    ) -> None:
        self.header, self.mesh, self.edges, self.masses = header, mesh, edges, masses
        self.blends, self.components, self.patches, self.rows = blends, components, patches, rows
        self.m0 = first_shape(header, mesh)
        self.centre = masses @ self.m0
        self.of_m0: list[BlendSystem] | None = None
        self.previous = self.m0  # x' of the frame before in the group

    def frame(self, coded: CodedFrame) -> np.ndarray:
        """spec.md 6.5: positions of the copies in a frame. A group's frames must come in display order."""
        header = self.header
        from_m0 = header.reference_shape == 0 or coded.is_intra
        moved = [z + d for z, d in zip(self._motion(coded, from_m0), self._displacement(coded))]
        x = np.concatenate([blend.functions @ z for blend, z in zip(self.blends, moved)])
        x = x + self._at_vertices(coded)
        self.previous = x
        rigid = np.array(coded.rigid, np.float64)
        rotation = rotations(header.rotation_step * rigid[None, :3])[0]
        translation = header.translation_step * rigid[3:]
        positions = (x - self.centre) @ rotation.T + self.centre + translation
        with np.errstate(over="ignore", invalid="ignore"):
            require(bool(np.all(np.isfinite(positions.astype(np.float32)))), 57, "a position beyond binary32")
        return positions[self.mesh.vertex_of_copy]

    def _motion(self, coded: CodedFrame, from_m0: bool) -> list[np.ndarray]:
        """z of each component before the displacement plane: spec.md 6.5.3."""
        reference = self.m0 if from_m0 else self.previous
        coefficients = coded.planes[MOTION].coefficients
        if not np.any(coefficients):
            return [blend.at_rest(reference[blend.begin : blend.end]) for blend in self.blends]
        at_handles = [part.vectors[blend.handles] for part, blend in zip(self.components, self.blends)]
        units = self._units(self.header.motion_step, 1 / 4)
        channels = fields(at_handles, self.rows.harmonics, coefficients, units)
        return [
            system.solve(deformation_gradients(own)) for system, own in zip(self._systems(from_m0, reference), channels)
        ]

    def _systems(self, from_m0: bool, reference: np.ndarray) -> list[BlendSystem]:
        """The system of each component on the reference shape."""
        if from_m0 and self.of_m0 is not None:
            return self.of_m0
        weights = edge_weights(self.edges, self.mesh.triangles, reference)
        systems = []
        for blend in self.blends:
            begin, end = blend.begin, blend.end
            ends, uneven = uneven_edges(self.edges, weights, self.mesh.grid, begin, end)
            systems.append(BlendSystem(blend, ends, uneven, self.masses[begin:end], reference[begin:end]))
        if from_m0:
            self.of_m0 = systems
        return systems

    def _units(self, step: float, power: float) -> np.ndarray:
        """step / 16 * (n / n_c)^power of each component: unit_c of spec.md 6.5.1."""
        return step / 16 * (self.header.vertices / np.diff(self.mesh.components)) ** power

    def _patch_scales(self) -> np.ndarray:
        """s of the component of each patch."""
        components = np.searchsorted(self.mesh.components, self.mesh.patches[:-1], side="right") - 1
        return self.mesh.scales[components]

    def _displacement(self, coded: CodedFrame) -> list[np.ndarray]:
        """What the displacement plane adds to z of each component, [functions, 3]."""
        columns = [part.columns for part in self.components]
        units = self._units(self.header.displacement_step, 1 / 2) / 2.0**self.mesh.scales
        return fields(columns, self.rows.harmonics, coded.planes[DISPLACEMENT].coefficients, units)

    def _at_vertices(self, coded: CodedFrame) -> np.ndarray:
        """The sum of the detail and correction planes, [n, 3] in model units."""
        header, planes = self.header, coded.planes
        total = np.zeros((header.vertices, 3))
        if DETAIL in planes:
            units = header.detail_step / 16 / np.sqrt(np.diff(self.mesh.patches)) / 2.0 ** self._patch_scales()
            vectors = [part.vectors for part in self.patches]
            total += np.concatenate(fields(vectors, self.rows.patch_harmonics, planes[DETAIL].coefficients, units))
        if CORRECTION in planes:
            total += planes[CORRECTION].coefficients * (header.correction_step / 16)
        return total


def first_shape(header: SequenceHeader, mesh: Mesh) -> np.ndarray:
    """M'0, spec.md 4: positions [n, 3]."""
    sizes = np.diff(mesh.components)
    finer = 2.0 ** np.repeat(mesh.scales, sizes)[:, None]
    begin = np.repeat(mesh.part_origins, sizes, axis=0)
    return np.array(header.origin) + header.cell * (begin + mesh.grid / finer)
