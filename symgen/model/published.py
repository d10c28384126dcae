"""Formulas of a publication as the file gives them: what a model is compared with."""

from __future__ import annotations

from typing import TypeAlias

from symgen.diagnostics import Span
from symgen.model.expressions.expression import Expression
from symgen.records import dataclass

Matrix: TypeAlias = tuple[tuple[Expression, ...], ...]


@dataclass(frozen=True, slots=True)
class PublishedMatrix:
    """A printed matrix (or column) of a quantity, and the corrected form where the print is wrong."""

    equation: str
    quantity: str
    value: Matrix
    corrected: Matrix | None
    where: tuple[tuple[str, Expression], ...]
    independent: tuple[str, ...]
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class PublishedEquations:
    """Printed equations left = right in q, rates, accelerations, inputs and `multiplier_<row>`."""

    equation: str
    equations: tuple[tuple[Expression, Expression], ...]
    corrected: tuple[tuple[Expression, Expression], ...]
    where: tuple[tuple[str, Expression], ...]
    span: Span | None = None


@dataclass(frozen=True, slots=True)
class PublishedSingularSet:
    """The printed set where a quantity does not exist, as the zeros of an expression."""

    equation: str
    quantity: str
    independent: tuple[str, ...]
    where_zero: Expression
    corrected: Expression | None
    span: Span | None = None


Published: TypeAlias = PublishedMatrix | PublishedEquations | PublishedSingularSet
