"""Sweeps into the places where methods fail: the method chosen beside the naive one."""
