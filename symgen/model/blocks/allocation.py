"""The block `allocation`: how redundant inputs share the work, as settings that join the parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from fractions import Fraction

from symgen.diagnostics import Span
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.names import did_you_mean
from symgen.model.expressions.walk import evaluate
from symgen.model.file.declarations import DeclaredRanges
from symgen.model.file.reading import entries, items, key_span, member, text_of
from symgen.model.file.scope import PARAMETERS, Scope, a_kind
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.model import Allocation, Input, Limit, Model, Parameter, Range
from symgen.records import dataclass

PRELOAD, LIMITS, TENSION = "preload", "limits", "tension"
ONE_NAME_EACH = "rename that one; settings are called as the generated struct's members"

_DESCRIBED = {"weight": " in the norm of the inputs", "preload": "", "limit": "", "direction": ", internal force"}


@dataclass(frozen=True, slots=True)
class _Setting:
    """One number of the block: the member it becomes, what it is about, and where it stands."""

    name: str
    of: str
    about: str
    node: Node
    place: Span
    role: str


@dataclass(frozen=True, slots=True)
class _Limits:
    """Both limits of an input, where they and their name stand, and what to do if they are in the wrong order."""

    of: str
    ends: tuple[Node, ...]
    place: Span
    value: Span
    order: str


def declare_settings(scope: Scope, tree: MappingNode) -> None:
    """Enters the members that the block makes; they are no values of the model language.

    A name that is taken already is a mistake at the entry that makes it.
    """
    for setting in _settings(tree):
        taken = scope.kinds.get(setting.name)
        if taken is None:
            scope.kinds[setting.name] = "setting"
        elif taken != "setting":
            where = f" (line {scope.spans[setting.name].line})" if setting.name in scope.spans else ""
            message = f"the {setting.about} becomes the parameter `{setting.name}`, which is {a_kind(taken)}{where}"
            scope.wrong(message, ONE_NAME_EACH, setting.place)


def read_allocation(
    scope: Scope, tree: MappingNode, inputs: tuple[Input, ...], parameters: tuple[Parameter, ...],
    ranges: DeclaredRanges,
) -> tuple[Allocation | None, tuple[Parameter, ...]]:  # fmt: skip
    """The block with the names of its settings, and the settings as parameters; (None, ()) where it says nothing.

    Values are numbers or expressions of parameters; weights are positive, lower limits not above upper ones.
    """
    block = tree.get("allocation")
    units = {item.name: item.unit for item in inputs}
    for part in ("weights", PRELOAD, LIMITS):
        _check_inputs(scope, member(block, part), part, units)
    _check_tensions(scope, tree, block)
    known = default_values(parameters)
    values: dict[str, float] = {}
    made: list[Parameter] = []
    for setting in _settings(tree):
        if setting.of and setting.of not in units:
            continue
        expression = scope.expression(setting.node, f"the {setting.about}", PARAMETERS)
        if expression is None:
            continue
        value = _value(scope, setting, expression, known)
        if value is None:
            continue
        values[setting.name] = value
        unit = None if setting.role == "weight" else _common_unit(units, setting, block)
        chosen = ranges.get(setting.name)
        if setting.role == "weight":
            _check_weight(scope, setting, value, chosen)
        description = setting.about.replace("`", "") + _DESCRIBED[setting.role]
        made.append(Parameter(setting.name, unit, description, expression, chosen, setting.node.span))
    complete = {parameter.name for parameter in made}
    limits: list[Limit] = []
    for given in _limits(tree):
        lower, upper = limit_names(given.of)
        if lower in complete and upper in complete:
            limits.append(Limit(given.of, lower, upper))
            if values[lower] > values[upper]:
                message = f"the lower limit of `{given.of}` is {values[lower]:.6g}, above its upper one"
                scope.wrong(message, given.order, given.value)
    preload = member(block, PRELOAD)
    allocation = Allocation(
        weights=_named(block, "weights", weight_name, complete),
        preload=PRELOAD if isinstance(preload, ScalarNode) and PRELOAD in complete else None,
        preferred=_named(block, PRELOAD, preferred_name, complete),
        limits=tuple(limits),
        scale=text_of(member(block, "scale")) == "true",
        span=key_span(tree, "allocation") or next((given.place for given in _limits(tree)), None),
    )
    if allocation.scale and len(limits) < len(inputs):
        missing = next(item.name for item in inputs if item.name not in {limit.input for limit in limits})
        message = f"`scale` needs limits of every input, and `{missing}` has none"
        scope.wrong(message, "name its limits, or remove `scale`", _span_of(block, "scale"))
    if not (allocation.weights or allocation.preload or allocation.preferred or allocation.limits):
        return None, ()
    return allocation, tuple(_with_range(parameter, values, limits) for parameter in made)


def weight_name(name: str) -> str:
    """The member for the weight of an input."""
    return f"weight_{name}"


def preferred_name(name: str) -> str:
    """The member for the preferred value of an input."""
    return f"{PRELOAD}_{name}"


def limit_names(name: str) -> tuple[str, str]:
    """The members for the limits of an input."""
    return f"limit_{name}_lower", f"limit_{name}_upper"


def _settings(tree: MappingNode) -> Iterator[_Setting]:
    """Every number of the block in the order weights, preload, limits."""
    block = tree.get("allocation")
    for key, node in entries(member(block, "weights")):
        yield _Setting(weight_name(key.value), key.value, f"weight of `{key.value}`", node, key.span, "weight")
    preload = member(block, PRELOAD)
    if isinstance(preload, ScalarNode):
        yield _Setting(PRELOAD, "", "preload", preload, preload.span, "direction")
    for key, node in entries(preload):
        about = f"preload of `{key.value}`"
        yield _Setting(preferred_name(key.value), key.value, about, node, key.span, "preload")
    for given in _limits(tree):
        for name, end, item in zip(limit_names(given.of), ("lower", "upper"), given.ends, strict=False):
            yield _Setting(name, given.of, f"{end} limit of `{given.of}`", item, given.place, "limit")


def _limits(tree: MappingNode) -> Iterator[_Limits]:
    """Those of the block, and of inputs those of a tension."""
    for key, node in entries(member(tree.get("allocation"), LIMITS)):
        yield _Limits(key.value, items(node)[:2], key.span, node.span, "write [lower, upper]")
    for key, node in entries(tree.get("inputs")):
        tension = member(node, TENSION)
        ends = [member(tension, end) for end in ("minimum", "maximum")]
        if tension is not None and not isinstance(tension, ScalarNode):
            known = tuple(end for end in ends if end is not None)
            place = _span_of(node, TENSION) or tension.span
            if len(known) == len(ends):
                yield _Limits(key.value, known, place, tension.span, "exchange `minimum` and `maximum`")


def _check_tensions(scope: Scope, tree: MappingNode, block: Node | None) -> None:
    """A tension is that of a cable, and is told in one place."""
    limited = {key.value for key, _ in entries(member(block, LIMITS))}
    for key, node in entries(tree.get("inputs")):
        place = _span_of(node, TENSION)
        if place is None:
            continue
        if member(node, "cable") is None:
            remedy = f"write its limits under `allocation`: `limits: {{{key.value}: [lower, upper]}}`"
            scope.wrong(f"`{key.value}` is no cable: it has no `tension`", remedy, place)
        elif key.value in limited:
            scope.wrong(f"`{key.value}` has `limits` under `allocation`, too", "remove one of them", place)


def _span_of(node: Node | None, key: str) -> Span | None:
    return key_span(node, key) if isinstance(node, MappingNode) else None


def _check_inputs(scope: Scope, node: Node | None, part: str, inputs: Mapping[str, str | None]) -> None:
    for key, _ in entries(node):
        if key.value not in inputs:
            remedy = did_you_mean(key.value, inputs, "name inputs")
            scope.wrong_about(key.value, f"`{key.value}` in `{part}` is no input", remedy, key.span)


def _value(scope: Scope, setting: _Setting, expression: Expression, known: Mapping[str, float]) -> float | None:
    try:
        return evaluate(expression, known)
    except (ArithmeticError, ValueError):
        remedy = "write a number in the range of doubles"
        scope.wrong(f"the {setting.about} is no finite number", remedy, setting.node.span)
        return None


def _check_weight(scope: Scope, setting: _Setting, value: float, chosen: Range | None) -> None:
    if value <= 0:
        remedy = "weights are positive; a larger one makes the input smaller"
        scope.wrong(f"the {setting.about} is {value:.6g}", remedy, setting.node.span)
    elif chosen is not None and chosen[0] <= 0:
        remedy = "weights are positive"
        scope.wrong(f"the range of `{setting.name}` reaches down to {float(chosen[0]):.6g}", remedy, setting.place)


def _common_unit(units: Mapping[str, str | None], setting: _Setting, block: Node | None) -> str | None:
    """The unit of a limit or preferred value is its input's, that of the preload the one all inputs have."""
    if setting.of:
        return units[setting.of]
    input_units = set(units.values())
    return input_units.pop() if len(input_units) == 1 and member(block, "weights") is None else None


def _named(
    block: Node | None, part: str, name: Callable[[str], str], complete: set[str]
) -> tuple[tuple[str, str], ...]:
    return tuple((key.value, name(key.value)) for key, _ in entries(member(block, part)) if name(key.value) in complete)


def _with_range(parameter: Parameter, values: Mapping[str, float], limits: list[Limit]) -> Parameter:
    """The parameter with a range of sensible values around its default, where the file gives none."""
    value = values[parameter.name]
    if parameter.range is not None:
        return parameter
    low, high = sorted((value / 2, 2 * value))
    for limit in limits:
        width = values[limit.upper] - values[limit.lower]
        if parameter.name == limit.lower:
            low, high = value, value + width / 4
        elif parameter.name == limit.upper:
            low, high = value - width / 4, value
    if not (low < high and math.isfinite(low) and math.isfinite(high)):
        return parameter
    return replace(parameter, range=(Fraction(low), Fraction(high)))


def without_allocation(model: Model) -> Model:
    """The model whose inputs are those of least norm: for comparisons with what knows no allocation."""
    allocation = model.allocation
    if allocation is None:
        return model
    settings = {name for _, name in (*allocation.weights, *allocation.preferred)} | {allocation.preload}
    settings |= {name for limit in allocation.limits for name in (limit.lower, limit.upper)}
    kept = tuple(parameter for parameter in model.parameters if parameter.name not in settings)
    return replace(model, allocation=None, parameters=kept)
