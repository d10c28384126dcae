"""Words of Rust.  None is refused in model files: what is taken gets an ending inside of the crate."""

from __future__ import annotations

from symgen.registered import Words, words

_KEYWORDS = words(
    """Self abstract as async await become box break const continue crate do dyn else enum extern false final fn for
    gen if impl in let loop macro match mod move mut override priv pub ref return self static struct super trait true
    try type typeof union unsafe unsized use virtual where while yield"""
)
# In a pattern these are no new names.
_VARIANTS = words("Err None Ok Some")
# Crates that come with the compiler.
_CRATES = words("alloc core proc_macro std test")
WORDS = Words({}, (_KEYWORDS | _VARIANTS).__contains__)


def crate_name(stem: str) -> str:
    """What a model's crate is called, whose files are called `stem`."""
    return f"{stem}_model" if stem in _KEYWORDS | _CRATES else stem
