"""Which branches the configurations of a mechanism have, and the ranks on them.

Ranks are decided on configurations in double precision with a gap of many orders of magnitude between "zero" and "not
zero"; what falls into the gap is thrown away.  A configuration counts for a branch if it is regular: a small step along
an admissible direction leads to a configuration of the same ranks.  So a singular pose, to which Newton's method likes
to converge, is no branch, and neither is an assembly that cannot move.

The rank of B is the one on the branch of the declared start, without one the largest on any branch that moves; the
inputs are taken to span what they span on the best branch of that rank.  Where ranks are lower a kernel returns a
status.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import replace

from symgen.model.checks.shaken import Shaken
from symgen.model.configurations.assembly import Assembly, ConfigurationRanks, RankedConfiguration
from symgen.model.configurations.closing import CLOSED, Closer, row_unit
from symgen.model.configurations.dense import null_space
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.open_loops import OpenLoop, OpenLoops
from symgen.model.configurations.sparse import NEGLIGIBLE, PLAIN, Row, Scales, clear_rank, pivots, typical
from symgen.model.configurations.starts import Starts
from symgen.model.model import Input

# Configurations where no constraint holds any.
FREE_POINTS = 6
# Configurations, on the constraints or not, that tell how large entries of the rows usually are.
TYPICAL_POINTS = 4
# Starts at least, and configurations that are enough where no rank can be greater than found.
FEWEST_STARTS, ENOUGH = 8, 4
# Further starts, for loops that stay open where others close.
RETRIES = 3
# Rows evaluated on the way, and how many times as many as long as nothing regular is found.
EFFORT, LONGEST = 30_000, 5
# Configurations where entries are told from rounding.
SHAKEN_POINTS = 2
# In coordinate widths, along a branch; where motion is confined to less, a smaller one is told from none.
STRIDES = (1e-3, 1e-4, 1e-5, 1e-6)
# Configurations along a branch, and how far they are apart at most.
WALK, STRIDE = 5, 0.2
# Configurations that say that a coordinate is held, and motions in its width that are none.
ENOUGH_HELD, HELD = 3, 1e-7
# Of a step, by which a regular branch leaves its tangent at most.
STRAIGHT = 0.1
# Of rows of length 1, at a singular configuration, and of what they lack of a rank.
SINGULAR, SHARE = 1e-3, 0.05
# Configurations of the same ranks that are looked at for a regular one.
TRIED = 3


def branches(mechanics: NumericSystem, inputs: Sequence[Input], start: dict[str, float]) -> Assembly | OpenLoop | None:
    """The assembly; where loops stay open; None where the constraints have no value."""
    return _Search(mechanics, inputs, start).result()


class _Search:
    def __init__(self, mechanics: NumericSystem, inputs: Sequence[Input], start: dict[str, float]) -> None:
        self._mechanics, self._inputs, self._start = mechanics, inputs, start
        self._starts = Starts(mechanics, inputs, start)
        self._n, self._r_geometric = len(mechanics.coordinates), len(mechanics.geometric)
        self._widths = self._starts.widths
        samples = list(self._sampled())
        self._usable = bool(samples)
        sizes = self._without_noise(typical(rows for _, rows in samples), [q for q, _ in samples])
        self._scales = Scales(sizes)
        rows = sizes[: len(mechanics.constraints)]
        self._units = tuple(round(math.log2(row_unit(row.values()))) for row in rows)
        geometric = sizes[: self._r_geometric]
        self._closer = Closer(mechanics.residuals, geometric, self._widths)
        # what is looked for there takes nothing off the effort of the search
        self._open_loops = OpenLoops(
            Closer(mechanics.residuals, geometric, self._widths), lambda: Starts(mechanics, inputs, start)
        )
        self._bound = self._bounds([*(rows for _, rows in samples), *self._with_other_parameters()])

    def result(self) -> Assembly | OpenLoop | None:
        if not self._usable:
            return None
        configurations = list(self._free() if not self._r_geometric else self._closed())
        if not configurations:
            return self._open_loops.widest()
        # where sizes differ too much no rank is clear-cut: then what is not negligible counts
        for plain in (PLAIN, NEGLIGIBLE):
            places = [
                RankedConfiguration(q, ranks)
                for q in configurations
                if (ranks := self._ranks(q, plain)) is not None
            ]
            if places:
                assembly = self._chosen(places, configurations[0])
                losing = () if assembly.regular else self._losing(assembly.places[0])
                units = self._units_of(assembly)
                return replace(
                    assembly, held=self._held(assembly), losing=losing, units=units, own_units=self._units
                )
        return None

    def _losing(self, place: RankedConfiguration) -> tuple[int, ...]:
        """The rows that take part in what B lacks of its rank at a singular configuration."""
        r = len(self._mechanics.constraints)
        rows = self._scales.scaled(self._rows(place.q) or [{}] * r)[:r]
        columns = [[row.get(j, 0.0) for row in rows] for j in range(self._n)]
        telling = [column for column in columns if max(map(abs, column), default=0.0) > SINGULAR]
        lacking = null_space(telling, r, SINGULAR)
        return tuple(i for i in range(r) if any(abs(vector[i]) > SHARE for vector in lacking))

    def _units_of(self, assembly: Assembly) -> tuple[int, ...]:
        """The units of rows; one for those that depend on each other, whose smallest multipliers are meant.

        The largest of them carry the load: where one is of ordinary size all stay as they are, as its multiplier would
        drown, times what makes a small row ordinary, in what is left of others.
        """
        r = len(self._mechanics.constraints)
        evaluated = self._rows(assembly.places[0].q)
        if assembly.ranks.constraints == r or evaluated is None or not any(self._units):
            return self._units
        rows = self._scales.scaled(evaluated)[:r]
        least = assembly.ranks.constraints
        spare = [i for i in range(r) if clear_rank(rows[:i] + rows[i + 1 :], NEGLIGIBLE) != least - 1]
        own = [self._units[i] for i in spare] or [0]
        shared = max(own, key=abs) if min(own) > 0 else min(own) if max(own) <= 0 else 0
        return tuple(shared if i in spare else unit for i, unit in enumerate(self._units))

    def _sampled(self) -> Iterator[tuple[list[float], list[Row]]]:
        """B and M at random configurations, whether they satisfy the constraints or not."""
        count = 0
        for _ in range(10 * TYPICAL_POINTS):
            place = self._starts.anywhere(whole=False)
            rows = self._rows(place)
            if rows is not None:
                yield place, rows
                count += 1
            if count == TYPICAL_POINTS:
                return

    def _with_other_parameters(self) -> Iterator[list[Row]]:
        """The same for other values of the parameters: rows may depend on each other for the default ones only."""
        for q, parameters in self._mechanics.anywhere(TYPICAL_POINTS):
            rows = self._rows(q, self._mechanics.having(parameters))
            if rows is not None:
                yield rows

    def _without_noise(self, sizes: list[Row], places: Sequence[list[float]]) -> list[Row]:
        """The entries that are not what rounding leaves of zeros."""
        shaken = Shaken(self._mechanics, self._inputs, _evaluated)
        for q in places[:SHAKEN_POINTS]:
            shaken.look(q)
        return [{j: x for j, x in row.items() if not shaken.is_rest(i, j)} for i, row in enumerate(sizes)]

    def _bounds(self, samples: Sequence[Sequence[Row]]) -> tuple[int, int]:
        r = len(self._mechanics.constraints)
        scaled = [self._scales.scaled(rows) for rows in samples]
        alone = max((clear_rank(rows[:r], NEGLIGIBLE) or 0 for rows in scaled), default=0)
        return alone, max((clear_rank(rows, NEGLIGIBLE) or 0 for rows in scaled), default=0)

    def _rows(self, q: Sequence[float], other: NumericSystem | None = None) -> list[Row] | None:
        try:
            rows = _evaluated(other or self._mechanics, self._inputs, q)
        except (ArithmeticError, ValueError):
            return None
        return rows if all(math.isfinite(value) for row in rows for value in row.values()) else None

    def _ranks(self, q: Sequence[float], plain: float = PLAIN) -> ConfigurationRanks | None:
        rows = self._rows(q)
        if rows is None:
            return None
        rows = self._scales.scaled(rows)
        r = len(self._mechanics.constraints)
        geometric = clear_rank(rows[: self._r_geometric], plain)
        constraints = geometric if r == self._r_geometric else clear_rank(rows[:r], plain)
        together = constraints if r == len(rows) else clear_rank(rows, plain)
        if geometric is None or constraints is None or together is None:
            return None
        return ConfigurationRanks(constraints, geometric, together - constraints)

    def _free(self) -> Iterator[tuple[float, ...]]:
        count, q = 0, tuple(self._starts.begin())
        for number in range(10 * FREE_POINTS):
            q = tuple(self._starts.anywhere(whole=False)) if number else q
            if self._rows(q) is not None:
                yield q
                count += 1
            if count == FREE_POINTS:
                return

    def _closed(self) -> Iterator[tuple[float, ...]]:
        """Configurations on the geometric constraints, where the start leads first."""
        configurations: list[tuple[float, ...]] = []
        reached: list[ConfigurationRanks] = []
        regular = False
        for number, (guess, held) in enumerate(self._starts.guesses(configurations)):
            q = self._close(guess, held)
            if q is not None:
                q = self._turned_back(q) if number else q
                configurations.append(q)
                yield q
                if (ranks := self._ranks(q)) is not None:
                    reached.append(ranks)
                    regular = regular or self._is_regular(RankedConfiguration(q, ranks))
            enough = number + 1 >= FEWEST_STARTS
            if number + 1 == FEWEST_STARTS and not configurations and self._open_loops.a_part_stays_open():
                return
            if enough and len(configurations) >= ENOUGH and self._at_bound(reached):
                return
            if self._closer.effort > EFFORT and (regular or self._closer.effort > LONGEST * EFFORT):
                return

    def _at_bound(self, reached: Sequence[ConfigurationRanks]) -> bool:
        """Whether no rank can be greater than those found, and motion is left."""
        constraints = self._bound[0]
        most = min(len(self._inputs), self._n - constraints, self._bound[1] - constraints)
        best = [ranks.actuation for ranks in reached if ranks.constraints == constraints]
        return constraints < self._n and max(best, default=-1) >= most

    def _close(self, guess: list[float], held: tuple[int, ...]) -> tuple[float, ...] | None:
        """What a guess leads to; loops that stay open while others close are tried again by themselves."""
        closed = self._closer.close(guess, None, held)
        if held and closed.open:
            closed = self._closer.close(closed.q, closed.open)
        for _ in range(RETRIES if len(closed.open) < len(self._closer.loops) else 0):
            if not closed.open:
                break
            anew, place = self._starts.anywhere(whole=True), list(closed.q)
            for loop in closed.open:
                for j in loop.coordinates:
                    place[j] = anew[j]
            closed = self._closer.close(place, closed.open)
        return None if closed.open else closed.q

    def _turned_back(self, q: tuple[float, ...]) -> tuple[float, ...]:
        """The same configuration with angles in their ranges, where whole turns change nothing."""
        turned = []
        for x, c in zip(q, self._mechanics.coordinates, strict=True):
            low, high = map(float, c.range)
            turns = math.ceil((low - x) / math.tau) if c.is_angle and not low <= x <= high else 0
            turned.append(x + turns * math.tau if x + turns * math.tau <= high else x)
        return tuple(turned) if self._closer.rest(turned) <= CLOSED else q

    def _chosen(self, places: Sequence[RankedConfiguration], first: tuple[float, ...]) -> Assembly:
        kinds: dict[ConfigurationRanks, list[RankedConfiguration]] = {}
        for place in places:
            kinds.setdefault(place.ranks, []).append(place)
        if not self._r_geometric:
            ranks = max(kinds, key=lambda kind: (kind.constraints, kind.actuation))
            return Assembly(ranks, tuple(kinds[ranks]), (), self._bound)
        moving = {
            kind: next((place for place in these[:TRIED] if self._is_regular(place)), None)
            for kind, these in kinds.items()
            if kind.constraints < self._n
        }
        branch = {kind: place for kind, place in moving.items() if place is not None}
        begin = next((place for place in places if place.q == first), None)
        start_is_regular = begin is not None and begin.ranks in branch and self._is_regular(begin)
        if branch:
            inside = {kind for kind in branch if any(self._in_ranges(place) for place in kinds[kind])} or {*branch}
            if self._start and begin is not None and start_is_regular:
                constraints = begin.ranks.constraints
            else:
                constraints = max(kind.constraints for kind in inside)
            able = [kind for kind in branch if kind.constraints == constraints]
            ranks = max(able, key=lambda kind: (kind.actuation, kind.geometric))
        else:
            # an assembly that cannot move, else nothing but singular configurations
            rigid = [kind for kind in kinds if kind.constraints == self._n]
            count = Counter(place.ranks for place in places)
            ranks = rigid[0] if rigid else max(count, key=lambda kind: (count[kind], kind.constraints, kind.actuation))
        others = tuple(place for kind, place in branch.items() if kind != ranks)
        there = begin.ranks if begin else ConfigurationRanks(0, 0, 0)
        singular = None if start_is_regular else RankedConfiguration(first, there)
        these = kinds[ranks]
        if singular is not None:
            these = sorted(these, key=self._nearness)
        return Assembly(ranks, tuple(these), others, self._bound, singular, bool(branch))

    def _nearness(self, place: RankedConfiguration) -> float:
        """How near a configuration is to a drop of rank: the less the smallest pivot, the more."""
        rows = self._rows(place.q)
        pivot_sizes = None if rows is None else pivots(self._scales.scaled(rows))
        return -min(pivot_sizes or [0.0])

    def _is_regular(self, place: RankedConfiguration) -> bool:
        """Whether the ranks stay as they are where a step along an admissible direction leads."""
        q = place.q
        direction = self._closer.along(q, self._starts.direction())
        if direction is None:
            return False
        longest = max(map(abs, direction))
        return longest >= STRIDES[0] and any(self._stays(place, direction, step / longest, step) for step in STRIDES)

    def _stays(self, place: RankedConfiguration, direction: Sequence[float], share: float, step: float) -> bool:
        """Whether a step along an admissible direction leads to a configuration of the same ranks close by.

        Beside a pose at which motion ends rows are closed but for the square of the distance, so that their rest has
        to be less than the least that a step across them would leave.
        """
        moved = [x + share * a * w for x, a, w in zip(place.q, direction, self._widths, strict=True)]
        closed = self._closer.close(moved)
        if closed.open or not self._closer.rest(closed.q) <= STRAIGHT * PLAIN * step:
            return False
        off = max(abs(a - b) / w for a, b, w in zip(closed.q, moved, self._widths, strict=True))
        return off <= STRAIGHT * step and self._ranks(closed.q) == place.ranks

    def _held(self, assembly: Assembly) -> tuple[int, ...]:
        """Coordinates that no admissible motion changes: along the branch of the declared start, else on any."""
        meant = bool(self._start) and assembly.start is None
        places = self._along(assembly.places[0]) if meant else [*assembly.places, *assembly.others]
        if len(places) < ENOUGH_HELD or not assembly.ranks.constraints:
            return ()
        held = set(range(self._n))
        r = len(self._mechanics.constraints)
        for place in places:
            evaluated = self._rows(place.q)
            if evaluated is None or not held:
                return ()
            rows = self._scales.scaled(evaluated)[:r]
            motions = null_space([[row.get(j, 0.0) for j in range(self._n)] for row in rows], self._n)
            held = {j for j in held if all(abs(motion[j]) < HELD for motion in motions)}
        return tuple(sorted(held))

    def _along(self, place: RankedConfiguration) -> list[RankedConfiguration]:
        """A walk along a branch, with shorter steps where it is bent more."""
        walk, stride = [place], STRIDE
        for _ in range(3 * WALK):
            direction = self._closer.along(walk[-1].q, self._starts.direction())
            longest = max(map(abs, direction or ()), default=0.0)
            if direction is None or longest < STRIDES[0] or len(walk) == WALK:
                break
            pairs = zip(walk[-1].q, direction, self._widths, strict=True)
            closed = self._closer.close([x + stride * a / longest * w for x, a, w in pairs])
            if not closed.open and self._ranks(closed.q) == place.ranks:
                walk.append(RankedConfiguration(closed.q, place.ranks))
            else:
                stride /= 4
        return walk

    def _in_ranges(self, place: RankedConfiguration) -> bool:
        """Whether every coordinate lies in its range, but for a hundredth of its width."""
        for x, c in zip(place.q, self._mechanics.coordinates, strict=True):
            low, high = map(float, c.range)
            slack = 0.01 * (high - low)
            if not low - slack <= x <= high + slack:
                return False
        return True


def _evaluated(mechanics: NumericSystem, inputs: Sequence[Input], q: Sequence[float]) -> list[Row]:
    """The rows of B, and the columns of M as rows."""
    return [*mechanics.rows(q), *mechanics.columns(q, inputs)]
