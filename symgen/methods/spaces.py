"""The ways to the null space of B along which quantities are derived: all are valid wherever the rank holds."""

from __future__ import annotations

from symgen.linear_algebra.blocks import components
from symgen.linear_algebra.null_space.block_space import BlockSpace
from symgen.linear_algebra.null_space.null_spaces import MinorSpace, has_few_minors
from symgen.mechanics.genericity import Genericity
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.mechanics.system import System
from symgen.methods.derivation import Derivation


def along_minors(mechanics: System, generic: Genericity) -> Derivation | str:
    """The derivation along the minors of B, or why there is none."""
    if not has_few_minors(mechanics.constraint_jacobian, generic.rank):
        return f"B has {generic.minors} minors"
    # of independent rows the one determinant is multiplied out later, and what is left as it is shares its parts
    shortened = mechanics.factoring.as_one_product if generic.rank < mechanics.r else None
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank, shortened)
    return Derivation(mechanics, generic, space)


def along_reflections(mechanics: System, generic: Genericity) -> Derivation | str:
    """The derivation along reflections of B^T, or why there is none."""
    if not mechanics.r:
        return "there are no constraints"
    return Derivation(mechanics, generic, reflected_rows(mechanics, generic))


def along_blocks(mechanics: System, generic: Genericity) -> Derivation | str:
    """The derivation along blocks of B that share no coordinate, or why there is none."""
    rows = mechanics.constraint_jacobian
    if generic.rank < len(rows):
        return "the constraint rows depend on each other"
    if len(list(components(rows))) < 2:
        return "B has one block"
    return Derivation(mechanics, generic, BlockSpace(mechanics.graph, rows, mechanics.n))


SPACES = {"minors": along_minors, "householder": along_reflections, "blocks": along_blocks}


def derivations(mechanics: System, generic: Genericity) -> dict[str, Derivation]:
    """Those that a system has, by name, on one graph."""
    by_name = {name: along(mechanics, generic) for name, along in SPACES.items()}
    return {name: one for name, one in by_name.items() if isinstance(one, Derivation)}
