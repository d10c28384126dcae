"""Whether masses, inertias and axes are those of a possible body, at the default values of the parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import acos, cos, pi, sqrt
from types import MappingProxyType

from symgen.diagnostics import Mistake, Notice, Span
from symgen.model.expressions.expression import Expression
from symgen.model.expressions.walk import evaluate, exact_value
from symgen.model.mechanism import Body, Frame, Mechanism, Quaternion, Vector3

# a pair of equal moments comes out with errors of the square root of the rounding unit
EQUAL_MOMENTS = 1e-7
NO_TURNING: Mapping[str, tuple[bool, bool, bool]] = MappingProxyType({})


def check_bodies(
    mechanism: Mechanism, defaults: Mapping[str, float], turning: Mapping[str, tuple[bool, bool, bool]] = NO_TURNING
) -> Iterator[Mistake | Notice]:
    """Masses that are negative, axes without a direction; inertias that no mass distribution has are notices.

    `turning` says about which of its own axes a frame can turn.
    """
    for frame in mechanism.frames:
        yield from _check_axes(frame, defaults)
    for body in mechanism.bodies:
        mass = _value(body.mass, defaults)
        if mass is not None and mass < 0:
            remedy = "a mass is positive, or 0 for a body without mass"
            yield Mistake(f"the mass of `{body.name}` is {mass:.6g}", remedy, _place(body.mass, body.span))
        yield from _check_inertia(body, defaults, turning.get(body.frame, (False, False, False)))
    for rotor in mechanism.rotor_inertias:
        inertia = _value(rotor.inertia, defaults)
        if inertia is not None and inertia < 0:
            message = f"the rotor inertia of `{rotor.coordinate}` is {inertia:.6g}"
            yield Mistake(message, "a moment of inertia is positive", _place(rotor.inertia, rotor.span))


def _check_axes(frame: Frame, defaults: Mapping[str, float]) -> Iterator[Mistake]:
    turns = () if isinstance(frame.rotation, Quaternion) else frame.rotation
    for turn in turns:
        values = [_value(entry, defaults) for entry in turn.axis]
        if all(value == 0 for value in values):
            remedy = "give the direction it turns about, such as z or [0, 0.6, 0.8]; its length does not matter"
            yield Mistake(f"an axis of the frame `{frame.name}` has length zero", remedy, _first(turn.axis, frame.span))


def unsound_bodies(mechanism: Mechanism, defaults: Mapping[str, float]) -> tuple[Body, ...]:
    """The bodies that would have negative energy for some velocities, if they were alone."""
    return tuple(body for body in mechanism.bodies if _negative(body, defaults) is not None)


def inertia_span(body: Body) -> Span | None:
    """Where the inertia of a body stands."""
    return _first(_entries(body), body.span)


def _entries(body: Body) -> tuple[Expression, ...]:
    tensor = body.inertia
    return tensor.xx, tensor.yy, tensor.zz, tensor.xy, tensor.xz, tensor.yz


def _moments(body: Body, defaults: Mapping[str, float]) -> tuple[float, float, float] | None:
    """The principal moments in ascending order."""
    values = [_value(entry, defaults) for entry in _entries(body)]
    if any(value is None for value in values):
        return None
    xx, yy, zz, xy, xz, yz = (value or 0.0 for value in values)
    return principal_moments(xx, yy, zz, xy, xz, yz)


def _negative(body: Body, defaults: Mapping[str, float]) -> float | None:
    """The smallest principal moment where it is negative."""
    low, _, high = _moments(body, defaults) or (0.0, 0.0, 0.0)
    return low if low < -EQUAL_MOMENTS * max(high, -low) else None


def _check_inertia(
    body: Body, defaults: Mapping[str, float], turning: tuple[bool, bool, bool]
) -> Iterator[Notice]:
    """What no mass distribution has; values identified together may have it, and their sum is judged elsewhere."""
    moments = _moments(body, defaults)
    if moments is None:
        return
    low, middle, high = moments
    if _negative(body, defaults) is not None:
        yield Notice(
            f"the inertia of `{body.name}` has a negative principal moment, {low:.6g}: if it was not identified "
            "together with others, check signs: xy, xz, yz are elements of the tensor, the negatives of CAD's "
            "products of inertia",
            inertia_span(body),
        )
        return
    # one or two moments alone are how planar mechanisms are written: nothing turns about the other axes
    missing = [able for entry, able in zip(_entries(body)[:3], turning, strict=True) if exact_value(entry) == 0]
    if (not missing or any(missing)) and low + middle < high * (1 - EQUAL_MOMENTS):
        low, middle = (0.0 if abs(moment) <= EQUAL_MOMENTS * high else moment for moment in (low, middle))
        hint = (
            "if they were not identified together with others, check units, signs of xy, xz, yz, and that the tensor "
            "is the one about the centre of mass"
        )
        if missing:
            hint = "give all of xx, yy, zz: what is missing counts as 0, and the body turns about those axes too"
        yield Notice(
            f"the inertia of `{body.name}` violates the triangle inequality: its principal moments are "
            f"{low:.6g}, {middle:.6g}, {high:.6g}, and no mass distribution has one above the sum of the others; "
            f"{hint}",
            inertia_span(body),
        )


def principal_moments(xx: float, yy: float, zz: float, xy: float, xz: float, yz: float) -> tuple[float, float, float]:
    """Eigenvalues of a symmetric 3 x 3 matrix in ascending order, by the trigonometric solution of the cubic."""
    mean = (xx + yy + zz) / 3
    off = xy * xy + xz * xz + yz * yz
    spread = sqrt(((xx - mean) ** 2 + (yy - mean) ** 2 + (zz - mean) ** 2 + 2 * off) / 6)
    if spread == 0:
        return mean, mean, mean
    a, b, c = ((x - mean) / spread for x in (xx, yy, zz))
    d, e, f = xy / spread, xz / spread, yz / spread
    half = (a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)) / 2
    angle = acos(max(-1.0, min(1.0, half))) / 3
    high = mean + 2 * spread * cos(angle)
    low = mean + 2 * spread * cos(angle + 2 * pi / 3)
    return low, 3 * mean - low - high, high


def _value(expression: Expression, defaults: Mapping[str, float]) -> float | None:
    try:
        return evaluate(expression, defaults)
    except (ArithmeticError, ValueError, KeyError):
        return None


def _place(expression: Expression, otherwise: Span | None) -> Span | None:
    return expression.span or otherwise


def _first(entries: tuple[Expression, ...] | Vector3, otherwise: Span | None) -> Span | None:
    return next((entry.span for entry in entries if entry.span is not None), otherwise)
