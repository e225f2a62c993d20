# SPDX-License-Identifier: Apache-2.0
"""Joining Draco's entries into vertices, and the numbering of vertices: spec.md 5.3 and 5.4."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from .draco_mesh import DracoMesh
from .errors import require
from .i_frame import SideInformation
from .sequence_header import SequenceHeader


@dataclass
class Mesh:
    """The mesh of a clip, in the final numbering of 5.3.

    Positions are `grid` [n, 3], integers, `triangles` [m, 3] those of vertices. What is given out are copies:
    `vertex_of_copy` has the vertex of each, `copy_triangles` the triangles of copies. Components and patches are runs of
    vertices, from `components[i]` to `components[i + 1]` - 1; `scales` and `part_origins` [.., 3] are those of components. Attributes are those of copies, None where there are none.
    `normals` are those of copies, or, if `normal_triangles` [m, 3] is there, those that it gives the indices of for
    corners.
    """

    grid: np.ndarray
    triangles: np.ndarray
    vertex_of_copy: np.ndarray
    copy_triangles: np.ndarray
    components: list[int]
    patches: list[int]
    scales: np.ndarray
    part_origins: np.ndarray
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


def _number_copies(final: list[int], counts: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """spec.md 5.3, "Output": the final vertex of each copy; the number of the first copy of each vertex of step 1, as it
    is output; and the copies of step 1, where a vertex's follow those of the vertex before, by their numbers in the
    output."""
    of_final = counts[final]
    vertex_of_copy = np.repeat(np.arange(len(final)), of_final)
    first = np.empty(len(final), np.int64)
    first[final] = np.cumsum(of_final) - of_final
    output = np.empty(len(vertex_of_copy), np.int64)
    for vertex, begin in enumerate(np.cumsum(counts) - counts):
        output[first[vertex] + np.arange(counts[vertex])] = begin + np.arange(counts[vertex])
    return vertex_of_copy, first, output


def _loose_uv_triangles(draco: DracoMesh, corners: np.ndarray) -> np.ndarray:
    """spec.md 5.3, "Texture coordinates": a corner of a loose triangle takes its copy's first corner's index, or 0.
    `corners` are the copies of all triangles' corners."""
    count = len(draco.triangles)
    first: dict[int, int] = {}
    for corner, uv in zip(corners[:count].ravel().tolist(), draco.uv_triangles.ravel().tolist()):
        first.setdefault(corner, uv)
    loose = corners[count:].tolist()
    return np.array([[first.get(corner, 0) for corner in triangle] for triangle in loose], np.int64).reshape(-1, 3)


def _colors(draco: DracoMesh, corners: np.ndarray, copies: int, own: dict[int, tuple]) -> np.ndarray | None:
    """spec.md 5.3, "Colours": of the last of a copy's corners, or its loose vertex's own."""
    if draco.colors is None and not own:
        return None
    result = np.zeros((copies, 4), np.int64)
    for copy, value in own.items():
        result[copy] = value
    if draco.colors is not None:
        for copy, value in zip(corners[: len(draco.triangles)].ravel(), draco.colors.reshape(-1, 4)):
            result[copy] = value
    return result


def _corner_normals(
    draco: DracoMesh, corners: np.ndarray, own: dict[int, tuple[float, ...]]
) -> list[tuple[int, bytes]]:
    """spec.md 5.3, "Normals": the copy and the bits of the normal of each corner. `own` are the loose vertices' normals,
    by their copies."""
    zero = np.zeros(3, np.float32).tobytes()
    first = {copy: np.array(normal, np.float32).tobytes() for copy, normal in own.items()}
    of_triangles = corners[: len(draco.triangles)].ravel().tolist()
    of_draco = [zero] * len(of_triangles)
    if draco.normals is not None:
        of_draco = [normal.tobytes() for normal in draco.normals.reshape(-1, 3)]
    for copy, normal in reversed(list(zip(of_triangles, of_draco))):
        first[copy] = normal
    of_loose = [first.get(copy, zero) for copy in corners[len(draco.triangles) :].ravel().tolist()]
    return list(zip(corners.ravel().tolist(), of_draco + of_loose))


def _normals(
    draco: DracoMesh, corners: np.ndarray, copies: int, own: dict[int, tuple[float, ...]]
) -> tuple[np.ndarray | None, np.ndarray | None]:
    """spec.md 5.3, "Normals": those of copies and None; or those of corners and, for each corner, the index of its
    own."""
    if draco.normals is None and not own:
        return None, None
    normal_of_corner = _corner_normals(draco, corners, own)
    bits = dict(normal_of_corner)
    if all(bits[copy] == normal for copy, normal in normal_of_corner):
        normals = np.zeros((copies, 3), np.float32)
        for copy, normal in own.items():
            normals[copy] = normal
        for copy, normal in bits.items():
            normals[copy] = np.frombuffer(normal, np.float32)
        return normals, None
    numbers: dict[tuple[int, bytes], int] = {}
    indices = [numbers.setdefault(corner, len(numbers)) for corner in normal_of_corner]
    normals = np.frombuffer(b"".join(normal for _, normal in numbers), np.float32).reshape(-1, 3)
    return normals, np.array(indices, np.int64).reshape(-1, 3)


@dataclass
class Joined:
    """What 5.3 step 1 makes: the grid positions of Draco's vertices [.., 3], all triangles [m, 3] by the numbers of this
    step, the copy of each of their corners [m, 3] and the number of copies of each vertex."""

    coded: np.ndarray
    triangles: np.ndarray
    copies: np.ndarray
    counts: np.ndarray


def all_triangles(draco: DracoMesh, vertex: np.ndarray, side: SideInformation) -> np.ndarray:
    """spec.md 5.3 step 1: Draco's triangles, then the loose ones. `vertex` is that of each entry."""
    loose = np.array(side.loose_triangles, np.int64).reshape(-1, 3)
    return np.concatenate([vertex[draco.triangles].reshape(-1, 3), loose])


def check_parts(draco: DracoMesh, side: SideInformation, vertices: int, triangles: int, header: SequenceHeader) -> None:
    """Rules R39 to R41, of so many vertices and triangles."""
    if side.loose_vertices:
        require(draco.normals is None or side.has_normals == 1, 39, "loose vertices without normals")
        require(draco.colors is None or side.has_colors == 1, 39, "loose vertices without colours")
    require(vertices == header.vertices, 40, f"{vertices} vertices")
    require(triangles == header.triangles, 41, f"{triangles} triangles")


def build_mesh(draco: DracoMesh, joined: Joined, side: SideInformation, patch_size: int) -> Mesh:
    """spec.md 5.3 from step 2 on. Rules R42 and R43."""
    loose = side.loose_vertices
    of_loose = np.array([v.position for v in loose], np.int64).reshape(-1, 3)
    grid = np.concatenate([joined.coded.reshape(-1, 3), of_loose])
    final, components, patches = _numbering(grid, joined.triangles, patch_size)
    sizes = np.diff(components)
    require(len(sizes) == len(side.harmonics), 42, f"{len(sizes)} components")
    require(bool(np.all(sizes >= side.harmonics)), 43, "a component has more harmonics than vertices")

    number = np.empty(len(grid), np.int64)  # the final number of each vertex of step 1
    number[final] = np.arange(len(grid))
    vertex_of_copy, first, output = _number_copies(final, joined.counts)
    copy_triangles = first[joined.triangles] + joined.copies
    mesh = Mesh(
        grid[final],
        number[joined.triangles],
        vertex_of_copy,
        copy_triangles,
        components,
        patches,
        np.array(side.scales, np.int64),
        np.array(side.part_origins, np.int64).reshape(-1, 3),
        order=side.order,
    )
    begin = np.cumsum(joined.counts) - joined.counts  # the first copy of each vertex, both by the numbers of step 1
    corners = begin[joined.triangles] + joined.copies
    copies_of_loose = [
        (begin[v] + i, own)
        for v, own in enumerate(loose, len(grid) - len(loose))
        for i in range(joined.counts[v])
    ]
    own_normals = {copy: v.normal for copy, v in copies_of_loose if v.normal is not None}
    own_colors = {copy: v.color for copy, v in copies_of_loose if v.color is not None}
    mesh.normals, mesh.normal_triangles = _normals(draco, corners, len(vertex_of_copy), own_normals)
    if mesh.normals is not None and mesh.normal_triangles is None:
        mesh.normals = mesh.normals[output]
    colors = _colors(draco, corners, len(vertex_of_copy), own_colors)
    mesh.colors = None if colors is None else colors[output]
    if draco.uvs is not None:
        mesh.uvs = draco.uvs
        mesh.uv_triangles = np.concatenate([draco.uv_triangles, _loose_uv_triangles(draco, corners)])
    return mesh
