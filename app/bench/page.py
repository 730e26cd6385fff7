"""The page of `bench all`: plots and all figures of one or two measurements, in a self-contained file."""

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape
from io import BytesIO
from typing import Any

from matplotlib.figure import Figure

from ..figures.page import STYLE, document
from ..figures.plot import look
from .plots import PLOTS, Plot, color
from .sent import Result

TABLE = """\
table { border-collapse: collapse; font-size: 0.92rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.1rem 0.9rem 0.1rem 0; text-align: right; border-bottom: 1px solid var(--line); }
th:first-child, td:first-child { text-align: left; }
.key { display: inline-block; width: 0.8em; height: 0.8em; border-radius: 0.2em; }
"""


def page(result: Result, before: Result | None = None, /) -> str:
    """Return the HTML page of a result of `bench all`, compared with an earlier one."""
    results = [result] if before is None else [before, result]
    plots = "\n".join(_shown(plot, results) for plot in PLOTS)
    title = f"tallgrass {result['version']}: {result['scene']}, {result['preset']}"
    body = f"""\
<header>
<h1>{escape(title)}</h1>
{_machines(results)}
</header>
<main>
{plots}
<details>
<summary>All figures</summary>
{_table(results)}
</details>
</main>
<footer>Made by <code>tallgrass bench all</code>.</footer>"""
    return document(title, STYLE + TABLE, body)


def _machines(results: Sequence[Result]) -> str:
    lines = []
    for number, each in enumerate(results):
        machine, when = each["machine"], "now" if number == len(results) - 1 else "before"
        what = f"{each['version']}, {each['scene']}, {each['preset']}; {machine['renderer']}, {machine['cpu']}"
        rule = f"yardstick {each['frame']['yardstick_ms']} ms"
        key = f'<span class="key" style="background: {color(number, len(results))}"></span>'
        lines.append(f"<p>{key} {when}: {escape(what)}; {rule}</p>")
    return "\n".join(lines)


def _shown(plot: Plot, results: Sequence[Result]) -> str:
    parts = [{"limits": each["limits"], **each[plot.part]} for each in results if each[plot.part] is not None]
    if not parts or results[-1][plot.part] is None:
        return ""
    with look():
        picture = _embedded(plot.draw(parts))
    return f"""\
<figure>
<img src="{picture}" alt="{escape(plot.title)}">
<figcaption><strong>{escape(plot.title)}.</strong> <p>{escape(plot.shows)}</p></figcaption>
</figure>"""


def _embedded(figure: Figure) -> str:
    file = BytesIO()
    figure.savefig(file, format="png", dpi="figure")
    return f"data:image/png;base64,{b64encode(file.getvalue()).decode('ascii')}"


def _table(results: Sequence[Result]) -> str:
    columns = [dict(figures(each)) for each in results]
    head = "<th>now</th>" if len(results) == 1 else "<th>before</th><th>now</th><th>now / before</th>"
    rows = []
    for name, value in columns[-1].items():
        cells = [column.get(name) for column in columns]
        if len(cells) == 2:
            cells.append(round(value / cells[0], 3) if cells[0] else None)
        text = "".join(f"<td>{'' if cell is None else f'{cell:g}'}</td>" for cell in cells)
        rows.append(f"<tr><td>{escape(name)}</td>{text}</tr>")
    return f"<table>\n<tr><th></th>{head}</tr>\n" + "\n".join(rows) + "\n</table>"


def figures(value: Any, name: str = "", /) -> Iterator[tuple[str, float]]:
    """Yield every number in a result with its path, such as `frame.frame_ms.p50` or `scale.rows.0.rss_mb`."""
    if isinstance(value, bool):
        return
    if isinstance(value, int | float):
        yield name, float(value)
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in inner:
        yield from figures(item, f"{name}.{key}".lstrip("."))
