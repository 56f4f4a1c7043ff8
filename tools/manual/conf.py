"""Sphinx's settings of the manual; `build` copies this file beside the pages."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

project = "rvelab"
copyright = "the authors of rvelab, MIT licence"
extensions = ["myst_parser", "mathml"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
myst_dmath_double_inline = False
html_math_renderer = "mathml"
highlight_language = "text"
pygments_style = "friendly"
html_theme = "furo"
html_title = "rvelab"
html_static_path = ["static"]
html_css_files = ["style.css"]
html_copy_source = False
html_show_sourcelink = False
html_last_updated_fmt = None
smartquotes = False  # "quasi_static" is a value with its quotation marks
nitpicky = True  # a reference without a target is a warning
