"""The minor form (Cauchy-Binet over the inputs, theory section 3.1) and the Householder form of u."""

from __future__ import annotations

from symgen.linear_algebra.null_spaces import MINOR_LIMIT, MinorSpace
from symgen.mechanics.reflected_rows import reflected_rows
from symgen.methods.derivation import Derivation
from symgen.methods.form import FormName, Method, form
from symgen.methods.system import MethodInput


def minor_derivation(system: MethodInput) -> Derivation | str:
    """The derivation along the minors of B, or why there is none."""
    mechanics, generic = system.mechanics, system.generic
    if generic.minors > MINOR_LIMIT:
        return f"B has {generic.minors} minors"
    space = MinorSpace(mechanics.graph, mechanics.constraint_jacobian, mechanics.n, generic.rank)
    return Derivation(mechanics, generic, space)


def householder_derivation(system: MethodInput) -> Derivation | str:
    """The derivation along reflections of B^T, or why there is none."""
    mechanics, generic = system.mechanics, system.generic
    if not mechanics.r:
        return "there are no constraints"
    return Derivation(mechanics, generic, reflected_rows(mechanics, generic))


def form_along(system: MethodInput, name: FormName, derivation: Derivation | str) -> Method | str:
    """u along a derivation, or why there is none.

    Minor: sum_J Delta_J^2 u_J / sum_J Delta_J^2 over the input subsets.  Householder: B^T = Q R, applied to M and tau,
    then determinants of the last rows of Q^T M.
    """
    if isinstance(derivation, str):
        return derivation
    return form(name, "inverse_dynamics", derivation.inverse_dynamics, derivation.inverse_dynamics_guards, system.given)
