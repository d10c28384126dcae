"""Which quantities a system has, and the method that each takes."""
