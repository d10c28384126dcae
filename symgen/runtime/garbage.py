"""What nobody holds any more but itself, let go by hand: commands run without the collector of cycles.

Looking for cycles all the time costs a twentieth of a run, and most runs end before their memory is worth it. Graphs
and their scalars hold each other; where many were made and are of no use any more, they are looked for once.
"""

from __future__ import annotations

import gc
from collections.abc import Callable
from contextlib import suppress

# Objects, some hundred bytes each; fewer are not worth looking through all the others.
MANY = 600_000
# What clears the results that functions of scalars remember: each would keep a whole graph.
_CLEARING: list[Callable[[], None]] = []


def cleared_with_the_rest(clear: Callable[[], None]) -> None:
    """Has a function clear what it remembers before anything is looked through."""
    _CLEARING.append(clear)


def let_go() -> None:
    """Lets go of what holds itself, of all that was made since the last `let_go_and_keep`, once that is much.

    What two of these looks have left in use is not looked through by the next.
    """
    if not gc.isenabled() and gc.get_count()[0] > MANY:
        _collect(1)


def let_go_and_keep() -> None:
    """The same; nobody looks again through what is left, and what is free goes back to the system for compilers."""
    if not gc.isenabled():
        _collect(2)
        gc.freeze()
        _give_back()


def let_go_of_all() -> None:
    """Of what was kept before, too: once, when most of it has served its turn and compilers need the memory."""
    gc.unfreeze()
    let_go_and_keep()


def _collect(generation: int) -> None:
    for clear in _CLEARING:
        clear()
    gc.collect(generation)


def _give_back() -> None:
    """glibc keeps pages that are free between others until it is told (malloc_trim(3))."""
    import ctypes  # small models start without it

    with suppress(OSError, AttributeError, TypeError):
        ctypes.CDLL(None).malloc_trim(0)
