"""Labels of axes and values, with their units."""

from __future__ import annotations

from symgen.paths.charts import symbol
from symgen.study.interest import Interest
from symgen.study.plan import StudyPlan


def axis_label(plan: StudyPlan, k: int) -> str:
    """A varied name as a formula of Matplotlib."""
    one = plan.over[k]
    return symbol(one.axis.name) + (f" in {_unit(one.unit)}" if one.unit else "")


def _unit(unit: str) -> str:
    return unit.replace("**2", "²").replace("**3", "³").replace("*", "·")


def value_label(one: Interest, label: str) -> str:
    """A channel of a quantity of interest by its `label`, or the quantity itself where that is empty."""
    named = symbol(label) if label.isidentifier() else label
    return f"{named or one.name}" + (f" in {_unit(one.unit)}" if one.unit not in ("", "1") else "")
