"""Reading the blocks of a model file: one module a block."""
