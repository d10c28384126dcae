"""What passes, constants and what scenes do not need are worth, counted."""
