"""Values of the parameters of a model: those that are chosen, and what follows from them."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any

from symgen.model.model import Model
from symgen.verify.reference.arithmetic.tape import Tape, ball, replay_of
from symgen.verify.reference.arithmetic.taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference.translation import Translation


def default_parameters(model: Model) -> list[Any]:
    """Default values of the parameters, as balls of the working precision."""
    return parameters_from(model, {})


def parameters_from(model: Model, chosen: Mapping[str, Any]) -> list[Any]:
    """Parameter values: the `chosen` ones, and the others from their expressions of earlier parameters."""
    return ParameterValues(model, list(chosen))(chosen)


class ParameterValues:
    """The values of all parameters when those named are chosen."""

    def __init__(self, model: Model, names: Collection[str]) -> None:
        self.model = model
        self.names = tuple(parameter.name for parameter in model.parameters if parameter.name in names)
        tape = Tape()
        known: dict[str, Polynomial] = {}
        translation = Translation(Taylor(tape, 0, 0), known, {}, {})
        for parameter in model.parameters:
            if parameter.name in names:
                known[parameter.name] = {CONSTANT: tape.input(self.names.index(parameter.name))}
            else:
                known[parameter.name] = translation.polynomial(parameter.value)
        registers = [known[parameter.name].get(CONSTANT, tape.zero) for parameter in model.parameters]
        self._replay = replay_of(tape, registers)

    def __call__(self, chosen: Mapping[str, Any]) -> list[Any]:
        """Balls, the `chosen` values among them."""
        return list(self._replay.run([ball(chosen[name]) for name in self.names]))
