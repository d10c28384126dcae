"""The null space of B: by minors, by reflections, with pivots, by blocks and by families of columns."""
