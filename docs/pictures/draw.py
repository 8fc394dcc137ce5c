#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of the examples that the pages show, from running services.

Usage: draw.py BIN [FOLDER]

BIN is the folder with robdef, smart_room_service and dual_arm; FOLDER (docs/images) gets smart_room.svg, dual_arm.svg and
wire.svg.
"""
import pathlib
import sys

import arms
import room
from service import Service


def draw_all(programs, folder):
    """Draws with the programs of one folder into another."""
    with Service(programs, "smart_room_service", "--port", "0", "--seconds", "120") as service:
        room.draw(service, folder / "smart_room.svg")
    with Service(programs, "dual_arm", "--serve", "120") as service:
        states = arms.run(service)
    arms.draw_arms(states, folder / "dual_arm.svg")
    arms.draw_wire(states, folder / "wire.svg")


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[2]) if len(sys.argv) == 3 else pathlib.Path(__file__).resolve().parent.parent / "images"
    draw_all(pathlib.Path(sys.argv[1]).resolve(), folder)


if __name__ == "__main__":
    main()
