"""What is kept of the states of a chunk: one value a point, or what its states are reduced to."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symgen.study.chunks import Array
from symgen.study.interest import BlockValues, Interest, interests, is_reduced_at_once, keeps_figures_alone
from symgen.study.kernels import StudyKernels
from symgen.study.plan import StudyPlan
from symgen.study.states import StudyStates

# States that are worked on at once: fewer are handed to C more often, more do not stay in the caches.
BLOCK_STATES = 131_072
# States that are worked on at once where nothing of them is kept but what they are reduced to.
REDUCED_BLOCK_STATES = 2**20
LARGEST_OF, QUANTILES_OF, PLACE_OF = "largest", "quantiles", "at"
MAXIMUM_OF, MINIMUM_OF, MEAN_OF, RMS_OF = "max", "min", "mean", "rms"
QUANTILE, TIME = "quantile", "t"
_ABOUT = {
    MAXIMUM_OF: "largest value",
    MINIMUM_OF: "smallest value",
    MEAN_OF: "mean",
    RMS_OF: "root of the mean square",
    LARGEST_OF: "largest magnitude",
    PLACE_OF: "number of the state with the {} magnitude",
    QUANTILES_OF: "quantiles by a histogram of 256 bins between the smallest and the largest value",
}


@dataclass(frozen=True, slots=True)
class ResultVariable:
    """An array of the results: dimensions behind those of the points, with their labels, a type and attributes."""

    name: str
    dimensions: tuple[str, ...]
    labels: tuple[tuple[str | float, ...], ...]
    dtype: str
    attributes: Mapping[str, str]

    @property
    def inner_shape(self) -> tuple[int, ...]:
        """The sizes of its own dimensions."""
        return tuple(map(len, self.labels))


def result_variables(plan: StudyPlan) -> tuple[ResultVariable, ...]:
    """All arrays of the results of a study."""
    made = [variable for one in interests(plan) for variable in _variables(plan, one)]
    about = f"states with a result, of {plan.states} at each point; -1 where a chunk failed"
    made.append(ResultVariable("valid", (), (), "i8", {"long_name": about}))
    made.append(ResultVariable("status", (), (), "u1", {"long_name": "first status of the point that is not 0"}))
    return tuple(made)


def _variables(plan: StudyPlan, one: Interest) -> Iterator[ResultVariable]:
    dimensions = (one.dimension,) if one.dimension else ()
    labels = (one.channels,) if one.dimension else ()
    attributes = {"long_name": one.about, "units": one.unit}
    if len(set(one.units)) > 1:
        attributes["units_of_channels"] = ", ".join(one.units)
    if plan.states == 1:
        yield ResultVariable(one.name, dimensions, labels, "f8", attributes)
        return
    for figure in (MAXIMUM_OF, MINIMUM_OF, MEAN_OF, RMS_OF, LARGEST_OF, PLACE_OF):
        about = _ABOUT[figure].format("smallest" if one.smallest else "largest")
        own = {**attributes, "long_name": f"{one.about}: {about} along the states of a point"}
        dtype = "f8"
        if figure == PLACE_OF:
            own["units"], dtype = "", "i8"
        yield ResultVariable(f"{one.name}_{figure}", dimensions, labels, dtype, own)
    if plan.request.quantiles:
        own = {**attributes, "long_name": f"{one.about}: {_ABOUT[QUANTILES_OF]}"}
        levels = (*labels, plan.request.quantiles)
        yield ResultVariable(f"{one.name}_{QUANTILES_OF}", (*dimensions, QUANTILE), levels, "f8", own)


@dataclass(slots=True)
class ChunkResults:
    """The arrays of a chunk by variable, points first; counts of statuses, and the worst value of each channel.

    `worst` has by quantity of interest, for each channel, the value, the number of the point in the chunk and the
    number of the state; nothing where no state has a result.
    """

    arrays: dict[str, NDArray[Any]]
    statuses: dict[int, int]
    worst: dict[str, list[tuple[float, int, int] | None]]


def chunk_results(plan: StudyPlan, kernels: StudyKernels, states: StudyStates, values: Array) -> ChunkResults:
    """The results of the points with these values (points x names), block by block."""
    points = len(values)
    made = ChunkResults(
        {one.name: np.empty((points, *one.inner_shape), dtype=one.dtype) for one in result_variables(plan)},
        {},
        {one.name: [None] * len(one.channels) for one in interests(plan)},
    )
    step = max(1, (REDUCED_BLOCK_STATES if is_reduced_at_once(plan) else BLOCK_STATES) // plan.states)
    for start in range(0, points, step):
        block = BlockValues(plan, kernels, states.of(values[start : start + step]))
        for one in interests(plan):
            _reduce(plan, kernels, one, block, made, start)
        _count(made, block, start)
    return made


def _count(made: ChunkResults, block: BlockValues, start: int) -> None:
    """Statuses of a block of points."""
    (points, states), status = block.shape, block.status
    here = slice(start, start + points)
    if status is None:
        made.arrays["valid"][here], made.arrays["status"][here] = states, 0
        made.statuses[0] = made.statuses.get(0, 0) + points * states
        return
    refused = status != 0
    made.arrays["valid"][here] = states - np.count_nonzero(refused, axis=1)
    made.arrays["status"][here] = status[np.arange(len(status)), refused.argmax(axis=1)]
    counts = np.bincount(status[refused], minlength=1)
    counts[0] = refused.size - np.count_nonzero(refused)
    for code in np.flatnonzero(counts):
        made.statuses[int(code)] = made.statuses.get(int(code), 0) + int(counts[code])


def _reduce(
    plan: StudyPlan, kernels: StudyKernels, one: Interest, block: BlockValues, made: ChunkResults, start: int
) -> None:
    """One quantity of interest at a block of points."""
    channels = len(one.channels)
    if keeps_figures_alone(plan):
        figures, places = block.reduced(one)
    else:
        values = block.of(one.name)
        rows = values.reshape(-1, plan.states)
        figures, places = kernels.reduced(rows, one.smallest)
    here = slice(start, start + len(figures) // channels)
    if plan.states == 1:
        _keep(made, one.name, here, values)
    else:
        _keep_reduced(one, figures, places, made, here)
    if plan.states > 1 and plan.request.quantiles:
        levels = kernels.quantiles(rows, figures, plan.request.quantiles)
        _keep(made, f"{one.name}_{QUANTILES_OF}", here, levels)
    # 0 is added to what may be -0
    worst, at = (figures[:, 5] + 0.0).reshape(-1, channels), places.reshape(-1, channels)
    for k in range(channels):
        _keep_worst(made.worst[one.name], k, one, worst[:, k], at[:, k] >= 0, at[:, k], start)


def _keep(made: ChunkResults, name: str, here: slice, values: NDArray[Any]) -> None:
    """Into an array of the results; what has one channel has no dimension for it."""
    array = made.arrays[name]
    array[here] = values.reshape(array[here].shape)


def _keep_reduced(
    one: Interest, figures: Array, places: NDArray[np.int64], made: ChunkResults, here: slice
) -> None:
    high, low, total, squares, number, worst = figures.T
    none = number == 0
    with np.errstate(invalid="ignore"):
        by_figure = {
            MAXIMUM_OF: np.where(none, np.nan, high),
            MINIMUM_OF: np.where(none, np.nan, low),
            MEAN_OF: total / number,
            RMS_OF: np.sqrt(squares / number),
            LARGEST_OF: np.where(none, np.nan, (np.maximum(high, -low) if one.smallest else worst) + 0.0),
            PLACE_OF: places,
        }
    for figure, array in by_figure.items():
        _keep(made, f"{one.name}_{figure}", here, array)


def _keep_worst(
    worst: list[tuple[float, int, int] | None],
    channel: int,
    one: Interest,
    bad: Array,
    some: NDArray[np.bool_],
    places: NDArray[np.int64],
    start: int,
) -> None:
    """The worst value so far of a channel; of equal ones the first."""
    if not some.any():
        return
    ranked = np.where(some, bad, math.inf if one.smallest else -math.inf)
    point = int(ranked.argmin() if one.smallest else ranked.argmax())
    there = float(bad[point]), start + point, int(places[point])
    if worse(one, there, worst[channel]):
        worst[channel] = there


def worse(one: Interest, new: tuple[float, int, int], old: tuple[float, int, int] | None) -> bool:
    """Whether a value is worse than the worst before it."""
    return old is None or (new[0] < old[0] if one.smallest else new[0] > old[0])
