"""The listings of the README run as they are: readme_test.py PROGRAM README PYTHONPATH PREFIX.

Each runs in order in one folder where `./vantage` is the program. The C++ listing is compiled against the package
installed below PREFIX. Their blocks are found by their language.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap


def listings(text):
    """(language, code) of every block that names its language."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def run(command, folder, **environment):
    done = subprocess.run(command, cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True,
                          timeout=600, check=False)
    if done.returncode != 0:
        sys.exit(f"{command}\nfailed with {done.returncode}:\n{done.stdout}{done.stderr}")
    return done.stdout


def run_bash(code, folder):
    # The port of the listing may be taken.
    return run(["bash", "-euo", "pipefail", "-c", code.replace("8350", "18350")], folder)


def run_cpp(code, folder, prefix):
    source = folder / "client"
    source.mkdir()
    (source / "main.cpp").write_text(code, encoding="utf-8")
    (source / "CMakeLists.txt").write_text(textwrap.dedent("""\
        cmake_minimum_required(VERSION 3.22)
        project(client LANGUAGES CXX)
        find_package(vantage REQUIRED COMPONENTS session)
        add_executable(robot main.cpp)
        target_link_libraries(robot vantage::session)
        """), encoding="utf-8")
    run(["cmake", "-G", "Ninja", "-S", source, "-B", source / "build", f"-DCMAKE_PREFIX_PATH={prefix}",
         "-DCMAKE_BUILD_TYPE=Release"], folder)
    run(["cmake", "--build", source / "build"], folder)
    return run([source / "build" / "robot"], folder)


def main():
    program, readme, python_path, prefix = sys.argv[1:]
    found = listings(pathlib.Path(readme).read_text(encoding="utf-8"))
    languages = [language for language, _ in found]
    if languages != ["bash", "python", "cpp", "bash"]:
        sys.exit(f"the README must have listings in bash, python, cpp and bash, has {languages}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "vantage").symlink_to(program)
        expected = ["next best view", "occplane", "view ", '"candidate"']
        for (language, code), text in zip(found, expected):
            if language == "bash":
                output = run_bash(code, folder)
            elif language == "python":
                output = run(["/usr/bin/python3", "-c", code], folder, PYTHONPATH=python_path)
            else:
                output = run_cpp(code, folder, prefix)
            if text not in output:
                sys.exit(f"the {language} listing must print '{text}', printed:\n{output}")
            print(f"{language}: {len(output)} characters, as expected")
        print(f"{len(found)} listings ran")


if __name__ == "__main__":
    main()
