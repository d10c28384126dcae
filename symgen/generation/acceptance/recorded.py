"""What verification led to, for commands that derive kernels anew: the record of the run that verified them.

`symgen MODEL.yaml` leaves DIR/<model>/derivation.json.  It names the methods that verification rejected, the one that
each quantity takes in their place, the scalar types in which it works with twice the digits, and what is left out.
"""

from __future__ import annotations

import json
from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symgen import __version__
from symgen.generation.derivation_file import COORDINATE_BOUNDS, RAISED, title_of
from symgen.generation.draft import REJECTED, Draft, draft_of
from symgen.ir.bounded import Bound
from symgen.ir.bounded_coordinates import CoordinateBound
from symgen.ir.kernel import UNIT_ROUNDOFF
from symgen.ir.raised import Raised
from symgen.quantities.alternatives import Alternatives
from symgen.quantities.select import Rejection
from symgen.records import dataclass

if TYPE_CHECKING:
    from symgen.generation.results import Options
    from symgen.ir.kernel import Scalar
    from symgen.model.model import Model

RECORD = "derivation.json"


@dataclass(frozen=True, slots=True)
class _Taken:
    """The candidate of a quantity that is made, and the types in which it works with twice the digits."""

    title: str
    wide: tuple[Scalar, ...]


@dataclass(frozen=True, slots=True)
class _VerificationRecord:
    """What a derivation.json tells of a verification."""

    rejected: tuple[Rejection, ...]
    taken: Mapping[str, _Taken]
    left_out: Mapping[str, tuple[Scalar, ...]]
    bounds: Mapping[Scalar, Mapping[str, tuple[Bound, ...]]]
    coordinate_bounds: Mapping[Scalar, Mapping[str, tuple[CoordinateBound, ...]]]
    raised: Mapping[Scalar, Mapping[str, Raised]]


class _UnusableError(Exception):
    """Why there is no record of the model."""


def as_recorded(model: Model, outputs: Sequence[str], options: Options) -> Draft:
    """The kernels of a model with what an earlier verification led to, as `options.measured` holds it.

    Without a record they are what derivation chooses, and the draft's `notice` says so.  Raises WrongUseError for a
    method that the model does not have.
    """
    draft = draft_of(model, outputs, options)
    if options.measured is None:
        return draft
    file = options.measured / model.name / RECORD
    try:
        record = _read(file, model)
    except _UnusableError as why:
        notice = f"{file} {why}: kernels are those that derivation chooses (`symgen` verifies them and writes it)"
        return replace(draft, notice=notice)
    return _with_record(draft, record, options.methods)


def _read(file: Path, model: Model) -> _VerificationRecord:
    try:
        content = json.loads(file.read_bytes())
    except OSError as error:
        raise _UnusableError("is missing") from error
    except ValueError as error:
        raise _UnusableError("is damaged") from error
    try:
        if content["model_sha256"] != model.text_hash:
            raise _UnusableError("is of another text of the model")
        if content["symgen"] != __version__:
            raise _UnusableError(f"is of symgen {content['symgen']}, this is {__version__}")
        return _record(content)
    except (KeyError, TypeError, AttributeError) as error:
        raise _UnusableError("is damaged") from error


def _record(content: Mapping[str, Any]) -> _VerificationRecord:
    kernels = content["kernels"].items()
    return _VerificationRecord(
        tuple(Rejection(str(r["quantity"]), str(r["method"]), str(r["why"])) for r in content.get("rejected", ())),
        {name: _Taken(title_of(one), tuple(one.get("twice_the_digits", ()))) for name, one in kernels},
        {str(one["quantity"]): tuple(one["scalars"]) for one in content.get("left_out", ())},
        {
            scalar: {name: tuple(_bounds(one.get("bounds", {}).get(scalar, {}))) for name, one in kernels}
            for scalar in UNIT_ROUNDOFF
        },
        {
            scalar: {
                name: tuple(_coordinate_bounds(one.get(COORDINATE_BOUNDS, {}).get(scalar, {}))) for name, one in kernels
            }
            for scalar in UNIT_ROUNDOFF
        },
        {
            scalar: {name: raised for name, one in kernels if (raised := _raised(one, scalar)) != Raised()}
            for scalar in UNIT_ROUNDOFF
        },
    )


def _raised(kernel: Mapping[str, Any], scalar: Scalar) -> Raised:
    decades = {field: kernel.get(key, {}).get(scalar) for field, key in RAISED.items()}
    return Raised(**{field: None if by is None else int(by) for field, by in decades.items()})


def _bounds(bounds: Mapping[str, Sequence[float | None]]) -> Iterator[Bound]:
    for parameter, ends in bounds.items():
        low, high = (None if end is None else Fraction(str(end)) for end in ends)
        yield Bound(parameter, low, high)


def _coordinate_bounds(bounds: Mapping[str, Sequence[float | None]]) -> Iterator[CoordinateBound]:
    for coordinate, ends in bounds.items():
        low, high = (None if end is None else Fraction(str(end)) for end in ends)
        yield CoordinateBound(coordinate, low, high)


def _with_record(draft: Draft, record: _VerificationRecord, asked: Container[str]) -> Draft:
    """The draft with the methods of the record in place of rejected ones, but where one was `asked` for."""
    present = {choice.quantity for choice in draft.derivations.choices}
    # a model whose allocation is set aside lacks the parameters of that
    known = {parameter.name for parameter in draft.model.parameters}
    bounds = {
        scalar: {
            name: tuple(one for one in own if one.parameter in known)
            for name, own in every.items()
            if name in present and name not in asked
        }
        for scalar, every in record.bounds.items()
    }
    coordinate_bounds = {
        scalar: {name: own for name, own in every.items() if name in present and name not in asked}
        for scalar, every in record.coordinate_bounds.items()
    }
    raised = {
        scalar: {name: one for name, one in every.items() if name in present and name not in asked}
        for scalar, every in record.raised.items()
    }
    draft = replace(draft, bounds=bounds, coordinate_bounds=coordinate_bounds, raised=raised)
    replaced = [name for name in dict.fromkeys(one.quantity for one in record.rejected) if name in present]
    if not replaced:
        return draft
    others = Alternatives(draft.model, draft.derivations.generic, draft.derivations.methods)
    for quantity in replaced:
        taken = record.taken.get(quantity)
        if taken is not None and quantity not in asked:
            one = others.named(quantity, taken.title)
            if one is None or draft.choice(quantity).title == taken.title:
                one = draft.taken(quantity)
            one = replace(one, choice=replace(one.choice, wide=taken.wide))
            draft = draft.along(one, draft.kernels_along(one, tuple(draft.programs)))
        if quantity in record.left_out:
            draft = draft.without(quantity, record.left_out[quantity], REJECTED)
    return draft.rejecting(record.rejected)
