"""What the report of an identification says of whole bodies."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from symgen.identification.bodies.entries import body_entry, in_one_line
from symgen.identification.bodies.nearest_bodies import LEAST_EIGENVALUE
from symgen.identification.estimates.whole_bodies import WholeBodies
from symgen.identification.reported.cells import numbers, table
from symgen.model.model import Model
from symgen.report.document import Block, CodeLine, Paragraph

_WHOLE = (
    "All inertial parameters, as of bodies that can be: the pseudo-inertia of each is positive definite (Wensing, Kim "
    "and Slotine, 2018), rotors are positive. What the log determines counts in its standard errors; what it leaves "
    "open stays near the file, with the mass and a length of the body as standard deviation, and its error says so."
)


def whole_blocks(model: Model, whole: WholeBodies) -> Iterator[Block]:
    """How they were found, all parameters, and the entries that a model file would have."""
    edge = f" At the edge of what can be: {', '.join(whole.at_edge)}." if whole.at_edge else ""
    off = f"Base parameters made of them are {whole.misfit:.2g} standard errors from the estimates (rms)."
    yield Paragraph((f"{_WHOLE} Found by: {whole.method}.{edge} {off}",))
    rows = zip(whole.parameters, whole.before, whole.values, whole.errors, whole.count, strict=True)
    shown = ((one.name, *numbers(*given)) for one, *given, counts in rows if counts or given[0])
    yield table(("parameter", "in the file", "now", "standard error"), shown)
    yield Paragraph(("As entries of a model file, inertias about the centre of mass:",))
    for k, body in enumerate(model.mechanism.bodies):
        ten = whole.values[10 * k : 10 * k + 10]
        if np.any(ten):
            yield CodeLine(f"{body.name}: {in_one_line(body_entry(ten))}")
    thin = f"{np.sqrt(LEAST_EIGENVALUE):.2g}"
    yield Paragraph(
        (f"A radius of gyration is at least {thin} of the length of its body, which matters for bodies in the plane.",)
    )
