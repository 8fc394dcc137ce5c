#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of the pages from running services, and looks at what they show.

Usage: pictures_test.py BIN FOLDER

The room is computed, so its picture is the one of the pages to the last byte. The arms move by the clock: where they have been is
compared with the table.
"""
import pathlib
import sys
import unittest
import xml.etree.ElementTree as xml

import arms
import draw

IMAGES = pathlib.Path(__file__).resolve().parent.parent / "images"
SVG = "{http://www.w3.org/2000/svg}"


def numbers(text):
    """All places of an attribute like `M1 2 L3,4`."""
    return [float(word) for word in text.replace("M", " ").replace("L", " ").replace(",", " ").split()]


class Pictures(unittest.TestCase):
    folder = None

    def test_the_room_is_that_of_the_pages(self):
        self.assertEqual((self.folder / "smart_room.svg").read_bytes(), (IMAGES / "smart_room.svg").read_bytes())

    def test_the_arms_are_drawn_inside_the_picture(self):
        picture = xml.parse(self.folder / "dual_arm.svg").getroot()
        poses = [group for group in picture.iter(SVG + "g") if group.get("opacity")]
        self.assertEqual(len(poses), 10)
        for line in picture.iter(SVG + "polyline"):
            places = numbers(line.get("points"))
            self.assertTrue(all(0 < x < 860 for x in places[::2]), places)
            self.assertTrue(all(30 < y < 440 for y in places[1::2]), places)

    def test_the_wire_shows_the_table(self):
        picture = xml.parse(self.folder / "wire.svg").getroot()
        lines = [path for path in picture.iter(SVG + "path") if path.get("pathLength")]
        self.assertEqual(len(lines), 2)
        rows = arms.table()
        for arm, line in enumerate(lines):
            heights = numbers(line.get("d"))[1::2]
            values = [(140 - height) / 90 for height in heights]
            wanted = rows[1 + 6 * arm::19]
            self.assertAlmostEqual(max(values), max(wanted), delta=0.05)
            self.assertAlmostEqual(min(values), min(wanted), delta=0.05)
            self.assertGreater(len(values), 30)


if __name__ == "__main__":
    Pictures.folder = pathlib.Path(sys.argv[2])
    Pictures.folder.mkdir(parents=True, exist_ok=True)
    draw.draw_all(pathlib.Path(sys.argv[1]).resolve(), Pictures.folder)
    unittest.main(argv=sys.argv[:1])
