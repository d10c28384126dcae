"""What a model file says of parameters that a log may tell."""

from __future__ import annotations

from symgen.records import dataclass


@dataclass(frozen=True, slots=True)
class IdentifyChoice:
    """Parameters that identification takes for known: as `geometry` of energies, or `fixed` at their values.

    `gains` are factors of inputs that it estimates.  What is known of energies `is_said` here, or follows from units.
    """

    geometry: tuple[str, ...]
    fixed: tuple[str, ...]
    gains: tuple[str, ...] = ()
    is_said: bool = True
