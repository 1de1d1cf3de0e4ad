# SPDX-License-Identifier: BSD-3-Clause
"""Sphinx configuration of the site; scripts/make_site lays out its sources and runs it there."""
import json
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

project = "Adaptive skill reproduction"
html_title = project
copyright = "BSD-3-Clause"
extensions = ["myst_parser", "breathe", "autoapi.extension", "mathml", "docstrings"]
myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence"]
myst_heading_anchors = 4
suppress_warnings = [
    "myst.header",  # a README's second heading may skip a level
    "autoapi.python_import_resolution",  # of modules that are not here, as the compiled ones
]
nitpicky = False  # types of Eigen, ROS and std have no page here

html_theme = "furo"
html_static_path = ["_static"]
html_css_files = ["site.css"]
html_show_sourcelink = False
html_show_copyright = False
highlight_language = "text"
html_math_renderer = "mathml"

breathe_projects = json.loads(os.environ["SITE_DOXYGEN"])
breathe_show_include = False

autoapi_dirs = os.environ["SITE_PYTHON"].split(os.pathsep)
autoapi_root = "reference/python"
autoapi_file_patterns = ["*.pyi", "*.py"]  # a stub stands for its compiled module
autoapi_options = ["members", "undoc-members"]
autoapi_add_toctree_entry = False
autoapi_python_use_implicit_namespaces = False
