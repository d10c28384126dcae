"""Reading couplings: gears, belts and linkages by which one coordinate follows others."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.model.expressions.combine import minus
from symgen.model.expressions.expression import Name
from symgen.model.expressions.walk import names_in
from symgen.model.file.declarations import enter_row, is_coordinate
from symgen.model.file.reading import entries
from symgen.model.file.scope import CONFIGURATION, Scope
from symgen.model.file.source import MappingNode
from symgen.model.model import ConstraintRow


def read_couplings(scope: Scope, tree: MappingNode) -> Iterator[ConstraintRow]:
    """The row a - f of each coupling `a: f`, by the name `a_coupling`."""
    for key, node in entries(tree.get("coupling")):
        if not is_coordinate(scope, key, "`coupling`", "a coupling moves a coordinate"):
            continue
        expression = scope.expression(node, f"the coupling of `{key.value}`", CONFIGURATION)
        if expression is None:
            continue
        if any(name.name == key.value for name in names_in(expression)):
            remedy = f"write what `{key.value}` follows of other coordinates, or a row under `constraints`"
            scope.wrong(f"the coupling of `{key.value}` holds `{key.value}` itself", remedy, node.span)
            continue
        name = coupling_row(key.value)
        enter_row(scope, name, key.span)
        yield ConstraintRow(name, "geometric", minus(Name(key.value, key.span), expression), node.span)


def coupling_row(coordinate: str) -> str:
    """The name of the row by which a coordinate follows others."""
    return f"{coordinate}_coupling"
