"""Whether the mechanism exists and moves: constraints consistent, δ > 0, masses where motion is possible."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.checks.masses import check_masses
from symgen.model.configurations.assembly import Assembly, RankedConfiguration
from symgen.model.configurations.dense import Rows, rank
from symgen.model.configurations.mechanics import NumericSystem
from symgen.model.configurations.open_loops import OpenLoop
from symgen.model.expressions.expression import Binary, Expression, Name, Power
from symgen.model.expressions.names import counted, shown_names
from symgen.model.expressions.walk import evaluate
from symgen.model.mechanism import Quaternion
from symgen.model.model import Coordinate, TaskCoordinate, TaskLeaves

# Configurations at which masses are looked at.
SAMPLES = 5
# Configurations beside them, for bodies of which only the sum may have a positive energy.
MORE_SAMPLES = 40

# Coordinates of a configuration that a message lists.
MOST_SHOWN = 6

# What rounding leaves of a coordinate that is 0, at most.
ROUNDING = 1e-12
# How far beside the constraints rows are looked at, in rad or m: far enough for a rank to be another.
BESIDE = 0.0371

# In rad, or of half a range: a declared start that is moved by more is told.
MOVED_FAR = 0.5


def check_motion(
    mechanics: NumericSystem,
    assembly: Assembly | OpenLoop | None,
    independent: tuple[str, ...],
    measured: tuple[str, ...],
    declared: Mapping[str, float],
    spans: dict[str, Span | None],
) -> Iterator[Mistake | Notice]:
    """What is wrong with the mechanism as a whole; `declared` is its start, `spans` are places to point at."""
    if not isinstance(assembly, Assembly):
        yield _no_configuration(mechanics, assembly, spans["geometric"])
        return
    n, rank = len(mechanics.coordinates), assembly.ranks.constraints
    if rank == n:
        against = f"{counted(n, 'coordinate')} under {counted(rank, 'independent constraint')}"
        yield Mistake(
            f"the mechanism cannot move: {against} (δ = 0)",
            "remove a constraint, or add the coordinate that is still free",
            spans["constraints"],
        )
        return
    if not assembly.regular:
        rows = shown_names(mechanics.constraints[i].name for i in assembly.losing)
        lost = f"there {rows} {'lose' if len(assembly.losing) > 1 else 'loses'} rank, and " if assembly.losing else ""
        yield Mistake(
            f"only singular configurations were found, such as {_shown(mechanics, assembly.places[0])}: {lost}beside "
            f"it the constraints that hold there have another rank than {rank}",
            "check lengths: what closes in a singular pose alone cannot move; give a regular one under "
            "`configuration`; write rows whose gradients do not vanish where they hold, no squares",
            spans["geometric"],
        )
        return
    regular = [(list(place.q), mechanics.jacobian(place.q)) for place in assembly.places[:SAMPLES]]
    places = [q for q, _ in regular] + _further(mechanics, assembly)
    yield from check_masses(mechanics, places, spans["kinetic_energy"])
    yield from _held(mechanics, assembly, spans["constraints"])
    yield from _far_start(mechanics, assembly, declared, spans["configuration"])
    yield from _other_branches(mechanics, assembly, spans["configuration"])
    if independent:
        yield from _check_independent(mechanics, regular, independent, n - rank, spans["independent_velocities"])
    if measured:
        yield from _check_measured(mechanics, [rows for _, rows in regular], measured, spans["measured"])


def _further(mechanics: NumericSystem, assembly: Assembly) -> list[list[float]]:
    """More configurations for bodies of which only the sum may have a positive energy."""
    if not mechanics.unsound:
        return []
    anywhere = [] if mechanics.geometric else [q for q, _ in mechanics.anywhere(MORE_SAMPLES)]
    return [*(list(place.q) for place in assembly.places[SAMPLES:]), *anywhere]


def _no_configuration(mechanics: NumericSystem, nearest: OpenLoop | None, span: Span | None) -> Mistake:
    """The mistake at the row that stays open widest."""
    message = "no configuration was found that satisfies all geometric constraints"
    remedy = "check signs and lengths, or give a start near the assembled mechanism under `configuration`"
    if nearest is None:
        return Mistake(message, remedy, span)
    row = mechanics.geometric[nearest.row]
    gap = f"`{row.name}` stays at {nearest.value:.3g}{_as_a_length(mechanics, row.expression, nearest.value)}"
    return Mistake(f"{message}; {gap} in the nearest one", remedy, row.span or span)


def _as_a_length(mechanics: NumericSystem, row: Expression, value: float) -> str:
    """What is left of a row `square - length**2`, said of the length."""
    match row:
        case Binary(operator="-", right=Power(base=length, exponent=exponent)) if exponent == 2:
            try:
                due = evaluate(length, mechanics.defaults)
            except (KeyError, ArithmeticError, ValueError):
                return ""
            square = value + due**2
            return f", a length of {math.sqrt(square):.3g} in place of {due:.3g}," if square >= 0 else ""
    return ""


def _far_start(
    mechanics: NumericSystem, assembly: Assembly, declared: Mapping[str, float], span: Span | None
) -> Iterator[Notice]:
    """That the declared start is far from closing: what it leads to may be another assembly than the one meant."""
    if assembly.start is not None or not mechanics.geometric:
        return
    # the start may lie on a branch on which the inputs span less
    moved = min((_moved(mechanics, place, declared) for place in (assembly.places[0], *assembly.others)), key=len)
    if moved:
        listed = ", ".join(f"{name} = {value:.3g} in place of {given:.3g}" for name, given, value in moved[:MOST_SHOWN])
        more = ", ..." if len(moved) > MOST_SHOWN else ""
        yield Notice(
            f"the start does not satisfy the geometric constraints, what it leads to is far from it: {listed}{more}; a "
            "start that nearly closes the loops says which assembly is meant",
            span,
        )


def _moved(
    mechanics: NumericSystem, place: RankedConfiguration, declared: Mapping[str, float]
) -> list[tuple[str, float, float]]:
    """The coordinates whose declared start is far from a configuration, with both values."""
    return [
        (c.name, declared[c.name], value)
        for c, value in zip(mechanics.coordinates, place.q, strict=True)
        if c.name in declared and abs(value - declared[c.name]) > MOVED_FAR * (1.0 if c.is_angle else _width(c))
    ]


def _width(coordinate: Coordinate) -> float:
    return float(coordinate.range[1] - coordinate.range[0]) / 2


def _other_branches(mechanics: NumericSystem, assembly: Assembly, span: Span | None) -> Iterator[Notice]:
    """That the start is singular, and that there are branches on which kernels give a status."""
    n, meant = len(mechanics.coordinates), assembly.ranks
    if assembly.start is not None:
        begin = "the start leads" if span is not None else "the middles of the ranges lead"
        yield Notice(
            f"{begin} to a singular configuration ({_shown(mechanics, assembly.start)}): ranks are those of others; a "
            "regular one under `configuration` says which branch is meant",
            span,
        )
    for place in assembly.others:
        ranks = place.ranks
        if ranks.constraints == meant.constraints:
            spans = f"the inputs span {ranks.actuation} of {n - ranks.constraints} directions, here {meant.actuation}"
        else:
            spans = f"the constraints have rank {ranks.constraints}, here {meant.constraints}"
        yield Notice(
            f"another branch of configurations ({_shown(mechanics, place)}): {spans}; there the functions that "
            "need this rank return a status",
            span,
        )


def _shown(mechanics: NumericSystem, place: RankedConfiguration) -> str:
    """The first coordinates of a configuration."""
    pairs = zip(mechanics.coordinates, place.q, strict=True)
    shown = [f"{c.name} = {_clean(value):.3g}" for c, value in pairs][:MOST_SHOWN]
    return ", ".join(shown) + (", ..." if len(place.q) > MOST_SHOWN else "")


def _clean(value: float) -> float:
    """A value without what rounding leaves of 0."""
    return 0.0 if abs(value) < ROUNDING else value


def _held(mechanics: NumericSystem, assembly: Assembly, span: Span | None) -> Iterator[Notice]:
    """Coordinates that no admissible motion changes: more often an axis that is not parallel than what was meant.

    Held are they along the branches that were looked at; where rows hold them beside the constraints, too, on any.
    """
    everywhere = _held_everywhere(mechanics, assembly)
    here = [i for i in assembly.held if i not in everywhere]
    if everywhere:
        rotations = (frame.rotation for frame in mechanics.mechanism.frames)
        parts = {x.name for r in rotations if isinstance(r, Quaternion) for x in r.parts if isinstance(x, Name)}
        # an attitude has four parts, whatever it is held to
        spare = sum(mechanics.coordinates[i].name not in parts for i in everywhere)
        left_out = f", else leave the coordinate{'s' if spare > 1 else ''} out" if spare == len(everywhere) else ""
        held = _values(mechanics, assembly, everywhere)
        yield Notice(
            f"{_named(mechanics, everywhere)} cannot move: the constraints hold {held}; if that is not meant, check "
            f"axes, lengths and loops{left_out}",
            span,
        )
    if here:
        yield Notice(
            f"{_named(mechanics, here)} cannot move in the configurations that were looked at: the constraints hold "
            f"{_values(mechanics, assembly, here)} there, and may leave {'it' if len(here) == 1 else 'them'} free in "
            f"others; if that is not meant, check axes, lengths and loops, or give a `configuration`",
            span,
        )


def _named(mechanics: NumericSystem, places: Sequence[int]) -> str:
    return shown_names(mechanics.coordinates[i].name for i in places)


def _values(mechanics: NumericSystem, assembly: Assembly, places: Sequence[int]) -> str:
    """What coordinates are held at."""
    q = assembly.places[0].q
    listed = ", ".join(f"{mechanics.coordinates[i].name} = {_clean(q[i]):.4g}" for i in places[:MOST_SHOWN])
    return listed + (", ..." if len(places) > MOST_SHOWN else "")


def _held_everywhere(mechanics: NumericSystem, assembly: Assembly) -> list[int]:
    """Those that rows leave no motion beside the constraints either, where they have the same rank."""
    if not assembly.held:
        return []
    q, known = assembly.places[0].q, assembly.ranks.constraints
    beside = [mechanics.jacobian([x + BESIDE * (k % 7 + turn) for k, x in enumerate(q)]) for turn in (1, 3)]
    if any(rank(rows) != known for rows in beside):
        return []
    axes = {i: [float(j == i) for j in range(len(q))] for i in assembly.held}
    return [i for i, axis in axes.items() if all(rank([*rows, axis]) == known for rows in beside)]


def measures_places(mechanics: NumericSystem, assembly: Assembly, measured: tuple[str, ...]) -> bool:
    """Whether geometric rows and what is measured determine every place: rows that hold rates alone do not."""
    names = [c.name for c in mechanics.coordinates]
    known = [[float(name == other) for other in names] for name in measured]
    rows = (mechanics.jacobian(place.q)[: len(mechanics.geometric)] for place in assembly.places[:SAMPLES])
    return any(rank([*place, *known]) == len(names) for place in rows)


def left_by_task(mechanics: NumericSystem, assembly: Assembly, task: Sequence[TaskCoordinate]) -> TaskLeaves:
    """How many directions rows and a task leave open, of rates and of places, where they leave fewest."""
    if not task:
        return TaskLeaves()
    n, geometric = len(mechanics.coordinates), len(mechanics.geometric)
    rates, places, idle = n, n, len(task)
    for place in assembly.places[:SAMPLES]:
        # a function may have no value at some of them
        with suppress(ArithmeticError, ValueError):
            slopes = mechanics.gradients(place.q, [x.expression for x in task])
            moved = [[row.get(j, 0.0) for j in range(n)] for row in slopes]
            rows = mechanics.jacobian(place.q)
            rates = min(rates, n - rank([*rows, *moved]))
            places = min(places, n - rank([*rows[:geometric], *moved]))
            idle = min(idle, len(task) - rank([*rows, *moved]) + rank(rows))
    return TaskLeaves(rates, places, idle)


def _check_measured(
    mechanics: NumericSystem, places: Sequence[Rows], measured: tuple[str, ...], span: Span | None
) -> Iterator[Mistake]:
    """What is measured must determine the other rates somewhere."""
    names = [c.name for c in mechanics.coordinates]
    units = {name: [float(name == other) for other in names] for name in names}
    known = [units[name] for name in measured]
    rows = max(([*place, *known] for place in places), key=rank)
    if missing := len(names) - rank(rows):
        more = [name for name in names if rank([*rows, units[name]]) > len(names) - missing]
        yield Mistake(
            f"{shown_names(measured)} do{'es' if len(measured) == 1 else ''} not determine the other rates anywhere: "
            f"{counted(missing, 'direction')} stay{'s' if missing == 1 else ''} open",
            f"name {counted(missing, 'coordinate')} more in `measured`, such as {shown_names(more[:MOST_SHOWN])}",
            span,
        )


def _check_independent(
    mechanics: NumericSystem,
    regular: list[tuple[list[float], Rows]],
    chosen: tuple[str, ...],
    delta: int,
    span: Span | None,
) -> Iterator[Mistake]:
    if len(chosen) != delta:
        yield Mistake(
            f"`independent_velocities` has {counted(len(chosen), 'name')}, the system has δ = {delta}",
            f"name {counted(delta, 'coordinate')} whose rates determine all others",
            span,
        )
        return
    n = len(mechanics.coordinates)
    dependent = [index for index, c in enumerate(mechanics.coordinates) if c.name not in chosen]
    if not any(rank([[row[i] for i in dependent] for row in b]) == n - delta for _, b in regular):
        yield Mistake(
            f"the rates of {', '.join(chosen)} do not determine the others anywhere",
            "choose other `independent_velocities`",
            span,
        )
