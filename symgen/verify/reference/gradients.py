"""The derivatives of G, B and M by every coordinate, for the matrices that contain their rates.

The energies of bodies are polynomials in all coordinates here, whose length grows with the fourth power of a chain's;
`reference_system` does without wherever a quantity is a vector.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any, TypeAlias

from symgen.model.expressions.expression import Expression, Number, Pi
from symgen.model.mechanism import component
from symgen.model.model import Model
from symgen.verify.reference.frames import Frames
from symgen.verify.reference.tape import Register, Replay, Tape, replay_of
from symgen.verify.reference.taylor import CONSTANT, Polynomial, Taylor
from symgen.verify.reference.translation import Translation, translation


class Gradients:
    """dG/dq, dB/dq and dM/dq as one replay, their sums along a velocity as others."""

    def __init__(self, model: Model, literals: Sequence[Number | Pi]) -> None:
        self._model, self._literals = model, literals
        n, m, r = model.n, model.m, model.r
        self._n = n
        self._tape = Tape()
        self._shared: dict[tuple[int, int], Translation] = {}
        places = self._translation(2, 0)
        self._frames = Frames(model.mechanism, places.algebra, places.polynomial)
        energy = self._kinetic_energy()
        rows = [self._constraint_row(index) for index in range(r)]
        columns = [dict(control.acts_on) for control in model.inputs]
        worked_on = [self._coefficients(control.velocity) for control in model.inputs]
        control = [
            worked[k] if worked else self._translation(1, 0).polynomial(column[c.name]) if c.name in column else {}
            for k, c in enumerate(model.coordinates)
            for column, worked in zip(columns, worked_on, strict=True)
        ]
        zero = self._tape.zero
        gradients: list[Register] = []
        mass_gradient = {
            (i, j, k): self._rate_coefficient(energy, i, j, k) for i in range(n) for j in range(n) for k in range(n)
        }
        positions = _collect(mass_gradient, gradients, zero)
        directional = {"mass": _derivative(positions, n, n, n), "coriolis": _christoffel(positions, n)}
        positions = _collect(
            {(i, j, k): rows[i][j][k] for i in range(r) for j in range(n) for k in range(n)}, gradients, zero
        )
        directional["constraints"] = _derivative(positions, r, n, n)
        positions = _collect(
            {(i, j, k): control[i * m + j].get(((k,), ()), zero) for i in range(n) for j in range(m) for k in range(n)},
            gradients,
            zero,
        )
        directional["control"] = _derivative(positions, n, m, n)
        self._directional = {name: _bilinear(terms, n) for name, terms in directional.items()}
        self._gradients = replay_of(self._tape, gradients)

    @property
    def operations(self) -> int:
        """Number of recorded operations, for estimates of cost."""
        return len(self._tape.records)

    def at(self, q: Sequence[Any], parameters: Sequence[Any], literals: Sequence[Any]) -> tuple[Any, ...]:
        """The entries of the gradients that do not vanish identically, at q."""
        return self._gradients.run([*q, *([None] * self._n), *parameters, *literals])

    def along(self, what: str, at: Sequence[Any], velocity: Any) -> tuple[Any, ...]:
        """Row-major entries of d/dt of `mass`, `constraints` or `control` along a velocity, or of `coriolis` (3)."""
        return self._directional[what].run([*velocity.entries(), *at])

    def _kinetic_energy(self) -> Polynomial:
        """T as written out plus that of the bodies; rotors add constants to G."""
        written = self._translation(1, 2)
        total = written.polynomial(self._model.kinetic_energy)
        if self._model.mechanism.bodies:
            total = written.algebra.add(total, self._frames.kinetic_energy(written.algebra, _unchanged))
        return total

    def _coefficients(self, velocity: Expression | None) -> list[Polynomial]:
        """The coefficients of a rate by the rates of the coordinates, to degree 1 in the coordinates."""
        if velocity is None:
            return []
        linear = self._translation(1, 1).polynomial(velocity)
        return [
            {(place, ()): register for (place, rates), register in linear.items() if rates == (j,)}
            for j in range(self._n)
        ]

    def _component(self, name: str, coordinates: int) -> Polynomial:
        """A component of a point or frame, to this degree."""
        found = self._frames.component(name)
        if component(name).is_rate:
            return found
        return {monomial: register for monomial, register in found.items() if len(monomial[0]) <= coordinates}

    def _rate_coefficient(self, energy: Polynomial, i: int, j: int, k: int) -> Register:
        """Register of the derivative of d2T/dqd_i dqd_j along q_k."""
        register = energy.get(((k,), (min(i, j), max(i, j))), self._tape.zero)
        return self._tape.scaled(Fraction(2), register) if i == j else register

    def _constraint_row(self, index: int) -> list[list[Register]]:
        """The gradient of a row of B."""
        row = self._model.constraints[index]
        zero, n = self._tape.zero, self._n
        if row.kind == "nonholonomic":
            linear = self._translation(1, 1).polynomial(row.expression)
            return [[linear.get(((k,), (j,)), zero) for k in range(n)] for j in range(n)]
        g = self._translation(2, 0).polynomial(row.expression)
        return [
            [
                self._tape.scaled(Fraction(2), g.get(((j, j), ()), zero))
                if j == k
                else g.get(((min(j, k), max(j, k)), ()), zero)
                for k in range(n)
            ]
            for j in range(n)
        ]

    def _translation(self, coordinates: int, rates: int) -> Translation:
        """The shared translation for polynomials of these degrees."""
        key = (coordinates, rates)
        if key not in self._shared:
            tape = self._tape

            def moving(j: int) -> tuple[Polynomial, Polynomial]:
                place: Polynomial = {CONSTANT: tape.input(j), ((j,), ()): tape.one}
                return place, {((), (j,)): tape.one} if rates else {}

            algebra = Taylor(tape, coordinates, rates)
            self._shared[key] = translation(
                self._model, self._literals, algebra, moving, lambda name: self._component(name, coordinates)
            )
        return self._shared[key]


def _unchanged(rate: Polynomial) -> Polynomial:
    return rate


Position: TypeAlias = tuple[int, int, int]
Terms: TypeAlias = list[list[tuple[Fraction, int, int]]]


def _collect(entries: dict[Position, Register], gradients: list[Register], zero: Register) -> dict[Position, int]:
    """Append the entries that are not zero to `gradients`; where each of them went."""
    positions: dict[Position, int] = {}
    for place, register in entries.items():
        if register != zero:
            positions[place] = len(gradients)
            gradients.append(register)
    return positions


def _derivative(positions: dict[Position, int], rows: int, columns: int, n: int) -> Terms:
    """sum_k d_k X_ij v_k for every entry of a matrix: factor, position of the gradient, k."""
    return [
        [(Fraction(1), positions[i, j, k], k) for k in range(n) if (i, j, k) in positions]
        for i in range(rows)
        for j in range(columns)
    ]


def _christoffel(positions: dict[Position, int], n: int) -> Terms:
    """C_ij = sum_k (d_k G_ij + d_j G_ik - d_i G_jk)/2 v_k."""
    half = Fraction(1, 2)
    return [
        [
            (factor, positions[place], k)
            for k in range(n)
            for factor, place in ((half, (i, j, k)), (half, (i, k, j)), (-half, (j, k, i)))
            if place in positions
        ]
        for i in range(n)
        for j in range(n)
    ]


def _bilinear(terms: Terms, n: int) -> Replay:
    """The sums as a replay of the velocity (n numbers) and the gradients."""
    tape = Tape()
    outputs = []
    for entry in terms:
        total = tape.zero
        for factor, gradient, k in entry:
            product = tape.binary("mul", tape.input(n + gradient), tape.input(k))
            total = tape.binary("add", total, tape.scaled(factor, product))
        outputs.append(total)
    return replay_of(tape, outputs)
