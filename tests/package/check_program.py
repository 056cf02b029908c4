#!/usr/bin/python3
"""How the program is built, read off the program: what makes a fault of it harder to use, and what it is made of.

    check_program.py PROGRAM BILL

Ends with 77 where readelf is not installed.
"""

import json
import re
import shutil
import subprocess
import sys

PROGRAM, BILL = sys.argv[1:3]


def run(*command):
    done = subprocess.run(command, check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    assert done.returncode == 0, f"{command} ended with {done.returncode}:\n{done.stdout}"
    return done.stdout


def check_hardening():
    headers = run("readelf", "-hldW", PROGRAM)
    assert re.search(r"Type: +DYN", headers) and re.search(r"FLAGS_1.*\bPIE\b", headers), "it is no PIE"
    assert "GNU_RELRO" in headers and "BIND_NOW" in headers, "relocations can be written"
    stack = re.search(r"GNU_STACK.*", headers).group(0)
    assert " RW " in stack and "E" not in stack.split()[-2], f"the stack can be run: {stack}"
    assert not re.search(r"LOAD.* RWE ", headers), "memory can be written and run"
    assert "RPATH" not in headers, "it has an RPATH"
    symbols = run("readelf", "--dyn-syms", "-W", PROGRAM)
    assert "__stack_chk_fail" in symbols, "no stack protector"
    assert len(set(re.findall(r"__(?!stack)\w+_chk\b", symbols))) >= 3, "no _FORTIFY_SOURCE"


def check_bill():
    with open(BILL, encoding="utf-8") as file:
        bill = json.load(file)
    for key in ("spdxVersion", "dataLicense", "SPDXID", "name", "documentNamespace", "creationInfo", "packages"):
        assert bill[key], key
    assert bill["spdxVersion"] == "SPDX-2.3" and bill["dataLicense"] == "CC0-1.0"
    assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", bill["creationInfo"]["created"])
    packages = {package["name"]: package for package in bill["packages"]}
    ids = {package["SPDXID"] for package in bill["packages"]}
    assert len(ids) == len(packages) and all(re.fullmatch(r"SPDXRef-[\w.-]+", i) for i in ids)
    for relation in bill["relationships"]:
        assert {relation["spdxElementId"], relation["relatedSpdxElement"]} <= ids | {"SPDXRef-DOCUMENT"}, relation
    for name, package in packages.items():
        for key in ("downloadLocation", "licenseDeclared", "licenseConcluded", "copyrightText"):
            assert package[key], (name, key)
        assert re.match(r"\d+\.\d+", package["versionInfo"]), f"{name} has the version {package['versionInfo']}"
    comments = " ".join(package["comment"] for package in packages.values())
    for library in re.findall(r"\(NEEDED\).*\[(\w+(?:\+\+)?)", run("readelf", "-d", PROGRAM)):
        assert re.search(rf"(?<!\w){re.escape(library)}(?!\w)", comments), f"{library} is not in the bill:\n{comments}"
    return packages


def check_version(packages):
    out = run(PROGRAM, "-ver")
    assert out.startswith("fppg v" + packages["fppg"]["versionInfo"]), out
    assert re.search(r"\ncommit ([0-9a-f]{12}(-dirty)?|unknown), built by (GCC|.*[Cc]lang)", out), out
    commit = re.search(r"\ncommit (\S+),", out).group(1)
    assert f"commit {commit}," in packages["fppg"]["comment"], packages["fppg"]["comment"]
    for name in ("glibc", "fmt", "tinyxml2", "embree", "libpng", "zlib", "CLI11", "nlohmann_json", "hdf5"):
        if name in packages:
            assert re.search(rf"\n  {name} .*{re.escape(packages[name]['versionInfo'])}", out), f"{name}:\n{out}"


if __name__ == "__main__":
    if not shutil.which("readelf"):
        print("readelf is not installed (binutils)")
        sys.exit(77)
    check_hardening()
    check_version(check_bill())
