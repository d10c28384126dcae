"""Charts, tables and pages of stress runs."""
