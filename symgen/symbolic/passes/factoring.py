"""Shorter scalars for a system: multiplied out, cancelled, factored, with sums of parameters left whole."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from symgen.symbolic.angles.sharing import share_angles
from symgen.symbolic.differences import Differences
from symgen.symbolic.graph import Graph, Mark
from symgen.symbolic.identity import same_values
from symgen.symbolic.passes.forgetting import forgetting
from symgen.symbolic.polynomials.polynomial import Multiplier, refactored
from symgen.symbolic.scalar import Scalar
from symgen.symbolic.traverse import topological

# Operations of a scalar up to which it is multiplied out to see what cancels: a longer one would not get shorter.
LONGEST_CANCELLED = 200


class Factoring:
    """Multiplies scalars out and factors them again; sums of parameters and the sums in `kept` stay whole.

    Differences of `coordinates` do where that is no longer.
    """

    def __init__(self, graph: Graph, parameters: Sequence[Scalar], coordinates: Sequence[Scalar] = ()) -> None:
        self.graph = graph
        self._coordinates = coordinates
        self._fixed: dict[Scalar, bool] = dict.fromkeys(parameters, True)
        self._multipliers: dict[frozenset[Scalar], Multiplier] = {}

    def fixed(self, node: Scalar) -> bool:
        """Whether a scalar depends on parameters only."""
        known = self._fixed.get(node)
        if known is not None:
            return known
        # operands are most often known
        inside = (node,) if node.args and self._fixed.keys() >= {*node.args} else topological([node], self._fixed)
        for inner in inside:
            self._fixed[inner] = inner.op == "const" or (bool(inner.args) and all(self._fixed[a] for a in inner.args))
        return self._fixed[node]

    def forget(self, mark: Mark, needed: Iterable[Scalar]) -> None:
        """Lets go of what was made since the mark of the graph and is not needed, see `forgetting`."""
        gone = forgetting(self.graph, mark, needed)
        if gone is not None:
            for node in gone:
                self._fixed.pop(node, None)
            self._multipliers.clear()

    def multiplier(self, whole: Callable[[Scalar], bool]) -> Multiplier:
        """One that leaves sums alone as `whole` tells, and differences of coordinates where that is no longer."""
        return Multiplier(self.graph, whole, Differences(self.graph, self._coordinates, self.fixed))

    def shorten(self, outputs: Sequence[Scalar], kept: frozenset[Scalar] = frozenset()) -> tuple[Scalar, ...]:
        """The scalars multiplied out, cancelled and factored where they are not too long."""
        multiplier = self._multipliers.get(kept)
        if multiplier is None:
            multiplier = self.multiplier(lambda node: node in kept or self.fixed(node))
            self._multipliers[kept] = multiplier
        shared = share_angles(self.graph, outputs)
        shorter = refactored(self.graph, shared, multiplier, self.fixed)
        same_values("multiplying out and factoring", shared, shorter)
        return tuple(shorter)

    def cancelled(self, scalar: Scalar) -> Scalar:
        """The scalar multiplied out and factored where that makes it shorter."""
        (shorter,) = self.shorten((scalar,))
        return shorter if shorter.size < scalar.size else scalar

    def as_one_product(self, scalar: Scalar) -> Scalar:
        """The scalar as a product of what is no sum but of parameters, where it is one: all its digits hold then."""
        if scalar.op not in ("add", "sub") or scalar.size > LONGEST_CANCELLED:
            return scalar
        (shorter,) = self.shorten((scalar,))
        _, powers = self.graph.products.monomial(shorter)
        return scalar if any(factor.op in ("add", "sub") and not self.fixed(factor) for factor in powers) else shorter

    def common_sums(self, components: Sequence[Scalar]) -> frozenset[Scalar]:
        """The sums that are factors of two components or more: what a vector is a multiple of."""
        seen: dict[Scalar, int] = {}
        for component in components:
            _, powers = self.graph.products.monomial(component)
            for factor, power in powers.items():
                if power > 0 and factor.op in ("add", "sub") and not self.fixed(factor):
                    seen[factor] = seen.get(factor, 0) + 1
        return frozenset(factor for factor, count in seen.items() if count > 1)
