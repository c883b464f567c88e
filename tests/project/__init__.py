"""The house as a whole: structure, set-up, packaging, faults, fuzz."""
