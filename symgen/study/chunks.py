"""The chunks of a study: which points each has, fixed by the study alone, and their values."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from symgen.study.asked.request import GRID, LATIN_HYPERCUBE, RANDOM
from symgen.study.plan import StudyPlan

Array = NDArray[np.float64]
# Chunks that a study has at least, so that several workers have something to do.
FEWEST_CHUNKS = 32
# States of a chunk at least: fewer take less time than handing them out does.
FEWEST_CHUNK_STATES = 16_384
# States of a chunk at most, of which a core makes three a second: what is lost where it is interrupted.
MOST_CHUNK_STATES = 2**24
# Chunks from which on they get larger instead: 8 for each of 1 000 cores, as many as a scheduler hands out in 10 s.
MANY_CHUNKS = 8192
# States of such a larger chunk at most: a core takes 3 s.
MOST_LARGE_CHUNK_STATES = 2**27
# Points of a chunk at most: what is kept of them stands in memory.
MOST_CHUNK_POINTS = 2**19


@dataclass(frozen=True, slots=True)
class ChunkGrid:
    """Boxes of the grid of points, numbered with the last axis first; all but the last along an axis have `sides`."""

    shape: tuple[int, ...]
    sides: tuple[int, ...]

    @property
    def counts(self) -> tuple[int, ...]:
        """How many boxes there are along each axis."""
        return tuple(-(-size // side) for size, side in zip(self.shape, self.sides, strict=True))

    def __len__(self) -> int:
        return int(np.prod([1, *self.counts], dtype=object))

    def slices(self, number: int) -> tuple[slice, ...]:
        """The points of a chunk along each axis."""
        places = np.unravel_index(number, self.counts)
        ends = zip(places, self.sides, self.shape, strict=True)
        return tuple(slice(int(k) * side, min(size, (int(k) + 1) * side)) for k, side, size in ends)


def chunk_grid(plan: StudyPlan) -> ChunkGrid:
    """Boxes of points that stand together in their order: whole last axes, a part of one, single values before."""
    total = plan.points * plan.states
    most = min(max(total // MANY_CHUNKS, MOST_CHUNK_STATES), MOST_LARGE_CHUNK_STATES)
    wanted = min(max(total // FEWEST_CHUNKS, FEWEST_CHUNK_STATES), most)
    room = max(1, min(wanted // plan.states, MOST_CHUNK_POINTS))
    sides: list[int] = []
    for size in reversed(plan.shape):
        side = max(1, min(size, room))
        sides.insert(0, side)
        room = room // size
    return ChunkGrid(plan.shape, tuple(sides))


def chunk_values(plan: StudyPlan, chunks: ChunkGrid, number: int) -> Array:
    """The values of the varied names at the points of a chunk, points x names."""
    slices = chunks.slices(number)
    if plan.request.sample == GRID:
        return product_of([axis_values(plan, k)[part] for k, part in enumerate(slices)])
    unit = _unit_values(plan, slices[0].start, slices[0].stop, number)
    first, last = (np.array([getattr(one.axis, end) for one in plan.over]) for end in ("first", "last"))
    return np.asarray(first + unit * (last - first))


def point_values(plan: StudyPlan, chunks: ChunkGrid, numbers: Sequence[int]) -> Array:
    """The values of the varied names at points with these numbers, points x names."""
    if plan.request.sample == GRID:
        places = [np.unravel_index(number, plan.shape) for number in numbers]
        axes = [axis_values(plan, k) for k in range(len(plan.over))]
        values = [[axis[k] for axis, k in zip(axes, at, strict=True)] for at in places]
        return np.array(values).reshape(len(numbers), -1)
    side = chunks.sides[0]
    whole = {number // side for number in numbers}
    by_chunk = {number: chunk_values(plan, chunks, number) for number in sorted(whole)}
    return np.stack([by_chunk[number // side][number % side] for number in numbers])


def axis_values(plan: StudyPlan, place: int) -> Array:
    """The values of an axis of a grid."""
    axis = plan.over[place].axis
    return np.linspace(axis.first, axis.last, axis.count or 1)


def along_values(plan: StudyPlan) -> Array:
    """The values of what varies at each point, states x names."""
    return product_of([np.linspace(one.axis.first, one.axis.last, one.axis.count or 1) for one in plan.along])


def product_of(axes: Sequence[Array]) -> Array:
    """All combinations of the values of some axes, the last one first; combinations x axes."""
    if not axes:
        return np.empty((1, 0))
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))


def _unit_values(plan: StudyPlan, start: int, stop: int, number: int) -> Array:
    """Points of a sample in the unit cube; the same for each chunk, whoever works on it."""
    request, names = plan.request, len(plan.over)
    if request.sample == RANDOM:
        return np.random.default_rng([request.seed, number]).random((stop - start, names))
    if request.sample == LATIN_HYPERCUBE:
        strata = np.stack([_strata(request.seed, k, plan.points)[start:stop] for k in range(names)], axis=-1)
        inside = np.random.default_rng([request.seed, number]).random((stop - start, names))
        return np.asarray((strata + inside) / plan.points)
    return _sobol(names, request.seed, start, stop)


@lru_cache(maxsize=16)
def _strata(seed: int, name: int, count: int) -> NDArray[np.int64]:
    """Which of `count` strata each point takes along one axis."""
    return np.asarray(np.random.default_rng([seed, name, count]).permutation(count))


def _sobol(names: int, seed: int, start: int, stop: int) -> Array:
    """Points of Sobol's sequence, scrambled by the seed.

    A power of two of them is drawn where the sequence begins: SciPy warns of other numbers there.
    """
    from scipy.stats import qmc

    engine = qmc.Sobol(names, scramble=True, rng=np.random.default_rng(seed))
    if start:
        engine.fast_forward(start)
        return np.asarray(engine.random(stop - start))
    return np.asarray(engine.random(1 << (stop - 1).bit_length())[:stop])
