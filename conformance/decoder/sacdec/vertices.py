# SPDX-License-Identifier: Apache-2.0
"""Joining Draco's entries into vertices, and the numbering of vertices: spec.md 5.3 and 5.4."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from .draco_mesh import DracoMesh
from .errors import require
from .i_frame import SideInformation


@dataclass
class Mesh:
    """The mesh of a clip, in the final numbering of 5.3.

    Positions are `grid` [n, 3], integers. Components and patches are runs of vertices, from `components[i]` to
    `components[i + 1]` - 1. Attributes are None where there are none. `normals` are those of vertices, or, if
    `normal_triangles` [m, 3] is there, those that it gives the indices of for corners.
    """

    grid: np.ndarray
    triangles: np.ndarray
    components: list[int]
    patches: list[int]
    normals: np.ndarray | None = None
    normal_triangles: np.ndarray | None = None
    colors: np.ndarray | None = None
    uvs: np.ndarray | None = None
    uv_triangles: np.ndarray | None = None
    order: list[int] | None = None


def join_entries(entries: int, welds: Iterable[tuple[int, int]]) -> tuple[np.ndarray, int]:
    """spec.md 5.3 step 1: the vertex of each entry, and how many vertices these are."""
    onto = dict(welds)
    require(all(point < entries for point in onto), 37, "a weld of an entry that does not exist")
    vertex = np.zeros(entries, np.int64)
    count = 0
    for entry in range(entries):
        if entry in onto:
            vertex[entry] = vertex[onto[entry]]
        else:
            vertex[entry] = count
            count += 1
    return vertex, count


def neighbours(count: int, triangles: Iterable[Sequence[int]]) -> list[set[int]]:
    """The other vertices that each vertex has an edge with. Triangles of two equal corners count too."""
    result: list[set[int]] = [set() for _ in range(count)]
    for triangle in triangles:
        for a in triangle:
            for b in triangle:
                if a != b:
                    result[a].add(b)
    return result


def connected_pieces(part: Iterable[int], joined: Sequence[set[int]]) -> list[list[int]]:
    """The connected pieces of a set of vertices by edges within it: pieces by their smallest vertex, each ascending."""
    left = set(part)
    pieces = []
    for start in sorted(left):
        if start not in left:
            continue
        left.discard(start)
        piece = [start]
        for vertex in piece:
            reached = joined[vertex] & left
            left -= reached
            piece.extend(reached)
        pieces.append(sorted(piece))
    return pieces


def cut_patches(part: list[int], grid: np.ndarray, joined: Sequence[set[int]], patch_size: int) -> list[list[int]]:
    """`cut` of spec.md 5.4: the patches of a part, in the order in which they arise. `part` is ascending."""
    if len(part) <= patch_size:
        return connected_pieces(part, joined)
    positions = grid[part]
    axis = int(np.argmax(positions.max(axis=0) - positions.min(axis=0)))  # the first of several
    ordered = sorted(part, key=lambda vertex: (grid[vertex, axis], vertex))
    half = len(ordered) // 2
    return cut_patches(sorted(ordered[:half]), grid, joined, patch_size) + cut_patches(
        sorted(ordered[half:]), grid, joined, patch_size
    )


def _numbering(grid: np.ndarray, triangles: np.ndarray, patch_size: int) -> tuple[list[int], list[int], list[int]]:
    """spec.md 5.3 step 2: the vertex of step 1 of each final one; where components and patches begin."""
    joined = neighbours(len(grid), triangles.tolist())
    final: list[int] = []
    components, patches = [0], [0]
    for component in connected_pieces(range(len(grid)), joined):
        for patch in cut_patches(component, grid, joined, patch_size):
            final.extend(patch)
            patches.append(len(final))
        components.append(len(final))
    return final, components, patches


def _loose_uv_triangles(mesh: DracoMesh, vertex: np.ndarray, loose: Sequence[Sequence[int]]) -> np.ndarray:
    """spec.md 5.3, "Texture coordinates": a corner of a loose triangle takes its vertex's first corner's index, or 0."""
    first: dict[int, int] = {}
    for corner, uv in zip(vertex[mesh.triangles].ravel().tolist(), mesh.uv_triangles.ravel().tolist()):
        first.setdefault(corner, uv)
    return np.array([[first.get(corner, 0) for corner in triangle] for triangle in loose], np.int64).reshape(-1, 3)


def _colors(count: int, of_entries: np.ndarray | None, vertex: np.ndarray, loose: list) -> np.ndarray | None:
    """spec.md 5.3, "Colours": of the last of a vertex's entries, or the loose vertex's own (None: it has none)."""
    has_loose = any(value is not None for value in loose)
    if of_entries is None and not has_loose:
        return None
    result = np.zeros((count, 4), np.int64)
    if of_entries is not None:
        for entry, target in enumerate(vertex):
            result[target] = of_entries[entry]
    for i, value in enumerate(loose):
        if value is not None:
            result[count - len(loose) + i] = value
    return result


def _corner_normals(
    draco: DracoMesh, triangles: np.ndarray, own: dict[int, tuple[float, ...]]
) -> list[tuple[int, bytes]]:
    """spec.md 5.3, "Normals": the vertex and the bits of the normal of each corner. `triangles` are all, by the vertices
    of step 1, `own` the loose vertices' normals."""
    zero = np.zeros(3, np.float32).tobytes()
    first = {vertex: np.array(normal, np.float32).tobytes() for vertex, normal in own.items()}
    corners = triangles[: len(draco.triangles)].ravel().tolist()
    of_draco = [zero] * len(corners)
    if draco.normals is not None:
        of_draco = [normal.tobytes() for normal in draco.normals.reshape(-1, 3)]
    for vertex, normal in reversed(list(zip(corners, of_draco))):
        first[vertex] = normal
    of_loose = [first.get(vertex, zero) for vertex in triangles[len(draco.triangles) :].ravel().tolist()]
    return list(zip(triangles.ravel().tolist(), of_draco + of_loose))


def _normals(
    draco: DracoMesh, triangles: np.ndarray, count: int, loose: list
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """spec.md 5.3, "Normals": those of vertices, by the numbers of step 1, and None; or those of corners and, for each
    corner, the index of its own. `loose` are the loose vertices' normals (None: they have none)."""
    own = {count - len(loose) + i: normal for i, normal in enumerate(loose) if normal is not None}
    if draco.normals is None and not own:
        return None, None
    corners = _corner_normals(draco, triangles, own)
    bits = dict(corners)
    if all(bits[vertex] == normal for vertex, normal in corners):
        normals = np.zeros((count, 3), np.float32)
        for vertex, normal in own.items():
            normals[vertex] = normal
        for vertex, normal in bits.items():
            normals[vertex] = np.frombuffer(normal, np.float32)
        return normals, None
    numbers: dict[tuple[int, bytes], int] = {}
    indices = [numbers.setdefault(corner, len(numbers)) for corner in corners]
    normals = np.frombuffer(b"".join(normal for _, normal in numbers), np.float32).reshape(-1, 3)
    return normals, np.array(indices, np.int64).reshape(-1, 3)


def build_mesh(
    draco: DracoMesh,
    vertex: np.ndarray,
    coded: np.ndarray,
    side: SideInformation,
    vertices: int,
    triangles: int,
    patch_size: int,
) -> Mesh:
    """spec.md 5.3: the mesh from Draco's, the vertices of its entries, their grid positions `coded` [.., 3], and the
    side information. Rules R39 to R43."""
    loose = side.loose_vertices
    if loose:
        require(draco.normals is None or side.has_normals == 1, 39, "loose vertices without normals")
        require(draco.colors is None or side.has_colors == 1, 39, "loose vertices without colours")
    count = len(coded) + len(loose)
    require(count == vertices, 40, f"{count} vertices")
    all_triangles = np.concatenate(
        [vertex[draco.triangles].reshape(-1, 3), np.array(side.loose_triangles, np.int64).reshape(-1, 3)]
    )
    require(len(all_triangles) == triangles, 41, f"{len(all_triangles)} triangles")

    grid = np.concatenate([coded.reshape(-1, 3), np.array([v.position for v in loose], np.int64).reshape(-1, 3)])
    final, components, patches = _numbering(grid, all_triangles, patch_size)
    sizes = np.diff(components)
    require(len(sizes) == len(side.harmonics), 42, f"{len(sizes)} components")
    require(bool(np.all(sizes >= side.harmonics)), 43, "a component has more harmonics than vertices")

    number = np.empty(count, np.int64)  # the final number of each vertex of step 1
    number[final] = np.arange(count)
    mesh = Mesh(grid[final], number[all_triangles], components, patches, order=side.order)
    mesh.normals, mesh.normal_triangles = _normals(draco, all_triangles, count, [v.normal for v in loose])
    if mesh.normals is not None and mesh.normal_triangles is None:
        mesh.normals = mesh.normals[final]
    colors = _colors(count, draco.colors, vertex, [v.color for v in loose])
    mesh.colors = None if colors is None else colors[final]
    if draco.uvs is not None:
        mesh.uvs = draco.uvs
        mesh.uv_triangles = np.concatenate(
            [draco.uv_triangles, _loose_uv_triangles(draco, vertex, side.loose_triangles)]
        )
    return mesh
