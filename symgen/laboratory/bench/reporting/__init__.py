"""Charts, tables and pages of benchmarks, and the goals they are held against."""
