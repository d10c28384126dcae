"""How a mechanism is assembled: configurations that satisfy its constraints, and the ranks found there, as data."""

from __future__ import annotations

from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class ConfigurationRanks:
    """At a configuration: of B, of its geometric rows, and how many admissible directions the inputs span (26)."""

    constraints: int
    geometric: int
    actuation: int


@dataclass(frozen=True, slots=True)
class RankedConfiguration:
    """A configuration on the geometric constraints and the ranks there."""

    q: tuple[float, ...]
    ranks: ConfigurationRanks


@dataclass(frozen=True, slots=True)
class Assembly:
    """What kernels are made for, and what else was found.

    `ranks` are those of the branch that is meant; `places` have them, where the start leads first, the most regular one
    first where that is singular.  `regular` is whether any of them is: else ranks drop wherever the constraints hold.
    `others` has one configuration for each other combination of ranks that whole branches have.  `bound` is what no
    configuration exceeds: the ranks of B and of [B; M^T] off the constraints, where q is free.  `start` is where the
    declared start leads, with its ranks, where it is singular.  `tied` are parameters for whose default values
    alone the loops close, because rows depend on each other.
    `losing` are the numbers of the rows that lose rank at the first place, where none is regular.
    `held` are the numbers of coordinates that no admissible motion changes.
    Rows times 2 to the power of their `own_units` are of ordinary size; of `units` rows that depend on each other share
    one.
    """

    ranks: ConfigurationRanks
    places: tuple[RankedConfiguration, ...]
    others: tuple[RankedConfiguration, ...] = ()
    bound: tuple[int, int] = (0, 0)
    start: RankedConfiguration | None = None
    regular: bool = True
    tied: tuple[str, ...] = ()
    losing: tuple[int, ...] = ()
    held: tuple[int, ...] = ()
    units: tuple[int, ...] = ()
    own_units: tuple[int, ...] = ()

    @property
    def has_branches(self) -> bool:
        """Whether a random configuration may lie on another branch than the one that is meant."""
        return bool(self.others) or self.start is not None or not self.rank_is_identical

    @property
    def rank_is_identical(self) -> bool:
        """Whether the rank of B is no greater anywhere, not only on the branches that were found."""
        return self.bound[0] == self.ranks.constraints

    @property
    def actuation_is_identical(self) -> bool:
        """Whether the inputs span no more directions anywhere."""
        return self.rank_is_identical and self.bound[1] == self.ranks.constraints + self.ranks.actuation
