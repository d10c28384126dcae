"""JAX as its user writes it: the energies by `grad`, projection by a Cholesky factor, `jit` of `vmap`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax.scipy.linalg import cho_factor, cho_solve

from symgen.laboratory.bench.candidate import PythonCandidate
from symgen.model.expressions.expression import Binary, Call, Expression, Name, Negation, Number, Pi, Power
from symgen.model.model import Model

NAMES = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "atan2": "arctan2"}


def jax_batch(model: Model) -> PythonCandidate:
    """The method `lean`: (28) with its fixed first inputs, M~ from B B^T, derivatives by JAX."""
    jax.config.update("jax_enable_x64", True)
    one = _inverse_dynamics(model)
    together = jax.jit(jax.vmap(one))
    alone = jax.jit(one)

    def batch(q: Any, qd: Any, qdd: Any, p: Any) -> Any:
        return np.asarray(together(q, qd, qdd, p))

    def single(q: Sequence[float], qd: Sequence[float], qdd: Sequence[float], p: Sequence[float]) -> Any:
        return np.asarray(alone(jnp.array(q), jnp.array(qd), jnp.array(qdd), jnp.array(p)))

    return PythonCandidate("JAX", "grad + lean", batch, single)


def _inverse_dynamics(model: Model) -> Callable[[Any, Any, Any, Any], Any]:
    n, m = model.n, model.m
    places = {coordinate.name: i for i, coordinate in enumerate(model.coordinates)}

    def scope(q: Any, qd: Any, p: Any) -> dict[str, Any]:
        names = {coordinate.name: q[i] for i, coordinate in enumerate(model.coordinates)}
        names |= {coordinate.rate: qd[i] for i, coordinate in enumerate(model.coordinates)}
        names |= {parameter.name: p[i] for i, parameter in enumerate(model.parameters)}
        for definition in model.definitions:
            names[definition.name] = _value(definition.value, names)
        return names

    def lagrangian(q: Any, qd: Any, p: Any) -> Any:
        names = scope(q, qd, p)
        return _value(model.kinetic_energy, names) - _value(model.potential_energy, names)

    def balance(q: Any, qd: Any, qdd: Any, p: Any) -> Any:
        momentum = jax.grad(lagrangian, 1)
        _, rate = jax.jvp(lambda a, b: momentum(a, b, p), (q, qd), (qd, qdd))
        names = scope(q, qd, p)
        applied = jnp.zeros(n)
        for force in model.applied_forces:
            applied = applied.at[places[force.coordinate]].add(_value(force.expression, names))
        return rate - jax.grad(lagrangian)(q, qd, p) - applied

    def residuals(q: Any, p: Any) -> Any:
        names = scope(q, jnp.zeros(n), p)
        rows = [_value(c.expression, names) for c in model.constraints if c.kind == "geometric"]
        return jnp.array(rows)

    def kinematic(q: Any, qd: Any, p: Any) -> Any:
        names = scope(q, qd, p)
        rows = [_value(c.expression, names) for c in model.constraints if c.kind == "nonholonomic"]
        return jnp.array(rows)

    def jacobian(q: Any, p: Any) -> Any:
        parts = []
        if any(c.kind == "geometric" for c in model.constraints):
            parts.append(jax.jacfwd(residuals)(q, p))
        if any(c.kind == "nonholonomic" for c in model.constraints):
            parts.append(jax.jacfwd(kinematic, 1)(q, jnp.zeros(n), p))
        return jnp.concatenate(parts) if parts else jnp.zeros((0, n))

    def control(q: Any, p: Any) -> Any:
        names = scope(q, jnp.zeros(n), p)
        matrix = jnp.zeros((n, m))
        for j, given in enumerate(model.inputs):
            for coordinate, coefficient in given.acts_on:
                matrix = matrix.at[places[coordinate], j].add(_value(coefficient, names))
        return matrix

    delta = n - model.r

    def inverse_dynamics(q: Any, qd: Any, qdd: Any, p: Any) -> Any:
        B, M, tau = jacobian(q, p), control(q, p), balance(q, qd, qdd, p)
        projected = M - B.T @ cho_solve(cho_factor(B @ B.T), B @ M) if model.r else M
        # (28) with its fixed choice of the first delta inputs
        first, rest = projected[:, :delta], projected[:, delta:]
        normal = cho_factor(first.T @ first)
        v = cho_solve(normal, first.T @ tau)
        if m == delta:
            return v
        R = cho_solve(normal, first.T @ rest)
        w = jnp.linalg.solve(jnp.eye(m - delta) + R.T @ R, R.T @ v)
        return jnp.concatenate([v - R @ w, w])

    return inverse_dynamics


def _value(expression: Expression, names: dict[str, Any]) -> Any:
    match expression:
        case Number(value=value):
            return float(value)
        case Pi():
            return jnp.pi
        case Name(name=name):
            return names[name]
        case Negation(operand=operand):
            return -_value(operand, names)
        case Power(base=base, exponent=exponent):
            whole = exponent.denominator == 1
            return _value(base, names) ** (exponent.numerator if whole else float(exponent))
        case Call(function=function, arguments=arguments):
            return getattr(jnp, NAMES.get(function, function))(*(_value(a, names) for a in arguments))
        case Binary(operator="+", left=left, right=right):
            return _value(left, names) + _value(right, names)
        case Binary(operator="-", left=left, right=right):
            return _value(left, names) - _value(right, names)
        case Binary(operator="*", left=left, right=right):
            return _value(left, names) * _value(right, names)
        case Binary(left=left, right=right):
            return _value(left, names) / _value(right, names)
