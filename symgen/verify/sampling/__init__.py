"""States: regular ones on the constraint manifold, and where a kernel is worst."""
