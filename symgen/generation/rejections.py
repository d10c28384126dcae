"""What verification rejects of a result, as text for whoever cannot do without it."""

from __future__ import annotations

from symgen.generation.results import Result


def rejected_lines(result: Result) -> tuple[str, ...]:
    """A line each: failures, then what was tried of each quantity that is left out, and the remedy; none if none is."""
    lines = [f"  {failure}" for failure in result.failures]
    for one in result.left_out:
        lines += [f"  {one.quantity}, {method}: {why}" for method, why in one.tried]
        lines.append(f"  {one.quantity}: remedy: {one.remedy}")
    return tuple(lines)
