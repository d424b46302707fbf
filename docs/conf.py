"""Sphinx configuration; the pages are built with warnings as errors."""

from configparser import ConfigParser
from importlib.metadata import version as installed_version
from pathlib import Path

from docutils.parsers.rst import Directive

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
napoleon_custom_sections = ["Speed and accuracy"]
suppress_warnings = ["ref.python"]  # "free of t" in a type is prose; which attribute t it might mean is no matter


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


class ReadingOrder(Directive):
    """The opening of every file of a package, in the order of its layers in setup.cfg."""

    required_arguments = 1

    def run(self):
        package = self.arguments[0]
        top = Path(__file__).parent.parent
        settings = ConfigParser()
        settings.read(top / "setup.cfg")
        layers = settings[f"importlinter:contract:{package}-layers"]["layers"]
        names = layers.replace("(", "").replace(")", "").replace("|", " ").split()
        lines = []
        for name in reversed(names):
            if (top / package / f"{name}.py").exists():
                lines += [f".. rubric:: ``{package}/{name}.py``", ""]
                lines += [f".. automodule:: {package}.{name}", "   :no-members:", "   :no-index:", ""]
        self.state_machine.insert_input(lines, f"the files of {package}")
        return []


def setup(app):
    app.add_directive("reading-order", ReadingOrder)
    app.connect("autodoc-process-docstring", house_style, priority=400)
