"""Assembly modes: configurations that differ although the task, or the measured coordinates, are the same.

Those of the model's own configuration are looked for from hundreds of starts, as those of a verification are: the
places are held as further rows, and what closes then is a mode.  Modes are looked for, not enumerated.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from math import pi, remainder
from typing import TypeAlias

from symgen.mechanics.genericity import assembly_of, parameter_values
from symgen.mechanics.system import System
from symgen.model.expressions.expression import Binary, Name, Number
from symgen.model.model import ConstraintRow, Model
from symgen.symbolic.evaluate import Evaluator
from symgen.symbolic.translate import translate
from symgen.verify.reference.reference import Reference, ReferenceValueError
from symgen.verify.sampling.modes import SAME_MODE, modes

# As many as a page shows.
MOST_MODES = 16

Configuration: TypeAlias = tuple[float, ...]


@lru_cache(maxsize=1)
def assembly_modes(model: Model, by_task: bool) -> tuple[Configuration, ...]:
    """Configurations with the task, or the measured coordinates, of the model's own, which comes first."""
    own: Configuration = tuple(map(float, assembly_of(model).places[0].q))
    names = [model.coordinates[k].name for k in model.measured_places]
    places = [one.expression for one in model.task] if by_task else [Name(name) for name in names]
    mechanics = System(model)
    here = dict(zip((c.name for c in model.coordinates), own, strict=True))
    functions = [translate(mechanics.graph, place, mechanics.names) for place in places]
    values = Evaluator(functions)({**parameter_values(mechanics), **here})
    held = [
        ConstraintRow(f"held_{k}", "geometric", Binary("-", place, Number(Fraction(value))))
        for k, (place, value) in enumerate(zip(places, values, strict=True))
    ]
    try:
        reference = Reference(replace(model, constraints=(*model.constraints, *held), assembly=None))
    except ReferenceValueError:
        # the own one is singular: others are not told from it
        return (own,)
    others = sorted(one for one in modes(reference) if not _is_same(model, one, own))
    return (own, *others)[:MOST_MODES]


def _is_same(model: Model, one: Configuration, other: Configuration) -> bool:
    """Whether two configurations are the same, whole turns of angles aside."""
    pairs = zip(model.coordinates, one, other, strict=True)
    apart = [remainder(a - b, 2 * pi) if c.is_angle else a - b for c, a, b in pairs]
    return max(map(abs, apart), default=0.0) <= SAME_MODE
