"""What leads a motion: as many coordinates as there are directions of motion, of the task or of the drives."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import combinations, islice

import numpy as np

from symgen.identification.machine_functions import GivenBy
from symgen.identification.not_identified import NotIdentifiedError
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.model import Model
from symgen.records import dataclass

# Choices of coordinates that are looked at, of one kind.
MOST_CHOICES_TRIED = 200
# Of rows of unit length, the smallest singular value below which they leave a place open.
DETERMINED = 1e-6


@dataclass(frozen=True, slots=True)
class Leading:
    """Names of the task's coordinates, or of coordinates, by which the whole motion is given."""

    given_by: GivenBy
    names: tuple[str, ...]


def leading(model: Model) -> Leading:
    """The task where it determines the motion, else coordinates that do: those of encoders, of drives, any.

    Of several choices of one kind the one that is furthest from leaving a direction open at the model's configuration.
    Raises NotIdentifiedError for a model with rows that hold rates alone, and for one that does not move.
    """
    if any(row.kind != "geometric" for row in model.constraints):
        raise NotIdentifiedError(
            "wheels that roll have no motion that a series of a few coordinates gives: drive a course with changes of "
            "speed and curvature, and identify from a log of it"
        )
    freedom = model.n if model.assembly is None else model.n - model.assembly.ranks.constraints
    if freedom == 0:
        raise NotIdentifiedError("nothing of the model can move: check its constraints")
    if len(model.task) == freedom and model.task_leaves.places == model.task_leaves.idle == 0:
        return Leading("task", tuple(one.name for one in model.task))
    if freedom == model.n:
        return Leading("measured", tuple(c.name for c in model.coordinates))
    for kind in _kinds(model):
        openness, chosen = max(_choices(model, kind, freedom), default=(0.0, ()))
        if openness > DETERMINED:
            return Leading("measured", chosen)
    raise NotIdentifiedError("no choice of coordinates determines the motion at the configuration of the model")


def _kinds(model: Model) -> Iterator[Sequence[str]]:
    """Coordinates with encoders, those that inputs drive alone, all."""
    yield model.measured
    driven = (pairs[0][0] for pairs in (one.acts_on for one in model.inputs) if len(pairs) == 1)
    yield tuple(dict.fromkeys(driven))
    yield tuple(c.name for c in model.coordinates)


def _choices(model: Model, names: Iterable[str], count: int) -> Iterator[tuple[float, tuple[str, ...]]]:
    """Choices of so many coordinates, each with how far it is from leaving something open."""
    assert model.assembly is not None
    parts = model.coordinates, model.parameters, model.definitions, model.constraints, model.kinetic_energy
    rows = np.array(NumericSystem(*parts, model.mechanism).jacobian(model.assembly.places[0].q), dtype=np.float64)
    lengths = np.linalg.norm(rows, axis=1, keepdims=True)
    rows = rows / np.where(lengths > 0, lengths, 1.0)
    places = [c.name for c in model.coordinates]
    for chosen in islice(combinations(names, count), MOST_CHOICES_TRIED):
        held = np.eye(model.n)[[places.index(name) for name in chosen]]
        yield float(np.linalg.svd(np.vstack([rows, held]), compute_uv=False)[-1]), chosen
