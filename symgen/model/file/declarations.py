"""What a model declares by name: coordinates, parameters, definitions, inputs, constraint rows."""

from __future__ import annotations

import math
from fractions import Fraction

from symgen.diagnostics import Mistake, Span
from symgen.model.blocks.joint_forms import JointCoordinate, declare_joints
from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.names import QUOTING, did_you_mean, is_name
from symgen.model.expressions.parser import parse_expression
from symgen.model.expressions.walk import evaluate, names_in
from symgen.model.file.constants import range_of
from symgen.model.file.reading import description_of, entries, member, text_of
from symgen.model.file.scope import CONFIGURATION, PARAMETERS, STATE, Kind, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import component, is_component
from symgen.model.model import AppliedForce, ConstraintRow, Definition, Parameter, Range

DeclaredRanges = dict[str, Range]


def declare_names(scope: Scope, tree: MappingNode) -> tuple[JointCoordinate, ...]:
    """Enters every name of the file, so that each expression can be checked against all of them.

    Returns the coordinates that joints bring along.
    """
    blocks: tuple[tuple[str, Kind], ...] = (
        ("coordinates", "coordinate"), ("parameters", "parameter"), ("definitions", "definition"), ("inputs", "input"),
        ("frames", "frame"), ("points", "point"),
    )  # fmt: skip
    for block, kind in blocks:
        for key, _ in entries(tree.get(block)):
            scope.declare(key, kind)
    joints = declare_joints(scope, tree)
    for key, _ in entries(tree.get("bodies")):
        # most bodies are named like their frames
        if scope.kinds.get(key.value) != "frame":
            scope.declare(key, "body")
    for block in ("geometric", "nonholonomic"):
        for key, _ in entries(member(tree.get("constraints"), block)):
            if scope.declare(key, "constraint row"):
                scope.kinds.setdefault(f"multiplier_{key.value}", "multiplier")
    return joints


def read_ranges(scope: Scope, tree: MappingNode) -> DeclaredRanges:
    """The ranges by name, from the `range:` of entries and from the block `ranges`."""
    ranges: DeclaredRanges = {}
    for block in ("coordinates", "parameters"):
        for key, value in entries(tree.get(block)):
            declared = range_of(scope, member(value, "range"), f"the range of `{key.value}`")
            if declared is not None:
                ranges[key.value] = declared
    kinds = ("coordinate", "rate", "acceleration", "parameter", "setting")
    ranged = [name for name, kind in scope.kinds.items() if kind in kinds]
    for key, value in entries(tree.get("ranges")):
        if key.value not in ranged:
            remedy = did_you_mean(key.value, ranged, "name a coordinate, rate, acceleration or parameter")
            scope.wrong_about(key.value, f"unknown name `{key.value}` in `ranges`", remedy, key.span)
            continue
        if key.value in ranges:
            scope.wrong(f"`{key.value}` has two ranges", "keep the one here or the one at its declaration", key.span)
            continue
        declared = range_of(scope, value, f"the range of `{key.value}`")
        if declared is not None:
            ranges[key.value] = declared
    return ranges


def read_parameters(scope: Scope, tree: MappingNode, ranges: DeclaredRanges) -> tuple[Parameter, ...]:
    """The parameters, each a number or an expression of earlier ones."""
    parameters: list[Parameter] = []
    values: dict[str, float] = {}
    block = entries(tree.get("parameters"))
    cycles = _cyclic(block)
    for key, node in block:
        value_node = node if isinstance(node, ScalarNode) else member(node, "value")
        known = [parameter.name for parameter in parameters]
        value = _ordered(scope, key, value_node, f"the value of `{key.value}`", PARAMETERS, known, cycles)
        if value is None:
            # A faulty value stands in as 1, so that what uses the parameter is still checked.
            value = Number(Fraction(1))
        else:
            _check_default(scope, key, value_node, value, values, ranges)
        number = _number(value, values)
        values[key.value] = 1.0 if math.isnan(number) else number
        unit = text_of(member(node, "unit"))
        if not scope.owns(key):
            continue
        parameters.append(Parameter(key.value, unit, description_of(node), value, ranges.get(key.value), key.span))
    return tuple(parameters)


def read_definitions(scope: Scope, tree: MappingNode) -> tuple[Definition, ...]:
    """The named sub-expressions, each of coordinates, rates, parameters and earlier ones."""
    definitions: list[Definition] = []
    block = entries(tree.get("definitions"))
    cycles = _cyclic(block)
    parameters = [name for name, kind in scope.kinds.items() if kind == "parameter"]
    for key, node in block:
        known = [*parameters, *(definition.name for definition in definitions)]
        value = _ordered(scope, key, node, f"the definition `{key.value}`", STATE, known, cycles)
        if not scope.owns(key):
            continue
        if value is not None and any(
            _is_rate(scope, name.name) or name.name in scope.rate_definitions for name in names_in(value)
        ):
            scope.rate_definitions.add(key.value)
        if value is not None and any(
            is_component(name.name) or name.name in scope.place_definitions for name in names_in(value)
        ):
            scope.place_definitions.add(key.value)
        if value is None:
            scope.faulty.add(key.value)
        definitions.append(Definition(key.value, value or Number(Fraction(1)), key.span))
    return tuple(definitions)


def read_constraints(scope: Scope, tree: MappingNode) -> tuple[ConstraintRow, ...]:
    """The rows, geometric ones first; faulty rows are left out."""
    rows: list[ConstraintRow] = []
    block = tree.get("constraints")
    for key, node in entries(member(block, "geometric")):
        expression = scope.expression(node, f"the geometric constraint `{key.value}`", CONFIGURATION)
        if expression is not None and scope.owns(key):
            rows.append(ConstraintRow(key.value, "geometric", expression, node.span))
    for key, node in entries(member(block, "nonholonomic")):
        expression = scope.expression(node, f"the constraint `{key.value}`", STATE)
        if expression is not None and scope.owns(key):
            rows.append(ConstraintRow(key.value, "nonholonomic", expression, node.span))
    return tuple(rows)


def read_applied_forces(scope: Scope, tree: MappingNode) -> tuple[AppliedForce, ...]:
    """The further generalized forces."""
    forces: list[AppliedForce] = []
    for key, node in entries(tree.get("applied_forces")):
        if is_coordinate(scope, key, "`applied_forces`"):
            expression = scope.expression(node, f"the applied force on `{key.value}`", STATE)
            if expression is not None:
                forces.append(AppliedForce(key.value, expression, key.span))
    return tuple(forces)


def _is_rate(scope: Scope, name: str) -> bool:
    return component(name).is_rate if is_component(name) else scope.kinds[name] == "rate"


def _number(value: Expression, values: dict[str, float]) -> float:
    try:
        return evaluate(value, values)
    except (ArithmeticError, ValueError):
        return math.nan


def _check_default(
    scope: Scope,
    key: ScalarNode,
    node: Node | None,
    value: Expression,
    values: dict[str, float],
    ranges: DeclaredRanges,
) -> None:
    span = node.span if node is not None else key.span
    number = _number(value, values)
    lower, upper = ranges.get(key.value, (None, None))
    if math.isnan(number):
        scope.wrong(f"the value of `{key.value}` is no finite number", "write a number in the range of doubles", span)
    elif lower is not None and upper is not None and not float(lower) <= number <= float(upper):
        message = (
            f"the value of `{key.value}` is {number:.6g}, outside its range [{float(lower):.6g}, {float(upper):.6g}]"
        )
        scope.wrong(message, "widen the range, or correct the value", span)


def enter_row(scope: Scope, name: str, span: Span) -> None:
    """Enters a row that a short form makes, and its multiplier; a mistake where the name is another thing's."""
    if name in scope.kinds:
        message = f"the row `{name}` that is made here has the name of another thing ({scope.kinds[name]})"
        scope.wrong(message, "rename one of them", span)
        return
    scope.kinds[name] = "constraint row"
    scope.kinds.setdefault(f"multiplier_{name}", "multiplier")


def is_coordinate(scope: Scope, key: ScalarNode, where: str, why: str = "forces act on coordinates") -> bool:
    """Whether the key names a coordinate; a mistake where it does not."""
    if scope.kinds.get(key.value) == "coordinate":
        return True
    coordinates = [name for name, kind in scope.kinds.items() if kind == "coordinate"]
    listed = scope.listed_coordinates()
    otherwise = f"{why}; name one of them{f': {listed}' if listed else ''}"
    remedy = scope.coordinate_meant(key.value, coordinates, otherwise)
    if not is_name(key.value):
        remedy = QUOTING
    scope.wrong_about(key.value, f"`{key.value}` in {where} is no coordinate", remedy, key.span)
    return False


def _ordered(
    scope: Scope, key: ScalarNode, node: Node | None, where: str, allowed: frozenset[Kind], known: list[str],
    cycles: dict[str, str],
) -> Expression | None:  # fmt: skip
    if key.value in cycles:
        span = node.span if node is not None else key.span
        scope.wrong(f"`{key.value}` is defined by itself: {cycles[key.value]}", "break the circle", span)
        return None
    return scope.expression(node, where, allowed, known)


def _cyclic(block: tuple[tuple[ScalarNode, Node], ...]) -> dict[str, str]:
    """For each name that leads back to itself, the shortest way round, as `a -> b -> a`."""
    uses: dict[str, list[str]] = {}
    for key, node in block:
        scalar = node if isinstance(node, ScalarNode) else member(node, "value")
        parsed = parse_expression(scalar) if isinstance(scalar, ScalarNode) and scalar.value.strip() else None
        if parsed is not None and not isinstance(parsed, Mistake):
            uses[key.value] = list(dict.fromkeys(name.name for name in names_in(parsed)))
    cycles: dict[str, str] = {}
    for start in uses:
        previous: dict[str, str] = {}
        frontier = [start]
        while frontier and start not in previous:
            reached: list[str] = []
            for name in frontier:
                for used in uses.get(name, ()):
                    if used in uses and used not in previous:
                        previous[used] = name
                        reached.append(used)
            frontier = reached
        if start in previous:
            way = [start]
            while len(way) == 1 or way[-1] != start:
                way.append(previous[way[-1]])
            cycles[start] = " -> ".join(reversed(way))
    return cycles
