"""B and M of each part of a system at many states at once, and which of these states are regular: in float64."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import comb

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.lanes.loops_in_lanes import DEPENDENT, LoopsInLanes, block, lengths_of
from symgen.verify.reference.configurations.manifold import ManifoldRanks
from symgen.verify.reference.system import ReferenceSystem
from symgen.verify.sampling.regular import REGULAR_SHARE

# Of rows of length 1: what is more than rounding leaves of rows that depend on others.
INDEPENDENT = 1e2 * DEPENDENT
# Of the largest singular value of rows: below it a direction is being lost.
LOST = 0.03
# Inputs from which on a decomposition of all of them takes longest.
MANY_INPUTS = 40


@dataclass(frozen=True)
class RankedPart:
    """A part of the system with the ranks of its rows and of its inputs along what these leave free."""

    coordinates: Sequence[int]
    rows: Sequence[int]
    inputs: Sequence[int]
    constraints: int
    actuation: int


def ranked_parts(system: ReferenceSystem, ranks: ManifoldRanks) -> list[RankedPart]:
    """The parts of a system; all of it where it is not known which parts lack ranks."""
    if len(ranks.of_parts) != len(system.parts):
        return [RankedPart(range(system.n), range(system.r), range(system.m), ranks.constraints, ranks.actuation)]
    pairs = zip(system.parts, ranks.of_parts, strict=True)
    return [RankedPart(part.coordinates, part.rows, part.inputs, *own) for part, own in pairs]


def matrices(
    system: ReferenceSystem, parts: Sequence[RankedPart], loops: LoopsInLanes, q: Lanes, p: Lanes
) -> list[tuple[Lanes, Lanes]]:
    """B and M of each part."""
    n, m, r = system.n, system.m, system.r
    made = loops.matrices(q, p)
    return [
        (
            block(made, [[i * n + j for j in part.coordinates] for i in part.rows], len(part.coordinates)),
            block(made, [[r * n + j * m + k for k in part.inputs] for j in part.coordinates], len(part.inputs)),
        )
        for part in parts
    ]


def is_regular(
    part: RankedPart, rows: Lanes, control: Lanes, other_branches: bool = True, share: float = REGULAR_SHARE
) -> Lanes:
    """Whether rows, and inputs along what the rows leave free, are as far from dependent as regular states are.

    Configurations of greater ranks lie on `other_branches`, which may count or not.
    """
    good: Lanes = np.isfinite(rows).all(axis=(1, 2)) & np.isfinite(control).all(axis=(1, 2))
    rows, control = rows.copy(), control.copy()
    rows[~good], control[~good] = 0.0, 0.0
    count, r, n = rows.shape
    columns = np.swapaxes(control, 1, 2)
    columns = columns / lengths_of(columns)
    apart = _few_rows(r, columns[good])
    free = np.broadcast_to(np.eye(n), (count, n, n))
    held = np.zeros((count, 0, n))
    if r:
        sizes, directions = np.linalg.svd(rows / lengths_of(rows), full_matrices=not apart)[1:]
        rank = part.constraints
        good &= sizes[:, rank - 1] >= share * sizes[:, 0] if rank else True
        if not other_branches:
            good &= (sizes[:, rank:] <= INDEPENDENT).all(axis=1)
        held, free = directions[:, :rank], directions[:, rank:]
    if part.actuation or not other_branches:
        along = np.swapaxes(columns, 1, 2)
        sizes = _along_few_rows(held @ along) if apart else np.linalg.svd(free @ along, compute_uv=False)
        good &= sizes[:, part.actuation - 1] >= share if part.actuation else True
        if not other_branches:
            good &= (sizes[:, part.actuation :] <= INDEPENDENT).all(axis=1)
    return good


def _few_rows(r: int, columns: Lanes) -> bool:
    """Whether there are many more inputs than rows, and inputs stand at right angles to each other, as drives do."""
    m, n = columns.shape[1:]
    if m < MANY_INPUTS or m <= r or m > n:
        return False
    return bool(np.all(np.count_nonzero(columns, axis=1) <= 1) and np.all(np.count_nonzero(columns, axis=2) == 1))


def _along_few_rows(held: Lanes) -> Lanes:
    """The singular values of inputs of length 1 at right angles along what rows leave free, the largest first.

    They are 1 but for as many as there are rows, and those follow from the shares that the rows hold.  What is below
    1e-8 is rounding.
    """
    count, rank, m = held.shape
    sizes = np.ones((count, m))
    shares = np.linalg.svd(held, compute_uv=False)
    sizes[:, m - rank :] = np.sqrt(np.maximum(1 - shares[:, ::-1] ** 2, 0))
    return sizes


def measures(parts: Sequence[RankedPart], blocks: Sequence[tuple[Lanes, Lanes]], together: bool = False) -> Lanes:
    """What `singularity` gives of B and M of each part: of the rows, and of the inputs along what these leave free.

    That of the rows is a product: where several directions are lost `together` only the least of them counts, if asked
    for so.
    """
    of_rows, of_inputs, whole = [], [], []
    for part, (rows, control) in zip(parts, blocks, strict=True):
        rows, control = (np.where(np.isfinite(made), made, 0.0) for made in (rows, control))
        count, r, n = rows.shape
        free = np.broadcast_to(np.eye(n), (count, n, n))
        if r:
            sizes, directions = np.linalg.svd(rows / lengths_of(rows))[1:]
            of_rows.append(sizes)
            free = directions[:, part.constraints :]
        of_inputs.append(np.linalg.svd(free @ control, compute_uv=False))
        whole.append(np.linalg.svd(control, compute_uv=False))
    rows_rank, inputs_rank = (sum(ranks) for ranks in zip(*((p.constraints, p.actuation) for p in parts), strict=True))
    all_rows, count = sum(made.shape[1] for made, _ in blocks), len(blocks[0][0])
    rows_measure = _sum_of_minors(count, of_rows, rows_rank) / comb(all_rows, rows_rank)
    if together:
        rows_measure = rows_measure * lost_together(parts, blocks)
    least, most = (_sum_of_minors(count, sizes, inputs_rank) for sizes in (of_inputs, whole))
    return np.stack([rows_measure, np.divide(least, most, out=np.zeros(count), where=most > 0)], axis=1)


def lost_together(parts: Sequence[RankedPart], blocks: Sequence[tuple[Lanes, Lanes]]) -> Lanes:
    """The factor by which the measure of rows is less for other directions that are lost than the least of each part.

    Flat, a linkage of Sarrus loses two at once: a ten-thousandth from there its measure is 1e-16, and not 1e-8.
    """
    factor = np.ones(len(blocks[0][0]))
    for part, (rows, _) in zip(parts, blocks, strict=True):
        if part.constraints > 1:
            sizes = np.linalg.svd(np.nan_to_num(rows / lengths_of(rows)), compute_uv=False)[:, : part.constraints - 1]
            with np.errstate(all="ignore"):
                lost = np.maximum(1.0, (LOST * sizes[:, :1] / sizes) ** 2)
            factor = factor * np.nan_to_num(lost).prod(axis=1)
    return factor


def _sum_of_minors(count: int, sizes: Sequence[Lanes], rank: int) -> Lanes:
    """Of the squares of so many singular values, all products of `rank`, summed."""
    sums = np.zeros((rank + 1, count))
    sums[0] = 1
    for made in sizes:
        for square in (made * made).T:
            sums[1:] += square * sums[:-1]
    return sums[rank]
