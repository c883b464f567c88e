"""The experiments on comparisons between methods, and on changes that are found."""

import pytest

from bench import changes_found, methods_compared
from bench.changes_found import Pairing, changes
from bench.methods_compared import Contest, chance_of_as_many, metal_balls
from tests.support.noisy_images import flat


def test_the_chance_of_false_alarms_is_binomial() -> None:
    assert chance_of_as_many(0, 300) == 1
    assert chance_of_as_many(1, 300) == pytest.approx(1 - 0.99**300)
    assert chance_of_as_many(3, 3) == pytest.approx(1e-6)


def test_a_change_is_of_one_kind_alone() -> None:
    image = flat(0.5, 0.1, 64, 64)
    groups = {"a": flat(0.2, 0, 64, 64), "b": flat(0.3, 0, 64, 64)}
    found = changes(image, groups, place=9)
    assert list(found) == ["all light", "one block", "light group a", "light group b"]
    assert found["all light"].min() == 0.5
    block = found["one block"]
    assert (block > 0).sum() == 3 * 64
    assert (block[8:16, 8:16] == 0.5).all(), "the tenth of eight in a row"
    assert found["light group b"].max() == pytest.approx(0.3)
    assert "light group a" not in changes(image, {"a": groups["a"]}, 0), "it is all light"


def test_a_table_has_a_row_for_each_contest(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Two pairs of heavy tails, 16 x 16 pixels."""
    for name in ("WIDTH", "HEIGHT"):
        monkeypatch.setattr(methods_compared, name, 16)
    contest = Contest(metal_balls(0.15), ("nee", 64), ("mis", 64))
    monkeypatch.setattr(methods_compared, "contests", lambda: {"balls": contest})
    assert methods_compared.main(["--pairs", "2"]) == 0
    assert "| balls | nee against mis | 64 / 64 | " in capsys.readouterr().out


def test_a_table_has_a_row_for_each_kind_of_change(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    for module in (methods_compared, changes_found):
        monkeypatch.setattr(module, "WIDTH", 16)
        monkeypatch.setattr(module, "HEIGHT", 16)
    monkeypatch.setattr(changes_found, "REFERENCES", 1)
    pairing = Pairing("sky", ("mis", 64), ("mis", 64))
    monkeypatch.setattr(changes_found, "pairings", lambda: [pairing])
    assert changes_found.main(["--pairs", "2"]) == 0
    out = capsys.readouterr().out
    assert "| sky | mis against mis | 64 / 64 | all light | " in out
    assert "| one block | " in out
    assert out.count(" of 2 |") == 2
