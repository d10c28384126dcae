"""A NumPy module, vectorised over leading axes."""
