"""The states of a verification, or that there are none, as a mistake in the file."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from symgen.diagnostics import ModelError
from symgen.generation.draft import Draft
from symgen.generation.refusals import no_states
from symgen.ir.kernel import Scalar
from symgen.model.model import Model
from symgen.verify.expected import Expected
from symgen.verify.reference.reference import ReferenceValueError
from symgen.verify.sampling.states import VerificationError


def expected_of(
    path: Path, draft: Draft, states: int, progress: Callable[[str], None], scalars: Sequence[Scalar] = ()
) -> Expected:
    """The states at which a draft is verified, with what is expected there in these types.

    Raises ModelError, about the file at `path`, where there are no such states.
    """
    progress("verifying: looking for states")
    names = dict.fromkeys(kernel.name for program in draft.programs.values() for kernel in program.kernels)
    try:
        expected = Expected(draft.model, tuple(names), states, progress)
        for scalar in scalars:
            expected.values(scalar)
    except (VerificationError, ReferenceValueError) as fault:
        raise without_states(path, draft.model, str(fault)) from fault
    return expected


def without_states(path: Path, model: Model, why: str) -> ModelError:
    """That nothing can be verified, about the file at `path`."""
    return ModelError(str(path), path.read_text(encoding="utf-8"), (no_states(model, why),))
