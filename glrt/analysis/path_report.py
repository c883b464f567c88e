"""Paths of a pixel as text: which samples carry its light, where they went, and what lit them."""

from collections.abc import Iterator, Sequence

from glrt.core.text import counted, escaped
from glrt.rendering.paths.values import Array, Contribution, Path, PathVertex, PixelPaths, Triple

LISTED = 5  # samples that are listed with their share
TOTAL = 0.995  # share of the light from which on a sample brings all of it


def report(found: PixelPaths, source: str) -> str:
    """The whole report; `source` is the name of the scene."""
    parts = _head(found, source), _ranking(found), _told(found.paths), _particles(found)
    return "\n".join(line for part in parts for line in part)


def _head(found: PixelPaths, source: str) -> Iterator[str]:
    settings, (x, y) = found.recipe.settings, found.pixel
    yield (
        f"{source}: pixel {x} {y} of {settings.width} x {settings.height}, "
        f"{counted(len(found.radiances), 'sample')} by {settings.method}"
    )
    yield f"mean radiance {triple(found.mean)}"
    if found.particles:
        total = triple(found.mean + found.particles.mean)
        yield f"  by paths from the camera; {total} with particles, which are listed apart"
    if found.lost:
        yield f"{counted(found.lost, 'sample')} lost or not finite, and not in the mean"


def _ranking(found: PixelPaths) -> Iterator[str]:
    shares, listed = found.shares, found.brightest(LISTED)
    yield ""
    if not listed:
        yield "No sample brings any light."
        return
    first = listed[0]
    whose = "what paths from the camera bring" if found.particles else "this pixel's light"
    yield f"Sample {first} carries {percent(shares[first])} of {whose}."
    for number in listed:
        radiance = triple(found.radiances[number])
        yield f"  {f'sample {number}':<14} {percent(shares[number]):>7}   radiance {radiance}"
    bringing = int((shares > 0).sum())
    if bringing > len(listed):
        rest = percent(1 - shares[listed].sum())
        yield f"  {f'{bringing - len(listed)} others':<14} {rest:>7}"
    if dark := len(shares) - bringing:
        yield f"  {counted(dark, 'sample')} brought none"


def _particles(found: PixelPaths) -> Iterator[str]:
    particles = found.particles
    if not particles:
        return
    yield ""
    yield (
        f"Particles: {counted(len(particles.numbers), 'particle')} of "
        f"{counted(particles.samples, 'sample')} reached this pixel, "
        f"and bring {triple(particles.mean)}"
    )
    yield from _told(particles.paths)


def _told(paths: Sequence[Path]) -> Iterator[str]:
    for path in paths:
        yield ""
        which = "" if path.particle is None else f", particle {path.particle}"
        radiance = triple(path.radiance)
        yield f"Sample {path.sample}{which}: radiance {radiance}, ended by: {path.end}"
        yield from _table(vertex_rows(path))
        yield from _lights(path)
        if reason := explanation(path):
            yield ""
            yield reason


def vertex_rows(path: Path) -> list[tuple[str, ...]]:
    """Cells of a table of the vertices of a path, headings first."""
    rows: list[tuple[str, ...]] = [
        ("", "event", "object", "material", "distance", "throughput", "density", "survives")
    ]
    for number, vertex in enumerate(path.vertices):
        rows.append((str(number), vertex.event, *_seen(vertex)))
    return rows


def _seen(vertex: PathVertex) -> tuple[str, str, str, str, str, str]:
    if vertex.object is None:
        return "", "", "", "", "", ""
    scatters = vertex.direction is not None and not vertex.event.startswith("passes")
    return (
        escaped(vertex.name),
        escaped(vertex.material or ""),
        f"{vertex.distance:.4g}",
        triple(vertex.throughput),
        (f"{vertex.pdf:.4g}" if vertex.pdf else "delta") if scatters else "",
        f"{100 * vertex.survival:.3g} %" if scatters and vertex.survival < 1 else "",
    )


def _lights(path: Path) -> Iterator[str]:
    if not path.contributions:
        yield "  no light"
        return
    yield ""
    yield from _table(light_rows(path))


def light_rows(path: Path) -> list[tuple[str, ...]]:
    """Cells of a table of the light that a path found, headings first."""
    whole = sum(path.radiance)
    rows: list[tuple[str, ...]] = [
        ("at", "light", "found by", "radiance", "density", "other", "weight", "added", "share")
    ]
    for light in path.contributions:
        share = percent(sum(light.added) / whole) if whole else ""
        rows.append(
            (
                str(light.vertex),
                escaped(light.name),
                light.strategy,
                triple(light.radiance),
                f"{light.pdf:.4g}" if light.pdf else "delta",
                f"{light.other_pdf:.4g}" if light.other_pdf else "-",
                f"{light.weight:.3g}",
                "hidden" if light.hidden else triple(light.added),
                "" if light.hidden else share,
            )
        )
    return rows


def explanation(path: Path) -> str:
    """Why a sample is as bright as it is: the path of most of its light, and what else finds it."""
    if not any(path.radiance):
        return ""
    light = max(path.contributions, key=lambda found: sum(found.added))
    share = sum(light.added) / sum(path.radiance)
    way = _way if path.particle is None else _way_back
    much = "All" if share > TOTAL else percent(share)
    return f"{much} of it is from {_name(light)}, by {way(path, light)}: {_finding(light)}."


def _way_back(path: Path, light: Contribution) -> str:
    """The names of the objects from a particle's lamp to the camera."""
    names = [escaped(vertex.name) for vertex in path.vertices[: light.vertex + 1]]
    return " - ".join([*names, "camera"])


def _way(path: Path, light: Contribution) -> str:
    """The names of the objects from the camera to a light."""
    names = [escaped(vertex.name) for vertex in path.vertices[: light.vertex + 1]]
    if light.strategy == "light sampling" or light.source != "object":
        names.append(_name(light))
    return " - ".join(names)


def _name(light: Contribution) -> str:
    if light.source == "medium":
        return f"the medium {escaped(light.name)}"
    return escaped(light.name) if light.source == "object" else f"the {light.source}"


def _finding(light: Contribution) -> str:
    if light.strategy == "particle":
        return f"linked to the camera with weight {light.weight:.3g}"
    if light.strategy == "camera":
        return "the camera sees it"
    if light.strategy == "light sampling":
        return f"sampled there with density {light.pdf:.3g}, weight {light.weight:.3g}"
    if not light.pdf:
        return (
            "met behind a smooth surface, where no light can be sampled; paths that meet it are "
            "rare, and each weighs as much more"
        )
    if not light.other_pdf:
        return f"met by scattering with density {light.pdf:.3g}, which alone finds it"
    return (
        f"met by scattering with density {light.pdf:.3g}, where sampling has {light.other_pdf:.3g}"
    )


def _table(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    """Lines of a table with columns two blanks apart, without blanks at their ends."""
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (f"{cell:<{width}}" for cell, width in zip(row, widths, strict=True))
        yield ("  " + "  ".join(cells)).rstrip()


def triple(values: Triple | Array) -> str:
    """Three numbers with four significant digits each."""
    return " ".join(f"{float(value):.4g}" for value in values)


def percent(share: float) -> str:
    """A share in percent, with three significant digits."""
    return f"{100 * share:.3g} %"
