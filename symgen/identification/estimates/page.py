"""An identification as one self-contained page of HTML with its charts."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape

from symgen.backends.render import render
from symgen.identification.estimates.charts import drive_chart
from symgen.identification.estimates.identification import Identification
from symgen.identification.estimates.notes import notes
from symgen.identification.estimates.parameter_file import WrittenFile, numbers_in_bodies
from symgen.identification.estimates.summary import settings_words
from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class IdentificationView:
    """What the template prints, escaped; cells of tables as text."""

    title: str
    settings: str
    notes: tuple[str, ...]
    parameters: tuple[tuple[str, ...], ...]
    drives: tuple[tuple[str, ...], ...]
    charts: tuple[tuple[str, str], ...]
    file: tuple[tuple[str, ...], ...]
    written: tuple[str, ...]
    shared: str


def identification_page(made: Identification, written: WrittenFile) -> str:
    """The page."""
    model, values = made.model, made.values
    rows = zip(values.names, values.before, values.values, values.errors, strict=True)
    units = {p.name: p.unit or "" for p in model.parameters}
    return render(
        "identification/report.html.jinja",
        IdentificationView(
            title=escape(f"{model.name}, identified"),
            settings=escape(settings_words(made)),
            notes=tuple(map(escape, notes(made))),
            parameters=tuple(
                (escape(one.name), *_numbers(one.value, one.error, one.ratio, one.before), escape(one.verdict))
                for one in made.parameters
            ),
            drives=tuple(
                (
                    escape(one.name),
                    *_numbers(one.inputs, one.fitted, one.predicted, one.noise, one.inner),
                    escape(_unit(one.unit)),
                )
                for one in made.drives
            ),
            charts=tuple((escape(one.name), _inline(drive_chart(made, k))) for k, one in enumerate(model.inputs)),
            file=tuple(
                (escape(name), *_numbers(before, value, error), escape(_unit(units[name])))
                for name, before, value, error in rows
            ),
            written=tuple(map(escape, _written_words(made, written))),
            shared=escape(_misfit_words(made)),
        ),
    )


def _written_words(made: Identification, written: WrittenFile) -> Sequence[str]:
    words = []
    if written.text is None:
        words.append(f"No model file is written: {written.why}.")
    if written.widened:
        words.append(f"Ranges that the estimates are beyond were widened: {', '.join(written.widened)}.")
    if numbers := numbers_in_bodies(made.model):
        words.append(f"Numbers in the file, which stay as they are: {', '.join(numbers)}.")
    words += [f"{name} stays as it is: {why}." for name, why in made.names.kept]
    return words


def _misfit_words(made: Identification) -> str:
    off = f"{made.values.misfit:.2g} standard errors"
    return f"Base parameters made of these values are {off} from the estimates (rms)."


def _numbers(*given: float) -> tuple[str, ...]:
    return tuple("–" if x != x else f"{x:.4g}" for x in given)


def _unit(unit: str) -> str:
    return unit.replace("**2", "²").replace("**3", "³").replace("*", " ")


def _inline(picture: str) -> str:
    """The SVG element alone."""
    return picture[picture.index("<svg") :]
