"""The index page: all figures with their numbers, what they show and how they were made."""

from collections.abc import Sequence
from html import escape

from ... import __version__
from .figure import PaperFigure

PAPER = "Frank Perbet and Marie-Paule Cani, <cite>Animating Prairies in Real-Time</cite>, I3D 2001"

STYLE = """\
:root { color-scheme: light dark;
  --paper: #f6f7f3; --card: #ffffff; --ink: #26301f; --faint: #667060; --line: #dfe2da; }
@media (prefers-color-scheme: dark) {
  :root { --paper: #171b15; --card: #20261d; --ink: #e4e8de; --faint: #9aa493; --line: #343c2f; }
}
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1rem 4rem; max-width: 62rem; background: var(--paper); color: var(--ink);
  font: 1rem/1.55 system-ui, sans-serif; }
h1 { margin: 0; font-size: 1.7rem; font-weight: 650; }
a { color: inherit; }
header p, footer { color: var(--faint); }
nav { display: flex; flex-wrap: wrap; gap: 0.4rem; margin: 1.2rem 0 2rem; }
nav a { padding: 0.15rem 0.7rem; border: 1px solid var(--line); border-radius: 1rem; text-decoration: none; }
nav a:hover, nav a:focus { border-color: var(--faint); }
figure { margin: 0 0 2rem; padding: 1rem; background: var(--card); border: 1px solid var(--line); border-radius: 0.6rem;
  scroll-margin-top: 1rem; }
img { display: block; width: 100%; height: auto; border-radius: 0.3rem; background: #fdfdfb; }
figcaption { margin-top: 0.8rem; }
figcaption p { margin: 0.3rem 0 0; }
.made { color: var(--faint); font-size: 0.92rem; }
@media print { nav { display: none; } figure { break-inside: avoid; border: 0; padding: 0; } }
"""


def document(title: str, style: str, body: str, /) -> str:
    """Return a self-contained HTML page from a title in plain text, a style sheet and a body."""
    return f"""\
<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{escape(title)}</title>
<style>
{style}</style>
</head>
<body>
{body}
</body>
</html>
"""


def index_page(figures: Sequence[PaperFigure], /) -> str:
    """Return the HTML page of figures whose files lie beside it."""
    links = "\n".join(f'<a href="#figure-{each.number}">{each.number}. {escape(each.title)}</a>' for each in figures)
    shown = "\n".join(_figure(each) for each in figures)
    body = f"""\
<header>
<h1>Animating Prairies in Real-Time: the figures</h1>
<p>Drawn by tallgrass {escape(__version__)}. Numbers and subjects are those of the paper: {PAPER}.</p>
</header>
<nav aria-label="Figures">
{links}
</nav>
<main>
{shown}
</main>
<footer>Made by <code>tallgrass figures</code>.</footer>"""
    return document("The figures of Animating Prairies in Real-Time, drawn by tallgrass", STYLE, body)


def _figure(each: PaperFigure) -> str:
    caption = f"Figure {each.number}: {each.title}. {each.shows}"
    return f"""\
<figure id="figure-{each.number}">
<a href="{each.file}"><img src="{each.file}" alt="{escape(caption)}" loading="lazy"></a>
<figcaption>
<strong>Figure {each.number}: {escape(each.title)}.</strong>
<p>{escape(each.shows)}</p>
<p class="made">{escape(each.made)}</p>
</figcaption>
</figure>"""
