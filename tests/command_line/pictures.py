# SPDX-FileCopyrightText: 2026 The adasplats authors
# SPDX-License-Identifier: Apache-2.0
"""What the command line tests read of pictures and their layers."""
import ast
import struct
from pathlib import Path

PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def png_size(path):
    """Width and height of a PNG, which `path` must be (PNG specification, sections 5.2 and 11.2.2)."""
    head = Path(path).read_bytes()[:24]
    if head[:8] != PNG_SIGNATURE or head[12:16] != b"IHDR":
        raise AssertionError(f"{path} is no PNG: it begins with {head[:16]!r}")
    return struct.unpack(">II", head[16:24])


def npy(path):
    """Shape and values of a .npy (numpy.lib.format)."""
    data = path.read_bytes()
    size = struct.unpack("<H", data[8:10])[0]
    header = ast.literal_eval(data[10:10 + size].decode())
    code = {"<f4": "f", "<i4": "i"}[header["descr"]]
    values = data[10 + size:]
    return header["shape"], struct.unpack(f"<{len(values) // 4}{code}", values)
