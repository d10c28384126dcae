"""The inertial parameters of bodies: ten each, about the origin and in the axes of the frame that the body moves with.

Inverse dynamics is linear in them (Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, ch. 9).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Literal, TypeAlias

from symgen.model.expressions.combine import negated, plus, times
from symgen.model.expressions.expression import Expression
from symgen.model.mechanism import Body, Mechanism
from symgen.records import dataclass

Element: TypeAlias = Literal["m", "mx", "my", "mz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz", "Ir"]

# Mass, first moments (kg m), inertia tensor about the origin (kg m^2).
ELEMENTS: tuple[Element, ...] = ("m", "mx", "my", "mz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz")
# Which stay where several say the same: inertias before first moments, these before masses.
_STAYING: tuple[Element, ...] = ("Ir", "Izz", "Ixx", "Iyy", "Ixy", "Ixz", "Iyz", "mx", "my", "mz", "m")


@dataclass(frozen=True, slots=True)
class InertialParameter:
    """One of a body's ten, or `Ir`: the inertia of a rotor that turns with a coordinate."""

    owner: str
    element: Element

    @property
    def name(self) -> str:
        """As `link_1.Izz`."""
        return f"{self.owner}.{self.element}"

    @property
    def staying(self) -> int:
        """The smaller, the rather it stands for others."""
        return _STAYING.index(self.element)


def inertial_parameters(mechanism: Mechanism) -> tuple[InertialParameter, ...]:
    """Those of all bodies in the order of the file, then of rotors."""
    bodies = [InertialParameter(body.name, element) for body in mechanism.bodies for element in ELEMENTS]
    return (*bodies, *(InertialParameter(rotor.coordinate, "Ir") for rotor in mechanism.rotor_inertias))


def in_words(mechanism: Mechanism) -> str:
    """Their order, as `m, mx, ..., Iyz of crank, of rod; Ir of a`."""
    groups = []
    if mechanism.bodies:
        groups.append(f"{', '.join(ELEMENTS)} {', '.join(f'of {body.name}' for body in mechanism.bodies)}")
    if mechanism.rotor_inertias:
        groups.append(f"Ir {', '.join(f'of {rotor.coordinate}' for rotor in mechanism.rotor_inertias)}")
    return "; ".join(groups)


def named(mechanism: Mechanism, numbers: Sequence[int]) -> str:
    """Some of them, as `crank.mx, rod.Izz`."""
    every = inertial_parameters(mechanism)
    return ", ".join(every[k].name for k in numbers)


def values(mechanism: Mechanism, evaluate: Callable[[Expression], float]) -> tuple[float, ...]:
    """What the file gives them, in the order of `inertial_parameters`."""
    return tuple(map(evaluate, expressions(mechanism)))


def expressions(mechanism: Mechanism) -> tuple[Expression, ...]:
    """The same as they stand in the file, or follow from that."""
    bodies = [expression for body in mechanism.bodies for expression in _of_body(body)]
    return (*bodies, *(rotor.inertia for rotor in mechanism.rotor_inertias))


def _of_body(body: Body) -> list[Expression]:
    """The tensor is moved from the centre of mass to the origin (Huygens and Steiner)."""
    mass, (x, y, z) = body.mass, body.com
    own = [getattr(body.inertia, element) for element in ("xx", "yy", "zz", "xy", "xz", "yz")]
    xx, yy, zz = (times(entry, entry) for entry in (x, y, z))
    moved = [plus(yy, zz), plus(xx, zz), plus(xx, yy)]
    moved += [negated(times(one, other)) for one, other in ((x, y), (x, z), (y, z))]
    first = [times(mass, entry) for entry in (x, y, z)]
    return [mass, *first, *(plus(a, times(mass, b)) for a, b in zip(own, moved, strict=True))]
