"""The block `published`: formulas as printed somewhere, which symgen decides for this model."""

from __future__ import annotations

from typing import TypeAlias

from symgen.model.expressions.expression import Expression
from symgen.model.expressions.names import did_you_mean
from symgen.model.file.reading import entries, items, member, text_of
from symgen.model.file.scope import MOTION, Scope
from symgen.model.file.source import MappingNode, Node, SequenceNode
from symgen.model.published import Matrix, Published, PublishedEquations, PublishedMatrix, PublishedSingularSet
from symgen.model.quantities import QUANTITIES

Equations: TypeAlias = tuple[tuple[Expression, Expression], ...]


def read_published(scope: Scope, tree: MappingNode, coordinates: tuple[str, ...]) -> tuple[Published, ...]:
    """The published formulas in the order of the file; several may share a number."""
    formulas = (_formula(scope, node, coordinates) for node in items(tree.get("published")))
    return tuple(formula for formula in formulas if formula is not None)


def _formula(scope: Scope, node: Node, coordinates: tuple[str, ...]) -> Published | None:
    equation = text_of(member(node, "equation")) or ""
    where = f"the published formula {equation}".rstrip()
    local = scope.inner()
    symbols: list[tuple[str, Expression]] = []
    for key, value in entries(member(node, "where")):
        expression = local.expression(value, f"`{key.value}` of {where}", MOTION)
        if local.declare(key, "symbol") and expression is not None:
            symbols.append((key.value, expression))
    if member(node, "singular_set") is not None:
        return _singular_set(local, node, equation, where, coordinates)
    if member(node, "equations") is not None:
        equations = _equations(local, member(node, "equations"), where)
        right_ones = _equations(local, member(node, "corrected"), where)
        return PublishedEquations(equation, equations, right_ones, tuple(symbols), node.span)
    matrix = _matrix(local, member(node, "value"), where)
    quantity = _quantity(local, member(node, "quantity"), where)
    if matrix is None or quantity is None:
        return None
    corrected_value = _matrix(local, member(node, "corrected"), where)
    chosen = _independent(local, member(node, "independent"), where, coordinates)
    return PublishedMatrix(equation, quantity, matrix, corrected_value, tuple(symbols), chosen, node.span)


def _singular_set(
    scope: Scope, node: Node, equation: str, where: str, coordinates: tuple[str, ...]
) -> PublishedSingularSet | None:
    block = member(node, "singular_set")
    quantity = _quantity(scope, member(block, "quantity"), where)
    zero = scope.expression(member(block, "where_zero"), where, MOTION)
    corrected = scope.expression(member(block, "corrected"), where, MOTION)
    chosen = _independent(scope, member(block, "independent"), where, coordinates)
    if quantity is None or zero is None:
        return None
    return PublishedSingularSet(equation, quantity, chosen, zero, corrected, node.span)


def _quantity(scope: Scope, node: Node | None, where: str) -> str | None:
    name = text_of(node)
    known = [quantity.name for quantity in QUANTITIES]
    if name is None or node is None:
        return None
    if name not in known:
        scope.wrong(f"`{name}` in {where} is no quantity", did_you_mean(name, known, "name a quantity"), node.span)
        return None
    return name


def _independent(scope: Scope, node: Node | None, where: str, coordinates: tuple[str, ...]) -> tuple[str, ...]:
    chosen: list[str] = []
    for item in items(node):
        name = text_of(item)
        if name is not None and name not in coordinates:
            remedy = did_you_mean(name, coordinates, "name coordinates, without _dot")
            scope.wrong_about(name, f"`{name}` in {where} is no coordinate", remedy, item.span)
        elif name is not None:
            chosen.append(name)
    return tuple(chosen)


def _matrix(scope: Scope, node: Node | None, where: str) -> Matrix | None:
    """Rows of entries; a flat list is a column."""
    if not isinstance(node, SequenceNode) or not node.items:
        return None
    rows = [tuple(item.items) if isinstance(item, SequenceNode) else (item,) for item in node.items]
    if len({len(row) for row in rows}) > 1:
        widths = ", ".join(str(len(row)) for row in rows)
        remedy = "give every row the same number of entries; quote an entry that has a comma"
        scope.wrong(f"the rows of {where} have different lengths: {widths}", remedy, node.span)
        return None
    entries_ = [[scope.expression(entry, where, MOTION) for entry in row] for row in rows]
    matrix = tuple(tuple(entry for entry in row if entry is not None) for row in entries_)
    return matrix if all(len(a) == len(b) for a, b in zip(matrix, rows, strict=True)) else None


def _equations(scope: Scope, node: Node | None, where: str) -> Equations:
    equations: list[tuple[Expression, Expression]] = []
    for item in items(node):
        left = scope.expression(member(item, "left"), where, MOTION)
        right = scope.expression(member(item, "right"), where, MOTION)
        if left is not None and right is not None:
            equations.append((left, right))
    return tuple(equations)
