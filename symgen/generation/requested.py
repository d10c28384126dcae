"""Quantities asked for by name: those of the command line, else of the model; one that does not exist is refused."""

from __future__ import annotations

from symgen.generation.results import NAMED_METHODS, Options, WrongUseError
from symgen.model.expressions.names import did_you_mean
from symgen.model.model import Model
from symgen.quantities.catalogue import BY_NAME


def requested_outputs(model: Model, options: Options) -> tuple[str, ...]:
    """What a run is to generate; raises WrongUseError for a quantity or method that does not exist."""
    outputs = options.outputs or model.outputs
    if unknown := [name for name in outputs if name != "all" and name not in BY_NAME]:
        raise unknown_quantity(unknown[0])
    for quantity, method in options.methods.items():
        known = NAMED_METHODS.get(quantity, ())
        if method not in known:
            remedy = did_you_mean(method, known, f"choose from {', '.join(known)}" if known else "it has no methods")
            raise WrongUseError(f"no method {method!r} of {quantity}; {remedy}")
    return outputs


def unknown_quantity(name: str) -> WrongUseError:
    """That a quantity does not exist, with one that may be meant."""
    remedy = did_you_mean(name, [*BY_NAME], "symgen explain MODEL.yaml lists those of a model")
    return WrongUseError(f"unknown quantity {name!r}; {remedy}")
