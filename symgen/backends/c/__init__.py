"""C99: plain kernels, batches, prepared parameters, given sines, several results; files for each scalar type."""
