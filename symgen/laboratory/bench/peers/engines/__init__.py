"""The scalars of each tool: symbols, numbers, derivatives, and the C that comes of them."""
