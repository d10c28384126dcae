"""Whether friction that grows with reactions is determined and can be worked out."""

from __future__ import annotations

from collections.abc import Iterator

from symgen.diagnostics import Mistake, Notice
from symgen.model.configurations.algebra import NotPolynomialError
from symgen.model.configurations.assembly import Assembly
from symgen.model.configurations.dense import RELATIVE
from symgen.model.configurations.friction_steps import LOCKING_SHARE, FrictionSteps
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.expressions.names import counted
from symgen.model.model import Model, RoughPlace
from symgen.model.quantities import MOTIONS


def check_rough(model: Model, assembly: Assembly) -> Iterator[Mistake]:
    """Reactions are determined by independent constraints, and by inputs that produce every motion by themselves."""
    ranks, span = assembly.ranks, model.rough[0].span
    if ranks.constraints < model.r:
        yield Mistake(
            f"friction grows with reactions that {counted(model.r, 'constraint')} of rank {ranks.constraints} do not "
            "determine",
            "remove constraints that hold what others hold already, or the friction of reactions",
            span,
        )
    if ranks.actuation < model.n - ranks.constraints:
        yield Mistake(
            "friction grows with reactions of a motion that the inputs do not produce: they reach "
            f"{ranks.actuation} of δ = {model.n - ranks.constraints} directions",
            "add inputs for the other directions, or leave out the friction of reactions",
            span,
        )
    if model.allocation is not None:
        yield Mistake(
            "friction of reactions beside an `allocation` is not made: the inputs change what they have to overcome",
            "leave one of them out; without `allocation` the inputs are the smallest",
            model.allocation.span,
        )


def check_locking(model: Model, steps: FrictionSteps, of_motion: FrictionSteps) -> Iterator[Mistake | Notice]:
    """How friction is worked out, and whether it locks; `of_motion` is for inputs that are given."""
    span = model.rough[0].span
    if steps.locks:
        yield Mistake(
            f"friction locks everywhere: it returns {steps.kappa:.2g} of the reactions it grows with, and "
            f"{LOCKING_SHARE} is too much",
            "give smaller coefficients or radii; a mechanism that locks has no inverse dynamics",
            span,
        )
        return
    if steps.locking:
        yield Notice(
            f"friction returns up to {steps.kappa:.2g} of the reactions it grows with: the status is FRICTION_LOCK at "
            f"{steps.locking} of {steps.points} configurations over the ranges as soon as all places slide",
            span,
        )
    if 0 < of_motion.locking < of_motion.points and not {"all", *MOTIONS}.isdisjoint(model.outputs):
        yield Notice(
            f"where inputs are given friction returns up to {of_motion.kappa:.2g} of the reactions: their status is "
            f"FRICTION_LOCK at {of_motion.locking} of {of_motion.points} configurations as soon as all places slide",
            span,
        )
    for path in model.paths:
        yield Notice(f"the charts along `{path.name}` are those without friction of reactions", path.span)


def check_rates(mechanics: NumericSystem, places: tuple[RoughPlace, ...]) -> Iterator[Mistake]:
    """Rates that the file writes are linear in those of the coordinates."""
    for place in places:
        try:
            terms = mechanics.polynomials(place.velocity)
        except NotPolynomialError:
            terms = [{(): (1.0, 1.0)}]
        powers = [(len(rates), abs(value) > RELATIVE * size) for one in terms for rates, (value, size) in one.items()]
        if any(count != 1 and counts for count, counts in powers):
            yield Mistake(
                f"the `rate` of the friction of `{place.name}` is not linear in the rates",
                "write how fast the pin turns or the guide slides, such as beta_dot",
                place.velocity.span or place.span,
            )
