"""Tests of methods that keep a history of a moving picture."""
