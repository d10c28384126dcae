"""The request that options of the command line make."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from symgen.model.expressions.names import did_you_mean
from symgen.study.asked.request import GRID, SAMPLES, AskedName, StudyAxis, StudyMistakes, StudyRequest
from symgen.study.sizing.catalogue import read_catalogue


def request_of(
    model: Path,
    over: Sequence[str],
    along: Sequence[str],
    show: Sequence[str],
    sample: str | None,
    count: int | None,
    seed: int | None,
    quantiles: Sequence[str],
    size: Path | None = None,
) -> tuple[StudyRequest, StudyMistakes]:
    """The request, and the mistakes of the options so far; `size` is a catalogue.

    Raises ModelError for mistakes in the catalogue, and OSError where it cannot be read.
    """
    mistakes = StudyMistakes()
    if not over:
        mistakes.wrong("over", "nothing is varied", "write a range, such as --over l_1=0.2:0.5:31")
    if sample is not None and sample not in SAMPLES:
        remedy = did_you_mean(sample, SAMPLES, f"choose from {', '.join(SAMPLES)}")
        mistakes.wrong("sample", f"{sample!r} is no sample", remedy)
        # the rest depends on it
        mistakes.check()
    if count is not None and count < 1:
        mistakes.wrong("count", f"{count} points", "give 1 or more")
    if seed is not None and not 0 <= seed < 2**32:
        mistakes.wrong("seed", f"{seed} is no seed", "give a whole number from 0 to 4294967295")
    paths = [text for text in along if "=" not in text]
    ranges = [text for text in along if "=" in text]
    if len(paths) > 1 or (paths and ranges):
        mistakes.wrong("along", f"{', '.join(along)} are several ways", "give one path, or ranges")
    request = StudyRequest(
        model=model,
        over=axes_of(mistakes, "over", over),
        show=tuple(map(AskedName, show)),
        sample=sample or GRID,
        count=None if count is None else max(1, count),
        seed=seed or 0,
        path=AskedName(paths[0]) if paths else None,
        along=axes_of(mistakes, "along", ranges),
        quantiles=_levels(mistakes, quantiles),
        motors=() if size is None else read_catalogue(size),
    )
    return request, mistakes


def _levels(mistakes: StudyMistakes, texts: Sequence[str]) -> tuple[float, ...]:
    levels = []
    for text in texts:
        try:
            levels.append(float(text))
        except ValueError:
            mistakes.wrong("quantiles", f"{text!r} is no number", "write levels such as 0.05,0.95")
    return tuple(levels)


def axes_of(mistakes: StudyMistakes, key: str, texts: Sequence[str]) -> tuple[StudyAxis, ...]:
    """`l_1=0.2:0.5:31` of the command line."""
    axes = []
    for text in texts:
        name, _, values = text.partition("=")
        parts = values.split(":")
        try:
            ends = [float(part) for part in parts[:2]]
            count = int(parts[2]) if len(parts) == 3 else None
            if len(parts) not in (2, 3) or not all(abs(end) < float("inf") for end in ends):
                raise ValueError
        except ValueError:
            mistakes.wrong(key, f"{text!r} is no range", "write NAME=FIRST:LAST:COUNT, such as l_1=0.2:0.5:31")
            continue
        axes.append(StudyAxis(name.strip(), ends[0], ends[1], count))
    return tuple(axes)
