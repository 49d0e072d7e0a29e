"""Frames as the writers of bags take them: frames.py FOLDER|small OUT.

Writes OUT/frames.json with size, camera matrix and poses, and OUT/NNNNNN.raw with depths (uint16, millimetres, little
endian). `small` are six made-up frames, else FOLDER is one that `vantage plan` reads.
"""

import json
import math
import pathlib
import struct
import sys
import zlib

START_NS = 1_700_000_000_000_000_000
STEP_NS = 100_000_000


def png16(path):
    """Width, height and bytes (little endian) of a grey PNG of 16 bits without interlacing."""
    data = path.read_bytes()
    place, packed, size = 8, b"", None
    while place < len(data):
        length, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + length]
        if kind == b"IHDR":
            size = struct.unpack(">IIBBBBB", body)
        if kind == b"IDAT":
            packed += body
        place += 12 + length
    width, height, bits, color, _, _, interlaced = size
    assert (bits, color, interlaced) == (16, 0, 0), f"{path}: must be grey, 16 bits, not interlaced"
    raw, stride = zlib.decompress(packed), 2 * width
    rows, before = [], bytearray(stride)
    for row in range(height):
        kind = raw[row * (stride + 1)]
        line = bytearray(raw[row * (stride + 1) + 1:(row + 1) * (stride + 1)])
        for i in range(stride):
            left, up = (line[i - 2] if i >= 2 else 0), before[i]
            corner = before[i - 2] if i >= 2 else 0
            guess = left + up - corner
            paeth = min((left, up, corner), key=lambda v: abs(guess - v))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255
        rows.append(line)
        before = line
    values = struct.unpack(f">{width * height}H", b"".join(rows))
    return width, height, struct.pack(f"<{width * height}H", *values)


def quaternion(m):
    """x, y, z, w of a rotation matrix (rows)."""
    trace = m[0][0] + m[1][1] + m[2][2]
    squares = [1 + 2 * m[0][0] - trace, 1 + 2 * m[1][1] - trace, 1 + 2 * m[2][2] - trace, 1 + trace]
    k = max(range(4), key=lambda i: squares[i])
    if k == 3:
        q = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], squares[3]]
    else:
        i, j = (k + 1) % 3, (k + 2) % 3
        q = [0.0] * 4
        q[k], q[i], q[j], q[3] = squares[k], m[i][k] + m[k][i], m[j][k] + m[k][j], m[j][i] - m[i][j]
    length = math.sqrt(sum(v * v for v in q))
    return [v / length for v in q]


def small_frames():
    frames = []
    for number in range(6):
        depths = [0 if (column + row) % 7 == 0 else 500 + 10 * column + 3 * row + number * 17
                  for row in range(12) for column in range(16)]
        depths[5] = 65535
        angle = 0.2 * number
        pose = [0.1 * number, 0.5 - 0.05 * number, 0.3, 0.0, 0.0, math.sin(angle / 2), math.cos(angle / 2)]
        frames.append((struct.pack("<192H", *depths), pose))
    return 16, 12, [20.0, 0.0, 7.5, 0.0, 21.0, 5.5, 0.0, 0.0, 1.0], frames


def folder_frames(folder):
    width = height = 0
    frames = []
    for file in sorted(folder.glob("*.depth.png")):
        width, height, depths = png16(file)
        text = (folder / file.name.replace(".depth.png", ".pose.txt")).read_text(encoding="utf-8")
        m = [[float(v) for v in line.split()] for line in text.splitlines() if line.strip()]
        frames.append((depths, [m[0][3], m[1][3], m[2][3], *quaternion(m)]))
    numbers = (folder / "camera-intrinsics.txt").read_text(encoding="utf-8").split()
    return width, height, [float(v) for v in numbers], frames


def main():
    out = pathlib.Path(sys.argv[2])
    out.mkdir(parents=True, exist_ok=True)
    width, height, k, frames = small_frames() if sys.argv[1] == "small" else folder_frames(pathlib.Path(sys.argv[1]))
    entries = []
    for number, (depths, pose) in enumerate(frames):
        (out / f"{number:06}.raw").write_bytes(depths)
        entries.append({"stamp_ns": str(START_NS + number * STEP_NS), "pose": pose, "depth": f"{number:06}.raw"})
    (out / "frames.json").write_text(json.dumps({"width": width, "height": height, "k": k, "frames": entries}, indent=1),
                                     encoding="utf-8")


if __name__ == "__main__":
    main()
