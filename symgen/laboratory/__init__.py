"""What measures the product; nothing of the product depends on it."""
