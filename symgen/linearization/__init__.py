"""A mechanism at rest as a linear system: its poles, what its inputs reach, and gains that hold it."""
