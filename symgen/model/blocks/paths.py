"""The block `paths`: trajectories as functions of t, fixed by conditions on the configuration."""

from __future__ import annotations

from fractions import Fraction

from symgen.model.expressions.expression import Expression, Number
from symgen.model.expressions.names import counted, name_mistake
from symgen.model.file.constants import constant, whole_number
from symgen.model.file.reading import description_of, entries, member
from symgen.model.file.scope import PATH_CONDITION, PATH_DEFINITION, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.model import Definition, Path

# Times at which a path is solved, unless the file says how many.
DEFAULT_SAMPLES = 201
# Times at which a path may be solved at most.
MAXIMUM_SAMPLES = 100_000


def read_paths(scope: Scope, tree: MappingNode, coordinates: tuple[str, ...], rows: int | None) -> tuple[Path, ...]:
    """The paths in the order of the file; there are so many geometric `rows`, of loops and joints too, if that is
    known."""
    if rows is not None:
        rows = max(rows, len(entries(member(tree.get("constraints"), "geometric"))))
    paths: list[Path] = []
    for key, node in entries(tree.get("paths")):
        mistake = name_mistake(key, "path")
        if mistake is not None:
            scope.mistakes.append(mistake)
        path = _path(scope, key, node, coordinates, rows)
        if path is not None:
            paths.append(path)
    return tuple(paths)


def _path(scope: Scope, key: ScalarNode, node: Node, coordinates: tuple[str, ...], rows: int | None) -> Path | None:
    name = key.value
    duration = constant(scope, member(node, "duration"), f"the duration of path `{name}`")
    count = member(node, "samples")
    samples = whole_number(scope, count, f"the number of samples of path `{name}`", 2, MAXIMUM_SAMPLES)
    if duration is not None and duration <= 0:
        scope.wrong(f"the duration of path `{name}` is not positive", "write a time in seconds", node.span)
    local = scope.inner(t="time")
    definitions: list[Definition] = []
    for symbol, value in entries(member(node, "definitions")):
        expression = local.expression(value, f"`{symbol.value}` of path `{name}`", PATH_DEFINITION)
        if local.declare(symbol, "symbol"):
            definitions.append(Definition(symbol.value, expression or Number(Fraction(1)), symbol.span))
    conditions: list[tuple[str, Expression]] = []
    for condition, value in entries(member(node, "conditions")):
        mistake = name_mistake(condition, "condition")
        if mistake is not None:
            scope.mistakes.append(mistake)
        label = f"the condition `{condition.value}` of path `{name}`"
        expression = local.expression(value, label, PATH_CONDITION)
        if expression is not None:
            conditions.append((condition.value, expression))
    start: list[tuple[str, Fraction]] = []
    for coordinate, value in entries(member(node, "start")):
        if coordinate.value not in coordinates:
            remedy = scope.coordinate_meant(coordinate.value, coordinates, "name coordinates")
            message = f"`{coordinate.value}` in `start` is no coordinate"
            scope.wrong_about(coordinate.value, message, remedy, coordinate.span)
            continue
        number = constant(scope, value, f"the start value of `{coordinate.value}`")
        if number is not None:
            start.append((coordinate.value, number))
    given = len(entries(member(node, "conditions")))
    if rows is not None and 0 < given + rows < len(coordinates):
        message = f"path `{name}` has {counted(given, 'condition')} and "
        message += f"{counted(rows, 'geometric constraint')} for {counted(len(coordinates), 'coordinate')}"
        scope.wrong(message, "add conditions until they fix every coordinate", key.span)
    if duration is None or (samples is None and count is not None):
        return None
    description, samples = description_of(node), samples or DEFAULT_SAMPLES
    return Path(name, description, duration, samples, tuple(definitions), tuple(conditions), tuple(start), key.span)
