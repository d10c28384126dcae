"""What becomes 0 where some scalars are 0, by rules that need no numbers, among all scalars that are asked about."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Sequence
from itertools import combinations

from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.fingerprint import PRIME
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# Of these 0 / y is 0, whatever y is.
_OF_THE_FIRST = frozenset({"neg", "abs", "sqrt", "div"})


class Vanishing:
    """Who uses whom among scalars: what vanishes with others is found upwards from these, whatever else there is."""

    def __init__(self) -> None:
        self._users: dict[Scalar, list[Scalar]] = {}
        # by fingerprints: the scalars, and the products that hold one as a factor
        self._by_value: defaultdict[int, list[Scalar]] = defaultdict(list)
        self._by_factor: defaultdict[int, list[Scalar]] = defaultdict(list)
        self._sines: list[tuple[Scalar, dict[int, int]]] = []
        self._always: list[Scalar] = []

    def add(self, scalar: Scalar) -> None:
        """One more scalar that is asked about."""
        for node in topological([scalar], self._users):
            self._users[node] = []
            for argument in node.args:
                self._users[argument].append(node)
            self._by_value[node.value].append(node)
            if node.is_zero:
                self._always.append(node)
            if node.op == "sin":
                self._sines.append((node, _angle(node)))
            if node.op == "mul":
                for factor, power in node.graph.products.monomial(node)[1].items():
                    if power > 0:
                        self._by_factor[factor.value].append(node)

    def any_where(self, zeros: Sequence[Scalar], asked: Collection[Scalar]) -> bool:
        """Whether one of those asked about, all added before, is 0 where the given ones are."""
        gone = set(self._at_once(zeros))
        wanted = frozenset(asked)
        if wanted & gone:
            return True
        pending = list(gone)
        while pending:
            node = pending.pop()
            for user in self._users[node]:
                if user not in gone and _vanishes(user, node, gone):
                    if user in wanted:
                        return True
                    gone.add(user)
                    pending.append(user)
        return False

    def _at_once(self, zeros: Sequence[Scalar]) -> Iterator[Scalar]:
        yield from self._always
        for value in {value for zero in zeros for value in (zero.value, -zero.value % PRIME)}:
            yield from self._by_value.get(value, ())
            yield from self._by_factor.get(value, ())
        angles = [_angle(zero) for zero in zeros if zero.op == "sin"]
        # sin x = sin y = 0 makes sin(x + y) = 0
        sums = [*angles, *(_sum(a, b, sign) for a, b in combinations(angles, 2) for sign in (1, -1))]
        if sums:
            for sine, angle in self._sines:
                if any(angle == known or _negative(angle) == known for known in sums):
                    yield sine


def _vanishes(user: Scalar, node: Scalar, gone: set[Scalar]) -> bool:
    """Whether an operation is 0 where one of its operands is, and all that is gone."""
    if user.op == "mul":
        return True
    if user.op in ("add", "sub"):
        return all(argument in gone for argument in user.args)
    return user.op in _OF_THE_FIRST and user.args[0] is node


def _angle(sine: Scalar) -> dict[int, int]:
    """The angle of a sine, as whole multiples of leaves given by their fingerprints."""
    return {leaf.value: count for leaf, count in angle_form(sine.args[0]).items()}


def _sum(a: dict[int, int], b: dict[int, int], sign: int) -> dict[int, int]:
    total = {leaf: a.get(leaf, 0) + sign * b.get(leaf, 0) for leaf in (*a, *b)}
    return {leaf: count for leaf, count in total.items() if count}


def _negative(a: dict[int, int]) -> dict[int, int]:
    return {leaf: -count for leaf, count in a.items()}
