"""The block `task`: what a motion is planned in, functions of the configuration."""

from __future__ import annotations

from symgen.model.expressions.names import name_mistake
from symgen.model.expressions.walk import names_in
from symgen.model.file.reading import entries
from symgen.model.file.scope import CONFIGURATION, Scope
from symgen.model.file.source import MappingNode
from symgen.model.mechanism import is_component
from symgen.model.model import TaskCoordinate

# What moves, or may.
_MOVING = ("coordinate", "definition")


def read_task(scope: Scope, tree: MappingNode) -> tuple[TaskCoordinate, ...]:
    """The coordinates of the task in the order of the file; faulty ones are left out.

    Their names stand for themselves: that of a coordinate, a point or a parameter may be among them.
    """
    coordinates: list[TaskCoordinate] = []
    for key, node in entries(tree.get("task")):
        mistake = name_mistake(key, "coordinate of the task")
        if mistake is not None:
            scope.mistakes.append(mistake)
        expression = scope.expression(node, f"`{key.value}` of the task", CONFIGURATION)
        if expression is None or mistake is not None:
            continue
        names = [name.name for name in names_in(expression)]
        if not any(is_component(name) or scope.kinds.get(name) in _MOVING for name in names):
            remedy = "write a function of the coordinates, such as a component of a point: `tip.x`"
            scope.wrong(f"`{key.value}` of the task does not move", remedy, node.span)
            continue
        coordinates.append(TaskCoordinate(key.value, expression, node.span))
    return tuple(coordinates)
