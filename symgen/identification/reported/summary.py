"""What `symgen identify` prints."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator

from symgen.identification.estimates.identification import EstimatedParameter, Identification
from symgen.identification.estimates.parameter_file import numbers_in_bodies
from symgen.identification.estimates.whole_bodies import WholeBodies
from symgen.identification.reported.notes import notes
from symgen.identification.text import LINE_WIDTH

# Characters of a sum of parameters that are printed; the page has all of it.
MOST_OF_A_SUM = 40


def summary(made: Identification) -> str:
    """Settings, estimates, how inputs are predicted, and parameters of the file, in lines that fit a terminal."""
    lines = [*wrapped(f"{made.model.name}: {settings_words(made)}", ""), ""]
    lines += ["  estimated                                     value    error   t-ratio"]
    for one in made.parameters:
        lines += _parameter(one)
    lines += ["", "  input              rms    fitted   predicted     noise     inner"]
    for drive in made.drives:
        rest = (drive.inputs, drive.fitted, drive.predicted, drive.noise, drive.inner)
        lines.append(f"  {drive.name[:14]:<14}" + "".join(f"{x:>10.3g}" for x in rest) + f"  {drive.unit}")
    lines += ["", *_file_lines(made)]
    lines += [*_whole_lines(made.whole), ""] if made.whole is not None else []
    for note in notes(made):
        lines += wrapped(note, "  ")
    return "\n".join(lines)


def settings_words(made: Identification) -> str:
    """How the log was filtered."""
    settings, count = made.settings, len(made.log.t)
    closed = f"; measured coordinates are off closed loops by {made.open_by:.2g} (rms)" if made.open_by else ""
    return (
        f"{count} samples at {settings.rate:.4g} Hz, motion up to {settings.motion:.3g} Hz, low-pass at "
        f"{settings.cutoff:.3g} Hz, one of {settings.decimation} samples kept, "
        f"{len(made.fitted_to.t)} fitted, {len(made.aside.t)} set aside; "
        f"{100 * made.estimate.outliers:.2g} % of them count less than half; "
        f"condition number {made.estimate.condition:.3g}{closed}"
    )


def wrapped(text: str, margin: str) -> list[str]:
    """Lines that fit, the further ones set in."""
    return textwrap.wrap(
        text, LINE_WIDTH - 1, initial_indent=margin, subsequent_indent=margin + "  ", break_long_words=False
    )


def reason_lines(text: str) -> list[str]:
    """Why a command ended, line by line, each in lines that fit."""
    return [part for line in text.splitlines() for part in wrapped(line, "")]


def _parameter(one: EstimatedParameter) -> Iterator[str]:
    name = one.name.replace("\u00a0", " ")
    name = name if len(name) <= MOST_OF_A_SUM else name[: MOST_OF_A_SUM - 3].rstrip(" +-([") + " ..."
    if one.value != one.value:
        yield f"  {name:<{MOST_OF_A_SUM}}  {one.verdict}"
    else:
        numbers = f"{one.value:>10.4g} {one.error:>8.2g} {one.ratio:>7.3g}"
        yield f"  {name:<{MOST_OF_A_SUM}} {numbers}  {one.verdict}".rstrip()


def _file_lines(made: Identification) -> list[str]:
    values = made.values
    lines = []
    if values.names:
        width = max(map(len, values.names))
        lines.append(f"  {'in the file':<{max(width, 11)}}      before         now    error")
        for name, before, value, error in zip(values.names, values.before, values.values, values.errors, strict=True):
            lines.append(f"  {name:<{max(width, 11)}} {before:>11.4g} {value:>11.4g} {error:>8.2g}")
    lines += _left(made)
    return [*lines, ""] if lines else []


def _whole_lines(whole: WholeBodies) -> list[str]:
    words = f"bodies that can be are {whole.misfit:.2g} standard errors from the estimates (rms)"
    return wrapped(words + (f"; at the edge of what can be: {', '.join(whole.at_edge)}" if whole.at_edge else ""), "  ")


def _left(made: Identification) -> list[str]:
    lines = []
    if not made.has_whole_bodies and (numbers := numbers_in_bodies(made.model)):
        lines += wrapped(f"numbers, which stay as they are: {', '.join(numbers)}", "  ")
    for name, why in made.names.kept:
        lines += wrapped(f"{name} stays as it is: {why}", "  ")
    return lines


