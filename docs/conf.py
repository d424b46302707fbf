"""Sphinx configuration; the pages are built with warnings as errors."""

from importlib.metadata import version as installed_version

project = "fastpicard"
author = "The fastpicard developers"
copyright = f"2026, {author}"
release = version = installed_version("fastpicard")

extensions = [
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx.ext.napoleon",
]
exclude_patterns = ["_build"]

html_theme = "alabaster"
html_theme_options = {
    "description": "Exact Picard iterates for linear equations with periodic coefficients",
    "page_width": "1060px",
    "fixed_sidebar": True,
}
html_sidebars = {"**": ["about.html", "navigation.html", "searchbox.html"]}
html_show_sourcelink = False

default_role = "code"
highlight_language = "python"

autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True}
napoleon_google_docstring = False
napoleon_use_ivar = True
napoleon_use_rtype = False


def house_style(app, what, name, obj, options, lines):
    """Read docstrings as they are meant, before napoleon does.

    An indented block is a formula, shown as it was typed.  A numpydoc section ends at a blank line that is
    followed by text at the margin; napoleon would take that text for one more entry.
    """
    result, in_section, in_block = [], False, False
    for number, line in enumerate(lines):
        previous_blank = bool(result) and not result[-1].strip()
        if line.strip() and not line.startswith(" "):
            underline = lines[number + 1].strip() if number + 1 < len(lines) else ""
            if len(underline) > 2 and set(underline) == {"-"}:
                in_section = True
            elif in_section and previous_blank:
                result.append("")
                in_section = False
            in_block = False
        elif line.startswith("   ") and previous_blank and not (in_block or in_section):
            in_block = not line.lstrip().startswith((">>>", "..", "- ", "* "))
            result += [".. code-block:: text", ""] if in_block else []
        result.append(line)
    lines[:] = result


def setup(app):
    app.connect("autodoc-process-docstring", house_style, priority=400)
