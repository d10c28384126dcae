"""Powers of ten with the same bits on every machine: in seven digits, as a library's last bits are its own."""

from __future__ import annotations

from typing import Any

import numpy as np


def power_of_ten(exponent: Any) -> Any:
    """10^x of a number, or of each in an array; x is far from the ends of single precision."""
    powers = np.power(10.0, exponent).astype(np.float32).astype(float)
    return powers if np.ndim(exponent) else float(powers)
