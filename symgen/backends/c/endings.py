"""What stands behind the names of files and functions of kernels for another use than one state: data."""

BATCH = "_batch"
PREPARED = "_prepared"
SINES_GIVEN = "_sc"
TOGETHER = "_together"
