#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the layers of the library: which folder may include which, no cycles, src/ mirrors include/gaussmap/.

Usage: test/layers.py [FOLDER]    FOLDER: the checkout, default: the one this script lies in
Prints one line per fault and exits 1, or prints one line and exits 0.
"""
import pathlib
import re
import sys

# From the lowest layer to the highest: a folder may include itself and folders of earlier rows.
LAYERS = ["core", "points", "mesh", "clustering", "map", "sensor", "mapping", "editing", "registration", "segments",
          "io", "evaluation", "simulation", "pcl", "viewer", "apps"]
ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent).resolve()
PUBLIC = ROOT / "include/gaussmap"
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]')


def folder_of(path):
    """The layer folder of a file, with subfolders: "io/pcd"; "" for the umbrella headers."""
    for base in (PUBLIC, ROOT / "src"):
        if base in path.parents:
            name = path.parent.relative_to(base).as_posix()
            return "" if name == "." else name.replace("pcl/impl", "pcl")
    return "apps"


def target_of(name, source):
    for candidate in (ROOT / "include" / name, ROOT / "src" / name, source.parent / name):
        if candidate.is_file():
            return candidate.resolve()
    return None


def includes():
    """(source, line number, included file) of every include of a file of the project by another."""
    for base in ("include", "src", "apps"):
        for source in sorted((ROOT / base).rglob("*")):
            if source.suffix not in (".h", ".hpp", ".cpp"):
                continue
            for number, line in enumerate(source.read_text().splitlines(), 1):
                found = INCLUDE.match(line)
                target = target_of(found.group(1), source) if found else None
                if target is not None:
                    yield source, number, target


def cycle_in(graph):
    """The folders of one cycle, in order, or None."""
    state, path = {}, []

    def visit(node):
        state[node] = "open"
        path.append(node)
        for following in sorted(graph.get(node, ())):
            if state.get(following) == "open":
                return path[path.index(following):] + [following]
            if following not in state:
                cycle = visit(following)
                if cycle:
                    return cycle
        path.pop()
        state[node] = "done"
        return None

    for node in sorted(graph):
        if node not in state:
            cycle = visit(node)
            if cycle:
                return cycle
    return None


def main():
    faults, graph, arrows = [], {}, set()
    for source, number, target in includes():
        at, to = folder_of(source), folder_of(target)
        where = f"{source.relative_to(ROOT)}:{number}"
        if PUBLIC in source.parents and PUBLIC not in target.parents:
            faults.append(f"{where}: a public header includes the internal {target.relative_to(ROOT)}")
        if "" in (at, to):
            if at != "" and target.name == "gaussmap.h":
                faults.append(f"{where}: the umbrella header is for users, include the parts")
            continue
        low, high = at.split("/")[0], to.split("/")[0]
        for name in (low, high):
            if name not in LAYERS:
                sys.exit(f"test/layers.py: {name} is in no layer: add it to LAYERS")
        if LAYERS.index(high) > LAYERS.index(low):
            faults.append(f"{where}: {low} must not include {high}, which is a higher layer ({target.relative_to(ROOT)})")
        if at != to:
            graph.setdefault(at, set()).add(to)
            arrows.add((at, to))
    cycle = cycle_in(graph)
    if cycle:
        faults.append("the folders include each other in a circle: " + " -> ".join(cycle))
    headers = sorted(PUBLIC.rglob("*.h"))
    for header in headers:
        text = header.read_text()
        source = ROOT / "src" / header.relative_to(PUBLIC).with_suffix(".cpp")
        if not source.is_file() and "// header only" not in text and header.parent != PUBLIC:
            faults.append(f"{header.relative_to(ROOT)}: no {source.relative_to(ROOT)}, and it does not say 'header only'")
    for fault in faults:
        print(fault)
    if faults:
        return 1
    folders = {folder for arrow in arrows for folder in arrow}
    print(f"layers: {len(folders)} folders, {len(arrows)} arrows, none upwards, no cycle; {len(headers)} public headers")
    return 0


sys.exit(main())
