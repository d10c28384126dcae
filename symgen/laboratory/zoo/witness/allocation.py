"""The block `allocation` as the documentation defines it: weights, preloads, limits of inputs that share the work."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from symgen.laboratory.zoo.witness.kkt import EquationValues, GenericRanks, internal_force
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING, Vector

# Of an internal force of norm 1, what rounding in balls leaves of an input that takes no part in it.
NO_PART = 1e-30
# The same in doubles.
NO_PART_IN_DOUBLES = 1e-12


def members(block: Mapping[str, Any], value: Callable[[str], float]) -> dict[str, float]:
    """Weights, preloads and limits as members of the parameters, in the order of the documentation."""
    by_name = {f"weight_{name}": value(text) for name, text in (block.get("weights") or {}).items()}
    preload = block.get("preload")
    if isinstance(preload, str):
        by_name["preload"] = value(preload)
    elif preload is not None:
        by_name |= {f"preload_{name}": value(text) for name, text in preload.items()}
    for name, (lower, upper) in (block.get("limits") or {}).items():
        by_name |= {f"limit_{name}_lower": value(lower), f"limit_{name}_upper": value(upper)}
    return by_name


def preloads(inputs: Sequence[str], block: Mapping[str, Any], values: Mapping[str, Any], zero: Any) -> Vector | None:
    """The inputs that u is to be nearest to, None where it is to be nearest to 0."""
    if not isinstance(block.get("preload"), Mapping):
        return None
    return [values.get(f"preload_{name}", zero) for name in inputs]


def limits_of(
    inputs: Sequence[str], block: Mapping[str, Any], values: Mapping[str, Any]
) -> list[tuple[int, Any, Any]]:
    """The numbers of the inputs that have limits, and these."""
    names = block.get("limits") or {}
    return [(inputs.index(name), values[f"limit_{name}_lower"], values[f"limit_{name}_upper"]) for name in names]


def is_directed(at: EquationValues, ranks: GenericRanks) -> bool:
    """Whether an internal force has one direction with a sign of its own, which limits do not take away.

    It has none where rows depend on each other.  A row of rounded numbers, 1e-17 long, holds nothing, and is one of
    them nevertheless: what the files say of it counts.
    """
    kept = len(holding(at, ranks).rows) if ranks.kept is None else ranks.kept
    return len(at.control[0]) - ranks.actuation == 1 and ranks.constraints == kept


def holding(at: EquationValues, ranks: GenericRanks) -> EquationValues:
    """The equations with rows that hold anything: of a loop in a plane those across it do not."""
    lengths = ranks.lengths or [1.0] * len(at.rows)
    return replace(at, rows=[row for row, length in zip(at.rows, lengths, strict=True) if length > NOTHING])


def directed(
    at: EquationValues, u: Vector, inputs: Sequence[str], block: Mapping[str, Any], values: Mapping[str, Any], one: Any
) -> Vector:
    """u with the internal force of one preload and of the limits added: c z; `one` is 1 as a ball or a double.

    c moves from the preload to the nearest value within the limits of every named input, and where these leave none to
    the nearest of those at which no excess shrinks without another one's growing.
    """
    single = isinstance(block.get("preload"), str)
    limits = block.get("limits") or {}
    if not single and not limits:
        return u
    along = internal_force(at, [values.get(f"weight_{name}", one) for name in inputs])
    amount = values["preload"] if single else one * 0
    no_part = NO_PART_IN_DOUBLES if isinstance(one, float) else NO_PART
    spans = []
    for name in limits:
        k = inputs.index(name)
        if abs(float(along[k])) < no_part:
            continue
        ends = [(values[f"limit_{name}_{end}"] - u[k]) / along[k] for end in ("lower", "upper")]
        spans.append(sorted(ends, key=float))
    if spans:
        # within all of them, or from the least upper to the largest lower end
        lower, upper = max((span[0] for span in spans), key=float), min((span[1] for span in spans), key=float)
        lower, upper = sorted((lower, upper), key=float)
        amount = min(max(amount, lower, key=float), upper, key=float)
    return [x + amount * z for x, z in zip(u, along, strict=True)]
