#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Collects the pages of the site in a folder: docs/, the pages at the top that they link to, and one page per folder of
public headers. Usage: stage.py FOLDER XML (of Doxygen)"""
import os
import pathlib
import re
import shutil
import sys

TOP = pathlib.Path(__file__).resolve().parents[1]
INCLUDE = TOP / "include/gaussmap"
LINK = re.compile(r"(!?\[[^\]]*\])\(([^)\s#]+)(#[^)\s]*)?\)")

# Folders of public headers, in the order of the layers, and what they are for.
FOLDERS = {
    ".": "Everyday headers",
    "core": "Values: Gaussians, moments, poses, scans",
    "points": "Raw points",
    "mesh": "Triangle meshes",
    "clustering": "Clustering of Gaussians",
    "map": "Maps: grid, moments, Gaussians, queries, samples",
    "sensor": "Range images and visibility",
    "mapping": "Building and refining maps",
    "editing": "Merging, moving, cropping, simplifying, compressing, comparing",
    "registration": "Registration",
    "segments": "Line segments",
    "io": "Files",
    "evaluation": "Evaluation",
    "pcl": "PCL plug-ins",
}


def stage_page(source, target, pages):
    """Copies a page. Links that leave docs/ lead to a copy of the page or file, links to folders become text."""
    def moved(match):
        text, link, anchor = match.group(1), match.group(2), match.group(3) or ""
        if re.match(r"[a-z]+:", link):
            return match.group()
        path = (source.parent / link).resolve()
        if path.is_dir() or not path.is_relative_to(TOP):
            return text.strip("[]")
        if path.is_relative_to(TOP / "docs") or not path.exists():
            place = path.relative_to(TOP / "docs") if path.is_relative_to(TOP / "docs") else path.relative_to(TOP)
        else:
            place = path.relative_to(TOP)
            place = pathlib.Path("top") / place if place.suffix == ".md" else pathlib.Path("files") / place
        pages.add((path, place))
        return f"{text}({os.path.relpath(place, target.parent)}{anchor})"

    text = source.read_text(encoding="utf-8")
    parts = re.split(r"(^\s*(?:```|~~~).*?^\s*(?:```|~~~)\s*$)", text, flags=re.M | re.S)
    return "".join(part if i % 2 else LINK.sub(moved, part) for i, part in enumerate(parts))


def stage_docs(folder):
    done, queue = set(), {(p.resolve(), p.relative_to(TOP / "docs")) for p in (TOP / "docs").rglob("*.md")}
    inside = {place for _, place in queue}
    while queue:
        path, place = queue.pop()
        if place in done or not path.exists():
            continue
        done.add(place)
        target = folder / place
        target.parent.mkdir(parents=True, exist_ok=True)
        if path.suffix != ".md":
            shutil.copy(path, target)
            continue
        more = set()
        text = stage_page(path, place, more)
        queue |= {entry for entry in more if entry[1] not in done}
        target.write_text(text if place in inside else "---\norphan: true\n---\n" + text, encoding="utf-8")


def headers_of(folder):
    found = (INCLUDE / folder).glob("*.h") if folder == "." else (INCLUDE / folder).rglob("*.h")
    return sorted((h for h in found), key=lambda h: (len(h.parts), h.name))


def stage_api(folder):
    """api.md with a table of all public headers, and one page per folder of headers."""
    known = set(FOLDERS)
    for entry in INCLUDE.iterdir():
        if entry.is_dir() and entry.name not in known:
            sys.exit(f"docs/stage.py: FOLDERS does not name include/gaussmap/{entry.name}")
    (folder / "api").mkdir(exist_ok=True)
    table, contents = [], []
    for name, title in FOLDERS.items():
        headers = headers_of(name)
        if not headers:
            continue
        page = "everyday" if name == "." else name
        names = ", ".join(f"`{h.relative_to(INCLUDE)}`" for h in headers)
        table.append(f"| [{title}](api/{page}.rst) | {names} |")
        contents.append(f"api/{page}")
        rst = [title, "=" * len(title), "", ".. cpp:namespace:: gaussmap", ""]
        for header in headers:
            path = header.relative_to(INCLUDE.parent)
            group = re.sub(r"[/.]", "_", str(path))
            rst += [str(path), "-" * len(str(path)), "", ".. code-block:: cpp", "", f"   #include <{path}>", ""]
            if header.name == "version.h":
                rst += [".. doxygendefine:: GAUSSMAP_VERSION", ""]
            elif re.search(r"^namespace gaussmap \{", header.read_text(), re.M):
                rst += [f".. doxygengroup:: {group}", "   :content-only:", "   :members:", "   :undoc-members:", ""]
        (folder / "api" / f"{page}.rst").write_text("\n".join(rst))
    intro = (TOP / "docs/api.md").read_text() if (TOP / "docs/api.md").exists() else "# C++ API\n"
    toctree = "\n```{toctree}\n:hidden:\n\n" + "\n".join(contents) + "\n```\n"
    (folder / "api.md").write_text(intro + "\n| pages | headers |\n|---|---|\n" + "\n".join(table) + "\n" + toctree)


def trim(xml):
    """Changes Doxygen's files for breathe: the pages say once that all names are in the namespace gaussmap, and there are no
    pages of the sources that a name of a header could lead to."""
    for path in xml.glob("*.xml"):
        text = path.read_text(encoding="utf-8")
        if path.name.startswith(("class", "struct")):
            text = text.replace("<compoundname>gaussmap::", "<compoundname>")
        text = re.sub(r'<ref refid="[^"]*_8h(?:_source)?"[^>]*>(.*?)</ref>', r"\1", text)
        path.write_text(text, encoding="utf-8")


def main():
    folder = pathlib.Path(sys.argv[1])
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    stage_docs(folder)
    stage_api(folder)
    trim(pathlib.Path(sys.argv[2]))
    shutil.copy(TOP / "docs/conf.py", folder)
    shutil.copy(TOP / "docs/gaussmap.css", folder)


if __name__ == "__main__":
    main()
