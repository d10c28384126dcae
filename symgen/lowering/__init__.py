"""From scalars of a graph to straight-line kernels."""
