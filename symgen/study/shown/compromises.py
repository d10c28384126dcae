"""Two criteria of a machine against each other: of all its variants those of which none is better in both."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from symgen.paths.drawing import COLOURS, svg, with_numbered_regions
from symgen.records import dataclass
from symgen.study.asked.request import DRIVE_SPEED, MOTOR_TORQUE
from symgen.study.chunks import Array
from symgen.study.interest import Interest, interests
from symgen.study.plan import StudyPlan
from symgen.study.reductions import LARGEST_OF, MINIMUM_OF
from symgen.study.shown.labels import value_label
from symgen.study.shown.pictures import StudyPicture
from symgen.study.shown.scatter import MOST_SCATTERED, point_values, worst_channel
from symgen.study.shown.summary import TableRows

# Of the best variants, those that are listed: the ends, and some between.
MOST_LISTED_VARIANTS = 12
# Inches: the height of a picture.
COMPROMISE_HEIGHT = 3.2


@dataclass(frozen=True, slots=True)
class Compromise:
    """Two criteria at the points of a study (N each, NaN where there is none), and the numbers of the best points in
    the order of the first criterion: no other is as good in both and better in one."""

    first: Interest
    second: Interest
    x: Array
    y: Array
    best: NDArray[np.intp]


def compromises(plan: StudyPlan, results: Any) -> tuple[Compromise, ...]:
    """Each pair of quantities of interest where parameters are varied; `results` is an xarray Dataset."""
    if any(one.kind != "parameter" for one in plan.over):
        return ()
    made = []
    worst = [(one, _worst(plan, one, results).ravel()) for one in interests(plan) if _is_criterion(one)]
    for (first, x), (second, y) in combinations(worst, 2):
        best = best_points(-x if first.smallest else x, -y if second.smallest else y)
        if len(best) > 1:
            made.append(Compromise(first, second, x, y, best))
    return tuple(made)


def _is_criterion(one: Interest) -> bool:
    """Whether more of it, or less, is better."""
    return not (one.signed or one.counted) and one.name not in (MOTOR_TORQUE, DRIVE_SPEED)


def _worst(plan: StudyPlan, one: Interest, results: Any) -> Array:
    """Of all channels and states the worst magnitude at each point."""
    figure = "" if plan.states == 1 else f"_{MINIMUM_OF if one.smallest else LARGEST_OF}"
    values = results[one.name + figure].values
    return worst_channel(one, np.moveaxis(values, -1, 0) if one.dimension else values[None])


def best_points(x: Array, y: Array) -> NDArray[np.intp]:
    """The numbers of the points that no other beats, of costs x and y (N each), in the order of x."""
    known = np.flatnonzero(np.isfinite(x) & np.isfinite(y))
    order = known[np.lexsort((y[known], x[known]))]
    least = np.minimum.accumulate(y[order])
    return order[np.concatenate([[True], least[1:] < least[:-1]])] if len(order) else order


def compromise_table(plan: StudyPlan, results: Any, one: Compromise) -> TableRows:
    """Some of the best variants with what is varied."""
    values = point_values(plan, results)
    places = np.unique(np.linspace(0, len(one.best) - 1, MOST_LISTED_VARIANTS).round().astype(int))
    rows = [
        (*(f"{v:.4g}" for v in values[k]), f"{one.x[k]:.4g}", f"{one.y[k]:.4g}") for k in one.best[places]
    ]
    columns = (*(of.axis.name for of in plan.over), *(f"worst {of.name}" for of in (one.first, one.second)))
    return f"best of {one.first.name} and {one.second.name}", columns, rows


def compromise_picture(one: Compromise) -> StudyPicture:
    """The variants, and which of them are best."""
    known = int(np.isfinite(one.x + one.y).sum())
    caption = f"{len(one.best)} of {known} variants are best: no other is as good in both and better in one."
    title = f"{one.first.name} against {one.second.name}"
    text = with_numbered_regions(svg(lambda figure: _draw(figure, one), COMPROMISE_HEIGHT))
    return StudyPicture(title, caption, text)


def _draw(figure: Any, one: Compromise) -> None:
    """Variants as dots, the best ones joined by steps: what lies beyond these was not to be had."""
    panel = figure.subplots()
    step = max(1, -(-len(one.x) // MOST_SCATTERED))
    panel.plot(one.x[::step], one.y[::step], ".", color="#888888", markersize=3, label="variants")
    x, y = one.x[one.best], one.y[one.best]
    panel.step(x, y, where="pre" if one.first.smallest else "post", color=COLOURS[1], linewidth=1.2)
    panel.plot(x, y, "o", color=COLOURS[1], markersize=4, label="best")
    for axis, of in ((panel.set_xlabel, one.first), (panel.set_ylabel, one.second)):
        better = "more" if of.smallest else "less"
        axis(f"worst {value_label(of, '')} ({better} is better)")
    panel.legend()
