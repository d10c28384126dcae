"""Frames, points and joints in any arithmetic."""
