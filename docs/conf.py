# SPDX-License-Identifier: BSD-3-Clause
# Settings of Sphinx. docs/build.sh copies this file beside the pages (docs/stage.py) and starts Sphinx there.
import os
import pathlib
import re

top = pathlib.Path(os.environ["GAUSSMAP_TOP"])
project = "gaussmap"
author = "the gaussmap authors"
copyright = "the gaussmap authors, BSD-3-Clause"
release = re.search(r'define GAUSSMAP_VERSION "(.+)"', (top / "include/gaussmap/version.h").read_text()).group(1)
version = ".".join(release.split(".")[:2])

extensions = ["myst_parser", "breathe", "sphinx_copybutton"]
myst_heading_anchors = 4  # [text](#a-heading), as GitHub has them
myst_enable_extensions = ["dollarmath"]
breathe_projects = {"gaussmap": os.environ["GAUSSMAP_DOXYGEN_XML"]}
breathe_default_project = "gaussmap"
breathe_default_members = ("members",)
breathe_show_include = False
primary_domain = "cpp"
highlight_language = "none"

# Names of other libraries.
nitpick_ignore_regex = [
    ("cpp:identifier", r"Pose(Covariance|Direction)::Zero"),  # of Eigen
    ("cpp:identifier", r"(std|Eigen|pcl)(::.*)?|gaussmap"),
    ("cpp:identifier", r"(Vector|Matrix)<.*>::.*|Rotation::.*"),  # members of Eigen's types
    ("cpp:identifier", r"(AccumulatedScans|OnlineMapper)<.*>::.*"),  # types in class templates
    ("cpp:identifier", r"detail(::CloudInput<.*>)?"),  # what the map builders share
    ("cpp:identifier", r"Base(::.*)?|PointCloud\w*Ptr"),  # the class of PCL that a plug-in derives from
]

html_theme = "sphinx_rtd_theme"
html_theme_options = {"navigation_depth": 3, "collapse_navigation": True}
html_static_path = ["gaussmap.css"]
html_css_files = ["gaussmap.css"]
html_title = f"gaussmap {release}"
html_show_sphinx = False
html_copy_source = False
