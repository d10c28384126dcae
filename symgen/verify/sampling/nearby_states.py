"""States in rows: what is looked at together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from symgen.verify.lanes.lane_arithmetic import Lanes
from symgen.verify.reference.reference import State
from symgen.verify.sampling.states import Sample


@dataclass(frozen=True)
class Nearby:
    """States with a row each: arguments and parameters by name, whether rates satisfy the constraints, and the places
    of the samples that they come from."""

    parts: Mapping[str, Lanes]
    admissible: Lanes
    origins: Lanes

    def __len__(self) -> int:
        return len(self.origins)

    def only(self, which: Lanes) -> Nearby:
        """Those that a mask or places name."""
        parts = {name: values[which] for name, values in self.parts.items()}
        return Nearby(parts, self.admissible[which], self.origins[which])

    def state(self, place: int) -> State:
        """One of them, in seven digits: what is found does not depend on the last bits of NumPy's functions."""
        single = {name: values[place].astype(np.float32) for name, values in self.parts.items()}
        q, qd, qdd, u, task = (tuple(map(float, single[name])) for name in ("q", "qd", "qdd", "u", "task"))
        return State(q, qd, qdd, u, tuple(map(float, self.parts["p"][place])), task)


def of_samples(samples: Sequence[Sample]) -> Nearby:
    """Samples as they are."""
    states = [sample.state for sample in samples]
    parts = {name: _rows([getattr(state, name) for state in states]) for name in ("q", "qd", "qdd", "u", "task")}
    parts["p"] = _rows([state.parameters for state in states])
    return Nearby(parts, np.array([sample.admissible for sample in samples]), np.arange(len(samples)))


def joined(first: Nearby, second: Nearby) -> Nearby:
    """All states of both."""
    parts = {name: np.concatenate((values, second.parts[name])) for name, values in first.parts.items()}
    admissible = np.concatenate((first.admissible, second.admissible))
    return Nearby(parts, admissible, np.concatenate((first.origins, second.origins)))


def _rows(values: Sequence[Sequence[Any]]) -> Lanes:
    return np.array([[float(x) for x in row] for row in values]).reshape(len(values), -1)
