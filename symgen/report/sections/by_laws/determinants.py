"""Singular configurations as zeros of determinants of small matrices."""

from __future__ import annotations

from collections import Counter

from symgen.closedform.laws.determinants import MOST_LISTED_ROWS, BlockDeterminant
from symgen.closedform.laws.singular_sets import DeterminantSet
from symgen.report.context import Context
from symgen.report.document import Block, displayed
from symgen.report.mathematics.layout import Array, Fenced, Layout, Product, Scripts, equation
from symgen.report.mathematics.matrices import packed
from symgen.report.mathematics.names import name_layout
from symgen.report.mathematics.setting import as_factor
from symgen.report.prose import ZERO, B, equals, juxtaposed, lam, listed, paragraph, transposed

MEANING = {
    "input": "There motions are possible on which no input works.",
    "measured": "There motions are possible in which what is measured stands still.",
    "task": "There motions are possible in which the task stands still.",
    "parameter": "There motions are possible in which the chosen velocities are zero.",
}


class Determinants:
    """The determinants in the singular sets of one report; those that are in several are printed once, with a name."""

    def __init__(self, context: Context) -> None:
        self._context = context
        uses = Counter(
            block
            for one in context.input.determinants
            for block in dict.fromkeys(factor for product in one.products for factor in product)
            if block.zero is None
        )
        shared = [block for block, count in uses.items() if count > 1]
        names = context.free_names("D", len(shared))
        self._names = dict(zip(shared, map(name_layout, names), strict=True))

    def definitions(self) -> list[Block]:
        """The determinants that have names."""
        if not self._names:
            return []
        equations = (equation(name, self._array(block)) for block, name in self._names.items())
        text = "Determinants of entries of {} that are in several conditions below"
        if not all(block.columns for block in self._names):
            text += "; columns in which two rows alone have entries are eliminated"
        return [paragraph(text + ":", B), displayed(tuple(packed(equations)), "determinants")]

    def conditions(self, one: DeterminantSet, opening: str, *slots: Layout) -> list[Block]:
        """What happens at a singularity, the equations of its set, and what they mean."""
        if one.kind == "constraint":
            return self._rows_depend(one, opening, *slots)
        if len(one.products) > 1:
            where = "; this happens where all of these vanish at once:"
            equations = self._products_vanish(one)
        else:
            (factors,) = one.products
            if len(factors) == 1 and factors[0] in self._names:
                name = equation(self._names[factors[0]], ZERO)
                return [paragraph(f"{opening}; this happens where {{}}. {MEANING[one.kind]}", *slots, name)]
            where = "; this happens where one of these vanishes:" if len(factors) > 1 else "; this happens where"
            equations = [equation(self._factor(factor), ZERO) for factor in factors]
        return [paragraph(opening + where, *slots), _displayed(equations), paragraph(MEANING[one.kind])]

    def _rows_depend(self, one: DeterminantSet, opening: str, *slots: Layout) -> list[Block]:
        """Where B loses rank: by B B^T, and by determinants of some columns."""
        square = equals(Fenced(juxtaposed(B, transposed(B)), "|"), ZERO)
        force = equals(juxtaposed(transposed(B), lam), ZERO)
        text = opening + "; this happens where {}. There {} is possible with {} that are not zero."
        where = paragraph(text, *slots, square, force, lam)
        if not one.products:
            return [where]
        rows = self._context.model.r
        also = f"All determinants of {rows} columns of {{}} vanish at once at these configurations, which includes"
        return [where, paragraph(also, B), _displayed(self._products_vanish(one))]

    def _products_vanish(self, one: DeterminantSet) -> list[Layout]:
        return [equation(self._product(product), ZERO) for product in one.products]

    def _product(self, factors: tuple[BlockDeterminant, ...]) -> Layout:
        layouts = list(map(self._factor, factors))
        return layouts[0] if len(layouts) == 1 else Product(tuple(map(as_factor, layouts)))

    def _factor(self, block: BlockDeterminant) -> Layout:
        """The factors that vanish where these are short, else the name or the determinant."""
        if block.zero is not None:
            return self._context.layout.expression(block.zero)
        return self._names.get(block) or self._array(block)

    def _array(self, block: BlockDeterminant) -> Layout:
        """The determinant by its entries, or by the names of the coordinates that its columns of B belong to."""
        if block.matrix.rows <= MOST_LISTED_ROWS:
            return Array(self._context.layout.matrix(block.matrix).rows, "|")
        names = (name_layout(self._context.model.coordinates[k].name) for k in block.columns)
        return Fenced(Scripts(B, listed(tuple(names))), "|")


def _displayed(equations: list[Layout]) -> Block:
    return displayed(tuple(packed(equations)))
