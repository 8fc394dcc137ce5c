# SPDX-License-Identifier: Apache-2.0
"""Pictures as text: SVG, and PNG for what goes into it."""
import base64
import struct
import zlib

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" font-family="sans-serif" font-size="13">'


def number(value):
    """With one decimal, as short as it can be written."""
    text = f"{value:.1f}"
    return text[:-2] if text.endswith(".0") else text


def points(places):
    """For the attribute of a polyline or polygon."""
    return " ".join(f"{number(x)},{number(y)}" for x, y in places)


def rgb(color, gain=1.0):
    """Three parts from 0 to 1 as `#rrggbb`, brighter by `gain`; what is above 1 is 1."""
    return "#" + "".join(f"{round(255 * min(1.0, part * gain)):02x}" for part in color)


def png(width, height, rgb_bytes):
    """Three bytes a pixel, rows from the top, as the text of a `data:` URL."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + rgb_bytes[3 * width * y:3 * width * (y + 1)] for y in range(height))
    data = (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
    return "data:image/png;base64," + base64.b64encode(data).decode("ascii")


def write(path, width, height, title, lines):
    """A picture of these lines on white."""
    text = "\n".join([HEAD.format(width, height), f"<title>{title}</title>",
                      f'<rect width="{width}" height="{height}" fill="#ffffff"/>', *lines, "</svg>", ""])
    path.write_text(text, encoding="utf-8")
