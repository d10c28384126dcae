"""Quantities asked for by name: those of the command line, else of the model; one that does not exist is refused."""

from __future__ import annotations

from symgen.generation.results import Options, WrongUseError
from symgen.model.expressions.names import did_you_mean
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME


def requested_outputs(model: Model, options: Options) -> tuple[str, ...]:
    """What a run is to generate; raises WrongUseError for a quantity that does not exist."""
    outputs = options.outputs or model.outputs
    if unknown := [name for name in outputs if name != "all" and name not in BY_NAME]:
        raise unknown_quantity(unknown[0])
    return outputs


def unknown_quantity(name: str) -> WrongUseError:
    """That a quantity does not exist, with one that may be meant."""
    remedy = did_you_mean(name, [*BY_NAME], "symgen explain MODEL.yaml lists those of a model")
    return WrongUseError(f"unknown quantity {name!r}; {remedy}")
