"""The inertial parameters of bodies: ten each, about the origin and in the axes of the frame that the body moves with.

Inverse dynamics is linear in them (Khalil and Dombre, Modeling, Identification and Control of Robots, 2002, ch. 9).
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

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


def values(mechanism: Mechanism, evaluate: Callable[[Expression], float]) -> tuple[float, ...]:
    """What the file gives them, in the order of `inertial_parameters`."""
    bodies = [number for body in mechanism.bodies for number in _of_body(body, evaluate)]
    return (*bodies, *(evaluate(rotor.inertia) for rotor in mechanism.rotor_inertias))


def _of_body(body: Body, evaluate: Callable[[Expression], float]) -> list[float]:
    """The tensor is moved from the centre of mass to the origin (Huygens and Steiner)."""
    mass = evaluate(body.mass)
    x, y, z = (evaluate(entry) for entry in body.com)
    own = [evaluate(getattr(body.inertia, element)) for element in ("xx", "yy", "zz", "xy", "xz", "yz")]
    moved = (y * y + z * z, x * x + z * z, x * x + y * y, -x * y, -x * z, -y * z)
    return [mass, mass * x, mass * y, mass * z, *(a + mass * b for a, b in zip(own, moved, strict=True))]
