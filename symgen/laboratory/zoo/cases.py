"""Stored cases: model files that once failed, with what they must end as, so that they are tests from then on."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from symgen.laboratory.zoo.dice import exact
from symgen.laboratory.zoo.draws.describe import Description
from symgen.laboratory.zoo.refusals import UNREPORTED
from symgen.laboratory.zoo.verdict import REFUSED, VERIFIED, DrawVerdict

FAILURE, EXPECTED, START, OPTIONS = "# found by the zoo: ", "# expected: ", "# start: ", "# options: "


@dataclass(frozen=True)
class StoredCase:
    """A model file, options, how it failed once, what it must end as, a configuration on the branch that is meant."""

    failure: str
    expected: str
    start: dict[str, float]
    model: str
    options: tuple[str, ...] = ()

    @property
    def text(self) -> str:
        """The file as it is stored: the model behind lines of comment."""
        start = ", ".join(f"{name} = {exact(value)}" for name, value in self.start.items())
        options = f"{OPTIONS}{' '.join(self.options)}\n" if self.options else ""
        return f"{FAILURE}{self.failure}\n{EXPECTED}{self.expected}\n{START}{start}\n{options}{self.model}"


def case_of(description: Description, verdict: DrawVerdict) -> StoredCase:
    """The case of a failure: a mistake that was not told must be refused, all else verified."""
    expected = REFUSED if verdict.kind == UNREPORTED else VERIFIED
    failure = f"{verdict.kind}: {verdict.signature}"
    return StoredCase(failure, expected, dict(description.start), description.text, description.options)


def read_case(path: Path) -> StoredCase:
    """A stored case."""
    text = path.read_text(encoding="utf-8")
    values = re.findall(r"(\w+) = ([^,\n]+)", _line(text, START))
    start = {name: float(value) for name, value in values}
    model = "\n".join(line for line in text.splitlines() if not line.startswith((FAILURE, EXPECTED, START, OPTIONS)))
    options = tuple(_line(text, OPTIONS).split())
    return StoredCase(_line(text, FAILURE), _line(text, EXPECTED), start, model + "\n", options)


def _line(text: str, begin: str) -> str:
    return next((line[len(begin) :] for line in text.splitlines() if line.startswith(begin)), "")
