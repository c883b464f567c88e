"""Scenes of these tests keep objects that are there twice: a tree breaks ties as a loop does."""

import pytest


@pytest.fixture(autouse=True)
def keep_twins(twins_stay: None) -> None:
    """Keep twins in every test of this folder."""
