"""Absolute angles in place of relative ones: q_j = y_j - y_parent(j), a change of coordinates with determinant 1.

In y the entries of B, the energies and the forces of linkages lose most of their terms: a link's column of B no longer
holds the links behind it.  u and lambda do not depend on the coordinates, accelerations change back linearly.
"""

from __future__ import annotations

from collections.abc import Mapping

from symgen.records import dataclass
from symgen.symbolic.angles.angle_forms import angle_form
from symgen.symbolic.matrix import Matrix, Vector, flatten
from symgen.symbolic.traverse import topological


@dataclass(frozen=True, slots=True)
class AbsoluteAngles:
    """`parents[j]` is the coordinate whose absolute angle is taken from that of j, or None."""

    parents: tuple[int | None, ...]

    @property
    def is_identity(self) -> bool:
        """Whether nothing changes."""
        return all(parent is None for parent in self.parents)

    def relative(self, y: Vector) -> Vector:
        """q (or its rates) from y: S y."""
        return tuple(a if p is None else a - y[p] for a, p in zip(y, self.parents, strict=True))

    def absolute(self, q: Vector) -> Vector:
        """y from q: S^-1 q."""
        visited: dict[int, int] = {}
        y = list(q)
        for j in range(len(q)):
            chain, place = [j], self.parents[j]
            while place is not None and place not in visited:
                chain.append(place)
                place = self.parents[place]
            for k in reversed(chain):
                parent = self.parents[k]
                if k not in visited and parent is not None:
                    y[k] = y[parent] + q[k]
                visited[k] = k
        return tuple(y)

    def forces(self, f: Vector) -> Vector:
        """Generalized forces of y from those of q: S^T f."""
        result = list(f)
        for j, parent in enumerate(self.parents):
            if parent is not None:
                result[parent] = result[parent] - f[j]
        return tuple(result)

    def forces_of_relative(self, f: Vector) -> Vector:
        """Generalized forces of q, or derivatives by q, from those of y: S^-T f."""
        result = list(f)
        for j, parent in enumerate(self.parents):
            while parent is not None:
                result[parent] = result[parent] + f[j]
                parent = self.parents[parent]
        return tuple(result)


def absolute_angles(q: Vector, constraint_jacobian: Matrix) -> AbsoluteAngles:
    """The coordinates that occur in the angles of B only together with another one, which becomes their parent.

    Of several the one that occurs in the fewest angles besides is taken: the neighbour in a chain of links.
    """
    forms = {
        node.args[0].serial: angle_form(node.args[0])
        for node in topological(flatten(constraint_jacobian))
        if node.op in ("sin", "cos")
    }
    seen: Mapping[int, frozenset[int]] = {
        j: frozenset(serial for serial, form in forms.items() if leaf in form) for j, leaf in enumerate(q)
    }
    parents: list[int | None] = []
    for j, leaf in enumerate(q):
        candidates = [
            i
            for i, other in enumerate(q)
            if i != j
            and seen[j]
            and (seen[j] < seen[i] or (seen[j] == seen[i] and i < j))
            and all(form.get(other) == form[leaf] for form in forms.values() if leaf in form)
        ]
        parents.append(min(candidates, key=lambda i: (len(seen[i]), -i), default=None))
    return AbsoluteAngles(tuple(parents))
