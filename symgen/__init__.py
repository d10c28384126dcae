"""symgen: verified, globally valid inverse dynamics of constrained mechanical systems."""

__version__ = "0.1.0"
