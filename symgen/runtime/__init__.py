"""A run's processes, signals, progress and memory."""
