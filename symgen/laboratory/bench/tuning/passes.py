"""What each rewriting pass is worth: operations of quantities with one of them left out at a time."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from statistics import fmean
from unittest.mock import patch

from symgen.laboratory.bench.tuning.skipping import counted_cost, table_line
from symgen.methods.quantity import Quantity, scalars
from symgen.model.model import Model
from symgen.quantities.select import derive_quantities
from symgen.symbolic.passes import grouping

INVERSE = "inverse_dynamics"
# In place of beginnings that are left out.
_AS_IT_IS = grouping.Step("", "as it is", lambda _, __, outputs: list(outputs))
# Of fewer operations one more is a large part.
SHORT = 20


@dataclass(frozen=True, slots=True)
class Counted:
    """Counted cost by quantity of one model: with all passes, and by name of the pass that is left out."""

    model: Model
    whole: Mapping[str, int]
    without: Mapping[str, Mapping[str, int]]


def counted(model: Model, outputs: Sequence[str]) -> Counted:
    """The quantities of a model derived with all passes, and again without each."""
    without = {}
    for name in grouping.PASSES:
        with _left_out(name):
            without[name] = _costs(model, outputs)
    return Counted(model, _costs(model, outputs), without)


@contextmanager
def _left_out(gone: str) -> Iterator[None]:
    kept, begun = (tuple(one for one in group if one.of != gone) for group in (grouping.STEPS, grouping.BEGINNINGS))
    with patch.object(grouping, "STEPS", kept), patch.object(grouping, "BEGINNINGS", begun or (_AS_IT_IS,)):
        yield


def _costs(model: Model, outputs: Sequence[str]) -> dict[str, int]:
    return costs(derive_quantities(model, outputs).quantities)


def costs(quantities: Iterable[Quantity]) -> dict[str, int]:
    """Counted cost by quantity."""
    return {one.name: counted_cost(scalars(one)) for one in quantities if one.outputs}


def page(shipped: Sequence[Counted], drawn: Sequence[Counted]) -> str:
    """The page docs/passes.md."""
    classes = {
        "u": [(one, INVERSE) for one in shipped],
        "all quantities": _quantities(shipped),
        "of trees": _quantities([one for one in shipped if not one.model.constraints]),
        "of closed chains": _quantities([one for one in shipped if one.model.constraints and not _rolls(one.model)]),
        "of what rolls": _quantities([one for one in shipped if _rolls(one.model)]),
        "of drawn systems": _quantities(drawn),
    }
    head = ["pass", *classes, "most for one quantity"]
    lines = [table_line(head), table_line(["---"] * len(head))]
    for one in grouping.PASSES:
        worth = {name: _ratios(members, one) for name, members in classes.items()}
        most = max(_quantities(shipped), key=lambda member: _ratio(member[0], member[1], one))
        where = f"{_percent(_ratio(most[0], most[1], one))} ({most[1].replace('_', ' ')} of {most[0].model.name})"
        lines.append(table_line([one, *(_percent(fmean(ratios)) for ratios in worth.values()), where]))
    sentences = "\n".join(f"- **{name}**: {does}." for name, does in grouping.PASSES.items())
    counts = f"{len(shipped)} shipped models, {len(drawn)} drawn ones"
    return _PAGE.replace("SENTENCES", sentences).replace("TABLE", "\n".join(lines)).replace("COUNTS", counts)


def _rolls(model: Model) -> bool:
    return any(row.kind == "nonholonomic" for row in model.constraints)


def _quantities(members: Sequence[Counted]) -> list[tuple[Counted, str]]:
    return [(one, name) for one in members for name, count in one.whole.items() if count > SHORT]


def _ratios(members: Sequence[tuple[Counted, str]], gone: str) -> list[float]:
    return [_ratio(one, name, gone) for one, name in members if one.whole.get(name)]


def _ratio(one: Counted, name: str, gone: str) -> float:
    return one.without[gone].get(name, one.whole[name]) / one.whole[name]


def _percent(ratio: float) -> str:
    return f"{100 * (ratio - 1):+.1f} %"


_PAGE = """\
# What the rewriting passes are worth

After a quantity is derived, its products and sums are regrouped by these passes, each taken where it saves operations:

SENTENCES

Counted cost without one of them against that with all (COUNTS; a sum or product weighs 1, a quotient or root 6, a
sine and cosine 30). They overlap: what one leaves the next may find. Made by `make passes`.

TABLE
"""
