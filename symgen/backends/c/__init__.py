"""C99: plain kernels, batches, prepared parameters, given sines, several results; a header and a source for each scalar type."""
