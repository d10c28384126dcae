"""Kernels are tried before any C is made of them.

Writing and compiling tens of thousands of operations takes as long as deriving them. Interpreted at the states of the
verification, where they have the bits of C and Python, they take a fraction of that: what is rejected takes another
method first, and what is written and compiled is what stays.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from symgen.backends.literals import check_literals
from symgen.generation.acceptance.fallback import Fallback
from symgen.generation.acceptance.rank_thresholds import RankThresholds
from symgen.generation.draft import Draft
from symgen.generation.files import verified
from symgen.generation.results import Options
from symgen.generation.states import expected_of
from symgen.verify.certificate import Certificate
from symgen.verify.run import blank_certificate
from symgen.verify.running.compile import find_compiler


class Trial:
    """The kernels of one draft, and of those that replace it, at the states of its verification.

    Raises ModelError, about the file at `path`, where there are no such states, and LiteralRangeError for a number
    that a scalar type does not hold.
    """

    def __init__(self, path: Path, draft: Draft, options: Options, progress: Callable[[str], None]) -> None:
        run = verified(options)
        compiler = find_compiler() if "c" in run else None
        self._blank = blank_certificate(draft.model, compiler, {}, None)
        chosen = {scalar: None for scalar in options.scalars if compiler is not None}
        self._scalars = tuple(chosen | ({"float64": None} if "python" in run else {}))
        self._progress = progress
        self.fallback = Fallback(options, progress)
        check_literals(draft.programs)
        self.expected = expected_of(path, draft, options.states, progress, self._scalars)
        self.ranks = RankThresholds(self.expected)

    def settled(self, draft: Draft) -> tuple[Draft, Certificate]:
        """The draft that nothing speaks against any more, and what its trial found."""
        while True:
            certificate = self._certificate(draft)
            other = self.fallback.other(draft, certificate, self.expected)
            if other is None:
                self._progress(f"verifying: {self.ranks.WHAT}")
                if faults := self.ranks.faults(draft):
                    other = self.fallback.other(draft, replace(certificate, faults=faults), self.expected)
            if other is None or not other.program.kernels:
                self.fallback.settle()
                return other or draft, certificate
            draft = other

    def _certificate(self, draft: Draft) -> Certificate:
        errors, faults = [], []
        for scalar in self._scalars:
            self._progress(f"verifying: trying kernels in {scalar}")
            program = draft.programs[scalar]
            for kernel in program.kernels:
                record, fault = self.fallback.errors.measurements.of(kernel, program.sincos, scalar, self.expected)
                errors.append(record)
                faults += [] if fault is None else [fault]
        return replace(self._blank, errors=tuple(errors), faults=tuple(faults), left_out=draft.left_out)

