#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Runs the code blocks of Markdown pages and compares what they print with the pages.

Everything of a page runs in one temporary folder, in this order:
  files   a block after the line `<!-- file: NAME -->` is written to NAME. If NAME exists beside the page
          (`examples/read_gmap.py`), the block must be equal to it.
  sh      `bash -euo pipefail`, one bash per block, with `gaussmap` and Debian's `python3` on the PATH
  cpp     blocks without `int main` are the body of one main(), the others are programs of their own
  python  one interpreter per block
          The recordings (*.mcap) in the folder `examples` beside the page are there under the same names.
  text    directly after one of these: its output (stdout, then stderr). Numbers and widths of blanks are not compared.
  cmake   the CMakeLists.txt that the programs of the page are built with (a block with `project(`), or lines of one
A block after the line `<!-- not run: REASON -->` does not run: sh is parsed, and packages that it installs with apt must
stand in cmake/install-deps.sh. Blocks of other languages are ignored.
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PYTHON = "/usr/bin/python3"  # Debian's: the one that python3-numpy belongs to
SKIPPED = 77  # exit code, known to ctest
TIMEOUT = 300  # of a block [s]
MISSPELT = {"bash": "sh", "shell": "sh", "c++": "cpp", "py": "python", "py3": "python", "CMake": "cmake"}
PCL = re.compile(r"<gaussmap/pcl/|<pcl/|\bpcl::|\bCOMPONENTS\b[^)]*\bpcl\b|gaussmap::pcl")
NUMBER = re.compile(r"(?:(?<![\w.)])[-+])?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?")

# With pipefail, a program that writes on after `head` has ended would fail.
BASH = 'head() { local code=0; command head "$@" || code=$?; cat >/dev/null; return $code; }\n'
PREAMBLE = r"""#include <gaussmap/gaussmap.h>
#include <cstdio>
#include <iostream>
#include <string>
#include <vector>
"""
MARK_FUNCTION = r"""static void beginDocsBlock(int block) {
  std::cout.flush();
  std::printf("@@ block %d @@\n", block);
  std::fflush(stdout);
}
"""


class Fault(Exception):
    """What is wrong, and at which line of the page."""

    def __init__(self, line, text):
        super().__init__(text)
        self.line = line


class Block:
    def __init__(self, language, line, text, end, indent):
        self.language, self.line, self.text, self.end, self.indent = language, line, text, end, indent
        self.not_run = None  # the reason
        self.file = None  # the name
        self.expected = None  # the text block behind it
        self.output = None
        self.original = None  # the text of the file beside the page


def parse(page):
    """All fenced blocks of a page. `line` is that of the fence, from 1; `end` that of the closing fence."""
    lines = page.read_text(encoding="utf-8").split("\n")
    blocks, last_text, i = [], "", 0
    while i < len(lines):
        fence = re.match(r"^(\s*)(`{3,}|~{3,})\s*([^\s`]*)", lines[i])
        if not fence:
            if lines[i].strip():
                last_text = lines[i].strip()
            i += 1
            continue
        indent, mark, language = fence.groups()
        begin, body = i, []
        i += 1
        while i < len(lines) and not re.match(rf"^\s*{mark[0]}{{{len(mark)},}}\s*$", lines[i]):
            body.append(lines[i][len(indent):] if lines[i].startswith(indent) else lines[i].lstrip())
            i += 1
        if i == len(lines):
            raise Fault(begin + 1, "the block does not end")
        block = Block(language, begin + 1, "".join(line + "\n" for line in body), i + 1, len(indent))
        i += 1
        not_run = re.fullmatch(r"<!--\s*not run:?\s*(.*?)\s*-->", last_text)
        named = re.fullmatch(r"<!--\s*file:\s*(\S+)\s*-->", last_text)
        if not_run:
            block.not_run = not_run.group(1)
            if not block.not_run:
                raise Fault(block.line, "`not run` needs a reason")
        if named:
            block.file = named.group(1)
        if language in MISSPELT:
            raise Fault(block.line, f"write ```{MISSPELT[language]}, not ```{language}: only then is the block run")
        if language == "text" and last_text == "" and blocks and blocks[-1].language in ("sh", "cpp", "python"):
            blocks[-1].expected = block
        blocks.append(block)
        last_text = ""
    return blocks


def masked(text):
    """Lines to compare: numbers become #, runs of blanks one blank, empty lines at the ends are cut."""
    lines = [re.sub(r"\s+", " ", NUMBER.sub("#", line)).strip() for line in text.split("\n")]
    while lines and not lines[-1]:
        lines.pop()
    while lines and not lines[0]:
        lines.pop(0)
    return lines


def indented(text):
    return "".join("    " + line + "\n" for line in text.rstrip("\n").split("\n"))


def debian_packages():
    """The packages that cmake/install-deps.sh knows."""
    text = (ROOT / "cmake/install-deps.sh").read_text()
    text = re.sub(r"#.*", "", text)
    return set(re.sub(r"\s+", " ", " ".join(re.findall(r"packages\+?=\(([^)]*)\)", text))).split())


def check_not_run(block):
    if block.language != "sh":
        return
    parsed = subprocess.run(["bash", "-n"], input=block.text, text=True, capture_output=True)
    if parsed.returncode:
        raise Fault(block.line, "bash cannot parse the block:\n" + indented(parsed.stderr))
    known = debian_packages()
    for command in re.sub(r"\\\n", " ", block.text).split("\n"):
        install = re.search(r"\bapt(?:-get)?\s+(?:-\S+\s+)*install\s+([^#;&|]*)", command)
        for package in install.group(1).split() if install else []:
            if not package.startswith("-") and package not in known:
                raise Fault(block.line, f"cmake/install-deps.sh does not install the package {package}")


class Page:
    def __init__(self, path, options):
        self.path, self.options = path, options
        self.blocks = parse(path)
        name = "-".join(path.resolve().parts[-2:])
        self.work = options.work / name if options.work else pathlib.Path(tempfile.mkdtemp(prefix="docs-"))
        self.skipped = []

    def prepare(self):
        if self.options.work:
            shutil.rmtree(self.work, ignore_errors=True)
        self.folder, bin_folder = self.work / "run", self.work / "bin"
        self.folder.mkdir(parents=True)
        bin_folder.mkdir()
        (bin_folder / "gaussmap").symlink_to(self.options.program.resolve())
        (bin_folder / "python3").symlink_to(PYTHON)
        for recording in (self.path.parent / "examples").glob("*.mcap"):
            (self.folder / "examples").mkdir(exist_ok=True)
            shutil.copy(recording, self.folder / "examples")
        self.environment = {"PATH": f"{bin_folder}:/usr/local/bin:/usr/bin:/bin", "HOME": str(self.folder),
                            "LC_ALL": "C.UTF-8", "TERM": "dumb"}

    def run(self):
        self.check_modules()
        self.prepare()
        for block in self.blocks:
            if block.not_run:
                check_not_run(block)
            elif block.file:
                self.write_file(block)
        for block in self.wanted("sh"):
            self.execute(block, ["bash", "-euo", "pipefail", "-c", BASH + block.text], "the command")
        self.run_cpp()
        for block in self.wanted("python"):
            self.execute(block, [PYTHON, "-c", block.text], "Python")

    def wanted(self, language):
        return [b for b in self.blocks if b.language == language and not b.not_run and not b.file]

    def check_modules(self):
        text = "".join(b.text for b in self.blocks if b.language == "python" and not b.not_run)
        for module in ("numpy", "zstandard"):
            if re.search(rf"\bimport .*\b{module}\b", text) and subprocess.run(
                    [PYTHON, "-c", f"import {module}"], capture_output=True).returncode:
                print(f"{self.path.name}: skipped, {PYTHON} has no module {module}: cmake/install-deps.sh --checks")
                sys.exit(SKIPPED)

    def write_file(self, block):
        original, text = self.path.parent / block.file, block.text
        if original.exists():
            text = original.read_text()
            if text != block.text and not self.options.update:
                raise Fault(block.line, f"the block differs from {original}")
            block.original = text
        (self.folder / pathlib.Path(block.file).name).write_text(text)

    def execute(self, block, command, what):
        try:
            done = subprocess.run(command, cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                                  capture_output=True, text=True, errors="replace", timeout=TIMEOUT)
        except subprocess.TimeoutExpired as late:
            raise Fault(block.line, f"{what} takes longer than {TIMEOUT} s") from late
        block.output = done.stdout + done.stderr
        if done.returncode:
            raise Fault(block.line, f"{what} ends with exit code {done.returncode}:\n" + indented(block.output))
        self.compare(block)

    def compare(self, block):
        if block.expected is None or self.options.update:
            return
        expected, got = masked(block.expected.text), masked(block.output)
        if expected == got:
            return
        line = next((i for i, pair in enumerate(zip(expected, got)) if pair[0] != pair[1]), min(len(expected), len(got)))
        row = block.expected.line + 1 + line
        raise Fault(row, "the output differs:\n"
                    f"  page:    {expected[line] if line < len(expected) else '(nothing more)'}\n"
                    f"  program: {got[line] if line < len(got) else '(nothing more)'}\n"
                    f"the whole output of the block in line {block.line}:\n" + indented(block.output))

    # C++ ----------------------------------------------------------------------------------------------------------

    def run_cpp(self):
        blocks, lists = self.wanted("cpp"), self.wanted("cmake")
        if not blocks and not lists:
            return
        with_pcl = any(PCL.search(b.text) for b in blocks + lists)
        if with_pcl and self.options.without_pcl:
            self.skipped.append("cpp and cmake (no PCL in this build)")
            return
        snippets = [b for b in blocks if not re.search(r"\bint\s+main\s*\(", b.text)]
        programs = [[b] for b in blocks if b not in snippets]
        if snippets:
            programs.append(snippets)
        sources = [self.source_of(p) for p in programs]
        whole = [b for b in lists if re.search(r"^\s*project\s*\(", b.text, re.M)]
        parts = [b for b in lists if b not in whole]
        for number, block in enumerate(whole[1:]):
            self.build_project(block, block.text, [], f"list-{number}")
        for number, block in enumerate(parts):
            self.build_project(block, self.completed(block.text), [], f"part-{number}")
        text = whole[0].text if whole else self.header(with_pcl)
        first = whole[0] if whole else (blocks or lists)[0]
        if whole or programs:
            executables = self.build_project(first, text, sources, "main")
            for program, executable in zip(programs, executables):
                self.run_program(program, executable)

    def source_of(self, blocks):
        """The C++ source of a whole program, or of snippets that share a main()."""
        line = lambda b, skip=0: f'#line {b.line + 1 + skip} "{self.path.name}"\n'
        if len(blocks) == 1 and re.search(r"\bint\s+main\s*\(", blocks[0].text):
            return line(blocks[0]) + blocks[0].text
        include = re.compile(r"^\s*#\s*include\b.*\n?", re.M)
        hoisted = [m.group().strip() for b in blocks for m in include.finditer(b.text)]
        body = "".join(f"beginDocsBlock({i});\n" + line(b) + include.sub("\n", b.text) for i, b in enumerate(blocks))
        return (PREAMBLE + "".join(h + "\n" for h in dict.fromkeys(hoisted)) + "using namespace gaussmap;\n"
                + MARK_FUNCTION + "int main() {\n" + body + "}\n")

    @staticmethod
    def header(with_pcl):
        component = "pcl" if with_pcl else "io"
        return ("cmake_minimum_required(VERSION 3.21)\nproject(docs LANGUAGES C CXX)\n"
                f"find_package(gaussmap REQUIRED COMPONENTS {component})\n")

    def completed(self, text):
        """Some lines of a CMakeLists.txt as a whole one: targets that it links but does not add are added before."""
        added = set(re.findall(r"add_(?:executable|library)\s*\(\s*(\S+)", text))
        missing = [t for t in dict.fromkeys(re.findall(r"target_link_libraries\s*\(\s*([^\s)]+)", text)) if t not in added]
        found = "" if "find_package" in text else f"find_package(gaussmap REQUIRED COMPONENTS {'pcl' if PCL.search(text) else 'io'})\n"
        return ("cmake_minimum_required(VERSION 3.21)\nproject(docs LANGUAGES C CXX)\n" + found
                + "".join(f"add_executable({t} docs_stub.cpp)\n" for t in missing) + text)

    def build_project(self, block, text, sources, name):
        """Builds a CMakeLists.txt with these programs. Its own add_executable() lines get them in order, or an empty one."""
        folder = self.work / name
        folder.mkdir()
        (folder / "docs_stub.cpp").write_text("int main() {}\n")
        executables, rest = [], list(sources)
        for target, files in re.findall(r"add_executable\s*\(\s*(\S+)([^)]*)\)", text):
            for i, file in enumerate(f for f in files.split() if f.endswith((".cpp", ".cc", ".cxx"))):
                if (folder / file).exists():
                    continue
                (folder / file).parent.mkdir(parents=True, exist_ok=True)
                source = rest.pop(0) if i == 0 and rest else None
                (folder / file).write_text(source or ("int main() {}\n" if i == 0 else "\n"))
                if source:
                    executables.append(target)
        if rest:
            component = "pcl" if any(PCL.search(s) for s in rest) else "io"
            text += f"\nfind_package(gaussmap REQUIRED COMPONENTS {component})\n"
        for i, source in enumerate(rest):
            target = f"docs_program_{i}"
            (folder / f"{target}.cpp").write_text(source)
            text += f"add_executable({target} {target}.cpp)\n"
            text += f"target_link_libraries({target} PRIVATE gaussmap::{'pcl' if PCL.search(source) else 'io'})\n"
            executables.append(target)
        (folder / "CMakeLists.txt").write_text(text)
        options = self.options
        launcher = [f"-DCMAKE_CXX_COMPILER_LAUNCHER={shutil.which('ccache')}"] if shutil.which("ccache") else []
        self.make(block, ["cmake", "-S", str(folder), "-B", str(folder / "build"), "-G", "Ninja",
                          f"-DCMAKE_CXX_COMPILER={options.compiler}", f"-DCMAKE_CXX_FLAGS={options.flags}",
                          f"-DCMAKE_PREFIX_PATH={options.prefix.resolve()}", *launcher])
        self.make(block, ["cmake", "--build", str(folder / "build"), "-j", "1"])
        return [folder / "build" / target for target in executables]

    def make(self, block, command):
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        if done.returncode:
            place = re.search(rf"{re.escape(self.path.name)}:(\d+):\d+: (?:fatal )?error:", done.stdout)
            line = int(place.group(1)) if place else block.line
            raise Fault(line, f"{' '.join(command[:2])} fails:\n" + indented(done.stdout[-6000:]))

    def run_program(self, blocks, executable):
        done = subprocess.run([str(executable)], cwd=self.folder, env=self.environment, stdin=subprocess.DEVNULL,
                              capture_output=True, text=True, errors="replace", timeout=TIMEOUT)
        parts = re.split(r"^@@ block \d+ @@\n", done.stdout, flags=re.M)
        outputs = parts[1:] if len(parts) > 1 else parts
        last = blocks[min(max(len(outputs) - 1, 0), len(blocks) - 1)]
        if done.returncode:
            raise Fault(last.line, f"the program ends with exit code {done.returncode}:\n"
                        + indented(done.stdout + done.stderr))
        outputs[-1] += done.stderr
        for block, output in zip(blocks, outputs):
            block.output = output
            self.compare(block)

    # ----------------------------------------------------------------------------------------------------------------

    def update(self):
        """Writes the real outputs into the text blocks of the page, and the named files into theirs."""
        lines = self.path.read_text(encoding="utf-8").split("\n")
        changed = 0
        rewritten = [(b.expected, b.output) for b in self.blocks if b.expected is not None and b.output is not None]
        rewritten += [(b, b.original) for b in self.blocks if b.original is not None]
        for block, text in sorted(rewritten, key=lambda pair: -pair[0].line):
            new = [(" " * block.indent + line).rstrip() for line in text.rstrip("\n").split("\n")]
            if lines[block.line:block.end - 1] != new:
                lines[block.line:block.end - 1] = new
                changed += 1
        self.path.write_text("\n".join(lines), encoding="utf-8")
        return changed

    def summary(self):
        counts = {lang: len(self.wanted(lang)) for lang in ("sh", "cpp", "python", "cmake")}
        compared = sum(b.expected is not None and b.output is not None for b in self.blocks)
        parts = [f"{n} {lang}" for lang, n in counts.items() if n] + [f"{compared} outputs compared"]
        parts += [f"line {b.line} not run ({b.not_run})" for b in self.blocks if b.not_run]
        return ", ".join(parts + [f"skipped: {s}" for s in self.skipped])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="+", type=pathlib.Path)
    parser.add_argument("--program", type=pathlib.Path, required=True, help="gaussmap")
    parser.add_argument("--prefix", type=pathlib.Path, required=True, help="where gaussmap is installed")
    parser.add_argument("--compiler", default="c++")
    parser.add_argument("--flags", default="-O0", help="of the compiler")
    parser.add_argument("--without-pcl", action="store_true", help="leave out the C++ of pages that use PCL")
    parser.add_argument("--work", type=pathlib.Path, help="the folder to work in; a page that fails stays there")
    parser.add_argument("--update", action="store_true", help="write the real outputs into the pages")
    options = parser.parse_args()
    options.work = options.work.resolve() if options.work else None
    failed = False
    for path in options.pages:
        page = None
        try:
            page = Page(path, options)
            page.run()
            changed = page.update() if options.update else 0
            print(f"{path.name}: good: {page.summary()}" + (f", {changed} blocks rewritten" if changed else ""))
        except Fault as fault:
            failed = True
            print(f"{path}:{fault.line}: {fault}")
        finally:
            if page and not (options.work and failed):
                shutil.rmtree(page.work, ignore_errors=True)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
