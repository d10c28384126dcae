"""Python on the array API standard: modules that run on NumPy, JAX and whatever else has such a namespace."""
