"""Pinocchio, the library for articulated bodies: RNEA, with loops Jacobians and reflections, timed in its own program.

Its model is built once from the parameters' default values, which the kernels take at each call.  Needs a C++ compiler
and the headers of Pinocchio and Eigen; mechanisms whose frames are no tree of simple joints are left out by name.
"""

from __future__ import annotations

import atexit
import subprocess
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from typing import Any

from symgen.backends.render import render
from symgen.model.configurations.mechanics import default_values
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import evaluate, names_in
from symgen.model.mechanism import WORLD, Frame, Quaternion, Vector3, component, is_component
from symgen.model.model import Model

# What Pinocchio's own build tells its users to define.
DEFINITIONS = ("BOOST_MPL_LIMIT_LIST_SIZE=30", "BOOST_MPL_CFG_NO_PREPROCESSED_HEADERS", "NDEBUG",
               "PINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION", "BOOST_FUSION_INVOKE_MAX_ARITY=10")  # fmt: skip
PROGRAM = "bench/pinocchio.cpp.jinja"
DERIVATIVES_PROGRAM = "bench/pinocchio_derivatives.cpp.jinja"
SLOWEST_COMPILER = 600.0


class NoTreeError(Exception):
    """The mechanism is none that the program knows; the text says why."""


@dataclass(frozen=True, slots=True)
class Timed:
    """Nanoseconds of one state, and u of every state, row by row."""

    nanoseconds: float
    u: tuple[tuple[float, ...], ...]


def pinocchio_time(model: Model, states: Sequence[Sequence[float]]) -> Timed | str:
    """u at states whose rows start with q, qd, qdd; or why it is not measured."""
    try:
        text = tree_text(model, states)
    except NoTreeError as reason:
        return str(reason)
    program = _program(PROGRAM)
    if isinstance(program, str):
        return program
    with tempfile.TemporaryDirectory(prefix="symgen-bench-") as folder:
        given = Path(folder) / "mechanism.txt"
        given.write_text(text, encoding="utf-8")
        completed = subprocess.run([str(program), str(given)], capture_output=True, text=True, check=True)
    first, *rows = completed.stdout.splitlines()
    return Timed(float(first), tuple(tuple(map(float, row.split())) for row in rows))


def tree_text(model: Model, states: Sequence[Sequence[float]]) -> str:
    """What the program reads: sizes, gravity, joints, bodies, rows, driven joints, states.

    Raises NoTreeError for a mechanism that it does not know.
    """
    return _NumberedTree(model).text(states)


def pinocchio_jacobian(model: Model) -> Any:
    """A CasADi function of (q, qd, qdd) whose value (m x 3 n) are the derivatives of RNEA; or why there is none.

    It is what Pinocchio's `computeRNEADerivatives` does in CasADi's scalars, the parameters being numbers in it.
    """
    import casadi

    if model.r:
        return "it has derivatives of trees alone"
    try:
        tree = _NumberedTree(model)
        text = tree.text(())
    except NoTreeError as reason:
        return str(reason)
    program = _program(DERIVATIVES_PROGRAM)
    if isinstance(program, str):
        return program
    with tempfile.TemporaryDirectory(prefix="symgen-bench-") as folder:
        given, left = Path(folder) / "mechanism.txt", Path(folder) / "derivatives.casadi"
        given.write_text(text, encoding="utf-8")
        subprocess.run([str(program), str(given), str(left)], capture_output=True, text=True, check=True)
        numbered = casadi.Function.load(str(left))
    # joints are numbered in an order of their own
    arrays = [casadi.SX.sym(name, model.n) for name in ("q", "qd", "qdd")]
    slopes = numbered(*(array[tree.moved] for array in arrays))
    columns = [k * model.n + tree.moved.index(i) for k in range(3) for i in range(model.n)]
    return casadi.Function("derivatives", arrays, [slopes[:, columns]])


@lru_cache(maxsize=2)
def _program(template: str) -> Path | str:
    """The compiled program, once a run; or what it lacks."""
    module = find_spec("pinocchio")
    if module is None or module.origin is None:
        return "not installed"
    if which("g++") is None:
        return "there is no C++ compiler"
    prefix = next((path for path in Path(module.origin).parents if (path / "include" / "pinocchio").is_dir()), None)
    if prefix is None:
        return "its headers are not installed"
    folder = Path(_folder().name)
    program = folder / Path(template).name.split(".")[0]
    source = program.with_suffix(".cpp")
    source.write_text(render(template, None), encoding="utf-8")
    command = ["g++", "-O2", "-std=c++17", *(f"-D{name}" for name in DEFINITIONS), f"-I{prefix / 'include'}"]
    command += [f"-I{prefix / 'include' / 'eigen3'}", "-I/usr/include/eigen3", "-o", str(program), str(source)]
    command += [f"-L{prefix / 'lib'}", "-lpinocchio_default", f"-Wl,-rpath,{prefix / 'lib'}"]
    if template == DERIVATIVES_PROGRAM:
        # it runs once for a function: what a compiler makes faster there takes it minutes
        command += ["-O0", *_of_casadi()]
    completed = subprocess.run(command, capture_output=True, text=True, check=False, timeout=SLOWEST_COMPILER)
    if completed.returncode:
        line = next((line for line in completed.stderr.splitlines() if "error" in line), "unknown")
        return f"its program does not compile: {line.rsplit('error: ', 1)[-1]}"
    return program


def _of_casadi() -> list[str]:
    """Its headers, those of Eigen that it brings, and its library."""
    import casadi

    place = Path(casadi.__file__).parent
    include = place / "include"
    return [f"-I{include}", f"-I{include / 'eigen3'}", f"-L{place}", "-lcasadi", f"-Wl,-rpath,{place}"]


@lru_cache(maxsize=1)
def _folder() -> tempfile.TemporaryDirectory[str]:
    """The program is built once and goes with this process."""
    folder = tempfile.TemporaryDirectory(prefix="symgen-bench-")
    atexit.register(folder.cleanup)
    return folder


class _NumberedTree:
    """Joints in the order in which Pinocchio numbers them, and where every frame is against its joint."""

    def __init__(self, model: Model) -> None:
        import numpy as np

        self.model = model
        self.names = [c.name for c in model.coordinates]
        self.usual = {**default_values(model.parameters), **dict.fromkeys(self.names, 0.0)}
        self.rotors = {r.coordinate: self._number(r.inertia) for r in model.mechanism.rotor_inertias}
        self.moved: list[int] = []
        self.lines: list[str] = []
        self.places: dict[str, tuple[int, Any, Any]] = {WORLD: (0, np.eye(3), np.zeros(3))}

    def text(self, states: Sequence[Sequence[float]]) -> str:
        """What the program reads."""
        model = self.model
        for frame in model.mechanism.frames:
            self._frame(frame)
        if sorted(self.moved) != list(range(model.n)):
            raise NoTreeError("not every coordinate moves one joint")
        if model.definitions or model.forces or model.applied_forces:
            raise NoTreeError("it has forces or definitions of its own")
        bodies = [self._body(body) for body in model.mechanism.bodies if body.frame != WORLD]
        rows = [self._row(row.expression, row.kind) for row in model.constraints]
        driven = " ".join(str(self.moved.index(self._driven(one))) for one in model.inputs)
        n = model.n
        arrays = [" ".join(repr(row[k * n + i]) for k in range(3) for i in self.moved) for row in states]
        head = f"{n} {model.r} {model.m} {len(bodies)} {len(states)}"
        gravity = _numbers(self._vector(model.mechanism.gravity))
        return "\n".join([head, gravity, *self.lines, *bodies, *rows, driven, *arrays, ""])

    def _number(self, expression: Expression, **coordinates: float) -> float:
        return float(evaluate(expression, {**self.usual, **coordinates}))

    def _vector(self, triple: Vector3, **coordinates: float) -> Any:
        import numpy as np

        return np.array([self._number(x, **coordinates) for x in triple])

    def _frame(self, frame: Frame) -> None:
        import numpy as np

        joint, turn, at = self.places[frame.parent]
        start = self._vector(frame.translation)
        at = at + turn @ start
        for name in self._in(frame.translation):
            way = self._vector(frame.translation, **{name: 1.0}) - start
            joint = self._joint(joint, "p", way, turn, at, name)
            turn, at = np.eye(3), np.zeros(3)
        if isinstance(frame.rotation, Quaternion):
            raise NoTreeError("it has a quaternion")
        for one in frame.rotation:
            axis = self._vector(one.axis)
            axis = axis / np.linalg.norm(axis)
            fixed = self._number(one.angle)
            turn = turn @ _turned(axis, fixed)
            for name in self._in((one.angle,)):
                rate = self._number(one.angle, **{name: 1.0}) - fixed
                along = rate * axis
                main = [letter for letter, unit in zip("xyz", np.eye(3), strict=True) if (along == unit).all()]
                kind = main[0] if main else "r"
                joint = self._joint(joint, kind, along, turn, at, name)
                turn, at = np.eye(3), np.zeros(3)
        self.places[frame.name] = joint, turn, at

    def _in(self, expressions: Sequence[Expression]) -> list[str]:
        used = dict.fromkeys(name.name for expression in expressions for name in names_in(expression))
        return [name for name in used if name in self.names]

    def _joint(self, parent: int, kind: str, axis: Any, turn: Any, at: Any, name: str) -> int:
        if self.names.index(name) in self.moved:
            raise NoTreeError(f"{name} moves several joints")
        self.moved.append(self.names.index(name))
        rotor = self.rotors.get(name, 0.0)
        self.lines.append(f"{parent} {kind} {_numbers(axis)} {_numbers(turn.ravel())} {_numbers(at)} {rotor!r}")
        return len(self.moved)

    def _body(self, body: Any) -> str:
        import numpy as np

        joint, turn, at = self.places[body.frame]
        com = at + turn @ self._vector(body.com)
        tensor = turn @ np.array([self._vector(row) for row in body.inertia.rows]) @ turn.T
        return f"{joint} {self._number(body.mass)!r} {_numbers(com)} {_numbers(tensor.ravel())}"

    def _row(self, expression: Expression, kind: str) -> str:
        """Joint, place, axis and factor of every component of a point that the row is a sum of."""
        names = dict.fromkeys(name.name for name in names_in(expression))
        parts = [name for name in names if is_component(name)]
        if kind != "geometric" or any(name in self.names for name in names):
            raise NoTreeError("its rows are not sums of places of points")
        zero = dict.fromkeys(parts, 0.0)
        level = evaluate(expression, {**self.usual, **zero})
        points = {point.name: point for point in self.model.mechanism.points}
        terms = []
        for name in parts:
            one = component(name)
            elsewhere = {**self.usual, **dict.fromkeys(parts, 3.0)}
            values = [evaluate(expression, {**elsewhere, name: x}) for x in (1.0, 2.0, 4.0)]
            factor = evaluate(expression, {**self.usual, **zero, name: 1.0}) - level
            straight = abs(values[2] - 3 * values[1] + 2 * values[0]) + abs(values[1] - values[0] - factor) < 1e-9
            if one.what not in ("x", "y", "z") or one.axes != WORLD or not straight:
                raise NoTreeError("its rows are not sums of places of points")
            frame, at = (points[one.owner].frame, points[one.owner].at) if one.owner in points else (one.owner, None)
            joint, turn, origin = self.places[frame]
            place = origin if at is None else origin + turn @ self._vector(at)
            if joint:
                terms.append(f"{joint} {_numbers(place)} {'xyz'.index(one.what)} {factor!r}")
        return f"{len(terms)} " + " ".join(terms)

    def _driven(self, one: Any) -> int:
        if one.velocity is not None or len(one.acts_on) != 1 or self._number(one.acts_on[0][1]) != 1:
            raise NoTreeError("its inputs do more than drive joints")
        return self.names.index(one.acts_on[0][0])


def _turned(axis: Any, angle: float) -> Any:
    """Rodrigues' formula."""
    import numpy as np

    x, y, z = axis
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def _numbers(values: Any) -> str:
    return " ".join(repr(float(x)) for x in values)
