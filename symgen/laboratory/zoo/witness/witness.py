"""The numbers of what was generated against those of the zoo, at states on the branch that was drawn."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import yaml

from symgen.laboratory.zoo.dice import Dice
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.witness.allocation import directed, holding, is_directed, limits_of, members, preloads
from symgen.laboratory.zoo.witness.coverage import Tally
from symgen.laboratory.zoo.witness.generated import ARGUMENTS, Answer, Target, targets
from symgen.laboratory.zoo.witness.kkt import (
    DirectionSplit,
    EquationEvaluator,
    GenericRanks,
    along,
    inverse_dynamics,
    motion,
    split,
)
from symgen.laboratory.zoo.witness.limits import NoInputsError, nearest_within
from symgen.laboratory.zoo.witness.numbers.distances import distance, least_distance, norm
from symgen.laboratory.zoo.witness.numbers.fields import Balls, Floats, precision
from symgen.laboratory.zoo.witness.numbers.linear import NOTHING
from symgen.laboratory.zoo.witness.numbers.tape import FileNumber, NodeProgram
from symgen.laboratory.zoo.witness.pinocchio_answers import COMPARED, PinocchioAnswers
from symgen.laboratory.zoo.witness.pinocchio_trees import SAME, disagreement, tree_of
from symgen.laboratory.zoo.witness.reading.mechanics import equations
from symgen.laboratory.zoo.witness.reading.reader import SystemReader
from symgen.laboratory.zoo.witness.reading.stated_ranges import StatedRanges
from symgen.laboratory.zoo.witness.reading.urdf_file import expanded
from symgen.laboratory.zoo.witness.results import CheckResult, Finding, JudgedResult, Truth
from symgen.laboratory.zoo.witness.states import FloatState, Walker, rounded

STATES = 20
PERTURBATIONS = 8
ALLOWED = 16.0
EPS = {"float64": 2.0**-53, "float32": 2.0**-24}
# a status is a failure where rows, inputs and masses are further apart than this
CERTAIN = {"float64": 1e-4, "float32": 2e-2}
# Roundings by which rows that depend on V may differ at a state that is rounded: where two sheets of V touch along a
# whole motion they differ by more than the state is off V, and what is left of the one that is left out decides.
STRAY = 1e3
LARGEST = {"float64": 1e280, "float32": 1e30}
# the part of a state that a result is as long as
RESULTS = {"inverse_dynamics": "u", "forward_dynamics": "qdd"}
# The status of u where inputs span less than they do on the branch that the files are made for.
ACTUATION_RANK = 3
# Where a coordinate is out of a range that the file states.
COORDINATE_RANGE = 13


class Witness:
    """A model file read by the zoo alone."""

    def __init__(
        self,
        text: str,
        start: Mapping[str, float] | None = None,
        seed: object = 0,
        files: Mapping[str, str] | None = None,
    ) -> None:
        given: Mapping[str, Any] = yaml.load(text, Loader=yaml.BaseLoader)
        self._given, self._files = given, files or {}
        blocks = expanded(given, self._files)
        self._system = SystemReader(blocks)
        self._equations = equations(self._system)
        self._evaluate = EquationEvaluator(NodeProgram(self._system.tape, self._equations.flat), self._equations)
        self._seed = seed
        configuration = {name: float(value) for name, value in (blocks.get("configuration") or {}).items()}
        self._start = {**configuration, **(start or {})}
        self._ranges = StatedRanges(blocks, self._system.coordinates)
        self._balls = Balls()
        self._rows: Sequence[int] = range(len(self._system.rows))
        self._runtime: list[bool] = []
        self._spanned = 0

    def check(self, folder: Path, count: int = STATES) -> CheckResult:
        """Everything generated in a folder; nothing is compared where no state is found."""
        defaults, walker, tally = self.defaults(), self.walker(), Tally()
        states, ranks = walker.states(defaults, count)
        findings: list[Finding] = []
        largest = 0.0
        members = self.opened(folder)
        ranks = replace(ranks, kept=int(self._derivation(folder)["sizes"]["r"]))
        called = targets(folder, self._system.blocks["model"])
        for target in called:
            if members and len(target.parameters) != len(members):
                message = f"{target.name}: parameters {target.parameters} where {members} are due"
                findings.append(Finding("witness: parameters", message))
                continue
            for state in states:
                for quantity in target.quantities:
                    error, finding = self._compared(target, quantity, state, ranks, tally)
                    largest = max(largest, error)
                    if finding is not None:
                        findings.append(finding)
                        break
                if findings and findings[-1].text.startswith(target.name):
                    break
        findings += self._beside_pinocchio(called, states, ranks, tally)
        return CheckResult(tally.total(len(states), walker.lack, self._there), largest, tuple(findings))

    @property
    def _there(self) -> tuple[str, ...]:
        """Which of u, accelerations and multipliers the model has."""
        absent = {"inverse_dynamics": not self._system.inputs, "multipliers": not self._rows}
        return tuple(name for name in ARGUMENTS if not absent.get(name))

    def _beside_pinocchio(
        self, called: Sequence[Target], states: Sequence[FloatState], ranks: GenericRanks, tally: Tally
    ) -> Iterator[Finding]:
        """Where joints and bodies make a tree, or one that is closed: its forces, and double results of all states."""
        defaults = self.defaults()
        tree_and_system = tree_of(self._given, defaults, self._files)
        if tree_and_system is None:
            return
        other = disagreement(*tree_and_system, defaults, Dice("Pinocchio", self._seed))
        if other > SAME:
            yield Finding("witness: Pinocchio", f"the witness and Pinocchio differ by {other:.1e}")
            return
        answers = PinocchioAnswers(tree_and_system[0], self._system.blocks, ranks)
        names = (*self._system.coordinates, *self._system.rate_names)
        for target in called:
            for state in states if target.scalar == "float64" else ():
                values = {**defaults, **dict(zip(names, (*state.q, *state.qd), strict=True))}
                for quantity in (name for name in COMPARED if name in target.quantities):
                    answer = target.call(quantity, self._at_runtime(state), len(getattr(state, RESULTS[quantity])))
                    apart = None if answer.status else answers.apart(quantity, state, values, answer.value)
                    tally.pinocchio += apart is not None
                    if apart is not None and not apart <= SAME:
                        message = f"{target.name}, {quantity}: {apart:.1e} from Pinocchio's, {SAME:g} is allowed"
                        yield Finding("witness: Pinocchio", message)
                        return

    def _at_runtime(self, state: FloatState) -> FloatState:
        """With the parameters alone that the files take."""
        return replace(
            state, parameters=tuple(x for x, used in zip(state.parameters, self._runtime, strict=True) if used)
        )

    def opened(self, folder: Path) -> list[str]:
        """The parameters of what was generated in a folder, which is compared from now on."""
        derivation = self._derivation(folder)
        numbers = derivation.get("parameters_as_numbers", ())
        members = [name for name in (*self._system.parameters, *self._allocation()) if name not in numbers]
        self._runtime = [name in members for name in (*self._system.parameters, *self._allocation())]
        self._rows = self._rows_of(folder)
        self._spanned = int(derivation["sizes"]["alpha"])
        return members

    def walker(self) -> Walker:
        """What finds states of the system, from the configuration that was drawn."""
        return Walker(self._system, self._evaluate, self._start, Dice("states", self._seed))

    @property
    def shaping(self) -> frozenset[str]:
        """The parameters on which masses or constraints depend: masses, inertias, lengths, ratios."""
        nodes = [node for matrix in (self._equations.mass, self._equations.rows) for row in matrix for node in row]
        reached = self._system.tape.reached([*nodes, *self._equations.residual])
        return frozenset(str(node.payload) for node in reached if node.op == "symbol") & set(self._system.parameters)

    def defaults(self) -> dict[str, float]:
        """The values of the parameters in the file, of those of the allocation too."""
        values: dict[str, float] = {}
        with precision():
            exact: dict[str, Any] = {}
            for name, node in self._system.parameters.items():
                exact[name] = self._system.tape.evaluate([node], exact, self._balls)[0]
                values[name] = float(exact[name].mid())
        for name, value in self._allocation().items():
            values[name] = value
        return values

    @staticmethod
    def _derivation(folder: Path) -> dict[str, Any]:
        derivation: dict[str, Any] = json.loads((folder / "derivation.json").read_bytes())
        return derivation

    def _rows_of(self, folder: Path) -> Sequence[int]:
        """The rows that the files have multipliers of: those that hold in every configuration are left out there."""
        derivation = self._derivation(folder)
        names = {name for block in derivation["blocks"] for name in block["rows"]}
        kept = [index for index, row in enumerate(self._system.rows) if row.name in names]
        return kept if len(kept) == derivation["sizes"]["r"] else range(len(self._system.rows))

    def _allocation(self) -> dict[str, float]:
        return members(self._system.blocks.get("allocation") or {}, self._float)

    def _float(self, text: str) -> float:
        return float(self._system.tape.evaluate([self._system.read(text)], {}, Floats())[0])

    def _compared(
        self, target: Target, quantity: str, state: FloatState, ranks: GenericRanks, tally: Tally
    ) -> tuple[float, Finding | None]:
        """The error of one result in units of what is allowed, and what is wrong with it."""
        judged = self.compare(target, quantity, state, ranks)
        if judged is None:
            tally.unknown()
            return 0.0, None
        where = f"{target.name}, {quantity}"
        if judged.status:
            if not judged.certain:
                tally.status(target.scalar, judged.clear)
            message = f"{where}: status {judged.status} at a regular state ({judged.clear:.1e})"
            return 0.0, Finding("witness: status", message) if judged.certain else None
        tally.number(quantity)
        if judged.units <= 1:
            return judged.units, None
        message = (
            f"{where}: {ALLOWED * judged.units:.3g} units at a state, {ALLOWED:g} are allowed "
            f"(relative error {judged.relative:.1e})"
        )
        return judged.units, Finding("witness: number", message)

    def compare(self, target: Target, quantity: str, state: FloatState, ranks: GenericRanks) -> JudgedResult | None:
        """One result beside the truth, None where there is no truth."""
        scalar = target.scalar
        parts = (state.q, state.qd, state.qdd, state.u, state.parameters)
        given = FloatState(*(rounded(part, scalar) for part in parts))
        with precision():
            try:
                truth = self._truth(quantity, given, ranks)
            except NoInputsError:
                answer = target.call(quantity, self._at_runtime(given), len(self._system.inputs))
                # seven digits may not tell what is all but within limits from what is not
                wrong = answer.status == 0 and scalar == "float64"
                return JudgedResult(answer.status, math.inf if wrong else 0.0, math.inf if wrong else 0.0, 0.0, False)
            except ZeroDivisionError:  # so near to a drop of rank that these digits do not tell it from one
                return None
            if truth is None or truth.stray > STRAY * EPS[scalar]:
                return None
            answer = target.call(quantity, self._at_runtime(given), len(truth.value))
            exact = [float(x.mid()) for x in truth.value]
            if answer.status:
                certain = min(truth.clear, self._shortest_row(given, ranks)) > CERTAIN[scalar]
                certain = certain and all(abs(x) < LARGEST[scalar] for x in exact)
                if answer.status == COORDINATE_RANGE:
                    certain = self._ranges.hold(given.q)
                if quantity == "inverse_dynamics" and ranks.actuation < self._spanned:
                    # the branch that was drawn is told to be one on which inputs lose rank
                    certain = answer.status != ACTUATION_RANK
                return JudgedResult(answer.status, 0.0, 0.0, truth.clear, certain)
            units = self._units(answer, truth, quantity, given, ranks, EPS[scalar])
        apart = norm([a - b for a, b in zip(answer.value, exact, strict=True)])
        return JudgedResult(0, units, apart / (norm(exact) or 1.0), truth.clear, False)

    def _shortest_row(self, state: FloatState, ranks: GenericRanks) -> float:
        """The least length of a row beside its usual one: rows that all but vanish are a reason for a status."""
        names = (*self._system.coordinates, *self._system.rate_names)
        values = dict(zip(names, (*state.q, *state.qd), strict=True))
        values |= dict(zip((*self._system.parameters, *self._allocation()), state.parameters, strict=True))
        rows = self._evaluate(values, Floats()).rows
        pairs = zip(rows, ranks.lengths, strict=bool(ranks.lengths))
        return min((norm(row) / usual for row, usual in pairs if usual > NOTHING), default=1.0)

    def unit(self, quantity: str, state: FloatState, ranks: GenericRanks, scalar: str) -> float:
        """The most that roundings of the inputs change a result, as a share of it; infinite where there is none."""
        parts = (state.q, state.qd, state.qdd, state.u, state.parameters)
        given = FloatState(*(rounded(part, scalar) for part in parts))
        dice, moved = Dice("perturbations", self._seed), 0.0
        with precision():
            truth = self._known(quantity, given, ranks)
            if truth is None:
                return math.inf
            for _ in range(PERTURBATIONS):
                other = self._known(quantity, given, ranks, (dice, EPS[scalar]))
                moved = max(moved, math.inf if other is None else distance(other.value, truth.value))
            size = norm([float(x.mid()) for x in truth.value])
        return moved / size if size else 0.0 if not moved else math.inf

    def _units(
        self, answer: Answer, truth: Truth, quantity: str, state: FloatState, ranks: GenericRanks, eps: float
    ) -> float:
        """The error over what is allowed; what rounding the inputs does is worked out only where it is needed."""
        if not all(map(math.isfinite, answer.value)) or len(answer.value) != len(truth.value):
            return math.inf
        error = least_distance(answer.value, truth.value)
        size = norm([float(x.mid()) for x in truth.value])

        def moved(eps: float, allowed: float) -> float:
            """What is allowed where roundings of this size move the result, worked out as far as it is needed."""
            dice, largest, due = Dice("perturbations", self._seed), 0.0, allowed * eps * size
            for _ in range(PERTURBATIONS):
                if error <= due:
                    break
                other = self._known(quantity, state, ranks, (dice, eps))
                if other is not None:
                    largest = max(largest, distance(other.value, truth.value))
                due = allowed * (largest + eps * size)
            return due

        allowed = moved(eps, ALLOWED)
        if error > allowed:
            # the same, for roundings of the same signs, but where these move the result by their squares alone, such as
            # accelerations of idle motions
            allowed = max(allowed, moved(ALLOWED * eps, 1.0))
        return error / allowed if allowed else (math.inf if error else 0.0)

    def _known(
        self, quantity: str, state: FloatState, ranks: GenericRanks, moved: tuple[Dice, float] | None = None
    ) -> Truth | None:
        """The same, None where no inputs within their limits produce the motion or a rank is lost."""
        try:
            return self._truth(quantity, state, ranks, moved)
        except (NoInputsError, ZeroDivisionError):
            return None

    def _truth(
        self, quantity: str, state: FloatState, ranks: GenericRanks, moved: tuple[Dice, float] | None = None
    ) -> Truth | None:
        """The quantity in balls; where `moved` is given, of a state that is one rounding away."""
        number = self._balls.number

        def ball(value: float) -> Any:
            exact = Fraction(value)
            return number(exact + _sign(moved[0]) * Fraction(moved[1]) * exact) if moved else number(exact)

        names = (*self._system.coordinates, *self._system.rate_names)
        values = {name: ball(x) for name, x in zip(names, (*state.q, *state.qd), strict=True)}
        parameters = [ball(x) for x in state.parameters]
        values |= dict(zip((*self._system.parameters, *self._allocation()), parameters, strict=True))
        literals: dict[FileNumber, Any] | None = None
        if moved:
            literals = {
                literal: number(literal.value + _sign(moved[0]) * Fraction(moved[1]) * literal.value)
                for literal in self._evaluate.program.literals
            }
        at = self._evaluate(values, self._balls, literals)
        one = number(Fraction(1))
        parts = split(at, ranks.constraints, one)
        if len(parts.held) < ranks.constraints:
            return None
        if quantity == "inverse_dynamics":
            return self._inputs(at, parts, [ball(x) for x in state.qdd], ranks, values)
        u = [ball(x) for x in state.u]
        accelerations, multipliers, pivots = motion(at, parts, u)
        if not accelerations:
            return None
        clear = min((*parts.pivots, *pivots[-1:]), default=1.0)
        if quantity == "forward_dynamics":
            return Truth(accelerations, clear, parts.stray)
        return Truth([multipliers[index] for index in self._rows], clear, parts.stray)

    def _inputs(
        self, at: Any, parts: DirectionSplit, accelerations: list[Any], ranks: GenericRanks, values: Mapping[str, Any]
    ) -> Truth | None:
        """u, as the model's allocation says."""
        one = self._balls.number(Fraction(1))
        inputs = self._system.inputs
        block = self._system.blocks.get("allocation") or {}
        weights = [values.get(f"weight_{name}", one) for name in inputs] if "weights" in block else None
        near = preloads(inputs, block, values, one * 0)
        u, pivots = inverse_dynamics(at, parts, accelerations, ranks.actuation, weights, near)
        if len(pivots) < ranks.actuation:
            return None
        if block.get("limits") and not is_directed(at, ranks):
            by_input = weights or [one] * len(inputs)
            limits = limits_of(inputs, block, values)
            u = nearest_within(along(at, parts)[0], u, by_input, limits, len(inputs) - ranks.actuation)
        else:
            u = directed(holding(at, ranks), u, inputs, block, values, one)
        # where the inputs reach nothing, u is a plain 0
        u = [x + 0 * one for x in u]
        return Truth(u, min((*parts.pivots, *pivots), default=1.0), parts.stray)


def _sign(dice: Dice) -> int:
    return 1 if dice.chance(0.5) else -1


def check(description: Description, folder: Path) -> CheckResult:
    """What the witness says of the files in a folder; it must read all that is drawn."""
    text = description.text
    return Witness(text, description.start, text, description.files).check(folder)
