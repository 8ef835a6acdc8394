#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Puts the figures of gaussmap_benchmark table --json into a Markdown file, between its two lines
<!-- benchmark: begin --> and <!-- benchmark: end -->. Usage: readme_table.py FIGURES.json FILE.md [WITHOUT...]
Rows whose input contains one of the words WITHOUT are left out."""
import json
import sys

BEGIN, END = "<!-- benchmark: begin -->", "<!-- benchmark: end -->"


def seconds(value):
    return f"{value * 1e3:.3g} ms" if value < 1 else f"{value:.3g} s"


def ratio(row):
    value = row["peer_seconds"] / row["seconds"]
    text = f"{row['peer']} {value:.3g}"
    if row["wanted"]:
        text += f" ({'wanted' if value >= row['wanted'] else '**wanted**'} {row['wanted']:g})"
    return text


def lines(figures, without):
    kept = lambda entry: not any(word in entry["input"] for word in without)
    yield "| what | input | threads | time | memory | times slower: the peer (**wanted** = not reached) |"
    yield "|---|---|---|---|---|---|"
    groups = {}
    for row in filter(kept, figures["rows"]):
        groups.setdefault((row["part"], row["input"], row["threads"]), []).append(row)
    for (part, given, threads), rows in groups.items():
        memory = f"{rows[0]['megabytes']:.0f} MB" if rows[0]["megabytes"] else ""
        peers = ", ".join(map(ratio, rows))
        yield f"| {part} | {given} | {threads} | {seconds(rows[0]['seconds'])} | {memory} | {peers} |"
    yield ""
    yield "| what | input | | |"
    yield "|---|---|---|---|"
    for figure in filter(kept, figures["figures"]):
        wanted = ""
        if figure["at_most"]:
            word = "wanted" if figure["value"] <= figure["at_most"] else "**wanted**"
            wanted = f" ({word} at most {figure['at_most']:g})"
        value = f"{figure['value']:.3g} {figure['unit']}".strip()
        yield f"| {figure['part']} | {figure['input']} | {figure['what']} | {value}{wanted} |"


def main():
    if len(sys.argv) < 3:
        sys.exit("usage: readme_table.py FIGURES.json FILE.md [WITHOUT...]")
    with open(sys.argv[1], encoding="utf-8") as file:
        figures = json.load(file)
    with open(sys.argv[2], encoding="utf-8") as file:
        text = file.read()
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        sys.exit(f"{sys.argv[2]}: needs one line '{BEGIN}' and one '{END}'")
    head, rest = text.split(BEGIN)
    tail = rest.split(END)[1]
    with open(sys.argv[2], "w", encoding="utf-8") as file:
        file.write(head + BEGIN + "\n" + "\n".join(lines(figures, sys.argv[3:])) + "\n" + END + tail)


main()
