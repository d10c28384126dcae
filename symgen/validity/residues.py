"""Whether two scalars differ by a product of parameters only, decided in the field of fingerprints.

A quotient that stays the same when all coordinates change, and that a doubled parameter multiplies by a power of two,
is a number times a product of powers of parameters (Schwartz and Zippel; see `symgen.symbolic.fingerprint`).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.fingerprint import PRIME, angle_pair, combine, leaf_pair, opaque, residue
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# Powers of two that a doubled parameter may multiply a quotient by, and their inverses.
HIGHEST_POWER = 16
POWERS_OF_TWO = {pow(2, k, PRIME): k for k in range(-HIGHEST_POWER, HIGHEST_POWER + 1)}
MOVED = ""  # the assignment in which every coordinate differs; no parameter has this name


class Residues:
    """Values of scalars under several assignments: all coordinates moved, or one parameter doubled."""

    def __init__(self, parameters: Iterable[str]) -> None:
        self._parameters = frozenset(parameters)
        self._values: dict[str, dict[Scalar, int]] = {}
        self._pairs: dict[int, tuple[int, int]] = {}
        self._symbols: dict[tuple[str, str], int] = {}

    def proportional(self, a: Scalar, b: Scalar, powers: tuple[int, int], definite: Callable[[str], bool]) -> bool:
        """Whether a^k / b^l, (k, l) the `powers`, is a product of powers of `definite` parameters and a number."""
        if not a.value or not b.value:
            return False
        here = _quotient(a.value, b.value, powers)
        if here != _quotient(self._value(MOVED, a), self._value(MOVED, b), powers):
            return False
        names = {str(n.payload) for n in topological([a, b]) if n.op == "symbol"} & self._parameters
        for name in sorted(names):
            factor = _quotient(self._value(name, a), self._value(name, b), powers) * pow(here, -1, PRIME) % PRIME
            power = POWERS_OF_TWO.get(factor)
            if power is None or (power and not definite(name)):
                return False
        return True

    def _value(self, changed: str, node: Scalar) -> int:
        known = self._values.setdefault(changed, {})
        for inner in topological([node], known):
            known[inner] = self._residue(changed, inner, known)
        return known[node]

    def _residue(self, changed: str, node: Scalar, known: dict[Scalar, int]) -> int:
        if node.op == "symbol":
            return self._symbol(changed, str(node.payload))
        if node.constant is not None:
            return residue(node.constant)
        if node.op in ("sin", "cos"):
            counts: dict[int, int] = {}
            for leaf, count in angle_form(node.args[0]).items():
                key = self._value(changed, leaf)
                counts[key] = counts.get(key, 0) + count
            for key in counts:
                if key not in self._pairs:
                    self._pairs[key] = leaf_pair(key)
            return angle_pair(counts, self._pairs)[node.op == "sin"]
        return combine(node.op, [known[argument] for argument in node.args], node.payload)

    def _symbol(self, changed: str, name: str) -> int:
        if (changed, name) not in self._symbols:
            moves = changed == MOVED and name not in self._parameters
            value = opaque("moved" if moves else "symbol", name)
            self._symbols[changed, name] = value * (2 if name == changed else 1) % PRIME
        return self._symbols[changed, name]


def _quotient(a: int, b: int, powers: tuple[int, int]) -> int:
    return pow(a, powers[0], PRIME) * pow(b, -powers[1], PRIME) % PRIME if a and b else 0
