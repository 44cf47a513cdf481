"""HTML of maps and routes for notebooks, with pictures inside and no link to another file."""

import base64
import html
import struct
import zlib
from typing import Any, Iterable

import numpy as np
import numpy.typing as npt

from talus._talus import _CATEGORIES, Map, Route

_MOST = 400  # cells along a side of a picture, and vertices of a drawn route


def _png(values: npt.NDArray[np.uint8]) -> str:
    """Return cells, row 0 in the south, as a PNG with the colours of the categories."""
    rows, columns = values.shape
    palette = b"".join(struct.pack(">I", colour)[1:] for _, colour in _CATEGORIES)
    lines = b"".join(b"\0" + row.tobytes() for row in values[::-1])
    png = b"\x89PNG\r\n\x1a\n"
    for kind, data in (
        (b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 3, 0, 0, 0)),
        (b"PLTE", palette),
        (b"IDAT", zlib.compress(lines, 9)),
        (b"IEND", b""),
    ):
        png += struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    return base64.b64encode(png).decode()


def _table(facts: Iterable[tuple[str, str]]) -> str:
    return "<table>" + "".join(f"<tr><td>{k}</td><td>{html.escape(v)}</td></tr>" for k, v in facts) + "</table>"


def map_html(ground: Map) -> str:
    """Return a picture of the categories in the worst heading, north up, and the share of each."""
    categories = ground.categories()
    step = -(-max(categories.shape) // _MOST)
    shares = np.bincount(categories.ravel(), minlength=4) / categories.size
    facts = [(f"{name} <span style='background:#{colour:06x};border:1px solid'>&emsp;</span>", f"{100 * share:.1f} %")
             for (name, colour), share in zip(_CATEGORIES, shares)]
    picture = f"<img style='image-rendering:pixelated;width:400px' src='data:image/png;base64,{_png(categories[::step, ::step])}'>"
    return f"{picture}<p>{html.escape(repr(ground)[1:-1])}, CRS {html.escape(ground.crs)}</p>{_table(facts)}"


def route_html(route: Route) -> str:
    """Return the track, north up, and the summary of a route, or the reason why there is none."""
    facts: list[tuple[str, Any]] = [("status", route.status), ("reason", route.reason), ("planner", route.planner)]
    if len(route) == 0:
        return _table(facts)
    for name in ("cost_J", "lower_bound_J", "energy_J", "time_s", "length_m", "max_slip", "immobilisation_risk"):
        facts.append((name, f"{getattr(route, name):.5g}"))
    x, y = route["x_m"], route["y_m"]
    span = max(float(np.ptp(x)), float(np.ptp(y)), 1e-9)
    keep = np.unique(np.linspace(0, len(route) - 1, _MOST).astype(int))
    at = [f"{5 + 290 * (a - x.min()) / span:.1f},{5 + 290 * (y.max() - b) / span:.1f}" for a, b in zip(x[keep], y[keep])]
    width, height = (10 + 290 * np.ptp(v) / span for v in (x, y))
    start = at[0].split(",")
    track = f"<polyline points='{' '.join(at)}' fill='none' stroke='#0072b2' stroke-width='2'/><circle cx='{start[0]}' cy='{start[1]}' r='4'/>"
    return f"<svg width='{width:.0f}' height='{height:.0f}'>{track}</svg>{_table((k, v) for k, v in facts if v)}"
