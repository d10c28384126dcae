"""Gains of drives, estimated with all else by instrumental variables.

Their columns are made of the log, and least squares would make them small: noise in a column is best avoided by none of
it.  So what is left is made orthogonal to what the model predicts in their place (Theil, Economic Forecasts and
Policy, 1958; for robots Janot, Vandanjon and Gautier, A generic instrumental variable approach for industrial robot
identification, 2014), again with each new estimate until it settles.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import linalg

from symgen.identification.arrays import Array
from symgen.identification.estimates.least_squares import MOST_ROUNDS, SETTLED_FIT, LinearEstimate, estimated
from symgen.identification.estimates.observations import Observations
from symgen.identification.not_identified import NotIdentifiedError

# Of a gain, or of that of the file where this is larger, the standard error up to which a log determines it.
LEAST_KNOWN = 0.3
# Of the change of a gain, what another one changes by where the log says only how both stand to each other.
TIED_SHARE = 0.01


def gains_left_open(seen: Observations) -> tuple[str, ...]:
    """Gains that a log does not determine, so that they stay as in the file.

    Raises NotIdentifiedError where others could not be told then.
    """
    left: tuple[str, ...] = ()
    while seen.drives is not None and seen.drives.names:
        made, instruments = _settled(seen)
        count = len(seen.drives.names)
        sizes = np.fmax(np.abs(made.values[-count:]), np.abs(seen.drives.before))
        errors = made.errors[-count:] / sizes
        errors = np.where(np.isfinite(errors), errors, np.inf)
        worst = int(np.argmax(errors))
        if errors[worst] <= LEAST_KNOWN:
            break
        _check_alone(seen, instruments, worst)
        left = (*left, seen.drives.names[worst])
        seen = seen.with_gain_known(left[-1])
    return left


def estimated_with_gains(seen: Observations) -> LinearEstimate:
    """The estimate of all columns of a log, gains among them."""
    return _settled(seen)[0]


def _settled(seen: Observations) -> tuple[LinearEstimate, Array]:
    """The estimate, and the instruments that it was made with."""
    assert seen.drives is not None
    first = seen.columns.shape[2] - len(seen.drives.names)
    others = seen.columns[..., :first]
    # gains are told as differences from those of the file: what is left open stays
    off = replace(seen, inputs=seen.inputs - seen.columns[..., first:] @ seen.drives.before)
    values = estimated(replace(off, columns=others)).values if first else np.empty(0)
    fit = others @ np.nan_to_num(values)
    size = max(float(np.sum(off.inputs**2)), 1e-300)
    for _ in range(MOST_ROUNDS):
        instruments = np.concatenate([others, seen.drives.predicted(values[:first])], axis=-1)
        made = estimated(off, instruments)
        values, before = made.values, fit
        fit = made.predicted(seen)
        if np.sum((fit - before) ** 2) < SETTLED_FIT**2 * size:
            break
    return replace(made, values=values + np.concatenate([np.zeros(first), seen.drives.before])), instruments


def _check_alone(seen: Observations, instruments: Array, place: int) -> None:
    """Raises NotIdentifiedError where other gains follow from the one at a place."""
    assert seen.drives is not None
    names, before = seen.drives.names, seen.drives.before
    column = instruments.shape[2] - len(names) + place
    flat = instruments.reshape(-1, instruments.shape[2])
    flat = flat / np.maximum(lengths := np.linalg.norm(flat, axis=0), 1e-300)
    shares = linalg.lstsq(np.delete(flat, column, axis=1), flat[:, column])[0]
    shares = np.insert(shares, column, 1.0)[-len(names) :] / np.maximum(lengths[-len(names) :], 1e-300)
    changes = np.abs(shares / before) / abs(shares[place] / before[place])
    tied = [name for name, change in zip(names, changes, strict=True) if change > TIED_SHARE]
    if len(tied) > 1:
        listed = ", ".join(f"`{name}`" for name in tied)
        raise NotIdentifiedError(
            f"the log says how the gains {listed} stand to each other, not how large they are, as nothing that drives "
            "move there is known: leave one that is known out of `gains`, or state what is known, a mass as a number "
            "in `bodies`, or its name under `fixed`"
        )
