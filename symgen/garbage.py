"""What nobody holds any more but itself, let go by hand: commands run without the collector of cycles.

Looking for cycles all the time costs a twentieth of a run, and most runs end before their memory is worth it. Graphs
and their scalars hold each other; where many were made and are of no use any more, they are looked for once.
"""

from __future__ import annotations

import gc


def let_go() -> None:
    """Lets go of what holds itself, of all that was made since the last `let_go_and_keep`."""
    if not gc.isenabled():
        gc.collect()


def let_go_and_keep() -> None:
    """The same; nobody looks again through what is left."""
    if not gc.isenabled():
        gc.collect()
        gc.freeze()
