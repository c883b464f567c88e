"""Measurements of speed, memory and noise, of glrt and of its rivals. Not part of the wheel."""
