"""The page ``docs/article.rst`` and these tests name the same things."""

import re
from pathlib import Path

HERE = Path(__file__).parent
PAGE = HERE.parents[1] / "docs" / "article.rst"


def names_here():
    """The names of all tests of outputs: those in ``test_article_*.py``."""
    return {name for file in HERE.glob("test_article_*.py")
            for name in re.findall(r"^def (test_\w+)\(", file.read_text(encoding="utf-8"), flags=re.MULTILINE)}


def test_page_names_only_tests_that_exist():
    """Every test that the page names is here."""
    named = set(re.findall(r"``(test_\w+)``", PAGE.read_text(encoding="utf-8")))
    assert len(named) > 20
    assert named - names_here() == set()


def test_page_names_every_test():
    """Every test of an output of the article is named on the page."""
    page = PAGE.read_text(encoding="utf-8")
    assert {name for name in names_here() if f"``{name}``" not in page} == set()
