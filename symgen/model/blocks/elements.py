"""Reading force elements: springs and dampers, joint friction, forces and torques given as functions of the state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

from symgen.model.blocks.inputs import FORCES, chosen_action, distance, point_name, shortening, working_rate
from symgen.model.blocks.lengths import check_length
from symgen.model.expressions.combine import divided, minus, negated, plus, times
from symgen.model.expressions.expression import Call, Expression, Name, Number, Power
from symgen.model.expressions.names import did_you_mean
from symgen.model.file.declarations import is_coordinate
from symgen.model.file.reading import entries, items, member
from symgen.model.file.scope import PARAMETERS, STATE, Scope
from symgen.model.file.source import MappingNode, Node, ScalarNode
from symgen.model.mechanism import ZERO
from symgen.model.model import Force
from symgen.records import dataclass

HALF = Number(Fraction(1, 2))
# Where reactions are, and what friction has that grows with one, and no other.
PLACES_OF_REACTIONS = ("joints", "loops")
OF_REACTIONS = ("radius", "reaction", "rate", "load")


@dataclass(frozen=True, slots=True)
class Fit:
    """What the unit of a coefficient must be: times `measure` to `power` it is an energy, or a power for `per_second`.

    A power of -1 stands for a coefficient in the unit of the measure itself.
    """

    coefficient: Expression
    measure: Expression
    power: int
    per_second: bool
    what: str


def read_springs(
    scope: Scope, tree: MappingNode, defaults: Mapping[str, float]
) -> tuple[Expression, tuple[Force, ...], tuple[Fit, ...]]:
    """The energy of the springs, the forces of their dampers, and what their units must fit."""
    energy: Expression = ZERO
    dampers: list[Force] = []
    fits: list[Fit] = []
    for key, node in entries(tree.get("springs")):
        what = f"the spring `{key.value}`"
        stretch, rate = _stretch(scope, key, node, what)
        stiffness = scope.expression(member(node, "stiffness"), f"the stiffness of {what}", PARAMETERS)
        length = scope.expression(member(node, "length"), f"the length of {what}", PARAMETERS) or ZERO
        if member(node, "between") is not None:
            remedy = "write its size: the distance at which the spring is at rest"
            check_length(scope, member(node, "length"), length, defaults, f"the length of {what}", remedy, or_zero=True)
        damping = scope.expression(member(node, "damping"), f"the damping of {what}", PARAMETERS)
        if member(node, "stiffness") is None and member(node, "damping") is None:
            scope.wrong(f"{what} has neither `stiffness` nor `damping`", "give one of them, or both", key.span)
        if stretch is None or rate is None:
            continue
        fits.append(Fit(length, stretch, -1, False, f"the length of {what}"))
        if stiffness is not None:
            fits.append(Fit(stiffness, stretch, 2, False, f"the stiffness of {what}"))
            energy = plus(energy, times(times(HALF, stiffness), Power(minus(stretch, length), Fraction(2))))
        if damping is not None:
            fits.append(Fit(damping, rate, 2, True, f"the damping of {what}"))
            dampers.append(Force(key.value, negated(times(damping, rate)), rate, key.span))
    return energy, tuple(dampers), tuple(fits)


def read_friction(scope: Scope, tree: MappingNode) -> tuple[tuple[Force, ...], tuple[Fit, ...]]:
    """Friction in the coordinates, viscous and dry as c tanh(rate/width), and what its units must fit."""
    forces: list[Force] = []
    fits: list[Fit] = []
    for key, node in entries(tree.get("friction")):
        if is_rough(scope, tree, key, node):
            continue  # which is read with the joints and loops, in `rough_places`
        if member(node, "radius") is not None and scope.kinds.get(key.value) != "coordinate":
            places = [other.value for block in PLACES_OF_REACTIONS for other, _ in entries(tree.get(block))]
            remedy = did_you_mean(key.value, places, "name the joint or the loop whose pin has this radius")
            scope.wrong_about(key.value, f"`{key.value}` in `friction` is no joint or loop", remedy, key.span)
            continue
        if not is_coordinate(scope, key, "`friction`"):
            continue
        if (stray := next((x for part in OF_REACTIONS if (x := member(node, part)) is not None), None)) is not None:
            remedy = "name the joint or the loop whose pin it is, or rows under `reaction`, in an entry of its own"
            scope.wrong(f"friction in the coordinate `{key.value}` has no reaction to grow with", remedy, stray.span)
            continue
        rate: Expression = Name(f"{key.value}_dot")
        viscous, coulomb, width = (
            scope.expression(member(node, part), f"`{part}` of the friction of `{key.value}`", PARAMETERS)
            for part in ("viscous", "coulomb", "width")
        )
        if coulomb is not None and member(node, "width") is None:
            remedy = "add `width`: the rate at which dry friction has 76 % of its full size, such as 0.01"
            scope.wrong(f"the dry friction of `{key.value}` has no `width`", remedy, key.span)
        for value, power, part in ((viscous, 2, "viscous"), (coulomb, 1, "coulomb"), (width, -1, "width")):
            if value is not None:
                fits.append(Fit(value, rate, power, power > 0, f"`{part}` of the friction of `{key.value}`"))
        magnitude: Expression = times(viscous, rate) if viscous is not None else ZERO
        if coulomb is not None and width is not None:
            magnitude = plus(magnitude, times(coulomb, Call("tanh", (divided(rate, width),))))
        forces.append(Force(f"friction of {key.value}", negated(magnitude), rate, key.span))
    return tuple(forces), tuple(fits)


def is_rough(scope: Scope, tree: MappingNode, key: ScalarNode, node: Node) -> bool:
    """Whether an entry of `friction` is about a reaction: that of a joint, of a loop, or of rows that it names."""
    if scope.kinds.get(key.value) == "coordinate":
        return False
    if member(node, "reaction") is not None:
        return True
    names = {other.value for block in PLACES_OF_REACTIONS for other, _ in entries(tree.get(block))}
    return key.value in names and not (member(node, "viscous") is not None and member(node, "coulomb") is None)


def read_forces(scope: Scope, tree: MappingNode) -> tuple[Force, ...]:
    """Forces and torques on points and frames, of a magnitude that depends on the state."""
    forces = []
    for key, node in entries(tree.get("forces")):
        action = chosen_action(scope, key, node, FORCES)
        what = f"the force `{key.value}`"
        rate = None if action is None else working_rate(scope, node, action, what)
        magnitude = scope.expression(member(node, "magnitude"), f"the magnitude of {what}", STATE)
        if rate is not None and magnitude is not None:
            forces.append(Force(key.value, magnitude, rate, key.span))
    return tuple(forces)


def _stretch(scope: Scope, key: ScalarNode, node: Node, what: str) -> tuple[Expression | None, Expression | None]:
    """Length of a spring and the rate at which it grows."""
    joint = member(node, "joint")
    if isinstance(joint, ScalarNode):
        good = is_coordinate(scope, joint, f"`joint` of {what}")
        return (Name(joint.value), Name(f"{joint.value}_dot")) if good else (None, None)
    if member(node, "between") is None:
        remedy = "give `between: [point, point]` or `joint`"
        scope.wrong_about(key.value, f"{what} is attached to nothing", remedy, key.span)
        return None, None
    owners: Sequence[str | None] = [
        point_name(scope, item, f"`between` of {what}") for item in items(member(node, "between"))
    ]
    known = [owner for owner in owners if owner is not None]
    if len(known) != 2:
        return None, None
    if known[0] == known[1]:
        scope.wrong(f"{what} is attached to `{known[0]}` at both ends", "name two different points", key.span)
        return None, None
    return distance(known[0], known[1]), negated(shortening(known))
