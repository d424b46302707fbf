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
