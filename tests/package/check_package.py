#!/usr/bin/python3
"""Makes the Debian packages, looks into them, unpacks them and runs what is inside.

    check_package.py CPACK BUILD_FOLDER SOURCE_FOLDER WORK_FOLDER HAS_PYTHON_MODULE(0 or 1)
"""

import glob
import gzip
import os
import re
import shutil
import subprocess
import sys

WANTED = ("/usr/bin/fppg", "/usr/share/man/man1/fppg.1.gz", "/usr/share/bash-completion/completions/fppg",
          "/usr/share/doc/fppg/copyright", "/usr/share/doc/fppg/fppg.spdx.json", "/usr/share/fppg/xml-templates/fppg.xsd",
          "/usr/share/fppg/xml-templates/FppgCaseTemplate.xml", "/usr/share/fppg/xml-templates/data/",
          "/usr/share/fppg/cases/dambreak/CaseDambreak_Def.xml", "/usr/include/fppg/version.h",
          "/usr/share/fppg/paraview/fppg_reader.py", "/usr/share/fppg/paraview/particle_files.py",
          "/usr/include/fppg/compare.h", "/usr/include/fppg/fppg.h", "cmake/fppg/fppgConfig.cmake", "/libfppg.a")


def run(*command, **options):
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **options)
    assert done.returncode == 0, f"{command} ended with {done.returncode}:\n{done.stdout}"
    return done.stdout


def files_of(package):
    """Path and what follows it, the target of a link, of everything in a package."""
    return [line.split(None, 5)[5].lstrip(".") for line in run("dpkg-deb", "--contents", package).splitlines()]


def check_completion(root):
    """What bash offers for the beginning of a line."""
    script = os.path.join(root, "usr/share/bash-completion/completions/fppg")
    offered = run("bash", "-c", f"""source {script!r}; compopt() {{ :; }}
        COMP_WORDS=(fppg comp); COMP_CWORD=1; _fppg; echo "${{COMPREPLY[*]}}"
        COMP_WORDS=(fppg compare --tolerance-v); COMP_CWORD=2; _fppg; echo "${{COMPREPLY[*]}}"
        COMP_WORDS=(fppg Case_Def out -createdirs); COMP_CWORD=3; _fppg; echo "${{COMPREPLY[*]}}"
        cd {root}/usr/share/fppg/cases/dambreak; COMP_WORDS=(fppg Case); COMP_CWORD=1; _fppg; echo "${{COMPREPLY[*]}}"
        """).splitlines()
    assert offered == ["compare", "--tolerance-velocity", "-createdirs:", "CaseDambreak_Def"], offered


def options_in(text):
    return set(re.findall(r"(?<![\w-])(--?[a-z][a-z0-9-]+)", text))


def check_help(program, source):
    """Every option and subcommand of the help is in the manual page and in the completion."""
    with open(os.path.join(source, "tools/package/fppg.1"), encoding="utf-8") as file:
        page = file.read().replace("\\-", "-").replace("\\", "")
    with open(os.path.join(source, "tools/package/fppg.bash"), encoding="utf-8") as file:
        completion = file.read()
    text = run(program, "--help")
    for option in options_in(text[text.index("Options"):]) - {"-h"}:
        assert option in page, f"{option} is not in the manual page"
    for command in re.findall(r"^  fppg ([a-z]+) ", text, re.M):
        assert f"\n.B {command}\n" in page, f"{command} is not in the manual page"
        known = completion[completion.index(f"*:{command})"):]
        known = known[:known.index(";;")]
        for option in options_in(run(program, command, "--help").split("ptions", 1)[-1]):
            # The completion offers one of the two spellings.
            if option.startswith("--") and command != "estimate" and option != "--colour":
                assert option in known, f"{command} {option} is not completed"


def check_python(root, files):
    """The Python module is there and works."""
    assert any(name.startswith("/usr/lib/python3/dist-packages/fppg/_fppg") for name in files), "no Python module"
    folder = os.path.join(root, "usr/lib/python3/dist-packages")
    case = os.path.join(root, "usr/share/fppg/cases/dambreak2d/CaseDambreak2D_Def.xml")
    text = run("/usr/bin/python3", "-B", "-c", f"import fppg; print(len(fppg.generate({case!r})))",
               env={**os.environ, "PYTHONPATH": folder})
    assert text.strip() == "21001", text


def check_step(root, package, work):
    """The plugin is in no package but its own, and makes the program read STEP files."""
    case = os.path.join(root, "usr/share/fppg/xml-templates/DrawFileStep_Def")
    command = [os.path.join(root, "usr/bin/fppg"), case, os.path.join(work, "step/Case")]
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 4 and "libfppg_step.so" in done.stdout, done.stdout
    run("dpkg-deb", "--extract", package, root)
    run(*command)
    assert "libocct-data-exchange" in run("dpkg-deb", "--field", package, "Depends")


def check_lintian(packages):
    """Debian's own check finds no error; its warnings are printed."""
    if not shutil.which("lintian"):
        print("lintian is not installed: what it says is not checked")
        return
    done = subprocess.run(["lintian", "--allow-root", "--tag-display-limit", "0", *packages], check=False, text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    print(done.stdout)
    errors = [line for line in done.stdout.splitlines() if line.startswith("E:")]
    assert not errors, "\n".join(errors)


def main(cpack, build, source, work, has_python_module):
    shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work)
    run(cpack, "-G", "DEB", "-B", work, "--config", os.path.join(build, "CPackConfig.cmake"))
    packages = {os.path.basename(path).split("_")[0]: path for path in glob.glob(os.path.join(work, "*.deb"))}
    has_step = os.path.exists(os.path.join(build, "libfppg_step.so"))
    assert set(packages) == {"fppg", "fppg-gencase-link"} | ({"fppg-step"} if has_step else set()), packages

    files = files_of(packages["fppg"])
    for wanted in WANTED:
        assert any(wanted in name for name in files), f"{wanted} is not in\n" + "\n".join(files)
    assert not any("GenCase_linux64" in name for name in files)
    outside = [name for name in files if not name.startswith(("/usr/", "/usr")) and name != "/"]
    assert not outside, outside
    assert any("/usr/bin/GenCase_linux64 -> fppg" in name for name in files_of(packages["fppg-gencase-link"]))
    assert run("dpkg-deb", "--field", packages["fppg-gencase-link"], "Depends").strip() == "fppg"
    if shutil.which("dpkg-shlibdeps"):
        assert "libtinyxml2" in run("dpkg-deb", "--field", packages["fppg"], "Depends")

    if os.path.exists(os.path.join(build, "libfppg_hdf5.so")):
        assert any(name.endswith("/fppg/libfppg_hdf5.so") for name in files), "no plugin for HDF5"

    root = os.path.join(work, "root")
    for name, package in packages.items():
        if name != "fppg-step":
            run("dpkg-deb", "--extract", package, root)
    if has_step:
        check_step(root, packages["fppg-step"], work)
    assert "GenCase" in run(os.path.join(root, "usr/bin/GenCase_linux64"), "-ver")
    case = os.path.join(root, "usr/share/fppg/cases/dambreak2d/CaseDambreak2D_Def")
    run(os.path.join(root, "usr/bin/GenCase_linux64"), case, os.path.join(work, "out/Case"))
    assert os.path.exists(os.path.join(work, "out/Case.bi4"))
    with gzip.open(os.path.join(root, "usr/share/man/man1/fppg.1.gz"), "rt") as page:
        assert page.read().startswith(".TH FPPG 1")
    check_completion(root)
    if has_python_module == "1":
        check_python(root, files)
    check_help(os.path.join(root, "usr/bin/fppg"), source)
    check_lintian(packages.values())


if __name__ == "__main__":
    main(*(os.path.abspath(argument) for argument in sys.argv[1:5]), sys.argv[5])
