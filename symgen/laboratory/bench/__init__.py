"""Run time against error: symgen's kernels beside those of other tools, on the same work in the same run."""
