#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Packs the Python module and the programs of an installation into a wheel; the same files give the same bytes.

usage: wheel.py PREFIX VERSION OUT_DIR     PREFIX: holds bin/ and lib/, programs look for libraries in ../lib
"""
import base64
import hashlib
import os
import platform
import sys
import zipfile

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
METADATA = """Metadata-Version: 2.1
Name: meshpipe
Version: {version}
Summary: Remesh triangulated surfaces for finite elements and CFD
License: BSD-3-Clause
Requires-Python: >=3.8
Requires-Dist: numpy
"""
WHEEL = "Wheel-Version: 1.0\nGenerator: meshpipe\nRoot-Is-Purelib: false\nTag: {tag}\n"


def main(prefix, version, out):
    libc = platform.libc_ver()[1].replace(".", "_")
    tag = f"py3-none-manylinux_{libc}_{platform.machine()}"
    files = {}
    for folder in ("bin", "lib"):
        for name in sorted(os.listdir(os.path.join(prefix, folder))):
            with open(os.path.join(prefix, folder, name), "rb") as f:
                files[f"meshpipe/{folder}/{name}"] = f.read()
    with open(os.path.join(ROOT, "scripts", "python", "meshpipe", "__init__.py"), "rb") as f:
        files["meshpipe/__init__.py"] = f.read()
    info = f"meshpipe-{version}.dist-info/"
    with open(os.path.join(ROOT, "LICENSE"), "rb") as f:
        files[info + "LICENSE"] = f.read()
    files[info + "METADATA"] = METADATA.format(version=version).encode()
    files[info + "WHEEL"] = WHEEL.format(tag=tag).encode()
    record = ""
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
        record += f"{name},sha256={digest},{len(data)}\n"
    files[info + "RECORD"] = (record + info + "RECORD,,\n").encode()
    path = os.path.join(out, f"meshpipe-{version}-{tag}.whl")
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, data in files.items():
            item = zipfile.ZipInfo(name, (2026, 1, 1, 0, 0, 0))
            item.external_attr = (0o100755 if "/bin/" in name else 0o100644) << 16
            item.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(item, data)
    print(path)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
