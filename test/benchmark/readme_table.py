#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Writes the tables of README.md, docs/*.md and RESULTS.md from what gaussmap_benchmark has measured.

A table stands between the lines
  <!-- begin figures: KIND [PART, PART...] -->
  <!-- end figures -->
and this program replaces everything between them. KIND is one of

  times          times beside peers, of the rows whose part begins with one of PART (none given: all)
  times-short    the same without the largest inputs
  values         the other figures: memory, growth, angles; PART as above
  values-short   the same without the largest inputs
  summary        the six rows of the README
  refinement     distances to the truth, all methods at the same number of Gaussians
  ratios         the ratios that refinement-table prints
  filters        point filters at the same number of points
  text NAME      the text of --text NAME=FILE

Usage: readme_table.py [--table JSON] [--refinement JSON] [--filters JSON] [--text NAME=FILE]... FILE.md...
  The JSON files are those of `gaussmap_benchmark table --json`, `refinement-table --json` and `filters --json`.
  Tables for which no input is given stay as they are. test/benchmark/results.sh calls this program.
"""
import argparse
import json
import re
import sys

BLOCK = re.compile(r"(<!-- begin figures: ([a-z-]+) ?([^\n]*?) -->\n)(.*?)(<!-- end figures -->)", re.DOTALL)
LARGEST = ("20.0 M", "compressed")  # inputs that the short tables leave out
SUMMARY = (  # task, part and input of the row, command
    ("Exact sums of 5 M points, 0.2 m cells", "exact sums", "street, packets, 5.0 M, 0.2 m",
     "`gaussmap_benchmark table`"),
    ("Register a MulRan scan, 0.5 m and 1 degree off", "registration", "mulran_kaist03_21scans, 0.5 m, 1 deg",
     "`gaussmap_benchmark registration --data DATA`"),
    ("Hausdorff distance, 1 M points each", "Hausdorff, all figures", "the next metres of the drive",
     "`gaussmap_benchmark table`"),
    ("Map 6 KITTI scans on line, 0.2 m cells", "on-line mapping", "kitti_6scans, 6 scans, 0.2 m",
     "`gaussmap_benchmark table --data DATA`"),
    ("Normals of a KITTI scan", "normals", "kitti_6scans/000000.pcd", "`gaussmap_benchmark normals SCAN`"),
)


def time_of(seconds):
    return f"{seconds * 1e3:.3g} ms" if seconds < 0.9995 else f"{seconds:.3g} s"


def line(cells):
    return "| " + " | ".join(cells) + " |"


def table(head, rows):
    return [line(head), "|" + "---|" * len(head), *map(line, rows)]


def name_and_note(text):
    """'pcl::NDT (9 of 12 found)' -> 'pcl::NDT', '9 of 12 found'."""
    name, _, note = text.partition(" (")
    return name, note.rstrip(")")


def chosen(entries, parts, short):
    for entry in entries:
        if parts and not any(entry["part"].startswith(part) for part in parts):
            continue
        if not short or not any(word in entry["input"] for word in LARGEST):
            yield entry


def times(inputs, parts, short=False):
    groups, peers = {}, {}  # peers: names in the order in which they occur
    for row in chosen(inputs.table["rows"], parts, short):
        groups.setdefault((row["part"], row["input"], row["threads"]), []).append(row)
        peers[name_and_note(row["peer"])[0]] = True
    one_part = len({name_and_note(part)[0] for part, _, _ in groups}) == 1
    has_memory = any(rows[0]["megabytes"] for rows in groups.values())
    own = "time" if all(peer.endswith("one thread") for peer in peers) else "gaussmap"
    head = ([] if one_part else ["what"]) + ["input", "threads", own] + (["memory"] if has_memory else [])
    lines = []
    for (part, given, threads), rows in groups.items():
        name, note = name_and_note(part)
        cells = ([] if one_part else [name]) + [given, str(threads), time_of(rows[0]["seconds"]) + (note and f", {note}")]
        if has_memory:
            cells.append(f"{rows[0]['megabytes']:.0f} MB" if rows[0]["megabytes"] else "")
        of_peer = {name_and_note(row["peer"])[0]: row for row in rows}
        for peer in peers:
            row = of_peer.get(peer)
            cells.append(beside(row) if row else "")
        lines.append(cells)
    head += ["speed-up over one thread" if peer.endswith("one thread") else peer for peer in peers]
    return table(head, lines)


def beside(row):
    """Returns the time of a peer and its ratio to the time of gaussmap."""
    ratio = f"{row['peer_seconds'] / row['seconds']:.3g} x"
    name, note = name_and_note(row["peer"])
    if name.endswith("one thread"):  # a speed-up
        return ratio
    return ", ".join(filter(None, (time_of(row["peer_seconds"]), ratio, note)))


def values(inputs, parts, short=False):
    rows = [[entry["part"], entry["input"], entry["what"], f"{entry['value']:.3g} {entry['unit']}".strip()]
            for entry in chosen(inputs.table["figures"], parts, short)]
    head = ["what", "input", "figure", "value"]
    if len({row[0] for row in rows}) == 1:
        head, rows = head[1:], [row[1:] for row in rows]
    return table(head, rows)


def mean_over_seeds(row, key, quantity):
    return sum(seed[key][quantity] for seed in row["seeds"]) / len(row["seeds"])


def distances(row):
    return [mean_over_seeds(row, "to_truth", quantity) for quantity in ("q99", "q95", "mean")]


def refinement(inputs, _):
    names = list(dict.fromkeys(row["method"] for data in inputs.refinement for row in data["rows"]))
    rows = []
    for data in inputs.refinement:
        for budget in sorted({row["budget"] for row in data["rows"]} - {1.0}):
            cells = [f"{data['data']}, {budget:g} x"]
            for name in names:
                found = [row for row in data["rows"] if row["method"] == name and row["budget"] in (budget, 1.0)]
                cells.append(" / ".join(f"{value:.3g}" for value in distances(found[-1])) if found else "")
            rows.append(cells)
    return table(["99 % / 95 % / mean [m]", *names], rows)


def ratios(inputs, _):
    rows = [[data["data"], ratio["what"], f"{ratio['value']:.3g}"]
            for data in inputs.refinement for ratio in data["ratios"]]
    return table(["data", "ratio", "value"], rows)


def summary(inputs, _):
    head = ["task", "gaussmap", "peers", "measured with"]
    street = next(data for data in inputs.refinement if data["data"] == "simulated street")
    mean = {row["method"]: distances(row)[2] for row in street["rows"] if row["budget"] in (1.0, 4.0)}
    others = "; ".join(f"{name}: {mean[name]:.3g} m"
                       for name in ("uniform grid", "insertion as in the paper", "one per cell"))
    error = ["Mean distance to the truth, 4 Gaussians per 10 m cell (simulated street)",
             f"{mean['agglomeration']:.3g} m", others, "`gaussmap_benchmark refinement-table`"]
    lines = []
    for task, part, given, command in SUMMARY:
        rows = [row for row in inputs.table["rows"]
                if name_and_note(row["part"])[0] == part and row["input"] == given and row["threads"] == 1]
        if not rows:
            sys.exit(f"readme_table.py: no row '{part}' with the input '{given}': was --data given?")
        peers = "; ".join(f"{name_and_note(row['peer'])[0]}: {beside(row)}" for row in rows)
        note = name_and_note(rows[0]["part"])[1]
        lines.append([task, time_of(rows[0]["seconds"]) + (note and f", {note}"), peers, command])
    return table(head, [lines[0], error, *lines[1:]])


def filters(inputs, _):
    """The program measures by cloud and number of points: VoxelGrid, UniformSampling, GridMinimum, GaussianMapFilter
    with as many points as VoxelGrid (means, samples, split), GaussianMapFilter with as many points as GridMinimum."""
    def cell(row, count=False, ratio=False):
        text = f"{row['input_to_kept_95']:.3g} / {row['input_to_kept_mean']:.3g}, {time_of(row['seconds'])}"
        if ratio:
            text += f", {row['times_voxel_grid']:.2g} x"
        return text + (f" ({row['kept']} points)" if count else "")
    rows = inputs.filters
    lines = []
    for i in range(0, len(rows) - 6, 7):
        voxels, uniform, minimum, ours, _, split, ours_again = rows[i:i + 7]
        lines.append([f"{ours['cloud']}, {ours['kept']} points", cell(ours, ratio=True), cell(voxels), cell(uniform),
                      cell(minimum, True), cell(ours_again), cell(split, ratio=True)])
    return table(["95 % / mean [m], time", "`GaussianMapFilter`", "`pcl::VoxelGrid`", "`pcl::UniformSampling`",
                  "`pcl::GridMinimum`", "`GaussianMapFilter` with as many points as `pcl::GridMinimum`",
                  "`GaussianMapFilter`, `Split`"], lines)


def text_of(inputs, parts):
    return inputs.text[parts[0]].rstrip("\n").split("\n")


KINDS = {  # kind: (input that it needs, function)
    "times": ("table", times), "times-short": ("table", lambda i, p: times(i, p, True)),
    "values": ("table", values), "values-short": ("table", lambda i, p: values(i, p, True)),
    "summary": ("table", summary), "refinement": ("refinement", refinement), "ratios": ("refinement", ratios),
    "filters": ("filters", filters), "text": ("text", text_of),
}


def fill(path, inputs):
    with open(path, encoding="utf-8") as file:
        before = file.read()
    count = 0

    def replace(found):
        nonlocal count
        begin, kind, arguments, old, end = found.groups()
        if kind not in KINDS:
            sys.exit(f"{path}: '{begin.strip()}': the kind of a table is one of {', '.join(KINDS)}")
        needs, make = KINDS[kind]
        parts = [part.strip() for part in arguments.split(", ") if part.strip()]
        given = getattr(inputs, needs)
        if not given or (kind == "text" and parts[0] not in given) or (kind == "summary" and not inputs.refinement):
            return found.group(0)
        count += 1
        return begin + "\n".join(make(inputs, parts)) + "\n" + end

    after = BLOCK.sub(replace, before)
    if after.count("begin figures:") != after.count("<!-- end figures -->"):
        sys.exit(f"{path}: a table lacks its line '<!-- end figures -->'")
    if after != before:
        with open(path, "w", encoding="utf-8") as file:
            file.write(after)
    if count:
        print(f"{path}: {count} tables written")


def load(path):
    if path is None:
        return None
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def main():
    parser = argparse.ArgumentParser(usage=__doc__.split("Usage: ")[1].split("\n")[0])
    for name in ("table", "refinement", "filters"):
        parser.add_argument("--" + name)
    parser.add_argument("--text", action="append", default=[])
    parser.add_argument("files", nargs="+")
    inputs = parser.parse_args()
    for name in ("table", "refinement", "filters"):
        setattr(inputs, name, load(getattr(inputs, name)))
    texts = {}
    for entry in inputs.text:
        name, _, path = entry.partition("=")
        with open(path, encoding="utf-8") as file:
            texts[name] = file.read()
    inputs.text = texts
    for path in inputs.files:
        fill(path, inputs)


main()
