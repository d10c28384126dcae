"""Whether masses determine the accelerations: G positive definite along the motions that the constraints allow.

Floats decide where they find it so.  Where they do not, 120 digits do, on configurations brought closer to the
constraints first: a mass of 1e-9 beside one of 1e9 is a mass, and an energy that cancels is none.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.checks.bodies import inertia_span
from symgen.model.configurations.dense import RELATIVE, Rows, is_positive, null_space
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.numbers import precise
from symgen.records import dataclass

# Configurations that tell how large entries of G usually are.
USUAL_PLACES = 3

# Components of a motion this small are none.
NO_COMPONENT = 1e-7

# Newton steps: each doubles the digits that floats have left.
CLOSING = 4


@dataclass(frozen=True, slots=True)
class _ZeroLimits:
    """What is nothing: a component of a motion of length 1, an energy beside its terms, beside what entries of G
    usually are, and a pivot of G.
    """

    component: float
    rounding: float
    energy: float
    pivot: float
    rows: tuple[float, ...]  # of rows that depend on each other, the first of them that tells a motion


# rounding in G itself is of second order where the places of masses cancel
IN_FLOATS = _ZeroLimits(1e-13, 1e-12, 1e-24, RELATIVE, (RELATIVE,))
# masses that are 1e18 apart count, and rounding of the file's numbers to 16 digits does not, squared as it is in G
IN_MANY_DIGITS = _ZeroLimits(1e-60, 1e-60, 1e-28, 1e-24, (1e-24, 1e-12, RELATIVE))


def check_masses(
    mechanics: NumericSystem, places: Sequence[list[float]], span: Span | None
) -> Iterator[Mistake | Notice]:
    """G must be positive definite along the constraints; across them it may be anything, which is told."""
    reports = list(_Masses(mechanics, places, IN_FLOATS).reports(span))
    if any(isinstance(one, Mistake) for one in reports):
        many = mechanics.within(precise())
        reports = list(_Masses(many, [_closed(many, q) for q in places], IN_MANY_DIGITS).reports(span))
    yield from reports


class _Masses:
    """G at some configurations that satisfy the constraints."""

    def __init__(self, mechanics: NumericSystem, places: Sequence[list[float]], limits: _ZeroLimits) -> None:
        self._mechanics, self._limits = mechanics, limits
        self._places = [(q, mechanics.jacobian(q)) for q in places]
        self._usual = self._usual_mass()

    def reports(self, span: Span | None) -> Iterator[Mistake | Notice]:
        """The mistake that energies are negative or missing, or what is special."""
        mechanics = self._mechanics
        definite_somewhere = negative_across = False
        still: set[str] = set()
        for q, jacobian in self._places:
            try:
                mass = mechanics.mass_matrix(q)
            except (ArithmeticError, ValueError):
                continue
            pairs = zip(mechanics.coordinates, q, strict=True)
            where = ", ".join(f"{c.name} = {float(value):.4g}" for c, value in pairs)
            along = self._along(mass, jacobian)
            definite = is_positive(along, self._limits.pivot)[1]
            if not mechanics.mass_is_sure and not definite and not is_positive(along)[0]:
                yield _negative_energy(mechanics, where, span)
                return
            if not mechanics.mass_is_sure and not negative_across and not is_positive(mass)[0]:
                negative_across = True
                negative = f"the kinetic energy is negative for some velocities at {where}"
                yield Notice(f"{negative}; the constraints allow none of them", span)
            definite_somewhere = definite_somewhere or definite
            if definite_somewhere and mechanics.mass_is_sure:
                break
            if not definite_somewhere and not still:
                still = self._without_mass(jacobian, mass)
        if not definite_somewhere:
            yield self._undetermined(still, span)

    def _undetermined(self, still: set[str], span: Span | None) -> Mistake:
        names = [f"`{c.name}`" for c in self._mechanics.coordinates if c.name in still]
        if not names:
            return Mistake(
                "the accelerations cannot be told: some of the masses vanish beside others",
                "check the units of masses and inertias; what weighs that little may have none",
                span,
            )
        alone = len(names) == 1
        moving = f"{names[0]} does" if alone else f"{', '.join(names)} move together"
        each = not alone and all(self._alone(name) for name in still)
        if each:
            moving = f"{', '.join(names[:-1])} or {names[-1]} does"
        which = "it" if alone else "each" if each else "one of them"
        return Mistake(
            f"the accelerations are undetermined: no mass moves where {moving}, which the constraints allow",
            f"give {which} a mass or inertia in `kinetic_energy` or `bodies`",
            span,
        )

    def _usual_mass(self) -> Rows:
        """The largest size of each entry of G at a few configurations, admissible or not."""
        n = len(self._mechanics.coordinates)
        largest = [[0.0] * n for _ in range(n)]
        for q, _ in self._mechanics.anywhere(USUAL_PLACES):
            try:
                mass = self._mechanics.mass_matrix(q)
            except (ArithmeticError, ValueError):
                continue
            pairs = zip(largest, mass, strict=True)
            largest = [[max(a, abs(b)) for a, b in zip(*rows, strict=True)] for rows in pairs]
        return largest

    def _along(self, mass: Rows, jacobian: Rows) -> Rows:
        """W^T G W for an orthonormal basis W of the velocities that the constraints allow; what is nothing is 0."""
        limits = self._limits
        # rounded zeros of rows let a motion of no mass take masses along
        vectors = null_space(jacobian, len(mass))
        basis = [[x if abs(x) > limits.component else 0.0 for x in vector] for vector in vectors]
        bounds = [
            [max(limits.rounding * abs(a), limits.energy * b) for a, b in zip(*rows, strict=True)]
            for rows in zip(mass, self._usual, strict=True)
        ]
        sizes = [[abs(a) for a in vector] for vector in basis]
        values, least = _reduced(mass, basis), _reduced(bounds, sizes)
        return _above(values, least)

    def _without_mass(self, jacobian: Rows, mass: Rows) -> set[str]:
        """The coordinates that take part in an admissible motion of no mass."""
        negligible = [[self._limits.energy * x for x in row] for row in self._usual]
        massive = [row for row in _above(mass, negligible) if any(row)]
        for relative in self._limits.rows:
            motions = null_space([*jacobian, *massive], len(mass), relative)
            if motions:
                coordinates = self._mechanics.coordinates
                return {
                    c.name
                    for i, c in enumerate(coordinates)
                    if any(abs(motion[i]) > NO_COMPONENT for motion in motions)
                }
        return set()

    def _alone(self, name: str) -> bool:
        """Whether the coordinate moves by itself, and no mass with it."""
        index = [c.name for c in self._mechanics.coordinates].index(name)
        return all(
            not any(row[index] for row in b) and not any(self._mechanics.mass_matrix(q)[index])
            for q, b in self._places
        )


def _closed(mechanics: NumericSystem, q: list[float]) -> list[float]:
    """The configuration nearer to the constraints: Newton steps of least length in the numbers of `mechanics`."""
    configuration = [mechanics.numbers.rational(0) + x for x in q]
    for _ in range(CLOSING):
        try:
            values, rows = mechanics.residuals(configuration, range(len(mechanics.geometric)))
        except (ArithmeticError, ValueError):
            return configuration
        step, met = [0.0] * len(q), list[list[float]]()
        for value, row in zip(values, rows, strict=True):
            given = [row.get(j, 0.0) for j in range(len(q))]
            length = math.sqrt(sum(x * x for x in given))
            across = given
            for unit in met:
                part = sum(a * b for a, b in zip(unit, across, strict=True))
                across = [a - part * b for a, b in zip(across, unit, strict=True)]
            square = sum(x * x for x in across)
            # what depends on rows before closes with them
            if square <= (RELATIVE * length) ** 2:
                continue
            share = (value + sum(a * b for a, b in zip(given, step, strict=True))) / square
            step = [x - share * a for x, a in zip(step, across, strict=True)]
            met.append([x / square**0.5 for x in across])
        configuration = [x + dx for x, dx in zip(configuration, step, strict=True)]
    return configuration


def _above(values: Rows, least: Rows) -> Rows:
    """The values, with 0 for those no larger than these."""
    pairs = zip(values, least, strict=True)
    return [[x if abs(x) > low else 0.0 for x, low in zip(*rows, strict=True)] for rows in pairs]


def _reduced(matrix: Rows, basis: Rows) -> Rows:
    # most vectors of most bases have one entry
    sparse = [[(j, x) for j, x in enumerate(vector) if x] for vector in basis]
    images = [[sum(row[j] * x for j, x in vector) for row in matrix] for vector in sparse]
    return [[sum(image[j] * x for j, x in vector) for vector in sparse] for image in images]


def _negative_energy(mechanics: NumericSystem, where: str, span: Span | None) -> Mistake:
    """The mistake at the inertia of a body that has a negative moment, or at the energy."""
    if not mechanics.unsound:
        remedy = "check the signs of its terms, and masses and inertias with their default values"
        return Mistake(f"the kinetic energy is negative for some velocities at {where}", remedy, span)
    body = mechanics.unsound[0]
    return Mistake(
        f"the kinetic energy is negative for some velocities at {where}: the negative principal moment of "
        f"`{body.name}` is not made up for by other bodies",
        "check signs: xy, xz, yz are elements of the tensor, the negatives of CAD's products of inertia",
        inertia_span(body) or span,
    )
