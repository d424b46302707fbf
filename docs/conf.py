"""Sphinx configuration; the pages are built with warnings as errors."""

import re
from configparser import ConfigParser
from importlib import import_module
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
autodoc_default_options = {"members": True, "special-members": "__call__, __getitem__"}
napoleon_google_docstring = False
napoleon_custom_sections = ["Speed and accuracy"]
nitpicky = True  # a link to a name that does not exist is a warning
nitpick_ignore_regex = [
    ("py:mod", "math"),
    ("py:class", r"(collections\.abc|fractions|sympy)\..*|(fastpicard|lagrangian)\.\w+\.[A-Z]\w*"),  # of annotations
]
suppress_warnings = ["ref.python"]  # "free of t" in a type is prose; which attribute t it might mean is no matter


def entry(lines):
    """One argument, attribute or result as a paragraph, "names : type     description" or "names : prose".

    Two spaces end a type, and so does a first line that leaves room for more.
    """
    first, *others = [line.strip() for line in lines]
    names, colon, rest = first.partition(" : ")
    if not colon:
        names, rest = "", first
    rest, gaps = re.subn(r"(?<![.;:])  +", " -- ", rest, count=1)
    between = " -- " if not gaps and len(first) < 88 else " "
    return (f"**{names}** : " if names else "") + between.join(filter(None, [rest, " ".join(others)]))


def entries(title, lines):
    """A section of entries as a field: napoleon would take prose for a type, and ``a, b : type`` for one name."""
    groups = []
    for line in lines:
        if groups and (line.startswith(" ") or " : " not in line):
            groups[-1].append(line)
        else:
            groups.append([line])
    return [f":{title}:", *(f"    * {entry(group)}" for group in groups), ""]


def fields(lines):
    """The lines with their sections of entries, each of which ends at a blank line, as fields."""
    result, lines = [], list(lines)
    while lines:
        title = lines.pop(0)
        if title in ("Parameters", "Attributes", "Returns") and lines and set(lines[0]) == {"-"}:
            end = lines.index("") if "" in lines else len(lines)
            result += entries(title, lines[1:end])
            lines = lines[end:]
        else:
            result.append(title)
    return result


def house_style(app, what, name, obj, options, lines):
    """Read docstrings as they are meant, before napoleon does.

    An indented block is a formula, shown as it was typed.  A numpydoc section ends at a blank line that is
    followed by text at the margin; napoleon would take that text for one more entry.
    """
    result, in_section, in_block = [], False, False
    lines[:] = fields(lines) if what != "property" else ["..", "", *lines]  # a comment first, or "a: b" is a type
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
        public = import_module(package).__all__
        lines = []
        for name in reversed(names):
            if (top / package / f"{name}.py").exists():
                lines += [f".. rubric:: ``{package}/{name}.py``", ""]
                lines += [f".. automodule:: {package}.{name}", "   :no-members:"]
                lines += ["   :no-index:", ""] if name in public else [""]  # links to chart are to the function
        self.state_machine.insert_input(lines, f"the files of {package}")
        return []


def setup(app):
    app.add_directive("reading-order", ReadingOrder)
    app.connect("autodoc-process-docstring", house_style, priority=400)
