"""`--error`: a fraction or a percentage, and what is probably neither."""

from pathlib import Path

import pytest

from glrt.cli.commands import parse
from glrt.cli.main import main


@pytest.mark.parametrize(
    ("text", "share"),
    [("0.02", 0.02), ("2%", 0.02), ("2 %", 0.02), ("1", 1), ("150%", 1.5), ("5e-1%", 0.005)],
)
@pytest.mark.parametrize("line", ["render sky -o a.png", "inspect sky"])
def test_a_fraction_or_a_percentage(line: str, text: str, share: float) -> None:
    assert parse([*line.split(), "--error", text]).error == pytest.approx(share)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("2", "argument --error: 200 %? For 2 % write 2% or 0.02. See `glrt "),
        ("1.5", "150 %? For 1.5 % write 1.5% or 0.015."),
        ("two", "'two' is no error, such as 0.02 or 2%."),
        ("%", "'%' is no error"),
        ("0%", "--error must be a number above 0, got 0."),
        ("-2%", "--error must be a number above 0, got -0.02."),
        ("inf", "--error must be a number above 0, got inf."),
        ("nan%", "--error must be a number above 0, got nan."),
    ],
)
def test_what_is_neither_is_asked_back(
    text: str, said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["render", "sky", "-o", str(tmp_path / "a.png"), f"--error={text}"]) == 2
    told = capsys.readouterr().err
    assert said in told
    assert told.count("\n") == 1
    assert not list(tmp_path.iterdir())
