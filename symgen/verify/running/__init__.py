"""What was generated, compiled or imported and called as its users call it."""
