#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Tests of run_blocks.py: pages that must pass and pages that must fail, each with a part of the message.
Usage: run_blocks_test.py [--prefix INSTALLED --compiler C++]; without a prefix the C++ pages are left out."""
import argparse
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def block(language, text, before=""):
    return f"{before}\n```{language}\n{text}\n```\n"


SAY = "gaussmap 'street.gmap: 20 scans, 0.46 s'"
GOOD = {
    "numbers and blanks may differ": block("sh", SAY) + block("text", "street.gmap:  7 scans, 1.2e-3 s"),
    "stderr comes after stdout": block("sh", "echo late >&2; echo early") + block("text", "early\nlate"),
    "blocks share a folder": block("sh", "echo 7 > file") + block("sh", "cat file") + block("text", "7"),
    "text behind a paragraph is not compared": block("sh", "echo a") + "Then:\n" + block("text", "b"),
    "head ends a pipe": block("sh", "seq 100000 | head -1; echo later") + block("text", "1\nlater"),
    "other languages are not run": block("json", "{") + block("{note}", "exit 1"),
    "python runs after sh": block("python", "print(open('file').read())") + block("text", "a") + block("sh", "echo a > file"),
    "not run": block("sh", "sudo apt-get install -y g++ \\\n  cmake\nfalse", "<!-- not run: needs root -->"),
    "a named file": block("python", "print('hello')", "<!-- file: hello.py -->") + block("sh", "python3 hello.py")
                    + block("text", "hello"),
}
BAD = {
    "wrong output": (block("sh", SAY) + block("text", "street.gmap: 20 maps, 0.46 s"), ":7: the output differs"),
    "missing line": (block("sh", "echo a; echo b") + block("text", "a"), "(nothing more)"),
    "failing command": (block("sh", "false; echo good"), ":2: the command ends with exit code 1"),
    "failing pipe": (block("sh", "false | cat"), "exit code 1"),
    "unset variable": (block("sh", "echo $undefined"), "unbound variable"),
    "python fault": (block("python", "raise SystemExit(3)"), "Python ends with exit code 3"),
    "no reason": (block("sh", "false", "<!-- not run: -->"), "needs a reason"),
    "not run, no bash": (block("sh", "if true", "<!-- not run: slow -->"), "bash cannot parse"),
    "unknown package": (block("sh", "sudo apt install no-such-package", "<!-- not run: root -->"), "no-such-package"),
    "misspelt language": (block("bash", "true"), "write ```sh"),
    "no end": ("\n```sh\ntrue\n", "does not end"),
    "differs from its file": (block("python", "print(2)", "<!-- file: same.py -->"), "differs from"),
}
GOOD_CPP = {
    "snippets share a main()": block("cpp", "#include <cmath>\nconst double two = std::sqrt(4.0);")
                               + block("cpp", "std::cout << \"two: \" << two << '\\n';") + block("text", "two: 2"),
    "a program and its CMakeLists.txt": block("cpp", "#include <cstdio>\nint main() { std::puts(\"own\"); }")
        + block("text", "own") + block("cmake", "cmake_minimum_required(VERSION 3.21)\nproject(own LANGUAGES CXX)\n"
                                       "add_executable(own own.cpp)"),
}
BAD_CPP = {
    "C++ fault": (block("cpp", "int main() {\n  return undefined;\n}"), ":4: cmake --build fails"),
    "wrong C++ output": (block("cpp", "#include <cstdio>\nint main() { std::puts(\"yes\"); }") + block("text", "no"),
                         ":8: the output differs"),
    "failing program": (block("cpp", "int main() { return 4; }"), "exit code 4"),
    "unknown package of CMake": (block("cmake", "find_package(no_such_library REQUIRED)"), "no_such_library"),
}


def run(page, folder, options, *more):
    command = [sys.executable, str(HERE / "run_blocks.py"), str(page), "--program", str(folder / "gaussmap"), "--prefix",
               options.prefix or "/nowhere", "--compiler", options.compiler, *more]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    return done.returncode, done.stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--prefix")
    parser.add_argument("--compiler", default="c++")
    options = parser.parse_args()
    good, bad = dict(GOOD), dict(BAD)
    if options.prefix:
        good.update(GOOD_CPP)
        bad.update(BAD_CPP)
    failures = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        program = folder / "gaussmap"
        program.write_text("#!/bin/sh\necho \"$1\"\n")
        program.chmod(0o755)
        (folder / "same.py").write_text("print(1)\n")
        page = folder / "page.md"

        def expect(title, right, output):
            nonlocal failures
            print(("good: " if right else "WRONG: ") + title)
            if not right:
                failures += 1
                print(output)

        for title, text in good.items():
            page.write_text(text)
            code, output = run(page, folder, options)
            expect(title, code == 0, output)
        for title, (text, message) in bad.items():
            page.write_text(text)
            code, output = run(page, folder, options)
            expect(title + " fails", code == 1 and message in output, output)
        page.write_text(BAD["wrong output"][0])
        code, output = run(page, folder, options, "--update")
        expect("--update corrects the page", code == 0 and "20 scans, 0.46 s" in page.read_text().split("```text")[1], output)
        expect("the corrected page passes", run(page, folder, options)[0] == 0, page.read_text())
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
