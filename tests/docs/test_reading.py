"""The manual is easy to read: Flesch's reading ease is 60 or more, and sentences are short.

No sentence has over 30 words where a page teaches, and none over 45 elsewhere.
"""

import re
from pathlib import Path

import pytest
import textstat

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
EASE, LONGEST, ELSEWHERE = 60.0, 30, 45
"""Plain English begins at an ease of 60 (Flesch); the longest sentence where a page teaches, and elsewhere [words]."""

NOT_PROSE = re.compile(r"(?ms)^```.*?^```$|<!-- generated: .*?end of what is generated -->|<!--.*?-->")
LINES_OF_NO_PROSE = re.compile(r"^(\||#|!\[|`[^`]+`:$).*$", re.MULTILINE)
LINK, CODE, NUMBER = re.compile(r"!?\[([^\]]*)\]\([^)]*\)"), re.compile(r"`[^`]*`"), re.compile(r"(?<=\d)[.,](?=\d)")


def prose(text: str, /) -> list[str]:
    """Return the sentences of a page. Code counts as one short word; an item of a list ends a sentence."""
    plain = LINES_OF_NO_PROSE.sub("", NOT_PROSE.sub("", text))
    plain = NUMBER.sub("", CODE.sub("code", LINK.sub(r"\1", plain))).replace("*", "")
    parts = [" ".join(part.split()) for part in re.split(r"\n\s*\n|^\s*(?:-|\d\.) ", plain, flags=re.MULTILINE)]
    return [sentence for part in parts for sentence in re.split(r"(?<=[.!?])\s+", part) if sentence]


def taught() -> list[str]:
    """Return the README, the first page, and the pages listed as tutorials and how-to pages."""
    listed = (DOCS / "mkdocs.yml").read_text("utf-8")
    parts = re.findall(r"^  - (?:Tutorials|How to):\n((?:      - .*\n)+)", listed, re.MULTILINE)
    assert len(parts) == 2
    return ["../README.md", "index.md", *re.findall(r": (\S+\.md)$", "".join(parts), re.MULTILINE)]


TAUGHT = taught()
OTHERS = sorted({*(page.name for page in DOCS.glob("*.md")), "../PACKAGE.md", "../CHANGELOG.md"} - {*TAUGHT})


@pytest.mark.parametrize("page", [*TAUGHT, *OTHERS])
def test_a_page_is_easy_to_read(page: str) -> None:
    sentences = prose((DOCS / page).read_text("utf-8"))
    assert len(sentences) >= 5 or page not in TAUGHT
    long = [sentence for sentence in sentences if len(sentence.split()) > (LONGEST if page in TAUGHT else ELSEWHERE)]
    assert not long, "\n".join(long)
    ease = textstat.flesch_reading_ease(" ".join(re.sub(r"[:,;]?$", ".", each.rstrip(".")) for each in sentences))
    hard = sorted(sentences, key=textstat.flesch_reading_ease)[:5]
    assert ease >= EASE, f"reading ease {ease:.0f}; the hardest sentences:\n" + "\n".join(hard)


def test_the_measure_tells_plain_prose_from_heavy_prose() -> None:
    plain = prose("# No prose\n\nThe wind blows. `Prairie.load` reads a [scene](scene.md) in 0.3 s.\n\n- Grass bends.")
    assert plain == ["The wind blows.", "code reads a scene in 03 s.", "Grass bends."]
    heavy = "Representational transitions necessitate considerable precomputation of individual configurations."
    assert textstat.flesch_reading_ease(" ".join(plain)) > EASE > textstat.flesch_reading_ease(heavy)
