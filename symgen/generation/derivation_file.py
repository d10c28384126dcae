"""derivation.json: structure, choices and operation counts, a function of the model and symgen's version alone.

The counts are the baseline against which a change of symgen is held.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from symgen import __version__
from symgen.backends.operations import count_operations
from symgen.backends.quantities import IN_FORMS
from symgen.generation.draft import Draft
from symgen.ir.bounded import Bound
from symgen.ir.bounded_coordinates import CoordinateBound
from symgen.ir.given_trig import given_trig
from symgen.ir.kernel import Kernel, Program
from symgen.ir.prepare import prepare
from symgen.ir.together import together_of
from symgen.methods.selection import MethodChoice
from symgen.model.model import Model
from symgen.quantities.select import Choice, Rejection

COORDINATE_BOUNDS = "coordinate_bounds"
# The keys of decades by which thresholds of rank are raised, and by `Raised`.
RAISED = {"ranks": "thresholds_raised_by_decades", "masses": "mass_thresholds_raised_by_decades"}
# Of shares of reactions in the file.
SHOWN_DECIMALS = 4


def derivation_json(draft: Draft) -> str:
    """The file's text; keys in a fixed order.  What is counted is that of float64, with the checks of bounds."""
    model, derivations, structure, program = draft.model, draft.derivations, draft.structure, draft.written["float64"]
    generic = derivations.generic
    choices = {choice.quantity: choice for choice in derivations.choices}
    rejected, left_out = derivations.rejected, derivations.left_out
    kernels: dict[str, Any] = {}
    for kernel in program.kernels:
        choice = choices[kernel.name]
        kernels[kernel.name] = {
            "shape": list(kernel.shape),
            **_of_choice(choice),
            **({"twice_the_digits": list(choice.wide)} if choice.wide else {}),
            **_bounds(draft, kernel.name),
            **_coordinate_bounds(draft, kernel.name),
            **_raised(draft, kernel.name),
            "counted_cost": dict(choice.costs),
            "operations": _operations(kernel),
            "statuses": sorted({check.status.name for block in kernel.blocks for check in block.checks}),
        }
    prepared = prepare(program, IN_FORMS)
    for kernel in () if prepared is None else prepared.kernels:
        kernels[kernel.name]["operations_prepared"] = _operations(kernel)
    for kernel in program.kernels:
        if kernel.name in IN_FORMS and (given := given_trig(kernel)) is not None:
            kernels[kernel.name]["operations_sines_given"] = _operations(given.kernel)
    content = {
        "symgen": __version__,
        "model": model.name,
        "model_sha256": model.text_hash,
        "sizes": {
            "n": generic.n,
            "r": generic.r,
            "rank": generic.rank,
            "m": generic.m,
            "delta_loc": generic.delta_loc,
            "delta_diff": generic.delta,
            "alpha": generic.alpha,
        },
        **({"parameters_as_numbers": [name for name, _ in model.taken]} if model.taken else {}),
        "actuation": structure.actuation,
        **_friction(model),
        "blocks": [
            {
                "rows": list(block.rows),
                "coordinates": list(block.coordinates),
                "rank": block.rank,
                "delta": block.delta,
                "null_space": block.null_space,
            }
            for block in structure.blocks
        ],
        "free_coordinates": list(structure.free_coordinates),
        "dependent_rows": list(structure.dependent_rows),
        "skipped": [{"what": d.what, "why": d.why} for d in structure.decisions],
        "absent": [{"quantity": name, "why": why} for name, why in derivations.absent],
        **({"rejected": [_rejection(one) for one in rejected]} if rejected else {}),
        **({"left_out": [{"quantity": name, "scalars": list(types)} for name, types in left_out]} if left_out else {}),
        "sine_and_cosine": "libm" if program.sincos is None else "portable",
        "method_of_inverse_dynamics": _method(derivations.method_of_u),
        **{f"method_of_{quantity}": _method(one) for quantity, one in derivations.named},
        "kernels": kernels,
        **_together(model, program),
    }
    return json.dumps(content, indent=2, ensure_ascii=False) + "\n"


def _together(model: Model, program: Program) -> dict[str, Any]:
    """What is wanted in one call, with the operations of that."""
    made = together_of(model.together, program)
    groups = [
        {"quantities": [part.name for part in one.parts], "operations": _operations(one.kernel)} for one in made
    ]
    return {"together": groups} if groups else {}


def _friction(model: Model) -> dict[str, Any]:
    """How friction of reactions is worked out, for a motion and for inputs, where the model has some."""
    both = {"for_a_motion": model.friction_steps, "for_inputs": model.motion_steps}
    known = {
        name: {
            "steps": one.steps,
            "kappa": round(one.kappa, SHOWN_DECIMALS),
            "configurations": one.points,
            "locking": one.locking,
        }
        for name, one in both.items()
        if one is not None
    }
    return {"friction": {"places": [place.name for place in model.rough], **known}} if model.rough else {}


def _of_choice(choice: Choice) -> dict[str, str]:
    """The method of a quantity, and along which null space it is, where that is not all there is to it."""
    own = choice.method not in ("", choice.title)
    return {"method": choice.method, "along": choice.title} if own else {"method": choice.title}


def title_of(kernel: Mapping[str, Any]) -> str:
    """The title of the candidate that a kernel of the file took."""
    return str(kernel.get("along", kernel["method"]))


def _bounds(draft: Draft, quantity: str) -> dict[str, Any]:
    """The bounds of parameters by type and name, where a kernel of the quantity has any."""
    bounds = {scalar: draft.bounds.get(scalar, {}).get(quantity, ()) for scalar in draft.kernels(quantity)}
    by_scalar = {scalar: {bound.parameter: _ends(bound) for bound in own} for scalar, own in bounds.items()}
    return {"bounds": by_scalar} if any(by_scalar.values()) else {}


def _coordinate_bounds(draft: Draft, quantity: str) -> dict[str, Any]:
    bounds = {scalar: draft.coordinate_bounds.get(scalar, {}).get(quantity, ()) for scalar in draft.kernels(quantity)}
    by_scalar = {scalar: {bound.coordinate: _ends(bound) for bound in own} for scalar, own in bounds.items()}
    return {COORDINATE_BOUNDS: by_scalar} if any(by_scalar.values()) else {}


def _raised(draft: Draft, quantity: str) -> dict[str, Any]:
    """By how many decades thresholds of rank are above what rounding leaves, by type, where any is."""
    raised = {scalar: every[quantity] for scalar, every in draft.raised.items() if quantity in every}
    made: dict[str, Any] = {}
    for field, key in RAISED.items():
        decades = {scalar: by for scalar, one in raised.items() if (by := getattr(one, field)) is not None}
        made |= {key: decades} if decades else {}
    return made


def _ends(bound: Bound | CoordinateBound) -> list[float | None]:
    return [None if end is None else float(end) for end in (bound.low, bound.high)]


def _rejection(one: Rejection) -> dict[str, str]:
    return {"quantity": one.quantity, "method": one.method, "why": one.why}


def _method(one: MethodChoice | None) -> dict[str, Any] | None:
    """A quantity's method: whether it is valid at every regular state, why or where not, and what others are known."""
    if one is None:
        return None
    return {
        "name": one.name,
        "valid_at_every_regular_state": one.validity.admitted,
        "because": one.validity.explanation,
        "singular": [{"where_zero": s.where_zero, "for_example": dict(s.state)} for s in one.validity.singular],
        "methods": [{"name": name, "counted_cost": weight, "remark": remark} for name, weight, remark in one.others],
    }


def _operations(kernel: Kernel) -> dict[str, int]:
    counts = count_operations(kernel.statements)
    return {name: getattr(counts, name) for name in ("add", "mul", "div", "sqrt", "sincos", "other")}
