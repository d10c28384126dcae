"""What the user wrote, resolved and checked, as frozen data."""
