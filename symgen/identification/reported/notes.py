"""What a reader should know before estimates are used, in sentences."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from symgen.identification.combinations import BodyCombinations
from symgen.identification.energies.shown_terms import ShownTerms
from symgen.identification.estimates.identification import Identification
from symgen.identification.text import combination

# Times the noise of the inputs, or standard errors, from which on something is more than noise.
MORE_THAN_NOISE = 3.0
# Times what the fit leaves, from which on it does not carry over to what was set aside.
CARRIES_OVER = 2.0
# Of the measured motion, what closed loops may differ from it by.
OFF_LOOPS = 0.003
# Of a combination of unit length, what a parameter that is named in it has at least.
NAMED_SHARE = 0.2


def notes(made: Identification) -> tuple[str, ...]:
    """All of them; that the log contradicts the model comes first, and in place of what follows from that."""
    if made.is_of_another_machine:
        return (contradiction(made),)
    return (*_of_inputs(made), *_of_parameters(made), *_of_energies(made), *_of_gains(made), *_of_the_file(made))


def contradiction(made: Identification) -> str:
    """That the model does not explain the log."""
    return (
        f"the log is not of this machine as the model has it: {100 * made.left_over:.0f} % of the inputs stay "
        "unexplained; check columns, signs, units, the geometry, and what the model leaves out"
    )


def _of_inputs(made: Identification) -> Iterator[str]:
    moved = np.mean([np.std(made.log.columns[name]) for name in made.log.measured])
    if made.open_by > OFF_LOOPS * moved:
        yield (
            f"measured coordinates are off closed loops by {made.open_by:.2g} (rms): lengths of the model or offsets "
            "of encoders are wrong"
        )
    drives = made.drives
    if noisy := [one.name for one in drives if one.fitted > MORE_THAN_NOISE * one.noise]:
        yield f"more than noise is left of {', '.join(noisy)}: the model lacks something, such as friction"
    if off := [one.name for one in drives if one.predicted > CARRIES_OVER * one.fitted]:
        yield f"{', '.join(off)}: worse predicted where set aside than where fitted; a longer log helps"


def _of_parameters(made: Identification) -> Iterator[str]:
    parameters = made.parameters
    small, rough, unseen = (
        sum(one.verdict.startswith(word) for one in parameters) for word in ("may be", "rough", "open")
    )
    counts = [(small, "may as well be 0"), (rough, "known roughly"), (unseen, "not shown by this motion")]
    if words := [f"{count} {what}" for count, what in counts if count]:
        yield (
            f"of {len(parameters)} estimates {', '.join(words)}; the condition number is "
            f"{made.estimate.condition:.0f}, limited by {_weakest(made)}"
        )


def _weakest(made: Identification) -> str:
    """The parameters that the weakest combination holds most of."""
    sizes = np.abs(made.estimate.weakest)
    order = [k for k in np.argsort(-sizes, kind="stable")[:2] if sizes[k] > NAMED_SHARE]
    return " with ".join(made.parameters[k].name.split(" ")[0] for k in order) or "none in particular"


def _of_energies(made: Identification) -> Iterator[str]:
    if not isinstance(made.combinations, ShownTerms):
        return
    terms = made.combinations.terms
    if terms.geometry and not terms.is_said:
        yield (
            f"taken for known, as geometry is: {', '.join(terms.geometry)}; `identify: {{geometry: [...]}}` in the "
            "model file says otherwise"
        )


def _of_gains(made: Identification) -> Iterator[str]:
    if isinstance(made.combinations, BodyCombinations) and made.combinations.known:
        known = ", ".join(combination(made.combinations.base.base[k]) for k in made.combinations.known)
        yield f"taken for known, as gains are told by what is: {known}".replace("\u00a0", " ")


def _of_the_file(made: Identification) -> Iterator[str]:
    values = made.values
    if values.impossible:
        which = ", ".join(values.impossible)
        ending = "bodies keep the values of the file" if values.kept else "the nearest possible values are taken"
        yield f"the data alone give {which} a mass or moment that cannot be: {ending}"
    if values.names and values.misfit > MORE_THAN_NOISE:
        wider = made.whole is not None and made.whole.misfit < MORE_THAN_NOISE
        yield (
            f"no values of the file's parameters give the estimates (off by {values.misfit:.1f} standard errors): "
            "bodies that share parameters differ, or numbers in the file are wrong"
            + ("; `--whole-bodies` writes bodies that do" if wider else "")
        )
