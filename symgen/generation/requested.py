"""What a command line asks for by name, else the model does; a name that does not exist is refused."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

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


def unknown_quantity(name: str, *others: str) -> WrongUseError:
    """That a quantity does not exist, with one that may be meant, or one of the others that may stand in its place."""
    remedy = did_you_mean(name, [*BY_NAME, *others], "symgen explain MODEL.yaml lists those of a model")
    return WrongUseError(f"unknown quantity {name!r}; {remedy}")


def check_known(model: Model, option: str, given: Iterable[str], names: Sequence[str]) -> None:
    """Raises WrongUseError for a name given behind an option that is none of `names`."""
    for name in given:
        if name not in names:
            remedy = did_you_mean(name, names, f"the model has {', '.join(names) or 'none'}")
            raise WrongUseError(f"{model.name}: {option}: unknown name {name!r}; {remedy}")


def configuration_near(model: Model, start: Mapping[str, float]) -> list[float]:
    """Coordinates as given, else as the file's `configuration` has them, else in the middle of their ranges."""
    declared = {name: float(value) for name, value in model.configuration}
    return [start.get(c.name, declared.get(c.name, float(sum(c.range)) / 2)) for c in model.coordinates]
