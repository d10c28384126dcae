"""The states of points: parameters, and configurations on a path, by a walk from the model's own, or as given."""

from __future__ import annotations

import time
from collections import OrderedDict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from threading import Lock

import numpy as np
from numpy.typing import NDArray

from symgen.generation.requested import configuration_near
from symgen.mechanics.genericity import assembly_of, parameter_values
from symgen.mechanics.system import System
from symgen.model.model import Model
from symgen.paths.path_equations import path_equations
from symgen.paths.path_family import PathFamily
from symgen.study.asked.request import MODES, REGULAR
from symgen.study.assembly_modes import assembly_modes
from symgen.study.chunks import Array, along_values
from symgen.study.kernels import Codes, StudyKernels
from symgen.study.neighbours.continuation import Neighbours, WalkStart
from symgen.study.neighbours.regular import RegularPlaces, limits
from symgen.study.plan import FROM_MEASURED, FROM_TASK, TASK_PLACE, StudyPlan, VariedName

# The status of the states of a path that cannot be followed, beside those of kernels.
NO_PATH = 255
# Bytes of solved paths that are kept: points whose parameters do not change the path share one.
KEPT_BYTES = 2**27


@dataclass(frozen=True, slots=True)
class BlockStates:
    """States of some points: parameters (points x parameters), q, qd and qdd by name (groups x n x states), whose
    states a point has, and why there is no configuration (groups x states, 0 where there is one).

    `assembled` says of each assembly mode whether it is reached (points x modes x states), `regular` whether a way
    passes no singularity (points x states), where that is shown."""

    parameters: Array
    parts: Mapping[str, Array]
    group: NDArray[np.uintp]
    placed: Codes
    assembled: Array | None = None
    regular: Array | None = None


class StudyStates:
    """What makes the states of points; `times` (s) are those of the path, if there is one."""

    def __init__(self, plan: StudyPlan, kernels: StudyKernels) -> None:
        self._plan, self._kernels = plan, kernels
        values = parameter_values(System(plan.model))
        self._defaults = np.array([values[one.name] for one in plan.model.parameters] or [0.0])
        self._along = along_values(plan)
        self._path = _SolvedPaths(plan) if plan.placing == "path" else None
        self._nodes = Neighbours(plan, kernels)
        self._regular: RegularPlaces | None = None
        self._lock = Lock()

    def of(self, values: Array) -> BlockStates:
        """The states of points with these values of the varied names (points x names)."""
        p = np.tile(self._defaults, (len(values), 1))
        for k, one in enumerate(self._plan.over):
            if one.kind == "parameter":
                p[:, one.place] = values[:, k]
        if self._path is not None:
            return self._path.states(p)
        q, placed = self._configurations(p, values)
        still = np.zeros_like(q)
        assembled = self._assembled(p, values) if MODES in self._plan.shown else None
        regular = self._regular_ways(p, values, q) if REGULAR in self._plan.shown else None
        group = np.arange(len(p), dtype=np.uintp)
        return BlockStates(p, {"q": q, "qd": still, "qdd": still}, group, placed, assembled, regular)

    def _regular_ways(self, p: Array, values: Array, q: Array) -> Array:
        """Whether a way from the start passes no singularity, 1 or 0 (points x states)."""
        start, kind = self._start_at(np.array(assembly_of(self._plan.model).places[0].q))
        with self._lock:
            self._regular = self._regular or RegularPlaces(self._plan, self._kernels, start)
        given = self._filled(start.x, values, kind)
        points, states = given.shape[:2]
        each = np.repeat(p, states, axis=0), given.reshape(points * states, -1), np.swapaxes(q, 1, 2)
        reached = self._regular.reached(each[0], each[1], each[2].reshape(points * states, -1))
        return reached.reshape(points, states).astype(np.float64)

    def _assembled(self, p: Array, values: Array) -> Array:
        """Whether the walk from each assembly mode of the start ends, and within the ranges that coordinates have."""
        low, high = (ends[:, None] for ends in limits(self._plan.model))
        made = []
        for mode in assembly_modes(self._plan.model, self._plan.placing == "task"):
            q, placed = self._walked(p, values, np.array(mode))
            made.append((placed == 0) & ((q >= low) & (q <= high)).all(axis=1))
        return np.stack(made, axis=1).astype(np.float64)

    def _configurations(self, p: Array, values: Array) -> tuple[Array, Codes]:
        """q (points x n x states) at rest, and statuses."""
        model = self._plan.model
        if self._plan.placing == "given":
            q = self._filled(np.array(configuration_near(model, {})), values, "coordinate")
            return np.ascontiguousarray(np.swapaxes(q, 1, 2)), np.zeros((len(q), q.shape[1]), dtype=np.uint8)
        return self._walked(p, values, np.array(assembly_of(model).places[0].q))

    def _walked(self, p: Array, values: Array, q_start: Array) -> tuple[Array, Codes]:
        """q (points x n x states) at places of the task, or of measured coordinates, from a configuration: by a walk
        from there, else from solved neighbours."""
        start, kind = self._start_at(q_start)
        given = self._filled(start.x, values, kind)
        q, placed = self._kernels.walked(start.kernel, (start.p, start.x, start.q), p, given)
        if placed.any() and (nodes := self._nodes.of(start)) is not None:
            points, states = np.nonzero(placed)
            hopped = nodes.hopped(p[points], given[points, states])
            ended = np.isfinite(hopped[:, 0])
            points, states = points[ended], states[ended]
            q[points, :, states], placed[points, states] = hopped[ended], 0
        return q, placed

    def _start_at(self, q: Array) -> tuple[WalkStart, str]:
        """Walks from a configuration, and the kind of names that are given."""
        if self._plan.placing == "measured":
            return WalkStart(FROM_MEASURED, self._defaults, q[list(self._plan.model.measured_places)], q), "measured"
        return WalkStart(FROM_TASK, self._defaults, self._task_place(q), q), "task"

    @property
    def seconds_once(self) -> float:
        """How long it took to solve for neighbours, or for the one path of all machines: this is not done by points."""
        solved = self._nodes.seconds + (self._regular.seconds if self._regular is not None else 0.0)
        return solved + (self._path.seconds_once if self._path is not None else 0.0)

    def _task_place(self, q: Array) -> Array:
        x, _ = self._kernels.over(
            TASK_PLACE, {"q": q[None, :, None]}, np.zeros(1, dtype=np.uintp), self._defaults[None]
        )
        return x[0, :, 0].copy()

    def _filled(self, start: Array, values: Array, kind: str) -> Array:
        """Places (points x states x k) as they are at the start, but where they are varied."""
        places = np.tile(start, (len(values), len(self._along), 1))
        for k, one in _of_kind(self._plan.over, kind):
            places[:, :, one.place] = values[:, k, None]
        for k, one in _of_kind(self._plan.along, kind):
            places[:, :, one.place] = self._along[:, k]
        return places


class _SolvedPaths:
    """The path of a study at the parameters of points, solved once for all that do not change it."""

    def __init__(self, plan: StudyPlan) -> None:
        assert plan.request.path is not None
        name = plan.request.path.name
        self._model: Model = plan.model
        self._path = next(one for one in plan.model.paths if one.name == name)
        equations = path_equations(plan.model, self._path)
        self._family = PathFamily(plan.model, self._path, equations)
        self._used = list(equations.parameters_used)
        varied = {one.place for one in plan.over if one.kind == "parameter"}
        self._is_one = varied.isdisjoint(self._used)
        self._most_kept = max(1, KEPT_BYTES // (3 * plan.model.n * self._path.samples * 8))
        self._kept: OrderedDict[bytes, tuple[Array, ...] | None] = OrderedDict()
        self._lock = Lock()
        self.seconds_once = 0.0
        """How long it took to solve for the path where all machines have the same."""

    def states(self, p: Array) -> BlockStates:
        """The states of points with these parameters."""
        changing = np.ascontiguousarray(p[: 1 if self._is_one else None, self._used])
        if self._is_one:
            first, group = np.zeros(1, dtype=np.intp), np.zeros(len(p), dtype=np.intp)
        else:
            _, first, group = np.unique(changing, axis=0, return_index=True, return_inverse=True)
        solved = self._solved(p[first], [changing[k].tobytes() for k in first])
        empty = np.full((self._model.n, self._path.samples), np.nan)
        parts = {
            name: np.stack([empty if one is None else one[k] for one in solved])
            for k, name in enumerate(("q", "qd", "qdd"))
        }
        codes = np.array([NO_PATH if one is None else 0 for one in solved], dtype=np.uint8)
        placed = np.repeat(codes[:, None], self._path.samples, axis=1)
        return BlockStates(p, parts, group.ravel().astype(np.uintp), placed)

    def _solved(self, p: Array, keys: Sequence[bytes]) -> list[tuple[Array, ...] | None]:
        """q, qd, qdd (n x samples) of machines with these parameters, or None where the path has no solution."""
        with self._lock:
            missing = [k for k, key in enumerate(keys) if key not in self._kept]
            if missing:
                began = time.perf_counter()
                for k, motion in zip(missing, self._family.solved(p[missing]), strict=True):
                    self._kept[keys[k]] = None if motion is None else (motion.q.T, motion.qd.T, motion.qdd.T)
                self.seconds_once += time.perf_counter() - began if self._is_one else 0.0
            for key in keys:
                self._kept.move_to_end(key)
            solved = [self._kept[key] for key in keys]
            while len(self._kept) > self._most_kept:
                self._kept.popitem(last=False)
            return solved


def _of_kind(names: Iterable[VariedName], kind: str) -> list[tuple[int, VariedName]]:
    return [(k, one) for k, one in enumerate(names) if one.kind == kind]
